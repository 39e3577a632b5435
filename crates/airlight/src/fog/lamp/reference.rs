//! Integrals along a line by brute force, for tests.

use super::passage::Passage;
use super::{Lamp, Murk, Sight};
use crate::fog::line::Line;
use crate::fog::profile::Profile;
use crate::quadrature::{gauss_legendre, integrate_by};
use std::f64::consts::PI;

/// `e = t + r - r_0` without cancellation, where the distance from the point closest to the lamp is `u`.
fn excess(passage: &Passage, t: f64, u: f64) -> f64 {
    let h = passage.nearest_m;
    let ahead = |u: f64| match u < 0.0 {
        true => h * h / (h.hypot(u) - u),
        false => h.hypot(u) + u,
    };
    t * (ahead(passage.start_m) + ahead(u)) / (passage.distance_m(0.0) + h.hypot(u))
}

/// The integral along a passage of `f(t, u)`: Gauss's rule of 24 points in stretches that shrink by a quarter towards the
/// start, the end, the point closest to the lamp and the places `more`. It is counted from the point closest to the lamp
/// where that is on the way, from the start elsewhere: what is small is not lost beside what is large.
pub fn along(passage: &Passage, more: &[f64], f: impl Fn(f64, f64) -> f64) -> f64 {
    let length = passage.length_m.min(1e16);
    let passed = -passage.start_m;
    let origin = match (0.0..=length).contains(&passed) {
        true => passed,
        false => 0.0,
    };
    let (first, last) = (-origin, length - origin);
    let rule = gauss_legendre(24);
    let mut breaks = Vec::new();
    let more = more.iter().map(|t| t - origin);
    for centre in [first, last, passed - origin].into_iter().chain(more) {
        breaks.push(centre);
        for k in 0..200 {
            let step = length * 0.75f64.powi(k);
            breaks.extend([centre - step, centre + step]);
        }
    }
    breaks.sort_by(f64::total_cmp);
    // Stretches shorter than rounding are none.
    breaks.dedup_by(|b, a| (*b - *a).abs() <= 1e-14 * b.abs());
    integrate_by(&rule, first, last, &breaks, |s| {
        f(s + origin, s + (origin - passed))
    })
}

/// What [`super::airlight_isotropic`] is, less the dimming over `r_0`.
pub fn isotropic_beyond(passage: &Passage, extinction: f64) -> f64 {
    // An endless line is cut after 1e16 m; what is beyond counts only in clear air.
    let rest = match passage.length_m.is_infinite() && extinction == 0.0 {
        true => 1e-16 / (4.0 * PI),
        false => 0.0,
    };
    rest + along(passage, &[], |t, u| {
        let r2 = u * u + passage.nearest_m * passage.nearest_m;
        (-extinction * excess(passage, t, u)).exp() / (4.0 * PI * r2)
    })
}

/// Every passage that tests try.
pub fn passages(nearest: &[f64]) -> impl Iterator<Item = Passage> + '_ {
    const START: [f64; 13] = [
        -1e7, -1e4, -37.0, -1.0, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 1.0, 37.0, 1e4, 1e7,
    ];
    const LENGTH: [f64; 8] = [1e-6, 1e-3, 0.5, 20.0, 74.0, 2e4, 1e7, f64::INFINITY];
    nearest.iter().flat_map(|&nearest_m| {
        START.iter().flat_map(move |&start_m| {
            LENGTH.iter().map(move |&length_m| Passage {
                nearest_m,
                start_m,
                length_m,
            })
        })
    })
}

