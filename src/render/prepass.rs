//! Prepass over an approximant: bounding box, colours and numbers of elements.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::num::NonZero;
use std::sync::Arc;

use crate::extent::{Limits, Reaches, search};
use crate::geometry::Bounds;
use crate::graph::{Graph, Object};
use crate::grow::{
    self, Census, Division, Element, FractalInfo, Growth, KeptBlocks, Seam, WalkError, walk_with,
};
use crate::parallel::with_team;
use crate::style::{ColorBy, Style, Width};

use super::classes::Classes;
use super::culling::{Culling, starts_rings};
use super::paint::{overhang, relative_overhang};
use super::short_cuts::ShortCuts;

mod visit;

/// Approximate number of elements of a span, in prepasses and in the walks that follow them.
const SPAN: u64 = 1 << 12;

/// Approximate maximum number of points of a span, on which the size of its sketch depends.
const MAX_POINTS: usize = 1 << 16;

/// Returns the range of the values of two ranges.
fn joined(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Returns the approximate number of elements of a span, which is also the maximum for a run.
pub(super) fn span(graph: &Graph) -> u64 {
    let pieces = graph
        .base_elements()
        .iter()
        .map(|base_element| base_element.pieces().len());
    let points = pieces.max().unwrap_or(1).max(1);
    SPAN.min((MAX_POINTS / points) as u64).max(1)
}

/// Source of ranks for a walk over `steps` steps.
#[derive(Clone, Debug)]
pub(super) struct Ranks {
    pub(super) steps: u32,
    how: Known,
}

/// Kind of source.
#[derive(Clone, Debug)]
enum Known {
    /// For every span of a walk with an equal division, the number of preceding elements of the fractal that
    /// it continues.
    BySpan(Arc<[u128]>),
    /// Census, which is independent of the elements that are visited.
    Counted(Arc<Census>),
}

impl Ranks {
    /// Returns the ranks of a census, with the largest rank, if the census is certain.
    pub(super) fn counted(census: Census, steps: u32) -> Option<(Self, u128)> {
        let largest = census.largest()?;
        let how = Known::Counted(Arc::new(census));
        Some((Self { steps, how }, largest))
    }

    /// Returns the ranks as the walk expects them.
    pub(super) fn for_walk(&self) -> grow::Ranks<'_> {
        match &self.how {
            Known::BySpan(before) => grow::Ranks::BySpan(before),
            Known::Counted(census) => grow::Ranks::Counted(census),
        }
    }

    /// Returns whether ranks are independent of the elements that are visited.
    pub(super) fn are_counted(&self) -> bool {
        matches!(self.how, Known::Counted(_))
    }
}

/// Properties of an approximant that are determined before it is drawn.
#[derive(Clone, Debug)]
pub(crate) struct Prepass<'g> {
    graph: &'g Graph,
    style: &'g Style,
    /// Bounding box of the outlines, without strokes whose width is in pixels.
    pub bounds: Bounds,
    /// Whether any outline is stroked.
    pub strokes: bool,
    /// Number of elements.
    pub elements: u64,
    /// Lengths of the shortest and the longest visible element, if colours depend on them.
    pub(super) lengths: [f64; 2],
    /// Whether a visible element lies beyond the range of numbers.
    pub(super) is_beyond: bool,
    /// Number of fractals.
    pub fractals: u64,
    /// Largest rank of an element in its fractal.
    pub largest_index: u128,
    /// Whether a walk was needed.
    pub(super) walked: bool,
    /// Whether the bounding box is known before the walk.
    pub(super) is_bounded: bool,
    /// Number of steps after which elements do not change any more.
    pub(super) steps: u32,
    /// Short cuts that drawing may take.
    pub(super) short_cuts: ShortCuts,
    /// Ranks, if the colour depends on them and they are known.
    pub(super) ranks: Option<Ranks>,
    /// Blocks of the graph, for all walks over it.
    pub(super) blocks: Arc<KeptBlocks>,
    culling: Culling,
    /// Part of the plane that is shown, if it is restricted.
    shown: Option<Bounds>,
    /// Whether the box of an outline meets that part; without a walk, whether the box of all outlines does.
    is_met: bool,
    fractal: FractalInfo,
    /// Last rank in the fractal that the span continues, without the number of elements before the span.
    last_index: Option<u128>,
    goes_on: bool,
    classes: Classes,
    /// Values on which the colour depends, each with whether a visible element has it.
    used: Vec<bool>,
}

