//! The name that was probably meant.

/// Longer names are not compared, since comparing takes time proportional to both lengths.
const MAX_CHARS: usize = 64;

/// `did you mean 'x'?` for the nearest of the candidates, if one is near: at most a third of the
/// letters differ (Damerau and Levenshtein's distance with adjacent letters swapped, case and the
/// choice of `-` or `_` not counted). Of several equally near the first is taken.
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let wanted = folded(name)?;
    let letters = wanted.chars().count();
    candidates
        .into_iter()
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
        .map(|(_, candidate)| format!("did you mean '{candidate}'?"))
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
