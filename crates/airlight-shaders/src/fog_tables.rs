//! [`FogTables`]: the tables of `wgsl/fog_table.wgsl`, filled from a fog of the library.

use crate::sky_tables::SkyTables;
use crate::twins::columns::INFINITE_M;
use crate::twins::exponentials::OPAQUE;
use crate::twins::fog_table::{
    FOG_AZIMUTHS, FOG_DISTANCES, FOG_LOGARITHMIC, FOG_ROWS, FogTableView,
};
use crate::twins::sky_tables::{
    PHASE_ANGLES, SkyView, direction_from_azimuth_elevation, one_minus_cos_from_phase_place,
};
use crate::twins::texture::Texture;
use airlight::fog::{FOG_STREAMS, RaySegment, RgbFog, RgbFogParts, RgbFogTable};
use glam::{Vec3, Vec4};
use std::f64::consts::{FRAC_PI_2, PI};

/// Logarithm of the least light of a stream, relative to its scale.
const DARKEST: f32 = -30.0;
/// Opacity at the first distance relative to that of the whole ray.
const NEAREST: f64 = 1e-5;
/// Largest value of the table of phase functions, below that of half floats.
const LARGEST_PHASE: f32 = 6e4;
/// Place of the first row, as the light along level rays is a limit.
const BESIDE_LEVEL: f64 = 1e-5;

/// Tables of a fog with all orders of scattering for one height of the eye, with the parameters of the shader function that reads
/// them, `tabulated_fog`. Textures may be stored as half floats.
#[derive(Clone, Debug, PartialEq)]
pub struct FogTables {
    /// What the tables are made for.
    pub view: FogTableView,
    /// Light that is scattered several times, per unit of opacity.
    pub diffuse: Texture,
    /// Logarithm of sunlight scattered once per unit of opacity, by distance, row and stream.
    pub streams: Texture,
    /// Light scattered towards the eye by angle and stream.
    pub stream_phase: Texture,
}

/// Error of [`FogTables::new`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FogTablesError {
    /// The fog is of another kind.
    #[error(
        "expected fog of one layer with multiple scattering over flat ground, got another; try the functions of the part `fog`"
    )]
    Fog,
}

/// Numbers of texels.
const AZIMUTHS: usize = FOG_AZIMUTHS as usize;
const ROWS: usize = FOG_ROWS as usize;
const DISTANCES: usize = FOG_DISTANCES as usize;
const ANGLES: usize = PHASE_ANGLES as usize;

impl FogTables {
    /// The tables of a fog for an eye at a height, m, not below the ground. Takes about a tenth of a second.
    ///
    /// # Errors
    /// [`FogTablesError`] for fog without multiple scattering, of several layers, or over round ground.
    pub fn new(fog: &RgbFog, eye_height_m: f64) -> Result<Self, FogTablesError> {
        Self::filled(fog, eye_height_m, None)
    }

    /// As [`FogTables::new`], of a fog in air: in front of what the air has dimmed and brightened, they have the effect of fog and air in their
    /// order along each ray.
    ///
    /// Light that the air scatters behind a part of the fog is dimmed by that part alone, and the fog's light by the air before it. With
    /// `T_a`, `S_a` of the air and `T_f`, `S_f` of the fog up to a distance, the light in addition to that behind the whole fog is
    ///
    /// ```text
    /// (1 - T_f) <S_a> + <T_a> S_f
    /// ```
    ///
    /// where `<f>` is the mean of `f` over the light that the fog removes on the way: per unit of opacity both vary slowly with distance and
    /// direction, as the tables do. Takes twice as long as [`FogTables::new`].
    ///
    /// # Errors
    /// As [`FogTables::new`].
    pub fn in_air(
        fog: &RgbFog,
        eye_height_m: f64,
        air: &SkyTables,
    ) -> Result<Self, FogTablesError> {
        Self::filled(fog, eye_height_m, Some(air))
    }

