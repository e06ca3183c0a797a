//! The work-precision plot: error against time, both logarithmic, a line a method.

use super::ladder::{Cost, LOST, Rung};
use crate::integrator::METHODS;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::FontStyle;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Once;

/// Pixels.
const SIZE: (u32, u32) = (1100, 760);
/// The free typeface that the program carries (Ubuntu Light).
const TYPEFACE: &[u8] = epaint_default_fonts::UBUNTU_LIGHT;

/// Okabe & Ito's colours, told apart by all eyes, with a darker yellow for a white ground.
pub(crate) const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(150, 140, 40),
];

/// Why there is no plot.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    #[error("{path}: the plot cannot be drawn: {why}")]
    Draw { path: String, why: String },
    #[error("{path}: the plot cannot be written: {why}; name a place that can be written to")]
    Write { path: String, why: String },
    #[error("nothing to plot: no run came to an end")]
    Empty,
}

/// Draws as SVG.
pub fn svg(cost: &Cost, title: &str, path: &Path) -> Result<(), PlotError> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        draw(cost, title, &area).map_err(|why| fault(path, why))?;
    }
    write(path, text.as_bytes())
}

/// Draws as PNG.
pub fn png(cost: &Cost, title: &str, path: &Path) -> Result<(), PlotError> {
    let mut pixels = vec![0_u8; (SIZE.0 * SIZE.1 * 3) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
        draw(cost, title, &area).map_err(|why| fault(path, why))?;
    }
    let mut bytes = Vec::new();
    {
        let mut encoder = png::Encoder::new(BufWriter::new(&mut bytes), SIZE.0, SIZE.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let written = encoder.write_header().and_then(|mut writer| {
            writer.write_image_data(&pixels)?;
            writer.finish()
        });
        written.map_err(|why| fault(path, why.to_string()))?;
    }
    write(path, &bytes)
}

pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), PlotError> {
    std::fs::write(path, bytes).map_err(|error| PlotError::Write {
        path: path.display().to_string(),
        why: error.to_string(),
    })
}

pub(crate) fn fault(path: &Path, why: String) -> PlotError {
    PlotError::Draw {
        path: path.display().to_string(),
        why,
    }
}

/// The rungs of a method that can be drawn, in order of time.
struct Line<'a> {
    method: &'static str,
    rungs: Vec<&'a Rung>,
}

/// Errors below this are drawn at it: a logarithm knows no zero.
const FLOOR: f64 = 1e-16;

fn lines(cost: &Cost) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    for rung in cost
        .rungs
        .iter()
        .filter(|rung| rung.error < LOST && !rung.own)
    {
        match lines.iter_mut().find(|line| line.method == rung.method) {
            Some(line) => line.rungs.push(rung),
            None => lines.push(Line {
                method: rung.method,
                rungs: vec![rung],
            }),
        }
    }
    lines
}

fn at(rung: &Rung) -> (f64, f64) {
    (rung.error.max(FLOOR), rung.time.median)
}

fn draw<B: DrawingBackend>(
    cost: &Cost,
    title: &str,
    area: &DrawingArea<B, Shift>,
) -> Result<(), String> {
    register_typeface();
    let lines = lines(cost);
    let points = || {
        lines
            .iter()
            .flat_map(|line| line.rungs.iter().map(|r| at(r)))
    };
    let range = |of: fn((f64, f64)) -> f64| {
        let (low, high) = points()
            .map(of)
            .fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        (low / 2.0)..(high * 2.0)
    };
    if lines.is_empty() {
        return Err(PlotError::Empty.to_string());
    }
    let (errors, times) = (range(|p| p.0), range(|p| p.1));
    let words = |error: DrawingAreaErrorKind<B::ErrorType>| error.to_string();
    area.fill(&WHITE).map_err(words)?;
    let (chart, legend) = area.split_horizontally(SIZE.0 as i32 - LEGEND);
    let mut chart = ChartBuilder::on(&chart)
        .caption(title, ("sans-serif", 22))
        .margin(16)
        .x_label_area_size(56)
        .y_label_area_size(80)
        .build_cartesian_2d(errors.log_scale(), times.log_scale())
        .map_err(words)?;
    chart
        .configure_mesh()
        .x_desc("largest error (rad)")
        .y_desc("wall time per simulated second (s)")
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .light_line_style(RGBColor(240, 240, 240))
        .bold_line_style(RGBColor(220, 220, 220))
        .draw()
        .map_err(words)?;
    for line in &lines {
        let look = Look::of(line.method);
        let places: Vec<(f64, f64)> = line.rungs.iter().map(|rung| at(rung)).collect();
        let along = places.iter().copied();
        match look.gap {
            0 => chart.draw_series(LineSeries::new(along, look.style())),
            gap => chart.draw_series(DashedLineSeries::new(along, 7, gap, look.style())),
        }
        .map_err(words)?;
        let marks = places
            .iter()
            .map(|&place| EmptyElement::at(place) + look.mark((0, 0)));
        chart.draw_series(marks).map_err(words)?;
    }
    let front = cost.rungs.iter().filter(|rung| rung.on_front);
    if let Some(own) = cost.own().filter(|rung| rung.error < LOST) {
        let cross = Cross::new(at(own), 9, BLACK.stroke_width(3));
        chart.draw_series([cross]).map_err(words)?;
    }
    let rings = front.map(|rung| Circle::new(at(rung), 8, BLACK.stroke_width(1)));
    chart.draw_series(rings).map_err(words)?;
    draw_legend(&lines, cost.own(), &legend).map_err(words)?;
    area.present().map_err(words)
}

