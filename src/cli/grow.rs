//! `kfrac grow`: draws a rule as a picture or lists its elements as a table.

mod batch;
mod drawing;
mod morphed;
mod plan;
mod plot;
mod pyramid;
mod runs;
mod scene;
mod space;
mod svg;
mod table;
mod tile;
mod visible;
mod watching;
mod zoom;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::fractal::Goal;
use crate::metadata::Metadata;
use crate::render;
use crate::style::{Named, View};

use super::camera::{self, SpaceArguments};
use super::chaos::{ChaosArguments, GameArguments, PlaneGame};
use super::growth::GrowthArguments;
use super::held::{self, Held};
use super::length::{self, Paper};
use super::picture::{self, PictureArguments};
use super::rule::{Loaded, RuleArguments};
use super::tween::TweenArguments;
use super::{Failure, format, help, input, number, output, readable, redrawn, steps, text};
use drawing::Drawing;
use morphed::MorphArguments;
use plan::{Format, Plan};
use plot::PlotArguments;
use pyramid::PyramidArguments;
pub(super) use runs::Runs;
use scene::SceneArguments;
use svg::SvgArguments;
use tile::TileArguments;
use zoom::ZoomArguments;

/// Grows a rule and draws it, or lists its elements
///
/// Replaces the fertile elements for a number of steps and writes the result, the approximant, as a picture
/// or a table. The output file appears complete or not at all.
#[derive(clap::Args, Clone)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    #[command(flatten)]
    tween: TweenArguments,
    /// Number of steps: how often fertile elements are replaced [default: from the rule]
    ///
    /// If the rule gives no number, the default is the deepest step up to 12 with no more than 20,000
    /// elements. Without --steps, --detail and --max-elements, an SVG is limited to 50,000 elements and 2 MB:
    /// beyond that, it is drawn with fewer steps or a coarser detail, and a note reports it. Several numbers, as 0..6 or 0,2,4, are a picture each.
    #[arg(long, short, value_name = "N", value_parser = steps::parse_several, allow_negative_numbers = true)]
    steps: Option<steps::Several>,
    /// Draws the last step while it grows out of the one before, at a share of its way from 0 to 1
    ///
    /// At 0, elements lie on the ones that they replace, or grow out of points; at 1, they are in their places.
    #[arg(long, value_name = "SHARE", requires = "steps", value_parser = number::share, allow_negative_numbers = true)]
    between: Option<f64>,
    /// Draws a picture up to a share of the length of its outlines, from 0 to 1, as a pen draws them
    ///
    /// Colour after colour, and in a colour along the elements; with --plot in the order of the plot.
    #[arg(long, value_name = "SHARE", value_parser = number::share, allow_negative_numbers = true)]
    drawn: Option<f64>,
    /// Stops replacing elements that are smaller than this number of pixels
    ///
    /// Without --steps, growth continues until all elements are smaller. L-systems that start anew at every
    /// step are the exception: they are grown by the number of steps in their file. Applies to pictures only.
    #[arg(long, value_name = "PX", value_parser = picture::pixels, allow_negative_numbers = true)]
    detail: Option<f64>,
    /// Output file, or - for standard output [default: NAME.svg]
    ///
    /// An existing file is replaced. Names of several pictures contain %s for the seed, %n for the number of steps and %{NAME}
    /// for the value of a parameter; %03s has at least three digits, and %% is a percent sign.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<Format>())]
    format: Option<Format>,
    /// Number of values in a range --set NAME=FROM..TO, each of which is a picture
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = number::whole("a number of values", 2..=10_000u32), allow_negative_numbers = true)]
    samples: u32,
    #[command(flatten)]
    growth: GrowthArguments,
    /// Writes the output again whenever the rule, or a file that it uses, changes; Ctrl-C ends it
    #[arg(long)]
    watch: bool,
    /// Opens the output in the program that the system has for such files
    #[arg(long)]
    open: bool,
    /// Long side of the picture, WIDTHxHEIGHT, or a paper: 1024, 200mm, 21cmx29.7cm, 8.5inx11in, a4, a3-landscape
    ///
    /// The other side follows from the shape. If both sides are given, the shape is fitted into them. A PNG
    /// of more than 17 million pixels is drawn in bands, in less than 300 MB of memory. PNG does not support lengths and
    /// papers (a0 to a6, b4, b5, letter, legal, tabloid; upright, or -landscape). With these, and in PDF and the formats
    /// of plotters always, a pixel is 1/96 inch. Sides have up to a million pixels, and with --tiles up to 2³⁰.
    #[arg(long, value_name = "SIZE", default_value = "1024", value_parser = length::paper_or_tiles)]
    #[arg(help_heading = "Picture")]
    size: Paper,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    svg: SvgArguments,
    #[command(flatten)]
    zoom: ZoomArguments,
    /// Turn a set of the plane about the origin, or a zoom about its centre, counter-clockwise
    ///
    /// --view is a window of the set that is turned. Sets in space turn with --from and --up.
    #[arg(long, value_name = "DEGREES", value_parser = number::degrees, allow_hyphen_values = true)]
    #[arg(help_heading = "Picture")]
    turn: Option<f64>,
    #[command(flatten)]
    tile: TileArguments,
    #[command(flatten)]
    pyramid: PyramidArguments,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    space: SpaceArguments,
    /// Also write the depths of the pixels of a set in space, as a grey PNG of 16 bits
    ///
    /// 65535 at the nearest point of the set, falling linearly to 1 at its farthest; 0 where nothing is shown.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Space")]
    depth: Option<PathBuf>,
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    chaos: ChaosArguments,
    #[command(flatten)]
    morphed: MorphArguments,
}

