//! Licences of dependencies: licences that would bind a program built with Orogen are rejected.

use std::path::Path;

use serde_json::Value;

use crate::failure::{Failure, Result};
use crate::{output, shell};

/// Accepted licences: permissive licences; MPL-2.0, which binds only its own files; and licences of data and fonts
/// that programs may contain.
const ACCEPTED: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    // Data without conditions on what is made with it: the certificates that browsers trust.
    "CDLA-Permissive-2.0",
    "ISC",
    "MIT",
    "MIT-0",
    "MPL-2.0",
    // Fonts.
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Checks every package that this workspace may be built with, optional ones included.
pub fn check() -> Result {
    check_of(None, &[])
}

/// Checks the packages of another workspace, which may have more licences, or of this one.
pub fn check_of(manifest: Option<&Path>, more: &[&str]) -> Result {
    let mut metadata = shell::cargo("metadata --all-features --format-version 1");
    metadata.args(manifest.iter().flat_map(|manifest| ["--manifest-path".as_ref(), manifest.as_os_str()]));
    let text = shell::capture(&mut metadata)?;
    let metadata: Value =
        serde_json::from_str(&text).map_err(|e| Failure::new(format!("cargo metadata printed no JSON: {e}")))?;
    let packages = metadata["packages"].as_array().map(Vec::as_slice).unwrap_or_default();
    let refused: Vec<String> = packages
        .iter()
        .filter_map(|package| {
            let licence = package["license"].as_str().unwrap_or("");
            let name = format!("{} {}", package["name"].as_str()?, package["version"].as_str()?);
            (!accepted(licence, more)).then(|| format!("  {name}: '{licence}'"))
        })
        .collect();
    if packages.is_empty() || !refused.is_empty() {
        return Err(Failure::new(format!("licences not on the accepted list:\n{}", refused.join("\n"))));
    }
    output::line(format_args!("    {} packages, every licence accepted", packages.len()));
    Ok(())
}

/// Whether an SPDX expression can be satisfied with accepted licences. `/` is the old form of OR; AND binds tighter.
fn accepted(expression: &str, more: &[&str]) -> bool {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = words.as_slice();
    either(&mut rest, more) && rest.is_empty()
}

fn either(rest: &mut &[&str], more: &[&str]) -> bool {
    let mut any = both(rest, more);
    while take(rest, "OR") {
        any |= both(rest, more);
    }
    any
}

fn both(rest: &mut &[&str], more: &[&str]) -> bool {
    let mut all = one(rest, more);
    while take(rest, "AND") {
        all &= one(rest, more);
    }
    all
}

fn one(rest: &mut &[&str], more: &[&str]) -> bool {
    if take(rest, "(") {
        let inner = either(rest, more);
        return take(rest, ")") && inner;
    }
    let Some((&name, after)) = rest.split_first() else { return false };
    *rest = after;
    if take(rest, "WITH") {
        // An exception only grants more rights.
        *rest = rest.get(1..).unwrap_or_default();
    }
    ACCEPTED.contains(&name) || more.contains(&name)
}

fn take(rest: &mut &[&str], word: &str) -> bool {
    let found = rest.first() == Some(&word);
    if found {
        *rest = &rest[1..];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::accepted;

    #[test]
    fn expressions() {
        for (expression, expect) in [
            ("MIT", true),
            ("MIT OR Apache-2.0", true),
            ("MIT/Apache-2.0", true),
            ("Apache-2.0 WITH LLVM-exception", true),
            ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
            ("MIT OR GPL-3.0-only", true),
            ("GPL-3.0-only", false),
            ("MIT AND GPL-2.0-or-later", false),
            ("AGPL-3.0", false),
            ("(MIT", false),
            ("MIT Apache-2.0", false),
            ("", false),
        ] {
            assert_eq!(accepted(expression, &[]), expect, "{expression}");
        }
        assert!(accepted("CC-BY-4.0 AND MIT", &["CC-BY-4.0"]) && !accepted("CC-BY-4.0 AND MIT", &[]));
    }
}
