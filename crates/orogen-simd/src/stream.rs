//! Non-temporal stores.

/// A permit for non-temporal stores (see [`streaming`]).
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

/// Runs work that writes results with [`crate::F32Lanes::stream`], which bypasses the caches. This is faster for
/// results that are larger than the caches and are not read again soon. When it returns, the results are visible to all
/// threads.
pub fn streaming<R>(work: impl FnOnce(&Stream) -> R) -> R {
    // It is always dropped here, because only this function owns it.
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
