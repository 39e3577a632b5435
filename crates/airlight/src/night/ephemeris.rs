//! Position of the moon (Meeus 1998, Astronomical Algorithms, chapter 47, after the theory ELP-2000/82 of Chapront).

use super::celestial::{
    centuries, equator_of_date_to_world, sidereal_time_rad, spherical, sun_longitude_rad,
};
use crate::sun::ASTRONOMICAL_UNIT_M;
use glam::DVec3;

/// Equatorial radius of the Earth and its polar radius relative to it (WGS 84).
const EARTH_RADIUS_M: f64 = 6_378_137.0;
const POLAR_RATIO: f64 = 0.996_647_19;

/// Periodic terms of longitude and distance: multiples of elongation, the sun's anomaly, the moon's anomaly and its argument
/// of latitude; coefficients of the sine, 1e-6 degrees, and of the cosine, m (Meeus, table 47.A). Terms below 0.0022 degrees are
/// left out.
const LONGITUDE_AND_DISTANCE: [([i32; 4], f64, f64); 32] = [
    ([0, 0, 1, 0], 6_288_774.0, -20_905_355.0),
    ([2, 0, -1, 0], 1_274_027.0, -3_699_111.0),
    ([2, 0, 0, 0], 658_314.0, -2_955_968.0),
    ([0, 0, 2, 0], 213_618.0, -569_925.0),
    ([0, 1, 0, 0], -185_116.0, 48_888.0),
    ([0, 0, 0, 2], -114_332.0, -3_149.0),
    ([2, 0, -2, 0], 58_793.0, 246_158.0),
    ([2, -1, -1, 0], 57_066.0, -152_138.0),
    ([2, 0, 1, 0], 53_322.0, -170_733.0),
    ([2, -1, 0, 0], 45_758.0, -204_586.0),
    ([0, 1, -1, 0], -40_923.0, -129_620.0),
    ([1, 0, 0, 0], -34_720.0, 108_743.0),
    ([0, 1, 1, 0], -30_383.0, 104_755.0),
    ([2, 0, 0, -2], 15_327.0, 10_321.0),
    ([0, 0, 1, 2], -12_528.0, 0.0),
    ([0, 0, 1, -2], 10_980.0, 79_661.0),
    ([4, 0, -1, 0], 10_675.0, -34_782.0),
    ([0, 0, 3, 0], 10_034.0, -23_210.0),
    ([4, 0, -2, 0], 8_548.0, -21_636.0),
    ([2, 1, -1, 0], -7_888.0, 24_208.0),
    ([2, 1, 0, 0], -6_766.0, 30_824.0),
    ([1, 0, -1, 0], -5_163.0, -8_379.0),
    ([1, 1, 0, 0], 4_987.0, -16_675.0),
    ([2, -1, 1, 0], 4_036.0, -12_831.0),
    ([2, 0, 2, 0], 3_994.0, -10_445.0),
    ([4, 0, 0, 0], 3_861.0, -11_650.0),
    ([2, 0, -3, 0], 3_665.0, 14_403.0),
    ([0, 1, -2, 0], -2_689.0, -7_003.0),
    ([2, 0, -1, 2], -2_602.0, 0.0),
    ([2, -1, -2, 0], 2_390.0, 10_056.0),
    ([1, 0, 1, 0], -2_348.0, 6_322.0),
    ([2, -2, 0, 0], 2_236.0, -9_884.0),
];

/// Periodic terms of latitude: multiples as above, and coefficients of the sine, 1e-6 degrees (Meeus, table 47.B). Terms below
/// 0.0018 degrees are left out.
const LATITUDE: [([i32; 4], f64); 19] = [
    ([0, 0, 0, 1], 5_128_122.0),
    ([0, 0, 1, 1], 280_602.0),
    ([0, 0, 1, -1], 277_693.0),
    ([2, 0, 0, -1], 173_237.0),
    ([2, 0, -1, 1], 55_413.0),
    ([2, 0, -1, -1], 46_271.0),
    ([2, 0, 0, 1], 32_573.0),
    ([0, 0, 2, 1], 17_198.0),
    ([2, 0, 1, -1], 9_266.0),
    ([0, 0, 2, -1], 8_822.0),
    ([2, -1, 0, -1], 8_216.0),
    ([2, 0, -2, -1], 4_324.0),
    ([2, 0, 1, 1], 4_200.0),
    ([2, 1, 0, -1], -3_359.0),
    ([2, -1, -1, 1], 2_463.0),
    ([2, -1, 0, 1], 2_211.0),
    ([2, -1, -1, -1], 2_065.0),
    ([0, 1, -1, -1], -1_870.0),
    ([4, 0, -1, -1], 1_828.0),
];

