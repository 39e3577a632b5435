//! The skies of other suites solved with the fine settings.

use crate::check::{Check, Suite, Unit};
use crate::{limits, random_airs, skies};
use airlight::sky::SkySettings;
use airlight::{Cancelled, Control};

/// Claimed bound on the error of each radiance, beyond three standard errors of its reference, percent.
pub const LIMIT: f64 = 0.5;

/// All comparisons of radiances with [`SkySettings::fine`], where the reference is as right: by day, in twilight and in random airs, around
/// the sun, at the horizon and in thick air.
///
/// # Errors
/// [`Cancelled`].
pub fn checks(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let settings = SkySettings::fine();
    let mut checks = [
        skies::against_monte_carlo(&settings, control)?,
        skies::against_truth(&settings, control)?,
        limits::checks(&settings, control)?,
        random_airs::checks(&settings, control)?,
    ]
    .concat();
    checks.retain(|check| check.unit == Unit::Percent);
    for check in &mut checks {
        (check.suite, check.limit) = (Suite::Fine, Some(LIMIT));
    }
    Ok(checks)
}
