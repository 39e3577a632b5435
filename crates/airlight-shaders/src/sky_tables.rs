//! [`SkyTables`]: the tables of `wgsl/sky_tables.wgsl`, filled from a solved sky.

use crate::colour_fit::ColourFit;
use crate::jump::Jump;
use crate::twins::colour::{RgbWeights, rgb_from_spectrum};
use crate::twins::path_optics::PathOptics;
use crate::twins::sky_tables as twin;
use crate::twins::texture::{LinearSampler, Texture};
use crate::wavelengths::WAVELENGTHS_NM;
use airlight::glam::DVec3;
use airlight::sky::{SkyError, SplitPath, SplitView, TableCoordinates, View};
use airlight::spectrum::{RgbSpace, rgb};
use airlight::transfer::count_exponentials;
use glam::{Vec3, Vec4};
use std::f64::consts::PI;

/// Logarithm of the least light that a table holds, relative to its scale.
const DARKEST: f64 = -30.0;
/// First distance of a ray, in steps: means are undefined at the eye itself.
const FIRST_STEP: f64 = 0.01;

/// Tables of the sky and of aerial perspective for one height of the eye and one direction of the sun, with the parameters of the
/// shader functions that read them. Textures may be stored as half floats.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyTables {
    /// What the tables are made for.
    pub view: twin::SkyView,
    /// Factors from table values to radiance, W m^-2 sr^-1 nm^-1.
    pub scales: twin::SkyScales,
    /// Logarithm of the radiance of the sky other than `sky_haze`.
    pub sky_smooth: Texture,
    /// Logarithm of the radiance that haze scatters once, divided by its phase function.
    pub sky_haze: Texture,
    /// Source function of the path radiance, as `sky_smooth`, and relative to [`twin::SkyView::smooth_above`] and
    /// [`twin::SkyView::extinction_above`].
    pub aerial_smooth: Texture,
    /// Source function of the path radiance, as `sky_haze`, and relative to [`twin::SkyView::haze_above`] and
    /// [`twin::SkyView::extinction_above`].
    pub aerial_haze: Texture,
    /// Mean extinction, 1/km, relative to [`twin::SkyView::extinction_above`].
    pub extinction: Texture,
    /// Phase function of haze, 1/sr.
    pub phase: Texture,
    /// Weights from radiance to red, green and blue, cd/m^2.
    pub radiance_weights: RgbWeights,
    /// Weights from transmittance to that of sunlight in red, green and blue.
    pub transmittance_weights: RgbWeights,
    /// Weights from the radiance of the sun's disc behind the air to red, green and blue, cd/m^2.
    pub disc_weights: RgbWeights,
}

/// Error of [`SkyTables::new`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SkyTablesError {
    /// The sky was solved at other wavelengths.
    #[error(
        "expected a sky at {WAVELENGTHS_NM:?} nm, got {0:?} nm; try airlight_shaders::wavelength_grid()"
    )]
    Wavelengths(Vec<f64>),
    /// The fit of the colours is not prepared for the view and cannot be solved for it.
    #[error(transparent)]
    Sky(#[from] SkyError),
}

impl SkyTables {
    /// Tables of a view of a sky that was solved on the [`crate::wavelength_grid`], for colours in an RGB space by the fit of its atmosphere.
    ///
    /// # Errors
    /// [`SkyTablesError`] for a sky at other wavelengths, and for a view that the fit cannot be solved for.
    pub fn new(view: &View, fit: &ColourFit, space: RgbSpace) -> Result<Self, SkyTablesError> {
        Self::of(&view.split(), fit, space)
    }

