//! Lighting of a fog by sun and sky, and the ground below it.

use super::error::{FogError, check_light};
use super::values::ChannelValues;
use crate::atmosphere::{DensityProfile, RaySegment};
use crate::names::named;
use crate::spectrum::SpectralCurve;
use glam::DVec3;
use std::f32::consts::PI;

/// Sunlight above the fog. `C` is a [`SpectralCurve`], or `[f32; 3]` for red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight<C = SpectralCurve> {
    /// Unit vector towards the sun.
    pub direction: DVec3,
    /// Irradiance above the fog on a surface that faces the sun (W m^-2 nm^-1, lux, or any other unit).
    pub irradiance: C,
}

/// Lighting of a fog. `C` is a [`SpectralCurve`], or `[f32; 3]` for red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLighting<C = SpectralCurve> {
    /// The sun, if it is above the horizon.
    pub sun: Option<DirectionalLight<C>>,
    /// Radiance that arrives uniformly from all directions, such as the mean of the sky; with [`FogScattering::Multiple`] from
    /// above only.
    pub ambient: C,
    /// Lambertian albedo of the ground, 0 to 1; used by [`FogScattering::Multiple`] only.
    pub ground_albedo: C,
}

/// The ground below a fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Height, m.
    pub height_m: f64,
    /// Radius, m; infinite for flat ground.
    pub radius_m: f64,
}

/// Orders of scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum FogScattering {
    /// Single scattering without attenuation between the light and the point of scattering: Ishiyama's model as printed.
    /// Correct for thin fog, too bright in thick fog.
    Undimmed,
    /// Single scattering of attenuated sunlight, and of ambient light that is the same everywhere.
    #[default]
    Single,
    /// All orders of scattering: sunlight and sky light enter at the top, and the ground reflects. Solved once when the fog is
    /// built. Fog without an upper end, which no light could enter, is lit uniformly by the ambient light and by the
    /// unattenuated sun.
    Multiple,
}

named! { FogScattering, "a kind of fog scattering", [
    ("all", (Multiple), "all orders of scattering, with light reflected by the ground"),
    ("single", (Single), "single scattering of attenuated sunlight and of uniform ambient light"),
    ("undimmed", (Undimmed), "single scattering of unattenuated sunlight: Ishiyama's height fog as printed"),
] }

impl Ground {
    /// Flat ground at height 0.
    pub const FLAT: Self = Self {
        height_m: 0.0,
        radius_m: f64::INFINITY,
    };

    /// Ground with the Earth's mean radius at height 0.
    pub const EARTH: Self = Self {
        height_m: 0.0,
        radius_m: 6.371e6,
    };

    /// Whether the ground is flat.
    #[inline]
    pub(crate) fn is_flat(&self) -> bool {
        self.radius_m == f64::INFINITY
    }

    /// Whether an infinite ray hits the ground.
    #[inline]
    pub(super) fn blocks(&self, ray: &RaySegment) -> bool {
        if self.is_flat() {
            return ray.sin_elevation <= 0.0;
        }
        ray.sin_elevation < 0.0 && ray.lowest_height_m() < self.height_m
    }

    pub(super) fn validate(&self) -> Result<(), FogError> {
        let number = |what, got: f64, expected| {
            Err(FogError::Number {
                what,
                got,
                expected,
            })
        };
        if !self.height_m.is_finite() {
            return number("height of the ground (m)", self.height_m, "a finite number");
        }
        match self.radius_m > 0.0 {
            true => Ok(()),
            false => number(
                "radius of the ground (m)",
                self.radius_m,
                "a number above 0, or infinity for flat ground",
            ),
        }
    }
}

/// [`effective_top_of_layers_m`] from the optical depth above a height, m, or a multiple of that.
fn effective_top_m(ground_height_m: f64, depth_above: impl Fn(f64) -> f64) -> f64 {
    const ABOVE: f64 = 0.01;
    const HIGHEST_M: f64 = 100e3;
    let whole = depth_above(ground_height_m);
    let (mut low, mut high) = (ground_height_m, ground_height_m + HIGHEST_M);
    if whole <= 0.0 || !whole.is_finite() {
        return low;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match depth_above(middle) > ABOVE * whole {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// Height of a fog's effective top, m, from the density profiles of its layers and their extinctions at density 1, 1/m: 1 % of the optical
/// depth above the ground lies above it, and sun and sky light the fog as they do there. It is at most 100 km above the ground; the ground
/// itself where no fog lies above that. Layers without an upper end do not count.
pub fn effective_top_of_layers_m<'a>(
    ground_height_m: f64,
    layers: impl Iterator<Item = (&'a DensityProfile, f32)> + Clone,
) -> f64 {
    let depth_above = |height_m: f64| -> f64 {
        let depth = |(density, extinction_per_m): (&DensityProfile, f32)| {
            let column_m = density.column_above_m(height_m);
            match column_m.is_finite() {
                true => column_m * f64::from(extinction_per_m),
                false => 0.0,
            }
        };
        layers.clone().map(depth).sum()
    };
    effective_top_m(ground_height_m, depth_above)
}

impl<C> FogLighting<C> {
    /// Converts the values of all channels.
    pub(crate) fn map<D>(&self, values: impl Fn(&C) -> D) -> FogLighting<D> {
        FogLighting {
            sun: self.sun.as_ref().map(|sun| DirectionalLight {
                direction: sun.direction,
                irradiance: values(&sun.irradiance),
            }),
            ambient: values(&self.ambient),
            ground_albedo: values(&self.ground_albedo),
        }
    }
}

impl FogLighting<[f32; 3]> {
    /// Radiance of a white horizontal surface in sunlight and ambient light.
    pub fn white_radiance(&self) -> [f32; 3] {
        let sunlight = self.sun.map_or([0.0; 3], |sun| {
            let factor = sun.direction.y.max(0.0) as f32 / PI;
            sun.irradiance.map(|c| c * factor)
        });
        std::array::from_fn(|i| self.ambient[i] + sunlight[i])
    }
}

impl<C: ChannelValues> FogLighting<C> {
    pub(super) fn validate(&self) -> Result<(), FogError> {
        check_light("ambient light", &self.ambient)?;
        check_light("albedo of the ground", &self.ground_albedo)?;
        if self.ground_albedo.largest() > 1.0 {
            return Err(FogError::Number {
                what: "albedo of the ground",
                got: self.ground_albedo.largest(),
                expected: "numbers from 0 to 1",
            });
        }
        if let Some(sun) = &self.sun {
            check_light("irradiance of the sun", &sun.irradiance)?;
            let length = sun.direction.length();
            if (length - 1.0).abs() > 1e-6 || length.is_nan() {
                return Err(FogError::Number {
                    what: "length of the direction to the sun",
                    got: length,
                    expected: "a unit vector; try normalizing it",
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_effective_top_leaves_a_hundredth_of_the_depth_above() {
        let top_m = effective_top_m(300.0, |height_m| 2.0 * (-height_m / 50.0).exp());
        assert!((top_m - 300.0 - 50.0 * 100f64.ln()).abs() < 1e-6, "{top_m}");
        for none in [0.0, f64::INFINITY] {
            assert_eq!(effective_top_m(300.0, |_| none), 300.0);
        }
    }
}
