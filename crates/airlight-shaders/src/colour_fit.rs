//! [`ColourFit`]: colours from the four wavelengths of sky tables.

use crate::wavelengths::{WAVELENGTHS_NM, wavelength_grid};
use airlight::atmosphere::Atmosphere;
use airlight::axes;
use airlight::glam::DVec3;
use airlight::sky::{
    Directions, OrderSettings, RowRay, Sky, SkyError, SkySettings, SunCoverage, View,
};
use airlight::spectrum::{RgbSpace, WavelengthGrid, difference, rgb};
use std::f64::consts::{FRAC_PI_2, PI};

/// What fits the weights from four wavelengths to colours for each height of the eye and sun.
///
/// The spectra to fit are those of the view at its four wavelengths, filled in by a coarse solution at four wavelengths and at sixteen.
/// The ratio of the two is smooth in wavelength, even where absorption bands, the ground or a low sun make the spectra steep.
#[derive(Clone, Debug)]
pub struct ColourFit {
    few: Sky,
    many: Sky,
}

/// Weights from light at the four wavelengths to XYZ, by wavelength.
pub(crate) struct XyzWeights {
    /// cd/m^2 for a radiance equal to the solar irradiance.
    pub radiance: [[f64; 3]; 4],
    /// Sunlight behind a transmittance, cd/m^2 for a radiance equal to the solar irradiance.
    pub sunlight: [[f64; 3]; 4],
    /// The sun's disc behind its air, cd/m^2 for a radiance equal to the solar irradiance.
    pub disc: [[f64; 3]; 4],
}

/// Azimuths from the sun of the directions of the fit, in half turns.
const AZIMUTHS: [f64; 5] = [0.05, 0.2, 0.45, 0.7, 1.0];
/// Elevations above and below the horizon, as parts of the way to the zenith or the limb, and to the nadir.
const ABOVE: [f64; 6] = [0.008, 0.03, 0.1, 0.3, 0.6, 0.95];
const BELOW: [f64; 4] = [-0.01, -0.05, -0.2, -0.7];
/// Lengths of the view rays, m: those of aerial perspective, and whole ones.
const LENGTHS_M: [f64; 2] = [3e4, f64::INFINITY];
/// Wavelengths between which the ratio to the coarse solution is interpolated, nm; it is constant beyond.
const RATIO_RANGE_NM: [f64; 2] = [390.0, 730.0];
/// Heights on the sun's disc, as parts of what is above the horizon.
const DISC_PARTS: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];
/// Weights of sunlight without air among light, transmittances (where it is exact), and the light of the disc. Light counts more, so
/// that sunlight decides only where the rest is dark.
const NO_AIR: [f64; 3] = [1e-3, 1e4, 1e-6];
/// Relative error of table values, independent of each other, that weights must not blow up.
const TABLE_ERROR: f64 = 1e-3;

/// Orders of scattering of the coarse solution in air so thick that it would not soon converge.
const ORDERS_IN_THICK_AIR: usize = 5;

/// Settings of the coarse solution, whose spectra are right while its light is not.
fn coarse(suns: SunCoverage, only_orders: Option<usize>) -> SkySettings {
    let directions = Directions {
        zenith_nodes: [4, 4, 4],
        azimuths: 5,
        panel_nodes: 2,
    };
    SkySettings {
        suns,
        altitudes: 10,
        polarisation_correction: false,
        orders: OrderSettings {
            degree: 4,
            peak_degree: 4,
            rescattered_degree: 4,
            first: directions.clone(),
            later: directions,
            tolerance: 0.02,
            max_iterations: 20,
            only_orders,
        },
        ..SkySettings::default()
    }
}

impl ColourFit {
    /// The fit of an atmosphere, prepared for the suns and eyes of the sky that it is used with.
    ///
    /// # Errors
    /// [`SkyError`] for an atmosphere that cannot be solved.
    pub fn new(atmosphere: &Atmosphere, suns: SunCoverage) -> Result<Self, SkyError> {
        let prepared = |only_orders| -> Result<Self, SkyError> {
            let settings = coarse(suns, only_orders);
            Ok(Self {
                few: Sky::prepare(atmosphere, &wavelength_grid(), &settings)?,
                many: Sky::prepare(atmosphere, &WavelengthGrid::standard(), &settings)?,
            })
        };
        match prepared(None) {
            Err(SkyError::NotConverged { .. }) => prepared(Some(ORDERS_IN_THICK_AIR)),
            result => result,
        }
    }

