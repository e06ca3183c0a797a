//! A trace on its way into a file: buffered by body, written by whole chunks.

use super::band::{Band, Pages};
use super::columns::{Ends, Times, counts, numbers, vectors};
use super::compare::{Comparison, Difference, Verdict};
use super::heading::Heading;
use super::layout::{self, MOST_TABS, Setting};
use super::look;
use super::mesh;
use super::picture::Impulses;
use super::price;
use super::rrd::{RrdFile, Store};
use super::sources::{self, Sources};
use super::swarm::SwarmRecorder;
use super::{Destination, RecordError};
use crate::trace::{
    Instant, Motion, Note, NoteKind, STREAMS, Sample, Sink, SinkError, StreamSet, Subject, Track,
};
use nalgebra::Vector3;
use rerun::archetypes::{
    CoordinateFrame, Ellipsoids3D, Mesh3D, Points3D, RecordingInfo, StateChange, TextDocument,
    TextLog, Transform3D, ViewCoordinates,
};
use rerun::components::{Color, FillMode, Radius, Scalar, TextLogLevel};
use rerun::{Component as _, ComponentDescriptor, TimePoint, Timeline};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Rows a chunk: what is due in a few simulated seconds, so that a chunk costs little beside its rows and a run that is
/// cut short lacks little.
const CHUNK: f64 = 4.0;
/// As many rows as LZ4 looks back over (64 KiB), in which one column's offsets are another's.
const STATE_ROWS: usize = 1024;
const NUMBER_ROWS: Range<usize> = 256..1024;
/// Of pictures and pages, which take kilobytes a row: as many as make some thousand over all bodies. A chunk costs the
/// same hundred microseconds whatever is in it, and a line of the file's footer.
const PICTURE_ROWS: Range<usize> = 256..1024;
const BUFFERED_PICTURES: usize = 1 << 13;
const HASH_ROWS: usize = 1024;
/// Rows buffered over all bodies, so that memory does not grow with their number.
const BUFFERED_ROWS: usize = 1 << 17;

/// Where the hashes of all states are.
pub(super) const HASHES: &str = "/hashes";

/// The columns of numbers, in the order of the lists.
pub(super) fn number_columns() -> impl Iterator<Item = &'static str> {
    let quantities = STREAMS.iter().flat_map(|stream| stream.quantities);
    quantities.map(|quantity| quantity.name)
}

/// Writes traces to an `.rrd` file, one after another.
pub struct Recorder {
    path: PathBuf,
    file: RrdFile,
    /// What the recordings that have ended came to beside those they are held against.
    verdicts: Vec<Verdict>,
    trace: Trace,
}

/// The trace that is being written.
#[derive(Clone)]
struct Trace {
    hash_times: Times,
    hashes: Vec<u64>,
    bodies: Vec<BodyRecorder>,
    swarms: Vec<SwarmRecorder>,
    state_rows: usize,
    /// Where forces are recorded.
    impulses: Option<Impulses>,
}

/// What was written.
#[derive(Clone, Debug)]
pub struct Summary {
    pub path: PathBuf,
    pub bytes: u64,
    pub rows: u64,
    /// One for each recording, where they were held against others.
    pub verdicts: Vec<Verdict>,
}

#[derive(Clone)]
struct BodyRecorder {
    subject: Subject,
    state_times: Times,
    positions: Vec<f32>,
    attitudes: Vec<f32>,
    omegas: Vec<f64>,
    /// Where it is, for what goes with it and does not turn.
    places: Places,
    bands: Vec<Band>,
}

/// Places of a body that are so far apart that one sees it.
#[derive(Clone)]
struct Places {
    /// m, and s.
    apart: f64,
    seldom: f64,
    last: Option<(f64, Vector3<f64>)>,
    times: Times,
    values: Vec<f32>,
}

/// Of a body's radius: a pixel or two of a body that fills a good part of the view.
const SEEN_APART: f64 = 0.01;
/// Places in the time in which what hangs there has one row: the fastest of bodies are not worth more.
const OFTEN: f64 = 4.0;

