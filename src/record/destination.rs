//! Where a recording goes: under a name of its own until it is whole, then to its name at once.
//!
//! `cone.rrd` is written as `cone.partial.rrd` beside it, and renamed when its last byte is there. Whoever
//! is killed leaves a partial file, which opens, and which `torquescope recover` makes whole. What waits in
//! memory longer than it may is written behind the end of what is settled, and written over by it: what a
//! whole file holds does not depend on the clock.
//!
//! ```text
//! settled | behind it: rows that wait, checksums          →  settled, more settled | behind it, anew
//! ```
//!
//! The file ends after what is settled while that is replaced, for as long as it takes to write it: who is killed then
//! leaves a clean cut. Where it cannot be written, what was there is put back.

use super::recover::{Left, left};
use super::{RecordError, is_recording};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where a recording is to go, and on what terms.
#[derive(Clone, Debug)]
pub struct Destination {
    pub path: PathBuf,
    /// Its name until it is whole, where that is not the usual one.
    pub meanwhile: Option<PathBuf>,
    /// Whether a recording that is there may be replaced.
    pub replace: bool,
    /// How much of the last, in wall time, may be lost when the program is killed.
    pub keeps_up: Duration,
}

/// What a killed program may lose where nobody says.
const HALF_A_SECOND: Duration = Duration::from_millis(500);

impl Destination {
    /// A name that is free.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            meanwhile: None,
            replace: false,
            keeps_up: HALF_A_SECOND,
        }
    }

    /// The same, whatever recording is there.
    pub fn replacing(self, replace: bool) -> Self {
        Self { replace, ..self }
    }

    /// Says before anything is computed what would be said when it is opened.
    pub fn check(&self) -> Result<(), RecordError> {
        must_be_free(&self.path, self.replace)
    }

    /// What a killed run has left that would be written over, if anything.
    pub fn writes_over(&self) -> Option<PathBuf> {
        let path = self.partial();
        (self.replace && matches!(left(&path), Left::Rows)).then_some(path)
    }

    /// By the name of what is replaced, not of a link to it.
    fn last(&self) -> PathBuf {
        std::fs::canonicalize(&self.path).unwrap_or_else(|_| self.path.clone())
    }

    fn partial(&self) -> PathBuf {
        let named = self.meanwhile.clone();
        named.unwrap_or_else(|| partial_name(&self.last()))
    }

    /// Gives a file that is whole its name.
    pub(super) fn give(&self, whole: &Path) -> Result<(), RecordError> {
        must_be_free(&self.path, self.replace)?;
        name_it(whole, &self.last(), self.replace).map_err(|error| RecordError::Create {
            path: self.path.display().to_string(),
            why: error.to_string(),
        })
    }
}

/// The name of a recording that is being written.
pub fn partial_name(path: &Path) -> PathBuf {
    // Of `a.txt` another than of `a.rrd`.
    let is_usual = path.extension().is_none_or(|ending| ending == "rrd");
    let stem = match is_usual {
        true => path.file_stem(),
        false => path.file_name(),
    };
    let mut name = stem.unwrap_or_default().to_os_string();
    name.push(PARTIAL);
    path.with_file_name(name)
}

/// How the name of what is not whole ends.
pub const PARTIAL: &str = ".partial.rrd";

/// Takes bytes, one after another.
pub struct Output {
    kind: Kind,
    /// Settled, and not yet in the file.
    buffer: Vec<u8>,
}

enum Kind {
    Nowhere,
    /// A device or a pipe: there is nothing to rename, and no way back.
    Stream(File),
    Partial(Partial),
}

struct Partial {
    file: File,
    /// Its name meanwhile.
    path: PathBuf,
    /// And in the end.
    last: PathBuf,
    replace: bool,
    /// Bytes of it that are settled.
    settled: u64,
    /// What stands behind them.
    behind: Behind,
}

/// What stands behind what is settled until others take its place.
#[derive(Default)]
pub struct Behind {
    pub bytes: Vec<u8>,
    /// Whether there are rows among them, which are nowhere else.
    pub rows: bool,
}

/// Bytes that are written at once.
const BUFFER: usize = 1 << 20;
/// How often a name is taken by others before it is told.
const TRIES: usize = 100;

impl Output {
    pub fn nowhere() -> Self {
        Self::of(Kind::Nowhere)
    }

    fn of(kind: Kind) -> Self {
        Self {
            kind,
            buffer: Vec::new(),
        }
    }

