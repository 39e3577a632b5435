//! `airlight accuracy` as a user meets it.

use crate::common::{Folder, run, succeed};

#[test]
fn the_measured_sky_is_reported() {
    let folder = Folder::new();
    assert_eq!(succeed(&folder, "accuracy measured -o a.html"), "");
    let page = std::fs::read_to_string(folder.file("a.html")).unwrap();
    assert!(page.starts_with("<!doctype html>"));
    assert!(page.contains("air of the day") && page.contains("hosek"));
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
        assert!(folder.names("").is_empty(), "{words}");
    }
}

#[test]
#[cfg(not(feature = "gpu"))]
fn suites_of_a_graphics_device_say_how_to_build_them() {
    for suite in ["gpu", "gpu-all", "gpu-monte-carlo"] {
        let output = run(&Folder::new(), &format!("accuracy {suite}"));
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(
            error.contains(suite) && error.contains("--features gpu"),
            "{error}"
        );
    }
}
