//! How many steps are taken at once: few where they are much work, by counts and not by a clock.

use std::ops::Range;
use torquescope::scene::Scene;
use torquescope::sim::Simulation;
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Track};

/// The steps of each stretch, where every state is recorded.
#[derive(Default)]
struct Stretches(Vec<usize>);

impl Sink for Stretches {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        if track.bodies.start == 0 {
            self.0.push(track.instants.len());
        }
        Ok(())
    }

    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }

    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

fn stretches(method: &str, step: f64, steps: usize, bodies: usize) -> Vec<usize> {
    let body = |k: usize| {
        format!(
            "[[body]]\nname = \"b{k}\"\nmass = 1\ninertia = [1, 2, 2.5]\nangular_velocity = [100, 1, 3]\n"
        )
    };
    let bodies: String = (0..bodies).map(body).collect();
    let source = format!(
        "duration = {}\n[effects]\ngyroscopic = true\n[stepping]\nmethod = \"{method}\"\nstep = {step}\n[record]\nstate = \"every\"\nrate = 1\nstreams = []\n{bodies}",
        step * steps as f64
    );
    let scene = Scene::parse("s", "s", &source).unwrap();
    let mut sink = Stretches::default();
    Simulation::new(&scene).run(&mut sink).1.unwrap();
    // The start is one by itself.
    assert_eq!(sink.0.remove(0), 1);
    assert_eq!(sink.0.iter().sum::<usize>(), steps);
    sink.0
}

#[test]
fn where_steps_are_little_work_many_are_taken_at_once() {
    assert_eq!(stretches("rk4", 1e-4, 2500, 1), [1024, 1024, 452]);
    assert_eq!(stretches("dop853", 1e-4, 2500, 1), [1024, 1024, 452]);
}

#[test]
fn where_they_are_much_work_few_are() {
    // A thousand bodies, each weighing 2.4 steps of rk4: 640,000 / 2,400.
    assert_eq!(stretches("cf4", 1e-4, 300, 1000), [200, 100]);
    assert_eq!(stretches("cf4", 1e-4, 100, 8000), [33, 33, 33, 1]);
    // 10,000 rad are tens of thousands of its own steps, each weighing 3.4.
    let own = stretches("dop853", 100.0, 12, 1);
    assert_eq!(own[..2], [1, 4]);
    assert!((2..16).contains(&own[2]), "{own:?}");
}
