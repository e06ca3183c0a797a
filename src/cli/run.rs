//! `run SCENE`: simulate, record, say what happened; of a recording the same again.

use super::stop::Stop;
use super::{Told, Wrong, explain, print, verify, view};
use crate::cost::{Plan, PlanError};
use crate::effect::Profile;
use crate::record::{self, Destination, Heading, Made, Provenance, RecordError, Recorder, Summary};
use crate::scene::{Event, Finding, Scene, SceneError, Script, Stepping};
use crate::sim::{Blow, Outcome, SimError, Simulation, Warning};
use crate::trace::{self, Sample, Subject, short, short_numbers, short_vector};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Simulate a scene and record it.
///
/// A recording is as good as a scene: it holds the text it was made from, and is run again.
#[derive(clap::Args)]
#[command(
    after_help = "Example: torquescope run @cone --view\n         torquescope run scenes/cone.toml --set body.free-A.mass=2 --until 0.5\n         torquescope run cone.rrd --verify"
)]
pub struct Arguments {
    /// The scene, a TOML file, or one that the program carries, such as @cone (`torquescope scenes`); or a
    /// recording of one, an .rrd file.
    pub(super) scene: PathBuf,
    /// Where the recording goes [default: the scene's name with .rrd, in the current folder; of a
    /// recording that is run again its name with -again.rrd].
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// Replace a recording of that name.
    #[arg(long)]
    force: bool,
    /// What may be lost of the last of a recording when the program is killed (s).
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 0.5,
        allow_hyphen_values = true
    )]
    save_every: f64,
    /// Give a value of the scene another, such as body.cone.mass=2, effects.damping.angular=0.1,
    /// event.0.force=[1,0,0]; again for more.
    #[arg(long, value_name = "PATH=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
    /// End the scene at this time instead of its own (s).
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    until: Option<f64>,
    /// Step by this method (`torquescope methods`).
    #[arg(long, value_name = "NAME", conflicts_with = "accuracy")]
    method: Option<String>,
    /// Steps of this length (s).
    #[arg(
        long,
        value_name = "SECONDS",
        allow_hyphen_values = true,
        conflicts_with = "accuracy"
    )]
    step: Option<f64>,
    /// However it is done, keep attitudes this true (rad).
    #[arg(long, value_name = "RADIANS", allow_hyphen_values = true)]
    accuracy: Option<f64>,
    /// Simulated seconds a second at which the recording plays when opened.
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true)]
    pub(super) speed: Option<f64>,
    /// Of a recording: run it again and say whether that gives the same bits, and if not, the
    /// first step, body and quantity that differ. Writes the new run, with a mark there, only
    /// where --out says. Exit code 0: the same; 1: not; 2: it cannot be told.
    #[arg(long)]
    verify: bool,
    /// Open the recording afterwards, in the viewer that this program carries.
    #[arg(long)]
    view: bool,
    #[command(flatten)]
    serve: view::Serving,
    /// Print how each body gets through each interval between events: what is active, by which
    /// method and step, the error to be expected and the error there was.
    #[arg(long)]
    explain: bool,
    /// Print one JSON object with every digit instead of tables; a list of them for a sweep.
    #[arg(long)]
    pub(super) json: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.serve.is_asked_for() && !arguments.view {
        return Err(Wrong("--port and --no-browser say how to view; add --view".to_owned()).into());
    }
    if let Some(speed) = arguments.speed.filter(|x| !(x.is_finite() && *x > 0.0)) {
        return Err(Wrong(format!(
            "--speed {speed:?} is no speed to play at; write a factor above 0, such as 0.5"
        ))
        .into());
    }
    if Duration::try_from_secs_f64(arguments.save_every).is_err() {
        return Err(Wrong(format!(
            "--save-every {:?} is no time; write seconds, such as 0.5",
            arguments.save_every
        ))
        .into());
    }
    let made = made(arguments)?;
    if arguments.verify {
        let Some(made) = &made else {
            let file = arguments.scene.display();
            return Err(Wrong(format!(
                "{file} is a scene; --verify takes a recording of one"
            ))
            .into());
        };
        return verify::run(arguments, made);
    }
    let scenes = scenes(arguments, made.as_ref())?;
    let path = place(arguments, made.is_some(), &scenes[0])?;
    let to = arguments.destination(&path);
    to.check()?;
    print::written_over(&to);
    let stop = Stop::prepare()?;
    let plans = plans(&scenes, arguments.explain)?;
    let page = match arguments.view {
        true => Some(view::bind(&path, &arguments.serve)?),
        false => None,
    };
    let headings = headings(&scenes, arguments, made.is_some());
    let start = |heading: &Heading, subjects: &[Subject]| Recorder::create(&to, heading, subjects);
    let (ran, summary) = record((&scenes, &plans), &headings, &stop, start)?;
    for warning in ran.iter().flat_map(|ran| &ran.outcome.warnings) {
        print::err(&format!("warning: {warning}"));
    }
    if arguments.json {
        report(&scenes, &plans, &ran, &summary)?;
    } else {
        print::out(&texts(&scenes, &plans, &ran, &summary))?;
    }
    let failed: Vec<String> = ran
        .iter()
        .filter_map(|ran| ran.done.as_ref().err().map(ToString::to_string))
        .collect();
    let kept = || {
        format!(
            "{}; everything up to that instant is recorded",
            failed.join("\n")
        )
    };
    if let Some(code) = stop.code() {
        match failed.is_empty() {
            // The signal came after the last step of a scene.
            true => print::err("stopped; what was run is recorded to its end"),
            false => print::err(&kept()),
        }
        let not_run = scenes[ran.len()..].iter();
        let not_run: Vec<&str> = not_run
            .filter_map(|scene| scene.variant.as_deref())
            .collect();
        if !not_run.is_empty() {
            print::err(&format!("not run: {}", not_run.join("; ")));
        }
        return Err(Told(code).into());
    }
    if let Some(page) = page {
        for error in &failed {
            print::err(error);
        }
        view::serve(&page, &arguments.serve, arguments.json)?;
    }
    match failed.is_empty() {
        true => Ok(()),
        false => Err(anyhow::anyhow!(kept())),
    }
}

