//! Document of an L-system (Prusinkiewicz and Lindenmayer 1990).
//!
//! A placeholder, [`unknown`](crate::expression::Expression::unknown), stands for every expression that
//! cannot be read and has been reported.

use crate::diagnostic::Place;

use super::ifs::ShapeDocument;
use super::read::BaseElementDocument;
use super::{MetadataDocument, Written, WrittenNumber, WrittenPoint};

/// An L-system as written.
#[derive(Clone, Debug)]
pub struct LSystemDocument {
    /// Metadata of the file.
    pub metadata: MetadataDocument,
    /// Whether the turtle moves in space.
    pub is_in_space: bool,
    /// Angle increment of `+` and `-`, in degrees.
    pub angle: Option<WrittenNumber>,
    /// Initial heading of the turtle, in degrees counter-clockwise from the x axis.
    pub start: Option<WrittenNumber>,
    /// In space, initial heading as a vector.
    pub start_vector: Option<Box<WrittenPoint>>,
    /// In space, initial direction upwards from the turtle's back.
    pub up: Option<Box<WrittenPoint>>,
    /// In space, tropism.
    pub tropism: Option<Box<TropismDocument>>,
    /// Stamps by name.
    pub stamps: Vec<(Written<String>, StampDocument)>,
    /// Variables that are drawn for every module that is replaced, with their distributions.
    pub random: Vec<(Written<String>, WrittenNumber)>,
    /// Step length of the turtle.
    pub length: Option<WrittenNumber>,
    /// Factor by which `!` multiplies the width.
    pub thinning: Option<WrittenNumber>,
    /// Axiom; `None` if it is missing.
    pub axiom: Option<WordDocument>,
    /// Productions, in the order of the file.
    pub productions: Vec<ProductionDocument>,
    /// Symbols to which the file gives its own interpretation.
    pub symbols: Vec<SymbolDocument>,
    /// Symbols that contexts ignore.
    pub ignored: Vec<char>,
}

/// A stamp as written.
#[derive(Clone, Debug)]
pub enum StampDocument {
    /// A base element.
    BaseElement(Box<BaseElementDocument>),
    /// A set, in the coordinates of the unit frame.
    Set(Box<ShapeDocument>),
}

/// A tropism as written.
#[derive(Clone, Debug)]
pub struct TropismDocument {
    /// The vector towards which lines bend.
    pub towards: WrittenPoint,
    /// The susceptibility to bending, in radians.
    pub susceptibility: WrittenNumber,
}

/// A string of modules as written.
#[derive(Clone, Debug)]
pub struct WordDocument {
    /// The modules.
    pub modules: Vec<ModuleDocument>,
    /// Whether the whole word could be read.
    pub complete: bool,
    /// Source span of the word.
    pub place: Place,
}

/// A module as written. In predecessors and contexts its arguments are names of formal parameters.
#[derive(Clone, Debug)]
pub struct ModuleDocument {
    /// Symbol.
    pub character: char,
    /// Arguments.
    pub arguments: Vec<WrittenNumber>,
    /// The first argument of `~` as text: the name of a stamp.
    pub name: Option<String>,
    /// Source span of the module.
    pub place: Place,
}

/// A production as written.
#[derive(Clone, Debug)]
pub struct ProductionDocument {
    /// Left context.
    pub left: Vec<ModuleDocument>,
    /// Strict predecessor: the module that is replaced.
    pub predecessor: ModuleDocument,
    /// Right context.
    pub right: Vec<ModuleDocument>,
    /// Condition.
    pub condition: Option<WrittenNumber>,
    /// Successor.
    pub successor: WordDocument,
    /// Weight of a stochastic production; 1 if it is one of a list of alternatives without a weight.
    pub weight: Option<WrittenNumber>,
}

/// The turtle's interpretation of a symbol, as written.
#[derive(Clone, Debug)]
pub struct SymbolDocument {
    /// The symbol, with names of formal parameters as arguments.
    pub symbol: ModuleDocument,
    /// Actions, in the order of execution.
    pub actions: Vec<ActionDocument>,
}

/// An action of the turtle as written.
#[derive(Clone, Debug)]
pub enum ActionDocument {
    /// Moves ahead by a number of steps (1 if `None`) and draws a line.
    Draw(Option<WrittenNumber>),
    /// Moves ahead by a number of steps without drawing; adds a vertex to an open polygon.
    Move(Option<WrittenNumber>),
    /// Moves ahead by a number of steps without drawing and without adding a vertex.
    Glide(Option<WrittenNumber>),
    /// Turns by an angle in degrees, clockwise after a reflection and counter-clockwise otherwise.
    Turn(WrittenNumber),
    /// Turns counter-clockwise by an angle in degrees, also after a reflection.
    Rotate(WrittenNumber),
    /// In space, turns about the direction to the left, by an angle in degrees.
    Pitch(WrittenNumber),
    /// In space, turns about the heading, by an angle in degrees.
    Roll(WrittenNumber),
    /// In space, rolls until the direction to the left is horizontal.
    Level,
    /// Cuts off the rest of the branch.
    Cut,
    /// Exchanges the heading and the second heading.
    Swap,
    /// Pushes the state.
    Push,
    /// Pops the state.
    Pop,
    /// Reverses the sense of the turns that follow.
    Reflect,
    /// Multiplies the step length.
    Scale(WrittenNumber),
    /// Multiplies the width.
    Width(WrittenNumber),
    /// Sets the width, as a multiple of the width of the file.
    SetWidth(WrittenNumber),
    /// Sets the colour by its number in the palette.
    Colour(WrittenNumber),
    /// Adds to the number of the colour.
    ShiftColour(WrittenNumber),
    /// Places a stamp, whose length is a number of steps (1 if `None`).
    Stamp(Written<String>, Option<WrittenNumber>),
    /// Begins a polygon.
    Open,
    /// Ends the polygon.
    Close,
    /// Adds a vertex to the polygon.
    Vertex,
}
