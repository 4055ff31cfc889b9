//! Writing of nodes as YAML.

use super::scalar::{number, resolve};
use crate::document::node::{Key, Node, Value};

/// Maximum width in columns of collections in flow style.
const WIDTH: usize = 80;
/// Maximum length in characters of a key without an explicit '?', less the quotes (YAML allows 1024).
const LONG_KEY: usize = 1000;

/// Writes a node as YAML, with a final line end.
pub(in crate::document) fn write(node: &Node) -> String {
    let mut out = String::new();
    match &node.value {
        Value::Sequence(items) if !items.is_empty() => sequence(&mut out, items, 0, false),
        Value::Mapping(entries) if !entries.is_empty() => mapping(&mut out, entries, 0, false),
        _ => {
            out += &flow(node, true).unwrap_or_default();
            out.push('\n');
        }
    }
    out
}

/// Writes the lines of a list. The first line is not indented if it follows a '- '.
fn sequence(out: &mut String, items: &[Node], indent: usize, mut inline: bool) {
    for item in items {
        pad(out, if inline { 0 } else { indent });
        inline = false;
        out.push('-');
        value(out, item, indent + 2, true);
    }
}

/// Writes the lines of a mapping. The first line is not indented if it follows a '- '.
fn mapping(out: &mut String, entries: &[(Key, Node)], indent: usize, mut inline: bool) {
    for (key, node) in entries {
        pad(out, if inline { 0 } else { indent });
        inline = false;
        let key = scalar_key(&key.name, false);
        if key.chars().count() > LONG_KEY {
            *out += &format!("? {key}\n{:indent$}:", "");
        } else {
            *out += &key;
            out.push(':');
        }
        value(out, node, indent + 2, false);
    }
}

/// Writes a value after a '-' or ':', up to the end of its line or lines.
fn value(out: &mut String, node: &Node, indent: usize, behind_dash: bool) {
    let column = out.len() - out.rfind('\n').map_or(0, |end| end + 1);
    let fits = |text: &String| column + 1 + text.chars().count() <= WIDTH;
    match &node.value {
        Value::Text(text) => match literal(text, indent) {
            Some(lines) => *out += &format!(" {lines}"),
            None => *out += &format!(" {}\n", scalar_text(text, false)),
        },
        Value::Sequence(items) if !items.is_empty() => match flow(node, false).filter(fits) {
            Some(text) => *out += &format!(" {text}\n"),
            None => {
                out.push(if behind_dash { ' ' } else { '\n' });
                sequence(out, items, indent, behind_dash);
            }
        },
        Value::Mapping(entries) if !entries.is_empty() => match flow(node, false).filter(fits) {
            Some(text) => *out += &format!(" {text}\n"),
            None => {
                out.push(if behind_dash { ' ' } else { '\n' });
                mapping(out, entries, indent, behind_dash);
            }
        },
        _ => *out += &format!(" {}\n", flow(node, true).unwrap_or_default()),
    }
}

/// Formats a value in flow style: a scalar, a list of scalars, or a mapping of both. Returns `None` for
/// values that read better in block style. At the `root`, a text is written as in block style.
fn flow(node: &Node, root: bool) -> Option<String> {
    match &node.value {
        Value::Null => Some("null".to_owned()),
        Value::Bool(value) => Some(value.to_string()),
        Value::Number(value) => Some(number(*value)),
        Value::Text(text) if literal(text, 2).is_some() && !root => None,
        Value::Text(text) => Some(scalar_text(text, !root)),
        Value::Sequence(items) => {
            let items: Option<Vec<_>> = items
                .iter()
                .map(|item| flow(item, false).filter(|_| is_scalar(item)))
                .collect();
            Some(format!("[{}]", items?.join(", ")))
        }
        Value::Mapping(entries) => {
            let entries: Option<Vec<_>> = entries.iter().map(flow_entry).collect();
            Some(format!("{{{}}}", entries?.join(", ")))
        }
    }
}

