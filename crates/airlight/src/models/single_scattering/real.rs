//! Just enough of f32 and f64 to write the shader once.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A floating point number of either width.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
{
    /// The nearest number of this width.
    fn of(value: f64) -> Self;
    /// The same in f64.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Arc cosine.
    fn acos(self) -> Self;
    /// Power.
    fn pow(self, exponent: Self) -> Self;
}

macro_rules! real {
    ($float:ty) => {
        impl Real for $float {
            fn of(value: f64) -> Self {
                value as $float
            }
            fn to_f64(self) -> f64 {
                self.into()
            }
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            fn exp(self) -> Self {
                self.exp()
            }
            fn cos(self) -> Self {
                self.cos()
            }
            fn acos(self) -> Self {
                self.acos()
            }
            fn pow(self, exponent: Self) -> Self {
                self.powf(exponent)
            }
        }
    };
}

real!(f32);
real!(f64);

/// A `vec3`.
#[derive(Clone, Copy, Debug)]
pub struct Vec3<F>(pub [F; 3]);

impl<F: Real> Vec3<F> {
    /// Of three numbers in f64.
    pub fn of(values: [f64; 3]) -> Self {
        Self(values.map(F::of))
    }

    /// Component by component.
    pub fn map(self, f: impl Fn(F) -> F) -> Self {
        Self(self.0.map(f))
    }

    /// Component by component with another.
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
