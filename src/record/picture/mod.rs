//! What streams draw. One line each in [`DRAWN`]: the text panel, the scales, the views and the
//! pictures all read that table.

mod force;
mod impulse;
mod vector;

pub use impulse::Impulses;
pub use vector::{Shown, VectorPicture};

use super::RecordError;
use super::look::{self, Colour};
use super::rrd::RrdFile;
use super::scale::Scales;
use crate::sim::Sizes;
use crate::trace::{Instant, Sample, StreamSet, Subject};
use nalgebra::Vector3;
use std::sync::Arc;

/// A stream that is drawn as arrows.
pub struct Drawn {
    /// The stream, and the first part of its entities' paths.
    pub stream: &'static str,
    pub symbol: &'static str,
    pub unit: &'static str,
    pub colour: Colour,
    /// How the text panel explains it.
    pub meaning: &'static str,
    /// Shown only when its eye is clicked.
    pub hidden: bool,
    /// Length of the largest arrow, in radii of a typical body: long enough to stick out of a
    /// solid mesh, and different where two vectors lie along one axis.
    pub reach: f64,
    /// The largest magnitude to expect.
    pub size: fn(&Sizes) -> f64,
    pub glyph: Glyph,
}

/// How an arrow is drawn.
#[derive(Clone, Copy)]
pub enum Glyph {
    /// At each push, ending where it pushes, with its lever arm.
    Push,
    /// From the reference point.
    Arrow(fn(&Subject, &Sample) -> Vector3<f64>),
    /// From the reference point, with an arrow that turns about it.
    Turning(fn(&Subject, &Sample) -> Vector3<f64>),
}

/// Every stream that is drawn as arrows.
pub const DRAWN: [Drawn; 5] = [
    Drawn {
        stream: "force",
        symbol: "F",
        unit: "N",
        colour: look::FORCE,
        meaning: "**red arrow**: a push F, ending where it pushes; the thin line is its lever arm",
        hidden: false,
        reach: 1.6,
        size: |s| s.force,
        glyph: Glyph::Push,
    },
    Drawn {
        stream: "torque",
        symbol: "τ",
        unit: "N·m",
        colour: look::TORQUE,
        meaning: "**purple, with a turning arrow**: torque τ about its axis",
        hidden: false,
        reach: 1.8,
        size: |s| s.torque,
        glyph: Glyph::Turning(|_, sample| sample.tau_w),
    },
    Drawn {
        stream: "alpha",
        symbol: "α",
        unit: "rad/s²",
        colour: look::ALPHA,
        meaning: "**amber arrow**: angular acceleration α",
        hidden: false,
        reach: 2.4,
        size: |s| s.alpha,
        glyph: Glyph::Arrow(|_, sample| sample.alpha_w),
    },
    Drawn {
        stream: "omega",
        symbol: "ω",
        unit: "rad/s",
        colour: look::OMEGA,
        meaning: "**teal arrow**: angular velocity ω",
        hidden: true,
        reach: 2.4,
        size: |s| s.omega,
        glyph: Glyph::Arrow(|_, sample| sample.motion.omega_w),
    },
    Drawn {
        stream: "momentum",
        symbol: "L",
        unit: "kg m²/s",
        colour: look::MOMENTUM,
        meaning: "**blue arrow**: angular momentum L",
        hidden: true,
        reach: 1.8,
        size: |s| s.momentum,
        glyph: Glyph::Arrow(|subject, sample| subject.momentum_w(&sample.motion)),
    },
];

/// The drawing of one quantity of one body.
pub trait Picture: Send {
    /// Writes what does not change.
    fn statics(&self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError>;

    /// Adds what is seen at an instant.
    fn row(&mut self, at: Instant, subject: &Subject, sample: &Sample);

    /// The same, with what was added.
    fn copy(&self) -> Box<dyn Picture>;

    /// How many instants were added.
    fn rows(&self) -> usize;

    /// Writes what was added.
    fn flush(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError>;
}

impl Clone for Box<dyn Picture> {
    fn clone(&self) -> Self {
        // Of what is in the box, not of the box.
        self.as_ref().copy()
    }
}

/// The pictures of the chosen streams for one body.
pub fn pictures(streams: StreamSet, scales: &Scales) -> Vec<Box<dyn Picture>> {
    let chosen = DRAWN.iter().filter(|drawn| streams.contains(drawn.stream));
    chosen
        .map(|drawn| -> Box<dyn Picture> {
            let scale = scales.of(drawn);
            let vector = |value: fn(&Subject, &Sample) -> Vector3<f64>| {
                VectorPicture::new(Shown {
                    stream: drawn.stream.to_owned(),
                    symbol: drawn.symbol.to_owned(),
                    unit: drawn.unit,
                    colour: drawn.colour,
                    scale,
                    value: Arc::new(value),
                })
            };
            match drawn.glyph {
                Glyph::Push => Box::new(force::ForcePicture::new(drawn, scale)),
                Glyph::Arrow(value) => Box::new(vector(value)),
                Glyph::Turning(value) => Box::new(vector(value).turning()),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_drawn_stream_is_a_stream_with_a_colour_of_its_own() {
        for (k, drawn) in DRAWN.iter().enumerate() {
            assert!(StreamSet::of(drawn.stream).is_some(), "{}", drawn.stream);
            assert!(DRAWN[..k].iter().all(|other| other.colour != drawn.colour));
        }
    }
}
