// requires: exponentials
// Integrals of relative density along rays ("columns", m) over flat or round ground. Heights are above the ground or above any
// other zero near the eye. Optical depth is extinction at density 1 times column.

/// Length of a ray that does not end: use it for the sky. Longer rays may overflow.
const INFINITE_M: f32 = 1e12;

/// Logarithm of the largest density of an exponential profile, so that no column overflows deep below the reference height.
const LARGEST_LN_DENSITY: f32 = 57.0;

/// A segment of a straight ray over flat or round ground. The height after `s` metres is
/// `height_m + s (sin_elevation + s curvature_per_m)`: the sphere to second order, within `s^3 sin_elevation / (2 R^2)`.
struct RaySegment {
    /// Height of the start, m.
    height_m: f32,
    /// Sine of the elevation at the start.
    sin_elevation: f32,
    /// Half the second derivative of the height, 1/m: `(1 - sin_elevation^2) / (2 R)`, 0 over flat ground.
    curvature_per_m: f32,
    /// Length, m, at most `INFINITE_M`.
    length_m: f32,
}

/// A segment over ground of curvature `inverse_radius_per_m` = 1 / R, 0 for flat ground.
///
/// Cost: no exp. Error: 4e-7 relative.
fn ray_segment(height_m: f32, sin_elevation: f32, length_m: f32, inverse_radius_per_m: f32) -> RaySegment {
    let squared_cos = (1.0 - sin_elevation) * (1.0 + sin_elevation);
    return RaySegment(height_m, sin_elevation, 0.5 * max(squared_cos, 0.0) * inverse_radius_per_m, length_m);
}

/// Height after `s_m` metres, m.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-3 absolute.
fn height_at(ray: RaySegment, s_m: f32) -> f32 {
    return ray.height_m + s_m * (ray.sin_elevation + s_m * ray.curvature_per_m);
}

/// The part from `from_m` to `to_m`, as a segment that starts there.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-3 absolute.
fn ray_part(ray: RaySegment, from_m: f32, to_m: f32) -> RaySegment {
    return RaySegment(
        height_at(ray, from_m),
        ray.sin_elevation + 2.0 * from_m * ray.curvature_per_m,
        ray.curvature_per_m,
        to_m - from_m,
    );
}

/// Interval of distances (m) in which the segment is below `height_m`; (0, 0) if it never is. Only a ray that grazes this height
/// over round ground has an error above 1e-2 m.
///
/// Cost: no exp. Error: 3e-6 relative plus 2 absolute.
fn below_height(ray: RaySegment, height_m: f32) -> vec2<f32> {
    let above = ray.height_m - height_m;
    var first = 0.0;
    var last = 0.0;
    if ray.curvature_per_m > 0.0 {
        // Roots of curvature s^2 + sin_elevation s + above, without cancellation.
        let discriminant = ray.sin_elevation * ray.sin_elevation - 4.0 * ray.curvature_per_m * above;
        if discriminant > 0.0 {
            let root = sqrt(discriminant);
            let q = -0.5 * (ray.sin_elevation + select(-root, root, ray.sin_elevation >= 0.0));
            let a = q / ray.curvature_per_m;
            let b = above / q;
            first = min(a, b);
            last = max(a, b);
        }
    } else if ray.sin_elevation == 0.0 {
        last = select(0.0, ray.length_m, above < 0.0);
    } else if ray.sin_elevation > 0.0 {
        last = -above / ray.sin_elevation;
    } else {
        first = above / -ray.sin_elevation;
        last = ray.length_m;
    }
    first = max(first, 0.0);
    last = min(last, ray.length_m);
    return select(vec2<f32>(0.0), vec2<f32>(first, last), last > first);
}

/// Density that has decayed over `heights` scale heights (negative: increased).
///
/// Cost: 1 exp. Error: 1.2e-5 relative.
fn decayed(heights: f32) -> f32 {
    return exp(min(-heights, LARGEST_LN_DENSITY));
}

/// `int_0^length e^-(a s + b s^2) ds` for `a` not negative and `b` above 0.
///
/// Cost: 4 exp. Error: 1.5e-6 relative.
fn falling_column_m(a: f32, b: f32, length_m: f32) -> f32 {
    let fall = length_m * (a + b * length_m);
    if fall < 0.5 {
        // Gauss-Legendre quadrature with 4 points: 1e-8.
        let s1 = 0.06943184420297371 * length_m;
        let s2 = 0.33000947820757187 * length_m;
        let s3 = 0.6699905217924281 * length_m;
        let s4 = 0.9305681557970263 * length_m;
        let outer = exp(-s1 * (a + b * s1)) + exp(-s4 * (a + b * s4));
        let inner = exp(-s2 * (a + b * s2)) + exp(-s3 * (a + b * s3));
        return length_m * (0.17392742256872692 * outer + 0.32607257743127307 * inner);
    }
    let root = sqrt(b);
    let near = 0.5 * a / root;
    let far = exp(-fall) * scaled_erfc(near + root * length_m);
    return 0.886226925452758 / root * (scaled_erfc(near) - far);
}

/// Column of the density `e^-((height - reference_height_m) / scale_height_m)` along a ray over flat ground: height fog
/// (Ishiyama 2018, eqs. 14 and 23). Level rays and infinite ones included; at most `OPAQUE`.
///
/// Cost: 2 exp. Error: 1.5e-5 relative plus 1e-3 absolute.
fn flat_exponential_column_m(height_m: f32, sin_elevation: f32, length_m: f32, reference_height_m: f32, scale_height_m: f32) -> f32 {
    let rise = sin_elevation * length_m / scale_height_m;
    // Start from the denser end to avoid overflow.
    let densest = (height_m - reference_height_m) / scale_height_m + min(rise, 0.0);
    return min(decayed(densest) * (length_m * mean_transmittance(abs(rise))), OPAQUE);
}

