//! The forms that a lamp's light in uniform fog has been given.

use super::passage::Passage;
use super::printed::airlight_printed;
use super::split_sum::airlight_split_sum;
use super::{Lamp, airlight_isotropic, airlight_without_extinction};
use crate::fog::matter::{FogError, Layer};
use crate::fog::profile::Profile;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;

/// How the light of a lamp that fog scatters into a line of sight is worked out. All but the first hold for point lamps in
/// one layer of uniform fog that scatters equally in all directions ([`LampForm::check`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LampForm {
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

impl LampForm {
    /// Light of a lamp of unit intensity in fog of unit scattering coefficient, 1/m.
    pub fn airlight(self, passage: &Passage, extinction_per_m: f64) -> f64 {
        match self {
            Self::Exact => airlight_isotropic(passage, extinction_per_m),
            Self::SplitSum => airlight_split_sum(passage, extinction_per_m),
            Self::NoExtinction => airlight_without_extinction(passage),
            Self::Printed => airlight_printed(passage),
        }
    }

    /// What a layer of uniform fog, which scatters equally in all directions, scatters into a line past a lamp.
    pub fn path_radiance<const N: usize>(
        self,
        layer: &Layer<N>,
        passage: &Passage,
        intensity: Spectrum<N>,
    ) -> Spectrum<N> {
        let matter = &layer.matter;
        let extinction = matter.extinction_per_m;
        let of_lane = |lane: usize| self.airlight(passage, f64::from(extinction[lane])) as f32;
        matter.scattering_per_m() * intensity * Spectrum::from_fn(of_lane)
    }

    /// Refuses lamps and layers that the form does not hold for.
    ///
    /// # Errors
    /// [`FogError::LampForm`]: what there is too much of.
    pub fn check<const N: usize>(
        self,
        lamps: &[Lamp<N>],
        layers: &[Layer<N>],
    ) -> Result<(), FogError> {
        let what = match layers {
            _ if self == Self::Exact => return Ok(()),
            [layer] if layer.profile != Profile::Uniform => "fog that thins with height",
            [layer] if layer.matter.phase != PhaseFunction::Isotropic => {
                "fog that scatters more in some directions"
            }
            [_] => match lamps.iter().all(|lamp| matches!(lamp, Lamp::Point(_))) {
                true => return Ok(()),
                false => "a lamp that is no point",
            },
            _ => "more or fewer layers than one",
        };
        Err(FogError::LampForm { what })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fog::droplets::DropletKind;
    use crate::fog::lamp::{LampSettings, Lamps, Murk, PointLamp, Sight, SphereLamp};
    use crate::spectrum::rgb::DOMINANT_NM;
    use glam::DVec3;

    fn layer(profile: Profile, droplets: &str) -> Layer<3> {
        let (_, kind) = DropletKind::all()
            .find(|(name, _)| *name == droplets)
            .unwrap();
        Layer {
            profile,
            matter: kind.at_wavelengths(0.27, &DOMINANT_NM).unwrap(),
        }
    }

    #[test]
    fn the_exact_form_is_that_of_lamps() {
        let even = layer(Profile::Uniform, "isotropic");
        let intensity = Spectrum([3.0, 2.0, 1.0]);
        let lamp = PointLamp::new(DVec3::new(1.0, 0.0, -5.0), intensity, 0.01).unwrap();
        let sight = Sight {
            eye: DVec3::ZERO,
            direction: DVec3::NEG_Z,
            length_m: 20.0,
        };
        let murk = Murk {
            matter: &even.matter,
            profile: &even.profile,
            others: &[],
            wavelengths_nm: &DOMINANT_NM,
            ground_radius_m: f64::INFINITY,
        };
        let lamps = Lamps::new(vec![Lamp::Point(lamp)], LampSettings::default()).unwrap();
        let right = lamps.path_radiance(&murk, &sight);
        let passage = Passage::new(sight.eye, sight.direction, 20.0, lamp.position, 0.01);
        let of = |form: LampForm| form.path_radiance(&even, &passage, intensity);
        for lane in 0..3 {
            assert!((of(LampForm::Exact)[lane] / right[lane] - 1.0).abs() < 1e-5);
            // 5.8 times too bright in dense fog.
            let without = of(LampForm::NoExtinction)[lane] / right[lane];
            assert!((without / 5.8 - 1.0).abs() < 3e-3, "{without}");
            assert!(of(LampForm::Printed)[lane] < 0.0);
            let split = of(LampForm::SplitSum)[lane] / right[lane];
            assert!((split / 0.6706 - 1.0).abs() < 1e-3, "{split}");
        }
    }

    #[test]
    fn forms_refuse_what_they_do_not_hold_for() {
        let point = Lamp::Point(PointLamp::new(DVec3::ZERO, Spectrum::ONE, 0.1).unwrap());
        let ball = Lamp::Sphere(SphereLamp::new(DVec3::ZERO, 0.1, Spectrum::ONE).unwrap());
        let even = layer(Profile::Uniform, "isotropic");
        let forward = layer(Profile::Uniform, "radiation");
        let slab = layer(Profile::Slab { top_height_m: 9.0 }, "isotropic");
        for form in [
            LampForm::SplitSum,
            LampForm::NoExtinction,
            LampForm::Printed,
        ] {
            let refused = |lamp: &Lamp<3>, layers: &[Layer<3>]| match form.check(&[*lamp], layers) {
                Err(FogError::LampForm { what }) => what,
                other => panic!("{other:?}"),
            };
            assert_eq!(form.check(&[point], std::slice::from_ref(&even)), Ok(()));
            assert!(refused(&ball, std::slice::from_ref(&even)).contains("no point"));
            assert!(refused(&point, std::slice::from_ref(&forward)).contains("directions"));
            assert!(refused(&point, std::slice::from_ref(&slab)).contains("height"));
            assert!(refused(&point, &[even.clone(), even.clone()]).contains("layers"));
        }
        assert_eq!(LampForm::Exact.check(&[ball], &[slab, forward]), Ok(()));
    }
}
