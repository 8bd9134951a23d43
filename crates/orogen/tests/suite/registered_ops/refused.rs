//! Ops whose names or keys are rejected.

use orogen::op::{Field, Inputs, WorldParams};
use orogen::{Points, Result};

macro_rules! raise {
    ($($name:ident = $op:literal, $key:ident, $default:literal;)*) => { $(
        orogen::op! {
            /// Some field.
            pub struct $name = $op, field, revision 1;
            params {
                /// Some number.
                $key: f64 = $default, range 0.0 to 10.0;
            }
        }
        impl Field for $name {
            fn eval(&self, _: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
                out.fill(self.$key as f32);
                Ok(())
            }
        }
    )* };
}

raise! {
    Bare = "terraces", value, 1.0;
    BuiltIn = "fbm", value, 1.0;
    Capital = "MyGame.terraces", value, 1.0;
    Deep = "mygame.water.rivers", value, 1.0;
    Double = "mygame.ripples", value, 1.0;
    Masked = "mygame.masked", mask, 1.0;
    Outside = "mygame.outside", value, 11.0;
    Grey = "mygame.grey", value, 1.0;
    Gray = "mygame.gray", value, 1.0;
}
