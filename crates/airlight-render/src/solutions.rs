//! [`Solutions`]: solved light that several pictures share.

use crate::error::RenderError;
use crate::renderer::Renderer;
use airlight::scene::{Input, PreparedModel, ResolvedScene};
use airlight::sky::SunCoverage;
use airlight_image::Control;
use std::sync::Arc;

/// Solved light that several pictures share: those of the same solver, air and range of suns, whatever their cameras, the azimuth of
/// the sun and, for solvers that can exchange it, their fog.
#[derive(Debug, Default)]
pub struct Solutions {
    solved: Vec<Solution>,
}

#[derive(Debug)]
struct Solution {
    model: &'static str,
    scene: ResolvedScene,
    suns: SunCoverage,
    prepared: Arc<dyn PreparedModel>,
}

impl Solutions {
    /// Number of solutions.
    pub fn len(&self) -> usize {
        self.solved.len()
    }

    /// Whether nothing was solved yet.
    pub fn is_empty(&self) -> bool {
        self.solved.is_empty()
    }

    /// [`Renderer::prepare`], or the light of an earlier call.
    ///
    /// # Errors
    /// As [`Renderer::prepare`].
    pub fn prepare(
        &mut self,
        renderer: &Renderer,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, RenderError> {
        let scene = renderer.resolved();
        let name = renderer.model().name();
        let same = |solution: &&Solution| {
            solution.model == name && solution.suns == suns && have_same_air(&solution.scene, scene)
        };
        for solution in self.solved.iter().filter(same) {
            let prepared = match solution.scene.fog == scene.fog {
                true => Some(solution.prepared.clone()),
                false => solution.prepared.with_fog(scene.fog.as_ref()),
            };
            if let Some(prepared) = prepared {
                return Ok(prepared);
            }
        }
        let prepared = renderer.prepare(suns, control)?;
        self.solved.push(Solution {
            model: name,
            scene: scene.clone(),
            suns,
            prepared: prepared.clone(),
        });
        Ok(prepared)
    }
}

/// Whether scenes are the same in what is solved for, except for the fog. The position of the sun enters by the range of suns.
fn have_same_air(a: &ResolvedScene, b: &ResolvedScene) -> bool {
    let inputs = |scene: &ResolvedScene| -> Vec<Input> {
        let of_fog = [Input::Fog, Input::FogScattering, Input::FogPatches];
        let inputs = scene.set_inputs.iter().copied();
        inputs.filter(|input| !of_fog.contains(input)).collect()
    };
    a.atmosphere == b.atmosphere
        && a.grid == b.grid
        && a.observer_altitude_m == b.observer_altitude_m
        && a.night == b.night
        && a.has_objects == b.has_objects
        && a.solver == b.solver
        && inputs(a) == inputs(b)
        // Solvers refuse some fogs with polarisation.
        && (a.fog == b.fog || !a.set_inputs.contains(&Input::Polarisation))
}
