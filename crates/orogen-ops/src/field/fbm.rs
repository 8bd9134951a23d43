//! Fractional Brownian motion.

use orogen_noise::Kind;

op! {
    /// Fractional Brownian motion (fBm): a sum of octaves of noise, in -1 ..= 1.
    ///
    /// The sum of gain^i n_i(p lacunarity^i / wavelength), divided by the sum of the amplitudes. Each octave has its
    /// own seed and offset. Mandelbrot and Van Ness 1968; Musgrave 1989.
    pub struct Fbm = "fbm", field, revision 1;
    octaves |_| Kind::Fbm;
}
