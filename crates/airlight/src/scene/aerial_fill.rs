//! Computation of the aerial-perspective table.

use super::aerial::{AZIMUTHS, AerialPerspective, DISTANCES, Eye, Half, ROWS, part_of};
use super::error::SceneError;
use super::lane_channels::{Converter, LaneChannels};
use crate::control::{Cancelled, Control};
use crate::math::parallel;
use crate::sky::{Peaked, View};
use crate::transfer::residual::HalfAngle;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Coordinate of the first node, in steps: means are undefined at the eye itself.
const FIRST_NODE: f64 = 0.01;
/// Transmittance below which a channel counts as opaque; RGB channels of saturated light may even be negative.
const OPAQUE: f64 = 1e-6;

impl<const N: usize> AerialPerspective<N> {
    /// Tabulates the air between a view's eye and points up to `limit_m` away (m; infinite: to space), in all directions.
    /// Distances are clamped to the limit and to the ground.
    ///
    /// # Errors
    /// [`SceneError`] if N lanes cannot be these channels, for a limit that is not a positive distance, and if the caller cancelled.
    pub fn new(
        view: &View,
        channels: LaneChannels,
        limit_m: f64,
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        if limit_m.is_nan() || limit_m <= 0.0 {
            return Err(SceneError::Distance(limit_m));
        }
        let converter = Converter::new(view, channels)?;
        Ok(tabulated(view, &converter, limit_m, control)?)
    }
}

/// The table of a view, in the lanes of `converter`.
fn tabulated<const N: usize>(
    view: &View,
    converter: &Converter<N>,
    limit_m: f64,
    control: Control<'_>,
) -> Result<AerialPerspective<N>, Cancelled> {
    let peaked = Peaked::of(view, N, |spectrum| {
        converter
            .radiance(spectrum)
            .map(|value| value as f32)
            .to_vec()
    });
    let (ground_radius_m, top_radius_m) = view.bounds_m();
    let radius_m = view.radius_m();
    let horizon_elevation = view.horizon_elevation_rad();
    let eye = Eye {
        radius_m,
        ground_radius_m,
        top_radius_m,
        horizon_elevation,
        horizon_sine: horizon_elevation.sin(),
        limit_m,
    };
    // From outside the air, rays above the tangent to its top miss it.
    let ceiling = if radius_m > top_radius_m {
        -(top_radius_m / radius_m).acos()
    } else {
        FRAC_PI_2
    };
    let horizontal = DVec3::new(view.sun().x, 0.0, view.sun().z);
    let sun_azimuth = if horizontal.length() > 1e-9 {
        horizontal.normalize()
    } else {
        DVec3::X
    };
    let half = |below: bool| {
        let span = if below { -FRAC_PI_2 } else { ceiling } - eye.horizon_elevation;
        let rows = ROWS[usize::from(below)];
        let filled = parallel::try_map(rows, |row| {
            control.check()?;
            let x = row as f64 / (rows - 1) as f64;
            // Values are discontinuous at the horizon: start just beside it.
            let elevation = eye.horizon_elevation + span * (x * x).max(1e-9);
            Ok(row_of(
                view,
                converter,
                &peaked,
                &eye,
                sun_azimuth,
                (elevation, below),
            ))
        })?;
        let (extinction, source): (Vec<_>, Vec<_>) = filled.into_iter().unzip();
        Ok(Half {
            below,
            span,
            rows,
            extinction: extinction.concat(),
            source: source.concat(),
        })
    };
    Ok(AerialPerspective {
        sun: view.sun(),
        sun_azimuth,
        eye,
        above: half(false)?,
        below: half(true)?,
        peaked: peaked.into(),
    })
}

/// One row: mean extinctions by distance, and mean source functions by azimuth and distance.
fn row_of<const N: usize>(
    view: &View,
    converter: &Converter<N>,
    peaked: &Peaked,
    eye: &Eye,
    sun_azimuth: DVec3,
    (elevation, below): (f64, bool),
) -> (Vec<f32>, Vec<f32>) {
    let (sin, cos) = elevation.sin_cos();
    let (start_m, end_m) = eye.span_m(sin, below);
    let stops_m: Vec<f64> = (0..DISTANCES)
        .map(|node| {
            let x = (node as f64).max(FIRST_NODE) / (DISTANCES - 1) as f64;
            start_m + (end_m - start_m) * part_of(x)
        })
        .collect();
    let across = DVec3::Y.cross(sun_azimuth);
    let (mut extinction, mut source) = (Vec::new(), Vec::new());
    let directions: Vec<DVec3> = (0..AZIMUTHS)
        .map(|azimuth| {
            let cos_azimuth = 2.0 * azimuth as f64 / (AZIMUTHS - 1) as f64 - 1.0;
            let sin_azimuth = (1.0 - cos_azimuth * cos_azimuth).sqrt();
            DVec3::Y * sin + (sun_azimuth * cos_azimuth + across * sin_azimuth) * cos
        })
        .collect();
    let rays = view.samples_along_rays(&directions, &stops_m, &peaked.parts, &converter.used());
    for (azimuth, (direction, stops)) in directions.iter().zip(rays).enumerate() {
        let phases = peaked.phases(HalfAngle::between(*direction, view.sun()));
        for (stop, stop_m) in stops.iter().zip(&stops_m) {
            let opacity = converter.opacity(&stop.depth).map(|a| a.min(1.0 - OPAQUE));
            if azimuth == 0 {
                let length_m = stop_m - start_m;
                let mean = |a: &f64| {
                    if length_m > 0.0 {
                        (-(-a).ln_1p() / length_m) as f32
                    } else {
                        0.0
                    }
                };
                padded(&mut extinction, opacity.iter().map(mean));
            }
            for (index, part) in stop.path.iter().enumerate() {
                let path = converter.radiance(part);
                let source_of = |lane: usize| {
                    let phase = match index.checked_sub(1).map(|part| peaked.parts[part]) {
                        None => 1.0,
                        Some(part) => f64::from(phases.get(part.peaked, lane)),
                    };
                    match opacity[lane] == 0.0 {
                        true => 0.0,
                        false => (path[lane] / (phase * opacity[lane])) as f32,
                    }
                };
                padded(&mut source, (0..N).map(source_of));
            }
        }
    }
    (extinction, source)
}

/// Appends lanes, padded with zeros to whole vector loads.
fn padded(out: &mut Vec<f32>, lanes: impl Iterator<Item = f32>) {
    out.extend(lanes);
    out.resize(out.len().next_multiple_of(4), 0.0);
}