impl Arguments {
    /// Whether the scene is to be changed.
    pub(super) fn changes(&self) -> bool {
        let numbers = [self.until, self.step, self.accuracy];
        !self.set.is_empty() || self.method.is_some() || numbers.iter().any(Option::is_some)
    }

    /// A recording at some place, on the terms of the command line.
    pub(super) fn destination(&self, path: &Path) -> Destination {
        Destination {
            // What is no time has been refused.
            keeps_up: Duration::try_from_secs_f64(self.save_every).unwrap_or(Duration::MAX),
            ..Destination::new(path).replacing(self.force)
        }
    }

    pub(super) fn views(&self) -> bool {
        self.view
    }

    fn change(&self, script: &mut Script) -> anyhow::Result<()> {
        for assignment in &self.set {
            let argument = format!("--set {assignment}");
            script.set(assignment, &argument).map_err(Wrong)?;
        }
        if let Some(name) = &self.method {
            script.set_method(name, &format!("--method {name}"));
        }
        if let Some(step) = self.step {
            script.set_step(step, &format!("--step {step}"));
        }
        if let Some(accuracy) = self.accuracy {
            script.set_accuracy(accuracy, &format!("--accuracy {accuracy}"));
        }
        if let Some(end) = self.until {
            script.end_at(end, &format!("--until {end}"));
        }
        Ok(())
    }
}

/// What the recording is made from, where it is one that is named.
fn made(arguments: &Arguments) -> anyhow::Result<Option<Made>> {
    let path = &arguments.scene;
    let is_called_one = path.extension().is_some_and(|ending| ending == "rrd");
    match is_called_one || record::is_recording(path) {
        true => Ok(Some(record::read(path)?)),
        false => Ok(None),
    }
}

/// The scenes to run: at least one.
pub(super) fn scenes(arguments: &Arguments, made: Option<&Made>) -> anyhow::Result<Vec<Scene>> {
    let scripts = match made {
        None => vec![Script::load(&arguments.scene)?],
        Some(made) => {
            let file = format!("{} (its scene)", arguments.scene.display());
            let script = |from: &Provenance| {
                let name = from.fact("scene").unwrap_or("scene");
                Script::new(&file, name, &from.text)
                    .with_files(from.files.clone())
                    .of_variant(from.fact("variant"))
            };
            made.recordings.iter().map(script).collect()
        }
    };
    // Of a recording that is run again as it was made everything has been told.
    let judging = made.is_none() || arguments.changes();
    let mut told: Vec<String> = Vec::new();
    let mut scenes: Vec<Scene> = Vec::new();
    for mut script in scripts {
        arguments.change(&mut script)?;
        let (all, warnings) = match judging {
            true => script.judge().map_err(SceneError::Wrong)?,
            false => (script.scenes().map_err(SceneError::Wrong)?, Vec::new()),
        };
        for line in warnings.iter().map(Finding::line) {
            if !told.contains(&line) {
                print::err(&line);
                told.push(line);
            }
        }
        for scene in all {
            // Recordings that differed in what is set now are one.
            if !scenes
                .iter()
                .any(|other| other.fingerprint == scene.fingerprint)
            {
                scenes.push(scene);
            }
        }
    }
    Ok(scenes)
}

