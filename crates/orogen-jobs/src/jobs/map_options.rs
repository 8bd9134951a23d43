//! The options of a map sheet.

use super::map::{MapColors, MapJob};
use crate::options::Condition::{Given, Is, IsNot};
use crate::options::{Choice, OptionSpec, Options, ValueKind};
use orogen_engine::world::HEIGHT;
use orogen_grid::error::Result;
use orogen_output::sheet::options::{GridStep, Labels, Parts, Resolution, Scale, Shading};

const COLORS: &[Choice] = &[
    Choice::new("palette", "The heights or the --layer, with a palette"),
    Choice::new("surfaces", "The recipe's surfaces, or the standard ones: grass, sand, scree, rock, snow, river beds"),
    Choice::new("biomes", "The classes of an output that is the layer of a `biome`, with their names"),
    Choice::new("classes", "The recipe's terrain classes, `[[class]]`, with their names"),
];

const RAMPS: &[Choice] = &[
    Choice::new("linear", "Linear scale"),
    Choice::new("log", "Logarithmic scale, for quantities over orders of magnitude"),
    Choice::new("labels", "A different color for each number"),
];

const SHADINGS: &[Choice] = &[
    Choice::new("multi", "Hillshade with three lights"),
    Choice::new("single", "Hillshade with one light from the north-west"),
    Choice::new("swiss", "Three lights, with soft hazy lowlands and crisp summits"),
    Choice::new("none", "No shading"),
];

const LABELS: &[Choice] =
    &[Choice::new("index", "Index contours"), Choice::new("all", "All contours"), Choice::new("none", "No contours")];

const PAGE_COLORS: &str = "Colors of the page, as #rrggbb or a name";
const PARTS: &str = "Parts to leave out";

const fn color(name: &'static str, example: &'static str, about: &'static str) -> OptionSpec {
    OptionSpec::new(name, "COLOR", ValueKind::Color)
        .with_about(about)
        .with_example(example, ["", ""])
        .under(PAGE_COLORS)
}

const fn part(name: &'static str, about: &'static str) -> OptionSpec {
    OptionSpec::switch(name).with_about(about).under(PARTS)
}

