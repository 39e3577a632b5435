//! Coordinates of tables of the sky: where their rows and columns are dense.
//!
//! Rows divide the elevations from the horizon to the highest air, and those from the horizon to the nadir. Light jumps at the horizon and
//! bends sharply along rays that graze a jump of density below the eye, such as the top of a dust layer: just below it the path in the
//! layer grows with the square root of the angle. Rows at the square of a uniform coordinate on that side resolve the root. Just below such a
//! jump, the level ray takes the place of the grazing one: rays above it soon leave the layer, those below it have a long way in it.
//!
//! Columns divide the azimuths from that of the sun to the opposite one. From space, the planet's shadow crosses the limb where the
//! sun has set for the air there: columns are dense about that azimuth.

use super::view::View;
use crate::axes;
use crate::math::arctangent::arctangent;
use crate::math::real::Real;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

/// Places of rows and columns in tables of the light of a view, by elevation and by azimuth from the sun: from 0 in the first to 1 in the
/// last of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TableCoordinates {
    /// Elevation of the horizon, rad.
    pub horizon_rad: f64,
    /// Elevation above which there is no air, rad: the zenith, or from space the limb.
    pub highest_rad: f64,
    /// Elevation of the rays that graze the highest jump of density below the eye, rad, or 0 for an eye just below a jump; that of the
    /// horizon without one.
    pub kink_rad: f64,
    /// Place of the row at that elevation, a multiple of 1 / [`TableCoordinates::ROW_STEPS`].
    pub kink_place: f64,
    /// Part of the columns that is dense about an azimuth.
    pub dense_share: f64,
    /// That azimuth, in half turns from the sun.
    pub dense_azimuth: f64,
    /// Width of the dense part, half turns.
    pub dense_width: f64,
    /// Share of rows below the horizon that are as dense at the nadir as rays to the ground are from far away; the others are denser near
    /// the horizon, as rays from a low eye soon meet the ground elsewhere.
    pub even_below: f64,
    /// Height above the ground of the jump of density that is nearest to the eye, m.
    pub jump_height_m: Option<f64>,
}

impl View {
    /// Where tables of this view have their rows and columns.
    pub fn table_coordinates(&self) -> TableCoordinates {
        TableCoordinates::new(self)
    }
}

impl TableCoordinates {
    /// Steps between rows above the horizon in the smallest table: others have a multiple of them, so that a kink is in a row.
    pub const ROW_STEPS: usize = 31;
    /// Part of the span of elevations from the horizon to the first rows, as radiance jumps there.
    const BESIDE_HORIZON: f64 = 1e-9;

    fn new(view: &View) -> Self {
        let radius_m = view.radius_m();
        let (ground_radius_m, top_radius_m) = view.bounds_m();
        let horizon_rad = view.horizon_elevation_rad();
        let highest_rad = match radius_m >= top_radius_m {
            true => -(top_radius_m / radius_m).acos(),
            false => FRAC_PI_2,
        };
        let jumps_m = &view.sky().shell().shadow_radii_m[1..];
        let nearest_m = jumps_m
            .iter()
            .copied()
            .min_by(|a, b| (a - radius_m).abs().total_cmp(&(b - radius_m).abs()));
        let below_eye = jumps_m.iter().rev().find(|&&jump_m| jump_m < radius_m);
        let grazing = match (nearest_m, below_eye) {
            (Some(jump_m), _) if is_just_below(radius_m, jump_m, ground_radius_m) => 0.0,
            (_, Some(jump_m)) => -(jump_m / radius_m).acos(),
            (_, None) => horizon_rad,
        };
        let (kink_rad, kink_place) = kink(grazing, (horizon_rad, highest_rad));
        let (dense_azimuth, dense_width) =
            terminator(axes::elevation_deg(view.sun()).to_radians(), -horizon_rad);
        Self {
            horizon_rad,
            highest_rad,
            kink_rad,
            kink_place,
            dense_share: dense_share(-horizon_rad),
            dense_azimuth,
            dense_width,
            even_below: -horizon_rad.sin(),
            jump_height_m: nearest_m.map(|jump_m| jump_m - ground_radius_m),
        }
    }

    /// Place of an elevation (rad) among the rows above or below the horizon.
    pub fn row_place(&self, elevation_rad: f64, is_below: bool) -> f64 {
        self.row_place_of_angle(elevation_rad - self.horizon_rad, is_below)
    }

    /// [`TableCoordinates::row_place`] of an angle above the horizon, negative below it, rad.
    #[inline(always)]
    pub(super) fn row_place_of_angle<T: Real>(&self, angle: T, is_below: bool) -> T {
        let kink = T::of(self.kink_rad - self.horizon_rad);
        if is_below || angle >= kink {
            return self.row_place_beyond_kink(angle, is_below);
        }
        let part = (angle / kink).clamp(T::of(0.0), T::of(1.0));
        let angle = arctangent(part.sqrt(), (T::of(1.0) - part).sqrt(), T::of(1.0));
        T::of(self.kink_place * FRAC_2_PI) * angle
    }

