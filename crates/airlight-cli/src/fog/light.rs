//! The light that fog over a picture is in: the picture's own, or that of a solved sky at the picture's level.

use crate::args::{AirArg, AirArgs, EffortArg, OverlayArgs, PlaceArgs, ScatteringArg, SolverArg};
use crate::error::CliError;
use crate::parse;
use crate::scene::{Scene, Sun};
use airlight::atmosphere::Constituent;
use airlight::fog::{FogLighting, FogScattering};
use airlight::scene::{FoggySky, LaneChannels};
use airlight::sky::Sky;
use airlight::spectrum::{RgbSpace, Spectrum};
use airlight_image::frame::Intrinsics;
use airlight_image::input::{DepthMap, Picture};
use airlight_render::overlay::{
    Ambient, ExistingAerial, FogSource, estimate_ambient, horizon_pixels,
};
use glam::DVec3;
use std::f32::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// The sky of the options, solved: once for all pictures.
pub struct SolvedSky {
    scene: Scene,
    sky: Sky,
    sun: Sun,
}

impl SolvedSky {
    /// What `--sky-light` asks for; nothing without it.
    ///
    /// # Errors
    /// [`CliError`] where the options do not fit together, or the atmosphere is none.
    pub fn of(args: &OverlayArgs) -> Result<Option<Self>, CliError> {
        let light = &args.light;
        if !light.sky_light {
            return Ok(None);
        }
        let place = PlaceArgs {
            at: light.at,
            when: light.when.clone(),
            sun_elevation: args.sun_elevation,
            sun_azimuth: Some(args.sun_azimuth),
            altitude_m: light.ground_altitude_m.unwrap_or(0.0) + args.eye_height_m,
            eye_height_m: args.eye_height_m,
            refraction: true,
        };
        let air = AirArgs {
            atmosphere: light.atmosphere.clone(),
            aerosol: None,
            humidity: None,
            aod_550: light.aod_550,
            turbidity: None,
            visibility_m: None,
            contrast: args.contrast.clone(),
            ozone_du: None,
            ground_albedo: args.ground_albedo,
            ground_altitude_m: light.ground_altitude_m,
            wavelengths: "standard".to_owned(),
            scattering: ScatteringArg::All,
            solver: SolverArg::Orders,
            effort: EffortArg::Standard,
            paths: None,
            seed: None,
            threads: None,
        };
        let scene = Scene::new(&place, &air)?;
        let sun = scene.sun.at(None)?;
        let (sky, _) = scene.prepare(scene.near(&sun))?;
        Ok(Some(Self { scene, sky, sun }))
    }

    /// The air, and where the eye is in it.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where the sun stands.
    pub fn sun(&self) -> &Sun {
        &self.sun
    }
}

/// Where fog gets its light from: prepared once, shared by all pictures.
pub struct LightSource<'a> {
    solved: Option<&'a SolvedSky>,
    scattering: FogScattering,
    /// The last foggy sky: another fog in it costs little, and the same one nothing.
    last: Mutex<Option<(Vec<Constituent>, Arc<FoggySky<3>>)>>,
}

/// How bright a picture says the light is, and how it says so.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// A colour in the picture's unit; of a solved sky, that of a white level surface in it.
    pub colour: Spectrum<3>,
    /// Where it is from.
    pub how: &'static str,
}

/// A picture, its depth and camera, and the ambient light that it shows or that is given.
pub struct Shown<'p> {
    pub picture: &'p Picture,
    pub depth: &'p DepthMap,
    pub camera: &'p Intrinsics,
    pub ambient: Level,
}

impl<'a> LightSource<'a> {
    /// Light of a solved sky, or of the pictures themselves; fog scatters which of it the options say.
    pub fn new(solved: Option<&'a SolvedSky>, args: &OverlayArgs) -> Self {
        Self {
            solved,
            scattering: args.scattering.scattering(),
            last: Mutex::new(None),
        }
    }

    /// The sky that lights the fog, with the fog in it; nothing where the picture does.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none.
    pub fn foggy(&self, layers: &[Constituent]) -> Result<Option<Arc<FoggySky<3>>>, CliError> {
        let Some(solved) = self.solved else {
            return Ok(None);
        };
        if layers.iter().any(|layer| layer.density.is_uniform()) {
            return Err(CliError::usage(
                "--sky-light shines on fog from above, so fog needs an upper end: choose --model height, clamped, unclamped or slab, and \
                 give each --layer scale-height or top",
            ));
        }
        let last = self
            .last
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        let foggy = match last {
            Some((known, sky)) if known == layers => return Ok(Some(sky)),
            Some((_, sky)) => sky.with_fog(layers, self.scattering)?,
            None => {
                let view = solved.scene.view(&solved.sky, &solved.sun);
                let ground = FoggySky::<3>::round_ground(&view);
                let channels = LaneChannels::Rgb(RgbSpace::Srgb);
                FoggySky::new(&view, channels, layers, ground, self.scattering)?
            }
        };
        let foggy = Arc::new(foggy);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) =
            Some((layers.to_vec(), foggy.clone()));
        Ok(Some(foggy))
    }
}

