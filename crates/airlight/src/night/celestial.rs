//! Orientation of the celestial sphere over a place.

use crate::sun::{DAY_S, UNIX_EPOCH_JD};
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Obliquity of the ecliptic at J2000, rad.
const OBLIQUITY_J2000_RAD: f64 = 0.409_092_804_222_329;
/// Julian date of J2000.0.
const J2000_JD: f64 = 2_451_545.0;

/// Orientation of the celestial sphere over a place at a time.
///
/// Positions on the sphere are equatorial, ecliptic or galactic coordinates of J2000. Precession is included; nutation,
/// aberration (together below 0.01 degrees) and refraction (0.5 degrees at the horizon, 0.1 degrees at an elevation of 10
/// degrees) are not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CelestialFrame {
    /// Rotation from equatorial coordinates of J2000 to world axes ([`crate::axes`]).
    to_world: DMat3,
    /// Ecliptic longitude of the sun (J2000), rad.
    sun_longitude_rad: f64,
}

impl CelestialFrame {
    /// The sphere over a place at a time, seconds since 1970-01-01T00:00:00Z.
    pub fn at(unix_s: f64, latitude_deg: f64, longitude_deg: f64) -> Self {
        let centuries = centuries(unix_s);
        let of_date =
            equator_of_date_to_world(sidereal_time_rad(unix_s, longitude_deg), latitude_deg);
        let precessed = 5029.0966 / 3600.0 * centuries;
        Self {
            to_world: of_date * precession(centuries),
            sun_longitude_rad: sun_longitude_rad(centuries) - precessed.to_radians(),
        }
    }

    /// The sphere over a latitude that has the sun in a direction (unit vector), in the half of the year in which days grow
    /// longer; over the nearest latitude where the sun may stand there, if it never does at this one.
    pub fn with_sun(sun: DVec3, latitude_deg: f64) -> Self {
        let latitude_deg = nearest_latitude_deg(sun, latitude_deg);
        let (sin_latitude, cos_latitude) = latitude_deg.to_radians().sin_cos();
        let (east, up, south) = (sun.x, sun.y, sun.z);
        let sin_declination = up * sin_latitude - south * cos_latitude;
        let toward_meridian = up * cos_latitude + south * sin_latitude;
        let hour_angle = (-east).atan2(toward_meridian);
        let (sin_obliquity, cos_obliquity) = OBLIQUITY_J2000_RAD.sin_cos();
        let longitude = (sin_declination / sin_obliquity).clamp(-1.0, 1.0).asin();
        let right_ascension = (cos_obliquity * longitude.sin()).atan2(longitude.cos());
        Self {
            to_world: equator_of_date_to_world(right_ascension + hour_angle, latitude_deg),
            sun_longitude_rad: longitude,
        }
    }

    /// Unit vector in world axes towards a right ascension and a declination (J2000), rad.
    pub fn direction_of(&self, right_ascension_rad: f64, declination_rad: f64) -> DVec3 {
        self.to_world * spherical(right_ascension_rad, declination_rad)
    }

    /// Rotates a unit vector in equatorial coordinates (J2000: x to the vernal equinox, z to the pole) to world axes.
    pub fn to_world(&self, equatorial: DVec3) -> DVec3 {
        self.to_world * equatorial
    }

    /// Rotates a unit vector in world axes to equatorial coordinates.
    pub fn to_equatorial(&self, direction: DVec3) -> DVec3 {
        self.to_world.transpose() * direction
    }

    /// Ecliptic longitude from the sun and ecliptic latitude of an equatorial unit vector, rad.
    pub fn ecliptic_from_sun(&self, equatorial: DVec3) -> (f64, f64) {
        let (sin, cos) = OBLIQUITY_J2000_RAD.sin_cos();
        let y = cos * equatorial.y + sin * equatorial.z;
        let z = cos * equatorial.z - sin * equatorial.y;
        (
            y.atan2(equatorial.x) - self.sun_longitude_rad,
            z.clamp(-1.0, 1.0).asin(),
        )
    }
}

/// The latitude nearest to a given one at which the declination of a sun in a direction is at most the obliquity of the ecliptic,
/// to half a degree.
fn nearest_latitude_deg(sun: DVec3, latitude_deg: f64) -> f64 {
    let occurs = |deg: f64| {
        let (sin, cos) = deg.to_radians().sin_cos();
        (sun.y * sin - sun.z * cos).abs() <= OBLIQUITY_J2000_RAD.sin()
    };
    (0..=360)
        .flat_map(|step| {
            let away = 0.5 * f64::from(step);
            [latitude_deg + away, latitude_deg - away]
        })
        .find(|&deg| deg.abs() <= 90.0 && occurs(deg))
        .unwrap_or(latitude_deg)
}

