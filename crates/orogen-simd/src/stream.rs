//! Results on their way past the caches.

/// Leave to write past the caches: see [`streaming`].
#[derive(Debug)]
pub struct Stream(());

impl Drop for Stream {
    fn drop(&mut self) {
        // SAFETY: every x86-64 processor has the instruction.
        #[cfg(target_arch = "x86_64")]
        unsafe {
            core::arch::x86_64::_mm_sfence();
        }
    }
}

/// Does work that writes some of its results by [`crate::F32Lanes::stream`], past the caches: what is written but not read again
/// soon, and larger than they are, is written faster so. All of it has arrived when this returns, for every thread to see.
pub fn streaming<R>(work: impl FnOnce(&Stream) -> R) -> R {
    // Dropped here whatever happens: nobody but this function ever owns one.
    let stream = Stream(());
    work(&stream)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, F32Lanes, Level, Simd, dispatch_at};

    #[test]
    fn whole_registers_and_what_is_left_arrive_wherever_they_begin() {
        struct Copy<'a>(&'a [f32], &'a mut [f32]);
        impl Body for Copy<'_> {
            type Output = ();
            #[inline(always)]
            fn run<S: Simd>(self, s: S) {
                streaming(|stream| {
                    for (from, to) in self.0.chunks(S::LANES).zip(self.1.chunks_mut(S::LANES)) {
                        s.load_partial(from, f32::NAN).stream(to, stream);
                    }
                });
            }
        }
        let from: Vec<f32> = (0..200).map(|i| i as f32).collect();
        for level in Level::available() {
            for begin in 0..20 {
                let mut to = vec![-1.0; 200];
                dispatch_at(level, Copy(&from[..200 - begin], &mut to[begin..])).unwrap();
                assert_eq!(to[begin..], from[..200 - begin]);
                assert!(to[..begin].iter().all(|&untouched| untouched == -1.0));
            }
        }
    }
}
