//! The choice of the device that computes windows, as written on command lines.

use std::fmt;
use std::str::FromStr;

/// The device that computes windows.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// The processor: `cpu`.
    #[default]
    Processor,
    /// A graphics card if there is one, otherwise the processor: `auto`.
    Auto,
    /// A graphics card: any one (`gpu`), or the one with this number or with this text in its name (`gpu:NAME`). If
    /// there is no such card, the processor is used.
    Card(Option<String>),
}

impl FromStr for DeviceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<DeviceChoice, String> {
        match text.split_once(':') {
            None if text == "cpu" => Ok(DeviceChoice::Processor),
            None if text == "auto" => Ok(DeviceChoice::Auto),
            None if text == "gpu" => Ok(DeviceChoice::Card(None)),
            Some(("gpu", name)) if !name.trim().is_empty() => Ok(DeviceChoice::Card(Some(name.trim().to_string()))),
            _ => Err("use cpu, gpu, gpu:NAME or auto".to_string()),
        }
    }
}

impl fmt::Display for DeviceChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DeviceChoice::Processor => f.write_str("cpu"),
            DeviceChoice::Auto => f.write_str("auto"),
            DeviceChoice::Card(None) => f.write_str("gpu"),
            DeviceChoice::Card(Some(name)) => write!(f, "gpu:{name}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_are_written_as_they_are_read() {
        for text in ["cpu", "auto", "gpu", "gpu:llvm", "gpu:0"] {
            assert_eq!(text.parse::<DeviceChoice>().unwrap().to_string(), text);
        }
        for text in ["", "gpu:", "gpu: ", "cuda", "cpu:0", "GPU"] {
            assert!(text.parse::<DeviceChoice>().is_err(), "{text}");
        }
    }
}
