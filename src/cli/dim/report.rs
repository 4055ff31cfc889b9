//! Output of `kfrac dim`, as text and as JSON.

use std::fmt::Write as _;

use serde::Serialize;
use serde_json::{Value, json};

use crate::measure::exact::{Dimensions, GraphDimensions, Hausdorff, OtherDimension};
use crate::measure::{BoxCounting, Estimate, Trend};

use super::Measured;

/// Number of decades below which a slope is weak evidence of a dimension.
const FEW_DECADES: f64 = 2.0;

#[derive(Serialize)]
pub(super) struct Report<'a> {
    similarity: Option<Value>,
    affinity: Option<Value>,
    hausdorff: Option<Value>,
    boundary: Option<Value>,
    contact: Option<Value>,
    #[serde(rename = "box")]
    box_dimension: Option<Value>,
    drawn: Option<f64>,
    notes: &'a [String],
    box_counting: Counting<'a>,
    measure: Option<&'a str>,
    spectrum: Vec<Value>,
    lacunarity: Vec<Value>,
    warnings: &'a [String],
}

#[derive(Serialize)]
struct Counting<'a> {
    set: &'a str,
    #[serde(flatten)]
    estimate: Fields,
    base: Option<f64>,
    fitting_base: Option<f64>,
    trend: Option<Value>,
    boxes: Vec<Boxes>,
    means: Vec<Value>,
}

#[derive(Serialize)]
struct Boxes {
    size: f64,
    count: u64,
    sampled: bool,
    local_slope: Option<f64>,
    scatter: f64,
    used: bool,
}

/// Estimate, or nulls.
#[derive(Serialize, Default)]
struct Fields {
    value: Option<f64>,
    std_error: Option<f64>,
    range: Option<[f64; 2]>,
    r_squared: Option<f64>,
}

impl Fields {
    fn of(estimate: Option<&Estimate>) -> Self {
        estimate.map_or_else(Self::default, |estimate| Self {
            value: Some(estimate.value),
            std_error: Some(estimate.std_error),
            range: Some(estimate.range),
            r_squared: Some(estimate.r_squared),
        })
    }
}

/// Formats the result as JSON.
pub(super) fn json(measured: &Measured) -> Report<'_> {
    let exact = measured.exact.as_ref();
    let known = exact.and_then(|exact| exact.dimensions.as_ref());
    let boxes = measured.counting.boxes.iter().map(|it| Boxes {
        size: it.size,
        count: it.count,
        sampled: it.sampled,
        local_slope: it.local_slope,
        scatter: it.scatter,
        used: it.used,
    });
    let spectrum = measured.spectrum.iter().map(|it| {
        let sums = it.entropies.iter();
        let sums = sums.map(|(size, entropy)| json!({"size": size, "entropy": entropy}));
        let mut value = json!(Fields::of(it.estimate.as_ref()));
        value["q"] = json!(it.order);
        value["exact"] = json!(measured.known(it.order));
        value["boxes"] = sums.collect();
        value
    });
    let lacunarity = measured.lacunarity.iter();
    let lacunarity =
        lacunarity.map(|it| json!({"size": it.size, "value": it.value, "places": it.places}));
    let means = measured.counting.means.iter();
    let means = means.map(|(size, boxes)| json!({"size": size, "boxes": boxes}));
    Report {
        similarity: exact.map(|_| similarity(known)),
        affinity: known.and_then(affinity),
        hausdorff: exact.map(|_| hausdorff(known)),
        boundary: known.and_then(|known| other(known.boundary.as_ref())),
        contact: known.and_then(|known| other(known.contact.as_ref())),
        box_dimension: known.and_then(|known| other(known.box_dimension.as_ref())),
        drawn: exact.and_then(|exact| exact.drawn),
        notes: exact.map_or(&[][..], |exact| &exact.notes),
        box_counting: Counting {
            set: &measured.set,
            estimate: Fields::of(measured.counting.estimate.as_ref()),
            base: measured.counting.base,
            fitting_base: measured.counting.fitting_base,
            trend: measured.counting.trend.as_ref().map(trend),
            boxes: boxes.collect(),
            means: means.collect(),
        },
        measure: measured.measure,
        spectrum: spectrum.collect(),
        lacunarity: lacunarity.collect(),
        warnings: &measured.warnings,
    }
}

