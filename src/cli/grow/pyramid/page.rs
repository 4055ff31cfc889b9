//! Files beside the tiles of a pyramid: the description of Deep Zoom, that of the folder, and the page that shows the tiles.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::render;

use super::super::super::Failure;
use super::folder::write_file;
use super::levels::Pyramid;

/// Page that shows tiles, with places for its title and for the numbers of the pyramid.
const PAGE: &str = include_str!("viewer.html");

/// Returns the description of a folder of tiles: what they are, and the text from which they can be made again.
pub(super) fn description(pyramid: &Pyramid, provenance: &str) -> Result<String, Failure> {
    let [width, height] = pyramid.size(pyramid.deepest());
    let description = json!({
        "width": width,
        "height": height,
        "tile_size": pyramid.side(),
        "overlap": pyramid.overlap(),
        "made_from": provenance,
    });
    let text = serde_json::to_string_pretty(&description).map_err(anyhow::Error::new)?;
    Ok(text + "\n")
}

/// Writes the description of Deep Zoom and the page, and returns the path of the page.
pub(super) fn write(
    folder: &Path,
    name: &str,
    pyramid: &Pyramid,
    options: &render::Options,
) -> Result<PathBuf, Failure> {
    let [width, height] = pyramid.size(pyramid.deepest());
    let (side, overlap) = (pyramid.side(), pyramid.overlap());
    let dzi = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <Image xmlns=\"http://schemas.microsoft.com/deepzoom/2008\" Format=\"png\" Overlap=\"{overlap}\" TileSize=\"{side}\">\n  \
         <Size Width=\"{width}\" Height=\"{height}\"/>\n</Image>\n"
    );
    write_file(&folder.join(format!("{name}.dzi")), dzi.as_bytes())?;
    let [red, green, blue, alpha] = options.style.background.map_or([0; 4], |it| it.rgba());
    let numbers = json!({
        "files": format!("{name}_files"),
        "width": width,
        "height": height,
        "side": side,
        "overlap": overlap,
        "deepest": pyramid.deepest(),
        "background": format!("rgba({red}, {green}, {blue}, {})", f64::from(alpha) / 255.0),
    });
    // A text may hold the end of a script.
    let numbers = numbers.to_string().replace('<', "\\u003c");
    let title = render::escaped(&options.labels.title);
    let page = PAGE
        .replacen("TITLE", &title, 1)
        .replacen("NUMBERS", &numbers, 1);
    let path = folder.join("index.html");
    write_file(&path, page.as_bytes())?;
    Ok(path)
}