    pub fn open(to: &Destination) -> Result<Self, RecordError> {
        must_be_free(&to.path, to.replace)?;
        let fail = |path: &Path, error: &std::io::Error| RecordError::Create {
            path: path.display().to_string(),
            why: error.to_string(),
        };
        if std::fs::metadata(&to.path).is_ok_and(|data| !data.is_file()) {
            let file = OpenOptions::new().write(true).open(&to.path);
            let file = file.map_err(|error| fail(&to.path, &error))?;
            return Ok(Self::of(Kind::Stream(file)));
        }
        let path = to.partial();
        let file = Partial::create(&path, to)?;
        let file = file.map_err(|error| fail(&to.path, &error))?;
        Ok(Self::of(Kind::Partial(Partial {
            file,
            path,
            last: to.last(),
            replace: to.replace,
            settled: 0,
            behind: Behind::default(),
        })))
    }

    /// Where the bytes are as long as they are not whole, if anywhere.
    pub fn partial(&self) -> Option<&Path> {
        match &self.kind {
            Kind::Partial(partial) => Some(&partial.path),
            Kind::Nowhere | Kind::Stream(_) => None,
        }
    }

    /// Whether there is a way back, so that what stands behind can be replaced.
    pub fn is_partial(&self) -> bool {
        matches!(self.kind, Kind::Partial(_))
    }

    /// Takes settled bytes, which go to the system with the next that do.
    pub fn write(&mut self, bytes: &[u8]) {
        if !matches!(self.kind, Kind::Nowhere) {
            self.buffer.extend_from_slice(bytes);
        }
    }

    /// Whether enough waits to be worth giving to the system: as much as has to be written again behind it.
    pub fn is_full(&self) -> bool {
        let again = match &self.kind {
            Kind::Partial(partial) => partial.behind.bytes.len(),
            Kind::Nowhere | Kind::Stream(_) => 0,
        };
        self.buffer.len() >= BUFFER.max(again)
    }

    /// Gives everything settled to the system, and behind it what is not. Where that fails it can be tried again.
    pub fn settle(&mut self, behind: Behind) -> std::io::Result<()> {
        match &mut self.kind {
            Kind::Nowhere => {}
            Kind::Stream(file) => file.write_all(&self.buffer)?,
            Kind::Partial(partial) => partial.settle(&self.buffer, behind)?,
        }
        self.buffer.clear();
        Ok(())
    }

    /// Everything is there: the file gets its name.
    pub fn finish(&mut self) -> std::io::Result<()> {
        self.settle(Behind::default())?;
        match &mut self.kind {
            Kind::Nowhere => Ok(()),
            Kind::Stream(file) => file.flush(),
            Kind::Partial(partial) => partial.finish(),
        }?;
        // It is nobody's to write to any more.
        self.kind = Kind::Nowhere;
        Ok(())
    }

    /// Takes away a file in which there is nothing worth keeping.
    pub fn discard(&mut self) {
        if let Kind::Partial(partial) = &self.kind
            && is_at(&partial.file, &partial.path)
        {
            // If it cannot be removed, it stays: as good as any other partial file.
            let _ = std::fs::remove_file(&partial.path);
        }
    }

    /// Sees to it that what was given to the system has a name, when no more will come.
    pub fn keep(&mut self) {
        if let Kind::Partial(partial) = &mut self.kind {
            // It is said elsewhere why no more comes.
            let _ = partial.stay();
        }
    }
}

impl Partial {
    /// A file for nobody else.
    fn create(path: &Path, to: &Destination) -> Result<std::io::Result<File>, RecordError> {
        let shown = || path.display().to_string();
        let open = || {
            // Not emptied before it is known to be nobody's.
            let mut options = OpenOptions::new();
            let options = options.read(true).write(true).create(true).truncate(false);
            options.open(path)
        };
        for _ in 0..TRIES {
            let file = match open() {
                Ok(file) => file,
                Err(error) => return Ok(Err(error)),
            };
            // Where files cannot be locked, nothing is known of others.
            if let Err(TryLockError::WouldBlock) = file.try_lock() {
                break;
            }
            if !is_at(&file, path) {
                // Whoever had it has just finished it, and given it its name.
                continue;
            }
            must_be_free(&to.path, to.replace)?;
            return match left(path) {
                Left::Nothing => Ok(file.set_len(0).map(|()| file)),
                Left::Rows if to.replace => Ok(file.set_len(0).map(|()| file)),
                Left::Rows => Err(RecordError::Left { path: shown() }),
                Left::Other => Err(RecordError::Occupied { path: shown() }),
            };
        }
        Err(RecordError::Busy { path: shown() })
    }