    fn filled(
        fog: &RgbFog,
        eye_height_m: f64,
        air: Option<&SkyTables>,
    ) -> Result<Self, FogTablesError> {
        let table = fog.seen_from(eye_height_m);
        let sun = fog.lighting().sun;
        let ground_m = (eye_height_m - fog.ground().height_m).max(0.0);
        let depth = |sine: f64, length_m: f64| {
            let depth = fog.optical_depth(&segment(eye_height_m, sine, length_m));
            Vec3::from(depth).min(Vec3::splat(OPAQUE))
        };
        let (below, above) = (depth(-1.0, ground_m), depth(1.0, f64::INFINITY));
        let per_sine = |depth: Vec3| 1.0 / (0.1 * depth.element_sum() / 3.0).clamp(1e-6, 0.05);
        let [below_per_sine, above_per_sine] = [below, above].map(per_sine);
        let mut rows = Vec::with_capacity(2 * ROWS);
        for (sign, per_sine) in [(-1.0, below_per_sine), (1.0, above_per_sine)] {
            for row in 0..ROWS {
                let place = (row as f64 / (ROWS - 1) as f64).max(BESIDE_LEVEL);
                let sine = sign * elevation_at(f64::from(per_sine), place).sin();
                rows.push(RowOfRays::new(fog, eye_height_m, ground_m, sine));
            }
        }
        let parts = rows
            .iter()
            .map(|row| table.parts(row.sine, &row.distances_m));
        let nodes: Option<Vec<Vec<RgbFogParts>>> = parts.collect();
        let nodes = nodes.ok_or(FogTablesError::Fog)?;
        let mut view = FogTableView {
            sun: sun.map_or(Vec3::Y, |sun| sun.direction.as_vec3()),
            below_per_sine,
            depth_below: below,
            above_per_sine,
            diffuse_scale: 1.0,
            depth_above: above,
            sunlit_scale: 1.0,
        };
        let in_front = |air| {
            rows.iter()
                .map(|row| AirBefore::new(row, air, view.sun))
                .collect()
        };
        let before: Option<Vec<AirBefore>> = air.map(in_front);
        let diffuse = diffuse(&rows, &nodes, before.as_deref(), &mut view.diffuse_scale);
        let streams = streams(&nodes, before.as_deref(), &mut view.sunlit_scale);
        let stream_phase = stream_phase(&table, &mut view.sunlit_scale);
        Ok(Self {
            view,
            diffuse,
            streams,
            stream_phase,
        })
    }
}

/// A ray over flat ground.
fn segment(height_m: f64, sine: f64, length_m: f64) -> RaySegment {
    RaySegment::new(height_m, sine, length_m, f64::INFINITY)
}

