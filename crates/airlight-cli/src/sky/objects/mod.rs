//! Things before the sky, in the light of whatever solver draws it.
//!
//! - [`lit`]: their light, and what the air before them does; [`rows`]: sky and things, row by row, and their depth.
//! - [`Things`]: both made ready from the options.

mod lit;
mod rows;

pub use rows::{ObjectRows, write_depth};

use super::channels::{Channels, RgbWeights};
use super::classic::Shed;
use super::fog::{Fog, PIECE};
use crate::args::{SkyArgs, SolverArg};
use crate::classic::Model;
use crate::error::CliError;
use crate::scene::Scene;
use airlight::classic::ClassicSky;
use airlight::classic::klassen1987::{Klassen1987, Klassen1987Scene};
use airlight::outdoors::{FoggySky, Outdoors, Surroundings};
use airlight::path::PathOptics;
use airlight::sky::View;
use airlight::spectrum::{RgbSpace, Spectrum};
use airlight_render::objects::Objects;
use glam::DVec3;
use lit::{Lit, Paint, Pieces, Summed, in_rgb, reflectances};
use std::path::Path;
use std::sync::Arc;

/// Things with the light on them.
pub struct Things<'a> {
    objects: Arc<Objects>,
    paint: Box<dyn Paint + 'a>,
    eye: DVec3,
}

/// Reads the things of the options.
///
/// # Errors
/// [`CliError`] for a file that cannot be read or describes none, and for a solver that knows none.
pub fn read(args: &SkyArgs) -> Result<Option<Arc<Objects>>, CliError> {
    let Some(path) = &args.things.objects else {
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
    !args.things.no_shadows
}

impl<'a> Things<'a> {
    /// In the light of the solver's sky, and of the fog in it.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none.
    pub fn solved(
        objects: &Arc<Objects>,
        (args, channels): (&SkyArgs, &Channels),
        view: &View<'a>,
    ) -> Result<Self, CliError> {
        let planet = &view.sky().atmosphere().planet;
        let ground_m = planet.ground_altitude_m;
        let air = Fog::or_clear(&args.fog, view, channels.table())?;
        let heights_m = heights_m(objects, args.fog.fog_visibility_m.is_some());
        let near = heights_m
            .into_iter()
            .map(|height_m| {
                let there = view.at_altitude(ground_m + height_m);
                let air = Fog::or_clear(&args.fog, &there, channels.table())?;
                Ok((height_m, air))
            })
            .collect::<Result<Vec<_>, CliError>>()?;
        let shadows = shadows(args);
        let paint: Box<dyn Paint + 'a> = match air {
            Fog::Rgb(air) => Box::new(Lit {
                air,
                around: around(&near, |fog| match fog {
                    Fog::Rgb(sky) => Some(sky.as_ref()),
                    Fog::Spectral(_) => None,
                }),
                reflectances: reflectances(objects, |curve| in_rgb(curve, channels.space)),
                shadows,
            }),
            Fog::Spectral(pieces) => {
                let nm = view.sky().grid().wavelengths_nm();
                let lit = |(number, air): (usize, FoggySky<'a, PIECE>)| Lit::<'a, PIECE> {
                    air: Box::new(air),
                    around: around(&near, |fog| match fog {
                        Fog::Spectral(pieces) => pieces.get(number),
                        Fog::Rgb(_) => None,
                    }),
                    reflectances: reflectances(objects, |curve| {
                        Spectrum::from_fn(|lane| {
                            let place = (number * PIECE + lane).min(nm.len() - 1);
                            curve.at(nm[place]) as f32
                        })
                    }),
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

    /// In the light of a published model.
    pub fn classic(
        objects: &Arc<Objects>,
        (args, channels): (&SkyArgs, &Channels),
        scene: &Scene,
        model: &Model,
        (ground, shed): ([f64; 3], &Shed),
        weights: &RgbWeights,
    ) -> Self {
        let shadows = shadows(args);
        let ground_m = scene.atmosphere.planet.ground_altitude_m;
        let paint: Box<dyn Paint + 'a> = match &model.scene1987 {
            Some(scene) => Box::new(Summed {
                lit: of_1987(objects, scene, args.fog.fog_visibility_m.is_some(), shadows),
                weights: weights.clone(),
            }),
            None => {
                let space = channels.space;
                let air = Airless {
                    model: model.sky.clone(),
                    sunlight: in_space(space, shed.sun_normal()),
                    ground: in_space(space, ground),
                    space,
                };
                let around = vec![(0.0, Surroundings::of(air.sun(), |d| air.around(d)))];
                Box::new(Lit {
                    air: Box::new(air),
                    around,
                    reflectances: reflectances(objects, |curve| in_rgb(curve, space)),
                    shadows,
                })
            }
        };
        Self {
            objects: objects.clone(),
            paint,
            eye: DVec3::Y * (scene.eye_altitude_m - ground_m),
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

/// The light around at heights.
fn around<'a, 'f, const N: usize>(
    near: &'f [(f64, Fog<'a>)],
    of: impl Fn(&'f Fog<'a>) -> Option<&'f FoggySky<'a, N>>,
) -> Vec<(f64, Surroundings<N>)>
where
    'a: 'f,
{
    near.iter()
        .filter_map(|(height_m, fog)| {
            let sky = of(fog)?;
            Some((*height_m, Surroundings::of(sky.sun(), |d| sky.sky(d))))
        })
        .collect()
}

fn of_1987<'a>(
    objects: &Objects,
    scene: &Klassen1987Scene,
    foggy: bool,
    shadows: bool,
) -> Lit<'a, { airlight::classic::klassen1987::WAVELENGTHS }> {
    let nm = Klassen1987::wavelengths();
    let around = heights_m(objects, foggy)
        .into_iter()
        .map(|height_m| {
            let there = scene.at_height_m(height_m);
            (
                height_m,
                Surroundings::of(Outdoors::sun(&there), |d| there.around(d)),
            )
        })
        .collect();
    Lit {
        air: Box::new(scene.clone()),
        around,
        reflectances: reflectances(objects, |curve| Spectrum(nm.map(|nm| curve.at(nm) as f32))),
        shadows,
    }
}

fn in_space(space: RgbSpace, xyz: [f64; 3]) -> Spectrum<3> {
    Spectrum(space.from_xyz(xyz).map(|v| v.max(0.0) as f32))
}

/// A published model of the sky that says nothing of the air before things: none is drawn.
struct Airless {
    model: Arc<dyn ClassicSky>,
    sunlight: Spectrum<3>,
    ground: Spectrum<3>,
    space: RgbSpace,
}

impl Outdoors<3> for Airless {
    fn sun(&self) -> DVec3 {
        self.model.sun()
    }

    fn sunlight(&self, _height_m: f64) -> Spectrum<3> {
        self.sunlight
    }

    fn before(&self, _direction: DVec3, _distance_m: f64) -> PathOptics<3> {
        PathOptics::CLEAR
    }

    fn around(&self, direction: DVec3) -> Spectrum<3> {
        match direction.y < 0.0 && !self.model.has_ground() {
            true => self.ground,
            false => in_space(self.space, self.model.sky_xyz(direction)),
        }
    }
}
