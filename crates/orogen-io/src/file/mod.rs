//! Writing files: atomically, and only over files that may be replaced.
//!
//! [`write_whole`] writes a temporary file in the folder of the target, syncs it, renames it over the target and syncs
//! the folder. Readers of the target see either the old file or the new one. After any failure the old file still
//! exists and the temporary one is removed. [`stage`] does everything except the rename, for files that belong
//! together: stage them all, then [`commit`] them. If the disk fills up, the old set stays complete. [`check_folder`]
//! checks early whether files can be written.
//!
//! All of them write to an [`Output`], which only an [`OutputPolicy`] creates. The policy never replaces a file that
//! the work reads, a recipe written by hand, or a file of another kind than the new one. It checks this when the output
//! is created, before the work begins, and again when the file is put in place.
//!
//! Existing targets:
//!
//! - *a file*: replaced if the policy allows it; its permissions are kept. A read-only file is an error.
//! - *a link*: the file that it refers to is replaced and the link stays, as with an ordinary write. A dangling link is
//!   an error.
//! - *a folder*: an error.
//! - *a pipe or a device* (`/dev/null`): written directly, because it cannot be replaced.

mod atomic;
#[doc(hidden)]
pub mod cancellable;
mod identity;
mod kind;
#[doc(hidden)]
pub mod mark;
mod output_folder;
mod policy;

pub use atomic::{Staged, check_folder, commit, explain, stage, write_whole};
pub use output_folder::OutputFolder;
pub use policy::{Existing, Output, OutputPolicy};

#[doc(hidden)]
pub use atomic::{replace_unsynced, replace_whole, sync_folder};
#[doc(hidden)]
pub use orogen_codec::fs::folder;
pub(crate) use orogen_codec::temporary::Temporary;
#[doc(hidden)]
pub use orogen_codec::temporary::sweep;
