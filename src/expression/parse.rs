//! Operator-precedence parser (Pratt 1973, "Top down operator precedence").

use std::ops::Range;

use super::functions::{FUNCTIONS, Function};
use super::lex::{self, Token};
use super::operator::{LOOSEST, NEGATE, NOT, One, POWER, Two};
use super::scope;
use super::{Expression, ExpressionError, Node};
use crate::diagnostic::nearest;

const MAX_BYTES: usize = 4096;
/// Maximum nesting depth of parentheses, prefix operators and powers, which the parser handles by
/// recursion.
const MAX_LEVELS: usize = 64;
/// Maximum number of operators: a chain of operators is a tree of the same depth, which is visited
/// recursively.
const MAX_OPERATORS: usize = 256;

const FLOW_STYLE: &str = "in YAML's flow style a comma ends the value: quote it, or write it on \
                          a line of its own";

type Parsed<T = Expression> = Result<T, ExpressionError>;

pub(super) fn parse(text: &str) -> Parsed {
    if text.len() > MAX_BYTES {
        let message = format!("this is too long: {} bytes", text.len());
        let hint = format!("{MAX_BYTES} bytes at most");
        return Err(ExpressionError::new(0..text.len(), message).hint(hint));
    }
    let (token, range) = lex::token(text, 0)?;
    if token == Token::End {
        let error = ExpressionError::new(0..text.len(), "an expression is missing");
        return Err(error.hint("write a number or a formula, such as sqrt(3)/6"));
    }
    let mut parser = Parser {
        text,
        token,
        range,
        previous: 0..0,
        open: Vec::new(),
        levels: 0,
        operators: 0,
    };
    let expression = parser.expression(LOOSEST)?;
    match parser.token {
        Token::End => Ok(expression),
        Token::Comma => Err(parser.stray_comma()),
        // Only a closing parenthesis ends an expression here; other tokens are reported as a missing
        // operator.
        _ => Err(ExpressionError::new(parser.range, "no bracket is open here").hint(FLOW_STYLE)),
    }
}

struct Parser<'t> {
    text: &'t str,
    /// The next token; its range follows.
    token: Token,
    range: Range<usize>,
    /// Range of the previous token.
    previous: Range<usize>,
    /// The open parentheses, and whether each encloses arguments.
    open: Vec<(Range<usize>, bool)>,
    levels: usize,
    operators: usize,
}

