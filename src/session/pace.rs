//! Simulated time by a clock on the wall: without drift, and slower where it cannot keep up.
//!
//! ```text
//! due = sim0 + (wall - wall0) speed        behind = (due - reached) / speed
//! ```
//!
//! counted from where it set out, so that nothing adds up. What is more than [`CATCH_UP`] behind is given up:
//! `sim0` moves, every step is still taken, and what was lost is told.

use std::time::Instant;

/// A clock on the wall, s; it never goes back.
pub trait Clock {
    fn seconds(&self) -> f64;
}

/// The machine's.
pub struct SystemClock(Instant);

impl SystemClock {
    pub fn start() -> Self {
        Self(Instant::now())
    }
}

impl Clock for SystemClock {
    fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// s of the wall that are made up for at most.
pub const CATCH_UP: f64 = 0.25;

/// Where simulated time should be.
#[derive(Clone, Debug)]
pub struct Pace {
    speed: f64,
    /// Wall and simulated time at which it set out, s; none while it stands.
    from: Option<(f64, f64)>,
    lost: f64,
}

/// How well it keeps up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pacing {
    /// Simulated s that should be reached by now.
    pub due: f64,
    pub reached: f64,
    /// s of the wall; 0 where it keeps up.
    pub behind: f64,
    /// s of the wall given up since it set out.
    pub lost: f64,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            speed: 1.0,
            from: None,
            lost: 0.0,
        }
    }
}

impl Pace {
    /// Simulated seconds a second; infinite is as fast as it goes.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    pub fn is_going(&self) -> bool {
        self.from.is_some()
    }

    /// Sets out, or again, from here.
    pub fn set_out(&mut self, wall: f64, reached: f64) {
        self.from = Some((wall, reached));
        self.lost = 0.0;
    }

    pub fn stand(&mut self) {
        self.from = None;
    }

    /// Above zero.
    pub fn set_speed(&mut self, speed: f64, wall: f64, reached: f64) {
        self.speed = speed;
        if self.is_going() {
            self.set_out(wall, reached);
        }
    }

    fn due(&self, wall: f64) -> Option<f64> {
        let (wall0, sim0) = self.from?;
        Some(match self.speed.is_finite() {
            true => sim0 + (wall - wall0) * self.speed,
            false => f64::INFINITY,
        })
    }

    /// When on the wall a simulated time (s) is due.
    pub fn wall_of(&self, time: f64) -> Option<f64> {
        let (wall0, sim0) = self.from?;
        Some(wall0 + (time - sim0) / self.speed)
    }

    /// How far to step now, simulated s; none while it stands.
    pub fn goal(&mut self, wall: f64, reached: f64) -> Option<f64> {
        let due = self.due(wall)?;
        let excess = due - (reached + CATCH_UP * self.speed);
        // Of two infinities the difference is no number, and nothing is late.
        if excess > 0.0 {
            self.lost += excess / self.speed;
            if let Some((_, sim0)) = &mut self.from {
                *sim0 -= excess;
            }
            return self.due(wall);
        }
        Some(due)
    }

    /// How it stands, after stepping.
    pub fn pacing(&self, wall: f64, reached: f64) -> Option<Pacing> {
        let due = self.due(wall)?;
        let behind = match self.speed.is_finite() {
            true => ((due - reached) / self.speed).max(0.0),
            false => 0.0,
        };
        Some(Pacing {
            due,
            reached,
            behind,
            lost: self.lost,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_hour_of_ticks_adds_up_to_an_hour() {
        let mut pace = Pace::default();
        pace.set_out(100.0, 2.0);
        let mut reached = 2.0;
        // A tick of 1/60 s, not a number that adds up; stepping lands up to a step before what is due.
        for k in 1..=216_000_u32 {
            let wall = 100.0 + f64::from(k) / 60.0;
            let goal = pace.goal(wall, reached).unwrap();
            reached = (goal / 1e-3).floor() * 1e-3;
        }
        // The last step is not taken yet, and 3,602 s are known to some 1e-12 s.
        assert!((3600.0 + 2.0 - reached).abs() <= 1e-3 + 1e-9, "{reached}");
        let pacing = pace.pacing(100.0 + 3600.0, reached).unwrap();
        assert!(
            pacing.lost == 0.0 && pacing.behind <= 1e-3 + 1e-9,
            "{pacing:?}"
        );
    }

    #[test]
    fn it_slows_and_says_by_how_much_and_never_skips() {
        let mut pace = Pace::default();
        pace.set_speed(2.0, 0.0, 0.0);
        pace.set_out(0.0, 0.0);
        let (mut wall, mut reached) = (0.0, 0.0);
        // A machine that gets through 1 simulated second a second where 2 are asked for.
        for _ in 0..1000 {
            let goal = pace.goal(wall, reached).unwrap();
            assert!(goal <= reached + CATCH_UP * 2.0 + 1e-9);
            let take = f64::min(goal - reached, 0.01);
            reached += take;
            wall += 0.01;
        }
        let pacing = pace.pacing(wall, reached).unwrap();
        // In 10 s it got 10 s; 20 were due, of which at most a quarter of a second is kept as a debt.
        assert!((reached - 10.0).abs() < 0.02, "{reached}");
        assert!((pacing.behind - CATCH_UP).abs() < 0.02, "{pacing:?}");
        assert!((pacing.lost - (5.0 - CATCH_UP)).abs() < 0.03, "{pacing:?}");
        // A short hold-up is made up for.
        pace.set_out(0.0, 0.0);
        assert_eq!(pace.goal(0.2, 0.0), Some(0.4));
        assert_eq!(pace.pacing(0.2, 0.4).unwrap().lost, 0.0);
    }

    #[test]
    fn a_pause_or_another_speed_counts_from_where_it_is() {
        let mut pace = Pace::default();
        assert_eq!(pace.goal(5.0, 0.0), None);
        pace.set_out(10.0, 1.0);
        assert_eq!(pace.goal(10.125, 1.0), Some(1.125));
        pace.stand();
        assert_eq!(
            (pace.goal(99.0, 1.125), pace.pacing(99.0, 1.125)),
            (None, None)
        );
        pace.set_out(100.0, 1.125);
        pace.set_speed(0.25, 100.0, 1.125);
        assert_eq!(pace.goal(100.125, 1.125), Some(1.125 + 0.03125));
        pace.set_speed(f64::INFINITY, 101.0, 2.0);
        assert_eq!(pace.goal(101.0, 2.0), Some(f64::INFINITY));
        assert_eq!(pace.pacing(102.0, 2.0).unwrap().behind, 0.0);
    }
}
