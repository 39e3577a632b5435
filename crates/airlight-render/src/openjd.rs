//! [`JobTemplate`]: jobs of Open Job Description, which render farms run.

use crate::batch::{BatchPlan, is_batch};
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
        let toml = embedded("the scene", scene.to_toml()?)?;
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
        draw["script"]["embeddedFiles"] = toml;
        let steps = match sequence {
            Some(_) => vec![draw],
            None => vec![draw, join(renderer, path, tasks)?],
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let parameters = json!([OUTPUT.definition(folder), program_parameter()]);
        Ok(Self(template(&file_name(path), Some(parameters), &steps)))
    }

    /// A job that adds fog to the pictures of a batch, a task for each shard. The description is a part of the template. Parameters of
    /// the job are the folders of the pictures, of their depth maps (if they are files of their own) and of the outputs, and the name
    /// of the program; folders that are relative are the defaults, from the folder of the template. Without a number of
    /// tasks there are 16, or fewer for few inputs.
    ///
    /// # Errors
    /// [`RenderError`] for a single picture, for one shard of a batch, for a manifest at a path of its own or pictures to replace, for more
    /// tasks than there are inputs, and for a description that is too large for a template.
    pub fn of_batch(plan: &BatchPlan, tasks: Option<u32>) -> Result<Self, RenderError> {
        let (scene, settings) = (plan.scene(), plan.settings());
        let colour = &scene.overlay.colour;
        let inputs = plan.found().inputs.len() as u64;
        let is_batch = is_batch(colour, scene.output()?)
            .map_err(|error| RenderError::setting(error.to_string()))?;
        if !is_batch {
            return Err(RenderError::setting(format!(
                "a job: expected a folder of pictures or a pattern, got `{}`",
                colour.display()
            )));
        }
        if settings.shard.is_some() || settings.manifest.is_some() || settings.overwrite {
            return Err(RenderError::setting(
                "a job: expected a batch without a shard, a manifest and pictures to replace, which are those of each task; try leaving them out",
            ));
        }
        let usual = u64::from(USUAL_TASKS).min(inputs) as u32;
        let tasks = checked_tasks(tasks.unwrap_or(usual), inputs)?;
        let mut description = scene.clone();
        // Options of the command take their place.
        description.overlay.colour = PathBuf::from(".");
        (description.overlay.depth, description.scene.output.file) = (None, None);
        let toml = embedded("the description", description.to_toml()?)?;
        let folders = [
            (&PICTURES, Some(colour.as_path())),
            (&DEPTH, scene.overlay.depth.as_deref()),
            (&OUTPUT, Some(scene.output()?)),
        ];
        let mut arguments = ["fog", "--scene", "{{Task.File.Scene}}"]
            .map(str::to_owned)
            .to_vec();
        let mut parameters = Vec::new();
        for (parameter, path) in folders {
            let Some(path) = path else { continue };
            let (folder, pattern) = folder_and_pattern(path);
            let pattern = plain("the name of a file", pattern.to_string_lossy().into_owned())?;
            arguments.extend(parameter.option.map(str::to_owned));
            arguments.push(format!("{{{{Param.{}}}}}/{pattern}", parameter.name));
            parameters.push(parameter.definition(&folder));
        }
        parameters.push(program_parameter());
        for (option, values) in [
            ("--vary", texts(&settings.vary)),
            ("--each", texts(&settings.each)),
            ("--variants", texts(&settings.variants)),
            ("--patch-interval-s", texts(&settings.patch_interval_s)),
            ("--jobs", texts(&settings.threads)),
        ] {
            arguments.extend(values.into_iter().map(|value| format!("{option}={value}")));
        }
        if !settings.vary.is_empty() {
            arguments.push(format!("--seed={}", settings.seed));
        }
        let switches = [
            ("--skip-unpaired", settings.skip_unpaired),
            ("--fail-fast", settings.fail_fast),
        ];
        let given = switches.into_iter().filter(|(_, is_given)| *is_given);
        arguments.extend(given.map(|(option, _)| option.to_owned()));
        let mut step = step("fog", "{{Param.Program}}", &arguments, tasks);
        step["script"]["embeddedFiles"] = toml;
        Ok(Self(template("fog", Some(json!(parameters)), &[step])))
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

/// A folder that is a parameter of a job.
struct FolderParameter {
    name: &'static str,
    /// Option of the command that the path follows.
    option: Option<&'static str>,
    data_flow: &'static str,
    description: &'static str,
}

const PICTURES: FolderParameter = FolderParameter {
    name: "PicturesDir",
    option: None,
    data_flow: "IN",
    description: "Folder of the pictures to which fog is added.",
};

const DEPTH: FolderParameter = FolderParameter {
    name: "DepthDir",
    option: Some("--depth"),
    data_flow: "IN",
    description: "Folder of the depth maps.",
};

const OUTPUT: FolderParameter = FolderParameter {
    name: "OutputDir",
    option: Some("--output"),
    data_flow: "OUT",
    description: "Folder of the pictures that are written.",
};

impl FolderParameter {
    fn definition(&self, folder: &Path) -> Value {
        let mut definition = json!({
            "name": self.name,
            "type": "PATH",
            "objectType": "DIRECTORY",
            "dataFlow": self.data_flow,
            "description": self.description,
        });
        if let Some(folder) = folder_of_template(folder) {
            definition["default"] = json!(folder);
        }
        definition
    }
}

/// The parameter for the name of the program.
fn program_parameter() -> Value {
    json!({
        "name": "Program",
        "type": "STRING",
        "default": "airlight",
        "description": "The program airlight, of version 0.1 or later.",
    })
}

/// The folder of a path of a batch, and the rest, which is a file or has wildcards or placeholders; nothing for a folder.
fn folder_and_pattern(path: &Path) -> (PathBuf, PathBuf) {
    if let (true, Some(name), Some(folder)) = (path.is_file(), path.file_name(), path.parent()) {
        return (folder.to_owned(), PathBuf::from(name));
    }
    let is_fixed = |part: &Component<'_>| {
        let name = part.as_os_str().to_string_lossy();
        !name.contains(['*', '{'])
    };
    let folder: PathBuf = path.components().take_while(is_fixed).collect();
    let pattern = path.components().skip_while(is_fixed).collect();
    (folder, pattern)
}

