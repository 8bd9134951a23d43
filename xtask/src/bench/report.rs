//! The results of the bench program, as a table and as JSON.

use serde_json::{Map, Value, json};

use crate::failure::{Failure, Result};
use crate::host;

/// The columns of the table.
pub const HEAD: [&str; 7] = ["case", "ours", "unit", "peer", "theirs", "ratio", "target"];

/// The figures of an area, with the machine.
pub struct Report {
    area: String,
    rows: Vec<Map<String, Value>>,
    simd: String,
    threads: u64,
    date: String,
    processor: String,
}

impl Report {
    /// Parses the output of the bench program: {"area", "simd", "threads", "rows"}.
    pub fn read(text: &str) -> Result<Self> {
        let value: Value =
            serde_json::from_str(text).map_err(|e| Failure::new(format!("the bench printed no JSON: {e}")))?;
        let rows = value["rows"].as_array().map(Vec::as_slice).unwrap_or_default();
        let rows: Vec<Map<String, Value>> = rows.iter().filter_map(Value::as_object).cloned().collect();
        if rows.is_empty() {
            return Err(Failure::new("the bench measured nothing: no case has that name"));
        }
        Ok(Self {
            area: value["area"].as_str().unwrap_or("?").to_owned(),
            rows,
            simd: value["simd"].as_str().unwrap_or("?").to_owned(),
            threads: value["threads"].as_u64().unwrap_or(0),
            date: host::date(),
            processor: host::processor(),
        })
    }

    /// The line above the table.
    pub fn heading(&self) -> String {
        let threads = if self.threads == 1 { "thread" } else { "threads" };
        format!(
            "{}: {}, {}, SIMD level {}, {} {threads}\n",
            self.area, self.date, self.processor, self.simd, self.threads
        )
    }

    /// The table's cells. A case is named only at its first peer.
    pub fn cells(&self) -> Vec<Vec<String>> {
        let mut last = "";
        let mut rows = Vec::new();
        for row in &self.rows {
            let case = row.get("case").and_then(Value::as_str).unwrap_or("?");
            let again = std::mem::replace(&mut last, case) == case;
            let once = |text: String| if again { String::new() } else { text };
            let built = row.get("ours").is_some_and(Value::is_number);
            let target = match (row.get("target"), row.get("met").and_then(Value::as_bool)) {
                (Some(target), Some(true)) => format!("{} met", number(Some(target))),
                (Some(target), Some(false)) if !built => format!("{} not built", number(Some(target))),
                (Some(target), Some(false)) => format!("{} MISSED", number(Some(target))),
                _ => "-".to_owned(),
            };
            rows.push(vec![
                once(case.to_owned()),
                once(number(row.get("ours"))),
                once(row.get("unit").and_then(Value::as_str).unwrap_or("").to_owned()),
                row.get("peer").and_then(Value::as_str).unwrap_or("-").to_owned(),
                number(row.get("peer_value")),
                number(row.get("ratio")),
                target,
            ]);
        }
        rows
    }

    /// The whole report as JSON.
    pub fn json(&self) -> String {
        let value = json!({
            "area": self.area,
            "date": self.date,
            "processor": self.processor,
            "simd": self.simd,
            "threads": self.threads,
            "rows": self.rows,
        });
        format!("{value:#}\n")
    }
}

/// Three significant digits.
fn number(value: Option<&Value>) -> String {
    let Some(x) = value.and_then(Value::as_f64) else { return "-".to_owned() };
    let places = match x.abs() {
        x if x >= 100.0 => 0,
        x if x >= 10.0 => 1,
        _ => 2,
    };
    format!("{x:.places$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table;

    fn report() -> Report {
        let text = r#"{"area":"noise","simd":"avx2","threads":1,"rows":[
            {"case":"perlin","ours":2211.7,"unit":"Mpt/s","peer":"a","peer_value":40.0,"ratio":55.3,"target":42.0,"met":true},
            {"case":"perlin","ours":2211.7,"unit":"Mpt/s","peer":"b","peer_value":80.0,"ratio":27.6,"target":null,"met":null},
            {"case":"white","ours":4000.0,"unit":"Mpt/s","peer":null,"peer_value":null,"ratio":null,"target":5000,"met":false},
            {"case":"worley","ours":null,"unit":"Mpt/s","peer":"a","peer_value":null,"ratio":null,"target":50,"met":false}]}"#;
        let mut report = Report::read(text).expect("well formed");
        report.date = "2026-01-02".into();
        report.processor = "A Processor".into();
        report
    }

    #[test]
    fn as_a_table() {
        let report = report();
        assert_eq!(report.heading(), "noise: 2026-01-02, A Processor, SIMD level avx2, 1 thread\n");
        let expect = "\
case    ours  unit   peer  theirs  ratio  target
------  ----  -----  ----  ------  -----  --------------
perlin  2212  Mpt/s  a       40.0   55.3  42.0 met
                     b       80.0   27.6  -
white   4000  Mpt/s  -          -      -  5000 MISSED
worley     -  Mpt/s  a          -      -  50.0 not built";
        assert_eq!(table::render(&HEAD, &report.cells()), expect);
    }

    #[test]
    fn as_json() {
        let value: Value = serde_json::from_str(&report().json()).expect("JSON");
        assert_eq!(value["area"], "noise");
        assert_eq!(value["processor"], "A Processor");
        let keys: Vec<&String> = value["rows"][0].as_object().expect("a row").keys().collect();
        assert_eq!(keys, ["case", "met", "ours", "peer", "peer_value", "ratio", "target", "unit"]);
    }

    #[test]
    fn nothing_measured_is_an_error() {
        assert!(Report::read("").is_err() && Report::read(r#"{"rows":[]}"#).is_err());
    }
}
