//! The control medium: a layered approximation of the air whose columns along straight rays are exact polynomials.
//!
//! The atmosphere is divided into layers in each of which every density is a parabola in the squared radius. The squared
//! radius is a parabola in the distance along a ray, so columns need no quadrature. Distances are sampled in the control
//! medium; its difference from the true densities is corrected without bias by residual tracking,
//! [`super::chord::Chord::residual`].

use crate::atmosphere::{Atmosphere, DensityProfile};
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};

/// Layers are halved until the relative error of the extinction is below this.
const TOLERANCE: f64 = 1e-3;
/// Thickness below which layers are not halved, m.
const MIN_THICKNESS_M: f64 = 1.0;
/// Number of points at which the parabolas of a layer are compared with the densities.
const CHECKS: usize = 16;

/// The layered control medium.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Radius of altitude 0, m.
    planet_radius_m: f64,
    densities: Vec<DensityProfile>,
    /// Squared radii of the layers' boundaries, increasing: one more than there are layers.
    edges: Vec<f64>,
    layers: Vec<Layer>,
}

/// One layer.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// Centre and half-width of the layer in squared radius, m^2.
    middle: f64,
    half: f64,
    /// `density = a + b x + c x^2`, `x = (r^2 - middle) / half`.
    pub parabolas: [[f64; 3]; MAX_CONSTITUENTS],
    /// Bound on the difference between the true extinction and that of the parabolas at any wavelength, 1/m.
    pub residual_per_m: f64,
}

impl Layers {
    /// Divides an atmosphere into layers; `extinctions` holds the extinction of each constituent at density 1 (1/m) for every
    /// wavelength.
    pub fn new(atmosphere: &Atmosphere, extinctions: &[PerConstituent]) -> Self {
        let planet = &atmosphere.planet;
        let mut layers = Self {
            planet_radius_m: planet.radius_m,
            densities: atmosphere
                .constituents
                .iter()
                .map(|part| part.density.clone())
                .collect(),
            edges: vec![(planet.radius_m + planet.ground_altitude_m).powi(2)],
            layers: Vec::new(),
        };
        let mut from = planet.ground_altitude_m;
        let breaks = atmosphere.breakpoints_m();
        for to in breaks.into_iter().chain([planet.top_altitude_m]) {
            layers.cut(from, to, extinctions);
            from = to;
        }
        layers
    }

    fn cut(&mut self, from_m: f64, to_m: f64, extinctions: &[PerConstituent]) {
        let (layer, relative_error) = self.fit(from_m, to_m, extinctions);
        if relative_error > TOLERANCE && to_m - from_m > MIN_THICKNESS_M {
            let middle = 0.5 * (from_m + to_m);
            self.cut(from_m, middle, extinctions);
            self.cut(middle, to_m, extinctions);
            return;
        }
        let edge = (self.planet_radius_m + to_m).powi(2);
        if edge > self.edges[self.edges.len() - 1] {
            self.edges.push(edge);
            self.layers.push(layer);
        }
    }

    /// Parabolas through the three Gauss points, whose integrals are exact to fifth order, and their largest relative error of
    /// the extinction at any wavelength.
    fn fit(&self, from_m: f64, to_m: f64, extinctions: &[PerConstituent]) -> (Layer, f64) {
        let squares = [from_m, to_m].map(|z| (self.planet_radius_m + z).powi(2));
        let mut layer = Layer {
            middle: 0.5 * (squares[0] + squares[1]),
            half: 0.5 * (squares[1] - squares[0]),
            parabolas: [[0.0; 3]; MAX_CONSTITUENTS],
            residual_per_m: 0.0,
        };
        let radius = |x: f64| (layer.middle + x * layer.half).sqrt();
        let node = 0.6f64.sqrt();
        let values = [-node, 0.0, node].map(|x| self.densities_at(radius(x)));
        for (c, parabola) in layer.parabolas.iter_mut().enumerate() {
            let [low, middle, high] = values.map(|v| v[c]);
            let slope = 0.5 * (high - low) / node;
            let curvature = (0.5 * (high + low) - middle) / (node * node);
            *parabola = [middle, slope, curvature];
            // A constant replaces parabolas that fall below a tenth of the density.
            let least = 0.1 * low.min(middle).min(high);
            let dips = [-1.0, 1.0]
                .into_iter()
                .chain((curvature != 0.0).then(|| (-0.5 * slope / curvature).clamp(-1.0, 1.0)))
                .any(|x| middle + x * (slope + x * curvature) < least);
            if dips {
                *parabola = [low.max(middle).max(high), 0.0, 0.0];
            }
        }
        let mut worst: f64 = 0.0;
        for k in 0..CHECKS {
            let x = 2.0 * (k as f64 + 0.5) / CHECKS as f64 - 1.0;
            let truth = self.densities_at(radius(x));
            let control = layer.densities_of(x);
            for extinction in extinctions {
                let (mut missing, mut whole) = (0.0, 0.0);
                for c in 0..self.densities.len() {
                    missing += extinction[c] * (truth[c] - control[c]).abs();
                    whole += extinction[c] * truth[c];
                }
                // Twice the sampled error, as a margin between the points.
                layer.residual_per_m = layer.residual_per_m.max(2.0 * missing);
                if missing > 0.0 {
                    worst = worst.max(missing / whole);
                }
            }
        }
        (layer, worst)
    }

