//! The rows that a filter needs for one row.

use std::collections::VecDeque;

use super::color::ColorSpace;
use crate::image::Raster;

/// A row of pixels as three rows of opponents.
type Row = [Vec<f64>; 3];

/// A row of a picture and so many rows and columns around it; beyond its border a picture goes on
/// with its outermost pixels.
pub(super) struct Neighborhood<'a> {
    image: &'a Raster,
    colors: &'a ColorSpace,
    radius: usize,
    /// The number of the row in the middle.
    row: usize,
    rows: VecDeque<Row>,
}

impl<'a> Neighborhood<'a> {
    /// The neighbourhood of that row.
    pub(super) fn new(
        image: &'a Raster,
        colors: &'a ColorSpace,
        radius: usize,
        row: usize,
    ) -> Neighborhood<'a> {
        let mut neighborhood = Neighborhood {
            image,
            colors,
            radius,
            row,
            rows: VecDeque::new(),
        };
        for place in 0..=2 * radius {
            let row = (row + place).saturating_sub(radius);
            let row = neighborhood.opponents(row, Row::default());
            neighborhood.rows.push_back(row);
        }
        neighborhood
    }

    /// Goes on to the next row.
    pub(super) fn advance(&mut self) {
        self.row += 1;
        let first = self.rows.pop_front().unwrap_or_default();
        let last = self.opponents(self.row + self.radius, first);
        self.rows.push_back(last);
    }

    /// A row of the picture, in the memory of another one.
    fn opponents(&self, row: usize, mut memory: Row) -> Row {
        let width = 3 * self.image.width() as usize;
        let row = row.min(self.image.height() as usize - 1);
        let pixels = self.image.samples()[row * width..][..width].chunks_exact(3);
        memory.iter_mut().for_each(Vec::clear);
        for pixel in pixels {
            for (samples, opponent) in memory.iter_mut().zip(self.colors.opponents(pixel)) {
                if samples.is_empty() {
                    samples.resize(self.radius, opponent);
                }
                samples.push(opponent);
            }
        }
        for samples in &mut memory {
            let last = samples.last().copied().unwrap_or_default();
            samples.resize(samples.len() + self.radius, last);
        }
        memory
    }

    /// The sums over each column of an opponent's samples by these weights, in the middle of which
    /// is the row.
    pub(super) fn sums_of_columns(&self, opponent: usize, weights: &[f64]) -> Vec<f64> {
        let above = self.radius - weights.len() / 2;
        let rows = self.rows.iter().map(|row| &row[opponent][..]).skip(above);
        let columns = self.image.width() as usize + 2 * self.radius;
        sums(weights, rows, columns)
    }

    /// The sums along the row of what there is for each of its columns, by these weights.
    pub(super) fn sums_along(&self, columns: &[f64], weights: &[f64]) -> Vec<f64> {
        let before = self.radius - weights.len() / 2;
        let shifted = (before..).map(|first| &columns[first..]);
        sums(weights, shifted, self.image.width() as usize)
    }
}

/// The sums of so many rows of this length, each by its weight.
fn sums<'a>(weights: &[f64], rows: impl Iterator<Item = &'a [f64]>, length: usize) -> Vec<f64> {
    let mut sums = vec![0.0; length];
    for (weight, row) in weights.iter().zip(rows) {
        for (sum, sample) in sums.iter_mut().zip(row) {
            *sum += weight * sample;
        }
    }
    sums
}
