//! Parts of work that several machines share.

/// Part of the work: number, from 1, and number of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shard {
    pub(super) number: u32,
    pub(super) count: u32,
}

impl Shard {
    /// The whole work.
    pub(super) const ALL: Self = Self {
        number: 1,
        count: 1,
    };

    /// Parses a part, `3/64` for the third of 64.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(number, count)| {
            let [number, count] = [number, count].map(|it| it.trim().parse::<u32>().ok());
            Some((number?, count?))
        });
        match parts {
            Some((number, count)) if number >= 1 && number <= count => Ok(Self { number, count }),
            _ => Err("a part is K/N, with K from 1 to N".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn parts_are_fractions() {
        assert_eq!(
            Shard::parse("3/64"),
            Ok(Shard {
                number: 3,
                count: 64
            })
        );
        for wrong in ["", "3", "0/4", "5/4", "1/0", "a/b", "1/2/3"] {
            assert!(Shard::parse(wrong).is_err(), "{wrong}");
        }
    }
}
