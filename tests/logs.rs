//! Logs of other engines: which columns are recognised, what is asked for, which rows are left out and how that is
//! told, what their numbers look like, and what is said of their bodies.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::fmt::Write as _;
use std::path::Path;
use torquescope::log::bodies;
use torquescope::log::conventions::{CannotTell, Order, Verdict};
use torquescope::log::read::{Bad, Format};
use torquescope::log::spellings::{self, Frame, Quantity};
use torquescope::log::{Log, LogError, Mapping, Options, Reader, Reading, Report, Row};

fn options(mappings: &[&str]) -> Options {
    let mapping = |text: &&str| text.parse().unwrap_or_else(|why| panic!("{why}"));
    Options {
        mappings: mappings.iter().map(mapping).collect(),
        ..Options::default()
    }
}

fn read(text: &str) -> (Log, Report) {
    read_with(text, &[])
}

fn read_with(text: &str, mappings: &[&str]) -> (Log, Report) {
    Log::read("log", text.as_bytes(), options(mappings)).unwrap_or_else(|why| panic!("{why}"))
}

fn refused(text: &str, mappings: &[&str]) -> String {
    match Log::read("log", text.as_bytes(), options(mappings)) {
        Ok((log, report)) => panic!("read: {log:?}\n{report}"),
        Err(why) => why.to_string(),
    }
}

fn rows(text: &str, mappings: &[&str]) -> Vec<Row> {
    let reader = Reader::new("log", text.as_bytes(), options(mappings));
    let reader = reader.unwrap_or_else(|why| panic!("{why}"));
    reader
        .map(|row| row.unwrap_or_else(|why| panic!("{why}")))
        .collect()
}

fn codes(report: &Report) -> Vec<&str> {
    report.notes.iter().map(|note| note.code).collect()
}

fn said(report: &Report, code: &str) -> String {
    let note = report.notes.iter().find(|note| note.code == code);
    let note = note.unwrap_or_else(|| panic!("nothing of {code}: {report}"));
    note.told("log")
}

const CONTRACT: &str = "time,body,x,y,z,qx,qy,qz,qw,wx,wy,wz,tx,ty,tz,fx,fy,fz,px,py,pz\n";

#[test]
fn a_log_of_the_contract_is_what_it_says() {
    let text = format!(
        "{CONTRACT}0,box,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3,4,5,6,7,8,9,10,11,12\n\
         0,ball,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n\
         0.5,box,1,2,4,0,0,0.6,0.8,0.1,0.2,0.3,4,5,6,7,8,9,10,11,12.5\n\
         0.5,ball,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n"
    );
    let (log, report) = read(&text);
    let names: Vec<&str> = log.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["box", "ball"]);
    let rows = &log.bodies[0].rows;
    assert_eq!(rows.times, [0.0, 0.5]);
    assert_eq!(rows.positions, [[1.0, 2.0, 3.0], [1.0, 2.0, 4.0]]);
    assert_eq!(rows.attitudes, [[0.0, 0.0, 0.6, 0.8]; 2]);
    assert_eq!(rows.omegas, [[0.1, 0.2, 0.3]; 2]);
    assert_eq!(rows.torques, [[4.0, 5.0, 6.0]; 2]);
    assert_eq!(rows.forces, [[7.0, 8.0, 9.0]; 2]);
    assert_eq!(rows.points, [[10.0, 11.0, 12.0], [10.0, 11.0, 12.5]]);
    assert!(rows.velocities.is_empty());
    assert_eq!((report.rows, report.left_out()), (4, 0));
    assert_eq!(report.to_string(), "");
}

