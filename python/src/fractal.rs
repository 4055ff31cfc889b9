//! `Fractal`: the front door of the library as a Python class.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use kfrac::Repetition;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Setting;
use kfrac::measure::Precision;
use kfrac::render::{Size, ZoomTarget};
use kfrac::style::{Named, View};
use kfrac::symmetry::TilingGroup;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyComplex, PyDict};

use crate::error::{Failure, listed};
use crate::results::{SizeArgument, named, whole};
use crate::table::Table;
use crate::work::{long, quick};

/// Limit of elements, unless another is given.
const MOST: u64 = 50_000_000;

/// Largest number of periods of a picture along both axes.
const MOST_PERIODS: u32 = 100;

/// Size in bytes up to which a notebook shows SVG.
const NOTEBOOK: f64 = 300_000.0;

/// Linear fractal: a rule, a system of maps, a structure or an L-system, with values of its parameters.
///
/// `load` and `parse` make fractals; they never change. Methods grow them anew for each result, without the interpreter's
/// lock, on all cores, to the same result on any number of threads. Arguments that methods share:
///
/// steps : int, optional
///     How often fertile elements are replaced; by default as the file proposes.
/// seed : int
///     Seed of the random draws of the file.
/// size : int or (int, int)
///     Long side of a picture in pixels, or width and height.
/// detail : float, optional
///     Length in pixels below which elements are not replaced. Without `steps`, it decides their number.
/// view : (float, float, float, float), optional
///     Part of the plane that a picture shows, without a margin: x and y of the lower left corner, width and height, in the
///     file's units. A picture of another shape shows more of the plane around it. By default, the window of the file, or else
///     all that is drawn, with a margin. Not for sets in space, nor together with `zoom`.
/// max_elements : int
///     Largest number of elements that are grown.
/// threads : int, optional
///     Number of threads; by default that of the machine's cores.
#[pyclass(frozen, module = "kfrac")]
#[derive(Clone)]
pub(crate) struct Fractal {
    fractal: kfrac::Fractal,
    name: String,
    /// Magnification and centre as written, and turn, of a zoom.
    zoom: Option<(String, String, f64)>,
    /// Group, factor of the distance of copies, and number of periods of a repetition.
    repetition: Option<(String, f64, u32)>,
}

/// Returns the fractal of a file, or of the library by its name.
///
/// Parameters
/// ----------
/// name : str or path
///     A file, or a name in the library, which `library` lists. An existing file comes first.
/// **parameters : float or complex
///     Values of parameters of the file, in place of its own.
///
/// Raises
/// ------
/// KfracError
///     If there is no such file or name, or the file is not valid: all its mistakes, with their places.
#[pyfunction]
#[pyo3(signature = (name, /, **parameters))]
pub(crate) fn load(
    py: Python<'_>,
    name: PathBuf,
    parameters: Option<&Bound<'_, PyDict>>,
) -> PyResult<Fractal> {
    let fractal = quick(py, || {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule(&name)?;
        Ok(kfrac::Fractal::read(&source, &catalogue)?)
    })?;
    let name = stem(&name);
    Fractal::new(fractal, name).set(py, parameters)
}

/// Returns the fractal of the text of a file.
///
/// Parameters
/// ----------
/// text : str
///     A rule file, in YAML.
/// name : str
///     Its name in messages.
/// **parameters : float or complex
///     Values of parameters of the file, in place of its own.
///
/// Raises
/// ------
/// KfracError
///     If the text is not valid: all its mistakes, with their places.
#[pyfunction]
#[pyo3(signature = (text, /, name="text", **parameters))]
pub(crate) fn parse(
    py: Python<'_>,
    text: &str,
    name: &str,
    parameters: Option<&Bound<'_, PyDict>>,
) -> PyResult<Fractal> {
    let fractal = quick(py, || {
        let source = Source::new(name, text);
        Ok(kfrac::Fractal::read(&source, &Catalogue::embedded())?)
    })?;
    Fractal::new(fractal, name.to_owned()).set(py, parameters)
}

