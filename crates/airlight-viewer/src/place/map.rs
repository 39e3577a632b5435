//! The map of the world, as the sun lights it.

use airlight::sun::{EphemerisError, Moment, Place, sun_position};
use eframe::egui::{Color32, ColorImage};
use glam::DVec3;
use std::sync::LazyLock;

/// Closed lines around land, and around lakes in it; the first lines state the source.
const LAND: &str = include_str!("../../data/land.txt");
/// Units of the table in a degree.
const PER_DEGREE: f64 = 10.0;
/// Colours of land and sea by day.
const LAND_COLOUR: [f64; 3] = [126.0, 136.0, 108.0];
const SEA_COLOUR: [f64; 3] = [52.0, 78.0, 102.0];
/// Brightness by night, relative to that by day.
const NIGHT: f64 = 0.22;
/// Elevations of the sun, degrees, between which night becomes day.
const TWILIGHT_DEG: [f64; 2] = [-12.0, 0.0];

/// A point of the map, degrees east and north.
type Point = [f64; 2];

/// Closed lines between land and water.
fn coasts() -> &'static [Vec<Point>] {
    static COASTS: LazyLock<Vec<Vec<Point>>> = LazyLock::new(|| {
        let rows = LAND.lines().filter(|line| !line.starts_with('#'));
        let points = |row: &str| -> Vec<Point> {
            let numbers = row.split(' ').filter_map(|text| text.parse::<f64>().ok());
            let degrees: Vec<f64> = numbers.map(|v| v / PER_DEGREE).collect();
            degrees.as_chunks().0.to_vec()
        };
        rows.map(points).collect()
    });
    &COASTS
}

/// Longitudes at which a parallel crosses coasts, ascending: land is between the first and the second, the third and the fourth, and so
/// on.
fn crossings(latitude_deg: f64) -> Vec<f64> {
    let mut found = Vec::new();
    for coast in coasts() {
        let ends = coast.iter().skip(1).chain(coast.first());
        for ([x0, y0], [x1, y1]) in coast.iter().zip(ends) {
            if (*y0 > latitude_deg) != (*y1 > latitude_deg) {
                found.push(x0 + (latitude_deg - y0) / (y1 - y0) * (x1 - x0));
            }
        }
    }
    found.sort_by(f64::total_cmp);
    found
}

/// Parts of the pixels of a row that are land, from the lines of latitude through it.
fn land_in_row(latitudes_deg: &[f64], width: usize) -> Vec<f64> {
    let pixels_per_degree = width as f64 / 360.0;
    let mut parts = vec![0.0; width];
    for latitude_deg in latitudes_deg {
        let coasts = crossings(*latitude_deg);
        for pair in coasts.as_chunks::<2>().0 {
            let [from, to] = pair.map(|deg| (deg + 180.0) * pixels_per_degree);
            let first = (from.max(0.0) as usize).min(width);
            for (i, part) in parts.iter_mut().enumerate().skip(first) {
                let left = i as f64;
                if left >= to {
                    break;
                }
                let overlap = to.min(left + 1.0) - from.max(left);
                *part += overlap / latitudes_deg.len() as f64;
            }
        }
    }
    parts
}

/// Unit vector to the zenith of a place: to 0° N 0° E, to 90° E and to the north.
fn zenith([longitude_deg, latitude_deg]: Point) -> DVec3 {
    let [longitude, latitude] = [longitude_deg, latitude_deg].map(f64::to_radians);
    let level = latitude.cos();
    DVec3::new(
        level * longitude.cos(),
        level * longitude.sin(),
        latitude.sin(),
    )
}

/// Unit vector to the sun in the axes of [`zenith`].
///
/// # Errors
/// [`EphemerisError`] for times that the ephemeris does not cover.
pub fn sun_over_earth(moment: Moment) -> Result<DVec3, EphemerisError> {
    let origin = Place {
        latitude_deg: 0.0,
        longitude_deg: 0.0,
        altitude_m: 0.0,
    };
    let there = sun_position(moment, origin, None)?.direction();
    // From up, east and north of the origin.
    Ok(DVec3::new(there.y, there.x, -there.z))
}

