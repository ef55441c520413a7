//! The filter: each pixel is settled by the cheapest arithmetic that leaves no doubt about it.

use std::cell::LazyCell;
use std::convert::Infallible;
use std::sync::{Mutex, MutexGuard, OnceLock};

use bumpalo_herd::Herd;

use super::arena::{Arena, SliceAllocator};
use super::decision::Decision;
use super::extent::Extents;
use super::line::Normal;
use super::palette::Palette;
use super::pixel::{Picture, Pixel, mirrors};
use super::pool::lock;
use super::vector::Vector;
use super::view_signs::FrameSigns;
use super::view_transform::ViewTransform;
use crate::number::{Bounded, DoubleDouble, Doubt, Expression, Real, Session};
use crate::scene::Scene;
use crate::stage::Stage;

/// The arithmetic that settled a pixel, cheapest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rung {
    /// f32 or f64, with a bound on its error where the kernel asks for one.
    Hardware,
    /// Double-doubles with a bound.
    DoubleDouble,
    /// Arbitrary precision.
    Arbitrary,
}

/// The pixels of a frame.
pub(super) trait Pixels: Sync {
    /// The pixel at `column` and `row`, and what settled it.
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung);

    /// The same pixel, worked through; `traced` is what it shows in the picture.
    fn explain(&self, column: u32, row: u32, traced: Pixel) -> String;
}

/// The pixels of a frame that can be traced row by row. All pixels of one decision have one colour,
/// except those of spheres in the light.
pub(super) trait RowPixels: Pixels {
    /// The frame as f64 with a bound knows it.
    fn bounded(&self) -> &Picture<'_, Bounded>;

    /// The samples of all pixels that show what was decided.
    fn color(&self, decision: Decision) -> [f32; 3];

    /// As [`Pixels::pixel`], for a pixel that is known to show the sphere of a decision, in shadow
    /// or not. Arithmetic without bounds may see something else there: it decides as for any pixel.
    fn pixel_on_sphere(&self, _shown: Decision, column: u32, row: u32) -> (Pixel, Rung) {
        self.pixel(column, row)
    }
}

/// What all arithmetics of a frame share.
struct FrameSetup<'f> {
    transform: ViewTransform<Bounded>,
    signs: FrameSigns<'f>,
    extents: Extents<'f>,
}

impl<'f> FrameSetup<'f> {
    fn new(scene: &'f Scene, stage: Stage, alpha: f64, size: u32, arena: &'f Arena) -> Self {
        let bounded = transform::<Bounded>(alpha, size);
        let plain = transform::<f64>(alpha, size);
        let double_double = LazyCell::new(|| transform::<DoubleDouble>(alpha, size));
        let signs = |mirrored| {
            let Ok(signs) = bounded
                .signs(scene, &plain, mirrored, &arena.setup)
                .or_else(|Doubt| double_double.signs(scene, &plain, mirrored, &arena.setup))
                .or_else(|Doubt| {
                    Expression::session(|| {
                        transform::<Expression>(alpha, size).signs(
                            scene,
                            &plain,
                            mirrored,
                            &arena.setup,
                        )
                    })
                });
            signs.refined(scene, &bounded, mirrored, || {
                Expression::session(|| {
                    let h = transform::<Expression>(alpha, size).halfway(scene, mirrored);
                    Vector {
                        x: h.x.to_double_double(),
                        y: h.y.to_double_double(),
                        z: h.z.to_double_double(),
                    }
                })
            })
        };
        let signs = FrameSigns {
            direct: signs(false),
            mirrored: mirrors(scene, stage).then(|| signs(true)),
        };
        FrameSetup {
            transform: bounded,
            signs,
            extents: Extents::new(scene, &plain, &bounded, size, arena),
        }
    }

    fn picture<'a, R: Real>(
        &self,
        scene: &'a Scene,
        stage: Stage,
        transform: &ViewTransform<R>,
        size: u32,
        allocator: &impl SliceAllocator<'a>,
    ) -> Picture<'a, R>
    where
        'f: 'a,
    {
        let (signs, extents) = (&self.signs, &self.extents);
        Picture::new(scene, stage, transform, size, signs, extents, allocator)
    }
}

/// The pixels of a kernel whose number never leaves a doubt.
pub(super) struct Plain<'f, R> {
    bounded: Picture<'f, Bounded>,
    /// The frame in this number.
    pub(super) picture: Picture<'f, R>,
}