impl Parser<'_> {
    /// Parses an expression whose infix operators outside of parentheses have at least the precedence
    /// `floor`.
    fn expression(&mut self, floor: u8) -> Parsed {
        let mut left = self.operand(floor)?;
        let mut compared = false;
        loop {
            let operator = match self.token {
                Token::Infix(operator) => operator,
                Token::Close | Token::Comma | Token::End => return Ok(left),
                Token::Number(_) | Token::Truth(_) | Token::Name | Token::Not | Token::Open => {
                    return Err(self.missing_operator());
                }
            };
            let precedence = operator.precedence();
            if precedence < floor {
                return Ok(left);
            }
            if compared && operator.is_comparison() {
                return Err(self.chained(&left, operator));
            }
            compared = operator.is_comparison();
            self.count_operator()?;
            self.advance()?;
            let right = if operator == Two::Power {
                self.deeper(|parser| parser.expression(POWER))?
            } else {
                self.expression(precedence + 1)?
            };
            let range = left.range.start..right.range.end;
            let node = Node::Infix(operator, Box::new([left, right]));
            left = Expression { node, range };
        }
    }

    fn operand(&mut self, floor: u8) -> Parsed {
        let range = self.range.clone();
        let node = match self.token {
            Token::Number(value) => Node::Number(value),
            Token::Truth(value) => Node::Truth(value),
            Token::Name => return self.name(),
            Token::Open => return self.brackets(),
            Token::Infix(Two::Subtract) => return self.prefix(One::Negate, NEGATE),
            Token::Not if floor <= NOT => return self.prefix(One::Not, NOT),
            Token::Not => {
                let error = ExpressionError::new(range, "'not' binds less tightly than this");
                return Err(error.hint("write (not ...)"));
            }
            Token::End => return Err(self.ended("a value is missing at the end")),
            Token::Infix(_) | Token::Close | Token::Comma => return Err(self.missing_value()),
        };
        self.advance()?;
        Ok(Expression { node, range })
    }

    fn prefix(&mut self, operator: One, precedence: u8) -> Parsed {
        let start = self.range.start;
        self.count_operator()?;
        let operand = self.deeper(|parser| {
            parser.advance()?;
            parser.expression(precedence)
        })?;
        let range = start..operand.range.end;
        let node = Node::Prefix(operator, Box::new(operand));
        Ok(Expression { node, range })
    }

    fn brackets(&mut self) -> Parsed {
        let start = self.range.start;
        self.open.push((self.range.clone(), false));
        let inner = self.deeper(|parser| {
            parser.advance()?;
            parser.expression(LOOSEST)
        })?;
        let range = start..self.range.end;
        self.close()?;
        Ok(Expression { range, ..inner })
    }

    fn name(&mut self) -> Parsed {
        let range = self.range.clone();
        let name = &self.text[range.clone()];
        self.advance()?;
        let function = Function::find(name);
        if self.token == Token::Open {
            return match function {
                Some(function) => self.call(function, range.start),
                None => Err(unknown_function(name, range)),
            };
        }
        if let Some(function) = function {
            let message = format!("'{name}' is a function: its arguments are missing");
            let hint = format!("write {}", function.signature());
            return Err(ExpressionError::new(range, message).hint(hint));
        }
        let node = Node::Name(name.to_owned());
        Ok(Expression { node, range })
    }

    fn call(&mut self, function: &'static Function, start: usize) -> Parsed {
        self.open.push((self.range.clone(), true));
        let arguments = self.deeper(Self::arguments)?;
        let range = start..self.range.end;
        self.close()?;
        if !function.accepts(arguments.len()) {
            let hint = self
                .decimal_comma(&arguments)
                .unwrap_or_else(|| format!("write {}", function.signature()));
            let message = function.arity_message(arguments.len());
            return Err(ExpressionError::new(range, message).hint(hint));
        }
        let node = Node::Call(function, arguments);
        Ok(Expression { node, range })
    }

    /// Parses the arguments of a call.
    fn arguments(&mut self) -> Parsed<Vec<Expression>> {
        let mut arguments = Vec::new();
        self.advance()?;
        if self.token == Token::Close {
            return Ok(arguments);
        }
        loop {
            arguments.push(self.expression(LOOSEST)?);
            if self.token != Token::Comma {
                return Ok(arguments);
            }
            self.advance()?;
        }
    }

    /// Consumes the closing parenthesis.
    fn close(&mut self) -> Parsed<()> {
        match self.token {
            Token::Close => {
                self.open.pop();
                self.advance()
            }
            Token::Comma => Err(self.stray_comma()),
            _ => Err(self.ended("a bracket is missing at the end")),
        }
    }

    fn advance(&mut self) -> Parsed<()> {
        let (token, range) = lex::token(self.text, self.range.end)?;
        self.previous = std::mem::replace(&mut self.range, range);
        self.token = token;
        Ok(())
    }

    /// Parses one nesting level deeper, and reports excessive depth at the next token.
    fn deeper<T>(&mut self, parse: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.levels == MAX_LEVELS {
            let error = ExpressionError::new(self.range.clone(), "this is nested too deeply");
            return Err(error.hint(format!("{MAX_LEVELS} levels at most")));
        }
        self.levels += 1;
        let parsed = parse(self)?;
        self.levels -= 1;
        Ok(parsed)
    }

    fn count_operator(&mut self) -> Parsed<()> {
        if self.operators == MAX_OPERATORS {
            let error = ExpressionError::new(self.range.clone(), "there are too many operators");
            return Err(error.hint(format!("{MAX_OPERATORS} at most")));
        }
        self.operators += 1;
        Ok(())
    }

    /// Returns the error for an unexpected end of the text.
    fn ended(&self, message: &str) -> ExpressionError {
        let Some((bracket, _)) = self.open.last() else {
            return ExpressionError::new(self.previous.clone(), message).hint(self.after_hint());
        };
        let hint = if self.open.iter().any(|(_, call)| *call) {
            FLOW_STYLE
        } else {
            "close it with )"
        };
        ExpressionError::new(bracket.clone(), "this bracket is not closed").hint(hint)
    }

    fn missing_value(&self) -> ExpressionError {
        let sign = &self.text[self.range.clone()];
        let message = format!("a value is missing before '{sign}'");
        let hint = match self.token {
            Token::Infix(Two::Add) => "leave the plus sign out".to_owned(),
            _ => self.after_hint(),
        };
        ExpressionError::new(self.range.clone(), message).hint(hint)
    }

    /// Returns the help text for a missing value after the previous token.
    fn after_hint(&self) -> String {
        match &self.text[self.previous.clone()] {
            "%" => "% is the remainder of a division; for 50 percent write 0.5".to_owned(),
            "" | "(" => "write a number, a name or a formula".to_owned(),
            last => format!("write a number, a name or a formula after '{last}'"),
        }
    }

    fn missing_operator(&self) -> ExpressionError {
        let left = match &self.text[self.previous.clone()] {
            ")" => "(...)",
            last => last,
        };
        let right = match &self.text[self.range.clone()] {
            "(" => "(...)".to_owned(),
            name if Function::find(name).is_some() => format!("{name}(...)"),
            next => next.to_owned(),
        };
        let hint = match right.to_lowercase().as_str() {
            "mod" => "write % for the remainder".to_owned(),
            word @ ("and" | "or") => format!("write {word}, in small letters"),
            "true" | "false" | "not" | "!" => "write and or or between them".to_owned(),
            _ if left == "true" || left == "false" => "write and or or between them".to_owned(),
            _ if self.open.last().is_some_and(|(_, call)| *call) => {
                format!("write {left} * {right}, or a comma between two values: {left}, {right}")
            }
            _ => format!("write {left} * {right}"),
        };
        let range = self.previous.start..self.range.end;
        ExpressionError::new(range, "an operator is missing here").hint(hint)
    }

    /// Returns the error for a second comparison after the comparison `left`.
    fn chained(&self, left: &Expression, second: Two) -> ExpressionError {
        let error = ExpressionError::new(self.range.clone(), "comparisons do not chain");
        let middle = match &left.node {
            Node::Infix(_, operands) => operands[1].to_string(),
            _ => "b".to_owned(),
        };
        let symbol = second.symbol();
        error.hint(format!("write {left} and {middle}{symbol}..."))
    }

    fn stray_comma(&self) -> ExpressionError {
        let (before, after) = (&self.text[..self.range.start], &self.text[self.range.end..]);
        let decimal = before.ends_with(lex::is_digit) && after.starts_with(lex::is_digit);
        let hint = if decimal {
            let units = before
                .rsplit(|c| !lex::is_digit(c))
                .next()
                .unwrap_or(before);
            let tenths = after.split(|c| !lex::is_digit(c)).next().unwrap_or(after);
            format!("write {units}.{tenths}: decimals follow a point")
        } else {
            "a comma stands only between the arguments of a function".to_owned()
        };
        ExpressionError::new(self.range.clone(), "a comma does not belong here").hint(hint)
    }

    /// Returns a help text if two adjacent arguments look like one number with a decimal comma.
    fn decimal_comma(&self, arguments: &[Expression]) -> Option<String> {
        arguments.windows(2).find_map(|pair| {
            let [units, tenths] = [&pair[0].range, &pair[1].range].map(|r| &self.text[r.clone()]);
            let numbers = units.ends_with(lex::is_digit) && tenths.starts_with(lex::is_digit);
            let adjacent = pair[0].range.end + 1 == pair[1].range.start;
            (numbers && adjacent)
                .then(|| format!("write {units}.{tenths}: decimals follow a point"))
        })
    }
}

fn unknown_function(name: &str, range: Range<usize>) -> ExpressionError {
    if scope::constant(name).is_some() {
        let message = format!("'{name}' is a number, not a function");
        return ExpressionError::new(range, message).hint(format!("write {name} * (...)"));
    }
    let functions = FUNCTIONS.each_ref().map(|function| function.name);
    // Suggests `cos` for `cosine`.
    let beginning = || {
        let begins = |function: &&str| function.len() > 2 && name.starts_with(function);
        functions.into_iter().find(begins)
    };
    let hint = nearest(name, functions).or_else(beginning);
    let hint = hint.map_or_else(
        || {
            let all = functions.join(", ");
            format!("to multiply, write {name} * (...); the functions are {all}")
        },
        |nearest| format!("did you mean '{nearest}'?"),
    );
    ExpressionError::new(range, format!("unknown function '{name}'")).hint(hint)
}