/// Drift of the local slopes.
fn trend(trend: &Trend) -> Value {
    json!({
        "per_decade": trend.per_decade,
        "std_error": trend.std_error,
        "significant": trend.is_significant(),
    })
}

/// Similarity dimension with its equation and closed form.
fn similarity(known: Option<&Dimensions>) -> Value {
    let similar = known.and_then(|known| known.similarity.as_ref());
    json!({
        "value": similar.map(|it| it.value),
        "equation": similar.map(|it| it.equation.to_string()),
        "closed_form": similar.and_then(|it| it.closed_form.as_ref()),
    })
}

/// Falconer's affinity dimension, an upper bound where maps are not similarities.
fn affinity(known: &Dimensions) -> Option<Value> {
    let affinity = known.affinity.as_ref()?;
    Some(json!({
        "upper_bound": affinity.upper_bound,
        "estimate": affinity.estimate,
        "length": affinity.length,
    }))
}

/// Hausdorff dimension of the set, whose copies may overlap.
pub(in crate::cli) fn hausdorff(known: Option<&Dimensions>) -> Value {
    known.map_or_else(
        || json!({"value": null, "overlap": "unknown", "method": null}),
        |known| {
            let hausdorff = &known.hausdorff;
            json!({
                "value": hausdorff.value,
                "closed_form": hausdorff.closed_form,
                "upper_bound": hausdorff.upper_bound,
                "overlap": hausdorff.overlap.to_string(),
                "method": hausdorff.method,
            })
        },
    )
}

/// Dimension of another set, or another dimension.
fn other(known: Option<&OtherDimension>) -> Option<Value> {
    let known = known?;
    Some(json!({
        "value": known.value,
        "closed_form": known.closed_form,
        "method": known.method,
    }))
}

/// Adds warnings about the reliability of the measurement.
pub(super) fn warn(measured: &mut Measured) {
    let few = |what: &str, decades: f64| {
        format!(
            "{what} only {decades:.1} decades: below {FEW_DECADES}, a slope is weak evidence of a dimension"
        )
    };
    let decades = |estimate: &Estimate| (estimate.sizes > 0).then(|| estimate.decades());
    let counted = measured.counting.estimate.as_ref();
    let counted_decades = counted.and_then(decades);
    if let Some(decades) = counted_decades.filter(|decades| *decades < FEW_DECADES) {
        measured.warnings.push(few("the range spans", decades));
    } else if counted.is_none()
        && !measured.counting.boxes.is_empty()
        && measured
            .counting
            .boxes
            .iter()
            .filter(|row| row.used)
            .count()
            < 3
    {
        let warning = "fewer than three sizes of boxes are usable: nothing is fitted";
        measured.warnings.push(warning.into());
    }
    // The warning for order 0 of points and pictures is that of box counting.
    let spectrum = measured.spectrum.iter();
    let spectrum = spectrum.filter(|it| measured.measure.is_some() || it.order != 0.0);
    let spectrum = spectrum.filter_map(|it| it.estimate.as_ref().and_then(decades));
    let least = spectrum.reduce(f64::min);
    if let Some(decades) = least.filter(|decades| *decades < FEW_DECADES) {
        measured
            .warnings
            .push(few("the spectrum D_q rests on", decades));
    }
}

/// Returns the result in one sentence.
pub(super) fn sentence(measured: &Measured) -> String {
    let Some(estimate) = &measured.counting.estimate else {
        return "The box-counting dimension could not be measured.".into();
    };
    let Estimate {
        value, std_error, ..
    } = estimate;
    if estimate.sizes == 0 {
        return "A single point has dimension 0.".into();
    }
    let unit = measured
        .unit
        .map(|unit| format!(" {unit}"))
        .unwrap_or_default();
    let decimals = decimals(2.0 * std_error);
    format!(
        "The box-counting dimension is {value:.decimals$} ± {:.decimals$} (2 standard errors), from {} sizes \
         over {:.1} decades ({} to {}{unit}), r² = {:.6}.",
        2.0 * std_error,
        estimate.sizes,
        estimate.decades(),
        short(estimate.range[0]),
        short(estimate.range[1]),
        estimate.r_squared,
    )
}

