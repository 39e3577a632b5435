//! Time that passes: by itself, in the frames of a time-lapse, and in the passes of the device.

use super::Viewer;
#[cfg(not(target_arch = "wasm32"))]
use crate::time_lapse::Step;
use crate::timers::Times;
use eframe::egui::Ui;

/// Longest time that passes between two frames, s: after a pause, time goes on from where it stood.
const LONGEST_FRAME_S: f32 = 0.1;

impl Viewer {
    /// Lets time pass in a scene whose sun follows from it.
    pub(super) fn pass_time(&mut self, ui: &Ui) {
        let sun = &mut self.state.scene.sun;
        self.play.is_on &= sun.elevation_deg.is_none();
        if self.play.is_on {
            let elapsed_s = f64::from(ui.input(|i| i.stable_dt.min(LONGEST_FRAME_S)));
            self.play.advance(&mut sun.time, elapsed_s);
            ui.ctx().request_repaint();
        }
    }

    /// Turns the timers of passes on or off, and takes what they measured.
    pub(super) fn take_times(&mut self, ui: &Ui) {
        let is_wanted = !matches!(self.times, Times::Off);
        if is_wanted != self.is_timed {
            self.is_timed = is_wanted;
            if !self.picture.set_timed(is_wanted) {
                self.times = Times::Missing;
            }
            // A picture to time.
            self.drawn = None;
        }
        if let Some(times) = self.picture.take_times() {
            self.times = Times::On(Some(times));
        }
        if self.picture.awaits_times() {
            ui.ctx().request_repaint();
        }
    }

    /// Shows the next picture of a time-lapse, or meters or saves the one that is shown.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn advance_time_lapse(&mut self, ui: &Ui) {
        let Some(lapse) = &mut self.time_lapse else {
            return;
        };
        ui.ctx().request_repaint();
        let Some((scene, to_do)) = lapse.step() else {
            let [saved, _] = lapse.progress();
            self.state.scene = lapse.before().clone();
            self.time_lapse = None;
            self.notice = Some(format!("{saved} pictures are saved"));
            return;
        };
        if self.state.scene != scene {
            self.state.scene = scene;
            return;
        }
        let is_lit = self.is_lit();
        if let Some(sentence) = self.error.clone().filter(|_| is_lit) {
            return self.stop_time_lapse(sentence);
        }
        let (true, Some((_, exposure))) = (is_lit && self.is_drawn(), &self.metered) else {
            return;
        };
        let ev100 = exposure.ev100();
        if let Step::Save(file) = &to_do
            && let Err(sentence) = self.save(file)
        {
            return self.stop_time_lapse(sentence);
        }
        if let Some(lapse) = &mut self.time_lapse {
            lapse.finish_step(ev100);
        }
    }

    /// Whether the last picture is that of the last light.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn is_drawn(&self) -> bool {
        self.drawn.is_some_and(|(number, _)| number == self.number)
    }

    /// Ends a time-lapse before its end.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn stop_time_lapse(&mut self, sentence: String) {
        if let Some(lapse) = self.time_lapse.take() {
            self.state.scene = lapse.before().clone();
            self.notice = Some(sentence);
        }
    }
}
