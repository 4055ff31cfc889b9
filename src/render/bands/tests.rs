//! Tests of bands: a picture in bands equals the picture in one piece.

use std::num::NonZero;

use crate::catalogue::Catalogue;
use crate::document::Document;
use crate::geometry::DVec2;
use crate::grow::Growth;
use crate::parallel::Team;
use crate::render::canvas::Size;
use crate::render::drawing::Drawing;
use crate::render::error::RenderError;
use crate::render::layout::Layout;
use crate::render::options::{Format, Options};
use crate::render::paint::{Paint, Pen, Stroke, position};
use crate::render::scene::Scene;
use crate::render::surface::Surface;
use crate::render::write::write_drawing;
use crate::style::{Cap, Colour, Join, Width};

/// Drawing of scenes in parts, some of them nested, below and above shapes of its own.
struct Parts<'a> {
    scene: Scene<'a>,
    /// Whether anything other than thin lines with round pens is drawn.
    has_shapes: bool,
}

const PEN: Pen = Pen {
    width: 2.5,
    cap: Cap::Butt,
    join: Join::Miter,
    dash: 0.0,
};

impl Parts<'_> {
    fn shape(&self, surface: &mut impl Surface, colour: [u8; 4]) -> Result<(), RenderError> {
        if !self.has_shapes {
            return Ok(());
        }
        let colour = Colour::of_rgba(colour);
        surface.begin(&Paint {
            fill: Some(colour),
            stroke: Some(Stroke { colour, pen: PEN }),
            has_holes: false,
        })?;
        let at = |x: f64, y: f64| position(DVec2::new(x, y) * 100.0);
        surface.move_to(at(7.3, 2.1));
        surface.line_to(at(61.7, 33.3));
        surface.curve_to(at(80.0, 60.0), at(20.0, 90.0), at(11.9, 78.2));
        surface.close();
        Ok(surface.end()?)
    }
}

impl Drawing for Parts<'_> {
    fn size(&self) -> [u32; 2] {
        [150, 173]
    }

    fn background(&self) -> Option<Colour> {
        Some(Colour::grey(250))
    }

    fn pen(&self) -> Pen {
        PEN
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        self.shape(surface, [200, 40, 0, 255])?;
        for corner in [[3, 5], [31, 66], [50, 101]] {
            if surface.enter(corner, self.scene.size())? {
                self.shape(surface, [0, 90, 200, 255])?;
                self.scene.draw(surface, team)?;
                if surface.enter([11, 22], [40, 31])? {
                    self.scene.draw(surface, team)?;
                    self.shape(surface, [0, 200, 20, 110])?;
                    surface.leave()?;
                }
                surface.leave()?;
            }
        }
        self.shape(surface, [90, 0, 120, 90])
    }
}

#[test]
fn parts_do_not_know_of_bands() {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule("koch-snowflake").unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    let graph = document.resolve(&[]).unwrap().0.compile(4).unwrap();
    for has_shapes in [false, true] {
        let mut options = Options {
            format: Format::Png,
            size: Size::Exactly(90, 70),
            threads: NonZero::<usize>::MIN,
            ..Options::default()
        };
        options.style.width = Width::Pixels(1.5);
        let growth = Growth::steps(3);
        let layout = Layout::find(&graph, &growth, &options).unwrap();
        let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
        let parts = Parts { scene, has_shapes };
        let png = |in_one_piece, rows: u64, threads| {
            let options = Options {
                in_one_piece,
                band: rows * 150,
                threads: NonZero::new(threads).unwrap(),
                ..options.clone()
            };
            let mut bytes = Vec::new();
            write_drawing(&parts, &options, &mut bytes).unwrap();
            bytes
        };
        let whole = png(0, 200, 1);
        if !has_shapes {
            assert!(png(u64::MAX, 1, 1) == whole);
        }
        for (rows, threads) in [(4, 1), (4, 3), (20, 1), (52, 2), (88, 1)] {
            assert!(
                png(0, rows, threads) == whole,
                "{rows} rows, shapes: {has_shapes}"
            );
        }
    }
}
