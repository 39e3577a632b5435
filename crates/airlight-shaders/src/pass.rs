//! [`Pass`]: complete shaders.

use crate::part::{Part, source};
use airlight::named;

/// A complete shader over the functions of the library: a triangle that covers the frame, and what it draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Pass {
    /// Exponential height fog over a frame with its depth.
    Fog,
    /// Sky and aerial perspective from tables.
    Sky,
    /// The sky article's scene.
    SkyArticle,
}

named! { Pass, "a pass of the shader library", [
    ("fog-pass", (Fog), "adds exponential height fog, lit by the sun and the sky, to a frame with its depth"),
    ("sky-pass", (Sky), "draws sky and ground and puts the air in front of geometry, from tables"),
    ("sky-article-pass", (SkyArticle), "draws the sky article's scene: sky, sun's disc, tone curve and dither"),
] }

impl Pass {
    /// The parts that it calls; the first is its subject.
    pub const fn parts(self) -> &'static [Part] {
        match self {
            Self::Fog => &[Part::Fog, Part::Phase],
            Self::Sky => &[Part::SkyTables],
            Self::SkyArticle => &[Part::Article, Part::Tone, Part::Dither],
        }
    }

    /// Text of its file alone.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Fog => include_str!("../examples/passes/fog_pass.wgsl"),
            Self::Sky => include_str!("../examples/passes/sky_pass.wgsl"),
            Self::SkyArticle => include_str!("../examples/passes/sky_article_pass.wgsl"),
        }
    }

    /// The shader in WGSL: the parts, and its file.
    pub fn source(self) -> String {
        source(self.parts()) + "\n" + self.text()
    }
}