impl<'f, R: Real<Doubt = Infallible>> Plain<'f, R> {
    pub(super) fn new(
        scene: &'f Scene,
        stage: Stage,
        alpha: f64,
        size: u32,
        arena: &'f Arena,
    ) -> Self {
        let setup = FrameSetup::new(scene, stage, alpha, size, arena);
        let arena = &arena.setup;
        Plain {
            bounded: setup.picture(scene, stage, &setup.transform, size, &arena),
            picture: setup.picture(scene, stage, &transform(alpha, size), size, &arena),
        }
    }

    fn samples(&self, decision: Decision, normal: Option<Normal<R>>) -> [f32; 3] {
        let Ok(color) = self.picture.color(decision, normal.as_ref());
        color
    }
}

impl<R: Real<Doubt = Infallible> + Send + Sync> RowPixels for Plain<'_, R> {
    fn bounded(&self) -> &Picture<'_, Bounded> {
        &self.bounded
    }

    fn color(&self, decision: Decision) -> [f32; 3] {
        self.samples(decision, None)
    }
}

impl<R: Real<Doubt = Infallible> + Send + Sync> Pixels for Plain<'_, R> {
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung) {
        let Ok((decision, normal)) = self.picture.decide(column, row);
        ((decision, self.samples(decision, normal)), Rung::Hardware)
    }

    fn explain(&self, column: u32, row: u32, traced: Pixel) -> String {
        let Ok(text) = self.picture.explain(column, row, traced);
        text
    }
}

/// The pixels of the certified kernels: f64 with a bound, then double-doubles with a bound, then
/// arbitrary precision.
pub(super) struct Ladder<'f> {
    scene: &'f Scene,
    stage: Stage,
    alpha: f64,
    size: u32,
    setup: FrameSetup<'f>,
    /// The cheapest arithmetic that is tried.
    lowest: Rung,
    bounded: Picture<'f, Bounded>,
    /// Made in the memory of `threads` when it is first needed.
    double_double: OnceLock<Picture<'f, DoubleDouble>>,
    /// Memory for the parts that threads make.
    threads: &'f Herd,
    /// Pictures that no thread is using. A thread that finds none makes one.
    arbitrary: Mutex<Vec<ArbitraryPicture<'f>>>,
    /// The same.
    palette: OnceLock<Palette<'f>>,
}

/// The frame in arbitrary precision, for one thread at a time. Digits that one pixel needed are
/// kept for the next.
struct ArbitraryPicture<'f> {
    session: Session,
    picture: Picture<'f, Expression>,
}

impl<'f> Ladder<'f> {
    /// A ladder that begins at the rung `lowest`.
    pub(super) fn new(
        scene: &'f Scene,
        stage: Stage,
        alpha: f64,
        size: u32,
        lowest: Rung,
        arena: &'f Arena,
    ) -> Self {
        let setup = FrameSetup::new(scene, stage, alpha, size, arena);
        let (arena, threads) = (&arena.setup, &arena.threads);
        Ladder {
            scene,
            stage,
            alpha,
            size,
            lowest,
            bounded: setup.picture(scene, stage, &setup.transform, size, &arena),
            setup,
            double_double: OnceLock::new(),
            threads,
            arbitrary: Mutex::default(),
            palette: OnceLock::new(),
        }
    }
}

fn transform<R: Real>(alpha: f64, size: u32) -> ViewTransform<R> {
    let (sin, cos) = R::sin_cos(alpha);
    ViewTransform::new(sin, cos, size)
}

impl<'f> Ladder<'f> {
    /// The answer of the cheapest arithmetic that has one, and which that was.
    fn settle<Q: Question>(&self, question: &Q) -> (Q::Answer, Rung) {
        if self.lowest == Rung::Hardware
            && let Ok(answer) = question.answer(&self.bounded)
        {
            return (answer, Rung::Hardware);
        }
        let double_double = self
            .double_double
            .get_or_init(|| self.picture(&self.threads.get()));
        if let Ok(answer) = question.answer(double_double) {
            return (answer, Rung::DoubleDouble);
        }
        let mut arbitrary = self.arbitrary().pop().unwrap_or_else(|| {
            let (session, picture) = Session::begin(|| {
                let picture = self.picture::<Expression>(&self.threads.get());
                // What is made while a pixel is decided is forgotten with the pixel: so all
                // tetrahedra are made before.
                for mirrored in [false, true] {
                    picture.view(mirrored).tetrahedra.complete();
                }
                picture
            });
            ArbitraryPicture { session, picture }
        });
        let Ok(answer) = arbitrary
            .session
            .go_on(|| question.answer(&arbitrary.picture));
        self.arbitrary().push(arbitrary);
        (answer, Rung::Arbitrary)
    }

