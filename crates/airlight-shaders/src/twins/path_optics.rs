//! The affine map that air applies to radiance: `wgsl/path_optics.wgsl`.

use super::exponentials::mean_transmittance_rgb;
use glam::Vec3;

/// Effect of the air along a segment of a ray: radiance `L` behind it reaches the eye as `transmittance L + path_radiance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathOptics {
    /// Transmittance, 0 to 1.
    pub transmittance: Vec3,
    /// Radiance scattered into the ray, in the unit of the light.
    pub path_radiance: Vec3,
}

/// Radiance at the eye of the radiance behind the segment.
pub fn apply_path_optics(path: PathOptics, radiance: Vec3) -> Vec3 {
    path.transmittance * radiance + path.path_radiance
}

/// A segment followed by one farther away, as one segment.
pub fn near_then_far(near: PathOptics, far: PathOptics) -> PathOptics {
    PathOptics {
        transmittance: near.transmittance * far.transmittance,
        path_radiance: near.path_radiance + near.transmittance * far.path_radiance,
    }
}

/// Segment of an optical depth with a constant source function.
pub fn constant_source(optical_depth: Vec3, source: Vec3) -> PathOptics {
    PathOptics {
        transmittance: (-optical_depth).exp(),
        path_radiance: source * (optical_depth * mean_transmittance_rgb(optical_depth)),
    }
}
