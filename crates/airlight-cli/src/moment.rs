//! Moments: seconds since 1970 and the zone they were given in.

use airlight::sun::position;
use std::time::{SystemTime, UNIX_EPOCH};

/// A moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Seconds since 1970-01-01T00:00:00Z.
    pub unix_s: f64,
    /// Local time minus UTC, s.
    pub offset_s: i32,
}

/// Date and time of day.
struct Calendar {
    year: i64,
    month: u32,
    day: u32,
    second_of_day: i64,
}

impl Moment {
    /// Reads `now`, or a time with its offset from UTC such as `2026-06-21T21:15:00+02:00`.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim().eq_ignore_ascii_case("now") {
            return Ok(Self::now());
        }
        let unix_s = position::parse_time(text).map_err(|e| format!("{e}; or write now"))?;
        Ok(Self {
            unix_s,
            offset_s: offset_s(text.trim()),
        })
    }

    /// The present, in UTC; 1970 where the clock stands before that.
    pub fn now() -> Self {
        let unix_s = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0.0, |d| d.as_secs_f64());
        Self {
            unix_s: unix_s.floor(),
            offset_s: 0,
        }
    }

    /// The same zone at another time.
    pub fn at(self, unix_s: f64) -> Self {
        Self { unix_s, ..self }
    }

    /// `2026-06-21T21:15:00+02:00`, to the second.
    pub fn rfc3339(self) -> String {
        let c = self.local();
        let zone = match self.offset_s {
            0 => "Z".to_owned(),
            s => format!(
                "{}{:02}:{:02}",
                if s < 0 { '-' } else { '+' },
                s.abs() / 3600,
                s.abs() / 60 % 60
            ),
        };
        let (h, m, s) = c.clock();
        format!(
            "{:04}-{:02}-{:02}T{h:02}:{m:02}:{s:02}{zone}",
            c.year, c.month, c.day
        )
    }

    /// The same in UTC.
    pub fn utc(self) -> String {
        Self {
            offset_s: 0,
            ..self
        }
        .rfc3339()
    }

    /// Local `2026:06:21 21:15:00`, as pictures keep it.
    pub fn capture_date(self) -> String {
        let c = self.local();
        let (h, m, s) = c.clock();
        format!(
            "{:04}:{:02}:{:02} {h:02}:{m:02}:{s:02}",
            c.year, c.month, c.day
        )
    }

    fn local(self) -> Calendar {
        let second = self.unix_s.floor() as i64 + i64::from(self.offset_s);
        Calendar::of(second.div_euclid(86_400), second.rem_euclid(86_400))
    }
}

impl Calendar {
    /// Of a number of days since 1970-01-01 (Gregorian calendar).
    fn of(days: i64, second_of_day: i64) -> Self {
        // The mean year is at most a day off.
        let mut year = 1970 + (days as f64 / 365.2425).floor() as i64;
        while first_day(year) > days {
            year -= 1;
        }
        while first_day(year + 1) <= days {
            year += 1;
        }
        let leap = first_day(year + 1) - first_day(year) == 366;
        let mut day = days - first_day(year);
        let mut month = 1;
        for length in [
            31,
            if leap { 29 } else { 28 },
            31,
            30,
            31,
            30,
            31,
            31,
            30,
            31,
            30,
        ] {
            if day < length {
                break;
            }
            day -= length;
            month += 1;
        }
        Self {
            year,
            month,
            day: day as u32 + 1,
            second_of_day,
        }
    }

    fn clock(&self) -> (i64, i64, i64) {
        (
            self.second_of_day / 3600,
            self.second_of_day / 60 % 60,
            self.second_of_day % 60,
        )
    }
}

/// Days from 1970-01-01 to the first of January of a year.
fn first_day(year: i64) -> i64 {
    let leap_days_before =
        |y: i64| (y - 1).div_euclid(4) - (y - 1).div_euclid(100) + (y - 1).div_euclid(400);
    365 * (year - 1970) + leap_days_before(year) - leap_days_before(1970)
}

/// The offset at the end of a time that has been read.
fn offset_s(text: &str) -> i32 {
    let zone = || {
        let at = text.len().checked_sub(6)?;
        let zone = text.get(at..)?;
        let sign = match zone.as_bytes()[0] {
            b'+' => 1,
            b'-' => -1,
            _ => return None,
        };
        let (hours, minutes) = zone[1..].split_once(':')?;
        Some(sign * (hours.parse::<i32>().ok()? * 3600 + minutes.parse::<i32>().ok()? * 60))
    };
    zone().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_come_back_as_they_were_written() {
        for text in [
            "2026-06-21T21:15:00+02:00",
            "2024-02-29T23:59:59-03:30",
            "1969-12-31T23:59:59Z",
            "1600-01-01T00:00:00Z",
            "2100-12-31T12:00:00Z",
            "0001-01-01T00:00:00Z",
        ] {
            assert_eq!(Moment::parse(text).unwrap().rfc3339(), text);
        }
        let m = Moment::parse("2026-06-21T01:15:00+02:00").unwrap();
        assert_eq!(m.utc(), "2026-06-20T23:15:00Z");
        assert_eq!(m.capture_date(), "2026:06:21 01:15:00");
        assert!(Moment::parse("now").unwrap().unix_s > 1.7e9);
        assert!(
            Moment::parse("tomorrow")
                .unwrap_err()
                .contains("2013-05-27T16:30:00Z")
        );
    }
}
