//! Sets in space in vector formats, and as plots.

use std::path::PathBuf;

use anyhow::anyhow;

use crate::render::space::write_visible;
use crate::render::{self, Format};
use crate::style::Named;

use super::super::labels::labels;
use super::super::rule::Loaded;
use super::super::{Failure, length, output, readable, steps};
use super::{Arguments, plot};

/// Draws a step of a set in space as polygons or lines; returns the path, a summary and the number of bytes.
pub(super) fn draw(
    arguments: &Arguments,
    loaded: &Loaded,
    format: Format,
) -> Result<(PathBuf, String, u64), Failure> {
    let Arguments {
        growth,
        picture,
        plot,
        size,
        ..
    } = arguments;
    let name = &loaded.name;
    let refused = [
        (
            "--detail",
            arguments.detail.is_some(),
            ": give --steps, or write a .png",
        ),
        ("--occlusion", arguments.space.occludes(), ": write a .png"),
        ("--shadows", arguments.space.has_shadows(), ": write a .png"),
        ("--depth", arguments.depth.is_some(), ": write a .png"),
        ("--svg instanced", arguments.svg.is_instanced(), ""),
        ("--zoom", arguments.zoom.is_asked(), ""),
        ("--view", picture.has_view(), ""),
        (
            "--turn",
            arguments.turn.is_some(),
            ": turn it with --from and --up",
        ),
    ];
    // Its plots have the visible edges, without areas.
    let of_areas = { plot.of_areas() }.map(|(option, is_asked)| (option, is_asked, ""));
    for (option, is_asked, instead) in refused.into_iter().chain(of_areas) {
        if is_asked {
            let message =
                format!("{name} lies in space, and {option} is not for its faces{instead}");
            return Err(Failure::Usage(message));
        }
    }
    let metadata = loaded.model.metadata();
    let mut style = picture.style_in(metadata, size.unit);
    let graph = loaded.in_space(arguments.steps())?;
    let graph = graph.ok_or_else(|| anyhow!("{name} lies in the plane"))?;
    let steps = steps::choose_in_space(arguments.steps(), loaded, &graph);
    let drawn = loaded.drawn_in_space(Some(steps), style.color_by)?;
    drawn.colour(&mut style);
    let (graph, levels) = (drawn.graph, drawn.steps.unwrap_or(steps));
    growth.check(levels, &graph, loaded)?;
    let space = arguments.space.to_options(&loaded.model.space_view())?;
    let own = [
        ("steps", steps.to_string()),
        ("format", format.name().into()),
    ];
    let all = { own.into_iter().chain(growth.options()) }
        .chain(plot.options())
        .chain([("size", size.to_string())])
        .chain(picture.options())
        .chain(arguments.own_options())
        .chain(arguments.space.options());
    let options = render::Options {
        format,
        style,
        view: picture.view_in(metadata, size.unit),
        size: size.size,
        unit: size.unit,
        plot: plot.is_asked(),
        pens: plot.pens(picture),
        machine: plot.machine(),
        drawn: arguments.drawn.unwrap_or(1.0),
        threads: growth.threads(),
        labels: labels(loaded, &format!("Step {steps}"), "grow", all),
        ..render::Options::default()
    }
    .on_paper();
    let default = arguments.rule.file("", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let (drawn, bytes) = growth.write(path, |mut out, progress| {
        write_visible(
            &graph,
            &growth.to(levels, progress),
            &options,
            &space,
            &mut out,
        )
        .map_err(|error| output::explain(error, path))
    })?;
    let elements = readable::counted(&drawn.elements.into(), "visible element");
    let size = length::described(drawn.size, size.unit);
    let mut summary = format!("step {steps} of {name}, {elements}, {size}");
    if let Some(plotted) = &drawn.plotted {
        if let Some(note) = plot.note_of_pens(plotted) {
            growth.note(&note);
        }
        for note in plot::of_pens(plotted) {
            growth.note(&note);
        }
        summary.push_str(&format!(", {}", plot::described(plotted)));
    }
    Ok((path.clone(), summary, bytes))
}
