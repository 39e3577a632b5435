//! Venus: carbon dioxide below clouds of sulfuric acid.

use super::fixed_table::{fixed_profile, fixed_table, sampled};
use super::molecules::{carbon_dioxide_m2, nitrogen_m2};
use crate::atmosphere::aerosol_types::sulfuric_acid;
use crate::atmosphere::{
    Atmosphere, Constituent, ConstituentKind, DensityProfile, Interpolation, Planet,
};
use crate::optics::mie::SizeDistribution;
use crate::optics::{Depolarization, PhaseFunction};
use crate::spectrum::{SpectralCurve, embedded_table, solar};
use crate::sun::SunDisc;

/// Mean distance of Venus from the sun, AU.
const DISTANCE_AU: f64 = 0.7233;
/// Pressure at the surface (Seiff et al. 1985), Pa.
#[cfg(feature = "config")]
pub(in crate::atmosphere) const VENUS_PRESSURE_PA: f64 = 92.1e5;
const TOP_KM: f64 = 100.0;

/// A mode of droplets: lognormal sizes, and a number density that is uniform in a layer and decays exponentially on both sides.
struct CloudMode {
    name: &'static str,
    median_radius_um: f64,
    geometric_deviation: f64,
    number_per_cm3: f64,
    base_km: f64,
    thickness_km: f64,
    scale_height_above_km: f64,
    scale_height_below_km: f64,
}

/// The modes of Haus, Kappel & Arnold (Planet. Space Sci. 89, 77, 2013; Icarus 232, 232, 2014).
const MODES: [CloudMode; 4] = [
    CloudMode {
        name: "cloud mode 1",
        median_radius_um: 0.3,
        geometric_deviation: 1.56,
        number_per_cm3: 193.5,
        base_km: 49.0,
        thickness_km: 16.0,
        scale_height_above_km: 3.5,
        scale_height_below_km: 1.0,
    },
    CloudMode {
        name: "cloud mode 2",
        median_radius_um: 1.0,
        geometric_deviation: 1.29,
        number_per_cm3: 100.0,
        base_km: 65.0,
        thickness_km: 1.0,
        scale_height_above_km: 3.5,
        scale_height_below_km: 3.0,
    },
    CloudMode {
        name: "cloud mode 2'",
        median_radius_um: 1.4,
        geometric_deviation: 1.23,
        number_per_cm3: 50.0,
        base_km: 49.0,
        thickness_km: 11.0,
        scale_height_above_km: 1.0,
        scale_height_below_km: 0.1,
    },
    CloudMode {
        name: "cloud mode 3",
        median_radius_um: 3.65,
        geometric_deviation: 1.28,
        number_per_cm3: 14.0,
        base_km: 49.0,
        thickness_km: 8.0,
        scale_height_above_km: 1.0,
        scale_height_below_km: 0.5,
    },
];

impl CloudMode {
    fn density(&self) -> DensityProfile {
        /// Scale heights at which the layer ends.
        const ENDS: f64 = 10.0;
        let top_km = self.base_km + self.thickness_km;
        let lowest_km = self.base_km - ENDS * self.scale_height_below_km;
        let highest_km = (top_km + ENDS * self.scale_height_above_km).min(TOP_KM);
        let above = (-(highest_km - top_km) / self.scale_height_above_km).exp();
        fixed_profile(
            [
                lowest_km - 0.001,
                lowest_km,
                self.base_km,
                top_km,
                highest_km,
            ],
            vec![0.0, (-ENDS).exp(), 1.0, 1.0, above],
            Interpolation::LogLinear,
        )
    }
}

