//! Fog with all orders of scattering from tables: `wgsl/fog_table.wgsl`.

use super::exponentials::{OPAQUE, mean_transmittance_rgb};
use super::path_optics::PathOptics;
use super::phase::one_minus_cos_between;
use super::sky_tables::{PHASE_ANGLES, azimuth_place, elevation_of, phase_place, texel_coordinate};
use super::texture::{LinearSampler, Texture2d, Texture3d};
use glam::{Vec2, Vec3, Vec4Swizzles};
use std::f32::consts::FRAC_2_PI;

/// Columns of the table of diffuse light, from the azimuth of the sun to the opposite one.
pub const FOG_AZIMUTHS: f32 = 32.0;
/// Rows of falling rays, from the horizontal to the nadir, and again of rising ones.
pub const FOG_ROWS: f32 = 64.0;
/// Distances of the tables.
pub const FOG_DISTANCES: f32 = 32.0;
/// Part of the logarithm of the sine of the elevation in the spacing of rows.
pub const FOG_LOGARITHMIC: f32 = 0.6;

/// What the tables of a layer of fog are made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogTableView {
    /// Unit vector to the sun.
    pub sun: Vec3,
    /// 1 over the sine up to which rows of falling rays are even.
    pub below_per_sine: f32,
    /// Optical depth of the layer straight down to the ground.
    pub depth_below: Vec3,
    /// 1 over the sine up to which rows of rising rays are even.
    pub above_per_sine: f32,
    /// Optical depth of the layer straight up.
    pub depth_above: Vec3,
    /// Factor of diffuse light.
    pub diffuse_scale: f32,
    /// Factor of sunlight scattered once.
    pub sunlit_scale: f32,
    /// Index of the layer among those of the tables.
    pub layer: f32,
    /// Number of layers of the tables.
    pub layer_count: f32,
    /// Number of phase functions of the fog.
    pub phase_count: f32,
}

/// Place of a row, 0 to 1, from the absolute elevation and its sine.
pub fn fog_row_place(per_sine: f32, sine: f32, elevation_rad: f32) -> f32 {
    let logarithm = (1.0 + sine * per_sine).ln() / (1.0 + per_sine).ln();
    FOG_LOGARITHMIC * logarithm + (1.0 - FOG_LOGARITHMIC) * FRAC_2_PI * elevation_rad
}

/// Texture coordinate of the rows of a direction.
pub fn fog_row_coordinate(view: FogTableView, direction: Vec3) -> f32 {
    let (per_sine, first) = match direction.y > 0.0 {
        true => (view.above_per_sine, FOG_ROWS),
        false => (view.below_per_sine, 0.0),
    };
    let place = fog_row_place(per_sine, direction.y.abs(), elevation_of(direction).abs());
    (first + 0.5 + place * (FOG_ROWS - 1.0)) / (2.0 * FOG_ROWS)
}

/// Texture coordinate in stacked tables from that in the table of the layer.
pub fn fog_stacked_coordinate(view: FogTableView, coordinate: f32) -> f32 {
    (view.layer + coordinate) / view.layer_count
}

/// Opacity of an optical depth.
pub fn fog_opacity(depth: Vec3) -> Vec3 {
    depth * mean_transmittance_rgb(depth)
}

/// Place of a distance, 0 to 1, from the opacity and the transmittance up to there.
pub fn fog_distance_place(
    view: FogTableView,
    sin_elevation: f32,
    opacity: Vec3,
    transmittance: Vec3,
) -> f32 {
    let vertical = match sin_elevation > 0.0 {
        true => view.depth_above,
        false => view.depth_below,
    };
    let depth = (vertical / sin_elevation.abs().max(1e-10)).min(Vec3::splat(OPAQUE));
    let whole = fog_opacity(depth).element_sum();
    let left = match whole < 1.5 {
        true => whole - opacity.element_sum(),
        false => (transmittance - (-depth).exp()).element_sum(),
    };
    1.0 - (left / whole.max(1e-30)).clamp(0.0, 1.0).sqrt().sqrt()
}

/// Sunlight that is scattered once with a phase function in a stream, per unit of opacity, before its scale.
pub fn fog_stream_light(
    view: FogTableView,
    stream_table: &Texture3d,
    stream_phase_table: &Texture2d,
    linear_sampler: LinearSampler,
    place: Vec3,
    phase: f32,
    stream: f32,
) -> Vec3 {
    let slice = (3.0 * phase + stream + 0.5) / (3.0 * view.phase_count);
    let uvw = Vec3::new(place.x, place.y, fog_stacked_coordinate(view, slice));
    let logarithms = stream_table.sample_3d(linear_sampler, uvw);
    let scattered = stream_phase_table.sample(linear_sampler, Vec2::new(place.z, slice));
    logarithms.xyz().exp() * scattered.xyz()
}

/// A layer of fog between the eye and a point, by its optical depth on the way.
pub fn tabulated_fog(
    view: FogTableView,
    diffuse_table: &Texture3d,
    stream_table: &Texture3d,
    stream_phase_table: &Texture2d,
    linear_sampler: LinearSampler,
    direction: Vec3,
    optical_depth: Vec3,
) -> PathOptics {
    let opacity = fog_opacity(optical_depth);
    let transmittance = (-optical_depth).exp();
    let u = texel_coordinate(azimuth_place(direction, view.sun), FOG_AZIMUTHS);
    let v = fog_row_coordinate(view, direction);
    let distance = fog_distance_place(view, direction.y, opacity, transmittance);
    let w = texel_coordinate(distance, FOG_DISTANCES);
    let uvw = Vec3::new(u, v, fog_stacked_coordinate(view, w));
    let diffuse = diffuse_table.sample_3d(linear_sampler, uvw).xyz();
    let one_minus_cos = one_minus_cos_between(direction, view.sun);
    let angle = texel_coordinate(phase_place(one_minus_cos), PHASE_ANGLES);
    let place = Vec3::new(w, v, angle);
    let stream = |phase, stream| {
        fog_stream_light(
            view,
            stream_table,
            stream_phase_table,
            linear_sampler,
            place,
            phase,
            stream,
        )
    };
    let mut sunlit = Vec3::ZERO;
    let mut phase = 0.0;
    while phase < view.phase_count {
        sunlit += stream(phase, 0.0) + stream(phase, 1.0) + stream(phase, 2.0);
        phase += 1.0;
    }
    let source = view.diffuse_scale * diffuse + view.sunlit_scale * sunlit.max(Vec3::ZERO);
    PathOptics {
        transmittance,
        path_radiance: opacity * source,
    }
}