/// The same row under the spellings that people use: each is the first column list of a log, with what its columns
/// hold.
#[test]
fn columns_are_recognised_as_people_write_them() {
    // Time 2 s, position (1, 2, 3), attitude (x, y, z, w) = (0, 0, 0.6, 0.8), omega (0.1, 0.2, 0.3).
    let cases: [(&str, &str); 17] = [
        (
            "t,px,py,pz,qw,qx,qy,qz,omega_x,omega_y,omega_z",
            "2,1,2,3,0.8,0,0,0.6,0.1,0.2,0.3",
        ),
        (
            "time_us,pos_x,pos_y,pos_z,quat_x,quat_y,quat_z,quat_w,ang_vel_x,ang_vel_y,ang_vel_z",
            "2000000,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "timestamp [us],position.x,position.y,position.z,orientation.x,orientation.y,orientation.z,orientation.w,angular_velocity.x,angular_velocity.y,angular_velocity.z",
            "2000000,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "sim_time,p[0],p[1],p[2],q[0],q[1],q[2],q[3],w[0],w[1],w[2]",
            "2,1,2,3,0.8,0,0,0.6,0.1,0.2,0.3",
        ),
        (
            "Time (ms),X [mm],Y [mm],Z [mm],q0,q1,q2,q3,wx_deg,wy_deg,wz_deg",
            "2000,1000,2000,3000,0.8,0,0,0.6,5.729577951308232,11.459155902616464,17.188733853924695",
        ),
        (
            "timestamp,posX,posY,posZ,quatX,quatY,quatZ,quatW,angVelX,angVelY,angVelZ",
            "2,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "stamp,Position/X,Position/Y,Position/Z,Rotation/X,Rotation/Y,Rotation/Z,Rotation/W,AngularVelocity/X,AngularVelocity/Y,AngularVelocity/Z",
            "2,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        // Blanks after commas, and other separators.
        (
            "time, x, y, z, q.x, q.y, q.z, q.w, wx, wy, wz",
            "2, 1, 2, 3, 0, 0, 0.6, 0.8, 0.1, 0.2, 0.3",
        ),
        (
            "time;x;y;z;qx;qy;qz;qw;wx;wy;wz",
            "2;1;2;3;0;0;0.6;0.8;0.1;0.2;0.3",
        ),
        (
            "time\tx\ty\tz\tqx\tqy\tqz\tqw\twx\twy\twz",
            "2\t1\t2\t3\t0\t0\t0.6\t0.8\t0.1\t0.2\t0.3",
        ),
        (
            "# time,x,y,z,qx,qy,qz,qw,wx,wy,wz",
            "2,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "\u{feff}time,x,y,z,qx,qy,qz,qw,wx,wy,wz",
            "2,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "\"time\",\"x\",\"y\",\"z\",\"qx\",\"qy\",\"qz\",\"qw\",\"wx\",\"wy\",\"wz\"",
            "\"2\",1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        // x, y, z, w are an attitude where the position has columns of its own.
        (
            "time,pos_x,pos_y,pos_z,x,y,z,w,wx,wy,wz",
            "2,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        // Seconds and nanoseconds apart.
        (
            "header.stamp.sec,header.stamp.nanosec,x,y,z,qx,qy,qz,qw,wx,wy,wz",
            "1,1000000000,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "/sim/time,/b/pose/pose/position/x,/b/pose/pose/position/y,/b/pose/pose/position/z,/b/pose/pose/orientation/x,/b/pose/pose/orientation/y,/b/pose/pose/orientation/z,/b/pose/pose/orientation/w,/b/angular_velocity/x,/b/angular_velocity/y,/b/angular_velocity/z",
            "2,1,2,3,0,0,0.6,0.8,0.1,0.2,0.3",
        ),
        (
            "elapsed_time_s,x_m,y_m,z_m,e0,e1,e2,e3,w_x_rad_s,w_y_rad_s,w_z_rad_s",
            "2,1,2,3,0.8,0,0,0.6,0.1,0.2,0.3",
        ),
    ];
    for (header, row) in cases {
        let rows = rows(&format!("{header}\n{row}\n"), &[]);
        let [row] = rows[..] else {
            panic!("{header}: {rows:?}")
        };
        assert_eq!(row.time, 2.0, "{header}");
        assert_eq!(row.position, Some([1.0, 2.0, 3.0]), "{header}");
        assert_eq!(row.attitude, Some([0.0, 0.0, 0.6, 0.8]), "{header}");
        let omega = Vector3::from(row.omega.unwrap());
        // A conversion from degrees rounds twice.
        assert!(
            (omega - Vector3::new(0.1, 0.2, 0.3)).norm() < 2e-16,
            "{header}: {omega}"
        );
    }
}

fn fixture(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/logs");
    std::fs::read(folder.join(name)).unwrap()
}

#[test]
fn what_other_programs_write_is_read() {
    let log = |name: &str| Log::read("log", &fixture(name)[..], Options::default()).unwrap();
    // ULog: microseconds, w first, rates along the body's axes; R of (0, 0, 0.6, 0.8) takes (1, 2) to (0.28, 0.96) + 2 (-0.96, 0.28).
    let (ulog, report) = log("ulog.csv");
    let rows = &ulog.bodies[0].rows;
    assert_eq!(rows.times, [0.001, 0.005]);
    assert_eq!(rows.attitudes, [[0.0, 0.0, 0.6, 0.8]; 2]);
    let omega = Vector3::from(rows.omegas[0]);
    assert!(
        (omega - Vector3::new(-0.164, 0.152, 0.3)).norm() < 1e-15,
        "{omega}"
    );
    assert_eq!(report.count(Bad::NotFinite), 1);
    // ROS, as rostopic prints it: nanoseconds since 1970, a twist of the child frame.
    let (odometry, report) = log("odometry.csv");
    assert_eq!(odometry.bodies[0].name, "base");
    let rows = &odometry.bodies[0].rows;
    assert_eq!(rows.times, [0.0, 0.01]);
    assert_eq!(rows.positions, [[1.0, 2.0, 3.0]; 2]);
    let omega = Vector3::from(rows.omegas[0]);
    assert!(
        (omega - Vector3::new(-0.164, 0.152, 0.3)).norm() < 1e-15,
        "{omega}"
    );
    assert!(
        said(&report, "columns-not-read").ends_with("not read: field.header.stamp"),
        "{report}"
    );
    // MuJoCo's state of one free body; of several nobody can tell whose it is.
    let qpos = |n: usize| {
        (0..n)
            .map(|k| format!("qpos[{k}]"))
            .collect::<Vec<_>>()
            .join(",")
    };
    let qvel = |n: usize| {
        (0..n)
            .map(|k| format!("qvel[{k}]"))
            .collect::<Vec<_>>()
            .join(",")
    };
    let text = format!(
        "time,{},{}\n0,1,2,3,0.8,0,0,0.6,4,5,6,0.1,0.2,0.3\n",
        qpos(7),
        qvel(6)
    );
    let row = crate::rows(&text, &[])[0];
    assert_eq!(
        (row.position, row.velocity),
        (Some([1.0, 2.0, 3.0]), Some([4.0, 5.0, 6.0]))
    );
    assert_eq!(row.attitude, Some([0.0, 0.0, 0.6, 0.8]));
    let omega = Vector3::from(row.omega.unwrap());
    assert!(
        (omega - Vector3::new(-0.164, 0.152, 0.3)).norm() < 1e-15,
        "{omega}"
    );
    let why = refused(&format!("time,{},{}\n", qpos(14), qvel(12)), &[]);
    assert!(
        why.starts_with("log:1: no columns are recognised as an attitude"),
        "{why}"
    );
    // The lines of the docs.
    let (lines, report) = log("lines.jsonl");
    assert_eq!(lines.bodies[0].rows.times, [0.0, 0.2]);
    assert_eq!(report.told[0].line, 2);
    let (bodies, _) = bodies::read("bodies.toml", &fixture("bodies.toml")).unwrap();
    assert_eq!(bodies[0].1.mass, Some(2.0));
}

/// Bodies' axes where that is the custom: (0.1, 0.2, 0.3) about a body turned by a quarter about z.
#[test]
fn what_is_along_the_bodys_axes_is_turned() {
    let s = std::f64::consts::FRAC_1_SQRT_2;
    for names in [
        "rollspeed,pitchspeed,yawspeed",
        "p,q,r",
        "gyro_rad[0],gyro_rad[1],gyro_rad[2]",
        "twist.twist.angular.x,twist.twist.angular.y,twist.twist.angular.z",
    ] {
        let text = format!("time,qx,qy,qz,qw,{names}\n0,0,0,{s},{s},0.1,0.2,0.3\n");
        let [row] = rows(&text, &[])[..] else {
            panic!()
        };
        let omega = Vector3::from(row.omega.unwrap());
        assert!(
            (omega - Vector3::new(-0.2, 0.1, 0.3)).norm() < 1e-15,
            "{names}: {omega}"
        );
        let report = read(&text).1;
        assert!(
            said(&report, "assumed").contains("along the body's axes"),
            "{report}"
        );
        // And not, where it is said otherwise.
        let [row] = rows(&text, &["omega=:world"])[..] else {
            panic!()
        };
        assert_eq!(row.omega, Some([0.1, 0.2, 0.3]));
    }
    let text =
        format!("time,x,y,z,qx,qy,qz,qw,fx,fy,fz,px,py,pz\n0,1,1,1,0,0,{s},{s},1,0,0,0,2,0\n");
    let [row] = rows(&text, &["force=:body", "point=:body"])[..] else {
        panic!()
    };
    let near = |v: Option<[f64; 3]>, w: [f64; 3]| {
        (Vector3::from(v.unwrap()) - Vector3::from(w)).norm() < 1e-15
    };
    assert!(
        near(row.force, [0.0, 1.0, 0.0]) && near(row.point, [-1.0, 1.0, 1.0]),
        "{row:?}"
    );
}

#[test]
fn json_lines_are_read_as_tables_are() {
    let text = r#"
{"time": 0.0, "body": "box", "position": [1, 2, 3], "orientation": {"x": 0, "y": 0, "z": 0.6, "w": 0.8}, "omega": [0.1, 0.2, 0.3]}
{"time": 0.1, "body": "box", "position": [1, 2, 4], "orientation": {"x": 0, "y": 0, "z": 0.6, "w": 0.8}, "omega": [0.1, 0.2, 0.3], "force": [0, 0, 5], "point": [1, 2, 4]}
{"time": 0.2, "body": "box", "position": [1, 2, 5], "orientation": {"x": 0, "y": 0, "z": 0.6, "w": 0.8}, "omega": [0.1, 0.2, 0.3]}
"#;
    let (log, report) = read(text);
    let rows = &log.bodies[0].rows;
    assert_eq!(rows.times, [0.0, 0.1, 0.2]);
    assert_eq!(rows.attitudes, [[0.0, 0.0, 0.6, 0.8]; 3]);
    // A key that comes later is read from there on, and nothing acts where it is absent.
    assert_eq!(rows.forces, [[0.0; 3], [0.0, 0.0, 5.0], [0.0; 3]]);
    assert_eq!(rows.points[1], [1.0, 2.0, 4.0]);
    assert_eq!(codes(&report), ["nothing-acts"]);
    // What a later row brings must not turn what was read into something else.
    let why = refused(
        "{\"t\": 0, \"p\": [0, 0, 0], \"q\": [1, 0, 0, 0]}\n{\"t\": 1, \"p\": [0, 0, 0], \"q\": [1, 0, 0, 0], \"pos\": [0, 0, 0], \"f\": [0, 0, 0]}\n",
        &[],
    );
    assert_eq!(
        why,
        "log:2: position was p[0],p[1],p[2] so far, and with what this row adds it may be something else; say which: --map position=p[0],p[1],p[2]"
    );
}

#[test]
fn every_digit_of_a_number_is_read() {
    let mut state = 1_u64;
    for _ in 0..2000 {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        // Any finite number of the exponents that logs have.
        let x = f64::from_bits((state >> 12) | (1013 + (state % 20)) << 52);
        for text in [
            format!("t,wx,wy,wz\n0,{x:?},0,0\n"),
            format!("{{\"t\":0,\"w\":[{x:?},0,0]}}\n"),
        ] {
            assert_eq!(rows(&text, &[])[0].omega, Some([x, 0.0, 0.0]), "{text}");
        }
    }
}

#[test]
fn what_may_be_two_things_is_asked_for() {
    for (header, mappings, wanted) in [
        (
            "time,qx,qy,qz,qw,wx,wy,wz,omega_x,omega_y,omega_z",
            &[][..],
            "log:1: omega may be wx,wy,wz or omega_x,omega_y,omega_z; say which: --map omega=wx,wy,wz",
        ),
        (
            "t,orientation[0],orientation[1],orientation[2],orientation[3],wx,wy,wz",
            &[],
            "log:1: orientation[0],orientation[1],orientation[2],orientation[3] may be x, y, z, w or w, x, y, z: numbers do not say where the scalar is; say it: --map attitude=orientation[0],orientation[1],orientation[2],orientation[3]:wxyz, or :xyzw",
        ),
        (
            "t,tx,ty,tz,qx,qy,qz,qw",
            &[],
            "log:1: tx,ty,tz may be a torque, or a translation: no other column is a position; say which: --map torque=tx,ty,tz or --map position=tx,ty,tz",
        ),
        (
            "t,qx,qy,qz,qw,fx,fy,fz,px,py,pz",
            &[],
            "log:1: px,py,pz may be the position, or where the force acts; say which: --map position=px,py,pz or --map point=px,py,pz",
        ),
        (
            "t,x,y,z,w,wx,wy,wz",
            &[],
            "log:1: x,y,z,w may be an attitude, or x,y,z a position; say which: --map attitude=x,y,z,w:xyzw or --map position=x,y,z",
        ),
        (
            "time,timestamp,wx,wy,wz",
            &[],
            "log:1: time may be time or timestamp; say which: --map time=time",
        ),
        (
            "frame,wx,wy,wz",
            &[],
            "log:1: no column is recognised as the time; name it: --map time=COLUMN; the columns are frame, wx, wy, wz",
        ),
        (
            "t,roll,pitch,yaw",
            &[],
            "log:1: no columns are recognised as an attitude or an angular velocity: roll, pitch and yaw are of no agreed order; turn them into a quaternion where they are logged, and log that",
        ),
        (
            "t,qx,qy,qz",
            &[],
            "log:1: no columns are recognised as an attitude or an angular velocity: of the four of a quaternion there are 3; name all: --map attitude=A,B,C,D:xyzw; the columns are t, qx, qy, qz",
        ),
        (
            "t,p,q,r",
            &[],
            "log:1: omega (p,q,r) is along the body's axes, and no column is an attitude to turn it by; name the attitude: --map attitude=…, or leave it out: --map omega=none",
        ),
        (
            "t,wx,wy,wz",
            &["omega=first,b,c"],
            "log:1: omega=first,b,c: there is no column `first`; known here: t, wx, wy, wz",
        ),
        (
            "t,wx,wy,wz",
            &["omega=wx,wy,wz", "omega=:deg/s"],
            "log:1: omega is mapped twice; keep one",
        ),
        (
            "t,wx,wy,wz",
            &["force=:body"],
            "log:1: force=:body: no column is recognised as force, world, N; name them: --map force=…; the columns are t, wx, wy, wz",
        ),
    ] {
        assert_eq!(refused(&format!("{header}\n"), mappings), wanted);
    }
}

#[test]
fn a_mapping_settles_it() {
    let header = "frame,a,b,c,d,omega_x,omega_y,omega_z,wx,wy,wz";
    let text = format!("{header}\n250,0.8,0,0,0.6,90,0,0,7,7,7\n");
    let row = rows(
        &text,
        &[
            "time=frame:ms",
            "attitude=a,b,c,d:wxyz:conjugated",
            "omega=omega:deg/s:body",
        ],
    )[0];
    assert_eq!(row.time, 0.25);
    assert_eq!(row.attitude, Some([-0.0, -0.0, -0.6, 0.8]));
    // About its own x, a quarter turn a second; R = (x, y, z, w) = (0, 0, -0.6, 0.8) takes x to (0.28, -0.96, 0).
    let omega = Vector3::from(row.omega.unwrap());
    let wanted = Vector3::new(0.28, -0.96, 0.0) * std::f64::consts::FRAC_PI_2;
    assert!((omega - wanted).norm() < 1e-15, "{omega}");
    // By number, by beginning, and nothing.
    let row = rows(&text, &["time=#1", "attitude=none", "omega=#9,#10,#11"])[0];
    assert_eq!(
        (row.time, row.attitude, row.omega),
        (250.0, None, Some([7.0; 3]))
    );
    let orientation = "t,orientation[0],orientation[1],orientation[2],orientation[3]\n0,1,0,0,0\n";
    let row = rows(orientation, &["attitude=orientation:wxyz"])[0];
    assert_eq!(row.attitude, Some([0.0, 0.0, 0.0, 1.0]));
    let row = rows(orientation, &["attitude=:xyzw"])[0];
    assert_eq!(row.attitude, Some([1.0, 0.0, 0.0, 0.0]));
}

#[test]
fn bad_rows_are_told_and_the_rest_is_kept() {
    let text = "time,body,qx,qy,qz,qw,wx,wy,wz\n\
        0,a,0,0,0,1,1,0,0\n\
        0.1,a,0,0,0,abc,1,0,0\n\
        0.2,a,0,0,0,1,nan,0,0\n\
        0.3,a,0,0,0,0,1,0,0\n\
        0.4,a,0,0,0,1\n\
        ,a,0,0,0,1,1,0,0\n\
        0.5,,0,0,0,1,1,0,0\n\
        0.6,a,0,0,0,1,1,,0\n\
        0.7,a,0,0,0,1,1,0,0\n\
        0.65,a,0,0,0,1,1,0,0\n\
        0.8,a,0,0,0,\"0,5\",1,0,0\n\
        \n\
        0.9,a,0,0,0,1,1,0,0";
    let (log, report) = read(text);
    assert_eq!(log.bodies[0].rows.times, [0.0, 0.7, 0.9]);
    let told: Vec<String> = report.told.iter().map(|row| row.told("log")).collect();
    assert_eq!(
        told,
        [
            "log:3: column 6 (qw): `abc` is no number",
            "log:4: column 7 (wx): `nan` is not finite",
            "log:5: column 3 (qx): the quaternion is zero, which is no attitude",
            "log:6: has 6 fields, the header 9",
            "log:7: column 1 (time): is empty: a row has a time",
            "log:8: column 2 (body): is empty: whose row is it?",
            "log:9: column 8 (wy): is empty where column 7 is not",
            "log:11: column 1 (time): the time of `a` goes back to 0.65 s from 0.7 s, line 10",
            "log:12: column 6 (qw): `0,5` is no number: it has a comma for a point",
        ]
    );
    assert_eq!(report.count(Bad::Missing), 3);
    assert_eq!((report.rows, report.left_out()), (3, 9));
    let text = report.to_string();
    assert!(text.contains("log: 2 of 12 rows with something that is no number: left out; write digits with a point"), "{text}");

    // Told up to a few of a kind, all counted.
    let mut text = "t,wx,wy,wz\n".to_owned();
    for k in 0..1000 {
        writeln!(text, "{k},x,0,0").unwrap();
    }
    text += "1000,1,0,0\n";
    let (_, report) = read(&text);
    assert_eq!(report.told.len() as u64, Report::TOLD);
    assert_eq!(report.count(Bad::NotANumber), 1000);
}

/// What brings no number, too much, or comes late.
#[test]
fn rows_that_say_nothing_and_rows_that_say_more_are_no_harm() {
    let row = "{\"t\":0,\"qx\":0,\"qy\":0,\"qz\":0,\"qw\":1}\n";
    // The first rows have no columns at all.
    for first in ["{}\n", "{\"a\":{}}\n", "{}\n{\"a\":[]}\n"] {
        let (log, report) = read(&format!("{first}{row}"));
        assert_eq!(log.bodies[0].rows.len(), 1, "{first}");
        assert!(report.left_out() > 0, "{first}");
    }
    // One row with too many fields makes none of the others wrong.
    let many: Vec<String> = (0..5000).map(|k| format!("\"k{k}\":{k}")).collect();
    let (log, report) = read(&format!("{{{}}}\n{row}", many.join(",")));
    assert_eq!(log.bodies[0].rows.len(), 1);
    assert_eq!(report.count(Bad::TooLong), 1);
    // Whose axes it is in is known when the column comes.
    let turned = |extra: &str| {
        format!(
            "{{\"t\":1,\"qx\":0,\"qy\":0,\"qz\":0.7071067811865476,\"qw\":0.7071067811865476{extra}}}\n"
        )
    };
    let gyro = ",\"gyro_x\":1,\"gyro_y\":0,\"gyro_z\":0";
    let rows = rows(&format!("{row}{}", turned(gyro)), &[]);
    let omega = rows[1].omega.unwrap();
    // Turned by a quarter about z; the rounding of two products.
    assert!(
        (omega[0].abs() + (omega[1] - 1.0).abs()) < 1e-15,
        "{omega:?}"
    );
}

/// Time that no number counts.
#[test]
fn times_are_finite() {
    let text = "header.stamp.sec,header.stamp.nanosec,qx,qy,qz,qw\n\
        1.7976931348623157e308,1.7976931348623157e308,0,0,0,1\n2,0,0,0,0,1\n";
    let (log, report) = read(text);
    assert_eq!(report.count(Bad::NotFinite), 1);
    assert!(log.bodies[0].rows.times.iter().all(|t| t.is_finite()));
    let (log, _) = read("t,qx,qy,qz,qw\n-1.7e308,0,0,0,1\n1.7e308,0,0,0,1\n");
    assert!(log.bodies[0].rows.times.iter().all(|t| t.is_finite()));
}

#[test]
fn bad_lines_of_json_are_told_where_they_are() {
    let text = "{\"t\": 0, \"w\": [1, 0, 0]}\n\
        {\"t\": 1, \"w\": [NaN, 0, 0]}\n\
        {\"t\": 2, \"w\": [1, 0, 0]\n\
        [1, 2]\n\
        {\"t\": \"x\", \"w\": [1, 0, 0]}\n\
        {\"t\": 3, \"w\": [1, 0]}\n\
        {\"t\": 4, \"w\": [1, 0, 0]}\n";
    let (log, report) = read(text);
    assert_eq!(log.bodies[0].rows.times, [0.0, 4.0]);
    let told: Vec<String> = report.told.iter().map(|row| row.told("log")).collect();
    assert_eq!(
        told,
        [
            "log:2: NaN or Infinity at character 16, which is no number",
            "log:3: is no JSON object: EOF while parsing an object, at character 23",
            "log:4: is no JSON object: it is something else, at character 1",
            "log:5: column 1 (t): `x` is no number",
            "log:6: column 4 (w[2]): is empty where column 2 is not",
        ]
    );
}

#[test]
fn files_of_another_kind_are_called_by_their_name() {
    for (bytes, wanted) in [
        (
            &b"\x89PNG\r\n\x1a\n\0\0\0"[..],
            "log: is a picture (PNG), not a log; a log is a table (CSV) or an object a line (JSON lines)",
        ),
        (
            b"RRF2\0\0\0\0",
            "log: is a recording of Rerun, not a log; look into it: torquescope inspect",
        ),
        (
            b"\x1f\x8b\x08\0",
            "log: is packed (gzip), not a log; unpack it: gunzip -c FILE",
        ),
        (
            b"ULog\x01\x12\x35",
            "log: is a ULog file of PX4, not a log; turn it into CSV first: docs/logs.md says how",
        ),
        (
            b"title = \"x\"\nduration = 1\n",
            "log: is TOML: a scene, or a file of bodies, not a log; a scene is run: torquescope run; bodies are given beside a log",
        ),
        (
            b"# bodies\n[body.box]\nmass = 1\n",
            "log: is TOML: a scene, or a file of bodies, not a log; a scene is run: torquescope run; bodies are given beside a log",
        ),
        (
            b"<robot name=\"r\"/>",
            "log: is XML or HTML, not a log; a robot's description is given beside a log, not as one",
        ),
        (
            b"\xff\xfet\0i\0",
            "log: is text in UTF-16, not a log; save it as UTF-8",
        ),
        (
            b"a\x00b\x01\n",
            "log: is not text, not a log; a log is a table (CSV) or an object a line (JSON lines)",
        ),
        (
            b"",
            "log: is empty, not a log; a log begins with the names of its columns: time,body,x,y,z,qx,qy,qz,qw,wx,wy,wz",
        ),
        (
            b"0,1,2,3\n",
            "log: is a table without a header, not a log; a log begins with the names of its columns: time,body,x,y,z,qx,qy,qz,qw,wx,wy,wz",
        ),
        (
            b"t wx wy wz\n0 1 2 3\n",
            "log: is a table with blanks between its columns, not a log; put commas there: tr -s ' ' ',' < FILE",
        ),
        (b"t,wx,wy,wz\n", "log: has no rows"),
    ] {
        let why = Log::read("log", bytes, Options::default()).unwrap_err();
        assert_eq!(why.to_string(), wanted);
    }
    let why = refused("t,wx,wy,wz\n0,a,0,0\n", &[]);
    assert!(
        why.starts_with("log:2: column 2 (wx): `a` is no number\n"),
        "{why}"
    );
    assert!(why.ends_with("log: has no row that can be read"), "{why}");
}

#[test]
fn times_that_jump_repeat_or_come_late_are_said() {
    let mut text = "t,body,wx,wy,wz\n".to_owned();
    for k in 0..40 {
        let t = f64::from(k) * 0.01 + if k >= 30 { 1.0 } else { 0.0 };
        writeln!(text, "{t:?},a,{k},0,0").unwrap();
        if k == 20 {
            writeln!(text, "{t:?},a,77,0,0").unwrap();
        }
        if k >= 10 {
            writeln!(text, "{t:?},b,1,0,0").unwrap();
        }
    }
    text += "2,c,1,0,0\n";
    let (log, report) = read(&text);
    assert_eq!(log.bodies[0].rows.len(), 40);
    // Of one instant the last row is kept.
    assert_eq!(log.bodies[0].rows.omegas[20], [77.0, 0.0, 0.0]);
    assert_eq!(
        report.to_string(),
        "log:53: a: time jumps (1 such row) by 1.01 s at most, where rows are 1.000e-2 s apart\n\
         log:54: b: time jumps (1 such row) by 1.01 s at most, where rows are 1.000e-2 s apart\n\
         log:33: a: a row has the time of the row before (1 such row); of one instant the last row counts for the step that follows\n\
         log:13: b: appears 0.1 s after the first body\n\
         log:73: c: appears 2 s after the first body\n\
         log:73: c: has one row, from which nothing moves"
    );
}

#[test]
fn large_times_keep_what_is_between_rows() {
    // 1,700,000,000 s as an f64 is good to 2.4e-7 s; rows are a millisecond apart to the last digit.
    for (header, unit) in [
        ("timestamp_ns", ""),
        ("header.stamp.sec,header.stamp.nanosec", ","),
        ("timestamp", "."),
    ] {
        let mut text = format!("{header},wx,wy,wz\n");
        for k in 0..100 {
            writeln!(
                text,
                "1700000000{unit}{:09},1,0,0",
                123_456_789 + k * 1_000_000
            )
            .unwrap();
        }
        let (log, report) = read(&text);
        for (k, time) in log.bodies[0].rows.times.iter().enumerate() {
            assert!(
                (time - 1e-3 * k as f64).abs() < 1e-16,
                "{header} {k}: {time}"
            );
        }
        assert!(
            said(&report, "time-origin").contains("1700000000.123"),
            "{report}"
        );
    }
}

#[test]
fn columns_that_are_swapped_are_noticed() {
    let motion = Motion::tumbling();
    let mut text = "time,step,qx,qy,qz,qw,x,y,z,wx,wy,wz,sx\n".to_owned();
    for k in 0..60 {
        let (t, q, omega) = motion.at(k);
        let (x, y, z, w) = (q.i, q.j, q.k, q.w);
        writeln!(
            text,
            "0,{t:?},{x:?},{y:?},{z:?},1,2,3,{w:?},{:?},{:?},{:?},0",
            omega.x, omega.y, omega.z
        )
        .unwrap();
    }
    // w has come to where z is, and nothing of four numbers side by side is of length one: told, without a guess.
    let (_, report) = read(&text);
    assert!(
        said(&report, "quaternion-length").contains("60 of 60 quaternions are not of length one"),
        "{report}"
    );

    let mut text = "time,qx,qy,qz,qw,x,y,z,wx,wy,wz\n".to_owned();
    for k in 0..60 {
        let (t, q, omega) = motion.at(k);
        let (x, y, z, w) = (q.i, q.j, q.k, q.w);
        writeln!(
            text,
            "{t:?},5,6,7,{x:?},{y:?},{z:?},{w:?},{:?},{:?},{:?}",
            omega.x, omega.y, omega.z
        )
        .unwrap();
    }
    let (_, report) = read(&text);
    assert!(said(&report, "columns-swapped").ends_with("columns 5 to 8 (qw, x, y, z) are of length one in every row: if they are the attitude, --map attitude=#5,#6,#7,#8:xyzw"), "{report}");

    let mut text = "time,t_ms,wx,wy,wz\n".to_owned();
    for k in 0..60 {
        writeln!(text, "{},{k},1,0,0", 60 - k).unwrap();
    }
    let (_, report) = read_with(&text, &["time=time"]);
    assert_eq!(
        said(&report, "columns-swapped"),
        "log: 59 rows go back in time, and column 2 (t_ms) grows; if that is the time: --map time=#2"
    );
}

/// A free body's attitude and angular velocity, by RK4 with ten steps a row on Euler's equations in body axes: no
/// code of the crate.
struct Motion {
    rows: Vec<(f64, UnitQuaternion<f64>, Vector3<f64>)>,
}

impl Motion {
    fn tumbling() -> Self {
        Self::of(
            Vector3::new(1.0, 2.0, 3.0),
            Vector3::new(0.4, 3.0, 0.7),
            0.01,
            600,
        )
    }

    /// Moments, angular velocity along the body's axes, interval of rows and their number.
    fn of(i: Vector3<f64>, mut w: Vector3<f64>, interval: f64, count: usize) -> Self {
        let rate = |w: Vector3<f64>| -> Vector3<f64> {
            Vector3::new(
                (i.y - i.z) * w.y * w.z / i.x,
                (i.z - i.x) * w.z * w.x / i.y,
                (i.x - i.y) * w.x * w.y / i.z,
            )
        };
        let h = interval / 10.0;
        let mut q = UnitQuaternion::from_euler_angles(0.3, -0.5, 0.9);
        let mut rows = Vec::new();
        for k in 0..count {
            rows.push((k as f64 * interval, q, q * w));
            for _ in 0..10 {
                let k1 = rate(w);
                let k2 = rate(w + k1 * (h / 2.0));
                let k3 = rate(w + k2 * (h / 2.0));
                let k4 = rate(w + k3 * h);
                let next = w + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
                q *= UnitQuaternion::from_scaled_axis((w + next) * (h / 2.0));
                w = next;
                q.renormalize();
            }
        }
        Self { rows }
    }

    fn at(&self, k: usize) -> (f64, UnitQuaternion<f64>, Vector3<f64>) {
        self.rows[k]
    }

    /// As a log in the contract's columns, its numbers made by `write`: time, (x, y, z, w), omega along both axes.
    fn log(
        &self,
        write: impl Fn(f64, [f64; 4], Vector3<f64>, Vector3<f64>) -> (f64, [f64; 4], Vector3<f64>),
    ) -> String {
        let mut text = "time,qx,qy,qz,qw,wx,wy,wz\n".to_owned();
        for &(t, q, w) in &self.rows {
            let (t, [a, b, c, d], w) = write(t, [q.i, q.j, q.k, q.w], w, q.inverse() * w);
            writeln!(
                text,
                "{t:?},{a:?},{b:?},{c:?},{d:?},{:?},{:?},{:?}",
                w.x, w.y, w.z
            )
            .unwrap();
        }
        text
    }
}

#[test]
fn conventions_are_found_told_and_applied_only_where_asked() {
    let motion = Motion::tumbling();
    let plain = motion.log(|t, q, w, _| (t, q, w));
    type Case = (&'static str, String, &'static str);
    let cases: [Case; 7] = [
        (
            "scalar first",
            motion.log(|t, [x, y, z, w], o, _| (t, [w, x, y, z], o)),
            "--map attitude=qx,qy,qz,qw:wxyz",
        ),
        (
            "world to body",
            motion.log(|t, [x, y, z, w], o, _| (t, [-x, -y, -z, w], o)),
            "--map attitude=:conjugated",
        ),
        (
            "body axes",
            motion.log(|t, q, _, o| (t, q, o)),
            "--map omega=:body",
        ),
        (
            "degrees",
            motion.log(|t, q, o, _| (t, q, o * (180.0 / std::f64::consts::PI))),
            "--map omega=:deg/s",
        ),
        (
            "milliseconds",
            motion.log(|t, q, o, _| (t * 1e3, q, o)),
            "--map time=:ms",
        ),
        (
            "turns a minute",
            motion.log(|t, q, o, _| (t, q, o * (30.0 / std::f64::consts::PI))),
            "--map omega=:rpm",
        ),
        (
            "scalar first, body axes and microseconds",
            motion.log(|t, [x, y, z, w], _, o| (t * 1e6, [w, x, y, z], o)),
            "--map attitude=qx,qy,qz,qw:wxyz --map omega=:body --map time=:us",
        ),
    ];
    let (right, report) = read(&plain);
    assert!(
        said(&report, "conventions").contains("belong together as declared"),
        "{report}"
    );
    for (name, text, remedy) in cases {
        // Told, and nothing changed.
        let (as_declared, report) = read(&text);
        let told = said(&report, "conventions-differ");
        assert!(
            told.ends_with(&format!("; read as declared; if so: {remedy}")),
            "{name}: {told}"
        );
        let first: Vec<f64> = text
            .lines()
            .nth(2)
            .unwrap()
            .split(',')
            .map(|x| x.parse().unwrap())
            .collect();
        assert_eq!(as_declared.bodies[0].rows.times[1], first[0], "{name}");
        assert_eq!(
            as_declared.bodies[0].rows.attitudes[1],
            first[1..5],
            "{name}"
        );
        assert_eq!(as_declared.bodies[0].rows.omegas[1], first[5..8], "{name}");
        // Applied where asked for, and where the remedy is followed.
        let mappings: Vec<&str> = remedy
            .split("--map ")
            .map(str::trim)
            .filter(|m| !m.is_empty())
            .collect();
        let by_mapping = read_with(&text, &mappings);
        let options = Options {
            reading: Reading::AsFound,
            ..Options::default()
        };
        let by_finding = Log::read("log", text.as_bytes(), options).unwrap();
        for (log, report) in [by_mapping, by_finding] {
            assert!(
                !codes(&report).contains(&"conventions-none-fit"),
                "{name}: {report}"
            );
            let (rows, wanted) = (&log.bodies[0].rows, &right.bodies[0].rows);
            assert_eq!(rows.len(), wanted.len());
            for k in 0..rows.len() {
                // Units that are turned round-trip to a few roundings of numbers up to 6.
                let apart =
                    |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 5e-15);
                assert!(
                    apart(&rows.attitudes[k], &wanted.attitudes[k]),
                    "{name} {k}"
                );
                assert!(apart(&rows.omegas[k], &wanted.omegas[k]), "{name} {k}");
                assert!(apart(&[rows.times[k]], &[wanted.times[k]]), "{name} {k}");
            }
        }
    }
    // What counts its numbers as ULog does, and is not so.
    let text = plain.replacen("qx,qy,qz,qw", "q[0],q[1],q[2],q[3]", 1);
    let (_, report) = read(&text);
    assert!(
        said(&report, "conventions-differ").ends_with("--map attitude=q[0],q[1],q[2],q[3]:xyzw"),
        "{report}"
    );
}

#[test]
fn noise_hides_no_convention_and_makes_none_up() {
    let motion = Motion::of(
        Vector3::new(1.0, 2.0, 3.0),
        Vector3::new(0.4, 3.0, 0.7),
        0.005,
        2000,
    );
    // 1% of omega and 0.2° of attitude, by a generator of its own (splitmix64, sums of twelve).
    let mut state = 7_u64;
    let mut unit = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut normal = move || (0..12).map(|_| unit()).sum::<f64>() - 6.0;
    let mut noisy = Motion { rows: Vec::new() };
    for &(t, q, w) in &motion.rows {
        let mut vector = |size: f64| Vector3::new(normal(), normal(), normal()) * size;
        let q = UnitQuaternion::from_scaled_axis(vector(0.2_f64.to_radians())) * q;
        noisy.rows.push((t, q, w + vector(0.01 * w.norm())));
    }
    let (_, report) = read(&noisy.log(|t, q, w, _| (t, q, w)));
    assert!(
        said(&report, "conventions").contains("as declared"),
        "{report}"
    );
    let (_, report) = read(&noisy.log(|t, q, _, w| (t, q, w)));
    assert!(
        said(&report, "conventions-differ").ends_with("--map omega=:body"),
        "{report}"
    );
}

#[test]
fn what_cannot_be_told_is_not_told() {
    let found = |text: &str| {
        let mut reader = Reader::new("log", text.as_bytes(), Options::default()).unwrap();
        while reader.next_row().unwrap().is_some() {}
        reader.conventions()[0].1.clone()
    };
    // About one axis of a body that starts along the world's both axes are one: as declared, with what else it may be.
    let mut spin = Motion { rows: Vec::new() };
    for k in 0..200 {
        let t = 0.01 * f64::from(k);
        let axis = Vector3::z() * 3.0;
        spin.rows
            .push((t, UnitQuaternion::from_scaled_axis(axis * t), axis));
    }
    let spun = found(&spin.log(|t, q, w, _| (t, q, w))).unwrap();
    assert_eq!(spun.verdict(), Verdict::AsDeclared);
    let frames: Vec<Frame> = spun
        .fitting
        .iter()
        .map(|fit| fit.conventions.frame)
        .collect();
    assert_eq!(frames, [Frame::World, Frame::Body]);
    // At rest, without omega, too fast, too short.
    let still = |w: f64| {
        let mut text = "t,qx,qy,qz,qw,wx,wy,wz\n".to_owned();
        (0..100).for_each(|k| writeln!(text, "{k},0,0,0,1,{w},0,0").unwrap());
        text
    };
    assert_eq!(found(&still(0.0)), Err(CannotTell::TooFew(1)));
    assert_eq!(
        found(&Motion::tumbling().log(|t, q, w, _| (t, q, w * 0.0))),
        Err(CannotTell::NoOmega)
    );
    let fast = Motion::of(
        Vector3::new(1.0, 1.5, 2.0),
        Vector3::new(0.0, 200.0, 0.1),
        0.01,
        60,
    );
    assert!(
        matches!(found(&fast.log(|t, q, w, _| (t, q, w))), Err(CannotTell::Aliased(turn)) if turn > 1.6)
    );
    // Attitudes and omegas of two different motions belong together by nothing.
    let other = Motion::of(
        Vector3::new(3.0, 1.0, 2.5),
        Vector3::new(-2.0, 0.3, 1.0),
        0.01,
        600,
    );
    let mut mixed = Motion::tumbling();
    for (row, other) in mixed.rows.iter_mut().zip(&other.rows) {
        row.2 = other.2;
    }
    let mixed = found(&mixed.log(|t, q, w, _| (t, q, w))).unwrap();
    assert_eq!(mixed.verdict(), Verdict::NoneFits, "{mixed}");
    // A search that finds an order finds the right one.
    let rotated = Motion::tumbling().log(|t, [x, y, z, w], o, _| (t, [w, x, y, z], o));
    assert_eq!(
        found(&rotated).unwrap().best.conventions.order,
        Order::ScalarFirst
    );
}

#[test]
fn a_recording_that_was_exported_comes_back() {
    // As docs/inspecting.md says: `recording`, `body`, `sim_time` and every number; empty where it is not known. A push
    // of (0, -10, 0) N at (2, 0, 0) from a body at the origin: (0, 0, -20) N m of the torque are the force's.
    let text = "recording,body,sim_time,position.x,position.y,position.z,orientation.x,orientation.y,orientation.z,orientation.w,velocity.x,velocity.y,velocity.z,force.x,force.y,force.z,force_point.x,force_point.y,force_point.z,torque.x,torque.y,torque.z,angular_acceleration.x,angular_acceleration.y,angular_acceleration.z,angular_velocity.x,angular_velocity.y,angular_velocity.z,kinetic_energy,torque_by_gravity.x,torque_by_gravity.y,torque_by_gravity.z\n\
        1,top,0.0,0.0,0.0,0.0,0.0,0.0,0.6,0.8,1.0,0.0,0.0,,,,,,,1.0,2.0,3.0,0.1,0.2,0.3,0.4,0.5,0.6,1.5,0.0,0.0,0.0\n\
        1,top,0.001,,,,,,,,,,,,,,,,,,,,,,,0.41,0.5,0.6,,,,\n\
        1,top,0.1,0.0,0.0,0.0,0.0,0.0,0.6,0.8,1.0,0.0,0.0,,,,,,,1.0,2.0,3.0,0.1,0.2,0.3,0.4,0.5,0.6,1.5,0.0,0.0,0.0\n\
        1,top,0.1,0.0,0.0,0.0,0.0,0.0,0.6,0.8,1.0,0.0,0.0,0.0,-10.0,0.0,2.0,0.0,0.0,1.0,2.0,-17.0,0.1,0.2,0.3,0.45,0.5,0.6,1.5,0.0,0.0,0.0\n\
        2,top,0.0,0.0,0.0,0.0,0.0,0.0,0.6,0.8,1.0,0.0,0.0,,,,,,,1.0,2.0,3.0,0.1,0.2,0.3,0.4,0.5,0.6,1.5,0.0,0.0,0.0\n";
    let (log, report) = read(text);
    let names: Vec<&str> = log.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["top", "top@2"]);
    let rows = &log.bodies[0].rows;
    assert_eq!(rows.times, [0.0, 0.1]);
    assert_eq!(rows.attitudes, [[0.0, 0.0, 0.6, 0.8]; 2]);
    assert_eq!(rows.omegas, [[0.4, 0.5, 0.6], [0.45, 0.5, 0.6]]);
    assert_eq!(rows.velocities, [[1.0, 0.0, 0.0]; 2]);
    assert_eq!(rows.forces, [[0.0; 3], [0.0, -10.0, 0.0]]);
    assert_eq!(rows.points[1], [2.0, 0.0, 0.0]);
    // Torques and forces add up to what was recorded.
    assert_eq!(rows.torques, [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]);
    assert_eq!(
        said(&report, "rows-left-out"),
        "log: top: 1 of 3 rows do not have the whole state and are left out: 1 have no attitude, 1 have no position, 1 have no velocity"
    );
    // Row by row every row is there, both of the instant, as recorded.
    let all = crate::rows(text, &[]);
    assert_eq!(all.len(), 5);
    assert_eq!((all[2].again, all[3].again), (false, true));
    assert_eq!(all[3].torque, Some([1.0, 2.0, -17.0]));
    // And as JSON, where the order of an orientation is the program's own.
    let json = "[\n{\"body\":\"top\",\"recording\":1,\"sim_time\":0.0,\"orientation\":[0.0,0.0,0.6,0.8],\"angular_velocity\":[0.4,0.5,0.6]},\n{\"body\":\"top\",\"recording\":1,\"sim_time\":0.5,\"orientation\":[0.0,0.0,0.6,0.8],\"angular_velocity\":[0.4,0.5,0.6]}\n]\n";
    let (log, _) = read(json);
    assert_eq!(log.bodies[0].rows.attitudes, [[0.0, 0.0, 0.6, 0.8]; 2]);
    assert_eq!(log.bodies[0].rows.times, [0.0, 0.5]);
}

#[test]
fn bodies_are_declared_in_toml() {
    let text = "[body.box]\nmass = 2.0\ninertia = [0.1, 0.2, 0.25]\ncentre_of_mass = [0, 0.1, 0]\nsize = [1, 0.5, 0.4]\n\n[body.\"a b\"]\ninertia = [[1, 0.1, 0], [0.2, 1, 0], [0, 0, 9]]\n";
    let mut bodies = bodies::parse("b.toml", text).unwrap();
    bodies.sort_by(|a, b| b.0.cmp(&a.0));
    assert_eq!(bodies[0].0, "box");
    let declared = &bodies[0].1;
    assert_eq!(declared.mass, Some(2.0));
    assert_eq!(
        declared.inertia_b,
        Matrix3::from_diagonal(&Vector3::new(0.1, 0.2, 0.25))
    );
    assert_eq!(declared.centre_of_mass_b, Vector3::new(0.0, 0.1, 0.0));
    assert_eq!(declared.size, Some(Vector3::new(1.0, 0.5, 0.4)));
    // Impossible ones are kept: they are what is to be found out.
    assert_eq!(bodies[1].0, "a b");
    assert_eq!(bodies[1].1.inertia_b[(0, 1)], 0.1);
    assert_eq!(bodies[1].1.inertia_b[(1, 0)], 0.2);
    assert_eq!((bodies[1].1.mass, bodies[1].1.size), (None, None));
}

#[test]
fn bodies_that_are_wrong_are_told_with_their_place() {
    for (text, wanted) in [
        (
            "[body.box]\nmass = 2.0\ninertia = [1, 2]\n",
            "b.toml:3:11: inertia = [1, 2] must be three moments or three rows of three (kg m², about the centre of mass, body axes)\n  3 | inertia = [1, 2]\n    |           ^^^^^^",
        ),
        (
            "[body.box]\ncenter_of_mass = [0, 0, 0]\ninertia = [1, 1, 1]\nmass = \"1\"\n",
            "b.toml:2:1: unknown key `center_of_mass` in [body.box]; did you mean `centre_of_mass`?\n  2 | center_of_mass = [0, 0, 0]\n    | ^^^^^^^^^^^^^^\nb.toml:4:8: mass = \"1\" is a string, not a number (kg)\n  4 | mass = \"1\"\n    |        ^^^",
        ),
        (
            "[body.box]\nmass = 1\n",
            "b.toml:1:1: [body.box] lacks `inertia`; add three moments or three rows of three, kg m²: inertia = [x, y, z]\n  1 | [body.box]\n    | ^^^^^^^^^^",
        ),
        (
            "[box]\nmass = 1\n",
            "b.toml:1:1: no body is in it; write [body.NAME] with mass and inertia for each\nb.toml:1:2: unknown key `box` in a file of bodies; known here: body\n  1 | [box]\n    |  ^^^",
        ),
    ] {
        assert_eq!(
            bodies::parse("b.toml", text).unwrap_err().to_string(),
            wanted
        );
    }
}

#[test]
fn bodies_come_from_robots_too() {
    let urdf = r#"<robot name="r">
  <link name="box">
    <inertial>
      <origin xyz="0 0.1 0" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/>
    </inertial>
  </link>
  <link name="bare"/>
</robot>"#;
    let (bodies, notes) = bodies::read("r.urdf", urdf.as_bytes()).unwrap();
    assert_eq!(bodies.len(), 1);
    let (name, declared) = &bodies[0];
    assert_eq!((name.as_str(), declared.mass), ("box", Some(2.0)));
    assert_eq!(declared.centre_of_mass_b, Vector3::new(0.0, 0.1, 0.0));
    // A quarter about z changes x and y.
    let wanted = Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 2.5));
    assert!((declared.inertia_b - wanted).norm() < 1e-15);
    assert_eq!(
        notes[0].told("r.urdf"),
        "r.urdf:9: bare: the link says nothing of its inertia: nothing is declared of it"
    );

    let (mut log, _) =
        read("t,body,wx,wy,wz\n0,box,1,0,0\n1,box,1,0,0\n0,other,1,0,0\n1,other,1,0,0\n");
    let notes = log.declare(bodies);
    assert_eq!(log.bodies[0].declared.as_ref().unwrap().mass, Some(2.0));
    assert_eq!(
        notes[0].told("log"),
        "log: other: nothing is declared of its mass and inertia"
    );
    // A log that names no body takes the only one.
    let (mut log, _) = read("t,wx,wy,wz\n0,1,0,0\n1,1,0,0\n");
    let one = bodies::parse("b", "[body.box]\ninertia = [1, 1, 1]\n").unwrap();
    assert!(log.declare(one).is_empty() && log.bodies[0].declared.is_some());
    let none = bodies::parse(
        "b",
        "[body.bax]\ninertia = [1, 1, 1]\n[body.c]\ninertia = [1, 1, 1]\n",
    )
    .unwrap();
    let (mut log, _) = read("t,body,wx,wy,wz\n0,box,1,0,0\n1,box,1,0,0\n");
    let notes = log.declare(none);
    assert_eq!(
        notes[0].told("log"),
        "log: bax: is declared, and the log has no rows of it; did you mean `box`?"
    );
}

