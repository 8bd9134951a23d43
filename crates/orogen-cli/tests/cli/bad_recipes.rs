//! Invalid recipes: each yields a message with its position, and no files.

use crate::harness::{DEADLINE, Folder};

/// The common start of the recipes.
const HEAD: &str = "orogen = 1\n[world]\nsize = [100, 100]\n";

fn check(content: impl AsRef<[u8]>, expect: &str) {
    check_as("a.toml", content, expect);
}

/// Checks that `generate`, `export` and `explain` reject a recipe with `expect`, in time, and leave the folder
/// unchanged.
fn check_as(name: &str, content: impl AsRef<[u8]>, expect: &str) {
    let folder = Folder::new();
    folder.write(name, content);
    for command in [&["generate", name][..], &["export", name, "-o", "x.npy"], &["explain", name]] {
        let begun = std::time::Instant::now();
        let outcome = folder.bad(command, 1, expect);
        assert!(outcome.err.len() < 20_000, "{} bytes of diagnostics", outcome.err.len());
        assert!(begun.elapsed() < DEADLINE, "{expect} took {:?}", begun.elapsed());
        assert_eq!(folder.names(""), [name]);
    }
}

/// A recipe with these nodes, whose heights are the node `a`.
fn nodes(nodes: &str) -> String {
    format!("{HEAD}{nodes}\n[outputs]\nheight = \"a\"\n")
}

#[test]
fn what_is_no_text() {
    check("", "a.toml is empty");
    check(" \n\n ", "a.toml is empty");
    check((0..=255u8).cycle().take(5000).collect::<Vec<u8>>(), "is not UTF-8 text");
    check([0; 100], "a.toml:");
    check(b"\xff\xfeo\0r\0o\0", "it is UTF-16 text; save it as UTF-8");
    check(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "is not UTF-8 text");
}

#[test]
fn deep_nesting() {
    let deep = 1_000_000;
    check(format!("orogen = 1\na = {}{}", "[".repeat(deep), "]".repeat(deep)), "a.toml:2:");
    check(format!("orogen = 1\na = {}", "{a = ".repeat(deep)), "a.toml:2:");
    check(format!("orogen = 1\n{} = 1", vec!["a"; deep].join(".")), "a.toml");
    check_as("a.json", format!("{{\"orogen\": 1, \"a\": {}{}}}", "[".repeat(deep), "]".repeat(deep)), "a.json:1:");
    check_as("a.json", "{\"a\":".repeat(deep), "a.json:1:");
}

#[test]
fn numbers_that_are_none() {
    for (value, expect) in
        [("nan", "finite"), ("inf", "finite"), ("-inf", "finite"), ("1e999", ""), ("\"5\"", "number")]
    {
        check(nodes(&format!("[nodes.a]\nop = \"fbm\"\nwavelength = {value}")), &format!("a.toml:6:14: {}", ""));
        check(nodes(&format!("[nodes.a]\nop = \"fbm\"\nwavelength = {value}")), expect);
        check(
            format!(
                "orogen = 1\n[world]\nsize = [100, {value}]\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n"
            ),
            "a.toml:3:",
        );
    }
    check_as(
        "a.json",
        r#"{"orogen": 1, "world": {"size": [100, 100], "cell": 1e999}, "nodes": {"a": {"op": "constant"}}, "outputs": {"height": "a"}}"#,
        "a.json:1:",
    );
}

#[test]
fn sizes_that_are_none() {
    for line in [
        "size = [0, 100]",
        "size = [-5, 100]",
        "size = [100]",
        "size = []",
        "size = \"big\"",
        "cell = 0",
        "cell = -1",
        "seed = -1",
    ] {
        check(
            format!("orogen = 1\n[world]\n{line}\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n"),
            "a.toml:3:",
        );
    }
}

#[test]
fn cycles() {
    check(nodes("[nodes.a]\nop = \"add\"\na = \"a\"\nb = \"a\""), "a.toml:6:5: ");
    let cycle = "[nodes.a]\nop = \"add\"\na = \"b\"\nb = \"c\"\n[nodes.b]\nop = \"clamp\"\nsource = \"c\"\n[nodes.c]\nop = \"clamp\"\nsource = \"a\"\n";
    check(nodes(cycle), "a.toml:");
}

#[test]
fn names_that_are_wrong() {
    check(nodes("[nodes.a]\nop = \"fmb\""), "did you mean `fbm`?");
    check(nodes("[nodes.a]\nop = \"fmb\""), "a.toml:5:6: ");
    check(nodes("[nodes.a]\nop = \"fbm\"\noctavs = 3"), "a.toml:6:1: ");
    check(nodes("[nodes.a]\nop = \"fbm\"\noctavs = 3"), "\n 6 | octavs = 3\n   | ^^^^^^\n");
    check(nodes("[nodes.a]\nop = \"clamp\"\nsource = \"nowhere\""), "a.toml:6:10: ");
    check(nodes("[nodes.a]\nop = \"clamp\""), "source");
    check(nodes("[nodes.a]\nop = \"fbm\"\n[nodes.a]\nop = \"fbm\""), "a.toml:6:");
    check(nodes("[nodes.a]\nop = \"fbm\"\nop = \"fbm\""), "a.toml:6:");
    check(nodes("[nodes.b]\nop = \"fbm\""), "a.toml:7:10: ");
    check_as("a.json", "{\"orogen\": 1, \"orogen\": 1}", "twice");
    check("orogen = 2\n", "newer Orogen");
    check("[world]\n", "orogen = 1");
    check(HEAD, "no outputs");
}

