//! [`JobTemplate`]: jobs of Open Job Description, which render farms run.

use crate::error::RenderError;
use crate::layout::PictureFile;
use crate::renderer::Renderer;
use crate::shard::Shard;
use crate::sky_rows::Layer;
use airlight_image::PictureFormat;
use airlight_image::output::RowBand;
use serde_json::{Value, json};
use std::path::{Component, Path, PathBuf};

/// Largest number of tasks of a step, of the specification.
const MOST_TASKS: u32 = 1024;
/// Largest embedded file, characters, of the specification.
const LARGEST_FILE: usize = 32 * 1024;
/// Tasks of a job that does not state their number.
const USUAL_TASKS: u32 = 16;

/// A job template of [Open Job Description](https://github.com/OpenJobDescription/openjd-specifications), version `2023-09`, whose
/// tasks run the program `airlight`, each on one [`Shard`]. Pixels do not depend on the number of tasks.
#[derive(Clone, Debug, PartialEq)]
pub struct JobTemplate(Value);

impl JobTemplate {
    /// A job that draws the pictures of a renderer's scene, a sequence by pictures, a single picture by bands of rows, which a last
    /// step joins. The scene is a part of the template. Parameters of the job are the folder of the pictures and the name of the program;
    /// a folder of the scene that is relative is the default, from the folder of the template. Without a number of tasks there are 16, or fewer for small jobs.
    ///
    /// # Errors
    /// [`RenderError`] for a scene without a file, for a single picture that is not an EXR file, for more tasks than there are
    /// pictures or bands, and for a scene that is too large for a template.
    pub fn of_scene(renderer: &Renderer, tasks: Option<u32>) -> Result<Self, RenderError> {
        let path = renderer.output_path()?;
        let name = file_name(path);
        let mut scene = renderer.scene().clone();
        scene.output.file = Some(name.clone());
        if let (Some(start), None | Some("now")) =
            (renderer.resolved().sun.start(), scene.sun.time.as_deref())
            && scene.sun.elevation_deg.is_none()
        {
            scene.sun.time = Some(start.to_string());
        }
        let toml = plain("the scene", scene.to_toml()?)?;
        if toml.chars().count() > LARGEST_FILE {
            return Err(RenderError::setting(format!(
                "expected a scene of at most {LARGEST_FILE} characters in a job template, got {}; try fewer objects, or a shorter table \
                 of the atmosphere",
                toml.chars().count()
            )));
        }
        let sequence = renderer.sequence()?;
        let most = match &sequence {
            Some(sequence) => sequence.steps().len() as u64,
            None => bands(renderer, path)?,
        };
        let usual = u64::from(USUAL_TASKS).min(most) as u32;
        let tasks = checked_tasks(tasks.unwrap_or(usual), most)?;
        let output = in_folder(&plain("the name of the picture", name)?);
        let arguments = ["sky", "--scene", "{{Task.File.Scene}}", "-o", &output].map(str::to_owned);
        let mut draw = step("sky", "{{Param.Program}}", &arguments, tasks);
        draw["script"]["embeddedFiles"] =
            json!([{"name": "Scene", "filename": "scene.toml", "type": "TEXT", "data": toml}]);
        let steps = match sequence {
            Some(_) => vec![draw],
            None => vec![draw, join(renderer, path, tasks)?],
        };
        let mut parameters = json!([
            {
                "name": "OutputDir",
                "type": "PATH",
                "objectType": "DIRECTORY",
                "dataFlow": "OUT",
                "description": "Folder of the pictures.",
            },
            {
                "name": "Program",
                "type": "STRING",
                "default": "airlight",
                "description": "The program airlight, of version 0.1 or later.",
            },
        ]);
        if let Some(folder) = folder_of_template(path) {
            parameters[0]["default"] = json!(folder);
        }
        Ok(Self(template(&file_name(path), Some(parameters), &steps)))
    }

    /// A job that runs a command of the program in parts: the words of `airlight fog` or `airlight sky` with options. Paths are those
    /// of the machines that run the tasks. A single picture of `airlight sky` is drawn in bands of rows, which
    /// [`exr::join`](airlight_image::output::exr::join) joins.
    ///
    /// # Errors
    /// [`RenderError`] for other commands, for words that each task sets, and for a number of tasks out of range.
    pub fn of_command(name: &str, words: &[String], tasks: u32) -> Result<Self, RenderError> {
        let refused = |expected: &str, got: &str| {
            RenderError::setting(format!("command: expected {expected}, got {got}"))
        };
        let [program, command, ..] = words else {
            let got = words.first().map_or("nothing", String::as_str);
            return Err(refused("airlight fog or airlight sky with options", got));
        };
        if !matches!(command.as_str(), "fog" | "sky") {
            return Err(refused(
                "airlight fog or airlight sky with options",
                command,
            ));
        }
        let set = |word: &&String| matches!(word.split('=').next(), Some("--shard" | "--openjd"));
        if let Some(word) = words.iter().find(set) {
            return Err(refused(
                "options without --shard, which each task sets",
                word,
            ));
        }
        for word in words {
            plain("command", word.clone())?;
        }
        let tasks = checked_tasks(tasks, MOST_TASKS.into())?;
        let steps = [step(command, program, &words[1..], tasks)];
        Ok(Self(template(name, None, &steps)))
    }