    /// [`TableCoordinates::row_place_of_angle`] other than between the horizon and the kink, without branches: loops over many angles
    /// run in vector registers.
    #[inline(always)]
    pub(super) fn row_place_beyond_kink<T: Real>(&self, angle: T, is_below: bool) -> T {
        let [kink, highest, nadir] =
            [self.kink_rad, self.highest_rad, -FRAC_PI_2].map(|end| end - self.horizon_rad);
        let [from, per_rad] = match is_below {
            true => [0.0, 1.0 / nadir],
            false => [kink, 1.0 / (highest - kink)],
        }
        .map(T::of);
        let part = ((angle - from) * per_rad).clamp(T::of(0.0), T::of(1.0));
        let root = part.sqrt();
        let below = root.sqrt();
        let [even, uneven] = [self.even_below, 1.0 - self.even_below].map(T::of);
        let [at_kink, beyond] = [self.kink_place, 1.0 - self.kink_place].map(T::of);
        match is_below {
            true => below * (uneven + even * below),
            false => at_kink + beyond * root,
        }
    }

    /// Inverse of [`TableCoordinates::row_place`], off the horizon by a nanoradian, where the light jumps.
    pub fn elevation_rad(&self, place: f64, is_below: bool) -> f64 {
        let between = |from: f64, to: f64, part: f64| from + (to - from) * part;
        if is_below {
            let even = self.even_below;
            let root =
                2.0 * place / (1.0 - even + ((1.0 - even).powi(2) + 4.0 * even * place).sqrt());
            let part = root.powi(4).max(Self::BESIDE_HORIZON);
            return between(self.horizon_rad, -FRAC_PI_2, part);
        }
        let elevation_rad = match place < self.kink_place {
            true => {
                let part = (FRAC_PI_2 * place / self.kink_place).sin().powi(2);
                between(self.horizon_rad, self.kink_rad, part)
            }
            false => {
                let part = ((place - self.kink_place) / (1.0 - self.kink_place)).powi(2);
                between(self.kink_rad, self.highest_rad, part)
            }
        };
        let first = between(self.horizon_rad, self.highest_rad, Self::BESIDE_HORIZON);
        elevation_rad.max(first)
    }

    /// Place of an azimuth from the sun among the columns; azimuths are in half turns.
    pub fn column_place(&self, azimuth: f64) -> f64 {
        self.column_place_of(azimuth)
    }

    /// [`TableCoordinates::column_place`] in the precision of the azimuth.
    #[inline(always)]
    pub(super) fn column_place_of<T: Real>(&self, azimuth: T) -> T {
        if self.dense_share == 0.0 {
            return azimuth;
        }
        let [first, last] = [0.0, 1.0].map(|end| self.dense(end));
        let dense = (self.dense(azimuth) - T::of(first)) * T::of(1.0 / (last - first));
        azimuth + T::of(self.dense_share) * (dense - azimuth)
    }

    #[inline(always)]
    fn dense<T: Real>(&self, azimuth: T) -> T {
        let one = T::of(1.0);
        let widths = (azimuth - T::of(self.dense_azimuth)) * T::of(1.0 / self.dense_width);
        arctangent(widths, one, (one + widths * widths).sqrt())
    }

    /// Inverse of [`TableCoordinates::column_place`], by bisection.
    pub fn azimuth(&self, place: f64) -> f64 {
        let (mut below, mut above) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (below + above);
            match self.column_place(middle) < place {
                true => below = middle,
                false => above = middle,
            }
        }
        match self.dense_share == 0.0 {
            true => place,
            false => 0.5 * (below + above),
        }
    }
}

/// True for an eye so close below a jump that rays near the horizontal leave the layer within a small part of the angle down to the horizon.
fn is_just_below(radius_m: f64, jump_radius_m: f64, ground_radius_m: f64) -> bool {
    const PART_OF_HEIGHT: f64 = 0.25;
    let depth_m = jump_radius_m - radius_m;
    (0.0..PART_OF_HEIGHT * (radius_m - ground_radius_m)).contains(&depth_m)
}

/// Elevation of a kink and its place, for rays that graze a jump at an elevation between others; the lower of them and 0 for one that is
/// not above it.
fn kink(grazing_rad: f64, (horizon_rad, highest_rad): (f64, f64)) -> (f64, f64) {
    /// Smallest angle of a layer that has rows of its own, rad, and the rows in steps of the smallest table that it has at least.
    const SMALLEST_RAD: f64 = 1e-5;
    const FEWEST_STEPS: f64 = 8.0;
    let most = TableCoordinates::ROW_STEPS as f64;
    let is_resolved =
        grazing_rad - horizon_rad > SMALLEST_RAD && highest_rad - grazing_rad > SMALLEST_RAD;
    if !is_resolved {
        return (horizon_rad, 0.0);
    }
    let among_others = ((grazing_rad - horizon_rad) / (highest_rad - horizon_rad)).sqrt();
    let steps = (among_others * most).round();
    (
        grazing_rad,
        steps.clamp(FEWEST_STEPS, most - FEWEST_STEPS) / most,
    )
}

