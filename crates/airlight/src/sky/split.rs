//! Light of a view in two parts that vary slowly with direction, for tables that are interpolated linearly.

use super::block::SampleLight;
use super::peaked::Peaked;
use super::table::{SkyTable, TableChannels};
use super::view::View;
use crate::axes;
use crate::debug::debug_fields;
use crate::math::parallel;
use crate::transfer::residual::HalfAngle;
use glam::DVec3;

/// A view whose light is split in two parts that tables can hold: light that constituents with a peaked phase function scatter once,
/// divided by [`SplitView::phase`], and all other light.
///
/// Both vary slowly with direction, so tables of them may be coarse. Lists have one entry per wavelength of the sky's grid;
/// radiances are in W m^-2 sr^-1 nm^-1.
pub struct SplitView {
    view: View,
    table: SkyTable,
    /// Light of each part, without its phase function, where they are brightest: `[part][wavelength]`.
    brightest: Vec<f32>,
}

debug_fields! { SplitView { view } }

/// Radiance of a whole view ray: `smooth + phase peaked`.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitLight {
    /// Radiance of the ground, and path radiance other than `peaked`.
    pub smooth: Vec<f32>,
    /// Radiance scattered once by peaked constituents, divided by [`SplitView::phase`], sr times radiance.
    pub peaked: Vec<f32>,
}

/// Optical depth and path radiance from the eye to a point: `smooth + phase peaked`.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitPath {
    /// Optical depth.
    pub optical_depth: Vec<f32>,
    /// Path radiance other than `peaked`.
    pub smooth: Vec<f32>,
    /// Radiance scattered once by peaked constituents, divided by [`SplitView::phase`], sr times radiance.
    pub peaked: Vec<f32>,
}

impl View {
    /// The view with its light split for tables.
    pub fn split(&self) -> SplitView {
        SplitView::new(self)
    }
}

impl SplitView {
    fn new(view: &View) -> Self {
        let table = view.table(TableChannels::Spectral);
        let channels = table.channels();
        let mut brightest = brightest(&table);
        // Without light from there, such as at night, the first stream alone.
        for (index, value) in brightest.iter_mut().enumerate() {
            let first = table.peaked.parts[index / channels].stream == 0;
            *value = value.max(if first { f32::MIN_POSITIVE } else { 0.0 });
        }
        Self {
            view: view.clone(),
            table,
            brightest,
        }
    }

    /// The view.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The light of the view without its split, as [`View::table`] with its wavelengths.
    pub fn table(&self) -> &SkyTable {
        &self.table
    }

    fn peaked(&self) -> &Peaked {
        &self.table.peaked
    }

    /// True if a constituent has a peaked phase function.
    pub fn has_peaked_light(&self) -> bool {
        !self.peaked().parts.is_empty()
    }

    /// Phase function of the peaked constituents together at the cosine of an angle, 1/sr: the mean by their light in that direction at the
    /// azimuth of the sun in which they are brightest. It includes what further scattering by small angles makes of it there.
    pub fn phase(&self, cos_angle: f64) -> Vec<f32> {
        /// A floor, as the mean can be 0 between bows.
        const SMALLEST: f32 = 1e-4;
        let channels = self.table.channels();
        let factors = self.peaked().factors(HalfAngle::of_cosine(cos_angle));
        let (mut light, mut whole) = (vec![0.0f32; channels], vec![0.0f32; channels]);
        for (index, value) in self.brightest.iter().enumerate() {
            light[index % channels] += factors.get(index / channels, index % channels) * value;
            if self.peaked().parts[index / channels].stream == 0 {
                whole[index % channels] += value;
            }
        }
        let mean = light.iter().zip(&whole).map(|(light, whole)| light / whole);
        match self.has_peaked_light() {
            true => mean.map(|phase| phase.max(SMALLEST)).collect(),
            false => vec![1.0; channels],
        }
    }

    /// Radiance along the unit vector `direction`, without the sun's disc.
    pub fn radiance(&self, direction: DVec3) -> SplitLight {
        let channels = self.table.channels();
        let values = self.table.parts(direction);
        let (smooth, peaked) = values.split_at(channels);
        SplitLight {
            smooth: smooth.iter().map(|v| v.max(0.0)).collect(),
            peaked: self.without_phase(direction, peaked),
        }
    }

    /// [`SplitView::radiance`] along many directions, on all threads.
    pub fn radiances(&self, directions: &[DVec3]) -> Vec<SplitLight> {
        parallel::map(directions.len(), |k| self.radiance(directions[k]))
    }

    /// Air between the eye and each of the increasing distances `distances_m` along unit vectors of one elevation, `[direction][distance]`;
    /// what is beyond the end of a ray counts as its end. Places along the rays are computed once for all of them.
    pub fn paths(&self, directions: &[DVec3], distances_m: &[f64]) -> Vec<Vec<SplitPath>> {
        let peaked = self.peaked();
        let channels = self.table.channels();
        let solar = self.view.solar_irradiance();
        let lit = |values: &[f32]| -> Vec<f32> {
            values.iter().zip(&solar).map(|(v, e)| v * e).collect()
        };
        let used = 0..channels;
        let rays = self
            .view
            .samples_along_rays(directions, distances_m, &peaked.parts, &used);
        let along = |(direction, samples): (&DVec3, Vec<SampleLight>)| {
            let cos_angle = direction.dot(self.view.sun());
            let phases = peaked.phases(HalfAngle::of_cosine(cos_angle));
            let converted = samples.into_iter().take(distances_m.len()).map(|sample| {
                let mut parts = Vec::new();
                for (part, values) in peaked.parts.iter().zip(&sample.path[1..]) {
                    let without = lit(values).into_iter().enumerate();
                    parts.extend(without.map(|(channel, value)| {
                        let phase = phases.get(part.peaked, channel);
                        value / phase.max(f32::MIN_POSITIVE)
                    }));
                }
                SplitPath {
                    smooth: lit(&sample.path[0]),
                    peaked: self.without_phase(*direction, &parts),
                    optical_depth: sample.depth,
                }
            });
            converted.collect()
        };
        directions.iter().zip(rays).map(along).collect()
    }

