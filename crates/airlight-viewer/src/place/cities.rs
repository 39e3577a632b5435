//! [`City`]: cities of the world by name, and their clocks.

use airlight::axes;
use airlight::glam::DVec3;
use airlight::sun::Moment;
use std::sync::LazyLock;

/// Cities by population; the first lines state the sources and the columns.
const TABLE: &str = include_str!("../../data/cities.csv");
/// Mean radius of the Earth, km.
const EARTH_RADIUS_KM: f64 = 6371.0;

/// A city.
#[derive(Clone, Debug, PartialEq)]
pub struct City {
    /// English name.
    pub name: &'static str,
    /// Name of its country.
    pub country: &'static str,
    /// Latitude, degrees north.
    pub latitude_deg: f64,
    /// Longitude, degrees east.
    pub longitude_deg: f64,
    /// Time zone, by its name in the database of the IANA.
    pub zone: &'static str,
    /// Its names, the English one first, in the letters of [`plain`].
    names: Vec<String>,
    plain_country: String,
}

/// All cities, the largest first.
pub fn all() -> &'static [City] {
    static CITIES: LazyLock<Vec<City>> = LazyLock::new(|| {
        let rows = TABLE.lines().filter(|line| !line.starts_with('#'));
        rows.filter_map(City::of_row).collect()
    });
    &CITIES
}

/// Cities whose name, part of a name or country begins with a text, the best matches first.
pub fn matching(text: &str) -> Vec<&'static City> {
    let sought = plain(text);
    let sought = sought.trim();
    if sought.is_empty() {
        return Vec::new();
    }
    let ranked = all()
        .iter()
        .filter_map(|city| Some((city.rank(sought)?, city)));
    let mut ranked: Vec<_> = ranked.collect();
    // Stable: the larger of equal matches first.
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, city)| city).collect()
}

/// The city nearest to a place, degrees north and east, and its distance on the sphere, km.
pub fn nearest(latitude_deg: f64, longitude_deg: f64) -> (&'static City, f64) {
    let here = axes::direction(longitude_deg, latitude_deg);
    let cosine = |city: &City| city.direction().dot(here);
    let nearest = all()
        .iter()
        .max_by(|a, b| cosine(a).total_cmp(&cosine(b)))
        .expect("a table of cities");
    let angle = nearest.direction().angle_between(here);
    (nearest, EARTH_RADIUS_KM * angle)
}

impl City {
    fn of_row(row: &'static str) -> Option<Self> {
        let mut fields = row.split(';');
        let mut next = || fields.next();
        let [name, others, country] = [next()?, next()?, next()?];
        let [latitude_deg, longitude_deg] = [next()?.parse().ok()?, next()?.parse().ok()?];
        let others = others.split('/').filter(|other| !other.is_empty());
        Some(Self {
            name,
            country,
            latitude_deg,
            longitude_deg,
            zone: next()?,
            names: std::iter::once(name).chain(others).map(plain).collect(),
            plain_country: plain(country),
        })
    }

    /// How well a plain text matches: 0 is best.
    fn rank(&self, sought: &str) -> Option<u8> {
        let names = || self.names.iter();
        let begins_later_word = |name: &String| {
            let mut places = name.match_indices(sought).map(|(at, _)| &name[..at]);
            places.any(|before| before.ends_with([' ', '-']))
        };
        if names().any(|name| name == sought) {
            Some(0)
        } else if names().any(|name| name.starts_with(sought)) {
            Some(1)
        } else if names().any(begins_later_word) {
            Some(2)
        } else {
            self.plain_country.starts_with(sought).then_some(3)
        }
    }

    /// Unit vector on the globe: longitude as azimuth, latitude as elevation.
    fn direction(&self) -> DVec3 {
        axes::direction(self.longitude_deg, self.latitude_deg)
    }

    /// A moment on the clocks of the city; as it is where their offset from UTC had seconds.
    pub fn on_its_clocks(&self, moment: Moment) -> Moment {
        let utc = moment.utc();
        format!("{utc}[{}]", self.zone).parse().unwrap_or(moment)
    }

    /// The moment at which the clocks of the city show what others show at a moment; that moment itself where they show it twice or
    /// never.
    pub fn at_same_clock_time(&self, moment: Moment) -> Moment {
        let text = moment.to_string();
        let local = text
            .find('T')
            .and_then(|t| text.get(..t + "T00:00:00".len()));
        let there = local.and_then(|local| format!("{local}[{}]", self.zone).parse().ok());
        there.unwrap_or_else(|| self.on_its_clocks(moment))
    }
}

