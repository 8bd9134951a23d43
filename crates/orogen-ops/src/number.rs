//! Serialization of numbers in stored plans. Formats such as JSON have no infinity and NaN, so these become text.

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serializer};
use std::fmt;

pub(super) fn serialize<S: Serializer>(number: &f32, serializer: S) -> Result<S::Ok, S::Error> {
    match number.is_finite() || !serializer.is_human_readable() {
        true => serializer.serialize_f32(*number),
        false => serializer.collect_str(number),
    }
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    match deserializer.is_human_readable() {
        true => deserializer.deserialize_any(Number),
        false => f32::deserialize(deserializer),
    }
}

struct Number;

impl Visitor<'_> for Number {
    type Value = f32;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a number, \"inf\", \"-inf\" or \"NaN\"")
    }

    fn visit_f64<E>(self, number: f64) -> Result<f32, E> {
        Ok(number as f32)
    }

    fn visit_i64<E>(self, number: i64) -> Result<f32, E> {
        Ok(number as f32)
    }

    fn visit_u64<E>(self, number: u64) -> Result<f32, E> {
        Ok(number as f32)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<f32, E> {
        match text {
            "inf" => Ok(f32::INFINITY),
            "-inf" => Ok(f32::NEG_INFINITY),
            "NaN" => Ok(f32::NAN),
            _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::program::Operand;

    #[test]
    fn numbers_of_every_kind_are_read_again() {
        for (number, text) in [
            (0.1, "{\"Number\":0.1}"),
            (-3.0, "{\"Number\":-3.0}"),
            (f32::INFINITY, "{\"Number\":\"inf\"}"),
            (f32::NEG_INFINITY, "{\"Number\":\"-inf\"}"),
            (f32::NAN, "{\"Number\":\"NaN\"}"),
        ] {
            assert_eq!(serde_json::to_string(&Operand::Number(number)).unwrap(), text);
            let Operand::Number(read) = serde_json::from_str(text).unwrap() else { panic!("a number") };
            assert!(read == number || read.is_nan() && number.is_nan(), "{text}: {read}");
        }
        assert!(matches!(serde_json::from_str("{\"Number\":7}").unwrap(), Operand::Number(7.0)));
        let error = serde_json::from_str::<Operand>("{\"Number\":\"1\"}").unwrap_err().to_string();
        assert!(error.contains("expected a number, \"inf\""), "{error}");
    }
}