    fn settle(&mut self, bytes: &[u8], behind: Behind) -> std::io::Result<()> {
        if bytes.is_empty() && behind.bytes.is_empty() && self.behind.bytes.is_empty() {
            return Ok(());
        }
        if let Err(error) = self.put([bytes, &behind.bytes]) {
            let before = std::mem::take(&mut self.behind);
            if before.rows {
                // There was room for it.
                let _ = self.put([&[], &before.bytes]);
            }
            self.behind = before;
            return Err(error);
        }
        self.settled += bytes.len() as u64;
        self.behind = behind;
        Ok(())
    }

    /// Writes behind what is settled, in place of all that is there.
    fn put(&mut self, parts: [&[u8]; 2]) -> std::io::Result<()> {
        self.file.set_len(self.settled)?;
        self.file.seek(SeekFrom::Start(self.settled))?;
        let mut parts = parts.into_iter();
        parts.try_for_each(|bytes| self.file.write_all(bytes))
    }

    fn finish(&mut self) -> std::io::Result<()> {
        self.stay()?;
        name_it(&self.path, &self.last, self.replace)
    }

    /// What was written has a name, whatever others have done to it meanwhile.
    fn stay(&mut self) -> std::io::Result<()> {
        match is_at(&self.file, &self.path) {
            true => Ok(()),
            false => self.write_again(),
        }
    }

    /// Somebody has removed it meanwhile; what was written can still be read.
    fn write_again(&mut self) -> std::io::Result<()> {
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create_new(true);
        let mut again = match options.open(&self.path) {
            Ok(file) => file,
            // Or put another in its place, which is not ours to write over.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                let folder = self
                    .path
                    .parent()
                    .filter(|path| !path.as_os_str().is_empty());
                let stem = self.last.file_stem().unwrap_or_default();
                let mut name = stem.to_os_string();
                name.push("-");
                let mut kept = tempfile::Builder::new();
                let kept = kept.prefix(&name).suffix(PARTIAL);
                let kept =
                    kept.make_in(folder.unwrap_or(Path::new(".")), |path| options.open(path))?;
                let (file, path) = kept.keep().map_err(|refused| refused.error)?;
                self.path = path;
                file
            }
            Err(error) => return Err(error),
        };
        let _ = again.try_lock();
        self.file.seek(SeekFrom::Start(0))?;
        std::io::copy(&mut self.file, &mut again)?;
        again.flush()?;
        self.file = again;
        Ok(())
    }
}

/// Whether a name leads to a file.
pub fn is_at(file: &File, path: &Path) -> bool {
    let Ok(own) = file.try_clone() else {
        return false;
    };
    let own = same_file::Handle::from_file(own);
    let named = same_file::Handle::from_path(path);
    matches!((own, named), (Ok(own), Ok(named)) if own == named)
}

/// Gives a file its last name, which nobody else may have, but for an empty file.
fn name_it(path: &Path, last: &Path, replace: bool) -> std::io::Result<()> {
    let there = std::fs::metadata(last).ok();
    let there = there.filter(|data| replace || (data.is_file() && data.len() == 0));
    if let Some(there) = there {
        // Who made it said who may read it.
        let _ = std::fs::set_permissions(path, there.permissions());
        return std::fs::rename(path, last);
    }
    let named = tempfile::TempPath::try_from_path(path)?;
    match named.persist_noclobber(last) {
        Ok(()) => Ok(()),
        Err(refused) => {
            // Left where it is.
            refused.path.keep()?;
            Err(refused.error)
        }
    }
}