/// How a method's line looks, the same in every plot: eight colours; the next eight dashed, with
/// diamonds; the next dotted, with triangles.
struct Look {
    colour: RGBColor,
    /// Pixels between dashes; 0 is an unbroken line.
    gap: i32,
    /// Corners of its marks, pixels.
    corners: &'static [(i32, i32)],
}

const SQUARE: &[(i32, i32)] = &[(-3, -3), (3, -3), (3, 3), (-3, 3)];
const DIAMOND: &[(i32, i32)] = &[(0, -6), (6, 0), (0, 6), (-6, 0)];
const TRIANGLE: &[(i32, i32)] = &[(0, -6), (6, 5), (-6, 5)];
const HOURGLASS: &[(i32, i32)] = &[(-5, -5), (5, -5), (-5, 5), (5, 5)];

impl Look {
    fn of(method: &str) -> Self {
        let k = METHODS.iter().position(|m| m.info().name == method);
        let k = k.unwrap_or(METHODS.len());
        let (gap, corners) =
            [(0, SQUARE), (5, DIAMOND), (14, TRIANGLE), (9, HOURGLASS)][(k / COLOURS.len()).min(3)];
        Self {
            colour: COLOURS[k % COLOURS.len()],
            gap,
            corners,
        }
    }

    fn style(&self) -> ShapeStyle {
        self.colour.stroke_width(2)
    }

    fn mark(&self, (x, y): (i32, i32)) -> Polygon<(i32, i32)> {
        let corners: Vec<(i32, i32)> = self.corners.iter().map(|(a, b)| (x + a, y + b)).collect();
        Polygon::new(corners, self.colour.filled())
    }
}

/// Pixels.
const LEGEND: i32 = 220;
const LINE: i32 = 22;

fn draw_legend<B: DrawingBackend>(
    lines: &[Line<'_>],
    own: Option<&Rung>,
    area: &DrawingArea<B, Shift>,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let words = ("sans-serif", 15).into_font().color(&BLACK);
    for (k, line) in lines.iter().enumerate() {
        let (look, y) = (Look::of(line.method), 52 + LINE * k as i32);
        let dash = if look.gap == 0 { 34 } else { 7 };
        let mut x = 4;
        while x < 38 {
            let end = (x + dash).min(38);
            area.draw(&PathElement::new([(x, y), (end, y)], look.style()))?;
            x = end + look.gap.max(1);
        }
        area.draw(&look.mark((21, y)))?;
        area.draw(&Text::new(line.method, (46, y - 8), words.clone()))?;
    }
    let y = 58 + LINE * lines.len() as i32;
    area.draw(&Circle::new((21, y), 8, BLACK.stroke_width(1)))?;
    area.draw(&Text::new("no other is both", (46, y - 8), words.clone()))?;
    area.draw(&Text::new("cheaper and truer", (46, y + 9), words.clone()))?;
    if let Some(own) = own {
        let y = y + 44;
        if own.error < LOST {
            area.draw(&Cross::new((21, y), 9, BLACK.stroke_width(3)))?;
        }
        area.draw(&Text::new("your scene:", (46, y - 8), words.clone()))?;
        area.draw(&Text::new(own.setting(), (46, y + 9), words.clone()))?;
        if own.error >= LOST {
            area.draw(&Text::new("(a radian off or more)", (46, y + 26), words))?;
        }
    }
    Ok(())
}

/// Once a process.
pub(crate) fn register_typeface() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // It is in the program; were it no font, labels would fail with the drawing's own error.
        let _ = plotters::style::register_font("sans-serif", FontStyle::Normal, TYPEFACE);
    });
}
