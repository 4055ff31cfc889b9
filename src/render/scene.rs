//! Scenes: approximants on their canvases, drawn in one or more passes.

use std::convert::Infallible;
use std::num::NonZero;
use std::sync::{Arc, OnceLock};

use crate::graph::{Graph, Object};
use crate::grow::{self, ColonyKinds, Division, Growth, WalkError, walk_with};
use crate::parallel::Team;
use crate::style::{ColorBy, Colour, Style, Width};

use super::contribution::ContributionMask;
use super::culling::{Culling, starts_rings};
use super::level_of_detail::LevelOfDetail;
use super::painter::Painter;
use super::prepass::{Ranks, span};
use super::sketch::{Means, Sketcher};
use super::sprites::USES;
use super::surface::{Pen, Surface};
use super::{Canvas, Classes, Drawing, Prepass, RenderError, ShortCuts};

/// Approximant on its canvas.
pub(crate) struct Scene<'a> {
    pub(super) graph: &'a Graph,
    pub(super) growth: &'a Growth<'a>,
    pub(super) style: &'a Style,
    pub(super) canvas: Canvas,
    pub(super) culling: Culling,
    pub(super) classes: Classes,
    passes: Vec<Pass>,
    /// Number of elements.
    pub(super) elements: u64,
    /// Ranks of elements, if colours depend on them and they are known.
    ranks: Option<Ranks>,
    pub(super) short_cuts: ShortCuts,
    /// Kinds of colonies, computed when sprites are first made.
    pub(super) colonies: OnceLock<ColonyKinds>,
    /// Minimum number of uses of a sprite.
    pub(super) uses: u64,
    /// Whether one path fills and strokes closed chains.
    pub(super) fills_strokes: bool,
    /// Simplified outlines, once a surface has stated the deviation that it permits.
    pub(super) coarse: OnceLock<Option<LevelOfDetail>>,
}

/// Part of a picture that one walk paints.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Pass {
    /// Areas of fractals that are closed chains, below everything else.
    Areas,
    /// Elements of a class.
    Class(u64),
    /// Elements of all classes, which occur in order.
    Along,
}

impl<'a> Scene<'a> {
    /// Creates the scene of a measured approximant on a canvas.
    pub(crate) fn new(prepass: &Prepass<'a>, growth: &'a Growth<'a>, canvas: Canvas) -> Self {
        let (graph, style) = (prepass.graph(), prepass.style());
        let (classes, painted) = prepass.classes();
        // One path serves both if stroke and colour never change along a fractal.
        let together = graph.draws_closed_paths()
            && matches!(style.width, Width::Pixels(_))
            && graph.widest().is_none()
            && classes.keep_fractals_whole();
        let is_open = |object: &Object| !graph.base_elements()[object.base_element].is_closed();
        let has_areas = starts_rings(graph) && graph.objects().iter().any(is_open);
        let areas = (style.fill.is_some() && !together && has_areas).then_some(Pass::Areas);
        let painted = if classes.come_in_order(graph) {
            vec![Pass::Along]
        } else {
            painted.into_iter().map(Pass::Class).collect()
        };
        let passes: Vec<_> = areas.into_iter().chain(painted).collect();
        if let Some(progress) = growth.progress {
            // The prepass, and a walk for every pass.
            let walks = u64::from(prepass.walked) + passes.len() as u64;
            progress.expect(prepass.elements * walks);
        }
        Self {
            graph,
            growth,
            style,
            canvas,
            culling: prepass.culling().clone(),
            classes,
            passes,
            elements: prepass.elements,
            ranks: prepass.ranks.clone(),
            short_cuts: prepass.short_cuts,
            colonies: OnceLock::new(),
            uses: USES,
            fills_strokes: together && style.fill.is_some(),
            coarse: OnceLock::new(),
        }
    }

    /// Returns whether all strokes have the same width.
    pub(super) fn has_one_width(&self) -> bool {
        matches!(self.style.width, Width::Pixels(_)) && self.graph.widest().is_none()
    }
}

impl Drawing for Scene<'_> {
    fn size(&self) -> [u32; 2] {
        self.canvas.size()
    }

    fn background(&self) -> Option<Colour> {
        self.style.background
    }

    fn pen(&self) -> Pen {
        super::pen(self.style)
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        let mut growth = *self.growth;
        let mut division = Division {
            span: Some(span(self.graph)),
            ranks: grow::Ranks::Unknown,
        };
        if self.style.color_by == ColorBy::Index {
            match &self.ranks {
                Some(ranks) => (growth.steps, division.ranks) = (ranks.steps, ranks.for_walk()),
                // If ranks are unknown before the walk, it is not divided.
                None => division.span = None,
            }
        }
        for &pass in &self.passes {
            let mut painter = Painter::new(self, pass, surface);
            let aim = Arc::new(ContributionMask::of(self, pass));
            let sprites = painter.sprites(pass, &aim);
            let means = Means {
                comb: painter.comb().map(Arc::new),
                coarse: painter.coarse(),
                broadens: painter.broadens(),
                sprites: sprites.map(Arc::new),
                aim,
            };
            let fresh = || Sketcher::new(self, pass, means.clone());
            let walked = walk_with(
                team,
                self.graph,
                &growth,
                division,
                fresh,
                |sketcher, seam| {
                    let painted = painter.paint_span(&sketcher.sketch, seam);
                    sketcher.clear();
                    painted
                },
            )?;
            painter.finish()?;
            if let Some(progress) = self.growth.progress {
                // Elements that a pass leaves out are done with it.
                progress.count(self.elements.saturating_sub(walked.elements));
            }
        }
        Ok(())
    }
}

