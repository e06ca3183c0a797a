//! What was measured, as a table to read and as JSON.

use crate::measure::Timing;
use serde_json::{Value, json};

#[derive(Default)]
pub struct Report {
    sections: Vec<Section>,
}

struct Section {
    name: &'static str,
    about: String,
    rows: Vec<Row>,
}

struct Row {
    name: String,
    value: f64,
    unit: &'static str,
    spread: Option<f64>,
    note: String,
}

impl Report {
    pub fn section(&mut self, name: &'static str, about: impl Into<String>) {
        let (about, rows) = (about.into(), Vec::new());
        self.sections.push(Section { name, about, rows });
    }

    /// A time; `unit` says of what, in ns.
    pub fn time(
        &mut self,
        name: impl Into<String>,
        time: Timing,
        unit: &'static str,
        note: impl Into<String>,
    ) {
        self.row(name.into(), time.ns, unit, Some(time.spread), note.into());
    }

    /// A ratio, or another number that was not read from the clock itself.
    pub fn number(
        &mut self,
        name: impl Into<String>,
        value: f64,
        unit: &'static str,
        note: impl Into<String>,
    ) {
        self.row(name.into(), value, unit, None, note.into());
    }

    fn row(
        &mut self,
        name: String,
        value: f64,
        unit: &'static str,
        spread: Option<f64>,
        note: String,
    ) {
        let section = self.sections.last_mut().expect("a section comes first");
        section.rows.push(Row {
            name,
            value,
            unit,
            spread,
            note,
        });
    }

    pub fn print(&self) {
        for section in &self.sections {
            println!("\n{}: {}", section.name, section.about);
            for row in &section.rows {
                let spread = row
                    .spread
                    .map_or(String::new(), |s| format!("+{:.0}%", 100.0 * s));
                let value = match row.value {
                    v if v == 0.0 || (1e-2..1e6).contains(&v) => format!("{v:.2}"),
                    v => format!("{v:.2e}"),
                };
                println!(
                    "  {:44} {value:>10} {:16} {spread:>6}  {}",
                    row.name, row.unit, row.note
                );
            }
        }
    }

    pub fn json(&self) -> Value {
        let row = |row: &Row| {
            json!({
                "name": row.name, "value": row.value, "unit": row.unit,
                "spread": row.spread, "note": row.note,
            })
        };
        let section = |section: &Section| {
            json!({
                "name": section.name, "about": section.about,
                "rows": section.rows.iter().map(row).collect::<Vec<_>>(),
            })
        };
        json!({ "sections": self.sections.iter().map(section).collect::<Vec<_>>() })
    }
}
