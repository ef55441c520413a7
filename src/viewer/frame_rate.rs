//! The frame rate of the window.

use std::time::{Duration, Instant};

/// The time over which frames are counted.
const INTERVAL: Duration = Duration::from_millis(250);

/// Counts the frames of a playing animation.
#[derive(Debug, Default)]
pub(super) struct FrameRate {
    /// The first frame of the interval, and the frames since.
    since: Option<(Instant, u32)>,
    rate: Option<f64>,
}

impl FrameRate {
    /// A frame was shown at `now`; whether an interval is over and [`FrameRate::per_second`] is
    /// new.
    pub(super) fn count(&mut self, now: Instant) -> bool {
        let Some((since, frames)) = &mut self.since else {
            self.since = Some((now, 0));
            return true;
        };
        *frames += 1;
        let elapsed = now.saturating_duration_since(*since);
        if elapsed < INTERVAL {
            return false;
        }
        self.rate = Some(f64::from(*frames) / elapsed.as_secs_f64());
        self.since = Some((now, 0));
        true
    }

    /// Nothing plays: the next frame starts an interval.
    pub(super) fn stop(&mut self) {
        *self = FrameRate::default();
    }

    /// Frames a second in the last interval that is over.
    pub(super) fn per_second(&self) -> Option<f64> {
        self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_of_the_last_interval() {
        let start = Instant::now();
        let mut frame_rate = FrameRate::default();
        let mut new = 0;
        for k in 0..=10 {
            new += u32::from(frame_rate.count(start + k * Duration::from_millis(50)));
        }
        assert_eq!(new, 3, "at the start and each 250 ms");
        assert_eq!(frame_rate.per_second(), Some(20.0));
        frame_rate.stop();
        assert_eq!(frame_rate.per_second(), None);
        assert!(frame_rate.count(start));
    }
}
