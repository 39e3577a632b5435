//! Components of OPAC aerosols: size distributions, refractive indices, growth in moist air.

use crate::math::interpolation::{interval_by_key, lerp};
use crate::names::named;
use crate::optics::RefractiveIndex;
use crate::optics::mie::SizeDistribution;
use crate::spectrum::embedded_table;
use std::sync::LazyLock;

/// A component of OPAC aerosols: spheres of one material with a lognormal size distribution (Hess, Koepke & Schult
/// 1998, table 1c).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Component {
    /// Soil with some organic matter.
    Insoluble,
    /// Sulfates, nitrates, organic matter; grows in moist air.
    WaterSoluble,
    /// Black carbon.
    Soot,
    /// Sea salt, accumulation mode; grows in moist air.
    SeaSaltAccumulation,
    /// Sea salt, coarse mode; grows in moist air.
    SeaSaltCoarse,
    /// Desert dust, nucleation mode.
    MineralNucleation,
    /// Desert dust, accumulation mode.
    MineralAccumulation,
    /// Desert dust, coarse mode.
    MineralCoarse,
    /// Desert dust after long transport.
    MineralTransported,
    /// Droplets of sulfuric acid (75 %); grow in moist air.
    Sulfate,
}

/// Material of a component: a column of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Material {
    Insoluble,
    WaterSoluble,
    Soot,
    SeaSalt,
    Mineral,
    Sulfate,
    Water,
}

/// Rows of wavelength (nm) and n, k of each [`Material`].
static INDICES: LazyLock<Vec<[f64; 15]>> =
    LazyLock::new(|| embedded_table(include_str!("../../../data/atmosphere/aerosol_indices.txt")));
/// Rows of relative humidity and growth (radius over dry radius) of water-soluble matter, sea salt and sulfate.
static GROWTH: LazyLock<Vec<[f64; 4]>> =
    LazyLock::new(|| embedded_table(include_str!("../../../data/atmosphere/aerosol_growth.txt")));

named! { Component, "an aerosol component", [
    ("insoluble", (Insoluble), "Soil with some organic matter"),
    ("water-soluble", (WaterSoluble), "Sulfates, nitrates, organic matter; grows in moist air"),
    ("soot", (Soot), "Black carbon"),
    ("sea-salt-accumulation", (SeaSaltAccumulation), "Sea salt, accumulation mode; grows in moist air"),
    ("sea-salt-coarse", (SeaSaltCoarse), "Sea salt, coarse mode; grows in moist air"),
    ("mineral-nucleation", (MineralNucleation), "Desert dust, nucleation mode"),
    ("mineral-accumulation", (MineralAccumulation), "Desert dust, accumulation mode"),
    ("mineral-coarse", (MineralCoarse), "Desert dust, coarse mode"),
    ("mineral-transported", (MineralTransported), "Desert dust after long transport"),
    ("sulfate", (Sulfate), "Droplets of sulfuric acid (75 %); grow in moist air"),
] }

impl Component {
    fn material(self) -> Material {
        match self {
            Self::Insoluble => Material::Insoluble,
            Self::WaterSoluble => Material::WaterSoluble,
            Self::Soot => Material::Soot,
            Self::SeaSaltAccumulation | Self::SeaSaltCoarse => Material::SeaSalt,
            Self::MineralNucleation
            | Self::MineralAccumulation
            | Self::MineralCoarse
            | Self::MineralTransported => Material::Mineral,
            Self::Sulfate => Material::Sulfate,
        }
    }

    /// Whether the particles take up water.
    pub fn grows(self) -> bool {
        self.material().growth_column().is_some()
    }

    /// Radius at a relative humidity (0 to 0.99) over the dry radius. Both modes of sea salt grow alike here; in OPAC the
    /// coarse mode grows 0.2 % more at 80 % and 3 % more at 99 %.
    pub fn growth(self, relative_humidity: f64) -> f64 {
        let Some(column) = self.material().growth_column() else {
            return 1.0;
        };
        // Water volume over solute volume is about proportional to a / (1 - a): interpolate the ratio to it.
        let odds = |a: f64| a / (1.0 - a);
        let water_uptake = |row: &[f64; 4]| (row[column].powi(3) - 1.0) / odds(row[0]);
        let wet = &GROWTH[1..];
        let below = interval_by_key(wet, relative_humidity, |row| row[0]);
        let (low, high) = (&wet[below], &wet[below + 1]);
        let t = ((relative_humidity - low[0]) / (high[0] - low[0])).clamp(0.0, 1.0);
        let kappa = lerp(water_uptake(low), water_uptake(high), t);
        (1.0 + kappa * odds(relative_humidity)).cbrt()
    }

