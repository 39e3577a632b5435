//! What the book shows must work.

use airlight::atmosphere::Atmosphere;

/// The fenced blocks of a language in a Markdown text.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    text.split(fence.as_str())
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap_or(""))
        .collect()
}

#[test]
fn the_readme_shows_the_example_of_the_crate() {
    let readme = include_str!("../../../../README.md");
    let of_crate = include_str!("../../README.md");
    let examples = blocks(readme, "rust");
    assert!(!examples.is_empty());
    for example in examples {
        assert!(
            of_crate.contains(example),
            "the documentation tests of the crate do not run this example:\n{example}"
        );
    }
}

#[test]
fn atmospheres_of_the_book_are_read() {
    let chapter = include_str!("../../../../docs/src/atmosphere.md");
    let types = include_str!("../../../../docs/src/aerosols.md");
    let examples = [blocks(chapter, "toml"), blocks(types, "toml")].concat();
    assert!(examples.len() >= 6, "{}", examples.len());
    for example in examples {
        let air =
            Atmosphere::from_toml(example).unwrap_or_else(|error| panic!("{error}\n{example}"));
        assert!(!air.constituents.is_empty(), "{example}");
    }
}
