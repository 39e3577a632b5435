//! Solar ephemeris: azimuth, elevation and distance of the sun for a time and a place.
//!
//! The position is computed with the Solar Position Algorithm (Reda & Andreas, Solar Energy 76, 577, 2004;
//! NREL/TP-560-34302), accurate to 0.0003 degrees in the years -2000 to 6000, as implemented by the crate
//! `solar-positioning`.

use super::moment::Moment;
use super::{DAY_S, UNIX_EPOCH_JD};
use crate::axes;
use glam::DVec3;
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, SolarPositions, delta_t};

/// A location on the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Latitude in degrees, positive north, -90 to 90.
    pub latitude_deg: f64,
    /// Longitude in degrees, positive east, -180 to 180.
    pub longitude_deg: f64,
    /// Altitude above sea level, m.
    pub altitude_m: f64,
}

/// State of the air that refracts sunlight at the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefractingAir {
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// Temperature, degrees Celsius.
    pub temperature_c: f64,
}

impl RefractingAir {
    /// Standard air: 1013.25 hPa and 15 degrees Celsius.
    pub const STANDARD: Self = Self {
        pressure_pa: 101_325.0,
        temperature_c: 15.0,
    };
}

/// Position of the sun in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SunPosition {
    /// Azimuth in degrees clockwise from north, in `[0, 360)`.
    pub azimuth_deg: f64,
    /// Elevation in degrees above the horizon: apparent if computed with refraction, otherwise geometric.
    pub elevation_deg: f64,
    /// Elevation in degrees above the horizon without refraction.
    pub geometric_elevation_deg: f64,
    /// Distance from the Earth, AU.
    pub distance_au: f64,
}

impl SunPosition {
    /// Unit vector towards the sun, in world axes ([`axes`]).
    pub fn direction(&self) -> DVec3 {
        axes::direction(self.azimuth_deg, self.elevation_deg)
    }
}

/// Error of [`sun_position`] or of parsing a time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EphemerisError {
    /// A latitude, longitude or altitude out of range.
    #[error("expected {what} from {least} to {most}, got {got}")]
    Range {
        /// The quantity, with its unit.
        what: &'static str,
        /// Smallest value allowed.
        least: f64,
        /// Largest value allowed.
        most: f64,
        /// The value.
        got: f64,
    },
    /// The algorithm does not cover the time.
    #[error("no position of the sun: {0}")]
    Algorithm(String),
}

/// Position of the sun at a time and a place on the Earth, with or without atmospheric refraction.
///
/// Terrestrial time is computed from polynomials after Espenak & Meeus; at present they are a few seconds off, which moves
/// the sun by less than 1e-4 degrees. Far from the present the rotation of the Earth is uncertain: by minutes in the year -500, by
/// hours in the years -2000 and 6000, in which the sun moves by degrees.
///
/// Refraction follows the algorithm (its eq. 42, after Bennett and Saemundsson): for standard air 0.48 degrees when the
/// geometric sun is at the horizon, uncertain there by about 0.05 degrees with the weather and much more accurate above
/// 5 degrees. Below -0.833 degrees, where the algorithm stops, it decays as `1 / tan(-elevation)`, so that the elevation
/// stays continuous at sunset.
///
/// # Errors
/// [`EphemerisError`] if a number is out of range or not finite.
pub fn sun_position(
    time: Moment,
    place: Place,
    refraction: Option<RefractingAir>,
) -> Result<SunPosition, EphemerisError> {
    let year = 1970.0 + time.unix_s() / (365.2425 * DAY_S);
    check("year", year.floor(), -2000.0, 6000.0)?;
    sun_position_with_lag(time, terrestrial_lag_s(year)?, place, refraction)
}

/// Difference between terrestrial and universal time in a year, s: polynomials from -500 to 3000, continued before and after by the
/// parabola of Espenak & Meeus (2006), 32 s per squared century from 1820.
fn terrestrial_lag_s(year: f64) -> Result<f64, EphemerisError> {
    let parabola = |year: f64| 32.0 * ((year - 1820.0) / 100.0).powi(2);
    let known = year.clamp(-500.0, 3000.0);
    let lag_s = delta_t::estimate(known).map_err(algorithm)?;
    Ok(lag_s + parabola(year) - parabola(known))
}

