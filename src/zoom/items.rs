//! What a descent carries along, and what it finds.

use crate::geometry::Frame;
use crate::graph::{Chain, Root};
use crate::grow::Standing;
use crate::rule::BaseElement;

use super::clip::Path;
use super::fixed::Fixed;

/// An instance that may show in the window.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) standing: Standing,
    pub(super) object: usize,
    pub(super) level: u32,
    /// The step in which its fractal was born.
    pub(super) born: u32,
    /// Its map, in parts of a pixel from the middle of the window.
    pub(super) map: Fixed,
    /// Whether it joins the one before it.
    pub(super) joined: bool,
}

/// What has come of it.
pub(super) enum Item {
    /// Nothing yet.
    Node(Box<Node>),
    Root(Box<Found>),
    /// Here it was that an element seeded a fractal, by number.
    Seed(usize),
}

impl Item {
    /// Whether it joins the one before it, if it is of the fractal itself.
    pub(super) fn joined(&mut self) -> Option<&mut bool> {
        match self {
            Self::Node(node) => Some(&mut node.joined),
            Self::Root(found) => Some(&mut found.joined),
            Self::Seed(_) => None,
        }
    }
}

/// What of a fractal may show in the window.
pub(super) struct Line {
    /// The step of its birth.
    pub(super) born: u32,
    /// Whether it is a closed chain still.
    pub(super) is_ring: bool,
    /// In the order of traversal.
    pub(super) items: Vec<Item>,
}

impl Line {
    /// Adds the instances of a chain that may show, in the order of traversal; tells whether what comes
    /// next can go on where the last one ends.
    pub(super) fn string(
        &mut self,
        chain: &Chain,
        mut children: Vec<Option<Node>>,
        is_reversed: bool,
        mut pen: bool,
    ) -> bool {
        let count = children.len();
        for turn in 0..count {
            let listed = if is_reversed { count - 1 - turn } else { turn };
            if turn > 0 {
                let link = if is_reversed { listed + 1 } else { listed };
                pen &= chain.instances[link].joined;
            }
            match children[listed].take() {
                Some(mut child) => {
                    child.joined = pen;
                    self.items.push(Item::Node(Box::new(child)));
                    pen = true;
                }
                None => pen = false,
            }
        }
        pen
    }

    /// Nothing joins the first item any more.
    pub(super) fn open(&mut self) {
        self.is_ring = false;
        if let Some(first) = self.items.iter_mut().find_map(Item::joined) {
            *first = false;
        }
    }

    /// Adds a root; ways around the window that follow each other are one.
    pub(super) fn add(&mut self, found: Found) {
        let mut before = self.items.iter_mut().rev();
        let last = before.find(|item| !matches!(item, Item::Seed(_)));
        if let (Some(Item::Root(last)), Drawn::Around(next), true) =
            (last, &found.drawn, found.joined)
            && let Drawn::Around(path) = &mut last.drawn
        {
            path.append(next);
            return;
        }
        self.items.push(Item::Root(Box::new(found)));
    }

    /// Whether it has come to a closed way that does not lead around the window, with nothing on it.
    pub(super) fn is_elsewhere(&self) -> bool {
        match &self.items[..] {
            [Item::Root(only)] => match &only.drawn {
                Drawn::Around(path) => self.is_ring && !path.goes_around(),
                Drawn::Object | Drawn::Clipped(_) => false,
            },
            _ => false,
        }
    }
}

/// A root.
pub(super) struct Found {
    pub(super) object: usize,
    pub(super) frame: Frame,
    pub(super) root: Root,
    pub(super) joined: bool,
    pub(super) drawn: Drawn,
}

/// What is drawn of a root.
pub(super) enum Drawn {
    /// What comes of its object.
    Object,
    /// This, in its frame.
    Clipped(BaseElement),
    /// A way around the window, in pixels.
    Around(Path),
}

impl Found {
    pub(super) fn of(node: &Node, frame: Frame, joined: bool, drawn: Drawn) -> Self {
        let Standing {
            path, length, coat, ..
        } = node.standing;
        Self {
            object: node.object,
            frame,
            root: Root {
                level: node.level,
                path,
                length,
                coat,
            },
            joined,
            drawn,
        }
    }
}
