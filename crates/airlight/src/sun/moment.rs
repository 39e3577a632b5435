//! Times with their offset from UTC.

use jiff::fmt::temporal::{DateTimePrinter, Pieces, PiecesOffset};
use jiff::tz::{Offset, OffsetConflict, TimeZone};
use jiff::{SignedDuration, Timestamp, civil::DateTime};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// A time with its offset from UTC, in the years -9999 to 9999 of the Gregorian calendar, also before 1582. Leap seconds do not
/// count: a second of 60 is read as 59.
///
/// Writes RFC 3339, and reads it and the names of time zones of the IANA, in brackets as in RFC 9557 or after a space. The data of the
/// zones is compiled in, so that a text means the same everywhere.
///
/// ```
/// use airlight::sun::Moment;
///
/// let evening: Moment = "2026-06-21T21:15:00+02:00".parse()?;
/// assert_eq!(evening.to_string(), "2026-06-21T21:15:00+02:00");
/// assert_eq!(evening.utc().to_string(), "2026-06-21T19:15:00Z");
/// assert_eq!("2026-06-21T21:15[Europe/Paris]".parse(), Ok(evening));
/// assert_eq!("2026-06-21 21:15 Europe/Paris".parse(), Ok(evening));
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
    "expected a time such as 2013-05-27T16:30:00Z, 2013-05-27T12:30:00-04:00 or 2013-05-27T12:30[America/New_York], got \"{text}\": {reason}"
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

    /// Reads RFC 3339 and names of time zones. A time with neither an offset nor a zone is refused: it would not say when; so is one
    /// that a zone's clocks skip, or show twice without an offset.
    fn from_str(text: &str) -> Result<Self, MomentError> {
        let refuse = |reason: String| MomentError {
            text: text.to_owned(),
            reason,
        };
        let written = zone_in_brackets(text.trim());
        let pieces =
            Pieces::parse(written.as_bytes()).map_err(|error| refuse(error.to_string()))?;
        let Some(clock) = pieces.time() else {
            return Err(refuse("it has no time of day".to_owned()));
        };
        let local = pieces.date().to_datetime(clock);
        let zone = pieces
            .to_time_zone()
            .map_err(|error| refuse(error.to_string()))?;
        let moment = match (pieces.offset(), zone) {
            (None, None) => return Err(refuse("it has no offset from UTC and no zone".to_owned())),
            (Some(offset), None) => Self::with_offset(local, offset),
            (offset, Some(zone)) => Self::in_zone(local, offset, zone),
        }
        .map_err(|error| refuse(error.to_string()))?;
        match moment.offset.seconds() % 60 {
            0 => Ok(moment),
            _ => Err(refuse("the offset from UTC has seconds".to_owned())),
        }
    }
}

impl Moment {
    fn with_offset(local: DateTime, offset: PiecesOffset) -> Result<Self, jiff::Error> {
        let offset = offset.to_numeric_offset();
        let time = offset.to_timestamp(local)?;
        Ok(Self { time, offset })
    }

    /// A time of a zone's clocks; with an offset the zone must agree. `Z` marks UTC, shown on the zone's clocks.
    fn in_zone(
        local: DateTime,
        offset: Option<PiecesOffset>,
        zone: TimeZone,
    ) -> Result<Self, jiff::Error> {
        let zoned = match offset {
            Some(PiecesOffset::Zulu) => Offset::UTC.to_timestamp(local)?.to_zoned(zone),
            Some(offset) => OffsetConflict::Reject
                .resolve(local, offset.to_numeric_offset(), zone)?
                .unambiguous()?,
            None => zone.into_ambiguous_zoned(local).unambiguous()?,
        };
        Ok(Self {
            time: zoned.timestamp(),
            offset: zoned.offset(),
        })
    }
}

/// The text with a zone's name after the last space in brackets.
fn zone_in_brackets(text: &str) -> Cow<'_, str> {
    match text.rsplit_once(' ') {
        Some((time, zone)) if zone.starts_with(|c: char| c.is_ascii_alphabetic()) => {
            Cow::Owned(format!("{}[{zone}]", time.trim_end()))
        }
        _ => Cow::Borrowed(text),
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
    fn zones_have_summer_and_winter_time() {
        for (text, want) in [
            (
                "2026-06-21T21:15[Europe/Paris]",
                "2026-06-21T21:15:00+02:00",
            ),
            ("2026-12-21 12:00 Europe/Paris", "2026-12-21T12:00:00+01:00"),
            ("2026-06-21T12:00:00Asia/Kolkata", "zone"),
            (
                "2026-06-21T12:00:00 asia/kolkata",
                "2026-06-21T12:00:00+05:30",
            ),
            (
                "2026-06-21T21:15:00+02:00[Europe/Paris]",
                "2026-06-21T21:15:00+02:00",
            ),
            (
                "2026-06-21T19:15:00Z[Europe/Paris]",
                "2026-06-21T21:15:00+02:00",
            ),
            // The clocks show this time twice.
            (
                "2026-10-25T02:30:00+01:00[Europe/Paris]",
                "2026-10-25T02:30:00+01:00",
            ),
            ("2026-10-25T02:30:00[Europe/Paris]", "zone"),
            // They skip this one.
            ("2026-03-29T02:30:00[Europe/Paris]", "zone"),
            ("2026-06-21T21:15:00+03:00[Europe/Paris]", "zone"),
            ("2026-06-21T21:15[Europe/Pari]", "zone"),
        ] {
            match text.parse::<Moment>() {
                Ok(moment) => assert_eq!(moment.to_string(), want),
                Err(error) => assert_eq!(want, "zone", "{error}"),
            }
        }
        assert_eq!(
            read("2026-06-21T21:15:00+0200"),
            read("2026-06-21T21:15:00+02:00")
        );
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
