//! Fog of random layers.

use super::draw::Draw;
use super::{Failure, equal, light, transmittance};
use airlight::atmosphere::{Constituent, ConstituentKind, DensityProfile};
use airlight::fog::{
    DirectionalLight, FogLighting, FogPatches, FogScattering, Ground, PatchField, PatchView,
    RaySegment, RgbFog, legacy,
};
use airlight::models::klassen1987::{RgbSlab1987, SunDepth};
use airlight::spectrum::SpectralCurve;
use airlight::transfer::RgbPathOptics;
use glam::DVec3;

/// Rays looked at in one fog.
const RAYS: usize = 40;

fn lighting(draw: &mut Draw) -> FogLighting<[f32; 3]> {
    let sun = draw.chance(0.8).then(|| DirectionalLight {
        direction: {
            let up = draw.direction();
            DVec3::new(up.x, up.y.abs(), up.z)
        },
        irradiance: [1.0, 0.8, 0.5],
    });
    FogLighting {
        sun,
        ambient: draw.pick(&[[0.0; 3], [0.1, 0.2, 0.3]]),
        ground_albedo: draw.pick(&[[0.0; 3], [0.2; 3], [1.0; 3]]),
    }
}

fn optics(path: &RgbPathOptics) -> Result<(), Failure> {
    transmittance(&path.transmittance)?;
    light("path radiance", &path.path_radiance)
}

/// The segment from the far end to the near one.
fn reversed(ray: &RaySegment) -> RaySegment {
    RaySegment {
        height_m: ray.end_height_m(),
        sin_elevation: -(ray.sin_elevation + 2.0 * ray.length_m * ray.curvature_per_m),
        ..*ray
    }
}

/// Single scattering, attenuated or not: closed forms.
pub fn single_scattering(draw: &mut Draw) -> Result<(), Failure> {
    let layers = draw.layers(2);
    let ground = draw.ground();
    let lighting = lighting(draw);
    let scattering = draw.pick(&[FogScattering::Single, FogScattering::Undimmed]);
    let fog = RgbFog::new(&layers, ground, &lighting, scattering).map_err(|e| e.to_string())?;
    let exact = layers.len() == 1 && ground == Ground::FLAT;
    for _ in 0..RAYS {
        let (height_m, direction) = (draw.height_m(), draw.direction());
        let length_m = match draw.chance(0.1) {
            true => f64::INFINITY,
            false => draw.length_m(),
        };
        let ray = RaySegment::new(height_m, direction.y, length_m, ground.radius_m);
        let cos_sun = lighting.sun.map_or(0.0, |sun| sun.direction.dot(direction));
        let whole = fog.path_along(&ray, cos_sun);
        let at = draw.unit() * length_m.min(1e5);
        let checked = || {
            optics(&whole)?;
            light("optical depth", &fog.optical_depth(&ray))?;
            let parts = [ray.part(0.0, at), ray.part(at, length_m)];
            let [near, far] = parts.map(|part| fog.path_along(&part, cos_sun));
            optics(&near)?;
            optics(&far)?;
            let joined = near.then(far);
            // Of an optical depth in single precision.
            let depth = fog.optical_depth(&ray).into_iter().fold(0.0, f32::max);
            let rounding = 1e-4 + 1e-6 * depth;
            equal(
                "transmittance of parts",
                &joined.transmittance,
                &whole.transmittance,
                rounding,
                1e-30,
            )?;
            if exact {
                equal(
                    "path radiance of parts",
                    &joined.path_radiance,
                    &whole.path_radiance,
                    rounding,
                    1e-12,
                )?;
            }
            if length_m.is_finite() {
                // That of the ray, or of rays that are higher or lower by the rounding of heights: a level ray at the edge of a
                // layer is in it or not.
                let step_m = 1e-9 * (1.0 + height_m.abs() + ray.end_height_m().abs());
                let near = [-step_m, 0.0, step_m].map(|up_m| {
                    fog.transmittance(&RaySegment {
                        height_m: height_m + up_m,
                        ..ray
                    })
                });
                let back = fog.transmittance(&reversed(&ray));
                let within: [f32; 3] = std::array::from_fn(|lane| {
                    let lanes = near.map(|transmittance| transmittance[lane]);
                    let least = lanes.into_iter().fold(1.0, f32::min);
                    back[lane].clamp(least, lanes.into_iter().fold(0.0, f32::max))
                });
                equal("transmittance back", &back, &within, rounding, 1e-30)?;
            }
            Ok(())
        };
        checked().map_err(|failure: Failure| {
            format!("{failure}\n    {ray:?}, split at {at}, {layers:?}, {ground:?}, {lighting:?}, {scattering:?}")
        })?;
    }
    Ok(())
}

