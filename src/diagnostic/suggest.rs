//! Spelling suggestions: the candidate nearest to an unknown name, by edit distance.

/// Maximum length in characters of names that are compared: the time is proportional to both lengths.
const MAX_CHARS: usize = 64;

/// Maximum number of candidates that are compared with a name.
const MAX_CANDIDATES: usize = 1000;
/// Maximum number of names in a list.
const MAX_LISTED: usize = 30;

/// Joins names with commas for a message. Names beyond [`MAX_LISTED`] are replaced by `...`.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let mut shown: Vec<&str> = names.by_ref().take(MAX_LISTED).collect();
    if names.next().is_some() {
        shown.push("...");
    }
    shown.join(", ")
}

/// Number of equal leading characters that makes two names near: `parameters` and `params`.
const SAME_BEGINNING: usize = 5;

/// Returns `did you mean 'x'?` with the candidate nearest to `name`, or `None` if no candidate is near.
///
/// The distance is the optimal string alignment distance (Damerau–Levenshtein, where adjacent
/// transpositions count once); case is ignored, and `-` equals `_`. A candidate is near if the distance
/// is at most a third of the longer name's length, but at least 1, and less than that length. Of
/// equally near candidates the first is taken. If no candidate is near, the first one that begins with
/// the same five characters is taken. At most 1000 candidates are compared.
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    nearest(name, candidates).map(|candidate| format!("did you mean '{candidate}'?"))
}

/// Returns the candidate that [`did_you_mean`] suggests.
pub(crate) fn nearest<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let wanted: Vec<char> = folded(name)?.collect();
    let letters = letter_set(wanted.iter().copied());
    let candidates: Vec<&str> = candidates.into_iter().take(MAX_CANDIDATES).collect();
    let beginning = || {
        let same = |candidate: &&&str| {
            let letters = candidate.chars().zip(name.chars());
            letters.take_while(|(a, b)| a == b).count() >= SAME_BEGINNING
        };
        candidates.iter().find(same).copied()
    };
    candidates
        .iter()
        .copied()
        .filter(|candidate| *candidate != name)
        .filter_map(|candidate| {
            let known = folded(candidate)?;
            let length = known.clone().count();
            let longest = wanted.len().max(length);
            let most = (longest / 3).max(1);
            // The distance is at least the difference of the lengths, and an edit removes at most one letter.
            let removed = letters & !letter_set(known.clone());
            if wanted
                .len()
                .abs_diff(length)
                .max(removed.count_ones() as usize)
                > most
            {
                return None;
            }
            let distance = distance(&wanted, &known.collect::<Vec<_>>());
            // Otherwise every name of one letter would be near to every other.
            let near = distance == 0 || (distance <= most && distance < longest);
            near.then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
        .or_else(beginning)
}

/// Returns the optimal string alignment distance.
fn distance(a: &[char], b: &[char]) -> usize {
    // The rows of the distances of beginnings of `a` from all beginnings of `b`: this one and two before.
    let mut row: Vec<usize> = (0..=b.len()).collect();
    let (mut above, mut second) = (row.clone(), row.clone());
    for i in 1..=a.len() {
        (above, second, row) = (row, above, second);
        row[0] = i;
        for j in 1..=b.len() {
            let replaced = above[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(above[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(second[j - 2] + 1);
            }
        }
    }
    row[b.len()]
}

/// Returns the characters of a name in lower case, with `_` for `-`. Empty and long names have none.
fn folded(name: &str) -> Option<impl Iterator<Item = char> + Clone> {
    let lower = name.chars().flat_map(char::to_lowercase);
    (!name.is_empty() && name.chars().nth(MAX_CHARS).is_none())
        .then(|| lower.map(|letter| if letter == '-' { '_' } else { letter }))
}

/// Returns the set of the characters' numbers modulo 64, as bits.
fn letter_set(letters: impl Iterator<Item = char>) -> u64 {
    letters.fold(0, |set, letter| set | 1 << (u32::from(letter) % 64))
}

#[cfg(test)]
mod tests {
    use super::{did_you_mean, distance};

    #[test]
    fn distances_are_of_optimal_string_alignment() {
        for (a, b, expected) in [
            ("", "", 0),
            ("abc", "", 3),
            ("", "abc", 3),
            ("kitten", "sitting", 3),
            ("ab", "ba", 1),
            // No part is edited twice: 2 by unrestricted Damerau–Levenshtein.
            ("ca", "abc", 3),
            ("a cat", "an abct", 4),
            ("öffnen", "ofefnn", 3),
        ] {
            let [a, b] = [a, b].map(|text: &str| text.chars().collect::<Vec<_>>());
            assert_eq!(distance(&a, &b), expected, "{a:?} {b:?}");
        }
    }

    #[test]
    fn the_nearest_name_is_offered() {
        let keys = [
            "generator",
            "generators",
            "title",
            "to",
            "tags",
            "base_element",
        ];
        let meant = |name| did_you_mean(name, keys);
        assert_eq!(
            meant("genrator").as_deref(),
            Some("did you mean 'generator'?")
        );
        assert_eq!(meant("Title").as_deref(), Some("did you mean 'title'?"));
        assert_eq!(
            meant("base-element").as_deref(),
            Some("did you mean 'base_element'?")
        );
        assert_eq!(meant("ot").as_deref(), Some("did you mean 'to'?"));
        assert_eq!(meant("colour"), None);
        assert_eq!(meant(""), None);
        assert_eq!(meant(&"generator".repeat(1000)), None);
        assert_eq!(did_you_mean("x", ["y"]), None);
        assert_eq!(
            did_you_mean("x", ["X"]).as_deref(),
            Some("did you mean 'X'?")
        );
    }
}
