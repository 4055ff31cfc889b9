//! Lexical analysis: tokens, and errors for characters and signs outside of the grammar.

use std::ops::Range;

use super::ExpressionError;
use super::operator::Two;

/// A token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Truth(bool),
    Name,
    Infix(Two),
    Not,
    Open,
    Close,
    Comma,
    End,
}

/// Returns the token at or after byte `at`, with its range. [`Token::End`] has an empty range at the
/// end.
pub(super) fn token(text: &str, at: usize) -> Result<(Token, Range<usize>), ExpressionError> {
    let blank = |c: char| c.is_ascii_whitespace();
    let rest = text[at..].trim_start_matches(blank);
    let start = text.len() - rest.len();
    let Some(first) = rest.chars().next() else {
        return Ok((Token::End, start..start));
    };
    if is_digit(first) || first == '.' && rest[1..].starts_with(is_digit) {
        return number(text, start);
    }
    if first.is_ascii_alphabetic() || first == '_' {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let mut length = prefix(rest, is_part);
        // The suffix for a part of a complex number.
        if let Some(after) = PARTS.iter().find_map(|it| rest[length..].strip_prefix(it))
            && !after.starts_with(is_part)
        {
            length = rest.len() - after.len();
        }
        return Ok((word(&rest[..length]), start..start + length));
    }
    if let Some((sign, hint)) = FOREIGN.iter().find(|(sign, _)| rest.starts_with(sign)) {
        let message = format!("'{sign}' is not an operator");
        return Err(ExpressionError::new(start..start + sign.len(), message).hint(*hint));
    }
    if let Some((sign, token)) = SIGNS.iter().find(|(sign, _)| rest.starts_with(sign)) {
        return Ok((*token, start..start + sign.len()));
    }
    if [".inf", ".nan"].iter().any(|word| rest.starts_with(word)) {
        let message = "this number is not finite";
        return Err(ExpressionError::new(start..start + 4, message)
            .hint("all numbers of a rule are finite"));
    }
    let range = start..start + first.len_utf8();
    Err(foreign_character(first, range))
}

/// Returns whether a text is valid as the name of a parameter: letters, digits and `_`, beginning with
/// a letter.
pub(crate) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Suffixes of the name of a complex number for its real part and its imaginary part.
pub(crate) const PARTS: [&str; 2] = [".re", ".im"];

/// Signs of the grammar. A sign precedes every shorter one that it starts with.
const SIGNS: [(&str, Token); 18] = [
    ("||", Token::Infix(Two::Or)),
    ("&&", Token::Infix(Two::And)),
    ("<=", Token::Infix(Two::LessEqual)),
    (">=", Token::Infix(Two::GreaterEqual)),
    ("==", Token::Infix(Two::Equal)),
    ("!=", Token::Infix(Two::NotEqual)),
    ("<", Token::Infix(Two::Less)),
    (">", Token::Infix(Two::Greater)),
    ("!", Token::Not),
    ("+", Token::Infix(Two::Add)),
    ("-", Token::Infix(Two::Subtract)),
    ("*", Token::Infix(Two::Multiply)),
    ("/", Token::Infix(Two::Divide)),
    ("%", Token::Infix(Two::Modulo)),
    ("^", Token::Infix(Two::Power)),
    ("(", Token::Open),
    (")", Token::Close),
    (",", Token::Comma),
];

/// Signs of other languages that start with a sign of the grammar, with help texts.
const FOREIGN: [(&str, &str); 9] = [
    ("**", "write ^ for powers"),
    ("//", "write floor(a / b)"),
    ("<>", "write !="),
    ("=<", "write <="),
    ("=>", "write >="),
    ("===", "write =="),
    ("!==", "write !="),
    ("<<", "write a * 2^b"),
    (">>", "write floor(a / 2^b)"),
];

