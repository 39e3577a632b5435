//! Diffuse light of the night sky outside the lower air.

use super::{CelestialFrame, airglow, starlight, zodiacal};
use crate::spectrum::WavelengthGrid;
use glam::DVec3;

/// Solar radio flux of an average year, in solar flux units.
pub(crate) const MEAN_SOLAR_FLUX_SFU: f64 = 100.0;

/// A component of the diffuse light of the night. Each has one spectrum, and an amount that depends on the direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GlowComponent {
    /// Airglow between an eye above the layer and the lower air. The unit of the amount is the layer seen vertically.
    AirglowBefore,
    /// Airglow seen through the lower air. The unit of the amount is the layer seen vertically.
    AirglowBehind,
    /// Zodiacal light. The unit is a radiance at 500 nm of 1 W m^-2 sr^-1 nm^-1.
    Zodiacal,
    /// Integrated starlight. The unit is one star of magnitude 10 per square degree.
    Starlight,
}

impl GlowComponent {
    /// All components.
    pub const ALL: [Self; 4] = [
        Self::AirglowBefore,
        Self::AirglowBehind,
        Self::Zodiacal,
        Self::Starlight,
    ];
}

/// Airglow, zodiacal light and integrated starlight.
///
/// Errors: the airglow of a night differs from the mean by 20 % and more; zodiacal light is known to 10 %; integrated starlight is a
/// smooth model, within 30 % of averages over several degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NightGlow {
    frame: CelestialFrame,
    solar_flux_sfu: f64,
}

impl NightGlow {
    /// The light under a celestial sphere, for a solar radio flux at 10.7 cm in solar flux units (70 in quiet years, 200 in
    /// active ones), which determines the airglow.
    pub fn new(frame: CelestialFrame, solar_flux_sfu: f64) -> Self {
        Self {
            frame,
            solar_flux_sfu,
        }
    }

    /// Spectrum of one unit of a component at the wavelengths of a grid, W m^-2 sr^-1 nm^-1.
    pub fn spectrum(&self, component: GlowComponent, grid: &WavelengthGrid) -> Vec<f64> {
        match component {
            GlowComponent::AirglowBefore | GlowComponent::AirglowBehind => {
                airglow::spectrum(grid, self.solar_flux_sfu)
            }
            GlowComponent::Zodiacal => zodiacal::spectrum(grid),
            GlowComponent::Starlight => starlight::spectrum(grid),
        }
    }

    /// Amounts of the components along a unit vector, in the order of [`GlowComponent::ALL`], outside the lower air; for an eye at
    /// a distance `radius_m` from the centre of a planet whose sea level is at `sea_level_m`.
    pub fn amounts(
        &self,
        direction: DVec3,
        radius_m: f64,
        sea_level_m: f64,
        meets_ground: bool,
    ) -> [f64; 4] {
        let (before, behind) =
            airglow::relative_lengths(radius_m, direction.y, sea_level_m, meets_ground);
        if meets_ground {
            return [before, behind, 0.0, 0.0];
        }
        let equatorial = self.frame.to_equatorial(direction);
        let (longitude, latitude) = self.frame.ecliptic_from_sun(equatorial);
        [
            before,
            behind,
            zodiacal::radiance_500nm(longitude, latitude),
            starlight::brightness_s10(equatorial),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes;
    use crate::night::magnitude_per_square_arcsec;

    #[test]
    fn a_dark_sky_has_21_5_to_22_magnitudes_outside_the_air() {
        let grid = WavelengthGrid::standard();
        let sea = 6_371e3;
        for (days, sfu) in [(0.0, 70.0), (90.0, 100.0), (180.0, 130.0)] {
            let frame = CelestialFrame::at(1_795_824_000.0 + 86_400.0 * days, 45.0, 0.0);
            let glow = NightGlow::new(frame, sfu);
            // Mean over the upper part of the sky.
            let directions = (0..24).map(|i| axes::direction(15.0 * f64::from(i), 60.0));
            let mut luminance = 0.0;
            for direction in directions {
                let amounts = glow.amounts(direction, sea, sea, false);
                for (component, amount) in GlowComponent::ALL.into_iter().zip(amounts) {
                    let light: Vec<f32> = glow
                        .spectrum(component, &grid)
                        .iter()
                        .map(|v| (amount * v) as f32)
                        .collect();
                    luminance += grid.to_xyz(&light)[1] / 24.0;
                }
            }
            let magnitude = magnitude_per_square_arcsec(luminance);
            assert!(
                (21.2..22.1).contains(&magnitude),
                "{days} days: {magnitude}"
            );
        }
    }
}
