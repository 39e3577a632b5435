//! Refusal of inputs that a model would ignore.

use super::error::SceneError;
use super::input::Input;
use super::model::RadianceModel;

/// Refuses inputs that a model would ignore, and variants that it does not have. `set` are the inputs that are set
/// explicitly, `variant` is the variant requested, `all` are the models from which alternatives are suggested.
///
/// # Errors
/// [`SceneError::IgnoredInput`] for the first input that the model ignores, [`SceneError::UnknownVariant`] for a variant
/// that it does not have.
pub fn check_inputs(
    model: &dyn RadianceModel,
    set: &[Input],
    variant: Option<&str>,
    all: &[&dyn RadianceModel],
) -> Result<(), SceneError> {
    let capabilities = model.capabilities();
    if let Some(&input) = set.iter().find(|input| !capabilities.honours(**input)) {
        let honoured_by = all
            .iter()
            .filter(|other| other.capabilities().honours(input));
        return Err(SceneError::IgnoredInput {
            input,
            model: model.name(),
            honoured_by: honoured_by.map(|other| other.name()).collect(),
        });
    }
    match variant {
        Some(variant) if !capabilities.variants.contains(&variant) => {
            Err(SceneError::UnknownVariant {
                got: variant.to_owned(),
                model: model.name(),
                variants: capabilities.variants,
            })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Capabilities, PreparedModel, ResolvedScene};
    use super::*;
    use crate::control::Control;
    use crate::sky::SunCoverage;
    use std::sync::Arc;

    /// A model with a name, inputs and variants.
    #[derive(Debug)]
    struct Named(&'static str, &'static [Input], &'static [&'static str]);

    impl RadianceModel for Named {
        fn name(&self) -> &'static str {
            self.0
        }

        fn summary(&self) -> &'static str {
            ""
        }

        fn capabilities(&self) -> Capabilities {
            Capabilities {
                inputs: self.1,
                variants: self.2,
                twilight: false,
                parts: false,
            }
        }

        fn prepare(
            &self,
            _scene: &ResolvedScene,
            _suns: SunCoverage,
            _control: Control<'_>,
        ) -> Result<Arc<dyn PreparedModel>, SceneError> {
            Err(SceneError::Distance(0.0))
        }
    }

    #[test]
    fn errors_for_ignored_inputs_suggest_other_models() {
        let formula = Named("formula", &[Input::Haze], &["printed", "corrected"]);
        let first = Named("first", &[Input::Ozone, Input::Haze], &[]);
        let second = Named("second", &[Input::Ozone], &[]);
        let all: [&dyn RadianceModel; 3] = [&formula, &first, &second];
        let check = |model: &Named, set: &[Input], variant| {
            check_inputs(model, set, variant, &all).map_err(|error| error.to_string())
        };
        assert_eq!(check(&formula, &[Input::Haze], Some("printed")), Ok(()));
        assert_eq!(
            check(&formula, &[Input::Haze, Input::Ozone], None).unwrap_err(),
            "air.ozone_du: expected a solver that honours the ozone column, got formula; try first or second"
        );
        assert_eq!(
            check(&first, &[Input::Lights], None).unwrap_err(),
            "lights: expected a solver that honours lights, got first; try leaving it out, as no solver does"
        );
        assert_eq!(
            check(&formula, &[], Some("fixed")).unwrap_err(),
            "solver.variant: expected a variant of formula, got \"fixed\"; try printed or corrected"
        );
        assert_eq!(
            check(&first, &[], Some("fixed")).unwrap_err(),
            "solver.variant: expected a variant of first, got \"fixed\"; try leaving it out, as it has no variants"
        );
    }
}
