//! [`Beside`]: what is computed beside the picture, to judge it: a spectrum, the error of the picture, the pictures of models.

use crate::compute::{Answer, Colours, Light, Output, Request, Spectrum, Target, Task};
use crate::platform::Worker;
use crate::truth::{self, Difference, Statistics};
use airlight::models::registry;
use airlight::monte_carlo::BUNDLE;
use airlight::scene::Scene;
use airlight_image::Frame;

/// Pixels, across and up, at which the picture is checked against the solver.
const CHECKED: [u32; 2] = [16, 12];
/// Bundles of paths that a model with noise begins with, at most adds at a time, and ends with.
const FIRST_BUNDLES: u64 = 2;
const ADDED_BUNDLES: u64 = 4;
const MOST_BUNDLES: u64 = 256;

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
    /// Point of the spectrum.
    pub target: Option<Target>,
    /// Models to compare.
    pub sides: Option<Sides<'a>>,
    /// The scene that the library draws, with the size of the picture in its camera.
    pub picture: Option<Scene>,
}

/// The two sides of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides<'a> {
    /// Model on the left; `None` is the picture.
    pub left: Option<&'a str>,
    /// Model on the right.
    pub right: &'a str,
    /// Width and height at which they are computed.
    pub size: [u32; 2],
}

impl Sides<'_> {
    fn models(&self) -> impl Iterator<Item = &str> {
        self.left.into_iter().chain([self.right])
    }
}

/// A comparison of two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What it is made of, from the left; the picture is none.
    of: Vec<Drawing>,
    /// Grows with each comparison.
    pub number: u64,
    /// Width and height.
    pub size: [u32; 2],
    /// Red, green and blue of the left, unless that is the picture, cd/m^2.
    pub left: Option<Vec<[f32; 3]>>,
    /// The same of the right.
    pub right: Vec<[f32; 3]>,
    /// Differences of the left from the right.
    pub differences: Vec<Option<Difference>>,
    /// Their statistics.
    pub statistics: Option<Statistics>,
    /// Inputs that a model ignores.
    pub ignored: Vec<String>,
    /// Larger noise of the models, relative; `None` without.
    pub noise: Option<f64>,
}

/// A picture that the library has drawn.
#[derive(Clone, Copy, Debug)]
pub struct LibraryPicture<'a> {
    /// Width and height.
    pub size: [u32; 2],
    /// Red, green and blue by pixel, cd/m^2.
    pub rgb: &'a [[f32; 3]],
}

/// Computes what is wanted, one after another.
#[derive(Debug)]
pub struct Beside {
    worker: Worker,
    number: u64,
    asked: Option<Question>,
    spectrum: Option<(Question, Spectrum)>,
    check: Option<(Question, Statistics)>,
    /// The last pictures of models, the newest last.
    drawings: Vec<(Drawing, Colours)>,
    comparison: Option<Comparison>,
    /// The picture that the library has drawn: red, green and blue by pixel, cd/m^2.
    picture: Option<(Question, Vec<[f32; 3]>)>,
    /// A question without an answer, and why.
    refused: Option<(Question, String)>,
}

/// A question about the light with a number.
#[derive(Clone, Debug, PartialEq)]
enum Question {
    Spectrum(u64, Target),
    Check(u64, Frame),
    Draw(Drawing),
    Picture(Box<Scene>),
}

/// A picture by a model for the light with a number.
#[derive(Clone, Debug, PartialEq)]
struct Drawing {
    number: u64,
    frame: Frame,
    size: [u32; 2],
    model: String,
    /// Bundles of paths, if the model has noise.
    bundles: u64,
}

impl Drawing {
    fn of(wanted: &Wanted<'_>, size: [u32; 2], model: &str) -> Self {
        Self {
            number: wanted.number,
            frame: wanted.frame,
            size,
            model: model.to_owned(),
            bundles: FIRST_BUNDLES,
        }
    }

    /// Whether it is the same picture with more or less noise.
    fn is_same(&self, other: &Self) -> bool {
        let bundles = self.bundles;
        *self
            == Self {
                bundles,
                ..other.clone()
            }
    }

