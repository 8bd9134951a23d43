//! A ball rolls on a land of Orogen, which is made around it while it rolls.
//!
//! `cargo run --release -p orogen-bevy` opens a window; `--help` lists the options.

mod arguments;
mod ball;
mod ground_plugin;
mod headless;
mod survey;

use std::process::ExitCode;
use std::sync::Arc;

use avian3d::prelude::*;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use orogen::LodConfig;

use arguments::Arguments;
use ball::{Push, drop_ball, follow_ball, push_ball};
use ground_plugin::{GroundPlugin, Viewer};

/// Color of the sky and of the haze.
const SKY: Color = Color::srgb(0.62, 0.74, 0.87);

/// Range of sight, in metres.
const RANGE: f64 = 6000.0;

fn main() -> ExitCode {
    match run() {
        Ok(AppExit::Success) => ExitCode::SUCCESS,
        Ok(AppExit::Error(_)) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<AppExit, String> {
    let arguments = Arguments::of_process()?;
    let world = Arc::new(orogen::open(&arguments.world).map_err(|error| error.to_string())?);
    let is_headless = arguments.frames > 0;
    let mut app = App::new();
    let window = Window { title: "Orogen".into(), ..default() };
    let plugins = DefaultPlugins
        .set(WindowPlugin {
            primary_window: (!is_headless).then_some(window),
            exit_condition: if is_headless { ExitCondition::DontExit } else { ExitCondition::OnAllClosed },
            ..default()
        })
        // What has no pipeline yet is not drawn, and a picture waits for no second frame.
        .set(RenderPlugin { synchronous_pipeline_compilation: is_headless, ..default() });
    match is_headless {
        true => app.add_plugins(plugins.disable::<WinitPlugin>()),
        false => app.add_plugins(plugins),
    };
    let lod = LodConfig::default().with_cell(arguments.cell).with_range(RANGE);
    app.add_plugins((PhysicsPlugins::default(), GroundPlugin { world, origin: arguments.at, lod }))
        .insert_resource(ClearColor(SKY))
        .insert_resource(GlobalAmbientLight { color: SKY, brightness: 650.0, ..default() })
        .insert_resource(Push(if is_headless { Vec3::new(0.5, 0.0, -0.35) } else { Vec3::ZERO }))
        .add_systems(Startup, light)
        .add_systems(Update, (drop_ball, push_ball, follow_ball).chain());
    if is_headless {
        headless::set_up(&mut app, arguments.frames, arguments.screenshot);
    } else {
        app.add_systems(Startup, |mut commands: Commands| {
            commands.spawn(camera());
        });
    }
    Ok(app.run())
}

/// The sun.
fn light(mut commands: Commands) {
    commands.spawn((
        DirectionalLight {
            illuminance: 11_000.0,
            color: Color::srgb(1.0, 0.95, 0.86),
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder { maximum_distance: 0.3 * RANGE as f32, first_cascade_far_bound: 60.0, ..default() }
            .build(),
        Transform::default().looking_to(Vec3::new(0.35, -0.5, 0.8), Vec3::Y),
    ));
}

/// The camera, which the ground is made around.
fn camera() -> impl Bundle {
    (
        Viewer,
        Camera3d::default(),
        Projection::from(PerspectiveProjection { far: 2.0 * RANGE as f32, near: 0.5, ..default() }),
        // The others need textures, which the example does without.
        Tonemapping::Reinhard,
        DistanceFog {
            color: SKY,
            falloff: FogFalloff::Linear { start: 0.15 * RANGE as f32, end: 0.95 * RANGE as f32 },
            ..default()
        },
        Transform::default(),
    )
}
