//! Visits of elements, runs and colonies by a sketcher.

use std::io;
use std::ops::RangeInclusive;

use crate::grow::{Colony, Element, Enter, FractalInfo, Run, Subtree, Taken, Visitor};
use crate::render::classes::Share;
use crate::render::contribution::Painted;
use crate::render::prepass::span;
use crate::render::scene::{Pass, Scene};
use crate::style::Width;

use super::{Mark, Sketcher};

impl Visitor for Sketcher<'_> {
    type Error = io::Error;

    fn takes_runs(&self) -> bool {
        true
    }

    fn longest_run(&self) -> u64 {
        let longest = span(self.scene.graph);
        let sprites = self.means.sprites.as_ref();
        let placed = sprites.and_then(|sprites| sprites.longest_run());
        placed.map_or(longest, |placed| longest.min(placed))
    }

    fn cuts(&self) -> Option<f64> {
        self.scene.culling.shortest()
    }

    fn ages(&self) -> RangeInclusive<u32> {
        let ages = match self.pass {
            Pass::Class(class) => self.scene.classes.ages(class),
            Pass::Areas | Pass::Along => None,
        };
        ages.unwrap_or(0..=u32::MAX)
    }

    fn go_on(&mut self, fractal: FractalInfo) {
        self.fractal = fractal;
    }

    fn begin(&mut self, fractal: FractalInfo) -> io::Result<()> {
        self.fractal = fractal;
        self.mark(Mark::Begin);
        Ok(())
    }

    #[inline]
    fn enter(&mut self, subtree: &Subtree) -> Enter {
        match self.scene.culling.enter(subtree) {
            Enter::Replace | Enter::Divide if !self.mask.may_paint(self.scene, subtree) => {
                Enter::Skip
            }
            enter => enter,
        }
    }

    #[inline]
    fn element(&mut self, element: &Element) -> io::Result<()> {
        self.see(element);
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> io::Result<()> {
        let Scene { graph, classes, .. } = self.scene;
        if self.scene.frames.is_some() {
            run.elements().for_each(|element| self.see(&element));
            return Ok(());
        }
        let share = match self.pass {
            Pass::Areas => Share::Some,
            Pass::Class(_) if self.mask.paints_all_of(run.object()) => Share::All,
            Pass::Class(class) => classes.share(run, &self.fractal, graph, class),
            Pass::Along => {
                let ends = [run.first(), run.last()].map(|element| {
                    element.map_or(0, |element| classes.of(&element, &self.fractal, graph))
                });
                if ends[0] == ends[1] {
                    self.come_to(ends[0]);
                    Share::All
                } else {
                    Share::Some
                }
            }
        };
        let one_width = matches!(self.scene.style.width, Width::Pixels(_));
        let line = run.line().filter(|_| one_width);
        match (share, line, run.sticks()) {
            // Of elements that are not painted, only the end matters, where the next line may begin.
            (Share::None, ..) => {
                if let Some(last) = run.last() {
                    self.see(&last);
                }
            }
            (Share::All, ..) if self.sprite(run, Painted::All) => {}
            (Share::All, _, Some(sticks)) if self.batches(run, sticks) => {}
            (Share::All, Some(ends), _) => {
                if let Some(first) = run.first() {
                    self.lines(run, ends, &first);
                }
            }
            (Share::All, _, Some(sticks)) => {
                if let Some(first) = run.first() {
                    self.sticks(run, sticks, &first);
                }
            }
            _ => match (self.pass, self.mask.steps.clone()) {
                (_, Some(steps))
                    if self.sprite(run, Painted::Steps(*steps.start(), *steps.end())) => {}
                (_, Some(steps)) => self.some(run, run.born_in(steps)),
                (Pass::Class(class), None)
                    if self.mask.depends_on_objects()
                        && self.sprite(run, Painted::Class(class)) => {}
                (Pass::Class(class), None) if self.mask.stands_alone => {
                    let fractal = self.fractal;
                    let is_of = |element: &Element| classes.of(element, &fractal, graph) == class;
                    self.some(run, run.chosen(is_of));
                }
                _ => run.elements().for_each(|element| self.see(&element)),
            },
        }
        Ok(())
    }

    fn takes(&self, colony: &Colony<'_>) -> Taken {
        let sprites = self.means.sprites.as_ref();
        sprites.map_or(Taken::Nothing, |sprites| sprites.takes(colony))
    }

    fn colony(&mut self, colony: &Colony<'_>, _: Taken) -> io::Result<()> {
        self.colony_of(colony);
        Ok(())
    }

    fn end(&mut self, joined: bool) -> io::Result<()> {
        self.mark(Mark::End(joined));
        Ok(())
    }
}
