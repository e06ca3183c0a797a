//! The messages of an `.rrd` file, one after another, until it ends or cannot be read.
//!
//! Whatever is in the file, reading it neither panics nor asks for memory that there is not; what was cut off or changed
//! since it was written is told. Files of others have no checksums: of them only the cut is seen.

use super::RERUN_VERSION;
use super::frames::is_checksums;
use re_protos::common::v1alpha1::Compression;
use re_protos::log_msg::v1alpha1::ArrowMsg;
use re_protos::log_msg::v1alpha1::log_msg::Msg;
use rerun::external::arrow::array::{Array as _, UInt64Array};
use rerun::external::arrow::ipc::root_as_message;
use rerun::external::re_log_encoding::{
    CachingApplicationIdInjector, Decodable as _, Encodable as _, MessageHeader, MessageKind,
    StreamFooter, StreamFooterEntry, StreamHeader, ToApplication as _,
};
use rerun::external::re_log_types::{LogMsg, StoreId};
use rerun::log::Chunk;
use std::cell::Cell;
use std::fs::File;
use std::io::{BufReader, Read as _};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Once;

/// The messages of a file.
pub struct Messages {
    file: BufReader<File>,
    /// Bytes of the file, and those that are read.
    bytes: u64,
    at: u64,
    /// Where the last whole message ends.
    read_until: u64,
    /// What was read since the last checksums began, and its checksums.
    unchecked: Vec<(Range<u64>, u32)>,
    names: CachingApplicationIdInjector,
    /// What stopped it.
    stopped: Option<String>,
    /// Whether the mark of the end has come.
    ended: bool,
    /// Messages that are not as they were written, and the footer where that is not.
    damaged: Vec<Range<u64>>,
    /// Checksums that are none, and how many bytes have none by that.
    spoiled: Vec<Range<u64>>,
    bare: u64,
    /// What was found by the last checksums.
    judged: Judged,
    bad_end: Option<Range<u64>>,
    /// Whether what cannot be unpacked is passed over.
    goes_on: bool,
    /// The whole message last read.
    frame: Vec<u8>,
}

/// What checksums came to, until it is known whether they are those that were written.
#[derive(Default)]
struct Judged {
    /// Where they are.
    by: Range<u64>,
    /// Bytes of what they are of.
    bytes: u64,
    /// What is not as it was written by them.
    found: Vec<Range<u64>>,
}

/// Bytes of one message at most, unpacked: chunks are written by a few hundred rows, and a scene's
/// text is no longer than 64 MB.
const LARGEST_MESSAGE: u64 = 1 << 30;
const TOO_LONG: &str = "a message in it is longer than it can be";
/// LZ4 packs no tighter.
const TIGHTEST: u64 = 255;

impl Messages {
    pub fn open(path: &Path) -> std::io::Result<Self> {
        let file = File::open(path)?;
        let bytes = file.metadata()?.len();
        let mut messages = Self {
            file: BufReader::with_capacity(1 << 20, file),
            bytes,
            at: 0,
            read_until: 0,
            unchecked: Vec::new(),
            names: CachingApplicationIdInjector::default(),
            stopped: None,
            ended: false,
            damaged: Vec::new(),
            spoiled: Vec::new(),
            bare: 0,
            judged: Judged::default(),
            bad_end: None,
            goes_on: false,
            frame: Vec::new(),
        };
        let head = StreamHeader::ENCODED_SIZE_BYTES as u64;
        if bytes < head {
            messages.stopped = Some("it is cut within its head".to_owned());
            return Ok(messages);
        }
        messages.read(head)?;
        messages.remember();
        let known = StreamHeader::from_rrd_bytes(&messages.frame);
        let known = known.and_then(StreamHeader::to_version_and_options);
        messages.stopped = known.err().map(|error| plain(&error.to_string()));
        Ok(messages)
    }

    /// The next message, if there is one that can be read.
    pub fn next(&mut self) -> Option<LogMsg> {
        loop {
            self.next_frame()?;
            let unpacked = match quietly(|| self.unpacked()) {
                Ok(unpacked) => unpacked,
                Err(why) => Err(why),
            };
            if let Ok(LogMsg::ArrowMsg(_, chunk)) = &unpacked
                && is_checksums(chunk)
            {
                let chunk = quietly(|| Chunk::from_arrow_msg(chunk));
                let written = chunk.ok().and_then(Result::ok).as_ref().and_then(written);
                self.check(written);
            }
            self.remember();
            self.read_until = self.at;
            match unpacked {
                Ok(message) => return Some(message),
                Err(_) if self.goes_on => self.damaged.push(self.place()),
                Err(why) => return self.stop(&why),
            }
        }
    }