/// The ambient light of the options, or as the picture shows it.
///
/// # Errors
/// [`CliError::Usage`] where the option does not say a colour.
pub fn ambient(args: &OverlayArgs, picture: &Picture, depth: &DepthMap) -> Result<Level, CliError> {
    if args.ambient != "auto" {
        let given = parse::three_numbers(&args.ambient)
            .map_err(|right| CliError::usage(format!("--ambient {right}, or auto")))?;
        return Ok(Level {
            colour: Spectrum(given.map(|v| v as f32)),
            how: "as given",
        });
    }
    let (colour, how) = estimate_ambient(picture, depth);
    let how = match how {
        Ambient::Sky => "from the sky of the picture",
        Ambient::DarkChannel => "from the picture's dark channel",
    };
    Ok(Level { colour, how })
}

/// A foggy sky at the level of a picture: by `--radiance-scale`; else as the file states its white; else so that the clear
/// sky is as bright as the picture's where that shows it near the horizon; else so that a white level surface under the clear
/// sky is as bright as the ambient light.
///
/// # Errors
/// [`CliError::Usage`] where `--ambient` does not say a colour, or nothing says how bright the light is.
pub fn at_level(
    args: &OverlayArgs,
    sky: Arc<FoggySky<3>>,
    shown: &Shown<'_>,
) -> Result<(FogSource, Level), CliError> {
    let white = white_surface(sky.fog_lighting());
    let stated = shown.picture.white_luminance_cd_m2.map(|white| 1.0 / white);
    let (scale, how) = match (args.light.radiance_scale, stated) {
        (Some(scale), _) => (scale as f32, "sky solver, --radiance-scale"),
        (None, Some(scale)) if args.ambient == "auto" => {
            (scale, "sky solver, unit as the file states it")
        }
        _ => match shown_over_solved(args, &sky, shown) {
            Some(scale) => (scale, "sky solver, as bright as the picture's sky"),
            None => {
                let scale = luminance(shown.ambient.colour) / luminance(white);
                (
                    scale,
                    "sky solver, a white surface as bright as the ambient light",
                )
            }
        },
    };
    if !(scale.is_finite() && scale > 0.0) {
        return Err(CliError::usage(
            "nothing says how bright the light is in the picture's unit: give --radiance-scale, the picture's units in one \
             cd/m^2",
        ));
    }
    let body = FogSource::Sky {
        sky,
        radiance_scale: scale,
        air: match args.light.air {
            AirArg::Drawn => ExistingAerial::Drawn,
            AirArg::Missing => ExistingAerial::Missing,
        },
    };
    let colour = white * scale;
    Ok((body, Level { colour, how }))
}

/// Radiance of a white level surface in the light at a fog's top.
fn white_surface(light: &FogLighting<Spectrum<3>>) -> Spectrum<3> {
    let sun = light.sun.map_or(Spectrum::ZERO, |sun| {
        sun.irradiance * (sun.direction.y.max(0.0) as f32 / PI)
    });
    light.ambient + sun
}

/// How bright the picture's sky near the horizon is over the solved one.
fn shown_over_solved(args: &OverlayArgs, sky: &FoggySky<3>, shown: &Shown<'_>) -> Option<f32> {
    if args.ambient != "auto" {
        return None;
    }
    let picture = shown.picture;
    let width = picture.size.width();
    let (mut drawn, mut solved) = (0.0, 0.0);
    for pixel in horizon_pixels(picture, shown.depth)? {
        let direction = shown
            .camera
            .pixel_direction(pixel as u32 % width, pixel as u32 / width);
        if direction.y <= 0.0 {
            continue;
        }
        let rgb = &picture.rgb[3 * pixel..];
        drawn += f64::from(luminance(Spectrum([rgb[0], rgb[1], rgb[2]])));
        solved += f64::from(luminance(clear(sky, direction)));
    }
    let scale = (drawn / solved) as f32;
    (scale.is_finite() && scale > 0.0).then_some(scale)
}

fn clear(sky: &FoggySky<3>, direction: DVec3) -> Spectrum<3> {
    let mut rgb = [0.0; 3];
    sky.clear().sample(direction, &mut rgb);
    Spectrum(rgb)
}

/// Luminance of linear sRGB (BT.709).
fn luminance(colour: Spectrum<3>) -> f32 {
    0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
}