/// What is there must not be lost: neither a recording, unless it may be replaced, nor anything else.
fn must_be_free(path: &Path, replace: bool) -> Result<(), RecordError> {
    let there = std::fs::metadata(path);
    if there.is_err_and(|error| error.kind() == ErrorKind::NotFound)
        && let Ok(leads_to) = std::fs::read_link(path)
    {
        return Err(RecordError::Dangling {
            path: path.display().to_string(),
            leads_to: leads_to.display().to_string(),
        });
    }
    let is_file = std::fs::metadata(path).is_ok_and(|data| data.is_file() && data.len() > 0);
    if !is_file {
        return Ok(());
    }
    let is_recording = is_recording(path);
    let path = path.display().to_string();
    if !is_recording {
        return Err(RecordError::Occupied { path });
    }
    match replace {
        true => Ok(()),
        false => Err(RecordError::Exists { path }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::MAGIC;
    use super::*;

    fn write(to: &Destination, parts: &[&[u8]]) -> Output {
        let mut output = Output::open(to).unwrap();
        for part in parts {
            output.write(part);
        }
        output
    }

    fn behind(bytes: &[u8]) -> Behind {
        Behind {
            bytes: bytes.to_vec(),
            rows: true,
        }
    }

    fn nothing() -> Behind {
        Behind::default()
    }

    #[test]
    fn the_name_appears_when_everything_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[MAGIC, b" first"]);
        assert!(!to.path.exists() && partial_name(&to.path).exists());
        output.finish().unwrap();
        assert!(to.path.exists() && !partial_name(&to.path).exists());
        assert_eq!(std::fs::read(&to.path).unwrap(), b"RRF2 first");
        // Now it is taken.
        assert!(matches!(Output::open(&to), Err(RecordError::Exists { .. })));
        let to = to.replacing(true);
        write(&to, &[MAGIC, b" second"]).finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"RRF2 second");
        std::fs::write(&to.path, "a letter").unwrap();
        assert!(matches!(
            Output::open(&to),
            Err(RecordError::Occupied { .. })
        ));
    }

    #[test]
    fn settled_bytes_take_the_place_of_what_stands_behind() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"settled"]);
        let now = || std::fs::read(partial_name(&to.path)).unwrap();
        output.settle(behind(b" and more")).unwrap();
        assert_eq!(now(), b"settled and more");
        output.settle(behind(b" another")).unwrap();
        assert_eq!(now(), b"settled another");
        output.write(b", more");
        assert_eq!(now(), b"settled another");
        output.settle(behind(b"!")).unwrap();
        assert_eq!(now(), b"settled, more!");
        output.finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"settled, more");
    }

    #[test]
    fn what_stands_behind_is_not_written_again_for_less_than_itself() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[]);
        output.write(&[0; BUFFER]);
        assert!(output.is_full());
        output.settle(behind(&vec![1; 3 * BUFFER])).unwrap();
        output.write(&[0; 2 * BUFFER]);
        assert!(!output.is_full());
        output.write(&[0; BUFFER]);
        assert!(output.is_full());
    }

    /// A file that can be written to no more.
    #[test]
    fn what_cannot_be_written_can_be_tried_again() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"settled"]);
        output.settle(behind(b" and behind")).unwrap();
        output.write(b", more");
        let Kind::Partial(partial) = &mut output.kind else {
            panic!("no file")
        };
        let read_only = File::open(&partial.path).unwrap();
        let whole = std::mem::replace(&mut partial.file, read_only);
        assert!(output.settle(behind(b" and other")).is_err());
        let Kind::Partial(partial) = &mut output.kind else {
            panic!("no file")
        };
        assert_eq!(partial.behind.bytes, b" and behind");
        partial.file = whole;
        output.settle(behind(b" and other")).unwrap();
        let now = std::fs::read(partial_name(&to.path)).unwrap();
        assert_eq!(now, b"settled, more and other");
    }

    #[cfg(unix)]
    #[test]
    fn what_stood_behind_is_put_back_where_there_is_no_more_room() {
        // No file may grow beyond some 50 KB, and that is no signal.
        let script = "trap '' XFSZ; ulimit -f 100; exec \"$0\" --ignored --exact \"$1\"";
        let name = module_path!().split_once("::").unwrap().1;
        let done = std::process::Command::new("sh")
            .args(["-c", script])
            .arg(std::env::current_exe().unwrap())
            .arg(format!("{name}::no_more_room"))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stdout);
        assert!(done.status.success(), "{said}");
        assert!(said.contains("1 passed"), "{said}");
    }

    #[test]
    #[ignore = "is run by another, where files cannot grow"]
    fn no_more_room() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"settled"]);
        output.settle(behind(&[1; 20_000])).unwrap();
        let before = std::fs::read(partial_name(&to.path)).unwrap();
        output.write(&[2; 200_000]);
        for _ in 0..2 {
            assert!(output.settle(behind(&[3; 30_000])).is_err());
            let now = std::fs::read(partial_name(&to.path)).unwrap();
            assert!(now == before);
        }
    }

    #[test]
    fn what_others_write_or_have_left_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[MAGIC, b"mine"]);
        output.settle(nothing()).unwrap();
        for replace in [false, true] {
            let other = Output::open(&to.clone().replacing(replace));
            assert!(matches!(other, Err(RecordError::Busy { .. })));
        }
        drop(output);
        // What cannot be read is not known to be nothing.
        assert!(matches!(Output::open(&to), Err(RecordError::Left { .. })));
        assert_eq!(std::fs::read(partial_name(&to.path)).unwrap(), b"RRF2mine");
        let to = to.replacing(true);
        assert_eq!(to.writes_over(), Some(partial_name(&to.path)));
        assert!(Output::open(&to).is_ok());
        // What is no recording is not ours, whatever its name.
        std::fs::write(partial_name(&to.path), "a letter").unwrap();
        let other = Output::open(&to);
        assert!(matches!(other, Err(RecordError::Occupied { .. })));
        let now = std::fs::read(partial_name(&to.path)).unwrap();
        assert_eq!(now, b"a letter");
    }

    /// Others may finish between the opening of a name and its lock.
    #[test]
    fn a_file_that_has_got_its_name_meanwhile_is_not_emptied() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let all = std::thread::scope(|scope| {
            let run = |k: u8| {
                let to = &to;
                scope.spawn(move || {
                    let mut done = 0;
                    for _ in 0..300 {
                        let to = Destination::new(to.path.with_file_name(format!("{k}.rrd")));
                        let to = Destination {
                            meanwhile: Some(to.path.with_file_name("all.partial.rrd")),
                            replace: true,
                            ..to
                        };
                        if let Ok(mut output) = Output::open(&to) {
                            output.write(MAGIC);
                            output.write(&[k; 64]);
                            output.finish().unwrap();
                            done += 1;
                            drop(output);
                        }
                        if let Ok(now) = std::fs::read(&to.path) {
                            assert_eq!(now.len(), 68, "{k}");
                            assert!(now[4..].iter().all(|byte| *byte == k));
                        }
                    }
                    done
                })
            };
            let threads = [run(1), run(2)];
            threads.map(|thread| thread.join().unwrap())
        });
        assert!(all.iter().all(|done| *done > 0), "{all:?}");
    }

    #[test]
    fn a_file_that_is_removed_meanwhile_is_there_in_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"before"]);
        output.settle(nothing()).unwrap();
        std::fs::remove_file(partial_name(&to.path)).unwrap();
        output.write(b", after");
        output.finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"before, after");
    }

    #[test]
    fn so_is_one_in_whose_place_another_was_put() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"before"]);
        output.settle(nothing()).unwrap();
        let partial = partial_name(&to.path);
        std::fs::remove_file(&partial).unwrap();
        std::fs::write(&partial, "another's").unwrap();
        output.write(b", after");
        output.finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"before, after");
        assert_eq!(std::fs::read(&partial).unwrap(), b"another's");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_name_that_is_taken_meanwhile_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"mine"]);
        std::fs::write(&to.path, "yours").unwrap();
        assert!(output.finish().is_err());
        assert_eq!(std::fs::read(&to.path).unwrap(), b"yours");
        assert_eq!(std::fs::read(partial_name(&to.path)).unwrap(), b"mine");
    }

    #[test]
    fn an_empty_file_is_as_good_as_none() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        // As mktemp makes one.
        std::fs::write(&to.path, "").unwrap();
        to.check().unwrap();
        write(&to, &[MAGIC]).finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), MAGIC);
        assert!(matches!(to.check(), Err(RecordError::Exists { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_nowhere_is_told_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        std::os::unix::fs::symlink("nowhere.rrd", &to.path).unwrap();
        for replace in [false, true] {
            let told = to.clone().replacing(replace).check();
            assert!(matches!(told, Err(RecordError::Dangling { .. })));
        }
        // One that leads somewhere stays one.
        std::fs::write(folder.path().join("nowhere.rrd"), "").unwrap();
        write(&to, &[MAGIC]).finish().unwrap();
        assert!(to.path.is_symlink());
        assert_eq!(std::fs::read(&to.path).unwrap(), MAGIC);
    }

    #[test]
    fn names_that_differ_have_partial_names_that_do() {
        let of = |name: &str| partial_name(Path::new(name)).display().to_string();
        assert_eq!(of("x/a.rrd"), "x/a.partial.rrd");
        assert_eq!(of("x/a.txt"), "x/a.txt.partial.rrd");
        assert_eq!(of("a.b.rrd"), "a.b.partial.rrd");
    }
}
