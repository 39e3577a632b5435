//! Whole frames of `airlight-gpu`, and of published real-time models, against the solver with its fine settings and against Monte
//! Carlo.
//!
//! Two quantities are compared, each as luminance and as a colour: the sky with the ground below, and grey walls, as bright as the
//! sky, behind 0.1 to 100 km of air. Of the published models, the sky is marched along each ray at three wavelengths, whose responses
//! are taken as red, green and blue, as real-time programs do.

mod case;
pub mod hillaire2020;
mod pixels;
mod renderers;

pub use case::{AIRS, Case, FramesError, HEIGHTS_M, SUNS_DEG};

use crate::check::{At, Check, Row, Suite, Unit};
use crate::skies::truth_air;
use airlight::Control;
use airlight::atmosphere::Atmosphere;
use airlight::axes;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::sky::{Sky, SkySettings, SunCoverage, View};
use airlight::spectrum::{WavelengthGrid, difference};
use airlight_gpu::headless::Headless;
use pixels::{Pixel, Wall, pixels};
use renderers::{Engine, Published, Seen};

/// Directions compared in each frame.
pub const DIRECTIONS: usize = 64;
/// Luminance relative to that of the white, below which a pixel counts as black.
const DARK: f64 = 1e-3;

/// A renderer of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Renderer {
    /// `airlight-gpu` with its default settings, on a device.
    AirlightGpu,
    /// [`airlight::models::hillaire2020`] as in the paper.
    Hillaire2020,
    /// Its variant `even-steps`.
    EvenSteps,
}

impl Renderer {
    /// All renderers.
    pub const ALL: [Self; 3] = [Self::AirlightGpu, Self::Hillaire2020, Self::EvenSteps];

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::AirlightGpu => "airlight-gpu",
            Self::Hillaire2020 => "Hillaire 2020",
            Self::EvenSteps => "Hillaire 2020 in 16 even steps",
        }
    }
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Luminance of sky and ground, percent.
    Sky,
    /// Luminance of walls behind air, percent.
    Walls,
    /// Colour of sky and ground, CIEDE2000.
    SkyColour,
    /// Colour of walls behind air, CIEDE2000.
    WallColour,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 4] = [Self::Sky, Self::Walls, Self::SkyColour, Self::WallColour];

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sky => "luminance of the sky",
            Self::Walls => "luminance of walls behind air",
            Self::SkyColour => "colour of the sky",
            Self::WallColour => "colour of walls behind air",
        }
    }

    /// Unit of its errors.
    pub fn unit(self) -> Unit {
        match self {
            Self::Sky | Self::Walls => Unit::Percent,
            Self::SkyColour | Self::WallColour => Unit::Ciede2000,
        }
    }

    /// XYZ and its reference, where there is something to compare.
    fn of(self, ours: &Seen, right: &Seen) -> Option<[[f64; 3]; 2]> {
        match self {
            Self::Sky | Self::SkyColour => Some([ours.sky, right.sky]),
            Self::Walls | Self::WallColour => Some([ours.wall?, right.wall?]),
        }
    }
}

/// A comparison of one renderer, quantity and pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRow {
    /// Renderer.
    pub renderer: Renderer,
    /// What is compared.
    pub quantity: Quantity,
    /// The value and its reference: luminances in cd/m^2, or a CIEDE2000 and 0.
    pub row: Row,
}

/// The solver's sky in an atmosphere, and the renderer.
struct Air<'a> {
    atmosphere: Atmosphere,
    sky: Sky,
    engine: Engine<'a>,
}

/// A case as the solver sees it, and as `airlight-gpu` draws it.
struct Subject {
    view: View,
    wall: Wall,
    pixels: Vec<Pixel>,
    drawn: Vec<Seen>,
}

impl<'a> Air<'a> {
    /// For cases of one atmosphere: the solver has its fine settings at sixteen wavelengths.
    fn new(
        device: &'a Headless,
        cases: &[Case],
        control: Control<'_>,
    ) -> Result<Self, FramesError> {
        let atmosphere = truth_air(cases[0].air).expect("an atmosphere of the list");
        let settings = SkySettings {
            suns: match cases {
                [case] => SunCoverage::near(case.sun_deg, case.height_m),
                _ => SunCoverage::All,
            },
            ..SkySettings::fine()
        };
        let (grid, control) = (WavelengthGrid::standard(), control.without_progress());
        Ok(Self {
            sky: Sky::prepare_with(&atmosphere, &grid, &settings, control)?,
            engine: Engine::new(device, &atmosphere)?,
            atmosphere,
        })
    }

    /// Draws a case: `count` pixels after the `first` of all.
    fn draw(&mut self, case: &Case, count: usize, first: usize) -> Result<Subject, FramesError> {
        let view = self.sky.try_view(case.height_m, case.sun())?;
        let wall = Wall::new(&view);
        let pixels = pixels(&view, count, first);
        Ok(Subject {
            drawn: self.engine.draw(case, &wall, &pixels)?,
            view,
            wall,
            pixels,
        })
    }
}