    /// Illuminance of a surface that faces the sun by its disc, dimmed by the air, in a colour space, lx.
    ///
    /// # Errors
    /// [`SkyError`] for a view that the fit is not prepared for and cannot be solved for.
    pub fn sun_illuminance_lx(&self, view: &View, space: RgbSpace) -> Result<[f64; 3], SkyError> {
        let many = under_source_of(&self.many, view)?;
        let xyz = self.many.grid().to_xyz(&many.sun_irradiance());
        Ok(rgb::apply(&space.from_xyz_matrix(), xyz))
    }

    /// The weights of a view: least squares over the light of its rays and of the air in front of points nearby, and their transmittances.
    pub(crate) fn xyz_weights(&self, view: &View) -> Result<XyzWeights, SkyError> {
        let few = under_source_of(&self.few, view)?;
        let many = under_source_of(&self.many, view)?;
        let grid = self.many.grid();
        let solar = many.solar_irradiance();
        let lit = |response: &mut dyn Iterator<Item = f64>| {
            let light = response
                .zip(&solar)
                .map(|(r, e)| (r * f64::from(*e)) as f32);
            grid.to_xyz(&light.collect::<Vec<_>>())
        };
        let mut samples = Vec::new();
        let mut dimmed = Vec::new();
        for row in rows(view) {
            let rays = [view, &few, &many].map(|view| view.along_row(&row, &LENGTHS_M));
            for index in 0..row.len() {
                let [all, few_ray, many_ray] =
                    [&rays[0], &rays[1], &rays[2]].map(|row| &row[index]);
                for (all, many) in all.paths.iter().zip(&many_ray.paths) {
                    let [all, many] = [all, many].map(|path| {
                        let values = path.transmittance.iter();
                        values.map(|t| f64::from(*t)).collect::<Vec<_>>()
                    });
                    dimmed.push((four(&all), lit(&mut many.into_iter())));
                }
                let light =
                    |ray: &RowRay| [ray.paths[0].path_radiance.clone(), ray.radiance.clone()];
                let [all, few_light, many_light] = [all, few_ray, many_ray].map(light);
                for k in 0..LENGTHS_M.len() {
                    let all = response(view, &all[k]);
                    let few = response(&few, &few_light[k]);
                    let many = response(&many, &many_light[k]);
                    samples.push((four(&all), lit(&mut filled(&all, &few, &many, grid))));
                }
            }
        }
        let sun = view.sun();
        let across = sun.cross(DVec3::Y).normalize_or(DVec3::X);
        let radius_rad = view.disc().angular_radius_rad;
        let up = across.cross(sun) * radius_rad;
        let above_horizon_rad = axes::elevation_rad(sun) - view.horizon_elevation_rad();
        let lowest = (-above_horizon_rad / radius_rad).clamp(-1.0, 1.0);
        let disc = DISC_PARTS.map(|part| {
            let height = lowest + (1.0 - lowest) * part;
            let direction = (sun + up * height).normalize();
            let [few, many] = [view, &many].map(|view| {
                let transmittance = view.transmittance_to_space(direction).into_iter();
                transmittance.map(f64::from).collect::<Vec<_>>()
            });
            (four(&few), lit(&mut many.into_iter()))
        });
        let sunlight = ([1.0; 4], grid.to_xyz(&solar));
        let fit = |samples: &[Sample], weight| fitted(samples, (sunlight, weight));
        Ok(XyzWeights {
            radiance: fit(&samples, NO_AIR[0]),
            sunlight: fit(&dimmed, NO_AIR[1]),
            disc: fit(&disc, NO_AIR[2]),
        })
    }
}

/// The view of another sky at the same place under the same source.
fn under_source_of(sky: &Sky, view: &View) -> Result<View, SkyError> {
    let altitude_m = view.radius_m() - sky.atmosphere().planet.radius_m;
    sky.try_view(altitude_m, *view.source())
}

