//! Air whose amounts change from frame to frame, as when a slider is dragged.

use crate::{draw, renderer};
use airlight::atmosphere::{Atmosphere, ConstituentKind, Preset, gases};
use airlight::axes;
use airlight_gpu::headless::{Frame, Headless};
use airlight_gpu::{SkyRenderer, SkyRendererError};

const HEIGHT_M: f64 = 2.0;
const SUN_DEG: f64 = 30.0;

/// Clear air with the amount of ozone of a step.
fn air(step: u32) -> Atmosphere {
    let mut air = Preset::Clear.atmosphere();
    air.put(gases::ozone(f64::from(100 + 37 * step % 401)));
    air
}

fn frame() -> Frame {
    Frame::towards(axes::direction(100.0, 10.0).as_vec3(), 8)
}

/// Whether the tables are those of the last air.
fn update(renderer: &mut SkyRenderer) -> Result<bool, SkyRendererError> {
    renderer.update_in_background(HEIGHT_M, axes::direction(140.0, SUN_DEG))
}

/// Frames are drawn with the last tables while air is solved for, those of some amounts appear although the amounts go on changing, and the
/// last one is that of the last amount.
#[test]
fn frames_go_on_while_amounts_change() {
    /// Pictures that are seen while amounts change.
    const PICTURES: u32 = 3;
    let gpu = Headless::new().unwrap();
    let mut renderer = renderer(&gpu, Preset::Clear, SUN_DEG, HEIGHT_M);
    let draw = |renderer: &mut SkyRenderer| draw(&gpu, renderer, &frame(), 1e-4, None);
    while !update(&mut renderer).unwrap() {
        std::thread::yield_now();
    }
    let mut seen = draw(&mut renderer);
    let (mut step, mut pictures) = (0, 0);
    while pictures < PICTURES {
        renderer.set_atmosphere_in_background(&air(step)).unwrap();
        assert!(!update(&mut renderer).unwrap());
        let now = draw(&mut renderer);
        // Air that was set for this frame cannot be in it yet.
        assert!(step > 0 || now == seen);
        if now != seen {
            pictures += 1;
            seen = now;
        }
        step += 1;
    }
    // A frame starts to solve, a later one to fill tables, and one after that shows them.
    assert!(step > 2 * PICTURES, "{step}");
    let last = air(step - 1);
    renderer.set_atmosphere_in_background(&last).unwrap();
    while !update(&mut renderer).unwrap() {
        std::thread::yield_now();
    }
    let in_the_end = draw(&mut renderer);
    let mut right = crate::renderer(&gpu, Preset::Clear, SUN_DEG, HEIGHT_M);
    right.set_atmosphere(&last).unwrap();
    right
        .update(HEIGHT_M, axes::direction(140.0, SUN_DEG))
        .unwrap();
    assert_eq!(in_the_end, draw(&mut right));
    assert_eq!(renderer.sky().atmosphere(), &last);
    // The same air again is no work.
    let tables = renderer.work().tables;
    renderer.set_atmosphere_in_background(&last).unwrap();
    assert!(update(&mut renderer).unwrap());
    assert_eq!(renderer.work().tables, tables);
}

/// Air that cannot be solved for is an error of a later update, and frames go on in the air before.
#[test]
fn air_that_cannot_be_solved_for_changes_nothing() {
    let gpu = Headless::new().unwrap();
    let mut renderer = renderer(&gpu, Preset::Clear, SUN_DEG, HEIGHT_M);
    renderer
        .update(HEIGHT_M, axes::direction(140.0, SUN_DEG))
        .unwrap();
    let before = draw(&gpu, &mut renderer, &frame(), 1e-4, None);
    let mut too_many = air(0);
    for k in 0..9 {
        let mut part = gases::ozone(10.0);
        part.kind = ConstituentKind::Other(format!("gas {k}"));
        too_many.put(part);
    }
    renderer.set_atmosphere_in_background(&too_many).unwrap();
    let refused = loop {
        match update(&mut renderer) {
            Err(error) => break error,
            Ok(is_done) => assert!(!is_done),
        }
        std::thread::yield_now();
    };
    assert!(matches!(refused, SkyRendererError::Sky(_)), "{refused:?}");
    assert!(update(&mut renderer).unwrap());
    assert_eq!(draw(&gpu, &mut renderer, &frame(), 1e-4, None), before);
}
