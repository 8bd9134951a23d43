//! `--device`: where windows of terrain are computed.

use std::fmt;

use orogen::device_choice::DeviceChoice;
use orogen::{Budget, Recipe, Session, World};

use crate::failure::Failure;
use crate::options::Limits;
use crate::say;

/// Where windows are computed.
#[derive(Debug, Clone, clap::Args)]
pub struct DeviceOption {
    /// Where the terrain is computed: cpu, gpu (the first graphics card; gpu:NAME or gpu:NUMBER for another one of
    /// `orogen devices`), or auto (a graphics card if there is one). A graphics card computes a preview: close to the
    /// processor's terrain, but not bit for bit the same
    #[arg(long, value_name = "DEVICE", default_value = "cpu")]
    device: DeviceChoice,
}

impl DeviceOption {
    /// Opens the world of a recipe, on the device if it can be used. If it cannot, the CPU is used, and a line on
    /// standard error says why.
    pub fn open(&self, limits: &Limits, recipe: Recipe, budget: &Budget) -> Result<(World, Card), Failure> {
        let session = Session::new(limits.options(budget))?;
        let card = Card::open(&self.device, budget)?;
        let session = card.session(session);
        Ok((session.open(recipe)?, card))
    }
}

/// Reports why the CPU is used instead of the requested device.
fn stands_in(why: impl fmt::Display) {
    say::error(&format!("{why}; the processor computes instead"));
}

#[cfg(feature = "gpu")]
pub use with_gpu::Card;

#[cfg(feature = "gpu")]
mod with_gpu {
    use super::stands_in;
    use crate::failure::Failure;
    use orogen::budget::Reservation;
    use orogen::device_choice::DeviceChoice;
    use orogen::gpu::Gpu;
    use orogen::output::render::device::RenderDevice;
    use orogen::{Budget, Session};
    use std::sync::Arc;

    /// An opened graphics card, if there is one.
    pub struct Card {
        gpu: Option<Gpu>,
        /// The memory of its buffers, which may be shared with the CPU.
        _buffers: Option<Reservation>,
    }

    /// Divisor of the memory limit for one buffer, and the number of buffers that exist at the same time.
    const SHARE: u64 = 8;
    const BUFFERS: u64 = 3;

    impl Card {
        pub(super) fn open(choice: &DeviceChoice, budget: &Budget) -> Result<Card, Failure> {
            let most = budget.limit().map(|limit| limit / SHARE);
            let gpu = Gpu::chosen(choice, most).unwrap_or_else(|failure| {
                stands_in(failure);
                None
            });
            let reserved =
                gpu.as_ref().zip(most).map(|(gpu, most)| budget.reserve(BUFFERS * most.min(gpu.buffer_limit())));
            Ok(Card { gpu, _buffers: reserved.transpose()? })
        }

        pub(super) fn session(&self, session: Session) -> Session {
            match &self.gpu {
                Some(gpu) => session.with_device(Arc::new(gpu.clone())),
                None => session,
            }
        }

        /// The device for painting pictures, if there is a card.
        pub fn render_device(&self) -> Option<Arc<dyn RenderDevice>> {
            self.gpu.as_ref().map(|gpu| Arc::new(gpu.clone()) as Arc<dyn RenderDevice>)
        }

        /// The card's name, if it computed something; a failure is reported after the work.
        pub fn used(&self) -> Option<String> {
            self.used_with(None)
        }

        /// Like [`used`](Card::used), after work that the card may have refused.
        pub fn used_with(&self, refused: Option<&str>) -> Option<String> {
            let gpu = self.gpu.as_ref()?;
            match (refused, gpu.failure()) {
                (Some(why), _) => stands_in(why),
                (None, Some(failure)) => stands_in(failure),
                (None, None) => {}
            }
            Some(gpu.adapter().to_string())
        }
    }
}

#[cfg(not(feature = "gpu"))]
pub use without_gpu::Card;

#[cfg(not(feature = "gpu"))]
mod without_gpu {
    use super::stands_in;
    use crate::failure::Failure;
    use orogen::device_choice::DeviceChoice;
    use orogen::output::render::device::RenderDevice;
    use orogen::{Budget, Session};
    use std::sync::Arc;

    /// No graphics card: this program was built without support for them.
    pub struct Card;

    impl Card {
        pub(super) fn open(choice: &DeviceChoice, _: &Budget) -> Result<Card, Failure> {
            if matches!(choice, DeviceChoice::Card(_)) {
                stands_in(
                    "this program was built without graphics cards (`cargo build --release --features gpu` builds it with them)",
                );
            }
            Ok(Card)
        }

        pub(super) fn session(&self, session: Session) -> Session {
            session
        }

        /// The device for painting pictures: none, so the CPU paints.
        pub fn render_device(&self) -> Option<Arc<dyn RenderDevice>> {
            None
        }

        /// The card's name, if it computed something: never.
        pub fn used(&self) -> Option<String> {
            None
        }

        /// Like [`used`](Card::used), after work that a card may have refused.
        pub fn used_with(&self, _: Option<&str>) -> Option<String> {
            None
        }
    }
}
