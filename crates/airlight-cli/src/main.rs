//! The airlight program.

fn main() {}
