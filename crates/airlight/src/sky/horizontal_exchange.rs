//! Horizontal exchange of light between places under different suns, for the corrections of [`super::orders`].
//!
//! All orders of scattering in plane-parallel air amplify light by the number of times that it is scattered. Light that differs from
//! sun to sun is amplified less, as it spreads horizontally between scatterings. A correction that ignores this is too large,
//! alternates and grows in thick air. With the exchange `E` between two suns, light at each is
//!
//! ```text
//! w u + sum over the neighbours of E min(I, I') (u / I - u' / I') = w r,
//! ```
//!
//! where `w` is the area for which the sun stands, a ring round the place under the sun, and `I` the intensity at the same place:
//! light that is the same fraction of it under both suns is in balance. `u` is the part of `r` that
//! plane-parallel air amplifies. Light that spreads into a shadow, with which the iteration begins, follows the same equation with
//! equal intensities.
//!
//! By diffusion over the length `L` of the slowest decaying vertical mode the exchange over the distance `d` is `L^2 / d` times the
//! length of the border. All this only steers the iteration, whose result does not depend on it.

use super::air::Air;
use super::field::FieldGrid;
use super::light::Light;
use crate::spectrum::Spectrum;

/// Exchange between the suns of a grid.
#[derive(Debug)]
pub struct HorizontalExchange {
    /// Areas for which the suns stand, per length of a great circle over 2 pi.
    areas: Vec<f32>,
    /// Exchange between neighbours.
    exchange: Vec<f32>,
}

/// Factor of the exchange in corrections. Light between clouds and the ground spreads farther than `L`; corrections that are too small
/// only fall more slowly.
const CAUTION: f32 = 8.0;

impl HorizontalExchange {
    /// The exchange in an atmosphere, unless light spreads by much less than the distance between suns.
    pub fn new<const N: usize>(air: &Air<N>, grid: &FieldGrid) -> Option<Self> {
        /// Length in distances between suns below which spreading does not matter.
        const NEGLIGIBLE: f64 = 0.1;
        let length_m = length_m(air)?;
        let radius_m = air.shell().ground_radius_m;
        let zeniths: Vec<f64> = grid.sun_cosines.iter().map(|mu| mu.acos()).collect();
        let distances: Vec<f64> = zeniths
            .windows(2)
            .map(|z| radius_m * (z[0] - z[1]))
            .collect();
        let shortest = distances.iter().copied().fold(f64::INFINITY, f64::min);
        if length_m < NEGLIGIBLE * shortest {
            return None;
        }
        let borders: Vec<f64> = zeniths.windows(2).map(|z| 0.5 * (z[0] + z[1])).collect();
        let area = |k: usize| {
            let outer = k.checked_sub(1).map_or(zeniths[0], |k| borders[k]);
            let inner = borders.get(k).unwrap_or(&zeniths[k]);
            (radius_m * (inner.cos() - outer.cos())) as f32
        };
        let exchange = |(d, border): (&f64, &f64)| (length_m * length_m / d * border.sin()) as f32;
        Some(Self {
            areas: (0..zeniths.len()).map(area).collect(),
            exchange: distances.iter().zip(&borders).map(exchange).collect(),
        })
    }

    /// What `light` becomes by spreading.
    pub fn spread<const N: usize>(&self, light: &Light<N>) -> Light<N> {
        let mut out = light.clone();
        let even = self.areas.iter().map(|_| Spectrum::<N>::ONE);
        let balance = Balance::new(self, 1.0, even);
        for radius in out.moments.chunks_exact_mut(self.areas.len() * light.count) {
            balance.solve_moments(radius, light.count);
        }
        balance.solve(out.ground.iter_mut());
        out
    }

    /// The part of `change` that plane-parallel air amplifies, where there is `light`.
    pub fn amplified<const N: usize>(&self, light: &Light<N>, change: &Light<N>) -> Light<N> {
        let mut out = change.clone();
        let count = light.count;
        let radius = self.areas.len() * count;
        let lights = light.moments.chunks_exact(radius);
        for (out, light) in out.moments.chunks_exact_mut(radius).zip(lights) {
            let intensities = light.chunks_exact(count).map(|point| point[0]);
            Balance::new(self, CAUTION, intensities).solve_moments(out, count);
        }
        Balance::new(self, CAUTION, light.ground.iter().copied()).solve(out.ground.iter_mut());
        out
    }
}

/// Factorised equations of the exchange at one radius.
struct Balance<const N: usize> {
    areas: Vec<Spectrum<N>>,
    /// Exchange with the next sun over the intensity at this sun and at the next.
    to_next: Vec<[Spectrum<N>; 2]>,
    inverse_diagonal: Vec<Spectrum<N>>,
}

