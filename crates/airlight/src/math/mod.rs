//! Mathematics without physics: interpolation, quadrature, polynomials, random numbers, SIMD.

pub(crate) mod arctangent;
pub(crate) mod exponentials;
pub(crate) mod interpolation;
pub(crate) mod legendre;
pub(crate) mod parallel;
pub(crate) mod quadrature;
pub(crate) mod random;
pub(crate) mod real;
pub(crate) mod rings;
pub(crate) mod rounded;
pub(crate) mod simd;
pub(crate) mod simpson;
pub(crate) mod slices;
pub(crate) mod spline;
pub(crate) mod split_mix;
