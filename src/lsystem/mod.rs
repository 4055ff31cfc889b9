//! L-systems with a turtle (Prusinkiewicz & Lindenmayer, "The Algorithmic Beauty of Plants", 1990).
//!
//! A *word* is a string of *modules*: a symbol, perhaps with arguments. A step replaces all modules of a word
//! at the same time, each by the successor of a production that fits it; a module that no production fits is
//! kept. A turtle reads the last word: every symbol has a meaning, a list of actions on the turtle.
//!
//! # Selection of productions
//!
//! Productions with contexts precede those without (ABOP, section 1.8); otherwise the order is that of the
//! file. [`Symbol::productions`] is in this order. The first production that fits is taken. If it has a
//! weight, one is drawn from all productions with weights that fit and have the same precedence. Draws depend
//! only on the seed and the module's *path*: its position in the axiom, then in each successor, among all
//! modules of it; being kept adds nothing.
//!
//! # The turtle
//!
//! The state of the turtle consists of a position, an exact [heading](Compass), a mirrored flag, the scale of
//! its steps, a factor of widths and a colour index. The turtle starts at the origin in the start heading
//! with scale 1, width 1 and colour 0. The y axis points up; positive angles are counter-clockwise, or
//! clockwise while the turtle is mirrored. Brackets save and restore the state. A second heading, initially
//! equal to the first, is part of the state and has no effect until both are exchanged.
//!
//! [In space](LSystemInSpace), the heading is a rotation, which a [`TurtleFrame`] composes of turns about three axes.
//!
//! # Guarantees
//!
//! All indices of symbols and productions are in range. A module has as many arguments as its symbol takes,
//! and none of the axiom's is infinite or NaN. In every word, in the axiom and all successors, pushes and
//! pops are balanced, and so are opened and closed polygons (but a bracket may be closed while a polygon that
//! was opened in it is still open). The numbers of pushes and pops of a symbol differ by at most one.
//! Constant numbers in actions are finite.

mod compass;
mod expand;
mod frame;
mod growing;
mod lengths;
mod no_growth;
mod rewrite;
mod space;
mod surroundings;
mod tube;
mod turtle;
mod word;

pub use compass::Compass;
pub use frame::{Axis, Heading3, TurtleFrame};
pub(crate) use growing::GrowingTurtle;
pub use no_growth::NoGrowth;
pub use rewrite::RewriteError;
pub use space::{LSystemInSpace, NoGraph, Tropism};
pub use tube::{Stretch, TubeLine, TubePart};
pub(crate) use turtle::Turtle;
pub use turtle::{Drawing, Drawn, Placed};
pub use word::Word;

use crate::diagnostic::Place;
use crate::draws::Variable;
use crate::expression::Program;
use crate::metadata::Metadata;
use crate::rule::BaseElement;
use crate::tween::Growing;

/// An L-system.
#[derive(Clone, Debug, PartialEq)]
pub struct LSystem {
    pub(crate) metadata: Metadata,
    pub(crate) start: f64,
    pub(crate) length: f64,
    pub(crate) symbols: Vec<Symbol>,
    pub(crate) axiom: Vec<Module>,
    pub(crate) productions: Vec<Production>,
    /// Base elements that the turtle places in the plane.
    pub(crate) stamps: Vec<BaseElement>,
    /// Whether the system stands for its limit set, not for its words.
    pub(crate) in_limit: bool,
    /// Step that is drawn while it grows, if there is one.
    pub(crate) growing: Option<Growing>,
}

/// A symbol with a number of arguments: `F` and `F(l)` are different symbols.
#[derive(Clone, Debug, PartialEq)]
pub struct Symbol {
    /// Character of the symbol.
    pub character: char,
    /// The number of arguments.
    pub arity: usize,
    /// Actions of the turtle on reading the symbol. The slots of their programs are the module's arguments.
    pub meaning: Vec<Action>,
    /// Whether contexts ignore the symbol.
    pub ignored: bool,
    /// Indices of the productions with this predecessor, in the order in which they are tried.
    pub productions: Vec<usize>,
}

