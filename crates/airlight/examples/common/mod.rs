//! Command line of the examples that print tables.

use std::error::Error;

/// Name of a table and the function that prints it.
pub type Table = (&'static str, fn());

/// Prints the table named on the command line, or all tables, each below its name.
pub fn print(tables: &[Table]) -> Result<(), Box<dyn Error>> {
    let only = std::env::args().nth(1);
    let wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    if !tables.iter().any(|(name, _)| wanted(name)) {
        let names: Vec<&str> = tables.iter().map(|(name, _)| *name).collect();
        return Err(format!("expected one of {}", names.join(", ")).into());
    }
    for (name, table) in tables.iter().filter(|(name, _)| wanted(name)) {
        println!("{name}");
        table();
    }
    Ok(())
}
