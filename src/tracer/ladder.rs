//! From number to number: each pixel by the cheapest arithmetic that leaves no doubt about it.

use std::cell::LazyCell;
use std::convert::Infallible;
use std::sync::OnceLock;

use super::extent::Extents;
use super::number::{Bounded, DoubleDouble, Doubt, Expression, Real};
use super::pixel::{Picture, Pixel, mirrors};
use super::view::{Crossings, Frame};
use crate::scene::Scene;
use crate::stage::Stage;

/// The arithmetic that settled a pixel, cheapest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rung {
    /// f64, with a bound on its error where the kernel asks for one.
    Double,
    /// Double-doubles with a bound.
    DoubleDouble,
    /// Arbitrary precision.
    Arbitrary,
}

/// The pixels of a frame.
pub(super) trait Pixels: Sync {
    /// The pixel at `column` and `row`, and what settled it.
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung);

    /// The same pixel, worked through.
    fn explain(&self, column: u32, row: u32) -> (String, Rung);
}

/// A kernel of one number that always answers.
pub(super) struct Plain<'a, R>(Picture<'a, R>);

impl<'a, R: Real<Doubt = Infallible>> Plain<'a, R> {
    pub(super) fn new(scene: &'a Scene, stage: Stage, alpha: f64, size: u32) -> Self {
        let frame = frame::<R>(alpha, size);
        let extents = Extents::new(scene, &self::frame(alpha, size), size);
        let crossing = |index, mirrored| frame.crossing(scene, index, mirrored);
        let Ok(crossings) = Crossings::new(scene, mirrors(scene, stage), crossing);
        let Ok(picture) = Picture::new(scene, stage, &frame, size, &crossings, &extents);
        Plain(picture)
    }
}

impl<R: Real<Doubt = Infallible> + Sync> Pixels for Plain<'_, R> {
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung) {
        let Ok(pixel) = self.0.pixel(column, row);
        (pixel, Rung::Double)
    }

    fn explain(&self, column: u32, row: u32) -> (String, Rung) {
        let Ok(text) = self.0.explain(column, row);
        (text, Rung::Double)
    }
}

/// The kernels that are right: f64 with a bound, then double-doubles with a bound, then as many digits as it takes.
pub(super) struct Ladder<'a> {
    scene: &'a Scene,
    stage: Stage,
    alpha: f64,
    size: u32,
    crossings: Crossings,
    extents: Extents,
    /// `None` where the frame itself is in doubt already, or the kernel does without this rung.
    bounded: Option<Picture<'a, Bounded>>,
    /// Made when it is first needed.
    double_double: OnceLock<Option<Picture<'a, DoubleDouble>>>,
}

impl<'a> Ladder<'a> {
    /// A ladder that begins at the rung `lowest`.
    pub(super) fn new(scene: &'a Scene, stage: Stage, alpha: f64, size: u32, lowest: Rung) -> Self {
        let bounded = frame::<Bounded>(alpha, size);
        let double_double = LazyCell::new(|| frame::<DoubleDouble>(alpha, size));
        let crossing = |index, mirrored| {
            bounded
                .crossing(scene, index, mirrored)
                .or_else(|Doubt| double_double.crossing(scene, index, mirrored))
                .or_else(|Doubt| {
                    Expression::session(|| {
                        frame::<Expression>(alpha, size).crossing(scene, index, mirrored)
                    })
                })
        };
        let Ok(crossings) = Crossings::new(scene, mirrors(scene, stage), crossing);
        let extents = Extents::new(scene, &bounded, size);
        let bounded = match lowest {
            Rung::Double => Picture::new(scene, stage, &bounded, size, &crossings, &extents).ok(),
            _ => None,
        };
        Ladder {
            scene,
            stage,
            alpha,
            size,
            crossings,
            extents,
            bounded,
            double_double: OnceLock::new(),
        }
    }
}

fn frame<R: Real>(alpha: f64, size: u32) -> Frame<R> {
    let (sin, cos) = R::sin_cos(alpha);
    Frame::new(sin, cos, size)
}

impl Ladder<'_> {
    /// The answer of the cheapest arithmetic that has one, and which that was.
    fn settle<Q: Question>(&self, question: &Q) -> (Q::Answer, Rung) {
        if let Some(Ok(answer)) = self
            .bounded
            .as_ref()
            .map(|picture| question.put_to(picture))
        {
            return (answer, Rung::Double);
        }
        let double_double = self.double_double.get_or_init(|| {
            let frame = frame(self.alpha, self.size);
            Picture::new(
                self.scene,
                self.stage,
                &frame,
                self.size,
                &self.crossings,
                &self.extents,
            )
            .ok()
        });
        if let Some(Ok(answer)) = double_double
            .as_ref()
            .map(|picture| question.put_to(picture))
        {
            return (answer, Rung::DoubleDouble);
        }
        Expression::session(|| {
            let frame = frame::<Expression>(self.alpha, self.size);
            let Ok(picture) = Picture::new(
                self.scene,
                self.stage,
                &frame,
                self.size,
                &self.crossings,
                &self.extents,
            );
            let Ok(answer) = question.put_to(&picture);
            (answer, Rung::Arbitrary)
        })
    }
}

/// What a picture in any number can be asked.
trait Question {
    type Answer;
    fn put_to<R: Real>(&self, picture: &Picture<'_, R>) -> Result<Self::Answer, R::Doubt>;
}

/// The pixel at a column and a row.
struct PixelAt(u32, u32);

impl Question for PixelAt {
    type Answer = Pixel;
    fn put_to<R: Real>(&self, picture: &Picture<'_, R>) -> Result<Pixel, R::Doubt> {
        picture.pixel(self.0, self.1)
    }
}

/// The same pixel, worked through.
struct Explain(u32, u32);

impl Question for Explain {
    type Answer = String;
    fn put_to<R: Real>(&self, picture: &Picture<'_, R>) -> Result<String, R::Doubt> {
        picture.explain(self.0, self.1)
    }
}

impl Pixels for Ladder<'_> {
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung) {
        self.settle(&PixelAt(column, row))
    }

    fn explain(&self, column: u32, row: u32) -> (String, Rung) {
        self.settle(&Explain(column, row))
    }
}
