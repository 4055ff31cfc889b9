//! Labels in the files of pictures: title, description and provenance, enough to reproduce the picture.

use std::fmt::Display;

use crate::render;

use super::rule::Loaded;

/// Returns title, description, and provenance: the version of the program, the command that reproduces the
/// picture from the text that follows, the values of the parameters, and the rule with all its components.
pub(super) fn labels(
    loaded: &Loaded,
    shown: &str,
    subcommand: &str,
    options: impl IntoIterator<Item = (impl Display, String)>,
) -> render::Labels {
    labels_of_rules(&[loaded], shown, subcommand, options)
}

/// Returns the labels of a picture of several rules, at least one, which have the same settings. The texts of the rules
/// follow one another.
pub(super) fn labels_of_rules(
    rules: &[&Loaded],
    shown: &str,
    subcommand: &str,
    options: impl IntoIterator<Item = (impl Display, String)>,
) -> render::Labels {
    let title = |loaded: &&Loaded| {
        let title = &loaded.model.metadata().description.title;
        title.clone().unwrap_or_else(|| loaded.name.clone())
    };
    let titles: Vec<_> = rules.iter().map(title).collect();
    let names: Vec<_> = rules.iter().map(|loaded| loaded.name.as_str()).collect();
    let mut provenance = format!(
        "# kfrac {}\n# {}\n",
        env!("CARGO_PKG_VERSION"),
        command(rules, subcommand, options)
    );
    for (number, loaded) in rules.iter().enumerate() {
        if number > 0 {
            provenance.push_str(&format!("---\n# {}\n", quoted(&loaded.name)));
        }
        add_content(&mut provenance, loaded);
    }
    let about = match rules {
        [loaded] => loaded.model.metadata().description.about.as_deref(),
        _ => None,
    };
    render::Labels {
        title: titles.join(", "),
        description: format!(
            "{shown} of {}. {}",
            names.join(", "),
            about.unwrap_or_default().trim()
        ),
        provenance,
    }
}

/// Returns the labels of a comparison: the values of the parameters, and both rules with all their
/// components.
pub(super) fn labels_of_two(a: &Loaded, b: &Loaded) -> render::Labels {
    let mut provenance = format!("# kfrac {}\n", env!("CARGO_PKG_VERSION"));
    for loaded in [a, b] {
        provenance.push_str(&format!("---\n# {}\n", quoted(&loaded.name)));
        add_content(&mut provenance, loaded);
    }
    render::Labels {
        title: format!("{} and {}", a.name, b.name),
        description: format!(
            "The difference of two sets. Orange: {} alone. Blue: {} alone. Grey: both.",
            a.name, b.name
        ),
        provenance,
    }
}

/// Adds the values of the parameters and the inlined file.
fn add_content(provenance: &mut String, loaded: &Loaded) {
    for parameter in &loaded.model.metadata().parameters {
        provenance.push_str(&format!("# {} = {}\n", parameter.name, parameter.value));
    }
    provenance.push_str(&loaded.document.to_yaml());
    for (name, document) in &loaded.beside {
        provenance.push_str(&format!("---\n# {}\n{}", quoted(name), document.to_yaml()));
    }
}

/// Returns the command that reproduces the picture from the resolved rules.
fn command(
    rules: &[&Loaded],
    subcommand: &str,
    options: impl IntoIterator<Item = (impl Display, String)>,
) -> String {
    let mut command = format!("kfrac {subcommand}");
    for loaded in rules {
        command.push_str(&format!(" {}", quoted(&format!("{}.yaml", loaded.name))));
    }
    let loaded = rules[0];
    let settings = loaded.settings.iter();
    let settings = settings.map(|setting| {
        (
            "set".to_owned(),
            format!("{}={}", setting.name, setting.value),
        )
    });
    let omitted: Vec<_> = loaded.omitted.iter().map(u32::to_string).collect();
    let omitted = (!omitted.is_empty()).then(|| ("omit".to_owned(), omitted.join(",")));
    let made_by = loaded.made_by.iter();
    let made_by = made_by.map(|(name, value)| ((*name).to_owned(), value.clone()));
    let options = options
        .into_iter()
        .map(|(name, value)| (name.to_string(), value));
    for (name, value) in settings.chain(omitted).chain(made_by).chain(options) {
        command.push_str(&format!(" --{name}"));
        // An equals sign allows values that begin with a minus; flags have no value.
        if !value.is_empty() {
            command.push_str(&format!("={}", quoted(&value)));
        }
    }
    command
}

/// Quotes a word for a shell, on one line.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_.,=%".contains(c);
    if word.chars().all(plain) {
        return word.into();
    }
    if word.contains(char::is_control) {
        let escaped = word.chars().map(|c| match c {
            '\'' | '\\' => format!("\\{c}"),
            c if c.is_control() => format!("\\u{:04x}", u32::from(c)),
            c => c.into(),
        });
        return format!("$'{}'", escaped.collect::<String>());
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
