//! A vector at a body's reference point: an arrow, and for a torque a turning arrow about it.
//!
//! A torque drawn as a plain straight arrow is read as a force. Its axis carries a ring with an
//! arrowhead that turns the way the torque does (right-hand rule).
//!
//! The data are in the quantity's own unit; a static frame scales them to metres.

use super::super::RecordError;
use super::super::columns::{Column, Ends, Times, strips, texts, vectors};
use super::super::look::{self, Colour};
use super::super::rrd::RrdFile;
use super::Picture;
use crate::trace::{Instant, Sample, Subject, brief};
use nalgebra::Vector3;
use rerun::archetypes::{Arrows3D, CoordinateFrame, LineStrips3D, Points3D, Transform3D};
use rerun::components::Radius;
use std::sync::{Arc, OnceLock};

/// The ring: its radius and its place along the axis, in lengths of the arrow; its arc.
const RING_RADIUS: f64 = 0.2;
const RING_PLACE: f64 = 0.8;
const RING_ARC: f64 = 1.75 * std::f64::consts::PI;
const RING_PIECES: usize = 28;

/// The vector of a body at an instant.
pub type Value = Arc<dyn Fn(&Subject, &Sample) -> Vector3<f64> + Send + Sync>;

/// Which vector, and how it looks.
#[derive(Clone)]
pub struct Shown {
    /// The first part of its entities' paths.
    pub stream: String,
    /// What its label says before the number.
    pub symbol: String,
    pub unit: &'static str,
    pub colour: Colour,
    /// m per unit.
    pub scale: f64,
    pub value: Value,
}

#[derive(Clone)]
pub struct VectorPicture {
    shown: Shown,
    times: Times,
    arrows: Arrows,
    labels: Labels,
    turns: Option<Turns>,
}

/// The rings of several rows, and the arrowheads that end them.
#[derive(Clone, Default)]
struct Turns {
    rings: Vec<f32>,
    points: Ends,
    heads: Arrows,
}

/// Arrows of several rows.
#[derive(Clone, Default)]
pub struct Arrows {
    pub origins: Vec<f32>,
    pub vectors: Vec<f32>,
    pub ends: Ends,
}

/// Labels of several rows, each at a point. Rerun would put an arrow's label at its middle, where
/// those of arrows along one axis cover each other.
#[derive(Clone, Default)]
pub struct Labels {
    places: Vec<f32>,
    texts: Vec<String>,
    ends: Ends,
}

impl Labels {
    pub fn push(&mut self, place: Vector3<f64>, text: String) {
        self.places.extend(place.iter().map(|&x| x as f32));
        self.texts.push(text);
    }

    pub fn end_row(&mut self, count: usize) {
        self.ends.push(count);
    }

    pub fn take(&mut self) -> Vec<Column> {
        let Self {
            places,
            texts: labels,
            ends,
        } = std::mem::take(self);
        vec![
            vectors(Points3D::descriptor_positions(), places, 3, ends.clone()),
            texts(Points3D::descriptor_labels(), labels, ends),
        ]
    }

    /// What does not change about them.
    pub fn statics(colour: Colour) -> Points3D {
        Points3D::update_fields()
            .with_colors([colour])
            .with_radii([Radius::new_ui_points(0.0)])
            .with_show_labels(true)
    }
}

impl Arrows {
    pub fn push(&mut self, origin: Vector3<f64>, vector: Vector3<f64>) {
        self.origins.extend(origin.iter().map(|&x| x as f32));
        self.vectors.extend(vector.iter().map(|&x| x as f32));
    }

    /// The columns of all rows.
    pub fn take(&mut self) -> Vec<Column> {
        let Self {
            origins,
            vectors: arrows,
            ends,
        } = std::mem::take(self);
        vec![
            vectors(Arrows3D::descriptor_vectors(), arrows, 3, ends.clone()),
            vectors(Arrows3D::descriptor_origins(), origins, 3, ends),
        ]
    }
}

impl VectorPicture {
    pub fn new(shown: Shown) -> Self {
        Self {
            shown,
            times: Times::default(),
            arrows: Arrows::default(),
            labels: Labels::default(),
            turns: None,
        }
    }

    /// With a ring that turns about the axis.
    pub fn turning(mut self) -> Self {
        self.turns = Some(Turns::default());
        self
    }

    fn path(&self, subject: &Subject) -> String {
        format!("/{}/{}", self.shown.stream, subject.name)
    }

    /// The frame of the data: at the reference point, without the body's turn, in the unit.
    fn frame(&self, subject: &Subject) -> String {
        format!("{}@{}", self.shown.stream, subject.name)
    }

    /// Where along the arrow its label stands: at the tip of a torque, beyond that of the longer others.
    fn label_place(&self) -> f64 {
        if self.turns.is_some() { 1.0 } else { 1.1 }
    }

