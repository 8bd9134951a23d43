//! Measurements of the land of a picture for comparison with real land, made outside of the thread of the user
//! interface.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use orogen::output::survey::{Land, Measures, SurveyJob};
use orogen::{Grid, Progress, Result, Session};
use serde::{Deserialize, Serialize};

use super::frame::{Frame, Key};
use super::worker::Wake;
use crate::platform::{self, Task, wire};

/// The measurements of a picture; `None` if it has too little land.
pub type Outcome = Result<Option<Measures>>;

/// Measures pictures; the next one cancels the previous one.
pub struct Survey {
    wake: Wake,
    sender: Sender<(Key, Outcome)>,
    receiver: Receiver<(Key, Outcome)>,
    asked: Option<Key>,
    running: Option<Progress>,
    outcome: Option<Outcome>,
}

impl Survey {
    /// A survey without measurements.
    #[must_use]
    pub fn new(wake: Wake) -> Survey {
        let (sender, receiver) = channel();
        Survey { wake, sender, receiver, asked: None, running: None, outcome: None }
    }

    /// Measures the heights of a picture, unless it was the last one measured. Earlier results are kept until then.
    pub fn ask(&mut self, session: &Session, frame: &Arc<Frame>) {
        let key = frame.key();
        if self.asked == Some(key) {
            return;
        }
        if let Some(running) = self.running.take() {
            running.cancel();
        }
        self.asked = Some(key);
        let progress = Progress::none();
        self.running = Some(progress.clone());
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        let land = Measuring { heights: Arc::clone(&frame.heights), sea_level: frame.sea_level };
        // The panel may already be closed.
        let started = platform::start(session, land, &progress, move |Event(outcome)| {
            let _ = sender.send((key, outcome));
            wake();
        });
        if let Err(error) = started {
            (self.running, self.outcome) = (None, Some(Err(error)));
        }
    }

    /// The latest result.
    pub fn outcome(&mut self) -> Option<&Outcome> {
        while let Ok((key, outcome)) = self.receiver.try_recv() {
            if self.asked == Some(key) {
                (self.running, self.outcome) = (None, Some(outcome));
            }
        }
        self.outcome.as_ref()
    }

    /// Whether a picture is being measured.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }
}

impl Drop for Survey {
    fn drop(&mut self) {
        if let Some(running) = self.running.take() {
            running.cancel();
        }
    }
}

/// The work of measuring heights.
#[derive(Serialize, Deserialize)]
pub struct Measuring {
    #[serde(with = "wire::shared")]
    heights: Arc<Grid>,
    sea_level: f64,
}

/// What was measured.
#[derive(Serialize, Deserialize)]
pub struct Event(#[serde(with = "wire::result")] Outcome);

impl Task for Measuring {
    const NAME: &'static str = "measures";
    type Event = Event;

    fn run(self, session: &Session, progress: &Progress, tell: &(dyn Fn(Event) + Send + Sync)) {
        tell(Event(measure(session, &self, progress)));
    }
}

fn measure(session: &Session, Measuring { heights, sea_level }: &Measuring, progress: &Progress) -> Outcome {
    let samples = heights.data().len() as u64;
    let _memory = session.budget().reserve(Measures::memory(samples).saturating_sub(4 * samples))?;
    let land = Land::in_memory(heights, Some(*sea_level as f32));
    session.install(|| SurveyJob::new(land).measure(progress))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::request::Request;
    use crate::preview::worker::{Event, Worker};
    use orogen::{Options, presets};
    use std::time::{Duration, Instant};

    #[test]
    fn a_picture_is_measured_as_by_the_job() {
        let session = Session::new(Options::default()).unwrap();
        let mut worker = Worker::new(session.clone(), Arc::new(|| ()));
        let request = Request::new(presets::find("hills").unwrap().recipe().unwrap());
        worker.ask(Request { finest: 256, ..request });
        let (begun, mut survey, mut frame) = (Instant::now(), Survey::new(Arc::new(|| ())), None);
        while survey.outcome().is_none() && begun.elapsed() < Duration::from_secs(300) {
            for event in worker.events() {
                if let Event::Frame(made) = event {
                    frame = Some(Arc::<Frame>::from(made));
                }
            }
            if let Some(frame) = frame.as_ref().filter(|_| !worker.is_busy()) {
                survey.ask(&session, frame);
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        let (frame, measured) = (frame.unwrap(), survey.outcome().unwrap().as_ref().unwrap().clone().unwrap());
        let expect = Measures::of(&frame.heights, Some(frame.sea_level as f32)).unwrap();
        assert_eq!((measured.relief, measured.slope_mean), (expect.relief, expect.slope_mean));
        assert!(!survey.is_busy());
    }
}
