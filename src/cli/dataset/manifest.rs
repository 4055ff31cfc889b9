//! Manifests and labels of data sets.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use serde::Serialize;
use sha2::{Digest as _, Sha256};

use crate::dataset::{Dataset, Label, Maps};

use super::super::{Failure, output, readable};
use super::Shard;
use super::folder::{part_name, write_file};

/// Pictures that have been written or compared.
#[derive(Default)]
pub(super) struct Tally {
    pictures: u64,
    bytes: u64,
    hash: Sha256,
    pub(super) wrong: Vec<String>,
}

impl Tally {
    pub(super) fn add(&mut self, png: &[u8]) {
        self.pictures += 1;
        self.bytes += png.len() as u64;
        self.hash.update(Sha256::digest(png));
    }
}

/// Label of a picture, as a line of JSON.
#[derive(Serialize)]
pub(super) struct LabelRow<'a> {
    category: u32,
    name: &'a str,
    instance: u32,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    maps: Vec<Vec<f64>>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    parameters: BTreeMap<&'a str, f64>,
    flip: u8,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<[f64; 2]>,
    dimension: Option<f64>,
}

impl<'a> LabelRow<'a> {
    pub(super) fn new(set: &'a Dataset, index: u64, label: &'a Label) -> Result<Self, Failure> {
        let (category, instance) = set.place(index)?;
        let of = set.category(category)?;
        let own = label.dimension().and_then(|it| it.value);
        let shared = || of.dimension().and_then(|it| it.value);
        Ok(Self {
            category,
            name: of.name(),
            instance,
            maps: rows(label.maps.as_ref()),
            parameters: named(&label.parameters),
            flip: label.flip,
            from: label.from,
            dimension: if label.maps.is_none() { shared() } else { own },
        })
    }

    pub(super) fn json(&self) -> Result<String, Failure> {
        Ok(serde_json::to_string(self).map_err(anyhow::Error::new)?)
    }
}

fn rows(maps: Option<&Maps>) -> Vec<Vec<f64>> {
    maps.map(Maps::rows).unwrap_or_default()
}

fn named(parameters: &[(String, f64)]) -> BTreeMap<&str, f64> {
    let parameters = parameters.iter();
    parameters
        .map(|(name, value)| (name.as_str(), *value))
        .collect()
}

/// Description of a data set, or of a part of it.
#[derive(Serialize)]
pub(super) struct Manifest {
    version: &'static str,
    spec: String,
    spec_sha256: String,
    #[serde(skip)]
    shard: Shard,
    part: Option<String>,
    from: u64,
    to: u64,
    pictures: u64,
    bytes: u64,
    sha256: String,
    categories: Vec<CategoryRow>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) wrong: Vec<String>,
}

#[derive(Serialize)]
struct CategoryRow {
    number: u32,
    name: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    maps: Vec<Vec<f64>>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    parameters: BTreeMap<String, f64>,
    attempts: u32,
    dimension: Option<f64>,
    closed_form: Option<String>,
}

impl Manifest {
    pub(super) fn new(
        set: &Dataset,
        shard: Option<Shard>,
        range: Range<u64>,
        tally: Tally,
    ) -> Result<Self, Failure> {
        let mut categories = Vec::new();
        if range.start < range.end {
            let [first, last] = [set.place(range.start)?, set.place(range.end - 1)?];
            for number in first.0..=last.0 {
                let category = set.category(number)?;
                let dimension = category.dimension();
                let parameters = category.parameters().into_iter();
                categories.push(CategoryRow {
                    number,
                    name: category.name().to_owned(),
                    maps: rows(category.maps()),
                    parameters: parameters.collect(),
                    attempts: category.attempts(),
                    dimension: dimension.and_then(|it| it.value),
                    closed_form: dimension.and_then(|it| it.closed_form.clone()),
                });
            }
        }
        Ok(Self {
            version: env!("CARGO_PKG_VERSION"),
            spec: set.text().to_owned(),
            spec_sha256: hex(&Sha256::digest(set.text())),
            shard: shard.unwrap_or(Shard {
                number: 1,
                count: 1,
            }),
            part: shard.map(|Shard { number, count }| format!("{number}/{count}")),
            from: range.start,
            to: range.end,
            pictures: tally.pictures,
            bytes: tally.bytes,
            sha256: hex(&tally.hash.finalize()),
            categories,
            wrong: tally.wrong,
        })
    }

    /// Writes the manifest into the folder of the data set.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let mut text = serde_json::to_string_pretty(self).map_err(anyhow::Error::new)?;
        text.push('\n');
        let name = part_name("manifest", "json", self.shard);
        write_file(&folder.join(name), text.as_bytes())
    }

    /// Describes the result in a line, and what is wrong in further ones.
    pub(super) fn described(&self, out: &Path, checks: bool) -> String {
        let pictures = readable::counted(&self.pictures.into(), "picture");
        let categories = match self.categories.len() {
            1 => "1 category".into(),
            count => format!("{} categories", readable::grouped(&count.into())),
        };
        let bytes = readable::bytes(self.bytes);
        let mut text = format!(
            "{}: {pictures} of {categories}, {bytes}",
            output::called(out)
        );
        if checks && self.wrong.is_empty() {
            text.push_str(", all as they would be drawn");
        }
        for wrong in &self.wrong {
            text.push_str(&format!(
                "\n{wrong} is missing, or differs from what would be drawn"
            ));
        }
        text
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
