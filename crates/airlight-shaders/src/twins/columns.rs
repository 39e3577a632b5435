//! Integrals of relative density along rays: `wgsl/columns.wgsl`.

use super::exponentials::{OPAQUE, mean_transmittance, scaled_erfc};
use glam::Vec2;

/// Length of a ray that does not end.
pub const INFINITE_M: f32 = 1e12;

/// Logarithm of the largest density of an exponential profile.
pub const LARGEST_LN_DENSITY: f32 = 57.0;

/// A segment of a straight ray over flat or round ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySegment {
    /// Height of the start, m.
    pub height_m: f32,
    /// Sine of the elevation at the start.
    pub sin_elevation: f32,
    /// Half the second derivative of the height, 1/m.
    pub curvature_per_m: f32,
    /// Length, m, at most [`INFINITE_M`].
    pub length_m: f32,
}

/// A segment over ground of curvature `inverse_radius_per_m` = 1 / R, 0 for flat ground.
pub fn ray_segment(
    height_m: f32,
    sin_elevation: f32,
    length_m: f32,
    inverse_radius_per_m: f32,
) -> RaySegment {
    let squared_cos = (1.0 - sin_elevation) * (1.0 + sin_elevation);
    RaySegment {
        height_m,
        sin_elevation,
        curvature_per_m: 0.5 * squared_cos.max(0.0) * inverse_radius_per_m,
        length_m,
    }
}

/// Height after `s_m` metres, m.
pub fn height_at(ray: RaySegment, s_m: f32) -> f32 {
    ray.height_m + s_m * (ray.sin_elevation + s_m * ray.curvature_per_m)
}

/// The part from `from_m` to `to_m`, as a segment that starts there.
pub fn ray_part(ray: RaySegment, from_m: f32, to_m: f32) -> RaySegment {
    RaySegment {
        height_m: height_at(ray, from_m),
        sin_elevation: ray.sin_elevation + 2.0 * from_m * ray.curvature_per_m,
        curvature_per_m: ray.curvature_per_m,
        length_m: to_m - from_m,
    }
}

/// Interval of distances (m) in which the segment is below `height_m`; (0, 0) if it never is.
pub fn below_height(ray: RaySegment, height_m: f32) -> Vec2 {
    let above = ray.height_m - height_m;
    let mut first = 0.0;
    let mut last = 0.0;
    if ray.curvature_per_m > 0.0 {
        let discriminant =
            ray.sin_elevation * ray.sin_elevation - 4.0 * ray.curvature_per_m * above;
        if discriminant > 0.0 {
            let root = discriminant.sqrt();
            let q = -0.5
                * (ray.sin_elevation
                    + if ray.sin_elevation >= 0.0 {
                        root
                    } else {
                        -root
                    });
            let a = q / ray.curvature_per_m;
            let b = above / q;
            first = a.min(b);
            last = a.max(b);
        }
    } else if ray.sin_elevation == 0.0 {
        last = if above < 0.0 { ray.length_m } else { 0.0 };
    } else if ray.sin_elevation > 0.0 {
        last = -above / ray.sin_elevation;
    } else {
        first = above / -ray.sin_elevation;
        last = ray.length_m;
    }
    first = first.max(0.0);
    last = last.min(ray.length_m);
    if last > first {
        Vec2::new(first, last)
    } else {
        Vec2::ZERO
    }
}

/// Density that has decayed over `heights` scale heights (negative: increased).
pub fn decayed(heights: f32) -> f32 {
    (-heights).min(LARGEST_LN_DENSITY).exp()
}

/// `int_0^length e^-(a s + b s^2) ds` for `a` not negative and `b` above 0.
pub fn falling_column_m(a: f32, b: f32, length_m: f32) -> f32 {
    let fall = length_m * (a + b * length_m);
    if fall < 0.5 {
        let s1 = 0.069_431_84 * length_m;
        let s2 = 0.330_009_5 * length_m;
        let s3 = 0.669_990_5 * length_m;
        let s4 = 0.930_568_16 * length_m;
        let outer = (-s1 * (a + b * s1)).exp() + (-s4 * (a + b * s4)).exp();
        let inner = (-s2 * (a + b * s2)).exp() + (-s3 * (a + b * s3)).exp();
        return length_m * (0.173_927_42 * outer + 0.326_072_57 * inner);
    }
    let root = b.sqrt();
    let near = 0.5 * a / root;
    let far = (-fall).exp() * scaled_erfc(near + root * length_m);
    0.886_226_95 / root * (scaled_erfc(near) - far)
}

/// Column of the density `e^-((height - reference_height_m) / scale_height_m)` along a ray over flat ground.
pub fn flat_exponential_column_m(
    height_m: f32,
    sin_elevation: f32,
    length_m: f32,
    reference_height_m: f32,
    scale_height_m: f32,
) -> f32 {
    let rise = sin_elevation * length_m / scale_height_m;
    let densest = (height_m - reference_height_m) / scale_height_m + rise.min(0.0);
    (decayed(densest) * (length_m * mean_transmittance(rise.abs()))).min(OPAQUE)
}