/// Ecliptic longitude and latitude of date, rad, and distance of the moon from the Earth's centre, m.
fn geocentric_moon(centuries: f64) -> (f64, f64, f64) {
    let t = centuries;
    let mean_longitude = 218.316_447_7 + (481_267.881_234_21 - 0.001_578_6 * t) * t;
    let elongation = 297.850_192_1 + (445_267.111_403_4 - 0.001_881_9 * t) * t;
    let sun_anomaly = 357.529_109_2 + (35_999.050_290_9 - 0.000_153_6 * t) * t;
    let moon_anomaly = 134.963_396_4 + (477_198.867_505_5 + 0.008_741_4 * t) * t;
    let argument = 93.272_095_0 + (483_202.017_523_3 - 0.003_653_9 * t) * t;
    let angles = [elongation, sun_anomaly, moon_anomaly, argument].map(f64::to_radians);
    let eccentricity = 1.0 - (0.002_516 + 0.000_007_4 * t) * t;
    let phase = |multiples: [i32; 4]| -> f64 {
        multiples
            .iter()
            .zip(angles)
            .map(|(&n, angle)| f64::from(n) * angle)
            .sum()
    };
    let scale = |multiples: [i32; 4]| eccentricity.powi(multiples[1].abs());
    let venus = (119.75 + 131.849 * t).to_radians();
    let jupiter = (53.09 + 479_264.290 * t).to_radians();
    let third = (313.45 + 481_266.484 * t).to_radians();
    let mean = mean_longitude.to_radians();
    let mut longitude =
        3_958.0 * venus.sin() + 1_962.0 * (mean - angles[3]).sin() + 318.0 * jupiter.sin();
    let mut latitude = -2_235.0 * mean.sin() + 382.0 * third.sin();
    let mut distance_m = 385_000_560.0;
    for (multiples, sine, cosine) in LONGITUDE_AND_DISTANCE {
        longitude += sine * scale(multiples) * phase(multiples).sin();
        distance_m += cosine * scale(multiples) * phase(multiples).cos();
    }
    for (multiples, sine) in LATITUDE {
        latitude += sine * scale(multiples) * phase(multiples).sin();
    }
    let micro = |value: f64| (1e-6 * value).to_radians();
    (mean + micro(longitude), micro(latitude), distance_m)
}

/// Obliquity of the ecliptic of date, rad (Meeus 1998, eq. 22.2).
fn obliquity_rad(centuries: f64) -> f64 {
    (23.439_291_1 - 0.013_004_167 * centuries).to_radians()
}

/// The moon as seen from a place, in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoonPosition {
    /// Vector from the place to the moon, m.
    pub from_place_m: DVec3,
    /// Vector from the moon to the sun, m.
    pub to_sun_m: DVec3,
}

/// Position of the moon's centre without refraction, to 0.02 degrees and 60 km in this century.
pub fn moon_position(unix_s: f64, latitude_deg: f64, longitude_deg: f64) -> MoonPosition {
    let t = centuries(unix_s);
    let (longitude, latitude, distance_m) = geocentric_moon(t);
    let (sin, cos) = obliquity_rad(t).sin_cos();
    let equatorial = |longitude: f64, latitude: f64| {
        let at = spherical(longitude, latitude);
        DVec3::new(at.x, cos * at.y - sin * at.z, sin * at.y + cos * at.z)
    };
    let moon_m = distance_m * equatorial(longitude, latitude);
    let sun_m = ASTRONOMICAL_UNIT_M * equatorial(sun_longitude_rad(t), 0.0);
    // Geocentric coordinates of the place (Meeus, chapter 11), at sea level.
    let sidereal = sidereal_time_rad(unix_s, longitude_deg);
    let flat = (POLAR_RATIO * latitude_deg.to_radians().tan()).atan();
    let place_m = EARTH_RADIUS_M
        * DVec3::new(
            flat.cos() * sidereal.cos(),
            flat.cos() * sidereal.sin(),
            POLAR_RATIO * flat.sin(),
        );
    let to_world = equator_of_date_to_world(sidereal, latitude_deg);
    MoonPosition {
        from_place_m: to_world * (moon_m - place_m),
        to_sun_m: to_world * (sun_m - moon_m),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes;

    #[test]
    fn the_published_example_is_met() {
        // Meeus, example 47.a: 1992 April 12, 0 h TD.
        let t = -0.077_221_081_451;
        let (longitude, latitude, distance_m) = geocentric_moon(t);
        assert!((longitude.to_degrees().rem_euclid(360.0) - 133.162_655).abs() < 0.01);
        assert!((latitude.to_degrees() + 3.229_126).abs() < 0.01);
        assert!((1e-3 * distance_m - 368_409.7).abs() < 60.0);
    }

    #[test]
    fn the_moon_stands_where_astropy_puts_it() {
        // Azimuth and elevation without refraction, distance from the place (km), and angle from the sun, by astropy 8.0 with
        // its built-in ephemeris at 48.1 N, 11.6 E.
        for (unix_s, azimuth_deg, elevation_deg, distance_km, elongation_deg) in [
            (1_795_824_000.0, 116.3923, 51.6406, 358_017.7, 132.146),
            (1_782_000_000.0, 288.6026, -12.8712, 384_513.2, 78.775),
            (1_796_800_000.0, 127.9509, -4.9428, 405_537.0, 6.192),
            (1_700_000_000.0, 302.4755, -58.0577, 386_536.2, 18.954),
            (900_000_000.0, 88.8707, -27.3915, 386_385.2, 176.987),
        ] {
            let moon = moon_position(unix_s, 48.1, 11.6);
            let want = axes::direction(azimuth_deg, elevation_deg);
            let off = moon.from_place_m.angle_between(want).to_degrees();
            assert!(off < 0.025, "{unix_s}: {off} degrees");
            assert!((1e-3 * moon.from_place_m.length() - distance_km).abs() < 100.0);
            let sun_m = moon.from_place_m + moon.to_sun_m;
            let elongation = moon.from_place_m.angle_between(sun_m).to_degrees();
            assert!((elongation - elongation_deg).abs() < 0.05, "{elongation}");
        }
    }
}
