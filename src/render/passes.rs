//! Drawing of scenes, pass by pass.

use std::sync::Arc;

use crate::grow::{self, Division, walk_with};
use crate::parallel::Team;
use crate::style::{Blend, ColorBy, Colour};

use super::contribution::ContributionMask;
use super::drawing::Drawing;
use super::error::RenderError;
use super::paint::Pen;
use super::paint_key::{PaintKey, PathKind};
use super::painter::Painter;
use super::png::Means;
use super::prepass::span;
use super::scene::Scene;
use super::sketch::Sketcher;
use super::surface::Surface;

impl Drawing for Scene<'_> {
    fn size(&self) -> [u32; 2] {
        self.canvas.size()
    }

    fn background(&self) -> Option<Colour> {
        self.style.ground()
    }

    fn pen(&self) -> Pen {
        super::paint::pen(self.style)
    }

    fn has_default_ink(&self) -> bool {
        self.style.has_default_ink()
    }

    fn blend(&self) -> Blend {
        self.style.blend
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        let mut growth = *self.growth;
        let mut division = Division {
            span: Some(span(self.graph)),
            ranks: grow::Ranks::Unknown,
            blocks: Some(&*self.blocks),
        };
        if self.style.color_by == ColorBy::Index {
            match &self.ranks {
                Some(ranks) => (growth.steps, division.ranks) = (ranks.steps, ranks.for_walk()),
                // If ranks are unknown before the walk, it is not divided.
                None => division.span = None,
            }
        }
        for &pass in &self.passes {
            let mask = Arc::new(ContributionMask::of(self, pass));
            let polygons = PaintKey::of(PathKind::Polygon).paint(self, pass.colour(self));
            let broadens = polygons.stroke.is_none() && surface.broadens(&polygons);
            let raster = surface.raster();
            let means = raster.map(|raster| Means::of(self, pass, &mask, raster));
            let means = means.unwrap_or_default();
            let mut painter = Painter::new(self, pass, surface);
            let fresh = || Sketcher::new(self, pass, Arc::clone(&mask), broadens, means.clone());
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

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use super::{Arc, ContributionMask, Means, Scene, Sketcher, span};
    use crate::catalogue::{Catalogue, Shelf};
    use crate::document::Document;
    use crate::graph::Graph;
    use crate::grow::{self, Division, Growth, walk_with};
    use crate::parallel::with_team;
    use crate::render::layout::Layout;
    use crate::render::scene::Pass;
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
                blocks: None,
            };
            let pass = Pass::Class(0);
            let mask = Arc::new(ContributionMask::of(&scene, pass));
            let fresh = || Sketcher::new(&scene, pass, Arc::clone(&mask), false, Means::default());
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
