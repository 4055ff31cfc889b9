//! Sums over the elements of an object, which a forecast carries from step to step.

use std::ops::AddAssign;

use crate::count::Count;

/// Count of the elements of an object, with sums over them.
#[derive(Default)]
pub(super) struct Tally {
    pub(super) count: Count,
    pub(super) sums: Sums,
}

/// Sums over elements.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    /// Approximate number of elements that do not join the element before; the effects of reversed
    /// traversal and of vanishing elements are neglected.
    pub(super) apart: f64,
    /// Approximate number of the others that join an element of different fertility: one step later, the
    /// two were created in different steps.
    pub(super) beside: f64,
    /// Approximate number of the others that join an element created in another step.
    pub(super) parted: f64,
    pub(super) length: f64,
    /// Sum of squares of lengths.
    pub(super) square: f64,
    /// Sum of squares of lengths, negative where the left side of the element is outside its outline.
    pub(super) signed: f64,
    /// Sum of the lengths of the initiator elements from which the elements descend.
    pub(super) root_length: f64,
    /// Sum of the squares of these lengths.
    pub(super) root_square: f64,
    /// Sum of cubes of lengths.
    pub(super) cube: f64,
    /// Sum of the cubes of the lengths of the initiator elements from which the elements descend.
    pub(super) root_cube: f64,
}

impl AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.apart += other.apart;
        self.beside += other.beside;
        self.parted += other.parted;
        self.length += other.length;
        self.square += other.square;
        self.signed += other.signed;
        self.root_length += other.root_length;
        self.root_square += other.root_square;
        self.cube += other.cube;
        self.root_cube += other.root_cube;
    }
}
