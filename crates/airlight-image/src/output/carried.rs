//! What an EXR file holds besides the colours that are drawn: attributes, channels and the place of its window. A picture made from
//! the file carries it along.

use ::exr::{
    math::Vec2,
    meta::{
        attribute::{ChannelDescription, SampleType, TimeCode},
        header::{Header, LayerAttributes},
    },
};

/// Attributes and channels of an EXR file, to be written again with other colours.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    pub(super) attributes: LayerAttributes,
    time_code: Option<TimeCode>,
    pub(super) channels: Vec<CarriedChannel>,
    /// Upper left corner of the display window.
    corner: (i32, i32),
}

/// A channel in the sample format of its file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CarriedChannel {
    pub(super) description: ChannelDescription,
    /// Samples of the display window, row by row, in the byte order of this machine.
    bytes: Vec<u8>,
}

impl Carried {
    /// The attributes of a part that still hold with other colours. What describes the encoding, the original pixels (preview,
    /// projection, original window) or other parts is left out, and what [`super::Metadata`] has fields for.
    pub(crate) fn of_header(header: &Header) -> Self {
        let shared = &header.shared_attributes;
        let mut attributes = LayerAttributes {
            layer_name: None,
            layer_position: Vec2(0, 0),
            white_luminance: None,
            adopted_neutral: None,
            environment_map: None,
            deep_image_state: None,
            original_data_window: None,
            preview: None,
            ..header.own_attributes.clone()
        };
        for (name, value) in &shared.other {
            attributes.other.insert(name.clone(), value.clone());
        }
        let corner = shared.display_window.position;
        Self {
            attributes,
            time_code: shared.time_code,
            channels: Vec::new(),
            corner: (corner.x(), corner.y()),
        }
    }

    /// Adds a channel with samples of the display window in the byte order of this machine.
    pub(crate) fn add_channel(&mut self, description: &ChannelDescription, bytes: Vec<u8>) {
        self.channels.push(CarriedChannel {
            description: ChannelDescription {
                sampling: Vec2(1, 1),
                ..description.clone()
            },
            bytes,
        });
    }

    /// Names of the channels.
    pub fn channel_names(&self) -> impl Iterator<Item = String> {
        let names = self.channels.iter();
        names.map(|channel| channel.description.name.to_string())
    }

    /// The same without the channels of these names, which are written otherwise.
    pub fn without_channels(&self, names: &[&str]) -> Self {
        let mut rest = self.clone();
        rest.channels.retain(|channel| {
            let name = channel.description.name.to_string();
            !names.contains(&name.as_str())
        });
        rest
    }

    /// Sets what all parts of a file share, and the place of the window.
    pub(super) fn set_shared(&self, header: &mut Header) {
        let corner = Vec2(self.corner.0, self.corner.1);
        header.shared_attributes.time_code = self.time_code;
        header.shared_attributes.display_window.position = corner;
        header.own_attributes.layer_position = corner;
    }
}

impl CarriedChannel {
    /// The samples of row `y` of a picture `width` pixels wide.
    pub(super) fn row(&self, y: u32, width: usize) -> &[u8] {
        let length = width * self.sample_bytes();
        let start = y as usize * length;
        self.bytes.get(start..start + length).unwrap_or_default()
    }

    fn sample_bytes(&self) -> usize {
        match self.description.sample_type {
            SampleType::F16 => 2,
            SampleType::F32 | SampleType::U32 => 4,
        }
    }
}