impl<'g> Prepass<'g> {
    /// Creates an empty prepass.
    #[must_use]
    pub(crate) fn new(graph: &'g Graph, style: &'g Style, steps: u32) -> Self {
        Self {
            graph,
            style,
            bounds: Bounds::EMPTY,
            strokes: false,
            elements: 0,
            lengths: [f64::INFINITY, 0.0],
            is_beyond: false,
            fractals: 0,
            largest_index: 0,
            walked: false,
            is_bounded: false,
            steps: 0,
            short_cuts: ShortCuts::default(),
            ranks: None,
            blocks: Arc::default(),
            culling: Culling::unbounded(),
            shown: None,
            is_met: false,
            fractal: FractalInfo::default(),
            last_index: None,
            goes_on: false,
            used: Vec::new(),
            classes: Classes::before_survey(style, graph, steps),
        }
    }

    /// Restricts the prepass to visible subtrees.
    #[must_use]
    pub(super) fn of_what_is_in(self, culling: Culling) -> Self {
        Self { culling, ..self }
    }

    /// Lets the prepass determine as well whether any outline meets a part of the plane.
    pub(super) fn of_what_comes_into(self, shown: Bounds) -> Self {
        Self {
            is_met: shown.meets(&self.bounds),
            shown: Some(shown),
            ..self
        }
    }

    /// Returns whether that part is certain to be empty. Closed chains that are filled may enclose it.
    pub(super) fn shows_nothing(&self) -> bool {
        let encloses = self.style.fill.is_some() && starts_rings(self.graph);
        let is_outside = |shown: &Bounds| !shown.meets(&self.bounds);
        !self.is_met
            && self
                .shown
                .is_some_and(|shown| !encloses || is_outside(&shown))
    }

    /// Adds the ranks that the graph determines, if the colour depends on ranks.
    pub(super) fn with_ranks_of(mut self, growth: &Growth<'_>) -> Self {
        if self.style.color_by == ColorBy::Index && self.ranks.is_none() {
            let shortest = self.culling.shortest().unwrap_or(0.0);
            let census = Census::of(self.graph, growth.steps, shortest);
            self.count_ranks(census, growth.steps);
        }
        self
    }

    /// Adds the ranks of a census of `steps` steps, if it determines them; returns whether it does.
    pub(super) fn count_ranks(&mut self, census: Option<Census>, steps: u32) -> bool {
        let ranks = census.and_then(|census| Ranks::counted(census, steps));
        let is_known = ranks.is_some();
        if let Some((ranks, largest)) = ranks {
            (self.ranks, self.largest_index) = (Some(ranks), largest);
        }
        is_known
    }

    /// Returns whether ranks are known regardless of the elements that are visited.
    pub(super) fn counts_ranks(&self) -> bool {
        self.ranks.as_ref().is_some_and(Ranks::are_counted)
    }

    /// Returns the visible part of the approximant.
    pub(super) fn culling(&self) -> &Culling {
        &self.culling
    }

