//! What a model honours and answers.

use super::input::Input;

/// Which inputs a model honours and which questions it answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// The inputs that change its result. [`check_inputs`](super::check_inputs) refuses every other input.
    pub inputs: &'static [Input],
    /// Names of its forms, the default first; empty for a model with one form.
    pub variants: &'static [&'static str],
    /// Whether it answers for a sun below the horizon.
    pub twilight: bool,
    /// Whether it knows how the light along a ray divides into single and multiple scattering and ground
    /// ([`RadianceView::line_of_sight`](super::RadianceView::line_of_sight)).
    pub parts: bool,
}

impl Capabilities {
    /// Whether an input changes the result.
    pub fn honours(&self, input: Input) -> bool {
        self.inputs.contains(&input)
    }
}
