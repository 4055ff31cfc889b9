//! Interpretation of a word of modules whose effects are known.

use std::borrow::Cow;

use crate::draws::Path;
use crate::geometry::{Frame2, Point as _};
use crate::instancing::Thickness;
use crate::lsystem::{Action, Axis, LSystem, TurtleFrame};

use super::NotCompiled;
use super::effects::{Effect, Effects, ModuleDrawing};
use super::far::Far;
use super::state::{Joint, Pose, Shade, StrokeAttributes, Tip, TurtleState};

/// DrawnPart of the drawing of a word.
#[derive(Clone, Debug)]
pub(super) struct DrawnPart<F: TurtleFrame = Frame2> {
    /// Position of the module that draws it.
    pub(super) position: u32,
    pub(super) of: Of<F>,
    /// Pose of the turtle where it starts.
    pub(super) pose: Pose<F>,
    pub(super) attributes: StrokeAttributes,
    pub(super) joint: Joint,
    /// Whether it continues the stroke of the part before, as far as the word determines this.
    pub(super) joined: bool,
}

/// Content of a part.
#[derive(Clone, Debug)]
pub(super) enum Of<F: TurtleFrame = Frame2> {
    /// Line of one step.
    Step {
        /// Whether the module is replaced in the next step.
        fertile: bool,
    },
    /// Polygon, by its vertices in steps.
    Polygon(Vec<F::Point>),
    /// Stamp of the system, by number.
    Stamp(usize),
    /// Subtree of a kind.
    Subtree(usize, ModuleDrawing<F>),
}

impl<F: TurtleFrame> DrawnPart<F> {
    /// Returns a bound on the distance of its points from its start, apart from those of stamps.
    fn reach(&self) -> Far<F::Point> {
        let steps = match &self.of {
            Of::Step { .. } | Of::Stamp(_) => Far::of_length(1.0),
            Of::Polygon(vertices) => {
                let farthest = vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
                // A polygon without extent is drawn as a line.
                Far::of_length(if farthest > 0.0 { farthest } else { 1.0 })
            }
            Of::Subtree(_, drawn) => drawn.reach,
        };
        steps.times(self.pose.scale).length()
    }
}

/// OpenPolygon polygon.
struct OpenPolygon<F: TurtleFrame> {
    state: TurtleState<F>,
    vertices: Vec<Far<F::Point>>,
}

/// Limit of the number of vertices of polygons.
const MAX_VERTICES: usize = 1 << 16;

/// Limit of the number of modules inside the polygons of a word, after words have been expanded.
const MAX_EXPANDED: u64 = 1 << 18;

/// Limit of the depth to which words inside polygons are expanded.
const DEEPEST: u32 = 1000;

/// Interpreter of a word.
pub(super) struct Reader<'e, F: TurtleFrame = Frame2> {
    effects: &'e Effects<F>,
    /// Whether the drawing is that of one path; otherwise it bounds those of all paths.
    draws: bool,
    /// TurtleState of the turtle relative to the beginning of the word.
    pub(super) state: TurtleState<F>,
    saved: Vec<TurtleState<F>>,
    open: Vec<OpenPolygon<F>>,
    /// The number of states that were saved where the branch was cut off, if it was.
    cut: Option<usize>,
    vertices: usize,
    pub(super) parts: Vec<DrawnPart<F>>,
    /// Whether the pen has stayed down since the last part or, before the first, since the beginning.
    down: bool,
    /// Attributes of the first line.
    first: Option<StrokeAttributes>,
    /// Attributes of the last line; before the first, those at the beginning.
    last: StrokeAttributes,
    /// Whether the first part may continue the stroke before the word.
    starts: bool,
    /// Whether the word is certain to draw something.
    is_sure: bool,
    /// Whether the state after the next module matters.
    leads: bool,
    /// Whether nothing depends on draws.
    is_exact: bool,
    /// Number of modules that have been read.
    work: u64,
    /// Number of modules of expanded words inside polygons.
    pub(super) expanded: u64,
}

impl<'e, F: TurtleFrame> Reader<'e, F> {
    pub(super) fn new(effects: &'e Effects<F>, state: TurtleState<F>, draws: bool) -> Self {
        Self {
            effects,
            draws,
            is_sure: false,
            leads: true,
            is_exact: true,
            work: 0,
            expanded: 0,
            state,
            saved: Vec::new(),
            open: Vec::new(),
            cut: None,
            vertices: 0,
            parts: Vec::new(),
            down: true,
            first: None,
            last: state.attributes,
            starts: true,
        }
    }

    /// Reads a word whose modules are to be replaced for `left` more steps.
    pub(super) fn read(
        &mut self,
        word: &[usize],
        left: u32,
        path: Path,
    ) -> Result<(), NotCompiled> {
        let mut rest = word.iter();
        let mut position = 0;
        while let Some(&kind) = rest.next() {
            // A closing bracket discards the state after the module before it.
            self.leads = !rest
                .clone()
                .next()
                .is_some_and(|&next| self.effects.pops(next));
            self.module(kind, left, path.child(position), position)?;
            position += 1;
        }
        Ok(())
    }

