//! The ops in groups, as the list of new nodes shows them.

/// A group: the catalog key of its name, and its ops in the order of their use.
pub struct OpGroup {
    /// The catalog key of its name.
    pub name: &'static str,
    /// The names of its ops.
    pub ops: &'static [&'static str],
}

const fn group(name: &'static str, ops: &'static [&'static str]) -> OpGroup {
    OpGroup { name, ops }
}

/// All groups. Every op is in one of them, except `input`, which recipes write themselves.
pub static ALL: [OpGroup; 9] = [
    group(
        "ops.noise",
        &[
            "fbm",
            "ridged",
            "billow",
            "weighted-fbm",
            "hybrid",
            "hetero",
            "swiss",
            "jordan",
            "ping-pong",
            "perlin",
            "classic",
            "simplex",
            "opensimplex2",
            "value",
            "worley",
            "white",
            "gullies",
        ],
    ),
    group(
        "ops.land",
        &[
            "continents",
            "amplify",
            "learned",
            "dla",
            "dem",
            "exemplar",
            "craters",
            "meanders",
            "radial",
            "edge",
            "ramp",
            "constant",
            "altitude",
        ],
    ),
    group("ops.draw", &["path", "polygon", "roads", "paint", "image", "label"]),
    group("ops.combine", &["add", "multiply", "mix", "min", "max", "expr"]),
    group(
        "ops.shape",
        &[
            "remap",
            "clamp",
            "curve",
            "terrace",
            "normalise",
            "warp",
            "transform",
            "blur",
            "resample",
            "slice",
            "bake",
            "extrapolate",
        ],
    ),
    group(
        "ops.erosion",
        &[
            "stream-power",
            "local-stream-power",
            "pipes",
            "droplets",
            "thermal",
            "soil-depth",
            "dolines",
            "hillslopes",
            "glaciate",
            "glaciers",
            "dunes",
            "lava",
            "coast",
        ],
    ),
    group(
        "ops.water",
        &["fill", "breach", "drainage", "lakes", "rivers", "flow-direction", "flow-indices", "height-above-drainage"],
    ),
    group(
        "ops.masks",
        &[
            "select-height",
            "select-slope",
            "select-aspect",
            "select-curvature",
            "select-flow",
            "select-share",
            "distance",
        ],
    ),
    group(
        "ops.analysis",
        &[
            "slope",
            "aspect",
            "curvature",
            "hillshade",
            "normal",
            "occlusion",
            "ruggedness",
            "topographic-position",
            "geomorphons",
            "viewshed",
            "insolation",
            "temperature",
            "orographic-rain",
            "evapotranspiration",
            "biome",
            "outcrop",
        ],
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::node::Node;

    #[test]
    fn every_op_is_in_one_group() {
        let mut grouped: Vec<&str> = ALL.iter().flat_map(|group| group.ops).copied().collect();
        grouped.sort_unstable();
        let mut ops: Vec<&str> = Node::all().iter().map(|node| node.spec().op).filter(|op| *op != "input").collect();
        ops.sort_unstable();
        assert_eq!(grouped, ops);
    }
}
