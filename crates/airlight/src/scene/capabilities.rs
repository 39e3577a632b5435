//! What a model honours and answers, and the one place where inputs that it would ignore are refused.

use super::{RadianceModel, SceneError};
use std::fmt;

/// An input of a scene that not every model honours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Input {
    /// The atmosphere: preset or file.
    Atmosphere,
    /// Type, humidity, optical depth, turbidity or visibility of the haze.
    Haze,
    /// Ozone column.
    Ozone,
    /// Albedo of the ground.
    GroundAlbedo,
    /// An eye high above the ground.
    ObserverHeight,
    /// Distance of the planet from the sun.
    SunDistance,
    /// Fog near the ground.
    Fog,
    /// Which orders of scattering the fog has.
    FogScattering,
    /// Point, spot and sphere lights.
    Lights,
    /// Objects in front of the sky.
    Objects,
    /// The wavelengths to compute.
    Wavelengths,
    /// Which orders of scattering are computed.
    Scattering,
    /// How finely the solver works.
    Effort,
    /// Number of Monte Carlo paths and their seed.
    Paths,
    /// Pictures of the standard error.
    NoiseMap,
    /// Polarisation of the light.
    Polarisation,
    /// The form of a published model.
    Variant,
    /// The sunlight of the single-scattering shader.
    Sunlight,
    /// Haze and air of the model of 1987.
    Klassen1987,
    /// Pictures with one channel for each wavelength.
    Spectra,
    /// Air in front of a point at a distance.
    Distances,
}

impl Input {
    /// Its key in a scene file.
    pub fn key(self) -> &'static str {
        match self {
            Self::Atmosphere => "air.atmosphere",
            Self::Haze => "air.aerosol, humidity, aod_550, turbidity and haze_visibility_m",
            Self::Ozone => "air.ozone_du",
            Self::GroundAlbedo => "air.ground_albedo",
            Self::ObserverHeight => "observer",
            Self::SunDistance => "sun.distance_ratio",
            Self::Fog => "fog",
            Self::FogScattering => "fog.scattering",
            Self::Lights => "lights",
            Self::Objects => "objects",
            Self::Wavelengths => "solver.wavelengths",
            Self::Scattering => "solver.scattering",
            Self::Effort => "solver.effort",
            Self::Paths => "solver.paths and solver.seed",
            Self::NoiseMap => "output.noise_map",
            Self::Polarisation => "output.polarisation",
            Self::Variant => "solver.variant",
            Self::Sunlight => "solver.sunlight and solver.zenith_lux",
            Self::Klassen1987 => "solver.klassen1987",
            Self::Spectra => "output.spectral",
            Self::Distances => "distance_m",
        }
    }
}

impl fmt::Display for Input {
    /// What it is, with its article: "the ozone column".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Atmosphere => "the atmosphere",
            Self::Haze => "haze",
            Self::Ozone => "the ozone column",
            Self::GroundAlbedo => "the albedo of the ground",
            Self::ObserverHeight => "an eye high above the ground",
            Self::SunDistance => "the distance of the sun",
            Self::Fog => "fog",
            Self::FogScattering => "the scattering of the fog",
            Self::Lights => "lights",
            Self::Objects => "objects",
            Self::Wavelengths => "the wavelengths",
            Self::Scattering => "the orders of scattering",
            Self::Effort => "the effort",
            Self::Paths => "the number of paths and their seed",
            Self::NoiseMap => "maps of the noise",
            Self::Polarisation => "polarisation",
            Self::Variant => "variants",
            Self::Sunlight => "the colour of the sunlight",
            Self::Klassen1987 => "the settings of the 1987 model",
            Self::Spectra => "spectral pictures",
            Self::Distances => "the air in front of a point",
        })
    }
}