    /// As [`SkyTables::new`], of a view whose light is split.
    ///
    /// # Errors
    /// As [`SkyTables::new`].
    pub fn of(split: &SplitView, fit: &ColourFit, space: RgbSpace) -> Result<Self, SkyTablesError> {
        let view = split.view();
        let grid = view.sky().grid();
        if grid.wavelengths_nm() != WAVELENGTHS_NM {
            let wavelengths_nm = grid.wavelengths_nm().to_vec();
            return Err(SkyTablesError::Wavelengths(wavelengths_nm));
        }
        let place = Eye::new(view);
        let jump = Jump::nearest(split, &place.coordinates);
        let sky_view = sky_view(view, &place.coordinates, &jump);
        let mut sky = sky(split, &place);
        begin_at_kink(&mut sky.1, &place);
        let scales = twin::SkyScales {
            smooth_light: scale(&sky.0),
            haze: scale(&sky.1),
        };
        let mut aerial = aerial(split, &place, &sky_view);
        begin_haze(&mut aerial.haze, &jump);
        let [radiance_weights, transmittance_weights, disc_weights] =
            rgb_weights(view, fit, space)?;
        Ok(Self {
            view: sky_view,
            scales,
            sky_smooth: logarithms(sky_size(), &sky.0, scales.smooth_light),
            sky_haze: logarithms(sky_size(), &sky.1, scales.haze),
            aerial_smooth: logarithms(aerial_size(), &aerial.smooth, scales.smooth_light),
            aerial_haze: logarithms(aerial_size(), &aerial.haze, scales.haze),
            extinction: aerial.extinction,
            phase: phase(split),
            radiance_weights,
            transmittance_weights,
            disc_weights,
        })
    }

    /// Red, green and blue of the sky, or of the ground below the horizon, along a unit vector, without the sun's disc, cd/m^2: what the
    /// shaders compute.
    pub fn rgb_radiance(&self, direction: Vec3) -> Vec3 {
        rgb_from_spectrum(self.radiance_weights, self.radiance(direction))
    }

    fn radiance(&self, direction: Vec3) -> Vec4 {
        twin::sky_radiance(
            self.view,
            self.scales,
            &self.sky_smooth,
            &self.sky_haze,
            &self.phase,
            LinearSampler,
            direction,
        )
    }

    /// These tables over ground that receives a part of its light, at the four wavelengths: as below a fog.
    pub fn over_ground_in_part(mut self, part: Vec4) -> Self {
        let texels = self.sky_smooth.texels().iter().enumerate();
        let texels = texels.map(|(index, &texel)| {
            let (column, row) = (index % SKY_COLUMNS, index / SKY_COLUMNS);
            if row < SKY_ROWS[0] {
                return texel;
            }
            let uv = [column, row].map(|k| k as f32 + 0.5);
            let (azimuths, rows) = (
                twin::SKY_AZIMUTHS,
                twin::SKY_ROWS_ABOVE + twin::SKY_ROWS_BELOW,
            );
            let place = twin::place_from_texel_coordinate(uv[0] / azimuths, azimuths);
            let azimuth = twin::azimuth_from_column_place(self.view, place);
            let elevation = twin::elevation_from_row_coordinate(
                self.view,
                uv[1] / rows,
                twin::SKY_ROWS_ABOVE,
                twin::SKY_ROWS_BELOW,
            );
            let direction = twin::direction_from_azimuth_elevation(self.view, azimuth, elevation);
            // What is not light of the air is that of the ground behind it.
            let air = self.path(direction, f32::MAX).path_radiance;
            let ground = (self.radiance(direction) - air).max(Vec4::ZERO);
            let scale = self.scales.smooth_light;
            let light = texel.exp() * scale - (Vec4::ONE - part) * ground;
            (light / scale).map_lanes(|light| light.ln().max(DARKEST as f32))
        });
        self.sky_smooth = Texture::new(self.sky_smooth.size(), texels.collect());
        self
    }

    /// Transmittance and path radiance, cd/m^2, of the air between the eye and a point at a distance (m) along a unit vector, in red, green and
    /// blue: what the shaders compute.
    pub fn rgb_path(&self, direction: Vec3, distance_m: f32) -> PathOptics {
        let path = self.path(direction, distance_m);
        twin::rgb_path(self.radiance_weights, self.transmittance_weights, path)
    }