    /// The same, and what cannot be unpacked is damaged and passed over.
    pub fn going_on(self) -> Self {
        Self {
            goes_on: true,
            ..self
        }
    }

    /// The next chunk of a recording that is read, with its store. Checksums are not shown.
    pub fn next_chunk(&mut self) -> Option<(StoreId, Chunk)> {
        loop {
            let LogMsg::ArrowMsg(store, message) = self.next()? else {
                continue;
            };
            if !store.is_recording() || is_checksums(&message) {
                continue;
            }
            let chunk = quietly(|| Chunk::from_arrow_msg(&message));
            match chunk.and_then(|chunk| chunk.map_err(|error| error.to_string())) {
                Ok(chunk) => return Some((store, chunk)),
                Err(_) if self.goes_on => self.damaged.push(self.place()),
                Err(why) => return self.stop(&why),
            }
        }
    }

    /// Where the message last read is in the file.
    pub fn place(&self) -> Range<u64> {
        self.at - self.frame.len() as u64..self.at
    }

    /// Messages that are not as they were written, as far as there are checksums or they cannot be read.
    pub fn damaged(&self) -> &[Range<u64>] {
        &self.damaged
    }

    /// Bytes whose checksums cannot be read, once it has been read past those.
    pub fn without_checksums(&self) -> u64 {
        self.bare
    }

    /// Bytes at the end that are no message, once it has been read to there.
    pub fn unread(&self) -> u64 {
        self.bytes - self.read_until
    }

    /// Whether nothing was read beyond some place because of what is there, once it has been read that far.
    pub fn is_stopped(&self) -> bool {
        self.stopped.is_some()
    }

    /// What is wrong with the file, once it has been read to its end.
    pub fn flaw(&self) -> Option<String> {
        if let Some(why) = &self.stopped {
            return Some(why.clone());
        }
        if !self.ended {
            return Some(format!(
                "it lacks the footer that rerun {RERUN_VERSION} ends a file with"
            ));
        }
        let spoiled = self.damaged.iter().chain(&self.spoiled);
        let mut all = spoiled.chain(&self.bad_end);
        let first = all.next()?;
        let others = match all.count() {
            0 => String::new(),
            1 => ", and in another place".to_owned(),
            n => format!(", and in {n} other places"),
        };
        Some(format!(
            "bytes {} to {} of it are not those that were written{others}",
            first.start, first.end
        ))
    }

    /// Reads the next message's bytes.
    fn next_frame(&mut self) -> Option<()> {
        const HEADER: u64 = MessageHeader::ENCODED_SIZE_BYTES as u64;
        if self.stopped.is_some() || self.ended || self.bytes - self.at < HEADER {
            return None;
        }
        self.frame.clear();
        if let Err(error) = self.read(HEADER) {
            return self.stop(&error.to_string());
        }
        let header = match MessageHeader::from_rrd_bytes(&self.frame) {
            Ok(header) => header,
            Err(error) => return self.stop(&error.to_string()),
        };
        // A footer grows with the file.
        if header.len > LARGEST_MESSAGE && !matches!(header.kind, MessageKind::End) {
            return self.stop(TOO_LONG);
        }
        if header.len > self.bytes - self.at {
            // What was being written when the program was killed.
            self.at = self.bytes;
            self.frame.clear();
            return None;
        }
        if let Err(error) = self.read(header.len) {
            return self.stop(&error.to_string());
        }
        if matches!(header.kind, MessageKind::End) {
            self.end();
            return None;
        }
        Some(())
    }

    /// Appends bytes of the file to the frame.
    fn read(&mut self, length: u64) -> std::io::Result<()> {
        let read = (&mut self.file).take(length).read_to_end(&mut self.frame)?;
        self.at += read as u64;
        match read as u64 == length {
            true => Ok(()),
            // Somebody has shortened it since.
            false => Err(std::io::ErrorKind::UnexpectedEof.into()),
        }
    }

    /// The footer is there: whether it is the one that was written, by the checksum behind it.
    fn end(&mut self) {
        let place = self.place();
        let mut last = Vec::new();
        let room = StreamFooter::ENCODED_SIZE_BYTES as u64;
        let read = (&mut self.file).take(room).read_to_end(&mut last);
        // It says how many parts it has, and any number would be believed: there is one.
        let is_one = read.is_ok() && last.ends_with(&1_u32.to_le_bytes());
        let known = is_one
            .then(|| StreamFooter::from_rrd_bytes(&last).ok())
            .flatten();
        // Rerun before 0.28 wrote an end without one.
        let bare = last.is_empty() && self.frame.len() == MessageHeader::ENCODED_SIZE_BYTES;
        self.ended = known.is_some() || bare;
        if self.ended {
            self.read_until = self.bytes;
        }
        if known.is_some_and(|known| !self.is_as_written(&place, &known)) {
            self.bad_end = Some(place);
        }
    }

