//! A cell, run as a user runs a scene.

use crate::cells::{Case, Must};
use nalgebra::Matrix3;
use std::ops::Range;
use torquescope::body::Inertial;
use torquescope::integrator::{Kind, MethodInfo};
use torquescope::mass::MassProperties;
use torquescope::scene::Scene;
use torquescope::sim::{SimError, Simulation};
use torquescope::trace::{Instant, Motion, Note, Sample, Sink, SinkError, Track};

/// What a cell came to.
#[derive(Clone, Debug)]
pub enum Seen {
    /// It ran to its end, so far off, and the watchdog told of so many drifts.
    Off {
        off: f64,
        warned: usize,
    },
    /// The scene was refused, with this message.
    Refused(String),
    /// It stopped at a time (s) and said this.
    Lost {
        time: f64,
        said: String,
    },
    NotRun,
}

/// A sink that sees to it that attitudes are attitudes.
struct Watched {
    /// The largest deviation of |q|² from 1.
    length: f64,
    notes: Vec<String>,
    motions: Vec<Motion>,
}

impl Sink for Watched {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        for motion in track.motions {
            let length = (motion.q_wb.coords.norm_squared() - 1.0).abs();
            self.length = self.length.max(length);
            self.motions.push(*motion);
        }
        Ok(())
    }
    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }
    fn note(&mut self, _: Instant, note: &Note) -> Result<(), SinkError> {
        self.notes.push(note.text.clone());
        Ok(())
    }
}

fn stepping(case: &Case, info: &MethodInfo) -> String {
    let tolerance = match info.kind {
        Kind::Adaptive => format!("\ntolerance = {:e}", crate::cells::TOLERANCE),
        _ => String::new(),
    };
    format!(
        "method = \"{}\"\nstep = {:e}{tolerance}",
        info.name, case.problem.step
    )
}

pub fn see(case: &Case, info: &MethodInfo) -> Seen {
    if let Must::NotRun = case.must(info) {
        return Seen::NotRun;
    }
    let text = case
        .problem
        .scene
        .replace("STEPPING", &stepping(case, info));
    let scene = match Scene::parse("hard.toml", "hard", &text) {
        Ok(scene) => scene,
        Err(problems) => return Seen::Refused(problems.to_string()),
    };
    let mut sink = Watched {
        length: 0.0,
        notes: Vec::new(),
        motions: Vec::new(),
    };
    let (outcome, done) = Simulation::new(&scene).on_threads(1).run(&mut sink);
    match done {
        Ok(()) => {
            let end = &outcome.end[0];
            // Methods renormalise or multiply unit quaternions: some roundings.
            assert!(
                sink.length < 1e-13,
                "{}, {}: |q|² off by {:e}",
                case.name,
                info.name,
                sink.length
            );
            Seen::Off {
                off: (case.problem.off)(end),
                warned: outcome.warnings.len(),
            }
        }
        Err(error) => {
            let SimError::NotFinite {
                body, time, step, ..
            } = &error
            else {
                panic!("{}, {}: {error}", case.name, info.name);
            };
            let said = error.to_string();
            assert_eq!(body, "hard");
            assert!(said.contains(&format!(
                "hard is no longer finite at t = {time} s, step {step}"
            )));
            assert_eq!(sink.notes.last(), Some(&said), "the log has it too");
            Seen::Lost { time: *time, said }
        }
    }
}

/// The states of a scene's first body, and how its run ended.
pub fn motions(text: &str) -> (Vec<Motion>, Result<(), SimError>) {
    let scene =
        Scene::parse("hard.toml", "hard", text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    let mut sink = Watched {
        length: 0.0,
        notes: Vec::new(),
        motions: Vec::new(),
    };
    let (_, done) = Simulation::new(&scene).on_threads(1).run(&mut sink);
    (sink.motions, done)
}

/// A body of these principal moments, 1 kg.
pub fn body(moments: [f64; 3]) -> Inertial {
    let tensor = Matrix3::from_diagonal(&moments.into());
    let properties =
        MassProperties::new(1.0, tensor, [false; 3]).unwrap_or_else(|why| panic!("{why}"));
    Inertial::new(&properties, None).0
}
