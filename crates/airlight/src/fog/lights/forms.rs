//! [`LightForm`]: scattering of a point light in uniform fog, exact and as in the fog note (after Macklin 2010).
//!
//! # The printed form
//! For uniform fog with scattering coefficient `sigma`, a surface at `p`, a camera at the distance `d`, and a light at `s` with
//! intensity `I`:
//!
//! ```text
//! b = (p - s) . v,  c = |p - s|^2,  v = sqrt(c - b^2),  x = (b + d) / v,  y = b / v
//! S = sigma pi I / v  arctan((x - y) / (1 + x y))
//! ```
//!
//! Errata:
//! - The arctangent is wrong by pi if `1 + x y < 0`, when the ray subtends more than a right angle at the light: for b = -5,
//!   c = 26, d = 20 it is -0.2640 instead of 2.8776. The path radiance is then negative.
//! - A light of intensity `I` causes the irradiance `I / r^2`, and the isotropic phase function is `1 / (4 pi)`: the source is
//!   `I / (4 pi r^2)`, not `pi I / r^2`. The printed form is `4 pi^2` = 39.5 times too bright.
//! - The note omits transmittance "because only single scattering is considered", but extinction before and after scattering is
//!   part of single scattering.
//!
//! [`airlight_without_extinction`] corrects the first two, [`airlight_isotropic`] all three.

use super::closed_form::{airlight_isotropic, airlight_without_extinction};
use super::geometry::LightRayGeometry;
use super::light::Light;
use crate::fog::closed_forms::Lanes;
use crate::fog::error::FogError;
use crate::fog::layer::LayerLanes;
use crate::math::quadrature::FixedRule;
use crate::names::named;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;
use std::f64::consts::PI;

/// Form of the scattering of lights. All but [`LightForm::Exact`] are for point lights in one layer of uniform, isotropically
/// scattering fog.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LightForm {
    /// With extinction between light, fog and eye; for all lights and layers.
    #[default]
    Exact,
    /// Opacity of the ray times the mean source: within 5 % up to an optical depth of 1, for a light halfway along the ray.
    SplitSum,
    /// Without extinction: [`airlight_without_extinction`].
    NoExtinction,
    /// As printed in the fog note.
    Printed,
}

named! { LightForm, "a form of in-scattering", [
    ("exact", (Exact), "with extinction between light, fog and eye, in any fog (Sun et al. 2005 in uniform fog)"),
    ("split-sum", (SplitSum), "opacity of the view ray times the mean of its source: the split sum of the fog note"),
    ("no-extinction", (NoExtinction), "without extinction: the formula of the fog note with the right angle and unit"),
    ("printed", (Printed), "as printed in the fog note: 40 times too bright, and negative where the ray passes the light"),
] }

impl LightForm {
    /// Path radiance for unit intensity and unit scattering coefficient, 1/m.
    pub fn airlight(self, geometry: &LightRayGeometry, extinction_per_m: f64) -> f64 {
        match self {
            Self::Exact => airlight_isotropic(geometry, extinction_per_m),
            Self::SplitSum => airlight_split_sum(geometry, extinction_per_m),
            Self::NoExtinction => airlight_without_extinction(geometry),
            Self::Printed => airlight_printed(geometry),
        }
    }

    /// Path radiance of a layer of uniform, isotropically scattering fog.
    pub(super) fn path_radiance<const N: usize>(
        self,
        layer: &LayerLanes<N>,
        geometry: &LightRayGeometry,
        intensity: Spectrum<N>,
    ) -> Spectrum<N> {
        let extinction = layer.extinction_per_m;
        let of_lane = |lane: usize| self.airlight(geometry, f64::from(extinction[lane])) as f32;
        layer.scattering_per_m * intensity * Spectrum::from_fn(of_lane)
    }

