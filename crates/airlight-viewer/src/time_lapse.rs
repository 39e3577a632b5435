//! [`TimeLapse`]: pictures of a sequence of times, saved one after another as the window shows them.

use airlight::scene::{Exposure, Scene, SequenceSpec};
use airlight_render::sequence::SequenceStep;
use airlight_render::{RenderError, Renderer};
use std::path::{Path, PathBuf};

/// Pictures that are being saved: one step after another is shown, and metered or saved once it is there.
#[derive(Debug)]
pub struct TimeLapse {
    /// The scene before, which is shown again in the end.
    before: Scene,
    steps: Vec<SequenceStep>,
    /// Places among the steps that are metered, the next one last.
    to_meter: Vec<usize>,
    /// The exposure that all pictures share, EV at ISO 100, as far as they are metered together.
    common_ev100: Option<f64>,
    next: usize,
}

/// What is to be done with the picture of a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Its exposure is metered.
    Meter,
    /// It is saved in a file.
    Save(PathBuf),
}

impl TimeLapse {
    /// The pictures of a scene's sequence, of a size, with the names that `airlight sky` gives to those of a file.
    ///
    /// # Errors
    /// [`RenderError`] for a scene without a sequence, with a fixed sun, or with invalid times.
    pub fn new(scene: &Scene, size: [u32; 2], file: &Path) -> Result<Self, RenderError> {
        let mut listed = scene.clone();
        // What the sky's solver would refuse, and needs not know here.
        (listed.lights, listed.objects) = (Vec::new(), None);
        listed.camera.size = Some(size);
        listed.output.file = Some(file.display().to_string());
        let sequence = Renderer::new(&listed)?.sequence()?.ok_or_else(|| {
            RenderError::setting(
                "expected a sequence with a duration and an interval, got one picture",
            )
        })?;
        let steps = sequence.steps().to_vec();
        let meters_each = |sequence: &SequenceSpec| sequence.meter_each == Some(true);
        let exposure = scene.output.exposure.unwrap_or(Exposure::AUTO);
        let is_shared = matches!(exposure, Exposure::Metered(_))
            && !scene.sequence.as_ref().is_some_and(meters_each);
        let last = steps.len().saturating_sub(1);
        Ok(Self {
            before: scene.clone(),
            to_meter: match is_shared {
                true => vec![last, last / 2, 0],
                false => Vec::new(),
            },
            steps,
            common_ev100: None,
            next: 0,
        })
    }

    /// Number of pictures that are saved, and of all.
    pub fn progress(&self) -> [usize; 2] {
        [self.next, self.steps.len()]
    }

    /// The scene to show next, and what to do with its picture; `None` at the end.
    pub fn step(&self) -> Option<(Scene, Step)> {
        let mut scene = self.before.clone();
        let (step, to_do) = match self.to_meter.last() {
            Some(place) => {
                // Brightening is added to the metered exposure.
                scene.output.brighten = None;
                (&self.steps[*place], Step::Meter)
            }
            None => {
                let step = self.steps.get(self.next)?;
                (step, Step::Save(step.path.clone()))
            }
        };
        scene.sun.time = Some(step.time.to_string());
        if let (Some(ev100), Step::Save(_)) = (self.common_ev100, &to_do) {
            scene.output.exposure = Some(Exposure::Ev100(ev100));
        }
        Some((scene, to_do))
    }

    /// Goes on after a step whose picture was exposed at an EV.
    pub fn finish_step(&mut self, ev100: f64) {
        match self.to_meter.pop() {
            // All are exposed as the brightest.
            Some(_) => {
                let most = self.common_ev100.map_or(ev100, |before| before.max(ev100));
                self.common_ev100 = Some(most);
            }
            None => self.next += 1,
        }
    }

    /// The scene to show in the end.
    pub fn before(&self) -> &Scene {
        &self.before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(more: &str) -> Scene {
        let text = format!(
            "sun = {{ latitude_deg = 48.9, longitude_deg = 2.3, time = \"2026-06-21T18:00:00+02:00\" }}\n\
             sequence = {{ until = \"+2h\", every = \"1h\" }}\n{more}"
        );
        Scene::from_toml(&text).unwrap()
    }

    #[test]
    fn pictures_are_metered_together_and_named_as_those_of_the_program() {
        let size = [64, 32];
        let mut lapse =
            TimeLapse::new(&scene("output.brighten = 1"), size, Path::new("a.png")).unwrap();
        let mut seen = Vec::new();
        for ev100 in [12.0, 14.0, 9.0, 1.0, 1.0, 1.0] {
            let (scene, step) = lapse.step().unwrap();
            let time = scene.sun.time.unwrap();
            let hour = time.split('T').nth(1).unwrap()[..2].to_owned();
            seen.push((hour, scene.output.brighten, scene.output.exposure, step));
            lapse.finish_step(ev100);
        }
        assert_eq!(lapse.step(), None);
        assert_eq!(lapse.progress(), [3, 3]);
        let metered = |hour: &str| (hour.to_owned(), None, None, Step::Meter);
        let saved = |hour: &str, name: &str| {
            let exposure = Some(Exposure::Ev100(14.0));
            (
                hour.to_owned(),
                Some(1.0),
                exposure,
                Step::Save(name.into()),
            )
        };
        assert_eq!(
            seen,
            [
                metered("18"),
                metered("19"),
                metered("20"),
                saved("18", "a.0001.png"),
                saved("19", "a.0002.png"),
                saved("20", "a.0003.png"),
            ]
        );
        let mut each = scene("");
        each.sequence.as_mut().unwrap().meter_each = Some(true);
        for scene in [scene("output.exposure = 12"), each] {
            let lapse = TimeLapse::new(&scene, size, Path::new("a.png")).unwrap();
            let (_, step) = lapse.step().unwrap();
            assert_eq!(step, Step::Save("a.0001.png".into()));
        }
    }

    #[test]
    fn one_picture_and_a_fixed_sun_are_refused() {
        let mut one = scene("");
        one.sequence = None;
        let mut fixed = scene("");
        fixed.sun = Scene::from_toml("sun.elevation_deg = 5").unwrap().sun;
        for scene in [one, fixed] {
            let error = TimeLapse::new(&scene, [8, 8], Path::new("a.png")).unwrap_err();
            assert!(error.to_string().contains("expected"), "{error}");
        }
    }
}
