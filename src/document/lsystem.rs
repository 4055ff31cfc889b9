//! The file of an L-system as it is written.
//!
//! Where something could not be read, which has been reported then, an expression that is
//! [unknown](crate::expression::Expression::unknown) stands in for it.

use crate::diagnostic::Place;

use super::{HeadingDocument, Number};

/// An L-system as written.
#[derive(Clone, Debug)]
pub struct LSystemDocument {
    /// What files of all kinds say.
    pub heading: HeadingDocument,
    /// The angle of `+` and `-`.
    pub angle: Option<Number>,
    /// Where the turtle looks first.
    pub start: Option<Number>,
    /// The length of its steps.
    pub length: Option<Number>,
    /// What `!` multiplies widths by.
    pub thinning: Option<Number>,
    /// The word that all begins with; `None` if it is missing.
    pub axiom: Option<WordDocument>,
    /// The productions, in the order of the file.
    pub productions: Vec<ProductionDocument>,
    /// Meanings of the file's own.
    pub symbols: Vec<SymbolDocument>,
    /// What contexts do not see.
    pub ignored: Vec<char>,
    /// Whether its style says what colours tell.
    pub tells_colours: bool,
}

/// A string of modules as written.
#[derive(Clone, Debug)]
pub struct WordDocument {
    /// The modules.
    pub modules: Vec<ModuleDocument>,
    /// Whether all of it could be read.
    pub complete: bool,
    /// Where it was written.
    pub place: Place,
}

/// A module as written; its arguments are names in what is replaced and its contexts.
#[derive(Clone, Debug)]
pub struct ModuleDocument {
    /// Its symbol.
    pub character: char,
    /// Its arguments.
    pub arguments: Vec<Number>,
    /// Where it was written.
    pub place: Place,
}

/// A production as written.
#[derive(Clone, Debug)]
pub struct ProductionDocument {
    /// What must stand before the module that is replaced.
    pub left: Vec<ModuleDocument>,
    /// The module that is replaced.
    pub predecessor: ModuleDocument,
    /// What must stand behind it.
    pub right: Vec<ModuleDocument>,
    /// What must hold.
    pub condition: Option<Number>,
    /// What replaces it.
    pub successor: WordDocument,
    /// How often it is taken; 1 where it is one of a list of alternatives.
    pub weight: Option<Number>,
}

/// What the turtle does where it meets a symbol, as written.
#[derive(Clone, Debug)]
pub struct SymbolDocument {
    /// The symbol, with names for its arguments.
    pub symbol: ModuleDocument,
    /// What the turtle does.
    pub actions: Vec<ActionDocument>,
}

/// An action of the turtle as written.
#[derive(Clone, Debug)]
pub enum ActionDocument {
    /// Draws a line of so many steps: one if left out.
    Draw(Option<Number>),
    /// The same without the line.
    Move(Option<Number>),
    /// The same without a vertex in a polygon.
    Glide(Option<Number>),
    /// Turns by so many degrees.
    Turn(Number),
    /// The same, also where it is mirrored.
    Rotate(Number),
    /// Exchanges its heading with the second one.
    Swap,
    /// Saves its state.
    Push,
    /// Takes it back.
    Pop,
    /// Turns the other way round from here on.
    Reflect,
    /// Multiplies the length of steps.
    Scale(Number),
    /// Multiplies the width.
    Width(Number),
    /// Sets the width.
    SetWidth(Number),
    /// Sets the colour.
    Colour(Number),
    /// Adds to the number of the colour.
    ShiftColour(Number),
    /// Begins a polygon.
    Open,
    /// Ends it.
    Close,
    /// Makes a vertex of it.
    Vertex,
}