/// A text in lower case, its Latin letters without accents.
fn plain(text: &str) -> String {
    let letters = text.chars().flat_map(char::to_lowercase);
    // The dot above that the lower case of a dotted capital I has.
    let letters = letters.filter(|c| !('\u{300}'..='\u{36f}').contains(c));
    letters
        .map(|c| match c {
            'à'..='å' | 'ā' | 'ă' | 'ą' => 'a',
            'ç' | 'ć' | 'č' => 'c',
            'è'..='ë' | 'ē' | 'ė' | 'ę' | 'ě' => 'e',
            'ġ' | 'ğ' => 'g',
            'ì'..='ï' | 'ī' | 'ı' => 'i',
            'ł' => 'l',
            'ñ' | 'ń' | 'ň' => 'n',
            'ò'..='ö' | 'ø' | 'ō' | 'ő' => 'o',
            'ř' => 'r',
            'ś' | 'š' | 'ş' | 'ș' => 's',
            'ţ' | 'ț' => 't',
            'ù'..='ü' | 'ū' | 'ů' | 'ű' => 'u',
            'ý' | 'ÿ' => 'y',
            'ź' | 'ż' | 'ž' => 'z',
            '’' => '\'',
            '–' => '-',
            c => c,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(text: &str) -> &'static str {
        matching(text).first().map_or("", |city| city.name)
    }

    #[test]
    fn every_row_is_a_city_with_plain_names_and_clocks() {
        let rows = TABLE.lines().filter(|line| !line.starts_with('#'));
        assert_eq!(all().len(), rows.count());
        assert!(all().len() > 300);
        let moment: Moment = "2026-06-21T12:00:00Z".parse().unwrap();
        for city in all() {
            assert!(city.latitude_deg.abs() <= 90.0 && city.longitude_deg.abs() <= 180.0);
            for name in city.names.iter().chain([&city.plain_country]) {
                assert!(name.is_ascii() && !name.is_empty(), "{city:?}");
            }
            let there: Result<Moment, _> = format!("2026-06-21T12:00:00Z[{}]", city.zone).parse();
            let there = there.unwrap_or_else(|error| panic!("{}: {error}", city.name));
            assert_eq!(there, city.on_its_clocks(moment));
            // Clocks follow the sun, but for those of wide countries and of the pole.
            let solar_h = city.longitude_deg / 15.0;
            let apart_h = f64::from(there.offset_s()) / 3600.0 - solar_h;
            let apart_h = (apart_h + 12.0).rem_euclid(24.0) - 12.0;
            assert!(apart_h.abs() < 3.5, "{city:?}: {apart_h}");
        }
    }

    #[test]
    fn cities_are_found_by_parts_of_their_names_and_by_country() {
        for (text, name) in [
            ("paris", "Paris"),
            ("  TOKYO ", "Tokyo"),
            ("sao p", "São Paulo"),
            ("São", "São Paulo"),
            ("izmir", "İzmir"),
            ("reykjavi", "Reykjavík"),
            ("bombay", "Mumbai"),
            ("KIEV", "Kyiv"),
            ("south pole", "Amundsen–Scott South Pole Station"),
            ("york", "New York"),
            ("norway", "Oslo"),
            // The larger of two.
            ("hyderabad", "Hyderabad"),
            ("costa", "San José"),
        ] {
            assert_eq!(first(text), name, "{text}");
        }
        assert!(matching("london").iter().all(|city| city.name != "Paris"));
        assert!(matching(" ").is_empty() && matching("xyzzy").is_empty());
    }

    #[test]
    fn the_nearest_city_is_found_across_the_date_line() {
        let (city, km) = nearest(48.8584, 2.2945);
        assert!(city.name == "Paris" && km < 10.0, "{city:?} {km}");
        let (city, km) = nearest(-17.5, -179.0);
        assert!(
            city.name == "Suva" && (200.0..400.0).contains(&km),
            "{city:?} {km}"
        );
        // A degree of a meridian.
        let quito = &matching("quito")[0];
        let (_, km) = nearest(quito.latitude_deg - 1.0, quito.longitude_deg);
        assert!((km - 111.2).abs() < 0.1, "{km}");
    }

    #[test]
    fn clocks_have_summer_time_and_keep_the_hour() {
        let tokyo = matching("tokyo")[0];
        let paris = matching("paris")[0];
        let evening: Moment = "2026-06-21T21:15:00+02:00".parse().unwrap();
        assert_eq!(
            tokyo.on_its_clocks(evening).to_string(),
            "2026-06-22T04:15:00+09:00"
        );
        assert_eq!(
            tokyo.at_same_clock_time(evening).to_string(),
            "2026-06-21T21:15:00+09:00"
        );
        let winter: Moment = "2026-12-21T09:00:00+09:00".parse().unwrap();
        assert_eq!(
            paris.at_same_clock_time(winter).to_string(),
            "2026-12-21T09:00:00+01:00"
        );
        // A time that the clocks of Paris skip, and one when they were set by the sun.
        let skipped: Moment = "2026-03-29T02:30:00Z".parse().unwrap();
        assert_eq!(
            paris.at_same_clock_time(skipped).to_string(),
            "2026-03-29T04:30:00+02:00"
        );
        let long_ago: Moment = "1850-06-21T12:00:00Z".parse().unwrap();
        assert_eq!(paris.on_its_clocks(long_ago), long_ago);
    }
}