#[test]
fn a_recipe_without_heights_has_nothing_to_generate() {
    let folder = Folder::new();
    folder.write("a.toml", format!("{HEAD}[nodes.a]\nop = \"constant\"\n[outputs]\nwet = \"a\"\n"));
    folder.bad(&["generate", "a.toml"], 2, "no layer `height`");
    assert_eq!(folder.names(""), ["a.toml"]);
    folder.good(&["export", "a.toml", "--layer", "wet", "-o", "a.npy"]);
}

#[test]
fn a_million_nodes() {
    let many: String = (0..1_000_000).map(|i| format!("n{i} = {{ op = \"fbm\" }}\n")).collect();
    check(format!("orogen = 1\n[nodes]\n{many}[outputs]\nheight = \"n1\"\n"), "a.toml");
    // Few enough bytes to be read, but too many nodes.
    let many: String = (0..100_000).map(|i| format!("n{i} = {{ op = \"fbm\" }}\n")).collect();
    check(format!("orogen = 1\n[nodes]\n{many}[outputs]\nheight = \"n1\"\n"), "65536");
}

#[test]
fn lines_that_are_long_and_strange() {
    check(format!("orogen = 1\n{} = 1\n", "x".repeat(1_000_000)), "a.toml:2:1: ");
    let folder = Folder::new();
    folder.write("a.toml", "orogen = 1\n\"\\u001b[31m\\u0007\" = 1\n");
    let outcome = folder.bad(&["generate", "a.toml"], 1, "a.toml:2:");
    assert!(!outcome.err.contains(['\x1b', '\x07']), "{:?}", outcome.err);
}

#[test]
fn a_file_that_is_not_there_is_told_at_its_line() {
    let folder = Folder::new();
    let text = "orogen = 1\n[world]\nsize = [640, 480]\n[nodes.place]\nop = \"dem\"\npath = \"none.tif\"\n[outputs]\nheight = \"place\"\n";
    folder.write("a.toml", text);
    folder.write(
        "a.json",
        r#"{"orogen": 1, "nodes": {"p": {"op": "image", "path": "none.png"}}, "outputs": {"height": "p"}}"#,
    );
    let told = folder.bad(&["generate", "a.toml"], 1, "error: a.toml:6:8: node `place`: cannot read none.tif: ");
    assert!(told.err.contains(" 6 | path = \"none.tif\"\n   |        ^^^^^^^^^^\n"), "{}", told.err);
    folder.bad(&["explain", "a.json"], 1, "error: a.json:1:");
    // Also a file that is not an image.
    folder.write("none.tif", "text");
    let told = folder.bad(&["generate", "a.toml"], 1, "error: a.toml:6:8: node `place`: ");
    assert!(told.err.contains("^^^^^^^^^^"), "{}", told.err);
}

#[test]
fn nothing_is_echoed_that_nobody_reads() {
    let folder = Folder::new();
    let name = "n".repeat(1_000_000);
    let text = |node: &str, value: &str, source: &str| {
        format!(
            "orogen = 1\n[world]\nsize = [640, 480]\n[nodes.{node}]\nop = \"fbm\"\nwavelength = {value}\n[nodes.b]\nop = \"normalise\"\nsource = \"{source}\"\n\
             [outputs]\nheight = \"b\"\n"
        )
    };
    for (text, expect) in [
        (text(&name, "20", &name), "nnn...nnn"),
        (text("a", "20", &name), "unknown node `nnn"),
        (text(&name, "20", "a"), "nnn...nnn"),
        (text("a", "1e308", "a"), "1e308"),
        (text("a", "1e-308", "a"), "1e-308"),
        (text("a", &"9".repeat(300), "a"), "1:"),
    ] {
        folder.write("a.toml", &text);
        for command in ["explain", "generate"] {
            let outcome = folder.run(&[command, "a.toml"]);
            assert_eq!(outcome.code, 1, "{}", outcome.err);
            let longest = outcome.err.lines().map(str::len).max().unwrap_or(0);
            assert!(longest < 420 && outcome.err.len() < 2000, "{} bytes in a line: {}", longest, &outcome.err[..400]);
            assert!(expect == "1:" || outcome.err.contains(expect), "{}", outcome.err);
        }
    }
    for arguments in [
        &["generate", "hills", "--cell", "1e308"][..],
        &["render", "hills", "--fov", "1e308"],
        &["render", "hills", "--exaggeration", "1e308"],
        &["grow", "alpine", "--years", "1e308"],
        &["export", "hills", "-o", "a.png", "--range", "1e308,2e308"],
        &["noise", "perlin", "--wavelength", "1e308"],
        &["map", "hills", "-o", "a.png", "--contours", "1e308"],
    ] {
        let outcome = folder.run(arguments);
        let longest = (outcome.err.lines().chain(outcome.text().lines())).map(str::len).max().unwrap_or(0);
        assert!(longest < 300, "{arguments:?}: {}", outcome.err);
    }
}
