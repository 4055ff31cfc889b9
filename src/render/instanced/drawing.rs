//! Text of the symbols and of the picture composed of them.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::sync::atomic::Ordering::Relaxed;

use crate::fast_hash::FastMap;
use crate::geometry::{DVec2, Direction};
use crate::graph::{Chain, Graph, Instance};
use crate::grow::{Growth, WalkError};
use crate::instancing::Appearance;
use crate::render::canvas::Canvas;
use crate::render::classes::Classes;
use crate::render::error::RenderError;
use crate::render::options::Options;
use crate::render::paint::{FINE, pen};
use crate::render::picture::Instanced;
use crate::render::svg::{ends_and_corners, opacity};
use crate::render::unit::Unit;
use crate::style::{Blend, ColorBy, ColorProperty, Colour, Style, Width};

use super::ends::{End, Ends};
use super::symbols::{Aspect, Dress, ElementSubset, Symbol, Symbols};
use super::{NotInstanced, Work, text};

/// Part of a class that is painted at once.
#[derive(Clone, Copy, PartialEq)]
enum Layer {
    Lines,
    Areas,
    Outlines,
    /// Closed and open elements, in order.
    Both,
}

/// Symbol that has been written.
#[derive(Clone, Copy)]
struct Written {
    name: u64,
    /// Number of elements and instances to which it expands, including itself.
    expanded: f64,
}

/// Picture that is being written.
pub(super) struct Drawing<'a> {
    graph: &'a Graph,
    style: &'a Style,
    unit: Unit,
    growth: &'a Growth<'a>,
    classes: Classes,
    symbols: Symbols<'a>,
    /// Symbols that are not empty.
    named: BTreeMap<Symbol, Written>,
    /// Names of base elements by number and appearance.
    outlines: BTreeMap<(usize, Dress), u64>,
    names: u64,
    /// Layers of every class, in order.
    layers: &'static [Layer],
    /// Transforms of instances, by their addresses in the graph.
    transforms: FastMap<usize, Box<str>>,
    /// Work that is left.
    work: Work,
}

/// Returns the layers of every class, in order.
fn layers(graph: &Graph, style: &Style) -> &'static [Layer] {
    let drawn = graph.objects().iter().filter(|object| object.visible);
    let [mut open, mut closed] = [false; 2];
    for object in drawn {
        let is_closed = graph.base_elements()[object.base_element].is_closed();
        closed |= is_closed;
        open |= !is_closed;
    }
    match (open, closed) {
        (_, false) => &[Layer::Lines],
        (true, true) => &[Layer::Both],
        (false, true) if style.outlines_polygons() => &[Layer::Areas, Layer::Outlines],
        (false, true) => &[Layer::Areas],
    }
}

impl<'a> Drawing<'a> {
    /// Prepares a drawing of a graph with known classes of colour.
    pub(super) fn new(
        graph: &'a Graph,
        growth: &'a Growth<'a>,
        options: &'a Options,
        classes: Classes,
        work: Work,
    ) -> Self {
        let style = &options.style;
        Self {
            graph,
            style,
            unit: options.unit,
            growth,
            classes,
            symbols: Symbols::new(graph, style.color_by, classes),
            named: BTreeMap::new(),
            outlines: BTreeMap::new(),
            names: 0,
            layers: layers(graph, style),
            transforms: FastMap::default(),
            work,
        }
    }