#[test]
fn files_that_are_no_bodies_are_told() {
    for (bytes, wanted) in [
        (
            &b"\xff\xfe"[..],
            "b: is not text in UTF-8; bodies are in TOML ([body.NAME]), URDF or MJCF",
        ),
        (
            b"<svg/>",
            "b: describes no robot: its outermost element is <svg>; URDF has <robot>, MJCF <mujoco>",
        ),
    ] {
        assert_eq!(bodies::read("b", bytes).unwrap_err().to_string(), wanted);
    }
}

/// Gives bytes as a program writes them: a row when it is done, and nothing more until it is asked.
struct Piecewise<'a> {
    pieces: std::slice::Iter<'a, &'a [u8]>,
    asked: &'a std::cell::Cell<usize>,
}

impl std::io::Read for Piecewise<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.asked.set(self.asked.get() + 1);
        let Some(piece) = self.pieces.next() else {
            return Ok(0);
        };
        buffer[..piece.len()].copy_from_slice(piece);
        Ok(piece.len())
    }
}

#[test]
fn a_row_is_given_as_soon_as_it_is_written() {
    for pieces in [
        [
            &b"t,wx,wy,wz\n"[..],
            b"0,1,0,0\n",
            b"1,1,0,0\n",
            b"2,1,0,0\n",
        ],
        [
            &b"{\"t\":0,\"w\":[1,0,0]}\n"[..],
            b"{\"t\":1,\"w\":[1,0,0]}\n",
            b"{\"t\":2,\"w\":[1,0,0]}\n",
            b"\n",
        ],
    ] {
        let asked = std::cell::Cell::new(0);
        let pipe = Piecewise {
            pieces: pieces.iter(),
            asked: &asked,
        };
        let mut reader =
            Reader::new("-", std::io::BufReader::new(pipe), Options::default()).unwrap();
        let header = asked.get();
        assert_eq!(header, 1, "columns are known when the first line is there");
        let rows_at = usize::from(reader.format() == Format::Csv(b','));
        for k in 0..3 {
            assert_eq!(reader.next_row().unwrap().unwrap().time, k as f64);
            // No piece beyond the row was asked for.
            assert_eq!(asked.get(), (k + 1 + rows_at).max(1));
        }
    }
}

