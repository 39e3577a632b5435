//! Computes the embedded tables of the published drop distributions again: `cargo run --release -p airlight --example drop_tables`
//! writes `data/optics/drops` (minutes of processor time); with names of distributions, those only.

use airlight::Named;
use airlight::optics::mie::droplets::Drops;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/optics/drops");
    let named: Vec<String> = std::env::args().skip(1).collect();
    let drops = match named.as_slice() {
        [] => Drops::ALL.to_vec(),
        names => names
            .iter()
            .map(|name| name.parse())
            .collect::<Result<_, _>>()?,
    };
    for drops in drops {
        // The same distribution as heavy radiation fog.
        if drops == Drops::CloudC1 {
            continue;
        }
        let name = drops.name();
        let source = format!(
            "Phase function and scattering matrix of the drop distribution {name}: {}.\n\
             Water of the refractive index in data/optics/water_index.txt.\n\
             Computed by: cargo run --release -p airlight --example drop_tables\n\
             Layout: src/optics/mie/stored.rs",
            drops.summary(),
        );
        let file = folder.join(name).with_extension("bin");
        std::fs::write(&file, drops.file_of_stored_table(&source)?)?;
        println!("{}", file.display());
    }
    Ok(())
}
