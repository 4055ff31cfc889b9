//! Data sets as written: a file of the kind `dataset`.

use std::sync::Arc;

use crate::diagnostic::{Diagnostics, Source};
use crate::style::Named;

use super::mapping::{FromNode, mapping, variants};
use super::node::{Key, Node, Value};
use super::reader::{Fields, Reader};
use super::shape::{Form, alternative};
use super::{Written, WrittenNumber};

mapping! {
    /// A data set as written.
    struct DatasetDocument: DATASET = "a data set",
        "kind: dataset, with `categories`, `instances` and `picture`";
    needed kind: String = Form::Words(&["dataset"]), "The kind of the file."
        => "the file needs `kind: dataset`", "kind: dataset";
    title: Option<String> = Form::Text, "Title.";
    about: Option<String> = Form::Text, "Description in a few sentences.";
    seed: Option<WrittenNumber> = Form::Whole(0, None), "Seed of all draws; 0 if left out.";
    needed categories: Option<CategoriesDocument> = Form::Mapping(&CATEGORIES), "The classes."
        => "a data set needs categories", "categories: {systems: {random: {maps: [2, 7]}, count: 1000}}";
    instances: Option<InstancesDocument> = Form::Mapping(&INSTANCES), "The pictures of a category.";
    picture: Option<PictureDocument> = Form::Mapping(&PICTURE), "How a picture is drawn.";
    accept: Option<AcceptDocument> = Form::Mapping(&ACCEPT), "Conditions for systems that are drawn at random.";
}

mapping! {
    /// The categories as written.
    struct CategoriesDocument: CATEGORIES = "the categories", "categories: {systems: {random: {maps: [2, 7]}, count: 1000}}";
    needed systems: Option<Vec<SourceDocument>> =
        Form::Either(&[Form::Mapping(&SOURCE), Form::List(&Form::Mapping(&SOURCE), 1, None)]),
        "A source of systems, or a list of sources, whose categories follow each other."
        => "categories need `systems`";
}

mapping! {
    /// A source of categories as written.
    struct SourceDocument: SOURCE = "a source of systems",
        "{random: {maps: [2, 7]}, count: 1000}, {rule: pythagoras, params: {angle: 'uniform(10, 80)'}}, {csv: folder} or {library: [ifs]}",
        &[
            alternative(&["random"], &["rule", "params", "csv", "library"]),
            alternative(&["rule"], &["random", "csv", "library"]),
            alternative(&["csv"], &["random", "rule", "params", "library", "count"]),
            alternative(&["library"], &["random", "rule", "params", "csv", "count"]),
        ];
    random: Option<RandomDocument> = Form::Mapping(&RANDOM), "Systems of maps that are drawn at random.";
    rule: Option<Written<String>> = Form::Text, "A file, or a name in the library.";
    params: Option<Vec<LawDocument>> = Form::Names(&Form::Either(&[Form::Number, Form::Expression]), 1),
        "Values of its parameters: numbers, or uniform(a, b), normal(mean, deviation) or choice(a, b, ...).";
    csv: Option<Written<String>> = Form::Text,
        "A folder of CSV files, one for each category: a row a, b, c, d, e, f, p for each map x' = a x + b y + e, y' = c x + d y + f \
         of weight p.";
    library: Option<Vec<Written<String>>> = Form::List(&Form::Text, 1, None),
        "Kinds of files of the library, each of which is a category.";
    count: Option<WrittenNumber> = Form::Whole(1, None),
        "Number of categories. A rule without it is one category, and draws its parameters for every picture.";
}

mapping! {
    /// A law of random systems as written.
    struct RandomDocument: RANDOM = "a law of random systems", "random: {maps: [2, 7], sigma: anderson}";
    maps: Option<[WrittenNumber; 2]> = Form::Either(&[Form::Whole(1, Some(32)), Form::Point]),
        "Number of maps, or its least and largest value; 2 to 7 if left out.";
    space: Option<WrittenNumber> = Form::Whole(2, Some(3)), "Number of dimensions: 2, or 3 for maps of space; 2 if left out.";
    sigma: Law = Form::variant::<Law>(),
        "Law of the maps: `anderson`, by singular values, or `uniform`, by coefficients from -1 to 1.";
}

mapping! {
    /// The pictures of a category as written.
    struct InstancesDocument: INSTANCES = "the pictures of a category", "instances: {count: 1000, weights: fractaldb, flips: true}";
    count: Option<WrittenNumber> = Form::Whole(1, None), "Number of pictures of a category; 1 if left out.";
    weights: Option<Written<String>> = Form::Text,
        "Factors of the coefficients of maps: `none`, `fractaldb`, `fractaldb(step)` or `jitter(spread)`.";
    flips: bool = Form::Flag(false), "Whether pictures are flipped, in all four ways.";
    views: Option<Written<String>> = Form::Either(&[Form::Words(&["random"]), Form::Whole(1, None)]),
        "Directions from which sets in space are seen: `random` for each picture, or a number of them, evenly around the set.";
}

