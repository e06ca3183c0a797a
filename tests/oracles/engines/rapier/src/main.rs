//! A free rigid body in Rapier itself (rapier3d-f64): `cargo run --release -- FOLDER`, or `-- wingnut`. Writes rapier_<variant>_<case>.csv: t,qx,qy,qz,qw,wx,wy,wz (world omega).
//! Variants: default (4 substeps, gyroscopic on), sub1 (num_solver_iterations = 1, gyro on), nogyro (default, gyro off), sub1_nogyro.
use rapier3d_f64::prelude::*;
use std::io::Write;

fn main() {
    let out = std::env::args().nth(1).expect("output folder");
    if out == "wingnut" {
        return wingnut();
    }
    for (variant, sub, gyro) in [("default", 4, true), ("sub1", 1, true), ("nogyro", 4, false), ("sub1_nogyro", 1, false)] {
        for (case, tau, c, w0) in [
            ("top", [0.0, 0.0, 0.0], 0.0, [0.1, 2.0, 0.1]),
            ("torque", [0.3, 0.0, 0.2], 0.0, [0.1, 2.0, 0.1]),
            ("damped", [0.0, 0.0, 0.0], 0.1, [0.1, 2.0, 0.1]),
            ("torquedamped", [0.3, 0.0, 0.2], 0.1, [0.1, 2.0, 0.1]),
            ("fast", [0.0, 0.0, 0.0], 0.0, [60.0, 70.0, 20.0]),
        ] {
            let (mut w, b) = world(sub, gyro, tau, c, w0, 0.01);
            let mut f = std::fs::File::create(format!("{out}/rapier_{variant}_{case}.csv")).unwrap();
            writeln!(f, "t,qx,qy,qz,qw,wx,wy,wz").unwrap();
            for k in 0..=1000u32 {
                if k > 0 {
                    w.step();
                }
                if k <= 3 || k % 100 == 0 {
                    let rb = &w.bodies[b];
                    let (q, o) = (rb.rotation(), rb.angvel());
                    // 17 significant digits
                    writeln!(f, "{},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e}", k as f64 * 0.01, q.x, q.y, q.z, q.w, o.x, o.y, o.z).unwrap();
                }
            }
            let rb = &w.bodies[b];
            println!("{variant} {case} {:?} {:?}", rb.rotation(), rb.angvel());
        }
    }
}

fn world(sub: usize, gyro: bool, tau: [f64; 3], c: f64, w0: [f64; 3], h: f64) -> (PhysicsWorld, RigidBodyHandle) {
    let mut w = PhysicsWorld::default();
    w.gravity = Vector::ZERO;
    w.integration_parameters.dt = h;
    w.integration_parameters.num_solver_iterations = sub;
    let mp = MassProperties::new(Vector::ZERO, 1.0, Vector::new(1.0, 2.0, 3.0));
    let rb = RigidBodyBuilder::dynamic()
        .additional_mass_properties(mp)
        .angvel(Vector::new(w0[0], w0[1], w0[2]))
        .angular_damping(c)
        .can_sleep(false)
        .gyroscopic_forces_enabled(gyro);
    let b = w.insert_body(rb);
    w.bodies[b].add_torque(Vector::new(tau[0], tau[1], tau[2]), true);
    (w, b)
}

/// Flips of the middle axis: how many sign changes of body omega_y in 60 s (same body, I = (1,2,3), omega = (0.1,2,0.1)).
fn wingnut() {
    for (name, sub, h) in [("default 60 Hz", 4, 1.0 / 60.0), ("1 substep 60 Hz", 1, 1.0 / 60.0), ("1 substep 240 Hz", 1, 1.0 / 240.0)] {
        let (mut w, b) = world(sub, true, [0.0; 3], 0.0, [0.1, 2.0, 0.1], h);
        let (mut last, mut t, mut times) = (1.0, 0.0, vec![]);
        while t < 60.0 {
            w.step();
            t += h;
            let rb = &w.bodies[b];
            let wy = (rb.rotation().inverse() * rb.angvel()).y;
            if wy * last < 0.0 {
                times.push(t);
                last = wy;
            }
        }
        println!("{name}: {} flips, {:?}", times.len(), &times[..times.len().min(6)]);
    }
}
