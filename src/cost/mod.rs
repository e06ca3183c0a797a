//! Level 6: what accuracy costs. Runs a scene by many methods, compares each with the truest motion
//! there is, and chooses.

mod check;
mod ladder;
mod plan;
#[cfg(feature = "cli")]
pub mod plot;
mod race;
mod reference;

pub use check::{Checked, apart};
pub use ladder::{Advice, Cost, LOST, Ladder, Progress, Rung, Spread, time};
pub use plan::{Plan, PlanError, Planned};
pub use race::Race;
pub use reference::{EXACT, Reference};
