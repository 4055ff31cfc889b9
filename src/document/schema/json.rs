//! JSON values whose objects keep the order of insertion.

use std::fmt::{self, Display, Write};

/// A JSON value.
pub(super) enum Json {
    Null,
    Bool(bool),
    Number(u32),
    Text(String),
    List(Vec<Json>),
    Object(Object),
}

/// A JSON object.
#[derive(Default)]
pub(super) struct Object(pub(super) Vec<(String, Json)>);

impl Object {
    /// Appends a key, which must be new.
    pub(super) fn with(mut self, key: &str, value: impl Into<Json>) -> Self {
        self.0.push((key.into(), value.into()));
        self
    }

    /// Appends a key if there is a value.
    pub(super) fn with_some(self, key: &str, value: Option<impl Into<Json>>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// Appends the entries of another object, which must have no keys in common.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.0.iter().any(|(known, _)| known == key)
    }

    /// Serializes the object as indented text.
    pub(super) fn to_text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text, "\n");
        text + "\n"
    }

    /// Appends the object to `text`, whose lines begin as `line` does.
    fn write(&self, text: &mut String, line: &str) {
        write_all(
            text,
            line,
            ['{', '}'],
            &self.0,
            |text, line, (key, value)| {
                *text += &format!("{}: ", Quoted(key));
                value.write(text, line);
            },
        );
    }
}

impl Json {
    fn write(&self, text: &mut String, line: &str) {
        match self {
            Self::Null => *text += "null",
            Self::Bool(value) => *text += &value.to_string(),
            Self::Number(value) => *text += &value.to_string(),
            Self::Text(value) => *text += &Quoted(value).to_string(),
            Self::List(items) => {
                write_all(text, line, ['[', ']'], items, |text, line, item| {
                    item.write(text, line);
                });
            }
            Self::Object(object) => object.write(text, line),
        }
    }
}

/// Appends items in brackets, each in a line of its own.
fn write_all<T>(
    text: &mut String,
    line: &str,
    [open, close]: [char; 2],
    items: &[T],
    write: impl Fn(&mut String, &str, &T),
) {
    let inner = format!("{line}  ");
    text.push(open);
    for (place, item) in items.iter().enumerate() {
        *text += if place > 0 { "," } else { "" };
        *text += &inner;
        write(text, &inner, item);
    }
    *text += if items.is_empty() { "" } else { line };
    text.push(close);
}

/// A JSON string.
struct Quoted<'a>(&'a str);

impl Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('"')?;
        for character in self.0.chars() {
            match character {
                '"' | '\\' => write!(f, "\\{character}")?,
                '\n' => f.write_str("\\n")?,
                control if control.is_ascii_control() => {
                    write!(f, "\\u{:04x}", u32::from(control))?
                }
                other => f.write_char(other)?,
            }
        }
        f.write_char('"')
    }
}

/// Creates a list of values.
pub(super) fn list<T: Into<Json>>(values: impl IntoIterator<Item = T>) -> Json {
    Json::List(values.into_iter().map(Into::into).collect())
}

impl From<bool> for Json {
    fn from(value: bool) -> Self {
        Self::Bool(value)
    }
}

impl From<u32> for Json {
    fn from(value: u32) -> Self {
        Self::Number(value)
    }
}

impl From<&str> for Json {
    fn from(value: &str) -> Self {
        Self::Text(value.into())
    }
}

impl From<String> for Json {
    fn from(value: String) -> Self {
        Self::Text(value)
    }
}

impl From<Object> for Json {
    fn from(value: Object) -> Self {
        Self::Object(value)
    }
}
