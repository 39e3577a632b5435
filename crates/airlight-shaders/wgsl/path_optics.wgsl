// requires: exponentials
// The affine map that a stretch of air applies to radiance, in red, green and blue.

/// Effect of the air along a segment of a ray: radiance `L` behind it reaches the eye as `transmittance L + path_radiance`.
struct PathOptics {
    /// Transmittance, 0 to 1.
    transmittance: vec3<f32>,
    /// Radiance scattered into the ray, in the unit of the light.
    path_radiance: vec3<f32>,
}

/// Radiance at the eye of the radiance behind the segment.
///
/// Cost: no exp. Error: 2e-7 relative.
fn apply_path_optics(path: PathOptics, radiance: vec3<f32>) -> vec3<f32> {
    return path.transmittance * radiance + path.path_radiance;
}

/// A segment followed by one farther away, as one segment.
///
/// Cost: no exp. Error: 2e-7 relative.
fn near_then_far(near: PathOptics, far: PathOptics) -> PathOptics {
    return PathOptics(
        near.transmittance * far.transmittance,
        near.path_radiance + near.transmittance * far.path_radiance,
    );
}

/// Segment of an optical depth with a source function (radiance scattered towards the eye per unit of optical depth) that is
/// constant along it: `(1 - T) source`, exact in thin and opaque air.
///
/// Cost: 6 exp. Error: 1e-6 relative plus 5e-7 absolute.
fn constant_source(optical_depth: vec3<f32>, source: vec3<f32>) -> PathOptics {
    return PathOptics(
        exp(-optical_depth),
        source * (optical_depth * mean_transmittance_rgb(optical_depth)),
    );
}
