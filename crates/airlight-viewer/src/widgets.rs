//! Controls with a name, a unit and a reset.

use eframe::egui::{self, Response, RichText, Role, Slider, SliderClamping, Ui, WidgetInfo};
use std::ops::RangeInclusive;

/// Width of the names of controls, points.
const NAME_WIDTH: f32 = 92.0;
/// Width of sliders, points.
const SLIDER_WIDTH: f32 = 112.0;

/// What a control of a number looks like.
#[derive(Clone, Debug)]
pub struct Number {
    /// Name, which is also that for screen readers.
    pub name: &'static str,
    /// Unit with a space before it, or none.
    pub unit: &'static str,
    /// Values that the slider reaches; the number can be typed, too.
    pub range: RangeInclusive<f64>,
    /// Whether equal steps of the slider are equal factors.
    pub logarithmic: bool,
    /// Decimals that are shown at most.
    pub decimals: usize,
    /// Whether small numbers are shown as parts of 1.
    pub fractions: bool,
    /// What it means, shown beside the pointer.
    pub help: &'static str,
}

impl Number {
    /// A slider over a range.
    pub fn new(name: &'static str, unit: &'static str, range: RangeInclusive<f64>) -> Self {
        Self {
            name,
            unit,
            range,
            logarithmic: false,
            decimals: 1,
            fractions: false,
            help: "",
        }
    }

    /// The same with equal factors for equal steps.
    pub fn logarithmic(self) -> Self {
        Self {
            logarithmic: true,
            ..self
        }
    }

    /// The same with a number of decimals.
    pub fn decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    /// The same with numbers below a third as parts of 1, such as 1/125.
    pub fn fractions(self) -> Self {
        Self {
            fractions: true,
            ..self
        }
    }

    /// The same with an explanation.
    pub fn help(self, help: &'static str) -> Self {
        Self { help, ..self }
    }

    /// Shows a number that may not be set, with the value that then holds. True if it has been changed; a click on the name with the
    /// secondary button, or Delete while the slider has the focus, unsets it.
    pub fn show_optional(&self, ui: &mut Ui, value: &mut Option<f64>, unset: f64) -> bool {
        let mut number = value.unwrap_or(unset);
        let is_set = value.is_some();
        let (changed, reset) = self.row(ui, &mut number, is_set);
        if reset && is_set {
            *value = None;
            return true;
        }
        if changed {
            *value = Some(number);
        }
        changed
    }

    /// Shows a number. True if it has been changed.
    pub fn show(&self, ui: &mut Ui, value: &mut f64) -> bool {
        self.row(ui, value, true).0
    }

    fn row(&self, ui: &mut Ui, value: &mut f64, is_set: bool) -> (bool, bool) {
        ui.horizontal(|ui| {
            let name = name(ui, self.name, is_set);
            let slider = Slider::new(value, self.range.clone())
                .logarithmic(self.logarithmic)
                .smallest_positive(self.smallest())
                .clamping(SliderClamping::Edits)
                .suffix(self.unit)
                .max_decimals(self.decimals);
            let slider = match self.fractions {
                true => slider
                    .custom_formatter(|number, _| fraction_text(number))
                    .custom_parser(fraction),
                false => slider,
            };
            ui.spacing_mut().slider_width = SLIDER_WIDTH;
            let response = ui.add(slider).labelled_by(name.id);
            let reset = name.secondary_clicked()
                || (response.has_focus() && ui.input(|i| i.key_pressed(egui::Key::Delete)));
            let changed = response.changed();
            if !self.help.is_empty() {
                response.on_hover_text(self.help);
            }
            (changed, reset)
        })
        .inner
    }

    fn smallest(&self) -> f64 {
        match *self.range.start() > 0.0 {
            true => *self.range.start(),
            false => 1e-3 * self.range.end(),
        }
    }
}

/// A number as a part of 1, such as 1/125, unless it is large.
fn fraction_text(number: f64) -> String {
    match number < 1.0 / 3.0 {
        true => format!("1/{}", number.recip().round()),
        false => format!("{:.1}", number),
    }
}

/// A number that may be written as a fraction.
fn fraction(text: &str) -> Option<f64> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let value = match text.split_once('/') {
        Some((over, under)) => number(over)? / number(under)?,
        None => number(text)?,
    };
    value.is_finite().then_some(value)
}

/// The name of a control.
pub fn name(ui: &mut Ui, text: &str, is_set: bool) -> Response {
    let text = match is_set {
        true => RichText::new(text),
        false => RichText::new(text).color(crate::style::QUIET),
    };
    let size = egui::vec2(NAME_WIDTH, ui.spacing().interact_size.y);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(NAME_WIDTH);
        ui.add(egui::Label::new(text).sense(egui::Sense::click()))
    })
    .inner
}

/// A choice among named values. True if it has been changed.
pub fn choice<T: PartialEq + Clone>(
    ui: &mut Ui,
    label: &'static str,
    value: &mut T,
    values: &[(T, String)],
) -> bool {
    ui.horizontal(|ui| {
        let name = name(ui, label, true);
        let shown = values.iter().find(|(of, _)| of == value);
        let mut changed = false;
        let combo = egui::ComboBox::from_id_salt(label)
            .width(SLIDER_WIDTH + 60.0)
            .selected_text(shown.map_or("", |(_, text)| text.as_str()))
            .show_ui(ui, |ui| {
                for (of, text) in values {
                    changed |= ui.selectable_value(value, of.clone(), text).changed();
                }
            });
        combo.response.labelled_by(name.id);
        changed
    })
    .inner
}

/// A title of a group of controls. True if the group is to be reset.
pub fn title(ui: &mut Ui, text: &str) -> bool {
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        ui.label(
            RichText::new(text)
                .strong()
                .color(crate::style::ACCENT)
                .size(12.0),
        );
        let right = egui::Layout::right_to_left(egui::Align::Center);
        ui.with_layout(right, |ui| {
            let text = format!("Reset {}", text.to_lowercase());
            let small = RichText::new("reset").color(crate::style::QUIET).small();
            // The frame shows the keyboard where it is.
            let button = ui.add(egui::Button::new(small).frame_when_inactive(false));
            button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &text));
            button.on_hover_text(&text).clicked()
        })
        .inner
    })
    .inner
}

/// A line of less important text.
pub fn quiet(ui: &mut Ui, text: String) {
    let text = RichText::new(text).color(crate::style::QUIET).small();
    ui.add(egui::Label::new(text).wrap());
}
