//! Titan: nitrogen and a haze of aggregates.

use super::fixed_table::{fixed_profile, fixed_table, sampled};
use super::molecules::nitrogen_m2;
use crate::atmosphere::{
    Atmosphere, Constituent, ConstituentKind, DensityProfile, Interpolation, Planet,
};
use crate::optics::{Depolarization, PhaseFunction, TabulatedPhase};
use crate::spectrum::{SpectralCurve, embedded_table, solar};
use crate::sun::SunDisc;

/// Mean distance of Saturn from the sun, AU.
const DISTANCE_AU: f64 = 9.58;
/// Surface pressure measured by Huygens (Fulchignoni et al., Nature 438, 785, 2005), Pa.
#[cfg(feature = "config")]
pub(in crate::atmosphere) const TITAN_PRESSURE_PA: f64 = 146.7e3;
const TOP_KM: f64 = 400.0;

/// Wavelengths of the phase functions of the haze, nm.
const PHASE_NM: [f64; 7] = [355.0, 430.0, 490.9, 599.9, 713.1, 822.4, 934.8];

/// Single-scattering albedo of the haze at 144 km and above, at 80 km, and below 30 km (Tomasko et al. 2008, table 2), by wavelength,
/// nm.
const ALBEDO: [(f64, [f64; 3]); 10] = [
    (430.0, [0.8200, 0.9250, 0.9200]),
    (491.0, [0.8700, 0.9450, 0.9752]),
    (531.0, [0.9002, 0.9600, 0.9600]),
    (555.0, [0.9105, 0.9684, 0.9550]),
    (600.0, [0.9195, 0.9813, 0.9750]),
    (634.0, [0.9250, 0.9886, 0.9550]),
    (670.0, [0.9319, 0.9900, 0.9775]),
    (675.0, [0.9319, 0.9900, 0.9700]),
    (751.0, [0.9450, 0.9930, 0.9700]),
    (830.0, [0.9600, 1.0000, 0.9925]),
];

/// Titan at the place and time of the landing of Huygens, 10 degrees south in January 2005.
///
/// - Haze: optical depth above 80 km `1.012e7 nm^-2.339` with a scale height of 65 km, from 30 to 80 km `2.029e4 nm^-1.409` and
///   below 30 km `627 nm^-0.9706`, both uniform, in all 8.1 at 550 nm; phase functions above and below 80 km, single-scattering
///   albedo at 144, 80 and 30 km, interpolated linearly between the former two (Tomasko et al., Planet. Space Sci. 56, 669, 2008;
///   the fits of the optical depth as printed by Bazzon, Schmid & Buenzli, A&A 572, A6, 2014, eqs. A.8 to A.13). The albedo is
///   constant below 430 nm.
/// - Gas: all molecules scatter as nitrogen does, which leaves out about 5 % of the scattering near the ground, by methane.
///   **Absorption by methane is left out**: its bands at 619 and 727 nm make the real Titan darker in the red.
/// - Ground: rounded from the reflectance at the landing site (Schroeder & Keller, Planet. Space Sci. 56, 753, 2008), accurate to about
///   a third.
/// - Sun: the solar spectrum at the Earth divided by 9.58^2, and a disc 9.58 times smaller.
pub fn titan() -> Atmosphere {
    let air = embedded_table::<3>(include_str!("../../../data/atmosphere/titan_air.txt"));
    let densities: Vec<f64> = air.iter().map(|row| row[1] / air[0][1]).collect();
    let mut constituents = vec![Constituent {
        kind: ConstituentKind::Molecules,
        density: fixed_profile(
            air.iter().map(|row| row[0]),
            densities,
            Interpolation::LogLinear,
        ),
        scattering_per_m: sampled(|nm| air[0][1] * nitrogen_m2(nm)),
        absorption_per_m: SpectralCurve::Constant(0.0),
        // From the King factor at 550 nm.
        phase: PhaseFunction::Rayleigh(Depolarization::Factor(0.0205)),
    }];
    let [above, below] = phases();
    // Share of the highest haze in that of a height: its albedo is reached at 144 km.
    let share = |km: f64| ((km - 80.0) / 64.0).clamp(0.0, 1.0);
    let profile = |of: &dyn Fn(f64) -> f64| {
        let heights = (20..=100).map(|i| 4.0 * f64::from(i));
        let density = |km: f64| (-(km - 80.0) / 65.0).exp() * of(km);
        let values: Vec<f64> = heights.clone().map(density).collect();
        // Nothing below 80 km.
        fixed_profile(
            [79.999].into_iter().chain(heights),
            [0.0].into_iter().chain(values).collect(),
            Interpolation::Linear,
        )
    };
    let layer = |bottom_km: f64, top_km: f64| DensityProfile::Layer {
        bottom_m: 1e3 * bottom_km,
        top_m: 1e3 * top_km,
    };
    let high = |nm: f64| 1.012e7 * nm.powf(-2.339) / 65e3;
    let middle = |nm: f64| 2.029e4 * nm.powf(-1.409) / 50e3;
    let low = |nm: f64| 6.270e2 * nm.powf(-0.9706) / 30e3;
    let mut haze = |name: &str,
                    density: DensityProfile,
                    extinction: &dyn Fn(f64) -> f64,
                    place: usize,
                    phase: &TabulatedPhase| {
        let albedo = fixed_table(&ALBEDO.map(|(nm, albedo)| (nm, albedo[place])));
        let curve = |of: &dyn Fn(f64) -> f64| {
            let samples: Vec<(f64, f64)> = (60..=180)
                .map(|i| 5.0 * f64::from(i))
                .map(|nm| (nm, of(albedo.at(nm)) * extinction(nm)))
                .collect();
            fixed_table(&samples)
        };
        constituents.push(Constituent {
            kind: ConstituentKind::Other(name.into()),
            density,
            scattering_per_m: curve(&|albedo| albedo),
            absorption_per_m: curve(&|albedo| 1.0 - albedo),
            phase: PhaseFunction::Tabulated(phase.clone()),
        });
    };
    haze("haze above 144 km", profile(&share), &high, 0, &above);
    haze(
        "haze above 80 km",
        profile(&|km| 1.0 - share(km)),
        &high,
        1,
        &above,
    );
    haze("haze above 30 km", layer(30.0, 80.0), &middle, 1, &below);
    haze("haze below 30 km", layer(0.0, 30.0), &low, 2, &below);
    Atmosphere {
        name: "titan".into(),
        planet: Planet {
            radius_m: 2_575e3,
            top_altitude_m: 1e3 * TOP_KM,
            ground_altitude_m: 0.0,
            ground_albedo: fixed_table(&[
                (450.0, 0.05),
                (600.0, 0.12),
                (750.0, 0.17),
                (830.0, 0.18),
            ]),
        },
        constituents,
        solar_irradiance: SpectralCurve::Table(solar::extraterrestrial().clone())
            .scaled(DISTANCE_AU.powi(-2)),
        sun: SunDisc::at_distance_au(DISTANCE_AU).unwrap_or_default(),
    }
}