fn flow_entry((key, node): &(Key, Node)) -> Option<String> {
    match &node.value {
        // Block style avoids quotes that only flow style requires.
        Value::Text(text) if needs_quotes(text, true) && !needs_quotes(text, false) => None,
        Value::Mapping(entries) if !entries.is_empty() => None,
        _ => Some(format!(
            "{}: {}",
            scalar_key(&key.name, true),
            flow(node, false)?
        )),
    }
}

fn is_scalar(node: &Node) -> bool {
    !matches!(node.value, Value::Sequence(_) | Value::Mapping(_))
}

fn pad(out: &mut String, indent: usize) {
    out.extend(std::iter::repeat_n(' ', indent));
}

/// Formats a text of several lines as a block scalar, if that is possible.
fn literal(text: &str, indent: usize) -> Option<String> {
    let (lines, header) = text
        .strip_suffix('\n')
        .map_or((text, "|-\n"), |lines| (lines, "|\n"));
    let printable = |line: &str| {
        let blank = line.trim().is_empty();
        !line.contains(must_escape) && !line.starts_with('\t') && (line.is_empty() || !blank)
    };
    let suits = text.contains('\n')
        && !lines.ends_with('\n')
        && !lines.starts_with(char::is_whitespace)
        && !lines.is_empty()
        && lines.split('\n').all(printable);
    suits.then(|| {
        let mut out = header.to_owned();
        for line in lines.split('\n') {
            pad(&mut out, if line.is_empty() { 0 } else { indent });
            out += line;
            out.push('\n');
        }
        out
    })
}

pub(in crate::document) fn scalar_key(name: &str, flow: bool) -> String {
    if name == "<<" {
        quoted(name)
    } else {
        scalar_key_text(name, flow)
    }
}

/// Formats a key. A number needs no quotes as a key, which is always text.
fn scalar_key_text(name: &str, flow: bool) -> String {
    let plain = matches!(resolve(name), Value::Number(_)) && !name.is_empty();
    if plain {
        name.to_owned()
    } else {
        scalar_text(name, flow)
    }
}

pub(in crate::document) fn scalar_text(text: &str, flow: bool) -> String {
    if needs_quotes(text, flow) {
        quoted(text)
    } else {
        text.to_owned()
    }
}

/// Words that this or another YAML parser does not resolve to text.
const WORDS: [&str; 13] = [
    "true", "false", "yes", "no", "on", "off", "null", "~", "=", "<<", ".nan", ".inf", "+.inf",
];

fn needs_quotes(text: &str, flow: bool) -> bool {
    let lower = text.to_ascii_lowercase();
    let starts_as_else = match text.as_bytes() {
        [] => true,
        [b'-'] => true,
        [b'-', next, ..] => next.is_ascii_whitespace() || text.starts_with("---"),
        [
            b',' | b'[' | b']' | b'{' | b'}' | b'#' | b'&' | b'*' | b'!' | b'|' | b'>',
            ..,
        ] => true,
        [b'\'' | b'"' | b'%' | b'@' | b'`' | b'?' | b':', ..] => true,
        _ => text.starts_with("..."),
    };
    starts_as_else
        || !matches!(resolve(text), Value::Text(_))
        || WORDS.contains(&lower.as_str())
        || lower == "-.inf"
        || text.starts_with(char::is_whitespace)
        || text.ends_with(char::is_whitespace)
        || text.ends_with(':')
        || text.contains(": ")
        || text.contains(" #")
        || text.contains(must_escape)
        || text.contains(['\t', '\n'])
        || (flow && text.contains([',', '[', ']', '{', '}']))
}

fn must_escape(c: char) -> bool {
    (c.is_control() && c != '\n' && c != '\t') || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}')
}

fn quoted(text: &str) -> String {
    let escapes = text.contains(|c: char| c.is_control() || must_escape(c));
    if text.contains(['"', '\\']) && !escapes {
        return format!("'{}'", text.replace('\'', "''"));
    }
    let mut out = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out += "\\n",
            '\t' => out += "\\t",
            _ if must_escape(c) => out += &format!("\\u{:04x}", u32::from(c)),
            _ => out.push(c),
        }
    }
    out.push('"');
    out
}
