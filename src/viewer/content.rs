//! What the window shows, and what of it the texture holds: a state machine that knows no window.

use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::comparison::{Compared, ErrorView};
use super::renderer::Renderer;
use super::tracing::{Frame, Traced};
use crate::{Image, Kernel, tracer};

/// A picture that took no longer is traced over before the next one is there, which takes about as
/// long.
const SOON: Duration = Duration::from_millis(20);

/// The number of a black picture that stands in for one that is not there: nobody compares it, or
/// works its pixels through.
pub(super) const STAND_IN: u64 = 0;

/// What the window shows.
pub(super) enum Content {
    /// No picture has been traced yet.
    Nothing {
        /// The first picture is to be compared.
        errors: bool,
    },
    /// The picture that was traced last.
    Picture(Picture),
    /// The errors of that picture; the picture itself until a comparison is done.
    Errors(Picture, ErrorView),
}

/// The picture that was traced last.
pub(super) struct Picture {
    traced: Traced,
    /// `None` after the samples were given back, to be traced over.
    samples: Option<Arc<Image>>,
    texture: Texture,
}

/// What the texture holds.
#[derive(Clone, Copy)]
enum Texture {
    /// What is to be shown.
    Current,
    /// The traced picture of this number, which is not to be shown any more.
    Picture(u64),
    /// Nothing, or errors that are not to be shown any more.
    Other,
}

/// What a redisplay does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Redisplay {
    /// Draws the texture.
    Draw,
    /// Clears the window, which cannot wait for the first picture.
    Clear,
    /// Leaves the window as it is, until there is something new or the wait was too long.
    Wait,
}

impl Picture {
    /// The texture once something else is to be shown than this picture, or than the errors of it
    /// that were `shown`.
    fn outdated(&self, shown: Option<&Compared>) -> Texture {
        match (self.texture, shown) {
            (Texture::Current, None) => Texture::Picture(self.traced.number),
            (Texture::Current, Some(_)) => Texture::Other,
            (old, _) => old,
        }
    }
}

impl Default for Content {
    fn default() -> Content {
        Content::Nothing { errors: false }
    }
}

impl Content {
    fn picture(&self) -> Option<&Picture> {
        match self {
            Content::Nothing { .. } => None,
            Content::Picture(picture) | Content::Errors(picture, _) => Some(picture),
        }
    }

    /// The metadata of the picture that was traced last.
    pub(super) fn traced(&self) -> Option<&Traced> {
        self.picture().map(|picture| &picture.traced)
    }

    /// The samples of the picture that was traced last, unless they were given back.
    pub(super) fn samples(&self) -> Option<&Image> {
        self.picture()?.samples.as_deref()
    }

    /// Whether errors are shown, or will be once they are known.
    pub(super) fn shows_errors(&self) -> bool {
        matches!(
            self,
            Content::Nothing { errors: true } | Content::Errors(..)
        )
    }

    /// The errors that the texture holds, or is to hold.
    fn compared(&self) -> Option<&Compared> {
        match self {
            Content::Nothing { .. } | Content::Picture(_) => None,
            Content::Errors(_, errors) => errors.done.as_ref(),
        }
    }

    /// The metadata of the picture that was traced last, and its samples, unless they were given
    /// back.
    pub(super) fn shown(&self) -> Option<(&Traced, Option<&Arc<Image>>)> {
        let picture = self.picture()?;
        let samples = picture.samples.as_ref();
        let samples = samples.filter(|_| picture.traced.number != STAND_IN);
        Some((&picture.traced, samples))
    }

    /// Whether a picture is shown that stands in for one.
    pub(super) fn is_stand_in(&self) -> bool {
        self.traced()
            .is_some_and(|traced| traced.number == STAND_IN)
    }

    /// The frame whose errors are to be shown, and its picture.
    pub(super) fn to_compare(&self) -> Option<(&Frame, Option<&Arc<Image>>)> {
        let (traced, image) = self.shown().filter(|_| self.shows_errors())?;
        Some((&traced.frame, image))
    }

    /// Whether errors are to be shown that are not known yet.
    pub(super) fn is_comparing(&self) -> bool {
        match self {
            Content::Nothing { .. } | Content::Picture(_) => false,
            Content::Errors(picture, errors) => {
                !self.is_stand_in() && errors.are_awaited(&picture.traced.frame)
            }
        }
    }