/// Compares pixels of frames with the solver: `directions` of each case, which are ordered by atmosphere. Needs a Vulkan device, of
/// which one on the processor will do. `control` hears of each case.
///
/// # Errors
/// [`FramesError`] without a device, for a case that cannot be solved for, and when cancelled.
pub fn against_solver(
    device: &Headless,
    cases: &[Case],
    directions: usize,
    control: Control<'_>,
) -> Result<Vec<FrameRow>, FramesError> {
    control.stage("comparing frames with the solver", cases.len() as u64);
    let mut rows = Vec::new();
    let mut done = 0;
    for of_air in cases.chunk_by(|a, b| a.air == b.air) {
        let mut air = Air::new(device, of_air, control)?;
        let published = [
            (
                Renderer::Hillaire2020,
                Published::new(&air.atmosphere, "paper")?,
            ),
            (
                Renderer::EvenSteps,
                Published::new(&air.atmosphere, "even-steps")?,
            ),
        ];
        for case in of_air {
            control.check()?;
            let subject = air.draw(case, directions, done * directions)?;
            let (wall, pixels) = (&subject.wall, &subject.pixels);
            let right = renderers::solver(&subject.view, wall, pixels);
            let mut add = |renderer: Renderer, seen: &[Seen]| {
                let seen = || pixels.iter().zip(seen).zip(&right);
                for quantity in Quantity::ALL {
                    rows.extend(seen().filter_map(|((pixel, ours), right)| {
                        let pair = quantity.of(ours, right)?;
                        let row = row(case, quantity, pixel, pair, wall.luminance);
                        Some(FrameRow {
                            renderer,
                            quantity,
                            row,
                        })
                    }));
                }
            };
            add(Renderer::AirlightGpu, &subject.drawn);
            for (renderer, model) in &published {
                add(*renderer, &model.march(case, wall, pixels)?);
            }
            done += 1;
            control.report(done as u64, cases.len() as u64);
        }
    }
    Ok(rows)
}

/// Compares the luminance of the sky in frames of `airlight-gpu` with path tracing of polarised light: `directions` of each case with
/// `paths` paths each.
///
/// # Errors
/// As [`against_solver`].
pub fn against_monte_carlo(
    device: &Headless,
    cases: &[Case],
    directions: usize,
    paths: u64,
    control: Control<'_>,
) -> Result<Vec<Row>, FramesError> {
    control.stage("comparing frames with Monte Carlo", cases.len() as u64);
    let quiet = control.without_progress();
    let grid = WavelengthGrid::standard();
    let mut rows = Vec::new();
    let mut done = 0;
    for of_air in cases.chunk_by(|a, b| a.air == b.air) {
        let mut air = Air::new(device, of_air, control)?;
        let settings = MonteCarloSettings {
            paths,
            ..Default::default()
        };
        let truth = MonteCarlo::new(&air.atmosphere, &grid, settings)?;
        for case in of_air {
            control.check()?;
            let subject = air.draw(case, directions, done * directions)?;
            for (pixel, ours) in subject.pixels.iter().zip(&subject.drawn) {
                let (eye_m, sun) = (case.height_m, case.sun());
                let light = truth.polarised_with(eye_m, sun, pixel.direction, None, quiet)?;
                let light = light.radiance();
                // Wavelengths share their paths, so that their errors add up.
                let [right, error] = [light.mean, light.standard_error].map(|light| {
                    let light: Vec<f32> = light.into_iter().map(|v| v as f32).collect();
                    truth.grid().to_xyz(&light)
                });
                let pair = [ours.sky, right];
                rows.push(Row {
                    standard_error: error[1],
                    ..row(case, Quantity::Sky, pixel, pair, subject.wall.luminance)
                });
            }
            done += 1;
            control.report(done as u64, cases.len() as u64);
        }
    }
    Ok(rows)
}

/// A value and its reference, in XYZ. Both count as no darker than a part of the white.
fn row(
    case: &Case,
    quantity: Quantity,
    pixel: &Pixel,
    [ours, right]: [[f64; 3]; 2],
    white: f64,
) -> Row {
    let is_wall = matches!(quantity, Quantity::Walls | Quantity::WallColour);
    let at = At {
        air: Some(case.air),
        sun_zenith_deg: 90.0 - case.sun_deg,
        altitude_m: case.height_m,
        view_zenith_deg: 90.0 - axes::elevation_deg(pixel.direction),
        relative_azimuth_deg: axes::azimuth_deg(pixel.direction) - case::SUN_AZIMUTH_DEG,
        distance_m: pixel.wall_m.filter(|_| is_wall),
        wavelength_nm: None,
    };
    let [ours, reference] = match quantity.unit() {
        Unit::Ciede2000 => {
            let lab = |xyz: [f64; 3]| {
                difference::xyz_to_lab(xyz.map(|v| 100.0 * v / white), difference::D65_WHITE)
            };
            match right[1] < DARK * white {
                true => [0.0; 2],
                false => [difference::ciede2000(lab(ours), lab(right)), 0.0],
            }
        }
        _ => [ours[1], right[1]].map(|luminance| luminance.max(DARK * white)),
    };
    Row {
        at,
        ours,
        reference,
        standard_error: 0.0,
    }
}

