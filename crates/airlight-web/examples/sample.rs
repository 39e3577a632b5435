//! Prints the values that the browser must compute, too, or with `time` the seconds in which one thread solves the sky of the viewer:
//! `cargo run --release -p airlight-web --example sample`.

use airlight_web::sample;
use std::time::Instant;

fn main() {
    if std::env::args().nth(1).as_deref() == Some("time") {
        let begin = Instant::now();
        let light = sample::solve_all_suns();
        println!("{:.3} s ({light:e})", begin.elapsed().as_secs_f64());
    } else {
        print!("{}", sample::text(&sample::values()));
    }
}
