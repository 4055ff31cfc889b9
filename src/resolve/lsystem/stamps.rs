//! Stamps of L-systems: base elements that symbols place.

use crate::document::{LSystemDocument, StampDocument};
use crate::ifs::Shape;
use crate::lsystem::LSystem;
use crate::metadata::Metadata;
use crate::resolve::Resolver;
use crate::rule::{BaseElement, Body, Surface};

use super::OfLSystem;

impl Resolver<OfLSystem> {
    /// Resolves a system in the plane. Reports mistakes and returns `None`.
    pub(in crate::resolve) fn lsystem_in_plane(
        &mut self,
        document: &LSystemDocument,
        metadata: Metadata,
    ) -> Option<LSystem> {
        let stamps = self.stamps(document, Self::stamp_in_plane);
        let system = self.lsystem(document, metadata)?;
        Some(LSystem {
            stamps: stamps?,
            ..system
        })
    }

    /// Resolves the stamps of a file by a function that returns the base elements of one. Reports mistakes and returns
    /// `None`.
    pub(super) fn stamps<B>(
        &mut self,
        document: &LSystemDocument,
        of: fn(&mut Self, &StampDocument) -> Option<Vec<B>>,
    ) -> Option<Vec<B>> {
        let mut all = Vec::new();
        let mut are_sound = true;
        for (name, stamp) in &document.stamps {
            let first = all.len();
            match of(self, stamp) {
                Some(made) => all.extend(made),
                None => are_sound = false,
            }
            let number = self.kind.stamps.len();
            let known = self.kind.stamp_numbers.entry(name.value.clone());
            known.or_insert(number);
            self.kind
                .stamps
                .push((name.value.clone(), first..all.len()));
        }
        are_sound.then_some(all)
    }

    fn stamp_in_plane(&mut self, stamp: &StampDocument) -> Option<Vec<BaseElement>> {
        let document = match stamp {
            StampDocument::BaseElement(document) => {
                return self.plane_base_element(document).map(|made| vec![made]);
            }
            StampDocument::Set(document) => document,
        };
        match self.set(document)? {
            Shape::Outline(outline) => Some(vec![outline]),
            Shape::Union(outlines) => Some(outlines.to_vec()),
            Shape::Point(_) => {
                let message = "a point has no extent to be placed";
                let hint = "{disk: {radius: 1/10}}, or another set";
                self.error_with_hint(&document.place, message, hint);
                None
            }
        }
    }

    pub(super) fn stamp_in_space(&mut self, stamp: &StampDocument) -> Option<Vec<Body>> {
        let body = match stamp {
            StampDocument::BaseElement(document) => self.body(document, None),
            StampDocument::Set(document) => {
                let solids = self.solids(document)?;
                self.check_surfaces(solids.len(), &document.place)?;
                let is_closed = solids.iter().all(|solid| solid.faces().len() > 1);
                let surfaces = solids.iter().cloned().map(Surface::from);
                Body::new(surfaces.collect(), Vec::new(), is_closed)
            }
        };
        body.map(|body| vec![body])
    }
}
