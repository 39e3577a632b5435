//! [`Language`]: the languages that the library is written in.

use airlight::named;

/// A shading language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Language {
    /// WGSL, the source itself.
    Wgsl,
    /// GLSL ES 3.00: WebGL 2.
    GlslEs300,
    /// GLSL 4.50.
    Glsl450,
    /// Godot 4's shading language, which is close to GLSL ES 3.00.
    Godot,
    /// HLSL, shader model 5.1.
    Hlsl,
    /// Metal shading language 2.0.
    Msl,
    /// SPIR-V 1.0 for Vulkan, which is binary: see [`spirv_modules`](crate::spirv_modules).
    Spirv,
}

named! { Language, "a shading language", [
    ("wgsl", (Wgsl), "WGSL, the source itself"),
    ("glsl-es300", (GlslEs300), "GLSL ES 3.00, for WebGL 2"),
    ("glsl450", (Glsl450), "GLSL 4.50"),
    ("godot", (Godot), "Godot 4's shading language"),
    ("hlsl", (Hlsl), "HLSL, shader model 5.1"),
    ("msl", (Msl), "Metal shading language 2.0"),
    ("spirv", (Spirv), "SPIR-V 1.0 for Vulkan: modules with entry points"),
] }

impl Language {
    /// Usual ending of files in this language.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::GlslEs300 | Self::Glsl450 => "glsl",
            Self::Godot => "gdshaderinc",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
            Self::Spirv => "spv",
        }
    }

    /// Whether functions without entry points can be written in it, as [`translate`](crate::translate) does: not in SPIR-V.
    pub fn has_functions(self) -> bool {
        self != Self::Spirv
    }
}

/// Error of a translation: what the translator reports.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected functions that {language} can express, got: {message}")]
pub struct TranslateError {
    /// The language.
    pub language: Language,
    /// The translator's report.
    pub message: String,
}