    fn path(&self, direction: Vec3, distance_m: f32) -> twin::SpectralPath {
        twin::aerial_perspective(
            self.view,
            self.scales,
            &self.aerial_smooth,
            &self.aerial_haze,
            &self.extinction,
            &self.phase,
            LinearSampler,
            direction,
            distance_m,
        )
    }
}

/// Source function of the path radiance that the air scatters once, as [`SkyTables::aerial_smooth`] holds that of all light: what is missing
/// where the sun is hidden. The shader function of aerial perspective reads it in the place of that table.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleScatteringTable {
    /// Logarithm of the source function, without the light of [`SkyTables::aerial_haze`], which haze scatters once.
    pub smooth: Texture,
    /// Factor from table values to radiance, W m^-2 sr^-1 nm^-1, in the place of [`twin::SkyScales::smooth_light`].
    pub scale: Vec4,
}

impl SingleScatteringTable {
    /// The table of a view of a sky that was solved with [`Scattering::Single`](airlight::sky::Scattering::Single), for the eye and the sun
    /// of `tables`.
    pub fn new(split: &SplitView, tables: &SkyTables) -> Self {
        let eye = Eye::new(split.view());
        let aerial = aerial(split, &eye, &tables.view);
        let scale = scale(&aerial.smooth);
        Self {
            smooth: logarithms(aerial_size(), &aerial.smooth, scale),
            scale,
        }
    }
}

/// What the shader functions know of a view.
fn sky_view(view: &View, coordinates: &TableCoordinates, jump: &Jump) -> twin::SkyView {
    let (ground_radius_m, top_radius_m) = view.bounds_m();
    with_place_of_jump(twin::SkyView {
        sun: view.sun().as_vec3(),
        height_m: (view.radius_m() - ground_radius_m) as f32,
        ground_radius_m: ground_radius_m as f32,
        air_height_m: (top_radius_m - ground_radius_m) as f32,
        horizon_rad: coordinates.horizon_rad as f32,
        highest_rad: coordinates.highest_rad as f32,
        kink_rad: coordinates.kink_rad as f32,
        kink_place: coordinates.kink_place as f32,
        dense_share: coordinates.dense_share as f32,
        dense_azimuth: coordinates.dense_azimuth as f32,
        dense_width: coordinates.dense_width as f32,
        even_below: coordinates.even_below as f32,
        jump_height_m: jump.height_m,
        jump_place: 0.0,
        jump_part: 0.0,
        extinction_above: jump.extinction,
        smooth_above: jump.smooth,
        haze_above: jump.haze,
    })
}

/// The view with the place of its jump among the distances: the nearest whole one before that which the crossing has among distances dense at
/// the eye, along the ray that grazes the jump, or from below along the level one.
fn with_place_of_jump(view: twin::SkyView) -> twin::SkyView {
    /// Height of the eye over or below a jump up to which distances that are dense at the eye resolve the crossings of steep rays, and
    /// others would not, m.
    const NEAR_M: f32 = 600.0;
    let over_jump = (view.height_m - view.jump_height_m)
        * (2.0 * view.ground_radius_m + view.height_m + view.jump_height_m);
    let distance_m = (view.height_m - view.jump_height_m).abs();
    if view.jump_height_m <= 0.0 || distance_m < NEAR_M || view.height_m >= view.air_height_m {
        return view;
    }
    let crossing_m = over_jump.abs().sqrt();
    let sine = match over_jump > 0.0 {
        true => -crossing_m / (view.ground_radius_m + view.height_m),
        false => 0.0,
    };
    let part = crossing_m / twin::air_span_m(view, sine, false).y;
    let steps = twin::AERIAL_DISTANCES - 1.0;
    let place = (steps * part.sqrt()).floor() / steps;
    match place > 0.0 {
        true => twin::SkyView {
            jump_place: place,
            jump_part: part,
            ..view
        },
        false => view,
    }
}

