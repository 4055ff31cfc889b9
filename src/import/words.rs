//! Words of a text with their places.

use crate::diagnostic::Place;

/// Returns the words of the text at a place, which characters of a kind separate.
pub(super) fn words(whole: &Place, is_between: impl Fn(char) -> bool) -> Vec<Place> {
    let text = whole.text();
    let mut words = Vec::new();
    let mut start = 0;
    for word in text.split(is_between) {
        if !word.is_empty() {
            words.push(whole.within(start..start + word.len()));
        }
        let end = start + word.len();
        start = end + text[end..].chars().next().map_or(0, char::len_utf8);
    }
    words
}
