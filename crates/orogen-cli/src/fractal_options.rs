//! How octaves are combined, as given on the command line.

use clap::ValueEnum;
use orogen_noise::Kind;

use crate::values::number::{finite, not_negative};

/// The kind of fractal, and the parameters of some kinds.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Kind of fractal [default: fbm]
    #[arg(long, conflicts_with = "texture")]
    fractal: Option<Sum>,
    /// How strongly slope damps the octaves of `weighted` [default: 1]
    #[arg(long, value_name = "K", value_parser = not_negative, allow_negative_numbers = true)]
    k: Option<f64>,
    /// Damping function of `weighted`, with m the squared slope [default: reciprocal]
    #[arg(long)]
    falloff: Option<Falloff>,
    /// How often `ping-pong` folds the noise (2 S - 1 times): 0.5 not at all, 1 like ridged, 4 in many bands [default:
    /// 2]
    #[arg(long, value_name = "S", value_parser = not_negative, allow_negative_numbers = true)]
    strength: Option<f64>,
    /// Value added to the noise of `hybrid` and `hetero`: where the sum is small, ground is smooth [default: 0.7]
    #[arg(long, value_name = "O", value_parser = finite, allow_negative_numbers = true)]
    offset: Option<f64>,
    /// How far slopes displace later octaves, in wavelengths of the first octave (`swiss`) or in cells of the octave
    /// (`jordan`) [default: 0.15; 0.35]
    #[arg(long, value_name = "W", value_parser = finite, allow_negative_numbers = true)]
    warp: Option<f64>,
    /// How far slopes let the finer octaves of `jordan` through; 0 leaves only the first octave [default: 0.8]
    #[arg(long, value_name = "D", value_parser = not_negative, allow_negative_numbers = true)]
    damp: Option<f64>,
}

/// How octaves are summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Sum {
    /// Fractional Brownian motion: the weighted sum of octaves
    Fbm,
    /// Sharp crests, round valleys
    Ridged,
    /// Round hills, sharp valleys
    Billow,
    /// Each octave is damped by the slope of those before it
    Weighted,
    /// Contour bands, as in agate
    PingPong,
    /// Hybrid multifractal: smooth lowlands, rough heights
    Hybrid,
    /// Heterogeneous terrain: the higher, the rougher
    Hetero,
    /// Swiss turbulence: branching crests
    Swiss,
    /// Jordan turbulence: rounded massifs with worn flanks
    Jordan,
}

/// How slope damps an octave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Falloff {
    /// 1 / (1 + k m)
    Reciprocal,
    /// e^(-k m)
    Exponential,
    /// 1 / (1 + k sqrt m)
    SquareRoot,
    /// 1 - smoothstep(k m): 0 beyond k m = 1
    Smoothstep,
}

impl Falloff {
    fn noise(self) -> orogen_noise::Falloff {
        match self {
            Falloff::Reciprocal => orogen_noise::Falloff::Reciprocal,
            Falloff::Exponential => orogen_noise::Falloff::Exponential,
            Falloff::SquareRoot => orogen_noise::Falloff::SquareRoot,
            Falloff::Smoothstep => orogen_noise::Falloff::Smoothstep,
        }
    }
}

impl Options {
    /// How octaves are summed.
    pub fn sum(&self) -> Sum {
        self.fractal.unwrap_or(Sum::Fbm)
    }

    /// The default number of octaves for a fractal.
    pub fn octaves(&self) -> u32 {
        if self.fractal.is_some() { 6 } else { 1 }
    }

    /// The kind of fractal, or an error about a parameter of another kind.
    pub fn kind(&self) -> Result<Kind, String> {
        let owners = [
            ("--k", self.k.is_some(), &[Sum::Weighted][..]),
            ("--falloff", self.falloff.is_some(), &[Sum::Weighted]),
            ("--strength", self.strength.is_some(), &[Sum::PingPong]),
            ("--offset", self.offset.is_some(), &[Sum::Hybrid, Sum::Hetero]),
            ("--warp", self.warp.is_some(), &[Sum::Swiss, Sum::Jordan]),
            ("--damp", self.damp.is_some(), &[Sum::Jordan]),
        ];
        for (option, given, owners) in owners {
            if given && !owners.contains(&self.sum()) {
                let owners: Vec<String> = owners.iter().map(|owner| format!("--fractal {}", owner.name())).collect();
                return Err(format!("{option} is for {}, not for {}", owners.join(" or "), self.sum().name()));
            }
        }
        let offset = self.offset.unwrap_or(0.7);
        Ok(match self.sum() {
            Sum::Fbm => Kind::Fbm,
            Sum::Ridged => Kind::Ridged,
            Sum::Billow => Kind::Billow,
            Sum::Weighted => Kind::Weighted {
                k: self.k.unwrap_or(1.0),
                falloff: self.falloff.unwrap_or(Falloff::Reciprocal).noise(),
            },
            Sum::PingPong => Kind::PingPong { strength: self.strength.unwrap_or(2.0) },
            Sum::Hybrid => Kind::Hybrid { offset },
            Sum::Hetero => Kind::Hetero { offset },
            Sum::Swiss => Kind::Swiss { warp: self.warp.unwrap_or(0.15) },
            Sum::Jordan => Kind::Jordan { warp: self.warp.unwrap_or(0.35), damp: self.damp.unwrap_or(0.8) },
        })
    }
}

impl Sum {
    /// The name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_string()).unwrap_or_default()
    }
}
