//! `airlight accuracy` as a user meets it.

use crate::common::{Folder, run, succeed};

#[test]
fn the_measured_sky_is_reported_in_every_form() {
    let folder = Folder::new();
    let text = succeed(&folder, "accuracy measured");
    assert!(
        text.contains("air of the day") && text.contains("hosek"),
        "{text}"
    );
    for (name, start) in [
        ("a.json", "{"),
        ("a.html", "<!doctype html>"),
        ("a.txt", "The sky"),
    ] {
        assert_eq!(
            succeed(&folder, &format!("accuracy measured -o {name}")),
            ""
        );
        let written = std::fs::read_to_string(folder.file(name)).unwrap();
        assert!(written.starts_with(start), "{name}");
    }
}

#[test]
fn bad_requests_are_refused_before_anything_is_computed() {
    let folder = Folder::new();
    for (words, code, part) in [
        ("accuracy measured -o report.pdf", 2, ".html"),
        ("accuracy measured --rows", 2, "JSON"),
        ("accuracy measured -o none/a.html", 1, "none"),
        ("accuracy everything", 2, "tables"),
    ] {
        let output = run(&folder, words);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words}: {error}");
        assert!(error.contains(part), "{words}: {error}");
        assert!(folder.names().is_empty(), "{words}");
    }
}