    /// Writes the symbols, and an instance of the initiator for every class.
    pub(super) fn write(
        mut self,
        canvas: &Canvas,
        painted: &[u64],
        out: &mut impl Write,
    ) -> Result<Instanced, RenderError> {
        let initiator = self.graph.initiator(self.growth.steps);
        // The initiator replaces a virtual object that has one more step.
        let aspect = |part| Aspect {
            steps: self.growth.steps + 1,
            part,
            dress: Dress(Appearance::NONE),
        };
        let aspects = |class| self.parts(class).into_iter().map(aspect).collect();
        let classes = painted.iter().map(|&class| (class, aspects(class)));
        let classes: Vec<(u64, Vec<Aspect>)> = classes.collect();
        let all = classes
            .iter()
            .flat_map(|(_, aspects)| aspects.iter().copied());
        let symbols = self.symbols.collect(initiator, all, &mut self.work);
        let symbols = symbols.filter(|symbols| self.affords(symbols, initiator));
        let symbols = symbols.ok_or(NotInstanced::TooManySymbols)?;
        let mut ends = Ends::new(self.graph);
        let mut text = String::new();
        out.write_all(b"<defs>\n")?;
        for symbol in symbols {
            if self.growth.cancel.is_some_and(|it| it.load(Relaxed)) {
                return Err(RenderError::Walk(WalkError::Cancelled));
            }
            text.clear();
            self.define(&symbol, &mut ends, &mut text);
            out.write_all(text.as_bytes())?;
        }
        out.write_all(b"</defs>\n")?;
        let map = canvas.to_pixels().to_cols_array();
        let map = map.map(|number| (number * FINE).to_string()).join(" ");
        writeln!(
            out,
            r#"<g transform="matrix({map})"{}{}>"#,
            self.width(Appearance::NONE, 1.0),
            ends_and_corners(pen(self.style))
        )?;
        if self.symbols.links {
            ends.advance(self.growth.steps);
        }
        let mut expanded = 0.0;
        for (class, aspects) in classes {
            for &layer in self.layers {
                text.clear();
                for of in &aspects {
                    for fractal in initiator.fractals() {
                        expanded += self.chain(fractal, of, false, &ends, &mut text);
                    }
                }
                if !text.is_empty() {
                    writeln!(out, "<g{}>\n{text}\n</g>", self.paint(class, layer))?;
                }
            }
        }
        out.write_all(b"</g>\n")?;
        Ok(Instanced {
            symbols: self.names,
            expanded,
        })
    }

    /// Returns whether outlines, transforms of instances, and ends that lines link take no more work than is left.
    fn affords(&mut self, symbols: &[Symbol], initiator: &Chain) -> bool {
        /// Work of a transform, and of a point of an outline, relative to that of an instance whose transform is known.
        const TRANSFORM: usize = 8;
        const POINT: usize = 4;
        let mut successors = BTreeSet::new();
        let mut outlines = BTreeSet::new();
        let mut is_affordable = self.work.take(TRANSFORM * initiator.instances.len());
        for symbol in symbols {
            let number = self.graph.objects()[symbol.object].base_element;
            let own = match self.symbols.successor(symbol) {
                Some(successor) if successors.insert(std::ptr::from_ref(successor).addr()) => {
                    TRANSFORM * successor.placed_instances().count()
                }
                None if outlines.insert((number, symbol.aspect.dress)) => {
                    POINT * self.graph.base_elements()[number].pieces().len()
                }
                _ => 0,
            };
            is_affordable = is_affordable && self.work.take(own);
        }
        let steps = self.growth.steps as usize;
        let ends = steps.saturating_mul(self.graph.objects().len());
        is_affordable && (!self.symbols.links || self.work.take(ends))
    }

    /// Returns the subsets of elements painted in the colour of a class, as seen from the virtual object that
    /// the initiator replaces.
    fn parts(&self, class: u64) -> Vec<ElementSubset> {
        match self.style.color_by.property() {
            ColorProperty::Step => {
                let steps = self.classes.steps(class).into_iter().flatten();
                steps.map(|step| ElementSubset::Born(step + 1)).collect()
            }
            ColorProperty::Age if self.graph.seeds => {
                let steps = self.growth.steps;
                let born = |age: u32| match steps - age {
                    0 => ElementSubset::Own,
                    born => ElementSubset::Seeded(born + 1),
                };
                let of_class = |age: &u32| self.classes.of_value((*age).into()) == class;
                (0..=steps).filter(of_class).map(born).collect()
            }
            ColorProperty::Object => vec![ElementSubset::Class(class)],
            ColorProperty::Direction => {
                let number = u32::try_from(class + 1).ok();
                let direction = number.and_then(Direction::from_number);
                direction.map(ElementSubset::Heading).into_iter().collect()
            }
            _ => vec![ElementSubset::All],
        }
    }

