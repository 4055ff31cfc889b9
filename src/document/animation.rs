//! Reading of `animation`: options of the film of a file.

use super::Written;
use super::node::Node;
use super::reader::Reader;
use super::shape::{Form, Shape, keys};

/// An option of a film as written, by its name on the command line.
#[derive(Clone, Debug)]
pub struct FilmOption {
    /// Name: `set` for each parameter.
    pub name: &'static str,
    /// Value, as on the command line; `NAME=VALUE` for `set`, and empty for a flag.
    pub value: Written<String>,
}

pub(super) const ANIMATION: Shape = Shape {
    what: "an animation",
    keys: &[
        &keys![
            set: Form::Names(&Form::Text, 0),
                "Values of parameters in the course of the film: angle: 10..80, or a list such as 10,80,40.";
            steps: Form::Text, "Numbers of steps, between which it grows: 0..6.";
            seed: Form::Text, "Seeds of random draws: 1..24.";
            zoom: Form::Text, "Magnifications: 1..1e100, or loop for a period of the address `at`.";
            at: Form::Text, "Point or address that is magnified.";
            turn: Form::Text, "Degrees by which a set of the plane is turned: 0..360.";
            from: Form::Text, "Azimuth and elevation from which a set in space is seen: 0..360,25.";
            to: Form::Text, "Rule to which the film leads.";
            by: Form::Words(&["polar", "matrix"]), "Course of the way to the other rule.";
            draw: Form::Flag(false), "Whether the picture is drawn line by line.";
            cuts: Form::Flag(false), "Whether steps change at once.";
        ],
        &keys![
            frames: Form::Whole(1, Some(100_000)), "Number of frames in which something changes.";
            fps: Form::Text, "Frames a second; 30 if left out.";
            loop: Form::Flag(false), "Whether the first frame follows the last one.";
            bounce: Form::Flag(false), "Whether the second half of the film goes back.";
            hold: Form::Whole(0, Some(10_000)),
                "Number of further frames for which the first and the last one are kept, each.";
            ease: Form::Words(&["linear", "in", "out", "in-out", "sine"]), "Course of time between key frames.";
            smooth: Form::Flag(false), "Whether the key frames of a list lie on a smooth curve.";
            once: Form::Flag(false), "Whether the film is shown once, not without end.";
            fit: Form::Words(&["all", "each"]), "What is shown: what all frames need, or each frame its own.";
            detail: Form::Text, "Size in pixels below which elements are not replaced.";
        ],
    ],
    alternatives: &[],
    hint: "animation: {set: {angle: 10..80}, frames: 120, bounce: true}",
};

/// Reads the options of a film. Their values are checked where the film is made.
pub(super) fn read_animation(reader: &mut Reader, node: &Node) -> Vec<FilmOption> {
    let Some(fields) = reader.fields(node, &ANIMATION) else {
        return Vec::new();
    };
    let mut options = Vec::new();
    for (name, node) in fields.in_order() {
        if name == "set" {
            let hint = "set: {angle: 10..80}";
            for (key, node) in reader.names(node, "a mapping of parameters", hint) {
                let value = reader.text(node).map(|value| Written {
                    value: format!("{}={value}", key.name),
                    place: node.place.clone(),
                });
                options.extend(value.map(|value| FilmOption { name, value }));
            }
            continue;
        }
        let value = match fields.form(name) {
            Some(Form::Flag(_)) => reader.flag(node).filter(|it| *it).map(|_| String::new()),
            Some(Form::Words(words)) => reader.word(node, words, name).map(Into::into),
            Some(Form::Whole(least, Some(most))) => whole(reader, node, [*least, *most]),
            _ => reader.text(node),
        };
        let value = value.map(|value| Written {
            value,
            place: node.place.clone(),
        });
        options.extend(value.map(|value| FilmOption { name, value }));
    }
    options
}

/// Reads a whole number between bounds.
fn whole(reader: &mut Reader, node: &Node, [least, most]: [u32; 2]) -> Option<String> {
    let text = reader.text(node)?;
    if text
        .parse()
        .is_ok_and(|it: u32| (least..=most).contains(&it))
    {
        return Some(text);
    }
    let message = format!("'{text}' is no number of frames");
    let hint = format!("write a whole number from {least} to {most}");
    reader.error_with_hint(&node.place, message, hint);
    None
}
