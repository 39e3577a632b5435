//! Things before the sky, in the light of whatever solver draws it.
//!
//! - [`lit`]: their light, and what the air before them does; [`rows`]: sky and things, row by row, and their depth.
//! - [`LitScene`]: both made ready from the options.

mod lit;
mod rows;

pub use rows::{ObjectRows, write_depth};

use super::channels::{Channels, RgbWeights};
use super::fog::{Fog, PIECE};
use crate::args::{SkyArgs, SolverArg};
use crate::error::CliError;
use crate::models;
use crate::scene::Scene;
use airlight::models::klassen1987::{Klassen1987, Klassen1987Scene};
use airlight::scene::{FoggySky, IrradianceMap, SceneLighting};
use airlight::sky::{SkyTable, View};
use airlight::spectrum::Spectrum;
use airlight::transfer::PathOptics;
use airlight_render::objects::Objects;
use glam::DVec3;
use lit::{LitThings, Pieces, Shader, Summed, at_wavelengths, in_rgb, place, reflectances};
use std::path::Path;
use std::sync::Arc;

/// Things with the light on them.
pub struct LitScene {
    objects: Arc<Objects>,
    paint: Box<dyn Shader>,
    eye: DVec3,
}

/// Reads the things of the options.
///
/// # Errors
/// [`CliError`] for a file that cannot be read or describes none, and for a solver that knows none.
pub fn read(args: &SkyArgs) -> Result<Option<Arc<Objects>>, CliError> {
    let Some(path) = &args.objects.objects else {
        return Ok(None);
    };
    if args.air.solver == SolverArg::MonteCarlo {
        return Err(CliError::usage(
            "random paths meet no things but the planet: leave out --objects, or give another --solver",
        ));
    }
    load(path).map(|objects| Some(Arc::new(objects)))
}

fn load(path: &Path) -> Result<Objects, CliError> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|error| CliError::usage(format!("--objects: cannot read `{name}`: {error}")))?;
    Objects::from_toml(&text)
        .map_err(|error| CliError::usage(format!("--objects: {name}: {error}")))
}

/// Whether things shade each other.
fn shadows(args: &SkyArgs) -> bool {
    !args.objects.no_shadows
}

impl LitScene {
    /// In the light of the solver's sky, and of the fog in it.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none.
    pub fn solved(
        objects: &Arc<Objects>,
        (args, channels): (&SkyArgs, &Channels),
        view: &View,
    ) -> Result<Self, CliError> {
        let planet = &view.sky().atmosphere().planet;
        let ground_m = planet.ground_altitude_m;
        let air = Fog::or_clear(&args.fog, view, channels.table())?;
        let near = heights_m(objects, args.fog.fog_visibility_m.is_some())
            .into_iter()
            .map(|height_m| {
                let there = view.at_altitude(ground_m + height_m);
                Ok((height_m, Seen::from(args, &there, channels)?))
            })
            .collect::<Result<Vec<_>, CliError>>()?;
        let shadows = shadows(args);
        let paint: Box<dyn Shader> = match air {
            Fog::Rgb(air) => Box::new(LitThings {
                air,
                around: around(&near, view.sun(), 0),
                reflectances: reflectances(objects, in_rgb(channels.space)),
                shadows,
            }),
            Fog::Spectral(pieces) => {
                let nm = view.sky().grid().wavelengths_nm();
                let lit = |(number, air): (usize, FoggySky<PIECE>)| LitThings::<PIECE> {
                    air: Box::new(air),
                    around: around(&near, view.sun(), number * PIECE),
                    reflectances: reflectances(objects, at_wavelengths(nm, number * PIECE)),
                    shadows,
                };
                Box::new(Pieces(pieces.into_iter().enumerate().map(lit).collect()))
            }
        };
        Ok(Self {
            objects: objects.clone(),
            paint,
            eye: DVec3::Y * (view.radius_m() - planet.radius_m - ground_m),
        })
    }

    /// In the light of a published model other than that of 1987.
    pub fn classic(
        objects: &Arc<Objects>,
        (args, channels): (&SkyArgs, &Channels),
        scene: &Scene,
        model: &Arc<models::Lit>,
    ) -> Self {
        let shadows = shadows(args);
        let paint: Box<dyn Shader> = match channels.spectral {
            None => {
                let space = channels.space;
                let lanes = move |light: &models::Light| {
                    Spectrum(space.from_xyz(light.xyz).map(|v| v.max(0.0) as f32))
                };
                let reflectances = reflectances(objects, in_rgb(space));
                Box::new(airless(model, lanes, reflectances, shadows))
            }
            Some(_) => {
                let nm = model.model.wavelengths_nm();
                let piece = |number: usize| {
                    let first = number * PIECE;
                    let lanes = move |light: &models::Light| -> Spectrum<PIECE> {
                        let values = &light.spectrum;
                        Spectrum::from_fn(|lane| values[place(first + lane, values.len())] as f32)
                    };
                    let reflectances = reflectances(objects, at_wavelengths(nm, first));
                    airless(model, lanes, reflectances, shadows)
                };
                Box::new(Pieces((0..nm.len().div_ceil(PIECE)).map(piece).collect()))
            }
        };
        let ground_m = scene.atmosphere.planet.ground_altitude_m;
        Self {
            objects: objects.clone(),
            paint,
            eye: DVec3::Y * (scene.eye_altitude_m - ground_m),
        }
    }

