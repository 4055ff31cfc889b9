//! The turtle's interpretation of symbols.

use crate::diagnostic::Place;
use crate::document::{ActionDocument, ModuleDocument, SymbolDocument, WrittenNumber};
use crate::expression::{Program, Scope};
use crate::lsystem::{Action, Symbol};
use crate::resolve::Resolver;

use super::{OfLSystem, of_argument};

/// Symbols of turns in space (Prusinkiewicz and Lindenmayer 1990), which the plane turtle refuses.
const SPACE: [char; 4] = ['&', '^', '\\', '/'];

/// Symbol that places a stamp.
const PLACES: char = '~';

impl Resolver<OfLSystem> {
    /// Returns the index of a module's symbol, which is added to the alphabet if it is new.
    pub(super) fn symbol(&mut self, module: &ModuleDocument) -> usize {
        if let Some(name) = self.stamp_of(module) {
            return self.placing(module, name);
        }
        let (character, arity) = (module.character, module.arguments.len());
        if let Some(&number) = self.kind.numbers.get(&(character, arity)) {
            self.spend(self.kind.symbols[number].meaning.len(), &module.place);
            return number;
        }
        let own = |arity| self.kind.own.get(&(character, arity));
        let own = own(arity).or_else(|| own(0)).cloned();
        let fits = self.spend(own.as_ref().map_or(1, |own| own.len()), &module.place);
        let own = own.map(|own| if fits { own.to_vec() } else { Vec::new() });
        let meaning = own.unwrap_or_else(|| {
            let is_space = !self.kind.is_in_space && SPACE.contains(&character);
            if is_space {
                let message =
                    format!("'{character}' needs space, and the turtle lives in the plane");
                let hint = format!(
                    "write `space: 3` at the top, or give it another meaning: symbols: {{'{character}': {{turn: 30}}}}"
                );
                self.error_with_hint(&module.place, message, hint);
            }
            self.usual(character, arity)
        });
        let number = self.add_symbol(character, arity, meaning);
        self.kind.numbers.insert((character, arity), number);
        number
    }

    fn add_symbol(&mut self, character: char, arity: usize, meaning: Vec<Action>) -> usize {
        self.kind.symbols.push(Symbol {
            character,
            arity,
            meaning,
            ignored: false,
            productions: Vec::new(),
        });
        self.kind.symbols.len() - 1
    }

