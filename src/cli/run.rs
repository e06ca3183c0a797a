//! `run SCENE`: simulate, record, say what happened.

use super::{Wrong, explain, print, view};
use crate::cost::{Plan, PlanError};
use crate::record::{Heading, Recorder, Summary};
use crate::scene::{Action, Event, Scene, Stepping};
use crate::sim::{Blow, Outcome, SimError, Simulation};
use crate::trace::{Sample, Subject, short, short_numbers, short_vector};
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
    /// Print how each body gets through each interval between events: what is active, by which
    /// method and step, the error to be expected and the error there was.
    #[arg(long)]
    explain: bool,
    /// Print one JSON object with every digit instead of tables.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.serve.is_asked_for() && !arguments.view {
        return Err(Wrong("--port and --no-browser say how to view; add --view".to_owned()).into());
    }
    let scene = Scene::load(&arguments.scene)?;
    let path = match &arguments.out {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.rrd", scene.name)),
    };
    let plan = plan(&scene, arguments.explain)?;
    let page = match arguments.view {
        true => Some(view::bind(&path, &arguments.serve)?),
        false => None,
    };
    let simulation = Simulation::new(&scene);
    let subjects = simulation.subjects().to_vec();
    let heading = Heading::of(&scene, &simulation);
    let mut recorder = Recorder::create(&path, &heading, &subjects)?;
    let (outcome, done) = match &plan {
        Some(plan) => simulation.run_by(&mut plan.chooser(), &mut recorder),
        None => simulation.run(&mut recorder),
    };
    if let Err(SimError::Sink(error)) = done {
        // The file itself failed: nothing more can be written to it.
        return Err(error.into());
    }
    // Whatever the run came to, the file is closed whole and what there is of it is told.
    let summary = recorder.finish()?;
    for warning in &outcome.warnings {
        print::err(&format!("warning: {warning}"));
    }
    if arguments.json {
        let mut report = Report::new(&scene, &subjects, &outcome, &summary, done.as_ref().err());
        report.plan = plan.as_ref().map(|plan| explain::report(plan, &subjects));
        print::json(&report)?;
    } else {
        let mut text = tables(&scene, &subjects, &outcome, &summary, done.is_ok());
        if let Some(plan) = &plan {
            text += &explain::table(plan, &subjects);
        }
        print::out(&text)?;
    }
    if let Some(page) = page {
        if let Err(error) = &done {
            print::err(&error.to_string());
        }
        view::serve(&page, &arguments.serve, arguments.json)?;
    }
    done.map_err(|error| anyhow::anyhow!("{error}; everything up to that instant is recorded"))
}

/// A scene that states an accuracy needs a plan; one that states a method has one where the user
/// wants to read it.
fn plan(scene: &Scene, explain: bool) -> anyhow::Result<Option<Plan>> {
    let needed = matches!(scene.stepping, Stepping::Accuracy(_));
    if !needed && !explain {
        return Ok(None);
    }
    let spinner = print::spinner("planning: measuring methods on each interval (ctrl-C stops)");
    let plan = Plan::of(scene);
    spinner.finish_and_clear();
    match plan {
        // What a stated method comes to is recorded, whatever becomes of its explanation.
        Err(error) if !needed => {
            print::err(&format!("nothing to explain: {error}"));
            Ok(None)
        }
        Err(PlanError::Sim(error)) => Err(anyhow::anyhow!(
            "{}: no plan: {error}; nothing is recorded",
            scene.name
        )),
        plan => Ok(Some(plan?)),
    }
}

