//! The score of a node: the chance that it is a whole fragment.

use fragscale_core::fault::Fault;
use rayon::prelude::*;

use super::features::{COUNT, features};
use crate::tree::Tree;

/// Neurons of the only layer in between.
const HIDDEN: usize = 24;

/// A small network: features, a layer in between, a chance.
#[derive(Debug, Clone, PartialEq)]
pub struct Scorer {
    /// For each neuron its weights and, last, its offset.
    hidden: Vec<[f64; COUNT + 1]>,
    /// The weight of each neuron and, last, the offset.
    last: [f64; HIDDEN + 1],
}

impl Scorer {
    /// From the numbers of a text, neuron by neuron and then the last layer, apart by blanks; `None` where they
    /// are not as many as there must be.
    pub fn read(text: &str) -> Option<Self> {
        let words = text.lines().filter(|line| !line.starts_with('#'));
        let numbers: Result<Vec<f64>, _> = words
            .flat_map(str::split_whitespace)
            .map(str::parse)
            .collect();
        let numbers = numbers.ok()?;
        let (hidden, last) = numbers.split_at_checked(HIDDEN * (COUNT + 1))?;
        let hidden = hidden.chunks_exact(COUNT + 1);
        Some(Self {
            hidden: hidden
                .map(|row| row.try_into().ok())
                .collect::<Option<_>>()?,
            last: last.try_into().ok()?,
        })
    }

    /// One that the program brings along, where its numbers could be read.
    ///
    /// # Errors
    /// Where they could not.
    pub(crate) fn brought_along(read: Option<&Self>) -> Result<&Self, Fault> {
        read.ok_or_else(|| Fault::new("the numbers of the score are broken", "report this"))
    }

    /// From 0 to 1.
    pub fn score(&self, features: &[f64; COUNT]) -> f64 {
        let mut sum = self.last[HIDDEN];
        for (neuron, weight) in self.hidden.iter().zip(&self.last) {
            let within: f64 = neuron.iter().zip(features).map(|(w, x)| w * x).sum();
            sum += weight * (within + neuron[COUNT]).tanh();
        }
        1.0 / (1.0 + (-sum).exp())
    }
}

/// Of every node.
pub fn scores(tree: &Tree, scorer: &Scorer) -> Vec<f64> {
    let places = (0..tree.nodes.len()).into_par_iter();
    places
        .map(|place| scorer.score(&features(tree, place)))
        .collect()
}
