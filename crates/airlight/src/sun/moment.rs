//! Times with their offset from UTC.

use jiff::fmt::temporal::{DateTimePrinter, Pieces};
use jiff::tz::Offset;
use jiff::{SignedDuration, Timestamp};
use std::fmt;
use std::str::FromStr;

/// A time with its offset from UTC, in the years -9999 to 9999 of the Gregorian calendar, also before 1582. Leap seconds do not
/// count: a second of 60 is read as 59.
///
/// Reads and writes RFC 3339:
///
/// ```
/// use airlight::sun::Moment;
///
/// let evening: Moment = "2026-06-21T21:15:00+02:00".parse()?;
/// assert_eq!(evening.to_string(), "2026-06-21T21:15:00+02:00");
/// assert_eq!(evening.utc().to_string(), "2026-06-21T19:15:00Z");
/// # Ok::<(), airlight::sun::MomentError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Moment {
    time: Timestamp,
    offset: Offset,
}

/// Why a text is not a [`Moment`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected a time such as 2013-05-27T16:30:00Z or 2013-05-27T12:30:00-04:00, got \"{text}\": {reason}"
)]
#[non_exhaustive]
pub struct MomentError {
    /// The text.
    pub text: String,
    /// What is wrong with it.
    pub reason: String,
}

impl Moment {
    /// The present to the second, in UTC.
    pub fn now() -> Self {
        Self::from_unix_s(Timestamp::now().as_second() as f64)
    }

    /// Reads `now`, or a time as [`FromStr`] does.
    ///
    /// # Errors
    /// As [`FromStr`].
    pub fn parse(text: &str) -> Result<Self, MomentError> {
        match text.trim().eq_ignore_ascii_case("now") {
            true => Ok(Self::now()),
            false => text.parse(),
        }
    }

    /// A number of seconds after 1970-01-01T00:00:00Z, in UTC; held to the range of years, and 1970 for a number that is not
    /// one.
    pub fn from_unix_s(unix_s: f64) -> Self {
        Self {
            time: Timestamp::UNIX_EPOCH,
            offset: Offset::UTC,
        }
        .at(unix_s)
    }

    /// Seconds since 1970-01-01T00:00:00Z.
    pub fn unix_s(self) -> f64 {
        self.time.as_duration().as_secs_f64()
    }

    /// Local time minus UTC, s: whole minutes.
    pub fn offset_s(self) -> i32 {
        self.offset.seconds()
    }

    /// The time `unix_s` seconds after 1970-01-01T00:00:00Z with the same offset from UTC; held to the range of years.
    pub fn at(self, unix_s: f64) -> Self {
        let [first, last] = [Timestamp::MIN, Timestamp::MAX].map(|end| end.as_second() as f64);
        let held = unix_s.clamp(first, last);
        let time = SignedDuration::try_from_secs_f64(held)
            .ok()
            .and_then(|since| Timestamp::from_duration(since).ok());
        Self {
            time: time.unwrap_or(Timestamp::UNIX_EPOCH),
            ..self
        }
    }

    /// The same time in UTC.
    pub fn utc(self) -> Self {
        Self {
            offset: Offset::UTC,
            ..self
        }
    }

    /// Local `2026:06:21 21:15:00`, as picture files keep it.
    pub fn capture_date(self) -> String {
        let local = self.offset.to_datetime(self.time);
        local.strftime("%Y:%m:%d %H:%M:%S").to_string()
    }

    /// UTC as `20260621T191500Z` (ISO 8601 basic form), for file names.
    pub fn basic_utc(self) -> String {
        let utc = Offset::UTC.to_datetime(self.time);
        utc.strftime("%Y%m%dT%H%M%SZ").to_string()
    }
}

impl fmt::Display for Moment {
    /// RFC 3339 to the second.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const PRINTER: DateTimePrinter = DateTimePrinter::new().precision(Some(0));
        f.pad(&match self.offset == Offset::UTC {
            true => PRINTER.timestamp_to_string(&self.time),
            false => PRINTER.timestamp_with_offset_to_string(&self.time, self.offset),
        })
    }
}

impl FromStr for Moment {
    type Err = MomentError;

