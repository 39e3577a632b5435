//! Prints the book's table of the functions of a part.
//!
//! ```sh
//! cargo run -p airlight-shaders --example function_table -- fog
//! ```

use airlight::Named;
use airlight_shaders::Part;

#[path = "book/table.rs"]
mod table;

fn main() {
    let name = std::env::args().nth(1).unwrap_or_default();
    match Part::from_name(&name) {
        Ok(part) => print!("{}", table::function_table(part)),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(2);
        }
    }
}