/// The options, in the order of a help.
const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("color", "WHAT", ValueKind::Choice(COLORS))
        .with_about(
            "What the colors show: a layer with a palette, the surfaces of the ground, the biomes, or the terrain \
             classes",
        )
        .with_default("palette")
        .with_aliases(&["colors", "colour", "colours"]),
    OptionSpec::new("layer", "L", ValueKind::Layer)
        .with_about(
            "Layer to color: an output, `node.layer`, or a layer derived from the heights (`orogen export --help` \
             lists them)",
        )
        .with_default(HEIGHT)
        .when(Is("color", &["palette"])),
    OptionSpec::new("palette", "NAME|FILE", ValueKind::Palette)
        .with_about(
            "Palette: a name (`orogen palettes` lists them) or a file (.cpt, .gpl, .toml, or gdaldem) [default: \
             hypsometric for heights; for other layers the palette with the layer's name, else viridis]",
        )
        .when(Is("color", &["palette"])),
    OptionSpec::switch("nearest-color")
        .with_about(
            "Give each value the color of the nearest stop of the palette, without mixing (as gdaldem's \
             -nearest_color_entry); with --shade none pixels have exactly these colors",
        )
        .when(Given("palette")),
    OptionSpec::new("ramp", "HOW", ValueKind::Choice(RAMPS))
        .with_about(
            "How values are mapped to colors [default: log for drainage areas and similar, labels for numbered areas, \
             else linear]",
        )
        .when(IsNot("layer", HEIGHT)),
    OptionSpec::new("range", "LOW,HIGH", ValueKind::Range)
        .with_about(
            "Values at the ends of the palette, for example to use the same range for several maps [default: the \
             minimum and maximum of this map]",
        )
        .with_example("0,1000", ["", ""])
        .when(Is("color", &["palette"])),
    OptionSpec::new("shade", "HOW", ValueKind::Choice(SHADINGS)).with_about("Relief shading").with_default("multi"),
    OptionSpec::new("contours", "M", ValueKind::Positive)
        .with_about("Contour interval in metres [default: a round number that suits relief and scale]")
        .with_example("100", ["", " m"])
        .without(&["levels"]),
    OptionSpec::new("levels", "A,B,...", ValueKind::Numbers)
        .with_about("Contour heights in metres, instead of an interval, such as 100,250,500; all of them are labeled")
        .with_example("100,250,500", ["", " m"])
        .without(&["contours"]),
    OptionSpec::new("labels", "WHICH", ValueKind::Choice(LABELS))
        .with_about("Contours that have labels, as far as there is room for them [default: index; all with --levels]")
        .without(&["no-labels"]),
    OptionSpec::new("grid", "STEP", ValueKind::Automatic)
        .with_about(
            "Coordinate grid, with its numbers along all four sides: STEP metres apart, or degrees on a map in degrees \
             [default STEP: a round distance of at least 20 mm on the page]",
        )
        .with_example("1000", ["", ""]),
    OptionSpec::new("river-area", "M2", ValueKind::Positive)
        .with_about(
            "Minimum drainage area of rivers in m^2 [default: depends on the scale, at least 100000; none on bare \
             noise, which has no rivers]",
        )
        .with_example("1000000", ["", " m²"]),
    OptionSpec::new("lake-area", "M2", ValueKind::Positive)
        .with_about(
            "Minimum area of lakes in m^2 [default: depends on the scale; none on bare noise, which has no lakes]",
        )
        .with_example("100000", ["", " m²"]),
    OptionSpec::new("names", "FILE", ValueKind::File).with_about(
        "Names on the map: a .csv file with columns x, y and name, and optionally kind (place, summit, river or \
             lake) and height, or a .geojson file of points with these properties, and of lines that names follow; in \
             the CRS of the heights; without a CRS, in metres east and north of the world's north-west corner (points \
             south of it are negative). Names without room are left out, the last of the file first",
    ),
    OptionSpec::new("scale", "N", ValueKind::Positive)
        .with_about(
            "Scale of the map, 1 : N, which sets the size of the page [default: the map is 240 mm long, or as large as \
             --paper allows]",
        )
        .with_example("100000", ["1 : ", ""])
        .without(&["paper"]),
    OptionSpec::new("title", "TEXT", ValueKind::Text).with_about("Title [default: the recipe's name]"),
    OptionSpec::new("paper", "PAPER", ValueKind::Paper)
        .with_about("Paper size: a0 to a5, letter, legal or WxHmm [default: the size of the map]")
        .with_example("a4", ["", ""])
        .without(&["scale"]),
    OptionSpec::switch("landscape").with_about("Landscape orientation").when(Given("paper")),
    OptionSpec::new("dpi", "N", ValueKind::Whole(20, 1200))
        .with_about(
            "Pixels per inch of a .png, and of the relief in a .svg or .pdf [default: 220; 150 for a .png without \
             --paper]",
        )
        .with_example("150", ["", " dpi"])
        .without(&["size"]),
    OptionSpec::new("size", "N", ValueKind::Whole(100, 30_000))
        .with_about("Pixels along the longer side of the page, instead of --dpi")
        .with_example("2000", ["", ""])
        .without(&["dpi"]),
    OptionSpec::switch("no-sidecar")
        .with_about("Do not write georeferencing files beside a .png (world file, .prj, .aux.xml)"),
    color("page-color", "#ffffff", "The page [default: white]"),
    color("ink-color", "#262422", "Texts, frames and symbols [default: almost black]"),
    color(
        "water-color",
        "#225c9c",
        "Rivers, lakes, shores and contours under water [default: shades of blue]; the sea has the colors of the \
         palette",
    ),
    color("contour-color", "#7e522a", "Contours on land [default: brown, bright on dark ground]"),
    part("no-title", "Title and subtitle"),
    part("no-axes", "Coordinates along the edges"),
    part("no-contours", "Contours and their labels"),
    part("no-labels", "Labels of the contours, as --labels none").without(&["labels"]),
    part("no-summits", "Summits and their heights"),
    part("no-rivers", "Rivers"),
    part("no-lakes", "Lakes (maps of a file of heights have none)"),
    part("no-roads", "Roads of the recipe's nodes `roads`"),
    part("no-shade", "Relief shading, as --shade none").without(&["shade"]),
    part("no-legend", "Legend"),
    part("no-color", "Color bar, or the list of surfaces, biomes or classes").with_aliases(&[
        "no-colors",
        "no-colour",
        "no-colours",
    ]),
    part("no-scale", "Scale bar"),
    part("no-north", "North arrow"),
    part("no-profile", "Profiles in the free space of --paper"),
];

impl MapJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The same with all that is chosen by [`OPTIONS`](MapJob::OPTIONS).
    ///
    /// # Errors
    /// If an option does not apply, a palette cannot be read, or the errors of [`check`](MapJob::check).
    pub fn with_options(self, options: &Options) -> Result<MapJob> {
        read(self, options)
    }
}

