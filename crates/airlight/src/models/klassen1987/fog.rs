//! Naturally lit fog of Klassen 1987: a slab of uniform fog below clear air, over flat ground.
//!
//! Klassen, "Modeling the effect of the atmosphere on light", ACM Trans. Graph. 6(3), 1987, sections 9 to 12, eqs. 34 to
//! 47, with the corrections listed in the book: the path of sunlight through the fog follows eqs. 37 and 38 everywhere, and
//! the sign in eq. 47 is minus. The error of flat ground is below 1 % for a sun at least 15 degrees high (the paper's
//! figure).

use crate::atmosphere::{Constituent, RaySegment};
use crate::fog::{Lanes, LayerLanes, constant_source, mean_attenuated_source};
use crate::spectrum::Spectrum;
use crate::transfer::{PathOptics, RgbPathOptics};

/// Depth of fog through which sunlight passes before it is scattered into the view ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SunDepth {
    /// The whole depth of the fog at every point (eq. 35); accurate for rays near the ground.
    Printed,
    /// The depth below the top at each point of the ray.
    #[default]
    Exact,
}

/// Slab of fog below clear air: heights above the ground, coefficients and sunlight.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slab1987<const N: usize> {
    /// Height of the fog's top, `R_H - R_E`, m.
    pub fog_top_m: f64,
    /// Height of the top of an atmosphere with constant density, `R_A - R_E`, m (8.4 km).
    pub air_top_m: f64,
    /// Droplets (`beta_p`).
    pub(super) fog: LayerLanes<N>,
    /// Molecules at the ground's density (`beta_m`).
    pub(super) air: LayerLanes<N>,
    /// Solar irradiance outside the atmosphere on a surface that faces the sun, `I_0`.
    pub sun_irradiance: Spectrum<N>,
    /// Sine of the sun's elevation `phi`, above 0.
    pub sin_sun: f64,
}

impl<const N: usize> Slab1987<N> {
    /// `B = beta_m + beta_p` (eq. 43), 1/m.
    pub fn extinction_per_m(&self) -> Spectrum<N> {
        self.air.extinction_per_m + self.fog.extinction_per_m
    }

    /// Irradiance at the top of the fog on a surface that faces the sun, `I_t`: `I_0` attenuated along `d_1` (eq. 37).
    pub fn irradiance_at_top(&self) -> Spectrum<N> {
        let d1 = (self.air_top_m - self.fog_top_m) / self.sin_sun;
        self.sun_irradiance * (self.air.extinction_per_m * d1 as f32).exp_neg()
    }

    /// Irradiance at a height in the fog on a surface that faces the sun: attenuated along `d_1` and `d_2` (eqs. 34, 36, 38).
    pub fn irradiance_at(&self, height_m: f64) -> Spectrum<N> {
        let d2 = (self.fog_top_m - height_m).max(0.0) / self.sin_sun;
        self.irradiance_at_top() * (self.extinction_per_m() * d2 as f32).exp_neg()
    }

    /// Fog and air between a point at `eye_height_m`, in the fog or at its top, and an object `length_m` away. The transmittance
    /// attenuates the object component (eq. 40); the path radiance is the fog component (eqs. 41 to 46).
    ///
    /// `sin_elevation` is the sine of the ray's elevation, `cos_sun` the cosine of the angle between the ray and the direction to
    /// the sun. The length of a ray that leaves the fog at the top must end there.
    pub fn in_fog(
        &self,
        eye_height_m: f64,
        sin_elevation: f64,
        length_m: f64,
        cos_sun: f64,
        depth: SunDepth,
    ) -> PathOptics<N> {
        let extinction = self.extinction_per_m();
        let along = extinction * length_m as f32;
        let to_sun_m = |height_m: f64| match depth {
            SunDepth::Printed => self.fog_top_m / self.sin_sun,
            SunDepth::Exact => (self.fog_top_m - height_m).max(0.0) / self.sin_sun,
        };
        let near_m = to_sun_m(eye_height_m);
        let far_m = to_sun_m(eye_height_m + sin_elevation * length_m) + length_m;
        // Per metre, as extinction may be 0.
        let arriving =
            mean_attenuated_source(extinction * near_m as f32, extinction * far_m as f32);
        let scattered = self.scattered(cos_sun) * length_m as f32;
        PathOptics {
            transmittance: along.exp_neg(),
            path_radiance: self.irradiance_at_top() * scattered * arriving,
        }
    }

