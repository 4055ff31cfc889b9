//! L-systems with a turtle (Prusinkiewicz & Lindenmayer, "The Algorithmic Beauty of Plants", 1990).
//!
//! A *word* is a string of *modules*: a symbol, perhaps with arguments. A step replaces all modules of a
//! word at the same time, each by the successor of a production that fits it; a module that none fits is
//! kept. A turtle reads the last word: every symbol has a meaning, a list of actions on the turtle.
//!
//! # Which production
//!
//! Productions with contexts come before those without (ABOP, section 1.8), and in the order of the file
//! otherwise; [`Symbol::productions`] is that order. The first one that fits is taken. If it has a weight,
//! one is drawn of all those with weights that fit and are of its precedence. Draws depend on the seed and the module's *path* alone: its
//! position in the axiom, then in each successor, among all its modules; being kept adds nothing.
//!
//! # The turtle
//!
//! Its state is a place, an exact [heading](Compass), whether it is mirrored, the scale of its
//! steps, a factor of widths and an index of colours. It starts at the origin in the start heading with
//! scale 1, width 1 and colour 0. y points up; positive angles are counter-clockwise, or clockwise where it
//! is mirrored. The state is what brackets save and restore. A second heading, which starts as the first one does,
//! is part of it; nothing goes by it until both are exchanged.
//!
//! # What is guaranteed
//!
//! All numbers of symbols and productions are in range. A module has as many arguments as its symbol
//! takes, and none of the axiom is infinite or NaN. In every word, the axiom and all successors, pushes
//! and pops are balanced, and so are opened and closed polygons (but a bracket may be closed while
//! a polygon that was opened in it is still open). A symbol saves the state once more than it takes it
//! back, or the other way round, or equally often. Constant numbers in actions are finite.

mod compass;
mod expand;
mod lengths;
mod rewrite;
mod surroundings;
mod turtle;
mod word;

pub use compass::Compass;
pub use rewrite::RewriteError;
pub(crate) use turtle::Turtle;
pub use turtle::{Drawing, Placed};
pub use word::Word;

use crate::diagnostic::Place;
use crate::expression::Program;
use crate::heading::Heading;

/// An L-system.
#[derive(Clone, Debug, PartialEq)]
pub struct LSystem {
    pub(crate) heading: Heading,
    pub(crate) start: f64,
    pub(crate) length: f64,
    pub(crate) symbols: Vec<Symbol>,
    pub(crate) axiom: Vec<Module>,
    pub(crate) productions: Vec<Production>,
}

/// A symbol with a number of arguments: `F` and `F(l)` are two.
#[derive(Clone, Debug, PartialEq)]
pub struct Symbol {
    /// Its character.
    pub character: char,
    /// The number of its arguments.
    pub arity: usize,
    /// What the turtle does where it meets it. The slots of its programs are the module's arguments.
    pub meaning: Vec<Action>,
    /// Whether contexts do not see it.
    pub ignored: bool,
    /// The productions of which it is the predecessor, in the order in which they are tried.
    pub productions: Vec<usize>,
}

/// An action of the turtle.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Goes so many steps ahead and draws a line; inside a polygon it makes a vertex instead.
    Draw(Program),
    /// The same without the line.
    Move(Program),
    /// The same with neither a line inside a polygon, nor a vertex.
    Glide(Program),
    /// Turns by so many degrees.
    Turn(Program),
    /// Turns by so many degrees counter-clockwise, also where it is mirrored.
    Rotate(Program),
    /// Exchanges its heading with the second one.
    Swap,
    /// Saves its state: an opening bracket.
    Push,
    /// Takes back the state that was saved last: a closing bracket.
    Pop,
    /// From here on turns the other way round.
    Reflect,
    /// Multiplies the length of its steps.
    Scale(Program),
    /// Multiplies the width of its lines.
    Width(Program),
    /// Sets the width, as a multiple of what it started with.
    SetWidth(Program),
    /// Sets the index of the colour.
    SetColour(Program),
    /// Adds to the index of the colour.
    ShiftColour(Program),
    /// Begins a polygon, which is of the colour that the turtle has here.
    Open,
    /// Ends the polygon that was begun last, and fills it.
    Close,
    /// Makes the place where it is a vertex.
    Vertex,
}

/// A module: a symbol with the values of its arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// The symbol, by number.
    pub symbol: usize,
    /// As many as the symbol takes.
    pub arguments: Vec<f64>,
}

/// A module of a successor, whose arguments are worked out where it is used.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// The symbol, by number.
    pub symbol: usize,
    /// As many as the symbol takes.
    pub arguments: Vec<Program>,
}

