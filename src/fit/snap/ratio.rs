//! Ratios that known systems have.

/// Ratios with their expressions in files.
fn known() -> Vec<(f64, String)> {
    let mut known: Vec<(f64, String)> = Vec::new();
    let mut add = |value: f64, text: String| {
        if known.iter().all(|other| (other.0 - value).abs() > 1e-12) {
            known.push((value, text));
        }
    };
    for below in 2..=9u32 {
        // 5/7 would hide 1/√2.
        let most = if below <= 5 { below } else { 2 };
        for above in 1..most {
            add(
                f64::from(above) / f64::from(below),
                format!("{above}/{below}"),
            );
        }
    }
    for square in [2u32, 3, 5, 7, 8, 12] {
        add(1.0 / libm::sqrt(square.into()), format!("1/sqrt({square})"));
    }
    let golden = (libm::sqrt(5.0) - 1.0) / 2.0;
    add(golden, "(sqrt(5) - 1)/2".into());
    add(golden * golden, "(3 - sqrt(5))/2".into());
    known
}

/// Returns the nearest known ratio within a relative distance, with its expression.
pub(in crate::fit) fn nearest(ratio: f64, most: f64) -> Option<(f64, String)> {
    let near = known()
        .into_iter()
        .filter(|known| (known.0 / ratio - 1.0).abs() <= most);
    near.min_by(|a, b| (a.0 - ratio).abs().total_cmp(&(b.0 - ratio).abs()))
}

/// Returns known ratios near those given: a common one if they are nearly equal. `None` if one has none nearby.
pub(super) fn shared(ratios: &[f64], most: f64) -> Option<Vec<f64>> {
    #[expect(clippy::cast_precision_loss, reason = "there are few maps")]
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    if ratios
        .iter()
        .all(|ratio| (ratio / mean - 1.0).abs() <= most)
    {
        let (common, _) = nearest(mean, most)?;
        return Some(vec![common; ratios.len()]);
    }
    ratios
        .iter()
        .map(|&ratio| Some(nearest(ratio, most)?.0))
        .collect()
}
