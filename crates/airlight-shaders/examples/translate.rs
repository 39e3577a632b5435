//! Writes all shader functions in every language to the folder `generated` of the crate, or to another folder, and with it the page
//! `examples/web/sky-article.html`.
//!
//! ```sh
//! cargo run -p airlight-shaders --example translate
//! ```

use airlight::Named;
use airlight_shaders::{Language, Part, translated_files};
use std::path::PathBuf;

#[path = "web/page.rs"]
mod page;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/generated")),
        PathBuf::from,
    );
    for &language in Language::ALL {
        if language == Language::Wgsl {
            continue;
        }
        let folder = folder.join(language.name());
        std::fs::create_dir_all(&folder)?;
        for file in translated_files(Part::ALL, language)? {
            let path = folder.join(file.name);
            std::fs::write(&path, file.contents)?;
            println!("{}", path.display());
        }
    }
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/web/sky-article.html");
    std::fs::write(page, page::assembled()?)?;
    println!("{page}");
    Ok(())
}
