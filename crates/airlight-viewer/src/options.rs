//! [`Options`].

use crate::state::State;

/// What the viewer starts with.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The scene and how it is looked at.
    pub state: State,
    /// Width and height of the window, in points.
    pub size: [f32; 2],
    /// Whether the controls are shown beside the picture.
    pub panel: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            state: State::default(),
            size: [1280.0, 800.0],
            panel: true,
        }
    }
}
