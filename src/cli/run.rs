//! `run SCENE`: simulate, record, say what happened.

use super::{print, view};
use crate::record::{Heading, Recorder, Scales, Summary};
use crate::scene::{Action, Scene};
use crate::sim::{Blow, Outcome, Simulation};
use crate::trace::{Moment, Subject, short, short_vector};
use serde::Serialize;
use std::path::PathBuf;

/// Simulate a scene and record it.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope run scenes/cone.toml --view")]
pub struct Arguments {
    /// The scene, a TOML file.
    scene: PathBuf,
    /// Where the recording goes [default: the scene's name with .rrd, in the current folder].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Open the recording afterwards, in the viewer that this program carries.
    #[arg(long)]
    view: bool,
    #[command(flatten)]
    serve: view::Serving,
    /// Print one JSON object with every digit instead of tables.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let scene = Scene::load(&arguments.scene)?;
    let path = match &arguments.out {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.rrd", scene.name)),
    };
    let mut simulation = Simulation::new(&scene);
    let subjects = simulation.subjects().to_vec();
    let lasting = || {
        scene
            .events
            .iter()
            .map(|event| event.action.lasts())
            .filter(|&s| s > 0.0)
    };
    let longest = lasting().fold(0.0, f64::max);
    let scales = Scales::new(&subjects, &simulation.expected(), longest);
    let heading = Heading {
        title: &scene.title,
        notes: &scene.notes,
        id: &format!("{}-{:016x}", scene.name, scene.fingerprint),
        duration: scene.duration,
        rate: scene.record.rate,
        shortest_event: lasting().min_by(f64::total_cmp),
        has_pushes: scene
            .events
            .iter()
            .any(|e| matches!(e.action, Action::Push { .. })),
        streams: scene.record.streams,
    };
    let mut recorder = Recorder::create(&path, &heading, &subjects, &scales)?;
    let outcome = simulation.run(&mut recorder);
    // The file is closed whole whatever the run came to.
    let summary = recorder.finish()?;
    let outcome = outcome?;
    if arguments.json {
        print::json(&Report::new(&scene, &subjects, &outcome, &summary))?;
    } else {
        print::out(&tables(&scene, &subjects, &outcome, &summary))?;
    }
    if arguments.view {
        view::serve(&path, &arguments.serve)?;
    }
    Ok(())
}

fn tables(scene: &Scene, subjects: &[Subject], outcome: &Outcome, summary: &Summary) -> String {
    let mut text = format!(
        "{}\nmethod {}, step {} s, {} steps, {} bodies\n",
        scene.title,
        scene.method.info().name,
        scene.step,
        outcome.steps,
        subjects.len()
    );
    if !outcome.blows.is_empty() {
        text += "\nEach blow as it strikes (world axes; torque and inertia about the pivot or the centre of mass)\n";
        let header = [
            "t (s)",
            "body",
            "about its",
            "torque τ (N·m)",
            "inverse inertia I⁻¹ (1/(kg m²))",
            "angular acceleration α (rad/s²)",
        ];
        let rows = outcome
            .blows
            .iter()
            .map(|blow| blow_row(scene, subjects, blow))
            .collect();
        text += &print::table(&header, rows);
        text += "\n";
    }
    text += &format!("\nAt the end, t = {} s\n", scene.duration);
    let header = [
        "body",
        "position (m)",
        "orientation (x, y, z, w)",
        "angular velocity ω (rad/s)",
        "energy (J)",
    ];
    let rows = subjects
        .iter()
        .zip(&outcome.end)
        .map(|(s, m)| end_row(s, m))
        .collect();
    text += &print::table(&header, rows);
    text += &format!(
        "\n\n{}: {} bytes, {} rows\nto open it: torquescope view {}  (or cargo run --release -- view {0})",
        summary.path.display(),
        summary.bytes,
        summary.rows,
        summary.path.display(),
    );
    text
}