const MORE: &str = "\
Examples:
  kfrac grow pythagoras --steps 8
      Draws the Pythagoras tree after eight steps, into pythagoras.svg
  kfrac grow pythagoras --set angle=30 -o oblique.svg
      Sets a parameter of the rule (kfrac info pythagoras lists them) and names the file
  kfrac grow mine.yaml --stroke teal --stroke-width 2 --background white
      Draws a rule from a file in the given colours
  kfrac grow koch --steps 7 --size 3000 -o koch.png
      Writes a PNG, 3000 pixels wide
  kfrac grow dragon --color-by index --palette sunset
      Colours the elements along the curve
  kfrac grow koch --view 0,0,0.4,0.2 --size 800x400
      Draws a window of the plane
  kfrac grow koch-snowflake --detail 0.5 -o koch.png
      Replaces elements until they are smaller than half a pixel
  kfrac grow koch-snowflake --detail 1 --size 60000 -o wall.png
      Draws a picture that is larger than the memory
  kfrac grow koch --view 0.499999,0.288673,2e-6,2e-6 --detail 1
      Draws a small window; elements outside of it are not grown
  kfrac grow koch --zoom 1e1000 --at '0.1.(2)' -o deep.png
      Magnifies the neighbourhood of a point by a factor of 1e1000; the address of the point is
      a position in the initiator, then positions in the generator, those in brackets repeated
      without end
  kfrac grow dragon --detail 1 --size 30000 --tiles dragon
      Draws tiles of a picture at all scales, and a page that shows them
  kfrac grow random-tree --seed 7
      Draws another random tree of the same rule
  kfrac grow random-tree --seed 1..9 -o 'tree-%s.png'
      Draws nine random trees, into tree-1.png to tree-9.png
  kfrac grow pythagoras --set angle=20..70 --samples 6 --steps 8,10 -o 'p-%{angle}-%02n.svg'
      Draws a picture for each of six angles and two numbers of steps
  kfrac grow levy --steps 10 --plot --size 200mm --stroke-width 0.3mm
      Draws single strokes for a pen plotter, 200 mm wide, with no line drawn twice
  kfrac grow koch-snowflake --size 100mm -o flake.dxf
      Writes outlines for a cutter; for paper, write a .pdf
  kfrac grow hilbert --size a4 --margin 1cm --pen-down M3S90 --pen-up M3S0 -o hilbert.gcode
      Writes G-code for a drawing machine whose pen is moved by a servo; plotters read .hpgl
  kfrac grow koch --steps 200 --svg instanced -o koch.svg
      Writes 4^200 elements as a small file of nested instances
  kfrac grow mine.yaml --watch --open
      Opens the picture, and draws it again whenever the file is saved
  kfrac grow koch.png --size 4000 -o large.png
      Grows again what a picture holds: its rule, with its options unless others are given
  kfrac grow koch --steps 4 --format csv -o - | head
      Lists the first elements as CSV
  kfrac grow barnsley-fern --method chaos --points 1M --color-by hits
      Draws an iterated function system by random iteration, into barnsley-fern.png
  kfrac grow maple-leaf --method chaos --morph close:2,open:3 -o leaf.png
      Fills gaps between the points of a picture, and removes what is thin
  kfrac grow dragon --tile p4g -o tile.png
      Repeats a set by the wallpaper group p4g, and draws one period, which continues itself at its edges
  kfrac grow menger --from 35,20 --perspective 40 -o menger.png
      Draws a set in space, to the pixel
  kfrac grow menger --method chaos --points 20M -o menger.png
      Draws points of the same set by random iteration
  kfrac grow menger --points 2M -o menger.ply
      Writes points with colours and normals for other programs
  kfrac grow menger --steps 60 -o menger.usda
      Writes 20^60 cubes as a small scene of nested instances for other programs
  kfrac grow menger --steps 4 --size 80mm -o menger.3mf
      Writes 160,000 cubes as components for a printer; a .glb is for viewers, a .pov for POV-Ray
  kfrac grow menger --steps 3 --mesh shell -o menger.stl
      Writes the surface of 8,000 cubes for a printer
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let pictures = batch::pictures(arguments)?;
    let [arguments] = &pictures[..] else {
        return batch::run(&pictures, catalogue);
    };
    let plan = Plan::of(arguments)?;
    let is_file = arguments.output.as_deref() != Some(Path::new("-"));
    if !is_file && (arguments.watch || arguments.open) {
        let message = "--watch and --open are for files, and the output is standard output";
        return Err(Failure::Usage(message.into()));
    }
    if arguments.watch {
        return watching::run(arguments, &plan, catalogue);
    }
    let path = arguments.run_once(&plan, catalogue, &mut Vec::new())?;
    if arguments.open {
        watching::open(&path)?;
    }
    Ok(())
}