/// Values as texts.
fn texts<'a, T: ToString + 'a>(values: impl IntoIterator<Item = &'a T>) -> Vec<String> {
    values.into_iter().map(T::to_string).collect()
}

/// A scene as a file of a step.
///
/// # Errors
/// [`RenderError`] for a scene that is too large.
fn embedded(what: &str, toml: String) -> Result<Value, RenderError> {
    let toml = plain(what, toml)?;
    match toml.chars().count() {
        0..=LARGEST_FILE => {
            Ok(json!([{"name": "Scene", "filename": "scene.toml", "type": "TEXT", "data": toml}]))
        }
        count => Err(RenderError::setting(format!(
            "{what}: expected at most {LARGEST_FILE} characters in a job template, got {count}; try fewer objects, or a shorter table \
             of the atmosphere"
        ))),
    }
}

/// A folder as the default of a parameter, which must be in the folder of the template; `None` elsewhere.
fn folder_of_template(folder: &Path) -> Option<String> {
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
        for (folder, default) in [
            ("", Some("./")),
            ("b/c", Some("./b/c")),
            ("/b", None),
            ("..", None),
        ] {
            let found = folder_of_template(Path::new(folder));
            assert_eq!(found.as_deref(), default, "{folder}");
        }
    }

    #[test]
    fn folders_of_a_batch_end_before_wildcards_and_placeholders() {
        for (path, folder, pattern) in [
            ("rgb/", "rgb", ""),
            ("rgb/*_left.png", "rgb", "*_left.png"),
            ("/data/day*/rgb/*.png", "/data", "day*/rgb/*.png"),
            ("out/{visibility}/", "out", "{visibility}"),
            ("*.png", "", "*.png"),
        ] {
            let found = folder_and_pattern(Path::new(path));
            assert_eq!(found, (folder.into(), pattern.into()), "{path}");
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