/// Which inputs a model honours and which questions it answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The inputs that change its result. [`check_inputs`] refuses every other input.
    pub inputs: &'static [Input],
    /// Names of its forms, the default first; empty for a model with one form.
    pub variants: &'static [&'static str],
    /// Whether it answers for a sun below the horizon.
    pub twilight: bool,
    /// Whether it knows how the light along a ray divides into single and multiple scattering and ground
    /// ([`RadianceView::line_of_sight`](super::RadianceView::line_of_sight)).
    pub parts: bool,
}

impl Capabilities {
    /// Whether an input changes the result.
    pub fn honours(&self, input: Input) -> bool {
        self.inputs.contains(&input)
    }
}

/// Refuses inputs that a model would ignore, and variants that it does not have. `set` are the inputs that are set
/// explicitly, `variant` is the one requested; `all` are the models to suggest instead.
///
/// # Errors
/// [`SceneError::IgnoredInput`] for the first input that it ignores, [`SceneError::UnknownVariant`].
pub fn check_inputs(
    model: &dyn RadianceModel,
    set: &[Input],
    variant: Option<&str>,
    all: &[&dyn RadianceModel],
) -> Result<(), SceneError> {
    let capabilities = model.capabilities();
    if let Some(&input) = set.iter().find(|input| !capabilities.honours(**input)) {
        let honoured_by = all
            .iter()
            .filter(|other| other.capabilities().honours(input));
        return Err(SceneError::IgnoredInput {
            input,
            model: model.name(),
            honoured_by: honoured_by.map(|other| other.name()).collect(),
        });
    }
    match variant {
        Some(variant) if !capabilities.variants.contains(&variant) => {
            Err(SceneError::UnknownVariant {
                got: variant.to_owned(),
                model: model.name(),
                variants: capabilities.variants,
            })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PreparedModel, ResolvedScene};
    use super::*;
    use crate::control::Control;
    use crate::sky::SunCoverage;
    use std::sync::Arc;

    /// A model that honours one input.
    #[derive(Debug)]
    struct Named(&'static str, &'static [Input], &'static [&'static str]);

    impl RadianceModel for Named {
        fn name(&self) -> &'static str {
            self.0
        }

        fn summary(&self) -> &'static str {
            ""
        }

        fn capabilities(&self) -> Capabilities {
            Capabilities {
                inputs: self.1,
                variants: self.2,
                twilight: false,
                parts: false,
            }
        }

        fn prepare(
            &self,
            _scene: &ResolvedScene,
            _suns: SunCoverage,
            _control: Control<'_>,
        ) -> Result<Arc<dyn PreparedModel>, SceneError> {
            Err(SceneError::Distance(0.0))
        }
    }

    #[test]
    fn ignored_inputs_are_refused_and_other_models_named() {
        let formula = Named("formula", &[Input::Haze], &["printed", "corrected"]);
        let first = Named("first", &[Input::Ozone, Input::Haze], &[]);
        let second = Named("second", &[Input::Ozone], &[]);
        let all: [&dyn RadianceModel; 3] = [&formula, &first, &second];
        let check = |model: &Named, set: &[Input], variant| {
            check_inputs(model, set, variant, &all).map_err(|error| error.to_string())
        };
        assert_eq!(check(&formula, &[Input::Haze], Some("printed")), Ok(()));
        assert_eq!(
            check(&formula, &[Input::Haze, Input::Ozone], None).unwrap_err(),
            "air.ozone_du: expected a solver that honours the ozone column, got formula; try first or second"
        );
        assert_eq!(
            check(&first, &[Input::Lights], None).unwrap_err(),
            "lights: expected a solver that honours lights, got first; try leaving it out, as no solver does"
        );
        assert_eq!(
            check(&formula, &[], Some("fixed")).unwrap_err(),
            "solver.variant: expected a variant of formula, got \"fixed\"; try printed or corrected"
        );
        assert_eq!(
            check(&first, &[], Some("fixed")).unwrap_err(),
            "solver.variant: expected a variant of first, got \"fixed\"; try leaving it out, as it has one form only"
        );
    }
}
