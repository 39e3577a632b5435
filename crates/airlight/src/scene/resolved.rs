//! [`ResolvedScene`]: the input from which models are prepared.

use super::{
    FogLayers, Input, NightSettings, NightSpec, ObjectsSpec, Scene, SceneError, SolverSpec,
    SunSource,
};
use crate::atmosphere::Atmosphere;
use crate::spectrum::WavelengthGrid;

/// Height above the ground up to which an eye counts as on the ground, m; models for eyes on the ground accept it.
const ON_THE_GROUND_M: f64 = 100.0;

/// A scene in physical quantities, the input of [`RadianceModel::prepare`](super::RadianceModel::prepare).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ResolvedScene {
    /// The atmosphere, without the fog.
    pub atmosphere: Atmosphere,
    /// Wavelengths to compute, for models without wavelengths of their own: those that the scene names, or
    /// [`WavelengthGrid::standard`]; see [`ResolvedScene::for_colors`].
    pub grid: WavelengthGrid,
    /// Altitude of the eye above sea level, m.
    pub observer_altitude_m: f64,
    /// Position of the sun, or place and time that determine it.
    pub sun: SunSource,
    /// Lights of the night; `None` if there are none.
    pub night: Option<NightSettings>,
    /// Fog near the ground.
    pub fog: Option<FogLayers>,
    /// Whether objects stand in front of the sky.
    pub has_objects: bool,
    /// Solver or published model, and its settings.
    pub solver: SolverSpec,
    /// The inputs that are set explicitly, in the order of [`Input`].
    pub set_inputs: Vec<Input>,
}

impl ResolvedScene {
    /// The scene for pictures, which need colours but no spectra: at the wavelengths that it names, or those of
    /// [`WavelengthGrid::fast`], whose colours differ from those of [`WavelengthGrid::standard`] by a CIEDE2000 of at most 0.3.
    pub fn for_colors(mut self) -> Self {
        if self.solver.wavelengths.is_none() {
            self.grid = WavelengthGrid::fast();
        }
        self
    }
}

impl Scene {
    /// Converts the scene to physical quantities.
    ///
    /// # Errors
    /// [`SceneError`] for invalid values, and for values that contradict each other.
    pub fn resolve(&self) -> Result<ResolvedScene, SceneError> {
        self.validate()?;
        let atmosphere = self.atmosphere()?;
        let observer_altitude_m = self.observer_altitude_m(&atmosphere);
        let sun = self.sun_source(&atmosphere, observer_altitude_m)?;
        let wavelengths = self.solver.wavelengths.as_deref().unwrap_or("standard");
        let grid = wavelengths
            .parse::<WavelengthGrid>()
            .map_err(|error| SceneError::refused("solver.wavelengths", error))?;
        let contrast = self.air.visibility_contrast();
        let fog = self
            .fog
            .as_ref()
            .map(|fog| fog.resolve(contrast))
            .transpose()?;
        let mut set_inputs = self.set_inputs();
        if observer_altitude_m - atmosphere.planet.ground_altitude_m > ON_THE_GROUND_M {
            set_inputs.push(Input::ObserverHeight);
            set_inputs.sort();
        }
        Ok(ResolvedScene {
            night: self.night.resolve(&atmosphere),
            atmosphere,
            grid,
            observer_altitude_m,
            sun,
            fog,
            has_objects: self.objects.as_ref().is_some_and(ObjectsSpec::is_set),
            solver: self.solver.clone(),
            set_inputs,
        })
    }

    /// The inputs that the scene sets explicitly, in the order of [`Input`]. [`Scene::resolve`] adds
    /// [`Input::ObserverHeight`], which depends on the atmosphere.
    pub fn set_inputs(&self) -> Vec<Input> {
        let (air, solver, output) = (&self.air, &self.solver, &self.output);
        let is = |flag: Option<bool>| flag == Some(true);
        let inputs = [
            (
                Input::Atmosphere,
                air.atmosphere.is_some() || air.atmosphere_toml.is_some(),
            ),
            (Input::Haze, air.sets_haze()),
            (Input::Ozone, air.ozone_du.is_some()),
            (Input::GroundAlbedo, air.ground_albedo.is_some()),
            (Input::SunDistance, self.sun.distance_ratio.is_some()),
            (Input::Night, self.night.sets_lights()),
            (Input::Fog, self.fog.is_some()),
            (
                Input::FogScattering,
                self.fog
                    .as_ref()
                    .is_some_and(|fog| fog.scattering.is_some()),
            ),
            (
                Input::FogPatches,
                self.fog.as_ref().is_some_and(|fog| fog.patches.is_some()),
            ),
            (Input::Lights, !self.lights.is_empty()),
            (
                Input::Objects,
                self.objects.as_ref().is_some_and(ObjectsSpec::is_set),
            ),
            (Input::Wavelengths, solver.wavelengths.is_some()),
            (Input::Scattering, solver.scattering.is_some()),
            (Input::Effort, solver.effort.is_some()),
            (
                Input::PolarisationCorrection,
                solver.polarisation_correction.is_some(),
            ),
            (
                Input::Paths,
                solver.paths.is_some() || solver.seed.is_some(),
            ),
            (Input::NoiseMap, is(output.noise_map)),
            (Input::Polarisation, is(output.polarisation)),
            (Input::Variant, solver.variant.is_some()),
            (
                Input::Sunlight,
                solver.sunlight.is_some() || solver.zenith_lux.is_some(),
            ),
            (Input::Klassen1987, solver.klassen1987 != Default::default()),
            (Input::Spectra, is(output.spectral)),
        ];
        inputs
            .into_iter()
            .filter(|(_, set)| *set)
            .map(|(input, _)| input)
            .collect()
    }

