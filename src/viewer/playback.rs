//! The angle α as time passes and keys are pressed, without a window.

use std::f64::consts::TAU;
use std::time::Instant;

use crate::camera::{ROUND, frame_angle};

/// How α advances while the animation plays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// By elapsed time, in radians per second, modulo 2π. Finite; below 0 it turns backwards.
    Speed(f64),
    /// By so many radians at each redisplay; once α is beyond 6.28 it starts again at 0. Finite.
    Step(f64),
}

impl Default for Pace {
    /// One grid step of 0.3 rad each 200 ms, smoothly.
    fn default() -> Pace {
        Pace::Speed(1.5)
    }
}

/// Beyond this α a stepped animation starts again.
#[expect(
    clippy::approx_constant,
    reason = "the document resets beyond 6.28, not beyond 2π"
)]
const LAST_STEP: f64 = 6.28;

/// α, and whether it moves.
///
/// α stays within one turn however long the animation runs: each advance adds a few hundredths of a
/// radian to a number below 2π and reduces the sum, so a rounding is at most 2⁻⁵¹ and a week of 60
/// frames a second adds up to less than 2e-8 rad.
#[derive(Debug)]
pub(super) struct Playback {
    alpha: f64,
    pace: Pace,
    paused: bool,
    /// It is paused for want of a picture, not by a key.
    halted: bool,
    /// α was chosen by a key and has not moved since.
    asked: bool,
    /// When α last advanced; `None` where no time counts since then.
    last: Option<Instant>,
}

impl Playback {
    pub(super) fn new(pace: Pace) -> Playback {
        Playback {
            alpha: 0.0,
            pace,
            paused: false,
            halted: false,
            asked: false,
            last: None,
        }
    }

    pub(super) fn alpha(&self) -> f64 {
        self.alpha
    }

    pub(super) fn paused(&self) -> bool {
        self.paused
    }

    /// A redisplay of the playing animation at `now`. The first one after a start or a
    /// [`Playback::hold`] shows α as it stands.
    pub(super) fn advance(&mut self, now: Instant) {
        if self.paused {
            return;
        }
        self.asked = false;
        let Some(last) = self.last.replace(now) else {
            return;
        };
        match self.pace {
            Pace::Speed(speed) => {
                let elapsed = now.saturating_duration_since(last).as_secs_f64();
                self.turn(speed * elapsed);
            }
            Pace::Step(step) => {
                let next = on_grid(self.alpha + step);
                self.alpha = if next.abs() <= LAST_STEP { next } else { 0.0 };
            }
        }
    }

    /// Time counts from `start` on, if it counted already: what was before that took no part in the
    /// animation.
    pub(super) fn count_from(&mut self, start: Instant) {
        if self.last.is_some() {
            self.last = Some(start);
        }
    }

    /// No time counts from here to the next [`Playback::advance`]: the animation is not seen.
    pub(super) fn hold(&mut self) {
        self.last = None;
    }

    /// Pauses the animation, or lets it play on.
    pub(super) fn toggle(&mut self) {
        self.paused = !self.paused;
        self.halted = false;
        self.hold();
    }

    /// Pauses the animation until there are pictures again.
    pub(super) fn halt(&mut self) {
        if !self.paused {
            self.pause();
            self.halted = true;
        }
    }

    /// There are pictures again: lets the animation play on, unless a key has paused it. Whether it
    /// was halted.
    pub(super) fn recover(&mut self) -> bool {
        let halted = self.halted;
        if halted {
            self.toggle();
        }
        halted
    }

    /// A static stage begins: at α = 0, unless a key asked for another angle.
    pub(super) fn settle(&mut self) {
        self.hold();
        if !self.asked {
            self.alpha = 0.0;
        }
    }

    /// Shows `alpha` because a key asked for it.
    fn ask(&mut self, alpha: f64) {
        self.alpha = alpha;
        self.asked = true;
    }

    /// α = 0.
    pub(super) fn zero(&mut self) {
        self.ask(0.0);
    }

    /// Turns by `angle` radians.
    pub(super) fn nudge(&mut self, angle: f64) {
        self.turn(angle);
        self.asked = true;
    }

