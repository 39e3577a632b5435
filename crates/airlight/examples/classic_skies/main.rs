//! Published skies beside our solver, with errors and speeds as the book states them:
//! `cargo run -p airlight --example classic_skies --features hosek-wilkie`.

mod article;
mod measure;
mod others;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    article::print()?;
    others::print()
}
