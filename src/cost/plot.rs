//! The work-precision plot: error against time, both logarithmic, a line a method.

use super::ladder::{Cost, Rung};
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

/// Okabe & Ito's colours, told apart by all eyes; black for a ninth is not needed: shapes alternate.
const COLOURS: [RGBColor; 8] = [
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
    #[error("{path}: the plot cannot be written: {source}; name a place that can be written to")]
    Write {
        path: String,
        source: std::io::Error,
    },
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

fn write(path: &Path, bytes: &[u8]) -> Result<(), PlotError> {
    std::fs::write(path, bytes).map_err(|source| PlotError::Write {
        path: path.display().to_string(),
        source,
    })
}

fn fault(path: &Path, why: String) -> PlotError {
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
    for rung in cost.rungs.iter().filter(|rung| rung.error.is_finite()) {
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
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 22))
        .margin(16)
        .margin_right(180)
        .x_label_area_size(56)
        .y_label_area_size(80)
        .build_cartesian_2d(errors.log_scale(), times.log_scale())
        .map_err(words)?;
    chart
        .configure_mesh()
        .x_desc("largest attitude error (rad)")
        .y_desc("wall time per simulated second (s)")
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .light_line_style(RGBColor(240, 240, 240))
        .bold_line_style(RGBColor(220, 220, 220))
        .draw()
        .map_err(words)?;
    for (k, line) in lines.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let dashed = k >= COLOURS.len();
        let places: Vec<(f64, f64)> = line.rungs.iter().map(|rung| at(rung)).collect();
        let style = colour.stroke_width(2);
        let legend = move |(x, y): (i32, i32)| {
            let marks = [(x, y), (x + 22, y)];
            PathElement::new(marks, style)
        };
        if dashed {
            let series = DashedLineSeries::new(places.iter().copied(), 6, 5, style);
            chart
                .draw_series(series)
                .map_err(words)?
                .label(line.method)
                .legend(legend);
        } else {
            let series = LineSeries::new(places.iter().copied(), style);
            chart
                .draw_series(series)
                .map_err(words)?
                .label(line.method)
                .legend(legend);
        }
        let marks = places.iter().map(|&place| {
            let mark = EmptyElement::at(place);
            match dashed {
                true => mark + Rectangle::new([(-3, -3), (3, 3)], colour.filled()),
                false => mark + Rectangle::new([(-3, -3), (3, 3)], colour.filled()),
            }
        });
        chart.draw_series(marks).map_err(words)?;
    }
    let front = cost
        .rungs
        .iter()
        .filter(|rung| rung.on_front && rung.error.is_finite());
    let rings = front.map(|rung| Circle::new(at(rung), 8, BLACK.stroke_width(1)));
    chart
        .draw_series(rings)
        .map_err(words)?
        .label("no other is both cheaper and truer")
        .legend(|(x, y)| Circle::new((x + 11, y), 6, BLACK.stroke_width(1)));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(RGBColor(200, 200, 200))
        .label_font(("sans-serif", 15))
        .draw()
        .map_err(words)?;
    area.present().map_err(words)
}

/// Once a process.
fn register_typeface() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // It is in the program; were it no font, labels would fail with the drawing's own error.
        let _ = plotters::style::register_font("sans-serif", FontStyle::Normal, TYPEFACE);
    });
}