fn foreign_character(character: char, range: Range<usize>) -> ExpressionError {
    let hint = match character {
        '=' => "write == to compare",
        '&' => "write and",
        '|' => "write or",
        '?' | ':' => "write if(condition, then, otherwise)",
        '[' | ']' | '{' | '}' => "write round brackets: ( )",
        ';' => "a comma separates arguments",
        '.' => "a decimal number has digits after its point: 0.5",
        '"' | '\'' | '`' => "an expression has no quotation marks inside",
        '$' | '@' | '#' => "write the name by itself",
        '×' | '·' | '∙' | '⋅' | '∗' => "write *",
        '÷' | '∕' | '⁄' => "write /",
        '−' | '–' | '—' => "write - (the minus sign of the keyboard)",
        '√' => "write sqrt(x)",
        '²' => "write ^2",
        '³' => "write ^3",
        '½' => "write 1/2",
        'π' => "write pi",
        'φ' | 'ϕ' | 'Φ' => "write phi",
        '°' => "leave it out: angles are in degrees",
        '≤' => "write <=",
        '≥' => "write >=",
        '≠' => "write !=",
        '∧' => "write and",
        '∨' => "write or",
        '¬' => "write not",
        '\u{a0}' | '\u{202f}' | '\u{2009}' => "write an ordinary space",
        _ if character.is_alphabetic() => "names are written with A to Z, a to z, 0 to 9 and _",
        _ => "the operators are + - * / % ^ == != < <= > >= and or not",
    };
    let shown = character.escape_debug();
    ExpressionError::new(range, format!("'{shown}' does not belong in an expression")).hint(hint)
}

fn word(word: &str) -> Token {
    match word {
        "and" => Token::Infix(Two::And),
        "or" => Token::Infix(Two::Or),
        "not" => Token::Not,
        "true" => Token::Truth(true),
        "false" => Token::Truth(false),
        _ => Token::Name,
    }
}

/// Reads the number at `start`: digits, an optional fraction and an optional power of ten.
fn number(text: &str, start: usize) -> Result<(Token, Range<usize>), ExpressionError> {
    let rest = &text[start..];
    let mut length = prefix(rest, is_digit);
    if let Some(fraction) = rest[length..].strip_prefix('.') {
        let digits = prefix(fraction, is_digit);
        length += 1 + digits;
        if digits == 0 {
            let hint = format!("write {}", &rest[..length - 1]);
            let message = "digits are missing after the point";
            return Err(ExpressionError::new(start..start + length, message).hint(hint));
        }
    }
    if let Some(exponent) = rest[length..].strip_prefix(['e', 'E']) {
        let digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        // Otherwise this is the constant e after a missing operator.
        if digits.starts_with(is_digit) {
            length = rest.len() - digits.len() + prefix(digits, is_digit);
        }
    }
    let range = start..start + length;
    let after = &rest[length..];
    if after.starts_with('.') {
        let range = start..start + length + prefix(after, |c| is_digit(c) || c == '.');
        return Err(ExpressionError::new(
            range,
            "a number has one decimal point",
        ));
    }
    if let Some(digits) = after.strip_prefix('_')
        && digits.starts_with(is_digit)
    {
        let range = start..range.end + prefix(after, |c| is_digit(c) || c == '_');
        let hint = format!("write {}", text[range.clone()].replace('_', ""));
        return Err(ExpressionError::new(range, "a number has no separators").hint(hint));
    }
    match rest[..length].parse() {
        Ok(value) if f64::is_finite(value) => Ok((Token::Number(value), range)),
        _ => Err(ExpressionError::new(range, "this number is too large")
            .hint("the largest is about 1.8e308")),
    }
}

pub(super) fn is_digit(character: char) -> bool {
    character.is_ascii_digit()
}

/// Returns the length in bytes of the longest prefix whose characters all satisfy a predicate.
fn prefix(text: &str, such: impl Fn(char) -> bool) -> usize {
    text.find(|c| !such(c)).unwrap_or(text.len())
}
