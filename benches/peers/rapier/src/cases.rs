//! One body a line: name h steps mass I1 I2 I3 w1 w2 w3 damping torque impulse arm gravity angle.
//!
//! A torque about z that stays; an impulse along z at (1, 0, 0) at the fifth step. With an arm (m, along y
//! from the pivot to the centre of mass; 0 for a free body) the body hangs on a spherical joint at the origin and starts
//! turned by the angle about z. Answers `name off x y z w` or `name lost t`.

use rapier3d_f64::prelude::*;
use std::io::BufRead as _;

pub fn run() {
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let numbers: Vec<f64> = fields[1..].iter().filter_map(|x| x.parse().ok()).collect();
        println!("{} {}", fields[0], end(&numbers));
    }
}

fn end(n: &[f64]) -> String {
    let (h, steps, mass) = (n[0], n[1] as u32, n[2]);
    let moments = Vector::new(n[3], n[4], n[5]);
    let (damping, torque, impulse, arm, gravity, angle) = (n[9], n[10], n[11], n[12], n[13], n[14]);
    let mut world = PhysicsWorld::default();
    world.gravity = Vector::new(0.0, -gravity, 0.0);
    world.integration_parameters.dt = h;
    let centre = Vector::new(-arm * angle.sin(), arm * angle.cos(), 0.0);
    let spin = Vector::new(n[6], n[7], n[8]);
    let body = RigidBodyBuilder::dynamic()
        .translation(centre)
        .rotation(Vector::new(0.0, 0.0, angle))
        .additional_mass_properties(MassProperties::new(Vector::ZERO, mass, moments))
        .angvel(spin)
        .linvel(spin.cross(centre))
        .angular_damping(damping)
        .can_sleep(false);
    let body = world.insert_body(body);
    if arm != 0.0 {
        let ground = world.insert_body(RigidBodyBuilder::fixed());
        let joint = SphericalJointBuilder::new().local_anchor2(Vector::new(0.0, -arm, 0.0));
        world.impulse_joints.insert(ground, body, joint, true);
    }
    for step in 0..steps {
        let rb = &mut world.bodies[body];
        rb.reset_torques(true);
        if torque != 0.0 {
            rb.add_torque(Vector::new(0.0, 0.0, torque), true);
        }
        if step == 5 && impulse != 0.0 {
            rb.apply_impulse_at_point(Vector::new(0.0, 0.0, impulse), Vector::new(1.0, 0.0, 0.0), true);
        }
        world.step();
        let rb = &world.bodies[body];
        let (q, x, v, w) = (rb.rotation(), rb.translation(), rb.linvel(), rb.angvel());
        let all = [q.x, q.y, q.z, q.w, x.x, x.y, x.z, v.x, v.y, v.z, w.x, w.y, w.z];
        if !all.iter().all(|x| x.is_finite()) {
            return format!("lost {:e}", h * f64::from(step + 1));
        }
    }
    let q = world.bodies[body].rotation();
    format!("off {:e} {:e} {:e} {:e}", q.x, q.y, q.z, q.w)
}