    /// Writes a symbol, unless it is empty.
    fn define(&mut self, symbol: &Symbol, ends: &mut Ends<'_>, text: &mut String) {
        let Some(successor) = self.symbols.successor(symbol) else {
            let name = self.outline(symbol, text);
            let written = Written {
                name,
                expanded: 1.0,
            };
            self.named.insert(*symbol, written);
            return;
        };
        if self.symbols.links {
            ends.advance(symbol.aspect.steps - 1);
        }
        let mut content = String::new();
        let of = &symbol.aspect;
        let mut expanded =
            1.0 + self.chain(&successor.body.instances, of, false, ends, &mut content);
        for seed in &successor.seeds {
            expanded += self.chain(&seed.chain.instances, of, true, ends, &mut content);
        }
        if content.is_empty() {
            return;
        }
        let name = self.next_name();
        text.push_str(&format!("<g id=\"{}\">{content}</g>\n", text::name(name)));
        self.named.insert(*symbol, Written { name, expanded });
    }

    fn next_name(&mut self) -> u64 {
        self.names += 1;
        self.names - 1
    }

    /// Returns the name of the outline of an object in its appearance, which is written on first use.
    fn outline(&mut self, symbol: &Symbol, text: &mut String) -> u64 {
        let number = self.graph.objects()[symbol.object].base_element;
        let Dress(appearance) = symbol.aspect.dress;
        let key = (number, symbol.aspect.dress);
        if let Some(&name) = self.outlines.get(&key) {
            return name;
        }
        let base_element = &self.graph.base_elements()[number];
        let (style, is_closed) = (self.style, base_element.is_closed());
        let own = |what: &str, colour: Option<Colour>| colour.map(|it| self.own_paint(what, it));
        let fill = match is_closed {
            false => Some(r#" fill="none""#.into()),
            true => own("fill", self.tint(appearance, style.polygons())),
        };
        let stroke = match (is_closed, style.outlines_polygons()) {
            (false, _) => own("stroke", self.tint(appearance, style.lines())),
            (true, _) if self.layers != [Layer::Both] => None,
            (true, true) => own("stroke", style.stroke),
            (true, false) => Some(r#" stroke="none""#.into()),
        };
        let width = self.graph.widest().map(|_| self.width(appearance, 1.0));
        let name = self.next_name();
        text.push_str(&format!(
            "<path id=\"{}\" d=\"{}\"{}{}{}{}/>\n",
            text::name(name),
            text::outline(base_element),
            fill.unwrap_or_default(),
            stroke.unwrap_or_default(),
            width.unwrap_or_default(),
            self.effect()
        ));
        self.outlines.insert(key, name);
        name
    }

    /// Returns the attribute by which strokes of a width in pixels do not scale.
    fn effect(&self) -> &'static str {
        match self.style.width {
            Width::Pixels(_) => r#" vector-effect="non-scaling-stroke""#,
            Width::Relative(_) => "",
        }
    }

    /// Writes instances that follow each other and the lines that link them, and returns the number of elements and
    /// instances to which they expand.
    fn chain(
        &mut self,
        instances: &[Instance],
        of: &Aspect,
        seeded: bool,
        ends: &Ends<'_>,
        text: &mut String,
    ) -> f64 {
        let part = match (of.part, seeded) {
            (ElementSubset::Seeded(1), true) => ElementSubset::Own,
            (part, _) => part,
        };
        let mut expanded = 0.0;
        // In a ring, the first instance is joined to the last.
        let mut before = instances.last();
        for instance in instances {
            if let (true, true, Some(before)) = (self.symbols.links, instance.joined, before)
                && let (Some(from), Some(to)) = (ends.of(before)[1], ends.of(instance)[0])
                && !(from.meets_frame && to.meets_frame)
                && self.symbols.paints(to.object, to.born, to.direction, part)
            {
                let Dress(appearance) = of.dress;
                self.link(from.point, &to, appearance, text);
                expanded += 1.0;
            }
            before = Some(instance);
            let symbol = self.symbols.child(instance, of, seeded);
            let Some(written) = symbol.and_then(|symbol| self.named.get(&symbol)) else {
                continue;
            };
            // Symbols of an object differ in steps and parts, not in their maps.
            let address = std::ptr::from_ref(instance).addr();
            let transform = self.transforms.entry(address);
            let transform =
                transform.or_insert_with(|| text::transform(instance.frame.map()).into());
            text.push_str("<use href=\"#");
            text.push_str(&text::name(written.name));
            if !transform.is_empty() {
                text.push_str("\" transform=\"");
                text.push_str(transform);
            }
            text.push_str("\"/>");
            expanded += written.expanded + 1.0;
        }
        expanded
    }

    /// Writes the line that links an element to its predecessor, in an appearance.
    fn link(&self, from: DVec2, to: &End, appearance: Appearance, text: &mut String) {
        let appearance = appearance.over(to.appearance);
        let stroke = self.tint(appearance, self.style.lines());
        let stroke = stroke.map(|colour| self.own_paint("stroke", colour));
        let has_own_width =
            self.graph.widest().is_some() || matches!(self.style.width, Width::Relative(_));
        let width = has_own_width.then(|| self.width(appearance, to.length));
        text.push_str(&format!(
            "<path d=\"{}\" fill=\"none\"{}{}{}/>",
            text::line(from, to.point),
            stroke.unwrap_or_default(),
            width.unwrap_or_default(),
            self.effect()
        ));
    }

    /// Returns the colour of elements that have their own colour and a tint, if colours depend on tints.
    fn tint(&self, appearance: Appearance, own: Colour) -> Option<Colour> {
        self.has_tints().then(|| appearance.on(own))
    }

    fn has_tints(&self) -> bool {
        self.style.color_by == ColorBy::Tint && self.graph.tints()
    }

    /// Returns the attribute for the stroke width in an appearance: relative to the length of elements in the
    /// frame, or in CSS pixels.
    fn width(&self, appearance: Appearance, length: f64) -> String {
        let width = match self.style.width {
            Width::Relative(width) => width * length * self.graph.unit(),
            Width::Pixels(width) => width * self.unit.millimetres() / Unit::Pixel.millimetres(),
        };
        let width = width * appearance.width();
        format!(r#" stroke-width="{width}""#)
    }

    /// Returns the attributes of a colour instead of that of the class, with the opacity where that of the class is inherited.
    fn own_paint(&self, what: &str, colour: Colour) -> String {
        let painted = painted(what, colour);
        let is_inherited = [self.style.polygons(), self.style.lines()]
            .iter()
            .any(|of_class| of_class.opacity() < 1.0);
        match colour.opacity() < 1.0 || !is_inherited {
            true => painted,
            false => format!(r#"{painted} {what}-opacity="1""#),
        }
    }

    /// Returns the attributes of the colour of a class. Opacity applies to the group as a whole, so that
    /// overlaps are not visible, except where they are blended or elements have colours of their own.
    fn paint(&self, class: u64, layer: Layer) -> String {
        let own = self.classes.colour(class, self.style);
        let lines = own.unwrap_or(self.style.lines());
        let areas = own.unwrap_or(self.style.polygons());
        let one = |colour: Colour, fill: bool| {
            let (on, off) = if fill {
                ("fill", "stroke")
            } else {
                ("stroke", "fill")
            };
            let is_joined = self.style.blend == Blend::Joined && !self.has_tints();
            match colour.opacity() < 1.0 && is_joined {
                true => format!(
                    r#" {off}="none" {on}="{colour}" opacity="{:.3}""#,
                    colour.opacity()
                ),
                false => format!(r#" {off}="none"{}"#, painted(on, colour)),
            }
        };
        match layer {
            Layer::Lines => one(lines, false),
            Layer::Areas => one(areas, true),
            Layer::Outlines => one(self.style.stroke.unwrap_or(lines), false),
            Layer::Both => painted("fill", areas) + &painted("stroke", lines),
        }
    }
}

fn painted(what: &str, colour: Colour) -> String {
    format!(r#" {what}="{colour}"{}"#, opacity(what, colour))
}
