//! [`FogTables`]: the tables of `wgsl/fog_table.wgsl`, filled from a fog of the library.

use crate::sky_tables::SkyTables;
use crate::twins::columns::INFINITE_M;
use crate::twins::exponentials::OPAQUE;
use crate::twins::fog_table::{
    FOG_AZIMUTHS, FOG_DISTANCES, FOG_LOGARITHMIC, FOG_ROWS, FogTableView, fog_opacity,
    tabulated_fog,
};
use crate::twins::path_optics::PathOptics;
use crate::twins::sky_tables::{
    PHASE_ANGLES, SkyView, direction_from_azimuth_elevation, one_minus_cos_from_phase_place,
};
use crate::twins::texture::{LinearSampler, Texture};
use airlight::fog::{DensityProfile, FOG_STREAMS, RaySegment, RgbFog, RgbFogParts, RgbFogTable};
use airlight::glam::DVec3;
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
/// them, `tabulated_fog`. Textures may be stored as half floats. Those of several density profiles are stacked in the last dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct FogTables {
    /// What the tables are made for: one view for each density profile of the fog, in the order of [`RgbFog::profiles`].
    pub views: Vec<FogTableView>,
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
        "expected fog with multiple scattering and an upper end over flat ground, got another; try the functions of the part `fog`"
    )]
    Fog,
}

/// Numbers of texels.
const AZIMUTHS: usize = FOG_AZIMUTHS as usize;
const ROWS: usize = FOG_ROWS as usize;
const DISTANCES: usize = FOG_DISTANCES as usize;
const ANGLES: usize = PHASE_ANGLES as usize;

impl FogTables {
    /// The tables of a fog for an eye at a height, m, not below the ground. Takes about a tenth of a second for a single density profile
    /// and a second for four.
    ///
    /// # Errors
    /// [`FogTablesError`] for fog without layers, multiple scattering or an upper end, or over round ground.
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
    /// direction, as the tables do. For one of several layers the means are over the light that it removes, and `1 - T_f` is the light that
    /// it removes of all. Takes twice as long as [`FogTables::new`].
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

    /// Fog between the eye and a point along a unit vector, by the optical depth of each density profile on the way: what the shader function
    /// finds, with textures of single precision.
    pub fn path(&self, direction: Vec3, depths: impl IntoIterator<Item = Vec3>) -> PathOptics {
        let clear = PathOptics {
            transmittance: Vec3::ONE,
            path_radiance: Vec3::ZERO,
        };
        let layers = self.views.iter().zip(depths);
        layers.fold(clear, |sum, (view, depth)| {
            let layer = tabulated_fog(
                *view,
                &self.diffuse,
                &self.streams,
                &self.stream_phase,
                LinearSampler,
                direction,
                depth,
            );
            PathOptics {
                transmittance: sum.transmittance * layer.transmittance,
                path_radiance: sum.path_radiance + layer.path_radiance,
            }
        })
    }

    fn filled(
        fog: &RgbFog,
        eye_height_m: f64,
        air: Option<&SkyTables>,
    ) -> Result<Self, FogTablesError> {
        let seen = SeenFog::new(fog, eye_height_m);
        let layers: Option<Vec<LayerTables>> = (0..seen.layers.len())
            .map(|layer| LayerTables::new(&seen, layer, air))
            .collect();
        let layers = layers.filter(|layers| !layers.is_empty());
        let layers = layers.ok_or(FogTablesError::Fog)?;
        let (stream_phase, scale) = stream_phase(&seen.table);
        let mut views: Vec<FogTableView> = layers.iter().map(|layer| layer.view).collect();
        for view in &mut views {
            view.sunlit_scale *= scale;
        }
        let stacked = |[width, height, depth]: [usize; 3], texels: fn(&LayerTables) -> &[Vec4]| {
            let all: Vec<&[Vec4]> = layers.iter().map(texels).collect();
            Texture::new([width, height, layers.len() * depth], all.concat())
        };
        let slices = seen.table.phase_count() * FOG_STREAMS;
        Ok(Self {
            views,
            diffuse: stacked([AZIMUTHS, 2 * ROWS, DISTANCES], |layer| &layer.diffuse),
            streams: stacked([DISTANCES, 2 * ROWS, slices], |layer| &layer.streams),
            stream_phase,
        })
    }
}

/// A fog seen from a height.
struct SeenFog {
    table: RgbFogTable,
    sun: Option<DVec3>,
    eye_height_m: f64,
    /// Height of the eye above the ground, m.
    above_ground_m: f64,
    layers: Vec<Layer>,
}

/// Layers of one density profile.
struct Layer {
    density: DensityProfile,
    extinction_per_m: Vec3,
}

impl SeenFog {
    fn new(fog: &RgbFog, eye_height_m: f64) -> Self {
        let layer = |(density, extinction): (&DensityProfile, [f32; 3])| Layer {
            density: density.clone(),
            extinction_per_m: Vec3::from(extinction),
        };
        Self {
            table: fog.seen_from(eye_height_m),
            sun: fog.lighting().sun.map(|sun| sun.direction),
            eye_height_m,
            above_ground_m: (eye_height_m - fog.ground().height_m).max(0.0),
            layers: fog.profiles().map(layer).collect(),
        }
    }