    /// Size distribution at a relative humidity. The smallest radius (5 nm or more in OPAC) is 0 here: smaller particles
    /// have no optical effect, and OPAC's number densities are of the whole distribution.
    pub fn sizes(self, relative_humidity: f64) -> SizeDistribution {
        // Mode radius of the number (micrometres), geometric standard deviation, largest radius.
        let (radius_um, geometric_deviation, largest_um) = match self {
            Self::Insoluble => (0.471, 2.51, 20.0),
            Self::WaterSoluble => (0.0212, 2.24, 20.0),
            Self::Soot => (0.0118, 2.00, 20.0),
            Self::SeaSaltAccumulation => (0.209, 2.03, 20.0),
            Self::SeaSaltCoarse => (1.75, 2.03, 60.0),
            Self::MineralNucleation => (0.07, 1.95, 20.0),
            Self::MineralAccumulation => (0.39, 2.00, 20.0),
            Self::MineralCoarse => (1.90, 2.15, 60.0),
            Self::MineralTransported => (0.50, 2.20, 5.0),
            Self::Sulfate => (0.0695, 2.03, 20.0),
        };
        let growth = self.growth(relative_humidity);
        SizeDistribution::LogNormal {
            median_radius_um: growth * radius_um,
            geometric_deviation,
            range_um: [0.0, growth * largest_um],
        }
    }

    /// Refractive index from 250 nm to 1250 nm: mean of solute and water, weighted by volume.
    pub fn index(self, relative_humidity: f64) -> RefractiveIndex {
        let solute = self.growth(relative_humidity).powi(-3);
        let row = |row: &[f64; 15]| {
            let of = |material: Material| {
                [
                    row[1 + 2 * material as usize],
                    row[2 + 2 * material as usize],
                ]
            };
            let (dry, water) = (of(self.material()), of(Material::Water));
            let mixed = |i: usize| water[i] + (dry[i] - water[i]) * solute;
            [row[0], mixed(0), mixed(1)]
        };
        RefractiveIndex::of_rows(INDICES.iter().map(row).collect())
    }
}

impl Material {
    fn growth_column(self) -> Option<usize> {
        match self {
            Self::WaterSoluble => Some(1),
            Self::SeaSalt => Some(2),
            Self::Sulfate => Some(3),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::Named;

    /// Mode radii of OPAC's table for moist air: 0.0306 micrometres for water-soluble matter at 80 % and 0.0534 at 99 %,
    /// 0.416 for sea salt at 80 %, 0.231 for sulfate at 99 %; and an index of the files for wet materials.
    #[test]
    fn growth_matches_the_publication() {
        for (component, humidity, radius_um) in [
            (Component::WaterSoluble, 0.8, 0.0306),
            (Component::WaterSoluble, 0.99, 0.0534),
            (Component::SeaSaltAccumulation, 0.8, 0.416),
            (Component::Sulfate, 0.99, 0.231),
            (Component::Soot, 0.99, 0.0118),
        ] {
            let SizeDistribution::LogNormal {
                median_radius_um, ..
            } = component.sizes(humidity)
            else {
                panic!("{component:?}")
            };
            assert!(
                (median_radius_um / radius_um - 1.0).abs() < 2e-3,
                "{component:?}: {median_radius_um}"
            );
        }
        let wet = Component::WaterSoluble.index(0.8).at(550.0);
        assert!(
            (wet.re - 1.399).abs() < 6e-4 && (wet.im - 1.995e-3).abs() < 5e-6,
            "{wet}"
        );
    }

    #[test]
    fn growth_increases_with_humidity() {
        for &component in Component::ALL {
            let mut before = component.growth(0.0);
            assert!((before - 1.0).abs() < 1e-12);
            for step in 1..=99 {
                let now = component.growth(0.01 * f64::from(step));
                match component.grows() {
                    true => assert!(now > before, "{component:?} at {step} %"),
                    false => assert!(now == 1.0),
                }
                before = now;
            }
        }
    }
}
