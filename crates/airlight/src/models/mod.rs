//! Solvers and published models of the sky, each a [`RadianceModel`](crate::scene::RadianceModel), and their [`registry`].
//!
//! Published models are implemented as printed and as corrected. The module of each cites its paper, with equation numbers,
//! errata and the difference from the solver of [`crate::sky`].

pub mod four_orders;
pub mod hillaire2020;
#[cfg(feature = "hosek-wilkie")]
pub mod hosek_wilkie;
pub mod klassen1987;
mod lut;
pub mod monte_carlo;
pub mod orders;
pub mod preetham;
mod prepared;
mod published_view;
pub mod single_scattering;

pub use published_view::PublishedModel;

/// Registry of the solvers and published models by name.
pub mod registry {
    #[cfg(feature = "hosek-wilkie")]
    use super::hosek_wilkie;
    use super::{
        four_orders, hillaire2020, klassen1987, monte_carlo, orders, preetham, single_scattering,
    };
    use crate::control::Control;
    use crate::names::UnknownName;
    use crate::scene::{PreparedModel, RadianceModel, ResolvedScene, SceneError, check_inputs};
    use crate::sky::SunCoverage;
    use std::sync::Arc;

    /// Name of the default solver.
    pub const DEFAULT: &str = "orders";

    /// All solvers and published models, in the order in which they are listed.
    pub const ALL: &[&dyn RadianceModel] = &[
        &orders::Orders,
        &monte_carlo::MonteCarloModel,
        &klassen1987::Klassen1987Model,
        &preetham::PreethamModel,
        #[cfg(feature = "hosek-wilkie")]
        &hosek_wilkie::HosekWilkieModel,
        &hillaire2020::Hillaire2020Model,
        &four_orders::FourOrdersModel,
        &single_scattering::SingleScatteringModel,
    ];

    /// The solver or published model with this name.
    ///
    /// # Errors
    /// [`SceneError::UnknownModel`] with all names and the most similar one.
    pub fn find(name: &str) -> Result<&'static dyn RadianceModel, SceneError> {
        let names = || ALL.iter().map(|model| model.name());
        let found = ALL.iter().find(|model| model.name() == name);
        found.copied().ok_or_else(|| SceneError::UnknownModel {
            unknown: UnknownName::new("a solver", name, names()),
        })
    }

    /// The solver or published model that a scene names.
    ///
    /// # Errors
    /// [`SceneError::UnknownModel`] for an unknown name.
    pub fn of_scene(scene: &ResolvedScene) -> Result<&'static dyn RadianceModel, SceneError> {
        find(scene.solver.name.as_deref().unwrap_or(DEFAULT))
    }

    /// Prepares the solver or published model of a scene for a range of suns, and refuses inputs that it would ignore.
    ///
    /// ```
    /// use airlight::{Control, axes, models::registry, scene::{Channels, Scene}, sky::SunCoverage, spectrum::RgbSpace};
    ///
    /// let scene = Scene::from_toml("sun.elevation_deg = 30\nsolver.name = \"preetham\"")?.resolve()?;
    /// let sun = scene.sun.at_start()?;
    /// let suns = SunCoverage::near(sun.elevation_deg, scene.observer_altitude_m);
    /// let prepared = registry::prepare(&scene, suns, Control::default())?;
    /// let view = prepared.view(scene.observer_altitude_m, &sun.state(), Channels::Rgb(RgbSpace::Srgb))?;
    /// let mut zenith = [0.0; 3];
    /// view.radiance(&[axes::direction(0.0, 90.0)], &mut zenith);
    /// assert!(zenith[2] > zenith[0], "the sky is blue: {zenith:?}");
    /// # Ok::<(), airlight::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError`] for an unknown name, an input that the model ignores, or a value outside its domain.
    pub fn prepare(
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let model = of_scene(scene)?;
        check_inputs(
            model,
            &scene.set_inputs,
            scene.solver.variant.as_deref(),
            ALL,
        )?;
        model.prepare(scene, suns, control)
    }
}
