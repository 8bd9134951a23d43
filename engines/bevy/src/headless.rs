//! Frames without a window: the way of the ball, what rays hit, and a picture at the end. Only the frames of the
//! picture are drawn.

use std::path::PathBuf;
use std::time::Duration;

use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured, save_to_disk};
use bevy::time::TimeUpdateStrategy;

use crate::ball::Ball;
use crate::camera;
use crate::ground_plugin::ShownGround;
use crate::survey::{print_ball, print_survey};

/// Size of the picture in pixels.
const SIZE: [u32; 2] = [960, 540];

/// The time of a frame, in seconds.
const FRAME: f64 = 1.0 / 60.0;

/// Frames from one line about the ball to the next.
const FRAMES_PER_LINE: u32 = 10;

/// Updates that are made at most while the ground is not complete.
const MAX_WAITS: u32 = 100_000;

/// The picture that the camera draws.
#[derive(Resource)]
struct Picture(Handle<Image>);

/// Makes the app run this many frames after the ball is there, and end.
pub fn set_up(app: &mut App, frames: u32, screenshot: Option<PathBuf>) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(FRAME)))
        .add_systems(Startup, picture)
        .set_runner(move |app| run(app, frames, screenshot));
}

fn picture(mut commands: Commands, mut images: ResMut<Assets<Image>>) {
    let [width, height] = SIZE;
    let image = images.add(Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None));
    // It draws the last frames only: software takes a second for one, and the ground and the ball need none.
    let camera = (camera(), Camera { is_active: false, ..default() }, RenderTarget::Image(image.clone().into()));
    commands.spawn(camera);
    commands.insert_resource(Picture(image));
}

fn run(mut app: App, frames: u32, screenshot: Option<PathBuf>) -> AppExit {
    while app.plugins_state() == bevy::app::PluginsState::Adding {
        std::thread::yield_now();
    }
    app.finish();
    app.cleanup();
    if !app.world().contains_resource::<ShownGround>() {
        return AppExit::error();
    }
    match roll(&mut app, frames) {
        Ok(()) => screenshot.map_or(AppExit::Success, |path| shoot(&mut app, path)),
        Err(error) => {
            error!("{error}");
            AppExit::error()
        }
    }
}

/// Lets the ball roll, and prints its way and what rays hit at the end.
fn roll(app: &mut App, frames: u32) -> Result<(), BevyError> {
    complete(app)?;
    for frame in 0..frames {
        app.update();
        if frame % FRAMES_PER_LINE == 0 {
            app.world_mut().run_system_cached(print_ball)?;
        }
        complete(app)?;
    }
    app.world_mut().run_system_cached(print_survey)?;
    app.world_mut().run_system_cached(print_ball)?;
    Ok(())
}

/// Makes the ground around the viewer complete while time stands still, as frames follow each other faster than in a
/// game. The first time, also the ball.
fn complete(app: &mut App) -> Result<(), String> {
    let mut balls = app.world_mut().query_filtered::<(), With<Ball>>();
    let is_complete = |app: &App| app.world().resource::<ShownGround>().is_complete;
    if is_complete(app) && balls.iter(app.world()).next().is_some() {
        return Ok(());
    }
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    let mut waits = 0;
    while !is_complete(app) || balls.iter(app.world()).next().is_none() {
        app.update();
        waits += 1;
        if waits > MAX_WAITS {
            return Err(format!("the ground is not complete after {waits} updates"));
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(FRAME)));
    Ok(())
}

/// Whether the picture is written.
#[derive(Resource)]
struct IsShot;

/// Writes the picture of the next frame.
fn shoot(app: &mut App, path: PathBuf) -> AppExit {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    let mut cameras = app.world_mut().query::<&mut Camera>();
    cameras.iter_mut(app.world_mut()).for_each(|mut camera| camera.is_active = true);
    // The frame before the picture makes what shaders need.
    app.update();
    let picture = app.world().resource::<Picture>().0.clone();
    app.world_mut()
        .spawn(Screenshot::image(picture))
        .observe(save_to_disk(path))
        .observe(|_: On<ScreenshotCaptured>, mut commands: Commands| commands.insert_resource(IsShot));
    for _ in 0..1000 {
        app.update();
        if app.world().contains_resource::<IsShot>() {
            return AppExit::Success;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    error!("the picture was not drawn");
    AppExit::error()
}
