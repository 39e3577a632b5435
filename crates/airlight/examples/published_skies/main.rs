//! Prints the book's tables of published sky models compared with our solver (`scripts/book`):
//! `cargo run -p airlight --example published_skies --features hosek-wilkie`; with the name of a table only that one.

mod article;
mod measure;
mod others;

type Fallible = Result<(), Box<dyn std::error::Error>>;
type Table = fn() -> Fallible;

const TABLES: [(&str, Table); 7] = [
    ("once", article::once),
    ("all", article::all),
    ("article-times", article::times),
    ("average", others::average),
    ("luminance", others::luminance),
    ("zenith", others::zenith),
    ("times", others::times),
];

fn main() -> Fallible {
    let only = std::env::args().nth(1);
    let wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    if !TABLES.iter().any(|(name, _)| wanted(name)) {
        let names = TABLES.map(|(name, _)| name).join(", ");
        return Err(format!("expected one of {names}").into());
    }
    for (name, print) in TABLES.iter().filter(|(name, _)| wanted(name)) {
        println!("{name}");
        print()?;
    }
    Ok(())
}
