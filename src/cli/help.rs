//! Texts that follow the options in the help of a command: examples and further sections.
//!
//! Each text is written once, in the layout of a terminal, and the manual pages are made from it: headings
//! end in a colon, terms are indented by two spaces and their explanations by six.

use clap::builder::{StyledStr, Styles};

/// Line of a help text.
pub(super) enum HelpLine<'t> {
    Heading(&'t str),
    Term(&'t str),
    Meaning(&'t str),
}

/// Iterates over the lines of a help text, without the empty ones.
pub(super) fn lines(text: &str) -> impl Iterator<Item = HelpLine<'_>> {
    let lines = text.lines().filter(|line| !line.is_empty());
    lines.map(|line| match line.strip_prefix("  ") {
        None => HelpLine::Heading(line.trim_end_matches(':')),
        Some(rest) => match rest.strip_prefix("    ") {
            None => HelpLine::Term(rest),
            Some(rest) => HelpLine::Meaning(rest),
        },
    })
}

/// Returns a help text in the colours of the rest of the help.
pub(super) fn styled(text: &str) -> StyledStr {
    let styles = Styles::styled();
    let (header, literal) = (styles.get_header(), styles.get_literal());
    let mut styled = String::new();
    for line in lines(text) {
        let line = match line {
            HelpLine::Heading(heading) if styled.is_empty() => {
                format!("{header}{heading}:{header:#}\n")
            }
            HelpLine::Heading(heading) => format!("\n{header}{heading}:{header:#}\n"),
            HelpLine::Term(term) => format!("  {literal}{term}{literal:#}\n"),
            HelpLine::Meaning(meaning) => format!("      {meaning}\n"),
        };
        styled.push_str(&line);
    }
    styled.truncate(styled.trim_end().len());
    styled.into()
}