impl<const N: usize> Balance<N> {
    /// Equations with the exchange times `factor`.
    fn new(
        exchange: &HorizontalExchange,
        factor: f32,
        intensities: impl Iterator<Item = Spectrum<N>>,
    ) -> Self {
        let intensities: Vec<_> = intensities.map(|i| i.max_scalar(1e-30)).collect();
        let to_next: Vec<_> = intensities
            .windows(2)
            .zip(&exchange.exchange)
            .map(|(pair, exchange)| {
                let least = Spectrum::from_fn(|lane| pair[0][lane].min(pair[1][lane]));
                [0, 1].map(|k| least * (factor * exchange) / pair[k])
            })
            .collect();
        let areas: Vec<_> = exchange.areas.iter().map(|a| Spectrum::splat(*a)).collect();
        let mut inverse_diagonal = Vec::<Spectrum<N>>::with_capacity(areas.len());
        // What the diagonal exceeds the exchange with the next sun by, without a difference of large numbers.
        let mut excess = Spectrum::ZERO;
        for (sun, area) in areas.iter().enumerate() {
            if sun > 0 {
                excess *= to_next[sun - 1][1] * inverse_diagonal[sun - 1];
            }
            excess += *area;
            let next = to_next.get(sun).map_or(Spectrum::ZERO, |[here, _]| *here);
            inverse_diagonal.push(Spectrum::ONE / (excess + next));
        }
        Self {
            areas,
            to_next,
            inverse_diagonal,
        }
    }

    /// Replaces moments `[sun][moment]` by the solution.
    fn solve_moments(&self, moments: &mut [Spectrum<N>], count: usize) {
        for moment in 0..count {
            self.solve(moments[moment..].iter_mut().step_by(count));
        }
    }

    /// Replaces values under each sun by the solution.
    fn solve<'v>(&self, values: impl Iterator<Item = &'v mut Spectrum<N>>) {
        let mut values: Vec<_> = values.collect();
        for sun in 0..values.len() {
            *values[sun] *= self.areas[sun];
            if sun > 0 {
                let earlier = *values[sun - 1] * self.inverse_diagonal[sun - 1];
                *values[sun] += earlier * self.to_next[sun - 1][0];
            }
        }
        for sun in (0..values.len()).rev() {
            if sun + 1 < values.len() {
                let next = *values[sun + 1];
                *values[sun] += next * self.to_next[sun][1];
            }
            *values[sun] *= self.inverse_diagonal[sun];
        }
    }
}

/// Distance over which light spreads horizontally, m: the altitude above which the air has an optical depth of 1, if it has.
fn length_m<const N: usize>(air: &Air<N>) -> Option<f64> {
    const STEPS: usize = 400;
    let shell = air.shell();
    (0..STEPS)
        .rev()
        .map(|step| shell.radius_of_coordinate(step as f64 / STEPS as f64))
        .find(|&radius_m| {
            let columns = shell.vertical_columns_m(radius_m);
            air.coefficients.extinction(&columns).max_element() >= 1.0
        })
        .map(|radius_m| radius_m - shell.ground_radius_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUNS: usize = 6;

    fn exchange() -> HorizontalExchange {
        HorizontalExchange {
            areas: vec![0.5, 1.0, 1.5, 1.5, 1.0, 0.5],
            exchange: vec![3.0, 2.0, 4.0, 2.0, 3.0],
        }
    }

    /// Light at one radius with one moment.
    fn light(values: [f32; SUNS]) -> Light<4> {
        Light {
            count: 1,
            moments: values.map(Spectrum::splat).to_vec(),
            ground: values.map(Spectrum::splat).to_vec(),
        }
    }

    /// From day to a shadow.
    const INTENSITIES: [f32; SUNS] = [2.0, 1.0, 0.3, 1e-3, 1e-6, 1e-10];

    #[test]
    fn light_in_balance_is_amplified_whole() {
        let change = INTENSITIES.map(|i| 0.1 * i);
        let amplified = exchange().amplified(&light(INTENSITIES), &light(change));
        for values in [&amplified.moments, &amplified.ground] {
            for (got, want) in values.iter().zip(change) {
                assert!((got[0] / want - 1.0).abs() < 1e-5, "{} {want}", got[0]);
            }
        }
    }

    /// Exchange neither adds nor removes light.
    #[test]
    fn all_light_is_conserved() {
        let change = [1.0, -0.7, 0.2, 3e-3, -1e-5, 1e-9];
        let amplified = exchange().amplified(&light(INTENSITIES), &light(change));
        let sum = |values: &mut dyn Iterator<Item = f32>| -> f32 {
            values.zip(exchange().areas).map(|(v, w)| v * w).sum()
        };
        let got = sum(&mut amplified.moments.iter().map(|v| v[0]));
        let want = sum(&mut change.into_iter());
        assert!((got / want - 1.0).abs() < 1e-5, "{got} {want}");
    }

    #[test]
    fn light_spreads_into_a_shadow() {
        let light = light([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let spread = exchange().spread(&light);
        assert!(
            spread.moments.is_sorted_by(|a, b| a[0] > b[0]),
            "{spread:?}"
        );
        assert!(spread.ground[SUNS - 1][0] > 0.0);
    }

    #[test]
    fn light_that_alternates_is_hardly_amplified() {
        let change = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
        let amplified = exchange().amplified(&light([1.0; SUNS]), &light(change));
        for value in &amplified.moments {
            assert!(value[0].abs() < 0.2, "{}", value[0]);
        }
    }

    /// A shadow does not disturb the light beside it.
    #[test]
    fn changes_in_a_shadow_stay_there() {
        let change = [0.0, 0.0, 0.0, 0.0, 0.0, 1e-9];
        let amplified = exchange().amplified(&light(INTENSITIES), &light(change));
        assert!(amplified.moments[0][0].abs() < 1e-8);
    }
}
