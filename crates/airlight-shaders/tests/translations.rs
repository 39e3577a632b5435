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

/// The GLSL in a fragment shader of a host, by glslangValidator (Debian: glslang-tools).
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
    ] {
        let out = match language {
            Language::Glsl450 => "layout(location = 0) out vec4 colour;",
            _ => "out vec4 colour;",
        };
        let text = head.to_owned()
            + &translate(Part::ALL, language).unwrap()
            + out
            + "void main() { colour = vec4(mean_transmittance(0.5)); }\n";
        let file = std::env::temp_dir().join(format!(
            "airlight-{}-{}.frag",
            std::process::id(),
            language.name()
        ));
        std::fs::write(&file, text).unwrap();
        let output = Command::new("glslangValidator")
            .arg(&file)
            .output()
            .unwrap();
        std::fs::remove_file(&file).unwrap();
        assert!(
            output.status.success(),
            "{language}: {}",
            String::from_utf8_lossy(&output.stdout)
        );
    }
}
