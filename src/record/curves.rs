//! Numbers against time, drawn as an SVG.

use super::inspect::Curve;
use crate::cost::plot::{COLOURS, PlotError, fault, register_typeface, write};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::ops::Range;
use std::path::Path;

/// Pixels.
const SIZE: (u32, u32) = (1100, 560);
const LEGEND: i32 = 200;
const LINE: i32 = 22;

/// Points that a line is drawn with at most: the least and the greatest of what falls between two
/// pixels stay.
const POINTS: usize = 4_000;

/// What stands beside the lines.
pub struct PlotText<'a> {
    pub title: &'a str,
    pub across: &'a str,
    pub up: &'a str,
}

/// Draws one line a curve.
pub fn plot(curves: &[Curve], text: &PlotText<'_>, path: &Path) -> Result<(), PlotError> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        draw(curves, text, &area).map_err(|why| fault(path, why))?;
    }
    write(path, svg.as_bytes())
}

fn draw<B: DrawingBackend>(
    curves: &[Curve],
    text: &PlotText<'_>,
    area: &DrawingArea<B, Shift>,
) -> Result<(), String> {
    register_typeface();
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (Some(across), Some(up)) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)))
    else {
        return Err("there is no finite number to plot".to_owned());
    };
    let words = |error: DrawingAreaErrorKind<B::ErrorType>| error.to_string();
    area.fill(&WHITE).map_err(words)?;
    let (chart, legend) = area.split_horizontally(SIZE.0 as i32 - LEGEND);
    let room = 0.04 * (up.end - up.start);
    let (tick_across, tick_up) = (digits(&across), digits(&up));
    let mut chart = ChartBuilder::on(&chart)
        .caption(text.title, ("sans-serif", 20))
        .margin(16)
        .x_label_area_size(52)
        .y_label_area_size(86)
        .build_cartesian_2d(across, (up.start - room)..(up.end + room))
        .map_err(words)?;
    chart
        .configure_mesh()
        .x_desc(text.across)
        .y_desc(text.up)
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .x_label_formatter(&|x| tick_across.write(*x))
        .y_label_formatter(&|y| tick_up.write(*y))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()
        .map_err(words)?;
    for (k, curve) in curves.iter().enumerate() {
        let line = LineSeries::new(thinned(&curve.points), style(curves, k));
        chart.draw_series(line).map_err(words)?;
    }
    draw_legend(curves, &legend).map_err(words)?;
    area.present().map_err(words)
}

/// Lines that stand on others are told apart by colour; what lies under them is wide and pale.
fn style(curves: &[Curve], k: usize) -> ShapeStyle {
    let under = curves[..k].iter().filter(|curve| curve.under).count();
    match curves[k].under {
        true => RGBColor(190, 190, 190).stroke_width(6),
        false => COLOURS[(k - under) % COLOURS.len()].stroke_width(2),
    }
}

fn draw_legend<B: DrawingBackend>(
    curves: &[Curve],
    area: &DrawingArea<B, Shift>,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let words = ("sans-serif", 15).into_font().color(&BLACK);
    let most = ((SIZE.1 as i32 - 80) / LINE).max(1) as usize;
    for (k, curve) in curves.iter().take(most).enumerate() {
        let y = 46 + LINE * k as i32;
        let name = match k + 1 == most && curves.len() > most {
            true => format!("and {} more", curves.len() - k),
            false => {
                area.draw(&PathElement::new([(2, y), (28, y)], style(curves, k)))?;
                curve.name.clone()
            }
        };
        area.draw(&Text::new(name, (36, y - 8), words.clone()))?;
    }
    Ok(())
}

/// From the least to the greatest; some room where they are the same.
fn range(values: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    if low > high {
        return None;
    }
    // Differences of what is finite may be none.
    let (low, high) = (low.max(-1e300), high.min(1e300));
    let room = match high - low <= 1e-12 * high.abs().max(low.abs()) {
        true => (0.5 * high.abs()).max(f64::MIN_POSITIVE * 1e10),
        false => 0.0,
    };
    match (low, high) {
        (0.0, 0.0) => Some(-1.0..1.0),
        _ => Some((low - room)..(high + room)),
    }
}

/// How the numbers of an axis are written.
struct Digits {
    decimals: usize,
    scientific: bool,
}

fn digits(range: &Range<f64>) -> Digits {
    let span = range.end - range.start;
    let largest = range.start.abs().max(range.end.abs());
    Digits {
        // Some ten marks on the axis, to be told apart.
        decimals: (1.5 - span.log10()).clamp(0.0, 12.0) as usize,
        scientific: !(1e-3..1e6).contains(&largest) || span < 1e-4 * largest,
    }
}

impl Digits {
    fn write(&self, x: f64) -> String {
        match self.scientific {
            true if x == 0.0 => "0".to_owned(),
            true => format!("{x:.2e}"),
            false => format!("{:.*}", self.decimals, x + 0.0),
        }
    }
}

/// The first, the least, the greatest and the last of each of many pieces.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= POINTS {
        return points.to_vec();
    }
    let piece = points.len().div_ceil(POINTS / 4);
    let ends = points.chunks(piece).flat_map(|piece| {
        let by = |a: &usize, b: &usize| piece[*a].1.total_cmp(&piece[*b].1);
        let least = (0..piece.len()).min_by(by).unwrap_or(0);
        let most = (0..piece.len()).max_by(by).unwrap_or(0);
        let mut kept = [0, least, most, piece.len() - 1];
        kept.sort_unstable();
        kept.map(|k| piece[k])
    });
    ends.collect()
}
