//! The sets of packages that cargo compiles for the checks. Both sets use the same features of shared packages, so that
//! no package is compiled twice.

/// The whole workspace; the studio without its window, no graphics card, and no object stores.
pub const LIBRARIES: &str = "--workspace --exclude orogen-gpu --exclude orogen-remote --no-default-features";

/// The studio with its window, graphics cards, and the command line with `--device`.
pub const WINDOW: &str = "--package orogen-features --package orogen-gpu --package orogen-studio --package orogen-cli \
    --features orogen-studio/kittest,orogen-cli/gpu";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell;
    use std::collections::{BTreeMap, BTreeSet};

    /// Packages that have other features in [`WINDOW`] on purpose. The test of the header for C compiles `syn` once
    /// more.
    const OTHERS: [&str; 4] = ["orogen", "orogen-cli", "orogen-studio", "syn"];

    /// The features of each package of a set: several, if it is compiled several times.
    fn features(set: &str) -> BTreeMap<String, BTreeSet<String>> {
        let mut tree = shell::cargo(&format!("tree --locked {set} --edges normal,build,dev --prefix none"));
        let text = shell::capture(tree.args(["--format", "{p}|{f}"])).expect("cargo lists packages");
        let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        // Other lines separate the packages of the set.
        for (package, features) in text.lines().filter_map(|line| line.trim_end_matches(" (*)").split_once('|')) {
            let mut words = package.split(' ');
            let package = [words.next(), words.next()].map(|word| word.unwrap_or_default()).join(" ");
            found.entry(package).or_default().insert(features.to_owned());
        }
        found
    }

    #[test]
    fn shared_packages_have_the_same_features_in_both_sets() {
        let (libraries, window) = (features(LIBRARIES), features(WINDOW));
        assert!(libraries.len() > 50 && window.len() > libraries.len());
        let differ: Vec<String> = libraries
            .iter()
            .filter_map(|(package, features)| Some((package, features, window.get(package)?)))
            .filter(|(package, features, others)| {
                !OTHERS.contains(&package.split(' ').next().unwrap_or_default()) && !features.is_subset(others)
            })
            .map(|(package, features, others)| format!("{package}: {features:?}, with the window {others:?}"))
            .collect();
        assert!(differ.is_empty(), "add their features to xtask/features/Cargo.toml:\n{}", differ.join("\n"));
    }
}
