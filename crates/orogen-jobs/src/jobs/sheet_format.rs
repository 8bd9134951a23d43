//! The kinds of files of a map sheet.

use std::path::Path;

/// The kind of file of a map sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SheetFormat {
    /// A picture.
    Png,
    /// A vector drawing.
    Svg,
    /// A PDF page.
    Pdf,
}

impl SheetFormat {
    /// All kinds.
    pub const ALL: [SheetFormat; 3] = [SheetFormat::Png, SheetFormat::Svg, SheetFormat::Pdf];

    /// Its name, which is also its file extension.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            SheetFormat::Png => "png",
            SheetFormat::Svg => "svg",
            SheetFormat::Pdf => "pdf",
        }
    }

    /// What it is, in a word or two.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            SheetFormat::Png => "Picture",
            SheetFormat::Svg => "Vector drawing",
            SheetFormat::Pdf => "PDF page",
        }
    }

    /// The kind for a path's extension.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<SheetFormat> {
        let extension = path.extension()?;
        SheetFormat::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.name()))
    }
}
