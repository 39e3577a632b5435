//! Dispatch to the widest vector instructions of the machine.

#[cfg(not(target_arch = "wasm32"))]
use pulp::{Arch, Simd, WithSimd};

/// Runs `work`, compiled for each vector instruction set, with the widest one available at run time.
///
/// Loops inside must be inlined into `work` (`#[inline(always)]`, also on closures) to be compiled for the wider registers.
/// The result does not depend on the instruction set: nothing is reassociated or fused.
#[cfg(not(target_arch = "wasm32"))]
#[inline(always)]
pub fn vectorized<R>(work: impl FnMut() -> R) -> R {
    struct Work<F>(F);
    impl<R, F: FnMut() -> R> WithSimd for Work<F> {
        type Output = R;
        #[inline(always)]
        fn with_simd<S: Simd>(mut self, _: S) -> R {
            // Called through `FnMut`: the `FnOnce` shim of such a closure is not inlined.
            (self.0)()
        }
    }
    Arch::new().dispatch(Work(work))
}

/// Runs `work`. WebAssembly cannot ask for instructions at run time, and one unknown to the browser anywhere in a module keeps it from
/// loading: what the module may use is set when it is compiled.
#[cfg(target_arch = "wasm32")]
#[inline(always)]
pub fn vectorized<R>(mut work: impl FnMut() -> R) -> R {
    work()
}
