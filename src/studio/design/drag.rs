//! A hand that drags: each movement is a preview, and its end one entry of the history.

use serde::Deserialize;

use crate::edit::Edit;

use super::super::answer::Refusal;
use super::super::session::Session;
use super::act::{Act, Design};
use super::hit::{REACH, distance, hit_element, hit_map};
use super::limits::Limit;
use super::maps::{Grip, Pull};
use super::names::{Basis, Names};
use super::scene::{Panel, Role, Scene};
use super::snap::{Grid, Snapped, Snapping};
use super::solve::{Unknown, solve};
use super::{Selected, edited, nice};

/// An event of a pointer in a panel.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pointer {
    panel: String,
    phase: Phase,
    /// Place in the panel's own coordinates.
    x: f64,
    y: f64,
    /// Length of a pixel.
    pub(super) pixel: f64,
    #[serde(default)]
    shift: bool,
    #[serde(default)]
    alt: bool,
    grid: Option<Grid>,
    /// Number of cells of the grid in the unit length.
    #[serde(default = "parts")]
    parts: u32,
    /// Points of the polyline that is drawn, as written.
    #[serde(default)]
    drawn: Vec<[String; 2]>,
    /// Whether the ends of generators may be moved.
    #[serde(default)]
    unlocked: bool,
    /// Map that is taken hold of at its corner, whatever lies nearer.
    pub(super) map: Option<usize>,
    /// Limit of random functions that is taken hold of, whatever lies nearer.
    limit: Option<usize>,
}

fn parts() -> u32 {
    12
}

/// Phase of a pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Phase {
    Down,
    Move,
    Up,
    /// Without a press: where a point would come to rest.
    Hover,
    Double,
    Cancel,
}

/// Something that is dragged.
#[derive(Clone, Debug)]
pub(super) struct Drag {
    panel: Panel,
    scene: Scene,
    what: What,
    /// Place from the pointer to what is dragged.
    offset: [f64; 2],
    start: [f64; 2],
    has_moved: bool,
}

#[derive(Clone, Copy, Debug)]
enum What {
    Point(usize),
    Arrow(usize),
    Map(usize, Grip),
    Limit(usize),
}

/// Pixels that a hand moves before something is dragged.
const STILL: f64 = 3.0;

impl Pointer {
    pub(super) fn place(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    fn check(&self) -> Result<(), Refusal> {
        let all = [self.x, self.y, self.pixel];
        let is_sound = all.iter().all(|it| it.is_finite() && it.abs() < 1e9) && self.pixel > 0.0;
        match is_sound && (1..=1000).contains(&self.parts) {
            true => Ok(()),
            false => Err(Refusal::wrong(
                "a pointer has a finite place, and a pixel a length",
            )),
        }
    }

    fn snapping(&self) -> Snapping {
        Snapping {
            grid: self.grid,
            parts: self.parts,
            angles: self.shift,
            reach: REACH * self.pixel,
            pixel: self.pixel,
        }
    }
}

/// Handles an event; returns where a point would come to rest, if the pointer hovers.
pub(crate) fn pointer(session: &mut Session, event: &Pointer) -> Result<Option<Snapped>, Refusal> {
    event.check()?;
    match event.phase {
        Phase::Down => down(session, event).map(|()| None),
        Phase::Move => moved(session, event).map(|()| None),
        Phase::Up => up(session, event).map(|()| None),
        Phase::Cancel => {
            session.drop_draft();
            Ok(None)
        }
        Phase::Double => {
            let scene = session.scene()?;
            let panel = find(&scene, &event.panel)?;
            if let Some(element) = hit_element(panel, event) {
                let panel = event.panel.clone();
                session.act(&Act::Split { panel, element })?;
            }
            Ok(None)
        }
        Phase::Hover => {
            let scene = session.scene()?;
            let mut panel = find(&scene, &event.panel)?.clone();
            let drawn = event.drawn.iter().take(super::scene::MOST);
            drawn.for_each(|text| panel.draw(text));
            let last = event.drawn.last().and(panel.points.last());
            let before = last.map(|point| [point.x, point.y]);
            let snapped = event.snapping().snap(&panel, None, before, event.place());
            session.hand.badge = snapped.to.clone();
            Ok(Some(snapped))
        }
    }
}

fn find<'s>(scene: &'s Scene, id: &str) -> Result<&'s Panel, Refusal> {
    let found = scene.panels.iter().find(|panel| panel.id == id);
    found.ok_or_else(|| Refusal::wrong(format!("nothing called '{id}' is designed here")))
}

