//! Associated Legendre functions, normalised so that the addition theorem has no factors:
//! `P_l(cos angle) = sum over m of (2 - delta_m0) Y_lm(mu) Y_lm(mu') cos(m azimuth)`.

/// Number of polar angles in both hemispheres together, and of Legendre moments.
pub const STREAMS: usize = 8;

/// Number of pairs `l < STREAMS`, `m <= l`.
pub const COUNT: usize = STREAMS * (STREAMS + 1) / 2;

/// Where the pair `(l, m)` stands: all `l` of `m = 0` first.
#[inline(always)]
pub const fn index(l: usize, m: usize) -> usize {
    m * STREAMS - m * (m + 1) / 2 + l
}

/// `sqrt((l - m)! / (l + m)!) P_l^m(mu)` for all pairs, without the sign `(-1)^m`.
#[inline]
pub fn evaluate(mu: f64) -> [f64; COUNT] {
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    let mut values = [0.0; COUNT];
    let mut diagonal = 1.0;
    for m in 0..STREAMS {
        if m > 0 {
            let m = m as f64;
            diagonal *= sine * ((2.0 * m - 1.0) / (2.0 * m)).sqrt();
        }
        let (mut before, mut now) = (0.0, diagonal);
        values[index(m, m)] = now;
        for l in m + 1..STREAMS {
            let (x, y) = (l as f64, m as f64);
            let back = ((x - 1.0) * (x - 1.0) - y * y).max(0.0).sqrt();
            let next = ((2.0 * x - 1.0) * mu * now - back * before) / (x * x - y * y).sqrt();
            (before, now) = (now, next);
            values[index(l, m)] = now;
        }
    }
    values
}

/// [`evaluate`] times `cos(m azimuth)`: what each moment adds in a direction.
#[inline]
pub fn in_direction(mu: f64, cos_azimuth: f64) -> [f32; COUNT] {
    let polar = evaluate(mu);
    let mut values = [0.0f32; COUNT];
    let (mut before, mut now) = (cos_azimuth, 1.0);
    for m in 0..STREAMS {
        for l in m..STREAMS {
            values[index(l, m)] = (polar[index(l, m)] * now) as f32;
        }
        (before, now) = (now, 2.0 * cos_azimuth * now - before);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pairs_are_numbered_without_gaps() {
        let mut next = 0;
        for m in 0..STREAMS {
            for l in m..STREAMS {
                assert_eq!(index(l, m), next);
                next += 1;
            }
        }
        assert_eq!(next, COUNT);
    }

    #[test]
    fn the_addition_theorem_holds() {
        let legendre = |l: usize, x: f64| {
            let (mut before, mut now) = (0.0, 1.0);
            for k in 1..=l {
                let k = k as f64;
                (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
            }
            now
        };
        for (a, b, azimuth) in [
            (0.3f64, -0.8f64, 0.5f64),
            (1.0, 0.2, 2.0),
            (-0.95, -0.4, 3.0),
        ] {
            let sines = ((1.0 - a * a) * (1.0 - b * b)).sqrt();
            let cos_angle = a * b + sines * azimuth.cos();
            let (from, to) = (evaluate(b), in_direction(a, azimuth.cos()));
            for l in 0..STREAMS {
                let sum: f64 = (0..=l)
                    .map(|m| {
                        let twice = if m == 0 { 1.0 } else { 2.0 };
                        twice * from[index(l, m)] * f64::from(to[index(l, m)])
                    })
                    .sum();
                assert!((sum - legendre(l, cos_angle)).abs() < 1e-6, "{l}");
            }
        }
    }
}
