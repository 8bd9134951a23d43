//! Every link of the site leads to something in it, and nothing is loaded from another host.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail, ensure};

use crate::places::{folder, resolved};
use crate::stage::read;

/// What was checked.
pub struct Count {
    pub pages: usize,
    pub links: usize,
}

/// Attributes with an address, of every element.
const ATTRIBUTES: [&str; 2] = [" href=\"", " src=\""];

/// Checks the site in a folder.
pub fn site(out: &Path) -> Result<Count> {
    let mut files = BTreeSet::new();
    list(out, "", &mut files)?;
    let pages: Vec<&String> = files.iter().filter(|file| file.ends_with(".html") && !has_no_place(file)).collect();
    ensure!(pages.len() > 20, "{} has only {} pages", out.display(), pages.len());
    for folder in ["", "zh-CN/"] {
        let starts = format!("{folder}searchindex-");
        ensure!(files.iter().any(|file| file.starts_with(&starts)), "{folder} has no search index");
    }
    let mut anchors: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for page in &files {
        if page.ends_with(".html") {
            anchors.insert(page.clone(), ids(&read(&out.join(page))?));
        }
    }
    let (mut faults, mut count) = (Vec::new(), Count { pages: pages.len(), links: 0 });
    for page in &pages {
        let text = read(&out.join(page))?;
        for (element, target) in links(&text) {
            count.links += 1;
            if let Err(error) = link(page, element, &target, &files, &anchors) {
                faults.push(format!("  {page}: <{element}> {target}: {error}"));
            }
        }
    }
    for file in files.iter().filter(|file| file.ends_with(".css")) {
        let text = read(&out.join(file))?;
        if ["url(http", "url(\"http", "url('http", "@import"].iter().any(|far| text.contains(far)) {
            faults.push(format!("  {file} loads something from another host"));
        }
    }
    match faults.is_empty() {
        true => Ok(count),
        false => bail!("faults of the site:\n{}", faults.join("\n")),
    }
}

/// Whether a page is one that a server shows for addresses without a page, wherever they are: its links have no place.
fn has_no_place(page: &str) -> bool {
    page.ends_with("404.html")
}

/// Checks a link of a page.
fn link(
    page: &str,
    element: &str,
    target: &str,
    files: &BTreeSet<String>,
    anchors: &BTreeMap<String, BTreeSet<String>>,
) -> Result<()> {
    if target.starts_with("data:") {
        return Ok(());
    }
    if let Some((scheme, _)) = target.split_once("://") {
        ensure!(element == "a", "loads something from another host");
        ensure!(scheme == "https", "is no https link");
        return Ok(());
    }
    // The studio stands beside this site. What it opens is part of this site.
    if let Some((_, query)) = target.split_once("studio/?") {
        let (key, value) = query.split_once('=').context("has no value")?;
        return match key {
            "preset" => Ok(()),
            "open" => {
                let file = value.strip_prefix("../book/").context("is not in this site")?;
                ensure!(files.contains(file), "{file} does not exist");
                Ok(())
            }
            _ => bail!("the studio has no key {key}"),
        };
    }
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    let file = match path {
        "" => page.to_owned(),
        path => resolved(folder(page), path)?,
    };
    ensure!(files.contains(&file), "{file} does not exist");
    if let (false, Some(ids)) = (anchor.is_empty(), anchors.get(&file)) {
        ensure!(ids.contains(anchor), "{file} has no such heading");
    }
    Ok(())
}

/// The names of elements and the targets of their links.
fn links(html: &str) -> Vec<(&str, String)> {
    let mut found = Vec::new();
    for part in html.split('<').skip(1) {
        let tag = part.split('>').next().unwrap_or_default();
        let element = tag.split_whitespace().next().unwrap_or_default();
        for attribute in ATTRIBUTES {
            if let Some((_, rest)) = tag.split_once(attribute) {
                let target = rest.split('"').next().unwrap_or_default();
                found.push((element, target.replace("&amp;", "&")));
            }
        }
    }
    found
}

/// The anchors of a page.
fn ids(html: &str) -> BTreeSet<String> {
    let attribute = |name: &str| {
        html.split(name).skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned).collect::<Vec<_>>()
    };
    [" id=\"", " name=\""].into_iter().flat_map(attribute).collect()
}

/// Lists the files below a folder by their paths with slashes.
fn list(folder: &Path, path: &str, files: &mut BTreeSet<String>) -> Result<()> {
    for entry in std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let entry = entry?;
        let (name, at): (String, PathBuf) = (format!("{path}{}", entry.file_name().to_string_lossy()), entry.path());
        match at.is_dir() {
            true => list(&at, &format!("{name}/"), files)?,
            false => drop(files.insert(name)),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_that_lead_nowhere_are_found() {
        let files: BTreeSet<String> = ["a/b.html", "a/c.png", "a/r.toml"].map(str::to_owned).into();
        let anchors = BTreeMap::from([("a/b.html".to_owned(), ids("<h1 id=\"here\">"))]);
        let check = |element: &str, target: &str| link("a/b.html", element, target, &files, &anchors).is_ok();
        assert!(check("a", "#here") && check("img", "c.png") && check("a", "../a/b.html#here"));
        assert!(check("a", "https://doi.org/10.1145/325165.325247") && check("img", "data:image/png;base64,AA=="));
        assert!(check("a", "../../studio/?open=../book/a/r.toml") && check("a", "../../studio/?preset=alpine"));
        assert!(!check("a", "#there") && !check("img", "d.png") && !check("a", "b.html#there"));
        assert!(!check("img", "https://example.org/a.png") && !check("script", "https://example.org/a.js"));
        assert!(!check("a", "../../studio/?open=../book/a/q.toml") && !check("a", "../../studio/?seed=1"));
        let html = "<a class=\"x\" href=\"y?a&amp;b\">z</a><script src=\"s.js\"></script>";
        assert_eq!(links(html), [("a", "y?a&b".to_owned()), ("script", "s.js".to_owned())]);
    }
}
