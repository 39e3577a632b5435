//! Colours, type and spacing.

use eframe::egui::{
    self, Color32, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Margin, Stroke,
    TextStyle, vec2,
};
use std::sync::Arc;

/// Width of the panel, points.
pub const PANEL_WIDTH: f32 = 316.0;
/// Colour of what is active.
pub const ACCENT: Color32 = Color32::from_rgb(232, 168, 96);
/// Colour of text that is less important.
pub const QUIET: Color32 = Color32::from_gray(150);
const TEXT: Color32 = Color32::from_gray(214);
const PANEL: Color32 = Color32::from_rgb(20, 22, 25);
const WIDGET: Color32 = Color32::from_rgb(42, 46, 52);
const WIDGET_HOVERED: Color32 = Color32::from_rgb(58, 63, 71);

/// Ubuntu Light, on a page with Latin letters alone, which are a third of its size (scripts/page_font.py).
#[cfg(not(target_arch = "wasm32"))]
const TYPEFACE: &[u8] = epaint_default_fonts::UBUNTU_LIGHT;
#[cfg(target_arch = "wasm32")]
const TYPEFACE: &[u8] = PAGE_TYPEFACE;
#[cfg(any(test, target_arch = "wasm32"))]
const PAGE_TYPEFACE: &[u8] = include_bytes!("../font/UbuntuLight-page.ttf");

/// A typeface for all text.
fn fonts(typeface: &'static [u8]) -> FontDefinitions {
    const NAME: &str = "Ubuntu-Light";
    let mut fonts = FontDefinitions::empty();
    let data = FontData::from_static(typeface);
    fonts.font_data.insert(NAME.to_owned(), Arc::new(data));
    for names in fonts.families.values_mut() {
        names.push(NAME.to_owned());
    }
    fonts
}

/// Sets the look of all widgets: dark, so that the picture is judged beside dim surroundings.
pub fn apply(context: &egui::Context) {
    context.set_fonts(fonts(TYPEFACE));
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Heading, 17.0, FontFamily::Proportional),
            (TextStyle::Body, 13.0, FontFamily::Proportional),
            (TextStyle::Button, 13.0, FontFamily::Proportional),
            (TextStyle::Small, 11.0, FontFamily::Proportional),
            (TextStyle::Monospace, 12.0, FontFamily::Monospace),
        ]
        .into_iter()
        .map(|(style, size, family)| (style, FontId::new(size, family)))
        .collect();
        style.spacing.item_spacing = vec2(6.0, 5.0);
        style.spacing.interact_size.y = 20.0;
        style.spacing.button_padding = vec2(7.0, 2.0);
        style.spacing.slider_rail_height = 4.0;
        let visuals = &mut style.visuals;
        visuals.panel_fill = PANEL;
        visuals.window_fill = PANEL;
        visuals.extreme_bg_color = Color32::from_rgb(12, 13, 15);
        visuals.override_text_color = Some(TEXT);
        visuals.selection.bg_fill = ACCENT.gamma_multiply(0.75);
        visuals.selection.stroke = Stroke::new(1.5, ACCENT);
        visuals.hyperlink_color = ACCENT;
        visuals.slider_trailing_fill = true;
        visuals.window_corner_radius = CornerRadius::same(6);
        let widgets = &mut visuals.widgets;
        for (widget, fill) in [
            (&mut widgets.inactive, WIDGET),
            (&mut widgets.hovered, WIDGET_HOVERED),
            (&mut widgets.active, WIDGET_HOVERED),
            (&mut widgets.open, WIDGET),
        ] {
            widget.bg_fill = fill;
            widget.weak_bg_fill = fill;
            widget.bg_stroke = Stroke::NONE;
            widget.corner_radius = CornerRadius::same(4);
        }
        // A ring shows where the keyboard is.
        widgets.active.bg_stroke = Stroke::new(1.5, ACCENT);
    });
}

/// Frame of the panel.
pub fn panel_frame() -> egui::Frame {
    egui::Frame::new()
        .fill(PANEL)
        .inner_margin(Margin::symmetric(14, 10))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place;

    /// The typeface of the page has what the viewer writes, and its letters are as wide as those of the desktop.
    #[test]
    fn the_page_writes_as_the_desktop_does() {
        let [page, desktop] = [PAGE_TYPEFACE, TYPEFACE].map(|typeface| {
            let context = egui::Context::default();
            context.set_fonts(fonts(typeface));
            let mut first = context.run_ui(Default::default(), |_| {});
            first.textures_delta.clear();
            context
        });
        let names = place::city_names().collect::<String>();
        let signs = "0123456789.,-+−±×°′″²³µαβλμτ…–—·•→←≈≤≥ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz()[]/%&'\"";
        for size in [11.0, 13.0, 17.0] {
            let font = FontId::proportional(size);
            for c in names.chars().chain(signs.chars()) {
                let width = |context: &egui::Context| {
                    context.fonts_mut(|fonts| {
                        let has_glyph = fonts.has_glyph(&font, c);
                        has_glyph.then(|| fonts.glyph_width(&font, c))
                    })
                };
                let [on_page, on_desktop] = [&page, &desktop].map(width);
                assert_eq!(on_page, on_desktop, "{c:?}");
                assert!(on_page.is_some() || !c.is_alphanumeric(), "{c:?}");
            }
        }
    }
}