/// Absolute elevation at a place of a row, rad: the inverse of `fog_row_place`, by bisection.
fn elevation_at(per_sine: f64, place: f64) -> f64 {
    let logarithmic = f64::from(FOG_LOGARITHMIC);
    let place_of = |elevation: f64| {
        let logarithm = (elevation.sin() * per_sine).ln_1p() / per_sine.ln_1p();
        logarithmic * logarithm + (1.0 - logarithmic) * elevation / FRAC_PI_2
    };
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match place_of(middle) < place {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// Rays of one elevation, and the distances of the tables along them.
struct RowOfRays {
    sine: f64,
    distances_m: Vec<f64>,
    /// Opacity of the fog up to each distance, the mean of the channels.
    opacities: Vec<f64>,
}

impl RowOfRays {
    fn new(fog: &RgbFog, eye_height_m: f64, ground_m: f64, sine: f64) -> Self {
        let opacity = |length_m: f64| {
            let depth = fog.optical_depth(&segment(eye_height_m, sine, length_m));
            let sum: f64 = depth.iter().map(|&d| -f64::from(-d).exp_m1()).sum();
            sum / 3.0
        };
        let end_m = match sine < 0.0 {
            true => ground_m / -sine,
            false => f64::INFINITY,
        };
        let whole = opacity(end_m);
        let mut distances_m = Vec::with_capacity(DISTANCES);
        let mut from_m = 0.0;
        for node in 0..DISTANCES {
            let left = 1.0 - node as f64 / (DISTANCES - 1) as f64;
            let target = whole * (1.0 - left.powi(4)).max(NEAREST);
            from_m = match node == DISTANCES - 1 {
                true => end_m,
                false => distance_of(&opacity, target, from_m, end_m),
            };
            distances_m.push(from_m);
        }
        let opacities = distances_m.iter().map(|&m| opacity(m)).collect();
        Self {
            sine,
            distances_m,
            opacities,
        }
    }

    fn cosine(&self) -> f64 {
        (1.0 - self.sine * self.sine).max(0.0).sqrt()
    }

    /// Means over the light that the fog removes up to each distance, of values that start from one at the eye.
    fn means(&self, at_eye: Vec3, value: impl Fn(f64) -> Vec3) -> Vec<Vec3> {
        let (mut sum, mut last) = (Vec3::ZERO, (0.0, at_eye));
        let nodes = self.distances_m.iter().zip(&self.opacities);
        let mean = |(&distance_m, &opacity): (&f64, &f64)| {
            let here = value(distance_m);
            sum += 0.5 * (last.1 + here) * (opacity - last.0) as f32;
            last = (opacity, here);
            match opacity > 0.0 {
                true => sum / opacity as f32,
                false => at_eye,
            }
        };
        nodes.map(mean).collect()
    }
}

/// Means of the air in front of a row over the light that the fog removes up to each distance.
struct AirBefore {
    transmittance: Vec<Vec3>,
    /// By azimuth.
    path_radiance: Vec<Vec<Vec3>>,
}

impl AirBefore {
    fn new(row: &RowOfRays, air: &SkyTables, sun: Vec3) -> Self {
        let optics = |azimuth: usize, distance_m: f64| {
            let turn = azimuth as f32 / (AZIMUTHS - 1) as f32;
            let elevation = (row.sine as f32).asin();
            let view = SkyView { sun, ..air.view };
            let direction = direction_from_azimuth_elevation(view, turn, elevation);
            air.rgb_path(direction, distance_m.min(f64::from(INFINITE_M)) as f32)
        };
        let of_azimuth = |azimuth| row.means(Vec3::ZERO, |m| optics(azimuth, m).path_radiance);
        Self {
            transmittance: row.means(Vec3::ONE, |m| optics(0, m).transmittance),
            path_radiance: (0..AZIMUTHS).map(of_azimuth).collect(),
        }
    }
}

/// Distance from `from_m` to `end_m` at which an increasing opacity reaches a target, by doubling and bisection.
fn distance_of(opacity: &impl Fn(f64) -> f64, target: f64, from_m: f64, end_m: f64) -> f64 {
    let (mut low, mut high) = (from_m, (2.0 * from_m).max(1e-3));
    while high < end_m && high < 1e12 && opacity(high) < target {
        low = high;
        high *= 2.0;
    }
    high = high.min(end_m);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        match opacity(middle) < target {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// Diffuse light by azimuth, row and distance, relative to its largest value, which is the scale.
fn diffuse(
    rows: &[RowOfRays],
    nodes: &[Vec<RgbFogParts>],
    before: Option<&[AirBefore]>,
    scale: &mut f32,
) -> Texture {
    let mut texels = Vec::with_capacity(AZIMUTHS * 2 * ROWS * DISTANCES);
    for distance in 0..DISTANCES {
        for (row, nodes) in nodes.iter().enumerate() {
            for azimuth in 0..AZIMUTHS {
                let turn = PI * azimuth as f64 / (AZIMUTHS - 1) as f64;
                let fog = Vec3::from(nodes[distance].diffuse(rows[row].cosine(), turn));
                let light = before.map_or(fog, |air| {
                    let air = &air[row];
                    fog * air.transmittance[distance] + air.path_radiance[azimuth][distance]
                });
                texels.push(light.extend(0.0));
            }
        }
    }
    *scale = largest(&texels);
    for texel in &mut texels {
        *texel /= *scale;
    }
    Texture::new([AZIMUTHS, 2 * ROWS, DISTANCES], texels)
}

/// Largest value of texels, or 1 if all are 0.
fn largest(texels: &[Vec4]) -> f32 {
    let largest = texels
        .iter()
        .fold(0.0f32, |most, texel| most.max(texel.abs().max_element()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// Logarithms of the streams by distance, row and stream, relative to the largest value, by which the scale is multiplied.
fn streams(nodes: &[Vec<RgbFogParts>], before: Option<&[AirBefore]>, scale: &mut f32) -> Texture {
    let mut texels = Vec::with_capacity(DISTANCES * 2 * ROWS * FOG_STREAMS);
    for stream in 0..FOG_STREAMS {
        for (row, nodes) in nodes.iter().enumerate() {
            for (distance, parts) in nodes.iter().enumerate() {
                let through = before.map_or(Vec3::ONE, |air| air[row].transmittance[distance]);
                let light = Vec3::from(parts.streams[stream]) * through;
                texels.push(light.extend(0.0));
            }
        }
    }
    let most = largest(&texels);
    *scale *= most;
    let logarithm = |x: f32| (x / most).ln().max(DARKEST);
    let texels = texels
        .iter()
        .map(|t| Vec4::from(t.to_array().map(logarithm)));
    Texture::new([DISTANCES, 2 * ROWS, FOG_STREAMS], texels.collect())
}

/// Light scattered towards the eye by angle and stream, relative to a scale by which `scale` is multiplied.
fn stream_phase(table: &RgbFogTable, scale: &mut f32) -> Texture {
    let angles: Vec<[[f32; 3]; FOG_STREAMS]> = (0..ANGLES)
        .map(|angle| {
            let place = angle as f32 / (ANGLES - 1) as f32;
            let one_minus_cos = f64::from(one_minus_cos_from_phase_place(place));
            table.sun_streams(1.0 - one_minus_cos)
        })
        .collect();
    let stream = |k: usize| {
        angles
            .iter()
            .map(move |light| Vec3::from(light[k]).extend(0.0))
    };
    let mut texels: Vec<Vec4> = (0..FOG_STREAMS).flat_map(stream).collect();
    let unit = largest(&texels) / LARGEST_PHASE;
    *scale *= unit;
    for texel in &mut texels {
        *texel /= unit;
    }
    Texture::new([ANGLES, FOG_STREAMS, 1], texels)
}