    /// Whether what is read is the footer that the last bytes tell of.
    fn is_as_written(&self, place: &Range<u64>, told: &StreamFooter) -> bool {
        let (head, footer) = self.frame.split_at(MessageHeader::ENCODED_SIZE_BYTES);
        let start = place.start + head.len() as u64;
        let header = MessageHeader {
            kind: MessageKind::End,
            len: place.end - start,
        };
        let mut written = Vec::new();
        let checksum = StreamFooter::compute_crc(footer);
        let mut entries = told.entries.iter();
        let agrees = |entry: &StreamFooterEntry| {
            let span = entry.rrd_footer_byte_span_from_start_excluding_header;
            (entry.crc_excluding_header, span.start, span.len) == (checksum, start, header.len)
        };
        header.to_rrd_bytes(&mut written).is_ok()
            && head == written
            && !told.entries.is_empty()
            && entries.all(agrees)
    }

    /// The frame as what it says.
    fn unpacked(&mut self) -> Result<LogMsg, String> {
        let packed = Option::<Msg>::from_rrd_bytes(&self.frame);
        let packed = packed.map_err(|error| error.to_string())?;
        let packed = packed.ok_or_else(|| "a message in it is none".to_owned())?;
        // A length that says more than there can be asks for memory that there is not.
        let most = LARGEST_MESSAGE.min(TIGHTEST * self.bytes + 64);
        if packed.byte_size_uncompressed() > most {
            return Err(TOO_LONG.to_owned());
        }
        if let Msg::ArrowMsg(message) = &packed {
            must_be_whole(message)?;
        }
        let message = packed.to_application((&mut self.names, None));
        message.map_err(|error| error.to_string())
    }

    /// Checksums are of what comes before them; the next begin with theirs.
    fn remember(&mut self) {
        let checksum = crc32fast::hash(&self.frame);
        self.unchecked.push((self.place(), checksum));
    }

    /// Holds what was read against the checksums that were written of it.
    fn check(&mut self, written: Option<Vec<u64>>) {
        let mut read = std::mem::take(&mut self.unchecked);
        let now = Judged {
            by: self.place(),
            bytes: length(&read),
            found: Vec::new(),
        };
        let before = std::mem::replace(&mut self.judged, now);
        let to = read.last().map_or(0, |(place, _)| place.end);
        let Some(written) = written else {
            // What they were of may be as it was written, or not.
            self.spoiled.push(self.place());
            self.bare += length(&read);
            return;
        };
        let [start, end, sums @ ..] = written.as_slice() else {
            return;
        };
        // They begin with those before them, where those can be told from others.
        let first = read.iter().position(|(place, _)| place.start == *start);
        let is_theirs = |first: &usize| (*end, sums.len()) == (to, read.len() - first);
        let Some(first) = first.filter(is_theirs) else {
            // Another tool has put the messages in another order, or packed them otherwise.
            return;
        };
        let of_these = read.split_off(first);
        self.bare += length(&read);
        let differ = of_these.into_iter().zip(sums);
        let differ = differ.filter(|((_, read), sum)| u64::from(*read) != **sum);
        let found: Vec<Range<u64>> = differ.map(|((place, _), _)| place).collect();
        if found.contains(&before.by) && !self.spoiled.contains(&before.by) {
            // They were none, whatever was found by them.
            self.damaged.retain(|place| !before.found.contains(place));
            self.spoiled.push(before.by);
            self.bare += before.bytes;
        }
        // Those that could not be read are known.
        let is_new =
            |place: &Range<u64>| !self.damaged.contains(place) && !self.spoiled.contains(place);
        let new: Vec<Range<u64>> = found.into_iter().filter(is_new).collect();
        self.damaged.extend(new.iter().cloned());
        self.judged.found = new;
    }

    fn stop<T>(&mut self, why: &str) -> Option<T> {
        self.stopped = Some(plain(why));
        None
    }
}

/// Bytes of some messages that come one after another.
fn length(messages: &[(Range<u64>, u32)]) -> u64 {
    let lengths = messages.iter().map(|(place, _)| place.end - place.start);
    lengths.sum()
}

/// What a chunk of checksums says.
fn written(chunk: &Chunk) -> Option<Vec<u64>> {
    let list = chunk.components().list_arrays().next()?.values();
    let numbers = list.as_any().downcast_ref::<UInt64Array>()?;
    Some(numbers.values().to_vec())
}

fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// Whether the parts of an Arrow message say no more of their lengths than there is: the decoder asks for
/// as much memory as they say.
fn must_be_whole(message: &ArrowMsg) -> Result<(), String> {
    let size = usize::try_from(message.uncompressed_size).unwrap_or(usize::MAX);
    let mut unpacked = Vec::new();
    let mut rest: &[u8] = match message.compression() {
        Compression::Lz4 => {
            unpacked.resize(size, 0);
            lz4_flex::block::decompress_into(&message.payload, &mut unpacked)
                .map_err(|error| format!("a message in it cannot be unpacked: {error}"))?;
            &unpacked
        }
        _ => &message.payload,
    };
    let cut = || "a message in it says that it is longer than it is".to_owned();
    // Each part: -1, the length of its head, the head, the body (Arrow's IPC streaming format).
    while let Some((mark, after)) = rest.split_first_chunk::<4>() {
        let (length, after) = match *mark {
            [0xff, 0xff, 0xff, 0xff] => after.split_first_chunk::<4>().ok_or_else(cut)?,
            _ => (mark, after),
        };
        let length = usize::try_from(i32::from_le_bytes(*length)).map_err(|_| cut())?;
        if length == 0 {
            break;
        }
        let (head, after) = after.split_at_checked(length).ok_or_else(cut)?;
        let head = root_as_message(head).map_err(|error| error.to_string())?;
        let body = usize::try_from(head.bodyLength()).map_err(|_| cut())?;
        rest = after.get(body..).ok_or_else(cut)?;
    }
    Ok(())
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Runs what may panic: decoders do, on bytes that are no longer what was written. Says what it said,
/// and prints nothing.
pub fn quietly<T>(run: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let loud = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                loud(panic);
            }
        }));
    });
    QUIET.set(true);
    // What was half decoded is not looked at again: reading stops there.
    let done = catch_unwind(AssertUnwindSafe(run));
    QUIET.set(false);
    done.map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
        format!("it cannot be decoded: {}", text.unwrap_or_default())
    })
}

#[cfg(test)]
mod tests {
    use super::super::destination::Destination;
    use super::super::rrd::RrdFile;
    use super::super::rrd::tests::fill;
    use super::*;

    fn read(path: &Path) -> (Messages, Vec<Range<u64>>) {
        let mut messages = Messages::open(path).unwrap().going_on();
        let mut checksums = Vec::new();
        while let Some(message) = messages.next() {
            if let LogMsg::ArrowMsg(_, chunk) = message
                && is_checksums(&chunk)
            {
                checksums.push(messages.place());
            }
        }
        (messages, checksums)
    }

    /// For changed checksums nothing is given up that is as it was written.
    #[test]
    fn what_has_lost_its_checksums_is_not_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut file = RrdFile::create(&to, "a").unwrap();
        file.begin_recording().unwrap();
        fill(&mut file, "/a", 0..120_000);
        file.finish().unwrap();
        let bytes = std::fs::read(&to.path).unwrap();
        let (whole, checksums) = read(&to.path);
        assert!(whole.flaw().is_none() && checksums.len() >= 4);
        let (mut spoiled, mut unreadable) = (0, 0);
        // Beside the length, behind which nothing is found.
        let place = &checksums[1];
        let step = (place.end - place.start) as usize / 12;
        let places = (place.start + 16..place.end).step_by(step);
        for at in places {
            let mut changed = bytes.clone();
            changed[at as usize] ^= 1 << (at % 8);
            std::fs::write(&to.path, &changed).unwrap();
            let (messages, _) = read(&to.path);
            assert!(messages.flaw().is_some(), "{at}");
            if messages.is_stopped() {
                continue;
            }
            let damaged = messages.damaged();
            assert!(damaged.iter().all(|one| one == place), "{at}: {damaged:?}");
            assert!(messages.without_checksums() >= CHECKED, "{at}");
            spoiled += messages.spoiled.len();
            unreadable += damaged.len();
        }
        // Both kinds there are.
        assert!(spoiled > 0 && unreadable > 0, "{spoiled}, {unreadable}");
    }

    /// Bytes between checksums, about.
    const CHECKED: u64 = 1 << 20;

    #[test]
    fn no_more_memory_is_asked_for_than_a_message_can_need() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.rrd");
        let mut file = RrdFile::create(&Destination::new(&path), "a").unwrap();
        file.begin_recording().unwrap();
        fill(&mut file, "/a", 0..100);
        file.finish().unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        let length = LARGEST_MESSAGE + 1;
        bytes[20..28].copy_from_slice(&length.to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        // As long as it says, on a disk that stores no zeros.
        let file = File::options().write(true).open(&path).unwrap();
        file.set_len(2 * length).unwrap();
        let mut messages = Messages::open(&path).unwrap();
        assert!(messages.next().is_none());
        assert_eq!(messages.flaw().as_deref(), Some(TOO_LONG));
        assert!(messages.frame.capacity() < 1 << 20);
    }
}