impl Recorder {
    /// Creates the file and writes what does not change: blueprint first, then static things.
    pub fn create(
        to: &Destination,
        heading: &Heading,
        subjects: &[Subject],
    ) -> Result<Self, RecordError> {
        let file = RrdFile::create(to, &heading.id)?;
        Self::into_file(file, &to.path, heading, subjects)
    }

    /// Records to nowhere, to learn from its summary how large a recording is.
    pub fn nowhere(heading: &Heading, subjects: &[Subject]) -> Result<Self, RecordError> {
        let file = RrdFile::nowhere(&heading.id)?;
        Self::into_file(file, Path::new(""), heading, subjects)
    }

    /// Holds what is recorded against earlier recordings of it; the file is for who wants to look.
    pub fn comparing(
        comparison: Comparison,
        to: Option<&Destination>,
        heading: &Heading,
        subjects: &[Subject],
    ) -> Result<Self, RecordError> {
        let mut file = match to {
            Some(to) => RrdFile::create(to, &heading.id)?,
            None => RrdFile::nowhere(&heading.id)?,
        };
        file.compare_with(comparison);
        let path = to.map_or(Path::new(""), |to| &to.path);
        Self::into_file(file, path, heading, subjects)
    }

    fn into_file(
        mut file: RrdFile,
        path: &Path,
        heading: &Heading,
        subjects: &[Subject],
    ) -> Result<Self, RecordError> {
        layout::write(&mut file, &Setting::new(heading, subjects))?;
        file.begin_recording()?;
        Ok(Self {
            path: path.to_owned(),
            trace: Trace::begin(&mut file, heading, subjects)?,
            file,
            verdicts: Vec::new(),
        })
    }

    /// Ends this recording and begins another in the same file.
    pub fn then(mut self, heading: &Heading, subjects: &[Subject]) -> Result<Self, RecordError> {
        self.end()?;
        self.file.next_recording(&heading.id)?;
        self.trace = Trace::begin(&mut self.file, heading, subjects)?;
        Ok(self)
    }

    /// Writes what is buffered and closes the file.
    pub fn finish(mut self) -> Result<Summary, RecordError> {
        self.end()?;
        let (bytes, rows) = self.file.finish()?;
        Ok(Summary {
            path: self.path,
            bytes,
            rows,
            verdicts: self.verdicts,
        })
    }

    /// Writes what waits in memory, where it has waited as long as it may: behind the end of what is settled, so that
    /// what the file holds in the end does not depend on when that was.
    fn keep_up(&mut self) -> Result<(), RecordError> {
        if !self.file.is_behind() {
            return Ok(());
        }
        self.file.begin_tail();
        self.trace.clone().flush(&mut self.file)?;
        self.file.end_tail()
    }

    fn end(&mut self) -> Result<(), RecordError> {
        self.trace.flush(&mut self.file)?;
        let Some(verdict) = self.file.verdict() else {
            return Ok(());
        };
        if let Some(difference) = &verdict.difference {
            mark(&mut self.file, difference)?;
        }
        self.verdicts.push(verdict);
        Ok(())
    }
}

/// Marks on the timeline where a run parts from what it is held against.
fn mark(file: &mut RrdFile, difference: &Difference) -> Result<(), RecordError> {
    let at = TimePoint::default()
        .with(Timeline::new_duration("sim_time"), difference.time)
        .with(Timeline::new_sequence("step"), difference.step as i64);
    let line = TextLog::new(format!("first difference from the recording {difference}"))
        .with_level(TextLogLevel::WARN)
        .with_color(Color::from(look::FORCE));
    file.remark("/events", at.clone(), &line)?;
    file.remark("/events/verify", at, &StateChange::single("differs"))
}