/// Runs the command with the given arguments and the text of its rule, and returns a summary of one line. Standard
/// output and messages go to `held`.
///
/// # Errors
///
/// As for the command.
pub(crate) fn hold(
    arguments: &[String],
    source: &Arc<Source>,
    catalogue: &Catalogue,
    held: Arc<Held>,
) -> Result<String, Failure> {
    let mut arguments: Arguments = held::parsed("grow", arguments)?;
    arguments.growth.held = Some(held);
    let plan = Plan::of(&arguments)?;
    let document = Arc::new(input::document(source, catalogue)?);
    let loaded = arguments.resolve(document, catalogue, true)?;
    let (_, summary, _) = arguments.grow(&plan, loaded)?;
    Ok(summary)
}

impl Arguments {
    /// Returns the command line that grows again what a picture holds, with the options of the line that is given;
    /// `None` unless the rule is a picture.
    pub(super) fn again(&self, given: &[OsString]) -> Option<Result<Vec<OsString>, Failure>> {
        let settings = self
            .rule
            .set
            .iter()
            .map(|setting| setting.name().to_owned());
        redrawn::command(
            &self.rule.rule,
            given,
            &settings.collect::<Vec<_>>(),
            self.steps.is_some() || self.detail.is_some(),
            self.output.is_some() || self.format.is_some() || self.pyramid.is_asked(),
        )
    }

    /// Returns whether a set in space is drawn as polygons or lines. Without a file or a format, it is drawn as pixels.
    fn draws_faces(&self, format: render::Format) -> bool {
        let is_asked = self.format.is_some() || self.names_file();
        self.plot.is_asked() || is_asked && format != render::Format::Png
    }

