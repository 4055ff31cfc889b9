//! From nodes to a rule as written. What is wrong is noted and something unknown stands in for it,
//! so that everything else is looked at as well.

mod base_element;
mod elements;
mod generator;
mod parameters;
mod rule;
mod select;

pub(super) use rule::{DESCRIPTION, RULE, read};
