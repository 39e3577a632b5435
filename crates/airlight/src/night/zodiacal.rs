//! Zodiacal light: sunlight scattered by dust between the planets.

use crate::math::interpolation::{Place, lerp};
use crate::spectrum::{WavelengthGrid, solar};
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Ecliptic longitudes from the sun and ecliptic latitudes of the table, degrees.
const LONGITUDES_DEG: [f64; 19] = [
    0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0,
    135.0, 150.0, 165.0, 180.0,
];
const LATITUDES_DEG: [f64; 11] = [
    0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 45.0, 60.0, 75.0, 90.0,
];
/// Radiance at 500 nm, 1e-11 W m^-2 sr^-1 nm^-1 (Leinert et al., Astron. Astrophys. Suppl. 127, 1, 1998, table 17). Closer than
/// about 15 degrees to the sun, where the table has no values, the nearest are continued.
const RADIANCE: [[f64; 11]; 19] = [
    [
        20000.0, 20000.0, 7200.0, 3140.0, 1610.0, 985.0, 640.0, 275.0, 150.0, 100.0, 77.0,
    ],
    [
        20000.0, 20000.0, 6300.0, 2940.0, 1540.0, 945.0, 625.0, 271.0, 150.0, 100.0, 77.0,
    ],
    [
        20000.0, 10000.0, 4740.0, 2470.0, 1370.0, 865.0, 590.0, 264.0, 148.0, 100.0, 77.0,
    ],
    [
        11500.0, 6780.0, 3440.0, 1860.0, 1110.0, 755.0, 525.0, 251.0, 146.0, 100.0, 77.0,
    ],
    [
        6400.0, 4480.0, 2410.0, 1410.0, 910.0, 635.0, 454.0, 237.0, 141.0, 99.0, 77.0,
    ],
    [
        3840.0, 2830.0, 1730.0, 1100.0, 749.0, 545.0, 410.0, 223.0, 136.0, 97.0, 77.0,
    ],
    [
        2480.0, 1870.0, 1220.0, 845.0, 615.0, 467.0, 365.0, 207.0, 131.0, 95.0, 77.0,
    ],
    [
        1650.0, 1270.0, 910.0, 680.0, 510.0, 397.0, 320.0, 193.0, 125.0, 93.0, 77.0,
    ],
    [
        1180.0, 940.0, 700.0, 530.0, 416.0, 338.0, 282.0, 179.0, 120.0, 92.0, 77.0,
    ],
    [
        910.0, 730.0, 555.0, 442.0, 356.0, 292.0, 250.0, 166.0, 116.0, 90.0, 77.0,
    ],
    [
        505.0, 442.0, 352.0, 292.0, 243.0, 209.0, 183.0, 134.0, 104.0, 86.0, 77.0,
    ],
    [
        338.0, 317.0, 269.0, 227.0, 196.0, 172.0, 151.0, 116.0, 93.0, 82.0, 77.0,
    ],
    [
        259.0, 251.0, 225.0, 193.0, 166.0, 147.0, 132.0, 104.0, 86.0, 79.0, 77.0,
    ],
    [
        212.0, 210.0, 197.0, 170.0, 150.0, 133.0, 119.0, 96.0, 82.0, 77.0, 77.0,
    ],
    [
        188.0, 186.0, 177.0, 154.0, 138.0, 125.0, 113.0, 90.0, 77.0, 74.0, 77.0,
    ],
    [
        179.0, 178.0, 166.0, 147.0, 134.0, 122.0, 110.0, 90.0, 77.0, 73.0, 77.0,
    ],
    [
        179.0, 178.0, 165.0, 148.0, 137.0, 127.0, 116.0, 96.0, 79.0, 72.0, 77.0,
    ],
    [
        196.0, 192.0, 179.0, 165.0, 151.0, 141.0, 131.0, 104.0, 82.0, 72.0, 77.0,
    ],
    [
        230.0, 212.0, 195.0, 178.0, 163.0, 148.0, 134.0, 105.0, 83.0, 72.0, 77.0,
    ],
];

/// Radiance at 500 nm outside the air, W m^-2 sr^-1 nm^-1, by ecliptic longitude from the sun and ecliptic latitude, rad.
/// The logarithm is interpolated.
pub fn radiance_500nm(longitude_from_sun_rad: f64, latitude_rad: f64) -> f64 {
    static LOGARITHM: LazyLock<[[f64; 11]; 19]> =
        LazyLock::new(|| RADIANCE.map(|row| row.map(f64::ln)));
    let turned = longitude_from_sun_rad.rem_euclid(TAU);
    let longitude = turned.min(TAU - turned).to_degrees();
    let latitude = latitude_rad.abs().to_degrees().min(90.0);
    let across = Place::among(&LONGITUDES_DEG, longitude);
    let up = Place::among(&LATITUDES_DEG, latitude);
    let at = |i: usize| up.value_in(&LOGARITHM[i]);
    1e-11 * lerp(at(across.below), at(across.below + 1), across.fraction).exp()
}

/// Spectrum relative to that at 500 nm: the sun's, reddened as at 90 degrees from the sun (Leinert et al. 1998, eq. 22),
/// by `1 + 0.9 log10(lambda / 500 nm)` below and `1 + 0.6 log10(lambda / 500 nm)` above 500 nm.
pub fn spectrum(grid: &WavelengthGrid) -> Vec<f64> {
    let sun = solar::extraterrestrial();
    let mean_500nm = (490..=510).map(|nm| sun.at(f64::from(nm))).sum::<f64>() / 21.0;
    grid.wavelengths_nm()
        .iter()
        .zip(grid.solar_irradiance())
        .map(|(&nm, e)| {
            let decades = (nm / 500.0).log10();
            let slope = if nm < 500.0 { 0.9 } else { 0.6 };
            e / mean_500nm * (1.0 + slope * decades)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radiance_is_that_of_the_table_and_symmetric() {
        let at = |longitude: f64, latitude: f64| {
            radiance_500nm(longitude.to_radians(), latitude.to_radians())
        };
        for (longitude, latitude, want) in [
            (90.0, 0.0, 259.0),
            (180.0, 0.0, 230.0),
            (30.0, 0.0, 2480.0),
            (60.0, 45.0, 134.0),
            (123.0, 90.0, 77.0),
        ] {
            assert!((at(longitude, latitude) / (1e-11 * want) - 1.0).abs() < 1e-9);
            assert_eq!(at(longitude, latitude), at(longitude, -latitude));
            assert!((at(-longitude, latitude) / at(longitude, latitude) - 1.0).abs() < 1e-12);
        }
        let near = 15.0;
        assert!(at(near, 0.0) > at(near + 10.0, 0.0) && at(0.0, 0.0).is_finite());
        // The gegenschein is brighter than its surroundings.
        assert!(at(180.0, 0.0) > at(150.0, 0.0));
    }

    #[test]
    fn the_spectrum_is_redder_than_the_sun() {
        let grid = WavelengthGrid::standard();
        let spectrum = spectrum(&grid);
        let share = |k: usize| spectrum[k] / grid.solar_irradiance()[k];
        assert!(share(12) / share(2) > 1.1);
    }
}
