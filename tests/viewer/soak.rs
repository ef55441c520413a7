//! The viewer, used at random.

use std::thread;
use std::time::{Duration, Instant};

use super::random::Random;
use super::session::{DOWN, LEFT, RIGHT, RIGHT_BUTTON, Session, UP, WHEEL_DOWN, WHEEL_UP};

/// How long the viewer is used at random, in seconds: so many as this variable says.
const SOAK: &str = "FIRSTHIT_SOAK_SECONDS";

#[test]
fn used_at_random_it_stays_well_and_its_memory_bounded() {
    let Some(mut session) = Session::start(&["view", "--size", "50"]) else {
        return;
    };
    let seconds = std::env::var(SOAK).map_or(5, |seconds| seconds.parse().unwrap());
    let start = Instant::now();
    let mut choices = Random::new();
    let mut random = |count| choices.below(count);
    let keys = b"1234567 .,+-0ekimhz";
    let mut settled = None;
    while start.elapsed() < Duration::from_secs(seconds) {
        session.program.goes_on();
        match random(12) {
            0 => session.resize(1 + random(500) as u32, 1 + random(500) as u32),
            1 => session.point(random(300) as i16, random(300) as i16),
            2 => session.click(if random(2) == 0 { WHEEL_UP } else { WHEEL_DOWN }),
            3 => session.click(RIGHT_BUTTON),
            4 => session.press(if random(2) == 0 { UP } else { DOWN }),
            5 => session.press(if random(2) == 0 { LEFT } else { RIGHT }),
            _ => session.press(u32::from(keys[random(keys.len())])),
        }
        thread::sleep(Duration::from_millis(5));
        // By then everything has been open once.
        if settled.is_none() && start.elapsed() > Duration::from_secs(seconds / 2) {
            settled = Some(session.program.memory());
        }
    }
    let (settled, end) = (settled.unwrap(), session.program.memory());
    assert!(
        end < settled + 32 * 1024,
        "{settled} KiB, and then {end} KiB"
    );
    // Whatever is open, it leaves as it is told.
    session.close();
    session.program.left();
}
