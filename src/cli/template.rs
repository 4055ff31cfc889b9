//! Names of files with placeholders for numbers and values, as `tree-%03s.png` or `tree-%{angle}.png`.

use std::convert::Infallible;

/// Name with placeholders.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Template(Vec<Part>);

#[derive(Clone, Debug, PartialEq)]
enum Part {
    Text(String),
    /// Placeholder, and the least number of its digits.
    Place(Placeholder, usize),
}

/// Place in a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Placeholder {
    /// Whole number with a letter of its own: `%d`.
    Number(char),
    /// Value of the parameter of this name: `%{angle}`.
    Value(String),
}

impl Template {
    /// Parses a name, in which the given letters stand for numbers. `%03d` has at least three digits, and `%%` is a percent
    /// sign.
    pub(super) fn parse(name: &str, letters: &str) -> Result<Self, String> {
        const MOST_DIGITS: usize = 20;
        let mut parts = Vec::new();
        let mut text = String::new();
        let mut rest = name;
        while let Some((before, after)) = rest.split_once('%') {
            text.push_str(before);
            if let Some(after) = after.strip_prefix('%') {
                text.push('%');
                rest = after;
                continue;
            }
            let end = |at: usize| format!("%{}", after.chars().take(at + 1).collect::<String>());
            let (place, digits, next) = match after.strip_prefix('{') {
                Some(inside) => {
                    let (name, next) = { inside.split_once('}') }
                        .ok_or_else(|| format!("'%{after}' has no closing brace"))?;
                    (Placeholder::Value(name.to_owned()), 1, next)
                }
                None => {
                    let other = after.find(|it: char| !it.is_ascii_digit());
                    let at = other.unwrap_or(after.len());
                    let letter = after[at..].chars().next();
                    let letter = { letter.filter(|letter| letters.contains(*letter)) }
                        .ok_or_else(|| format!("'{}' is no placeholder", end(at)))?;
                    let digits = match &after[..at] {
                        "" => Some(1),
                        digits => digits.strip_prefix('0').and_then(|it| it.parse().ok()),
                    };
                    let digits = { digits.filter(|digits| *digits <= MOST_DIGITS) }
                        .ok_or_else(|| format!("'{}' is no placeholder", end(at)))?;
                    (Placeholder::Number(letter), digits, &after[at + 1..])
                }
            };
            parts.push(Part::Text(std::mem::take(&mut text)));
            parts.push(Part::Place(place, digits));
            rest = next;
        }
        text.push_str(rest);
        parts.push(Part::Text(text));
        Ok(Self(parts))
    }

    /// Iterates over the placeholders.
    pub(super) fn placeholders(&self) -> impl Iterator<Item = &Placeholder> {
        self.0.iter().filter_map(|part| match part {
            Part::Text(_) => None,
            Part::Place(place, _) => Some(place),
        })
    }

    /// Returns the name with the text of each placeholder.
    pub(super) fn fill<E>(
        &self,
        text: impl Fn(&Placeholder) -> Result<String, E>,
    ) -> Result<String, E> {
        let mut name = String::new();
        for part in &self.0 {
            match part {
                Part::Text(text) => name.push_str(text),
                Part::Place(place, digits) => name.push_str(&format!("{:0>digits$}", text(place)?)),
            }
        }
        Ok(name)
    }
}

/// Name with one place for a number, written `%d` or `%06d`.
pub(super) struct NumberedName(Template);

impl NumberedName {
    /// Parses a name; `None` unless it has one place.
    pub(super) fn parse(name: &str) -> Option<Self> {
        let template = Template::parse(name, "d").ok()?;
        let places: Vec<_> = template.placeholders().collect();
        matches!(places[..], [Placeholder::Number(_)]).then_some(Self(template))
    }

    pub(super) fn with(&self, number: u64) -> String {
        let filled = self.0.fill(|_| Ok::<_, Infallible>(number.to_string()));
        filled.unwrap_or_else(|never| match never {})
    }
}

#[cfg(test)]
mod tests {
    use super::{Placeholder, Template};

    #[test]
    fn placeholders_are_filled_and_percent_signs_kept() {
        let name = |text: &str| {
            Template::parse(text, "ns")?.fill(|place| {
                Ok::<_, String>(match place {
                    Placeholder::Number('s') => "7".to_owned(),
                    Placeholder::Number(letter) => letter.to_string(),
                    Placeholder::Value(name) => format!("<{name}>"),
                })
            })
        };
        for (text, expected) in [
            ("plain.svg", "plain.svg"),
            ("100%%.svg", "100%.svg"),
            ("%%s", "%s"),
            ("%s-%03s-%n%{angle}", "7-007-n<angle>"),
            ("ä%sö", "ä7ö"),
        ] {
            assert_eq!(name(text).unwrap(), expected, "{text}");
        }
        for (text, message) in [
            ("a%", "'%' is no placeholder"),
            ("%ä", "'%ä' is no placeholder"),
            ("%x.svg", "'%x' is no placeholder"),
            ("%3s", "'%3s' is no placeholder"),
            ("%099s", "'%099s' is no placeholder"),
            ("%{angle", "'%{angle' has no closing brace"),
        ] {
            assert_eq!(name(text).unwrap_err(), message, "{text}");
        }
    }
}