/// Where a successor was written: for messages about what shows only when it is used.
#[derive(Clone, Debug)]
pub(crate) struct Origin(pub(crate) Place);

impl PartialEq for Origin {
    /// Two productions are the same wherever they were written.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A production: what replaces a module, and when.
///
/// The slots of its programs are the arguments of the modules of the left context, in the order in which
/// they are written, then those of the predecessor, then those of the right context.
#[derive(Clone, Debug, PartialEq)]
pub struct Production {
    pub(crate) origin: Origin,
    /// The symbol that it replaces, by number.
    pub predecessor: usize,
    /// The symbols that stand before it, on the way from the root: the nearest one last.
    pub left: Vec<usize>,
    /// What stands behind it.
    pub right: Vec<Context>,
    /// What must hold.
    pub condition: Option<Program>,
    /// What replaces the module.
    pub successor: Vec<Template>,
    /// How often it is taken, relative to the others that fit.
    pub weight: Option<Program>,
}

/// A part of a right context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Context {
    /// A symbol, by number.
    Symbol(usize),
    /// A branch begins.
    Open,
    /// It ends.
    Close,
}

impl LSystem {
    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        &self.heading
    }

    /// Where the turtle looks first: degrees, counter-clockwise from the right.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.start
    }

    /// The length of its steps; above 0.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The symbols.
    #[must_use]
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// The word that all begins with.
    #[must_use]
    pub fn axiom(&self) -> &[Module] {
        &self.axiom
    }

    /// The productions, in the order of the file.
    #[must_use]
    pub fn productions(&self) -> &[Production] {
        &self.productions
    }

    /// Whether nothing is drawn at random.
    #[must_use]
    pub fn is_deterministic(&self) -> bool {
        !{ &self.productions }
            .iter()
            .any(|production| production.weight.is_some())
    }

    /// Whether no production has a context.
    #[must_use]
    pub fn is_context_free(&self) -> bool {
        self.productions
            .iter()
            .all(|production| !production.has_context())
    }

    /// Whether what replaces a module depends on arguments.
    #[must_use]
    pub fn is_parametric(&self) -> bool {
        let mut symbols = self.symbols.iter();
        symbols.any(|symbol| symbol.arity > 0 && !symbol.productions.is_empty())
    }

    /// Whether what a word draws depends on more of the turtle than where it stands: on a second heading,
    /// or on whether it is mirrored where turns are not.
    pub(crate) fn depends_on_the_way(&self) -> bool {
        let mut actions = self.symbols.iter().flat_map(|symbol| &symbol.meaning);
        actions.any(|action| matches!(action, Action::Swap | Action::Rotate(_)))
    }

    /// The same system with lines of one width and one colour: it draws the same set.
    #[must_use]
    pub fn without_looks(&self) -> Self {
        let mut plain = self.clone();
        for symbol in &mut plain.symbols {
            symbol.meaning.retain(|action| !action.changes_looks());
        }
        plain
    }

    /// Whether the turtle's colour ever changes.
    #[must_use]
    pub fn has_colours(&self) -> bool {
        let mut actions = self.symbols.iter().flat_map(|symbol| &symbol.meaning);
        actions.any(|action| matches!(action, Action::SetColour(_) | Action::ShiftColour(_)))
    }
}

impl Action {
    /// Whether it changes widths or colours, and nothing else.
    #[must_use]
    pub fn changes_looks(&self) -> bool {
        matches!(
            self,
            Self::Width(_) | Self::SetWidth(_) | Self::SetColour(_) | Self::ShiftColour(_)
        )
    }
}

impl Production {
    /// Whether it has a context.
    #[must_use]
    pub fn has_context(&self) -> bool {
        !self.left.is_empty() || !self.right.is_empty()
    }
}

impl Symbol {
    /// How many lines and polygons it draws at most.
    #[must_use]
    pub fn draws(&self) -> u64 {
        let draws = |action: &Action| u64::from(matches!(action, Action::Draw(_) | Action::Close));
        self.meaning.iter().map(draws).sum()
    }

    /// Whether it is an opening bracket: it saves the state once more than it takes it back.
    #[must_use]
    pub fn is_push(&self) -> bool {
        self.saves() > 0
    }

    /// Whether it is a closing bracket.
    #[must_use]
    pub fn is_pop(&self) -> bool {
        self.saves() < 0
    }

    /// How often it saves the state, less how often it takes it back: -1, 0 or 1.
    fn saves(&self) -> i32 {
        let saves = |action: &Action| match action {
            Action::Push => 1,
            Action::Pop => -1,
            _ => 0,
        };
        self.meaning.iter().map(saves).sum()
    }
}