fn down(session: &mut Session, event: &Pointer) -> Result<(), Refusal> {
    session.drop_draft();
    session.keep()?;
    let scene = session.scene()?;
    let panel = find(&scene, &event.panel)?;
    let near = |place: [f64; 2]| distance(place, event.place());
    let point = (0..panel.points.len())
        .map(|index| (near(panel.place(index)), index))
        .filter(|(far, _)| *far <= REACH * event.pixel && event.map.is_none())
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let limit = (0..panel.limits.len())
        .map(|index| (near(panel.limits[index].at), index))
        .filter(|(far, index)| match event.limit {
            Some(limit) => limit == *index,
            None => *far <= REACH * event.pixel && point.is_none_or(|(point, _)| *far < point),
        })
        .filter(|_| event.map.is_none())
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let others = (hit_element(panel, event), hit_map(panel, event));
    let (what, at) = match (limit, point, others) {
        (Some((_, index)), ..) => (What::Limit(index), panel.limits[index].at),
        (None, Some((_, index)), _) => (What::Point(index), panel.place(index)),
        (None, None, (Some(index), _)) => (What::Arrow(index), event.place()),
        (None, None, (None, Some((index, grip, place)))) => (What::Map(index, grip), place),
        _ => {
            session.hand.selected = None;
            return Ok(());
        }
    };
    let (name, index) = match what {
        What::Limit(index) => ("limit", index),
        What::Point(index) => ("point", index),
        What::Arrow(index) => ("element", index),
        What::Map(index, _) => ("map", index),
    };
    session.hand.selected = Some(Selected {
        panel: event.panel.clone(),
        what: name,
        index,
    });
    session.hand.badge = None;
    session.hand.drag = Some(Drag {
        panel: panel.clone(),
        what,
        offset: [at[0] - event.x, at[1] - event.y],
        start: event.place(),
        has_moved: false,
        scene,
    });
    Ok(())
}

fn moved(session: &mut Session, event: &Pointer) -> Result<(), Refusal> {
    let Some(mut drag) = session.hand.drag.clone() else {
        return Ok(());
    };
    if !drag.has_moved && distance(drag.start, event.place()) < STILL * event.pixel {
        return Ok(());
    }
    drag.has_moved = true;
    session.hand.drag = Some(drag.clone());
    if let Some(why) = &drag.panel.why {
        session.hand.badge = Some(why.clone());
        return Ok(());
    }
    let to = [event.x + drag.offset[0], event.y + drag.offset[1]];
    let (edits, badge) = drag.edits(session, event, to)?;
    session.hand.badge = badge;
    let text = std::sync::Arc::clone(session.kept_text());
    match edited(&session.reader(), &text, &edits) {
        Ok(checked) => session.show_draft(checked),
        // The last place without a mistake stays.
        Err(refusal) => session.hand.badge = Some(refusal.message),
    }
    Ok(())
}

fn up(session: &mut Session, event: &Pointer) -> Result<(), Refusal> {
    let Some(drag) = session.hand.drag.take() else {
        return Ok(());
    };
    if drag.has_moved {
        session.keep_draft();
        return Ok(());
    }
    // A click on the arrow of an element, in its outer half, turns it to the next direction.
    let What::Arrow(index) = drag.what else {
        return Ok(());
    };
    let element = &drag.panel.elements[index];
    let [a, b] = [element.from, element.to].map(|point| drag.panel.place(point));
    let arrow = [0, 1].map(|axis| a[axis] + 0.62 * (b[axis] - a[axis]));
    let is_arrow = distance(arrow, event.place()) <= REACH * event.pixel;
    if is_arrow && drag.panel.role != Role::BaseElement {
        let directions = if drag.scene.names.is_in_space() { 8 } else { 4 };
        let next = element.direction % directions + 1;
        session.act(&Act::Key {
            panel: event.panel.clone(),
            element: index,
            key: "direction".into(),
            value: Some(next.to_string()),
        })?;
    }
    Ok(())
}

/// Lets parameters have the values that are written, in place of those that are set.
fn written(session: &mut Session, (edits, badge): (Vec<Edit>, String)) -> Edits {
    for name in edits.iter().filter_map(|edit| edit.at().get(1)) {
        session.look.set.remove(&name.to_string());
    }
    (edits, Some(badge))
}

type Edits = (Vec<Edit>, Option<String>);

impl Drag {
    fn edits(
        &self,
        session: &mut Session,
        event: &Pointer,
        to: [f64; 2],
    ) -> Result<Edits, Refusal> {
        match self.what {
            What::Point(point) => self.point(session, event, point, to),
            What::Arrow(_) => Ok((Vec::new(), None)),
            What::Map(map, grip) => self.map(session, event, map, grip, to),
            What::Limit(limit) => self.limit(session, event, limit, to),
        }
    }

    /// Changes the limits of random functions, or parameters on which they depend.
    fn limit(
        &self,
        session: &mut Session,
        event: &Pointer,
        limit: usize,
        to: [f64; 2],
    ) -> Result<Edits, Refusal> {
        let Limit { side, point, .. } = self.panel.limits[limit];
        let found = self.panel.functions.as_ref().zip(self.node(session, point));
        let Some((functions, node)) = found else {
            return Ok((Vec::new(), None));
        };
        let names = &self.scene.names;
        if let Some((edits, badge)) = functions.dragged(names, node, side, to, event.pixel) {
            return Ok((edits, Some(badge)));
        }
        let solved = self.solved(session, event, to, &|names| {
            let (place, _) = functions.names(names, side).point(node)?;
            Some(place)
        })?;
        Ok(written(session, solved))
    }

