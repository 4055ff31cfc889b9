//! Completion: keys and values that the schema allows at a place of a text.

use serde::Serialize;
use serde_json::Value;

use crate::catalogue::Shelf;
use crate::document::schema;
use crate::kind::Kind;

/// Word that may stand at a place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Completion {
    pub(super) word: String,
    about: String,
    /// Number of UTF-16 units before the place that the word replaces.
    pub(super) replaces: usize,
}

/// Largest number of words.
const MOST: usize = 60;

/// Returns the words that may stand at a position, in UTF-16 units, of a text.
pub(super) fn complete(text: &str, position: usize) -> Vec<Completion> {
    let wide: Vec<u16> = text.encode_utf16().take(position).collect();
    let before = String::from_utf16_lossy(&wide);
    let after = text.get(before.len()..).unwrap_or_default();
    let line = before.rsplit('\n').next().unwrap_or_default();
    if line.contains('#') {
        return Vec::new();
    }
    let Ok(root) = serde_json::from_str::<Value>(&schema(Shelf::Fractals(kind(text)))) else {
        return Vec::new();
    };
    let mut path = path(&before, line);
    let start = line.trim_start().trim_start_matches("- ");
    let (key, typed) = match start.rsplit_once(['{', ',', '[']) {
        Some((_, last)) if line.contains('{') => split(last),
        _ => split(start),
    };
    path.extend(key.map(str::to_owned));
    let nodes = path.iter().fold(vec![&root], |nodes, name| {
        let next = nodes.iter().flat_map(|node| below(&root, node, name));
        next.collect()
    });
    let mut words: Vec<(String, String)> = Vec::new();
    for node in nodes {
        match key {
            Some(_) => add_values(&root, node, &mut words, 0),
            None => add_keys(&root, node, &mut words, 0),
        }
    }
    words.sort();
    words.dedup_by(|a, b| a.0 == b.0);
    let rest = after.split(['\n', ':']).next().unwrap_or_default();
    let fits = |word: &str| word.starts_with(typed) && (word != typed || !rest.is_empty());
    let indentation = line.len() - line.trim_start().len();
    let is_known = |word: &str| key.is_none() && has_sibling(text, indentation, word);
    let fitting = words
        .into_iter()
        .filter(|(word, _)| fits(word) && !is_known(word));
    let completions = fitting.map(|(word, about)| Completion {
        word: match key {
            Some(_) => word,
            None => format!("{word}: "),
        },
        about,
        replaces: typed.encode_utf16().count(),
    });
    completions.take(MOST).collect()
}

/// Splits what stands in front of a place into a key, where there is one, and the beginning of a word.
fn split(text: &str) -> (Option<&str>, &str) {
    match text.split_once(':') {
        Some((key, typed)) => (Some(key.trim()), typed.trim_start()),
        None => (None, text.trim_start()),
    }
}

/// Returns the kind that a text gives.
fn kind(text: &str) -> Kind {
    let line = text.lines().find_map(|line| line.strip_prefix("kind:"));
    let name = line.map(|rest| rest.split('#').next().unwrap_or_default().trim());
    name.and_then(Kind::named).unwrap_or(Kind::Rule)
}

/// Returns whether a key stands in a text with this indentation.
fn has_sibling(text: &str, indentation: usize, key: &str) -> bool {
    indentation == 0
        && text.lines().any(|line| {
            line.strip_prefix(key)
                .is_some_and(|rest| rest.starts_with(':'))
        })
}

/// Returns the keys that enclose the last line, from the outermost.
fn path(before: &str, line: &str) -> Vec<String> {
    let indentation = |line: &str| line.len() - line.trim_start_matches([' ', '-']).len();
    let mut within = indentation(line);
    let mut path = Vec::new();
    // Keys before a brace of the same line enclose what is in it.
    if let Some((head, _)) = line.split_once('{')
        && let (Some(key), _) = split(head.trim_start().trim_start_matches("- "))
    {
        path.push(key.to_owned());
    }
    for line in before
        .lines()
        .rev()
        .skip(usize::from(!before.ends_with('\n')))
    {
        let own = indentation(line);
        if own < within && !line.trim().is_empty() && !line.trim_start().starts_with('#') {
            within = own;
            if let (Some(key), _) = split(line.trim_start().trim_start_matches("- ")) {
                path.push(key.to_owned());
            }
        }
    }
    path.reverse();
    path
}