/// Directions of rows and columns.
struct Eye {
    coordinates: TableCoordinates,
    sun: DVec3,
}

impl Eye {
    fn new(view: &View) -> Self {
        Self {
            coordinates: view.table_coordinates(),
            sun: view.sun(),
        }
    }

    /// Unit vector at a place among the columns of a sky table and at an elevation.
    fn direction(&self, column_place: f64, elevation: f64) -> DVec3 {
        let towards = DVec3::new(self.sun.x, 0.0, self.sun.z);
        let towards = match self.sun.x.abs() + self.sun.z.abs() < 1e-9 {
            true => DVec3::X,
            false => towards.normalize(),
        };
        let across = DVec3::new(-towards.z, 0.0, towards.x);
        let azimuth = self.coordinates.azimuth(column_place);
        let (sin, cos) = (PI * azimuth).sin_cos();
        (towards * cos + across * sin) * elevation.cos() + DVec3::Y * elevation.sin()
    }
}

/// Place from 0 to 1 of a row among those above or below the horizon, and whether it is below.
fn row_place(row: usize, [above, below]: [usize; 2]) -> (f64, bool) {
    match row < above {
        true => (row as f64 / (above - 1) as f64, false),
        false => ((row - above) as f64 / (below - 1) as f64, true),
    }
}

/// The part `p` for which `p^(1 - x)` is nearest to `x` between 0 and 1, within 0.15: what stands for nothing in logarithms between which
/// light begins.
const BEGINNING: f32 = 0.145;
const SKY_COLUMNS: usize = twin::SKY_AZIMUTHS as usize;
const SKY_ROWS: [usize; 2] = [twin::SKY_ROWS_ABOVE as usize, twin::SKY_ROWS_BELOW as usize];
const AERIAL_COLUMNS: usize = twin::AERIAL_AZIMUTHS as usize;
const AERIAL_ROWS: [usize; 2] = [
    twin::AERIAL_ROWS_ABOVE as usize,
    twin::AERIAL_ROWS_BELOW as usize,
];
const DISTANCES: usize = twin::AERIAL_DISTANCES as usize;

fn sky_size() -> [usize; 3] {
    [SKY_COLUMNS, SKY_ROWS[0] + SKY_ROWS[1], 1]
}

fn aerial_size() -> [usize; 3] {
    [AERIAL_COLUMNS, AERIAL_ROWS[0] + AERIAL_ROWS[1], DISTANCES]
}

/// Smooth light and haze of the sky by texel.
fn sky(split: &SplitView, eye: &Eye) -> (Vec<Vec4>, Vec<Vec4>) {
    let [columns, rows, _] = sky_size();
    let mut directions = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        let (place, is_below) = row_place(row, SKY_ROWS);
        let elevation = eye.coordinates.elevation_rad(place, is_below);
        let places = (0..columns).map(|column| column as f64 / (columns - 1) as f64);
        directions.extend(places.map(|place| eye.direction(place, elevation)));
    }
    let light = split.radiances(&directions);
    light
        .iter()
        .map(|light| (vec4(&light.smooth), vec4(&light.peaked)))
        .unzip()
}

/// Aerial perspective by texel.
struct Aerial {
    smooth: Vec<Vec4>,
    haze: Vec<Vec4>,
    extinction: Texture,
}

