//! Writing files: atomically, and only over what may be replaced.
//!
//! [`write_whole`] writes under a temporary name beside the target, syncs it, renames it over the target and syncs the folder.
//! Whoever looks at the target sees the old file or the new one, never a half; after any failure the old file is still there
//! and the temporary one is gone. [`stage`] does all but the rename, for files that belong together: stage them all, then
//! [`commit`] them, and a disk that fills up half way leaves the old set complete. [`check_folder`] finds out early
//! whether there is any point in starting.
//!
//! All of them write to an [`Output`], and only an [`OutputPolicy`] makes one: it refuses a file that the work reads, a recipe that a
//! person wrote, and a file of another kind than the one that is written. It does so when the output is made, before the work begins, and
//! again when the file is put in its place.
//!
//! What the target may already be:
//!
//! - *a file*: replaced if the policy allows it, keeping its permissions; one marked read-only is left alone and refused.
//! - *a link*: what it names is replaced and the link stays, as an ordinary write would do. A link to nothing is refused.
//! - *a folder*: refused.
//! - *a pipe or a device* (`/dev/null`): cannot be replaced without destroying it, so it is written straight through.

mod atomic;
mod identity;
mod kind;
pub mod mark;
mod policy;
mod temporary;

pub use atomic::{Staged, check_folder, commit, explain, stage, write_whole};
pub use policy::{Existing, Output, OutputPolicy};

#[doc(hidden)]
pub use atomic::{folder, replace_whole, sync_folder};
pub(crate) use temporary::Temporary;
#[doc(hidden)]
pub use temporary::sweep;