/// As [`sun_position`], with an explicit difference between terrestrial and universal time (delta T), s.
///
/// # Errors
/// As [`sun_position`].
pub(crate) fn sun_position_with_lag(
    time: Moment,
    terrestrial_lag_s: f64,
    place: Place,
    refraction: Option<RefractingAir>,
) -> Result<SunPosition, EphemerisError> {
    check("latitude (degrees)", place.latitude_deg, -90.0, 90.0)?;
    check("longitude (degrees)", place.longitude_deg, -180.0, 180.0)?;
    check("altitude (m)", place.altitude_m, -12_000.0, 100_000.0)?;
    if let Some(air) = refraction {
        check("pressure (Pa)", air.pressure_pa, 0.0, 200_000.0)?;
        check(
            "temperature (degrees Celsius)",
            air.temperature_c,
            -150.0,
            100.0,
        )?;
    }
    let time = JulianDate::new(UNIX_EPOCH_JD + time.unix_s() / DAY_S, terrestrial_lag_s)
        .map_err(algorithm)?;
    let prepared = SolarPositions::new()
        .for_time_from_julian(time)
        .map_err(algorithm)?;
    let location = Location {
        latitude: place.latitude_deg,
        longitude: place.longitude_deg,
    };
    let solved = prepared
        .at(location, place.altitude_m, None)
        .map_err(algorithm)?;
    let geometric = 90.0 - solved.zenith_angle();
    Ok(SunPosition {
        azimuth_deg: solved.azimuth().rem_euclid(360.0),
        elevation_deg: geometric + refraction.map_or(0.0, |air| refraction_deg(geometric, air)),
        geometric_elevation_deg: geometric,
        distance_au: prepared.earth_radius_vector().unwrap_or(1.0),
    })
}

/// A direction (unit vector) as it appears through refracting air, or unchanged for `None`.
pub(crate) fn raised(direction: DVec3, refraction: Option<RefractingAir>) -> DVec3 {
    let Some(air) = refraction else {
        return direction;
    };
    let elevation_deg = axes::elevation_deg(direction);
    let lift_deg = refraction_deg(elevation_deg, air);
    axes::direction(axes::azimuth_deg(direction), elevation_deg + lift_deg)
}

/// Refraction at a geometric elevation, degrees (Reda & Andreas 2004, eq. 42).
fn refraction_deg(geometric_elevation_deg: f64, air: RefractingAir) -> f64 {
    /// Minus the sun's radius and the refraction at the horizon, where the algorithm stops.
    const LOWEST_DEG: f64 = -0.833_37;
    let e = geometric_elevation_deg.max(LOWEST_DEG);
    let standard = 1.02 / (60.0 * (e + 10.3 / (e + 5.11)).to_radians().tan());
    let lift = air.pressure_pa / 101_000.0 * (283.0 / (273.0 + air.temperature_c)) * standard;
    match geometric_elevation_deg < LOWEST_DEG {
        // Decays to 0 at the nadir.
        true => {
            let tangent = |deg: f64| deg.to_radians().tan();
            lift * (tangent(LOWEST_DEG) / tangent(geometric_elevation_deg)).max(0.0)
        }
        false => lift,
    }
}

fn check(what: &'static str, got: f64, least: f64, most: f64) -> Result<(), EphemerisError> {
    match (least..=most).contains(&got) {
        true => Ok(()),
        false => Err(EphemerisError::Range {
            what,
            least,
            most,
            got,
        }),
    }
}