    /// Returns the graph.
    pub(super) fn graph(&self) -> &'g Graph {
        self.graph
    }

    /// Returns the style.
    pub(super) fn style(&self) -> &'g Style {
        self.style
    }

    /// Returns the final classes of colour, and the classes that are to be painted.
    #[must_use]
    pub(crate) fn classes(&self) -> (Classes, Vec<u64>) {
        let classes = self.classes.after_survey(self.fractals, self.largest_index);
        if classes.need_no_survey() {
            let used = (0..).zip(&self.used).filter(|(_, used)| **used);
            let used: BTreeSet<u64> = used.map(|(value, _)| classes.of_value(value)).collect();
            return (classes, used.into_iter().collect());
        }
        (classes, classes.all().collect())
    }

    /// Returns whether colours depend on the lengths of all elements, which a walk finds.
    pub(super) fn needs_lengths(&self) -> bool {
        self.style.color_by == ColorBy::Length && self.style.color_range.is_none()
    }

    pub(super) fn is_stroked(&self, object: &Object) -> bool {
        let base_element = &self.graph.base_elements()[object.base_element];
        !base_element.is_closed() || self.style.outlines_polygons()
    }

    /// Returns the largest distance of an object's stroke from its outline, as a multiple of the object's
    /// length; 0 if widths are in pixels.
    pub(super) fn pad(&self, object: &Object) -> f64 {
        match self.style.width {
            Width::Relative(width) if self.is_stroked(object) => {
                width * self.widest() * self.graph.unit() * relative_overhang(self.style)
            }
            _ => 0.0,
        }
    }

    /// Returns the largest factor of stroke widths.
    fn widest(&self) -> f64 {
        self.graph.widest().unwrap_or(1.0)
    }

    /// Records that a visible element has a value.
    pub(super) fn use_value(&mut self, value: u128) {
        if let (true, Ok(value)) = (self.classes.need_no_survey(), usize::try_from(value)) {
            if value >= self.used.len() {
                self.used.resize(value + 1, false);
            }
            self.used[value] = true;
        }
    }

    /// Records the value of a visible element.
    pub(super) fn use_value_of(&mut self, element: &Element, fractal: &FractalInfo) {
        let value = self.classes.value(element, fractal, self.graph);
        self.use_value(value);
    }

    /// Returns the prepass of the approximant `fewer` steps earlier, which consists of the same elements.
    pub(super) fn sooner(mut self, growth: &Growth<'_>, fewer: u32) -> Self {
        if self.style.color_by == ColorBy::Age {
            self.used.drain(..(fewer as usize).min(self.used.len()));
        }
        self.classes = Classes::before_survey(self.style, self.graph, growth.steps - fewer);
        self
    }

    /// Determines the bounding box, and whether any outline is stroked, without a walk. `None` if the graph
    /// does not bound all subtrees, if only some of the outlines are stroked, or if a search exceeds the limits.
    pub(super) fn glimpsed(
        mut self,
        growth: &Growth<'_>,
        reaches: &[f64],
        limits: Limits,
    ) -> Option<Self> {
        if self.needs_lengths() {
            return None;
        }
        let objects = || self.graph.objects().iter();
        let mut drawn = objects().filter(|object| object.visible);
        self.strokes = drawn.clone().any(|object| self.is_stroked(object));
        if self.strokes && !drawn.all(|object| self.is_stroked(object)) {
            return None;
        }
        let reaches = Reaches {
            all: reaches,
            pads: &objects().map(|object| self.pad(object)).collect::<Vec<_>>(),
        };
        // The box of the last approximant is used for time-indexed graphs, even if short elements are kept.
        let levelled = self.graph.is_time_indexed();
        let pad = |object: &Object| self.pad(object);
        let whole = levelled.then(|| self.graph.padded_bounds(growth.steps, pad));
        self.bounds = match whole.flatten() {
            Some(bounds) => bounds,
            None => search(self.graph, growth, &reaches, limits, |subtree| {
                self.culling.enter(subtree)
            })?,
        };
        self.is_bounded = true;
        Some(self)
    }

    /// Returns the radius of every object's subtree, with strokes: see [`Graph::reaches`].
    pub(super) fn reaches(&self) -> Vec<f64> {
        let radius = self.graph.outline_radii();
        let own = |object: &Object| radius(object) + self.pad(object);
        self.graph.reaches(own)
    }

    /// Adds the prepass of the next span.
    fn add(&mut self, span: &Self, seam: Seam) {
        self.bounds.add_all(&span.bounds);
        self.strokes |= span.strokes;
        self.is_met |= span.is_met;
        self.is_beyond |= span.is_beyond;
        self.elements += span.elements;
        self.lengths = joined(self.lengths, span.lengths);
        self.fractals += span.fractals;
        let last_index = span
            .last_index
            .map_or(0, |index| seam.before.wrapping_add(index));
        self.largest_index = self.largest_index.max(span.largest_index).max(last_index);
        self.steps = self.steps.max(span.steps);
        for (value, _) in (0..).zip(&span.used).filter(|(_, used)| **used) {
            self.use_value(value);
        }
    }

    /// Completes the prepass by a walk on several threads.
    pub(super) fn walked(
        self,
        growth: &Growth<'_>,
        threads: NonZero<usize>,
    ) -> Result<Self, WalkError<Infallible>> {
        let mut prepass = self.with_ranks_of(growth);
        prepass.walked = true;
        let none = prepass.clone();
        let fresh = || none.clone();
        let mut before = Vec::new();
        let blocks = Arc::clone(&prepass.blocks);
        let division = Division {
            span: Some(span(prepass.graph)),
            ranks: grow::Ranks::Unknown,
            blocks: Some(&*blocks),
        };
        let graph = prepass.graph;
        with_team(threads, |team| {
            walk_with(team, graph, growth, division, fresh, |seen, seam| {
                prepass.add(seen, seam);
                before.push(seam.before);
                let fractal = seen.fractal;
                *seen = Self {
                    fractal,
                    ..none.clone()
                };
                Ok(())
            })
        })?;
        if prepass.style.color_by == ColorBy::Index && prepass.ranks.is_none() {
            if prepass.culling.cuts() {
                // The last visitor only decided about replacement, and belongs to no span.
                before.pop();
            }
            before.push(prepass.largest_index);
            prepass.ranks = Some(Ranks {
                steps: growth.steps,
                how: Known::BySpan(before.into()),
            });
        }
        Ok(prepass)
    }

    /// Returns the distance, in pixels, by which strokes of a width in pixels extend beyond their paths.
    #[must_use]
    pub(crate) fn overhang(&self) -> f64 {
        match self.style.width {
            Width::Pixels(width) if self.strokes => width * self.widest() * overhang(self.style),
            _ => 0.0,
        }
    }
}