/// An action of the turtle.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Moves forward by a number of steps and draws a line; inside a polygon, adds a vertex instead.
    Draw(Program),
    /// Moves forward by a number of steps without a line; inside a polygon, adds a vertex.
    Move(Program),
    /// Moves forward by a number of steps with neither a line nor a vertex.
    Glide(Program),
    /// Turns by an angle in degrees, counter-clockwise, or clockwise while mirrored.
    Turn(Program),
    /// Turns by an angle in degrees counter-clockwise, also while mirrored.
    Rotate(Program),
    /// In space, turns about L, the direction to the left, by an angle in degrees, by the right-hand rule: pitches down.
    Pitch(Program),
    /// In space, turns about the heading by an angle in degrees, by the right-hand rule. A mirrored turtle rolls the
    /// other way.
    Roll(Program),
    /// In space, rolls about the heading until L is horizontal: L = V × H / |V × H| for the y axis V, which points up,
    /// and U = H × L. A vertical turtle does nothing (Prusinkiewicz & Lindenmayer 1990, section 2.3.3).
    Level,
    /// Exchanges the heading with the second one.
    Swap,
    /// Saves the state: an opening bracket.
    Push,
    /// Restores the state that was saved last: a closing bracket.
    Pop,
    /// Toggles the mirrored flag, which inverts the direction of turns.
    Reflect,
    /// Multiplies the length of steps by a factor.
    Scale(Program),
    /// Multiplies the width of lines by a factor; negative ones count as 0.
    Width(Program),
    /// Sets the width, as a multiple of the initial one; negative widths count as 0.
    SetWidth(Program),
    /// Sets the colour index.
    SetColour(Program),
    /// Adds to the colour index.
    ShiftColour(Program),
    /// Begins a polygon in the turtle's current colour.
    Open,
    /// Ends the polygon that was begun last, and fills it.
    Close,
    /// Adds the current position to the polygon as a vertex.
    Vertex,
    /// Places a stamp of the system, by index, along the heading; its length is a number of steps. The turtle stays.
    Stamp(usize, Program),
    /// Cuts off the rest of the branch: everything up to the closing bracket that ends it.
    Cut,
}

/// A module: a symbol with the values of its arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// Index of the symbol.
    pub symbol: usize,
    /// Arguments, as many as the symbol takes.
    pub arguments: Vec<f64>,
}

/// A module of a successor, whose arguments are evaluated where the production is applied.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// Index of the symbol.
    pub symbol: usize,
    /// Expressions of the arguments, as many as the symbol takes.
    pub arguments: Vec<Program>,
}

/// Source span of a successor, for diagnostics of errors that occur only on application.
#[derive(Clone, Debug)]
pub(crate) struct Origin(pub(crate) Place);

impl PartialEq for Origin {
    /// Returns `true`: equality of productions does not depend on their source spans.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A production: the replacement of a module, and its conditions.
///
/// The slots of its programs are the arguments of the left context's modules in the order in which they are
/// written, then those of the predecessor, then those of the right context, and in its successor its variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Production {
    pub(crate) origin: Origin,
    /// Index of the symbol that is replaced.
    pub predecessor: usize,
    /// Left context: the symbols before the module on the path from the root, the nearest one last.
    pub left: Vec<usize>,
    /// Right context.
    pub right: Vec<Context>,
    /// Condition that must hold, if there is one.
    pub condition: Option<Program>,
    /// Modules that replace the predecessor.
    pub successor: Vec<Template>,
    /// Weight in the draw among fitting productions; without one there is no draw.
    pub weight: Option<Program>,
    /// Variables that are drawn for every module that is replaced; empty if the successor uses none.
    pub variables: Vec<Variable>,
}