/// Lines without end, as long as they are asked for.
struct Endless {
    line: Vec<u8>,
    at: usize,
    left: u64,
}

impl std::io::Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let mut written = 0;
        while written < buffer.len() && self.left > 0 {
            buffer[written] = self.line[self.at];
            self.at = (self.at + 1) % self.line.len();
            written += 1;
            self.left -= 1;
        }
        Ok(written)
    }
}

#[test]
fn rows_that_do_not_end_are_refused_in_bounded_memory() {
    // A quote that is never closed, 64 MiB behind it: what is read ends after a megabyte.
    let head = "t,wx,wy,wz\n0,1,0,0\n1,\"1,0,0\n";
    let endless = Endless {
        line: b"2,1,0,0\n".to_vec(),
        at: 0,
        left: 1 << 26,
    };
    let input = std::io::BufReader::new(std::io::Read::chain(head.as_bytes(), endless));
    let mut reader = Reader::new("log", input, Options::default()).unwrap();
    assert_eq!(reader.next_row().unwrap().unwrap().time, 0.0);
    let why = reader.next_row().unwrap_err();
    assert!(matches!(why, LogError::Endless { .. }), "{why}");
    assert_eq!(
        why.to_string(),
        "log:3: a row of more than 1048576 bytes; is there a quote that is not closed?"
    );
    assert!(reader.next_row().unwrap().is_none());
    // A line of JSON without end is left out, and the next is read.
    let mut text = b"{\"t\":0,\"w\":[1,0,0]}\n{\"t\":1,\"a\":\"".to_vec();
    text.extend(std::iter::repeat_n(b'x', 3 << 20));
    text.extend(b"\"}\n{\"t\":2,\"w\":[1,0,0]}\n");
    let (log, report) = Log::read("log", &text[..], Options::default()).unwrap();
    assert_eq!(log.bodies[0].rows.times, [0.0, 2.0]);
    assert_eq!(
        report.told[0].told("log"),
        "log:2: is longer than 1048576 bytes"
    );
}