    /// Reads RFC 3339. A time without offset is refused: it would not say when.
    fn from_str(text: &str) -> Result<Self, MomentError> {
        let refuse = |reason: String| MomentError {
            text: text.to_owned(),
            reason,
        };
        let pieces = Pieces::parse(text.trim()).map_err(|error| refuse(error.to_string()))?;
        let Some(clock) = pieces.time() else {
            return Err(refuse("it has no time of day".to_owned()));
        };
        let Some(offset) = pieces.to_numeric_offset() else {
            return Err(refuse("it has no offset from UTC".to_owned()));
        };
        if pieces.time_zone_annotation().is_some() {
            return Err(refuse("a time zone's name is not read".to_owned()));
        }
        if offset.seconds() % 60 != 0 {
            return Err(refuse("the offset from UTC has seconds".to_owned()));
        }
        let time = offset
            .to_timestamp(pieces.date().to_datetime(clock))
            .map_err(|error| refuse(error.to_string()))?;
        Ok(Self { time, offset })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Moment {
        text.parse().unwrap()
    }

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
            assert_eq!(read(text).to_string(), text);
        }
        let m = read("2026-06-21T01:15:00+02:00");
        assert_eq!(m.utc().to_string(), "2026-06-20T23:15:00Z");
        assert_eq!(m.capture_date(), "2026:06:21 01:15:00");
        assert_eq!(m.basic_utc(), "20260620T231500Z");
        assert!(Moment::parse(" Now ").unwrap().unix_s() > 1.7e9);
    }

    #[test]
    fn seconds_are_counted_from_1970() {
        for (text, unix_s) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2000-02-29T12:00Z", 951_825_600.0),
            ("1900-01-01 00:00:00z", -2_208_988_800.0),
            ("2013-05-27T12:30:00.25-04:00", 1_369_672_200.25),
            ("2100-02-28T23:59:59Z", 4_107_542_399.0),
            ("2100-03-01T00:00:00Z", 4_107_542_400.0),
        ] {
            assert_eq!(read(text).unix_s(), unix_s);
            assert_eq!(Moment::from_unix_s(unix_s), read(text).utc());
        }
        let later = read("2026-06-21T21:15:00+02:00").at(1_718_971_509.0);
        assert_eq!(later.to_string(), "2024-06-21T14:05:09+02:00");
    }

    #[test]
    fn times_beyond_the_calendar_are_held_at_its_ends() {
        assert_eq!(Moment::from_unix_s(1e300).basic_utc(), "99991230T220000Z");
        assert_eq!(
            Moment::from_unix_s(f64::NEG_INFINITY).basic_utc(),
            "-99990102T015959Z"
        );
        assert_eq!(Moment::from_unix_s(f64::NAN).unix_s(), 0.0);
    }

    #[test]
    fn texts_that_say_no_time_are_refused_with_the_reason() {
        for (text, reason) in [
            ("", "year"),
            ("noon", "year"),
            ("2013-05-27", "time of day"),
            ("2013-05-27T16:30:00", "offset"),
            ("2013-5-27T16:30:00Z", "month"),
            ("2013-05-27T1é:30Z", "hour"),
            ("2013-05-27T16:30:xxZ", "second"),
            ("2013-05-27T16:30:00+99:00", "offset"),
            ("2013-05-27T16:30:00+02:00:30", "offset"),
            ("2013-05-27T16:30:00.Z", "fractional"),
            ("2013-05-27T16:30:00+02:00[Europe/Paris]", "zone"),
            ("2013-02-29T00:00:00Z", "'day' for `2013-02`"),
            ("2013-13-01T00:00:00Z", "'month'"),
            ("2013-01-01T24:00:00Z", "'hour'"),
            ("2013-01-01T00:60:00Z", "'minute'"),
            ("2013-01-01T00:00:61Z", "'second'"),
            ("9999-12-31T23:59:59Z", "range"),
        ] {
            let error = text.parse::<Moment>().unwrap_err();
            assert!(error.reason.contains(reason), "{error}");
            let said = error.to_string();
            assert!(said.contains("2013-05-27T16:30:00Z") && said.contains(text));
        }
    }
}