/// A lamp's light in the first lane of a line of sight: the defining integral, less the clamp where the line passes closer
/// than the lamp's radius.
pub fn path_radiance<const N: usize>(lamp: &Lamp<N>, murk: &Murk<N>, sight: &Sight) -> f64 {
    let Sight { eye, direction, .. } = *sight;
    let length = match lamp {
        Lamp::Sphere(ball) => ball
            .hit(eye, direction)
            .map_or(sight.length_m, |hit| hit.min(sight.length_m)),
        _ => sight.length_m,
    };
    let true_nearest = (lamp.position() - eye).cross(direction).length();
    let nearest = match lamp {
        Lamp::Sphere(_) => 0.0,
        _ => lamp.radius_m(),
    };
    let passage = Passage::new(eye, direction, length, lamp.position(), nearest);
    let matter = murk.matter;
    let extinction = f64::from(matter.extinction_per_m[0]);
    let line = Line::new(eye.y, direction.y, length, murk.ground_radius_m);
    let edges = edges(lamp, murk, sight, &line);
    let integral = along(&passage, &edges, |t, u| {
        let r = (passage.nearest_m * passage.nearest_m + u * u).sqrt();
        let point = eye + t * direction;
        let towards = (lamp.position() - point) / r;
        let (leg, part) = match lamp {
            Lamp::Point(_) => (r, 1.0),
            Lamp::Spot(spot) => {
                let closest = true_nearest.max(1e-300) / passage.nearest_m;
                let off = (point - lamp.position()) / r;
                assert!(closest > 0.99, "spots are tried off the line");
                (r, spot.falloff(off))
            }
            Lamp::Sphere(ball) => {
                let x = (ball.radius_m / r).powi(2).min(1.0);
                (r - ball.radius_m, 2.0 / (1.0 + (1.0 - x).sqrt()))
            }
        };
        let height = line.height_at(t);
        let bend = 0.5 / murk.ground_radius_m;
        let offset = t * (towards.x * direction.x + towards.z * direction.z);
        let to_lamp = Line {
            height_m: height,
            climb: towards.y + 2.0 * bend * offset,
            bend_per_m: bend * (1.0 - towards.y * towards.y).max(0.0),
            length_m: leg,
        };
        let way = |profile: &Profile| {
            profile.column(&Line {
                length_m: t,
                ..line
            }) + match *profile {
                Profile::Uniform => leg,
                _ => profile.column(&to_lamp),
            }
        };
        let others = murk.others.iter();
        let others = others.map(|o| f64::from(o.matter.extinction_per_m[0]) * way(&o.profile));
        let depth = extinction * way(murk.profile) + others.sum::<f64>();
        let phase = matter.phase.evaluate(-u / r, murk.wavelengths_nm[0]);
        murk.profile.density(height) * part * phase * (-depth).exp() / (r * r)
    });
    let scattering = f64::from(matter.scattering_per_m()[0]);
    scattering * f64::from(lamp.intensity()[0]) * integral
}

/// Where density or the lamp's intensity has a kink, or fog is densest.
fn edges<const N: usize>(lamp: &Lamp<N>, murk: &Murk<N>, sight: &Sight, line: &Line) -> Vec<f64> {
    let mut edges = Vec::new();
    let others = murk.others.iter().map(|other| &other.profile);
    for profile in others.chain([murk.profile]) {
        match *profile {
            Profile::Clamped { base_height_m, .. } => edges.push(line.below(base_height_m)),
            Profile::Slab { top_height_m } => edges.push(line.below(top_height_m)),
            Profile::Exponential { .. } => edges.push((-0.5 * line.climb / line.bend_per_m, 0.0)),
            Profile::Uniform => {}
        }
    }
    if let Lamp::Spot(spot) = lamp {
        let passage = Passage::new(
            sight.eye,
            sight.direction,
            sight.length_m,
            spot.position,
            spot.radius_m,
        );
        let beam = super::spot::Beam::new(spot, &passage, sight.eye, sight.direction);
        edges.extend(beam.lit(&passage));
    }
    edges
        .into_iter()
        .flat_map(|(a, b)| [a, b])
        .filter(|t| t.is_finite() && *t > 0.0 && *t < sight.length_m)
        .collect()
}
