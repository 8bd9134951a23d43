//! Date and machine of a measurement or a check.

use std::time::{SystemTime, UNIX_EPOCH};

use crate::shell;

/// Today in UTC, in days after 1970-01-01.
pub fn today() -> i64 {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    i64::try_from(seconds / 86_400).unwrap_or(0)
}

/// Today in UTC, as year-month-day.
pub fn date() -> String {
    shown(today())
}

/// The days after 1970-01-01 of a date written as year-month-day.
pub fn parse_date(text: &str) -> Option<i64> {
    let mut parts = text.split('-').map(|part| part.parse::<i64>().ok());
    let [year, month, _] = [parts.next()??, parts.next()??, parts.next()??];
    // A day around the previous month, at most two months before the date.
    let about = (year - 1970) * 365 + (month - 2) * 30;
    (about..about + 200).find(|day| shown(*day) == text)
}

fn shown(days: i64) -> String {
    let (year, month, day) = civil(days);
    format!("{year:04}-{month:02}-{day:02}")
}

/// The name of the processor.
pub fn processor() -> String {
    let linux = || {
        let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
        let line = text.lines().find(|l| l.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let mac = || shell::capture(shell::program("sysctl").args(["-n", "machdep.cpu.brand_string"])).ok();
    let windows = || std::env::var("PROCESSOR_IDENTIFIER").ok();
    let name = if cfg!(target_os = "macos") { mac() } else { linux().or_else(windows) };
    name.map_or_else(|| format!("unnamed {}", std::env::consts::ARCH), |n| n.trim().to_owned())
}

/// The Gregorian date of a number of days after 1970-01-01. Years are counted from March, which puts the leap day last:
/// the days before a month are then a straight line rounded down.
fn civil(days: i64) -> (i64, i64, i64) {
    let days = days + 719_468; // since 0000-03-01
    let era = days.div_euclid(146_097); // 400 years each
    let of_era = days.rem_euclid(146_097);
    let year_of_era = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    (era * 400 + year_of_era + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::{civil, parse_date};

    #[test]
    fn dates_go_both_ways() {
        for (text, days) in [("1970-01-01", 0), ("2026-12-31", 20_818), ("2100-02-28", 47_540), ("2100-03-01", 47_541)]
        {
            assert_eq!(parse_date(text), Some(days), "{text}");
        }
        for text in ["", "2026", "2026-02-30", "2026-1-1", "2026-13-01", "a-b-c"] {
            assert_eq!(parse_date(text), None, "{text}");
        }
    }

    #[test]
    fn known_days() {
        for (days, expect) in [
            (0, (1970, 1, 1)),
            (58, (1970, 2, 28)),
            (59, (1970, 3, 1)),
            (11_016, (2000, 2, 29)),
            (20_454, (2026, 1, 1)),
            (20_818, (2026, 12, 31)),
            (47_540, (2100, 2, 28)),
            (47_541, (2100, 3, 1)),
        ] {
            assert_eq!(civil(days), expect, "day {days}");
        }
    }
}
