//! Straight rays through the layers: their segments, columns, and sampling of distances along them.

use super::layers::Layers;
use crate::math::quadrature::FixedRule;
use crate::math::random::Random;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};
use glam::DVec3;

/// How a ray ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At the ground.
    Ground,
    /// Above the atmosphere, or at a distance where nothing is hit.
    Space,
}

/// A ray in the coordinate `t` that is 0 at the point closest to the planet's centre: the squared radius is
/// `tangent + t^2`.
#[derive(Clone, Copy, Debug)]
pub struct HalfLine {
    /// Squared radius of the closest point, m^2.
    pub tangent: f64,
    /// Coordinate of the origin, m.
    pub start: f64,
}

/// A ray traced through the layers.
#[derive(Clone, Debug, Default)]
pub struct Chord {
    tangent: f64,
    pieces: Vec<Piece>,
    /// Columns over the whole chord.
    pub columns: PerConstituent,
    residual: f64,
}

/// The part of a chord within one layer.
#[derive(Clone, Copy, Debug)]
struct Piece {
    layer: usize,
    from: f64,
    to: f64,
    /// Columns from the start of the chord to `from`.
    before: PerConstituent,
    /// Residual optical depth from the start of the chord to `from`.
    residual_before: f64,
}

impl HalfLine {
    /// Ray from a position (m, relative to the planet's centre) along a unit vector.
    #[inline(always)]
    pub fn new(place: DVec3, direction: DVec3) -> Self {
        Self {
            tangent: place.cross(direction).length_squared(),
            start: place.dot(direction),
        }
    }

    /// True if the ray hits the planet.
    #[inline(always)]
    pub fn meets_ground(&self, layers: &Layers) -> bool {
        self.start < 0.0 && self.tangent < layers.edge(0)
    }

    /// Calls `visit(layer, from, to)` for each segment, from the origin inside the atmosphere to the ground or space.
    #[inline(always)]
    fn for_each_segment(&self, layers: &Layers, mut visit: impl FnMut(usize, f64, f64)) -> End {
        let mut t = self.start;
        let mut layer = layers.at(self.tangent + t * t);
        loop {
            let descends = t < 0.0 && self.tangent < layers.edge(layer);
            let edge = layers.edge(if descends { layer } else { layer + 1 });
            let reach = (edge - self.tangent).max(0.0).sqrt();
            let to = if descends { -reach } else { reach };
            if to > t {
                visit(layer, t, to);
                t = to;
            }
            match descends {
                true if layer == 0 => return End::Ground,
                true => layer -= 1,
                false if layer == layers.last() => return End::Space,
                false => layer += 1,
            }
        }
    }

    /// Columns of the control medium to space, and the residual optical depth; for a ray that does not hit the ground.
    #[inline(always)]
    pub fn to_space(self, layers: &Layers) -> (PerConstituent, f64) {
        let mut columns = [0.0; MAX_CONSTITUENTS];
        let mut residual = 0.0;
        self.for_each_segment(layers, |layer, from, to| {
            let layer = layers.layer(layer);
            let more = layer.columns(layer.moments(self.tangent, from, to), MAX_CONSTITUENTS);
            for (column, more) in columns.iter_mut().zip(more) {
                *column += more;
            }
            residual += layer.residual_per_m * (to - from);
        });
        (columns, residual)
    }

    /// Calls `at(squared radius, layer)` at the residual collisions on the way to space: a Poisson process with the rate
    /// `residual_per_m`, whose first event is at the residual optical depth `first`.
    #[cold]
    pub fn residual_places(
        &self,
        layers: &Layers,
        first: f64,
        random: &mut Random,
        mut at: impl FnMut(f64, usize),
    ) {
        let mut remaining = first;
        self.for_each_segment(layers, |layer, from, to| {
            let rate = layers.layer(layer).residual_per_m;
            let mut t = from;
            while rate * (to - t) > remaining {
                t += remaining / rate;
                at(self.tangent + t * t, layer);
                remaining = -random.unit().ln();
            }
            remaining -= rate * (to - t);
        });
    }
}

impl Chord {
    /// Traces a ray that starts inside the atmosphere.
    #[inline(always)]
    pub fn cross(&mut self, layers: &Layers, line: HalfLine) -> End {
        self.tangent = line.tangent;
        self.pieces.clear();
        let mut columns = [0.0; MAX_CONSTITUENTS];
        let mut residual = 0.0;
        let pieces = &mut self.pieces;
        let end = line.for_each_segment(layers, |layer, from, to| {
            pieces.push(Piece {
                layer,
                from,
                to,
                before: columns,
                residual_before: residual,
            });
            let layer = layers.layer(layer);
            let more = layer.columns(layer.moments(line.tangent, from, to), MAX_CONSTITUENTS);
            for (column, more) in columns.iter_mut().zip(more) {
                *column += more;
            }
            residual += layer.residual_per_m * (to - from);
        });
        // A ray that ends where it starts, on an edge of the atmosphere.
        if pieces.is_empty() {
            pieces.push(Piece {
                layer: layers.at(line.tangent + line.start * line.start),
                from: line.start,
                to: line.start,
                before: columns,
                residual_before: residual,
            });
        }
        self.columns = columns;
        self.residual = residual;
        end
    }

