//! Failures of tasks.

/// A failure, with a message for the user.
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

    /// The message.
    pub fn message(&self) -> &str {
        let (Self::Usage(message) | Self::Failed(message)) = self;
        message
    }
}

/// The result of a task.
pub type Result<T = ()> = std::result::Result<T, Failure>;

/// The failure of an operation on a file.
pub fn on_file(what: &str, path: &std::path::Path, error: &std::io::Error) -> Failure {
    Failure::new(format!("cannot {what} {}: {error}", path.display()))
}
