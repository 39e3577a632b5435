//! Evenly spaced times.

use airlight_image::ImageError;

/// Evenly spaced times, from the first to the last inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SequencePlan {
    start_s: i64,
    every_s: i64,
    count: u64,
}

/// One frame of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameStep {
    /// Number of the frame, from 1.
    pub number: u64,
    /// Time, seconds since 1970-01-01T00:00:00Z.
    pub time_s: i64,
}

impl SequencePlan {
    /// Largest number of frames of a plan.
    pub const MOST_FRAMES: u64 = 1_000_000;

    /// Times `start_s`, `start_s + every_s` and so on up to `until_s` (seconds since 1970-01-01T00:00:00Z).
    ///
    /// # Errors
    /// [`ImageError::Setting`] if `every_s` is not positive, `until_s` is before `start_s`, or there would be more than a
    /// million frames.
    pub fn new(start_s: i64, until_s: i64, every_s: i64) -> Result<Self, ImageError> {
        let refuse = |what, got: String, right| Err(ImageError::Setting { what, got, right });
        if every_s <= 0 {
            return refuse(
                "the step of a sequence",
                format!("{every_s} s"),
                "above 0 s",
            );
        }
        if until_s < start_s {
            return refuse(
                "the end of a sequence",
                format!("{until_s} s with a start at {start_s} s"),
                "at or after its start",
            );
        }
        let count = until_s.abs_diff(start_s) / every_s.unsigned_abs();
        if count >= Self::MOST_FRAMES {
            return refuse(
                "the number of frames",
                format!("{}", u128::from(count) + 1),
                "at most 1000000 (try a longer step or an earlier end)",
            );
        }
        Ok(Self {
            start_s,
            every_s,
            count: count + 1,
        })
    }

    /// Number of frames.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The frames in order.
    pub fn frames(&self) -> impl Iterator<Item = FrameStep> + use<> {
        let Self {
            start_s, every_s, ..
        } = *self;
        (0..self.count).map(move |index| FrameStep {
            number: index + 1,
            // The result lies between start and end, even if an intermediate value overflows.
            time_s: start_s.wrapping_add(every_s.wrapping_mul(index as i64)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_have_the_expected_frames() {
        for (start, until, every, count) in
            [(0, 0, 5, 1), (0, 9, 5, 2), (0, 10, 5, 3), (-7, 7, 7, 3)]
        {
            let plan = SequencePlan::new(start, until, every).unwrap();
            let times: Vec<i64> = plan.frames().map(|f| f.time_s).collect();
            assert_eq!(plan.count(), count);
            assert_eq!(times.len() as u64, count);
            assert_eq!(times[0], start);
            assert!(times.iter().all(|&t| t <= until));
        }
        for (start, until, every, words) in [
            (0, 10, 0, "above 0"),
            (10, 0, 1, "after its start"),
            (0, 10_000_000, 1, "10000001"),
            (i64::MIN, i64::MAX, 1, "at most"),
        ] {
            let error = SequencePlan::new(start, until, every)
                .unwrap_err()
                .to_string();
            assert!(error.contains(words), "{error}");
        }
        let wide = SequencePlan::new(i64::MIN, i64::MAX, i64::MAX).unwrap();
        assert_eq!(wide.frames().last().unwrap().time_s, i64::MAX - 1);
    }
}