    /// Checks whether the form is valid for lights and layers.
    ///
    /// # Errors
    /// [`FogError::LightForm`] if it is not.
    pub(super) fn check<C, const N: usize>(
        self,
        lights: &[Light<C>],
        layers: &[LayerLanes<N>],
    ) -> Result<(), FogError> {
        let got = match layers {
            _ if self == Self::Exact => return Ok(()),
            [layer] if !layer.density.is_uniform() => "fog whose density depends on height",
            [layer] if layer.phase != PhaseFunction::Isotropic => {
                "fog with a directional phase function"
            }
            [_] => match lights.iter().all(|light| matches!(light, Light::Point(_))) {
                true => return Ok(()),
                false => "a light that is not a point light",
            },
            _ => "no layer or several layers",
        };
        Err(FogError::LightForm { got })
    }
}

/// The printed form in 1/m, to be multiplied by intensity and scattering coefficient. It is symmetric in the ends of the ray; for
/// an infinite ray it is the limit `arctan(1 / y)`.
#[inline]
pub(crate) fn airlight_printed(geometry: &LightRayGeometry) -> f64 {
    let v = geometry.nearest_m;
    let y = geometry.start_m / v;
    let x = (geometry.start_m + geometry.length_m) / v;
    let tangent = match x.is_finite() {
        true => (x - y) / (1.0 + x * y),
        false => 1.0 / y,
    };
    PI / v * tangent.atan()
}

/// Limit of the integral along an infinite ray, in `asinh(u / h)` from the point closest to the light; a fraction of 1e-16 lies
/// beyond.
const REACH: f64 = 37.0;
/// Length of a Gauss-Legendre panel in the same coordinate.
const PANEL: f64 = 2.0;

/// The split sum of the fog note in 1/m, `(1 - T) (1 / d) int J dt` with the attenuated source `J` of the light, to be multiplied
/// by intensity and scattering coefficient.
///
/// With `u = h sinh s` the integral is `1 / (4 pi h) int e^-(sigma h cosh s) / cosh s ds`, by Gauss-Legendre quadrature:
/// relative error below 1e-6 up to an optical depth of 10 between light and ray. The split sum is within 5 % of
/// [`airlight_isotropic`] up to an optical depth of 1 of the ray, for a light halfway along it. For an infinite ray it is 0, as
/// the mean of the source is 0.
pub(crate) fn airlight_split_sum(geometry: &LightRayGeometry, extinction_per_m: f64) -> f64 {
    static RULE: FixedRule<12> = FixedRule::fixed();
    if extinction_per_m == 0.0 {
        return airlight_without_extinction(geometry);
    }
    let h = geometry.nearest_m;
    let place = |u: f64| (u / h).asinh().clamp(-REACH, REACH);
    let (first, last) = (
        place(geometry.start_m),
        place(geometry.start_m + geometry.length_m),
    );
    let mean_transmittance = (extinction_per_m * geometry.length_m).mean_transmittance();
    let panels = ((last - first) / PANEL).ceil().max(1.0);
    let step = (last - first) / panels;
    let depth = extinction_per_m * h;
    let at = |s: f64| (-depth * s.cosh()).exp() / s.cosh();
    let sum: f64 = (0..panels as u32)
        .map(|k| {
            let from = first + step * f64::from(k);
            RULE.integrate(from, from + step, at)
        })
        .sum();
    mean_transmittance * sum / (4.0 * PI * h)
}

#[cfg(test)]
mod tests {
    use super::super::{LightSettings, PointLight, RgbLightSet, SphereLight, ViewRay};
    use super::*;
    use crate::atmosphere::DensityProfile;
    use crate::fog::closed_forms::constant_source;
    use crate::fog::{Ground, RgbLayer};
    use crate::math::quadrature::GaussRule;
    use glam::DVec3;

    fn past(start_m: f64, length_m: f64) -> LightRayGeometry {
        LightRayGeometry {
            nearest_m: 1.0,
            start_m,
            length_m,
        }
    }

    #[test]
    fn errors_of_the_printed_form_are_those_of_the_errata() {
        // b = -5, c = 26, d = 20.
        let passed = past(-5.0, 20.0);
        let printed = airlight_printed(&passed) / PI;
        assert!((printed + 0.2640).abs() < 5e-5, "{printed}");
        let right = 4.0 * PI * airlight_without_extinction(&passed);
        assert!((right - 2.8776).abs() < 5e-5, "{right}");
        assert!((right - printed - PI).abs() < 1e-12);
        // Symmetric in the ends of the ray.
        assert!((airlight_printed(&passed.reversed()) / PI - printed).abs() < 1e-12);
    }

