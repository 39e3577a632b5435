//! All orders of scattering in spherical geometry.
//!
//! Light is what the sun's light becomes by being scattered or reflected once, plus itself scattered or reflected once more
//! ([`super::transport`]). The iteration starts with the light of plane-parallel air ([`super::plane_parallel`]). Each step adds the
//! light that is missing in the equation together with all orders of its scattering in plane-parallel air: what remains falls by the
//! small difference between spherical and plane-parallel air, in thin and in thick air alike; light that in thick air spreads from
//! place to place is left out of that sum, and begins with some light in shadows ([`super::horizontal_exchange`]). Where what remains does
//! not fall fast, [`super::mixing`] combines the corrections; before that, in shadows, [`super::damping`] reduces those that alternate.

use super::air::Air;
use super::damping::Damping;
use super::field::{Diffuse, FieldGrid};
use super::harmonics::Harmonics;
use super::horizon::{self, ByDirection};
use super::horizontal_exchange::HorizontalExchange;
use super::mixing::Mixing;
use super::settings::{OrderSettings, SkyError};
use super::transport::Transport;
use crate::control::Control;

/// Number of iterations in a row whose changes grow, after which the solver starts combining corrections from none, or gives up where
/// it does not combine any.
const MAX_GROWING: usize = 5;

/// Fraction of the last change from which on changes fall slowly.
const SLOW: f32 = 0.5;

/// Change below which corrections are combined: larger ones are those of light on its way into a shadow.
const SHAPED: f32 = 0.2;

/// Factor of the last change above which earlier steps are forgotten.
const RESTART: f32 = 10.0;

/// Ratios of the second change to the first that are expected where light does not spread horizontally, in shadow and in light: in clear
/// and hazy air they are 0.1 to 0.2 in shadow. In light second changes of 69 skies were at most 0.16 %, and those after first ones above
/// 3 % at most 0.026 of them.
const EXPECTED: [f32; 2] = [1.0 / 3.0, 0.015];

/// Weight of changes in shadow, which are those under suns below the horizon, but by day: little of the light in the planet's shadow
/// reaches an eye. By twilight, skies at the ground are wrong by less than a third of it.
const SHADOW: f32 = 1.0 / 8.0;

