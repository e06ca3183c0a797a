//! The scene reader under scenes that something has happened to: no panic, no hang, memory bounded, every
//! refusal with a place, and the schema takes whatever the reader takes.
//!
//! `TORQUESCOPE_MUTATIONS=1000000 cargo test --release --no-default-features --test mutations` tries a million;
//! `TORQUESCOPE_MUTATION=SEED` one of them, and prints it. fuzz/ goes on from there with coverage.

#[path = "common/json.rs"]
mod json;

use std::alloc::System;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{LazyLock, Mutex};
use std::time::{Duration, Instant};
use torquescope::scene::{Enclosure, Script};

#[global_allocator]
static MEMORY: cap::Cap<System> = cap::Cap::new(System, usize::MAX);

/// As many as take some fifteen seconds on two cores in the dev profile, where the TOML parser is not
/// optimised at all.
const MUTATIONS: u64 = 10_000;
/// Bytes that all threads may hold at once, the validators included.
const MEMORY_AT_MOST: usize = 1 << 25;
/// A scene of a few kilobytes is read in milliseconds; this is for a machine that does other things.
const LONGEST: Duration = Duration::from_secs(30);

/// splitmix64 (Steele, Lea & Flood): a stream from any seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to below `end`; 0 where that is 0.
    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn one<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        &of[self.below(of.len())]
    }

    /// A stretch of at most `most` of so many.
    fn range(&mut self, length: usize, most: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        start..(start + self.below(most + 1)).min(length)
    }
}

/// Every shipped scene and fixture; the right ones first, and how many they are.
fn corpus() -> (Vec<String>, usize) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |folder: &str| {
        let entries = std::fs::read_dir(root.join(folder)).unwrap();
        let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
        paths.sort();
        let texts = paths
            .iter()
            .map(|path| std::fs::read_to_string(path).unwrap());
        texts.collect::<Vec<String>>()
    };
    let right = ["scenes", "tests/fixtures/right", "src/cli"]
        .map(read)
        .concat();
    let count = right.len();
    let all = [right, read("tests/fixtures/wrong")].concat();
    assert!(count >= 10 && all.len() > 25, "{count} {}", all.len());
    (all, count)
}

/// The files that those scenes name, by the names they have for them.
static FILES: LazyLock<Vec<Enclosure>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let named = [
        ("t_handle.obj", "scenes/t_handle.obj"),
        ("../../../scenes/t_handle.obj", "scenes/t_handle.obj"),
        ("../robots/arm.urdf", "tests/fixtures/robots/arm.urdf"),
        ("../robots/arm.xml", "tests/fixtures/robots/arm.xml"),
    ];
    let read =
        |(name, path): (&str, &str)| Enclosure::new(name, std::fs::read(root.join(path)).unwrap());
    named.map(read).into()
});

fn script(text: &str) -> Script {
    Script::new("s", "s", text).with_files(FILES.clone())
}

/// What stands in place of a number.
const NUMBERS: [&str; 24] = [
    "0",
    "-0.0",
    "1e308",
    "-1e308",
    "1e-320",
    "1e400",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999999999999999999999999",
    "0x7fffffffffffffff",
    "0b1",
    "1_000",
    "1e-9",
    "1e-150",
    "1e150",
    "1",
    "-1",
    "0.1",
    "3",
    "1e9",
];

/// What stands in place of a value.
const VALUES: [&str; 16] = [
    "true",
    "\"\"",
    "[]",
    "{}",
    "[[]]",
    "[1, 2, 3]",
    "[0, 0, 0, 1]",
    "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
    "\"infinite\"",
    "\"every\"",
    "\"body\"",
    "\"centre\"",
    "1979-05-27",
    "{ body = \"apex\" }",
    "{ cone = { radius = 1, height = 1 } }",
    "'''\n\u{1b}[2J\u{202e}質量'''",
];