    /// Whether there is less noise than at first.
    fn is_refined(&self) -> bool {
        self.bundles > FIRST_BUNDLES
    }
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
            drawings: Vec::new(),
            comparison: None,
            picture: None,
            refused: None,
        }
    }

    /// Takes answers, and asks the next question.
    pub fn update(&mut self, wanted: &Wanted<'_>) {
        while let Some(answer) = self.worker.receive() {
            self.take(answer, wanted);
        }
        self.compare(wanted);
        let next = self.next(wanted).or_else(|| self.refinement(wanted));
        if self.asked.is_none()
            && let Some(question) = next
        {
            self.number += 1;
            let scene = match &question {
                Question::Picture(scene) => (**scene).clone(),
                _ => wanted.scene.clone(),
            };
            let request = Request {
                number: self.number,
                scene,
                task: task(&question),
            };
            if self.worker.send(request) {
                self.asked = Some(question);
            }
        }
    }

    /// Whether all that is wanted is there, or refused, be it with noise.
    pub fn is_current(&self, wanted: &Wanted<'_>) -> bool {
        let is_refining = match &self.asked {
            Some(Question::Draw(drawing)) => drawing.is_refined(),
            Some(_) => false,
            None => true,
        };
        is_refining && self.next(wanted).is_none()
    }

    /// Waits for an answer.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(&mut self, wanted: &Wanted<'_>) {
        if self.asked.is_some()
            && let Some(answer) = self.worker.wait()
        {
            self.take(answer, wanted);
            self.compare(wanted);
        }
    }

    /// The spectrum of the wanted point.
    pub fn spectrum(&self, wanted: &Wanted<'_>) -> Option<&Spectrum> {
        let question = Question::Spectrum(wanted.number, wanted.target?);
        let (of, spectrum) = self.spectrum.as_ref()?;
        (*of == question).then_some(spectrum)
    }

    /// Differences of the picture from the solver, over the whole of it.
    pub fn check(&self, wanted: &Wanted<'_>) -> Option<&Statistics> {
        let (of, statistics) = self.check.as_ref()?;
        (*of == Question::Check(wanted.number, wanted.frame)).then_some(statistics)
    }

    /// The wanted picture of the library, or why there is none, as a sentence.
    pub fn picture(&self, wanted: &Wanted<'_>) -> Option<Result<LibraryPicture<'_>, &str>> {
        let scene = wanted.picture.as_ref()?;
        let is_of = |question: &Question| match question {
            Question::Picture(of) => **of == *scene,
            _ => false,
        };
        if let Some((_, sentence)) = self.refused.as_ref().filter(|(of, _)| is_of(of)) {
            return Some(Err(sentence));
        }
        let (_, rgb) = self.picture.as_ref().filter(|(of, _)| is_of(of))?;
        let size = scene.camera.size?;
        Some(Ok(LibraryPicture { size, rgb }))
    }

    /// The wanted comparison.
    pub fn comparison(&self, wanted: &Wanted<'_>) -> Option<&Comparison> {
        let sides = wanted.sides?;
        self.comparison.as_ref().filter(|comparison| {
            let of = comparison.of.iter();
            let models = sides.models();
            comparison.of.len() == sides.models().count()
                && of
                    .zip(models)
                    .all(|(of, model)| of.is_same(&Drawing::of(wanted, sides.size, model)))
        })
    }

    /// Why there is no comparison, as a sentence.
    pub fn refusal(&self, wanted: &Wanted<'_>) -> Option<&str> {
        let sides = wanted.sides?;
        let (of, sentence) = self.refused.as_ref()?;
        let is_refused = |model| *of == Question::Draw(Drawing::of(wanted, sides.size, model));
        sides.models().any(is_refused).then_some(sentence.as_str())
    }

    /// Number of paths for each direction of the wanted comparison, if a model has noise.
    pub fn paths(&self, wanted: &Wanted<'_>) -> Option<u64> {
        let comparison = self.comparison(wanted)?;
        let bundles = comparison.of.iter().map(|drawing| drawing.bundles).max()?;
        comparison.noise.map(|_| bundles * BUNDLE as u64)
    }

    /// The picture of a model, with however much noise.
    fn drawing(&self, drawing: &Drawing) -> Option<&(Drawing, Colours)> {
        self.drawings.iter().find(|(of, _)| of.is_same(drawing))
    }

    /// The next question: what is shown first, the check last.
    fn next(&self, wanted: &Wanted<'_>) -> Option<Question> {
        let spectrum = wanted
            .target
            .map(|target| Question::Spectrum(wanted.number, target));
        let picture = wanted.picture.clone();
        let picture = picture.map(|scene| Question::Picture(Box::new(scene)));
        // What the library draws is not what the device draws.
        let check = Question::Check(wanted.number, wanted.frame);
        let check = picture.is_none().then_some(check);
        let sides = wanted.sides.as_ref();
        let drawings = sides.into_iter().flat_map(|sides| {
            let models = sides.models();
            models.map(|model| Question::Draw(Drawing::of(wanted, sides.size, model)))
        });
        let is_open = |question: &Question| {
            let is_answered = match question {
                Question::Spectrum(..) => {
                    self.spectrum.as_ref().is_some_and(|(of, _)| of == question)
                }
                Question::Check(..) => self.check.as_ref().is_some_and(|(of, _)| of == question),
                Question::Draw(drawing) => self.drawing(drawing).is_some(),
                Question::Picture(_) => self.picture.as_ref().is_some_and(|(of, _)| of == question),
            };
            !is_answered && self.refused.as_ref().map(|(of, _)| of) != Some(question)
        };
        spectrum
            .into_iter()
            .chain(picture)
            .chain(drawings)
            .chain(check)
            .find(is_open)
    }

    /// A picture with noise again, with more paths.
    fn refinement(&self, wanted: &Wanted<'_>) -> Option<Question> {
        let sides = wanted.sides?;
        let drawings = sides.models().filter_map(|model| {
            let (drawing, colours) = self.drawing(&Drawing::of(wanted, sides.size, model))?;
            let is_noisy = colours.noise.is_some() && drawing.bundles < MOST_BUNDLES;
            is_noisy.then(|| Drawing {
                bundles: drawing.bundles + drawing.bundles.min(ADDED_BUNDLES),
                ..drawing.clone()
            })
        });
        let least = drawings.min_by_key(|drawing| drawing.bundles);
        least.map(Question::Draw)
    }

    fn take(&mut self, answer: Answer, wanted: &Wanted<'_>) {
        let Some(question) = self.asked.take() else {
            return;
        };
        let number = match &question {
            Question::Spectrum(number, _) | Question::Check(number, _) => *number,
            Question::Draw(drawing) => drawing.number,
            Question::Picture(_) => wanted.number,
        };
        if number != wanted.number {
            return;
        }
        match (answer.result, question) {
            (Ok(Output::Spectrum(spectrum)), question) => {
                self.spectrum = Some((question, spectrum));
            }
            (Ok(Output::Colours(colours)), Question::Check(number, frame)) => {
                let directions = truth::directions(&frame, CHECKED);
                let drawn = truth::drawn(wanted.light, &directions);
                let differences = truth::differences(&drawn, &colours.rgb);
                let found = truth::statistics(wanted.light, &directions, &differences);
                let question = Question::Check(number, frame);
                self.check = Some((question, found.unwrap_or_default()));
            }
            (Ok(Output::Colours(colours)), Question::Draw(drawing)) => {
                /// Both sides.
                const KEPT: usize = 2;
                self.drawings.retain(|(of, _)| !of.is_same(&drawing));
                self.drawings.push((drawing, colours));
                let more = self.drawings.len().saturating_sub(KEPT);
                self.drawings.drain(..more);
            }
            (Ok(Output::Colours(colours)), question @ Question::Picture(_)) => {
                self.picture = Some((question, colours.rgb));
            }
            (Err(sentence), question) => self.refused = Some((question, sentence)),
            (Ok(_), _) => {}
        }
    }

    /// Compares the wanted pictures, once they are there and unless they have been.
    fn compare(&mut self, wanted: &Wanted<'_>) {
        let Some(sides) = wanted.sides else {
            return;
        };
        let drawings = sides.models().map(|model| {
            self.drawing(&Drawing::of(wanted, sides.size, model))
                .cloned()
        });
        let Some(drawings) = drawings.collect::<Option<Vec<_>>>() else {
            return;
        };
        let (of, colours): (Vec<Drawing>, Vec<Colours>) = drawings.into_iter().unzip();
        if self
            .comparison
            .as_ref()
            .is_some_and(|before| before.of == of)
        {
            return;
        }
        let ignored = colours.iter().flat_map(|colours| colours.ignored.clone());
        let noise = colours.iter().filter_map(|colours| colours.noise);
        let (ignored, noise) = (ignored.collect(), noise.reduce(f64::max));
        let mut rgb = colours.into_iter().map(|colours| colours.rgb);
        let left = sides.left.and_then(|_| rgb.next());
        let right = rgb.next().unwrap_or_default();
        let directions = truth::directions(&wanted.frame, sides.size);
        let differences = match &left {
            Some(left) => truth::differences(left, &right),
            None => truth::differences(&truth::drawn(wanted.light, &directions), &right),
        };
        self.comparison = Some(Comparison {
            of,
            number: self
                .comparison
                .as_ref()
                .map_or(0, |before| before.number + 1),
            size: sides.size,
            statistics: truth::sky_statistics(wanted.light, &directions, &differences),
            left,
            right,
            differences,
            ignored,
            noise,
        });
    }
}

fn task(question: &Question) -> Task {
    match question {
        Question::Picture(_) => Task::Picture,
        Question::Spectrum(_, target) => Task::Spectrum(*target),
        Question::Check(_, frame) => Task::Colours {
            model: registry::DEFAULT.to_owned(),
            directions: truth::directions(frame, CHECKED),
            bundles: FIRST_BUNDLES,
        },
        Question::Draw(drawing) => Task::Colours {
            model: drawing.model.clone(),
            directions: truth::directions(&drawing.frame, drawing.size),
            bundles: drawing.bundles,
        },
    }
}
