//! The fog note's split sum for a lamp in uniform fog: the opacity of the line times the mean of the source on it.

use super::airlight_without_extinction;
use super::geometry::LightRayGeometry;
use crate::fog::lanes::Lanes;
use std::f64::consts::PI;

/// How far from the point closest to the lamp the light of an endless line is looked for, in `asinh(u / h)`: beyond there is
/// a part of 1e-16 of it.
const REACH: f64 = 37.0;
/// A panel of the same has Gauss-Legendre nodes.
const PANEL: f64 = 2.0;

/// `(1 - T) (1 / d) int J dt` with the lamp's source `J`, whose light is dimmed on its way to the fog, in 1/m: times the
/// lamp's radiant intensity and the scattering coefficient that is the path radiance ([`crate::fog::approximation::split_sum`]).
///
/// With `u = h sinh s` the integral is `1 / (4 pi h) int e^-(sigma h cosh s) / cosh s ds`, by Gauss's rule: relative error
/// below 1e-6 where the lamp is dimmed by no more than an optical depth of 10. Against [`super::airlight_isotropic`] the split
/// sum is within 5 % up to an optical depth of 1 of the line for a lamp halfway along it; for an endless line it is 0, as the
/// mean of the source is.
pub fn airlight_split_sum(geometry: &LightRayGeometry, extinction_per_m: f64) -> f64 {
    if extinction_per_m == 0.0 {
        return airlight_without_extinction(geometry);
    }
    let h = geometry.nearest_m;
    let place = |u: f64| (u / h).asinh().clamp(-REACH, REACH);
    let (first, last) = (
        place(geometry.start_m),
        place(geometry.start_m + geometry.length_m),
    );
    let mean_transmittance = (extinction_per_m * geometry.length_m).mean_transmittance();
    let panels = ((last - first) / PANEL).ceil().max(1.0);
    let half = 0.5 * (last - first) / panels;
    let depth = extinction_per_m * h;
    let at = |s: f64| (-depth * s.cosh()).exp() / s.cosh();
    let sum: f64 = (0..panels as u32)
        .map(|k| {
            let middle = first + half * (2.0 * f64::from(k) + 1.0);
            RULE.iter()
                .map(|&(p, w)| w * (at(middle + half * p) + at(middle - half * p)))
                .sum::<f64>()
        })
        .sum();
    mean_transmittance * half * sum / (4.0 * PI * h)
}

/// Gauss-Legendre with 12 points: places and weights on one side.
const RULE: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_4, 0.203_167_426_723_065_92),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_23),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_43),
    (0.981_560_634_246_719_3, 0.047_175_336_386_511_83),
];

#[cfg(test)]
mod tests {
    use super::super::{airlight_isotropic, airlight_without_extinction};
    use super::*;
    use crate::fog::approximation;
    use crate::math::quadrature::GaussRule;
    use crate::spectrum::Spectrum;

    fn geometry(nearest_m: f64, start_m: f64, length_m: f64) -> LightRayGeometry {
        LightRayGeometry {
            nearest_m,
            start_m,
            length_m,
        }
    }

    #[test]
    fn it_is_the_mean_of_the_source_by_quadrature() {
        for (h, start, length) in [
            (1.0, -5.0, 20.0),
            (0.01, -8.0, 9.0),
            (3.0, 4.0, 30.0),
            (0.5, -40.0, 30.0),
            (2.0, -1e-3, 1e-2),
        ] {
            for sigma in [0.0, 1e-3, 0.1, 0.27, 1.0] {
                if sigma * h > 10.0 || sigma * f64::hypot(h, start) > 10.0 {
                    continue;
                }
                let geometry = geometry(h, start, length);
                // Even in the angle under which the lamp sees the line.
                let (from, to) = ((start / h).atan(), ((start + length) / h).atan());
                let mean = GaussRule::new(3000)
                    .integrate(from, to, |angle| (-sigma * h / angle.cos()).exp())
                    / (4.0 * PI * h * length);
                let opacity = (sigma * length).mean_transmittance() * length;
                let got = airlight_split_sum(&geometry, sigma);
                assert!(
                    (got / (opacity * mean) - 1.0).abs() < 1e-6,
                    "{geometry:?} {sigma}: {got} {}",
                    opacity * mean
                );
                let source = Spectrum([(mean / sigma) as f32]);
                let general = approximation::split_sum(Spectrum([(sigma * length) as f32]), source);
                if sigma > 0.0 {
                    assert!((f64::from(general.path_radiance[0]) / got - 1.0).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn it_is_good_in_thin_fog_and_bad_in_thick() {
        // The book's table: a lamp halfway along the line, h lengths of it aside; percent.
        for (tau, h, percent) in [
            (0.1, 0.1, 0.0),
            (0.5, 0.1, 0.7),
            (1.0, 0.01, 4.1),
            (1.0, 0.1, 3.0),
            (1.0, 0.5, 0.9),
            (3.0, 0.1, 31.0),
            (3.0, 0.5, 11.0),
        ] {
            let geometry = geometry(h, -0.5, 1.0);
            let error = 100.0
                * (airlight_split_sum(&geometry, tau) / airlight_isotropic(&geometry, tau) - 1.0);
            let rounding = if percent < 10.0 { 0.06 } else { 0.6 };
            assert!((error - percent).abs() < rounding, "{tau} {h}: {error}");
        }
    }

    #[test]
    fn its_ends_are_what_they_must_be() {
        let line = geometry(1.0, -5.0, 20.0);
        let thin = airlight_split_sum(&line, 0.0) / airlight_without_extinction(&line);
        assert!((thin - 1.0).abs() < 1e-9);
        let endless = geometry(1.0, -5.0, f64::INFINITY);
        assert_eq!(airlight_split_sum(&endless, 0.1), 0.0);
        assert_eq!(airlight_split_sum(&geometry(1.0, -5.0, 0.0), 0.1), 0.0);
        assert_eq!(airlight_split_sum(&line, 1e6), 0.0);
    }
}