    /// Returns whether a file is named, other than standard output.
    fn names_file(&self) -> bool {
        { self.output.as_deref() }.is_some_and(|path| path != Path::new("-"))
    }

    /// Returns whether a PLY file is requested.
    fn is_ply(&self) -> bool {
        let format = format::choose(self.format, self.output.as_deref());
        (self.format.is_some() || self.names_file()) && matches!(format, Ok(Format::PLY))
    }

    /// Returns whether random iteration is requested: for a PLY file, also by a number of points.
    fn draws_points(&self) -> bool {
        self.chaos.is_asked() || (self.chaos.has_points() && self.is_ply())
    }

    /// Returns the number of steps, if one is given.
    fn steps(&self) -> Option<u32> {
        self.steps.as_ref().map(steps::Several::first)
    }

    /// Resolves the rule of one picture after it has been read.
    fn resolve(
        &self,
        document: Arc<Document>,
        catalogue: &Catalogue,
        quiet: bool,
    ) -> Result<Loaded, Failure> {
        self.growth.refuse_several_seeds()?;
        if let Some(steps) = self.steps.as_ref().filter(|steps| steps.is_plural()) {
            let message = format!("--steps {steps}: a single number of steps is expected");
            return Err(Failure::Usage(message));
        }
        let settings = self.rule.settings()?;
        let loaded = self.rule.resolve(document, settings, quiet)?;
        self.tween.apply(loaded, catalogue, quiet)
    }

    /// Reads the rule and writes the output once; returns its path. `files` become those that the rule consists of.
    fn run_once(
        &self,
        plan: &Plan,
        catalogue: &Catalogue,
        files: &mut Vec<PathBuf>,
    ) -> Result<PathBuf, Failure> {
        let start = Instant::now();
        let document = self.rule.document(catalogue)?;
        let loaded = self.resolve(document, catalogue, self.growth.quiet)?;
        *files = loaded.paths();
        let (path, summary, bytes) = self.grow(plan, loaded)?;
        self.report(&path, &summary, bytes, start);
        Ok(path)
    }

    /// Writes what the plan asks for, or what the file has drawn where the command line is silent; returns the path, a summary
    /// and the number of bytes.
    fn grow(&self, plan: &Plan, loaded: Loaded) -> Result<(PathBuf, String, u64), Failure> {
        match plan::of_file(self, loaded.model.metadata().density) {
            Some((arguments, plan)) => arguments.write(&plan, loaded),
            None => self.write(plan, loaded),
        }
    }

    fn write(&self, plan: &Plan, mut loaded: Loaded) -> Result<(PathBuf, String, u64), Failure> {
        if !self.draws_points() {
            self.chaos.check(&self.picture, true)?;
        }
        if let (Some(share), Some(steps)) = (self.between, self.steps()) {
            loaded.model = loaded.model.between(steps, share);
        }
        if loaded.model.is_in_space() {
            self.tile.refuse_in_space(&loaded)?;
            self.pyramid.refuse_in_space(&loaded)?;
            let loaded = loaded.grown(&self.growth);
            if self.scene.is_asked() && !matches!(plan, Plan::Scene(_)) {
                return Err(scene::mesh_of_none());
            }
            if let Plan::Scene(_) | Plan::Table(_) | Plan::Chaos(Some(_)) | Plan::Cloud = plan {
                let has_camera = matches!(plan, Plan::Scene(format) if format.has_camera());
                self.space.refuse_for_elements(has_camera)?;
            }
            return match *plan {
                Plan::Scene(format) => scene::write(self, &loaded, format),
                Plan::Picture { format, .. } if self.draws_faces(format) => {
                    visible::draw(self, &loaded, format)
                }
                _ => space::draw(self, &loaded, plan),
            };
        }
        self.space.refuse_in_plane(&loaded)?;
        if self.depth.is_some() {
            return Err(camera::in_plane("depth", &loaded));
        }
        if self.pyramid.is_asked() {
            return pyramid::write(self, loaded.turned(self.turn));
        }
        let default = self.rule.file("", plan.extension());
        let path = self.output.as_ref().unwrap_or(&default);
        let (summary, bytes) = self.grow_in_plane(plan, loaded, path)?;
        Ok((path.clone(), summary, bytes))
    }

