//! Translations: complete, up to date, and accepted by an independent compiler where one is installed.

use airlight::Named;
use airlight_shaders::{
    Language, Part, Pass, functions, spirv_modules, translate, translated_files,
};
use std::path::Path;
use std::process::Command;

/// Languages of generated files.
fn translated() -> impl Iterator<Item = Language> {
    let all = Language::ALL.iter().copied();
    all.filter(|&language| language != Language::Wgsl)
}

/// Those of them in which functions stand alone.
fn with_functions() -> impl Iterator<Item = Language> {
    translated().filter(|language| language.has_functions())
}

#[test]
fn generated_files_are_up_to_date() {
    for language in translated() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("generated")
            .join(language.name());
        let files = translated_files(Part::ALL, language).unwrap();
        let kept = std::fs::read_dir(&folder).map_or(0, Iterator::count);
        assert_eq!(kept, files.len(), "files in {}", folder.display());
        for file in files {
            let path = folder.join(file.name);
            let mut bytes = std::fs::read(&path).unwrap_or_default();
            if path.extension().is_none_or(|ending| ending != "spv") {
                bytes = String::from_utf8(bytes)
                    .unwrap()
                    .replace("\r\n", "\n")
                    .into();
            }
            assert!(
                bytes == file.contents,
                "{}: run cargo run -p airlight-shaders --example translate",
                path.display()
            );
        }
    }
}

/// The rules of Vulkan are stricter than those of SPIR-V: no `Linkage`, and an offset for each member of a buffer.
#[test]
fn vulkan_accepts_the_modules() {
    let modules = spirv_modules(Part::ALL).unwrap();
    assert_eq!(modules.len(), Part::ALL.len() + Pass::ALL.len());
    for module in modules {
        let file = std::env::temp_dir().join(format!(
            "airlight-module-{}-{}.spv",
            std::process::id(),
            module.name
        ));
        std::fs::write(&file, module.bytes()).unwrap();
        assert_valid(&file, &["--target-env", "vulkan1.0"]);
    }
}

#[test]
fn functions_alone_are_refused_in_spirv() {
    let error = translate(&[Part::Fog], Language::Spirv).unwrap_err();
    assert!(error.to_string().contains("spirv_modules"), "{error}");
}

#[test]
fn each_part_has_its_module_and_its_passes() {
    let names = |parts: &[Part]| -> Vec<&str> {
        let modules = spirv_modules(parts).unwrap();
        modules.iter().map(|module| module.name).collect()
    };
    assert_eq!(names(&[Part::Phase]), ["phase"]);
    assert_eq!(
        names(&[Part::Fog, Part::Dither]),
        ["fog", "fog-pass", "dither"]
    );
}

/// The interface as a program needs it: every entry point, descriptor and offset.
#[test]
fn interfaces_name_what_a_program_binds() {
    let modules = spirv_modules(&[Part::Fog]).unwrap();
    assert_eq!(spirv_modules(&[Part::Fog, Part::Fog]).unwrap(), modules);
    let [functions, pass] = [&modules[0], &modules[1]].map(|module| module.interface.as_str());
    for line in [
        "exponential_fog (compute, 64 x 1 x 1) 18 -> 6: fn exponential_fog(",
        "set 0, binding 1: storage buffer, read and written: results: array<f32>",
        "FogMedium { extinction_per_m: vec3<f32>, scattering_per_m: vec3<f32> }",
        "PathOptics { transmittance: vec3<f32>, path_radiance: vec3<f32> }",
    ] {
        assert!(functions.contains(line), "{line} in\n{functions}");
    }
    for line in [
        "add_fog (fragment) takes built-in Position, location 0: clip: vec2<f32>",
        "set 0, binding 0: uniform buffer: fog: FogPass",
        "    156  mean_cosine: f32",
        "set 0, binding 2: sampled image, 2D, depth: depths",
    ] {
        assert!(pass.contains(line), "{line} in\n{pass}");
    }
}

#[test]
fn translations_define_every_function_once_under_its_name() {
    for language in with_functions() {
        for &part in Part::ALL {
            let text = translate(&[part], language).unwrap();
            for function in functions(part) {
                let defined = text.lines().filter(|line| {
                    line.contains(&format!(" {}(", function.name))
                        && !line.starts_with([' ', '/'])
                        && !line.ends_with(';')
                });
                assert_eq!(defined.count(), 1, "{language}: {}", function.name);
            }
            assert!(!text.contains("keeps_all_functions"), "{language}");
            assert!(!text.contains("void main("), "{language}");
        }
    }
}

