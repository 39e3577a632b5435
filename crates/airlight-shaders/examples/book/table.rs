//! The table of a part's functions in the book.

use airlight_shaders::{ErrorBound, Part, functions};

/// Markdown: what each function computes, what it costs, its largest error.
pub fn function_table(part: Part) -> String {
    let mut table = String::from("| function | computes | cost | error |\n|---|---|---|---|\n");
    for function in functions(part) {
        let computes = first_sentence(&function.documentation[0]);
        assert!(!computes.contains('|'), "{}", function.name);
        table += &format!(
            "| `{}` | {computes} | {} | {} |\n",
            function.name,
            function.cost,
            bound(function.error)
        );
    }
    table
}

/// The text up to the first full stop outside parentheses that ends a sentence, without the stop.
fn first_sentence(text: &str) -> &str {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            '.' if depth == 0 && starts_sentence(&text[at + 1..]) => return &text[..at],
            _ => {}
        }
    }
    text.trim_end_matches('.')
}

/// Whether a text after a full stop begins another sentence.
fn starts_sentence(after: &str) -> bool {
    let next = after.strip_prefix(' ').and_then(|rest| rest.chars().next());
    next.is_some_and(|c| c.is_uppercase() || c == '`')
}

/// `1e-6 relative, 2e-7 absolute`, or either half.
fn bound(error: ErrorBound) -> String {
    let halves = [(error.relative, "relative"), (error.absolute, "absolute")];
    let stated = halves.iter().filter(|(size, _)| *size > 0.0);
    let texts: Vec<String> = stated
        .map(|(size, kind)| match *size < 0.1 {
            true => format!("{size:e} {kind}"),
            false => format!("{size} {kind}"),
        })
        .collect();
    texts.join(", ")
}