impl Trace {
    fn begin(
        file: &mut RrdFile,
        heading: &Heading,
        subjects: &[Subject],
    ) -> Result<Self, RecordError> {
        let setting = Setting::new(heading, subjects);
        let mut bodies = Vec::with_capacity(setting.subjects.len());
        file.statics("/", &[&ViewCoordinates::RIGHT_HAND_Y_UP()])?;
        let info = RecordingInfo::new().with_name(heading.name());
        file.statics("/__properties", &[&info])?;
        if let Some(provenance) = &heading.provenance {
            provenance.write(file)?;
        }
        let notes = TextDocument::from_markdown(layout::notes(&setting));
        file.statics("/notes", &[&notes])?;
        let legend = TextDocument::from_markdown(layout::legend(&setting));
        file.statics("/legend", &[&legend])?;
        if let Some(cost) = &heading.price {
            price::write(file, cost)?;
        }
        let sources = sources::all_names(setting.subjects);
        let count = setting.subjects.len().max(1);
        let share = (BUFFERED_ROWS / count).max(8);
        let pictures = (BUFFERED_PICTURES / count).clamp(PICTURE_ROWS.start, PICTURE_ROWS.end);
        for (k, subject) in setting.subjects.iter().enumerate() {
            let body = BodyRecorder::new(subject, k, heading, &sources, (share, pictures));
            body.statics(file, k, heading)?;
            bodies.push(body);
        }
        let mut first = bodies.len();
        let mut swarms = Vec::new();
        for members in setting.swarms.chunk_by(Subject::is_like) {
            swarms.push(SwarmRecorder::begin(file, members, first, swarms.len())?);
            first += members.len();
        }
        let impulses = heading.streams.contains("force");
        let impulses =
            impulses.then(|| Impulses::new(&heading.scales, heading.impulse_shown_for()));
        Ok(Self {
            hash_times: Times::default(),
            hashes: Vec::new(),
            bodies,
            swarms,
            state_rows: share.min(STATE_ROWS),
            impulses,
        })
    }

    fn flush(&mut self, file: &mut RrdFile) -> Result<(), RecordError> {
        for body in &mut self.bodies {
            body.flush_state(file)?;
            for band in &mut body.bands {
                band.flush(file, &body.subject)?;
            }
        }
        for swarm in &mut self.swarms {
            swarm.flush(file)?;
        }
        self.flush_hashes(file)
    }

    fn flush_hashes(&mut self, file: &mut RrdFile) -> Result<(), RecordError> {
        let times = std::mem::take(&mut self.hash_times);
        let hashes = std::mem::take(&mut self.hashes);
        let ends = Ends::uniform(hashes.len(), 1);
        let column = counts(ComponentDescriptor::partial("state"), hashes, ends);
        file.columns(HASHES, &times, vec![column])
    }
}

impl Sink for Recorder {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        let width = track.bodies.len();
        for (k, &at) in track.instants.iter().enumerate() {
            let motions = &track.motions[k * width..(k + 1) * width];
            let alone = self.trace.bodies.len();
            let range = track.bodies.start.min(alone)..track.bodies.end.min(alone);
            let bodies = self.trace.bodies[range].iter_mut();
            for (body, motion) in bodies.zip(motions) {
                body.motion(at, motion);
                if body.state_times.len() >= self.trace.state_rows {
                    body.flush_state(&mut self.file)?;
                }
            }
        }
        for swarm in &mut self.trace.swarms {
            swarm.motions(&mut self.file, track)?;
        }
        Ok(self.keep_up()?)
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        if let Some(impulses) = &mut self.trace.impulses {
            impulses.clear(&mut self.file, at, || timepoint(at))?;
        }
        for (body, sample) in self.trace.bodies[bodies].iter_mut().zip(samples) {
            let due = |band: &&mut Band| sample.due.meets(band.streams);
            for band in body.bands.iter_mut().filter(due) {
                band.sample(at, &body.subject, sample);
                band.flush_full(&mut self.file, &body.subject)?;
            }
        }
        Ok(self.keep_up()?)
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        let (level, colour) = match (note.kind, note.body) {
            (NoteKind::Failure, _) => (TextLogLevel::ERROR, look::FORCE),
            (NoteKind::Warning, _) => (TextLogLevel::WARN, look::FORCE),
            (_, Some(body)) => (TextLogLevel::INFO, look::BODIES[body % look::BODIES.len()]),
            (_, None) => (TextLogLevel::INFO, look::NAME),
        };
        let line = TextLog::new(note.text.as_str())
            .with_level(level)
            .with_color(Color::from(colour));
        let when = timepoint(at);
        let body = note.body.and_then(|body| self.trace.bodies.get(body));
        let subject = body.map(|body| &body.subject);
        if let (Some(impulses), Some(strike), Some(subject)) =
            (&mut self.trace.impulses, note.strike, subject)
        {
            impulses.strike(&mut self.file, (at, when.clone()), subject, strike)?;
        }
        self.file
            .row(Store::Recording, "/events", when.clone(), &[&line])?;
        let state = match note.kind {
            NoteKind::Begins => StateChange::single("acts"),
            NoteKind::Instant => StateChange::single("struck"),
            NoteKind::Set => StateChange::single("set"),
            NoteKind::Failure => StateChange::single("not finite"),
            NoteKind::Ends => StateChange::new().with_state([""]),
            // The lane of the log itself: its notes, one after the other, along the whole scene.
            NoteKind::Remark => StateChange::single(note.text.as_str()),
            // What acts goes on acting.
            NoteKind::Warning => return Ok(()),
        };
        let lane = match (note.kind, subject) {
            (NoteKind::Remark, _) | (_, None) => "/events".to_owned(),
            (_, Some(subject)) => format!("/events/{}", subject.name),
        };
        self.file.row(Store::Recording, lane, when, &[&state])?;
        Ok(())
    }

    fn idle(&mut self) -> Result<(), SinkError> {
        Ok(self.keep_up()?)
    }

    fn wants_fingerprints(&self) -> bool {
        true
    }

    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        self.trace.hash_times.push(at);
        self.trace.hashes.push(hash);
        if self.trace.hashes.len() >= HASH_ROWS {
            self.trace.flush_hashes(&mut self.file)?;
        }
        Ok(())
    }
}

