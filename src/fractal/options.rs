//! Options of a fractal, as builder methods.

use std::num::NonZero;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use crate::diagnostic::Diagnostic;
use crate::document::{Document, MetadataDocument, Setting};
use crate::render::space::SpaceOptions;
use crate::render::{PngEncoding, Size, ZoomTarget};
use crate::style::{Style, View};

use super::{Error, Fractal, Repetition};

impl Fractal {
    /// Sets a parameter of the file; `model().metadata().parameters` lists them.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let tree = kfrac::Fractal::named("pythagoras")?.set("angle", 30.0)?;
    /// assert!(tree.set("angel", 30.0).is_err());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the file has no such parameter, or is not valid with this value.
    pub fn set(self, name: &str, value: f64) -> Result<Self, Error> {
        self.set_all([(name, value)])
    }

    /// Sets several parameters of the file together: `("angle", 30.0)`, or a [`Setting`].
    ///
    /// # Errors
    ///
    /// If the file has no such parameter, or is not valid with these values.
    pub fn set_all<S: Into<Setting>>(
        mut self,
        settings: impl IntoIterator<Item = S>,
    ) -> Result<Self, Error> {
        for setting in settings {
            let setting: Setting = setting.into();
            let metadata = self.document.as_ref().map(Document::metadata);
            let has = |it: &MetadataDocument| {
                it.params
                    .iter()
                    .any(|param| param.name.value == setting.name)
            };
            if !metadata.is_some_and(has) {
                let hint = metadata.map_or_else(
                    || "it has none".into(),
                    |metadata| metadata.instead_of(&setting.name),
                );
                let message = format!("there is no parameter '{}'", setting.name);
                return Err(Diagnostic::error(message).hint(hint).into());
            }
            self.settings.retain(|known| known.name != setting.name);
            self.settings.push(setting);
        }
        if let Some(document) = &self.document {
            (self.model, self.warnings) = document.resolve(&self.settings)?;
        }
        Ok(self.anew())
    }

    /// Sets the number of steps: how often fertile elements are replaced. By default, it is that of the file, or as
    /// many as [`proposed_steps`](crate::proposed_steps).
    #[must_use]
    pub fn steps(mut self, steps: u32) -> Self {
        self.steps = Some(steps);
        self.anew()
    }

    /// Sets the length in pixels below which elements of pictures are not replaced. Without
    /// [`steps`](Self::steps) it decides their number too.
    #[must_use]
    pub fn detail(mut self, pixels: f64) -> Self {
        self.detail = Some(pixels);
        self.anew()
    }

