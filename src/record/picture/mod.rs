//! What a stream draws. One file per kind of picture, one line in [`pictures`].

mod force;
mod vector;

use super::RecordError;
use super::look;
use super::rrd::RrdFile;
use super::scale::Scales;
use crate::trace::{Instant, Moment, StreamSet, Subject};
use vector::VectorPicture;

/// The drawing of one quantity of one body.
pub trait Picture {
    /// Writes what does not change.
    fn statics(&self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError>;

    /// Adds what is seen at an instant.
    fn row(&mut self, at: Instant, subject: &Subject, moment: &Moment);

    /// Writes what was added.
    fn flush(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError>;
}

/// The pictures of the chosen streams for one body.
pub fn pictures(streams: StreamSet, scales: &Scales) -> Vec<Box<dyn Picture>> {
    let all: [(&str, Box<dyn Picture>); 5] = [
        ("force", Box::new(force::ForcePicture::new(scales.force))),
        (
            "torque",
            Box::new(
                VectorPicture::new(
                    "torque",
                    "τ",
                    "N·m",
                    scales.torque,
                    look::TORQUE,
                    |_, m| m.tau_w,
                )
                .turning(),
            ),
        ),
        (
            "alpha",
            Box::new(VectorPicture::new(
                "alpha",
                "α",
                "rad/s²",
                scales.alpha,
                look::ALPHA,
                |_, m| m.alpha_w,
            )),
        ),
        (
            "omega",
            Box::new(VectorPicture::new(
                "omega",
                "ω",
                "rad/s",
                scales.omega,
                look::OMEGA,
                |_, m| m.motion.omega_w,
            )),
        ),
        (
            "momentum",
            Box::new(VectorPicture::new(
                "momentum",
                "L",
                "kg m²/s",
                scales.momentum,
                look::MOMENTUM,
                |s, m| s.momentum_w(&m.motion),
            )),
        ),
    ];
    let chosen = all
        .into_iter()
        .filter(|(stream, _)| streams.contains(stream));
    chosen.map(|(_, picture)| picture).collect()
}
