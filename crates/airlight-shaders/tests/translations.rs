//! Translations: complete, up to date, and accepted by an independent compiler where one is installed.

use airlight::Named;
use airlight_shaders::{Language, Part, functions, translate};
use std::path::Path;
use std::process::Command;

fn translated() -> impl Iterator<Item = Language> {
    let all = Language::ALL.iter().copied();
    all.filter(|&language| language != Language::Wgsl)
}

#[test]
fn generated_files_are_up_to_date() {
    for language in translated() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("generated")
            .join(language.name())
            .join(format!("airlight.{}", language.extension()));
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(
            text.replace("\r\n", "\n") == translate(Part::ALL, language).unwrap(),
            "{}: run cargo run -p airlight-shaders --example translate",
            file.display()
        );
    }
}

#[test]
fn translations_define_every_function_once_under_its_name() {
    for language in translated() {
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
        assert_valid(&binary);
    }
}

/// Asks spirv-val (Debian: spirv-tools), where it is installed, for its opinion of a file, and removes that.
fn assert_valid(binary: &Path) {
    match Command::new("spirv-val").arg(binary).output() {
        Ok(output) => assert!(
            output.status.success(),
            "{}",
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
            assert_valid(&binary);
        }
    }
}