/// The map in equal steps of longitude and latitude, twice as wide as high, in the light of a sun in a direction of [`sun_over_earth`].
pub fn image(height: usize, sun: DVec3) -> ColorImage {
    let width = 2 * height;
    let degrees = 180.0 / height as f64;
    let [night, day] = TWILIGHT_DEG.map(|deg| deg.to_radians().sin());
    let mut pixels = Vec::with_capacity(width * height);
    for j in 0..height {
        let latitude_deg = 90.0 - (j as f64 + 0.5) * degrees;
        let lines = [-0.25, 0.25].map(|part| latitude_deg + part * degrees);
        for (i, land) in land_in_row(&lines, width).into_iter().enumerate() {
            let longitude_deg = (i as f64 + 0.5) * degrees - 180.0;
            let sine = zenith([longitude_deg, latitude_deg]).dot(sun);
            let part = ((sine - night) / (day - night)).clamp(0.0, 1.0);
            let light = NIGHT + (1.0 - NIGHT) * part * part * (3.0 - 2.0 * part);
            let [r, g, b] = std::array::from_fn(|c| {
                let colour = SEA_COLOUR[c] + land * (LAND_COLOUR[c] - SEA_COLOUR[c]);
                (colour * light).round() as u8
            });
            pixels.push(Color32::from_rgb(r, g, b));
        }
    }
    ColorImage::new([width, height], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::cities;

    fn is_land([longitude_deg, latitude_deg]: Point) -> bool {
        let coasts_deg = crossings(latitude_deg);
        coasts_deg.partition_point(|deg| *deg < longitude_deg) % 2 == 1
    }

    #[test]
    fn land_and_sea_are_where_they_are() {
        for land in [
            [25.0, 0.0],
            [100.0, 60.0],
            [-100.0, 40.0],
            [134.0, -25.0],
            [0.0, -85.0],
        ] {
            assert!(is_land(land), "{land:?}");
        }
        // Oceans, and the Caspian Sea in the land.
        for sea in [
            [-30.0, 0.0],
            [-150.0, 40.0],
            [80.0, -30.0],
            [0.0, 88.0],
            [51.0, 40.0],
        ] {
            assert!(!is_land(sea), "{sea:?}");
        }
        // Most large cities are not at the coast.
        let inland = cities::all()
            .iter()
            .filter(|city| is_land([city.longitude_deg, city.latitude_deg]));
        let part = inland.count() as f64 / cities::all().len() as f64;
        assert!(part > 0.75, "{part}");
        // A row of pixels has as much of it as the lines through it.
        let row = land_in_row(&[20.0], 90);
        let coasts = crossings(20.0);
        let lengths = coasts.as_chunks::<2>().0.iter();
        let land_deg: f64 = lengths.map(|[from, to]| to - from).sum();
        assert!((4.0 * row.iter().sum::<f64>() - land_deg).abs() < 1e-9);
        assert!(row.iter().all(|part| (0.0..=1.0 + 1e-9).contains(part)));
        // 29 % of the globe.
        let rows = (-89..90).map(|latitude| f64::from(latitude) + 0.01);
        let (mut land_deg, mut all_deg) = (0.0, 0.0);
        for latitude_deg in rows {
            let along = latitude_deg.to_radians().cos();
            let pairs = crossings(latitude_deg);
            let pairs = pairs.as_chunks::<2>().0.iter();
            land_deg += along * pairs.map(|[from, to]| to - from).sum::<f64>();
            all_deg += along * 360.0;
        }
        let part = land_deg / all_deg;
        assert!((part - 0.292).abs() < 0.01, "{part}");
    }

    /// Against the ephemeris at each place.
    #[test]
    fn the_sun_stands_over_each_place_as_its_ephemeris_says() {
        for (time, latitude_deg, longitude_deg) in [
            ("2026-06-21T10:00:00Z", 48.86, 2.33),
            ("2026-12-21T03:30:00Z", -33.9, 151.2),
            ("2024-03-20T18:00:00Z", 64.1, -21.9),
        ] {
            let moment: Moment = time.parse().unwrap();
            let sun = sun_over_earth(moment).unwrap();
            let sine = zenith([longitude_deg, latitude_deg]).dot(sun);
            let place = Place {
                latitude_deg,
                longitude_deg,
                altitude_m: 0.0,
            };
            let there = sun_position(moment, place, None).unwrap();
            // The parallax of the sun is 0.0024 degrees.
            assert!((sine.asin().to_degrees() - there.elevation_deg).abs() < 0.005);
        }
    }

    #[test]
    fn the_night_is_dark() {
        let noon: Moment = "2026-03-20T12:00:00Z".parse().unwrap();
        let map = image(90, sun_over_earth(noon).unwrap());
        assert_eq!(map.size, [180, 90]);
        let at = |longitude: usize| map.pixels[45 * 180 + (longitude + 180) / 2 % 180];
        let [day, night] = [at(330), at(180)];
        assert_eq!(day, Color32::from_rgb(52, 78, 102));
        assert!(night.g() < 20 && night.g() > 10, "{night:?}");
    }
}