/// Returns the name of a file without folder and extension.
fn stem(path: &Path) -> String {
    let is_file = path
        .extension()
        .is_some_and(|it| it == "yaml" || it == "yml" || it == "json");
    let name = if is_file {
        path.file_stem()
    } else {
        path.file_name()
    };
    name.map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Options of growing that methods share.
struct Growing {
    steps: Option<u32>,
    seed: u64,
    max_elements: u64,
    threads: Option<NonZero<usize>>,
}

impl Growing {
    fn steps(steps: Option<u32>, seed: u64) -> Self {
        Self {
            steps,
            seed,
            max_elements: MOST,
            threads: None,
        }
    }

    /// Returns a fractal with these options.
    fn apply(&self, fractal: &kfrac::Fractal) -> kfrac::Fractal {
        let mut fractal = fractal
            .clone()
            .seed(self.seed)
            .max_elements(self.max_elements);
        if let Some(steps) = self.steps {
            fractal = fractal.steps(steps);
        }
        if let Some(threads) = self.threads {
            fractal = fractal.threads(threads);
        }
        fractal
    }
}

impl Fractal {
    fn new(fractal: kfrac::Fractal, name: String) -> Self {
        Self {
            fractal,
            name,
            zoom: None,
            repetition: None,
        }
    }

    /// Reads a text that the library itself has written.
    pub(crate) fn read_text(py: Python<'_>, text: &str) -> PyResult<Self> {
        parse(py, text, "text", None)
    }

    /// Sets parameters: real numbers, or complex ones with two parts.
    fn set(mut self, py: Python<'_>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let Some(parameters) = parameters.filter(|it| !it.is_empty()) else {
            return Ok(self);
        };
        let mut settings: Vec<Setting> = Vec::new();
        for (name, value) in parameters {
            let name: String = name.extract()?;
            if let Ok(value) = value.cast::<PyComplex>() {
                let parts = [(".re", "real"), (".im", "imag")];
                for (suffix, part) in parts {
                    let part: f64 = value.getattr(part)?.extract()?;
                    settings.push((format!("{name}{suffix}").as_str(), part).into());
                }
            } else {
                let value: f64 = value.extract().map_err(|_| {
                    PyTypeError::new_err(format!("parameter '{name}' is no number"))
                })?;
                settings.push((name.as_str(), value).into());
            }
        }
        let fractal = self.fractal;
        self.fractal = quick(py, || Ok(fractal.set_all(settings)?))?;
        Ok(self)
    }

    /// Grows or draws for a long time.
    fn grown<T: Send + 'static>(
        &self,
        py: Python<'_>,
        growing: &Growing,
        work: impl FnOnce(kfrac::Fractal) -> Result<T, kfrac::Error> + Send + 'static,
    ) -> PyResult<T> {
        let fractal = growing.apply(&self.fractal);
        long(py, move |cancel: Arc<AtomicBool>| {
            Ok(work(fractal.cancel(cancel))?)
        })
    }
}

/// Options of pictures that methods share.
struct Drawing {
    size: Size,
    detail: Option<f64>,
    view: Option<View>,
}

impl Drawing {
    /// Checks the options: a detail is a length, and a view a rectangle of the plane, in place of a zoom.
    fn new(
        fractal: &Fractal,
        size: &SizeArgument,
        detail: Option<f64>,
        view: Option<[f64; 4]>,
    ) -> PyResult<Self> {
        if detail.is_some_and(|pixels| !(pixels > 0.0 && pixels.is_finite())) {
            return Err(PyValueError::new_err("a detail is a length above 0 pixels"));
        }
        if view.is_some() && fractal.zoom.is_some() {
            let message = "a view and a zoom each select what is shown";
            return Err(PyValueError::new_err(message));
        }
        let is_rectangle = |[x, y, width, height]: [f64; 4]| {
            [x, y, width, height].iter().all(|it| it.is_finite()) && width > 0.0 && height > 0.0
        };
        if view.is_some_and(|window| !is_rectangle(window)) {
            let message = "a view is (x, y, width, height), with sides above 0";
            return Err(PyValueError::new_err(message));
        }
        Ok(Self {
            size: size.size()?,
            detail,
            view: view.map(|window| View {
                window: Some(window),
                margin: Some(0.0),
            }),
        })
    }

