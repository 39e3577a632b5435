//! Geometry and density profiles of a spherical atmosphere, independent of wavelength.

use crate::atmosphere::{Atmosphere, DensityProfile};
use crate::transfer::ray::{AirSegment, Ray};
use std::cell::Cell;

/// Largest number of constituents.
pub const MAX_CONSTITUENTS: usize = 8;

/// One number for each constituent (relative densities, or columns in metres at density 1); unused entries are 0.
pub type PerConstituent = [f64; MAX_CONSTITUENTS];

/// Vertical optical depth at any visible wavelength up to which an absorber needs few panels along rays.
const WEAK_ABSORBER: f64 = 0.05;

thread_local! {
    static EVALUATIONS: Cell<u64> = const { Cell::new(0) };
}

/// Number of points at which this thread has evaluated the densities of an atmosphere to integrate along rays: the work of a solution,
/// a table or a ray is a difference of two such numbers, on a single thread.
pub fn medium_evaluations() -> u64 {
    EVALUATIONS.get()
}

/// Counts one of the [`medium_evaluations`].
#[inline(always)]
pub(super) fn count_evaluation() {
    EVALUATIONS.set(EVALUATIONS.get() + 1);
}

/// An atmosphere with more than [`MAX_CONSTITUENTS`] constituents, and how many it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManyConstituents(pub usize);

/// A spherical shell of air: radii, density profiles and quadrature panels.
#[derive(Clone, Debug)]
pub struct Shell {
    /// Radius at altitude 0, m.
    pub planet_radius_m: f64,
    /// Radius of the ground, m.
    pub ground_radius_m: f64,
    /// Radius of the top of the atmosphere, m.
    pub top_radius_m: f64,
    /// Boundaries of quadrature panels: between them densities are smooth and change by a limited factor.
    pub panel_radii_m: Vec<f64>,
    /// Radii at which a density has a jump or a sharp bend.
    pub kink_radii_m: Vec<f64>,
    /// Radii of the spheres behind which sunlight changes abruptly: the ground, and jumps of a density, where a grazing ray begins to
    /// pass through dense air.
    pub shadow_radii_m: Vec<f64>,
    /// Largest extinction of each constituent at density 1 from 280 to 830 nm, 1/m.
    pub(super) max_extinction_per_m: Vec<f64>,
    densities: Vec<DensityProfile>,
}

impl Shell {
    /// Divides `atmosphere` into panels; `low_sun` adds panels in thin air, which dominates with a low sun.
    ///
    /// # Errors
    /// [`TooManyConstituents`] for more than [`MAX_CONSTITUENTS`].
    pub fn new(atmosphere: &Atmosphere, low_sun: bool) -> Result<Self, TooManyConstituents> {
        let planet = &atmosphere.planet;
        if atmosphere.constituents.len() > MAX_CONSTITUENTS {
            return Err(TooManyConstituents(atmosphere.constituents.len()));
        }
        let densities: Vec<_> = atmosphere
            .constituents
            .iter()
            .map(|c| c.density.clone())
            .collect();
        let (bottom, top) = (planet.ground_altitude_m, planet.top_altitude_m);
        let resolutions: Vec<Resolution> = atmosphere
            .constituents
            .iter()
            .map(|c| {
                let column_m = c.density.column_m(bottom, top);
                let visible = || (360..=830).step_by(10).map(f64::from);
                if visible().any(|nm| c.scattering_per_m.at(nm) > 0.0) {
                    Resolution::scatterer(low_sun)
                } else if visible().any(|nm| column_m * c.extinction_per_m(nm) > WEAK_ABSORBER) {
                    Resolution::STRONG_ABSORBER
                } else {
                    Resolution::WEAK_ABSORBER
                }
            })
            .collect();
        let (panels, kinks) = panel_altitudes_m(&densities, &resolutions, (bottom, top));
        let radii = |altitudes: Vec<f64>| {
            let radius = |altitude| planet.radius_m + altitude;
            altitudes.into_iter().map(radius).collect()
        };
        let max_extinction_per_m: Vec<f64> = atmosphere
            .constituents
            .iter()
            .map(|part| {
                let extinction = |nm| part.extinction_per_m(f64::from(nm));
                (280..=830).step_by(10).map(extinction).fold(0.0, f64::max)
            })
            .collect();
        let jumps = jump_altitudes_m(&densities, &max_extinction_per_m, planet.radius_m);
        let inside = jumps.into_iter().filter(|&h| h > bottom && h < top);
        Ok(Self {
            planet_radius_m: planet.radius_m,
            ground_radius_m: planet.radius_m + bottom,
            top_radius_m: planet.radius_m + top,
            panel_radii_m: radii(panels),
            kink_radii_m: radii(kinks),
            shadow_radii_m: radii(std::iter::once(bottom).chain(inside).collect()),
            max_extinction_per_m,
            densities,
        })
    }

