//! Impulses: an arrow that ends where the impulse struck.
//!
//! An impulse lasts no time at all, so its arrow stays for a while after it, where it struck.

use super::super::RecordError;
use super::super::look;
use super::super::rrd::{RrdFile, Store};
use super::super::scale::Scales;
use crate::trace::{Instant, PointForce, Subject, brief};
use nalgebra::Vector3;
use rerun::TimePoint;
use rerun::archetypes::{Arrows3D, Points3D};
use rerun::components::Radius;

/// The arrows of impulses that are still shown.
#[derive(Clone)]
pub struct Impulses {
    /// m per N·s.
    scale: f64,
    /// s.
    shown_for: f64,
    shown: Vec<(f64, String)>,
}

impl Impulses {
    pub fn new(scales: &Scales, shown_for: f64) -> Self {
        Self {
            scale: scales.impulse,
            shown_for,
            shown: Vec::new(),
        }
    }

    /// Draws one.
    pub fn strike(
        &mut self,
        file: &mut RrdFile,
        (at, when): (Instant, TimePoint),
        subject: &Subject,
        strike: PointForce,
    ) -> Result<(), RecordError> {
        let single = |v: Vector3<f64>| <[f32; 3]>::from(v.map(|x| x as f32));
        let arrow = strike.force_w * self.scale;
        let from = strike.point_w - arrow;
        let arrows = Arrows3D::from_vectors([single(arrow)])
            .with_origins([single(from)])
            .with_colors([look::FORCE])
            .with_radii([Radius::new_ui_points(look::BOLD)]);
        let label = Points3D::new([single(from)])
            .with_colors([look::FORCE])
            .with_radii([Radius::new_ui_points(0.0)])
            .with_labels([format!("J {} N·s", brief(strike.force_w.norm()))])
            .with_show_labels(true);
        let path = format!("/force/{}/impulse", subject.name);
        file.row(Store::Recording, path.as_str(), when, &[&arrows, &label])?;
        self.shown.retain(|(_, other)| *other != path);
        self.shown.push((at.time + self.shown_for, path));
        Ok(())
    }

    /// Takes away those that have been shown long enough.
    pub fn clear(
        &mut self,
        file: &mut RrdFile,
        at: Instant,
        when: impl Fn() -> TimePoint,
    ) -> Result<(), RecordError> {
        let none: [[f32; 3]; 0] = [];
        for (until, path) in &self.shown {
            if at.time >= *until {
                let arrows = Arrows3D::from_vectors(none).with_origins(none);
                let label = Points3D::new(none);
                file.row(Store::Recording, path.as_str(), when(), &[&arrows, &label])?;
            }
        }
        self.shown.retain(|(until, _)| at.time < *until);
        Ok(())
    }
}