/// A part of a right context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Context {
    /// The symbol with this index.
    Symbol(usize),
    /// The start of a branch.
    Open,
    /// The end of a branch.
    Close,
}

impl LSystem {
    /// Returns the metadata that files of all kinds have.
    #[must_use]
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// Returns the start heading in degrees, counter-clockwise from the right.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Returns the initial length of a step, above 0.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the symbols.
    #[must_use]
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// Returns the axiom: the word of step 0.
    #[must_use]
    pub fn axiom(&self) -> &[Module] {
        &self.axiom
    }

    /// Returns the productions, in the order of the file.
    #[must_use]
    pub fn productions(&self) -> &[Production] {
        &self.productions
    }

    /// Returns whether nothing is drawn at random: no production has a weight or variables.
    #[must_use]
    pub fn is_deterministic(&self) -> bool {
        { &self.productions }
            .iter()
            .all(|it| it.weight.is_none() && it.variables.is_empty())
    }

    /// Returns whether no production has a context.
    #[must_use]
    pub fn is_context_free(&self) -> bool {
        self.productions
            .iter()
            .all(|production| !production.has_context())
    }

    /// Returns whether the drawing of a word depends on more of the turtle's state than its frame: on the
    /// second heading, or on the mirrored flag where [`Action::Rotate`] ignores it.
    pub(crate) fn depends_on_the_way(&self) -> bool {
        let mut actions = self.symbols.iter().flat_map(|symbol| &symbol.meaning);
        actions.any(|action| matches!(action, Action::Swap | Action::Rotate(_)))
    }

    /// Returns the system without actions on width and colour: it draws the same set.
    #[must_use]
    pub fn without_appearance(&self) -> Self {
        let mut plain = self.clone();
        for symbol in &mut plain.symbols {
            symbol.meaning.retain(|action| !action.changes_appearance());
        }
        plain
    }

    /// Returns the system that stands for its limit set, without actions on width and colour.
    pub(crate) fn in_limit(&self) -> Self {
        Self {
            in_limit: true,
            ..self.without_appearance()
        }
    }

    /// Returns whether a symbol changes the turtle's colour.
    #[must_use]
    pub fn has_colours(&self) -> bool {
        let mut actions = self.symbols.iter().flat_map(|symbol| &symbol.meaning);
        actions.any(|action| matches!(action, Action::SetColour(_) | Action::ShiftColour(_)))
    }
}

impl Action {
    /// Returns whether the action changes width or colour only.
    #[must_use]
    pub fn changes_appearance(&self) -> bool {
        matches!(
            self,
            Self::Width(_) | Self::SetWidth(_) | Self::SetColour(_) | Self::ShiftColour(_)
        )
    }
}

impl Production {
    /// Returns whether the production has a left or right context.
    #[must_use]
    pub fn has_context(&self) -> bool {
        !self.left.is_empty() || !self.right.is_empty()
    }
}

impl Symbol {
    /// Returns the largest number of lines, polygons and stamps that the symbol draws.
    #[must_use]
    pub fn draws(&self) -> u64 {
        let draws = |action: &Action| {
            let draws = matches!(action, Action::Draw(_) | Action::Close | Action::Stamp(..));
            u64::from(draws)
        };
        self.meaning.iter().map(draws).sum()
    }

    /// Returns whether the symbol is an opening bracket: it saves the state once more than it restores it.
    #[must_use]
    pub fn is_push(&self) -> bool {
        self.saves() > 0
    }

    /// Returns whether the symbol is a closing bracket: it restores the state once more than it saves it.
    #[must_use]
    pub fn is_pop(&self) -> bool {
        self.saves() < 0
    }

    /// Returns the number of pushes minus the number of pops: −1, 0 or 1.
    fn saves(&self) -> i32 {
        let saves = |action: &Action| match action {
            Action::Push => 1,
            Action::Pop => -1,
            _ => 0,
        };
        self.meaning.iter().map(saves).sum()
    }
}
