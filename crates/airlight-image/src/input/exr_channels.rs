//! Selection of the channels of an EXR file by name.

use super::source::DecodeError;
use ::exr::meta::header::Header;

/// Largest number of channels that an error lists.
const MAX_LISTED: usize = 60;

/// Channels of a picture in one part of a file.
#[derive(Debug, PartialEq)]
pub(super) struct ColourChannels {
    pub(super) part: usize,
    /// Red, green, blue; three equal indices for grey.
    pub(super) rgb: [usize; 3],
    pub(super) alpha: Option<usize>,
}

/// Names of one part's channels.
struct Part {
    name: Option<String>,
    channels: Vec<String>,
}

fn parts(headers: &[Header]) -> Vec<Part> {
    headers
        .iter()
        .map(|header| Part {
            name: header
                .own_attributes
                .layer_name
                .as_ref()
                .map(ToString::to_string)
                .filter(|name| !name.is_empty()),
            channels: header
                .channels
                .list
                .iter()
                .map(|channel| channel.name.to_string())
                .collect(),
        })
        .collect()
}

/// Names of all channels, with the name of the part in files with several.
fn list_channels(parts: &[Part]) -> String {
    let names: Vec<String> = parts
        .iter()
        .flat_map(|part| {
            part.channels.iter().map(|channel| match &part.name {
                Some(name) if parts.len() > 1 => format!("{name}.{channel}"),
                _ => channel.clone(),
            })
        })
        .collect();
    let more = names.len().saturating_sub(MAX_LISTED);
    let shown = names[..names.len() - more].join(", ");
    match more {
        0 => shown,
        _ => format!("{shown} and {more} more"),
    }
}

fn missing(parts: &[Part], wanted: impl Into<String>) -> DecodeError {
    DecodeError::NoChannel {
        wanted: wanted.into(),
        available: list_channels(parts),
    }
}

/// Colour channels of a layer, or of the file.
pub(super) fn colours(
    headers: &[Header],
    layer: Option<&str>,
) -> Result<ColourChannels, DecodeError> {
    let parts = parts(headers);
    let Some(layer) = layer else {
        return plain_colours(&parts);
    };
    let layer = layer.trim_end_matches('.');
    let found = parts.iter().enumerate().find_map(|(number, part)| {
        let own = format!("{layer}.");
        let within = part.name.as_deref().and_then(|name| {
            let rest = layer.strip_prefix(name)?;
            if rest.is_empty() {
                Some(String::new())
            } else {
                rest.strip_prefix('.').map(|rest| format!("{rest}."))
            }
        });
        with_prefix(number, part, &own).or_else(|| with_prefix(number, part, &within?))
    });
    found.ok_or_else(|| {
        missing(
            &parts,
            format!("layer `{layer}` with R, G, B or Y (as in `{layer}.R`)"),
        )
    })
}

fn plain_colours(parts: &[Part]) -> Result<ColourChannels, DecodeError> {
    let numbered = || parts.iter().enumerate();
    if let Some(plain) = numbered().find_map(|(number, part)| with_prefix(number, part, "")) {
        return Ok(plain);
    }
    let mut layers = numbered().flat_map(|(number, part)| {
        part.channels.iter().filter_map(move |channel| {
            let prefix = channel.strip_suffix('R')?;
            prefix
                .ends_with('.')
                .then(|| with_prefix(number, part, prefix))?
        })
    });
    match (layers.next(), layers.next()) {
        (Some(only), None) => Ok(only),
        (None, _) => Err(missing(parts, "channels R, G, B or Y")),
        (Some(_), Some(_)) => Err(missing(
            parts,
            "channels R, G, B outside layers, and several layers with them; try naming a layer",
        )),
    }
}

fn with_prefix(number: usize, part: &Part, prefix: &str) -> Option<ColourChannels> {
    let find = |name: &str| {
        part.channels.iter().position(|channel| {
            channel
                .strip_prefix(prefix)
                .is_some_and(|rest| rest.eq_ignore_ascii_case(name))
        })
    };
    let rgb = match (find("R"), find("G"), find("B")) {
        (Some(r), Some(g), Some(b)) => [r, g, b],
        _ => {
            // With an X beside it, Y belongs to a position or normal.
            let y = find("Y").filter(|_| find("X").is_none())?;
            [y; 3]
        }
    };
    Some(ColourChannels {
        part: number,
        rgb,
        alpha: find("A"),
    })
}

/// Names of depth channels, the likeliest first. Names of several words match by the last ones.
const DEPTH_NAMES: [&str; 6] = ["Z", "depth.Z", "depth.V", "depth.Y", "depth.R", "depth"];

/// Part and index of the channel with a name, or of the depth channel by the rules of
/// [`super::depth::DepthOptions::channel`].
pub(super) fn depth(
    headers: &[Header],
    wanted: Option<&str>,
) -> Result<(usize, usize), DecodeError> {
    let parts = parts(headers);
    let all = || {
        parts.iter().enumerate().flat_map(|(number, part)| {
            let name = part.name.as_deref();
            let numbered = part.channels.iter().enumerate();
            numbered.map(move |(c, channel)| ((number, c), name, channel.as_str()))
        })
    };
    if let Some(wanted) = wanted {
        let with_part = |name: Option<&str>, channel: &str| {
            name.is_some_and(|name| format!("{name}.{channel}") == wanted)
        };
        return all()
            .find(|&(_, _, channel)| channel == wanted)
            .or_else(|| all().find(|&(_, name, channel)| with_part(name, channel)))
            .map(|(at, _, _)| at)
            .ok_or_else(|| missing(&parts, format!("channel `{wanted}`")));
    }
    let has = |number: usize, name: &str| {
        parts[number]
            .channels
            .iter()
            .any(|channel| channel.eq_ignore_ascii_case(name))
    };
    for known in DEPTH_NAMES {
        let is_plain = |&((number, _), _, channel): &((usize, usize), Option<&str>, &str)| {
            // With an X beside it, Z belongs to a position or normal.
            let vector = known == "Z" && has(number, "X");
            channel.eq_ignore_ascii_case(known) && !vector
        };
        if let Some((at, _, _)) = all().find(is_plain) {
            return Ok(at);
        }
    }
    for known in &DEPTH_NAMES[1..] {
        let ends = |name: Option<&str>, channel: &str| {
            let full = match name {
                Some(name) => format!(".{name}.{channel}"),
                None => format!(".{channel}"),
            };
            full.to_ascii_lowercase()
                .ends_with(&format!(".{}", known.to_ascii_lowercase()))
        };
        let mut found = all().filter(|&(_, name, channel)| ends(name, channel));
        match (found.next(), found.next()) {
            (Some((at, _, _)), None) => return Ok(at),
            (None, _) => {}
            (Some(_), Some(_)) => break,
        }
    }
    // A luminance or a red channel without the others of a colour.
    for (known, others) in [("Y", ["X", "Z", "RY"]), ("R", ["G", "B", "A"])] {
        let alone = |number| !others.iter().any(|other| has(number, other));
        let is_it = |&((number, _), _, channel): &((usize, usize), Option<&str>, &str)| {
            channel.eq_ignore_ascii_case(known) && alone(number)
        };
        if let Some((at, _, _)) = all().find(is_it) {
            return Ok(at);
        }
    }
    match (all().next(), all().nth(1)) {
        (Some((at, _, _)), None) => Ok(at),
        _ => Err(missing(
            &parts,
            "channel that is clearly depth (such as Z or depth.Z); try naming one",
        )),
    }
}