/// Venus by day.
///
/// - Gas: number density of Seiff et al. (Adv. Space Res. 5, 3, 1985), 92 bar at the ground; 96.5 % carbon dioxide, the rest
///   nitrogen. Absorption by gases is left out: sulfur vapour below 30 km makes the real Venus darker in the blue.
/// - Clouds: four modes of droplets of 75 % sulfuric acid by Lorenz-Mie theory, with the sizes and heights of Haus, Kappel & Arnold
///   (2013, 2014); optical depth 35 at 1000 nm.
/// - Absorber: particles in the upper cloud that absorb blue and ultraviolet light, of unknown nature (Haus, Kappel & Arnold, Planet.
///   Space Sci. 117, 262, 2015).
/// - Ground: albedo 0.1, rounded from Veneras 9 and 10 (Ekonomov, Golovin & Moshkin, Icarus 41, 65, 1980).
/// - Sun: the solar spectrum at the Earth divided by 0.7233^2, and a larger disc, which is never seen.
pub fn venus() -> Atmosphere {
    let air = embedded_table::<2>(include_str!("../../../data/atmosphere/venus_air.txt"));
    let ground = air[0][1];
    let column = |rows: &[[f64; 2]], i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    let gas = |nm: f64| ground * (0.965 * carbon_dioxide_m2(nm) + 0.035 * nitrogen_m2(nm));
    let relative = |rows: &[[f64; 2]], most: f64| {
        let values = column(rows, 1).iter().map(|value| value / most).collect();
        fixed_profile(column(rows, 0), values, Interpolation::LogLinear)
    };
    let absorber = embedded_table::<2>(include_str!(
        "../../../data/atmosphere/venus_absorber_profile.txt"
    ));
    let most = column(&absorber, 1).into_iter().fold(0.0, f64::max);
    let absorption: Vec<(f64, f64)> =
        embedded_table::<2>(include_str!("../../../data/atmosphere/venus_absorber.txt"))
            .iter()
            .map(|[nm, cross_section]| (*nm, most * cross_section))
            .collect();
    let mut constituents = vec![
        Constituent {
            kind: ConstituentKind::Molecules,
            density: relative(&air, ground),
            scattering_per_m: sampled(gas),
            absorption_per_m: SpectralCurve::Constant(0.0),
            // From the King factor of carbon dioxide at 550 nm.
            phase: PhaseFunction::Rayleigh(Depolarization::Factor(0.079)),
        },
        Constituent {
            kind: ConstituentKind::Other("ultraviolet absorber".into()),
            density: relative(&absorber, most),
            scattering_per_m: SpectralCurve::Constant(0.0),
            absorption_per_m: fixed_table(&absorption),
            phase: PhaseFunction::Isotropic,
        },
    ];
    constituents.extend(MODES.iter().map(|mode| {
        let sizes = SizeDistribution::log_normal(mode.median_radius_um, mode.geometric_deviation);
        let kind = ConstituentKind::Other(mode.name.into());
        sulfuric_acid(kind, sizes, mode.number_per_cm3, mode.density())
            .expect("constant parameters are valid")
    }));
    Atmosphere {
        name: "venus".into(),
        planet: Planet {
            radius_m: 6_051.8e3,
            top_altitude_m: 1e3 * TOP_KM,
            ground_altitude_m: 0.0,
            ground_albedo: SpectralCurve::Constant(0.1),
        },
        constituents,
        solar_irradiance: SpectralCurve::Table(solar::extraterrestrial().clone())
            .scaled(DISTANCE_AU.powi(-2)),
        sun: SunDisc::at_distance_au(DISTANCE_AU).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::RefractiveIndex;
    use crate::optics::mie::{Complex64, Particles};

    #[test]
    fn optical_depths_of_the_clouds_are_those_of_the_publication() {
        // Haus et al. (2013), at 1000 nm, where 75 % sulfuric acid has the refractive index 1.42 (Palmer & Williams, Appl. Opt. 14,
        // 208, 1975).
        let index = RefractiveIndex::constant(Complex64::new(1.42, 0.0));
        for (mode, published) in MODES.iter().zip([3.88, 7.62, 9.35, 14.14]) {
            let sizes =
                SizeDistribution::log_normal(mode.median_radius_um, mode.geometric_deviation);
            let droplets = Particles::new(index.clone(), sizes)
                .unwrap()
                .bulk(1000.0)
                .unwrap();
            let column_m = mode.density().column_m(0.0, 1e3 * TOP_KM);
            let got = droplets.extinction_per_m(mode.number_per_cm3) * column_m;
            assert!((got / published - 1.0).abs() < 0.05, "{}: {got}", mode.name);
        }
    }

    #[test]
    fn clouds_do_not_absorb_visible_light() {
        let venus = venus();
        let cloud = &venus.constituents[4];
        assert!(cloud.absorption_per_m.at(550.0) < 1e-4 * cloud.scattering_per_m.at(550.0));
    }
}