/// All orders of scattering, by the solver and by its tables: closed forms along a ray for one profile over flat ground.
pub fn multiple_scattering(draw: &mut Draw) -> Result<(), Failure> {
    /// Optical depth of a ray beyond which densities are those of a profile far below any fog.
    const DEEPEST: f32 = 1e6;
    let layers = draw.layers(1);
    let ground = draw.ground();
    let exact = layers.len() == 1 && ground == Ground::FLAT;
    let lighting = lighting(draw);
    let fog = RgbFog::new(&layers, ground, &lighting, FogScattering::Multiple)
        .map_err(|e| e.to_string())?;
    let eye_m = ground.height_m + draw.pick(&[0.0, 1.7, 30.0, 500.0]);
    let table = fog.seen_from(eye_m);
    for _ in 0..RAYS {
        let direction = draw.direction();
        let length_m = draw.length_m();
        let at = draw.unit() * length_m;
        let cos_sun = lighting.sun.map_or(0.0, |sun| sun.direction.dot(direction));
        let checked = || {
            let irradiance = fog.ground_irradiance().unwrap_or_default();
            light("irradiance", &irradiance)?;
            optics(&table.path(direction, length_m)).map_err(|f| format!("table: {f}"))?;
            let whole = fog.path(eye_m, direction, length_m);
            optics(&whole)?;
            let ray = RaySegment::new(eye_m, direction.y, length_m, ground.radius_m);
            let parts = [ray.part(0.0, at), ray.part(at, length_m)];
            let [near, far] = parts.map(|part| fog.path_along(&part, cos_sun));
            optics(&near)?;
            optics(&far)?;
            let depth = fog.optical_depth(&ray).into_iter().fold(0.0, f32::max);
            if exact && depth < DEEPEST {
                let joined = near.then(far);
                let (joined, whole) = (joined.path_radiance, whole.path_radiance);
                equal("path radiance of parts", &joined, &whole, 1e-4, 1e-9)?;
            }
            Ok(())
        };
        checked().map_err(|failure: Failure| {
            format!("{failure}\n    from {eye_m} along {direction}, {length_m} m, split at {at}, {layers:?}, {ground:?}, {lighting:?}")
        })?;
    }
    Ok(())
}

/// The fog of 1987 and the fog factors of graphics hardware.
pub fn old_models(draw: &mut Draw) -> Result<(), Failure> {
    let part = |draw: &mut Draw, per_m: f64| Constituent {
        kind: ConstituentKind::Fog,
        density: DensityProfile::Uniform,
        scattering_per_m: SpectralCurve::Constant(per_m),
        absorption_per_m: SpectralCurve::Constant(per_m * draw.pick(&[0.0, 0.3, 3.0])),
        phase: draw.phase(),
    };
    let per_m = draw.scale(1e-6, 1.0);
    let fog = part(draw, per_m);
    let per_m = draw.scale(1e-8, 1e-3);
    let air = part(draw, per_m);
    let tops_m = [draw.scale(1.0, 1e3), draw.scale(1e3, 1e4)];
    let sin_sun = draw.scale(1e-3, 1.0);
    let slab = RgbSlab1987::new(
        [&fog, &air],
        tops_m,
        [1.0; 3],
        sin_sun,
        &[600.0, 550.0, 450.0],
    );
    for _ in 0..RAYS {
        let height_m = draw.unit() * 1.2 * tops_m[0];
        let (sin_elevation, length_m) = (draw.direction().y, draw.length_m());
        let length_m = match sin_elevation < 0.0 {
            true => length_m.min(-height_m / sin_elevation),
            false => length_m,
        };
        let cos_sun = draw.between(-1.0, 1.0);
        let depth = draw.pick(&[SunDepth::Printed, SunDepth::Exact]);
        let [start_m, end_m, density] = [draw.length_m(), draw.length_m(), draw.scale(1e-6, 1.0)];
        let checked = || {
            optics(&slab.along(height_m, sin_elevation, length_m, cos_sun, depth))?;
            light("irradiance", &slab.irradiance_at(height_m))?;
            optics(&legacy::exponential_squared(density, length_m, [0.5; 3]))?;
            optics(&legacy::linear(
                start_m.min(end_m),
                end_m,
                length_m,
                [0.5; 3],
            ))
        };
        checked().map_err(|failure: Failure| {
            format!("{failure}\n    {length_m} m from {height_m}, sine {sin_elevation}, {cos_sun}, {depth:?}, {slab:?}, {start_m} {end_m} {density}")
        })?;
    }
    Ok(())
}

/// Patches, and fog of their density.
pub fn patches(draw: &mut Draw) -> Result<(), Failure> {
    let patches = FogPatches {
        strength: draw.between(0.0, 2.0),
        size_m: draw.scale(1.0, 1e3),
        height_m: draw.scale(1.0, 1e3),
        seed: draw.below(1 << 20) as u64,
        drift_m: [draw.between(-1e4, 1e4), 0.0],
    };
    let field = PatchField::new(&patches).map_err(|e| e.to_string())?;
    let density = draw.density();
    let extinction = draw.scale(1e-6, 1.0);
    let eye = DVec3::Y * draw.height_m();
    let ground = draw.ground();
    let view = PatchView::new(
        field,
        vec![(extinction, density.clone())],
        ground.radius_m,
        eye,
        draw.pick(&[2e-3, 0.02]),
    )
    .map_err(|e| e.to_string())?;
    let depth = draw.scale(1e-3, 30.0) as f32;
    let even = RgbPathOptics {
        transmittance: [(-depth).exp(), (-2.0 * depth).exp(), 1.0],
        path_radiance: [1.0 - (-depth).exp(), 0.3, 0.0],
    };
    for _ in 0..RAYS / 4 {
        let direction = draw.direction();
        let distances_m = [1e-3, 1.0, 30.0, 1e3, 1e5].map(|d| d * draw.scale(1.0, 10.0));
        let mut factors = [0.0; 5];
        view.factors(direction, &distances_m, &mut factors);
        let checked = || {
            light("factors", &factors.map(|f| f as f32))?;
            factors
                .iter()
                .try_for_each(|f| optics(&even.at_density(*f as f32)))
        };
        checked().map_err(|failure: Failure| {
            format!("{failure}\n    along {direction} to {distances_m:?}, {patches:?}, {extinction}, {density:?}, {ground:?}, {eye}, {even:?}")
        })?;
    }
    Ok(())
}
