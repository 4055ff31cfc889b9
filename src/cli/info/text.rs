//! Description of a rule in text.

use std::fmt::Write as _;

use crate::cli::readable::{self, counted};
use crate::cli::rule::Loaded;
use crate::cli::structure::StructureInfo;
use crate::count::Count;
use crate::metadata::Parameter;
use crate::rule::Generator;

use super::Info;

/// Describes the rule in text.
pub(super) fn described(loaded: &Loaded, info: &Info<'_>, unit: f64) -> String {
    let mut text = String::new();
    let metadata = loaded.model.metadata();
    let description = &metadata.description;
    let mut line = |label: &str, value: &str| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{label:<12}{value}");
    };
    line("name", info.name);
    if let Some(title) = &description.title {
        line("title", title);
    }
    if let Some(about) = &description.about {
        line("about", about.trim());
    }
    if let Some(source) = &description.source {
        line("source", source.trim());
    }
    if !description.tags.is_empty() {
        line("tags", &description.tags.join(", "));
    }
    for parameter in &metadata.parameters {
        line("parameter", &parameter_line(parameter));
    }
    let generators = loaded
        .model
        .rule()
        .map_or(&[][..], |rule| rule.generators());
    let names: Vec<_> = generators.iter().map(Generator::name).collect();
    if names.len() > 1 {
        line("generators", &names.join(", "));
    }
    for (label, value) in info.system.iter().flat_map(|system| system.lines(unit)) {
        line(label, &value);
    }
    for (label, value) in info.structure.iter().flat_map(StructureInfo::lines) {
        line(label, &value);
    }
    if let Some(turtle) = &info.turtle {
        line("turtle", &turtle.line());
    }
    if let Some(group) = &metadata.symmetry {
        let images = counted(&u64::from(group.order()).into(), "image");
        line("symmetry", &format!("{group}: {images}"));
    }
    line("random", if info.random { "yes" } else { "no" });
    line(
        "regular",
        if info.regular {
            "yes"
        } else {
            "no: the walk counts indices"
        },
    );
    let labels = ["dimension", ""].into_iter();
    for (label, dimension) in labels.zip(info.dimension.lines().into_iter().flatten()) {
        line(label, &dimension);
    }
    if let Some(bytes) = info.instanced_svg_bytes {
        let bytes = readable::rough_bytes(bytes);
        line(
            "instanced",
            &format!("about {bytes} of SVG at step {}", info.steps),
        );
    }
    if let Some(bounds) = &info.bounds {
        line(
            "bounds",
            &format!("{} at step {}", bounds.described(unit), info.steps),
        );
    }
    if let Some(bounds) = &info.limit_bounds {
        line("", &format!("{} in the limit", bounds.described(unit)));
    }
    text.push('\n');
    match &info.elements {
        Some(elements) => text.push_str(&table(info, elements, unit)),
        None => text.push_str("The sizes of the steps are not known before they are grown.\n"),
    }
    text
}

fn parameter_line(parameter: &Parameter) -> String {
    let mut line = format!("{} = {}", parameter.name, parameter.value);
    match (parameter.min, parameter.max) {
        (Some(min), Some(max)) => line.push_str(&format!(", from {min} to {max}")),
        (Some(min), None) => line.push_str(&format!(", at least {min}")),
        (None, Some(max)) => line.push_str(&format!(", at most {max}")),
        (None, None) => {}
    }
    if let Some(about) = &parameter.about {
        line.push_str(&format!(": {}", about.trim()));
    }
    line
}

/// Formats the forecast, one row per step. Long numbers are abbreviated to their magnitude.
fn table(info: &Info<'_>, elements: &[Count], unit: f64) -> String {
    let is_in_space = info.space == 3;
    let last = match is_in_space {
        true => ["surface", "volume"],
        false => ["SVG (about)", "time (about)"],
    };
    let volume = { info.volume.as_ref() }.map_or(&None, |it| &it.volume);
    let head = ["step", "elements", "fertile", "fractals", "length"];
    let head = head.into_iter().chain(last).map(String::from);
    let mut rows: Vec<Vec<String>> = vec![head.collect()];
    for step in 0..elements.len() {
        let at = |column: &Option<Vec<Count>>| {
            column
                .as_ref()
                .map_or("-".into(), |column| readable::grouped(&column[step]))
        };
        let of = |column: &Option<Vec<Option<f64>>>| column.as_ref().and_then(|all| all[step]);
        let estimated =
            |value: Option<f64>, wording: fn(f64) -> String| value.map_or("-".into(), wording);
        let measured = |column| of(column).map_or("-".into(), |it| readable::measure(it, unit));
        let last = match is_in_space {
            true => [measured(&info.area), measured(volume)],
            false => [
                estimated(of(&info.svg_bytes), readable::rough_bytes),
                estimated(of(&info.seconds), readable::duration),
            ],
        };
        let row = [
            step.to_string(),
            readable::grouped(&elements[step]),
            at(&info.fertile),
            at(&info.fractals),
            measured(&info.length),
        ];
        rows.push(row.into_iter().chain(last).collect());
    }
    let widths: Vec<_> = (0..rows[0].len())
        .map(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0))
        .collect();
    let mut table = String::new();
    for row in &rows {
        let cells: Vec<_> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"))
            .collect();
        table.push_str(&cells.join("  "));
        table.push('\n');
    }
    table
}
