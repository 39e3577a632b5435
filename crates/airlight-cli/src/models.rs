//! Published models of the sky, made from the options; [`lit`](mod@lit): over the ground that they light.

mod lit;

pub use lit::{Light, Lit, disc};

use crate::args::{
    AirArgs, EffortArg, ModelArgs, ScatteringArg, SkyArgs, SkyFogArgs, SolverArg, SunlightArg,
    VariantArg,
};
use crate::error::CliError;
use crate::scene::{Scene, Sun};
use airlight::atmosphere::aerosol::turbidity_of_optical_depth;
use airlight::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile};
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight::models::PublishedModel;
use airlight::models::four_orders::FourOrders;
use airlight::models::hillaire2020::{self, Hillaire2020};
use airlight::models::klassen1987::fog::SunDepth;
use airlight::models::klassen1987::{Fog1987, Klassen1987, Klassen1987Scene, Klassen1987Settings};
use airlight::models::preetham::Preetham;
use airlight::models::single_scattering::{
    self, SkyArticle, Sunlight, Variant, ZENITH_ILLUMINANCE_LX,
};
use airlight::sky::SkySettings;
use std::fmt::Display;
use std::sync::Arc;

/// The model asked for, under a sun and over the scene's ground.
///
/// # Errors
/// [`CliError::Usage`] for what the model refuses.
pub fn lit(air: &AirArgs, args: &ModelArgs, scene: &Scene, sun: &Sun) -> Result<Lit, CliError> {
    let model = model(air, args, scene, sun)?;
    Ok(Lit::new(model, &scene.atmosphere.planet.ground_albedo))
}

/// The same for a picture. Where that has fog or things before the sky of 1987, with what it takes to light them.
///
/// # Errors
/// [`CliError::Usage`] for what the model refuses.
pub fn lit_in_picture(
    args: &SkyArgs,
    scene: &Scene,
    sun: &Sun,
) -> Result<(Lit, Option<Arc<Klassen1987Scene>>), CliError> {
    let whole = args.fog.fog_visibility_m.is_some() || args.objects.objects.is_some();
    if args.air.solver != SolverArg::Klassen1987 || !whole {
        return Ok((lit(&args.air, &args.model, scene, sun)?, None));
    }
    refuse_scattering(&args.air)?;
    let scene1987 = Arc::new(scene_of_1987(args, scene, sun)?);
    let albedo = &scene.atmosphere.planet.ground_albedo;
    Ok((Lit::new(scene1987.clone(), albedo), Some(scene1987)))
}

fn model(
    air: &AirArgs,
    args: &ModelArgs,
    scene: &Scene,
    sun: &Sun,
) -> Result<Arc<dyn PublishedModel>, CliError> {
    refuse_scattering(air)?;
    refuse_height(air, scene)?;
    let direction = sun.direction();
    let eye_altitude_m = scene.eye_altitude_m;
    Ok(match air.solver {
        SolverArg::Klassen1987 => Arc::new(of_1987(args, scene, sun)?),
        SolverArg::SingleScattering => {
            let settings = article_settings(args, eye_altitude_m);
            let refused = refused_by("single-scattering");
            Arc::new(SkyArticle::new(&settings, direction).map_err(refused)?)
        }
        SolverArg::Preetham => {
            let turbidity = turbidity(&scene.atmosphere);
            Arc::new(Preetham::new(turbidity, direction).map_err(refused_by("preetham"))?)
        }
        SolverArg::HosekWilkie => hosek_wilkie(scene, sun)?,
        SolverArg::Hillaire2020 => {
            let mut settings = hillaire2020::Settings::default();
            if air.scattering == ScatteringArg::Single {
                settings.multiple = None;
            }
            let sky = Hillaire2020::with_settings(
                &at_sun_distance(&scene.atmosphere, sun),
                &scene.grid,
                eye_altitude_m,
                direction,
                &settings,
            );
            Arc::new(sky.map_err(refused_by("hillaire2020"))?)
        }
        SolverArg::Bruneton2008 => {
            let settings = SkySettings {
                suns: scene.near(sun),
                ..match air.effort {
                    EffortArg::Standard => SkySettings::default(),
                    EffortArg::Fine => SkySettings::fine(),
                }
            };
            let eye_and_sun = (eye_altitude_m, direction);
            let atmosphere = at_sun_distance(&scene.atmosphere, sun);
            let sky = FourOrders::new(&atmosphere, &scene.grid, eye_and_sun, 4, &settings);
            Arc::new(sky.map_err(refused_by("bruneton2008"))?)
        }
        SolverArg::Orders | SolverArg::MonteCarlo => {
            return Err(CliError::failure("this solver is no published model"));
        }
    })
}

