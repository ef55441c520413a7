//! The layers of an EXR: red, green and blue, whose names differ in the last letter alone.

use std::collections::HashMap;
use std::fmt::Write as _;

use ::exr::meta::attribute::Text;
use ::exr::meta::header::Header;

use super::Problem;

/// Red, green and blue in one part of a file, and their opacity where there is one.
pub(super) struct Layer {
    /// The place of the part among all parts.
    pub(super) part: usize,
    /// What its channels' names begin with, else its part's name; empty where it has neither.
    pub(super) name: String,
    part_name: String,
    /// Its channels have only letters for names.
    plain: bool,
    /// The places of red, green and blue among the part's channels.
    colors: [usize; 3],
    alpha: Option<usize>,
}

/// What a channel is to a layer.
pub(super) enum Role {
    /// Its 0th, 1st or 2nd colour.
    Color(usize),
    Alpha,
}

impl Layer {
    /// What the part's channel at `place` is to this layer.
    pub(super) fn role(&self, place: usize) -> Option<Role> {
        if self.alpha == Some(place) {
            return Some(Role::Alpha);
        }
        let color = self.colors.iter().position(|&own| own == place)?;
        Some(Role::Color(color))
    }
}

/// The letters of red, green, blue and opacity.
const LETTERS: [[char; 4]; 2] = [['R', 'G', 'B', 'A'], ['r', 'g', 'b', 'a']];

/// The layer to read, and the names of the others: that of the name `wanted`, else the first one
/// without a name, else the first. A file whose only layer has no name leaves no choice.
pub(super) fn choose(
    parts: &[Header],
    wanted: Option<&str>,
) -> Result<(Layer, Vec<String>), Problem> {
    let mut layers: Vec<Layer> = Vec::new();
    for (part, header) in parts.iter().enumerate().filter(|(_, header)| !header.deep) {
        add_layers(part, header, &mut layers);
    }
    let names = || layers.iter().map(|layer| layer.name.clone());
    let place = match wanted {
        Some(wanted) => {
            let named = |layer: &Layer| layer.name == wanted || layer.part_name == wanted;
            let is_only = |layer: &Layer| layers.len() == 1 && layer.name.is_empty();
            let found = layers
                .iter()
                .position(|layer| named(layer) || is_only(layer));
            if found.is_none() && !layers.is_empty() {
                return Err(Problem::NoLayer(wanted.to_owned(), listed(names())));
            }
            found
        }
        None => {
            let plain = layers.iter().position(|layer| layer.plain);
            plain.or((!layers.is_empty()).then_some(0))
        }
    };
    let Some(place) = place else {
        let channels = parts.iter().flat_map(|part| &part.channels.list);
        let channels = channels.map(|channel| printable(&channel.name));
        return Err(Problem::NoColor(listed(channels)));
    };
    let layer = layers.remove(place);
    let others = layers.into_iter().map(|layer| layer.name).collect();
    Ok((layer, others))
}

fn add_layers(part: usize, header: &Header, layers: &mut Vec<Layer>) {
    let list = header.channels.list.iter();
    let names: Vec<String> = list.map(|channel| printable(&channel.name)).collect();
    let places: HashMap<&str, usize> = names.iter().map(String::as_str).zip(0..).collect();
    let part_name = header.own_attributes.layer_name.as_ref();
    let part_name = part_name.map(printable).unwrap_or_default();
    for name in &names {
        for [red, green, blue, alpha] in LETTERS {
            let Some(prefix) = name.strip_suffix(red) else {
                continue;
            };
            let place = |letter| places.get(format!("{prefix}{letter}").as_str()).copied();
            let (Some(red), Some(green), Some(blue)) = (place(red), place(green), place(blue))
            else {
                continue;
            };
            if !prefix.is_empty() && !prefix.ends_with('.') {
                continue;
            }
            let own_name = prefix.strip_suffix('.').unwrap_or_default();
            layers.push(Layer {
                part,
                name: if own_name.is_empty() {
                    &part_name
                } else {
                    own_name
                }
                .to_owned(),
                part_name: part_name.clone(),
                plain: own_name.is_empty(),
                colors: [red, green, blue],
                alpha: place(alpha),
            });
        }
    }
}

/// The name, with what would not fit on a line escaped.
fn printable(name: &Text) -> String {
    let mut printable = String::new();
    for character in name.chars() {
        match character.is_control() {
            true => printable.extend(character.escape_default()),
            false => printable.push(character),
        }
    }
    printable
}

/// The most names in a message.
const LISTED: usize = 16;

/// The names with commas between them, and how many more there are.
fn listed(names: impl Iterator<Item = String>) -> String {
    let mut text = String::new();
    let mut more = 0;
    for (i, name) in names.enumerate() {
        let name = if name.is_empty() { "(nameless)" } else { &name };
        match i {
            0 => text.push_str(name),
            1..LISTED => {
                text.push_str(", ");
                text.push_str(name);
            }
            _ => more += 1,
        }
    }
    if more > 0 {
        // Writing to a string cannot fail.
        let _ = write!(text, " and {more} more");
    }
    text
}
