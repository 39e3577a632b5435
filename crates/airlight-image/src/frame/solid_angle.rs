//! Solid angles of pixels, in steradians.

use std::f64::consts::TAU;

/// The band of the sphere between two elevations (radians), all the way round.
pub(super) fn band(bottom: f64, top: f64) -> f64 {
    // sin(top) - sin(bottom), without cancellation.
    TAU * 2.0 * ((top + bottom) / 2.0).cos() * ((top - bottom) / 2.0).sin()
}

/// An upright rectangle at distance 1, given by its edges.
pub(super) fn rectangle(x: (f64, f64), y: (f64, f64)) -> f64 {
    // The rectangle from the axis to the corner (x, y) subtends atan(x y / sqrt(1 + x^2 + y^2)).
    let corner = |x: f64, y: f64| (x * y).atan2((1.0 + x * x + y * y).sqrt());
    corner(x.1, y.1) - corner(x.0, y.1) - corner(x.1, y.0) + corner(x.0, y.0)
}

/// A pixel of an equidistant fisheye whose upper left corner lies at `corner` (pixels from the middle): 9-point
/// Gauss-Legendre quadrature of `sin(theta) / theta`, points outside the circle counting nothing.
pub(super) fn equidistant_pixel(
    corner: (f64, f64),
    radians_per_pixel: f64,
    half_angle: f64,
) -> f64 {
    let offset = 0.5 * 0.6f64.sqrt();
    let points = [(0.5 - offset, 5.0), (0.5, 8.0), (0.5 + offset, 5.0)];
    let mut sum = 0.0;
    for (x, weight_x) in points {
        for (y, weight_y) in points {
            let theta = (corner.0 + x).hypot(corner.1 + y) * radians_per_pixel;
            if theta <= half_angle {
                let density = if theta < 1e-4 {
                    1.0 - theta * theta / 6.0
                } else {
                    theta.sin() / theta
                };
                sum += density * (weight_x * weight_y) / 324.0;
            }
        }
    }
    sum * radians_per_pixel * radians_per_pixel
}
