//! Four orders of scattering, as in the precomputed skies of Bruneton and Neyret.
//!
//! E. Bruneton and F. Neyret, "Precomputed Atmospheric Scattering", Computer Graphics Forum 27(4), 2008, sum light scattered
//! or reflected up to four times into tables, each order computed from the one before. This model does not use their tables:
//! it is our own solver ([`crate::sky`]) stopped after four orders, so that it differs from the full solution only by the
//! later orders. (Light in forward peaks counts as unscattered in the solver, so light in the narrow lobe of haze may have
//! been scattered more often.)

use super::PublishedModel;
use super::orders::PreparedOrders;
use crate::atmosphere::Atmosphere;
use crate::control::Control;
use crate::scene::{Capabilities, Input, PreparedModel, RadianceModel, ResolvedScene, SceneError};
use crate::sky::{LineOfSight, Sky, SkyError, SkySettings, SunCoverage, View};
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use glam::DVec3;
use std::sync::Arc;

/// Sky of four orders of scattering for one eye and one sun.
#[derive(Debug)]
pub struct FourOrders {
    view: View,
}

impl FourOrders {
    /// Sky of the first `orders` orders (at least 2; 4 in the paper) for an eye at an altitude (m; raised to the ground if below
    /// it) and a sun direction.
    ///
    /// # Errors
    /// [`SkyError`] if the atmosphere is invalid, `orders` is below 2, or the sun's direction is zero or not finite.
    pub fn new(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        (eye_altitude_m, sun_direction): (f64, DVec3),
        orders: usize,
        settings: &SkySettings,
    ) -> Result<Self, SkyError> {
        let sun = sun_direction
            .try_normalize()
            .ok_or(SkyError::Setting("a finite sun direction that is not zero"))?;
        let settings = stopped_after(orders, settings)?;
        let sky = Sky::prepare_with(atmosphere, grid, &settings, Control::default())?;
        Ok(Self {
            view: sky.try_view(eye_altitude_m, sun)?,
        })
    }
}

/// Settings with which the solver computes the first `orders` orders of scattering.
fn stopped_after(orders: usize, settings: &SkySettings) -> Result<SkySettings, SkyError> {
    if orders < 2 {
        return Err(SkyError::Setting("at least 2 orders of scattering"));
    }
    let mut settings = settings.clone();
    // As in the paper, light is scalar.
    settings.polarisation_correction = false;
    // The field holds all orders but the last, which tracing the view ray adds.
    settings.orders.only_orders = Some(orders - 1);
    Ok(settings)
}

/// The solver of [`Orders`](super::orders::Orders) stopped after four orders of scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FourOrdersModel;

impl RadianceModel for FourOrdersModel {
    fn name(&self) -> &'static str {
        "four-orders"
    }

    fn summary(&self) -> &'static str {
        "the first four orders of scattering, as in the tables of Bruneton & Neyret 2008"
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            inputs: &[
                Input::Atmosphere,
                Input::Haze,
                Input::Ozone,
                Input::GroundAlbedo,
                Input::ObserverHeight,
                Input::SunDistance,
                Input::Objects,
                Input::Wavelengths,
                Input::Effort,
                Input::Spectra,
                Input::Distances,
            ],
            variants: &[],
            twilight: true,
            parts: true,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let settings = stopped_after(4, &scene.solver.sky_settings(suns))?;
        Ok(Arc::new(PreparedOrders::new(scene, &settings, control)?))
    }
}

impl PublishedModel for FourOrders {
    fn sun(&self) -> DVec3 {
        self.view.sun()
    }

    fn disc(&self) -> &SunDisc {
        self.view.disc()
    }

    fn has_ground(&self) -> bool {
        true
    }

    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.view
            .sky()
            .grid()
            .to_xyz(&self.view.along(direction, None).radiance())
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.view
            .sky()
            .grid()
            .to_xyz(&self.view.sun_disc_radiance(direction))
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(self.view.sky().grid())
    }

    fn sky_spectrum(&self, direction: DVec3) -> Vec<f64> {
        let line = self.view.along(direction, None);
        line.radiance().into_iter().map(f64::from).collect()
    }

    fn disc_spectrum(&self, direction: DVec3) -> Vec<f64> {
        let disc = self.view.sun_disc_radiance(direction);
        disc.into_iter().map(f64::from).collect()
    }

    fn line(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        Some(self.view.along(direction, limit_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::reference;
    use crate::axes;

    /// Zenith angle of the sun, zenith angle of the view, azimuth from the sun; radiances of orders 1 to 4 and of all orders at
    /// 680, 550 and 440 nm, W m^-2 sr^-1 nm^-1, from an independent Monte Carlo (delta tracking, 0.1 % noise), Bruneton's Earth.
    const MONTE_CARLO: [([f64; 3], [f64; 3], [f64; 3]); 4] = [
        (
            [30.0, 0.0, 0.0],
            [0.009_446_615, 0.024_290_7, 0.057_232_12],
            [0.009_449_2, 0.024_331_55, 0.057_942_49],
        ),
        (
            [30.0, 60.0, 180.0],
            [0.010_165_41, 0.028_849_96, 0.070_383_36],
            [0.010_170_94, 0.028_865_17, 0.071_808_31],
        ),
        (
            [80.0, 60.0, 180.0],
            [0.011_658_83, 0.026_659_71, 0.051_980_37],
            [0.011_661_65, 0.026_706_93, 0.052_723_92],
        ),
        (
            [80.0, 80.0, 180.0],
            [0.034_500_82, 0.069_166_56, 0.099_239_12],
            [0.034_509_51, 0.069_278_64, 0.100_674_4],
        ),
    ];

    #[test]
    fn radiance_matches_four_orders_of_monte_carlo() {
        let (air, grid) = (reference::earth_demo(), WavelengthGrid::rgb());
        for ([sun_zenith, zenith, azimuth], four, all) in MONTE_CARLO {
            let sun = axes::direction(180.0, 90.0 - sun_zenith);
            let settings = SkySettings::default();
            let sky = FourOrders::new(&air, &grid, (0.0, sun), 4, &settings).unwrap();
            let got = sky.sky_spectrum(axes::direction(180.0 + azimuth, 90.0 - zenith));
            for channel in 0..3 {
                let error = got[2 - channel] / four[channel] - 1.0;
                assert!(
                    error.abs() < 0.01,
                    "{sun_zenith} {zenith} {channel}: {error}"
                );
            }
            // Orders above four contribute 1.2 to 2 % in blue.
            let deficit = 1.0 - got[0] / all[2];
            let should = 1.0 - four[2] / all[2];
            assert!((deficit - should).abs() < 0.008, "{deficit} {should}");
        }
    }

    #[test]
    fn invalid_arguments_are_refused() {
        let (air, grid) = (reference::earth_demo(), WavelengthGrid::rgb());
        let settings = SkySettings::default();
        let refused = FourOrders::new(&air, &grid, (0.0, DVec3::Y), 1, &settings);
        assert!(matches!(refused, Err(SkyError::Setting(_))));
        let nowhere = FourOrders::new(&air, &grid, (0.0, DVec3::ZERO), 4, &settings);
        assert!(matches!(nowhere, Err(SkyError::Setting(_))));
    }
}