fn blow_row(scene: &Scene, subjects: &[Subject], blow: &Blow) -> Vec<String> {
    let event = &scene.events[blow.event];
    let subject = &subjects[event.body];
    let (torque, response) = match blow.jump {
        None => (
            short_vector(blow.moment.tau_w),
            short_vector(blow.moment.alpha_w),
        ),
        Some((angular, turn)) => (
            format!("{} N·m·s", short_vector(angular)),
            format!("Δω {} rad/s", short_vector(turn)),
        ),
    };
    let inverse = blow.moment.inverse_inertia_w(subject);
    let rows: Vec<String> = (0..3)
        .map(|i| inverse.row(i).transpose())
        .map(|row| short_vector(nalgebra::Vector3::new(row[0], row[1], row[2])))
        .collect();
    let what = match event.action {
        Action::Push { .. } => subject.name.clone(),
        Action::Torque { .. } => format!("{} (torque)", subject.name),
        Action::Impulse { .. } => format!("{} (impulse)", subject.name),
        Action::AngularImpulse { .. } => format!("{} (angular impulse)", subject.name),
    };
    vec![
        short(blow.at.time),
        what,
        subject.reference().to_owned(),
        torque,
        rows.join("\n"),
        response,
    ]
}

fn end_row(subject: &Subject, moment: &Moment) -> Vec<String> {
    let motion = &moment.motion;
    let q: Vec<String> = motion.q_wb.coords.iter().map(|&x| short(x)).collect();
    vec![
        subject.name.clone(),
        short_vector(motion.position_w),
        format!("({})", q.join(", ")),
        short_vector(motion.omega_w),
        short(subject.energy(motion)),
    ]
}

/// What `--json` prints. A number that is not finite is null.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    title: &'a str,
    method: &'static str,
    step: f64,
    steps: u64,
    duration: f64,
    blows: Vec<BlowReport<'a>>,
    bodies: Vec<BodyReport<'a>>,
    recording: RecordingReport,
}

#[derive(Serialize)]
struct BlowReport<'a> {
    time: f64,
    body: &'a str,
    torque: [f64; 3],
    inverse_inertia: [[f64; 3]; 3],
    angular_acceleration: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    angular_impulse: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angular_velocity_jump: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct BodyReport<'a> {
    name: &'a str,
    about: &'static str,
    position: [f64; 3],
    velocity: [f64; 3],
    /// x, y, z, w.
    orientation: [f64; 4],
    angular_velocity: [f64; 3],
    angular_momentum: [f64; 3],
    energy: f64,
}

#[derive(Serialize)]
struct RecordingReport {
    path: String,
    bytes: u64,
    rows: u64,
}

impl<'a> Report<'a> {
    fn new(
        scene: &'a Scene,
        subjects: &'a [Subject],
        outcome: &Outcome,
        summary: &Summary,
    ) -> Self {
        let blow = |blow: &Blow| {
            let subject = &subjects[scene.events[blow.event].body];
            BlowReport {
                time: blow.at.time,
                body: &subject.name,
                torque: blow.moment.tau_w.into(),
                inverse_inertia: blow.moment.inverse_inertia_w(subject).into(),
                angular_acceleration: blow.moment.alpha_w.into(),
                angular_impulse: blow.jump.map(|(angular, _)| angular.into()),
                angular_velocity_jump: blow.jump.map(|(_, turn)| turn.into()),
            }
        };
        let body = |(subject, moment): (&'a Subject, &Moment)| BodyReport {
            name: &subject.name,
            about: subject.reference(),
            position: moment.motion.position_w.into(),
            velocity: moment.motion.velocity_w.into(),
            orientation: moment.motion.q_wb.coords.into(),
            angular_velocity: moment.motion.omega_w.into(),
            angular_momentum: subject.momentum_w(&moment.motion).into(),
            energy: subject.energy(&moment.motion),
        };
        Self {
            scene: &scene.name,
            title: &scene.title,
            method: scene.method.info().name,
            step: scene.step,
            steps: outcome.steps,
            duration: scene.duration,
            blows: outcome.blows.iter().map(blow).collect(),
            bodies: subjects.iter().zip(&outcome.end).map(body).collect(),
            recording: RecordingReport {
                path: summary.path.display().to_string(),
                bytes: summary.bytes,
                rows: summary.rows,
            },
        }
    }
}