fn aerial(split: &SplitView, eye: &Eye, view: &twin::SkyView) -> Aerial {
    let [columns, rows, distances] = aerial_size();
    let column_places = (0..columns).map(|column| {
        let place = column as f32 / (columns - 1) as f32;
        f64::from(twin::part_from_place(place, twin::AERIAL_FIRST_COLUMN))
    });
    let column_places: Vec<f64> = column_places.collect();
    // From above a jump, the distance at which rays enter the air below it: what is relative to that needs a little of it.
    let entry = match view.height_m > view.jump_height_m {
        true => (view.jump_place * (distances - 1) as f32).round() as usize,
        false => 0,
    };
    let mut rays = Vec::with_capacity(rows);
    // By row and step: the length of the ray in the air, m, and the part of it below a jump of density.
    let mut lengths_m = Vec::with_capacity(rows * distances);
    let mut shares = Vec::with_capacity(rows * distances);
    for row in 0..rows {
        let (row_place, is_below) = row_place(row, AERIAL_ROWS);
        let place = twin::row_place_from_aerial(*view, row_place as f32, is_below);
        let elevation = eye.coordinates.elevation_rad(f64::from(place), is_below);
        let sine = elevation.sin() as f32;
        let span = twin::air_span_m(*view, sine, is_below);
        let start_m = f64::from(span.x);
        let stops_m = (0..distances).map(|step| {
            let entered = f64::from(u8::from(step == entry));
            let place =
                (step as f64 + FIRST_STEP * entered).max(FIRST_STEP) / (distances - 1) as f64;
            start_m
                + f64::from(twin::length_from_distance_place(
                    *view,
                    span,
                    sine,
                    place as f32,
                    is_below,
                ))
        });
        let stops_m: Vec<f64> = stops_m.collect();
        for stop_m in &stops_m {
            let length_m = (stop_m - start_m) as f32;
            let share = twin::share_below_jump(*view, span, sine, length_m, is_below);
            lengths_m.push(length_m);
            shares.push(share);
        }
        let directions = column_places.iter();
        let directions = directions.map(|&place| eye.direction(place, elevation));
        rays.push((directions.collect(), stops_m));
    }
    let paths = split.many_paths(&rays);
    // Relative to what is below a jump of density, so that nothing jumps.
    let relative = |above: Vec4, share: f32| above.lerp(Vec4::ONE, share);
    let mut smooth = vec![Vec4::ZERO; columns * rows * distances];
    let mut haze = smooth.clone();
    for (index, path) in paths.iter().flatten().enumerate() {
        for (step, stop) in path.iter().enumerate() {
            let texel = step * columns * rows + index;
            let share = shares[index / columns * distances + step];
            let opacity = vec4(&stop.optical_depth).map_lanes(|depth| -(-depth).exp_m1());
            let opacity = opacity / relative(view.extinction_above, share);
            smooth[texel] = source(&stop.smooth, opacity) / relative(view.smooth_above, share);
            haze[texel] = source(&stop.peaked, opacity) / relative(view.haze_above, share);
        }
    }
    count_exponentials(4 * smooth.len());
    let mut extinction = Vec::with_capacity(rows * distances);
    for row in 0..rows {
        let mean = |(step, stop): (usize, &SplitPath)| {
            let length_km = 1e-3 * lengths_m[row * distances + step];
            let relative = relative(view.extinction_above, shares[row * distances + step]);
            match length_km > 0.0 {
                true => vec4(&stop.optical_depth) / (length_km * relative),
                false => Vec4::ZERO,
            }
        };
        extinction.extend(paths[row][0].iter().enumerate().map(mean));
    }
    Aerial {
        smooth,
        haze,
        extinction: Texture::new([distances, rows, 1], extinction),
    }
}

/// Gives texels of aerial perspective without haze, from which haze begins at the next distance or in the next row below, what they tend
/// to as it begins: relative to a jump that bounds the haze the light of the neighbour, otherwise a part of that.
fn begin_haze(haze: &mut [Vec4], jump: &Jump) {
    let [columns, rows, distances] = aerial_size();
    let layer = columns * rows;
    let part = if jump.bounds_haze() { 1.0 } else { BEGINNING };
    for texel in (0..layer * (distances - 1)).rev() {
        if haze[texel] == Vec4::ZERO {
            haze[texel] = part * haze[texel + layer];
        }
    }
    if jump.bounds_haze() {
        for texel in 0..haze.len() {
            let row = texel % layer / columns;
            if haze[texel] == Vec4::ZERO && (1..AERIAL_ROWS[0]).contains(&row) {
                haze[texel] = haze[texel - columns];
            }
        }
    }
}