    #[test]
    fn the_printed_form_is_wrong_by_a_factor_below_a_right_angle() {
        for (start_m, length_m) in [
            (-5.0, 4.0),
            (0.5, 20.0),
            (3.0, f64::INFINITY),
            (-0.5, 2.0),
            (-1.0, 1.9),
        ] {
            let geometry = past(start_m, length_m);
            let ratio = airlight_printed(&geometry) / airlight_without_extinction(&geometry);
            assert!(
                (ratio / (4.0 * PI * PI) - 1.0).abs() < 1e-12,
                "{start_m} {ratio}"
            );
        }
        // Negative above a right angle, also for an infinite ray.
        for (start_m, length_m) in [(-1.0, 2.1), (-1.0, f64::INFINITY)] {
            let printed = airlight_printed(&past(start_m, length_m));
            assert!(printed < 0.0 && printed.is_finite(), "{start_m} {printed}");
        }
        assert_eq!(airlight_printed(&past(-3.0, 0.0)), 0.0);
    }

    fn geometry(nearest_m: f64, start_m: f64, length_m: f64) -> LightRayGeometry {
        LightRayGeometry {
            nearest_m,
            start_m,
            length_m,
        }
    }

    #[test]
    fn the_split_sum_matches_quadrature() {
        for (h, start, length) in [
            (1.0, -5.0, 20.0),
            (0.01, -8.0, 9.0),
            (3.0, 4.0, 30.0),
            (0.5, -40.0, 30.0),
            (2.0, -1e-3, 1e-2),
        ] {
            for sigma in [0.0, 1e-3, 0.1, 0.27, 1.0] {
                if sigma * h > 10.0 || sigma * f64::hypot(h, start) > 10.0 {
                    continue;
                }
                let geometry = geometry(h, start, length);
                // In the angle that the ray subtends at the light.
                let (from, to) = ((start / h).atan(), ((start + length) / h).atan());
                let mean = GaussRule::new(3000)
                    .integrate(from, to, |angle| (-sigma * h / angle.cos()).exp())
                    / (4.0 * PI * h * length);
                let opacity = (sigma * length).mean_transmittance() * length;
                let got = airlight_split_sum(&geometry, sigma);
                assert!(
                    (got / (opacity * mean) - 1.0).abs() < 1e-6,
                    "{geometry:?} {sigma}: {got} {}",
                    opacity * mean
                );
                let source = Spectrum([(mean / sigma) as f32]);
                let general = constant_source(Spectrum([(sigma * length) as f32]), source);
                if sigma > 0.0 {
                    assert!((f64::from(general.path_radiance[0]) / got - 1.0).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn errors_of_the_split_sum_grow_with_optical_depth() {
        // A table of the book: light halfway along the ray, at h times its length from it; error in percent.
        for (tau, h, percent) in [
            (0.1, 0.1, 0.0),
            (0.5, 0.1, 0.7),
            (1.0, 0.01, 4.1),
            (1.0, 0.1, 3.0),
            (1.0, 0.5, 0.9),
            (3.0, 0.1, 31.0),
            (3.0, 0.5, 11.0),
        ] {
            let geometry = geometry(h, -0.5, 1.0);
            let error = 100.0
                * (airlight_split_sum(&geometry, tau) / airlight_isotropic(&geometry, tau) - 1.0);
            let rounding = if percent < 10.0 { 0.06 } else { 0.6 };
            assert!((error - percent).abs() < rounding, "{tau} {h}: {error}");
        }
    }

    #[test]
    fn limits_of_the_split_sum() {
        let passing = geometry(1.0, -5.0, 20.0);
        let thin = airlight_split_sum(&passing, 0.0) / airlight_without_extinction(&passing);
        assert!((thin - 1.0).abs() < 1e-9);
        let infinite = geometry(1.0, -5.0, f64::INFINITY);
        assert_eq!(airlight_split_sum(&infinite, 0.1), 0.0);
        assert_eq!(airlight_split_sum(&geometry(1.0, -5.0, 0.0), 0.1), 0.0);
        assert_eq!(airlight_split_sum(&passing, 1e6), 0.0);
    }

    fn layer(density: DensityProfile, phase: PhaseFunction) -> RgbLayer {
        RgbLayer {
            density,
            extinction_per_m: [0.27; 3],
            single_scattering_albedo: [1.0; 3],
            phase,
        }
    }

    /// A set of one light in one form.
    fn set(
        light: Light<[f32; 3]>,
        layers: &[RgbLayer],
        form: LightForm,
    ) -> Result<RgbLightSet, FogError> {
        let settings = LightSettings {
            form,
            ..LightSettings::default()
        };
        RgbLightSet::new(vec![light], layers, Ground::FLAT, settings)
    }

    #[test]
    fn ratios_of_forms_to_the_exact_form() {
        let uniform = layer(DensityProfile::Uniform, PhaseFunction::Isotropic);
        let intensity = [3.0, 2.0, 1.0];
        let light = PointLight::new(DVec3::new(1.0, 0.0, -5.0), intensity, 0.01).unwrap();
        let view_ray = ViewRay {
            eye: DVec3::ZERO,
            direction: DVec3::NEG_Z,
            length_m: 20.0,
        };
        let of = |form| {
            let set = set(Light::Point(light), std::slice::from_ref(&uniform), form);
            set.unwrap().path_radiance(&view_ray)
        };
        let right = of(LightForm::Exact);
        let geometry =
            LightRayGeometry::new(view_ray.eye, view_ray.direction, 20.0, light.position, 0.01);
        let lanes = LayerLanes::<3>::rgb(&uniform);
        let exact = LightForm::Exact.path_radiance(&lanes, &geometry, Spectrum(intensity));
        for lane in 0..3 {
            assert!((exact[lane] / right[lane] - 1.0).abs() < 1e-5);
            // 5.8 times too bright.
            let without = of(LightForm::NoExtinction)[lane] / right[lane];
            assert!((without / 5.8 - 1.0).abs() < 3e-3, "{without}");
            assert!(of(LightForm::Printed)[lane] < 0.0);
            let split = of(LightForm::SplitSum)[lane] / right[lane];
            assert!((split / 0.6706 - 1.0).abs() < 1e-3, "{split}");
        }
    }

    #[test]
    fn forms_reject_invalid_lights_and_layers() {
        let point = Light::Point(PointLight::new(DVec3::ZERO, [1.0; 3], 0.1).unwrap());
        let sphere = Light::Sphere(SphereLight::new(DVec3::ZERO, 0.1, [1.0; 3]).unwrap());
        let uniform = layer(DensityProfile::Uniform, PhaseFunction::Isotropic);
        let forward = layer(
            DensityProfile::Uniform,
            PhaseFunction::HenyeyGreenstein { g: 0.8 },
        );
        let slab = layer(DensityProfile::slab(9.0), PhaseFunction::Isotropic);
        for form in [
            LightForm::SplitSum,
            LightForm::NoExtinction,
            LightForm::Printed,
        ] {
            let refused = |light: Light<[f32; 3]>, layers: &[&RgbLayer]| {
                let layers: Vec<RgbLayer> = layers.iter().map(|&layer| layer.clone()).collect();
                match set(light, &layers, form) {
                    Err(FogError::LightForm { got }) => got,
                    other => panic!("{other:?}"),
                }
            };
            assert!(set(point, std::slice::from_ref(&uniform), form).is_ok());
            assert!(refused(sphere, &[&uniform]).contains("not a point"));
            assert!(refused(point, &[&forward]).contains("directional"));
            assert!(refused(point, &[&slab]).contains("height"));
            assert!(refused(point, &[&uniform, &uniform]).contains("layers"));
        }
        assert!(set(sphere, &[slab, forward], LightForm::Exact).is_ok());
    }
}