    /// Sets the seed of random draws; 0 by default.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self.anew()
    }

    /// Sets the largest number of elements that are grown; 50 million by default.
    #[must_use]
    pub fn max_elements(mut self, max_elements: u64) -> Self {
        self.max_elements = max_elements;
        self.anew()
    }

    /// Sets the number of threads; by default, that of the machine's cores. Results do not depend on it.
    #[must_use]
    pub fn threads(mut self, threads: NonZero<usize>) -> Self {
        self.threads = threads;
        self
    }

    /// Sets the size of [`svg`](Self::svg) and of pictures that are [written](Self::write); 1024 pixels on the
    /// long side by default.
    #[must_use]
    pub fn size(mut self, size: impl Into<Size>) -> Self {
        self.size = size.into();
        self
    }

    /// Sets the style in place of the file's.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::style::{ColorBy, Style};
    ///
    /// let koch = kfrac::Fractal::named("koch")?;
    /// let style = koch.model().metadata().style.clone();
    /// let koch = koch.style(Style { color_by: ColorBy::Index, ..style });
    /// assert!(koch.steps(3).svg()?.contains("stroke="));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn style(mut self, style: Style) -> Self {
        self.style = Some(style);
        self
    }

    /// Sets the window, in the file's units, and the margin in place of the file's. A window keeps the frames of a film
    /// in place.
    #[must_use]
    pub fn view(mut self, view: View) -> Self {
        self.view = Some(view);
        self
    }

    /// Repeats pictures of a set of the plane under a wallpaper or frieze group, which
    /// [`TilingGroup::from_name`](crate::style::Named::from_name) finds by its name. The set keeps its size: its box is inscribed
    /// in a fundamental domain of the group. Without a [window](Self::view), a picture shows as many
    /// [periods](Repetition::periods) as are asked for; of the default size, opposite edges of a PNG continue each other.
    /// Elements and numbers are those of the set itself, and a [zoom](Self::zoom) draws no copies. Pictures of sets in space are
    /// refused, and those for which there is a [reason](crate::NoRepetition).
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::{Fractal, Repetition, style::Named, symmetry::TilingGroup};
    ///
    /// let group = TilingGroup::from_name("p4g").unwrap();
    /// let dragon = Fractal::named("dragon")?.steps(8);
    /// let wallpaper = dragon.repeat(Some(Repetition::from(group).periods(2)));
    /// assert_eq!(wallpaper.pixels((300, 300))?.size(), [300, 300]);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn repeat(mut self, repetition: Option<Repetition>) -> Self {
        self.repetition = repetition;
        self
    }

    /// Sets the camera, the shading and the light of pictures of a set in space in place of the file's. They have no effect
    /// in the plane.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::render::space::{Camera, Shade, SpaceOptions};
    ///
    /// let camera = Camera::default().from([60.0, 10.0]).perspective(Some(35.0));
    /// let space = SpaceOptions::default().camera(camera).shade(Some(Shade::Relief));
    /// let sponge = kfrac::Fractal::named("menger")?.steps(4).space(space);
    /// assert_eq!(sponge.pixels((64, 48))?.size(), [64, 48]);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn space(mut self, space: SpaceOptions) -> Self {
        self.space = Some(space);
        self
    }

    /// Sets a point about which pictures of a set of the plane are magnified, without a limit. Elements are replaced down to
    /// the [detail](Self::detail), one pixel by default; a number of steps ends it earlier. Colours by index, which would
    /// need all elements before one, become one colour.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use kfrac::{Fractal, render::ZoomTarget};
    ///
    /// let tip = ZoomTarget::new("1e1000".parse()?, "0.1.(2)".parse()?);
    /// let far = Fractal::named("koch")?.zoom(Some(tip)).pixels((64, 48))?;
    /// assert!(far.premultiplied().iter().any(|&byte| byte > 0));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn zoom(mut self, target: Option<ZoomTarget>) -> Self {
        self.zoom = target;
        self
    }

    /// Sets the encoding of PNGs: faster, or as grey levels.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::render::PngEncoding;
    ///
    /// let encoding = PngEncoding::default().fast(true).grey(true);
    /// let frame = kfrac::Fractal::named("dragon")?.steps(10).png_encoding(encoding).png(400)?;
    /// assert_eq!(frame[24..26], [8, 0]); // 8 bits of grey
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn png_encoding(mut self, encoding: PngEncoding) -> Self {
        self.png_encoding = encoding;
        self
    }

    /// Sets a flag that ends growing and drawing with an error soon after it becomes true. It is tested before
    /// every result, and then at intervals of some thousand elements; the measuring of a dimension goes on.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use std::sync::Arc;
    /// use std::sync::atomic::{AtomicBool, Ordering};
    ///
    /// let flag = Arc::new(AtomicBool::new(false));
    /// let dragon = kfrac::Fractal::named("dragon")?.steps(24).cancel(Arc::clone(&flag));
    /// let drawing = std::thread::spawn(move || dragon.pixels(600));
    /// flag.store(true, Ordering::Relaxed);
    /// assert!(drawing.join().unwrap().unwrap_err().is_cancelled());
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn cancel(mut self, cancel: Arc<AtomicBool>) -> Self {
        self.cancel = Some(cancel);
        self
    }

    pub(super) fn anew(mut self) -> Self {
        self.graph = OnceLock::new();
        self.graph_in_space = OnceLock::new();
        self.drawn_in_space = OnceLock::new();
        self
    }
}