/// Returns the number of decimals that shows two digits of an error.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it is clamped"
)]
fn decimals(error: f64) -> usize {
    let first = if error > 0.0 {
        -libm::log10(error).floor()
    } else {
        4.0
    };
    (first + 1.0).clamp(2.0, 6.0) as usize
}

/// Formats a size with four digits.
pub(super) fn short(size: f64) -> String {
    let exponent = libm::log10(size).floor();
    if (-4.0..6.0).contains(&exponent) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is small"
        )]
        let decimals = (3.0 - exponent).max(0.0) as usize;
        let text = format!("{size:.decimals$}");
        match text.split_once('.') {
            Some(_) => text.trim_end_matches('0').trim_end_matches('.').into(),
            None => text,
        }
    } else {
        format!("{size:.3e}")
    }
}

/// Describes the result in text.
pub(super) fn described(measured: &Measured) -> String {
    let mut text = format!("{}: {}\n\n", measured.name, measured.set);
    if let Some(exact) = &measured.exact {
        known(&mut text, exact);
    }
    if measured.is_exact {
        spectrum(&mut text, measured);
        return text;
    }
    table(&mut text, &measured.counting, measured.unit);
    spectrum(&mut text, measured);
    if !measured.lacunarity.is_empty() {
        let _ = writeln!(text, "\n{:>12}  {:>10}", "gliding box", "lacunarity");
        for it in &measured.lacunarity {
            let _ = writeln!(text, "{:>12}  {:>10.4}", short(it.size), it.value);
        }
    }
    let _ = writeln!(text, "\n{}", sentence(measured));
    for remark in remarks(&measured.counting) {
        let _ = writeln!(text, "{remark}");
    }
    text
}

/// Returns remarks on the fit: drifts, bases and ranges.
fn remarks(counting: &BoxCounting) -> Vec<String> {
    const USUAL: f64 = 2.0;
    let mut remarks = Vec::new();
    if let (Some(base), Some(fitting)) = (counting.base, counting.fitting_base) {
        if base != fitting {
            remarks.push(format!(
                "The base {fitting} fits this picture better than {base}: \
                 all its local slopes are equal (--base {fitting})."
            ));
        } else if base != USUAL {
            remarks.push(format!(
                "The base {base} fits this picture better than {USUAL}: \
                 all its local slopes are equal."
            ));
        }
    }
    if let Some(trend) = counting.trend.filter(Trend::is_significant) {
        let way = if trend.per_decade > 0.0 {
            "rise"
        } else {
            "fall"
        };
        remarks.push(format!(
            "Local slopes {way} by {:.4} ± {:.4} per decade of smaller boxes: the estimate extrapolates \
             this drift beyond the measured sizes, and its error accounts for that.",
            trend.per_decade.abs(),
            2.0 * trend.std_error,
        ));
    }
    remarks
}

impl Measured {
    /// Returns the exact dimension of an order, if it is known and finite.
    fn known(&self, order: f64) -> Option<f64> {
        let known = self.spectrum_known.as_ref()?;
        Some(known.at(order)).filter(|value| value.is_finite())
    }
}