/// Follows references and choices from a node of the schema.
fn each<'a>(root: &'a Value, node: &'a Value, depth: usize, visit: &mut impl FnMut(&'a Value)) {
    const DEEPEST: usize = 12;
    if depth > DEEPEST {
        return;
    }
    visit(node);
    let target = node
        .get("$ref")
        .and_then(Value::as_str)
        .and_then(|it| it.strip_prefix('#'));
    if let Some(target) = target.and_then(|it| root.pointer(it)) {
        each(root, target, depth + 1, visit);
    }
    for choice in ["allOf", "anyOf", "oneOf"] {
        let all = node.get(choice).and_then(Value::as_array);
        all.into_iter()
            .flatten()
            .for_each(|it| each(root, it, depth + 1, visit));
    }
    for one in ["items", "then", "else"] {
        node.get(one)
            .into_iter()
            .for_each(|it| each(root, it, depth + 1, visit));
    }
}

/// Returns the nodes below a key.
fn below<'a>(root: &'a Value, node: &'a Value, key: &str) -> Vec<&'a Value> {
    let mut found = Vec::new();
    each(root, node, 0, &mut |node| {
        let named = node.get("properties").and_then(|it| it.get(key));
        let other = node.get("additionalProperties").filter(|it| it.is_object());
        found.extend(named.or(other));
    });
    found
}

fn add_keys(root: &Value, node: &Value, words: &mut Vec<(String, String)>, depth: usize) {
    each(root, node, depth, &mut |node| {
        let all = node.get("properties").and_then(Value::as_object);
        for (name, shape) in all.into_iter().flatten() {
            words.push((name.clone(), described(shape)));
        }
    });
}

fn add_values(root: &Value, node: &Value, words: &mut Vec<(String, String)>, depth: usize) {
    each(root, node, depth, &mut |node| {
        let listed = ["enum", "examples"].map(|key| node.get(key).and_then(Value::as_array));
        for value in listed
            .into_iter()
            .flatten()
            .flatten()
            .chain(node.get("const"))
        {
            let word = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            words.push((word, String::new()));
        }
    });
}

fn described(shape: &Value) -> String {
    shape
        .get("description")
        .and_then(Value::as_str)
        .unwrap_or_default()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::complete;

    /// Returns the words at the bar of a text.
    fn words(text: &str) -> Vec<String> {
        let position = text.split('|').next().unwrap().encode_utf16().count();
        let found = complete(&text.replace('|', ""), position);
        found.into_iter().map(|it| it.word).collect()
    }

    #[test]
    fn keys_are_those_of_the_place() {
        let top = words("title: 🌲\nini|");
        assert_eq!(top, ["initiator: "]);
        let style = words("initiator: segment\nstyle:\n  |\n");
        for key in ["stroke: ", "color_by: ", "palette: "] {
            assert!(style.contains(&key.to_owned()), "{style:?}");
        }
        assert!(!style.contains(&"initiator: ".to_owned()));
        assert!(
            !words("title: a\n|").contains(&"title: ".to_owned()),
            "it is there"
        );
        assert!(words("kind: ifs\nma|").contains(&"maps: ".to_owned()));
        assert!(words("# tit|").is_empty());
    }

    #[test]
    fn values_are_those_of_the_key() {
        let by = words("style:\n  color_by: s|");
        assert!(
            by.contains(&"step".to_owned()) && !by.contains(&"index".to_owned()),
            "{by:?}"
        );
        let inline = words("style: {color_by: in|}");
        assert!(inline.contains(&"index".to_owned()), "{inline:?}");
    }
}