    /// The next grid angle strictly after α, the first one after the last.
    pub(super) fn next_frame(&mut self) {
        let next = (0..ROUND)
            .map(frame_angle)
            .find(|&angle| angle > self.alpha);
        self.ask(next.unwrap_or(0.0));
    }

    /// The last grid angle strictly before α, the last one before the first.
    pub(super) fn previous_frame(&mut self) {
        let previous = (0..ROUND)
            .rev()
            .map(frame_angle)
            .find(|&angle| angle < self.alpha);
        self.ask(previous.unwrap_or(frame_angle(ROUND - 1)));
    }

    /// Stops the animation where it is.
    pub(super) fn pause(&mut self) {
        self.paused = true;
        self.halted = false;
        self.hold();
    }

    /// Multiplies the speed, or the step, by `factor`, as far as it makes sense on a screen.
    pub(super) fn scale(&mut self, factor: f64) {
        let (Pace::Speed(pace) | Pace::Step(pace)) = &mut self.pace;
        let scaled = *pace * factor;
        if (1e-3..=1e3).contains(&scaled.abs()) {
            *pace = scaled;
        }
    }

    fn turn(&mut self, angle: f64) {
        let alpha = (self.alpha + angle % TAU).rem_euclid(TAU);
        // A sum just below 0 rounds up to 2π itself; an overflow of the speed leaves no angle at
        // all.
        self.alpha = if alpha < TAU { alpha } else { 0.0 };
    }
}