    /// Returns a fractal with these options.
    fn apply(&self, fractal: kfrac::Fractal) -> kfrac::Fractal {
        let mut fractal = fractal.size(self.size);
        if let Some(pixels) = self.detail {
            fractal = fractal.detail(pixels);
        }
        if let Some(view) = self.view {
            fractal = fractal.view(view);
        }
        fractal
    }
}

#[pymethods]
impl Fractal {
    /// Name of the file, without folder and extension, or in the library.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// Kind of the file: `rule`, `ifs`, `instancing` or `lsystem`.
    #[getter]
    fn kind(&self) -> &'static str {
        self.fractal.model().kind().name()
    }

    /// Title of the file, if it has one.
    #[getter]
    fn title(&self) -> Option<&str> {
        let description = &self.fractal.model().metadata().description;
        description.title.as_deref()
    }

    /// Number of dimensions of the space in which it lies: 2 or 3.
    #[getter]
    fn space(&self) -> u8 {
        if self.fractal.model().is_in_space() {
            3
        } else {
            2
        }
    }

    /// Parameters with their values: real numbers, or complex ones.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        let parameters = &self.fractal.model().metadata().parameters;
        let mut parameters = parameters.iter().peekable();
        while let Some(parameter) = parameters.next() {
            // The imaginary part of a complex parameter follows its real part.
            match (parameter.name.strip_suffix(".re"), parameters.peek()) {
                (Some(name), Some(imaginary)) if imaginary.name == format!("{name}.im") => {
                    let complex = PyComplex::from_doubles(py, parameter.value, imaginary.value);
                    values.set_item(name, complex)?;
                    parameters.next();
                }
                _ => values.set_item(&parameter.name, parameter.value)?,
            }
        }
        Ok(values)
    }

    /// Returns the fractal with other values of parameters.
    ///
    /// Raises
    /// ------
    /// KfracError
    ///     If the file has no such parameter, or is not valid with these values.
    #[pyo3(signature = (**parameters))]
    fn with_(&self, py: Python<'_>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        self.clone().set(py, parameters)
    }

    /// Returns the fractal with its pictures magnified about a point, without a limit of magnification.
    ///
    /// Parameters
    /// ----------
    /// factor : str or float
    ///     Magnification relative to the whole: 250, "1e1000", "3^5000".
    /// at : str
    ///     Centre: an address such as "0.1.(2)", whose positions in brackets repeat without end, or a point "x,y" with any
    ///     number of digits.
    /// turn : float
    ///     Angle in degrees by which the set is turned about that point, counter-clockwise.
    #[pyo3(signature = (factor, at, turn=0.0))]
    fn zoom(&self, factor: &Bound<'_, PyAny>, at: &str, turn: f64) -> PyResult<Self> {
        let factor = factor.str()?.to_string();
        let target = ZoomTarget {
            factor: factor.parse().map_err(|error| mistake(&error))?,
            at: at.parse().map_err(|error| mistake(&error))?,
            turn,
        };
        if !turn.is_finite() {
            return Err(PyValueError::new_err("a turn is an angle in degrees"));
        }
        let mut zoomed = self.clone();
        zoomed.fractal = zoomed.fractal.zoom(Some(target));
        zoomed.zoom = Some((factor, at.to_owned(), turn));
        Ok(zoomed)
    }

    /// Returns the fractal with its pictures repeated under a wallpaper or frieze group. Of the default size and without a view,
    /// opposite edges of a PNG continue each other. Elements and numbers are those of the set itself, and a zoom draws no
    /// copies. Pictures of sets in space, and of more than 20,000 copies, are a `KfracError`.
    ///
    /// Parameters
    /// ----------
    /// group : str
    ///     Wallpaper group, `p1` to `p6m`, or frieze group, `frieze-p1` to `frieze-p2mm`.
    /// cell : float
    ///     Factor of the distance of copies, 0.01 to 1000; below 1 they may overlap.
    /// periods : int
    ///     Number of periods that a picture without a view shows along both axes, 1 to 100.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no such group, or a number is out of range.
    #[pyo3(signature = (group, *, cell=1.0, periods=1))]
    fn repeat(&self, group: &str, cell: f64, periods: u32) -> PyResult<Self> {
        let Some(known) = TilingGroup::from_name(group) else {
            let names: Vec<&str> = TilingGroup::NAMES.iter().map(|(name, _)| *name).collect();
            let message = format!("there is no group '{group}', but {}", names.join(", "));
            return Err(PyValueError::new_err(message));
        };
        if !Repetition::CELLS.contains(&cell) || !(1..=MOST_PERIODS).contains(&periods) {
            let (least, most) = Repetition::CELLS.into_inner();
            let message =
                format!("a cell is from {least} to {most}, and periods are 1 to {MOST_PERIODS}");
            return Err(PyValueError::new_err(message));
        }
        let repetition = Repetition::from(known).cell(cell).periods(periods);
        let mut repeated = self.clone();
        repeated.fractal = repeated.fractal.repeat(Some(repetition));
        repeated.repetition = Some((group.to_owned(), cell, periods));
        Ok(repeated)
    }

    /// Returns the elements of the approximant, infertile and invisible ones included, as a table.
    #[pyo3(signature = (steps=None, *, seed=0, max_elements=MOST, threads=None))]
    fn elements(
        &self,
        py: Python<'_>,
        steps: Option<u32>,
        seed: u64,
        max_elements: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<Table> {
        let growing = Growing {
            steps,
            seed,
            max_elements,
            threads,
        };
        let columns = self.grown(py, &growing, move |fractal| fractal.columns())?;
        Ok(Table::new(columns))
    }

    /// Returns the approximant as SVG; in space, its visible faces.
    #[pyo3(signature = (steps=None, *, size=SizeArgument::Long(1024), detail=None, view=None, seed=0, max_elements=MOST, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn svg(
        &self,
        py: Python<'_>,
        steps: Option<u32>,
        size: SizeArgument,
        detail: Option<f64>,
        view: Option<[f64; 4]>,
        seed: u64,
        max_elements: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<String> {
        let drawing = Drawing::new(self, &size, detail, view)?;
        let growing = Growing {
            steps,
            seed,
            max_elements,
            threads,
        };
        self.grown(py, &growing, move |fractal| drawing.apply(fractal).svg())
    }

    /// Returns the approximant as the bytes of a PNG.
    #[pyo3(signature = (steps=None, *, size=SizeArgument::Long(1024), detail=None, view=None, seed=0, max_elements=MOST, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn png<'py>(
        &self,
        py: Python<'py>,
        steps: Option<u32>,
        size: SizeArgument,
        detail: Option<f64>,
        view: Option<[f64; 4]>,
        seed: u64,
        max_elements: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let drawing = Drawing::new(self, &size, detail, view)?;
        let growing = Growing {
            steps,
            seed,
            max_elements,
            threads,
        };
        let png = self.grown(py, &growing, move |fractal| {
            drawing.apply(fractal).png(drawing.size)
        })?;
        Ok(PyBytes::new(py, &png))
    }

    /// Returns the approximant as pixels.
    ///
    /// Returns
    /// -------
    /// array of uint8, shape (height, width, 4)
    ///     Rows from the top: red, green, blue (sRGB) and opacity, which the colours are not multiplied by.
    #[pyo3(signature = (steps=None, *, size=SizeArgument::Long(512), detail=None, view=None, seed=0, max_elements=MOST, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn pixels<'py>(
        &self,
        py: Python<'py>,
        steps: Option<u32>,
        size: SizeArgument,
        detail: Option<f64>,
        view: Option<[f64; 4]>,
        seed: u64,
        max_elements: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let drawing = Drawing::new(self, &size, detail, view)?;
        let growing = Growing {
            steps,
            seed,
            max_elements,
            threads,
        };
        let (pixels, [width, height]) = self.grown(py, &growing, move |fractal| {
            let pixels = drawing.apply(fractal).pixels(drawing.size)?;
            let size = pixels.size();
            Ok((pixels.into_straight(), size))
        })?;
        let pixels: Bound<'py, PyArray1<u8>> = pixels.into_pyarray(py);
        pixels.reshape([height as usize, width as usize, 4])
    }

    /// Writes a picture (.svg, .png, .pdf, .dxf) or a table of elements (.csv, .json, .jsonl, .ndjson), by the extension of
    /// the file; in space also a mesh (.stl, .obj, .ply) or nested instances (.usda, .glb, .3mf, .pov). An existing file is
    /// replaced once the new one is complete.
    #[pyo3(signature = (path, steps=None, *, size=SizeArgument::Long(1024), detail=None, view=None, seed=0, max_elements=MOST, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        steps: Option<u32>,
        size: SizeArgument,
        detail: Option<f64>,
        view: Option<[f64; 4]>,
        seed: u64,
        max_elements: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<()> {
        let drawing = Drawing::new(self, &size, detail, view)?;
        let growing = Growing {
            steps,
            seed,
            max_elements,
            threads,
        };
        self.grown(py, &growing, move |fractal| {
            drawing.apply(fractal).write(path)
        })
    }

    /// Counts the points of random iteration (the chaos game) in the pixels of the attractor's box, or of the window of the
    /// file. For systems of maps of the plane (`kind: ifs`).
    ///
    /// Returns
    /// -------
    /// array of uint32, shape (height, width)
    ///     Number of points in each pixel, in rows from the top. It does not depend on the number of threads.
    #[pyo3(signature = (points=10_000_000, size=SizeArgument::Long(512), *, seed=0, threads=None))]
    fn histogram<'py>(
        &self,
        py: Python<'py>,
        points: u64,
        size: SizeArgument,
        seed: u64,
        threads: Option<NonZero<usize>>,
    ) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let size = size.size()?;
        let growing = Growing {
            steps: None,
            seed,
            max_elements: MOST,
            threads,
        };
        let counted = self.grown(py, &growing, move |fractal| fractal.histogram(points, size))?;
        let [width, height] = counted.size();
        let counts = PyArray1::from_slice(py, counted.counts(0));
        counts.reshape([height as usize, width as usize])
    }

    /// Returns the properties that are known without growing it.
    ///
    /// Returns
    /// -------
    /// dict
    ///     `name`, `kind`, `space`, `title`, `parameters`; `steps`; `random`, whether it draws numbers; `regular`; `elements`,
    ///     `fertile`, `fractals`, `length`, `area`, `volume`: lists of the approximants 0 to `steps`, or None; `bounds` and
    ///     `limit_bounds`, or None; `similarity_dimension` with its `note`; `dimension`, exact or None, with
    ///     `dimension_bound`. Lengths are in the file's units.
    #[pyo3(signature = (steps=None, *, seed=0))]
    fn info<'py>(
        &self,
        py: Python<'py>,
        steps: Option<u32>,
        seed: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let growing = Growing::steps(steps, seed);
        let info = self.grown(py, &growing, move |fractal| fractal.info())?;
        let all = PyDict::new(py);
        all.set_item("name", &self.name)?;
        all.set_item("kind", self.kind())?;
        all.set_item("space", self.space())?;
        all.set_item("title", self.title())?;
        all.set_item("parameters", self.parameters(py)?)?;
        all.set_item("steps", info.steps)?;
        all.set_item("random", info.is_random)?;
        all.set_item("regular", info.is_regular)?;
        let levels = info.levels.as_deref();
        type Counted = fn(&kfrac::graph::Level) -> &kfrac::Count;
        let counts: [(&str, Counted); 3] = [
            ("elements", |level| &level.elements),
            ("fertile", |level| &level.fertile),
            ("fractals", |level| &level.fractals),
        ];
        for (name, count) in counts {
            let numbers = levels.map(|levels| levels.iter().map(|it| whole(py, count(it))));
            let numbers: Option<Vec<_>> =
                numbers.map(Iterator::collect::<PyResult<_>>).transpose()?;
            all.set_item(name, numbers)?;
        }
        type Measure = fn(&kfrac::graph::Level) -> Option<f64>;
        let measures: [(&str, Measure); 3] = [
            ("length", |level| level.length),
            ("area", |level| level.area),
            ("volume", |level| level.volume),
        ];
        for (name, measure) in measures {
            let numbers = levels.map(|levels| levels.iter().map(measure).collect::<Vec<_>>());
            all.set_item(name, numbers)?;
        }
        for (name, corners) in [("bounds", info.bounds), ("limit_bounds", info.limit_bounds)] {
            let bounds = corners.map(|corners| bounds(py, corners)).transpose()?;
            all.set_item(name, bounds)?;
        }
        all.set_item("similarity_dimension", info.similarity.value)?;
        all.set_item("note", info.similarity.note)?;
        let exact = info.dimension.as_ref();
        let known = exact.and_then(|exact| exact.value.map(|value| (value, &exact.closed_form)));
        let known = known
            .map(|(value, form)| named(py, "Dimension", (value, None::<f64>, form.as_deref())));
        all.set_item("dimension", known.transpose()?)?;
        all.set_item("dimension_bound", exact.and_then(|exact| exact.upper_bound))?;
        Ok(all)
    }

    /// Returns the sizes of an approximant without growing it, as `Forecast`: a named tuple of `elements`, `fertile`,
    /// `fractals` (whole numbers of any size), `length` and `area` in the file's units. None if they depend on draws.
    #[pyo3(signature = (steps=None, *, seed=0))]
    fn forecast<'py>(
        &self,
        py: Python<'py>,
        steps: Option<u32>,
        seed: u64,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let level = quick(py, || {
            let fractal = Growing::steps(steps, seed).apply(&self.fractal);
            Ok(match fractal.model().is_in_space() {
                true => fractal.forecast_in_space()?.map(|it| it.level()),
                false => fractal.forecast()?.map(|it| it.level()),
            })
        })?;
        let forecast = level.map(|it| {
            let counts = [&it.elements, &it.fertile, &it.fractals];
            let [elements, fertile, fractals] = counts.map(|count| whole(py, count));
            let values = (elements?, fertile?, fractals?, it.length, it.area);
            named(py, "Forecast", values)
        });
        forecast.transpose()
    }

    /// Returns the dimension of the limit set as `Dimension`: a named tuple of `value`, `std_error` (None if it is exact) and
    /// `closed_form` (None if there is none). An exact one is the Hausdorff dimension, a measured one the box dimension.
    fn dimension<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let growing = Growing::steps(None, 0);
        let found = self.grown(py, &growing, move |fractal| fractal.dimension())?;
        named(
            py,
            "Dimension",
            (found.value, found.std_error, found.closed_form),
        )
    }

    /// Returns the box of the approximant in the file's units as `Bounds`: a named tuple of `min` and `max`, (x, y) or
    /// (x, y, z); y points up.
    #[pyo3(signature = (steps=None, *, seed=0))]
    fn bounds<'py>(
        &self,
        py: Python<'py>,
        steps: Option<u32>,
        seed: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let growing = Growing::steps(steps, seed);
        let is_in_space = self.fractal.model().is_in_space();
        let corners = self.grown(py, &growing, move |fractal| {
            Ok(match is_in_space {
                true => {
                    let found = fractal.bounds_in_space()?;
                    [
                        found.min().to_array().to_vec(),
                        found.max().to_array().to_vec(),
                    ]
                }
                false => {
                    let found = fractal.bounds()?;
                    [
                        found.min().to_array().to_vec(),
                        found.max().to_array().to_vec(),
                    ]
                }
            })
        })?;
        bounds(py, corners)
    }

    /// Returns the warnings about the file, and mistakes that show only where elements are replaced, as named tuples
    /// `Diagnostic` of `file`, `line`, `column`, `severity`, `message` and `hint`.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let found = quick(py, || Ok(self.fractal.check()))?;
        listed(py, &found)
    }

    /// Returns the file with its parents and components inlined, and with the present values of its parameters, as YAML that
    /// `parse` reads as an equal fractal.
    fn yaml(&self, py: Python<'_>) -> PyResult<String> {
        let none = || Failure::Message("it has no file".into());
        quick(py, || self.fractal.yaml().ok_or_else(none))
    }

    /// Returns the Hausdorff distance from another fractal as `Distance`: a named tuple of `value`, `error`, `there`, `back`,
    /// in the unit of the files, and `same`, whether the distance is within its error.
    ///
    /// Parameters
    /// ----------
    /// other : Fractal
    /// steps : int, optional
    ///     Compares the approximants of this step; by default the limit sets.
    /// tolerance : float
    ///     Error of the distance, as a fraction of the larger set.
    #[pyo3(signature = (other, *, steps=None, tolerance=1e-3))]
    fn compare<'py>(
        &self,
        py: Python<'py>,
        other: &Self,
        steps: Option<u32>,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        if !(1e-9..=1.0).contains(&tolerance) {
            return Err(PyValueError::new_err("a tolerance lies from 1e-9 to 1"));
        }
        let precision = Precision {
            tolerance,
            ..Precision::default()
        };
        let other = other.fractal.clone();
        let found = self.grown(py, &Growing::steps(None, 0), move |fractal| {
            fractal.compare(&other, steps, &precision)
        })?;
        let values = (
            found.value(),
            found.error,
            found.there,
            found.back,
            found.may_be_same(),
        );
        named(py, "Distance", values)
    }

    fn __repr__(&self) -> String {
        let parameters = &self.fractal.model().metadata().parameters;
        let values = parameters
            .iter()
            .map(|it| format!(", {}={}", it.name, it.value));
        format!(
            "<kfrac.Fractal '{}': {}{}>",
            self.name,
            self.kind(),
            values.collect::<String>()
        )
    }

    /// Shows the fractal in a notebook: as SVG if it is estimated to have less than 300 kB, otherwise as PNG.
    #[pyo3(signature = (include=None, exclude=None))]
    fn _repr_mimebundle_<'py>(
        &self,
        py: Python<'py>,
        include: Option<&Bound<'py, PyAny>>,
        exclude: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let _ = (include, exclude);
        const SIZE: u32 = 512;
        let growing = Growing::steps(None, 0);
        let has_no_estimate = self.zoom.is_some() || self.repetition.is_some();
        let (svg, png) = self.grown(py, &growing, move |fractal| {
            let fractal = fractal.size(SIZE);
            let estimate = if has_no_estimate {
                None
            } else {
                fractal.estimate()?
            };
            Ok(match estimate.is_some_and(|it| it.svg_bytes < NOTEBOOK) {
                true => (Some(fractal.svg()?), None),
                false => (None, Some(fractal.png(SIZE)?)),
            })
        })?;
        let bundle = PyDict::new(py);
        bundle.set_item("text/plain", self.__repr__())?;
        if let Some(svg) = svg {
            bundle.set_item("image/svg+xml", svg)?;
        }
        if let Some(png) = png {
            bundle.set_item("image/png", PyBytes::new(py, &png))?;
        }
        Ok(bundle)
    }

    /// Pickles the fractal as the text of its file.
    #[expect(clippy::type_complexity, reason = "as pickle takes it")]
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyAny>,
        (
            String,
            &str,
            Option<(String, String, f64)>,
            Option<(String, f64, u32)>,
        ),
    )> {
        let restore = py.import("kfrac._results")?.getattr("restore")?;
        let (zoom, repetition) = (self.zoom.clone(), self.repetition.clone());
        Ok((restore, (self.yaml(py)?, &self.name, zoom, repetition)))
    }
}

fn mistake(error: &impl std::fmt::Display) -> PyErr {
    Python::attach(|py| Failure::of(error).into_exception(py))
}

/// Returns a box as a named tuple of tuples.
fn bounds(py: Python<'_>, [min, max]: [Vec<f64>; 2]) -> PyResult<Bound<'_, PyAny>> {
    let corner = |values: Vec<f64>| pyo3::types::PyTuple::new(py, values);
    named(py, "Bounds", (corner(min)?, corner(max)?))
}
