//! The share of a part of a build.

use std::collections::BTreeSet;
use std::ops::Range;

use super::job::{Job, Stage};

/// One of several parts that make a result together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The number of the part, from 1.
    pub number: usize,
    /// The number of parts.
    pub count: usize,
}

impl Part {
    /// The jobs of the first stage that this part does. Parts have the same number of jobs, or one more. The jobs of a
    /// part are adjacent, so that few samples are computed by two parts. They do not depend on threads or memory, which
    /// may differ between machines.
    pub fn jobs(self, stage: Stage) -> BTreeSet<Job> {
        let end = |number: usize| (number as u128 * stage.len() as u128 / self.count as u128) as usize;
        along_curve(stage, end(self.number - 1)..end(self.number))
    }
}

/// The jobs of the first stage at these positions along a Z-order curve, which orders the quarters of a square, the
/// quarters of each quarter, and so on.
fn along_curve(stage: Stage, positions: Range<usize>) -> BTreeSet<Job> {
    let mut jobs = BTreeSet::new();
    let mut squares = vec![(0, 0, stage.rows.max(stage.columns).next_power_of_two())];
    // The position of the next square.
    let mut position = 0;
    while let Some((top, left, side)) = squares.pop() {
        let rows = top..(top + side).min(stage.rows).max(top);
        let columns = left..(left + side).min(stage.columns).max(left);
        let end = position + rows.len() * columns.len();
        if position >= positions.start && end <= positions.end {
            let all = rows.flat_map(|row| columns.clone().map(move |column| Job { stage: 0, row, column }));
            jobs.extend(all);
        } else if end > positions.start && position < positions.end {
            let half = side / 2;
            squares.extend(
                [(half, half), (half, 0), (0, half), (0, 0)].map(|(down, across)| (top + down, left + across, half)),
            );
            continue;
        }
        position = end;
    }
    jobs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_job_belongs_to_one_part() {
        for (rows, columns) in [(1, 1), (1, 9), (7, 1), (4, 4), (5, 13), (31, 8)] {
            let stage = Stage { rows, columns, samples: 1 };
            for count in [1, 2, 3, 7, 64, 1000] {
                let parts: Vec<BTreeSet<Job>> = (1..=count).map(|number| Part { number, count }.jobs(stage)).collect();
                let all: BTreeSet<Job> = parts.iter().flatten().copied().collect();
                let sizes = parts.iter().map(BTreeSet::len);
                assert_eq!((all.len(), sizes.clone().sum()), (stage.len(), stage.len()), "{rows} {columns} {count}");
                assert!(sizes.clone().max() <= sizes.min().map(|least| least + 1));
                assert!(all.iter().all(|job| job.row < rows && job.column < columns));
            }
        }
    }

    #[test]
    fn the_jobs_of_a_part_are_adjacent() {
        let stage = Stage { rows: 16, columns: 16, samples: 1 };
        for number in 1..=16 {
            let jobs = Part { number, count: 16 }.jobs(stage);
            let [rows, columns] = [|job: &Job| job.row, |job: &Job| job.column].map(|of| {
                let all: BTreeSet<usize> = jobs.iter().map(of).collect();
                all.len()
            });
            assert_eq!([rows, columns], [4, 4]);
        }
    }
}