/// `flat_exponential_column_m` over flat or round ground: height fog, or a gas.
///
/// Cost: 9 exp; over flat ground 2. Error: 1.5e-5 relative plus 1e-3 absolute.
fn exponential_column_m(ray: RaySegment, reference_height_m: f32, scale_height_m: f32) -> f32 {
    let length = ray.length_m;
    if ray.curvature_per_m <= 0.0 {
        return flat_exponential_column_m(ray.height_m, ray.sin_elevation, length, reference_height_m, scale_height_m);
    }
    let slope = ray.sin_elevation / scale_height_m;
    let curvature = ray.curvature_per_m / scale_height_m;
    let start = (ray.height_m - reference_height_m) / scale_height_m;
    // The exponent is a parabola, integrated away from its lowest point.
    let lowest = clamp(-0.5 * slope / curvature, 0.0, length);
    let densest = start + lowest * (slope + lowest * curvature);
    let back = max(-(slope + 2.0 * curvature * lowest), 0.0);
    let ahead = max(slope + 2.0 * curvature * lowest, 0.0);
    var column = 0.0;
    if lowest > 0.0 {
        column += falling_column_m(back, curvature, lowest);
    }
    if lowest < length {
        column += falling_column_m(ahead, curvature, length - lowest);
    }
    return min(decayed(densest) * column, OPAQUE);
}

/// Column of a density that is 1 up to the base and falls exponentially above it, `e^-(max(0, height - base) / scale)`, along a
/// ray over flat ground: the height fog after Wenzel, split where the ray crosses the base.
///
/// Cost: 2 exp. Error: 1.2e-5 relative plus 1e-6 absolute.
fn flat_clamped_column_m(height_m: f32, sin_elevation: f32, length_m: f32, base_height_m: f32, scale_height_m: f32) -> f32 {
    let within = below_height(RaySegment(height_m, sin_elevation, 0.0, length_m), base_height_m);
    let below_m = within.y - within.x;
    if below_m <= 0.0 {
        return flat_exponential_column_m(height_m, sin_elevation, length_m, base_height_m, scale_height_m);
    }
    // The rest is the same upwards from the base as downwards to it.
    let beyond_m = length_m - below_m;
    return min(below_m + flat_exponential_column_m(0.0, abs(sin_elevation), beyond_m, 0.0, scale_height_m), OPAQUE);
}

/// `flat_clamped_column_m` over flat or round ground.
///
/// Cost: 18 exp; over flat ground 2. Error: 1.5e-5 relative plus 0.1 absolute.
fn clamped_column_m(ray: RaySegment, base_height_m: f32, scale_height_m: f32) -> f32 {
    if ray.curvature_per_m <= 0.0 {
        return flat_clamped_column_m(ray.height_m, ray.sin_elevation, ray.length_m, base_height_m, scale_height_m);
    }
    let within = below_height(ray, base_height_m);
    if within.x == within.y {
        return exponential_column_m(ray, base_height_m, scale_height_m);
    }
    var column = within.y - within.x;
    if within.x > 0.0 {
        column += exponential_column_m(ray_part(ray, 0.0, within.x), base_height_m, scale_height_m);
    }
    if within.y < ray.length_m {
        column += exponential_column_m(ray_part(ray, within.y, ray.length_m), base_height_m, scale_height_m);
    }
    return min(column, OPAQUE);
}

/// Column of a density that is 1 from `bottom_m` to `top_m` and 0 elsewhere. Only a ray that grazes an edge over round ground has
/// an error above 1e-2 m.
///
/// Cost: no exp. Error: 3e-6 relative plus 15 absolute.
fn layer_column_m(ray: RaySegment, bottom_m: f32, top_m: f32) -> f32 {
    let below_top = below_height(ray, top_m);
    let below_bottom = below_height(ray, bottom_m);
    if below_bottom.x == below_bottom.y {
        return below_top.y - below_top.x;
    }
    // Between the edges on the way down, and again on the way up. A passage from edge to edge is the thickness divided by the
    // mean slope, which unlike the difference of two distances does not cancel.
    let thickness = top_m - bottom_m;
    var down = max(below_bottom.x - below_top.x, 0.0);
    if below_top.x > 0.0 {
        down = -thickness / (ray.sin_elevation + ray.curvature_per_m * (below_top.x + below_bottom.x));
    }
    var up = max(below_top.y - below_bottom.y, 0.0);
    if below_top.y < ray.length_m && below_bottom.y < ray.length_m {
        up = thickness / (ray.sin_elevation + ray.curvature_per_m * (below_top.y + below_bottom.y));
    }
    return down + up;
}

/// Column of the exponential profile above a height, m.
///
/// Cost: 1 exp. Error: 1.2e-5 relative.
fn exponential_column_above_m(height_m: f32, reference_height_m: f32, scale_height_m: f32) -> f32 {
    return scale_height_m * decayed((height_m - reference_height_m) / scale_height_m);
}

/// Column of the clamped profile above a height, m.
///
/// Cost: 1 exp. Error: 1.2e-5 relative.
fn clamped_column_above_m(height_m: f32, base_height_m: f32, scale_height_m: f32) -> f32 {
    return max(base_height_m - height_m, 0.0) + scale_height_m * decayed(max(height_m - base_height_m, 0.0) / scale_height_m);
}