    /// The template as JSON, which is YAML too.
    pub fn to_json(&self) -> String {
        format!("{:#}\n", self.0)
    }
}

/// The folder of a picture as the default of a parameter, which must be in the folder of the template; `None` elsewhere.
fn folder_of_template(picture: &Path) -> Option<String> {
    let folder = picture.parent().unwrap_or(Path::new(""));
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    let folder = Path::new(".").join(folder.components().all(is_inside).then_some(folder)?);
    Some(folder.to_string_lossy().into_owned())
}

/// A template of steps.
fn template(name: &str, parameters: Option<Value>, steps: &[Value]) -> Value {
    let mut template = json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": name,
        "steps": steps,
    });
    if let Some(parameters) = parameters {
        template["parameterDefinitions"] = parameters;
    }
    template
}

/// A step with a task for each shard.
fn step(name: &str, program: &str, arguments: &[String], tasks: u32) -> Value {
    let shard = [
        "--shard".to_owned(),
        format!("{{{{Task.Param.Shard}}}}/{tasks}"),
    ];
    let arguments = [arguments, &shard].concat();
    json!({
        "name": name,
        "parameterSpace": {
            "taskParameterDefinitions": [{"name": "Shard", "type": "INT", "range": format!("1-{tasks}")}],
        },
        "script": {
            "actions": {"onRun": {"command": program, "args": arguments}},
        },
    })
}

/// The step that joins the bands of each file of a picture.
fn join(renderer: &Renderer, path: &Path, tasks: u32) -> Result<Value, RenderError> {
    let names = pictures(renderer, path).into_iter().map(|picture| {
        let stem = picture.file_stem().unwrap_or_default();
        plain(
            "the name of the picture",
            stem.to_string_lossy().into_owned(),
        )
    });
    let names = names.collect::<Result<Vec<_>, _>>()?;
    let name = Path::new("{{Task.Param.Name}}.exr");
    let bands = Shard::all(tasks).map(|shard| in_folder(&file_name(&shard.path_of(name))));
    let mut arguments = vec!["join".to_owned()];
    arguments.extend(bands);
    arguments.extend(["-o".to_owned(), in_folder(&file_name(name))]);
    Ok(json!({
        "name": "join",
        "dependencies": [{"dependsOn": "sky"}],
        "parameterSpace": {
            "taskParameterDefinitions": [{"name": "Name", "type": "STRING", "range": names}],
        },
        "script": {
            "actions": {"onRun": {"command": "{{Param.Program}}", "args": arguments}},
        },
    }))
}

/// The files of a single picture, with the maps beside it.
fn pictures(renderer: &Renderer, path: &Path) -> Vec<PathBuf> {
    let output = &renderer.scene().output;
    let maps = [
        ("noise", output.noise_map),
        ("polarisation", output.polarisation),
        ("depth", output.depth_map),
    ];
    let of_file = |file: PictureFile| {
        let of_sky = maps.iter().filter(|_| file.layer != Layer::Disc);
        let wanted = of_sky.filter(|(_, wanted)| *wanted == Some(true));
        let mut files: Vec<_> = wanted.map(|(tag, _)| file.map_path(tag)).collect();
        files.push(file.path);
        files
    };
    let files = renderer.layout().files(path).into_iter();
    files.flat_map(of_file).collect()
}

/// Number of bands of a single picture.
fn bands(renderer: &Renderer, path: &Path) -> Result<u64, RenderError> {
    if renderer.layout().format() != Some(PictureFormat::EXR) {
        return Err(RenderError::value(
            "output.file",
            "an OpenEXR file for a job of one picture, whose bands of rows are joined",
            format!("`{}`", path.display()),
            "a name that ends in .exr, or a sequence of pictures",
        ));
    }
    let files = renderer.layout().files(path).into_iter();
    let heights = files.map(|file| file.frame.size().height());
    Ok(u64::from(
        heights.min().unwrap_or(0).div_ceil(RowBand::MULTIPLE),
    ))
}

fn checked_tasks(tasks: u32, most: u64) -> Result<u32, RenderError> {
    let most = most.min(MOST_TASKS.into());
    match (1..=most).contains(&tasks.into()) {
        true => Ok(tasks),
        false => Err(RenderError::setting(format!(
            "tasks: expected 1 to {most}, got {tasks}"
        ))),
    }
}

/// Refuses text that a template would take for an expression.
fn plain(what: &str, text: String) -> Result<String, RenderError> {
    match text.contains("{{") {
        true => Err(RenderError::setting(format!(
            "{what}: expected text without {{{{, which begins an expression of a job template, got it in `{text}`"
        ))),
        false => Ok(text),
    }
}

