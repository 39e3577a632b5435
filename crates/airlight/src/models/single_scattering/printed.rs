//! The shader as printed, operation by operation: 8 midpoint steps on each ray, no planet in the way.

use super::constants as c;
use super::sunlight::{Sunlight, solar_rgb};
use super::vec3::Vec3;
use crate::math::real::Real;

/// The shader with its constants evaluated.
pub struct Printed<F> {
    rayleigh: Vec3<F>,
    mie: Vec3<F>,
    ozone: Vec3<F>,
    origin_view: Vec3<F>,
    radius_size: F,
    sun_solid_angle: F,
    outer_space: Vec3<F>,
}

impl<F: Real> Printed<F> {
    /// Shader for an eye at an altitude (m) and sunlight.
    ///
    /// The zenith transmittance by which the illuminance is divided omits the factor 1.11 of haze, as printed.
    pub fn new(eye_altitude_m: f64, sunlight: Sunlight) -> Self {
        let f = F::of;
        let rayleigh = Vec3::of(c::RAYLEIGH_PER_MEGAMETRE).scaled(f(1e-6));
        let mie = Vec3::of([c::MIE_PER_MEGAMETRE; 3]).scaled(f(1e-6));
        let ozone = Vec3::of(c::OZONE).scaled(f(0.06)).scaled(f(1e-5));
        let origin_view = Vec3::<F>::of([0.0, c::PLANET_RADIUS_M + eye_altitude_m, 0.0]);
        let zenith_h = f(c::TOP_RADIUS_M) - f(c::PLANET_RADIUS_M);
        let origin_h = origin_view.0[1] - f(c::PLANET_RADIUS_M);
        let column = |coefficient: Vec3<F>, scale_height_m: f64| {
            let h = f(scale_height_m);
            coefficient
                .scaled(h)
                .scaled((-origin_h / h).exp() - (-zenith_h / h).exp())
        };
        let depth = column(rayleigh, c::RAYLEIGH_SCALE_HEIGHT_M)
            .plus(column(mie, c::MIE_SCALE_HEIGHT_M))
            .plus(column(ozone, c::RAYLEIGH_SCALE_HEIGHT_M));
        let zenith = depth.map(|tau| (-tau).exp());
        // radians(0.53 / 2.0)
        let radius_size = f(c::SUN_WIDTH_DEG) / f(2.0) * f(std::f64::consts::PI / 180.0);
        let sun_solid_angle = f(2.0) * f(PI) * (f(1.0) - radius_size.cos());
        let outer_space = match sunlight {
            Sunlight::WhiteAtZenith(illuminance) => Vec3::of([illuminance; 3])
                .over(sun_solid_angle)
                .zip(zenith, |light, transmittance| light / transmittance),
            Sunlight::SolarSpectrum => Vec3::of(solar_rgb()).over(sun_solid_angle),
        };
        Self {
            rayleigh,
            mie,
            ozone,
            origin_view,
            radius_size,
            sun_solid_angle,
            outer_space,
        }
    }

    /// `compute_luminance`: singly scattered light along a direction. NaN if the ray runs so deep into the planet that densities
    /// overflow.
    pub fn luminance(&self, view: [f64; 3], sun: [f64; 3]) -> [f64; 3] {
        let (view, sun) = (Vec3::<F>::of(view), Vec3::<F>::of(sun));
        let out = self.exit_point(view);
        let ds = out.minus(self.origin_view).over(F::of(STEPS));
        let direction = ds.over(ds.length());
        let mut sum = Vec3::of([0.0; 3]);
        for i in 0..c::STEPS {
            let s = self.origin_view.plus(ds.scaled(F::of(i as f64 + 0.5)));
            let light = self
                .transmittance(self.origin_view, s)
                .times(self.source(s, direction, sun));
            sum = sum.plus(light);
        }
        sum.scaled(ds.length()).0.map(F::to_f64)
    }