fn tables(
    scene: &Scene,
    subjects: &[Subject],
    outcome: &Outcome,
    summary: &Summary,
    whole: bool,
) -> String {
    let mut text = format!(
        "{}\nmethod {}, step {} s; steps: {}, bodies: {}\n",
        scene.title,
        scene.stepping.name(),
        scene.step,
        outcome.steps,
        subjects.len()
    );
    if !outcome.blows.is_empty() {
        text += "\nEach event as it begins (world axes; torque and inertia about the pivot, or else the centre of mass)\n";
        let header = [
            "t (s)",
            "body",
            "event",
            "its torque τ (N·m)",
            "inverse inertia I⁻¹ (1/(kg m²))",
            "the body's α (rad/s²)",
        ];
        let rows = outcome
            .blows
            .iter()
            .map(|blow| blow_row(scene, subjects, blow))
            .collect();
        text += &print::table(&header, rows);
        text += "\n";
    }
    text += &match whole {
        true => format!("\nAt the end, t = {} s\n", scene.duration),
        false => format!("\nWhere it stopped, after {} steps\n", outcome.steps),
    };
    let header = [
        "body",
        "position (m)",
        "velocity (m/s)",
        "orientation (x, y, z, w)",
        "angular velocity ω (rad/s)",
        "kinetic energy (J)",
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
        None => (short_vector(blow.tau_w), short_vector(blow.sample.alpha_w)),
        Some(jump) => (
            format!("{} N·m·s", short_vector(jump.angular_impulse_w)),
            format!("Δω {} rad/s", short_vector(jump.omega_w)),
        ),
    };
    let inverse = blow.sample.inverse_inertia_w(subject);
    let rows: Vec<String> = (0..3)
        .map(|i| inverse.row(i).transpose())
        .map(|row| short_vector(nalgebra::Vector3::new(row[0], row[1], row[2])))
        .collect();
    vec![
        short(blow.at.time),
        subject.name.clone(),
        what(event, blow),
        torque,
        rows.join("\n"),
        response,
    ]
}

/// The event in words: the force and where it pushed, in the world.
fn what(event: &Event, blow: &Blow) -> String {
    let lasts = short(event.action.lasts());
    match event.action {
        Action::Push { .. } => match blow.sample.pushes.last() {
            Some(push) => format!(
                "push for {lasts} s\nF {} N\nat {} m",
                short_vector(push.force_w),
                short_vector(push.point_w)
            ),
            None => format!("push for {lasts} s"),
        },
        Action::Torque { .. } => format!("torque for {lasts} s"),
        Action::Impulse { .. } => "impulse".to_owned(),
        Action::AngularImpulse { .. } => "angular impulse".to_owned(),
    }
}

fn end_row(subject: &Subject, sample: &Sample) -> Vec<String> {
    let motion = &sample.motion;
    let q = short_numbers(motion.q_wb.coords.as_slice());
    vec![
        subject.name.clone(),
        short_vector(motion.position_w),
        short_vector(motion.velocity_w),
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
    /// How it was stepped, where that was planned.
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<explain::Report>,
    /// Why it stopped before its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

#[derive(Serialize)]
struct BlowReport<'a> {
    time: f64,
    body: &'a str,
    /// Of everything that acts on the body just after.
    torque: [f64; 3],
    /// Of this event alone.
    own_torque: [f64; 3],
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
        error: Option<&SimError>,
    ) -> Self {
        let blow = |blow: &Blow| {
            let subject = &subjects[scene.events[blow.event].body];
            BlowReport {
                time: blow.at.time,
                body: &subject.name,
                torque: blow.sample.tau_w.into(),
                own_torque: blow.tau_w.into(),
                inverse_inertia: blow.sample.inverse_inertia_w(subject).into(),
                angular_acceleration: blow.sample.alpha_w.into(),
                angular_impulse: blow.jump.map(|jump| jump.angular_impulse_w.into()),
                angular_velocity_jump: blow.jump.map(|jump| jump.omega_w.into()),
            }
        };
        let body = |(subject, sample): (&'a Subject, &Sample)| BodyReport {
            name: &subject.name,
            about: subject.reference(),
            position: sample.motion.position_w.into(),
            velocity: sample.motion.velocity_w.into(),
            orientation: sample.motion.q_wb.coords.into(),
            angular_velocity: sample.motion.omega_w.into(),
            angular_momentum: subject.momentum_w(&sample.motion).into(),
            energy: subject.energy(&sample.motion),
        };
        Self {
            scene: &scene.name,
            title: &scene.title,
            method: scene.stepping.name(),
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
            plan: None,
            error: error.map(ToString::to_string),
        }
    }
}
