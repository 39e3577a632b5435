use super::*;
use std::time::Instant;

#[test]
fn look() {
    for (name, kind, _) in AerosolType::ALL {
        let start = Instant::now();
        let mix = AerosolMixture::of(kind, 0.8).unwrap();
        let s = mix.summary().unwrap();
        let t = start.elapsed();
        let start = Instant::now();
        let air = crate::medium::gases::air(101_325.0);
        let clear = crate::medium::ClearAir {
            optical_depth_550: air.optical_depth(0.0, 1e5, 550.0),
            ground_extinction_per_m: air.extinction_per_m(550.0),
        };
        let c = mix.constituent(None, None, clear, 0.0, 1e5).unwrap();
        let crate::optics::PhaseFunction::Tabulated(p) = &c.phase else {
            panic!()
        };
        println!(
            "{name:22} ext {:.4}/km ssa {:.4} g {:.4} a {:.3} {:.3} aod {:.3} angles {} p(0) {:.1} t {:?} {:?}",
            s.extinction_per_m * 1e3,
            s.single_scattering_albedo,
            s.asymmetry,
            s.angstrom_350_500,
            s.angstrom_500_800,
            c.optical_depth(0.0, 1e5, 550.0),
            p.angles_rad().len(),
            p.evaluate(1.0, 550.0),
            t,
            start.elapsed()
        );
        if let AerosolType::Biomass(smoke) = kind {
            for m in [440.0, 670.0, 870.0, 1020.0] {
                let (mut sca, mut ext, mut g) = (0.0, 0.0, 0.0);
                for mode in smoke.modes() {
                    let b = crate::optics::mie::Particles::new(mode.index, mode.sizes)
                        .unwrap()
                        .bulk(m)
                        .unwrap();
                    sca += mode.number_per_cm3 * b.scattering_um2;
                    ext += mode.number_per_cm3 * b.extinction_um2();
                    g += mode.number_per_cm3 * b.scattering_um2 * b.asymmetry;
                }
                println!(
                    "   {m} tau {:.4} ssa {:.4} g {:.4}",
                    ext * 1e-6,
                    sca / ext,
                    g / sca
                );
            }
        }
    }
}