    /// Writes what the plan asks for of a set in the plane; returns a summary and the number of bytes.
    fn grow_in_plane(
        &self,
        plan: &Plan,
        loaded: Loaded,
        path: &Path,
    ) -> Result<(String, u64), Failure> {
        match plan {
            Plan::Table(format) => {
                let loaded = loaded.grown(&self.growth).turned(self.turn);
                self.list(loaded, *format, path)
            }
            Plan::Picture {
                format,
                shown,
                is_light,
            } => {
                self.zoom.check_in_plane(self.between.is_some())?;
                let loaded = loaded.turned(self.turn);
                Drawing::new(self, loaded, *format, shown, path)?.write(*is_light)
            }
            Plan::Chaos(_) if self.zoom.is_asked() => {
                Err(Failure::Usage(plan::NO_ZOOM_OF_POINTS.into()))
            }
            Plan::Chaos(_) if self.turn.is_some() => {
                let message = "--turn is for elements, and random iteration draws points";
                Err(Failure::Usage(message.into()))
            }
            Plan::Chaos(table) => {
                let copies = self.copies(&loaded, Goal::Detail(1.0))?;
                let mut view = self.view(loaded.model.metadata());
                let (mut size, mut images) = (self.size.size, None);
                if let Some(copies) = &copies {
                    (view.window, size) = (Some(copies.window), copies.size);
                    images = Some(&copies.images[..]);
                }
                let game = PlaneGame::new(self.game(), &loaded, view, images)?;
                self.write_picture(path, |out, progress| match table {
                    Some(format) => game.list(*format, progress, out, path),
                    None => game.draw(size, self.tile.options(), progress, out, path),
                })
            }
            Plan::Scene(format) => {
                let message = format!(
                    "a .{} holds elements in space, and {} lies in the plane: write a .svg, .png, .pdf or .dxf",
                    Format::Scene(*format).name(),
                    loaded.name
                );
                Err(Failure::Usage(message))
            }
            Plan::Cloud => Err(Failure::Usage(format!(
                "a .ply holds points in space, and {} lies in the plane: write a .csv of its points",
                loaded.name
            ))),
        }
    }

    /// Returns the arguments of random iteration.
    fn game(&self) -> GameArguments<'_> {
        GameArguments {
            chaos: &self.chaos,
            growth: &self.growth,
            picture: &self.picture,
            steps: self.steps(),
            seed: self.growth.seed.first(),
        }
    }

    /// Returns the turn, and the shares of the last step and of the pen's way, with their values where they are given.
    fn own_options(&self) -> Vec<(&'static str, String)> {
        let all = [
            ("turn", self.turn),
            ("between", self.between),
            ("drawn", self.drawn),
        ];
        let given = all.into_iter();
        given
            .filter_map(|(name, value)| Some((name, value?.to_string())))
            .chain(self.tile.options())
            .chain(self.pyramid.options())
            .collect()
    }

    /// Prints what has been written, unless messages are suppressed.
    fn report(&self, path: &Path, summary: &str, bytes: u64, start: Instant) {
        if !self.growth.quiet {
            text::print_message(&format!(
                "{}: {summary}, {}, {:.2} s",
                output::called(path),
                readable::bytes(bytes),
                start.elapsed().as_secs_f64(),
            ));
        }
    }

    /// Returns the view of the picture. That of a file shows its set, and none of the copies.
    fn view(&self, metadata: &Metadata) -> View {
        match self.tile.is_asked() {
            true => self.picture.view_in(&Metadata::default(), self.size.unit),
            false => self.picture.view_in(metadata, self.size.unit),
        }
    }
}
