//! Running a computation with the widest vector instructions of the machine.

use pulp::{Arch, Simd, WithSimd};

/// Runs `work`, compiled once for each vector instruction set and chosen when the program runs.
///
/// The loops inside must be inlined into `work` (`#[inline(always)]`, on closures too) to be compiled for the wider
/// registers. No instruction set changes the result: nothing is reassociated and nothing is fused.
#[inline(always)]
pub fn vectorized<R>(work: impl FnMut() -> R) -> R {
    struct Work<F>(F);
    impl<R, F: FnMut() -> R> WithSimd for Work<F> {
        type Output = R;
        #[inline(always)]
        fn with_simd<S: Simd>(mut self, _: S) -> R {
            // Called as `FnMut`: the `FnOnce` of such a closure is a shim of its own, which is not inlined.
            (self.0)()
        }
    }
    Arch::new().dispatch(Work(work))
}
