//! Error type.

/// Why a chart or a picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The data span no range on an axis.
    #[error("expected {expected}, got {got}; try more points, or a range for the axis")]
    NoRange {
        /// What the chart needs.
        expected: &'static str,
        /// What the data are.
        got: String,
    },
    /// The drawing library failed.
    #[error("cannot draw the chart: {0}")]
    Draw(String),
    /// A text is not SVG.
    #[error("expected an SVG document: {0}")]
    Svg(String),
    /// A picture has no pixels, or more than memory can hold.
    #[error(
        "expected a picture of at least one pixel that fits in memory, got {width} x {height} pixels"
    )]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The PNG encoder failed.
    #[error("cannot encode the picture as PNG: {0}")]
    Png(String),
}
