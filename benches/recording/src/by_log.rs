//! As every example of the SDK does it: a `log` call a step and entity. Four quantities.

use rerun::{Arrows3D, RecordingStreamBuilder, Scalars, Transform3D};
use std::path::Path;
use torquescope::trace::{Instant, Sample};

pub fn log(rows: &[(Instant, Sample)], path: &Path) {
    let builder = RecordingStreamBuilder::new("bench");
    let stream = builder.save(path).expect("a place for files");
    for (at, sample) in rows {
        stream.set_duration_secs("sim_time", at.time);
        stream.set_time_sequence("step", at.step as i64);
        let motion = &sample.motion;
        let single = |v: nalgebra::Vector3<f64>| <[f32; 3]>::from(v.map(|x| x as f32));
        let [x, y, z, w] = motion.q_wb.coords.map(|x| x as f32).into();
        let pose = Transform3D::from_translation(single(motion.position_w))
            .with_quaternion(rerun::Quaternion::from_xyzw([x, y, z, w]));
        let arrow = |v| Arrows3D::from_vectors([single(v)]);
        let done = stream
            .log("bodies/top", &pose)
            .and_then(|()| stream.log("omega/top", &arrow(motion.omega_w)))
            .and_then(|()| stream.log("torque/top", &arrow(sample.tau_w)))
            .and_then(|()| stream.log("numbers/top", &Scalars::single(sample.alpha_w.norm())));
        done.expect("a log");
    }
    stream.flush_blocking().expect("a flush");
}
