//! Removal of items and entries.

use std::ops::Range;

use crate::document::node::{Node, Value};

use super::PathStep;
use super::splice::{Splice, Text};

/// Returns ways to remove a part of a collection.
pub(super) fn removed(text: &Text<'_>, parent: &Node, step: &PathStep) -> Option<Vec<Splice>> {
    let (ranges, index) = match &parent.value {
        Value::Sequence(items) => {
            let ranges: Vec<_> = items.iter().map(|item| text.range(item)).collect();
            let PathStep::Item(index) = step else {
                return None;
            };
            (ranges, *index)
        }
        Value::Mapping(entries) => {
            let name = step.to_string();
            let index = entries.iter().position(|(key, _)| key.name == name)?;
            let ranges = entries.iter().map(|(key, node)| {
                let key = text.quoted(key.place.range());
                key.start..text.range(node).end.max(key.end + 1)
            });
            (ranges.collect(), index)
        }
        _ => return None,
    };
    if text.is_flow(parent) {
        return Some(from_flow(text, &ranges, index));
    }
    if ranges.len() == 1 {
        let empty = match parent.value {
            Value::Sequence(_) => " []",
            _ => " {}",
        };
        let own = parent.place.range();
        let start = text.text[..own.start].trim_end().len();
        return Some(vec![vec![(start..own.end, empty.into())]]);
    }
    let starts = |index: usize| match &parent.value {
        Value::Sequence(items) => text.dash(items.get(index)?),
        _ => Some(ranges.get(index)?.start),
    };
    let start = starts(index)?;
    let line = text.line_start(start);
    let is_first_on_line = text.text[line..start].trim().is_empty();
    let way = match is_first_on_line {
        true => whole_lines(text, line, ranges[index].end),
        // The first part of a collection that stands behind a dash: what follows takes its place.
        false => start..starts(index + 1)?,
    };
    let lost = &text.text[ranges[index].end.min(way.end)..way.end];
    let keeps_comments = is_first_on_line || !lost.contains('#');
    Some(match keeps_comments {
        true => vec![vec![(way, String::new())]],
        false => Vec::new(),
    })
}

/// Returns lines from the start of one to the end of another; at the end of the text without the line end before.
fn whole_lines(text: &Text<'_>, start: usize, end: usize) -> Range<usize> {
    let end = text.next_line(end);
    if end == text.text.len() && !text.text.ends_with('\n') && start > 0 {
        let before = text.text[..start - 1].trim_end_matches('\r').len();
        return before..end;
    }
    start..end
}

fn from_flow(text: &Text<'_>, ranges: &[Range<usize>], index: usize) -> Vec<Splice> {
    let own = ranges[index].clone();
    let all = text.text;
    if index + 1 == ranges.len() {
        let Some(before) = index.checked_sub(1).map(|before| ranges[before].end) else {
            return vec![vec![(own, String::new())]];
        };
        let gap = &all[before..own.start];
        return match gap.trim() {
            "," => vec![vec![(before..own.end, String::new())]],
            // A comment stands between them, and stays: the comma goes alone, if it is not a part of it.
            _ => {
                let comma = gap.find(',').map(|at| before + at);
                let alone = comma.map(|comma| {
                    vec![
                        (own.clone(), String::new()),
                        (comma..comma + 1, String::new()),
                    ]
                });
                alone
                    .into_iter()
                    .chain([vec![(own, String::new())]])
                    .collect()
            }
        };
    }
    let next = ranges[index + 1].start;
    let gap = &all[own.end..next];
    if gap.trim() == "," {
        let line = text.line_start(own.start);
        let starts_line = all[line..own.start].trim().is_empty();
        // An item on a line of its own goes with the line.
        let end = match gap.find('\n') {
            Some(at) if starts_line && !own.is_empty() => own.end + at + 1,
            Some(_) if !starts_line => own.end + gap.trim_end_matches(char::is_whitespace).len(),
            _ => next,
        };
        let start = if starts_line && gap.contains('\n') {
            line
        } else {
            own.start
        };
        return vec![
            vec![(start..end, String::new())],
            vec![(own.start..next, String::new())],
        ];
    }
    let comma = gap.find(',').map(|at| own.end + at + 1);
    comma
        .map(|end| vec![(own.start..end, String::new())])
        .into_iter()
        .collect()
}
