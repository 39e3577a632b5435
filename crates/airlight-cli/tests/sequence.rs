//! Sequences: names, times, taking up where an earlier run stopped.

mod common;

use common::{Exr, Folder, succeed};

const WORDS: &str = "sky --wavelengths rgb --scattering single --size 16x8 --at 50,10 --when 2026-06-21T18:00:00+02:00 \
                     --every 1h";

#[test]
fn frames_there_are_left_as_they_are() {
    let folder = Folder::new();
    let words = format!("{WORDS} --until +3h -o a.exr");
    let text = succeed(&folder, &words);
    assert!(text.contains("4 of 4 frames made"), "{text}");
    let names = ["a.0001.exr", "a.0002.exr", "a.0003.exr", "a.0004.exr"];
    assert_eq!(folder.names(), names);
    // One is missing, one is empty: both are made; the others are not touched.
    std::fs::remove_file(folder.file(names[1])).unwrap();
    std::fs::write(folder.file(names[2]), "").unwrap();
    std::fs::write(folder.file(names[3]), "mine").unwrap();
    let text = succeed(&folder, &words);
    assert!(
        text.contains("2 of 4 frames made, 2 were there already"),
        "{text}"
    );
    assert_eq!(std::fs::read(folder.file(names[3])).unwrap(), b"mine");
    assert!(Exr::read(&folder.file(names[2])).luminance(3, 1) > 0.0);
    assert!(succeed(&folder, &words).contains("0 of 4 frames made"));
    assert!(succeed(&folder, &format!("{words} --overwrite")).contains("4 of 4 frames made"));
    assert!(Exr::read(&folder.file(names[3])).luminance(3, 1) > 0.0);
}

#[test]
fn frames_show_the_moment_they_are_named_after() {
    let folder = Folder::new();
    succeed(
        &folder,
        &format!("{WORDS} --until 2026-06-21T17:30:00Z -o s-{{time}}.png --sun-disc separate"),
    );
    assert_eq!(
        folder.names(),
        [
            "s-20260621T160000Z.png",
            "s-20260621T160000Z.sun.png",
            "s-20260621T170000Z.png",
            "s-20260621T170000Z.sun.png"
        ]
    );
    succeed(&folder, &format!("{WORDS} --until +1h -o b.exr"));
    let single = WORDS.replace("--every 1h", "").replace("18:00", "19:00");
    succeed(&folder, &format!("{single} -o c.exr"));
    let (frame, alone) = (
        Exr::read(&folder.file("b.0002.exr")),
        Exr::read(&folder.file("c.exr")),
    );
    assert_eq!(frame.texts["time"], "2026-06-21T19:00:00+02:00");
    assert_eq!(frame.texts["sunPosition"], alone.texts["sunPosition"]);
    // A sky prepared for all heights of the sun is that prepared for one.
    for (x, y) in [(3, 1), (8, 3), (12, 2), (5, 6)] {
        let (a, b) = (frame.luminance(x, y), alone.luminance(x, y));
        assert!((a / b - 1.0).abs() < 0.01, "{x} {y}: {a} {b}");
    }
}