/// Refuses a height that a model leaves out, and would draw wrongly without a word.
fn refuse_height(air: &AirArgs, scene: &Scene) -> Result<(), CliError> {
    let name = air.solver.name();
    let height_m = scene.eye_altitude_m - scene.atmosphere.planet.ground_altitude_m;
    match air.solver {
        SolverArg::Klassen1987 if height_m > ON_THE_GROUND_M => Err(CliError::usage(
            "--solver klassen1987 looks from the ground, but into a fog or at objects: leave out --altitude-m and --eye-height-m, \
             or give --fog-visibility-m or --objects",
        )),
        SolverArg::Preetham | SolverArg::HosekWilkie if height_m > ON_THE_GROUND_M => {
            Err(CliError::usage(format!(
                "--solver {name} looks from the ground: leave out --altitude-m and --eye-height-m"
            )))
        }
        _ => Ok(()),
    }
}

/// Refuses single scattering of a model that has no say in it.
fn refuse_scattering(air: &AirArgs) -> Result<(), CliError> {
    match air.solver {
        SolverArg::Hillaire2020 => Ok(()),
        solver if air.scattering == ScatteringArg::Single => Err(CliError::usage(format!(
            "--scattering single is for --solver orders, monte-carlo and hillaire2020: leave it out for {}, which has orders of \
             its own",
            solver.name()
        ))),
        _ => Ok(()),
    }
}

/// Bits that the model of 1987 remembers colours for: files may hold more than 8, and are exposed later.
const BITS: u32 = 12;
/// How far above the ground an eye may be whose height a model leaves out, m.
const ON_THE_GROUND_M: f64 = 100.0;

/// The sun and the sky of 1987.
fn of_1987(args: &ModelArgs, scene: &Scene, sun: &Sun) -> Result<Klassen1987, CliError> {
    let settings = klassen(args, scene, sun);
    Klassen1987::new(&settings, sun.direction()).map_err(refused_by("klassen1987"))
}

/// The same with fog, ground and an eye at any height.
fn scene_of_1987(args: &SkyArgs, scene: &Scene, sun: &Sun) -> Result<Klassen1987Scene, CliError> {
    let model = Arc::new(of_1987(&args.model, scene, sun)?);
    let depth = match args.model.variant {
        Some(VariantArg::Printed) => SunDepth::Printed,
        _ => SunDepth::Exact,
    };
    let eye_m = scene.eye_altitude_m - scene.atmosphere.planet.ground_altitude_m;
    let fog = fog_of_1987(&args.fog)?;
    Klassen1987Scene::new(model, eye_m, fog, depth).map_err(refused_by("klassen1987"))
}

/// The fog of the options, which must be a slab.
fn fog_of_1987(args: &SkyFogArgs) -> Result<Option<Fog1987>, CliError> {
    let Some(visibility_m) = args.fog_visibility_m else {
        return Ok(None);
    };
    let Some(top_m) = args.fog_top_m else {
        return Err(CliError::usage(
            "the fog of --solver klassen1987 is even up to a height: say with --fog-top-m up to which",
        ));
    };
    let extinction = extinction_per_m(visibility_m, Contrast::FivePercent);
    let drops = args.fog_droplets.0;
    Ok(Some(Fog1987 {
        top_m,
        droplets: Constituent::fog(
            extinction,
            drops,
            DensityProfile::slab(top_m),
            &Klassen1987::wavelengths(),
        )?,
    }))
}

