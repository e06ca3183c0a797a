//! What kind of file it is, by how it begins.

/// How a log is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table with a header, and this between its fields.
    Csv(u8),
    /// An object a line.
    JsonLines,
}

/// What a file is that is no log, and what to do.
pub(super) struct Other {
    pub what: &'static str,
    pub remedy: &'static str,
}

const CSV: &str = "a log is a table (CSV) or an object a line (JSON lines)";
const CONVERT: &str = "turn it into CSV first: docs/logs.md says how";

/// Beginnings that are known.
const KNOWN: [(&[u8], &str, &str); 19] = [
    (b"\x89PNG", "a picture (PNG)", CSV),
    (b"\xff\xd8\xff", "a picture (JPEG)", CSV),
    (
        b"RRF",
        "a recording of Rerun",
        "look into it: torquescope inspect",
    ),
    (
        b"RRIO",
        "a recording of Rerun",
        "look into it: torquescope inspect",
    ),
    (b"\x89MCAP", "an MCAP file", CONVERT),
    (b"ULog", "a ULog file of PX4", CONVERT),
    (b"#ROSBAG", "a bag of ROS", CONVERT),
    (
        b"SQLite format 3",
        "a database (SQLite), such as a bag of ROS 2",
        CONVERT,
    ),
    (b"PAR1", "a Parquet file", CONVERT),
    (b"\x89HDF", "an HDF5 file", CONVERT),
    (b"\x93NUMPY", "an array of NumPy", CONVERT),
    (b"\x1f\x8b", "packed (gzip)", "unpack it: gunzip -c FILE"),
    (
        b"\x28\xb5\x2f\xfd",
        "packed (Zstandard)",
        "unpack it: zstd -dc FILE",
    ),
    (
        b"PK\x03\x04",
        "packed (ZIP), or a workbook (XLSX)",
        "unpack it, or save it as CSV",
    ),
    (b"\xff\xfe", "text in UTF-16", "save it as UTF-8"),
    (b"\xfe\xff", "text in UTF-16", "save it as UTF-8"),
    (b"%PDF", "a PDF", CSV),
    (b"\x7fELF", "a program", CSV),
    (
        b"<",
        "XML or HTML",
        "a robot's description is given beside a log, not as one",
    ),
];

/// What the first bytes say it is, if it is no log. `line`: the first one that holds something.
pub(super) fn other(head: &[u8], line: &[u8]) -> Option<Other> {
    let known = KNOWN.iter().find(|(begins, ..)| head.starts_with(begins));
    if let Some((_, what, remedy)) = known {
        return Some(Other { what, remedy });
    }
    let is_control = |b: &u8| *b < 0x20 && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0c);
    if line.iter().any(is_control) {
        return Some(Other {
            what: "not text",
            remedy: CSV,
        });
    }
    if std::str::from_utf8(line).is_err() {
        return Some(Other {
            what: "not text in UTF-8",
            remedy: "save it as UTF-8",
        });
    }
    let line = line.trim_ascii();
    let is_table =
        line.starts_with(b"[") && line.ends_with(b"]") && !line.contains(&b'{') && line.len() > 2;
    let key = line
        .split(|b| *b == b'=')
        .next()
        .unwrap_or_default()
        .trim_ascii();
    let is_word = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-' | b'.');
    let is_value = line.contains(&b'=') && !key.is_empty() && key.iter().all(is_word);
    if (is_table && !line.contains(&b',')) || is_value {
        return Some(Other {
            what: "TOML: a scene, or a file of bodies",
            remedy: "a scene is run: torquescope run; bodies are given beside a log",
        });
    }
    None
}

/// How a log is written, by its first line that holds something.
pub(super) fn format(line: &[u8]) -> Format {
    let line = line.trim_ascii();
    if line.starts_with(b"{") || line.starts_with(b"[") && (line.len() == 1 || line.contains(&b'{'))
    {
        return Format::JsonLines;
    }
    // Outside quotes.
    let count = |delimiter: u8| {
        let mut quoted = false;
        let between = |b: &&u8| {
            quoted ^= **b == b'"';
            !quoted && **b == delimiter
        };
        line.iter().filter(between).count()
    };
    let best = [b',', b';', b'\t']
        .into_iter()
        .rev()
        .max_by_key(|d| count(*d));
    Format::Csv(best.unwrap_or(b','))
}