/// Gives the row of the sky's rays that graze a jump of density, if they meet no haze, a part of the light of the next row below, where haze
/// begins: from there the light grows with the square root of the angle, which is that of the place, and logarithms would start at nothing.
fn begin_at_kink(haze: &mut [Vec4], eye: &Eye) {
    let row = (eye.coordinates.kink_place * (SKY_ROWS[0] - 1) as f64).round() as usize;
    if row == 0 {
        return;
    }
    let first = row * SKY_COLUMNS;
    for at_kink in first..first + SKY_COLUMNS {
        haze[at_kink] = haze[at_kink].max(BEGINNING * haze[at_kink - SKY_COLUMNS]);
    }
}

/// Path radiance divided by opacity.
fn source(path: &[f32], opacity: Vec4) -> Vec4 {
    let path = vec4(path);
    Vec4::from_array(std::array::from_fn(|k| match opacity[k] > 0.0 {
        true => path[k] / opacity[k],
        false => 0.0,
    }))
}

fn phase(split: &SplitView) -> Texture {
    let count = twin::PHASE_ANGLES as usize;
    let texels = (0..count).map(|k| {
        let place = k as f32 / (count - 1) as f32;
        let one_minus_cos = twin::one_minus_cos_from_phase_place(place);
        vec4(&split.phase(1.0 - f64::from(one_minus_cos)))
    });
    Texture::new([count, 1, 1], texels.collect())
}

/// Geometric mean of the light in each channel.
fn scale(light: &[Vec4]) -> Vec4 {
    Vec4::from_array(std::array::from_fn(|k| {
        let brightest = light.iter().map(|v| v[k]).fold(0.0, f32::max);
        let lit = light.iter().map(|v| v[k]).filter(|v| *v > 1e-6 * brightest);
        let (count, sum) = lit.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + f64::from(v).ln()));
        count_exponentials(count as usize + 1);
        match count > 0.0 {
            true => (sum / count).exp() as f32,
            false => f32::MIN_POSITIVE,
        }
    }))
}

fn logarithms(size: [usize; 3], light: &[Vec4], scale: Vec4) -> Texture {
    count_exponentials(4 * light.len());
    let texels = light.iter().map(|value| {
        let ln = |k: usize| f64::from(value[k] / scale[k]).ln().max(DARKEST) as f32;
        Vec4::new(ln(0), ln(1), ln(2), ln(3))
    });
    Texture::new(size, texels.collect())
}

/// The four wavelengths of a list.
fn vec4(values: &[f32]) -> Vec4 {
    Vec4::from_slice(values)
}

trait MapLanes {
    fn map_lanes(self, f: impl Fn(f32) -> f32) -> Self;
}

impl MapLanes for Vec4 {
    fn map_lanes(self, f: impl Fn(f32) -> f32) -> Self {
        Self::from_array(self.to_array().map(f))
    }
}

