//! From nodes to a rule as written. What is wrong is noted and something unknown stands in for it,
//! so that everything else is looked at as well.

mod base_element;
mod elements;
mod generator;
mod parameters;
mod rule;
mod select;

pub(super) use base_element::BASE_ELEMENT;
pub(super) use elements::{ELEMENTS, INITIATOR};
pub(super) use generator::GENERATOR;
pub(super) use parameters::{PARAMETER, PARAMS};
pub(super) use rule::{DESCRIPTION, KIND, RULE, check_description, read};