    /// The same with the sun at the horizon: there is no direct light, and multiply scattered light has the radiance `colour`
    /// in all directions (section 11.2).
    pub fn in_fog_at_sunset(&self, length_m: f64, colour: Spectrum<N>) -> PathOptics<N> {
        constant_source(self.extinction_per_m() * length_m as f32, colour)
    }

    /// Clear air, at the density of the ground, between an eye above the fog and the point where the ray enters the fog.
    pub fn air_above(&self, length_m: f64, cos_sun: f64) -> PathOptics<N> {
        let along = self.air.extinction_per_m * length_m as f32;
        let scattered = self.air.scattering_per_m * self.air.phase_lanes(cos_sun) * length_m as f32;
        PathOptics {
            transmittance: along.exp_neg(),
            path_radiance: self.irradiance_at_top() * scattered * along.mean_transmittance(),
        }
    }

    /// Air above the fog, then fog, between an eye at any height and an object `length_m` away.
    pub fn along(
        &self,
        eye_height_m: f64,
        sin_elevation: f64,
        length_m: f64,
        cos_sun: f64,
        depth: SunDepth,
    ) -> PathOptics<N> {
        let line = RaySegment::flat(eye_height_m, sin_elevation, length_m);
        let (enters, leaves) = line.below(self.fog_top_m);
        if enters == leaves {
            return self.air_above(length_m, cos_sun);
        }
        let fog = self.in_fog(
            line.height_at(enters),
            sin_elevation,
            leaves - enters,
            cos_sun,
            depth,
        );
        let before = self.air_above(enters, cos_sun);
        let behind = self.air_above(length_m - leaves, cos_sun);
        before.then(fog).then(behind)
    }

    /// `beta_sc(psi)`: scattering per metre and steradian towards the eye.
    fn scattered(&self, cos_sun: f64) -> Spectrum<N> {
        let part = |layer: &LayerLanes<N>| layer.scattering_per_m * layer.phase_lanes(cos_sun);
        part(&self.fog) + part(&self.air)
    }
}

/// Naturally lit fog of Klassen 1987 at three wavelengths: a slab of uniform fog below clear air, over flat ground.
#[derive(Clone, Debug)]
pub struct RgbSlab1987 {
    lanes: Slab1987<3>,
}

impl RgbSlab1987 {
    /// Fog and air at wavelengths (nm), each with the constant density of its coefficients; heights of the tops of fog and air
    /// in m, irradiance of the sun outside the atmosphere, and the sine of its elevation, which must be above 0.
    pub fn new(
        [fog, air]: [&Constituent; 2],
        [fog_top_m, air_top_m]: [f64; 2],
        sun_irradiance: [f32; 3],
        sin_sun: f64,
        wavelengths_nm: &[f64; 3],
    ) -> Self {
        Self {
            lanes: Slab1987 {
                fog_top_m,
                air_top_m,
                fog: LayerLanes::new(fog, wavelengths_nm),
                air: LayerLanes::new(air, wavelengths_nm),
                sun_irradiance: Spectrum(sun_irradiance),
                sin_sun,
            },
        }
    }

    /// Irradiance at a height (m) in the fog on a surface that faces the sun (eqs. 34, 36, 38).
    pub fn irradiance_at(&self, height_m: f64) -> [f32; 3] {
        self.lanes.irradiance_at(height_m).0
    }

