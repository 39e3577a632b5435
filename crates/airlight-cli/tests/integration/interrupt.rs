//! A run that is stopped half-way leaves nothing behind.
#![cfg(unix)]

use crate::common::{Folder, command};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

fn spawn(folder: &Folder, words: &str) -> Child {
    command(folder, words)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn stop(child: Child, signal: Signal) -> (Option<i32>, String) {
    kill(Pid::from_raw(child.id() as i32), signal).unwrap();
    let output = child.wait_with_output().unwrap();
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    )
}

/// Waits until a temporary file that has grown lies in the folder.
fn wait_for_part(folder: &Folder) {
    let start = Instant::now();
    let grown = |name: &String| {
        name.ends_with(".part")
            && std::fs::metadata(folder.file(name)).is_ok_and(|about| about.len() > 100_000)
    };
    while !folder.names("").iter().any(grown) {
        assert!(
            start.elapsed() < Duration::from_secs(120),
            "nothing was written: {:?}",
            folder.names("")
        );
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Waits until a file is there, whole.
fn wait_for_file(folder: &Folder, name: &str) {
    let start = Instant::now();
    while !folder.file(name).exists() {
        assert!(start.elapsed() < Duration::from_secs(240));
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn stopped_while_writing() {
    let words =
        "sky --wavelengths rgb --scattering single --sun-elevation 30 --size 16384x8192 -o a.exr";
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        let folder = Folder::new();
        std::fs::write(folder.file("a.exr"), "what was there before").unwrap();
        let child = spawn(&folder, words);
        wait_for_part(&folder);
        let (code, error) = stop(child, signal);
        assert_eq!(code, Some(130), "{error}");
        assert!(error.contains("stopped"), "{error}");
        assert_eq!(folder.names(""), ["a.exr"]);
        assert_eq!(
            std::fs::read(folder.file("a.exr")).unwrap(),
            b"what was there before"
        );
    }
}

#[test]
fn stopped_while_solving() {
    let folder = Folder::new();
    // Wavelengths enough to be at it for a while.
    let child = spawn(&folder, "sky --wavelengths 1nm --sun-elevation 3 -o a.exr");
    std::thread::sleep(Duration::from_millis(700));
    let (code, error) = stop(child, Signal::SIGINT);
    assert_eq!(code, Some(130), "{error}");
    assert!(folder.names("").is_empty());
}

#[test]
fn interrupted_monte_carlo_keeps_the_picture_of_the_last_pass() {
    let folder = Folder::new();
    let words = "sky --sun-elevation 30 --wavelengths rgb --size 8x4 --solver monte-carlo --paths 1000000000 -o a.exr";
    let child = spawn(&folder, words);
    wait_for_file(&folder, "a.exr");
    let (code, error) = stop(child, Signal::SIGINT);
    assert_eq!(code, Some(130), "{error}");
    assert_eq!(folder.names(""), ["a.exr"]);
    assert_eq!(crate::common::Exr::read(&folder.file("a.exr")).width, 8);
}

#[test]
fn a_stopped_sequence_keeps_its_whole_frames_and_goes_on() {
    let folder = Folder::new();
    let words = "sky --wavelengths rgb --scattering single --at 50,10 --when 2026-06-21T10:00:00Z --until +2h \
                 --every 1h --size 2048x1024 -o a.png";
    let child = spawn(&folder, words);
    wait_for_file(&folder, "a.0001.png");
    let (code, error) = stop(child, Signal::SIGINT);
    assert_eq!(code, Some(130), "{error}");
    let names = folder.names("");
    let (manifest, pictures) = names.split_last().unwrap();
    assert_eq!(manifest, "manifest.jsonl");
    assert!(
        pictures
            .iter()
            .all(|name| name.ends_with(".png") && !name.starts_with('.')),
        "{names:?}"
    );
    let done = pictures.len();
    let text = crate::common::succeed(&folder, words);
    assert!(
        text.contains(&format!("{} of 3 pictures written", 3 - done)),
        "{text}"
    );
    let all = ["a.0001.png", "a.0002.png", "a.0003.png", "manifest.jsonl"];
    assert_eq!(folder.names(""), all);
}

#[test]
fn a_stopped_batch_keeps_its_whole_pictures_and_goes_on() {
    let folder = Folder::new();
    let (width, height) = (300, 200);
    for place in ["rgb", "depth"] {
        std::fs::create_dir(folder.file(place)).unwrap();
    }
    let picture = image::RgbImage::from_fn(width, height, |x, y| image::Rgb([x as u8, y as u8, 9]));
    let depth =
        image::ImageBuffer::from_fn(width, height, |x, y| image::Luma([(9 * x + y) as u16 + 1]));
    for number in 10..30 {
        picture
            .save(folder.file(format!("rgb/{number}.png")))
            .unwrap();
        depth
            .save(folder.file(format!("depth/{number}.png")))
            .unwrap();
    }
    let words = "fog rgb --depth depth --depth-scale 0.01 --fog-profile height --vary visibility=5..50 -o out";
    let child = spawn(&folder, words);
    let start = Instant::now();
    let made = || -> Vec<String> {
        let names = std::fs::read_dir(folder.file("out")).into_iter().flatten();
        let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names
            .filter(|name| !name.starts_with('.') && name.ends_with(".png"))
            .collect()
    };
    while made().is_empty() {
        assert!(start.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(2));
    }
    let (code, error) = stop(child, Signal::SIGINT);
    assert_eq!(code, Some(130), "{error}");
    let done = made().len();
    let all = std::fs::read_dir(folder.file("out")).unwrap().count();
    assert_eq!(all, done + 1, "pictures and manifest, nothing else");
    let manifest = || std::fs::read_to_string(folder.file("out/manifest.jsonl")).unwrap();
    assert_eq!(manifest().lines().count(), done);
    let text = crate::common::succeed(&folder, words);
    assert!(
        text.contains(&format!("{} of 20 pictures written", 20 - done)),
        "{text}"
    );
    assert_eq!((made().len(), manifest().lines().count()), (20, 20));
}
