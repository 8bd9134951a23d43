//! The light of the 3D view, which is the light of rendered pictures.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use eframe::egui::Context;
use orogen::output::render::lighting::Lighting;
use orogen::output::render::shader::LightShader;
use orogen::{Progress, Session};
use serde::{Deserialize, Serialize};

use crate::platform::{self, Task};
use crate::studio::Studio;

/// The work for the sky of a sun.
#[derive(Serialize, Deserialize)]
pub struct SkyTask {
    /// Azimuth and elevation, in degrees.
    sun: [f64; 2],
}

impl Task for SkyTask {
    const NAME: &'static str = "sky";
    const IS_URGENT: bool = true;
    type Event = Lighting;

    fn run(self, _: &Session, _: &Progress, tell: &(dyn Fn(Lighting) + Send + Sync)) {
        tell(Lighting::new(self.sun));
    }
}

/// What the light of the view depends on, in addition to the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// The diagonal of the land, in units of the view.
    pub across: f64,
    /// Height of the highest ground above the lowest, in units of the view.
    pub highest: f64,
    /// The cell, in metres.
    pub cell: f64,
}

/// The light, computed again when the sun or the land changes.
#[derive(Debug, Default)]
pub struct Light {
    /// The sky for an elevation of the sun. Computing one takes longer than a frame.
    sky: Option<(f64, Lighting)>,
    making: Option<Receiver<(f64, Lighting)>>,
    shader: Option<([f64; 2], Block, Arc<LightShader>)>,
}

impl Light {
    /// The light for a sun (degrees clockwise from north, and above the horizon) and a block of land. While the sky for
    /// another elevation is being computed, the last one is returned.
    pub fn of(&mut self, studio: &Studio, context: &Context, sun: [f64; 2], block: Block) -> Arc<LightShader> {
        let [azimuth, elevation] = sun;
        let made = self.making.as_ref().map(Receiver::try_recv);
        match made {
            Some(Ok(sky)) => (self.sky, self.making) = (Some(sky), None),
            Some(Err(TryRecvError::Disconnected)) => self.making = None,
            Some(Err(TryRecvError::Empty)) | None => {}
        }
        let (known, lighting) = self.sky.get_or_insert_with(|| (elevation, Lighting::new(sun)));
        if *known != elevation && self.making.is_none() {
            let (sender, receiver) = channel();
            let context = context.clone();
            let sky = SkyTask { sun: [azimuth, elevation] };
            // The view may already be closed.
            let started = platform::start(&studio.session(), sky, &Progress::none(), move |lighting| {
                let _ = sender.send((elevation, lighting));
                context.request_repaint();
            });
            self.making = started.is_ok().then_some(receiver);
        }
        let sun = [azimuth, *known];
        match &self.shader {
            Some((of_sun, of_block, shader)) if *of_sun == sun && *of_block == block => Arc::clone(shader),
            _ => {
                let lighting = lighting.turned(azimuth);
                let data = lighting.data(1.0, [block.across, block.highest], block.cell);
                let shader = Arc::new(LightShader::new(&data));
                self.shader = Some((sun, block, Arc::clone(&shader)));
                shader
            }
        }
    }
}
