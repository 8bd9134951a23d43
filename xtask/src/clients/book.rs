//! The documentation as a site, and the commands and scripts of its pages.

use std::path::PathBuf;

use super::{install, python};
use crate::book::{self, Programs};
use crate::failure::{Result, on_file};
use crate::shell;

/// Tests the program that makes the site, makes the site, and follows the pages of the tutorial, the cookbook, the
/// engines and the ops with the release build.
pub fn check() -> Result {
    shell::empty_dir(&work())?;
    // With the native part of the release build, laid out as in the wheel.
    let programs = programs();
    std::fs::create_dir_all(&programs.packages).map_err(|cause| on_file("create", &programs.packages, &cause))?;
    python::lay_out(&install::python(), &programs.packages)?;
    book::check()?;
    book::build(&work().join("site"))?;
    book::follow(&programs, &work().join("pages"))
}

/// The programs of this step; they are there after it has run.
pub fn programs() -> Programs {
    let bin = install::python().parent().map(PathBuf::from).unwrap_or_default();
    Programs { orogen: super::orogen(), bin, packages: work().join("packages") }
}

fn work() -> PathBuf {
    super::folder().join("work/book")
}