    /// A picture came at `now`, to be shown instead of the one before.
    pub(super) fn picture_came(&mut self, traced: Traced, samples: Arc<Image>, now: Instant) {
        let (texture, errors) = match std::mem::take(self) {
            Content::Nothing { errors } => (Texture::Other, errors.then(|| ErrorView::since(now))),
            Content::Picture(picture) => (picture.outdated(None), None),
            Content::Errors(picture, errors) => {
                let is_same = picture.traced.frame == traced.frame;
                let since = if is_same { errors.since } else { now };
                let texture = picture.outdated(errors.done.as_ref());
                (texture, Some(ErrorView { since, ..errors }))
            }
        };
        let picture = Picture {
            traced,
            samples: Some(samples),
            texture,
        };
        *self = match errors {
            None => Content::Picture(picture),
            Some(errors) => Content::Errors(picture, errors),
        };
    }

    /// From `now` on errors are shown instead of the picture, or the picture instead of its errors.
    pub(super) fn toggle_errors(&mut self, now: Instant) {
        *self = match std::mem::take(self) {
            Content::Nothing { errors } => Content::Nothing { errors: !errors },
            Content::Picture(mut picture) => {
                picture.texture = picture.outdated(None);
                Content::Errors(picture, ErrorView::since(now))
            }
            Content::Errors(mut picture, errors) => {
                picture.texture = picture.outdated(errors.done.as_ref());
                Content::Picture(picture)
            }
        };
    }

    /// The picture of `kernel` is traced for the comparison now.
    pub(super) fn comparison_traces(&mut self, kernel: Kernel, progress: tracer::Progress) {
        if let Content::Errors(_, errors) = self {
            errors.tracing = Some((kernel, progress));
        }
    }

    /// A comparison is done.
    pub(super) fn comparison_came(&mut self, compared: Compared) {
        if let Content::Errors(picture, errors) = self {
            picture.texture = picture.outdated(errors.done.as_ref());
            errors.done = Some(compared);
        }
    }

    /// There is a new texture, with nothing in it.
    pub(super) fn lose_texture(&mut self) {
        if let Content::Picture(picture) | Content::Errors(picture, _) = self {
            picture.texture = Texture::Other;
        }
    }

    /// Gives the samples back, to be traced over by `next`, where the texture holds them: not those
    /// of a slow picture, which may be wanted again before the next one is there, not those that a
    /// renderer made, which a click compares with the truth, and not those of `next` itself, which
    /// would not be traced again.
    pub(super) fn give_back(&mut self, next: &Frame) {
        if let Content::Picture(picture) = self
            && let Texture::Current = picture.texture
            && picture.traced.time < SOON
            && matches!(picture.traced.frame.renderer, Renderer::Kernel(_))
            && picture.traced.frame != *next
        {
            picture.samples = None;
        }
    }

    /// The image of which the texture lacks these rows; `None` where it lacks none, or where the
    /// samples were given back.
    pub(super) fn to_upload(&self) -> Option<(&Image, Range<u32>)> {
        let picture = self.picture()?;
        let last = match picture.texture {
            Texture::Current => return None,
            Texture::Picture(number) => Some(number),
            Texture::Other => None,
        };
        if let Some(compared) = self.compared() {
            return Some((&compared.image, 0..compared.image.size()));
        }
        let samples = picture.samples.as_deref()?;
        let follows = last.is_some_and(|last| last + 1 == picture.traced.number);
        let rows = match follows {
            true => picture.traced.changed.clone(),
            false => 0..samples.size(),
        };
        Some((samples, rows))
    }

    /// The texture has got what it lacked.
    pub(super) fn uploaded(&mut self) {
        if let Content::Picture(picture) | Content::Errors(picture, _) = self {
            picture.texture = Texture::Current;
        }
    }

    /// What the texture holds, if it is to be shown and its samples are here.
    pub(super) fn in_texture(&self) -> Option<&Image> {
        match self.picture()?.texture {
            Texture::Current => match self.compared() {
                Some(compared) => Some(&compared.image),
                None => self.samples(),
            },
            Texture::Picture(_) | Texture::Other => None,
        }
    }

