//! Integrated starlight: the Milky Way and the light of all stars that are too faint to be seen singly.

use super::celestial::{galactic, spherical};
use super::spectra::black_body;
use crate::math::interpolation::bilinear;
use crate::spectrum::WavelengthGrid;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

/// Luminance of one star of magnitude 10 per square degree (the unit S10), cd/m^2: 27.78 magnitudes per square arcsecond.
const S10_CD_M2: f64 = 8.35e-7;
/// Colour temperature of the light, K: redder than the sun, as the spectrum of Mattila (1980).
const TEMPERATURE_K: f64 = 5000.0;

// Lengths in kiloparsecs.
/// Distance of the sun from the galactic centre, and its height above the plane.
const SUN_KPC: (f64, f64) = (8.2, 0.02);
/// Scale length and scale height of the thin disc, the thick disc and the dust.
const THIN: (f64, f64) = (2.6, 0.44);
const THICK: (f64, f64) = (3.5, 0.9);
const DUST: (f64, f64) = (4.0, 0.21);
/// Emission of the thin disc at the sun, S10/kpc; shares of the thick disc and of the bulge at the centre.
const EMISSION: f64 = 57.0;
const THICK_SHARE: f64 = 0.06;
const BULGE_SHARE: f64 = 14.2;
/// Scale length of the bulge, and its axis ratio.
const BULGE: (f64, f64) = (0.757, 0.6);
/// Absorption by dust at the sun, 1/kpc.
const ABSORPTION: f64 = 0.403;

/// Numbers of tabulated longitudes (0 to 180 degrees) and latitudes (-90 to 90 degrees).
const TABLE: [usize; 2] = [91, 181];

/// Brightness outside the air in units of S10, by an equatorial unit vector (J2000).
///
/// The integral along the line of sight over a galaxy of two exponential discs, a bulge and a disc of dust, whose constants
/// are fitted to the brightness that Leinert et al. 1998 state for integrated starlight: 260 at the galactic centre, 100 at
/// longitudes 120 and 240, 50 at latitudes of 30 degrees, 20 at 80 degrees (after Elsaesser & Haug 1960, Roach & Megill 1961), and
/// for Pioneer 10 at the poles, 27 and 33 with diffuse galactic light; and to at most 550 in Sagittarius. The fit meets these
/// numbers to 30 %. It has the smooth structure of the Milky Way: band, bulge and dark lane, not its clouds.
pub fn brightness_s10(equatorial: DVec3) -> f64 {
    static BRIGHTNESS: LazyLock<Vec<f64>> = LazyLock::new(|| {
        let [longitudes, latitudes] = TABLE;
        (0..longitudes * latitudes)
            .map(|i| {
                let (column, row) = (i % longitudes, i / longitudes);
                let l = PI * column as f64 / (longitudes - 1) as f64;
                let b = PI * row as f64 / (latitudes - 1) as f64 - FRAC_PI_2;
                integrated(l, b)
            })
            .collect()
    });
    let (l, b) = galactic(equatorial);
    bilinear(l.abs() / PI, (b + FRAC_PI_2) / PI, TABLE)
        .into_iter()
        .map(|(cell, weight)| f64::from(weight) * BRIGHTNESS[cell])
        .sum()
}

/// Brightness at a galactic longitude and latitude, rad, by the trapezoidal rule.
fn integrated(l: f64, b: f64) -> f64 {
    /// Steps, growing from 15 pc to the end of the path, 25 kpc.
    const STEPS: usize = 160;
    let toward = spherical(l, b);
    let distance = |step: usize| {
        let t = step as f64 / STEPS as f64;
        25.0 * (0.1 * t + 0.9 * t * t * t)
    };
    let (mut brightness, mut depth) = (0.0, 0.0);
    let mut before = medium(toward, 0.0);
    for step in 1..=STEPS {
        let length = distance(step) - distance(step - 1);
        let here = medium(toward, distance(step));
        let mean = (0.5 * (before.0 + here.0), 0.5 * (before.1 + here.1));
        brightness += f64::exp(-depth - 0.5 * mean.1 * length) * mean.0 * length;
        depth += mean.1 * length;
        before = here;
    }
    brightness
}

/// Emission (S10/kpc) and absorption (1/kpc) at a distance along a galactic unit vector.
fn medium(toward: DVec3, distance_kpc: f64) -> (f64, f64) {
    let at =
        DVec3::new(SUN_KPC.0, 0.0, SUN_KPC.1) + distance_kpc * toward * DVec3::new(-1.0, 1.0, 1.0);
    let (radius, height) = (at.x.hypot(at.y), at.z.abs());
    let disc = |(length, thickness): (f64, f64)| {
        (-(radius - SUN_KPC.0) / length - height / thickness).exp()
    };
    let bulge = (-radius.hypot(height / BULGE.1) / BULGE.0).exp();
    let emission = EMISSION * (disc(THIN) + THICK_SHARE * disc(THICK) + BULGE_SHARE * bulge);
    (emission, ABSORPTION * disc(DUST))
}

/// Spectrum of a brightness of 1 S10 at the wavelengths of a grid, W m^-2 sr^-1 nm^-1.
pub fn spectrum(grid: &WavelengthGrid) -> Vec<f64> {
    let mut spectrum = black_body(grid, TEMPERATURE_K);
    spectrum.iter_mut().for_each(|v| *v *= S10_CD_M2);
    spectrum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brightness_matches_published_numbers() {
        let at = |l: f64, b: f64| integrated(l.to_radians(), b.to_radians());
        for (l, b, want) in [
            (0.0, 0.0, 260.0),
            (120.0, 0.0, 100.0),
            (240.0, 0.0, 100.0),
            (120.0, 30.0, 50.0),
            (240.0, -30.0, 50.0),
            (0.0, 90.0, 27.0),
            (0.0, -90.0, 33.0),
        ] {
            let got = at(l, b);
            assert!(
                (0.7..1.35).contains(&(got / want)),
                "({l}, {b}): {got} against {want}"
            );
        }
        assert!(at(0.0, 5.0) > at(0.0, 0.0), "the dust darkens the plane");
        assert!(at(0.0, -6.0) < 650.0 && at(0.0, -6.0) > at(180.0, -6.0) * 4.0);
    }

    #[test]
    fn the_table_matches_the_integral() {
        for (right_ascension_deg, declination_deg) in
            [(266.4, -28.9), (192.9, 27.1), (300.0, 35.0), (85.0, 5.0)]
        {
            let at = spherical(
                f64::to_radians(right_ascension_deg),
                f64::to_radians(declination_deg),
            );
            let (l, b) = galactic(at);
            let got = brightness_s10(at);
            assert!(
                (got / integrated(l, b) - 1.0).abs() < 0.05,
                "{right_ascension_deg}: {got}"
            );
        }
    }
}
