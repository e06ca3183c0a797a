//! The work-precision plot as things in the plane: error to the right, time upwards, a unit a decade.

use super::RecordError;
use super::look;
use super::rrd::RrdFile;
use crate::cost::{Cost, LOST, Rung};
use rerun::archetypes::{LineStrips2D, Points2D};
use rerun::components::Radius;

/// Where it hangs.
pub const PATH: &str = "/price";

/// A decade of time is drawn as many times longer than one of error: there are fewer of them.
const STRETCH: f32 = 2.0;
/// A logarithm knows no zero.
const FLOOR: f64 = 1e-17;

fn place(error: f64, time: f64) -> [f32; 2] {
    let log = |x: f64| x.max(FLOOR).log10() as f32;
    // The plane's y points down.
    [log(error), -STRETCH * log(time)]
}

fn shown(rung: &&Rung) -> bool {
    rung.error < LOST && !rung.own
}

pub fn write(file: &mut RrdFile, cost: &Cost) -> Result<(), RecordError> {
    let rungs: Vec<&Rung> = cost.rungs.iter().filter(shown).collect();
    grid(file, &rungs)?;
    let mut methods: Vec<&'static str> = rungs.iter().map(|rung| rung.method).collect();
    methods.dedup();
    for (k, method) in methods.iter().enumerate() {
        let colour = look::BODIES[k % look::BODIES.len()];
        let own = rungs.iter().filter(|rung| rung.method == *method);
        let places: Vec<[f32; 2]> = own.clone().map(|r| place(r.error, r.time.median)).collect();
        let line = LineStrips2D::new([places.clone()])
            .with_colors([colour])
            .with_radii([Radius::new_ui_points(1.0)]);
        let marks = Points2D::new(places)
            .with_colors([colour])
            .with_labels(own.map(|rung| rung.setting()))
            .with_show_labels(false)
            .with_radii([Radius::new_ui_points(4.0)]);
        file.statics(format!("{PATH}/{method}"), &[&line])?;
        file.statics(format!("{PATH}/{method}/settings"), &[&marks])?;
        let best = rungs.iter().filter(|rung| rung.method == *method);
        if let Some(last) = best.min_by(|a, b| a.error.total_cmp(&b.error)) {
            let label = Points2D::new([place(last.error, last.time.median)])
                .with_labels([*method])
                .with_show_labels(true)
                .with_colors([colour])
                .with_radii([Radius::new_ui_points(5.0)]);
            file.statics(format!("{PATH}/{method}/name"), &[&label])?;
        }
    }
    Ok(())
}

/// Lines at whole decades, with what they stand for.
fn grid(file: &mut RrdFile, rungs: &[&Rung]) -> Result<(), RecordError> {
    let span = |of: fn(&Rung) -> f64| {
        let logs = rungs.iter().map(|rung| of(rung).max(FLOOR).log10());
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
        (low.floor() as i32, high.ceil() as i32)
    };
    if rungs.is_empty() {
        return Ok(());
    }
    let (errors, times) = (span(|r| r.error), span(|r| r.time.median));
    let at = |error: i32, time: i32| [error as f32, -STRETCH * time as f32];
    let mut lines = Vec::new();
    let mut labels = Vec::new();
    for error in errors.0..=errors.1 {
        lines.push([at(error, times.0), at(error, times.1)]);
        if error % 2 == 0 {
            let [x, y] = at(error, times.0);
            labels.push(([x, y + 0.5], format!("1e{error} rad")));
        }
    }
    for time in times.0..=times.1 {
        lines.push([at(errors.0, time), at(errors.1, time)]);
        let [x, y] = at(errors.0, time);
        labels.push(([x - 1.2, y], format!("1e{time} s a second")));
    }
    let lines = LineStrips2D::new(lines)
        .with_colors([look::GRID])
        .with_radii([Radius::new_ui_points(0.5)]);
    file.statics(format!("{PATH}/grid"), &[&lines])?;
    let (places, texts): (Vec<[f32; 2]>, Vec<String>) = labels.into_iter().unzip();
    let texts = Points2D::new(places)
        .with_labels(texts)
        .with_show_labels(true)
        .with_colors([look::NAME])
        .with_radii([Radius::new_ui_points(0.0)]);
    file.statics(format!("{PATH}/grid/decades"), &[&texts])
}