    /// Number of layers.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.layers.len()
    }

    /// Number of constituents.
    #[cfg(test)]
    pub fn constituents(&self) -> usize {
        self.densities.len()
    }

    /// Layer by index.
    #[inline(always)]
    pub fn layer(&self, layer: usize) -> &Layer {
        &self.layers[layer]
    }

    /// Squared radius of a boundary: layer `i` lies between the boundaries `i` and `i + 1`.
    #[inline(always)]
    pub fn edge(&self, edge: usize) -> f64 {
        self.edges[edge]
    }

    /// Squared radii of the ground and of the top of the atmosphere.
    pub fn bounds(&self) -> (f64, f64) {
        (self.edges[0], self.edges[self.edges.len() - 1])
    }

    /// Index of the top layer.
    #[inline(always)]
    pub fn last(&self) -> usize {
        self.layers.len() - 1
    }

    /// Layer that contains a squared radius; outside the atmosphere, the nearest layer.
    #[inline(always)]
    pub fn at(&self, square: f64) -> usize {
        self.edges
            .partition_point(|&edge| edge <= square)
            .clamp(1, self.layers.len())
            - 1
    }

    /// True densities at a radius in m.
    #[inline(always)]
    pub fn densities_at(&self, radius_m: f64) -> PerConstituent {
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (value, profile) in out.iter_mut().zip(&self.densities) {
            *value = profile.at(radius_m - self.planet_radius_m);
        }
        out
    }
}

impl Layer {
    /// Coordinate `x` of the parabolas at a squared radius.
    #[inline(always)]
    pub fn coordinate(&self, square: f64) -> f64 {
        (square - self.middle) / self.half
    }

    /// Densities of the control medium at `x`.
    #[inline(always)]
    pub fn densities_of(&self, x: f64) -> PerConstituent {
        self.parabolas.map(|[a, b, c]| a + x * (b + x * c))
    }

    /// Integrals of 1, `x` and `x^2` along a straight ray with squared radius `tangent + t^2`, from `from` to `to`, from which
    /// [`Self::columns`] computes columns.
    #[inline(always)]
    pub fn moments(&self, tangent: f64, from: f64, to: f64) -> [f64; 3] {
        let (middle, h) = (0.5 * (from + to), 0.5 * (to - from));
        // About the midpoint: x = x0 + x1 s + x2 s^2.
        let x0 = self.coordinate(tangent + middle * middle);
        let x2 = 1.0 / self.half;
        let x1 = 2.0 * middle * x2;
        let h2 = h * h;
        let length = 2.0 * h;
        [
            length,
            length * (x0 + x2 * h2 / 3.0),
            length * (x0 * x0 + (x1 * x1 + 2.0 * x0 * x2) * h2 / 3.0 + x2 * x2 * h2 * h2 / 5.0),
        ]
    }

    /// Columns for these moments, in metres at density 1.
    #[inline(always)]
    pub fn columns(&self, moments: [f64; 3], constituents: usize) -> PerConstituent {
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (column, [a, b, c]) in out.iter_mut().zip(&self.parabolas).take(constituents) {
            *column = a * moments[0] + b * moments[1] + c * moments[2];
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::Preset;
    use crate::names::Named;

    fn extinctions(air: &Atmosphere) -> Vec<PerConstituent> {
        [400.0, 550.0, 700.0]
            .map(|nm| {
                let mut all = [0.0; MAX_CONSTITUENTS];
                for (value, part) in all.iter_mut().zip(&air.constituents) {
                    *value = part.extinction_per_m(nm);
                }
                all
            })
            .to_vec()
    }

    /// The vertical optical depth of the control medium matches the profiles, with few layers.
    #[test]
    fn layers_preserve_the_vertical_column() {
        for &preset in Preset::ALL {
            let (name, air) = (preset.name(), preset.atmosphere());
            let extinctions = extinctions(&air);
            let layers = Layers::new(&air, &extinctions);
            assert!((2..160).contains(&layers.len()), "{name}: {}", layers.len());
            let (ground, top) = layers.bounds();
            for extinction in &extinctions {
                let (mut got, mut want) = (0.0, 0.0);
                for layer in 0..layers.len() {
                    let ends = [layers.edge(layer), layers.edge(layer + 1)].map(f64::sqrt);
                    let layer = layers.layer(layer);
                    let columns =
                        layer.columns(layer.moments(0.0, ends[0], ends[1]), MAX_CONSTITUENTS);
                    for c in 0..layers.constituents() {
                        got += extinction[c] * columns[c];
                    }
                }
                for (part, sigma) in air.constituents.iter().zip(extinction) {
                    let [from, to] = [ground, top].map(|s| s.sqrt() - air.planet.radius_m);
                    want += sigma * part.density.column_m(from, to);
                }
                assert!((got / want - 1.0).abs() < 1e-5, "{name}: {got} for {want}");
            }
        }
    }
}