    /// In the light of the model of 1987, and in its fog.
    pub fn of_1987(
        objects: &Arc<Objects>,
        (args, channels): (&SkyArgs, &Channels),
        scene: &Klassen1987Scene,
        weights: &RgbWeights,
    ) -> Self {
        let around = heights_m(objects, args.fog.fog_visibility_m.is_some())
            .into_iter()
            .map(|height_m| {
                let there = scene.at_height_m(height_m);
                let sun = SceneLighting::sun(&there);
                (height_m, IrradianceMap::of(sun, |d| there.around(d)))
            })
            .collect();
        let nm = Klassen1987::wavelengths();
        let lit = LitThings {
            air: Box::new(scene.clone()),
            around,
            reflectances: reflectances(objects, at_wavelengths(&nm, 0)),
            shadows: shadows(args),
        };
        Self {
            objects: objects.clone(),
            paint: match channels.spectral {
                Some(_) => Box::new(Pieces(vec![lit])),
                None => Box::new(Summed {
                    lit,
                    weights: weights.clone(),
                }),
            },
            eye: DVec3::Y * scene.eye_height_m(),
        }
    }
}

/// Heights (m) at which the light from around is taken: where there is fog it changes from the ground to the tops of things.
fn heights_m(objects: &Objects, foggy: bool) -> Vec<f64> {
    let top_m = objects.top_m().max(1.0);
    match foggy {
        true => vec![0.0, top_m],
        false => vec![0.5 * top_m],
    }
}

/// A sky as it is seen from a height, and the fog before it.
struct Seen {
    clear: Arc<SkyTable>,
    fog: Option<Fog>,
}

impl Seen {
    fn from(args: &SkyArgs, there: &View, channels: &Channels) -> Result<Self, CliError> {
        let fog = Fog::new(&args.fog, there, channels.table())?;
        Ok(Self {
            clear: match &fog {
                Some(fog) => fog.clear(),
                None => Arc::new(there.table(channels.table())),
            },
            fog,
        })
    }

    fn along(&self, direction: DVec3, values: &mut [f32]) {
        self.clear.sample(direction, values);
        if let Some(fog) = &self.fog {
            fog.cover(direction, values);
        }
    }
}

/// The light around at heights, in lanes from the channel `first` on; lanes beyond the last repeat it.
fn around<const N: usize>(
    near: &[(f64, Seen)],
    sun: DVec3,
    first: usize,
) -> Vec<(f64, IrradianceMap<N>)> {
    let at = |(height_m, seen): &(f64, Seen)| {
        let channels = seen.clear.channels();
        let surroundings = IrradianceMap::of(sun, |direction| {
            let mut values = vec![0.0; channels];
            seen.along(direction, &mut values);
            Spectrum::from_fn(|lane| values[place(first + lane, channels)])
        });
        (*height_m, surroundings)
    };
    near.iter().map(at).collect()
}

/// Things in the light of a model that says nothing of the air before them: none is drawn. `lanes` are those of its light.
fn airless<const N: usize>(
    model: &Arc<models::Lit>,
    lanes: impl Fn(&models::Light) -> Spectrum<N> + Sync + 'static,
    reflectances: Vec<[Spectrum<N>; 2]>,
    shadows: bool,
) -> LitThings<N> {
    let air = Airless {
        sunlight: lanes(&model.sun_normal),
        model: model.clone(),
        lanes,
    };
    LitThings {
        around: vec![(0.0, IrradianceMap::of(air.sun(), |d| air.around(d)))],
        air: Box::new(air),
        reflectances,
        shadows,
    }
}

/// A published model without air before things.
struct Airless<const N: usize, F> {
    model: Arc<models::Lit>,
    sunlight: Spectrum<N>,
    lanes: F,
}

impl<const N: usize, F: Fn(&models::Light) -> Spectrum<N> + Sync> SceneLighting<N>
    for Airless<N, F>
{
    fn sun(&self) -> DVec3 {
        self.model.model.sun()
    }

    fn sunlight(&self, _height_m: f64) -> Spectrum<N> {
        self.sunlight
    }

    fn before(&self, _direction: DVec3, _distance_m: f64) -> PathOptics<N> {
        PathOptics::CLEAR
    }

    fn around(&self, direction: DVec3) -> Spectrum<N> {
        (self.lanes)(&self.model.along(direction))
    }
}