    /// The samples of a pixel if it shows a sphere in the light, as `decision` says; `None` where
    /// it cannot.
    pub(super) fn color_if(&self, decision: Decision, column: u32, row: u32) -> Option<[f32; 3]> {
        self.settle(&ColorIf(decision, column, row)).0
    }

    fn arbitrary(&self) -> MutexGuard<'_, Vec<ArbitraryPicture<'f>>> {
        lock(&self.arbitrary)
    }

    /// The picture in any number.
    pub(super) fn picture<'a, R: Real>(&self, allocator: &impl SliceAllocator<'a>) -> Picture<'a, R>
    where
        'f: 'a,
    {
        let transform = transform(self.alpha, self.size);
        self.setup
            .picture(self.scene, self.stage, &transform, self.size, allocator)
    }
}

/// A question that a picture in any number answers.
trait Question {
    type Answer;
    fn answer<R: Real>(&self, picture: &Picture<'_, R>) -> Result<Self::Answer, R::Doubt>;
}

/// A decision, and its samples if it has a normal.
type MaybeColored = (Decision, Option<[f32; 3]>);

/// The decision of the pixel at a column and a row, and its samples if it has a normal.
struct PixelAt(u32, u32);

impl Question for PixelAt {
    type Answer = MaybeColored;
    fn answer<R: Real>(&self, picture: &Picture<'_, R>) -> Result<Self::Answer, R::Doubt> {
        colored(picture, picture.decide(self.0, self.1)?)
    }
}

/// The same for a pixel that is known to show the sphere of a decision.
struct PixelOnSphere(Decision, u32, u32);

impl Question for PixelOnSphere {
    type Answer = MaybeColored;
    fn answer<R: Real>(&self, picture: &Picture<'_, R>) -> Result<Self::Answer, R::Doubt> {
        colored(picture, picture.decide_on_sphere(self.0, self.1, self.2)?)
    }
}

/// The samples of a decision, too, if it has a normal.
fn colored<R: Real>(
    picture: &Picture<'_, R>,
    (decision, normal): (Decision, Option<Normal<R>>),
) -> Result<MaybeColored, R::Doubt> {
    let color = normal.map(|normal| picture.color(decision, Some(&normal)));
    Ok((decision, color.transpose()?))
}

/// The samples of all pixels that show what was decided.
struct ColorOf(Decision);

impl Question for ColorOf {
    type Answer = [f32; 3];
    fn answer<R: Real>(&self, picture: &Picture<'_, R>) -> Result<[f32; 3], R::Doubt> {
        picture.color(self.0, None)
    }
}

/// The samples of the pixel at a column and a row if it shows a sphere in the light.
struct ColorIf(Decision, u32, u32);

impl Question for ColorIf {
    type Answer = Option<[f32; 3]>;
    fn answer<R: Real>(&self, picture: &Picture<'_, R>) -> Result<Self::Answer, R::Doubt> {
        picture.color_if(self.0, self.1, self.2)
    }
}

/// A pixel worked through.
struct Explain(u32, u32, Pixel);

impl Question for Explain {
    type Answer = String;
    fn answer<R: Real>(&self, picture: &Picture<'_, R>) -> Result<String, R::Doubt> {
        picture.explain(self.0, self.1, self.2)
    }
}

impl RowPixels for Ladder<'_> {
    fn bounded(&self) -> &Picture<'_, Bounded> {
        &self.bounded
    }

    fn color(&self, decision: Decision) -> [f32; 3] {
        self.settle(&ColorOf(decision)).0
    }

    fn pixel_on_sphere(&self, shown: Decision, column: u32, row: u32) -> (Pixel, Rung) {
        self.settled(&PixelOnSphere(shown, column, row))
    }
}

impl Pixels for Ladder<'_> {
    fn pixel(&self, column: u32, row: u32) -> (Pixel, Rung) {
        self.settled(&PixelAt(column, row))
    }

    fn explain(&self, column: u32, row: u32, traced: Pixel) -> String {
        self.settle(&Explain(column, row, traced)).0
    }
}

impl Ladder<'_> {
    /// A pixel, its decision and samples settled by the cheapest arithmetic.
    fn settled(&self, question: &impl Question<Answer = MaybeColored>) -> (Pixel, Rung) {
        let ((decision, color), rung) = self.settle(question);
        // A colour halfway between two floats needs arbitrary precision, which is too slow for each
        // pixel of a face: so it is settled once.
        let color = color.unwrap_or_else(|| {
            let palette = || Palette::new(self.scene, &self.threads.get());
            let palette = self.palette.get_or_init(palette);
            *palette.get(decision).get_or_init(|| self.color(decision))
        });
        ((decision, color), rung)
    }
}
