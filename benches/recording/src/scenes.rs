//! What is recorded.

use torquescope::scene::Scene;

/// Forced, damped, asymmetric, 1 ms a step: nothing about it stands still or repeats.
pub fn top(steps: usize, record: &str) -> Scene {
    let duration = steps as f64 * 1e-3;
    let source = format!(
        r#"
duration = {duration}
[stepping]
step = 0.001
[record]
{record}
[effects]
gravity = [0.0, -1.0, 0.0]
damping = {{ angular = 0.02 }}
gyroscopic = true
[[body]]
name = "top"
mass = 2.0
inertia = [1.0, 2.0, 2.5]
angular_velocity = [3.0, 5.0, -2.0]
velocity = [1.0, 20.0, 0.5]
[[event]]
at = 0.0
for = {duration}
body = "top"
torque = [0.3, 0.2, 0.1]
frame = "body"
"#
    );
    scene(&source)
}

/// Bodies that each turn in a way of their own.
pub fn bodies(count: usize, steps: usize, record: &str) -> Scene {
    let mut source = format!(
        "duration = {}\n[stepping]\nstep = 0.001\n[record]\n{record}\n[effects]\ngravity = [0.0, -9.81, 0.0]\ngyroscopic = true\n",
        steps as f64 * 1e-3
    );
    for k in 0..count {
        let x = k as f64;
        source += &format!(
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nposition = [{x}, 0, 0]\nangular_velocity = [{}, {}, {}]\n",
            1.0 + 0.001 * x,
            2.0 - 0.0013 * x,
            0.1 + 0.0007 * x
        );
    }
    scene(&source)
}

/// The same as one swarm.
pub fn swarm(count: usize, steps: usize) -> Scene {
    scene(&format!(
        r#"
duration = {}
[stepping]
step = 0.001
[effects]
gravity = [0.0, -9.81, 0.0]
gyroscopic = true
[[swarm]]
name = "box"
count = {count}
shape = {{ cuboid = {{ x = 0.3, y = 0.5, z = 0.9 }} }}
mass = 1.0
grid = {{ spacing = 1.5 }}
random = {{ seed = 7, spin = 10.0, orientation = true, within = [0.4, 0.4, 0.4] }}
"#,
        steps as f64 * 1e-3
    ))
}

fn scene(source: &str) -> Scene {
    Scene::parse("bench", "bench", source).unwrap_or_else(|error| panic!("{error}"))
}