    /// Number of constituents.
    #[inline(always)]
    pub fn constituents(&self) -> usize {
        self.densities.len()
    }

    /// Thickness of the shell, m.
    #[inline(always)]
    pub fn thickness_m(&self) -> f64 {
        self.top_radius_m - self.ground_radius_m
    }

    /// Relative densities at a radius. Counts as one of the [`medium_evaluations`].
    #[inline(always)]
    pub fn densities_at(&self, radius_m: f64) -> PerConstituent {
        count_evaluation();
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (value, profile) in out.iter_mut().zip(&self.densities) {
            *value = profile.at(radius_m - self.planet_radius_m);
        }
        out
    }

    /// Vertical columns from a radius to the top, in metres at density 1.
    pub fn vertical_columns_m(&self, radius_m: f64) -> PerConstituent {
        let mut out = [0.0; MAX_CONSTITUENTS];
        let altitude = radius_m - self.planet_radius_m;
        let top = self.top_radius_m - self.planet_radius_m;
        for (value, profile) in out.iter_mut().zip(&self.densities) {
            *value = profile.column_m(altitude, top).max(0.0);
        }
        out
    }

    /// Segment of a ray inside the atmosphere, over at most `limit_m`.
    pub fn segment(&self, ray: &Ray, limit_m: f64) -> Option<AirSegment> {
        ray.segment_in_air(self.ground_radius_m, self.top_radius_m, limit_m)
    }

    /// Altitude coordinate `sqrt(height above ground / thickness)` in `[0, 1]`, in which tables are uniform: dense near the
    /// ground, where most of the air is.
    #[inline(always)]
    pub fn altitude_coordinate(&self, radius_m: f64) -> f64 {
        ((radius_m - self.ground_radius_m) / self.thickness_m())
            .clamp(0.0, 1.0)
            .sqrt()
    }

    /// Inverse of [`Shell::altitude_coordinate`].
    pub fn radius_of_coordinate(&self, coordinate: f64) -> f64 {
        self.ground_radius_m + coordinate * coordinate * self.thickness_m()
    }

    /// Increasing radii from the ground to the top, between which every density is smooth: its kinks, all of them.
    pub(super) fn smooth_radii_m(&self) -> Vec<f64> {
        let mut radii = vec![self.ground_radius_m, self.top_radius_m];
        for density in &self.densities {
            let structure = density.structure();
            let ramps = structure.ramps_m.into_iter().flatten();
            radii.extend(
                structure
                    .kinks_m
                    .into_iter()
                    .chain(ramps)
                    .map(|h| h + self.planet_radius_m),
            );
        }
        radii.retain(|r| (self.ground_radius_m..=self.top_radius_m).contains(r));
        radii.sort_by(f64::total_cmp);
        // Closer kinks are one; the ends stay.
        let top = self.top_radius_m;
        radii.dedup_by(|above, below| *above - *below < THINNEST_M && *above < top);
        while radii.len() > 2 && top - radii[radii.len() - 2] < THINNEST_M {
            radii.remove(radii.len() - 2);
        }
        radii
    }
}

/// Height of an interval of altitudes that is not divided, m.
const THINNEST_M: f64 = 1e-3;

/// Increasing radii, with each interval halved until it is `fine(below, above)` or a millimetre high.
pub fn divided(radii_m: &[f64], fine: impl Fn(f64, f64) -> bool) -> Vec<f64> {
    let mut out = vec![radii_m[0]];
    for edge in radii_m.windows(2) {
        let mut parts = vec![(edge[0], edge[1])];
        while let Some((below, above)) = parts.pop() {
            if above - below > THINNEST_M && !fine(below, above) {
                let middle = 0.5 * (below + above);
                parts.extend([(middle, above), (below, middle)]);
            } else {
                out.push(above);
            }
        }
    }
    out
}

/// What panels have to resolve of a constituent, as fractions of its largest density.
#[derive(Clone, Copy)]
struct Resolution {
    /// Density below which it needs no panels.
    least_density: f64,
    /// Largest kink ([`sharpness`]) inside a panel.
    kink: f64,
}

impl Resolution {
    const STRONG_ABSORBER: Self = Self {
        least_density: 1e-4,
        kink: 0.2,
    };
    const WEAK_ABSORBER: Self = Self {
        least_density: 0.1,
        kink: 0.8,
    };

    /// In twilight all light comes from thin air above the planet's shadow: with 3e-3 the sky is off by 1 % with the sun at 2
    /// degrees, 8 % at -2, 20 % at -6.
    fn scatterer(low_sun: bool) -> Self {
        Self {
            least_density: if low_sun { 1e-5 } else { 3e-3 },
            kink: 0.2,
        }
    }
}