fn algorithm(error: solar_positioning::Error) -> EphemerisError {
    EphemerisError::Algorithm(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOLDEN: Place = Place {
        latitude_deg: 39.742476,
        longitude_deg: -105.1786,
        altitude_m: 1830.14,
    };

    fn moment(text: &str) -> Moment {
        text.parse().unwrap()
    }

    #[test]
    fn position_matches_the_published_example() {
        // Reda & Andreas, NREL/TP-560-34302, table A5.1: delta T 67 s, 820 mbar, 11 degrees Celsius.
        let time = moment("2003-10-17T12:30:30-07:00");
        let air = RefractingAir {
            pressure_pa: 82_000.0,
            temperature_c: 11.0,
        };
        let sun = sun_position_with_lag(time, 67.0, GOLDEN, Some(air)).unwrap();
        assert!(
            (90.0 - sun.elevation_deg - 50.11162).abs() < 1e-5,
            "{sun:?}"
        );
        assert!((sun.azimuth_deg - 194.34024).abs() < 1e-5, "{sun:?}");
        assert!((sun.distance_au - 0.996_542_297).abs() < 1e-8, "{sun:?}");
        let usual = sun_position(time, GOLDEN, Some(air)).unwrap();
        assert!((usual.elevation_deg - sun.elevation_deg).abs() < 1e-4);
    }

    #[test]
    fn sun_culminates_overhead_at_the_tropic_on_the_solstice() {
        // 2024-06-20T20:51Z is the solstice; at 12:02 solar time the sun is above the tropic of Cancer.
        let place = Place {
            latitude_deg: 23.436,
            longitude_deg: -132.3,
            altitude_m: 0.0,
        };
        let time = moment("2024-06-20T20:51:00Z");
        let sun = sun_position(time, place, None).unwrap();
        assert!(sun.elevation_deg > 89.5, "{sun:?}");
        assert!((sun.distance_au - 1.0163).abs() < 1e-3);
        assert!(sun.direction().y > 0.9999);
    }

    #[test]
    fn refraction_is_positive_and_continuous() {
        let air = RefractingAir::STANDARD;
        assert!(
            (refraction_deg(0.0, air) - 0.478).abs() < 0.01,
            "{}",
            refraction_deg(0.0, air)
        );
        assert!(refraction_deg(90.0, air).abs() < 1e-4);
        let mut before = refraction_deg(-90.0, air);
        for i in -8999..=9000 {
            let now = refraction_deg(0.01 * f64::from(i), air);
            assert!((now - before).abs() < 0.01, "{i}: {before} {now}");
            before = now;
        }
    }

    #[test]
    fn places_and_times_out_of_range_are_refused() {
        let now = Moment::now();
        for (latitude_deg, longitude_deg, altitude_m) in
            [(91.0, 0.0, 0.0), (0.0, 181.0, 0.0), (0.0, 0.0, f64::NAN)]
        {
            let place = Place {
                latitude_deg,
                longitude_deg,
                altitude_m,
            };
            assert!(matches!(
                sun_position(now, place, None),
                Err(EphemerisError::Range { .. })
            ));
        }
        for time in [
            "8000-01-01T00:00Z",
            "6001-01-01T12:00Z",
            "-004000-01-01T00:00Z",
        ] {
            let error = sun_position(moment(time), GOLDEN, None).unwrap_err();
            let said = error.to_string();
            assert!(
                said.starts_with("expected year from -2000 to 6000"),
                "{said}"
            );
        }
        for time in [
            "-001999-06-01T12:00Z",
            "0000-06-01T12:00Z",
            "5999-06-01T12:00Z",
        ] {
            let sun = sun_position(moment(time), GOLDEN, None).unwrap();
            assert!((-90.0..=90.0).contains(&sun.elevation_deg), "{time}");
        }
        // Continuous, and growing as the parabola.
        for year in [-500.0, 3000.0] {
            let [before, after] = [-1e-6, 1e-6].map(|step| terrestrial_lag_s(year + step).unwrap());
            assert!((after - before).abs() < 0.01, "{year}: {before} {after}");
        }
        let grown = terrestrial_lag_s(6000.0).unwrap() - terrestrial_lag_s(3000.0).unwrap();
        assert!(
            (grown - 32.0 * (41.8 * 41.8 - 11.8 * 11.8)).abs() < 1e-6,
            "{grown}"
        );
    }
}
