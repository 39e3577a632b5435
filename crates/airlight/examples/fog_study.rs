//! Where the short cuts of fog hold: the tables of the book's chapter on fog.
//!
//! `cargo run --release -p airlight --example fog_study`

use airlight::axes::direction;
use airlight::fog::{
    Fog, Ground, Layer, Light, Profile, Scattering, Sun, approximation, droplets::Droplets,
};
use airlight::spectrum::Spectrum;

fn main() {
    split_sum_map();
    lamp_beside_the_line();
    sun_undimmed();
}

/// Error of the split sum for sources that change exponentially along the line.
fn split_sum_map() {
    let rates = [-0.9, -0.5, -0.2, -0.05, 0.05, 0.2, 0.5, 1.0, 2.0, 5.0];
    println!("Split sum against exact, percent: source e^-(k t), t the optical depth from the eye");
    print!("{:>8}", "tau \\ k");
    rates.iter().for_each(|k| print!("{k:>8}"));
    println!();
    for tau in [0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0] {
        print!("{tau:>8}");
        for k in rates {
            print!("{:>8.1}", 100.0 * approximation::split_sum_error(tau, k));
        }
        println!();
    }
}

/// Error of the split sum and of leaving out extinction, for a lamp beside the line of sight.
fn lamp_beside_the_line() {
    println!(
        "\nLamp halfway along the line, h to its side (in lengths of the line): percent against exact"
    );
    println!(
        "{:>8}{:>8}{:>14}{:>16}",
        "tau", "h", "split sum", "no extinction"
    );
    for tau in [0.1, 0.5, 1.0, 3.0] {
        for aside in [0.01, 0.1, 0.5, 2.0] {
            // A line of length 1 with extinction tau; source e^-(tau r) / r^2 but for constants.
            let source = |s: f64| {
                let r2 = (s - 0.5).powi(2) + aside * aside;
                (-tau * r2.sqrt()).exp() / r2
            };
            let exact = mean(aside, |s| source(s) * (-tau * s).exp());
            let split = mean(aside, source) * -f64::exp_m1(-tau) / tau;
            let none = mean(aside, |s| 1.0 / ((s - 0.5).powi(2) + aside * aside));
            println!(
                "{tau:>8}{aside:>8}{:>14.1}{:>16.0}",
                100.0 * (split / exact - 1.0),
                100.0 * (none / exact - 1.0)
            );
        }
    }
}

/// `int_0^1 f ds` with steps that crowd where a lamp at 1/2, `aside` away, is near: even in angle.
fn mean(aside: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 20_000;
    let end = (0.5 / aside).atan();
    (0..STEPS)
        .map(|k| {
            let angle = end * (2.0 * (f64::from(k) + 0.5) / f64::from(STEPS) - 1.0);
            f(0.5 + aside * angle.tan()) * aside / angle.cos().powi(2)
        })
        .sum::<f64>()
        * 2.0
        * end
        / f64::from(STEPS)
}

/// Ishiyama's model as printed against the same with the sun's own way through the fog.
fn sun_undimmed() {
    println!(
        "\nHeight fog, scale height 50 m, visibility at the ground as given, 150 m level line, eye at 2 m, away from the sun:"
    );
    println!("path radiance of sunlight without its dimming in the fog over that with it");
    print!("{:>14}", "visibility m");
    let suns = [5.0, 15.0, 30.0, 60.0, 90.0];
    suns.iter()
        .for_each(|e| print!("{:>9}", format!("sun {e}")));
    println!();
    for visibility in [5000.0, 1000.0, 300.0, 100.0] {
        print!("{visibility:>14}");
        for elevation in suns {
            let path = |scattering| {
                let layer: Layer<1> = Layer {
                    profile: Profile::Exponential {
                        reference_height_m: 0.0,
                        scale_height_m: 50.0,
                    },
                    matter: Droplets::Radiation.matter(3.0 / visibility),
                };
                let light = Light {
                    sun: Some(Sun {
                        direction: direction(0.0, elevation),
                        irradiance: Spectrum::ONE,
                    }),
                    ambient: Spectrum::ZERO,
                    ground_albedo: Spectrum::ZERO,
                };
                let fog = Fog::new(&[layer], Ground::FLAT, light, scattering).expect("a fog");
                fog.along(2.0, direction(180.0, 0.0), 150.0).path_radiance[0]
            };
            let ratio = path(Scattering::Undimmed) / path(Scattering::Single);
            let text = match ratio < 1e3 {
                true => format!("{ratio:.2}"),
                false => "> 1000".to_owned(),
            };
            print!("{text:>9}");
        }
        println!();
    }
}
