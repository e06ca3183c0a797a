//! A swarm: many bodies on one entity, their poses alone, a row an instant.
//!
//! Ten thousand entities are more than a viewer can hold; ten thousand instances of one are not. Boxes
//! and ellipsoids are shapes that Rerun has, which a click tells apart; everything else is one mesh and
//! its instances. Nothing is derived of a swarm's bodies: who wants to see a torque names the body.

use super::RecordError;
use super::columns::{Ends, Times, vectors};
use super::look::{self, Colour};
use super::mesh;
use super::rrd::RrdFile;
use crate::mass::solids::Surface;
use crate::trace::{Motion, Subject, Track};
use nalgebra::Vector3;
use rerun::ComponentDescriptor;
use rerun::archetypes::{Boxes3D, Ellipsoids3D, InstancePoses3D};
use rerun::components::{Color, FillMode, HalfSize3D};
use std::ops::Range;

#[derive(Clone)]
pub struct SwarmRecorder {
    path: String,
    members: Range<usize>,
    /// From a body's centre of mass to where what is drawn has its own, body axes.
    offset_b: Vector3<f64>,
    place: ComponentDescriptor,
    turn: ComponentDescriptor,
    times: Times,
    /// Row by row, body by body.
    positions: Vec<f32>,
    attitudes: Vec<f32>,
    /// The first row of the stretch that is being delivered group by group.
    base: usize,
}

/// Bytes buffered before a chunk is written.
const BUFFERED: usize = 8 << 20;
/// Of a pose: three numbers and four, f32.
const POSE: usize = 28;

impl SwarmRecorder {
    /// Writes what does not change. `first` is the index of the first body, `place` that of the swarm.
    pub fn begin(
        file: &mut RrdFile,
        bodies: &[Subject],
        first: usize,
        place: usize,
    ) -> Result<Self, RecordError> {
        let like = &bodies[0];
        let name = like.swarm.as_deref().unwrap_or_default();
        let path = format!("/swarms/{name}");
        let colours = (0..bodies.len()).map(|k| colour(place, k));
        let colours: Vec<Color> = colours.map(Color::from).collect();
        let solid = like.solid.as_ref();
        let half = |size: Vector3<f64>| HalfSize3D::from(<[f32; 3]>::from(size.map(|x| x as f32)));
        let (shape, place, turn) = match solid.map(|solid| solid.surface()) {
            Some(Surface::Cuboid(extents)) => {
                let sizes = vec![half(extents * 0.5); bodies.len()];
                let boxes = Boxes3D::from_half_sizes(sizes)
                    .with_colors(colours)
                    .with_fill_mode(FillMode::Solid);
                file.statics(path.as_str(), &[&boxes])?;
                let place = Boxes3D::descriptor_centers();
                (true, place, Boxes3D::descriptor_quaternions())
            }
            Some(Surface::Ellipsoid(size)) => {
                let sizes = vec![half(size); bodies.len()];
                let ellipsoids = Ellipsoids3D::from_half_sizes(sizes)
                    .with_colors(colours)
                    .with_fill_mode(FillMode::Solid);
                file.statics(path.as_str(), &[&ellipsoids])?;
                let place = Ellipsoids3D::descriptor_centers();
                (true, place, Ellipsoids3D::descriptor_quaternions())
            }
            _ => {
                let mesh = mesh::mesh(like, colour(place, 0));
                file.statics(path.as_str(), &[&mesh])?;
                let place = InstancePoses3D::descriptor_translations();
                (false, place, InstancePoses3D::descriptor_quaternions())
            }
        };
        Ok(Self {
            path,
            members: first..first + bodies.len(),
            // A mesh is made about the centre of mass, a shape has its own.
            offset_b: match (shape, solid) {
                (true, Some(solid)) => -solid.centre(),
                _ => Vector3::zeros(),
            },
            place,
            turn,
            times: Times::default(),
            positions: Vec::new(),
            attitudes: Vec::new(),
            base: 0,
        })
    }

    /// Takes what of a group's track is about its bodies; groups come one after another, each with the
    /// same instants.
    pub fn motions(&mut self, file: &mut RrdFile, track: &Track<'_>) -> Result<(), RecordError> {
        let start = track.bodies.start.max(self.members.start);
        let end = track.bodies.end.min(self.members.end);
        if start >= end {
            return Ok(());
        }
        let count = self.members.len();
        if start == self.members.start {
            self.base = self.times.len();
            track.instants.iter().for_each(|&at| self.times.push(at));
            self.positions.resize(self.times.len() * count * 3, 0.0);
            self.attitudes.resize(self.times.len() * count * 4, 0.0);
        }
        let width = track.bodies.len();
        for row in 0..track.instants.len() {
            for body in start..end {
                let motion = &track.motions[row * width + body - track.bodies.start];
                let at = (self.base + row) * count + body - self.members.start;
                self.pose(at, motion);
            }
        }
        if end == self.members.end {
            self.base = self.times.len();
            if self.base * count * POSE >= BUFFERED {
                self.flush(file)?;
            }
        }
        Ok(())
    }

    fn pose(&mut self, at: usize, motion: &Motion) {
        let mut place_w = motion.position_w;
        if self.offset_b != Vector3::zeros() {
            place_w += motion.q_wb * self.offset_b;
        }
        let position = &mut self.positions[3 * at..3 * at + 3];
        position
            .iter_mut()
            .zip(place_w.iter())
            .for_each(|(to, &x)| *to = x as f32);
        let attitude = &mut self.attitudes[4 * at..4 * at + 4];
        let q = motion.q_wb.coords;
        attitude
            .iter_mut()
            .zip(q.iter())
            .for_each(|(to, &x)| *to = x as f32);
    }

    /// Writes the rows that all bodies have; others are begun, and wait for the rest of their bodies.
    pub fn flush(&mut self, file: &mut RrdFile) -> Result<(), RecordError> {
        let count = self.members.len();
        self.times.truncate(self.base);
        self.positions.truncate(self.base * count * 3);
        self.attitudes.truncate(self.base * count * 4);
        self.base = 0;
        let times = std::mem::take(&mut self.times);
        let ends = Ends::uniform(times.len(), self.members.len());
        let positions = std::mem::take(&mut self.positions);
        let attitudes = std::mem::take(&mut self.attitudes);
        let columns = vec![
            vectors(self.place.clone(), positions, 3, ends.clone()),
            vectors(self.turn.clone(), attitudes, 4, ends),
        ];
        file.columns(self.path.as_str(), &times, columns)
    }
}

/// One hue a swarm, lighter and darker from body to body.
fn colour(swarm: usize, body: usize) -> Colour {
    let hue = look::BODIES[swarm % look::BODIES.len()];
    look::lightened(hue, 0.12 * (body % 5) as f32)
}