    /// Optical depth of a layer along a ray from the eye.
    fn depth(&self, layer: &Layer, sine: f64, length_m: f64) -> Vec3 {
        let ray = RaySegment::flat(self.eye_height_m, sine, length_m);
        let column_m = layer.density.column_along_m(&ray).min(f64::from(OPAQUE));
        (layer.extinction_per_m * column_m as f32).min(Vec3::splat(OPAQUE))
    }

    /// Transmittance of all layers but one along a ray from the eye.
    fn transmittance_of_others(&self, but: usize, sine: f64, length_m: f64) -> Vec3 {
        let others = self.layers.iter().enumerate().filter(|(k, _)| *k != but);
        let depth: Vec3 = others
            .map(|(_, layer)| self.depth(layer, sine, length_m))
            .sum();
        (-depth).exp()
    }
}

/// The tables of a layer.
struct LayerTables {
    view: FogTableView,
    diffuse: Vec<Vec4>,
    streams: Vec<Vec4>,
}

impl LayerTables {
    fn new(seen: &SeenFog, layer: usize, air: Option<&SkyTables>) -> Option<Self> {
        let depths = |layer| {
            let sides = [(-1.0, seen.above_ground_m), (1.0, f64::INFINITY)];
            sides.map(|(sine, length_m)| seen.depth(layer, sine, length_m))
        };
        let [depth_below, depth_above] = depths(&seen.layers[layer]);
        let [below_per_sine, above_per_sine] = [0, 1].map(|side| {
            // The thinnest layer is opaque along rays that are the closest to level ones.
            let each = seen
                .layers
                .iter()
                .map(|layer| depths(layer)[side].element_sum() / 3.0);
            let least = each
                .filter(|depth| *depth > 0.0)
                .fold(f32::INFINITY, f32::min);
            1.0 / (0.1 * least).clamp(1e-6, 0.05)
        });
        let mut rows = Vec::with_capacity(2 * ROWS);
        for (sign, per_sine) in [(-1.0, below_per_sine), (1.0, above_per_sine)] {
            for row in 0..ROWS {
                let place = (row as f64 / (ROWS - 1) as f64).max(BESIDE_LEVEL);
                let sine = sign * elevation_at(f64::from(per_sine), place).sin();
                rows.push(RowOfRays::new(seen, layer, sine));
            }
        }
        let parts = rows
            .iter()
            .map(|row| seen.table.parts(layer, row.sine, &row.distances_m));
        let nodes: Option<Vec<Vec<RgbFogParts>>> = parts.collect();
        let nodes = nodes?;
        let sun = seen.sun.map_or(Vec3::Y, |sun| sun.as_vec3());
        let in_front = |air| {
            rows.iter()
                .map(|row| AirBefore::new(row, air, sun))
                .collect()
        };
        let before: Option<Vec<AirBefore>> = air.map(in_front);
        let (diffuse, diffuse_scale) = diffuse(&rows, &nodes, before.as_deref());
        let (streams, sunlit_scale) = streams(&nodes, before.as_deref());
        let view = FogTableView {
            sun,
            below_per_sine,
            depth_below,
            above_per_sine,
            depth_above,
            diffuse_scale,
            sunlit_scale,
            layer: layer as f32,
            layer_count: seen.layers.len() as f32,
            phase_count: seen.table.phase_count() as f32,
        };
        Some(Self {
            view,
            diffuse,
            streams,
        })
    }
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

/// Rays of one elevation, and the distances of the tables of a layer along them.
struct RowOfRays {
    sine: f64,
    distances_m: Vec<f64>,
    /// Opacity of the layer alone up to each distance.
    opacities: Vec<Vec3>,
    /// Transmittance of the other layers up to each distance.
    before: Vec<Vec3>,
}

impl RowOfRays {
    fn new(seen: &SeenFog, layer: usize, sine: f64) -> Self {
        let of = &seen.layers[layer];
        let opacity = |length_m: f64| fog_opacity(seen.depth(of, sine, length_m));
        let mean = |length_m: f64| f64::from(opacity(length_m).element_sum()) / 3.0;
        let end_m = match sine < 0.0 {
            true => seen.above_ground_m / -sine,
            false => f64::INFINITY,
        };
        let whole = mean(end_m);
        let mut distances_m = Vec::with_capacity(DISTANCES);
        let mut from_m = 0.0;
        for node in 0..DISTANCES {
            let left = 1.0 - node as f64 / (DISTANCES - 1) as f64;
            let target = whole * (1.0 - left.powi(4)).max(NEAREST);
            from_m = match node == DISTANCES - 1 {
                true => end_m,
                false => distance_of(&mean, target, from_m, end_m),
            };
            distances_m.push(from_m);
        }
        let before = |&m: &f64| seen.transmittance_of_others(layer, sine, m);
        Self {
            sine,
            opacities: distances_m.iter().map(|&m| opacity(m)).collect(),
            before: distances_m.iter().map(before).collect(),
            distances_m,
        }
    }