/// Part of the columns that is dense, for an angle of the horizon below the horizontal: none in the air, where the shadow crosses no
/// horizon.
fn dense_share(dip_rad: f64) -> f64 {
    const MOST: f64 = 0.6;
    /// Sines of the angle at which it begins, at 10 km on Earth, and from which it has its whole share.
    const SINES: [f64; 2] = [0.06, 0.3];
    MOST * ((dip_rad.sin() - SINES[0]) / (SINES[1] - SINES[0])).clamp(0.0, 1.0)
}

/// Azimuth from the sun at which the sun has set at the limb, and the width about it in which the light changes much, in half turns, for a
/// sun at an elevation and a horizon at an angle below the horizontal.
fn terminator(sun_rad: f64, dip_rad: f64) -> (f64, f64) {
    /// Elevation of the sun at the limb amid the change, and half the change, rad.
    const MIDDLE_RAD: f64 = -5.0 * PI / 180.0;
    const HALF_RAD: f64 = 8.0 * PI / 180.0;
    /// Width that is even enough, half turns.
    const WIDEST: f64 = 10.0;
    // The sine of the sun's elevation at the limb is linear in the cosine of the azimuth.
    let per_cosine = (sun_rad.cos() * dip_rad.sin()).max(1e-9);
    let cosine = (MIDDLE_RAD.sin() - sun_rad.sin() * dip_rad.cos()) / per_cosine;
    // Where it never sets, columns are the more even the higher it stays.
    let width = HALF_RAD / per_cosine * cosine.abs().max(1.0) / PI;
    (cosine.clamp(-1.0, 1.0).acos() / PI, width.min(WIDEST))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coordinates(dip_deg: f64, sun_deg: f64, kink_deg: Option<f64>) -> TableCoordinates {
        let horizon_rad = -dip_deg.to_radians();
        let highest_rad = match dip_deg > 11.0 {
            true => horizon_rad + 0.04,
            false => FRAC_PI_2,
        };
        let grazing = kink_deg.map_or(horizon_rad, f64::to_radians);
        let (kink_rad, kink_place) = kink(grazing, (horizon_rad, highest_rad));
        let (dense_azimuth, dense_width) = terminator(sun_deg.to_radians(), dip_deg.to_radians());
        TableCoordinates {
            horizon_rad,
            highest_rad,
            kink_rad,
            kink_place,
            dense_share: dense_share(dip_deg.to_radians()),
            dense_azimuth,
            dense_width,
            even_below: -horizon_rad.sin(),
            jump_height_m: None,
        }
    }

    fn all() -> Vec<TableCoordinates> {
        let mut all = Vec::new();
        for dip_deg in [0.0, 0.05, 3.2, 19.8, 81.0] {
            for sun_deg in [90.0, 60.0, 5.0, -6.0, -18.0, -90.0] {
                for kink_deg in [None, Some(-0.6 * dip_deg), Some(-dip_deg + 1e-4)] {
                    all.push(coordinates(dip_deg, sun_deg, kink_deg));
                }
            }
        }
        all
    }

    #[test]
    fn places_and_their_inverses_agree() {
        for of in all() {
            for k in 0..=40 {
                let place = f64::from(k) / 40.0;
                for is_below in [false, true] {
                    let elevation = of.elevation_rad(place, is_below);
                    assert_eq!(elevation < of.horizon_rad, is_below, "{of:?}");
                    let got = of.row_place(elevation, is_below);
                    // The first row is off the horizon.
                    let is_right = (got - place).abs() < 1e-9;
                    assert!(is_right || k == 0, "{of:?}: {place} {got}");
                }
                let got = of.column_place(of.azimuth(place));
                assert!((got - place).abs() < 1e-9, "{of:?}: {place} {got}");
            }
        }
    }

    #[test]
    fn ends_are_those_of_the_table() {
        for of in all() {
            for azimuth in [0.0, 1.0] {
                assert!((of.column_place(azimuth) - azimuth).abs() < 1e-12);
            }
            assert!((of.elevation_rad(1.0, true) + FRAC_PI_2).abs() < 1e-12);
            assert!((of.elevation_rad(1.0, false) - of.highest_rad).abs() < 1e-12);
            assert_eq!(of.row_place(of.kink_rad, false), of.kink_place);
        }
    }

    /// From space, an eighth of the columns and more are within the five degrees after sunset.
    #[test]
    fn columns_are_dense_where_the_shadow_crosses_the_limb() {
        let of = coordinates(19.8, -4.0, None);
        let sunset = |sun_deg: f64| {
            let (sun, dip) = ((-4f64).to_radians(), 19.8f64.to_radians());
            let cosine =
                (sun_deg.to_radians().sin() - sun.sin() * dip.cos()) / (sun.cos() * dip.sin());
            cosine.acos() / PI
        };
        let columns = of.column_place(sunset(-8.0)) - of.column_place(sunset(-3.0));
        assert!(columns > 1.5 * (sunset(-8.0) - sunset(-3.0)), "{columns}");
        let low = coordinates(3.2, -4.0, None);
        assert_eq!(low.column_place(0.3), 0.3);
    }
}
