//! Pictures drawn by many machines: shards of one picture, and jobs.

use crate::common::{Exr, Folder, run, succeed};
use serde_json::Value;

const QUICK: &str = "--wavelengths rgb --scattering single";

#[test]
fn bands_of_a_picture_are_joined() {
    let folder = Folder::new();
    let words = format!("sky {QUICK} --sun-elevation 20 --size 160x80");
    succeed(&folder, &format!("{words} -o whole.exr"));
    for number in 1..=3 {
        let text = succeed(&folder, &format!("{words} -o a.exr --shard {number}/3"));
        assert!(
            text.contains(&format!("a-{number}-of-3.exr: 160 x ")),
            "{text}"
        );
    }
    assert!(!folder.file("a.exr").exists());
    let text = succeed(
        &folder,
        "join a-2-of-3.exr a-1-of-3.exr a-3-of-3.exr -o a.exr",
    );
    assert!(text.starts_with("a.exr: 3 bands joined, "), "{text}");
    let [a, whole] = ["a.exr", "whole.exr"].map(|name| Exr::read(&folder.file(name)));
    assert!((a.width, a.height) == (160, 80) && a.channels == whole.channels);
}

#[test]
fn shards_and_joins_that_cannot_be_are_refused() {
    let folder = Folder::new();
    let sky = format!("sky {QUICK} --sun-elevation 20");
    succeed(&folder, &format!("{sky} --size 64x64 -o a.exr --shard 1/2"));
    for (words, code, part) in [
        (
            format!("{sky} --shard 1/2 -o a.png"),
            2,
            "--output: expected an OpenEXR file",
        ),
        (format!("{sky} --shard 1/2"), 2, "expected an output"),
        (
            format!("{sky} --size 128x64 --shard 1/3 -o a.exr"),
            2,
            "at most 2 shards",
        ),
        (
            format!("{sky} --openjd a.json --shard 1/2 -o a.exr"),
            2,
            "--shard",
        ),
        (
            format!("{sky} --openjd a.json -o a.png"),
            2,
            "a sequence of pictures",
        ),
        (
            format!("{sky} --openjd a.json"),
            2,
            "--output: expected a file",
        ),
        (
            format!("{sky} --openjd a.json --tasks 99 -o a.exr"),
            2,
            "--tasks: expected 1 to 32, got 99",
        ),
        (
            "join -o b.exr".to_owned(),
            2,
            "for example: airlight join sky-1-of-2.exr",
        ),
        (
            "join a-1-of-2.exr -o b.png".to_owned(),
            2,
            "expected an OpenEXR file",
        ),
        (
            "join a-1-of-2.exr -o b.exr".to_owned(),
            1,
            "rows 32 to 63 of the picture are in no band",
        ),
    ] {
        let output = run(&folder, &words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words}: {said}");
        assert!(said.contains(part), "{words}: {said}");
    }
}

#[test]
fn a_job_of_fog_makes_the_pictures_of_the_command() {
    let folder = Folder::new();
    for name in ["rgb", "depth"] {
        std::fs::create_dir(folder.file(name)).unwrap();
    }
    for name in ["a", "b", "c"] {
        let colour = image::RgbImage::from_pixel(8, 4, image::Rgb([200, 90, 30]));
        let depth = image::ImageBuffer::from_pixel(8, 4, image::Luma([90_u16]));
        colour.save(folder.file(format!("rgb/{name}.png"))).unwrap();
        depth
            .save(folder.file(format!("depth/{name}_m.png")))
            .unwrap();
    }
    let words = "fog rgb/*.png --depth depth/*_m.png --vary visibility=50..500 --seed 3";
    let text = succeed(
        &folder,
        &format!("{words} -o farm/ --openjd job.json --tasks 2"),
    );
    assert_eq!(text, "job.json: job template\n");
    assert!(!folder.file("farm").exists());
    let job: Value =
        serde_json::from_slice(&std::fs::read(folder.file("job.json")).unwrap()).unwrap();
    let defaults = ["./rgb", "./depth", "./farm", "airlight"];
    for (parameter, default) in job["parameterDefinitions"]
        .as_array()
        .unwrap()
        .iter()
        .zip(defaults)
    {
        assert_eq!(parameter["default"], default, "{parameter}");
    }
    let script = &job["steps"][0]["script"];
    let scene = script["embeddedFiles"][0]["data"].as_str().unwrap();
    std::fs::write(folder.file("scene.toml"), scene).unwrap();
    let action = script["actions"]["onRun"]["args"].as_array().unwrap();
    let action: Vec<&str> = action.iter().map(|word| word.as_str().unwrap()).collect();
    for number in 1..=2 {
        let command = action
            .join(" ")
            .replace("{{Task.File.Scene}}", "scene.toml")
            .replace("{{Param.PicturesDir}}", "rgb")
            .replace("{{Param.DepthDir}}", "depth")
            .replace("{{Param.OutputDir}}", "farm")
            .replace("{{Task.Param.Shard}}", &number.to_string());
        succeed(&folder, &command);
    }
    succeed(&folder, &format!("{words} -o whole/"));
    for name in ["a", "b", "c"] {
        let [farm, whole] = ["farm", "whole"]
            .map(|output| std::fs::read(folder.file(format!("{output}/{name}.png"))).unwrap());
        assert!(farm == whole, "{name}");
    }
    for (words, part) in [
        (
            format!("{words} -o farm/ --openjd a.json --tasks 4"),
            "1 to 3, got 4",
        ),
        (
            format!("{words} -o farm/ --openjd a.json --shard 1/2"),
            "--shard",
        ),
        (
            "fog rgb/a.png --depth depth/a_m.png --visibility-m 9 -o a.png --openjd a.json"
                .to_owned(),
            "expected a folder of pictures",
        ),
    ] {
        let output = run(&folder, &words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            !output.status.success() && said.contains(part),
            "{words}: {said}"
        );
    }
    // A folder may hold a single picture.
    for name in ["b", "c"] {
        std::fs::remove_file(folder.file(format!("rgb/{name}.png"))).unwrap();
    }
    succeed(&folder, &format!("{words} -o farm/ --openjd one.json"));
}

#[test]
fn a_job_draws_nothing_by_itself() {
    let folder = Folder::new();
    let words = format!(
        "sky {QUICK} --at 50,10 --when 2026-06-21T18:00:00+02:00 --every 1h --until +2h --size 16x8 -o a.png"
    );
    let text = succeed(&folder, &format!("{words} --openjd job.json --tasks 2"));
    assert_eq!(text, "job.json: job template\n");
    assert_eq!(folder.names(""), ["job.json"]);
    let job: Value =
        serde_json::from_slice(&std::fs::read(folder.file("job.json")).unwrap()).unwrap();
    assert_eq!(job["specificationVersion"], "jobtemplate-2023-09");
    // The scene that a task draws is that of the options.
    let scene = job["steps"][0]["script"]["embeddedFiles"][0]["data"]
        .as_str()
        .unwrap();
    std::fs::write(folder.file("scene.toml"), scene).unwrap();
    for part in ["1/2", "2/2"] {
        succeed(
            &folder,
            &format!("sky --scene scene.toml -o b.png --shard {part}"),
        );
    }
    succeed(&folder, &words);
    for number in 1..=3 {
        let pixels = ["a", "b"].map(|name| {
            let path = folder.file(format!("{name}.000{number}.png"));
            image::open(path).unwrap().into_rgb8()
        });
        assert!(pixels[0] == pixels[1], "{number}");
    }
}
