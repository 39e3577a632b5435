//! Result of a probe as plain text.

use airlight::night::magnitude_per_square_arcsec;
use airlight_render::probe::{ProbeAnswer, RayAnswer};
use airlight_render::summary::short;
use std::fmt::Write;

/// Formats the result.
pub fn text(answer: &ProbeAnswer) -> String {
    let mut text = head(answer);
    for view in &answer.views {
        text.push('\n');
        text.push_str(&one(answer, view));
    }
    text
}

fn head(answer: &ProbeAnswer) -> String {
    let (observer, sun) = (&answer.observer, &answer.sun);
    let mut text = format!(
        "air           {}, eye at {} m\n",
        answer.atmosphere.as_deref().unwrap_or("the model's own"),
        short(observer.altitude_m)
    );
    text.push_str(&solver(answer));
    if let (Some(latitude), Some(longitude), Some(time)) = (
        observer.latitude_deg,
        observer.longitude_deg,
        &observer.time_utc,
    ) {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "place, time   latitude {latitude}, longitude {longitude}, {time}"
        );
    }
    let _ = writeln!(
        text,
        "sun           elevation {:.4} deg, azimuth {:.4} deg; {}\nilluminance   sun {} lx facing it, {} lx horizontal; sky \
        {} lx horizontal",
        sun.elevation_deg,
        sun.azimuth_deg,
        towards(sun.direction),
        short(sun.illuminance_normal_lx),
        short(sun.illuminance_horizontal_lx),
        short(answer.sky.illuminance_horizontal_lx)
    );
    let [sun_rgb, sky_rgb] = [sun.rgb_normal_lx, answer.sky.rgb_horizontal_lx].map(colour);
    let _ = writeln!(
        text,
        "colour        {} sun {sun_rgb} lx facing it; sky {sky_rgb} lx horizontal",
        answer.color_space
    );
    if let Some(moon) = &answer.moon {
        let _ = writeln!(
            text,
            "moon          elevation {:.4} deg, azimuth {:.4} deg, {:.0} % lit; {} lx facing it, {} lx horizontal",
            moon.elevation_deg,
            moon.azimuth_deg,
            100.0 * moon.lit_fraction,
            short(moon.illuminance_normal_lx),
            short(moon.illuminance_horizontal_lx)
        );
    }
    if answer.views.is_empty() && !answer.wavelengths_nm.is_empty() {
        let columns = [
            ("outside", &sun.irradiance_outside_w_m2_nm),
            ("sun, facing", &sun.irradiance_normal_w_m2_nm),
            ("sun, horiz.", &sun.irradiance_horizontal_w_m2_nm),
            ("sky, horiz.", &answer.sky.irradiance_horizontal_w_m2_nm),
        ];
        text.push_str("\nirradiance, W m^-2 nm^-1\n");
        lines(&mut text, &answer.wavelengths_nm, &columns);
    }
    text
}

/// A unit vector in world axes.
fn towards(direction: [f64; 3]) -> String {
    // No negative zeros.
    let [east, up, south] = direction.map(|c| (c * 1e6).round() / 1e6 + 0.0);
    format!("east {east}, up {up}, south {south}")
}

fn colour(rgb: [f64; 3]) -> String {
    rgb.map(short).join(" ")
}

/// Line with the solver or published model, and whether it has spectra.
fn solver(answer: &ProbeAnswer) -> String {
    let variant = answer.variant.as_ref();
    let variant = variant.map_or(String::new(), |variant| format!(", {variant}"));
    let spectra = match answer.wavelengths_nm.is_empty() {
        true => "; colours only, no spectra",
        false => "",
    };
    format!("solver        {}{variant}{spectra}\n", answer.solver)
}

/// Luminance as astronomers state it, in words for a sky as dark as late twilight.
fn night_magnitude(luminance_cd_m2: f64) -> String {
    /// About 16 magnitudes per square arcsecond.
    const DARK_CD_M2: f64 = 0.05;
    match luminance_cd_m2 > 0.0 && luminance_cd_m2 < DARK_CD_M2 {
        true => {
            let magnitude = magnitude_per_square_arcsec(luminance_cd_m2);
            format!(" ({magnitude:.2} mag/arcsec^2)")
        }
        false => String::new(),
    }
}

fn one(answer: &ProbeAnswer, view: &RayAnswer) -> String {
    let end = match (view.distance_m, view.meets_ground) {
        (_, true) => "to the ground".to_owned(),
        (Some(m), false) => format!("over {} m", short(m)),
        (None, false) => "to space".to_owned(),
    };
    let rgb = colour(view.rgb_cd_m2);
    let [x, y, z] = view.xyz_cd_m2.map(short);
    let mut text = format!(
        "azimuth {} deg, elevation {} deg, {end}, {:.3} deg from the sun; {}\nluminance {} cd/m^2{}; XYZ {x} {y} {z}; {} {rgb} \
         cd/m^2\n",
        view.azimuth_deg,
        view.elevation_deg,
        view.sun_angle_deg,
        towards(view.direction),
        short(view.luminance_cd_m2),
        night_magnitude(view.luminance_cd_m2),
        answer.color_space,
    );
    if answer.wavelengths_nm.is_empty() {
        return text;
    }
    text.push_str("radiance, W m^-2 sr^-1 nm^-1\n");
    let mut columns = vec![("all", &view.radiance_w_m2_sr_nm)];
    let parts = [
        ("single", &view.radiance_single_w_m2_sr_nm),
        ("multiple", &view.radiance_multiple_w_m2_sr_nm),
        ("ground", &view.radiance_ground_w_m2_sr_nm),
        ("transmittance", &view.transmittance),
    ];
    let known = parts.into_iter();
    columns.extend(known.filter_map(|(name, values)| Some((name, values.as_ref()?))));
    let single = |values: &[f64]| -> Vec<f32> { values.iter().map(|&v| v as f32).collect() };
    let found = view.monte_carlo.as_ref();
    let mut more = Vec::new();
    if let Some(found) = found {
        more.push(("Monte Carlo", single(&found.radiance_w_m2_sr_nm)));
        more.push(("std. error", single(&found.standard_error_w_m2_sr_nm)));
    }
    if let Some(found) = view.polarisation() {
        let values = [
            ("polarised", &found.stokes_i_w_m2_sr_nm),
            ("degree", &found.degree),
            ("std. error", &found.degree_standard_error),
            ("angle, deg", &found.angle_deg),
            ("std. error", &found.angle_standard_error_deg),
        ];
        let known = values.into_iter().filter(|(_, values)| !values.is_empty());
        more.extend(known.map(|(name, values)| (name, single(values))));
    }
    columns.extend(more.iter().map(|(name, values)| (*name, values)));
    lines(&mut text, &answer.wavelengths_nm, &columns);
    text
}

fn lines(text: &mut String, wavelengths_nm: &[f64], columns: &[(&str, &Vec<f32>)]) {
    let _ = write!(text, "{:>8}", "nm");
    for (name, _) in columns {
        let _ = write!(text, " {name:>13}");
    }
    text.push('\n');
    for (lane, nm) in wavelengths_nm.iter().enumerate() {
        let _ = write!(text, "{nm:>8}");
        for (_, values) in columns {
            let _ = write!(text, " {:>13}", short(f64::from(values[lane])));
        }
        text.push('\n');
    }
}
