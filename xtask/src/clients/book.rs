//! The documentation as a site, and the commands and scripts of its pages.

use std::path::PathBuf;

use super::{install, python};
use crate::book;
use crate::failure::Result;
use crate::shell;

/// Tests the program that makes the site, makes the site, and follows the pages of the tutorial, the cookbook and the
/// engines with the release build.
pub fn check() -> Result {
    book::check()?;
    let work = super::folder().join("work/book");
    shell::empty_dir(&work)?;
    book::build(&work.join("site"))?;
    // The packages of scripts: the native part of the release build, laid out as in the wheel.
    let packages = work.join("packages");
    std::fs::create_dir_all(&packages).map_err(|cause| crate::failure::on_file("create", &packages, &cause))?;
    python::lay_out(&install::python(), &packages)?;
    let bin = install::python().parent().map(PathBuf::from);
    book::follow(&super::orogen(), &work.join("pages"), bin.as_deref(), &packages)
}