    /// Torque has a thin axis and a bold ring, so that an arrow along the same axis shows on it.
    fn radius(&self) -> Radius {
        Radius::new_ui_points(if self.turns.is_some() {
            look::THIN
        } else {
            look::MEDIUM
        })
    }
}

/// Sine and cosine along the ring.
fn circle() -> &'static [(f64, f64); RING_PIECES + 1] {
    static CIRCLE: OnceLock<[(f64, f64); RING_PIECES + 1]> = OnceLock::new();
    CIRCLE.get_or_init(|| {
        // The same on every machine, as all that is recorded.
        std::array::from_fn(|k| libm::sincos(RING_ARC * k as f64 / RING_PIECES as f64))
    })
}

impl Turns {
    /// A ring about `axis`, ending in an arrowhead.
    fn push(&mut self, axis: Vector3<f64>) {
        let length = axis.norm();
        let n = axis / length;
        // Any direction across the axis: from the world axis least along it.
        let least = n.map(f64::abs).imin();
        let mut across = Vector3::zeros();
        across[least] = 1.0;
        let u = n.cross(&across).normalize();
        let v = n.cross(&u);
        let centre = axis * RING_PLACE;
        let radius = RING_RADIUS * length;
        let circle = circle();
        let at = |k: usize| {
            let (sin, cos) = circle[k];
            (centre + (u * cos + v * sin) * radius, v * cos - u * sin)
        };
        for k in 0..=RING_PIECES {
            self.rings.extend(at(k).0.iter().map(|&x| x as f32));
        }
        self.points.push(RING_PIECES + 1);
        let (tip, along) = at(RING_PIECES);
        self.heads.push(tip, along * (0.5 * radius));
    }
}

impl Picture for VectorPicture {
    fn statics(&self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let frame = self.frame(subject);
        // A pivot stays where it is; the centre of mass of a free body takes its arrows along.
        let parent = match subject.pivot_b {
            Some(_) => format!("tf#/pivots/{}", subject.name),
            None => format!("tf#/places/{}", subject.name),
        };
        let scaling = Transform3D::from_scale(self.shown.scale as f32)
            .with_child_frame(frame.as_str())
            .with_parent_frame(parent.as_str());
        file.statics(
            format!("/frames/{}/{}", self.shown.stream, subject.name),
            &[&scaling],
        )?;
        let arrows = Arrows3D::update_fields()
            .with_colors([self.shown.colour])
            .with_radii([self.radius()]);
        let here = CoordinateFrame::new(frame);
        let path = self.path(subject);
        file.statics(path.as_str(), &[&here, &arrows])?;
        file.statics(
            format!("{path}/label"),
            &[&here, &Labels::statics(self.shown.colour)],
        )?;
        if self.turns.is_some() {
            let bold = Radius::new_ui_points(look::BOLD);
            let ring = LineStrips3D::update_fields()
                .with_colors([self.shown.colour])
                .with_radii([bold]);
            let head = Arrows3D::update_fields()
                .with_colors([self.shown.colour])
                .with_radii([bold]);
            file.statics(format!("{path}/turn"), &[&here, &ring, &head])?;
        }
        Ok(())
    }

    fn row(&mut self, at: Instant, subject: &Subject, sample: &Sample) {
        let value = (self.shown.value)(subject, sample);
        let length = value.norm();
        let shown = length.is_finite() && length > 0.0;
        self.times.push(at);
        if shown {
            self.arrows.push(Vector3::zeros(), value);
            let label = format!(
                "{} {} {}",
                self.shown.symbol,
                brief(length),
                self.shown.unit
            );
            self.labels.push(value * self.label_place(), label);
        }
        self.arrows.ends.push(usize::from(shown));
        self.labels.end_row(usize::from(shown));
        if let Some(turns) = &mut self.turns {
            if shown {
                turns.push(value);
            }
            turns.heads.ends.push(usize::from(shown));
        }
    }

    fn copy(&self) -> Box<dyn Picture> {
        Box::new(self.clone())
    }

    fn rows(&self) -> usize {
        self.times.len()
    }

    fn flush(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let times = std::mem::take(&mut self.times);
        let path = self.path(subject);
        let arrows = self.arrows.take();
        file.columns(path.as_str(), &times, arrows)?;
        file.columns(format!("{path}/label"), &times, self.labels.take())?;
        if let Some(turns) = &mut self.turns {
            let Turns {
                rings,
                points,
                mut heads,
            } = std::mem::take(turns);
            let ends = heads.ends.clone();
            let mut columns = heads.take();
            columns.push(strips(
                LineStrips3D::descriptor_strips(),
                rings,
                points,
                ends,
            ));
            file.columns(format!("{path}/turn"), &times, columns)?;
        }
        Ok(())
    }
}
