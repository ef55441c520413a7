//! What is wrong with a picture, pixel by pixel.

mod wrong_decision;

pub use wrong_decision::{WrongDecision, WrongPixels};
