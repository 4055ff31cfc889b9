//! The name that was probably meant.

/// Longer names are not compared, since comparing takes time proportional to both lengths.
const MAX_CHARS: usize = 64;

/// More candidates than this are not compared with a name, and more names are not listed.
const MOST_CANDIDATES: usize = 1000;
const MOST_LISTED: usize = 30;

/// Names for a message, with commas between them: the first ones if they are many.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let mut shown: Vec<&str> = names.by_ref().take(MOST_LISTED).collect();
    if names.next().is_some() {
        shown.push("...");
    }
    shown.join(", ")
}

/// Names that begin with the same letters, this many, are near: `parameters` and `params`.
const SAME_BEGINNING: usize = 5;

/// `did you mean 'x'?` for the nearest of the candidates, if one is near: at most a third of the
/// letters differ (Damerau and Levenshtein's distance with adjacent letters swapped, case and the
/// choice of `-` or `_` not counted). Of several equally near the first is taken.
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    nearest(name, candidates).map(|candidate| format!("did you mean '{candidate}'?"))
}

/// The name that [`did_you_mean`] offers.
pub(crate) fn nearest<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let wanted = folded(name)?;
    let letters = wanted.chars().count();
    let candidates: Vec<&str> = candidates.into_iter().take(MOST_CANDIDATES).collect();
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
            let distance = strsim::osa_distance(&wanted, &known);
            let longest = letters.max(known.chars().count());
            // A name of one letter is near to none.
            let near = distance == 0 || (distance <= (longest / 3).max(1) && distance < longest);
            near.then_some((distance, candidate))
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
        .or_else(beginning)
}

fn folded(name: &str) -> Option<String> {
    (!name.is_empty() && name.chars().nth(MAX_CHARS).is_none())
        .then(|| name.to_lowercase().replace('-', "_"))
}

#[cfg(test)]
mod tests {
    use super::did_you_mean;

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
