//! Information of `kfrac info` that only iterated function systems have.

use serde::Serialize;

use super::info;
use super::readable::decimal;
use crate::geometry::{DVec2, Homothety, Point as _};
use crate::ifs::{AffineMap, Contraction, Exponent, Ifs, PointOf, System, Verdict};
use crate::model::Model;

/// Maps of a system, their contraction, and the measure of random iteration.
#[derive(Serialize)]
pub(super) struct SystemInfo {
    maps: Vec<MapInfo>,
    /// Whether the file gives no weights.
    default_weights: bool,
    /// Property that default weights are proportional to.
    weights_by: Option<Weights>,
    contraction: ContractionInfo,
    /// Contraction on average of random iteration, if the system is not known to contract.
    lyapunov_exponent: Option<ExponentInfo>,
    measure: Option<MeasureInfo>,
}

/// Property that default weights are proportional to.
#[derive(Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
enum Weights {
    Determinants,
    /// Widths of the pieces of a curve through points.
    Widths,
}

#[derive(Serialize)]
struct MapInfo {
    name: Option<String>,
    weight: f64,
    fixed_point: Option<Vec<f64>>,
}

#[derive(Serialize)]
struct ContractionInfo {
    contracts: Option<bool>,
    lower: f64,
    upper: f64,
    length: u32,
}

#[derive(Serialize)]
struct MeasureInfo {
    mean: [f64; 2],
    covariance: [[f64; 2]; 2],
}

#[derive(Serialize)]
struct ExponentInfo {
    /// Upper bound; null for minus infinity.
    upper: f64,
    exact: bool,
    length: u32,
    #[serde(skip)]
    text: String,
}

impl ExponentInfo {
    fn of(exponent: Exponent) -> Self {
        let Exponent {
            upper,
            is_exact,
            length,
        } = exponent;
        Self {
            upper,
            exact: is_exact,
            length,
            text: exponent.to_string(),
        }
    }
}

impl ContractionInfo {
    fn of(contraction: &Contraction) -> Self {
        Self {
            contracts: match contraction.verdict {
                Verdict::Contracts => Some(true),
                Verdict::Diverges => Some(false),
                Verdict::Undecided => None,
            },
            lower: contraction.lower,
            upper: contraction.upper,
            length: contraction.length,
        }
    }
}

impl SystemInfo {
    /// Collects the information of a system. `place` maps coordinates near the unit box around the origin, in which
    /// everything is computed in the plane, to those of the system.
    pub(super) fn of(model: &Model, place: &Homothety) -> Option<Self> {
        let system = match model {
            Model::Ifs(system) => system,
            Model::IfsInSpace(system) => {
                return Some(Self::within(
                    system,
                    system.ifs(),
                    &Homothety::IDENTITY,
                    None,
                ));
            }
            _ => return None,
        };
        let Model::Ifs(within) = model.within(place) else {
            return None;
        };
        let measure = within.ifs().measure().map(|measure| MeasureInfo {
            mean: (place.point(measure.moments.mean) + DVec2::ZERO).to_array(),
            covariance: (measure.moments.covariance.to_cols_array_2d())
                .map(|row| row.map(|value| value * place.ratio() * place.ratio())),
        });
        Some(Self::within(system, within.ifs(), place, measure))
    }

    /// Collects the information of a system with maps in coordinates that `place` maps to its own.
    fn within<M: AffineMap>(
        system: &System<M>,
        ifs: &Ifs<M>,
        place: &Homothety<PointOf<M>>,
        measure: Option<MeasureInfo>,
    ) -> Self {
        let point = |point: PointOf<M>| {
            let coordinates = place.point(point).coordinates();
            let coordinates = coordinates.iter().take(PointOf::<M>::DIMENSION);
            coordinates.map(|value| value + 0.0).collect()
        };
        let maps = ifs.maps().iter().zip(ifs.weights()).zip(ifs.fixed_points());
        let maps = maps.map(|((map, &weight), fixed)| MapInfo {
            name: map.name.clone(),
            weight,
            fixed_point: fixed.map(point),
        });
        let weights_by = if system.is_interpolation() {
            Some(Weights::Widths)
        } else {
            (!ifs.has_weights()).then_some(Weights::Determinants)
        };
        Self {
            maps: maps.collect(),
            default_weights: weights_by.is_some(),
            weights_by,
            contraction: ContractionInfo::of(system.contraction()),
            lyapunov_exponent: { system.contraction().verdict != Verdict::Contracts }
                .then(|| ifs.lyapunov_exponent().map(ExponentInfo::of))
                .flatten(),
            measure,
        }
    }

    /// Formats the information in lines, each with its label.
    pub(super) fn lines(&self, unit: f64) -> Vec<(&'static str, String)> {
        let mut lines = Vec::new();
        for (number, map) in self.maps.iter().enumerate() {
            let name = map.name.clone().unwrap_or_else(|| (number + 1).to_string());
            let fixed = map.fixed_point.as_ref().map_or_else(
                || "no single fixed point".into(),
                |point| format!("fixed point {}", info::point(point, unit)),
            );
            lines.push((
                "map",
                format!("{name}: weight {}, {fixed}", decimal(map.weight, 1.0)),
            ));
        }
        if let Some(weights) = self.weights_by {
            let by = match weights {
                Weights::Determinants => {
                    "by the determinants of the maps, or a twentieth of their mean if that is more"
                }
                Weights::Widths => "by the widths of the pieces between the points",
            };
            lines.push(("weights", format!("{by}, since the file gives none")));
        }
        let ContractionInfo {
            contracts,
            lower,
            upper,
            length,
        } = self.contraction;
        let known = match contracts {
            Some(true) => "yes",
            Some(false) => "no",
            None => "not decided",
        };
        let s = if length == 1 { "" } else { "s" };
        lines.push((
            "contracts",
            format!(
                "{known}: by a factor from {lower:.6} to {upper:.6} a map, by products of up to \
                 {length} map{s}"
            ),
        ));
        if let Some(exponent) = &self.lyapunov_exponent {
            lines.push(("on average", exponent.text.clone()));
        }
        if let Some(measure) = &self.measure {
            let [x, y] = measure.mean.map(|value| decimal(value, unit));
            lines.push(("mean", format!("[{x}, {y}]")));
            let is_finite = measure
                .covariance
                .as_flattened()
                .iter()
                .all(|it| it.is_finite());
            if !is_finite {
                return lines;
            }
            let [[xx, xy], [yx, yy]] = measure
                .covariance
                .map(|row| row.map(|value| decimal(value, unit * unit)));
            lines.push(("covariance", format!("[[{xx}, {xy}], [{yx}, {yy}]]")));
        }
        lines
    }
}