/// Rows of a chunk of what is due so often (1/s).
fn rows(rate: f64, few_to_many: Range<usize>) -> usize {
    ((CHUNK * rate) as usize).clamp(few_to_many.start, few_to_many.end)
}

fn timepoint(at: Instant) -> TimePoint {
    TimePoint::default()
        .with(Timeline::new_duration("sim_time"), at.nanoseconds())
        .with(Timeline::new_sequence("step"), at.step as i64)
}

impl BodyRecorder {
    fn new(
        subject: &Subject,
        index: usize,
        heading: &Heading,
        sources: &[&str],
        (share, pictures): (usize, usize),
    ) -> Self {
        let band = |&(rate, streams): &(f64, StreamSet)| {
            let rows = (rows(rate, NUMBER_ROWS), pictures);
            let rows = (share.min(rows.0), share.min(rows.1));
            let mut band = Band::new(streams, heading, rows);
            // A page is for reading: only bodies that have a tab have one.
            if streams.contains("numbers") && index < MOST_TABS {
                band.pages = Some(Pages::of(heading.streams));
            }
            if streams.contains("sources") {
                band.sources = Sources::of(subject, sources, &heading.scales);
            }
            band
        };
        Self {
            subject: subject.clone(),
            state_times: Times::default(),
            positions: Vec::new(),
            attitudes: Vec::new(),
            omegas: Vec::new(),
            places: Places {
                apart: SEEN_APART * mesh::radius(subject),
                seldom: 1.0 / (OFTEN * heading.rate),
                last: None,
                times: Times::default(),
                values: Vec::new(),
            },
            bands: heading.bands.iter().map(band).collect(),
        }
    }

    fn statics(
        &self,
        file: &mut RrdFile,
        index: usize,
        heading: &Heading,
    ) -> Result<(), RecordError> {
        let subject = &self.subject;
        let name = &subject.name;
        let shape: Mesh3D = mesh::mesh(subject, look::BODIES[index % look::BODIES.len()]);
        file.statics(format!("/bodies/{name}/shape"), &[&shape])?;
        let above = [0.0, (1.2 * heading.scales.size) as f32, 0.0];
        let label = Points3D::new([above])
            .with_radii([Radius::new_ui_points(0.0)])
            .with_labels([subject.label.as_str()])
            .with_colors([look::NAME])
            .with_show_labels(true);
        let at_place = CoordinateFrame::new(format!("tf#/places/{name}"));
        file.statics(format!("/labels/{name}"), &[&at_place, &label])?;
        if let Some(pivot_w) = subject.pivot_w {
            let at = Transform3D::from_translation(<[f32; 3]>::from(pivot_w.map(|x| x as f32)));
            let dot = Points3D::new([[0.0_f32; 3]])
                .with_radii([Radius::new_ui_points(5.0)])
                .with_colors([look::PIVOT]);
            file.statics(format!("/pivots/{name}"), &[&at, &dot])?;
        }
        if heading.streams.contains("inertia") {
            self.ellipsoid(file)?;
        }
        let mut bands = self.bands.iter();
        bands.try_for_each(|band| band.statics(file, subject))
    }