    /// [`SplitView::paths`] of many rows of directions, each with its own distances, on all threads.
    pub fn many_paths(&self, rows: &[(Vec<DVec3>, Vec<f64>)]) -> Vec<Vec<Vec<SplitPath>>> {
        parallel::map(rows.len(), |k| self.paths(&rows[k].0, &rows[k].1))
    }

    /// Light of all parts at once, divided by [`SplitView::phase`], of the light of each part without its phase function.
    fn without_phase(&self, direction: DVec3, parts: &[f32]) -> Vec<f32> {
        let channels = self.table.channels();
        let cos_angle = direction.dot(self.view.sun());
        let factors = self.peaked().factors(HalfAngle::of_cosine(cos_angle));
        let mut light = vec![0.0f32; channels];
        for (index, value) in parts.iter().enumerate() {
            light[index % channels] += factors.get(index / channels, index % channels) * value;
        }
        let phase = self.phase(cos_angle);
        let divided = light.iter().zip(&phase).map(|(l, p)| (l / p).max(0.0));
        divided.collect()
    }
}

/// Light of each part, without its phase function, in that direction at the azimuth of the sun in which the parts together are brightest:
/// beside the sun, but above a layer of haze where rays pass through it.
fn brightest(table: &SkyTable) -> Vec<f32> {
    /// Elevations that are tried on each side of the horizon.
    const ELEVATIONS: usize = 64;
    let channels = table.channels();
    let (of, sun) = (table.coordinates(), table.sun);
    let beside_horizon = |is_below| {
        let place = |k: usize| k as f64 / (ELEVATIONS - 1) as f64;
        (0..ELEVATIONS).map(move |k| of.elevation_rad(place(k), is_below))
    };
    let elevations_rad = beside_horizon(false)
        .chain(beside_horizon(true))
        .chain([axes::elevation_rad(sun)]);
    let lights = elevations_rad.map(|elevation_rad| {
        let direction = table.sun_azimuth * elevation_rad.cos() + DVec3::Y * elevation_rad.sin();
        let light = table.parts(direction)[channels..].to_vec();
        let factors = table
            .peaked
            .factors(HalfAngle::of_cosine(direction.dot(sun)));
        let scattered = light.iter().enumerate();
        let scattered =
            scattered.map(|(index, light)| factors.get(index / channels, index % channels) * light);
        (scattered.sum::<f32>(), light)
    });
    let none = (0.0, vec![0.0; channels * table.peaked.parts.len()]);
    let brighter = |a: (f32, Vec<f32>), b: (f32, Vec<f32>)| if b.0 > a.0 { b } else { a };
    lights.fold(none, brighter).1
}

#[cfg(test)]
mod tests {
    use crate::atmosphere::Preset;
    use crate::axes;
    use crate::sky::{Sky, SkySettings, SunCoverage};
    use crate::spectrum::WavelengthGrid;

    /// The documented sums, against the march along each ray.
    #[test]
    fn parts_sum_to_the_light_of_the_view() {
        let grid = WavelengthGrid::from_wavelengths_nm(vec![445.0, 525.0, 640.0]).unwrap();
        let settings = SkySettings {
            suns: SunCoverage::near(12.0, 0.0),
            altitudes: 12,
            ..Default::default()
        };
        let sky = Sky::prepare(&Preset::Hazy.atmosphere(), &grid, &settings).unwrap();
        let view = sky.view(500.0, axes::direction(180.0, 12.0));
        let split = view.split();
        for (azimuth, elevation) in [(182.0, 11.0), (60.0, 1.0), (0.0, 50.0), (170.0, -3.0)] {
            let direction = axes::direction(azimuth, elevation);
            let phase = split.phase(direction.dot(view.sun()));
            let whole = split.radiance(direction);
            let right = view.along(direction, None).radiance();
            let beside = axes::direction(azimuth + 100.0, elevation);
            let near = &split.paths(&[beside, direction], &[3e3])[1][0];
            let right_near = view.along(direction, Some(3e3));
            for k in 0..3 {
                let sum = whole.smooth[k] + phase[k] * whole.peaked[k];
                assert!((sum / right[k] - 1.0).abs() < 3e-3, "{azimuth} {elevation}");
                let sum = near.smooth[k] + phase[k] * near.peaked[k];
                let path = right_near.path_radiance()[k];
                assert!((sum / path - 1.0).abs() < 3e-3, "{sum} {path}");
                let depth = -right_near.transmittance[k].ln();
                assert!((near.optical_depth[k] - depth).abs() < 1e-4);
            }
        }
    }
}
