//! A survey as one job: what is measured, and what it may use.

use std::path::PathBuf;

use super::land::Land;
use super::measures::Measures;
use super::water;
use orogen_engine::budget::Budget;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;

/// The measuring of a piece of land. Land on disk has the numbers of land in memory, to the bit, and needs little
/// memory.
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct SurveyJob<'a> {
    /// The land.
    pub land: Land<'a>,
    /// The folder for temporary rasters of land on disk; by default the system's.
    pub scratch: PathBuf,
    /// The budget from which the memory of the rivers of land on disk is reserved; unlimited by default.
    pub budget: Budget,
}

impl<'a> SurveyJob<'a> {
    /// The measuring of this land.
    pub fn new(land: Land<'a>) -> SurveyJob<'a> {
        SurveyJob { land, scratch: std::env::temp_dir(), budget: Budget::of(None) }
    }

    /// The same with temporary rasters in this folder.
    pub fn with_scratch(self, scratch: impl Into<PathBuf>) -> SurveyJob<'a> {
        SurveyJob { scratch: scratch.into(), ..self }
    }

    /// The same within this budget.
    pub fn with_budget(self, budget: Budget) -> SurveyJob<'a> {
        SurveyJob { budget, ..self }
    }

    /// Measures the land. Samples at or below the sea level, if there is one, are not land and are ignored. `None` if
    /// fewer than 64 x 64 samples or less than 1 % of them are land, or all of it is level.
    ///
    /// # Errors
    /// If the work is cancelled; for land on disk also if the disk fails or the rivers do not fit in the budget.
    pub fn measure(&self, progress: &Progress) -> Result<Option<Measures>> {
        Measures::made(&self.land, progress, &|land, progress| match land.is_on_disk() {
            true => water::measure_on_disk(land, &self.scratch, &self.budget, progress),
            false => water::measure(&land.rows(0..land.window().height)?, progress),
        })
    }
}

impl Measures {
    /// Measures heights in memory; see [`SurveyJob::measure`], which also has progress and cancellation.
    #[must_use]
    pub fn of(heights: &Grid, sea_level: Option<f32>) -> Option<Measures> {
        SurveyJob::new(Land::in_memory(heights, sea_level)).measure(&Progress::none()).ok().flatten()
    }
}