    /// What a redisplay does: the texture `is_new` where it has just been uploaded, the next
    /// picture `is_awaited` where it is being traced, and the window `is_overdue` where it cannot
    /// wait for that any longer.
    pub(super) fn redisplay(&self, is_new: bool, is_awaited: bool, is_overdue: bool) -> Redisplay {
        match self.picture().map(|picture| &picture.texture) {
            None if is_overdue => Redisplay::Clear,
            Some(Texture::Current) if is_new || is_overdue || !is_awaited => Redisplay::Draw,
            None | Some(_) => Redisplay::Wait,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use std::sync::LazyLock;

    use super::*;
    use crate::random::Random;
    use crate::tracer::Tally;
    use crate::viewer::renderer::GivenRenderer;
    use crate::{Scene, Stage};

    const SIZE: u32 = 6;

    fn traced(number: u64, changed: Range<u32>) -> Traced {
        static SCENE: LazyLock<Arc<Scene>> = LazyLock::new(|| Arc::new(Scene::builtin()));
        Traced {
            frame: Frame {
                scene: SCENE.clone(),
                stage: Stage::Animation,
                alpha: number as f64,
                renderer: Renderer::Kernel(Kernel::Exact),
            },
            number,
            changed,
            time: Duration::ZERO,
            tally: Tally::default(),
        }
    }

    fn image(sample: f32) -> Image {
        let mut image = Image::new(SIZE).unwrap();
        image.samples_mut().fill(sample);
        image
    }

    fn compared(frame: Frame, sample: f32) -> Compared {
        Compared {
            frame,
            image: Arc::new(image(sample)),
            rings: Vec::new(),
            wrong: Vec::new(),
            misrounded: 0,
            largest: 0,
            hints: Vec::new(),
        }
    }

    fn come(content: &mut Content, number: u64, changed: Range<u32>) {
        let samples = Arc::new(image(number as f32));
        content.picture_came(traced(number, changed), samples, Instant::now());
    }

    /// The first sample of what is to be uploaded, and its rows; it is uploaded then.
    fn upload(content: &mut Content) -> Option<(f32, Range<u32>)> {
        let (image, rows) = content.to_upload()?;
        let uploaded = (image.samples()[0], rows);
        content.uploaded();
        Some(uploaded)
    }

    #[test]
    fn only_a_window_that_cannot_wait_is_cleared_and_only_before_the_first_picture() {
        let mut content = Content::default();
        assert_eq!(content.redisplay(false, true, false), Redisplay::Wait);
        assert_eq!(content.redisplay(false, true, true), Redisplay::Clear);
        come(&mut content, 1, 0..SIZE);
        assert_eq!(content.redisplay(false, true, true), Redisplay::Wait);
        assert_eq!(upload(&mut content), Some((1.0, 0..SIZE)));
        // What is new is drawn, and what waits too long; else the next picture is waited for.
        assert_eq!(content.redisplay(true, true, false), Redisplay::Draw);
        assert_eq!(content.redisplay(false, true, true), Redisplay::Draw);
        assert_eq!(content.redisplay(false, false, false), Redisplay::Draw);
        assert_eq!(content.redisplay(false, true, false), Redisplay::Wait);
        content.lose_texture();
        assert_eq!(content.redisplay(false, false, true), Redisplay::Wait);
    }

    #[test]
    fn only_over_its_predecessor_a_picture_uploads_the_rows_that_changed() {
        let mut content = Content::default();
        come(&mut content, 1, 2..3);
        assert_eq!(upload(&mut content), Some((1.0, 0..SIZE)));
        assert_eq!(upload(&mut content), None);
        come(&mut content, 2, 2..3);
        assert_eq!(upload(&mut content), Some((2.0, 2..3)));
        come(&mut content, 4, 2..3);
        assert_eq!(upload(&mut content), Some((4.0, 0..SIZE)));
        come(&mut content, 5, 2..3);
        content.lose_texture();
        assert_eq!(upload(&mut content), Some((5.0, 0..SIZE)));
    }

    #[test]
    fn samples_are_given_back_once_they_are_uploaded_and_not_looked_at() {
        let next = traced(9, 0..SIZE).frame;
        let mut content = Content::default();
        come(&mut content, 1, 0..SIZE);
        content.give_back(&next);
        assert!(content.samples().is_some(), "not uploaded yet");
        upload(&mut content);
        content.give_back(&traced(1, 0..SIZE).frame);
        assert!(
            content.samples().is_some(),
            "there is no other picture next"
        );
        content.give_back(&next);
        assert!(content.samples().is_none() && content.in_texture().is_none());
        assert_eq!(content.redisplay(false, false, false), Redisplay::Draw);
        content.lose_texture();
        assert_eq!(content.to_upload(), None);

        let slow = Traced {
            time: SOON,
            ..traced(2, 0..SIZE)
        };
        content.picture_came(slow, Arc::new(image(2.0)), Instant::now());
        upload(&mut content);
        content.give_back(&next);
        assert!(content.samples().is_some(), "a slow picture");

        let mut given = traced(3, 0..SIZE);
        given.frame.renderer = Renderer::Given(GivenRenderer {
            number: 0,
            name: Arc::from("homework"),
            edition: 0,
        });
        content.picture_came(given, Arc::new(image(3.0)), Instant::now());
        upload(&mut content);
        content.give_back(&next);
        assert!(content.samples().is_some(), "a click would need them");

        content.toggle_errors(Instant::now());
        come(&mut content, 4, 0..SIZE);
        upload(&mut content);
        content.give_back(&next);
        assert!(content.samples().is_some(), "errors are looked at");
    }

    #[test]
    fn errors_are_awaited_for_the_picture_that_is_shown() {
        let mut content = Content::default();
        content.toggle_errors(Instant::now());
        assert!(content.shows_errors() && content.to_compare().is_none());
        come(&mut content, 1, 0..SIZE);
        let first = traced(1, 0..SIZE).frame;
        assert_eq!(content.to_compare().map(|(frame, _)| frame), Some(&first));
        assert_eq!(upload(&mut content), Some((1.0, 0..SIZE)));
        assert!(content.is_comparing());
        content.comparison_came(compared(first.clone(), 0.5));
        assert!(!content.is_comparing());
        assert_eq!(upload(&mut content), Some((0.5, 0..SIZE)));
        come(&mut content, 2, 2..3);
        assert!(content.is_comparing(), "those of another picture are shown");
        assert_eq!(upload(&mut content), Some((0.5, 0..SIZE)));
        content.toggle_errors(Instant::now());
        assert!(!content.shows_errors() && !content.is_comparing());
        assert_eq!(upload(&mut content), Some((2.0, 0..SIZE)));
        // Nobody waits for them any more.
        content.comparison_came(compared(first, 0.5));
        assert_eq!(
            content.in_texture().map(|image| image.samples()[0]),
            Some(2.0)
        );
    }

    #[test]
    fn whatever_happens_what_is_drawn_is_what_is_to_be_shown() {
        let mut random = Random::new();
        let width = 3 * SIZE as usize;
        let mut content = Content::default();
        let mut texture = vec![f32::NAN; width * SIZE as usize];
        // What the tracer has traced last, what came from it last, and the errors that are shown.
        let (mut canvas, mut number) = (image(0.0), 0);
        let mut picture: Option<Image> = None;
        let mut errors: Option<Image> = None;
        let mut drawn = 0;
        for _ in 0..20_000 {
            match random.below(8) {
                0 | 1 => {
                    // Pictures that nobody waits for any more do not come.
                    let mut changed = 0..0;
                    for _ in 0..=random.below(2) {
                        number += 1;
                        let first = random.below(SIZE as usize);
                        let end = first + random.below(SIZE as usize + 1 - first);
                        canvas.samples_mut()[first * width..end * width].fill(number as f32);
                        changed = first as u32..end as u32;
                    }
                    let samples = Arc::new(canvas.clone());
                    content.picture_came(traced(number, changed), samples, Instant::now());
                    picture = Some(canvas.clone());
                }
                2 => {
                    content.toggle_errors(Instant::now());
                    errors = None;
                }
                3 => {
                    if let Some((frame, _)) = content.to_compare() {
                        let compared = compared(frame.clone(), -(number as f32));
                        errors = Some((*compared.image).clone());
                        content.comparison_came(compared);
                    }
                }
                4 => content.give_back(&traced(number + 1, 0..SIZE).frame),
                5 if random.below(4) == 0 => {
                    content.lose_texture();
                    texture.fill(f32::NAN);
                }
                _ => {
                    if let Some((image, rows)) = content.to_upload() {
                        let rows = rows.start as usize * width..rows.end as usize * width;
                        texture[rows.clone()].copy_from_slice(&image.samples()[rows]);
                        content.uploaded();
                    }
                    let expected = errors
                        .as_ref()
                        .or(picture.as_ref())
                        .map(|image| image.samples());
                    if content.redisplay(false, false, false) == Redisplay::Draw {
                        assert_eq!(Some(&texture[..]), expected);
                        drawn += 1;
                    } else {
                        assert!(picture.is_none() || content.samples().is_none());
                    }
                    if let Some(image) = content.in_texture() {
                        assert_eq!(image.samples(), texture);
                    }
                }
            }
        }
        assert!(drawn > 1000, "{drawn}");
    }
}