/// Galactic longitude and latitude of an equatorial unit vector (J2000), rad. The pole is at right ascension 192.85948 and
/// declination 27.12825 degrees, the centre at 266.40500 and -28.93617 degrees (Perryman et al. 1997, Hipparcos catalogue,
/// vol. 1, sec. 1.5.3).
pub(super) fn galactic(equatorial: DVec3) -> (f64, f64) {
    let to_galactic = DMat3::from_cols(
        DVec3::new(-0.054_875_560_4, 0.494_109_427_9, -0.867_666_149_0),
        DVec3::new(-0.873_437_090_2, -0.444_829_630_0, -0.198_076_373_4),
        DVec3::new(-0.483_835_015_5, 0.746_982_244_5, 0.455_983_776_2),
    );
    let at = to_galactic * equatorial;
    (at.y.atan2(at.x), at.z.clamp(-1.0, 1.0).asin())
}

/// Unit vector of two spherical coordinates, rad.
pub(super) fn spherical(longitude_rad: f64, latitude_rad: f64) -> DVec3 {
    let (sin, cos) = longitude_rad.sin_cos();
    DVec3::new(
        latitude_rad.cos() * cos,
        latitude_rad.cos() * sin,
        latitude_rad.sin(),
    )
}

/// Julian centuries since J2000, of universal time: 70 s less than terrestrial time, in which the moon moves by 0.01
/// degrees.
pub(super) fn centuries(unix_s: f64) -> f64 {
    (unix_s / DAY_S + UNIX_EPOCH_JD - J2000_JD) / 36_525.0
}

/// Local mean sidereal time (Meeus 1998, Astronomical Algorithms, eq. 12.4), rad.
pub(super) fn sidereal_time_rad(unix_s: f64, longitude_deg: f64) -> f64 {
    let days = unix_s / DAY_S + UNIX_EPOCH_JD - J2000_JD;
    let t = days / 36_525.0;
    let deg = 280.460_618_37 + 360.985_647_366_29 * days + 0.000_387_933 * t * t;
    (deg + longitude_deg).to_radians().rem_euclid(TAU)
}

/// Ecliptic longitude of the sun of date, rad, to 0.01 degrees (Meeus 1998, chapter 25).
pub(super) fn sun_longitude_rad(centuries: f64) -> f64 {
    let t = centuries;
    let mean = 280.466_46 + 36_000.769_83 * t + 0.000_303_2 * t * t;
    let anomaly = (357.529_11 + 35_999.050_29 * t - 0.000_153_7 * t * t).to_radians();
    let centre = (1.914_602 - 0.004_817 * t) * anomaly.sin()
        + (0.019_993 - 0.000_101 * t) * (2.0 * anomaly).sin()
        + 0.000_289 * (3.0 * anomaly).sin();
    (mean + centre).to_radians()
}

/// Rotation from the equator of date to world axes, for a local sidereal time.
pub(super) fn equator_of_date_to_world(sidereal_rad: f64, latitude_deg: f64) -> DMat3 {
    let (sin_time, cos_time) = sidereal_rad.sin_cos();
    let (sin_latitude, cos_latitude) = latitude_deg.to_radians().sin_cos();
    // Rows: east, up and south in equatorial coordinates.
    let east = DVec3::new(-sin_time, cos_time, 0.0);
    let to_meridian = DVec3::new(cos_time, sin_time, 0.0);
    let up = cos_latitude * to_meridian + sin_latitude * DVec3::Z;
    let south = sin_latitude * to_meridian - cos_latitude * DVec3::Z;
    DMat3::from_cols(east, up, south).transpose()
}