    /// The scene with an input reset to its default, to compare solvers of which only one honours it.
    pub fn without(mut self, input: Input) -> Self {
        let defaults = Self::default();
        match input {
            Input::Atmosphere => {
                self.air.atmosphere = None;
                self.air.atmosphere_toml = None;
            }
            Input::Haze => {
                self.air.aerosol = None;
                self.air.humidity = None;
                self.air.aod_550 = None;
                self.air.turbidity = None;
                self.air.haze_visibility_m = None;
            }
            Input::Ozone => self.air.ozone_du = None,
            Input::GroundAlbedo => self.air.ground_albedo = None,
            Input::ObserverHeight => self.observer = defaults.observer,
            Input::SunDistance => self.sun.distance_ratio = None,
            Input::Night => self.night = NightSpec::default(),
            Input::Fog => self.fog = None,
            Input::FogScattering => self.fog.iter_mut().for_each(|fog| fog.scattering = None),
            Input::FogPatches => self.fog.iter_mut().for_each(|fog| fog.patches = None),
            Input::Lights => self.lights.clear(),
            Input::Objects => self.objects = None,
            Input::Wavelengths => self.solver.wavelengths = None,
            Input::Scattering => self.solver.scattering = None,
            Input::Effort => self.solver.effort = None,
            Input::PolarisationCorrection => self.solver.polarisation_correction = None,
            Input::Paths => {
                self.solver.paths = None;
                self.solver.seed = None;
            }
            Input::NoiseMap => self.output.noise_map = None,
            Input::Polarisation => self.output.polarisation = None,
            Input::Variant => self.solver.variant = None,
            Input::Sunlight => {
                self.solver.sunlight = None;
                self.solver.zenith_lux = None;
            }
            Input::Klassen1987 => self.solver.klassen1987 = defaults.solver.klassen1987,
            Input::Spectra => self.output.spectral = None,
            Input::Distances => {}
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FogSpec, ObjectsSpec};
    use super::*;
    use crate::fog::FogScattering;

    fn full() -> Scene {
        let mut scene = Scene::default();
        scene.sun.elevation_deg = Some(20.0);
        scene.sun.distance_ratio = Some(1.01);
        scene.night.stars = Some(false);
        scene.air.atmosphere = Some("clear".to_owned());
        scene.air.aod_550 = Some(0.2);
        scene.air.ozone_du = Some(250.0);
        scene.air.ground_albedo = Some(0.3);
        scene.fog = Some(FogSpec {
            visibility_m: Some(200.0),
            scattering: Some(FogScattering::Single),
            patches: Some(Default::default()),
            ..Default::default()
        });
        scene.objects = Some(ObjectsSpec {
            file: Some("solids.toml".to_owned()),
            ..Default::default()
        });
        scene.lights.push(Default::default());
        scene.solver = SolverSpec {
            name: Some("orders".to_owned()),
            scattering: Some(crate::sky::Scattering::Single),
            effort: Some(super::super::Effort::Fine),
            polarisation_correction: Some(true),
            wavelengths: Some("rgb".to_owned()),
            paths: Some(128),
            variant: Some("printed".to_owned()),
            zenith_lux: Some(1.0),
            klassen1987: super::super::Klassen1987Spec {
                air_density: Some(2.0),
                ..Default::default()
            },
            ..Default::default()
        };
        scene.output.noise_map = Some(true);
        scene.output.polarisation = Some(true);
        scene.output.spectral = Some(true);
        scene
    }

    #[test]
    fn inputs_are_found_and_can_be_removed() {
        assert_eq!(Scene::default().set_inputs(), []);
        let all = full().set_inputs();
        assert_eq!(all.len(), 22);
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
        for input in all {
            let left = full().without(input).set_inputs();
            // Removing the fog also removes its scattering and its patches.
            let gone = if input == Input::Fog { 3 } else { 1 };
            assert_eq!(left.len(), 22 - gone, "{input:?}");
            assert!(!left.contains(&input));
        }
    }

    #[test]
    fn scenes_are_resolved_or_rejected() {
        let mut scene = full();
        scene.lights.clear();
        scene.observer.altitude_m = Some(500.0);
        let resolved = scene.resolve().unwrap();
        assert_eq!(resolved.observer_altitude_m, 500.0);
        assert_eq!(resolved.grid.len(), 3);
        assert!(resolved.has_objects && resolved.set_inputs.contains(&Input::ObserverHeight));
        let fog = resolved.fog.unwrap();
        assert!((fog.layers[0].extinction_per_m - 20f64.ln() / 200.0).abs() < 1e-12);
        let said = |change: fn(&mut Scene)| {
            let mut scene = full();
            scene.lights.clear();
            change(&mut scene);
            scene.resolve().unwrap_err().to_string()
        };
        for (sentence, start) in [
            (
                said(|s| s.solver.wavelengths = Some("greens".to_owned())),
                "solver.wavelengths: ",
            ),
            (
                said(|s| s.fog.as_mut().unwrap().visibility_m = None),
                "fog.visibility_m: expected",
            ),
            (
                said(|s| s.fog.as_mut().unwrap().profile = Some(super::super::FogProfile::Uniform)),
                "fog.profile: expected",
            ),
            (
                said(|s| s.air.turbidity = Some(3.0)),
                "air.turbidity: expected one amount of haze",
            ),
            (
                said(|s| s.air.ground_albedo = Some(1.5)),
                "air.ground_albedo: expected a number from 0 to 1, got 1.5",
            ),
            (
                said(|s| s.air.atmosphere = Some("mars".to_owned())),
                "air.ozone_du: expected the Earth's air",
            ),
            (said(|s| s.version = 2), "version: expected 1, got 2"),
        ] {
            assert!(sentence.starts_with(start), "{sentence}");
        }
    }
}
