//! `--device`: where windows of terrain are computed.

use std::fmt;
use std::str::FromStr;

use orogen::{Budget, Recipe, Session, World};

use crate::failure::Failure;
use crate::options::Limits;
use crate::say;

/// Where windows are computed.
#[derive(Debug, Clone, clap::Args)]
pub struct DeviceOption {
    /// Where the terrain is computed: cpu, gpu (the first graphics card; gpu:NAME or gpu:NUMBER for another one of `orogen devices`), or auto (a graphics card
    /// if there is one). A graphics card makes a preview: close to the processor's terrain, but not the same bits
    #[arg(long, value_name = "DEVICE", default_value = "cpu")]
    device: Wanted,
}

/// The device that is asked for.
#[derive(Debug, Clone, PartialEq)]
enum Wanted {
    /// The processor.
    Cpu,
    /// A graphics card if there is one; nothing is said otherwise.
    Auto,
    /// A graphics card, or the one with this name or number.
    Gpu(Option<String>),
}

impl FromStr for Wanted {
    type Err = String;

    fn from_str(text: &str) -> Result<Wanted, String> {
        match text.split_once(':') {
            None if text == "cpu" => Ok(Wanted::Cpu),
            None if text == "auto" => Ok(Wanted::Auto),
            None if text == "gpu" => Ok(Wanted::Gpu(None)),
            Some(("gpu", name)) if !name.trim().is_empty() => Ok(Wanted::Gpu(Some(name.trim().to_string()))),
            _ => Err("use cpu, gpu, gpu:NAME or auto".to_string()),
        }
    }
}

impl fmt::Display for Wanted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Wanted::Cpu => f.write_str("cpu"),
            Wanted::Auto => f.write_str("auto"),
            Wanted::Gpu(None) => f.write_str("gpu"),
            Wanted::Gpu(Some(name)) => write!(f, "gpu:{name}"),
        }
    }
}

impl DeviceOption {
    /// Opens the world of a recipe, with the device if it can be used. If it cannot, the processor stands in, and a line on standard error says why.
    pub fn open(&self, limits: &Limits, recipe: Recipe, budget: &Budget) -> Result<(World, Card), Failure> {
        let session = Session::new(limits.options(budget))?;
        let card = Card::open(&self.device);
        let session = card.session(session);
        Ok((session.open(recipe)?, card))
    }
}

/// Says why the processor computes in place of the device that was asked for.
fn stands_in(why: impl fmt::Display) {
    say::error(&format!("{why}; the processor computes instead"));
}

#[cfg(feature = "gpu")]
pub use with_gpu::Card;

#[cfg(feature = "gpu")]
mod with_gpu {
    use super::{Wanted, stands_in};
    use orogen::Session;
    use orogen::gpu::gpu::Options;
    use orogen::gpu::{Choice, Gpu};
    use std::sync::Arc;

    /// An opened graphics card, if there is one.
    pub struct Card(Option<Gpu>);

    impl Card {
        pub(super) fn open(wanted: &Wanted) -> Card {
            let choice = match wanted {
                Wanted::Cpu => return Card(None),
                Wanted::Auto => Choice::Card,
                Wanted::Gpu(None) => Choice::Any,
                Wanted::Gpu(Some(name)) => Choice::Named(name.clone()),
            };
            match Gpu::open(&Options::new(choice)) {
                Ok(gpu) => Card(Some(gpu)),
                Err(failure) => {
                    if *wanted != Wanted::Auto {
                        stands_in(failure);
                    }
                    Card(None)
                }
            }
        }

        pub(super) fn session(&self, session: Session) -> Session {
            match &self.0 {
                Some(gpu) => session.with_device(Arc::new(gpu.clone())),
                None => session,
            }
        }

        /// The card's name, if it computed; a failure is told, once the work is done.
        pub fn used(&self) -> Option<String> {
            let gpu = self.0.as_ref()?;
            if let Some(failure) = gpu.failure() {
                stands_in(failure);
            }
            Some(gpu.adapter().to_string())
        }
    }
}

#[cfg(not(feature = "gpu"))]
pub use without_gpu::Card;

#[cfg(not(feature = "gpu"))]
mod without_gpu {
    use super::{Wanted, stands_in};
    use orogen::Session;

    /// No graphics card: this program was built without support for them.
    pub struct Card;

    impl Card {
        pub(super) fn open(wanted: &Wanted) -> Card {
            if matches!(wanted, Wanted::Gpu(_)) {
                stands_in(
                    "this program was built without graphics cards (`cargo build --release --features gpu` builds it with them)",
                );
            }
            Card
        }

        pub(super) fn session(&self, session: Session) -> Session {
            session
        }

        /// The card's name, if it computed.
        pub fn used(&self) -> Option<String> {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_are_written_as_they_are_read() {
        for text in ["cpu", "auto", "gpu", "gpu:llvm", "gpu:0"] {
            assert_eq!(text.parse::<Wanted>().unwrap().to_string(), text);
        }
        for text in ["", "gpu:", "gpu: ", "cuda", "cpu:0", "GPU"] {
            assert!(text.parse::<Wanted>().is_err(), "{text}");
        }
    }
}
