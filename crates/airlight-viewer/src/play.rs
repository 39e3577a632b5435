//! [`Play`]: time that passes in the picture.

use airlight::sun::Moment;

/// Speeds, in seconds of the scene per second, and their names.
pub const SPEEDS: [(f64, &str); 5] = [
    (1.0, "real time"),
    (60.0, "1 minute a second"),
    (600.0, "10 minutes a second"),
    (3600.0, "1 hour a second"),
    (86_400.0, "1 day a second"),
];

/// Whether, and how fast, time passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Play {
    /// Whether it passes.
    pub is_on: bool,
    /// Seconds of the scene per second.
    pub speed: f64,
    /// Part of a second that has passed since the scene's time, which is in whole seconds.
    rest_s: f64,
}

impl Default for Play {
    fn default() -> Self {
        Self {
            is_on: false,
            speed: 600.0,
            rest_s: 0.0,
        }
    }
}

impl Play {
    /// Moves a scene's time on by an elapsed time, seconds. A time that cannot be read stays.
    pub fn advance(&mut self, time: &mut Option<String>, elapsed_s: f64) {
        let Ok(moment) = Moment::parse(time.as_deref().unwrap_or("now")) else {
            return;
        };
        let now_s = moment.unix_s() + self.rest_s + self.speed * elapsed_s;
        self.rest_s = now_s - now_s.floor();
        *time = Some(moment.at(now_s.floor()).to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_passes_at_its_speed() {
        let mut time = Some("2026-06-21T21:15:00+02:00".to_owned());
        let mut play = Play {
            speed: 60.0,
            ..Play::default()
        };
        // Frames that are shorter than a second of the scene.
        for _ in 0..1000 {
            play.advance(&mut time, 0.01);
        }
        let moment = Moment::parse(time.as_deref().unwrap()).unwrap();
        let right = Moment::parse("2026-06-21T21:25:00+02:00").unwrap();
        assert!((moment.unix_s() - right.unix_s()).abs() <= 1.0, "{moment}");
        assert_eq!(moment.offset_s(), 7200);
        let mut wrong = Some("soon".to_owned());
        play.advance(&mut wrong, 1.0);
        assert_eq!(wrong.as_deref(), Some("soon"));
    }
}
