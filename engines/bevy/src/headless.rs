//! Frames without a window: a picture of the last one, and what rays hit.

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
use crate::survey::print_survey;

/// Size of the picture in pixels.
const SIZE: [u32; 2] = [960, 540];

/// The time of a frame, in seconds.
const FRAME: f64 = 1.0 / 60.0;

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
    commands.spawn((camera(), RenderTarget::Image(image.clone().into())));
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
    let mut balls = app.world_mut().query_filtered::<(), With<Ball>>();
    let mut waits = 0;
    while balls.iter(app.world()).next().is_none() {
        app.update();
        waits += 1;
        if waits > MAX_WAITS {
            error!("the ground is not complete after {waits} updates");
            return AppExit::error();
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    for _ in 0..frames {
        app.update();
    }
    // The ball does not move while the ground around it is completed.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    while !app.world().resource::<ShownGround>().is_complete && waits < MAX_WAITS {
        app.update();
        waits += 1;
        std::thread::sleep(Duration::from_millis(1));
    }
    app.update();
    if let Err(error) = app.world_mut().run_system_cached(print_survey) {
        error!("{error}");
        return AppExit::error();
    }
    match screenshot {
        Some(path) => shoot(&mut app, path),
        None => AppExit::Success,
    }
}

/// Whether the picture is written.
#[derive(Resource)]
struct IsShot;

/// Writes the picture of the next frame.
fn shoot(app: &mut App, path: PathBuf) -> AppExit {
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