/// Sets the fields of a job from its options.
fn read(mut job: MapJob, options: &Options) -> Result<MapJob> {
    options.check(OPTIONS)?;
    let without = |name: &str| options.has(name);
    job.colors = match options.word("color") {
        Some("surfaces") => MapColors::Surfaces,
        Some("biomes") => MapColors::Biomes,
        Some("classes") => MapColors::Classes,
        _ => MapColors::Palette,
    };
    job.layer = options.text("layer").unwrap_or(HEIGHT).to_owned();
    job.palette = options.palette()?;
    job.scale = options.word("ramp").map(|word| match word {
        "log" => Scale::Log,
        "labels" => Scale::Labels,
        _ => Scale::Linear,
    });
    job.range = options.pair("range").map(|ends| ends.map(|end| end as f32));
    job.shading = match options.word("shade") {
        _ if without("no-shade") => Shading::None,
        Some("single") => Shading::Single,
        Some("swiss") => Shading::Swiss,
        Some("none") => Shading::None,
        _ => Shading::Multi,
    };
    job.interval = options.number("contours");
    job.levels = options.numbers("levels").map(<[f64]>::to_vec);
    job.labels = match options.word("labels") {
        Some("index") => Some(Labels::Index),
        Some("all") => Some(Labels::All),
        _ => None,
    };
    job.grid = options.has("grid").then(|| options.number("grid").map_or(GridStep::Automatic, GridStep::Every));
    job.river_area = options.number("river-area");
    job.lake_area = options.number("lake-area");
    job.names_file = options.file("names").map(Into::into);
    job.map_scale = options.number("scale");
    if let Some(title) = options.text("title") {
        job.title = title.to_owned();
    }
    job.paper = options.paper("paper").map(|paper| paper.sides(options.has("landscape")));
    let side = options.whole("size").map(|pixels| Resolution::Longer(pixels as u32));
    job.resolution = options.whole("dpi").map(|dpi| Resolution::Inch(dpi as f64)).or(side);
    job.has_sidecars = !without("no-sidecar");
    let colors = &mut job.page_colors;
    colors.page = options.color("page-color").unwrap_or(colors.page);
    colors.ink = options.color("ink-color").unwrap_or(colors.ink);
    colors.water = options.color("water-color");
    colors.contours = options.color("contour-color");
    let mut parts = Parts::default();
    parts.title = !without("no-title");
    parts.axes = !without("no-axes");
    parts.contours = !without("no-contours");
    parts.labels = !without("no-labels") && options.word("labels") != Some("none");
    parts.summits = !without("no-summits");
    parts.rivers = !without("no-rivers");
    parts.lakes = !without("no-lakes");
    parts.roads = !without("no-roads");
    parts.legend = !without("no-legend");
    parts.colors = !without("no-color");
    parts.scale = !without("no-scale");
    parts.north = !without("no-north");
    parts.profile = !without("no-profile");
    job.parts = parts;
    job.check()?;
    Ok(job)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::sheet_format::SheetFormat;

    /// The job for options.
    fn job(given: &[(&str, &str)]) -> Result<MapJob> {
        let options = Options::of(OPTIONS, given.iter().copied())?;
        MapJob::new(SheetFormat::Png).with_options(&options)
    }

    #[test]
    fn defaults_are_those_of_the_job() {
        let own = format!("{:?}", MapJob::new(SheetFormat::Png));
        assert_eq!(format!("{:?}", job(&[]).unwrap()), own);
        for spec in OPTIONS.iter().filter(|spec| !spec.default.is_empty()) {
            assert_eq!(format!("{:?}", job(&[(spec.name, spec.default)]).unwrap()), own, "{}", spec.name);
        }
    }

    #[test]
    fn every_word_and_every_switch_makes_another_job() {
        for spec in OPTIONS {
            // What the option needs to apply.
            let needed = match spec.condition {
                Given("palette") => ("palette", "viridis"),
                Given(_) => ("paper", "a4"),
                IsNot(..) => ("layer", "slope"),
                _ => ("title", "A map"),
            };
            let values: Vec<&str> = match spec.kind {
                ValueKind::Choice(words) => words.iter().map(|word| word.name).collect(),
                ValueKind::Nothing => vec![""],
                _ if spec.example.is_empty() => continue,
                _ => vec![spec.example],
            };
            let mut made = vec![format!("{:?}", job(&[needed]).unwrap())];
            for value in
                values.into_iter().filter(|value| *value != spec.default && (spec.name, *value) != ("labels", "none"))
            {
                let with = format!("{:?}", job(&[needed, (spec.name, value)]).unwrap());
                // A dialog starts from the colors that hold anyway.
                let is_own = ["page-color", "ink-color"].contains(&spec.name);
                assert!(is_own || !made.contains(&with), "{} {value}", spec.name);
                made.push(with);
            }
        }
        let none = job(&[("labels", "none")]).unwrap().parts;
        assert!(!none.labels && none == job(&[("no-labels", "")]).unwrap().parts);
    }

    #[test]
    fn contradictions_are_sentences() {
        for (given, expect) in [
            (&[("color", "surfaces"), ("layer", "slope")][..], "--layer applies to --color palette"),
            (&[("ramp", "log")], "--ramp needs a --layer other than height"),
            (&[("landscape", "")], "--landscape needs --paper"),
            (&[("levels", "1,2"), ("contours", "10")], "exclude each other"),
            (&[("levels", "100"), ("labels", "index")], "no index contours"),
            (&[("dpi", "1200"), ("paper", "2000x2000mm")], "not enough memory for a page"),
        ] {
            let why = job(given).unwrap_err().to_string();
            assert!(why.contains(expect), "{why}");
        }
    }
}