/// Where the eye of a frame is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the air, up to 10 km.
    Air,
    /// At 10 km, above desert dust, whose upper edge is sharp.
    AboveDust,
    /// At 400 km.
    Space,
}

impl Place {
    /// The place of a row.
    pub fn of(at: &At) -> Self {
        match at.altitude_m {
            ..5e3 => Self::Air,
            ..1e5 if at.air != Some("desert") => Self::Air,
            ..1e5 => Self::AboveDust,
            _ => Self::Space,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Air => "eye up to 10 km",
            Self::AboveDust => "eye at 10 km above dust",
            Self::Space => "eye at 400 km",
        }
    }
}

/// Suns and eyes of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Group {
    day: bool,
    place: Place,
}

impl Group {
    fn all() -> impl Iterator<Item = Self> {
        let suns = |place| [true, false].map(|day| Self { day, place });
        [Place::Air, Place::AboveDust, Place::Space]
            .into_iter()
            .flat_map(suns)
    }

    fn holds(self, at: &At) -> bool {
        (at.sun_zenith_deg <= 90.0) == self.day && Place::of(at) == self.place
    }

    fn name(self) -> String {
        let suns = match self.day {
            true => "sun 0 to 60°",
            false => "sun -2 to -6°",
        };
        format!("{suns}, {}", self.place.name())
    }

    /// Claimed bounds on the root mean square and on each error of `airlight-gpu`.
    fn claims(self, quantity: Quantity) -> (f64, f64) {
        use Place::{AboveDust, Air, Space};
        match (quantity, self.place, self.day) {
            (Quantity::Sky, Air, true) => (0.2, 2.0),
            (Quantity::Sky, Air, false) => (0.4, 2.0),
            (Quantity::Sky, AboveDust, true) => (0.2, 1.0),
            (Quantity::Sky, AboveDust, false) => (0.6, 2.0),
            (Quantity::Sky, Space, _) => (0.3, 2.0),
            (Quantity::SkyColour, Air, true) => (0.1, 1.0),
            (Quantity::SkyColour, _, _) => (0.3, 1.5),
            (Quantity::Walls, Air | AboveDust, _) => (0.3, 1.0),
            (Quantity::Walls, Space, _) => (0.1, 0.5),
            (Quantity::WallColour, Air | AboveDust, _) => (0.3, 1.0),
            (Quantity::WallColour, Space, _) => (0.1, 1.0),
        }
    }
}

/// All cases against the solver, or for [`Suite::Gpu`] those of one atmosphere.
///
/// # Errors
/// As [`against_solver`].
pub fn checks(suite: Suite, control: Control<'_>) -> Result<Vec<Check>, FramesError> {
    let cases = match suite {
        Suite::Gpu => Case::in_air("hazy").collect(),
        _ => Case::all(),
    };
    let rows = against_solver(&Headless::new()?, &cases, DIRECTIONS, control)?;
    let mut checks = Vec::new();
    for quantity in Quantity::ALL {
        for renderer in Renderer::ALL {
            for group in Group::all() {
                let of_check = |r: &&FrameRow| {
                    r.renderer == renderer && r.quantity == quantity && group.holds(&r.row.at)
                };
                let claims = (renderer == Renderer::AirlightGpu).then(|| group.claims(quantity));
                checks.push(Check {
                    suite,
                    what: format!("{}, {}", quantity.name(), group.name()),
                    against: format!("{} against the fine solver", renderer.name()),
                    unit: quantity.unit(),
                    limit: claims.map(|(_, each)| each),
                    limit_of_rms: claims.map(|(rms, _)| rms),
                    rows: rows.iter().filter(of_check).map(|r| r.row).collect(),
                });
            }
        }
    }
    checks.retain(|check| !check.rows.is_empty());
    Ok(checks)
}

/// Paths along each direction of the suite `gpu-monte-carlo`.
pub const PATHS: u64 = 16_384;
/// Directions of each of its cases: as many for each sun as [`DIRECTIONS`].
pub const PATH_DIRECTIONS: usize = DIRECTIONS / (AIRS.len() * HEIGHTS_M.len());

/// All cases against Monte Carlo, as the suite `gpu-monte-carlo`.
///
/// # Errors
/// As [`against_monte_carlo`].
pub fn monte_carlo_checks(control: Control<'_>) -> Result<Vec<Check>, FramesError> {
    let device = Headless::new()?;
    let rows = against_monte_carlo(&device, &Case::all(), PATH_DIRECTIONS, PATHS, control)?;
    let check = |group: Group| Check {
        suite: Suite::GpuMonteCarlo,
        what: format!("{}, {}", Quantity::Sky.name(), group.name()),
        against: "airlight-gpu against Airlight's Monte Carlo".into(),
        unit: Unit::Percent,
        limit: Some(if group.day { 2.0 } else { 5.0 }),
        limit_of_rms: None,
        rows: rows
            .iter()
            .filter(|row| group.holds(&row.at))
            .copied()
            .collect(),
    };
    Ok(Group::all().map(check).collect())
}