/// Weights to red, green and blue: of radiance, of transmittance, and of the sun's disc.
fn rgb_weights(view: &View, fit: &ColourFit, space: RgbSpace) -> Result<[RgbWeights; 3], SkyError> {
    let xyz = fit.xyz_weights(view)?;
    let from_xyz = space.from_xyz_matrix();
    let [radiance, sunlight, disc] = [xyz.radiance, xyz.sunlight, xyz.disc]
        .map(|xyz| xyz.map(|column| rgb::apply(&from_xyz, column)));
    let weights = |of: &dyn Fn(usize, usize) -> f64| {
        let row = |c: usize| Vec4::from_array(std::array::from_fn(|k| of(c, k) as f32));
        RgbWeights {
            red: row(0),
            green: row(1),
            blue: row(2),
        }
    };
    // At the sun's distance, as the fit.
    let solar = view.solar_irradiance().into_iter().map(f64::from);
    let solar: Vec<f64> = solar.collect();
    let per_radiance =
        |light: &[[f64; 3]; 4]| weights(&|c, k| light[k][c] / solar[k].max(f64::MIN_POSITIVE));
    let total = |c: usize| sunlight.iter().map(|column| column[c]).sum::<f64>();
    Ok([
        per_radiance(&radiance),
        weights(&|c, k| sunlight[k][c] / total(c)),
        per_radiance(&disc),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::atmosphere::Preset;
    use airlight::axes;
    use airlight::sky::{Scattering, Sky, SkySettings, SunCoverage};
    use airlight::spectrum::WavelengthGrid;

    /// Views from the ground to a geostationary orbit, above and below the tops of layers, under suns by day, in twilight
    /// and in the nadir.
    fn views() -> Vec<View> {
        let grid = WavelengthGrid::from_wavelengths_nm(vec![550.0]).expect("a grid");
        let mut views = Vec::new();
        for preset in [Preset::Average, Preset::Wildfire] {
            for height_m in [0.0, 3e3, 1e4, 5e4, 4e5, 3.6e7] {
                for sun_deg in [90.0, -4.0, -90.0] {
                    let settings = SkySettings {
                        suns: SunCoverage::near(sun_deg, height_m),
                        scattering: Scattering::Single,
                        ..SkySettings::default()
                    };
                    let air = preset.atmosphere();
                    let sky = Sky::prepare(&air, &grid, &settings).expect("a sky");
                    views.push(sky.view(height_m, axes::direction(200.0, sun_deg)));
                }
            }
        }
        views
    }

    /// The largest differences between the mapping of the twins and that of the library, by which the tables are filled: of elevations, rad,
    /// and azimuths, half turns. Places are compared as what they stand for, because elevations of one place differ by a rounding of the
    /// horizon, beside which rows are dense without limit.
    #[test]
    fn twins_have_the_coordinates_of_the_library() {
        let [mut elevation_rad, mut azimuth] = [0.0_f64; 2];
        let (mut kinks, mut dense) = (0, 0);
        for view in views() {
            let exact = view.table_coordinates();
            let twin_view = sky_view(&view, &exact, &Jump::NONE);
            kinks += usize::from(exact.kink_place > 0.0);
            dense += usize::from(exact.dense_share > 0.0);
            for k in 0..=1000 {
                let place = f64::from(k) / 1000.0;
                for is_below in [false, true] {
                    let right = exact.elevation_rad(place, is_below);
                    let got = twin::elevation_from_row_place(twin_view, place as f32, is_below);
                    let got_place = twin::row_place(twin_view, right as f32, is_below);
                    let back = exact.elevation_rad(f64::from(got_place), is_below);
                    for got in [f64::from(got), back] {
                        elevation_rad = elevation_rad.max((got - right).abs());
                    }
                }
                let right = exact.azimuth(place);
                let got = twin::azimuth_from_column_place(twin_view, place as f32);
                let got_place = twin::column_place(twin_view, right as f32);
                let back = exact.azimuth(f64::from(got_place));
                for got in [f64::from(got), back] {
                    azimuth = azimuth.max((got - right).abs());
                }
            }
        }
        println!("elevations {elevation_rad:.1e} rad, azimuths {azimuth:.1e} half turns");
        println!("{kinks} views above the top of a layer, {dense} with dense columns");
        assert!(kinks >= 8 && dense >= 8, "{kinks} {dense}");
        assert!(elevation_rad < 1e-6, "{elevation_rad:e}");
        assert!(azimuth < 1e-6, "{azimuth:e}");
    }
}
