//! Morphology of a picture that was drawn (Libeskind-Hadas & Maragos 1987, figure 7).

use std::path::Path;

use anyhow::Context;

use crate::grow::Progress;
use crate::import::Raster;
use crate::morphology::{DiskFamily, Sequence};

use super::super::morph;
use super::super::output::{self, Counted, Output};
use super::super::pixels::PixelArguments;
use super::super::{Failure, morph::disk};
use super::Arguments;
use super::plan::Plan;

/// Limit of the bytes of a picture that is held in memory.
const MAX_BYTES: usize = 1 << 31;

/// Options for the morphology of the picture.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Morphology")]
pub(super) struct MorphArguments {
    /// Erodes, dilates, opens and closes the picture, as in "open:3, close:2", into a PNG of black on white
    ///
    /// Dark pixels, or opaque ones where pixels are transparent, are the set; kfrac morph describes the operations.
    #[arg(long, value_name = "OPERATIONS")]
    pub(super) morph: Option<Sequence>,
    /// Family of the disks of --morph
    #[arg(long, default_value = "euclid", value_parser = disk(), requires = "morph")]
    disk: DiskFamily,
}

impl MorphArguments {
    /// Refuses morphology of what is no PNG.
    pub(super) fn refuse_beside(&self, plan: &Plan) -> Result<(), Failure> {
        match self.morph {
            Some(_) if plan.extension() != "png" => {
                let message = "--morph applies to the pixels of a PNG: write a .png";
                Err(Failure::Usage(message.into()))
            }
            _ => Ok(()),
        }
    }
}

impl Arguments {
    /// Writes a picture, with the operations of `--morph` applied to it, and returns its size in bytes.
    pub(super) fn write_picture<T>(
        &self,
        path: &Path,
        content: impl FnOnce(&mut Counted<Output>, Option<&Progress>) -> Result<T, Failure>,
    ) -> Result<(T, u64), Failure> {
        let MorphArguments { morph, disk } = &self.morphed;
        let Some(operations) = morph else {
            return self.growth.write(path, content);
        };
        self.growth.write(path, |mut out, _| {
            let (written, bytes) = output::write_held(Vec::new(), MAX_BYTES, content)?;
            let picture = Raster::read(&bytes, None).context("the picture that was drawn")?;
            let set = PixelArguments::default().decide(output::called(path), picture)?;
            morph::write(
                &set.bits,
                operations,
                *disk,
                self.growth.threads(),
                path,
                &mut out,
            )?;
            Ok(written)
        })
    }
}