    /// Shortens the chord to end at `until`, if it extends further.
    #[cold]
    pub fn cut(&mut self, layers: &Layers, until: f64) {
        if self.pieces.is_empty() || until >= self.end() {
            return;
        }
        let last = self.piece_at(until);
        self.columns = self.columns_to(layers, until);
        self.pieces.truncate(last + 1);
        let piece = &mut self.pieces[last];
        piece.to = until.max(piece.from);
        let rate = layers.layer(piece.layer).residual_per_m;
        self.residual = piece.residual_before + rate * (piece.to - piece.from);
    }

    /// Columns of the true densities over the chord, by an 8-point Gauss rule in each layer.
    pub fn true_columns(&self, layers: &Layers) -> PerConstituent {
        static RULE: FixedRule<8> = FixedRule::fixed();
        let mut columns = [0.0; MAX_CONSTITUENTS];
        for piece in &self.pieces {
            for (t, weight) in RULE.on(piece.from, piece.to) {
                let densities = layers.densities_at((self.tangent + t * t).sqrt());
                for (column, density) in columns.iter_mut().zip(densities) {
                    *column += weight * density;
                }
            }
        }
        columns
    }

    /// Coordinate of the start, m.
    pub fn start(&self) -> f64 {
        self.pieces.first().map_or(0.0, |piece| piece.from)
    }

    /// Coordinate of the end, m.
    pub fn end(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.to)
    }

    /// Index of the layer at `t`.
    #[inline(always)]
    pub fn layer_at(&self, t: f64) -> usize {
        self.pieces[self.piece_at(t)].layer
    }

    #[inline(always)]
    fn piece_at(&self, t: f64) -> usize {
        self.pieces
            .partition_point(|piece| piece.from <= t)
            .clamp(1, self.pieces.len())
            - 1
    }

    /// Columns of the control medium from the start to `t`.
    #[inline(always)]
    pub fn columns_to(&self, layers: &Layers, t: f64) -> PerConstituent {
        let piece = &self.pieces[self.piece_at(t)];
        let layer = layers.layer(piece.layer);
        let to = t.clamp(piece.from, piece.to);
        let more = layer.columns(
            layer.moments(self.tangent, piece.from, to),
            MAX_CONSTITUENTS,
        );
        let mut columns = piece.before;
        for (column, more) in columns.iter_mut().zip(more) {
            *column += more;
        }
        columns
    }

    /// Coordinate at which the optical depth of the control medium from the start is `depth`, for the extinction of each
    /// constituent in 1/m at density 1: bracketed Newton iteration on a polynomial of degree 5, to rounding.
    pub fn at_depth(&self, layers: &Layers, extinction: &PerConstituent, depth: f64) -> f64 {
        let of = |columns: &PerConstituent| -> f64 {
            extinction.iter().zip(columns).map(|(e, c)| e * c).sum()
        };
        let piece = self
            .pieces
            .partition_point(|piece| of(&piece.before) <= depth)
            .max(1)
            - 1;
        let piece = &self.pieces[piece];
        let layer = layers.layer(piece.layer);
        let mut parabola = [0.0; 3];
        for (e, p) in extinction.iter().zip(&layer.parabolas) {
            for (sum, p) in parabola.iter_mut().zip(p) {
                *sum += e * p;
            }
        }
        let target = depth - of(&piece.before);
        let depth_to = |t: f64| -> f64 {
            let moments = layer.moments(self.tangent, piece.from, t);
            parabola.iter().zip(moments).map(|(p, m)| p * m).sum()
        };
        let rate = |t: f64| {
            let x = layer.coordinate(self.tangent + t * t);
            parabola[0] + x * (parabola[1] + x * parabola[2])
        };
        let (mut low, mut high) = (piece.from, piece.to);
        let whole = depth_to(high);
        let mut t = match whole > 0.0 {
            true => low + (high - low) * (target / whole).clamp(0.0, 1.0),
            false => return high,
        };
        for _ in 0..60 {
            let excess = depth_to(t) - target;
            if excess > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - excess / rate(t);
            let next = match newton > low && newton < high {
                true => newton,
                false => 0.5 * (low + high),
            };
            let step = (next - t).abs();
            t = next;
            if step <= 1e-9 * (piece.to - piece.from) {
                break;
            }
        }
        t
    }

    /// As [`HalfLine::residual_places`], from the start to `until`. Residual collisions are rare.
    #[inline(always)]
    pub fn residual(
        &self,
        layers: &Layers,
        until: f64,
        random: &mut Random,
        mut at: impl FnMut(f64, usize),
    ) {
        let mut next = -random.unit().ln();
        if next > self.residual {
            return;
        }
        for piece in &self.pieces {
            let rate = layers.layer(piece.layer).residual_per_m;
            let to = piece.to.min(until);
            while piece.residual_before + rate * (to - piece.from) > next {
                let t = piece.from + (next - piece.residual_before) / rate;
                at(self.tangent + t * t, piece.layer);
                next -= random.unit().ln();
            }
            if piece.to >= until {
                return;
            }
        }
    }
}
