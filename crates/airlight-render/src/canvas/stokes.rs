//! Polarisation of a pixel's light.

use airlight::monte_carlo::PolarisedSample;

/// Channels of a polarisation map: degree and angle of linear polarisation, and `Q` and `U` over `I`.
pub const POLARIZATION_CHANNELS: [&str; 4] = ["degree", "angle_deg", "Q_over_I", "U_over_I"];

/// Sums of the Stokes parameters `I`, `Q`, `U` over the paths of a pixel, weighted by luminance.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelStokes([f64; 3]);

impl PixelStokes {
    /// Adds a bundle of paths; `weights` are those of the wavelengths in luminance.
    pub fn add(&mut self, sample: &PolarisedSample, weights: impl Iterator<Item = f64>) {
        for (lane, weight) in weights.enumerate() {
            for (sum, part) in self.0.iter_mut().zip(&sample.stokes) {
                *sum += weight * part[lane];
            }
        }
    }

    /// Values of [`POLARIZATION_CHANNELS`]; zeros where there is no light.
    pub fn channels(&self) -> [f32; 4] {
        let [i, q, u] = self.0;
        if i <= 0.0 {
            return [0.0; 4];
        }
        let angle = (0.5 * u.atan2(q)).to_degrees().rem_euclid(180.0);
        [q.hypot(u) / i, angle.rem_euclid(180.0), q / i, u / i].map(|v| v as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degree_and_angle_follow_from_the_stokes_parameters() {
        let sample = |q: f64, u: f64| PolarisedSample {
            scalar: Default::default(),
            stokes: [vec![2.0], vec![q], vec![u]],
        };
        let channels = |q, u| {
            let mut pixel = PixelStokes::default();
            pixel.add(&sample(q, u), std::iter::once(0.5));
            pixel.channels()
        };
        assert_eq!(channels(1.0, 0.0), [0.5, 0.0, 0.5, 0.0]);
        assert_eq!(channels(-1.0, 0.0), [0.5, 90.0, -0.5, 0.0]);
        assert_eq!(channels(0.0, 1.0), [0.5, 45.0, 0.0, 0.5]);
        assert_eq!(channels(0.0, -1.0), [0.5, 135.0, 0.0, -0.5]);
        assert_eq!(PixelStokes::default().channels(), [0.0; 4]);
    }
}