    fn point(
        &self,
        session: &mut Session,
        event: &Pointer,
        point: usize,
        to: [f64; 2],
    ) -> Result<Edits, Refusal> {
        let found = &self.panel.points[point];
        if found.pinned && !event.unlocked {
            let why = "the ends of a generator join its neighbours: the lock opens them";
            return Ok((Vec::new(), Some(why.into())));
        }
        match found.basis {
            Basis::Drawn if !event.alt => {
                let why = format!(
                    "[{}] is drawn at random, or depends on the element: its limits are the dashed figures, and Alt writes numbers",
                    found.text.join(", ")
                );
                return Ok((Vec::new(), Some(why)));
            }
            Basis::Parameters if !event.alt => {
                let solved = self.solved(session, event, to, &|names| {
                    let node = self.node(session, point)?;
                    names.point(node).map(|(place, _)| place)
                })?;
                return Ok(written(session, solved));
            }
            _ => {}
        }
        let before = self
            .panel
            .elements
            .iter()
            .find(|element| element.to == point);
        let before = before.map(|element| self.panel.place(element.from));
        let Snapped { text, to, .. } = event.snapping().snap(&self.panel, Some(point), before, to);
        let root = session.kept()?.0.node();
        let design = Design {
            scene: &self.scene,
            root,
            raw: root,
        };
        let edits = design.place(&self.panel, point, [&text[0], &text[1]])?;
        let badge = format!(
            "[{}]{}",
            text.join(", "),
            to.map(|to| format!("  {to}")).unwrap_or_default()
        );
        Ok((edits, Some(badge)))
    }

    /// Returns where a point is written first.
    fn node<'s>(
        &self,
        session: &'s Session,
        point: usize,
    ) -> Option<&'s crate::document::node::Node> {
        let at = self.panel.points[point].written.first()?;
        crate::edit::find(session.kept().ok()?.0.node(), at)
    }

    fn map(
        &self,
        session: &mut Session,
        event: &Pointer,
        map: usize,
        grip: Grip,
        to: [f64; 2],
    ) -> Result<Edits, Refusal> {
        let handle = &self.panel.maps[map];
        let names = &self.scene.names;
        if handle.basis == Basis::Drawn && !event.alt {
            let why = format!("{} is drawn at random: Alt writes numbers", handle.title());
            return Ok((Vec::new(), Some(why)));
        }
        if handle.basis != Basis::Numbers && !event.alt {
            let solved = self.solved(session, event, to, &|names| handle.grip(grip, names))?;
            return Ok(written(session, solved));
        }
        let snapped = match event.grid.is_some() {
            true => event.snapping().snap(&self.panel, None, None, to).place,
            false => to,
        };
        let pull = Pull {
            grip,
            to: snapped.into(),
            similar: event.shift,
            pixel: event.pixel,
        };
        let edits = handle.edits(names, &pull);
        let Some(edits) = edits else {
            let why = format!(
                "{} is written by {}: in this order, they have no map that lies there",
                handle.title(),
                handle.form
            );
            return Ok((Vec::new(), Some(why)));
        };
        Ok((edits, Some(format!("{}: {}", handle.title(), handle.form))))
    }

    /// Solves for the parameters for which something lies at a place.
    fn solved(
        &self,
        session: &Session,
        event: &Pointer,
        to: [f64; 2],
        place: &dyn Fn(&Names) -> Option<[f64; 2]>,
    ) -> Result<(Vec<Edit>, String), Refusal> {
        let (good, look) = session.kept()?;
        let unknowns: Vec<Unknown> = good
            .parameters
            .iter()
            .filter(|it| super::super::write::is_number(good, it))
            .map(|it| Unknown {
                name: it.name.clone(),
                value: super::super::vary::value_of(it, &look.set),
                min: it.min.unwrap_or(f64::NEG_INFINITY),
                max: it.max.unwrap_or(f64::INFINITY),
            })
            .collect();
        let of = |values: &[f64]| {
            let values = unknowns.iter().zip(values);
            place(
                &self
                    .panel
                    .names
                    .with(values.map(|(it, value)| (it.name.as_str(), *value))),
            )
        };
        let found = solve(&unknowns, to, &of);
        let found =
            found.ok_or_else(|| Refusal::wrong("no parameter with a value of its own moves it"))?;
        let mut edits = Vec::new();
        let mut badge = Vec::new();
        for (index, (unknown, value)) in unknowns.iter().zip(&found).enumerate() {
            if *value == unknown.value {
                continue;
            }
            // As many decimals as move it by a part of a pixel.
            let length = {
                let mut moved = found.clone();
                let by = (unknown.max - unknown.min).min(unknown.value.abs().max(1.0)) * 1e-4;
                moved[index] = (value - by).max(unknown.min);
                let (a, b) = (of(&found), of(&moved));
                a.zip(b)
                    .map_or(1e-3, |(a, b)| by / distance(a, b).max(1e-12))
                    * event.pixel
            };
            let text = nice::decimals(*value, length.min(1.0));
            badge.push(format!("{} = {text}", unknown.name));
            edits.extend(super::super::write::parameter(good, &unknown.name, &text));
        }
        Ok((edits, badge.join(", ")))
    }
}
