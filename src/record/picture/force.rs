//! Pushes: an arrow that ends at the point it pushes, and the lever arm from the reference point.

use super::super::RecordError;
use super::super::columns::{Ends, Times, strips};
use super::super::look;
use super::super::rrd::RrdFile;
use super::vector::{Arrows, Labels};
use super::{Drawn, Picture};
use crate::trace::{Instant, Sample, Subject, brief};
use rerun::archetypes::{Arrows3D, LineStrips3D};
use rerun::components::Radius;

#[derive(Clone)]
pub struct ForcePicture {
    drawn: &'static Drawn,
    /// m per N.
    scale: f64,
    times: Times,
    arrows: Arrows,
    labels: Labels,
    arms: Vec<f32>,
    arm_points: Ends,
}

impl ForcePicture {
    pub fn new(drawn: &'static Drawn, scale: f64) -> Self {
        Self {
            drawn,
            scale,
            times: Times::default(),
            arrows: Arrows::default(),
            labels: Labels::default(),
            arms: Vec::new(),
            arm_points: Ends::default(),
        }
    }
}

impl Picture for ForcePicture {
    fn statics(&self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let arrows = Arrows3D::update_fields()
            .with_colors([self.drawn.colour])
            .with_radii([Radius::new_ui_points(look::BOLD)]);
        let arms = LineStrips3D::update_fields()
            .with_colors([self.drawn.colour])
            .with_radii([Radius::new_ui_points(look::THIN)]);
        let path = format!("/force/{}", subject.name);
        file.statics(format!("{path}/arm"), &[&arms])?;
        file.statics(
            format!("{path}/label"),
            &[&Labels::statics(self.drawn.colour)],
        )?;
        file.statics(path, &[&arrows])
    }

    fn row(&mut self, at: Instant, subject: &Subject, sample: &Sample) {
        let reference = sample.reference_w(subject);
        self.times.push(at);
        for push in &sample.pushes {
            let arrow = push.force_w * self.scale;
            self.arrows.push(push.point_w - arrow, arrow);
            let label = format!(
                "{} {} {}",
                self.drawn.symbol,
                brief(push.force_w.norm()),
                self.drawn.unit
            );
            self.labels.push(push.point_w - arrow * 1.12, label);
            for end in [reference, push.point_w] {
                self.arms.extend(end.iter().map(|&x| x as f32));
            }
            self.arm_points.push(2);
        }
        self.arrows.ends.push(sample.pushes.len());
        self.labels.end_row(sample.pushes.len());
    }

    fn copy(&self) -> Box<dyn Picture> {
        Box::new(self.clone())
    }

    fn rows(&self) -> usize {
        self.times.len()
    }

    fn flush(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let times = std::mem::take(&mut self.times);
        let path = format!("/force/{}", subject.name);
        let ends = self.arrows.ends.clone();
        file.columns(path.as_str(), &times, self.arrows.take())?;
        file.columns(format!("{path}/label"), &times, self.labels.take())?;
        let arms = std::mem::take(&mut self.arms);
        let points = std::mem::take(&mut self.arm_points);
        let arms = strips(LineStrips3D::descriptor_strips(), arms, points, ends);
        file.columns(format!("{path}/arm"), &times, vec![arms])?;
        Ok(())
    }
}
