//! Draws the systems of the library, fits systems to their pictures, and compares.
//!
//!     cargo run --locked --release --example fits -- [--size 128] [--free] [--method auto] [--effort 20000] [--save FOLDER] [NAME ...]
//!     cargo run --locked --release --example fits -- --random 35
//!
//! The table is Markdown: the number of maps of the library and of the fit, intersection over union, along the
//! boundaries too, the share of the fit within 2 pixels of the picture, Hausdorff distance in per cent of the longer side,
//! whether the picture is matched exactly, the method, and the time on one thread. With `--free` the number of maps is not
//! given to the fit. With `--random` the systems are random: 2 to 8 affine maps with singular values from 0.2 to 0.7.

#![allow(clippy::print_stdout, reason = "it says what it has found")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "pictures are small"
)]

use std::error::Error;
use std::num::NonZero;
use std::time::Instant;

use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::convert::{Keeps, convert};
use kfrac::diagnostic::Diagnostics;
use kfrac::document::Document;
use kfrac::fit::{Candidate, FitOptions, Method, Silhouette};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::graph::Graph;
use kfrac::ifs::System;
use kfrac::measure::Bits;
use kfrac::model::Model;
use kfrac::{Kind, fit};

fn main() -> Result<(), Box<dyn Error>> {
    let mut size = 128;
    let mut free = false;
    let mut method = Method::Collage;
    let mut effort = None;
    let mut drawn = 0;
    let mut folder = None;
    let mut names = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--size" => size = arguments.next().ok_or("--size N")?.parse()?,
            "--free" => free = true,
            "--random" => drawn = arguments.next().ok_or("--random COUNT")?.parse()?,
            "--method" => {
                let name = arguments.next().ok_or("--method NAME")?;
                let named = Method::ALL.into_iter().find(|it| it.name() == name);
                method = named.ok_or("auto, skeleton, collage or moments")?;
            }
            "--effort" => effort = Some(arguments.next().ok_or("--effort N")?.parse()?),
            "--save" => folder = arguments.next(),
            _ => names.push(argument),
        }
    }
    println!(
        "| name | maps | fitted | IoU | boundary | within 2 | Hausdorff % | exact | method | s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut rows = Vec::new();
    let all = match drawn {
        0 => systems(&names)?,
        count => random_systems(count),
    };
    for (name, candidate) in all {
        let Some(placed) = placed(&candidate, size) else {
            continue;
        };
        let (candidate, frame) = placed;
        let Ok(picture) = candidate.attractor(frame, None) else {
            continue;
        };
        let Ok(shape) = Silhouette::new(picture.pixels) else {
            continue;
        };
        let count = candidate.maps.len();
        let options = FitOptions::default()
            .method(method)
            .threads(NonZero::<usize>::MIN);
        let options = match effort {
            Some(effort) => options.effort(effort),
            None => options,
        };
        let options = if free {
            options
        } else {
            options.maps(count..=count)
        };
        let start = Instant::now();
        let found = fit(&shape, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let away = 100.0 * found.score.hausdorff / frame[0].max(frame[1]) as f64;
        let exact = if found.exact { "yes" } else { "" };
        println!(
            "| {name} | {count} | {} | {:.3} | {:.3} | {:.3} | {away:.2} | {exact} | {} | {seconds:.2} |",
            found.candidate.maps.len(),
            found.score.iou,
            found.score.boundary_iou,
            found.score.coverage,
            found.method.name(),
        );
        if let Some(folder) = &folder {
            let drawn = found.candidate.attractor(frame, None)?.pixels;
            save(&format!("{folder}/{name}.png"), [shape.bits(), &drawn])?;
        }
        rows.push((
            count,
            found.candidate.maps.len(),
            found.score.iou,
            away,
            found.exact,
            found.score.coverage,
        ));
    }
    let share = |count: usize| 100.0 * count as f64 / rows.len().max(1) as f64;
    let mut ious: Vec<f64> = rows.iter().map(|row| row.2).collect();
    ious.sort_by(f64::total_cmp);
    let mut aways: Vec<f64> = rows.iter().map(|row| row.3).collect();
    aways.sort_by(f64::total_cmp);
    let within = rows.iter().map(|row| row.5).sum::<f64>() / rows.len().max(1) as f64;
    println!(
        "\n{} systems: median IoU {:.3}, {:.0} % at 0.95 or more, median Hausdorff {:.2} %, {} exact, maps within + 1 in {:.0} %, {within:.3} within 2 pixels in the mean",
        rows.len(),
        ious.get(ious.len() / 2).unwrap_or(&0.0),
        share(rows.iter().filter(|row| row.2 >= 0.95).count()),
        aways.get(aways.len() / 2).unwrap_or(&0.0),
        rows.iter().filter(|row| row.4).count(),
        share(rows.iter().filter(|row| row.1 <= row.0 + 1).count()),
    );
    Ok(())
}

/// Returns systems of 2 to 8 affine maps, drawn by an additive sequence whose bits are mixed (SplitMix).
fn random_systems(count: u64) -> Vec<(String, Candidate)> {
    let mut state = 1u64;
    let mut unit = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = (state ^ state >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ bits >> 31) >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut systems = Vec::new();
    for number in 0..count {
        let maps = (0..2 + number % 7).map(|_| {
            let [one, other] = [unit(), unit()].map(|it| DMat2::from_angle(it * 7.0));
            let factors = DVec2::new(0.2 + 0.5 * unit(), 0.2 + 0.5 * unit());
            let matrix = one * DMat2::from_diagonal(factors) * other;
            DAffine2::from_mat2_translation(matrix, DVec2::new(unit(), unit()) - 0.5)
        });
        let candidate = Candidate::of_maps(maps.collect());
        // About a point of the attractor, in a unit that holds it.
        let reach = { candidate.maps.iter() }
            .map(|map| map.translation.length() / (1.0 - 0.7))
            .fold(0.0, f64::max);
        let scale = DMat2::from_diagonal(DVec2::splat(0.5 / reach));
        let there = DAffine2::from_mat2_translation(scale, DVec2::ZERO);
        systems.push((format!("random {number}"), candidate.moved(&there)));
    }
    systems
}

/// Returns the systems of the library that are a union of maps of the plane.
fn systems(names: &[String]) -> Result<Vec<(String, Candidate)>, Box<dyn Error>> {
    let catalogue = Catalogue::embedded();
    let mut systems: Vec<(String, Candidate)> = Vec::new();
    for entry in catalogue.entries() {
        let wanted = names.is_empty() || names.contains(&entry.name);
        if !wanted
            || ![Shelf::RULES, Shelf::IFS, Shelf::LSYSTEMS, Shelf::INSTANCING]
                .contains(&entry.shelf)
        {
            continue;
        }
        let source = catalogue.rule(&entry.name).map_err(Diagnostics::from)?;
        let (model, _) = Document::read(&source, &catalogue)?.resolve(&[])?;
        let model = match model {
            Model::Ifs(_) => model,
            _ if model.is_in_space() => continue,
            _ => match convert(&model, Kind::Ifs, Keeps::Limit) {
                Ok(document) => document.resolve(&[])?.0,
                Err(_) => continue,
            },
        };
        let Model::Ifs(system) = model else { continue };
        let ifs = system.ifs();
        if ifs.is_recurrent()
            || !ifs.condensation().is_empty()
            || !(2..=8).contains(&ifs.maps().len())
        {
            continue;
        }
        let maps: Vec<DAffine2> = ifs.maps().iter().map(|map| map.affine).collect();
        let candidate = normal(&system, maps)?;
        if let Some(candidate) = candidate
            && !systems.iter().any(|(_, other)| same(other, &candidate))
        {
            systems.push((entry.name, candidate));
        }
    }
    Ok(systems)
}

/// Returns a system whose attractor lies in the unit square about 0.
fn normal(system: &System, maps: Vec<DAffine2>) -> Result<Option<Candidate>, Box<dyn Error>> {
    let Some(bounds) = Graph::of_system(system).limit_bounds() else {
        return Ok(None);
    };
    let side = bounds.size().max_element();
    let middle = (bounds.min() + bounds.max()) / 2.0;
    let scale = DMat2::from_diagonal(DVec2::splat(1.0 / side));
    let there = DAffine2::from_mat2_translation(scale, -middle / side);
    Ok((side > 0.0).then(|| Candidate::of_maps(maps).moved(&there)))
}

fn same(one: &Candidate, other: &Candidate) -> bool {
    one.maps.len() == other.maps.len()
        && one
            .maps
            .iter()
            .all(|map| other.maps.iter().any(|own| own.abs_diff_eq(*map, 1e-6)))
}

/// Returns a system in a picture of `size` pixels on the long side, with a margin of a twentieth.
fn placed(candidate: &Candidate, size: usize) -> Option<(Candidate, [usize; 2])> {
    let fine =
        DAffine2::from_scale_angle_translation(DVec2::splat(400.0), 0.0, DVec2::splat(256.0));
    let drawn = Silhouette::new(
        candidate
            .moved(&fine)
            .attractor([512, 512], None)
            .ok()?
            .pixels,
    )
    .ok()?;
    let extent = drawn.bounds().size() / 400.0;
    let margin = (size / 20) as f64;
    let scale = (size as f64 - 2.0 * margin) / extent.max_element().max(0.1);
    let sides = extent * scale + 2.0 * margin;
    let frame = [sides.x, sides.y].map(|side| side.ceil() as usize);
    let middle = ((drawn.bounds().min() + drawn.bounds().max()) / 2.0 - 256.0) / 400.0;
    let shift = sides / 2.0 - middle * scale;
    let there = DAffine2::from_scale_angle_translation(DVec2::splat(scale), 0.0, shift);
    Some((candidate.moved(&there), frame))
}

/// Writes two pictures in one: the first alone in blue, the second alone in red, both in black.
fn save(path: &str, [one, other]: [&Bits; 2]) -> Result<(), Box<dyn Error>> {
    let (width, height) = (one.width(), one.height());
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let bytes =
        pixels.flat_map(
            |(column, row)| match (one.get(column, row), other.get(column, row)) {
                (true, true) => [0, 0, 0],
                (true, false) => [0, 90, 255],
                (false, true) => [255, 60, 0],
                (false, false) => [255, 255, 255],
            },
        );
    encoder
        .write_header()?
        .write_image_data(&bytes.collect::<Vec<u8>>())?;
    Ok(())
}