fn four(values: &[f64]) -> [f64; 4] {
    std::array::from_fn(|k| values[k])
}

/// Radiance per solar irradiance.
fn response(view: &View, radiance: &[f32]) -> Vec<f64> {
    let solar = view.solar_irradiance();
    let ratio = |(l, e): (&f32, &f32)| f64::from(*l) / f64::from(*e).max(f64::MIN_POSITIVE);
    radiance.iter().zip(&solar).map(ratio).collect()
}

/// Light at many wavelengths from the same at four, and from similar light at four and at many; dark where either is.
fn filled<'a>(
    light: &[f64],
    few: &[f64],
    many: &'a [f64],
    grid: &'a WavelengthGrid,
) -> impl Iterator<Item = f64> + 'a {
    let is_lit = light.iter().chain(few).all(|v| *v > 0.0);
    let ratio: [f64; 4] = std::array::from_fn(|k| match is_lit {
        true => (light[k] / few[k]).ln(),
        false => f64::NEG_INFINITY,
    });
    let nodes = grid.wavelengths_nm().iter();
    nodes.zip(many).map(move |(nm, v)| match is_lit {
        true => v * interpolated(ratio, *nm).exp(),
        false => 0.0,
    })
}

/// Cubic polynomial in the logarithm of the wavelength through values at the four wavelengths.
fn interpolated(values: [f64; 4], nm: f64) -> f64 {
    let x = nm.clamp(RATIO_RANGE_NM[0], RATIO_RANGE_NM[1]).ln();
    let nodes = WAVELENGTHS_NM.map(f64::ln);
    let term = |k: usize| {
        let others = (0..4).filter(|&j| j != k);
        let factors = others.map(|j| (x - nodes[j]) / (nodes[k] - nodes[j]));
        values[k] * factors.product::<f64>()
    };
    (0..4).map(term).sum()
}

/// Directions over the part of a view in which there is air, by elevation.
fn rows(view: &View) -> impl Iterator<Item = [DVec3; AZIMUTHS.len()]> {
    let coordinates = view.table_coordinates();
    let (horizon, highest) = (coordinates.horizon_rad, coordinates.highest_rad);
    let sun = view.sun();
    let towards = DVec3::new(sun.x, 0.0, sun.z).normalize_or(DVec3::X);
    let across = DVec3::new(-towards.z, 0.0, towards.x);
    ABOVE.into_iter().chain(BELOW).map(move |part| {
        let end = if part > 0.0 { highest } else { -FRAC_PI_2 };
        let elevation = horizon + (end - horizon) * part.abs();
        AZIMUTHS.map(|azimuth| {
            let (sin, cos) = (PI * azimuth).sin_cos();
            let level = towards * cos + across * sin;
            level * elevation.cos() + DVec3::Y * elevation.sin()
        })
    })
}

/// Response at the four wavelengths, and XYZ.
type Sample = ([f64; 4], [f64; 3]);

/// Weights from responses to XYZ by least squares, in which errors of samples count as in CIELAB, where the brightest is white; and one
/// more sample with a weight, relative to that of white.
fn fitted(samples: &[Sample], (more, weight): (Sample, f64)) -> [[f64; 3]; 4] {
    /// Value relative to white below which CIELAB is linear.
    const LINEAR: f64 = 0.008_856;
    let brightest = samples.iter().map(|(_, xyz)| xyz[1]).fold(0.0, f64::max);
    let mut weights = [[0.0; 3]; 4];
    for c in 0..3 {
        let mut fit = LeastSquares::default();
        if brightest > 0.0 {
            let white = 0.01 * difference::D65_WHITE[c] * brightest;
            for (response, xyz) in samples {
                let lightness_slope = (xyz[c] / white).max(LINEAR).powf(-2.0 / 3.0);
                fit.add(*response, xyz[c], (lightness_slope / white).powi(2));
            }
        }
        fit.add(more.0, more.1[c], weight / more.1[1].powi(2));
        for (weight, value) in weights.iter_mut().zip(fit.solved()) {
            weight[c] = value;
        }
    }
    weights
}