/// Writes the spectrum of dimensions.
fn spectrum(text: &mut String, measured: &Measured) {
    if measured.spectrum.is_empty() {
        return;
    }
    let of = match measured.measure {
        Some("weights") => "\nof the measure given by the weights",
        Some("squares") => "\nof squares of equal mass",
        Some(_) => "\nof the natural measure",
        None => "",
    };
    let has_known = measured.spectrum_known.is_some();
    let exact = |value: String| {
        if has_known {
            format!("  {value:>10}")
        } else {
            String::new()
        }
    };
    let head = exact("exact".into());
    let measures = match measured.is_exact {
        true => String::new(),
        false => format!("  {:>8}  {:>8}  {:>9}", "D_q", "± 2 s.e.", "r²"),
    };
    let _ = writeln!(text, "{of}\n{:>6}{head}{measures}", "q");
    for it in &measured.spectrum {
        let name = match it.order {
            1.0 => "information",
            2.0 => "correlation",
            _ => "",
        };
        let known = measured.known(it.order);
        let known = exact(known.map_or_else(String::new, |value| format!("{value:.6}")));
        let line = match &it.estimate {
            Some(estimate) => format!(
                "{:>6}{known}  {:>8.4}  {:>8.4}  {:>9.6}  {name}",
                it.order,
                estimate.value,
                2.0 * estimate.std_error,
                estimate.r_squared
            ),
            None if measured.is_exact => format!("{:>6}{known}  {name}", it.order),
            None if has_known => format!("{:>6}{known}  {:>30}{name}", it.order, ""),
            None => continue,
        };
        let _ = writeln!(text, "{}", line.trim_end());
    }
}

/// Writes the exact results.
fn known(text: &mut String, exact: &GraphDimensions) {
    let mut line = |label: &str, value: &str| {
        let _ = writeln!(text, "{label:<22}{value}");
    };
    let formatted = |value: f64, form: Option<&String>| match form {
        Some(form) => format!("{value:.12} = {form}"),
        None => format!("{value:.12}"),
    };
    if let Some(dimensions) = &exact.dimensions {
        if let Some(similar) = &dimensions.similarity {
            let form = similar.closed_form.as_ref();
            line("similarity dimension", &formatted(similar.value, form));
        }
        if let Some(affinity) = &dimensions.affinity {
            let bound = format!("at most {:.4} (Falconer 1988)", affinity.upper_bound);
            line("affinity dimension", &bound);
        }
        let Hausdorff {
            value,
            closed_form,
            upper_bound,
            overlap,
            method,
        } = &dimensions.hausdorff;
        let own = match (value, upper_bound) {
            (Some(value), _) => formatted(*value, closed_form.as_ref()),
            (None, Some(bound)) => format!("at most {bound:.6}"),
            (None, None) => "not decided".into(),
        };
        line("Hausdorff dimension", &own);
        line("", method);
        line("overlap", &overlap.to_string());
        let others = [
            ("box dimension", &dimensions.box_dimension),
            ("boundary", &dimensions.boundary),
            ("contact of copies", &dimensions.contact),
        ];
        for (label, other) in others {
            if let Some(other) = other {
                let form = other.closed_form.as_ref();
                let own = other.value.map(|value| formatted(value, form));
                line(label, own.as_ref().unwrap_or(&other.method));
            }
        }
        if let Some(drawn) = exact.drawn {
            line("all that is drawn", &formatted(drawn, None));
        }
    }
    for note in &exact.notes {
        line("note", note);
    }
    text.push('\n');
}

/// Writes the counts for every size of boxes; a star marks those that the fit uses.
fn table(text: &mut String, counting: &BoxCounting, unit: Option<&str>) {
    if counting.boxes.is_empty() {
        return;
    }
    let side = unit.map_or("side".into(), |unit| format!("side ({unit})"));
    let _ = writeln!(text, "{side:>13}  {:>20}  {:>11}", "boxes", "local slope");
    for it in &counting.boxes {
        let slope = it
            .local_slope
            .map(|slope| format!("{slope:.4}"))
            .unwrap_or_default();
        let star = if it.used { "*" } else { "" };
        let about = if it.sampled { "~" } else { "" };
        let line = format!(
            "{:>13}  {:>20}  {slope:>11} {star}",
            short(it.size),
            format!("{about}{}", it.count)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let sampled = counting.boxes.iter().any(|it| it.sampled);
    let about = if sampled {
        "; ~ from a sample of boxes"
    } else {
        ""
    };
    let _ = writeln!(text, "(* used by the fit{about})");
}
