//! Reproducible inputs: random values mixed with singular ones.

use airlight::SplitMix64;

/// Generator of inputs.
pub struct Random(SplitMix64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    /// A uniform number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.0.bits() >> 40) as f32 / (1u64 << 24) as f32
    }

    pub fn between(&mut self, from: f32, to: f32) -> f32 {
        from + (to - from) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn decades(&mut self, from: f32, to: f32) -> f32 {
        self.between(from.ln(), to.ln()).exp()
    }

    /// One of the values, or with equal probability `other`.
    pub fn or(&mut self, values: &[f32], other: impl FnOnce(&mut Self) -> f32) -> f32 {
        match self.unit() < 0.5 {
            true => self.one_of(values),
            false => other(self),
        }
    }

    pub fn one_of(&mut self, values: &[f32]) -> f32 {
        values[(self.unit() * values.len() as f32) as usize]
    }

    /// An optical depth from clear to opaque.
    pub fn depth(&mut self) -> f32 {
        let values = [0.0, 1e-9, 1e-4, 0.7499, 0.75, 1.0, 40.0, 1e4, 1e25];
        self.or(&values, |r| r.decades(1e-9, 1e4))
    }

    /// 1 minus a cosine.
    pub fn one_minus_cos(&mut self) -> f32 {
        let values = [0.0, 1e-9, 1e-4, 1.0, 2.0];
        self.or(&values, |r| match r.unit() < 0.5 {
            true => r.decades(1e-8, 2.0),
            false => r.between(0.0, 2.0),
        })
    }

    /// The sine of an elevation: level, vertical, close to level, any.
    pub fn sine(&mut self) -> f32 {
        let values = [0.0, 1e-6, -1e-6, 1.0, -1.0];
        self.or(&values, |r| match r.unit() < 0.5 {
            true => r.between(-0.02, 0.02),
            false => r.between(-1.0, 1.0),
        })
    }

    /// A height above ground, m.
    pub fn height_m(&mut self) -> f32 {
        self.or(&[0.0, 1.7, 20.0, -5.0], |r| r.decades(0.1, 1e4))
    }

    /// A height at which a profile has its reference, base or edge, m.
    pub fn edge_m(&mut self) -> f32 {
        self.or(&[0.0, 20.0], |r| r.between(-10.0, 500.0))
    }

    /// A scale height, m.
    pub fn scale_m(&mut self) -> f32 {
        self.decades(5.0, 8e3)
    }

    /// The length of a ray, m.
    pub fn length_m(&mut self) -> f32 {
        self.or(&[0.0, 100.0, 1e12], |r| r.decades(1e-2, 1e5))
    }

    /// 1 / R, 1/m: flat, the Earth, a small planet.
    pub fn inverse_radius_per_m(&mut self) -> f32 {
        self.one_of(&[0.0, 1.0 / 6.371e6, 1.0 / 6.371e6, 1e-5])
    }

    /// Three numbers, as the channels of a colour.
    pub fn rgb(&mut self, mut channel: impl FnMut(&mut Self) -> f32) -> [f32; 3] {
        std::array::from_fn(|_| channel(self))
    }

    /// A unit vector.
    pub fn direction(&mut self) -> [f32; 3] {
        let y = self.sine();
        let azimuth = self.between(0.0, std::f32::consts::TAU);
        let across = (1.0 - y * y).max(0.0).sqrt();
        [across * azimuth.sin(), y, -across * azimuth.cos()]
    }
}