    /// The equivalent ellipsoid: translucent, turning with the body.
    fn ellipsoid(&self, file: &mut RrdFile) -> Result<(), RecordError> {
        let Some((half, q)) = mesh::equivalent_ellipsoid(&self.subject) else {
            return Ok(());
        };
        let name = &self.subject.name;
        let at_body = CoordinateFrame::new(format!("tf#/bodies/{name}"));
        let [x, y, z, w] = q.coords.map(|x| x as f32).into();
        let ellipsoid = Ellipsoids3D::from_half_sizes([<[f32; 3]>::from(half.map(|x| x as f32))])
            .with_quaternions([rerun::Quaternion::from_xyzw([x, y, z, w])])
            .with_colors([look::with_alpha(look::INERTIA, 0x40)])
            .with_fill_mode(FillMode::Solid);
        file.statics(format!("/inertia/{name}"), &[&at_body, &ellipsoid])
    }

    fn motion(&mut self, at: Instant, motion: &Motion) {
        self.state_times.push(at);
        self.positions
            .extend(motion.position_w.iter().map(|&x| x as f32));
        self.attitudes
            .extend(motion.q_wb.coords.iter().map(|&x| x as f32));
        self.omegas.extend(motion.omega_w.iter());
        self.places.pass(at, motion.position_w);
    }

    /// The state: f32 pose for the picture, f64 angular velocity.
    fn flush_state(&mut self, file: &mut RrdFile) -> Result<(), RecordError> {
        let name = &self.subject.name;
        let times = std::mem::take(&mut self.state_times);
        let rows = times.len();
        let one = Ends::uniform(rows, 1);
        let positions = std::mem::take(&mut self.positions);
        let attitudes = std::mem::take(&mut self.attitudes);
        let omegas = std::mem::take(&mut self.omegas);
        let translation = vectors(
            Transform3D::descriptor_translation(),
            positions,
            3,
            one.clone(),
        );
        let quaternion = vectors(Transform3D::descriptor_quaternion(), attitudes, 4, one);
        let omega = numbers(
            number_descriptor("angular_velocity"),
            omegas,
            Ends::uniform(rows, 3),
        );
        let columns = vec![translation, quaternion, omega];
        file.columns(format!("/bodies/{name}"), &times, columns)?;
        self.places.flush(file, name)
    }
}

impl Places {
    /// Keeps a place that is far enough from the last.
    fn pass(&mut self, at: Instant, position_w: Vector3<f64>) {
        let seen = |(time, place_w): (f64, Vector3<f64>)| {
            at.time - time < self.seldom || (position_w - place_w).norm() <= self.apart
        };
        if self.last.is_some_and(seen) {
            return;
        }
        self.last = Some((at.time, position_w));
        self.times.push(at);
        self.values.extend(position_w.iter().map(|&x| x as f32));
    }

    fn flush(&mut self, file: &mut RrdFile, name: &str) -> Result<(), RecordError> {
        let times = std::mem::take(&mut self.times);
        let values = std::mem::take(&mut self.values);
        let one = Ends::uniform(times.len(), 1);
        let column = vectors(Transform3D::descriptor_translation(), values, 3, one);
        file.columns(format!("/places/{name}"), &times, vec![column])
    }
}

/// A column of f64 that plots can take for their scalars.
pub(super) fn number_descriptor(name: &'static str) -> ComponentDescriptor {
    ComponentDescriptor::partial(name).with_component_type(Scalar::name())
}
