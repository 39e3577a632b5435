//! Adaptive selection of the angles of a tabulated phase function.

use crate::control::Cancelled;
use crate::optics::tabulated::between_samples;
use std::f64::consts::PI;

/// Largest number of times an interval is halved.
const MAX_DEPTH: usize = 8;
/// Number of angles above which no more intervals are halved.
const MAX_ANGLES: usize = 800;

/// Initial angles (radians, from 0 to pi): uniform steps, and geometric ones towards 0 and pi, where the features of spheres
/// with size parameter `x` have a width of `1 / x`.
fn first(x: f64) -> Vec<f64> {
    const MAX_STEP: f64 = PI / 45.0;
    const RATIO: f64 = 1.5;
    let mut near = vec![0.0];
    let mut angle = (0.5 / x).min(MAX_STEP);
    while angle * (RATIO - 1.0) < MAX_STEP {
        near.push(angle);
        angle *= RATIO;
    }
    let start = near[near.len() - 1];
    let count = ((PI - 2.0 * start) / MAX_STEP).ceil().max(1.0);
    let even = (1..count as usize).map(|i| start + (PI - 2.0 * start) * i as f64 / count);
    let far: Vec<f64> = near.iter().rev().map(|a| PI - a).collect();
    near.into_iter().chain(even).chain(far).collect()
}

/// Angles at which the logarithm of a function, interpolated as [`TabulatedPhase`](crate::optics::TabulatedPhase) does, is
/// accurate to `tolerance` in the middle of each interval; the midpoints are then added too. If that takes more than
/// [`MAX_ANGLES`], the tolerance is not reached.
///
/// Starts from the angles `known`, for instance of another wavelength, if not empty.
pub(super) fn adapt(
    x: f64,
    known: &[f64],
    tolerance: f64,
    evaluate: impl Fn(&[f64]) -> Result<Vec<f64>, Cancelled>,
) -> Result<Vec<f64>, Cancelled> {
    let mut angles = match known {
        [] => first(x),
        _ => known.to_vec(),
    };
    let mut logs: Vec<f64> = evaluate(&angles)?.iter().map(|p| p.ln()).collect();
    let mut open = vec![true; angles.len() - 1];
    for _ in 0..MAX_DEPTH {
        let middles: Vec<f64> = (0..open.len())
            .filter(|&i| open[i])
            .map(|i| 0.5 * (angles[i] + angles[i + 1]))
            .collect();
        if middles.is_empty() || angles.len() > MAX_ANGLES {
            break;
        }
        let guesses = between_samples(&angles, &logs, &middles);
        let mut values = evaluate(&middles)?.into_iter().map(f64::ln);
        let mut guesses = guesses.into_iter();
        let (mut next, mut next_logs, mut next_open) = (vec![], vec![], vec![]);
        for i in 0..open.len() {
            next.push(angles[i]);
            next_logs.push(logs[i]);
            let halved = open[i].then(|| values.next().zip(guesses.next())).flatten();
            match halved {
                Some((value, guess)) => {
                    let inaccurate = (value - guess).abs() > tolerance;
                    next.push(0.5 * (angles[i] + angles[i + 1]));
                    next_logs.push(value);
                    next_open.extend([inaccurate, inaccurate]);
                }
                None => next_open.push(false),
            }
        }
        next.push(PI);
        next_logs.push(logs[logs.len() - 1]);
        (angles, logs, open) = (next, next_logs, next_open);
    }
    Ok(angles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adaptation_resolves_a_narrow_peak_and_a_ring() {
        let f = |a: f64| 1e6 * (-a * a * 4e6).exp() + 1.0 + (-((a - 2.45) / 0.01).powi(2)).exp();
        let evaluate = |angles: &[f64]| Ok(angles.iter().map(|&a| f(a)).collect::<Vec<_>>());
        let angles = adapt(1e3, &[], 0.01, evaluate).unwrap();
        assert!(angles.len() < 400, "{}", angles.len());
        let logs: Vec<f64> = angles.iter().map(|&a| f(a).ln()).collect();
        let probes: Vec<f64> = (1..30_000)
            .map(|i| PI * (f64::from(i) / 3e4).powi(2))
            .collect();
        let guesses = between_samples(&angles, &logs, &probes);
        for (a, guess) in probes.iter().zip(guesses) {
            assert!((guess - f(*a).ln()).abs() < 0.01, "{a}: {guess}");
        }
    }

    #[test]
    fn angles_increase_from_0_to_pi() {
        for x in [1e-3, 0.3, 1.0, 10.0, 1e5] {
            let angles = first(x);
            assert_eq!((angles[0], angles[angles.len() - 1]), (0.0, PI));
            assert!(angles.windows(2).all(|a| a[0] < a[1]), "{x}: {angles:?}");
        }
    }
}