/// Where the recording goes: never where the one is that is run again.
fn place(arguments: &Arguments, again: bool, scene: &Scene) -> anyhow::Result<PathBuf> {
    let input = &arguments.scene;
    let path = match (&arguments.out, again) {
        (Some(path), _) => path.clone(),
        (None, false) => PathBuf::from(format!("{}.rrd", scene.name)),
        (None, true) => {
            let stem = input.file_stem().unwrap_or_default().to_string_lossy();
            PathBuf::from(format!("{stem}-again.rrd"))
        }
    };
    must_not_be_input(&path, input)?;
    Ok(path)
}

pub(super) fn must_not_be_input(path: &Path, input: &Path) -> anyhow::Result<()> {
    // By another name too: a link of either kind.
    let same = same_file::is_same_file(path, input).unwrap_or(false);
    // A scene is told apart by what it holds, where it would be written over.
    if same && record::is_recording(input) {
        return Err(Wrong(format!(
            "{} is what is run; choose another name for the new recording",
            path.display()
        ))
        .into());
    }
    Ok(())
}

pub(super) fn plans(scenes: &[Scene], explain: bool) -> anyhow::Result<Vec<Option<Plan>>> {
    scenes.iter().map(|scene| plan(scene, explain)).collect()
}

pub(super) fn headings(scenes: &[Scene], arguments: &Arguments, again: bool) -> Vec<Heading> {
    let heading = |scene: &Scene| {
        let mut heading = Heading::of(scene, &Simulation::new(scene));
        heading.one_of_several = scenes.len() > 1;
        heading.provenance = Some(Provenance::of(scene));
        heading.speed = arguments.speed;
        if again {
            // Beside the first in one viewer it is another.
            heading.id += "-again";
            heading.title += " (again)";
        }
        heading
    };
    let mut headings: Vec<Heading> = scenes.iter().map(heading).collect();
    Heading::share_scales(&mut headings);
    headings
}

/// What running one scene came to.
pub(super) struct Ran {
    pub subjects: Vec<Subject>,
    pub outcome: Outcome,
    pub done: Result<(), SimError>,
}

/// Runs scenes, one after another, into one file.
pub(super) fn record(
    (scenes, plans): (&[Scene], &[Option<Plan>]),
    headings: &[Heading],
    stop: &Stop,
    start: impl Fn(&Heading, &[Subject]) -> Result<Recorder, RecordError>,
) -> anyhow::Result<(Vec<Ran>, Summary)> {
    let mut recorder: Option<Recorder> = None;
    let mut all = Vec::new();
    for ((scene, plan), heading) in scenes.iter().zip(plans).zip(headings) {
        let simulation = Simulation::new(scene).until_set(stop.asked());
        let subjects = simulation.subjects().to_vec();
        let mut sink = match recorder.take() {
            None => start(heading, &subjects)?,
            Some(recorder) => recorder.then(heading, &subjects)?,
        };
        // Before the first step there is nothing to be finished, and what has the name already stays.
        stop.finish_from_here();
        let (outcome, done) = trace::beside(&mut sink, |sink| match plan {
            Some(plan) => simulation.run_by(&mut plan.chooser(), sink),
            None => simulation.run(sink),
        })?;
        if let Err(SimError::Sink(error)) = done {
            // The file itself failed: nothing more can be written to it.
            return Err(error.into());
        }
        all.push(Ran {
            subjects,
            outcome,
            done,
        });
        recorder = Some(sink);
        if stop.code().is_some() {
            break;
        }
    }
    // Whatever the run came to, the file is closed whole and what there is of it is told.
    let summary = recorder.map(Recorder::finish).transpose()?;
    let summary = summary.ok_or_else(|| anyhow::anyhow!("there is nothing to run"))?;
    Ok((all, summary))
}

fn report(
    scenes: &[Scene],
    plans: &[Option<Plan>],
    ran: &[Ran],
    summary: &Summary,
) -> anyhow::Result<()> {
    let all = scenes.iter().zip(plans).zip(ran);
    let reports = all.map(|((scene, plan), ran)| {
        let mut report = Report::new(
            scene,
            &ran.subjects,
            &ran.outcome,
            summary,
            ran.done.as_ref().err(),
        );
        report.plan = plan
            .as_ref()
            .map(|plan| explain::report(plan, &ran.subjects));
        report
    });
    let reports: Vec<Report> = reports.collect();
    match reports.as_slice() {
        [one] if scenes.len() == 1 => print::json(one),
        // Also of a sweep that was stopped in its first.
        several => print::json(&several),
    }
}

