//! The forms that a lamp's light in uniform fog has been given.

use super::geometry::LightRayGeometry;
use super::printed::airlight_printed;
use super::split_sum::airlight_split_sum;
use super::{Light, airlight_isotropic, airlight_without_extinction};
use crate::fog::layer::{FogError, Layer};
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;

/// How the light of a lamp that fog scatters into a line of sight is worked out. All but the first hold for point lamps in
/// one layer of uniform fog that scatters equally in all directions ([`LightForm::check`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightForm {
    /// Dimmed on both legs.
    #[default]
    Exact,
    /// The opacity of the line times the mean of the source on it: [`airlight_split_sum`].
    SplitSum,
    /// Not dimmed: [`airlight_without_extinction`].
    NoExtinction,
    /// As the fog note prints it: [`airlight_printed`].
    Printed,
}

impl LightForm {
    /// Light of a lamp of unit intensity in fog of unit scattering coefficient, 1/m.
    pub fn airlight(self, geometry: &LightRayGeometry, extinction_per_m: f64) -> f64 {
        match self {
            Self::Exact => airlight_isotropic(geometry, extinction_per_m),
            Self::SplitSum => airlight_split_sum(geometry, extinction_per_m),
            Self::NoExtinction => airlight_without_extinction(geometry),
            Self::Printed => airlight_printed(geometry),
        }
    }

    /// What a layer of uniform fog, which scatters equally in all directions, scatters into a line past a lamp.
    pub fn path_radiance<const N: usize>(
        self,
        layer: &Layer<N>,
        geometry: &LightRayGeometry,
        intensity: Spectrum<N>,
    ) -> Spectrum<N> {
        let medium = &layer.medium;
        let extinction = medium.extinction_per_m;
        let of_lane = |lane: usize| self.airlight(geometry, f64::from(extinction[lane])) as f32;
        medium.scattering_per_m() * intensity * Spectrum::from_fn(of_lane)
    }

    /// Refuses lamps and layers that the form does not hold for.
    ///
    /// # Errors
    /// [`FogError::LightForm`]: what there is too much of.
    pub fn check<const N: usize>(
        self,
        lights: &[Light<N>],
        layers: &[Layer<N>],
    ) -> Result<(), FogError> {
        let what = match layers {
            _ if self == Self::Exact => return Ok(()),
            [layer] if !layer.profile.is_uniform() => "fog that thins with height",
            [layer] if layer.medium.phase != PhaseFunction::Isotropic => {
                "fog that scatters more in some directions"
            }
            [_] => match lights.iter().all(|light| matches!(light, Light::Point(_))) {
                true => return Ok(()),
                false => "a lamp that is no point",
            },
            _ => "more or fewer layers than one",
        };
        Err(FogError::LightForm { what })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::DensityProfile;
    use crate::fog::droplets::DropletKind;
    use crate::fog::lights::{
        LightSet, LightSettings, ParticipatingMedium, PointLight, SphereLight, ViewRay,
    };
    use crate::spectrum::rgb::DOMINANT_NM;
    use glam::DVec3;

    fn layer(profile: DensityProfile, droplets: &str) -> Layer<3> {
        let (_, kind) = DropletKind::all()
            .find(|(name, _)| *name == droplets)
            .unwrap();
        Layer {
            profile,
            medium: kind.at_wavelengths(0.27, &DOMINANT_NM).unwrap(),
        }
    }

    #[test]
    fn the_exact_form_is_that_of_lamps() {
        let even = layer(DensityProfile::Uniform, "isotropic");
        let intensity = Spectrum([3.0, 2.0, 1.0]);
        let light = PointLight::new(DVec3::new(1.0, 0.0, -5.0), intensity, 0.01).unwrap();
        let view_ray = ViewRay {
            eye: DVec3::ZERO,
            direction: DVec3::NEG_Z,
            length_m: 20.0,
        };
        let medium = ParticipatingMedium {
            medium: &even.medium,
            profile: &even.profile,
            others: &[],
            wavelengths_nm: &DOMINANT_NM,
            ground_radius_m: f64::INFINITY,
        };
        let lights = LightSet::new(vec![Light::Point(light)], LightSettings::default()).unwrap();
        let right = lights.path_radiance(&medium, &view_ray);
        let geometry =
            LightRayGeometry::new(view_ray.eye, view_ray.direction, 20.0, light.position, 0.01);
        let of = |form: LightForm| form.path_radiance(&even, &geometry, intensity);
        for lane in 0..3 {
            assert!((of(LightForm::Exact)[lane] / right[lane] - 1.0).abs() < 1e-5);
            // 5.8 times too bright in dense fog.
            let without = of(LightForm::NoExtinction)[lane] / right[lane];
            assert!((without / 5.8 - 1.0).abs() < 3e-3, "{without}");
            assert!(of(LightForm::Printed)[lane] < 0.0);
            let split = of(LightForm::SplitSum)[lane] / right[lane];
            assert!((split / 0.6706 - 1.0).abs() < 1e-3, "{split}");
        }
    }

    #[test]
    fn forms_refuse_what_they_do_not_hold_for() {
        let point = Light::Point(PointLight::new(DVec3::ZERO, Spectrum::ONE, 0.1).unwrap());
        let ball = Light::Sphere(SphereLight::new(DVec3::ZERO, 0.1, Spectrum::ONE).unwrap());
        let even = layer(DensityProfile::Uniform, "isotropic");
        let forward = layer(DensityProfile::Uniform, "radiation");
        let slab = layer(DensityProfile::slab(9.0), "isotropic");
        for form in [
            LightForm::SplitSum,
            LightForm::NoExtinction,
            LightForm::Printed,
        ] {
            let refused =
                |light: &Light<3>, layers: &[Layer<3>]| match form.check(&[*light], layers) {
                    Err(FogError::LightForm { what }) => what,
                    other => panic!("{other:?}"),
                };
            assert_eq!(form.check(&[point], std::slice::from_ref(&even)), Ok(()));
            assert!(refused(&ball, std::slice::from_ref(&even)).contains("no point"));
            assert!(refused(&point, std::slice::from_ref(&forward)).contains("directions"));
            assert!(refused(&point, std::slice::from_ref(&slab)).contains("height"));
            assert!(refused(&point, &[even.clone(), even.clone()]).contains("layers"));
        }
        assert_eq!(LightForm::Exact.check(&[ball], &[slab, forward]), Ok(()));
    }
}
