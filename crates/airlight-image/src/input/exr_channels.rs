//! Selection of the channels of an EXR file by name.

use super::source::DecodeError;
use ::exr::meta::{attribute::Text, header::Header};

/// Largest number of channels that an error lists.
const MAX_LISTED: usize = 60;

/// A layer of an EXR file, from which colours were read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExrLayer {
    /// What precedes R, G, B in the names of its channels, such as `ViewLayer.Combined.`; empty for plain colours.
    pub prefix: String,
    /// View of a stereo file, such as `left`.
    pub view: Option<String>,
}

/// Channels of a picture in one part of a file.
#[derive(Debug, PartialEq)]
pub(super) struct ColourChannels {
    pub(super) part: usize,
    pub(super) layer: ExrLayer,
    /// Red, green, blue; three equal indices for grey; luminance and chroma RY, BY.
    pub(super) rgb: [usize; 3],
    /// The colours are luminance and chroma.
    pub(super) is_luma_chroma: bool,
    pub(super) alpha: Option<usize>,
}

/// Names of one part's channels.
struct Part {
    name: Option<String>,
    /// The view of the whole part.
    view: Option<String>,
    /// All views of a part with channels of several, the one without a name first.
    views: Vec<String>,
    channels: Vec<String>,
}

impl Part {
    /// View of a channel: that of the part, else the last but one word of its name, else the first view.
    fn view_of(&self, channel: &str) -> Option<&str> {
        if self.view.is_some() {
            return self.view.as_deref();
        }
        let word = channel.rsplit('.').nth(1);
        let named = self.views.iter().find(|view| Some(view.as_str()) == word);
        named.or(self.views.first()).map(String::as_str)
    }
}

