//! What examples that print tables share.

use std::error::Error;

/// A table and its name.
pub type Table = (&'static str, fn());

/// Prints the table that the command line names, or all of them, each under its name.
pub fn print(tables: &[Table]) -> Result<(), Box<dyn Error>> {
    let only = std::env::args().nth(1);
    let wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    if !tables.iter().any(|(name, _)| wanted(name)) {
        let names: Vec<&str> = tables.iter().map(|(name, _)| *name).collect();
        return Err(format!("there are {}", names.join(", ")).into());
    }
    for (name, table) in tables.iter().filter(|(name, _)| wanted(name)) {
        println!("{name}");
        table();
    }
    Ok(())
}