    /// Path optics between an eye at a height (m) and an object `length_m` away: the air above the fog, then the fog (eqs. 39 to
    /// 46). `sin_elevation` is the sine of the ray's elevation, `cos_sun` the cosine of its angle to the direction of the sun.
    pub fn along(
        &self,
        eye_height_m: f64,
        sin_elevation: f64,
        length_m: f64,
        cos_sun: f64,
        depth: SunDepth,
    ) -> RgbPathOptics {
        self.lanes
            .along(eye_height_m, sin_elevation, length_m, cos_sun, depth)
            .into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::DensityProfile;
    use crate::math::quadrature::GaussRule;
    use crate::optics::{Depolarization, PhaseFunction};

    fn scene() -> Slab1987<3> {
        const NM: [f64; 3] = [680.0, 550.0, 440.0];
        let layer = |extinction_per_m: [f32; 3], phase| LayerLanes {
            density: DensityProfile::Uniform,
            extinction_per_m: Spectrum(extinction_per_m),
            scattering_per_m: Spectrum(extinction_per_m),
            phase,
            wavelengths_nm: NM,
        };
        Slab1987 {
            fog_top_m: 100.0,
            air_top_m: 8400.0,
            // 15 to 40 per km in the paper.
            fog: layer(
                [0.020, 0.021, 0.022],
                PhaseFunction::HenyeyGreenstein { g: 0.8 },
            ),
            air: layer(
                [5.8e-6, 13.5e-6, 33.1e-6],
                PhaseFunction::Rayleigh(Depolarization::None),
            ),
            sun_irradiance: Spectrum([1.5, 1.8, 1.9]),
            sin_sun: 0.6,
        }
    }

    #[test]
    fn the_fog_component_is_the_integral_of_equation_12() {
        let scene = scene();
        let (eye, sin_elevation, length, cos_sun) = (60.0, -0.3, 180.0, 0.4);
        for depth in [SunDepth::Printed, SunDepth::Exact] {
            let got = scene.in_fog(eye, sin_elevation, length, cos_sun, depth);
            for lane in 0..3 {
                let fog = f64::from(scene.fog.extinction_per_m[lane]);
                let air = f64::from(scene.air.extinction_per_m[lane]);
                let phase = fog * scene.fog.phase.evaluate(cos_sun, 550.0)
                    + air * scene.air.phase.evaluate(cos_sun, 550.0);
                let integral =
                    GaussRule::new(24).integrate_between(0.0, length, &[30.0, 90.0], |d3| {
                        let d1 = (8400.0 - 100.0) / 0.6;
                        let d2 = match depth {
                            SunDepth::Printed => 100.0 / 0.6,
                            SunDepth::Exact => (100.0 - (eye + sin_elevation * d3)) / 0.6,
                        };
                        (-air * d1 - (d2 + d3) * (air + fog)).exp()
                    });
                let exact = f64::from(scene.sun_irradiance[lane]) * phase * integral;
                let path = f64::from(got.path_radiance[lane]);
                assert!(
                    (path / exact - 1.0).abs() < 1e-5,
                    "{depth:?} {lane}: {path} {exact}"
                );
            }
        }
    }

    #[test]
    fn the_printed_depth_is_accurate_near_the_ground_only() {
        let scene = scene();
        let ratio = |eye: f64| {
            // A level ray at eye height.
            let of = |depth| scene.in_fog(eye, 0.0, 150.0, 0.4, depth).path_radiance[1];
            of(SunDepth::Printed) / of(SunDepth::Exact)
        };
        assert!((ratio(2.0) - 1.0).abs() < 0.08, "{}", ratio(2.0));
        assert!(ratio(80.0) < 0.1, "{}", ratio(80.0));
    }

    #[test]
    fn rays_from_above_cross_air_and_then_fog() {
        let scene = scene();
        let whole = scene.along(300.0, -0.5, 600.0, 0.2, SunDepth::Exact);
        let parts = scene.air_above(400.0, 0.2).then(scene.in_fog(
            100.0,
            -0.5,
            200.0,
            0.2,
            SunDepth::Exact,
        ));
        assert_eq!(whole, parts);
        // Splitting the ray inside the fog does not change the result.
        for cut in [420.0, 500.0, 599.0] {
            let near = scene.along(300.0, -0.5, cut, 0.2, SunDepth::Exact);
            let far = scene.along(300.0 - 0.5 * cut, -0.5, 600.0 - cut, 0.2, SunDepth::Exact);
            for (a, b) in [
                (near.then(far).path_radiance, whole.path_radiance),
                (near.then(far).transmittance, whole.transmittance),
            ] {
                assert!((a - b).map(f32::abs).max_element() < 1e-5 * b.max_element());
            }
        }
        assert_eq!(
            scene.along(300.0, 0.1, 1e3, 0.2, SunDepth::Exact),
            scene.air_above(1e3, 0.2)
        );
    }

    #[test]
    fn light_on_objects_is_attenuated_by_air_and_fog() {
        let scene = scene();
        let ground = scene.irradiance_at(0.0)[1];
        let exact = 1.8 * f64::exp(-13.5e-6 * 8400.0 / 0.6 - 0.021 * 100.0 / 0.6);
        assert!((f64::from(ground) / exact - 1.0).abs() < 1e-5);
        assert_eq!(scene.irradiance_at(100.0), scene.irradiance_at_top());
        let ambient = Spectrum([0.1; 3]);
        let far = scene.in_fog_at_sunset(1e6, ambient);
        assert!((far.path_radiance - ambient).map(f32::abs).max_element() < 1e-7);
    }
}