/// Solves for all light scattered or reflected at least once, with or without its polarisation. Changes of the light under other suns
/// than `eye_sun` count as much as they change what an eye under that sun sees. `report` receives the fraction of the work done.
///
/// # Errors
/// [`SkyError::Cancelled`] soon after cancellation; [`SkyError::NotConverged`].
pub fn solve<const N: usize>(
    real_air: &Air<N>,
    (grid, eye_sun): (FieldGrid, Option<usize>),
    settings: &OrderSettings,
    polarised: bool,
    control: Control<'_>,
    report: impl Fn(f64),
) -> Result<Diffuse<N>, SkyError> {
    // Approximate progress after the first order, and after the paths of later orders are prepared.
    const FIRST: f64 = 0.3;
    const PATHS: f64 = 0.5;
    let air = real_air.without_forward_peaks(settings.peak_degree);
    let basis = Harmonics::new(settings.degree);
    let transport = |degree, directions| {
        let light = (degree, polarised);
        Transport::new((&air, &grid, &basis), light, directions, control)
    };
    let (once, once_by_direction) = transport(0, &settings.first)?.sunlight()?;
    report(FIRST);
    let transport = transport(settings.rescattered_degree, &settings.later)?;
    report(PATHS);
    let mut light = once.clone();
    let mut error = 0.0;
    let mut by_direction: Option<ByDirection<N>> = None;
    let all_suns = 0..grid.sun_cosines.len();
    if let Some(orders) = settings.only_orders {
        let mut order = once;
        for _ in 1..orders {
            order = transport
                .scattered(&order.field(&grid, &basis), &all_suns)?
                .0;
            light.add(&order);
        }
    } else {
        let plane_parallel = transport.plane_parallel()?;
        let exchange = HorizontalExchange::new(&air, &grid);
        light = plane_parallel.all_orders(&once, &all_suns);
        if let Some(exchange) = &exchange {
            light = exchange.spread(&light);
        }
        // The first suns are those below the horizon.
        let mut in_shadow = grid.sun_cosines.partition_point(|&mu_sun| mu_sun < 0.0);
        if eye_sun.is_some_and(|sun| sun >= in_shadow) {
            in_shadow = 0;
        }
        let (mut last, mut converged, mut growing, mut iterations) = (f32::INFINITY, false, 0, 0);
        let mut mixing: Option<Mixing<N>> = None;
        let mut damping = Damping::new();
        // The suns whose light is computed again, and the estimated error of each.
        let (mut suns, mut errors) = (all_suns.clone(), vec![0.0f32; all_suns.len()]);
        while iterations < settings.max_iterations && growing < MAX_GROWING {
            iterations += 1;
            let field = light.field(&grid, &basis);
            let (mut missing, directions) = transport.scattered(&field, &suns)?;
            match &mut by_direction {
                Some(known) => horizon::replace(known, &directions, (&suns, all_suns.len())),
                None => by_direction = Some(directions),
            }
            missing.add(&once);
            missing.subtract(&light);
            missing.keep(&suns);
            let mut correction = match &exchange {
                Some(exchange) => {
                    let amplified = exchange.amplified(&light, &missing);
                    missing.subtract(&amplified);
                    let mut correction = plane_parallel.all_orders(&amplified, &suns);
                    correction.add(&missing);
                    correction
                }
                None => plane_parallel.all_orders(&missing, &suns),
            };
            let changes = light.changes_by(&correction, eye_sun);
            let change = changes.iter().copied().fold(0.0, f32::max);
            // Steps on the way into a shadow, or from which changes grow, say nothing about the next.
            if change > SHAPED || change > RESTART * last {
                mixing = None;
            } else if change > SLOW * last && mixing.is_none() {
                mixing = Some(Mixing::new());
            }
            match &mut mixing {
                Some(mixing) => light.correct(&mixing.step(&light, &correction)),
                None => {
                    damping.limit(&mut correction);
                    light.correct(&correction);
                }
            }
            // The changes fall by a nearly constant factor, or unevenly where corrections are combined; the first is the light that is
            // missing in the beginning.
            let ratios = match last.is_finite() {
                true if mixing.is_some() => [(change / last).max(SLOW); 2],
                true => [change / last; 2],
                false if exchange.is_none() => EXPECTED,
                false => [1.0; 2],
            };
            let [later_in_shadow, later_in_light] =
                ratios.map(|ratio| ratio / (1.0 - ratio.min(0.99)));
            for sun in suns.clone() {
                errors[sun] = match sun < in_shadow {
                    true => SHADOW * changes[sun] * later_in_shadow,
                    false => changes[sun] * later_in_light,
                };
            }
            error = errors.iter().copied().fold(0.0, f32::max);
            converged = error < settings.tolerance;
            // Steady changes do not count: light that falls to a tenth in each iteration is on its way into a shadow. Changes
            // that are not even finite grow.
            growing = if change <= 1.01 * last {
                0
            } else {
                growing + 1
            };
            if growing == MAX_GROWING && mixing.is_some() {
                // The earlier steps mislead.
                (mixing, growing) = (None, 0);
            }
            last = change;
            if converged {
                break;
            }
            // Where light does not spread from sun to sun, that under the others is settled.
            suns = all_suns.clone();
            if exchange.is_none() && mixing.is_none() {
                let wrong = |error: &f32| *error >= settings.tolerance;
                if let (Some(first), Some(last)) = (
                    errors.iter().position(wrong),
                    errors.iter().rposition(wrong),
                ) {
                    suns = first..last + 1;
                }
            }
            let done = f64::from(error.ln() / settings.tolerance.ln()).clamp(0.0, 1.0);
            report(PATHS + (1.0 - PATHS) * done);
        }
        if !converged {
            return Err(SkyError::NotConverged { error, iterations });
        }
    }
    let mut field = light.field(&grid, &basis);
    if let Some(by_direction) = by_direction {
        let parts = [
            (&once_by_direction, &settings.first),
            (&by_direction, &settings.later),
        ];
        let air = (real_air, &air);
        let nodes = (&grid.radii_m[..], grid.sun_cosines.len());
        if let Some(correction) = horizon::correction(air, nodes, settings.peak_degree, &parts) {
            field = field.with_horizon(&correction);
        }
    }
    Ok(Diffuse { field, air, error })
}