/// Phase functions of the haze above and below 80 km.
fn phases() -> [TabulatedPhase; 2] {
    let rows = embedded_table::<15>(include_str!(
        "../../../data/atmosphere/titan_haze_phase.txt"
    ));
    let angles: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    [1, 8].map(|first| {
        let values = (first..first + PHASE_NM.len())
            .flat_map(|w| rows.iter().map(move |row| row[w]))
            .collect();
        TabulatedPhase::new(angles.clone(), PHASE_NM.to_vec(), values)
            .expect("the embedded table is valid")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn optical_depths_are_those_of_the_publications() {
        let titan = titan();
        let haze = |nm: f64, from_m: f64| -> f64 {
            let parts = titan.constituents[1..].iter();
            parts
                .map(|part| part.optical_depth(from_m, 400e3, nm))
                .sum()
        };
        // The air is cut at 400 km, above which 0.7 % of the highest haze lies.
        for (nm, from_m, published) in [
            (550.0_f64, 0.0, 8.105),
            (680.0, 0.0, 5.587),
            (440.0, 0.0, 12.169),
            (550.0, 80e3, 3.940),
            (550.0, 30e3, 3.940 + 2.793),
        ] {
            let got = haze(nm, from_m);
            assert!((got / published - 1.0).abs() < 0.01, "{nm} {from_m}: {got}");
        }
    }

    #[test]
    fn phase_functions_are_those_of_the_table() {
        let titan = titan();
        // Relative to isotropic scattering; the table as printed is normalised to within 1 %.
        for (part, nm, degrees, printed) in [
            (1, 430.0, 0.0_f64, 673.297),
            (1, 430.0, 4.0, 96.3033),
            (4, 822.4, 4.0, 100.051),
            (4, 490.9, 6.0, 33.2609),
        ] {
            let phase = titan.constituents[part]
                .phase
                .evaluate(degrees.to_radians().cos(), nm);
            let got = 4.0 * PI * phase;
            assert!(
                (got / printed - 1.0).abs() < 0.015,
                "{part} {nm} {degrees}: {got}"
            );
        }
    }
}
