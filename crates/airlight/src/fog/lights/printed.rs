//! The fog note's light of a point lamp, as it is printed (after Macklin 2010).
//!
//! In uniform fog of the scattering coefficient `sigma`, from the surface `p` towards the camera, `d` away, past a lamp at
//! `s` with the intensity `I`:
//!
//! ```text
//! b = (p - s) . v,  c = |p - s|^2,  v = sqrt(c - b^2),  x = (b + d) / v,  y = b / v
//! S = sigma pi I / v  arctan((x - y) / (1 + x y))
//! ```
//!
//! # Errata
//! - The arctangent is off by pi wherever `1 + x y < 0`, which is wherever the lamp is passed by so much that it sees the
//!   line under more than a right angle: for b = -5, c = 26, d = 20 it is -0.2640, and should be 2.8776. The light is then
//!   below 0.
//! - A lamp of intensity `I` gives the irradiance `I / r^2`, and the uniform phase function is `1 / (4 pi)`: the source is
//!   `I / (4 pi r^2)`, not `pi I / r^2`. So all of it is `4 pi^2` = 39.5 times too bright.
//! - "Transmittance is left out because only single scattering is considered": the extinction on both legs is part of single
//!   scattering.
//!
//! [`super::airlight_without_extinction`] mends the first two, [`super::airlight_isotropic`] all three.

use super::geometry::LightRayGeometry;
use std::f64::consts::PI;

/// The printed form, in 1/m: times the lamp's intensity and the scattering coefficient that is the path radiance. It is the
/// same from either end of the line; a line without end has the limit, `arctan(1 / y)`.
#[inline]
pub fn airlight_printed(geometry: &LightRayGeometry) -> f64 {
    let v = geometry.nearest_m;
    let y = geometry.start_m / v;
    let x = (geometry.start_m + geometry.length_m) / v;
    let tangent = match x.is_finite() {
        true => (x - y) / (1.0 + x * y),
        false => 1.0 / y,
    };
    PI / v * tangent.atan()
}

#[cfg(test)]
mod tests {
    use super::super::airlight_without_extinction;
    use super::*;

    fn geometry(start_m: f64, length_m: f64) -> LightRayGeometry {
        LightRayGeometry {
            nearest_m: 1.0,
            start_m,
            length_m,
        }
    }

    #[test]
    fn it_is_as_wrong_as_the_errata_say() {
        // b = -5, c = 26, d = 20.
        let passed = geometry(-5.0, 20.0);
        let printed = airlight_printed(&passed) / PI;
        assert!((printed + 0.2640).abs() < 5e-5, "{printed}");
        let right = 4.0 * PI * airlight_without_extinction(&passed);
        assert!((right - 2.8776).abs() < 5e-5, "{right}");
        assert!((right - printed - PI).abs() < 1e-12);
        // The same from the other end.
        assert!((airlight_printed(&passed.reversed()) / PI - printed).abs() < 1e-12);
    }

    #[test]
    fn where_the_lamp_is_not_passed_only_the_unit_is_wrong() {
        for (start_m, length_m) in [
            (-5.0, 4.0),
            (0.5, 20.0),
            (3.0, f64::INFINITY),
            (-0.5, 2.0),
            (-1.0, 1.9),
        ] {
            let geometry = geometry(start_m, length_m);
            let ratio = airlight_printed(&geometry) / airlight_without_extinction(&geometry);
            assert!(
                (ratio / (4.0 * PI * PI) - 1.0).abs() < 1e-12,
                "{start_m} {ratio}"
            );
        }
        // Under more than a right angle: below 0, also without end.
        for (start_m, length_m) in [(-1.0, 2.1), (-1.0, f64::INFINITY)] {
            let printed = airlight_printed(&geometry(start_m, length_m));
            assert!(printed < 0.0 && printed.is_finite(), "{start_m} {printed}");
        }
        assert_eq!(airlight_printed(&geometry(-3.0, 0.0)), 0.0);
    }
}