fn in_folder(name: &str) -> String {
    format!("{{{{Param.OutputDir}}}}/{name}")
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::scene::Scene;

    fn of_scene(toml: &str, tasks: Option<u32>) -> Result<Value, RenderError> {
        let scene = Scene::from_toml(toml).unwrap();
        Ok(JobTemplate::of_scene(&Renderer::new(&scene)?, tasks)?.0)
    }

    const DAY: &str = "sun = { latitude_deg = 50, longitude_deg = 10, time = '2026-06-21T18:00:00+02:00' }\n\
                       sequence = { every = '1h', until = '+2h' }\noutput.file = 'day/a.png'\n";

    #[test]
    fn a_sequence_is_a_task_for_each_shard() {
        let job = of_scene(DAY, None).unwrap();
        let step = &job["steps"][0];
        assert_eq!(job["steps"].as_array().unwrap().len(), 1);
        let tasks = &step["parameterSpace"]["taskParameterDefinitions"][0];
        assert_eq!(tasks["range"], "1-3");
        let action = &step["script"]["actions"]["onRun"];
        let words = "sky --scene {{Task.File.Scene}} -o {{Param.OutputDir}}/a.png --shard {{Task.Param.Shard}}/3";
        let expected: Vec<&str> = words.split(' ').collect();
        assert_eq!(action["args"], json!(expected));
        assert_eq!(job["parameterDefinitions"][0]["default"], "./day");
        let data = step["script"]["embeddedFiles"][0]["data"].as_str().unwrap();
        let drawn = Scene::from_toml(data).unwrap();
        assert_eq!(drawn.output.file.as_deref(), Some("a.png"));
        assert!(
            of_scene(DAY, Some(4))
                .unwrap_err()
                .to_string()
                .contains("1 to 3")
        );
    }

    #[test]
    fn folders_outside_that_of_the_template_are_no_default() {
        for (picture, folder) in [
            ("a.png", Some("./")),
            ("b/c/a.png", Some("./b/c")),
            ("/b/a.png", None),
            ("../a.png", None),
        ] {
            let found = folder_of_template(Path::new(picture));
            assert_eq!(found.as_deref(), folder, "{picture}");
        }
    }

    #[test]
    fn a_time_that_is_now_is_the_same_in_all_tasks() {
        let now = DAY.replace("2026-06-21T18:00:00+02:00", "now");
        let job = of_scene(&now, None).unwrap();
        let data = job["steps"][0]["script"]["embeddedFiles"][0]["data"]
            .as_str()
            .unwrap();
        let time = Scene::from_toml(data).unwrap().sun.time.unwrap();
        assert!(time.starts_with("20"), "{time}");
    }

    #[test]
    fn bands_of_a_picture_are_joined() {
        let toml = "sun.elevation_deg = 20\ncamera.size = [256, 128]\n\
                    output = { file = 'a.exr', sun_disc = 'separate', polarisation = true }";
        let job = of_scene(toml, None).unwrap();
        let join = &job["steps"][1];
        assert_eq!(join["dependencies"][0]["dependsOn"], "sky");
        let names = &join["parameterSpace"]["taskParameterDefinitions"][0]["range"];
        assert_eq!(names, &json!(["a.sun", "a.polarisation", "a"]));
        let args = join["script"]["actions"]["onRun"]["args"]
            .as_array()
            .unwrap();
        assert_eq!(args.len(), 1 + 4 + 2);
        assert_eq!(
            args[4],
            "{{Param.OutputDir}}/{{Task.Param.Name}}-4-of-4.exr"
        );
        let png = of_scene(
            &toml
                .replace("a.exr", "a.png")
                .replace(", polarisation = true", ""),
            None,
        );
        assert!(png.unwrap_err().to_string().contains("OpenEXR"));
    }

    #[test]
    fn commands_that_cannot_be_split_are_refused() {
        let job = |command: &str, tasks| {
            let words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
            JobTemplate::of_command("job", &words, tasks).map(|job| job.0)
        };
        for (command, tasks, said) in [
            ("airlight", 3, "got airlight"),
            ("", 3, "got nothing"),
            ("airlight probe", 3, "got probe"),
            ("airlight fog --shard=1/2", 3, "--shard"),
            ("airlight fog {{a", 3, "expression"),
            ("airlight fog", 0, "1 to 1024"),
            ("airlight fog", 1025, "1 to 1024"),
        ] {
            let error = job(command, tasks).unwrap_err().to_string();
            assert!(error.contains(said), "{command}: {error}");
        }
        let job = job("airlight fog rgb --depth depth -o out", 4).unwrap();
        let action = &job["steps"][0]["script"]["actions"]["onRun"];
        assert_eq!(action["command"], "airlight");
        assert_eq!(
            action["args"].as_array().unwrap().last().unwrap(),
            "{{Task.Param.Shard}}/4"
        );
    }
}