/// The layers of 1987 that stand for the scene's air, with what the options change.
fn klassen(args: &ModelArgs, scene: &Scene, sun: &Sun) -> Klassen1987Settings {
    let mut settings = Klassen1987Settings {
        bits_per_channel: BITS,
        ..Klassen1987Settings::of(&scene.atmosphere)
    };
    settings.clear_air = at_sun_distance(&settings.clear_air, sun);
    if args.variant == Some(VariantArg::Printed) {
        settings = settings.printed();
    }
    args.klassen.apply(&mut settings);
    settings
}

/// The air of a planet as far from the sun as it is: irradiance falls by the square, the disc shrinks.
fn at_sun_distance(air: &Atmosphere, sun: &Sun) -> Atmosphere {
    let mut air = air.clone();
    let ratio = sun.distance_ratio;
    air.solar_irradiance = air.solar_irradiance.scaled(1.0 / (ratio * ratio));
    air.sun.angular_radius_rad = (air.sun.angular_radius_rad.sin() / ratio).asin();
    air
}

/// What a model says of numbers that it refuses.
fn refused_by<E: Display>(solver: &'static str) -> impl Fn(E) -> CliError {
    move |error| CliError::usage(format!("--solver {solver}: {error}"))
}

fn article_settings(args: &ModelArgs, eye_altitude_m: f64) -> single_scattering::Settings {
    single_scattering::Settings {
        variant: match args.variant {
            Some(VariantArg::Printed) => Variant::Printed,
            Some(VariantArg::PrintedF64) => Variant::PrintedF64,
            Some(VariantArg::Table) => Variant::Table,
            Some(VariantArg::Multiple) => Variant::Multiple,
            Some(VariantArg::Corrected) | None => Variant::Converged,
        },
        sunlight: match args.sunlight {
            Some(SunlightArg::Measured) => Sunlight::SolarSpectrum,
            Some(SunlightArg::White) | None => {
                Sunlight::WhiteAtZenith(args.zenith_lux.unwrap_or(ZENITH_ILLUMINANCE_LX))
            }
        },
        eye_altitude_m,
    }
}

/// The turbidity of an air: optical depth of molecules and haze over that of molecules, at 550 nm.
fn turbidity(air: &Atmosphere) -> f64 {
    let planet = &air.planet;
    let depth = air
        .constituent(&ConstituentKind::Aerosol)
        .map_or(0.0, |haze| {
            haze.optical_depth(planet.ground_altitude_m, planet.top_altitude_m, 550.0)
        });
    turbidity_of_optical_depth(depth, air.clear_air())
}

#[cfg(feature = "hosek-wilkie")]
fn hosek_wilkie(scene: &Scene, sun: &Sun) -> Result<Arc<dyn PublishedModel>, CliError> {
    use airlight::models::hosek_wilkie::HosekWilkie;
    use airlight::spectrum::rgb::DOMINANT_NM;

    let air = &scene.atmosphere;
    let albedo = DOMINANT_NM.map(|nm| air.planet.ground_albedo.at(nm));
    let sky = HosekWilkie::new(turbidity(air), albedo, sun.direction());
    Ok(Arc::new(sky.map_err(refused_by("hosek-wilkie"))?))
}

#[cfg(not(feature = "hosek-wilkie"))]
fn hosek_wilkie(_: &Scene, _: &Sun) -> Result<Arc<dyn PublishedModel>, CliError> {
    Err(CliError::usage(
        "--solver hosek-wilkie is not in this build: build airlight-cli with --features hosek-wilkie",
    ))
}