/// Rotation from the equator of J2000 to that of date (IAU 1976: Meeus 1998, eq. 21.3 and 21.4).
fn precession(centuries: f64) -> DMat3 {
    let t = centuries;
    let arcsec = |first: f64, second: f64, third: f64| {
        ((first + (second + third * t) * t) * t / 3600.0).to_radians()
    };
    let zeta = arcsec(2306.2181, 0.301_88, 0.017_998);
    let z = arcsec(2306.2181, 1.094_68, 0.018_203);
    let theta = arcsec(2004.3109, -0.426_65, -0.041_833);
    DMat3::from_rotation_z(z) * DMat3::from_rotation_y(-theta) * DMat3::from_rotation_z(zeta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes;

    /// 2026-11-28T00:00:00Z.
    const TIME_S: f64 = 1_795_824_000.0;

    /// Right ascension, declination, azimuth and elevation, degrees.
    const ASTROPY: [(f64, f64, f64, f64); 4] = [
        (101.287, -16.716, 156.1214, 21.9572),
        (279.235, 38.784, 343.8236, -1.1195),
        (37.95, 89.264, 359.5122, 48.6297),
        (213.915, 19.183, 42.4410, -12.0561),
    ];
    /// Right ascension, declination, galactic longitude and latitude, degrees.
    const ASTROPY_GALACTIC: [(f64, f64, f64, f64); 4] = [
        (101.287, -16.716, 227.23012, -8.89036),
        (279.235, 38.784, 67.44859, 19.23716),
        (37.95, 89.264, 123.28054, 26.46127),
        (213.915, 19.183, 15.05119, 69.11181),
    ];
    const SUN_RA_DEC_DEG: (f64, f64) = (243.455_39, -21.196_36);

    fn angle_deg(a: DVec3, b: DVec3) -> f64 {
        a.angle_between(b).to_degrees()
    }

    #[test]
    fn stars_stand_where_astropy_puts_them() {
        // Azimuth and elevation without refraction, by astropy 8.0 (AltAz) at 48.1 N, 11.6 E.
        let frame = CelestialFrame::at(TIME_S, 48.1, 11.6);
        for (right_ascension_deg, declination_deg, azimuth_deg, elevation_deg) in ASTROPY {
            let got = frame.direction_of(
                right_ascension_deg.to_radians(),
                declination_deg.to_radians(),
            );
            let want = axes::direction(azimuth_deg, elevation_deg);
            assert!(angle_deg(got, want) < 0.015, "{}", angle_deg(got, want));
        }
    }

    #[test]
    fn galactic_coordinates_match_astropy() {
        for (right_ascension_deg, declination_deg, l_deg, b_deg) in ASTROPY_GALACTIC {
            let at = spherical(
                f64::to_radians(right_ascension_deg),
                f64::to_radians(declination_deg),
            );
            let (l, b) = galactic(at);
            let got = spherical(l, b);
            let want = spherical(f64::to_radians(l_deg), f64::to_radians(b_deg));
            assert!(angle_deg(got, want) < 1e-4);
        }
    }

    #[test]
    fn the_sun_is_where_it_was_put() {
        for (azimuth_deg, elevation_deg, latitude_deg) in [
            (180.0, -30.0, 45.0),
            (0.0, 90.0, 80.0),
            (270.0, -5.0, 10.0),
            (20.0, -40.0, -35.0),
        ] {
            let sun = axes::direction(azimuth_deg, elevation_deg);
            let frame = CelestialFrame::with_sun(sun, latitude_deg);
            let (longitude, latitude) = frame.ecliptic_from_sun(frame.to_equatorial(sun));
            assert!(longitude.abs() < 1e-9 && latitude.abs() < 1e-9);
        }
        // The pole stands at the latitude where the sun may be there.
        for (elevation_deg, latitude_deg, pole_deg) in [(-5.0, 30.0, 30.0), (-30.0, 45.0, -37.0)] {
            let sun = axes::direction(
                if latitude_deg == 30.0 { 270.0 } else { 180.0 },
                elevation_deg,
            );
            let frame = CelestialFrame::with_sun(sun, latitude_deg);
            let pole = frame.direction_of(0.0, 0.5 * std::f64::consts::PI);
            let off = angle_deg(pole, axes::direction(0.0, pole_deg));
            assert!(off < 1e-9, "{elevation_deg}: {off}");
        }
    }

    #[test]
    fn the_sun_of_a_time_is_on_the_ecliptic_of_its_frame() {
        let place = (48.1, 11.6);
        let frame = CelestialFrame::at(TIME_S, place.0, place.1);
        // By astropy 8.0: right ascension and declination (J2000) of the sun.
        let sun = spherical(SUN_RA_DEC_DEG.0.to_radians(), SUN_RA_DEC_DEG.1.to_radians());
        let (longitude, latitude) = frame.ecliptic_from_sun(sun);
        let turns = (longitude / TAU).round() * TAU;
        assert!(
            (longitude - turns).to_degrees().abs() < 0.02 && latitude.to_degrees().abs() < 0.01
        );
    }
}
