//! Spelling suggestions: the candidate nearest to an unknown name, by edit distance.

/// Maximum length in characters of names that are compared: the time is proportional to both lengths.
const MAX_CHARS: usize = 64;

/// Maximum number of candidates that are compared with a name.
pub(crate) const MAX_CANDIDATES: usize = 1000;
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
    let mut letters = Vec::new();
    fold(name, &mut letters)?;
    let wanted = Wanted::new(&letters);
    let candidates: Vec<&str> = candidates.into_iter().take(MAX_CANDIDATES).collect();
    let mut best: Option<(usize, &str)> = None;
    for &candidate in &candidates {
        if candidate == name || fold(candidate, &mut letters).is_none() {
            continue;
        }
        let longest = wanted.length.max(letters.len());
        let most = (longest / 3).max(1);
        let least = wanted.least_distance(&letters);
        if least > most || best.is_some_and(|(distance, _)| least >= distance) {
            continue;
        }
        let distance = wanted.distance(&letters);
        // Otherwise every name of one letter would be near to every other.
        let near = distance == 0 || (distance <= most && distance < longest);
        if near && best.is_none_or(|(known, _)| distance < known) {
            best = Some((distance, candidate));
        }
    }
    let beginning = || {
        let same = |candidate: &&str| {
            let letters = candidate.chars().zip(name.chars());
            letters.take_while(|(a, b)| a == b).count() >= SAME_BEGINNING
        };
        candidates.iter().copied().find(same)
    };
    best.map(|(_, candidate)| candidate).or_else(beginning)
}

/// A name that others are compared with: its letters, each with the bits of its places.
struct Wanted {
    length: usize,
    places: Vec<(char, u128)>,
    set: u64,
}

impl Wanted {
    /// Prepares a name of 1 to 128 letters.
    fn new(letters: &[char]) -> Self {
        let mut places: Vec<(char, u128)> = Vec::new();
        for (place, letter) in letters.iter().enumerate() {
            match places.iter_mut().find(|(known, _)| known == letter) {
                Some((_, bits)) => *bits |= 1 << place,
                None => places.push((*letter, 1 << place)),
            }
        }
        Self {
            length: letters.len(),
            places,
            set: letter_set(letters),
        }
    }

    /// Returns a lower bound of the distance from a name: an edit changes the length by at most one letter, and
    /// adds and removes at most one.
    fn least_distance(&self, name: &[char]) -> usize {
        let set = letter_set(name);
        let [removed, added] = [self.set & !set, set & !self.set].map(u64::count_ones);
        let length = self.length.abs_diff(name.len());
        length.max(removed.max(added) as usize)
    }

    /// Returns the optimal string alignment distance from a name.
    ///
    /// A step goes from one beginning of `name` to the next one. The bits of `up` and `down` are set where the distance
    /// of a beginning of the wanted name is greater, or less, by 1 than that of the beginning before it (Hyyrö, "A
    /// bit-vector algorithm for computing Levenshtein and Damerau edit distances", 2003).
    fn distance(&self, name: &[char]) -> usize {
        let last = self.length - 1;
        let (mut up, mut down) = (!0_u128, 0_u128);
        let (mut diagonal, mut before) = (0_u128, 0_u128);
        let mut distance = self.length;
        for letter in name {
            let found = self.places.iter().find(|(known, _)| known == letter);
            let places = found.map_or(0, |(_, places)| *places);
            let transposed = ((!diagonal & places) << 1) & before;
            let carried = (places & up).wrapping_add(up) ^ up;
            diagonal = carried | places | down | transposed;
            let (more, less) = (down | !(diagonal | up), diagonal & up);
            distance += (more >> last & 1) as usize;
            distance -= (less >> last & 1) as usize;
            let (more, less) = (more << 1 | 1, less << 1);
            (up, down) = (less | !(diagonal | more), more & diagonal);
            before = places;
        }
        distance
    }
}

/// Replaces `letters` by the characters of a name in lower case, with `_` for `-`. Empty and long names have none.
fn fold(name: &str, letters: &mut Vec<char>) -> Option<()> {
    letters.clear();
    if name.is_empty() || name.chars().nth(MAX_CHARS).is_some() {
        return None;
    }
    for letter in name.chars() {
        match letter {
            '-' => letters.push('_'),
            _ if letter.is_ascii() => letters.push(letter.to_ascii_lowercase()),
            // At most two characters.
            _ => letters.extend(letter.to_lowercase()),
        }
    }
    Some(())
}

/// Returns the set of the characters' numbers modulo 64, as bits.
fn letter_set(letters: &[char]) -> u64 {
    { letters.iter() }.fold(0, |set, letter| set | 1 << (u32::from(*letter) % 64))
}

#[cfg(test)]
mod tests {
    use super::{MAX_CHARS, Wanted, did_you_mean, fold};

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
            assert_eq!(plain_distance(&a, &b), expected, "{a:?} {b:?}");
            if !a.is_empty() {
                assert_eq!(Wanted::new(&a).distance(&b), expected, "{a:?} {b:?}");
            }
        }
    }

    /// Returns the distance by its definition: from the distances of the names without their last letters.
    fn plain_distance(a: &[char], b: &[char]) -> usize {
        let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
        for i in 0..=a.len() {
            for j in 0..=b.len() {
                rows[i][j] = match (i, j) {
                    (0, _) | (_, 0) => i + j,
                    _ => {
                        let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                        let removed = rows[i - 1][j].min(rows[i][j - 1]) + 1;
                        let is_swap =
                            i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
                        let swapped = if is_swap {
                            rows[i - 2][j - 2] + 1
                        } else {
                            usize::MAX
                        };
                        replaced.min(removed).min(swapped)
                    }
                };
            }
        }
        rows[a.len()][b.len()]
    }

    #[test]
    fn distances_of_long_names_are_those_of_the_definition() {
        let mut state = 1_u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % below
        };
        for _ in 0..2000 {
            let name = |random: &mut dyn FnMut(u32) -> u32| -> Vec<char> {
                let length = random(128) + 1;
                let letter = |_| char::from(b"abcd"[random(4) as usize]);
                (0..length).map(letter).collect()
            };
            let a = name(&mut random);
            let b = if random(2) == 0 {
                name(&mut random)
            } else {
                // A few transpositions of the first name.
                let mut b = a.clone();
                for _ in 0..random(6) {
                    let place = random(128) as usize % b.len();
                    b.swap(place, (place + 1) % a.len());
                }
                b
            };
            let expected = plain_distance(&a, &b);
            let wanted = Wanted::new(&a);
            assert_eq!(wanted.distance(&b), expected, "{a:?} {b:?}");
            assert!(wanted.least_distance(&b) <= expected, "{a:?} {b:?}");
        }
    }

    #[test]
    fn folded_names_have_at_most_128_letters() {
        let mut letters = Vec::new();
        let longest = |letter: char| letter.to_lowercase().count();
        assert_eq!((char::MIN..=char::MAX).map(longest).max(), Some(2));
        fold(&"\u{130}".repeat(MAX_CHARS), &mut letters).unwrap();
        assert_eq!(letters.len(), 2 * MAX_CHARS);
        assert_eq!(Wanted::new(&letters).distance(&letters), 0);
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
