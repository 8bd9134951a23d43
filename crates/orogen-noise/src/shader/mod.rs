//! Noise for GPUs: WGSL functions and the numbers that they read.

/// Declares numbers that shaders and this crate have in common: as constants here, and in a WGSL text that ends with
/// the content of a file.
#[doc(hidden)]
#[macro_export]
macro_rules! shader_constants {
    ($(#[$about:meta])* $seen:vis $text:ident = $file:literal, $($name:ident = $value:literal),+) => {
        $($seen const $name: usize = $value;)+
        $(#[$about])*
        $seen const $text: &str =
            concat!($("const ", stringify!($name), " = ", $value, "u;\n",)+ include_str!($file));
    };
}

pub mod function;
pub mod lattice;
mod noise;
pub mod phacelle;