fn texts(scenes: &[Scene], plans: &[Option<Plan>], ran: &[Ran], summary: &Summary) -> String {
    let mut text = String::new();
    for ((scene, plan), ran) in scenes.iter().zip(plans).zip(ran) {
        if let Some(variant) = &scene.variant {
            text += &format!("{variant}\n");
        }
        text += &tables(scene, &ran.subjects, &ran.outcome, ran.done.is_ok());
        if let Some(plan) = plan {
            text += &explain::table(plan, &ran.subjects);
        }
        text += "\n\n";
    }
    let path = print::argument(&summary.path);
    let several = match ran.len() {
        1 => String::new(),
        n => format!(", {n} recordings, to be chosen between in the panel on the left"),
    };
    text + &format!(
        "{path}: {} bytes, {} rows{several}\nto open it: torquescope view {path}  (or cargo run --release -- view {path})",
        summary.bytes, summary.rows,
    )
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

fn tables(scene: &Scene, subjects: &[Subject], outcome: &Outcome, whole: bool) -> String {
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
    let (alone, swarms) = subjects.split_at(scene.outside_swarms());
    let (ends, ends_of_swarms) = outcome.end.split_at(alone.len());
    let alone = alone.iter().zip(ends);
    let mut rows: Vec<Vec<String>> = alone.map(|(s, m)| end_row(s, m)).collect();
    let mut ends = ends_of_swarms.iter();
    for members in swarms.chunk_by(Subject::is_like) {
        let name = members[0].swarm.as_deref().unwrap_or_default();
        let energies = members.iter().zip(&mut ends);
        let energy: f64 = energies.map(|(s, m)| s.energy(&m.motion)).sum();
        let mut row = vec![String::new(); header.len()];
        row[0] = format!("{name} ({} bodies)", members.len());
        row[header.len() - 1] = format!("{} in all", short(energy));
        rows.push(row);
    }
    text += &print::table(&header, rows);
    text
}

fn blow_row(scene: &Scene, subjects: &[Subject], blow: &Blow) -> Vec<String> {
    let event = &scene.events[blow.event];
    let subject = &subjects[blow.body];
    let (torque, response) = match blow.jump {
        // A profile that begins at nothing: its torque is told at the peak, the body as it is.
        None if event.action.profile() != Profile::Box => (
            format!("{}\nat its peak", short_vector(blow.tau_w)),
            format!("{}\nas it begins", short_vector(blow.sample.alpha_w)),
        ),
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

/// The event in words: the force at its peak and where it pushed, in the world.
fn what(event: &Event, blow: &Blow) -> String {
    let mut what = event.action.noun().to_owned();
    if let Some(name) = &event.name {
        what = format!("{name}\n{what}");
    }
    let lasts = event.action.lasts();
    if lasts > 0.0 {
        what += &format!(" for {} s", short(lasts));
    }
    if event.action.profile() != Profile::Box {
        what += &format!(", {}", event.action.profile().name());
    }
    if let Some(push) = blow.push {
        what += &format!(
            "\nF {} N\nat {} m",
            short_vector(push.force_w),
            short_vector(push.point_w)
        );
    }
    what
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
    /// The values that tell it from the scene's file, or from others of its sweep.
    #[serde(skip_serializing_if = "Option::is_none")]
    variant: Option<&'a str>,
    method: &'static str,
    step: f64,
    steps: u64,
    duration: f64,
    blows: Vec<BlowReport<'a>>,
    bodies: Vec<BodyReport<'a>>,
    /// What drifted beyond what is to be expected of the method.
    warnings: Vec<WarningReport<'a>>,
    recording: RecordingReport,
    /// How it was stepped, where that was planned.
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<explain::Report>,
    /// Why it stopped before its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

#[derive(Serialize)]
struct WarningReport<'a> {
    body: &'a str,
    drifts: &'static str,
    method: &'static str,
    /// When a sample first showed it.
    time: f64,
    step: u64,
    /// What was allowed then and the largest until the end: parts of what there is; of an attitude rad.
    allowed: f64,
    worst: f64,
}

#[derive(Serialize)]
struct BlowReport<'a> {
    time: f64,
    /// Where the scene names it.
    #[serde(skip_serializing_if = "Option::is_none")]
    event: Option<&'a str>,
    body: &'a str,
    /// Of everything that acts on the body just after.
    torque: [f64; 3],
    /// Of this event alone, at its peak.
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
            let subject = &subjects[blow.body];
            BlowReport {
                time: blow.at.time,
                event: scene.events[blow.event].name.as_deref(),
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
        let warning = |warning: &Warning| WarningReport {
            body: &subjects[warning.body].name,
            drifts: warning.drifts.describe(),
            method: warning.method,
            time: warning.began.time,
            step: warning.began.step,
            allowed: warning.allowed,
            worst: warning.worst,
        };
        Self {
            scene: &scene.name,
            title: &scene.title,
            variant: scene.variant.as_deref(),
            method: scene.stepping.name(),
            step: scene.step,
            steps: outcome.steps,
            duration: scene.duration,
            blows: outcome.blows.iter().map(blow).collect(),
            bodies: subjects.iter().zip(&outcome.end).map(body).collect(),
            warnings: outcome.warnings.iter().map(warning).collect(),
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
