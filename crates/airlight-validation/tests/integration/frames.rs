//! Frames of a graphics device against the solver. Run with `--nocapture` for the errors.

use airlight::Control;
use airlight_gpu::headless::Headless;
use airlight_validation::frames::{
    Case, FrameRow, Quantity, Renderer, against_monte_carlo, against_solver,
};
use airlight_validation::{Check, Suite, Unit, run};

/// Root mean square and largest error of a renderer.
fn errors(rows: &[FrameRow], renderer: Renderer, quantity: Quantity) -> (f64, f64) {
    let chosen = rows
        .iter()
        .filter(|r| r.renderer == renderer && r.quantity == quantity);
    let errors: Vec<f64> = chosen.map(|r| quantity.unit().error(&r.row)).collect();
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    let largest = errors.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    ((squares / errors.len() as f64).sqrt(), largest)
}

fn case(air: &'static str, sun_deg: f64, height_m: f64) -> Case {
    Case {
        air,
        sun_deg,
        height_m,
    }
}

#[test]
fn a_frame_is_truer_than_published_real_time_models() {
    let device = Headless::new().unwrap();
    let rows = against_solver(&device, &[case("hazy", 10.0, 2.0)], 64, Control::default()).unwrap();
    for (quantity, rms, each) in [
        (Quantity::Sky, 0.2, 1.0),
        (Quantity::SkyColour, 0.1, 0.5),
        (Quantity::Walls, 0.3, 1.0),
        (Quantity::WallColour, 0.3, 1.0),
    ] {
        let ours = errors(&rows, Renderer::AirlightGpu, quantity);
        println!("{}: {ours:.2?}", quantity.name());
        assert!(ours.0 < rms && ours.1 < each, "{}", quantity.name());
    }
    for quantity in [Quantity::Sky, Quantity::SkyColour] {
        let all = Renderer::ALL.map(|renderer| errors(&rows, renderer, quantity));
        println!("{}: {all:.2?}", quantity.name());
        let [ours, paper, even] = all;
        assert!(ours.0 < 0.2 * paper.0 && ours.1 < 0.5 * paper.1);
        assert!(ours.0 < 0.2 * even.0 && ours.1 < 0.5 * even.1);
    }
}

#[test]
fn a_frame_is_that_of_the_monte_carlo() {
    let device = Headless::new().unwrap();
    let rows = against_monte_carlo(
        &device,
        &[case("clear", 30.0, 2.0)],
        12,
        4096,
        Control::default(),
    )
    .unwrap();
    assert_eq!(rows.len(), 12);
    for row in rows {
        let (error, noise) = (Unit::Percent.error(&row), Unit::Percent.noise(&row));
        println!("{error:+.2} % (noise {noise:.2}) at {}", row.at);
        assert!(error.abs() < 1.0 + 3.0 * noise);
    }
}

/// All frames; prints their errors.
#[test]
#[ignore = "solves for all suns in four atmospheres and draws 144 skies: six minutes of a processor"]
fn all_frames_are_within_their_claims() {
    let checks = run(&[Suite::GpuAll]).unwrap();
    for check in &checks {
        let s = check.statistics().expect("a check has rows");
        let (what, against) = (&check.what, &check.against);
        println!(
            "{what}, {against}: rms {:.2}, worst {:+.2} at {}",
            s.rms, s.worst, s.worst_at
        );
        assert!(check.holds(), "{what}: {:?}", check.broken());
    }
    // Four quantities by six places and suns; of the published models, those of the sky.
    let claims = checks.iter().filter(|check| Check::claims(check));
    assert_eq!((checks.len(), claims.count()), (24 + 2 * 12, 24));
}