/// Since HLSL 2021, the default of its compiler, a condition of `?:` is a scalar.
#[test]
fn hlsl_selects_vectors_by_components() {
    let text = translate(Part::ALL, Language::Hlsl).unwrap();
    assert!(text.contains("select_each((v <= (0.0031308).xxx), (12.92 * v), curved)"));
    let vectors = text.lines().filter_map(|line| {
        let (before, after) = line.trim().split_once("bool3 ")?;
        before
            .is_empty()
            .then(|| after.split([' ', '=', ';']).next())?
    });
    let mut vectors: Vec<&str> = vectors.collect();
    vectors.push(").xxx)");
    for line in text.lines().filter(|line| line.contains(" ? ")) {
        for condition in line.split(" ? ").map(str::trim_end) {
            let is_vector = vectors.iter().any(|vector| condition.ends_with(vector));
            assert!(!is_vector, "{line}");
        }
    }
}

/// The passes in HLSL and GLSL with the translated functions, as hosts compile them.
#[test]
fn glslang_accepts_the_passes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (language, file, options) in [
        (
            Language::Hlsl,
            "fog_pass.hlsl",
            &["-D", "-e", "add_fog"][..],
        ),
        (Language::Glsl450, "fog_pass.frag", &[]),
    ] {
        let binary = std::env::temp_dir().join(format!(
            "airlight-pass-{}-{}.spv",
            std::process::id(),
            language.name()
        ));
        let included = folder.join("generated").join(language.name());
        let output = Command::new("glslangValidator")
            .args(["-V", "-S", "frag"])
            .args(options)
            .arg(format!("-I{}", included.display()))
            .arg(folder.join("examples/passes").join(file))
            .arg("-o")
            .arg(&binary)
            .output();
        let Ok(output) = output else {
            println!("glslangValidator is not installed: skipped");
            return;
        };
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stdout)
        );
        assert_valid(&binary, &[]);
    }
}

/// Asks spirv-val (Debian: spirv-tools), where it is installed, for its opinion of a file, and removes that.
fn assert_valid(binary: &Path, options: &[&str]) {
    let output = Command::new("spirv-val").args(options).arg(binary).output();
    match output {
        Ok(output) => assert!(
            output.status.success(),
            "{}: {}",
            binary.display(),
            String::from_utf8_lossy(&output.stderr)
        ),
        Err(_) => println!("spirv-val is not installed: SPIR-V is not checked"),
    }
    std::fs::remove_file(binary).unwrap();
}

/// GLSL and HLSL in a fragment shader of a host, by glslangValidator (Debian: glslang-tools), and the SPIR-V that it makes of HLSL.
#[test]
fn glslang_accepts_the_translations() {
    if Command::new("glslangValidator")
        .arg("--version")
        .output()
        .is_err()
    {
        println!("glslangValidator is not installed: skipped");
        return;
    }
    for (language, head) in [
        (Language::GlslEs300, "#version 300 es\n"),
        (Language::Glsl450, "#version 450\n"),
        // There is no other parser of Godot's language than Godot.
        (
            Language::Godot,
            "#version 300 es\nprecision highp float;\nprecision highp int;\n",
        ),
        (Language::Hlsl, ""),
    ] {
        let main = match language {
            Language::Glsl450 => {
                "layout(location = 0) out vec4 colour; void main() { colour = vec4(mean_transmittance(0.5)); }"
            }
            Language::Hlsl => "float4 main() : SV_Target { return mean_transmittance(0.5); }",
            _ => "out vec4 colour; void main() { colour = vec4(mean_transmittance(0.5)); }",
        };
        let text = head.to_owned() + &translate(Part::ALL, language).unwrap() + main + "\n";
        let file = std::env::temp_dir().join(format!(
            "airlight-{}-{}.frag",
            std::process::id(),
            language.name()
        ));
        std::fs::write(&file, text).unwrap();
        let binary = file.with_extension("spv");
        let mut compile = Command::new("glslangValidator");
        if language == Language::Hlsl {
            compile.args(["-D", "-V", "-e", "main", "-o"]).arg(&binary);
        }
        let output = compile.arg(&file).output().unwrap();
        std::fs::remove_file(&file).unwrap();
        assert!(
            output.status.success(),
            "{language}: {}",
            String::from_utf8_lossy(&output.stdout)
        );
        if language == Language::Hlsl {
            assert_valid(&binary, &[]);
        }
    }
}