/// Where a text has what satisfies a condition, unbroken.
fn runs(text: &[u8], is: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (k, &byte) in text.iter().chain([&b'\n']).enumerate() {
        match (is(byte), start) {
            (true, None) => start = Some(k),
            (false, Some(from)) => {
                found.push(from..k);
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Does something to a text.
fn mutate(text: &mut Vec<u8>, corpus: &[String], words: &[String], random: &mut Random) {
    let lines = |text: &[u8]| runs(text, |byte| byte != b'\n');
    let is_number = |byte: u8| byte.is_ascii_digit() || b"+-._e".contains(&byte);
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || b"_-".contains(&byte);
    let with = |text: &mut Vec<u8>, at: std::ops::Range<usize>, what: &[u8]| {
        let end = at.end.min(text.len());
        text.splice(at.start.min(end)..end, what.iter().copied());
    };
    match random.below(14) {
        0 => {
            let at = random.below(text.len());
            if let Some(byte) = text.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        1 => {
            let at = random.below(text.len() + 1);
            with(text, at..at, &[random.next() as u8]);
        }
        2 => {
            let range = random.range(text.len(), 30);
            with(text, range, b"");
        }
        3 => text.truncate(random.below(text.len() + 1)),
        // A stretch of lines: doubled, moved, lost.
        kind @ 4..=6 => {
            let all = lines(text);
            if all.is_empty() {
                return;
            }
            let some = random.range(all.len() - 1, 12);
            let range = all[some.start].start..all[some.end].end;
            let mut what = text[range.clone()].to_vec();
            what.push(b'\n');
            if kind != 4 {
                with(text, range, b"");
            }
            if kind != 6 {
                let all = lines(text);
                let at = all
                    .get(random.below(all.len()))
                    .map_or(0, |line| line.start);
                with(text, at..at, &what);
            }
        }
        // Numbers most of all: what is read is mostly numbers.
        7..=9 => {
            let all: Vec<_> = runs(text, is_number)
                .into_iter()
                .filter(|run| text[run.clone()].iter().any(u8::is_ascii_digit))
                .collect();
            if !all.is_empty() {
                let at = random.one(&all).clone();
                with(text, at, random.one(&NUMBERS).as_bytes());
            }
        }
        10 => {
            let all = runs(text, is_word);
            if !all.is_empty() {
                let at = random.one(&all).clone();
                with(text, at, random.one(words).as_bytes());
            }
        }
        11 => {
            // The value of a line.
            let all = lines(text);
            let line = all.get(random.below(all.len())).cloned().unwrap_or(0..0);
            if let Some(sign) = text[line.clone()].iter().position(|&byte| byte == b'=') {
                with(
                    text,
                    line.start + sign + 1..line.end,
                    random.one(&VALUES).as_bytes(),
                );
            }
        }
        12 => {
            // Another scene's lines.
            let other = random.one(corpus).as_bytes();
            let all = lines(other);
            let some = random.range(all.len().saturating_sub(1), 20);
            let range = all.get(some.start).map_or(0, |line| line.start)
                ..all.get(some.end).map_or(0, |line| line.end);
            let what = [b"\n", &other[range], b"\n"].concat();
            let at = random.below(text.len() + 1);
            with(text, at..at, &what);
        }
        _ => {
            let depth = 1 << random.below(10);
            let (open, close) =
                *random.one(&[("[", "]"), ("{a=", "}"), ("a.", ""), ("[[a]]\n", "")]);
            let what = open.repeat(depth) + "1" + &close.repeat(random.below(2) * depth);
            let at = random.below(text.len() + 1);
            with(text, at..at, what.as_bytes());
        }
    }
}

/// The scene that comes of a seed: mostly a right one, to which one thing or several have happened.
fn mutant(seed: u64, (corpus, right): (&[String], usize), words: &[String]) -> String {
    let mut random = Random(seed);
    let from = match random.below(8) {
        0 => corpus,
        _ => &corpus[..right],
    };
    let mut text = random.one(from).clone().into_bytes();
    for _ in 0..=random.below(8).saturating_sub(4) {
        mutate(&mut text, corpus, words, &mut random);
    }
    String::from_utf8_lossy(&text).into_owned()
}

/// A validator of docs/scene.schema.json.
struct Schema {
    schemas: boon::Schemas,
    index: boon::SchemaIndex,
}

impl Schema {
    fn new() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.schema.json");
        let schema = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let (mut schemas, mut compiler) = (boon::Schemas::new(), boon::Compiler::new());
        compiler.add_resource("scene.json", schema).unwrap();
        let index = compiler.compile("scene.json", &mut schemas).unwrap();
        Self { schemas, index }
    }
}

/// Reads a scene; whether it was right.
fn read(text: &str, schema: &Schema) -> bool {
    match script(text).judge() {
        Ok((scenes, warnings)) => {
            assert!(!scenes.is_empty());
            for scene in &scenes {
                assert!(scene.duration.is_finite() && scene.step > 0.0);
            }
            for warning in &warnings {
                assert!(warning.to_string().starts_with("s:") && warning.to_string().len() < 4_000);
            }
            let document = json::document(text).expect("a scene is TOML");
            if let Err(why) = schema.schemas.validate(&document, schema.index) {
                panic!("the reader takes it, the schema does not: {why}");
            }
            true
        }
        Err(problems) => {
            let said = problems.to_string();
            assert!(said.len() < 100_000 && !problems.is_empty());
            for line in said.lines() {
                assert!(line.starts_with("s:") || line.starts_with("  "), "{line}");
            }
            false
        }
    }
}

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().expect("a number"))
}

/// One test, because memory is counted for the whole process.
#[test]
fn mutated_scenes_are_read_or_refused() {
    let (corpus, right_ones) = corpus();
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-';
    let mut words: Vec<String> = corpus
        .iter()
        .flat_map(|text| {
            runs(text.as_bytes(), is_word)
                .into_iter()
                .map(|run| text[run].to_owned())
        })
        .collect();
    words.sort();
    words.dedup();
    if let Some(seed) = number("TORQUESCOPE_MUTATION") {
        let text = mutant(seed, (&corpus, right_ones), &words);
        println!("{text}");
        println!("right: {}", read(&text, &Schema::new()));
        return;
    }
    let count = number("TORQUESCOPE_MUTATIONS").unwrap_or(MUTATIONS);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let (next, right) = (AtomicU64::new(0), AtomicU64::new(0));
    let slowest = Mutex::new((Duration::ZERO, 0));
    let before = MEMORY.allocated();
    let began = Instant::now();
    // Beyond it an allocation fails, and the test ends there and then; a panic that shows its way takes some.
    MEMORY.set_limit(before + (1 << 30)).unwrap();
    std::thread::scope(|scope| {
        let work = || {
            let schema = Schema::new();
            loop {
                let seed = next.fetch_add(1, Ordering::Relaxed);
                if seed >= count {
                    break;
                }
                let text = mutant(seed, (&corpus, right_ones), &words);
                let since = Instant::now();
                let done =
                    std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| read(&text, &schema)));
                match done {
                    Ok(true) => drop(right.fetch_add(1, Ordering::Relaxed)),
                    Ok(false) => {}
                    Err(_) => panic!("TORQUESCOPE_MUTATION={seed} shows the scene"),
                }
                let mut slowest = slowest.lock().unwrap();
                *slowest = (*slowest).max((since.elapsed(), seed));
            }
        };
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    MEMORY.set_limit(usize::MAX).unwrap();
    let (longest, seed) = *slowest.lock().unwrap();
    let most = MEMORY.max_allocated().saturating_sub(before);
    let right = right.into_inner();
    println!(
        "{count} mutated scenes in {:.1?} on {threads} threads: {right} right, the slowest {longest:.1?} (seed {seed}), memory at most {most} bytes",
        began.elapsed()
    );
    assert!(
        longest < LONGEST,
        "TORQUESCOPE_MUTATION={seed} takes {longest:?}"
    );
    // A good part is right, or the mutations are so wild that nothing but the parser is tested.
    assert!(right > count / 10 && right < count, "{right} of {count}");
    assert!(most < MEMORY_AT_MOST, "{most} bytes");
    deep_and_wide();
}

/// Texts of a quarter of a megabyte that are deep, or wide, or wrong all over: read or refused by no more
/// than so many bytes of memory for each of theirs, and none by a stack that overflows.
fn deep_and_wide() {
    const LENGTH: usize = 1 << 18;
    const BYTES_EACH: usize = 320;
    let fill = |unit: &str| unit.repeat(LENGTH / unit.len());
    let numbered = |unit: &str| -> String {
        let units = (0..).map(|k| unit.replace('#', &format!("{k}")));
        let mut text = String::new();
        units
            .take_while(|unit| {
                text += unit;
                text.len() < LENGTH
            })
            .for_each(drop);
        text
    };
    let body = "[[body]]\nname = \"b#\"\nmass = 1\ninertia = [1, 1, 1]\n";
    let texts = [
        ("arrays in arrays", format!("a = {}", fill("["))),
        (
            "arrays in arrays, closed",
            format!("a = {}{}", fill("["), fill("]")),
        ),
        (
            "tables in tables",
            format!("a = {}1{}", fill("{a="), fill("}")),
        ),
        ("dotted keys", format!("{}a = 1", fill("a."))),
        ("a dotted header", format!("[{}a]", fill("a."))),
        ("zeros", format!("position = [{}]", fill("0,"))),
        ("empty tables", format!("body = [{}]", fill("{},"))),
        ("headers", fill("[[body]]\n")),
        ("keys", numbered("k# = 1\n")),
        ("wrong values", numbered("k# = 1x\n")),
        ("signs", fill("= = =\n")),
        ("open quotes", fill("a = \"\n")),
        ("the same key", fill("a = 1\n")),
        (
            "one line",
            format!("title = \"{}\"\nduration = -1", fill("質")),
        ),
        ("bodies", format!("duration = 1\n{}", numbered(body))),
        (
            "bodies of one name",
            format!("duration = 1\n{}", fill(&body.replace('#', ""))),
        ),
        (
            "events on nobody",
            format!(
                "duration = 1\n{}{}",
                numbered(body),
                numbered("[[event]]\nat = 0\nbody = \"c#\"\ntorque = [1, 0, 0]\n")
            ),
        ),
        (
            "events",
            format!(
                "duration = 1\n[stepping]\nmethod = \"closed-form\"\n{}{}",
                numbered(body),
                numbered("[[event]]\nat = 0\nbody = \"b1\"\ntorque = [0, 0, 0]\n")
            ),
        ),
    ];
    for (what, text) in texts {
        let before = MEMORY.allocated();
        let limit = before + BYTES_EACH * text.len();
        MEMORY.set_limit(limit).unwrap();
        let since = Instant::now();
        let said = match script(&text).judge() {
            Ok((scenes, warnings)) => {
                let bodies = scenes[0].bodies.len();
                format!("{bodies} bodies, {} warnings", warnings.len())
            }
            Err(problems) => problems.to_string(),
        };
        let took = since.elapsed();
        MEMORY.set_limit(usize::MAX).unwrap();
        let first: String = said
            .lines()
            .next()
            .unwrap_or_default()
            .chars()
            .take(90)
            .collect();
        println!("{what}, {} bytes in {took:.1?}: {first}", text.len());
        assert!(took < LONGEST, "{what}");
        assert!(said.len() < 100_000, "{what}");
    }
}
