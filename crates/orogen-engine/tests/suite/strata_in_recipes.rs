//! Strata in recipes.

use orogen_engine::declare::{Param, Stratum};
use orogen_engine::{Recipe, Window, World};

fn recipe(op: &str, strata: &str) -> String {
    format!(
        "orogen = 1\n[world]\nsize = [2000, 2000]\ncell = 50\n[nodes.land]\nop = \"fbm\"\n[nodes.worn]\nop = \"{op}\"\n\
         source = \"land\"\nbedding = 20\nstrata = {strata}\n[outputs]\nheight = \"worn\"\n"
    )
}

fn parse(text: &str) -> Recipe {
    Recipe::parse(text, "t").unwrap_or_else(|error| panic!("{error}"))
}

const OPS: [&str; 4] = ["stream-power", "local-stream-power", "thermal", "outcrop"];

#[test]
fn strata_are_read_and_written() {
    for op in OPS {
        let read =
            parse(&recipe(op, "[{ thickness = 20, erodibility_factor = 0.1 }, { talus_angle = 35.5, thickness = 4 }]"));
        let expect = "strata = [\n  { thickness = 20, erodibility_factor = 0.1, talus_angle = 0 },\n  \
            { thickness = 4, erodibility_factor = 1, talus_angle = 35.5 },\n]\n";
        assert!(read.to_toml().contains(expect), "{}", read.to_toml());
        assert_eq!(parse(&read.to_toml()), read);
        World::open(read).unwrap().window("height", &Window::new(9, 9, 50.0)).unwrap();
    }
    let text =
        recipe("thermal", "[{ thickness = \"= depth / 2\" }]").replace("[world]", "[parameters]\ndepth = 30\n[world]");
    let index = parse(&text).nodes()[1].node.spec().param_named("strata").unwrap();
    let expect = vec![Stratum { thickness: 15.0, ..Stratum::default() }];
    assert_eq!(parse(&text).nodes()[1].node.param(index), expect.write());
}

#[test]
fn messages_say_what_is_wrong_and_where() {
    // The mark `|` is before the part that is wrong.
    for (strata, message) in [
        ("|5", "`strata` must be a list of strata [{ thickness = 100, erodibility_factor = 0.2 }, ...], not 5"),
        ("[{ thickness = 5 }, |3]", "`strata`: stratum 2 is 3; write it as { thickness = 100"),
        ("[|{ talus_angle = 30 }]", "`strata`: stratum 1 has no `thickness`"),
        ("[{ thickness = |0 }]", "in stratum 1 `thickness` must be a finite number from 0.1 to 1e6 (m), not 0"),
        (
            "[{ thickness = 1, erodibility_factor = |-2 }]",
            "`erodibility_factor` must be a finite number from 0.001 to 1000",
        ),
        ("[{ thickness = 1, talus_angle = |95 }]", "`talus_angle` must be a finite number from 0 to 89 (deg), not 95"),
        ("[{ thickness = 1, |hardness = 2 }]", "unknown key `hardness` in stratum 1"),
    ] {
        let marked = recipe("stream-power", strata);
        let error = Recipe::parse(&marked.replace('|', ""), "t").unwrap_err();
        assert!(error.to_string().contains(message), "{strata}: {error}");
        let place = error.diagnostics()[0].place.clone().unwrap();
        let at = marked.find('|').unwrap();
        let start = marked[..at].rfind('\n').unwrap() + 1;
        assert_eq!(place.column, at - start + 1, "{strata}: {error}");
    }
    let many = recipe("outcrop", &format!("[{}]", "{ thickness = 1 }, ".repeat(1001)));
    let error = Recipe::parse(&many, "t").unwrap_err().to_string();
    assert!(error.contains("more than 1000 strata; set `repeat_strata`"), "{error:.300}");
}