    fn module(
        &mut self,
        kind: usize,
        left: u32,
        path: Path,
        position: u32,
    ) -> Result<(), NotCompiled> {
        let effects = self.effects;
        let of = &effects.kinds.all[kind];
        self.work = self.work.saturating_add(1);
        if left == 0 || !of.is_fertile() {
            let meaning = &effects.words().symbols()[of.symbol].meaning;
            let mut actions = meaning.iter();
            return actions.try_for_each(|action| {
                if !self.stays(action)? {
                    return Ok(());
                }
                self.act(
                    action,
                    &of.arguments,
                    left == 0 && of.is_fertile(),
                    position,
                )
            });
        }
        if self.cut.is_some() {
            return Ok(());
        }
        if self.open.is_empty() {
            let known = effects.of(kind, left)?;
            let effect = if self.draws && (self.leads || !known.is_sure) {
                effects.of_path(kind, left, path)?
            } else {
                Cow::Borrowed(known)
            };
            self.subtree(kind, &effect, position);
            return Ok(());
        }
        // Modules inside a polygon contribute vertices: their words are expanded.
        if left > DEEPEST || of.alternatives.len() > 1 {
            return Err(NotCompiled);
        }
        let word = &of.alternatives[of.drawn(path)].word;
        self.expanded += word.len() as u64;
        if self.expanded > MAX_EXPANDED {
            return Err(NotCompiled);
        }
        for (inner, &kind) in (0..).zip(word) {
            self.module(kind, left - 1, path.child(inner), position)?;
        }
        Ok(())
    }

    /// Returns whether an action belongs to no branch that is cut off. The closing bracket of such a branch ends it.
    fn stays(&mut self, action: &Action) -> Result<bool, NotCompiled> {
        let Some(depth) = self.cut else {
            return Ok(true);
        };
        match action {
            Action::Push => self.saved.push(self.state),
            Action::Pop if self.saved.len() == depth => {
                self.cut = None;
                return Ok(true);
            }
            Action::Pop => {
                self.saved.pop();
            }
            // A polygon that is cut off stays open.
            Action::Close if !self.open.is_empty() => return Err(NotCompiled),
            _ => {}
        }
        Ok(false)
    }

    fn subtree(&mut self, kind: usize, effect: &Effect<F>, position: u32) {
        let state = self.state;
        self.is_exact &= effect.is_exact;
        if !effect.is_exact {
            self.work = self.work.saturating_add(effect.work);
        }
        self.is_sure |= effect.is_sure && effect.drawn.is_some();
        if let Some(drawn) = &effect.drawn {
            self.part(Of::Subtree(kind, *drawn), state, drawn.first, position);
            self.last = state.attributes.then(drawn.last);
        } else if effect.lifts {
            self.down = false;
        }
        self.state = state.then(self.effects.compass, &effect.state);
        if effect.cuts {
            self.cut = Some(self.saved.len());
        }
    }

    /// Adds a part from a state; `first` holds the attributes of its first line.
    fn part(&mut self, of: Of<F>, state: TurtleState<F>, first: StrokeAttributes, position: u32) {
        // Only lines are joined, also those of subtrees.
        let is_joinable = matches!(of, Of::Step { .. } | Of::Subtree(..));
        self.down &= is_joinable;
        let attributes = state.attributes.then(first);
        let alike = self.parts.is_empty() || self.last == attributes;
        if self.parts.is_empty() {
            self.starts = self.down;
            self.first = Some(attributes);
        }
        self.parts.push(DrawnPart {
            position,
            of,
            pose: state.pose,
            attributes: state.attributes,
            joint: state.joint,
            joined: self.down && alike && !self.parts.is_empty(),
        });
        self.down = is_joinable;
        self.last = attributes;
    }

    fn vertex(&mut self) -> Result<(), NotCompiled> {
        if let Some(open) = self.open.last_mut() {
            open.vertices.push(self.state.pose.place);
            self.vertices += 1;
        }
        if self.vertices > MAX_VERTICES {
            return Err(NotCompiled);
        }
        Ok(())
    }

