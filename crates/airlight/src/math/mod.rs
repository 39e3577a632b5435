//! Interpolation, quadrature, random numbers and vector dispatch: mathematics without physics.

pub(crate) mod cubic;
pub(crate) mod gauss_rule;
pub(crate) mod quadrature;
pub(crate) mod random;
pub(crate) mod simd;
