//! How a chore ends when it does not end well.

/// What went wrong, as a message for the person at the terminal.
#[derive(Debug)]
pub enum Failure {
    /// The command line was wrong: exit code 2.
    Usage(String),
    /// A check or a tool failed: exit code 1.
    Failed(String),
}

impl Failure {
    /// A failed check or tool.
    pub fn new(message: impl Into<String>) -> Self {
        Self::Failed(message.into())
    }

    /// A wrong command line.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(format!("error: {}", message.into()))
    }

    /// The message alone.
    pub fn message(&self) -> &str {
        let (Self::Usage(message) | Self::Failed(message)) = self;
        message
    }
}

/// The result of a chore.
pub type Result<T = ()> = std::result::Result<T, Failure>;

/// The failure of something done to a file.
pub fn on_file(what: &str, path: &std::path::Path, error: &std::io::Error) -> Failure {
    Failure::new(format!("cannot {what} {}: {error}", path.display()))
}