/// [`flat_exponential_column_m`] over flat or round ground.
pub fn exponential_column_m(ray: RaySegment, reference_height_m: f32, scale_height_m: f32) -> f32 {
    let length = ray.length_m;
    if ray.curvature_per_m <= 0.0 {
        return flat_exponential_column_m(
            ray.height_m,
            ray.sin_elevation,
            length,
            reference_height_m,
            scale_height_m,
        );
    }
    let slope = ray.sin_elevation / scale_height_m;
    let curvature = ray.curvature_per_m / scale_height_m;
    let start = (ray.height_m - reference_height_m) / scale_height_m;
    let lowest = (-0.5 * slope / curvature).clamp(0.0, length);
    let densest = start + lowest * (slope + lowest * curvature);
    let back = (-(slope + 2.0 * curvature * lowest)).max(0.0);
    let ahead = (slope + 2.0 * curvature * lowest).max(0.0);
    let mut column = 0.0;
    if lowest > 0.0 {
        column += falling_column_m(back, curvature, lowest);
    }
    if lowest < length {
        column += falling_column_m(ahead, curvature, length - lowest);
    }
    (decayed(densest) * column).min(OPAQUE)
}

/// Column of a density that is 1 up to the base and falls exponentially above it, over flat ground.
pub fn flat_clamped_column_m(
    height_m: f32,
    sin_elevation: f32,
    length_m: f32,
    base_height_m: f32,
    scale_height_m: f32,
) -> f32 {
    let ray = RaySegment {
        height_m,
        sin_elevation,
        curvature_per_m: 0.0,
        length_m,
    };
    let within = below_height(ray, base_height_m);
    let below_m = within.y - within.x;
    if below_m <= 0.0 {
        return flat_exponential_column_m(
            height_m,
            sin_elevation,
            length_m,
            base_height_m,
            scale_height_m,
        );
    }
    let beyond_m = length_m - below_m;
    let beyond = flat_exponential_column_m(0.0, sin_elevation.abs(), beyond_m, 0.0, scale_height_m);
    (below_m + beyond).min(OPAQUE)
}

/// [`flat_clamped_column_m`] over flat or round ground.
pub fn clamped_column_m(ray: RaySegment, base_height_m: f32, scale_height_m: f32) -> f32 {
    if ray.curvature_per_m <= 0.0 {
        return flat_clamped_column_m(
            ray.height_m,
            ray.sin_elevation,
            ray.length_m,
            base_height_m,
            scale_height_m,
        );
    }
    let within = below_height(ray, base_height_m);
    if within.x == within.y {
        return exponential_column_m(ray, base_height_m, scale_height_m);
    }
    let mut column = within.y - within.x;
    if within.x > 0.0 {
        let before = ray_part(ray, 0.0, within.x);
        column += exponential_column_m(before, base_height_m, scale_height_m);
    }
    if within.y < ray.length_m {
        let beyond = ray_part(ray, within.y, ray.length_m);
        column += exponential_column_m(beyond, base_height_m, scale_height_m);
    }
    column.min(OPAQUE)
}

/// Column of a density that is 1 from `bottom_m` to `top_m` and 0 elsewhere.
pub fn layer_column_m(ray: RaySegment, bottom_m: f32, top_m: f32) -> f32 {
    let below_top = below_height(ray, top_m);
    let below_bottom = below_height(ray, bottom_m);
    if below_bottom.x == below_bottom.y {
        return below_top.y - below_top.x;
    }
    let thickness = top_m - bottom_m;
    let mut down = (below_bottom.x - below_top.x).max(0.0);
    if below_top.x > 0.0 {
        let twice_mid_m = below_top.x + below_bottom.x;
        down = -thickness / (ray.sin_elevation + ray.curvature_per_m * twice_mid_m);
    }
    let mut up = (below_top.y - below_bottom.y).max(0.0);
    if below_top.y < ray.length_m && below_bottom.y < ray.length_m {
        let twice_mid_m = below_top.y + below_bottom.y;
        up = thickness / (ray.sin_elevation + ray.curvature_per_m * twice_mid_m);
    }
    down + up
}

/// Column of the exponential profile above a height, m.
pub fn exponential_column_above_m(
    height_m: f32,
    reference_height_m: f32,
    scale_height_m: f32,
) -> f32 {
    scale_height_m * decayed((height_m - reference_height_m) / scale_height_m)
}

/// Column of the clamped profile above a height, m.
pub fn clamped_column_above_m(height_m: f32, base_height_m: f32, scale_height_m: f32) -> f32 {
    (base_height_m - height_m).max(0.0)
        + scale_height_m * decayed((height_m - base_height_m).max(0.0) / scale_height_m)
}