#[test]
fn progress_is_told_in_bytes() {
    let mut text = "t,wx,wy,wz\n".to_owned();
    (0..50_000).for_each(|k| writeln!(text, "{k},1,0,0").unwrap());
    let mut told = Vec::new();
    Log::read_telling("log", text.as_bytes(), Options::default(), &mut |bytes| {
        told.push(bytes)
    })
    .unwrap();
    assert!(told.len() > 5 && told.is_sorted(), "{told:?}");
    assert_eq!(*told.last().unwrap(), text.len() as u64);
}

#[test]
fn docs_list_the_spellings() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/logs.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let (open, close) = (
        "<!-- spellings: written by tests/logs.rs -->\n",
        "<!-- end of spellings -->",
    );
    let (before, rest) = text
        .split_once(open)
        .expect("the page has a place for the table");
    let (_, after) = rest.split_once(close).expect("and its end");
    let wanted = format!("{before}{open}{}{close}{after}", spellings::markdown());
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&page, &wanted).unwrap();
        return;
    }
    assert_eq!(text, wanted);
}

/// Every spelling of the table, written as a header, is read as what it says.
#[test]
fn every_spelling_is_recognised() {
    for spelling in spellings::SPELLINGS {
        let ends: &[&str] = match (spelling.quantity, &spelling.names) {
            (_, spellings::Names::Exactly(_)) => &[],
            (Quantity::Attitude, _) => &["x", "y", "z", "w"],
            _ => &["x", "y", "z"],
        };
        let lists: Vec<Vec<String>> = match &spelling.names {
            spellings::Names::Exactly(names) => {
                vec![names.iter().map(|n| (*n).to_owned()).collect()]
            }
            spellings::Names::Before(prefixes) | spellings::Names::BeforeScalarFirst(prefixes) => {
                prefixes
                    .iter()
                    .map(|prefix| ends.iter().map(|end| format!("{prefix}_{end}")).collect())
                    .collect()
            }
        };
        for list in lists {
            let mut names: Vec<String> = list.clone();
            // What else a log must have, or this spelling needs to be meant.
            let beside = match spelling.quantity {
                Quantity::Time => "qx qy qz qw",
                Quantity::Attitude => "time pos_x pos_y pos_z",
                Quantity::Point => "time qx qy qz qw x y z fx fy fz",
                Quantity::Torque | Quantity::Force => "time qx qy qz qw pos_x pos_y pos_z",
                _ => "time qx qy qz qw",
            };
            names.extend(beside.split(' ').map(str::to_owned));
            let columns = torquescope::log::columns::Columns::find(&names, &[]);
            let columns = columns.unwrap_or_else(|why| panic!("{list:?}: {why:?}"));
            let found = columns
                .of(spelling.quantity)
                .unwrap_or_else(|| panic!("{list:?}"));
            let at: Vec<usize> = (0..list.len()).collect();
            assert_eq!(found.columns, at, "{list:?}");
            assert_eq!(found.frame, spelling.frame, "{list:?}");
        }
    }
}

