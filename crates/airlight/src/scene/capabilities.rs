//! [`Capabilities`] of a model.

use super::input::Input;

/// The inputs that a model honours and the results that it provides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The inputs that change its result. [`check_inputs`](super::check_inputs) refuses every other input.
    pub inputs: &'static [Input],
    /// Names of its variants, the default first; empty for a model without variants.
    pub variants: &'static [&'static str],
    /// Whether it supports a sun below the horizon.
    pub twilight: bool,
    /// Whether it separates the light along a ray into single scattering, multiple scattering and ground
    /// ([`RadianceView::line_of_sight`](super::RadianceView::line_of_sight)).
    pub parts: bool,
}

impl Capabilities {
    /// Whether an input changes the model's result.
    pub fn honours(&self, input: Input) -> bool {
        self.inputs.contains(&input)
    }
}
