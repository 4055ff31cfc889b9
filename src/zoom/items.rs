//! State and results of a descent.

use crate::geometry::Frame2;
use crate::graph::{Chain, Root};
use crate::grow::TraversalState;
use crate::rule::BaseElement;

use super::clip::Path;
use super::fixed::Fixed;

/// Instance that may show in the window.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) state: TraversalState,
    pub(super) object: usize,
    pub(super) level: u32,
    /// Step of its fractal's birth.
    pub(super) born: u32,
    /// Map in parts of a pixel from the centre of the window.
    pub(super) map: Fixed,
    /// Whether it joins the item before.
    pub(super) joined: bool,
}

/// Item of a fractal.
pub(super) enum FractalItem {
    /// Instance that is still to be replaced or to become a root.
    Node(Box<Node>),
    Root(Box<FoundRoot>),
    /// Place at which an element seeded a fractal, with the number of the fractal.
    Seed(usize),
}

impl FractalItem {
    /// Returns whether it joins the item before; `None` for a seed.
    pub(super) fn joined(&mut self) -> Option<&mut bool> {
        match self {
            Self::Node(node) => Some(&mut node.joined),
            Self::Root(found) => Some(&mut found.joined),
            Self::Seed(_) => None,
        }
    }
}

/// Part of a fractal that may show in the window.
pub(super) struct FractalPart {
    /// Step of its birth.
    pub(super) born: u32,
    /// Whether it is still a closed chain.
    pub(super) is_ring: bool,
    /// Items in the order of traversal.
    pub(super) items: Vec<FractalItem>,
}

impl FractalPart {
    /// Adds the instances of a chain that may show, in the order of traversal; returns whether the next
    /// item can join the end of the last one.
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
                    self.items.push(FractalItem::Node(Box::new(child)));
                    pen = true;
                }
                None => pen = false,
            }
        }
        pen
    }

    /// Opens the chain: its first item joins no other.
    pub(super) fn open(&mut self) {
        self.is_ring = false;
        if let Some(first) = self.items.iter_mut().find_map(FractalItem::joined) {
            *first = false;
        }
    }

    /// Adds a root; consecutive paths around the window are joined to one.
    pub(super) fn add(&mut self, found: FoundRoot) {
        let mut before = self.items.iter_mut().rev();
        let last = before.find(|item| !matches!(item, FractalItem::Seed(_)));
        if let (Some(FractalItem::Root(last)), RootDrawing::Around(next), true) =
            (last, &found.drawn, found.joined)
            && let RootDrawing::Around(path) = &mut last.drawn
        {
            path.append(next);
            return;
        }
        self.items.push(FractalItem::Root(Box::new(found)));
    }

    /// Returns whether the fractal is only a closed path that does not lead around the window.
    pub(super) fn is_elsewhere(&self) -> bool {
        match &self.items[..] {
            [FractalItem::Root(only)] => match &only.drawn {
                RootDrawing::Around(path) => self.is_ring && !path.encloses(),
                RootDrawing::Object | RootDrawing::Clipped(_) => false,
            },
            _ => false,
        }
    }
}

/// Root: an instance from which the graph of the window starts.
pub(super) struct FoundRoot {
    pub(super) object: usize,
    pub(super) frame: Frame2,
    pub(super) root: Root,
    pub(super) joined: bool,
    pub(super) drawn: RootDrawing,
}

/// Drawing of a root.
pub(super) enum RootDrawing {
    /// Subtree of its object.
    Object,
    /// Clipped outline, in its frame.
    Clipped(BaseElement),
    /// Path around the window, in pixels.
    Around(Path),
}

impl FoundRoot {
    pub(super) fn of(node: &Node, frame: Frame2, joined: bool, drawn: RootDrawing) -> Self {
        let TraversalState {
            path,
            length,
            appearance,
            ..
        } = node.state;
        Self {
            object: node.object,
            frame,
            root: Root {
                level: node.level,
                path,
                length,
                appearance,
            },
            joined,
            drawn,
        }
    }
}