/// Whatever comes in: rows and a report, or an error; every row is finite, times grow, and what is said adds up.
fn holds(bytes: &[u8], mappings: &[&str], reading: Reading) {
    let options = Options {
        reading,
        ..options(mappings)
    };
    let mut reader = match Reader::new("log", bytes, options) {
        Ok(reader) => reader,
        Err(why) => {
            assert!(why.to_string().starts_with("log:"), "{why}");
            return;
        }
    };
    let mut times: Vec<f64> = Vec::new();
    let mut rows = 0;
    loop {
        let row = match reader.next_row() {
            Ok(Some(row)) => row,
            Ok(None) => break,
            Err(why) => {
                assert!(why.to_string().starts_with("log:"), "{why}");
                break;
            }
        };
        rows += 1;
        times.resize(times.len().max(row.body + 1), f64::NEG_INFINITY);
        assert!(row.time >= times[row.body], "{row:?}");
        times[row.body] = row.time;
        assert!(reader.body(row.body).is_some());
    }
    let report = reader.report();
    assert_eq!(report.rows, rows);
    assert!(report.told.len() as u64 <= report.left_out());
    let said = report.to_string();
    assert!(
        said.is_empty() || said.lines().all(|line| line.starts_with("log:")),
        "{said}"
    );
    assert!(
        !said.contains(|c: char| c.is_control() && c != '\n'),
        "{said}"
    );
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        holds(&bytes, &[], Reading::AsDeclared);
        let _ = bodies::read("b", &bytes);
    }

    #[test]
    fn any_fields_under_a_header_are_read_or_refused(
        rows in prop::collection::vec(prop::collection::vec("[-+0-9.eE,naNif\"]{0,8}|1e308|-0|0", 7..9), 0..60),
        body in "[a-c]",
    ) {
        let mut text = "t,body,qx,qy,qz,qw,wx,wy,wz\n".to_owned();
        for row in &rows {
            text += &format!("{},{body},{}\n", row[0], row[1..].join(","));
        }
        for reading in [Reading::AsDeclared, Reading::AsFound] {
            holds(text.as_bytes(), &["omega=:body:deg/s"], reading);
        }
    }

    #[test]
    fn numbers_of_any_size_are_searched_without_harm(
        rows in prop::collection::vec(prop::array::uniform8(any::<f64>()), 25..60),
    ) {
        let mut text = "t,qx,qy,qz,qw,wx,wy,wz\n".to_owned();
        for (k, row) in rows.iter().enumerate() {
            let numbers: Vec<String> = row.iter().map(|x| format!("{x:?}")).collect();
            text += &format!("{k},{}\n", numbers[1..].join(","));
        }
        for reading in [Reading::AsDeclared, Reading::AsFound] {
            holds(text.as_bytes(), &[], reading);
        }
    }

    #[test]
    fn any_json_is_read_or_refused(lines in prop::collection::vec("[{}\\[\\]\",:0-9a-ctwqNe. -]{0,40}", 0..20)) {
        let mut text = "{\"t\":0,\"w\":[1,2,3]}\n".to_owned();
        text += &lines.join("\n");
        holds(text.as_bytes(), &[], Reading::AsDeclared);
    }

    #[test]
    fn any_json_may_come_first(lines in prop::collection::vec("[{}\\[\\]\",:0-9a-ctwqNe. -]{0,40}", 0..20)) {
        holds(lines.join("\n").as_bytes(), &[], Reading::AsDeclared);
    }

    #[test]
    fn any_mapping_is_one_or_is_told(text in "[a-z=:,#0-9/]{0,24}") {
        match text.parse::<Mapping>() {
            Ok(mapping) => {
                prop_assert_eq!(mapping.to_string().parse::<Mapping>().unwrap(), mapping);
            }
            Err(why) => prop_assert!(why.to_string().starts_with(&text)),
        }
    }
}
