//! Free bodies in Rapier, as it steps by default: four substeps, the gyroscopic term on. Prints ns of
//! processor time a body-step: of one body, and of ten thousand.
//!
//! `rapier-peer cases` reads hard cases from its input (../hard_cases.py writes them) and prints how each ends.

mod cases;

use cpu_time::ThreadTime;
use rapier3d_f64::prelude::*;
use std::hint::black_box;

fn main() {
    if std::env::args().nth(1).as_deref() == Some("cases") {
        return cases::run();
    }
    println!(
        "{{\"one\": {}, \"many\": {}}}",
        time(1, 1_000),
        time(10_000, 16)
    );
}

fn time(bodies: usize, steps: u32) -> f64 {
    let shortest = |best: f64, _| {
        let mut world = world(bodies);
        // The first step builds what the engine keeps.
        world.step();
        let start = ThreadTime::now();
        for _ in 0..steps {
            world.step();
        }
        let ns = start.elapsed().as_nanos() as f64;
        black_box(&world.bodies);
        best.min(ns)
    };
    (0..3).fold(f64::INFINITY, shortest) / (bodies as f64 * f64::from(steps))
}

fn world(bodies: usize) -> PhysicsWorld {
    let mut world = PhysicsWorld::default();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = 0.01;
    for k in 0..bodies {
        let mass = MassProperties::new(Vector::ZERO, 1.0, Vector::new(1.0, 2.0, 3.0));
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(k as f64, 0.0, 0.0))
            .additional_mass_properties(mass)
            .angvel(Vector::new(0.1, 2.0, 0.1))
            .can_sleep(false);
        world.insert_body(body);
    }
    world
}