fn parts(headers: &[Header]) -> Vec<Part> {
    let text = |text: &Option<Text>| {
        let text = text.as_ref().map(ToString::to_string);
        text.filter(|text| !text.is_empty())
    };
    headers
        .iter()
        .map(|header| {
            let own = &header.own_attributes;
            let views = own.multi_view_names.iter().flatten();
            Part {
                name: text(&own.layer_name),
                view: text(&own.view_name),
                views: match headers.len() {
                    1 => views.map(ToString::to_string).collect(),
                    _ => Vec::new(),
                },
                channels: header
                    .channels
                    .list
                    .iter()
                    .map(|channel| channel.name.to_string())
                    .collect(),
            }
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
    let layers: Vec<ColourChannels> = numbered()
        .flat_map(|(number, part)| {
            part.channels.iter().filter_map(move |channel| {
                let prefix = channel.strip_suffix('R')?;
                prefix
                    .ends_with('.')
                    .then(|| with_prefix(number, part, prefix))?
            })
        })
        .collect();
    // The complete picture among the passes of Blender.
    let is_combined = |layer: &&ColourChannels| {
        let mut words = layer.layer.prefix.split('.');
        words.any(|word| word.eq_ignore_ascii_case("combined"))
    };
    let first_view = |layers: &[&ColourChannels]| {
        let first = layers.first()?;
        let rest = &layers[1..];
        let is_other_view = |other: &&&ColourChannels| {
            first.layer.view.is_some() && other.layer.view != first.layer.view
        };
        (rest.iter().filter(is_other_view).count() == rest.len()).then_some(first.layer.clone())
    };
    let combined: Vec<&ColourChannels> = layers.iter().filter(is_combined).collect();
    let chosen = first_view(&combined).or_else(|| first_view(&layers.iter().collect::<Vec<_>>()));
    match layers
        .into_iter()
        .find(|found| Some(&found.layer) == chosen.as_ref())
    {
        Some(found) => Ok(found),
        None if numbered().any(|(number, part)| has_layer(number, part)) => Err(missing(
            parts,
            "channels R, G, B outside layers, and several layers with them; try colour-layer with the name of one",
        )),
        None => Err(missing(parts, "channels R, G, B or Y")),
    }
}

/// Whether a part has a layer with colours.
fn has_layer(number: usize, part: &Part) -> bool {
    part.channels.iter().any(|channel| {
        let prefix = channel.strip_suffix('R').filter(|p| p.ends_with('.'));
        prefix.is_some_and(|prefix| with_prefix(number, part, prefix).is_some())
    })
}

fn with_prefix(number: usize, part: &Part, prefix: &str) -> Option<ColourChannels> {
    let find = |name: &str| {
        part.channels.iter().position(|channel| {
            channel
                .strip_prefix(prefix)
                .is_some_and(|rest| rest.eq_ignore_ascii_case(name))
        })
    };
    let (rgb, is_luma_chroma) = match (find("R"), find("G"), find("B")) {
        (Some(r), Some(g), Some(b)) => ([r, g, b], false),
        _ => {
            // With an X beside it, Y belongs to a position or normal.
            let y = find("Y").filter(|_| find("X").is_none())?;
            match (find("RY"), find("BY")) {
                (Some(ry), Some(by)) => ([y, ry, by], true),
                _ => ([y; 3], false),
            }
        }
    };
    Some(ColourChannels {
        part: number,
        layer: ExrLayer {
            prefix: prefix.to_owned(),
            view: part.view_of(&part.channels[rgb[0]]).map(str::to_owned),
        },
        rgb,
        is_luma_chroma,
        alpha: find("A"),
    })
}

/// Names of depth channels, the likeliest first. Names of several words match by the last ones.
const DEPTH_NAMES: [&str; 6] = ["Z", "depth.Z", "depth.V", "depth.Y", "depth.R", "depth"];

/// Part and index of the channel with a name, or of the depth channel by the rules of
/// [`super::depth::DepthOptions::channel`]; of the view and layer of the colours `beside` which it lies, if they are known.
pub(super) fn depth(
    headers: &[Header],
    wanted: Option<&str>,
    beside: Option<&ExrLayer>,
) -> Result<(usize, usize), DecodeError> {
    let parts = parts(headers);
    let named = |number: usize, channel: &str| match &parts[number].name {
        Some(name) => format!("{name}.{channel}"),
        None => channel.to_owned(),
    };
    let all = || {
        parts.iter().enumerate().flat_map(|(number, part)| {
            let numbered = part.channels.iter().enumerate();
            numbered.map(move |(c, channel)| ((number, c), channel.as_str()))
        })
    };
    if let Some(wanted) = wanted {
        return all()
            .find(|&(_, channel)| channel == wanted)
            .or_else(|| all().find(|&((number, _), channel)| named(number, channel) == wanted))
            .map(|(at, _)| at)
            .ok_or_else(|| missing(&parts, format!("channel `{wanted}`")));
    }
    let has = |number: usize, name: &str| {
        parts[number]
            .channels
            .iter()
            .any(|channel| channel.eq_ignore_ascii_case(name))
    };
    // Channels called depth, the likeliest first: by their whole name, then by its end.
    let plain = DEPTH_NAMES.iter().map(|known| {
        let is_plain = |&&((number, _), channel): &&((usize, usize), &str)| {
            // With an X beside it, Z belongs to a position or normal.
            let vector = *known == "Z" && has(number, "X");
            channel.eq_ignore_ascii_case(known) && !vector
        };
        all().filter(|found| is_plain(&found)).collect::<Vec<_>>()
    });
    let views: Vec<&String> = parts.iter().flat_map(|part| &part.views).collect();
    let ending = DEPTH_NAMES.iter().map(|known| {
        let ends = |&&((number, _), channel): &&((usize, usize), &str)| {
            // Without the view: `Depth.left.Z` is depth, and so is the `right.Z` beside `right.R`.
            let words = channel.split('.');
            let words: Vec<&str> = words
                .filter(|word| !views.iter().any(|view| view == word))
                .collect();
            let short = words.join(".");
            let of_view = words.len() < channel.split('.').count();
            let full = format!(".{}", named(number, &short)).to_ascii_lowercase();
            (*known != "Z" && full.ends_with(&format!(".{}", known.to_ascii_lowercase())))
                || (*known == "Z" && of_view && short.eq_ignore_ascii_case(known))
        };
        all().filter(|found| ends(&found)).collect::<Vec<_>>()
    });
    let has_views = parts
        .iter()
        .any(|part| part.view.is_some() || !part.views.is_empty());
    for found in plain.chain(ending) {
        let view_of = |&((number, _), channel): &((usize, usize), &str)| {
            parts[number].view_of(channel).map(str::to_owned)
        };
        let mut found = found;
        if has_views && found.is_empty() {
            continue;
        }
        if let Some(view) = beside.and_then(|layer| layer.view.as_ref()) {
            let before = found.len();
            found.retain(|at| view_of(at).is_none_or(|of| of == *view));
            if found.is_empty() && before > 0 {
                continue;
            }
        } else if found.iter().any(|at| view_of(at) != view_of(&found[0])) {
            return Err(missing(
                &parts,
                "view to which its depth belongs, and depth of several views; try depth-channel with a name",
            ));
        }
        // Of several, that of the layer of the colours.
        let shared = |&(_, channel): &((usize, usize), &str)| {
            let prefix = beside.map_or("", |layer| layer.prefix.as_str());
            let pairs = prefix.split('.').zip(channel.split('.'));
            pairs.take_while(|(a, b)| a == b).count()
        };
        let most = found.iter().map(shared).max().unwrap_or(0);
        found.retain(|at| shared(at) == most);
        let is_plain = found.first().is_some_and(|(_, channel)| {
            DEPTH_NAMES.iter().any(|k| channel.eq_ignore_ascii_case(k))
        });
        match found[..] {
            [] => {}
            [(at, _)] => return Ok(at),
            [(at, _), ..] if is_plain => return Ok(at),
            _ => break,
        }
    }
    if let Some(view) = beside.and_then(|layer| layer.view.as_ref())
        && has_views
    {
        return Err(missing(
            &parts,
            format!("depth of the view `{view}`, which the colours have"),
        ));
    }
    // A luminance or a red channel without the others of a colour.
    for (known, others) in [("Y", ["X", "Z", "RY"]), ("R", ["G", "B", "A"])] {
        let alone = |number| !others.iter().any(|other| has(number, other));
        let is_it = |&((number, _), channel): &((usize, usize), &str)| {
            channel.eq_ignore_ascii_case(known) && alone(number)
        };
        if let Some((at, _)) = all().find(is_it) {
            return Ok(at);
        }
    }
    match (all().next(), all().nth(1)) {
        (Some((at, _)), None) => Ok(at),
        _ => Err(missing(
            &parts,
            "channel that is clearly depth (such as Z or depth.Z); try depth-channel with a name",
        )),
    }
}
