//! Fog of published drops, whose phase functions have diffraction peaks of a degree, bows and glories: the fog's solution
//! beside paths of light followed one by one with the whole phase function.

use crate::common::{GREEN_NM as NM, green_fog, green_path};
use airlight::atmosphere::Constituent;
use airlight::axes::direction;
use airlight::fog::{DensityProfile, Fog, FogScattering, Ground};
use airlight::optics::mie::droplets::Drops;
use airlight::optics::{PhaseFunction, TabulatedPhase};
use glam::DVec3;
use rayon::prelude::*;

const TOP_M: f64 = 100.0;

/// Even numbers in `[0, 1)` (Steele, Lea & Flood, OOPSLA 2014: SplitMix).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// What one path of light is followed through: a slab with heights in optical depths above the ground.
struct Slab<'a> {
    phase: &'a TabulatedPhase,
    tau: f64,
    sun: DVec3,
}

impl Slab<'_> {
    fn p(&self, a: DVec3, b: DVec3) -> f64 {
        self.phase.evaluate(a.dot(b), NM)
    }

    /// A direction that light from `around` is scattered to.
    fn scattered(&self, around: DVec3, random: &mut Random) -> DVec3 {
        let cosine = self.phase.sample(random.next(), NM);
        let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
        let (across, up) = around.any_orthonormal_pair();
        let (sin, cos) = (std::f64::consts::TAU * random.next()).sin_cos();
        (around * cosine + (across * cos + up * sin) * sine).normalize()
    }

    /// The height at which a line from a height meets a drop; none where it leaves.
    fn next(&self, height: f64, towards: DVec3, random: &mut Random) -> Option<f64> {
        let next = height - (1.0 - random.next()).ln() * towards.y;
        (0.0..self.tau).contains(&next).then_some(next)
    }

    /// Radiance of light scattered twice or more along one path traced backwards from the eye. Where its last direction but
    /// one goes is drawn from both the drop's own scattering and that of the drop which sunlight meets, so that no peak is
    /// met by chance (Veach & Guibas 1995, the balance heuristic).
    fn path(&self, view: DVec3, random: &mut Random) -> f64 {
        let start = if view.y > 0.0 { 0.0 } else { self.tau };
        let (mut at, mut towards, mut radiance) = (self.next(start, view, random), view, 0.0);
        while let Some(height) = at {
            let around = match random.next() < 0.5 {
                true => towards,
                false => self.sun,
            };
            let last = self.scattered(around, random);
            if let Some(height) = self.next(height, last, random) {
                let (here, there) = (self.p(towards, last), self.p(last, self.sun));
                let dimmed = (-(self.tau - height) / self.sun.y).exp();
                radiance += 2.0 * here * there / (here + there) * dimmed;
            }
            towards = self.scattered(towards, random);
            at = self.next(height, towards, random);
        }
        radiance
    }
}

/// Radiance of light scattered twice or more into a line of sight: its mean over paths and its standard error.
fn scattered_again(slab: &Slab<'_>, view: DVec3, paths: u64) -> (f64, f64) {
    const CHUNK: u64 = 1000;
    let chunk = |chunk: u64| {
        let mut random = Random(chunk << 32);
        (0..CHUNK).fold((0.0, 0.0), |(sum, squares), _| {
            let radiance = slab.path(view, &mut random);
            (sum + radiance, squares + radiance * radiance)
        })
    };
    let parts: Vec<(f64, f64)> = (0..paths / CHUNK).into_par_iter().map(chunk).collect();
    let (sum, squares) = parts.iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    let count = paths as f64;
    let mean = sum / count;
    (mean, ((squares / count - mean * mean) / count).sqrt())
}

/// A line of sight: azimuth and elevation, degrees. The sun stands at 180, 40.
type ViewRay = (f64, f64);

/// From the ground up, 10 to 80 degrees from the sun.
const UP: [ViewRay; 4] = [(180.0, 30.0), (180.0, 65.0), (90.0, 50.0), (0.0, 60.0)];
/// From the top down: to the point opposite to the sun and in its glory.
const GLORY: [ViewRay; 2] = [(0.0, -40.0), (0.0, -43.0)];
/// In the bow, and beside it.
const DOWN: [ViewRay; 3] = [(0.0, -79.0), (60.0, -60.0), (180.0, -50.0)];

/// Our error, and the standard error of the paths that it is measured against, as parts of the radiance.
fn errors(drops: Drops, tau: f64, sights: &[ViewRay], paths: u64) -> Vec<[f64; 2]> {
    let slab = DensityProfile::slab(TOP_M);
    let layer = Constituent::fog(tau / TOP_M, drops.into(), slab, &[NM]).unwrap();
    let PhaseFunction::Tabulated(phase) = layer.phase.clone() else {
        panic!("{drops:?} is no table")
    };
    let sun = direction(180.0, 40.0);
    let fog = |scattering| green_fog(layer.clone(), Ground::FLAT, Some(sun), 0.0, scattering);
    let many = fog(FogScattering::Multiple);
    let once = fog(FogScattering::Single);
    let slab = Slab {
        phase: &phase,
        tau,
        sun,
    };
    let error = |&(azimuth, elevation): &ViewRay| {
        let view = direction(azimuth, elevation);
        let (height, length) = match view.y > 0.0 {
            true => (0.0, f64::INFINITY),
            false => (TOP_M, TOP_M / -view.y),
        };
        let seen = |fog: &Fog| green_path(fog, height, view, length)[1];
        let (again, error) = scattered_again(&slab, view, paths);
        let want = seen(&once) + again;
        let [ours, loose] = [seen(&many) / want - 1.0, error / want];
        println!(
            "{drops:?}, depth {tau}, {:.0} degrees from the sun: {:+.1} +- {:.1} %",
            view.angle_between(sun).to_degrees(),
            100.0 * ours,
            100.0 * loose
        );
        [ours, loose]
    };
    sights.iter().map(error).collect()
}

/// The field inside keeps 8 moments; what it leaves out of the peak is put back for light scattered once. A glory, as narrow
/// as the peak, is then not smeared by it as it should be: up to 17 % too bright; all else is right to 8 %.
fn check(drops: Drops, tau: f64, paths: u64) {
    for (sights, limit) in [(&UP[..], 0.08), (&DOWN[..], 0.08), (&GLORY[..], 0.17)] {
        for [ours, loose] in errors(drops, tau, sights, paths) {
            assert!(ours.abs() < limit + 3.0 * loose, "{ours} {loose}");
        }
    }
}

#[test]
fn drops_by_theory_scatter_as_paths_say() {
    check(Drops::CloudC1, 1.0, 10_000);
}

#[test]
#[ignore = "takes minutes: prints the errors that the book states"]
fn errors_of_fog_of_drops_by_theory() {
    for (drops, tau) in [
        (Drops::CloudC1, 1.0),
        (Drops::CloudC1, 6.0),
        (Drops::ModerateAdvectionFog, 1.0),
        (Drops::ModerateAdvectionFog, 6.0),
    ] {
        check(drops, tau, 200_000);
    }
}
