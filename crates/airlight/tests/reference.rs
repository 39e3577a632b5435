//! The solver against outside truth.
use airlight::medium::{Atmosphere, reference};
use airlight::sky::{air::Air, field::*, orders::*, ray::Ray, shell::Shell, trace::Tracer};
use std::sync::Arc;
use std::time::Instant;

fn rows(text: &str) -> Vec<Vec<String>> {
    text.lines()
        .skip(1)
        .map(|l| l.split(',').map(|s| s.trim().to_string()).collect())
        .collect()
}

struct Solved {
    air: Air<4>,
    field: RadianceField<4>,
}

fn solve(atm: &Atmosphere, nm: [f64; 4], sun: f64) -> Solved {
    let t = Instant::now();
    let shell = Arc::new(Shell::new(atm).unwrap());
    let t1 = t.elapsed();
    let env = |k: &str, d: usize| std::env::var(k).map_or(d, |v| v.parse().unwrap());
    let s = OrderSettings {
        full_degree: env("LF", 8),
        zonal_degree: env("LZ", 12),
        rescattered_degree: env("LR", 4),
        first: Directions {
            zenith_nodes: [env("Z0", 8), env("Z1", 5), env("Z2", 8)],
            azimuths: env("AZ", 12),
            panel_nodes: env("PN", 3),
        },
        later: Directions {
            zenith_nodes: [env("Y0", 5), env("Y1", 4), env("Y2", 6)],
            azimuths: env("AY", 8),
            panel_nodes: env("PY", 2),
        },
        tolerance: 1e-4 * env("TOL", 100) as f32,
        max_orders: 30,
    };
    let air = Air::new(atm, shell, nm, s.zonal_degree);
    let offs = std::env::var("OFF").unwrap_or("-14,-8,-4,-1.5,0,1.5,4,8,14".into());
    let offs: Vec<f64> = offs.split(',').map(|x| x.parse().unwrap()).collect();
    let mut z: Vec<f64> = offs.iter().map(|d| sun + d).filter(|z| *z > 0.0).collect();
    z.insert(0, 0.0);
    z.dedup();
    let grid = FieldGrid::new(&air, env("NR", 24), &z);
    let field = orders_solve(&air, grid, &s);
    if std::env::var("TIMES").is_ok() {
        println!(
            "shell {t1:?} all {:?} panels {:?}",
            t.elapsed(),
            air.shell
                .panel_radii_m
                .iter()
                .map(|r| (r - air.shell.planet_radius_m).round())
                .collect::<Vec<_>>()
        );
    }
    Solved { air, field }
}
use airlight::sky::orders::solve as orders_solve;

fn mean_rms(v: &[(f64, String)]) -> String {
    if v.is_empty() {
        return "none".into();
    }
    let n = v.len() as f64;
    let m = v.iter().map(|x| x.0).sum::<f64>() / n;
    let r = (v.iter().map(|x| x.0 * x.0).sum::<f64>() / n).sqrt();
    let mut s: Vec<_> = v.to_vec();
    s.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    format!(
        "n {} mean {:+.3}% rms {:.3}% worst {:+.3}% {} | {:+.3}% {} | {:+.3}% {}",
        v.len(),
        m * 100.,
        r * 100.,
        s[0].0 * 100.,
        s[0].1,
        s[1].0 * 100.,
        s[1].1,
        s[2].0 * 100.,
        s[2].1
    )
}

#[test]
fn monte_carlo() {
    let sets: Vec<(
        &str,
        &str,
        Box<dyn Fn(&str) -> Atmosphere>,
        Vec<(&str, f64)>,
    )> = vec![
        (
            "rayleigh",
            include_str!("data/mc_sphere_rayleigh.csv"),
            Box::new(|c| reference::rayleigh(c[1..].parse().unwrap())),
            vec![("5.8e-6", 680.), ("13.5e-6", 550.), ("33.1e-6", 440.)],
        ),
        (
            "earth_demo",
            include_str!("data/mc_sphere_earth_demo.csv"),
            Box::new(|_| reference::earth_demo()),
            vec![("680", 680.), ("550", 550.), ("440", 440.)],
        ),
        (
            "csm",
            include_str!("data/mc_sphere_csm.csv"),
            Box::new(|_| reference::csm()),
            vec![("442.25", 442.25), ("548", 548.), ("677.25", 677.25)],
        ),
    ];
    for (name, text, make, channels) in sets {
        let rows = rows(text);
        let mut keys: Vec<(String, String)> =
            rows.iter().map(|r| (r[0].clone(), r[1].clone())).collect();
        keys.dedup();
        keys.sort();
        keys.dedup();
        let nm: [f64; 4] = [channels[0].1, channels[1].1, channels[2].1, 500.];
        for (config, sun) in keys {
            let atm = make(&config);
            let sz: f64 = sun.parse().unwrap();
            let solved = solve(&atm, nm, sz);
            let mut tracer = Tracer::new(&solved.air, Some(&solved.field));
            let (mut e1, mut e) = (vec![], vec![]);
            for r in rows.iter().filter(|r| r[0] == config && r[1] == sun) {
                let vz: f64 = r[2].parse().unwrap();
                let az: f64 = r[3].parse().unwrap();
                let lane = channels.iter().position(|c| c.0 == r[4]).unwrap();
                let (mu, mus) = (vz.to_radians().cos(), sz.to_radians().cos());
                let nu = mu * mus
                    + vz.to_radians().sin() * sz.to_radians().sin() * az.to_radians().cos();
                let ray = Ray {
                    radius_m: solved.air.shell.ground_radius_m + 1.0,
                    mu,
                    mu_sun: mus,
                    nu,
                };
                let light = tracer.trace(&ray, f64::INFINITY);
                let e0 = if name == "rayleigh" {
                    1.0
                } else {
                    atm.solar_irradiance.at(nm[lane])
                };
                let single = f64::from(light.single(&solved.air, nu)[lane]) * e0;
                let all = single + f64::from((light.multiple + light.ground)[lane]) * e0;
                let want: f64 = r[5].parse().unwrap();
                let se: f64 = r[6].parse().unwrap();
                let want1: f64 = r[7].parse().unwrap();
                let what = format!("vz{} az{} {}", r[2], r[3], r[4]);
                e.push((
                    all / want - 1.0,
                    format!("{what} se {:.2}%", se / want * 100.),
                ));
                e1.push((single / want1 - 1.0, what));
            }
            println!(
                "{name} {config} sun {sun}\n   single {}\n   all    {}",
                mean_rms(&e1),
                mean_rms(&e)
            );
        }
    }
}
