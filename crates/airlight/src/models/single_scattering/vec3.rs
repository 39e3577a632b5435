//! Vectors of the shader, in either precision.

use crate::math::real::Real;

/// A `vec3`.
#[derive(Clone, Copy, Debug)]
pub struct Vec3<F>(pub [F; 3]);

impl<F: Real> Vec3<F> {
    /// Vector of three numbers in f64.
    pub fn of(values: [f64; 3]) -> Self {
        Self(values.map(F::of))
    }

    /// Applies `f` to each component.
    pub fn map(self, f: impl Fn(F) -> F) -> Self {
        Self(self.0.map(f))
    }

    /// Applies `f` to each pair of components.
    pub fn zip(self, other: Self, f: impl Fn(F, F) -> F) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    /// `self + other`.
    pub fn plus(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    /// `self - other`.
    pub fn minus(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    /// `self * other`.
    pub fn times(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    /// `self * factor`.
    pub fn scaled(self, factor: F) -> Self {
        self.map(|a| a * factor)
    }

    /// `self / divisor`.
    pub fn over(self, divisor: F) -> Self {
        self.map(|a| a / divisor)
    }

    /// `dot(self, other)`.
    pub fn dot(self, other: Self) -> F {
        let [x, y, z] = self.times(other).0;
        x + y + z
    }

    /// `length(self)`.
    pub fn length(self) -> F {
        self.dot(self).sqrt()
    }
}