    fn cosine(&self) -> f64 {
        (1.0 - self.sine * self.sine).max(0.0).sqrt()
    }

    /// Light that the layer removes up to each distance, and its product with values, per unit of opacity.
    fn removed(&self, value: impl Fn(f64) -> Vec3) -> Vec<[Vec3; 2]> {
        let (mut sum, mut weighted) = (Vec3::ZERO, Vec3::ZERO);
        let at = |k: usize| {
            (
                self.opacities[k],
                self.before[k],
                value(self.distances_m[k]),
            )
        };
        // Light that is removed before the first distance is removed close to it.
        let mut last = (Vec3::ZERO, self.before[0], value(self.distances_m[0]));
        let removed = |k: usize| {
            let here = at(k);
            let step = here.0 - last.0;
            sum += 0.5 * step * (last.1 + here.1);
            weighted += 0.5 * step * (last.1 * last.2 + here.1 * here.2);
            last = here;
            let per_opacity =
                |light: Vec3| Vec3::select(here.0.cmpgt(Vec3::ZERO), light / here.0, Vec3::ZERO);
            [sum, weighted].map(per_opacity)
        };
        (0..self.distances_m.len()).map(removed).collect()
    }
}

/// Air in front of a row.
struct AirBefore {
    /// Means of the transmittance over the light that the layer removes up to each distance.
    transmittance: Vec<Vec3>,
    /// By azimuth, products of the path radiance and the light that the layer removes, per unit of its opacity.
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
        let mean = |[removed, dimmed]: [Vec3; 2]| {
            Vec3::select(removed.cmpgt(Vec3::ZERO), dimmed / removed, Vec3::ONE)
        };
        let through = row.removed(|m| optics(0, m).transmittance);
        let of_azimuth = |azimuth| {
            let light = row.removed(|m| optics(azimuth, m).path_radiance);
            light.into_iter().map(|[_, light]| light).collect()
        };
        Self {
            transmittance: through.into_iter().map(mean).collect(),
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

/// Diffuse light by azimuth, row and distance, relative to its largest value, and that value.
fn diffuse(
    rows: &[RowOfRays],
    nodes: &[Vec<RgbFogParts>],
    before: Option<&[AirBefore]>,
) -> (Vec<Vec4>, f32) {
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
    let scale = largest(&texels);
    for texel in &mut texels {
        *texel /= scale;
    }
    (texels, scale)
}

/// Largest value of texels, or 1 if all are 0.
fn largest(texels: &[Vec4]) -> f32 {
    let largest = texels
        .iter()
        .fold(0.0f32, |most, texel| most.max(texel.abs().max_element()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// Logarithms of the streams by distance, row, phase function and stream, relative to the largest value, and that value.
fn streams(nodes: &[Vec<RgbFogParts>], before: Option<&[AirBefore]>) -> (Vec<Vec4>, f32) {
    let phases = nodes[0][0].streams.len();
    let mut texels = Vec::with_capacity(DISTANCES * 2 * ROWS * phases * FOG_STREAMS);
    for phase in 0..phases {
        for stream in 0..FOG_STREAMS {
            for (row, nodes) in nodes.iter().enumerate() {
                for (distance, parts) in nodes.iter().enumerate() {
                    let through = before.map_or(Vec3::ONE, |air| air[row].transmittance[distance]);
                    let light = Vec3::from(parts.streams[phase][stream]) * through;
                    texels.push(light.extend(0.0));
                }
            }
        }
    }
    let scale = largest(&texels);
    let logarithm = |x: f32| (x / scale).ln().max(DARKEST);
    for texel in &mut texels {
        *texel = Vec4::from(texel.to_array().map(logarithm));
    }
    (texels, scale)
}

/// Phase functions times sunlight by angle, phase function and stream, relative to a scale, and that scale.
fn stream_phase(table: &RgbFogTable) -> (Texture, f32) {
    let phases = table.phase_count();
    let mut texels = vec![Vec4::ZERO; ANGLES * phases * FOG_STREAMS];
    for phase in 0..phases {
        for angle in 0..ANGLES {
            let place = angle as f32 / (ANGLES - 1) as f32;
            let one_minus_cos = f64::from(one_minus_cos_from_phase_place(place));
            let streams = table.sun_streams(phase, 1.0 - one_minus_cos);
            for (stream, light) in streams.into_iter().enumerate() {
                let slice = phase * FOG_STREAMS + stream;
                texels[slice * ANGLES + angle] = Vec3::from(light).extend(0.0);
            }
        }
    }
    let scale = largest(&texels) / LARGEST_PHASE;
    for texel in &mut texels {
        *texel /= scale;
    }
    (
        Texture::new([ANGLES, phases * FOG_STREAMS, 1], texels),
        scale,
    )
}
