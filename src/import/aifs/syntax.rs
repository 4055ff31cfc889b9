//! Expressions of AIFS.
//!
//! In order of increasing precedence: `|` (union), `+ -`, `* / %` (`*` composes maps), negation, `^`, and calls and
//! elements, `f(x)` and `v[0]`. All but `^` group to the left: `2^-1^2` is a half.

use std::ops::Range;

use crate::diagnostic::{Diagnostic, Place};

/// Result of parsing or evaluating: a mistake has its place.
pub(super) type Parsed<T> = Result<T, Box<Diagnostic>>;

/// Largest depth of parentheses, brackets, signs and exponents.
const MAX_DEPTH: usize = 64;

/// An expression and its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Expression {
    pub(super) place: Place,
    pub(super) kind: Kind,
}

/// Form of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Number(f64),
    /// A variable, or a constant such as `$i`.
    Name(String),
    /// `[a, b, …]`.
    List(Vec<Expression>),
    /// `f(a, b, …)`.
    Call(String, Vec<Expression>),
    /// `v[i]`, `v[i, j]`.
    Element(Box<Expression>, Vec<Expression>),
    /// `-a`.
    Minus(Box<Expression>),
    /// `a^b`.
    Power(Box<Expression>, Box<Expression>),
    /// `a*b/c`: each with the operator before it, of which the first has no meaning.
    Product(Vec<(Operator, Expression)>),
    /// `a+b-c`, in the same form.
    Sum(Vec<(Operator, Expression)>),
    /// `a|b|c`.
    Union(Vec<Expression>),
}

/// An operator of two arguments that groups to the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Plus,
    Minus,
    Times,
    Over,
    Modulo,
}

impl Expression {
    /// Calls a function with each name of a variable in the expression.
    pub(super) fn names<'a>(&'a self, of: &mut impl FnMut(&'a str)) {
        match &self.kind {
            Kind::Number(_) => {}
            Kind::Name(name) => of(name),
            Kind::List(all) | Kind::Call(_, all) | Kind::Union(all) => {
                all.iter().for_each(|it| it.names(of));
            }
            Kind::Element(list, indices) => {
                list.names(of);
                indices.iter().for_each(|it| it.names(of));
            }
            Kind::Minus(it) => it.names(of),
            Kind::Power(base, exponent) => {
                base.names(of);
                exponent.names(of);
            }
            Kind::Product(all) | Kind::Sum(all) => all.iter().for_each(|(_, it)| it.names(of)),
        }
    }
}

/// Returns whether a text is an identifier.
pub(super) fn is_name(text: &str) -> bool {
    let mut characters = text.chars();
    let is_first = |c: char| c.is_ascii_alphabetic() || c == '_';
    characters.next().is_some_and(is_first) && characters.all(is_in_name)
}