    fn act(
        &mut self,
        action: &Action,
        arguments: &[f64],
        fertile: bool,
        position: u32,
    ) -> Result<(), NotCompiled> {
        let compass = self.effects.compass;
        let TurtleState {
            pose,
            attributes,
            joint,
        } = &mut self.state;
        let changed = |width, colour| StrokeAttributes { width, colour };
        let StrokeAttributes { width, colour } = StrokeAttributes::SAME;
        match action {
            Action::Draw(steps) => {
                let steps = steps.eval(arguments);
                let mut state = self.state;
                self.state.pose.go(compass, steps);
                if !self.open.is_empty() {
                    self.state.joint.tip = Tip::Free;
                    self.down = false;
                    return self.vertex();
                }
                state.pose.scale *= steps;
                if state.pose.scale != 0.0 {
                    self.is_sure = true;
                    self.state.joint = Joint {
                        tip: Tip::Ends(state.attributes.width),
                        bent: Some(false),
                    };
                    self.part(
                        Of::Step { fertile },
                        state,
                        StrokeAttributes::SAME,
                        position,
                    );
                }
            }
            Action::Move(steps) => {
                pose.go(compass, steps.eval(arguments));
                joint.tip = Tip::Free;
                self.vertex()?;
                self.down = false;
            }
            Action::Glide(steps) => {
                pose.go(compass, steps.eval(arguments));
                joint.tip = Tip::Free;
                self.down = false;
            }
            Action::Turn(angle) => self.turn(Axis::Up, angle.eval(arguments)),
            Action::Pitch(angle) => self.turn(Axis::Left, angle.eval(arguments)),
            Action::Roll(angle) => self.turn(Axis::Heading, angle.eval(arguments)),
            // `Kinds::of` rejects systems with these actions.
            Action::Rotate(_) | Action::Swap | Action::Level => return Err(NotCompiled),
            Action::Push => {
                self.saved.push(self.state);
                self.state.joint.tip = Tip::Free;
            }
            Action::Pop => {
                self.state = self.saved.pop().ok_or(NotCompiled)?;
                self.down = false;
            }
            Action::Reflect => pose.mirrored ^= true,
            Action::Scale(factor) => pose.scale *= factor.eval(arguments),
            Action::Width(factor) => {
                let factor = factor.eval(arguments).max(0.0);
                *attributes = attributes.then(changed(Thickness::Times(factor), colour));
            }
            Action::SetWidth(set) => {
                let set = set.eval(arguments).max(0.0);
                *attributes = attributes.then(changed(Thickness::Set(set), colour));
            }
            Action::SetColour(set) => {
                let set = LSystem::colour(set.eval(arguments));
                *attributes = attributes.then(changed(width, Shade::Set(set)));
            }
            Action::ShiftColour(by) => {
                let by = LSystem::colour(by.eval(arguments));
                *attributes = attributes.then(changed(width, Shade::Shifted(by)));
            }
            Action::Open => self.open.push(OpenPolygon {
                state: self.state,
                vertices: Vec::new(),
            }),
            Action::Close => {
                let open = self.open.pop().ok_or(NotCompiled)?;
                self.close(&open, position);
            }
            Action::Vertex => self.vertex()?,
            Action::Stamp(number, size) => {
                let mut state = self.state;
                state.pose.scale *= size.eval(arguments);
                if state.pose.scale != 0.0 {
                    self.is_sure = true;
                    self.part(Of::Stamp(*number), state, StrokeAttributes::SAME, position);
                }
            }
            Action::Cut => self.cut = Some(self.saved.len()),
        }
        Ok(())
    }

    /// Turns about an axis by an angle in degrees.
    fn turn(&mut self, axis: Axis, angle: f64) {
        self.state.pose.turn(self.effects.compass, axis, angle);
        // A roll leaves a line straight.
        if axis != Axis::Heading && angle != 0.0 {
            self.state.joint.bent = Some(true);
        }
    }

    fn close(&mut self, open: &OpenPolygon<F>, position: u32) {
        let OpenPolygon { state, vertices } = open;
        if vertices.len() < 3 || state.pose.scale == 0.0 {
            return;
        }
        let compass = self.effects.compass;
        let seen = vertices
            .iter()
            .map(|place| state.pose.seen(compass, *place));
        self.is_sure = true;
        self.part(
            Of::Polygon(seen.collect()),
            *state,
            StrokeAttributes::SAME,
            position,
        );
    }

    /// Returns the effect of the modules that have been read.
    pub(super) fn effect(&self) -> Result<Effect<F>, NotCompiled> {
        let reached = self.parts.iter().map(|part| {
            let reach = part.reach();
            (part.pose.away().plus(reach), part)
        });
        let farthest = reached.reduce(|a, b| if a.0.longer(b.0) == a.0 { a } else { b });
        let drawn = farthest.zip(self.first).map(|((reach, part), first)| {
            let drawn = ModuleDrawing {
                reach,
                size: reach,
                tip: part.pose.place,
                first,
                last: self.last,
            };
            ModuleDrawing {
                size: drawn.size_of(&self.state.pose),
                ..drawn
            }
        });
        let pose = &self.state.pose;
        let finite = |reach: Far<F::Point>| reach.is_finite() && !reach.is_zero();
        let is_known = pose.place.is_finite()
            && pose.scale.is_finite()
            && drawn.as_ref().is_none_or(|drawn| finite(drawn.reach));
        if !is_known || !self.saved.is_empty() || !self.open.is_empty() {
            return Err(NotCompiled);
        }
        // Joints matter to tubes alone, and keep alternatives that are drawn at random apart.
        let joint = match F::tube(&self.effects.system) {
            Some(_) => self.state.joint,
            None => Joint::SAME,
        };
        Ok(Effect {
            state: TurtleState {
                joint,
                ..self.state
            },
            lifts: !self.down,
            cuts: self.cut.is_some(),
            drawn,
            is_exact: self.is_exact,
            is_sure: self.is_sure || self.parts.is_empty(),
            work: self.work,
        })
    }

    /// Returns whether the first part starts where the word does, and whether the last one ends where it
    /// ends.
    pub(super) fn meets(&self) -> [bool; 2] {
        [self.starts, self.down]
    }
}