    /// `direct_light_from_sun`: the disc, attenuated. The cosine is clamped to 1, unlike in the shader.
    pub fn disc(&self, view: [f64; 3], sun: [f64; 3]) -> [f64; 3] {
        let (view, sun) = (Vec3::<F>::of(view), Vec3::<F>::of(sun));
        let cosine = view.dot(sun);
        let angle = if cosine > F::of(1.0) {
            F::of(0.0)
        } else {
            cosine.acos()
        };
        let [inner, outer] = c::SUN_EDGE.map(|edge| self.radius_size * F::of(edge));
        let disc = F::of(1.0) - smoothstep(inner, outer, angle);
        self.outer_space
            .scaled(disc)
            .times(self.transmittance(self.origin_view, self.exit_point(view)))
            .0
            .map(F::to_f64)
    }

    /// Point at which a view ray leaves the atmosphere.
    fn exit_point(&self, view: Vec3<F>) -> Vec3<F> {
        let distance = leave(self.origin_view, view);
        self.origin_view.plus(view.scaled(distance))
    }

    /// `j`.
    fn source(&self, position: Vec3<F>, view: Vec3<F>, sun: Vec3<F>) -> Vec3<F> {
        let out = position.plus(sun.scaled(leave(position, sun)));
        let to_sun = self.transmittance(position, out);
        let rayleigh = self
            .sigma_rayleigh(position)
            .scaled(rayleigh_phase(view.dot(sun)));
        let mie = self.sigma_mie(position).scaled(mie_phase(view.dot(sun)));
        self.outer_space
            .times(to_sun)
            .scaled(self.sun_solid_angle)
            .times(rayleigh.plus(mie))
    }

    /// `transmittance`, by `integrate_sigma_t`.
    fn transmittance(&self, from: Vec3<F>, to: Vec3<F>) -> Vec3<F> {
        let ds = to.minus(from).over(F::of(STEPS));
        let mut sum = Vec3::of([0.0; 3]);
        for i in 0..c::STEPS {
            let s = from.plus(ds.scaled(F::of(i as f64 + 0.5)));
            let sigma_t = self
                .sigma_rayleigh(s)
                .plus(self.sigma_mie(s).scaled(F::of(c::MIE_EXTINCTION)))
                .plus(self.sigma_ozone(s));
            sum = sum.plus(sigma_t);
        }
        sum.scaled(ds.length()).map(|tau| (-tau).exp())
    }

    fn sigma_rayleigh(&self, position: Vec3<F>) -> Vec3<F> {
        self.rayleigh
            .scaled(density(position, c::RAYLEIGH_SCALE_HEIGHT_M))
    }

    fn sigma_mie(&self, position: Vec3<F>) -> Vec3<F> {
        self.mie.scaled(density(position, c::MIE_SCALE_HEIGHT_M))
    }

    fn sigma_ozone(&self, position: Vec3<F>) -> Vec3<F> {
        self.ozone
            .scaled(density(position, c::RAYLEIGH_SCALE_HEIGHT_M))
    }
}

/// The article's pi.
#[allow(clippy::approx_constant)]
const PI: f64 = 3.141_592_653_59;
const STEPS: f64 = c::STEPS as f64;

fn density<F: Real>(position: Vec3<F>, scale_height_m: f64) -> F {
    let h = position.length() - F::of(c::PLANET_RADIUS_M);
    (-h / F::of(scale_height_m)).exp()
}

/// `intersectRaySphereFromInside` with the top of the air.
fn leave<F: Real>(origin: Vec3<F>, direction: Vec3<F>) -> F {
    let b = origin.dot(direction);
    let radius = F::of(c::TOP_RADIUS_M);
    let discriminant = b * b - (origin.dot(origin) - radius * radius);
    -b + discriminant.sqrt()
}

fn rayleigh_phase<F: Real>(mu: F) -> F {
    (F::of(3.0) / (F::of(16.0) * F::of(PI))) * (F::of(1.0) + mu * mu)
}

fn mie_phase<F: Real>(mu: F) -> F {
    let g = F::of(c::MIE_G);
    let denominator = F::of(1.0) + g * g - F::of(2.0) * g * mu;
    (F::of(1.0) - g * g) / (F::of(4.0) * F::of(PI) * denominator.pow(F::of(1.5)))
}

/// GLSL's `smoothstep`.
pub fn smoothstep<F: Real>(from: F, to: F, x: F) -> F {
    let (zero, one) = (F::of(0.0), F::of(1.0));
    let t = (x - from) / (to - from);
    let t = if t < zero {
        zero
    } else if t > one {
        one
    } else {
        t
    };
    t * t * (F::of(3.0) - F::of(2.0) * t)
}