/// Linear least squares: a value of a response at four wavelengths.
#[derive(Default)]
struct LeastSquares {
    normal: [[f64; 4]; 4],
    right: [f64; 4],
}

impl LeastSquares {
    /// Adds a value whose squared error has a weight.
    fn add(&mut self, response: [f64; 4], value: f64, weight: f64) {
        for i in 0..4 {
            for j in 0..4 {
                self.normal[i][j] += weight * response[i] * response[j];
            }
            self.normal[i][i] += weight * (TABLE_ERROR * response[i]).powi(2);
            self.right[i] += weight * response[i] * value;
        }
    }

    /// The solution, by elimination with pivots.
    fn solved(self) -> [f64; 4] {
        let (mut a, mut b) = (self.normal, self.right);
        for k in 0..4 {
            let pivot = (k..4).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()));
            let pivot = pivot.unwrap_or(k);
            a.swap(k, pivot);
            b.swap(k, pivot);
            for i in 0..4 {
                if i != k && a[k][k] != 0.0 {
                    let factor = a[i][k] / a[k][k];
                    for j in 0..4 {
                        a[i][j] -= factor * a[k][j];
                    }
                    b[i] -= factor * b[k];
                }
            }
        }
        std::array::from_fn(|k| match a[k][k] == 0.0 {
            true => 0.0,
            false => b[k] / a[k][k],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Named;
    use airlight::atmosphere::Preset;

    /// The colours of the spectra that are fitted, against the solver at sixteen wavelengths.
    #[test]
    fn filled_spectra_have_the_colours_of_the_solver() {
        let grid = WavelengthGrid::standard();
        for (air, sun_deg) in [
            (Preset::Clear, 40.0),
            (Preset::Hazy, 1.0),
            (Preset::Hazy, -4.0),
        ] {
            let suns = SunCoverage::near(sun_deg, 500.0);
            let fit = ColourFit::new(&air.atmosphere(), suns).unwrap();
            let settings = SkySettings {
                suns,
                ..Default::default()
            };
            let [view, right] = [wavelength_grid(), grid.clone()].map(|grid| {
                let sky = Sky::prepare(&air.atmosphere(), &grid, &settings).unwrap();
                sky.view(500.0, axes::direction(180.0, sun_deg))
            });
            let [few, many] = [&fit.few, &fit.many].map(|sky| under_source_of(sky, &view).unwrap());
            let along = |direction| {
                [&view, &few, &many, &right]
                    .map(|view| response(view, &view.along(direction, None).radiance()))
            };
            let all: Vec<[Vec<f64>; 4]> = rows(&view).flatten().map(along).collect();
            let solar = right.solar_irradiance();
            let xyz = |response: &mut dyn Iterator<Item = f64>| {
                let light = response.zip(&solar).map(|(r, e)| r as f32 * e);
                grid.to_xyz(&light.collect::<Vec<_>>())
            };
            let pairs = all.iter().map(|[light, few, many, right]| {
                let got = xyz(&mut filled(light, few, many, &grid));
                (got, xyz(&mut right.iter().copied()))
            });
            let pairs: Vec<_> = pairs.collect();
            let brightest = pairs.iter().map(|(_, right)| right[1]).fold(0.0, f64::max);
            let lab = |xyz: [f64; 3]| {
                difference::xyz_to_lab(xyz.map(|v| 100.0 * v / brightest), difference::D65_WHITE)
            };
            let differences = pairs
                .iter()
                .map(|(got, right)| difference::ciede2000(lab(*got), lab(*right)));
            let worst = differences.fold(0.0, f64::max);
            println!("{air:?} {sun_deg}: CIEDE2000 {worst:.3}");
            assert!(worst < 0.5);
        }
    }

    /// Also in air so thick that the coarse solution does not converge.
    #[test]
    #[ignore = "solves for thick airs: a minute"]
    fn every_atmosphere_has_a_fit() {
        for &air in Preset::ALL {
            let fit = ColourFit::new(&air.atmosphere(), SunCoverage::near(30.0, 0.0));
            assert!(fit.is_ok(), "{air:?}: {:?}", fit.err());
        }
    }
}