mapping! {
    /// The drawing of pictures as written.
    struct PictureDocument: PICTURE = "the drawing of pictures", "picture: {size: 256, points: 100k, mode: hits}";
    size: Option<WrittenNumber> = Form::Whole(1, Some(16_384)), "Side in pixels; 256 if left out.";
    points: Option<Written<String>> = Form::Text, "Number of points: 100k, 1M; 100k if left out.";
    mode: Mode = Form::variant::<Mode>(), "How hits become levels.";
    colour: Option<Written<String>> = Form::Text, "`gray`, `hsv`, or the name of a palette; `gray` if left out.";
    fit: Framing = Form::variant::<Framing>(), "How the box of the attractor fills the picture.";
    format: PictureFormat = Form::variant::<PictureFormat>(), "Format of files.";
}

mapping! {
    /// Conditions for random systems as written.
    struct AcceptDocument: ACCEPT = "conditions for random systems", "accept: {fill: 0.2}";
    fill: Option<WrittenNumber> = Form::Number,
        "Least share of pixels that are hit, of 512 x 512, by 100,000 points.";
}

/// Law by which the maps of random systems are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Law {
    /// By singular values below 1 whose weighted sum is limited (Anderson & Farrell 2022).
    #[default]
    Anderson,
    /// By coefficients that are uniform on [-1, 1) (Kataoka et al. 2020).
    Uniform,
}

impl Named for Law {
    const NAMES: &'static [(&'static str, Self)] =
        &[("anderson", Self::Anderson), ("uniform", Self::Uniform)];
}

/// Mapping of hits to levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Mode {
    /// By the logarithm of the number of hits, from 1 to 255.
    #[default]
    Hits,
    /// 255 for every pixel that is hit.
    Binary,
    /// As `binary`, with a pattern of 3 × 3 pixels, drawn for the picture, in place of a pixel.
    Patch3,
}

impl Named for Mode {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("hits", Self::Hits),
        ("binary", Self::Binary),
        ("patch3", Self::Patch3),
    ];
}

/// Placement of the box of an attractor in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Framing {
    /// The box fills the picture; x and y are scaled apart.
    #[default]
    Box,
    /// The longer side of the box fills the picture; x and y are scaled alike.
    Shape,
}

impl Named for Framing {
    const NAMES: &'static [(&'static str, Self)] = &[("box", Self::Box), ("shape", Self::Shape)];
}

/// Format of pictures in files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum PictureFormat {
    /// PNG.
    #[default]
    Png,
}

impl Named for PictureFormat {
    const NAMES: &'static [(&'static str, Self)] = &[("png", Self::Png)];
}

variants! {
    Law: "law of random systems";
    Mode: "mode of pictures";
    Framing: "way to fit";
    PictureFormat: "format of pictures";
}

/// A parameter and its value, or the distribution of its values.
#[derive(Clone, Debug)]
pub struct LawDocument {
    /// Name of the parameter.
    pub name: Written<String>,
    /// Number or distribution.
    pub value: WrittenNumber,
}

impl FromNode for Vec<LawDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let hint = "params: {angle: 'uniform(10, 80)'}";
        let entries = reader.names(node, "a mapping of parameters", hint);
        let law = |(key, node): &(Key, Node)| LawDocument {
            name: Written {
                value: key.name.clone(),
                place: key.place.clone(),
            },
            value: reader.number(node),
        };
        Some(entries.iter().map(law).collect())
    }
}

impl FromNode for Vec<SourceDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let nodes = match &node.value {
            Value::Sequence(_) => reader.filled(node, "a list of sources", "source", SOURCE.hint),
            _ => std::slice::from_ref(node),
        };
        let sources = nodes.iter();
        sources
            .map(|node| SourceDocument::from_node(reader, node))
            .collect()
    }
}

impl FromNode for Vec<Written<String>> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let nodes = match &node.value {
            Value::Sequence(_) => reader.filled(node, "a list of names", "name", "library: [ifs]"),
            _ => std::slice::from_ref(node),
        };
        nodes.iter().map(|node| reader.name(node)).collect()
    }
}

impl DatasetDocument {
    /// Reads the text of a data set.
    ///
    /// # Errors
    ///
    /// Returns all mistakes of syntax, and all keys and values that have no meaning.
    pub fn read(source: &Arc<Source>) -> Result<Self, Diagnostics> {
        let mut found = Diagnostics::default();
        let node = Node::parse_with(source, &mut found);
        let document = node.and_then(|node| {
            let mut reader = Reader::after(&found, &node);
            let document = Self::from_node(&mut reader, &node);
            found.extend(reader.diagnostics);
            document
        });
        match document {
            Some(document) if !found.has_errors() => Ok(document),
            _ => Err(found.without_repeats()),
        }
    }
}
