//! Frames and tropism of L-systems in space.

use crate::document::{LSystemDocument, TropismDocument, WrittenPoint};
use crate::expression::degrees;
use crate::geometry::{Attitude, DMat3, DVec3, Direction, Frame3};
use crate::lsystem::{LSystemInSpace, Tropism};
use crate::metadata::Metadata;
use crate::resolve::Resolver;
use crate::style::ColorBy;

use super::OfLSystem;

impl Resolver<OfLSystem> {
    /// Resolves a system in space. Reports mistakes and returns `None`.
    pub(in crate::resolve) fn lsystem_in_space(
        &mut self,
        document: &LSystemDocument,
        metadata: Metadata,
    ) -> Option<LSystemInSpace> {
        self.kind.is_in_space = true;
        let stamps = self.stamps(document, Self::stamp_in_space);
        let start = self.start(document);
        let tropism = document.tropism.as_ref().map(|it| self.tropism(it));
        let mut words = self.lsystem(document, metadata)?;
        let stamps = stamps?;
        let pieces = stamps.iter().flat_map(|body| body.surfaces());
        if { pieces }.any(|piece| piece.color.is_some()) && !document.metadata.sets_colours {
            words.metadata.style.color_by = ColorBy::Tint;
        }
        Some(LSystemInSpace {
            words,
            start: start?,
            tropism: match tropism {
                None => None,
                Some(tropism) => Some(tropism?),
            },
            stamps,
        })
    }

    /// Returns the start rotation if the file gives more than an angle; the outer `None` is a mistake.
    fn start(&mut self, document: &LSystemDocument) -> Option<Option<DMat3>> {
        if document.start_vector.is_none() && document.up.is_none() {
            return Some(None);
        }
        let ahead = match &document.start_vector {
            Some(written) => self.direction(written, "a heading")?,
            None => {
                let angle = self.number_or(document.start.as_ref(), 0.0);
                DVec3::new(degrees::cos(angle), degrees::sin(angle), 0.0)
            }
        };
        let attitude = match &document.up {
            None => Attitude::Least,
            Some(written) => {
                let up = self.direction(written, "`up`")?;
                if ahead.cross(up).length() < 1e-9 {
                    let message = "`up` lies along the heading";
                    let hint = "a direction across the heading: up: [0, 0, 1]";
                    self.error_with_hint(&written.place, message, hint);
                    return None;
                }
                Attitude::Normal(up)
            }
        };
        let frame = Frame3::between(DVec3::ZERO, ahead, Direction::Normal, attitude);
        Some(Some(frame.map().matrix3))
    }

    fn tropism(&mut self, document: &TropismDocument) -> Option<Tropism> {
        let towards = self.constant_in_space(Some(&document.towards), DVec3::NEG_Y)?;
        if towards == DVec3::ZERO {
            let message = "this vector has no length";
            self.error_with_hint(&document.towards.place, message, "towards: [0, -1, 0]");
            return None;
        }
        let susceptibility = self.constant(&document.susceptibility)?;
        Some(Tropism {
            towards,
            susceptibility,
        })
    }

    /// Returns the direction of a vector.
    fn direction(&mut self, written: &WrittenPoint, what: &str) -> Option<DVec3> {
        let vector = self.constant_in_space(Some(written), DVec3::X)?;
        let direction = vector.try_normalize();
        if direction.is_none() {
            let message = format!("{what} is a vector with a length");
            self.error_with_hint(&written.place, message, "[0, 1, 0] is upwards");
        }
        direction
    }
}
