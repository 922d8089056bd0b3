//! Loops with the vector instructions of the machine at hand: wider vectors, the same operations and so the same bits.

use pulp::{Arch, Simd, WithSimd};

struct Wide<F>(F);

impl<R, F: FnMut() -> R> WithSimd for Wide<F> {
    type Output = R;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> R {
        (self.0)()
    }
}

/// Calls `f`, which has to be `#[inline(always)]` with all that it calls, compiled for the instructions of `arch`. It is
/// `FnMut` because a closure that is called once goes through a function that is compiled for any machine.
#[inline(always)]
pub fn wide<R>(arch: Arch, f: impl FnMut() -> R) -> R {
    arch.dispatch(Wide(f))
}
