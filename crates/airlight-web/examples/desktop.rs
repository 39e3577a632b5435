//! Draws the window of the desktop with the state of an address, for comparison with the page:
//! `cargo run -p airlight-web --example desktop -- 'FRAGMENT' WIDTHxHEIGHT OUT.png`; an empty fragment is the first state.

use airlight_viewer::{Options, State, screenshot};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [fragment, size, output] = arguments.as_slice() else {
        return Err("expected a fragment, WIDTHxHEIGHT and OUT.png".into());
    };
    let state = match fragment.as_str() {
        "" => State::default(),
        fragment => State::from_fragment(fragment)?,
    };
    let (width, height) = size.split_once('x').ok_or("expected WIDTHxHEIGHT")?;
    let options = Options {
        state,
        size: [width.parse()?, height.parse()?],
        ..Options::default()
    };
    Ok(screenshot(options, Path::new(output))?)
}