impl<'a> Prepass<'a> {
    /// Makes the prepass of an approximant: from the graph if it determines everything, otherwise by a walk. Colours that
    /// depend on steps span `steps` of them.
    pub(crate) fn of(
        graph: &'a Graph,
        growth: &Growth<'_>,
        style: &'a Style,
        steps: u32,
        threads: NonZero<usize>,
    ) -> Result<Self, WalkError<Infallible>> {
        match Self::known(graph, growth, style, steps) {
            Some(known) => Ok(known),
            None => Self::new(graph, style, steps).walked(growth, threads),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use super::{Arc, ContributionMask, Pass, Scene, Sketcher, span};
    use crate::catalogue::{Catalogue, Shelf};
    use crate::document::Document;
    use crate::graph::Graph;
    use crate::grow::{self, Division, Growth, walk_with};
    use crate::parallel::with_team;
    use crate::render::layout::Layout;
    use crate::render::sketch::Means;
    use crate::render::{Detail, Format, Options, Size, write_drawing};
    use crate::style::{ColorBy, Colour};

    #[test]
    fn one_walk_paints_classes_that_come_in_order() {
        let catalogue = Catalogue::embedded();
        let cases = [
            ("gosper", ColorBy::Index),
            ("dragon-wreath", ColorBy::Index),
            ("pentaflake", ColorBy::Index),
            ("hilbert", ColorBy::Index),
            // Lengths are unequal, so that ranks require a walk.
            ("snowflake-sweep", ColorBy::Index),
            ("random-tree", ColorBy::Index),
            ("self-seeding-square", ColorBy::Fractal),
        ];
        for (name, color_by) in cases {
            let source = catalogue.component(Shelf::RULES, name).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
            let graph = Graph::compile(&rule, 30).unwrap();
            let mut style = rule.style().clone();
            style.color_by = color_by;
            let options = Options {
                style,
                size: Size::Long(96),
                detail: Some(Detail {
                    pixels: 1.0,
                    decides_steps: true,
                }),
                ..Options::default()
            };
            let growth = Growth::steps(30);
            let layout = Layout::find(&graph, &growth, &options).unwrap();
            let scene = || Scene::new(&layout.prepass, &layout.growth, layout.canvas);
            let png = |scene: &Scene<'_>, threads: usize| {
                let mut png = Vec::new();
                let threads = NonZero::new(threads).unwrap();
                let options = Options {
                    format: Format::Png,
                    threads,
                    ..Options::default()
                };
                write_drawing(scene, &options, &mut png).unwrap();
                png
            };
            let mut one_by_one = scene();
            assert!(one_by_one.passes == [Pass::Along], "{name}");
            one_by_one.passes = one_by_one.classes.all().map(Pass::Class).collect();
            assert!(one_by_one.passes.len() > 10, "{name}");
            one_by_one.ranks = None;
            let expected = png(&one_by_one, 1);
            for threads in [1, 3] {
                assert!(
                    png(&scene(), threads) == expected,
                    "{name} on {threads} threads"
                );
            }
        }
    }

    /// The only areas are those inside closed chains of open elements.
    #[test]
    fn areas_are_looked_for_where_there_may_be_any() {
        let catalogue = Catalogue::embedded();
        for (name, has_areas) in [
            ("mandala", false),
            ("koch", false),
            ("koch-snowflake", true),
        ] {
            let source = catalogue.rule(name).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let model = document.resolve(&[]).unwrap().0;
            let graph = model.compile(2).unwrap();
            let mut options = Options::of(model.metadata());
            options.style.fill = Some(Colour::BLACK);
            options.style.color_by = ColorBy::Step;
            let growth = Growth::steps(2);
            let layout = Layout::find(&graph, &growth, &options).unwrap();
            let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
            assert_eq!(scene.passes.contains(&Pass::Areas), has_areas, "{name}");
        }
    }

    /// A span has few elements if these are large outlines.
    #[test]
    fn sketches_stay_small() {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule("gasket-of-dragons").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let model = document.resolve(&[]).unwrap().0;
        let graph = model.compile(7).unwrap();
        let options = Options::of(model.metadata());
        let growth = Growth::steps(7);
        let layout = Layout::find(&graph, &growth, &options).unwrap();
        let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
        let [mut all, mut most] = [0, 0];
        with_team(NonZero::<usize>::MIN, |team| {
            let division = Division {
                span: Some(span(&graph)),
                ranks: grow::Ranks::Unknown,
            };
            let pass = Pass::Class(0);
            let aim = Arc::new(ContributionMask::of(&scene, pass));
            let means = Means {
                comb: None,
                coarse: None,
                broadens: false,
                sprites: None,
                aim,
            };
            let fresh = || Sketcher::new(&scene, pass, means.clone());
            walk_with(team, &graph, &growth, division, fresh, |sketcher, _| {
                let points = sketcher.sketch.points.len();
                (all, most) = (all + points, most.max(points));
                sketcher.clear();
                Ok(())
            })
            .unwrap();
        });
        assert!(all > 1 << 20 && most <= 1 << 17, "{most} of {all}");
    }
}