    /// Returns the name of the stamp that a module places: its first argument.
    fn stamp_of<'m>(&self, module: &'m ModuleDocument) -> Option<&'m WrittenNumber> {
        let own = &self.kind.own;
        let is_own = || {
            let mut all = own.range((PLACES, 0)..=(PLACES, usize::MAX));
            all.next().is_some()
        };
        let is_placing = module.character == PLACES && !is_own();
        module.arguments.first().filter(|_| is_placing)
    }

    /// Returns the arguments of a module that are numbers.
    pub(super) fn arguments<'m>(&self, module: &'m ModuleDocument) -> &'m [WrittenNumber] {
        let names = usize::from(self.stamp_of(module).is_some());
        &module.arguments[names..]
    }

    /// Returns the number of a stamp. Reports a name that is not known and returns `None`.
    fn stamp(&mut self, name: &str, place: &Place) -> Option<usize> {
        let known = self.kind.stamp_numbers.get(name).copied();
        if known.is_none() && !self.incomplete {
            let message = format!("there is no stamp '{name}'");
            let names: Vec<_> = { self.kind.stamps.iter() }
                .map(|(name, _)| name.clone())
                .collect();
            let names = names.iter().map(String::as_str);
            let hint = self.suggestion(name, names).unwrap_or_else(|| {
                "list it under `stamps`, or name a base element of the library: ~(leaf)".into()
            });
            self.error_with_hint(place, message, hint);
        }
        known
    }

    /// Returns the actions that place a stamp: one for each of its base elements.
    fn places(&mut self, stamp: Option<usize>, size: &Program, place: &Place) -> Vec<Action> {
        let stamp = stamp.and_then(|stamp| self.kind.stamps.get(stamp));
        let base_elements = stamp.map_or(0..0, |(_, base_elements)| base_elements.clone());
        if !self.spend(base_elements.len(), place) {
            return Vec::new();
        }
        base_elements
            .map(|number| Action::Stamp(number, size.clone()))
            .collect()
    }

    /// Returns the index of the symbol that places a stamp, which is added to the alphabet if it is new. An argument
    /// after the name is the length in steps.
    fn placing(&mut self, module: &ModuleDocument, name: &WrittenNumber) -> usize {
        let written = module.name.as_deref();
        let known = self.stamp(written.unwrap_or(name.place.text()), &name.place);
        let arity = module.arguments.len() - 1;
        if known.is_some() && arity > 1 {
            let message = "a stamp has a name, and perhaps a length in steps";
            self.error_with_hint(&module.place, message, "~(leaf) or ~(leaf, 2)");
        }
        let stamp = known.unwrap_or(0);
        if let Some(&number) = self.kind.placing.get(&(stamp, arity)) {
            self.spend(self.kind.symbols[number].meaning.len(), &module.place);
            return number;
        }
        let size = match arity {
            0 => Program::constant(1.0),
            _ => of_argument("x"),
        };
        let meaning = self.places(known, &size, &module.place);
        let number = self.add_symbol(PLACES, arity, meaning);
        self.kind.placing.insert((stamp, arity), number);
        number
    }

    /// Returns the default interpretation of a symbol (Prusinkiewicz and Lindenmayer 1990).
    fn usual(&self, character: char, arity: usize) -> Vec<Action> {
        let constant = Program::constant;
        let has_argument = arity > 0;
        let argument_or = |value| match has_argument {
            true => of_argument("x"),
            false => constant(value),
        };
        vec![match character {
            'F' => Action::Draw(argument_or(1.0)),
            'f' => Action::Move(argument_or(1.0)),
            '+' => Action::Turn(argument_or(self.kind.angle)),
            '-' if has_argument => Action::Turn(of_argument("-x")),
            '-' => Action::Turn(constant(-self.kind.angle)),
            '&' => Action::Pitch(argument_or(self.kind.angle)),
            '^' if has_argument => Action::Pitch(of_argument("-x")),
            '^' => Action::Pitch(constant(-self.kind.angle)),
            '/' => Action::Roll(argument_or(self.kind.angle)),
            '\\' if has_argument => Action::Roll(of_argument("-x")),
            '\\' => Action::Roll(constant(-self.kind.angle)),
            '$' if self.kind.is_in_space => Action::Level,
            '%' => Action::Cut,
            '|' => Action::Turn(constant(180.0)),
            '[' => Action::Push,
            ']' => Action::Pop,
            '{' => Action::Open,
            '}' => Action::Close,
            '.' => Action::Vertex,
            '!' if has_argument => Action::SetWidth(of_argument("x")),
            '!' => Action::Width(constant(self.kind.thinning)),
            '\'' if has_argument => Action::SetColour(of_argument("x")),
            '\'' => Action::ShiftColour(constant(1.0)),
            _ => return Vec::new(),
        }]
    }

    /// Adds the file's own interpretation of a symbol.
    pub(super) fn define(&mut self, document: &SymbolDocument) {
        let module = &document.symbol;
        let mut scope = Scope::inside(&self.kind.constants);
        self.names(module, &mut scope, &mut 0);
        let actions: Vec<_> = { document.actions.iter() }
            .flat_map(|action| self.actions(action, &scope))
            .collect();
        let saves = |action: &Action| match action {
            Action::Push | Action::Open => 1,
            Action::Pop | Action::Close => -1,
            _ => 0i32,
        };
        let is_bracket = |action: &Action| saves(action) != 0;
        let brackets: Vec<_> = actions.iter().filter(|action| is_bracket(action)).collect();
        let mut depth = 0;
        let depths = brackets.iter().map(|action| {
            depth += saves(action);
            depth
        });
        let least = depths.min().unwrap_or(0);
        if depth.abs() > 1 || least < depth.min(0) {
            let message = "a symbol opens or closes one bracket at most";
            let hint = "use one symbol for each";
            self.error_with_hint(&module.place, message, hint);
        }
        let key = (module.character, module.arguments.len());
        if self.kind.own.insert(key, actions.into()).is_some() {
            let message = format!("'{}' has a meaning already", module.character);
            self.error(&module.place, message);
        }
    }

    fn actions(&mut self, document: &ActionDocument, scope: &Scope) -> Vec<Action> {
        let mut steps = |number: &Option<WrittenNumber>| match number {
            Some(number) => self.program(number, scope),
            None => Program::constant(1.0),
        };
        vec![match document {
            ActionDocument::Stamp(name, scale) => {
                let size = steps(scale);
                let stamp = self.stamp(&name.value, &name.place);
                return self.places(stamp, &size, &name.place);
            }
            ActionDocument::Draw(number) => Action::Draw(steps(number)),
            ActionDocument::Move(number) => Action::Move(steps(number)),
            ActionDocument::Glide(number) => Action::Glide(steps(number)),
            ActionDocument::Turn(number) => Action::Turn(self.program(number, scope)),
            ActionDocument::Rotate(number) => Action::Rotate(self.program(number, scope)),
            ActionDocument::Pitch(number) => Action::Pitch(self.program(number, scope)),
            ActionDocument::Roll(number) => Action::Roll(self.program(number, scope)),
            ActionDocument::Level => Action::Level,
            ActionDocument::Cut => Action::Cut,
            ActionDocument::Swap => Action::Swap,
            ActionDocument::Push => Action::Push,
            ActionDocument::Pop => Action::Pop,
            ActionDocument::Reflect => Action::Reflect,
            ActionDocument::Scale(number) => Action::Scale(self.program(number, scope)),
            ActionDocument::Width(number) => Action::Width(self.width(number, scope)),
            ActionDocument::SetWidth(number) => Action::SetWidth(self.width(number, scope)),
            ActionDocument::Colour(number) => Action::SetColour(self.program(number, scope)),
            ActionDocument::ShiftColour(number) => Action::ShiftColour(self.program(number, scope)),
            ActionDocument::Open => Action::Open,
            ActionDocument::Close => Action::Close,
            ActionDocument::Vertex => Action::Vertex,
        }]
    }

    fn width(&mut self, number: &WrittenNumber, scope: &Scope) -> Program {
        let program = self.program(number, scope);
        if program.as_constant().is_some_and(|value| value < 0.0) {
            self.error(&number.place, "a width cannot be negative");
        }
        program
    }
}
