//! Many lamps.

use super::fast::airlight_isotropic_lanes;
use super::march::{Haze, Ray};
use super::murk::{Murk, Sight};
use super::nodes::Nodes;
use super::passage::Passage;
use super::{Lamp, check};
use crate::fog::lanes::Lanes;
use crate::fog::matter::FogError;
use crate::fog::profile::Profile;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// How carefully the light of lamps is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LampSettings {
    /// Nodes in each panel of a line: at least 4.
    pub nodes: usize,
    /// A lamp that cannot add more than this to any lane of a line is left out, W m^-2 sr^-1 nm^-1 (or candela per square
    /// metre). The bound is that of the line's densest fog without extinction, under the larger of the phase function's
    /// values forward and backward; in uniform fog it is dimmed by what lies between eye and lamp.
    pub threshold: f32,
}

impl Default for LampSettings {
    /// 12 nodes, no threshold.
    fn default() -> Self {
        Self {
            nodes: 12,
            threshold: 0.0,
        }
    }
}

/// Lamps in fog.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamps<const N: usize> {
    lamps: Vec<Lamp<N>>,
    settings: LampSettings,
    nodes: Nodes,
}

impl<const N: usize> Lamps<N> {
    /// Lamps and how to sum them.
    ///
    /// # Errors
    /// [`FogError`] for fewer than 4 nodes or more than 256, or a threshold below 0 or not finite.
    pub fn new(lamps: Vec<Lamp<N>>, settings: LampSettings) -> Result<Self, FogError> {
        if !(4..=256).contains(&settings.nodes) {
            return Err(FogError::Number {
                what: "the number of nodes in a panel of a line past a lamp",
                got: settings.nodes as f64,
                right: "from 4 to 256",
            });
        }
        check::light("the threshold of lamps", Spectrum([settings.threshold]))?;
        Ok(Self {
            lamps,
            settings,
            nodes: Nodes::new(settings.nodes),
        })
    }

    /// The lamps themselves, for their direct light ([`Lamp::illumination`]).
    pub fn lamps(&self) -> &[Lamp<N>] {
        &self.lamps
    }

    /// The first glowing ball that a line meets: how far away, and its radiance (not yet dimmed by the fog before it).
    pub fn hit(&self, eye: DVec3, direction: DVec3) -> Option<(f64, Spectrum<N>)> {
        let balls = self.lamps.iter().filter_map(|lamp| match lamp {
            Lamp::Sphere(ball) => Some((ball.hit(eye, direction)?, ball.radiance)),
            _ => None,
        });
        balls.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The light of all lamps that fog scatters once into a line of sight, W m^-2 sr^-1 nm^-1: to be added to the path
    /// radiance that the fog has without them. The line ends at the first glowing ball that it meets.
    ///
    /// Where the fog is uniform and scatters evenly, [`super::airlight_isotropic_lanes`]; elsewhere quadrature in the same
    /// variable, with [`LampSettings::nodes`] in each panel. Errors: the book's chapter on lamps.
    pub fn path_radiance(&self, murk: &Murk<N>, sight: &Sight) -> Spectrum<N> {
        let Some(haze) = Haze::new(murk) else {
            return Spectrum::ZERO;
        };
        let mut sight = *sight;
        if let Some((distance, _)) = self.hit(sight.eye, sight.direction) {
            sight.length_m = sight.length_m.min(distance);
        }
        if sight.length_m <= 0.0 {
            return Spectrum::ZERO;
        }
        let mut sum = Spectrum::ZERO;
        for lamp in &self.lamps {
            sum += self.of_one(lamp, &haze, &sight);
        }
        sum
    }

    fn of_one(&self, lamp: &Lamp<N>, haze: &Haze<N>, sight: &Sight) -> Spectrum<N> {
        let ray = Ray::new(lamp, haze, sight);
        if self.settings.threshold > 0.0 && bound(&ray, haze) < self.settings.threshold {
            return Spectrum::ZERO;
        }
        let murk = haze.murk;
        match lamp {
            Lamp::Point(_)
                if haze.isotropic
                    && *murk.profile == Profile::Uniform
                    && murk.others.is_empty() =>
            {
                let extinction = murk.matter.extinction_per_m;
                evenly(&ray.passage, extinction, &self.nodes)
                    * haze.scattering_per_m
                    * ray.intensity
            }
            _ => ray.path_radiance(&self.nodes),
        }
    }
}

/// [`airlight_isotropic_lanes`], with a fourth lane for company where there are three: the machine likes that better.
#[inline]
fn evenly<const N: usize>(
    passage: &Passage,
    extinction_per_m: Spectrum<N>,
    nodes: &Nodes,
) -> Spectrum<N> {
    if N == 3 {
        let four = Spectrum::<4>::from_fn(|lane| extinction_per_m[lane.min(2)]);
        let light = airlight_isotropic_lanes(passage, four, nodes);
        Spectrum::from_fn(|lane| light[lane])
    } else {
        airlight_isotropic_lanes(passage, extinction_per_m, nodes)
    }
}

/// What a lamp adds to no lane more than.
fn bound<const N: usize>(ray: &Ray<N>, haze: &Haze<N>) -> f32 {
    let murk = haze.murk;
    let [forward, backward] = [1.0, -1.0].map(|cos| {
        murk.matter
            .phase_lanes(cos, murk.wavelengths_nm)
            .max_element()
    });
    let mut light = haze.scattering_per_m * ray.intensity;
    let density = match *murk.profile {
        Profile::Uniform => {
            let between = (ray.passage.distance_m(0.0) - 2.0 * ray.passage.nearest_m).max(0.0);
            let depth = murk.matter.extinction_per_m * between as f32;
            light *= depth.exp_neg();
            1.0
        }
        _ => murk.profile.density(ray.line.lowest_height_m()),
    };
    // 4: twice for a ball's closeness, twice for its line moved out to its radius.
    let glow = 4.0 * density * ray.passage.angle() / ray.passage.nearest_m;
    light.max_element() * forward.max(backward) * glow.min(f64::from(f32::MAX)) as f32
}

#[cfg(test)]
mod tests;