fn is_in_name(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

/// Parses the text at a place; comments from `#` to the ends of its lines are skipped.
pub(super) fn parse(place: &Place) -> Parsed<Expression> {
    let mut parser = Parser {
        place,
        text: place.text(),
        at: 0,
        depth: 0,
    };
    let expression = parser.union()?;
    match parser.peek() {
        None => Ok(expression),
        Some(_) => Err(parser.unexpected("an operator")),
    }
}

struct Parser<'a> {
    place: &'a Place,
    text: &'a str,
    /// Offset of the next character.
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    /// Skips blanks and comments, and returns the next character.
    fn peek(&mut self) -> Option<char> {
        loop {
            let rest = &self.text[self.at..];
            let skipped = rest.trim_start();
            self.at += rest.len() - skipped.len();
            if !skipped.starts_with('#') {
                return skipped.chars().next();
            }
            self.at += skipped.find(['\n', '\r']).unwrap_or(skipped.len());
        }
    }

    /// Skips a character if it is next.
    fn skip(&mut self, character: char) -> bool {
        let is_next = self.peek() == Some(character);
        if is_next {
            self.at += character.len_utf8();
        }
        is_next
    }

    fn expect(&mut self, character: char) -> Parsed<()> {
        match self.skip(character) {
            true => Ok(()),
            false => Err(self.unexpected(&format!("'{character}'"))),
        }
    }

    fn unexpected(&mut self, expected: &str) -> Box<Diagnostic> {
        let (message, length) = match self.peek() {
            Some(found) => (
                format!("'{found}' where {expected} is expected"),
                found.len_utf8(),
            ),
            None => (
                format!("the definition ends where {expected} is expected"),
                0,
            ),
        };
        Box::new(Diagnostic::error(message).at(&self.place.within(self.at..self.at + length)))
    }

    fn made(&self, range: Range<usize>, kind: Kind) -> Expression {
        Expression {
            place: self.place.within(range),
            kind,
        }
    }

    /// Parses with a part that nests one level deeper.
    fn deeper<T>(&mut self, part: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == MAX_DEPTH {
            let place = self.place.within(self.at..self.at + 1);
            let deep = format!("the definition nests more than {MAX_DEPTH} levels");
            return Err(Box::new(Diagnostic::error(deep).at(&place)));
        }
        self.depth += 1;
        let result = part(self);
        self.depth -= 1;
        result
    }

    fn union(&mut self) -> Parsed<Expression> {
        self.peek();
        let start = self.at;
        let mut parts = vec![self.sum()?];
        while self.skip('|') {
            parts.push(self.sum()?);
        }
        Ok(match parts.len() {
            1 => parts.remove(0),
            _ => self.made(start..self.at, Kind::Union(parts)),
        })
    }

    fn sum(&mut self) -> Parsed<Expression> {
        let signs = [('+', Operator::Plus), ('-', Operator::Minus)];
        self.chain(signs.as_slice(), Self::product, Kind::Sum)
    }

    fn product(&mut self) -> Parsed<Expression> {
        let signs = [
            ('*', Operator::Times),
            ('/', Operator::Over),
            ('%', Operator::Modulo),
        ];
        self.chain(signs.as_slice(), Self::unary, Kind::Product)
    }

    fn chain(
        &mut self,
        signs: &[(char, Operator)],
        part: fn(&mut Self) -> Parsed<Expression>,
        kind: fn(Vec<(Operator, Expression)>) -> Kind,
    ) -> Parsed<Expression> {
        self.peek();
        let start = self.at;
        let mut parts = vec![(signs[0].1, part(self)?)];
        loop {
            let next = signs.iter().find(|(sign, _)| self.skip(*sign));
            let Some((_, operator)) = next else { break };
            parts.push((*operator, part(self)?));
        }
        Ok(match parts.len() {
            1 => parts.remove(0).1,
            _ => self.made(start..self.at, kind(parts)),
        })
    }

    fn unary(&mut self) -> Parsed<Expression> {
        self.peek();
        let start = self.at;
        if self.skip('-') {
            let inner = self.deeper(Self::unary)?;
            return Ok(self.made(start..self.at, Kind::Minus(inner.into())));
        }
        let base = self.postfix()?;
        if !self.skip('^') {
            return Ok(base);
        }
        // A sign before an exponent belongs to it, and so does a further exponent.
        let exponent = self.deeper(Self::unary)?;
        Ok(self.made(start..self.at, Kind::Power(base.into(), exponent.into())))
    }

    fn postfix(&mut self) -> Parsed<Expression> {
        let mut expression = self.primary()?;
        let start = expression.place.range().start - self.place.range().start;
        let mut levels = 0;
        while self.peek() == Some('[') {
            levels += 1;
            if levels > MAX_DEPTH {
                return Err(self.unexpected("an operator"));
            }
            let indices = self.list('[', ']')?;
            let element = Kind::Element(expression.into(), indices);
            expression = self.made(start..self.at, element);
        }
        Ok(expression)
    }

    fn list(&mut self, open: char, close: char) -> Parsed<Vec<Expression>> {
        self.expect(open)?;
        let mut items = Vec::new();
        if self.skip(close) {
            return Ok(items);
        }
        loop {
            items.push(self.deeper(Self::union)?);
            if !self.skip(',') {
                self.expect(close)?;
                return Ok(items);
            }
        }
    }

    fn primary(&mut self) -> Parsed<Expression> {
        let next = self.peek();
        let start = self.at;
        match next {
            Some('(') => {
                self.skip('(');
                let inner = self.deeper(Self::union)?;
                self.expect(')')?;
                Ok(Expression {
                    place: self.place.within(start..self.at),
                    ..inner
                })
            }
            Some('[') => {
                let items = self.list('[', ']')?;
                Ok(self.made(start..self.at, Kind::List(items)))
            }
            Some(digit) if digit.is_ascii_digit() || digit == '.' => self.number(),
            Some(letter) if is_in_name(letter) || letter == '$' => {
                let rest = &self.text[start..];
                let mark = usize::from(letter == '$');
                let end = rest[mark..].find(|c| !is_in_name(c));
                let name = rest[..end.map_or(rest.len(), |end| mark + end)].to_owned();
                self.at += name.len();
                if self.peek() != Some('(') {
                    return Ok(self.made(start..start + name.len(), Kind::Name(name)));
                }
                let arguments = self.list('(', ')')?;
                Ok(self.made(start..self.at, Kind::Call(name, arguments)))
            }
            _ => Err(self.unexpected("a number, a name, '(' or '['")),
        }
    }

    fn number(&mut self) -> Parsed<Expression> {
        let start = self.at;
        let rest = &self.text[start..];
        let digits = |text: &str| {
            let end = text.find(|c: char| !c.is_ascii_digit() && c != '.');
            end.unwrap_or(text.len())
        };
        let mut length = digits(rest);
        // An exponent: e, a sign, digits.
        if let Some(exponent) = rest[length..].strip_prefix(['e', 'E']) {
            let unsigned = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            let whole = unsigned.len()
                - unsigned
                    .trim_start_matches(|c: char| c.is_ascii_digit())
                    .len();
            if whole > 0 {
                length += 1 + exponent.len() - unsigned.len() + whole;
            }
        }
        self.at += length;
        let place = self.place.within(start..self.at);
        match rest[..length]
            .parse::<f64>()
            .ok()
            .filter(|it| it.is_finite())
        {
            Some(value) => Ok(Expression {
                place,
                kind: Kind::Number(value),
            }),
            None => {
                let message = format!("'{}' is not a number", &rest[..length]);
                Err(Box::new(Diagnostic::error(message).at(&place)))
            }
        }
    }
}
