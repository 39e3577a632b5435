//! [`Beside`]: what is computed beside the picture, to judge it: a spectrum, the error of the picture, another model's picture.

use crate::compute::{Answer, Light, Output, Request, Spectrum, Task};
use crate::platform::Worker;
use crate::truth::{self, Difference, Statistics};
use airlight::glam::DVec3;
use airlight::models::registry;
use airlight::scene::Scene;
use airlight_image::Frame;

/// Pixels, across and up, at which the picture is checked against the solver.
const CHECKED: [u32; 2] = [16, 12];

/// What is wanted for a light.
#[derive(Clone, Debug)]
pub struct Wanted<'a> {
    /// Number of the light.
    pub number: u64,
    /// The light.
    pub light: &'a Light,
    /// The scene that it is of.
    pub scene: &'a Scene,
    /// Projection and size of the picture.
    pub frame: Frame,
    /// Direction of the spectrum.
    pub direction: Option<DVec3>,
    /// Model to compare with, and the size of its picture.
    pub model: Option<(&'a str, [u32; 2])>,
}

/// A picture of a model for a light.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    of: Question,
    /// Width and height.
    pub size: [u32; 2],
    /// Red, green and blue, cd/m^2.
    pub rgb: Vec<[f32; 3]>,
    /// Differences of the picture that is drawn.
    pub differences: Vec<Option<Difference>>,
    /// Their statistics.
    pub statistics: Option<Statistics>,
    /// Inputs that the model ignores.
    pub ignored: Vec<String>,
}

/// Computes what is wanted, one after another.
#[derive(Debug)]
pub struct Beside {
    worker: Worker,
    number: u64,
    asked: Option<Question>,
    spectrum: Option<(Question, Spectrum)>,
    check: Option<(Question, Statistics)>,
    comparison: Option<Comparison>,
    /// A question without an answer, and why.
    refused: Option<(Question, String)>,
}

/// A question about the light with a number.
#[derive(Clone, Debug, PartialEq)]
enum Question {
    Spectrum(u64, DVec3),
    Check(u64, Frame),
    Compare(u64, Frame, [u32; 2], String),
}

impl Beside {
    /// `wake` is called after each answer.
    pub fn new(wake: impl Fn() + Send + 'static) -> Self {
        Self {
            worker: Worker::new(wake),
            number: 0,
            asked: None,
            spectrum: None,
            check: None,
            comparison: None,
            refused: None,
        }
    }

    /// Takes answers, and asks the next question.
    pub fn update(&mut self, wanted: &Wanted<'_>) {
        while let Some(answer) = self.worker.receive() {
            self.take(answer, wanted);
        }
        if self.asked.is_none()
            && let Some(question) = self.next(wanted)
        {
            self.number += 1;
            let request = Request {
                number: self.number,
                scene: wanted.scene.clone(),
                task: task(&question),
            };
            if self.worker.send(request) {
                self.asked = Some(question);
            }
        }
    }

    /// Whether all that is wanted is there, or refused.
    pub fn is_current(&self, wanted: &Wanted<'_>) -> bool {
        self.asked.is_none() && self.next(wanted).is_none()
    }

    /// Waits for an answer.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(&mut self, wanted: &Wanted<'_>) {
        if self.asked.is_some()
            && let Some(answer) = self.worker.wait()
        {
            self.take(answer, wanted);
        }
    }

    /// The spectrum in the wanted direction.
    pub fn spectrum(&self, wanted: &Wanted<'_>) -> Option<&Spectrum> {
        let question = Question::Spectrum(wanted.number, wanted.direction?);
        let (of, spectrum) = self.spectrum.as_ref()?;
        (*of == question).then_some(spectrum)
    }

    /// Differences of the picture from the solver, over the whole of it.
    pub fn check(&self, wanted: &Wanted<'_>) -> Option<&Statistics> {
        let (of, statistics) = self.check.as_ref()?;
        (*of == Question::Check(wanted.number, wanted.frame)).then_some(statistics)
    }

    /// The wanted comparison.
    pub fn comparison(&self, wanted: &Wanted<'_>) -> Option<&Comparison> {
        let question = compare(wanted)?;
        self.comparison.as_ref().filter(|c| c.of == question)
    }

    /// Why there is no comparison, as a sentence.
    pub fn refusal(&self, wanted: &Wanted<'_>) -> Option<&str> {
        let question = compare(wanted)?;
        let (of, sentence) = self.refused.as_ref()?;
        (*of == question).then_some(sentence.as_str())
    }

    /// The next question: what is shown first, the check last.
    fn next(&self, wanted: &Wanted<'_>) -> Option<Question> {
        let spectrum = wanted
            .direction
            .map(|d| Question::Spectrum(wanted.number, d));
        let check = Some(Question::Check(wanted.number, wanted.frame));
        let is_open = |question: &Question| {
            let answered = match question {
                Question::Spectrum(..) => self.spectrum.as_ref().map(|(of, _)| of),
                Question::Check(..) => self.check.as_ref().map(|(of, _)| of),
                Question::Compare(..) => self.comparison.as_ref().map(|c| &c.of),
            };
            answered != Some(question) && self.refused.as_ref().map(|(of, _)| of) != Some(question)
        };
        [spectrum, compare(wanted), check]
            .into_iter()
            .flatten()
            .find(is_open)
    }

    fn take(&mut self, answer: Answer, wanted: &Wanted<'_>) {
        let Some(question) = self.asked.take() else {
            return;
        };
        let number = match question {
            Question::Spectrum(number, _) | Question::Check(number, _) => number,
            Question::Compare(number, ..) => number,
        };
        if number != wanted.number {
            return;
        }
        match (answer.result, &question) {
            (Ok(Output::Spectrum(spectrum)), _) => self.spectrum = Some((question, spectrum)),
            (Ok(Output::Colours(colours)), Question::Check(_, frame)) => {
                let directions = truth::directions(frame, CHECKED);
                let differences = truth::differences(wanted.light, &directions, &colours);
                let found = truth::statistics(wanted.light, &directions, &differences);
                self.check = Some((question, found.unwrap_or_default()));
            }
            (Ok(Output::Colours(colours)), Question::Compare(_, frame, size, _)) => {
                let size = *size;
                let directions = truth::directions(frame, size);
                let differences = truth::differences(wanted.light, &directions, &colours);
                self.comparison = Some(Comparison {
                    size,
                    statistics: truth::sky_statistics(wanted.light, &directions, &differences),
                    differences,
                    rgb: colours.rgb,
                    ignored: colours.ignored,
                    of: question,
                });
            }
            (Err(sentence), _) => self.refused = Some((question, sentence)),
            (Ok(_), _) => {}
        }
    }
}

fn compare(wanted: &Wanted<'_>) -> Option<Question> {
    let (model, size) = wanted.model?;
    Some(Question::Compare(
        wanted.number,
        wanted.frame,
        size,
        model.to_owned(),
    ))
}

fn task(question: &Question) -> Task {
    match question {
        Question::Spectrum(_, direction) => Task::Spectrum(direction.to_array()),
        Question::Check(_, frame) => Task::Colours {
            model: registry::DEFAULT.to_owned(),
            directions: truth::directions(frame, CHECKED),
        },
        Question::Compare(_, frame, size, model) => Task::Colours {
            model: model.clone(),
            directions: truth::directions(frame, *size),
        },
    }
}