/// The grid angle α_k where `alpha` differs from it by no more than sums of decimal steps round:
/// stepping by 0.3 then shows the grid itself and gathers no error.
fn on_grid(alpha: f64) -> f64 {
    (0..ROUND)
        .map(frame_angle)
        .find(|angle| (angle - alpha).abs() < 1e-12)
        .unwrap_or(alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn at(start: Instant, milliseconds: u64) -> Instant {
        start + Duration::from_millis(milliseconds)
    }

    #[test]
    fn smooth_playback_goes_by_elapsed_time() {
        let start = Instant::now();
        let mut playback = Playback::new(Pace::default());
        playback.advance(start);
        assert_eq!(playback.alpha(), 0.0, "the first redisplay shows the start");
        for milliseconds in [16, 17, 50, 200] {
            playback.advance(at(start, milliseconds));
        }
        assert!((playback.alpha() - 0.3).abs() < 1e-15);
        playback.advance(at(start, 200 + 4_000_000));
        let expected = (0.3 + 6000.0) % TAU;
        assert!((playback.alpha() - expected).abs() < 1e-10);
    }

    #[test]
    fn a_week_of_playback_keeps_its_precision() {
        let start = Instant::now();
        let frame = Duration::new(0, 16_666_667);
        let frames = 7 * 24 * 3600 * 60;
        let mut playback = Playback::new(Pace::Speed(1.5));
        let mut now = start;
        playback.advance(now);
        for _ in 0..frames {
            now += frame;
            playback.advance(now);
        }
        let nanoseconds = u128::from(frames as u64) * 16_666_667;
        // 1.5 rad/s for a whole number of nanoseconds, reduced in whole multiples of 1e-9 rad.
        let picoradians = nanoseconds * 1500;
        let turns = (picoradians as f64 * 1e-12 / TAU).floor();
        let expected = picoradians as f64 * 1e-12 - turns * TAU;
        assert!((playback.alpha() - expected).abs() < 1e-7);
        assert!((0.0..TAU).contains(&playback.alpha()));
    }

    #[test]
    fn no_speed_and_no_wait_lead_out_of_the_turn() {
        let start = Instant::now();
        for speed in [1e308, -1e308, -1e-300, f64::MIN_POSITIVE, 0.0] {
            let mut playback = Playback::new(Pace::Speed(speed));
            playback.advance(start);
            playback.advance(at(start, 86_400_000));
            assert!((0.0..TAU).contains(&playback.alpha()), "{speed}");
        }
    }

    #[test]
    fn stepped_playback_is_the_round_of_the_document() {
        let start = Instant::now();
        let mut playback = Playback::new(Pace::Step(0.3));
        for k in 0..3 * ROUND {
            playback.advance(start);
            assert_eq!(playback.alpha(), frame_angle(k));
        }
        let mut playback = Playback::new(Pace::Step(0.7));
        for expected in [0.0, 0.7, 1.4] {
            playback.advance(start);
            assert!((playback.alpha() - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn pausing_and_hiding_stop_the_clock() {
        let start = Instant::now();
        let mut playback = Playback::new(Pace::default());
        playback.advance(start);
        playback.advance(at(start, 200));
        let alpha = playback.alpha();
        playback.toggle();
        playback.advance(at(start, 900));
        assert_eq!(playback.alpha(), alpha);
        playback.toggle();
        playback.advance(at(start, 2000));
        assert_eq!(playback.alpha(), alpha);
        playback.hold();
        playback.advance(at(start, 5000));
        assert_eq!(playback.alpha(), alpha);
        playback.advance(at(start, 5200));
        assert!((playback.alpha() - 0.6).abs() < 1e-15);
    }

    #[test]
    fn an_animation_that_was_halted_plays_on_unless_a_key_paused_it() {
        let start = Instant::now();
        let mut playback = Playback::new(Pace::default());
        playback.advance(start);
        playback.advance(at(start, 200));
        let alpha = playback.alpha();
        playback.halt();
        assert!(playback.paused());
        assert!(playback.recover() && !playback.paused());
        playback.advance(at(start, 5000));
        assert_eq!(playback.alpha(), alpha, "no time counts in between");
        // Paused by a key before it was halted, and after that.
        for by_key in [Playback::toggle, Playback::pause] {
            let mut playback = Playback::new(Pace::default());
            by_key(&mut playback);
            playback.halt();
            assert!(!playback.recover() && playback.paused());
            let mut playback = Playback::new(Pace::default());
            playback.halt();
            playback.pause();
            assert!(!playback.recover() && playback.paused());
        }
        assert!(!playback.recover() && !playback.paused());
    }

    #[test]
    fn grid_keys_go_to_the_neighbouring_grid_angles_and_around() {
        let mut playback = Playback::new(Pace::default());
        for k in 1..=ROUND {
            playback.next_frame();
            assert_eq!(playback.alpha(), frame_angle(k));
        }
        for k in (0..ROUND).rev() {
            playback.previous_frame();
            assert_eq!(playback.alpha(), frame_angle(k));
        }
        playback.nudge(0.05);
        playback.next_frame();
        assert_eq!(playback.alpha(), 0.3);
        playback.nudge(0.05);
        playback.previous_frame();
        assert_eq!(playback.alpha(), 0.3);
        playback.zero();
        playback.nudge(-0.05);
        assert_eq!(playback.alpha(), (-0.05_f64).rem_euclid(TAU));
        playback.next_frame();
        assert_eq!(playback.alpha(), 0.0);
    }

    #[test]
    fn a_static_stage_keeps_only_an_angle_that_was_asked_for() {
        let start = Instant::now();
        let mut playback = Playback::new(Pace::default());
        playback.advance(start);
        playback.advance(at(start, 300));
        playback.settle();
        assert_eq!(playback.alpha(), 0.0);
        playback.nudge(0.05);
        playback.settle();
        assert_eq!(playback.alpha(), 0.05);
        playback.advance(at(start, 600));
        playback.settle();
        assert_eq!(playback.alpha(), 0.0, "the animation moved on from it");
    }

    #[test]
    fn the_pace_scales_within_reason() {
        let mut playback = Playback::new(Pace::Speed(-2.0));
        playback.scale(1.25);
        assert_eq!(playback.pace, Pace::Speed(-2.5));
        for _ in 0..1000 {
            playback.scale(1.25);
        }
        let Pace::Speed(fastest) = playback.pace else {
            unreachable!()
        };
        assert!((-1e3..=-8e2).contains(&fastest));
        for _ in 0..1000 {
            playback.scale(1.0 / 1.25);
        }
        let Pace::Speed(slowest) = playback.pace else {
            unreachable!()
        };
        assert!((-1.25e-3..=-1e-3).contains(&slowest));
    }
}
