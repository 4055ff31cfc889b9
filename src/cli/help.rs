//! What the help of a command says beside its options: examples and the like.
//!
//! It is written once, as it is read on a terminal, and the manual pages are made from it: headings
//! with a colon at the end, terms that are indented by two, and what they mean, indented by six.

use clap::builder::{StyledStr, Styles};

/// A line of such a text.
pub(super) enum Line<'t> {
    Heading(&'t str),
    Term(&'t str),
    Meaning(&'t str),
}

/// The lines of a text, without the empty ones.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let lines = text.lines().filter(|line| !line.is_empty());
    lines.map(|line| match line.strip_prefix("  ") {
        None => Line::Heading(line.trim_end_matches(':')),
        Some(rest) => match rest.strip_prefix("    ") {
            None => Line::Term(rest),
            Some(rest) => Line::Meaning(rest),
        },
    })
}

/// A text in the colours of the rest of the help.
pub(super) fn styled(text: &str) -> StyledStr {
    let styles = Styles::styled();
    let (header, literal) = (styles.get_header(), styles.get_literal());
    let mut styled = String::new();
    for line in lines(text) {
        let line = match line {
            Line::Heading(heading) if styled.is_empty() => {
                format!("{header}{heading}:{header:#}\n")
            }
            Line::Heading(heading) => format!("\n{header}{heading}:{header:#}\n"),
            Line::Term(term) => format!("  {literal}{term}{literal:#}\n"),
            Line::Meaning(meaning) => format!("      {meaning}\n"),
        };
        styled.push_str(&line);
    }
    styled.truncate(styled.trim_end().len());
    styled.into()
}
