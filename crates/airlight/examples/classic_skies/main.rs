//! Published skies beside our solver, with errors and speeds as the book shows them (`scripts/book`):
//! `cargo run -p airlight --example classic_skies --features hosek-wilkie`; with the name of a table only that one.

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
        return Err(format!("there are {names}").into());
    }
    for (name, print) in TABLES.iter().filter(|(name, _)| wanted(name)) {
        println!("{name}");
        print()?;
    }
    Ok(())
}
