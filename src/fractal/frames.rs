//! Frames of films: a fractal that changes, in one window.

use crate::geometry::{Bounds, DVec2};
use crate::render::{self, Canvas, Format, Pixels, RenderError, Size};
use crate::style::View;
use crate::tween::TweenBy;

use super::{Error, Fractal};

/// Iterator over the frames of a film; see [`Fractal::frames`].
pub struct Frames<F> {
    fractal: Fractal,
    frame: F,
    count: u32,
    next: u32,
    size: Size,
    view: Option<View>,
}

impl Fractal {
    /// Returns the fractal at a share of the way to another one of its kind: this one at 0, the other one at 1. Options of
    /// this one apply. [`tween`](crate::tween) describes the way.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::{Fractal, tween::TweenBy};
    ///
    /// let (koch, levy) = (Fractal::named("koch")?, Fractal::named("levy")?);
    /// let between = koch.toward(&levy, 0.5, TweenBy::Polar)?.steps(4);
    /// assert_eq!(between.elements()?.count(), 256);
    /// assert!(koch.toward(&Fractal::named("barnsley-fern")?, 0.5, TweenBy::Polar).is_err());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If there is no tween between the two.
    pub fn toward(&self, other: &Self, share: f64, by: TweenBy) -> Result<Self, Error> {
        let model = self.model.toward(&other.model, share, by)?;
        let mut between = self.clone().anew();
        (between.document, between.settings) = (None, Vec::new());
        between.model = model;
        Ok(between)
    }

    /// Returns the frames of a film, one after another. `frame` returns the fractal at a moment, which is 0 in the first frame
    /// and 1 in the last; `size` is the long side in pixels, or width and height.
    ///
    /// In the plane all frames show one window, the smallest that holds all of them, unless a [`view`](Fractal::view) is set;
    /// it is found before, from boxes where they are known. In space, the camera of each frame applies.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let tree = kfrac::Fractal::named("pythagoras")?.steps(7);
    /// let bent = |tree: &kfrac::Fractal, moment: f64| tree.clone().set("angle", 25.0 + 40.0 * moment);
    /// let frames: Vec<_> = tree.frames(5, 200, bent)?.collect::<Result<_, _>>()?;
    /// assert!(frames.iter().all(|frame| frame.size() == frames[0].size()));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If a frame cannot be grown, or `frame` fails. Items are errors where a frame cannot be drawn.
    pub fn frames<F: FnMut(&Self, f64) -> Result<Self, Error>>(
        &self,
        count: u32,
        size: impl Into<Size>,
        frame: F,
    ) -> Result<Frames<F>, Error> {
        let mut frames = Frames {
            fractal: self.clone(),
            frame,
            count,
            next: 0,
            size: size.into(),
            view: None,
        };
        if !self.model.is_in_space() && self.view.is_none() && count > 0 {
            frames.find_view()?;
        }
        Ok(frames)
    }

    /// Returns the window of a picture of the plane, in the file's units; `None` if nothing is drawn.
    fn window(&self, size: Size) -> Result<Option<[f64; 4]>, Error> {
        let options = self.options(Format::Png, size)?;
        self.draw_by(&options, |graph, growth, options| {
            let window = render::survey(graph, growth, options)?.window;
            Ok(window.map(|window| graph.place().window(window)))
        })
    }
}

impl<F: FnMut(&Fractal, f64) -> Result<Fractal, Error>> Frames<F> {
    fn fractal(&mut self, number: u32) -> Result<Fractal, Error> {
        let last = self.count.saturating_sub(1).max(1);
        let moment = f64::from(number) / f64::from(last);
        (self.frame)(&self.fractal, moment)
    }

    /// Finds the window that holds all frames, and their size.
    fn find_view(&mut self) -> Result<(), Error> {
        let mut all = Bounds::EMPTY;
        for number in 0..self.count {
            let fractal = self.fractal(number)?;
            if fractal.view.is_some() {
                return Ok(());
            }
            if let Some([x, y, width, height]) = fractal.window(self.size)? {
                let corner = DVec2::new(x, y);
                all.add_all(&Bounds::new(corner, corner + DVec2::new(width, height)));
            }
        }
        let canvas = Canvas::fit(&all, self.size, 0.0).map_err(RenderError::from)?;
        let [width, height] = canvas.size();
        self.size = Size::Exactly(width, height);
        self.view = Some(View {
            window: Some(canvas.window()),
            margin: Some(0.0),
        });
        Ok(())
    }
}

impl<F: FnMut(&Fractal, f64) -> Result<Fractal, Error>> Iterator for Frames<F> {
    type Item = Result<Pixels, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next >= self.count {
            return None;
        }
        let fractal = self.fractal(self.next);
        self.next += 1;
        Some(fractal.and_then(|fractal| {
            let fractal = match self.view {
                Some(view) => fractal.view(view),
                None => fractal,
            };
            fractal.pixels(self.size)
        }))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = (self.count - self.next) as usize;
        (left, Some(left))
    }
}

impl<F: FnMut(&Fractal, f64) -> Result<Fractal, Error>> ExactSizeIterator for Frames<F> {}