/// Altitudes from `bottom` to `top`, both included, between which all densities are free of kinks and, as far as the
/// constituent contributes, change by less than a factor `e^PANEL_DECAY`; and the altitudes of the kinks.
fn panel_altitudes_m(
    densities: &[DensityProfile],
    resolutions: &[Resolution],
    (bottom, top): (f64, f64),
) -> (Vec<f64>, Vec<f64>) {
    const PANEL_DECAY: f64 = 1.7;
    const SAMPLES: usize = 4000;
    let altitude = |i: usize| bottom + (top - bottom) * (i as f64 / SAMPLES as f64).powi(2);
    let peaks: Vec<f64> = densities
        .iter()
        .map(|density| {
            (0..=SAMPLES)
                .map(|i| density.at(altitude(i)))
                .fold(0.0, f64::max)
        })
        .collect();
    let floors: Vec<f64> = peaks
        .iter()
        .zip(resolutions)
        .map(|(peak, resolution)| peak * resolution.least_density)
        .collect();
    let mut kinks: Vec<f64> = densities
        .iter()
        .zip(&peaks)
        .zip(resolutions)
        .flat_map(|((density, peak), resolution)| {
            let breakpoints = density.breakpoints_m();
            let sharp = sharpnesses(density, &breakpoints, top - bottom);
            let parts = breakpoints.into_iter().zip(sharp);
            let least = peak * resolution.kink;
            parts.filter_map(move |(h, sharpness)| (sharpness > least).then_some(h))
        })
        .filter(|&h| h > bottom && h < top)
        .collect();
    kinks.sort_by(f64::total_cmp);
    // Closer kinks are one.
    kinks.dedup_by(|above, below| *above - *below < THINNEST_M);

    let mut edges = vec![bottom];
    let mut next_kink = kinks.iter().copied().peekable();
    for i in 1..=SAMPLES {
        let here = altitude(i);
        if let Some(kink) = next_kink.next_if(|&kink| kink <= here) {
            edges.push(kink);
            while next_kink.next_if(|&kink| kink <= here).is_some() {}
            continue;
        }
        let start = edges[edges.len() - 1];
        let changed = densities.iter().zip(&floors).any(|(density, &floor)| {
            floor > 0.0
                && ((density.at(here) + floor) / (density.at(start) + floor))
                    .ln()
                    .abs()
                    > PANEL_DECAY
        });
        if changed {
            edges.push(here);
        }
    }
    if top > edges[edges.len() - 1] {
        edges.push(top);
    }
    (edges, kinks)
}

/// Altitudes of jumps of a density through which grazing sunlight is dimmed: the optical depth of a ray rises with the root of the
/// distance of its lowest point below the jump.
fn jump_altitudes_m(
    densities: &[DensityProfile],
    max_extinction_per_m: &[f64],
    planet_radius_m: f64,
) -> Vec<f64> {
    /// Distance of the lowest point of a ray below the jump, m, and its optical depth that matters.
    const BELOW_M: f64 = 1e3;
    const DEPTH: f64 = 0.05;
    const STEP_M: f64 = 0.1;
    let chord_m = 2.0 * (2.0 * planet_radius_m * BELOW_M).sqrt();
    let parts = densities.iter().zip(max_extinction_per_m);
    let mut jumps: Vec<f64> = parts
        .flat_map(|(density, extinction_per_m)| {
            let breakpoints = density.breakpoints_m().into_iter();
            breakpoints.filter(move |h| {
                let jump = (density.at(h + STEP_M) - density.at(h - STEP_M)).abs();
                jump * extinction_per_m * chord_m > DEPTH
            })
        })
        .collect();
    jumps.sort_by(f64::total_cmp);
    // Closer jumps are one.
    jumps.dedup_by(|above, below| *above - *below < THINNEST_M);
    jumps
}

/// Jumps of a density at its breakpoints, plus the change of its slope there times an eighth of the thickness or, where breakpoints are
/// closer, the distance between them: bends of a table that follows a smooth profile are small then.
fn sharpnesses(density: &DensityProfile, breakpoints_m: &[f64], thickness_m: f64) -> Vec<f64> {
    let farthest_m = thickness_m / 8.0;
    let step = 1e-6 * thickness_m;
    let distance = |k: Option<usize>, altitude_m: f64| {
        let neighbour = k.and_then(|k| breakpoints_m.get(k));
        neighbour.map_or(farthest_m, |h| (h - altitude_m).abs().min(farthest_m))
    };
    let of = |(k, &altitude_m): (usize, &f64)| {
        let [below2, below, above, above2] =
            [-2.0, -1.0, 1.0, 2.0].map(|k| density.at(altitude_m + k * step));
        let jump = (above - below).abs();
        let bend = ((above2 - above) - (below - below2)).abs() / step;
        let before = distance(k.checked_sub(1), altitude_m);
        let after = distance(Some(k + 1), altitude_m);
        jump + bend * before.max(after)
    };
    breakpoints_m.iter().enumerate().map(of).collect()
}
