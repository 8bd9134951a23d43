//! Parsing of op! blocks.

/// The data of a node for codegen.
#[derive(Debug, PartialEq, Eq)]
pub struct Op {
    /// The module, which is the name of the file.
    pub module: String,
    /// The struct.
    pub name: String,
    /// The name in recipes.
    pub op: String,
    /// The declared locality.
    pub locality: String,
}

/// The op! block of a source text; `None` if the file has none. The module is left empty.
pub fn find(text: &str) -> Result<Option<Op>, String> {
    let mut found = None;
    let mut lines = text.lines().map(str::trim);
    while let Some(line) = lines.next() {
        if !opens(line) {
            continue;
        }
        if found.is_some() {
            return Err("a second op! block: one node a file".to_owned());
        }
        let declaration = lines
            .find(|l| !(l.is_empty() || l.starts_with("//") || l.starts_with('#')))
            .ok_or("an op! block that never begins")?;
        found = Some(parse(declaration).ok_or_else(|| {
            format!("expected `pub struct NAME = \"op_name\", field|filter|levelled|solver, revision N;`, found `{declaration}`")
        })?);
    }
    Ok(found)
}

/// The names of the public types of a source text, sorted: the op, and the choices of its parameters.
pub fn public_types(text: &str) -> Vec<String> {
    let named = |line: &str| {
        let rest = line.trim().strip_prefix("pub struct ").or(line.trim().strip_prefix("pub enum "))?;
        rest.split(|c: char| !c.is_alphanumeric()).next().map(str::to_owned)
    };
    let mut names: Vec<String> = text.lines().take_while(|line| *line != "#[cfg(test)]").filter_map(named).collect();
    names.sort();
    names
}

/// Whether a line is `op! {`, also with a path, or `drained_op! {`; not in a comment or a doc example.
fn opens(line: &str) -> bool {
    let call =
        ["crate::op::", "crate::", "drained_"].iter().find_map(|before| line.strip_prefix(before)).unwrap_or(line);
    call.strip_prefix("op!").is_some_and(|rest| rest.trim_start().starts_with('{'))
}

fn parse(line: &str) -> Option<Op> {
    let (name, rest) = line.strip_prefix("pub struct ")?.split_once('=')?;
    let mut parts = rest.trim().strip_suffix(';')?.split(',').map(str::trim);
    let op = parts.next()?.strip_prefix('"')?.strip_suffix('"')?;
    let locality = parts.next()?;
    let revision = parts.next()?.strip_prefix("revision ")?;
    let whole = parts.next().is_none()
        && revision.trim().parse::<u32>().is_ok()
        && super::LOCALITIES.contains(&locality)
        // Names with a namespace are left to ops of other crates.
        && !op.is_empty()
        && !op.contains('.');
    whole.then(|| Op {
        module: String::new(),
        name: name.trim().to_owned(),
        op: op.to_owned(),
        locality: locality.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLUR: &str = r#"//! Blur.
use crate::op::op;

op! {
    /// A gaussian blur.
    ///
    /// Slow in doubt.
    #[derive(Debug)]
    pub struct Blur = "blur", filter, revision 1;
    radius: f64 = 10.0,
}
"#;

    #[test]
    fn types_are_found_in_and_outside_of_macros() {
        let text = format!("choice! {{\n    pub enum Edges {{\n    }}\n}}\n{BLUR}\n#[cfg(test)]\npub struct Test;\n");
        assert_eq!(public_types(&text), ["Blur", "Edges"]);
        assert_eq!(public_types("pub fn alone() {}\nstruct Hidden;\n"), [""; 0]);
    }

    fn op(name: &str, op: &str, locality: &str) -> Op {
        Op { module: String::new(), name: name.into(), op: op.into(), locality: locality.into() }
    }

    #[test]
    fn one_block_behind_docs_and_attributes() {
        assert_eq!(find(BLUR), Ok(Some(op("Blur", "blur", "filter"))));
        assert_eq!(find(&BLUR.replace("op! {", "crate::op! {")), Ok(Some(op("Blur", "blur", "filter"))));
        assert_eq!(find("op!{\npub struct A=\"a\",field,revision 12;\n}"), Ok(Some(op("A", "a", "field"))));
    }

    #[test]
    fn a_helper_has_none() {
        assert_eq!(find("//! Shared by two nodes.\n// op! { stands elsewhere\npub fn help() {}\n"), Ok(None));
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expect) in [
            (BLUR.to_owned() + BLUR, "a second op! block"),
            (BLUR.replace("filter,", "brush,"), "found `pub struct Blur = \"blur\", brush, revision 1;`"),
            (BLUR.replace(", revision 1", ""), "expected `pub struct NAME"),
            (BLUR.replace("\"blur\"", "\"orogen.blur\""), "found `pub struct Blur = \"orogen.blur\""),
            ("op! {\n/// nothing\n".to_owned(), "never begins"),
        ] {
            let error = find(&text).expect_err(expect);
            assert!(error.contains(expect), "{error}");
        }
    }
}
