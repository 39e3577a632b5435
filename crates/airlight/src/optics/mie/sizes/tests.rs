use super::*;

const FINE: Steps = Steps {
    size: 0.01,
    log: 0.02,
};

fn all() -> [SizeDistribution; 5] {
    [
        SizeDistribution::gamma(10.0, 0.1),
        SizeDistribution::ModifiedGamma {
            alpha: 8.0,
            gamma: 3.0,
            mode_radius_um: 4.0,
        },
        SizeDistribution::ModifiedGamma {
            alpha: 1.0,
            gamma: 0.5,
            mode_radius_um: 0.05,
        },
        SizeDistribution::log_normal(0.0212, 2.24),
        SizeDistribution::LogNormal {
            median_radius_um: 0.5,
            geometric_deviation: 2.2,
            range_um: [0.02, 5.0],
        },
    ]
}

#[test]
fn sums_over_nodes_match_the_closed_moments() {
    for sizes in all() {
        let nodes = sizes.nodes(FINE);
        for power in [2, 3, 4] {
            let sum: f64 = nodes
                .iter()
                .map(|node| node.share * node.radius_um.powi(power))
                .sum();
            let closed = sizes.mean_power(f64::from(power));
            assert!(
                (sum / closed - 1.0).abs() < 1e-5,
                "{sizes:?} {power}: {sum} {closed}"
            );
        }
    }
}

#[test]
fn hansens_parameters_are_effective_radius_and_variance() {
    for (radius, variance) in [(10.0, 0.1), (6.0, 0.02), (0.3, 0.3)] {
        let sizes = SizeDistribution::gamma(radius, variance);
        assert!((sizes.effective_radius_um() / radius - 1.0).abs() < 1e-12);
        assert!((sizes.effective_variance() / variance - 1.0).abs() < 1e-11);
    }
    // exp(5/2 s^2) and exp(s^2) - 1.
    let sizes = SizeDistribution::log_normal(0.2, 1.5);
    let s2 = 1.5f64.ln().powi(2);
    assert!((sizes.effective_radius_um() / (0.2 * (2.5 * s2).exp()) - 1.0).abs() < 1e-12);
    assert!((sizes.effective_variance() / s2.exp_m1() - 1.0).abs() < 1e-11);
    let one = SizeDistribution::Monodisperse { radius_um: 3.0 };
    assert!((one.effective_radius_um() - 3.0).abs() < 1e-12);
    assert!(one.effective_variance().abs() < 1e-12);
}

/// Deirmendjian's cloud C.1 (`alpha` 6, `gamma` 1, 4 micrometres) has effective radius 6 and effective variance 1/9.
#[test]
fn cloud_c1_has_its_known_effective_size() {
    let c1 = SizeDistribution::ModifiedGamma {
        alpha: 6.0,
        gamma: 1.0,
        mode_radius_um: 4.0,
    };
    assert!((c1.effective_radius_um() - 6.0).abs() < 1e-12);
    assert!((c1.effective_variance() - 1.0 / 9.0).abs() < 1e-12);
}

#[test]
fn invalid_parameters_are_refused() {
    let bad = [
        SizeDistribution::Monodisperse { radius_um: 0.0 },
        SizeDistribution::gamma(10.0, 0.4),
        SizeDistribution::gamma(f64::NAN, 0.1),
        SizeDistribution::log_normal(1.0, 1.0),
        SizeDistribution::LogNormal {
            median_radius_um: 1.0,
            geometric_deviation: 2.0,
            range_um: [2.0, 1.0],
        },
    ];
    for sizes in bad {
        assert!(
            matches!(sizes.validate(), Err(MieError::Sizes { .. })),
            "{sizes:?}"
        );
    }
    for sizes in all() {
        sizes.validate().unwrap();
    }
}
