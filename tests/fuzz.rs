//! Every parser against damaged files: valid ones are mutated at random, and whatever comes out must be refused with an
//! error or read as something valid, without a panic, without end, and without more memory than the file justifies.
//!
//! Without further ado each parser sees a few hundred files, the same in every run. `NMT_FUZZ_SECONDS` is a budget in
//! seconds for all parsers together, `NMT_FUZZ_SEED` another seed. Files that break something stay in
//! `target/tmp/fuzz`.

mod common;

use common::{Workplace, nmt};
use nmt::dataset::DatasetConfig;
use nmt::numeric::npy;
use nmt::oit::Context;
use nmt::pixel::{CameraPlanes, FragmentList};
use nmt::scene::{self, SceneFile};
use nmt::synth::{Purpose, Synth, SynthConfig};
use nmt::train::{AdamMoments, Backend, Checkpoint, TrainConfig, checkpoint::Losses};
use nmt::{dataset, model, oit, report};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};
use std::alloc::{GlobalAlloc, Layout, System};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, Once, PoisonError};
use std::time::{Duration, Instant};

/// Counts memory: how much is held, the most that was held, and the largest single request.
pub struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static MAX_HELD: AtomicUsize = AtomicUsize::new(0);
static LARGEST: AtomicUsize = AtomicUsize::new(0);

/// A single request of more than this fails [bytes].
const MAX_REQUEST: usize = 1 << 30;

fn took(size: usize) {
    let held = HELD.fetch_add(size, Relaxed) + size;
    MAX_HELD.fetch_max(held, Relaxed);
    LARGEST.fetch_max(size, Relaxed);
}

// SAFETY: every request goes to the system's allocator as it is, or fails as a request may.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() > MAX_REQUEST {
            return std::ptr::null_mut();
        }
        took(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if layout.size() > MAX_REQUEST {
            return std::ptr::null_mut();
        }
        took(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if size > MAX_REQUEST {
            return std::ptr::null_mut();
        }
        took(size);
        HELD.fetch_sub(layout.size(), Relaxed);
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a file of so many bytes may make a parser hold [bytes]: compressed bytes stand for about a thousand others at
/// most.
fn most_memory(file: usize) -> usize {
    (96 << 20) + 4096 * file
}

/// What is inserted or put over what is there.
const TOKENS: [&[u8]; 40] = [
    b"\0",
    b"\xff",
    b"\0\0\0\0",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\0\0\0\x80",
    b"\x01\0\0\0",
    b"\xff\xff\xff\xff\xff\xff\xff\xff",
    b"\0\0\0\0\0\0\0\x80",
    b"\0\0\xc0\x7f",
    b"\0\0\x80\x7f",
    b"\0\0\x80\xbf",
    b"\x01\0\0\0\0\0\0\0",
    b"\n",
    b" ",
    b"-1",
    b"0",
    b"1e999",
    b"-1e308",
    b"1e-320",
    b"nan",
    b"inf",
    b"null",
    b"true",
    b"\"\"",
    b"{}",
    b"[]",
    b"[",
    b"}",
    b"18446744073709551616",
    b"4294967296",
    b"99999999",
    b"-0",
    b"0.1",
    b"=",
    b",",
    b"../",
    b"\\u0000",
    "é".as_bytes(),
    b"<script>",
];

/// One change of a file.
#[derive(Debug, Clone)]
enum Change {
    Flip(Index, u8),
    Set(Index, u8),
    Truncate(Index),
    Remove(Index, usize),
    Duplicate(Index, usize, Index),
    Insert(Index, usize),
    Overwrite(Index, usize),
    /// Puts a token in the place of a run of digits, dots, signs.
    Number(Index, usize),
    /// Puts a number of its own there.
    Digits(Index, f64),
    /// Brackets that nest deeply.
    Nest(Index, usize, bool),
    /// A piece of another valid file.
    Splice(Index, Index, usize, Index),
}

fn change() -> impl Strategy<Value = Change> {
    let at = any::<Index>;
    let token = || 0..TOKENS.len();
    prop_oneof![
        3 => (at(), 0..8u8).prop_map(|(i, b)| Change::Flip(i, b)),
        2 => (at(), any::<u8>()).prop_map(|(i, b)| Change::Set(i, b)),
        1 => at().prop_map(Change::Truncate),
        2 => (at(), 1..64usize).prop_map(|(i, n)| Change::Remove(i, n)),
        2 => (at(), 1..200usize, at()).prop_map(|(i, n, to)| Change::Duplicate(i, n, to)),
        2 => (at(), token()).prop_map(|(i, t)| Change::Insert(i, t)),
        3 => (at(), token()).prop_map(|(i, t)| Change::Overwrite(i, t)),
        4 => (at(), token()).prop_map(|(i, t)| Change::Number(i, t)),
        2 => (at(), prop_oneof![-1e3..1e3f64, Just(1e38), Just(1e-38), Just(3.4e38), Just(16777216.0),
            Just(1e9)]).prop_map(|(i, x)| Change::Digits(i, x)),
        1 => (at(), 1..300usize, any::<bool>()).prop_map(|(i, n, b)| Change::Nest(i, n, b)),
        1 => (at(), at(), 1..400usize, at()).prop_map(|(f, i, n, to)| Change::Splice(f, i, n, to)),
    ]
}

/// Changes that leave a text's syntax as it is, more often than not.
fn number_change() -> impl Strategy<Value = Change> {
    let at = any::<Index>;
    let values = prop_oneof![
        -1e3..1e3f64,
        0.0..1.0f64,
        (0..300u32).prop_map(f64::from),
        Just(0.0),
        Just(-1.0),
        Just(1e38),
        Just(1e-38),
        Just(1e9),
        Just(1e300)
    ];
    prop_oneof![
        1 => (at(), 0..TOKENS.len()).prop_map(|(i, t)| Change::Number(i, t)),
        4 => (at(), values).prop_map(|(i, x)| Change::Digits(i, x)),
    ]
}

/// Places of runs of digits and what belongs to them.
fn numbers(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let part = |b: u8| b.is_ascii_digit() || b == b'.' || b == b'-';
    let mut runs = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let end = at + bytes[at..].iter().take_while(|&&b| part(b)).count();
        if bytes[at..end].iter().any(u8::is_ascii_digit) {
            runs.push(at..end);
        }
        at = end.max(at) + 1;
    }
    runs
}

impl Change {
    fn apply(&self, bytes: &mut Vec<u8>, others: &[(String, Vec<u8>)]) {
        let n = bytes.len();
        if n == 0 {
            return;
        }
        match self {
            Self::Flip(at, bit) => bytes[at.index(n)] ^= 1 << bit,
            Self::Set(at, byte) => bytes[at.index(n)] = *byte,
            Self::Truncate(at) => bytes.truncate(at.index(n)),
            Self::Remove(at, len) => drop(bytes.drain(at.index(n)..(at.index(n) + len).min(n))),
            Self::Duplicate(at, len, to) => {
                let piece = bytes[at.index(n)..(at.index(n) + len).min(n)].to_vec();
                let to = to.index(n);
                bytes.splice(to..to, piece);
            }
            Self::Insert(at, token) => {
                let at = at.index(n);
                bytes.splice(at..at, TOKENS[*token].iter().copied());
            }
            Self::Overwrite(at, token) => {
                let at = at.index(n);
                bytes.splice(at..(at + TOKENS[*token].len()).min(n), TOKENS[*token].iter().copied());
            }
            Self::Number(which, token) => {
                let runs = numbers(bytes);
                if !runs.is_empty() {
                    bytes.splice(runs[which.index(runs.len())].clone(), TOKENS[*token].iter().copied());
                }
            }
            Self::Digits(which, value) => {
                let runs = numbers(bytes);
                if !runs.is_empty() {
                    bytes.splice(runs[which.index(runs.len())].clone(), value.to_string().into_bytes());
                }
            }
            Self::Nest(at, depth, square) => {
                let at = at.index(n);
                bytes.splice(at..at, std::iter::repeat_n(if *square { b'[' } else { b'{' }, *depth));
            }
            Self::Splice(file, from, len, to) => {
                let other = &others[file.index(others.len())].1;
                if !other.is_empty() {
                    let from = from.index(other.len());
                    let to = to.index(n);
                    bytes.splice(to..to, other[from..(from + len).min(other.len())].iter().copied());
                }
            }
        }
        bytes.truncate(1 << 20);
    }
}

/// A parser under test.
struct Parser<'a> {
    name: &'static str,
    /// Valid files, by the names under which they are read.
    seeds: Vec<(String, Vec<u8>)>,
    /// Reads the file of a name in a folder, and says what is wrong with what came out; whether it was read or refused
    /// does not matter.
    #[expect(clippy::type_complexity)]
    read: Box<dyn Fn(&Path, &str) -> Result<bool, String> + 'a>,
}

/// How much is tried.
#[derive(Clone, Copy)]
enum Budget {
    Cases(u32),
    Time(Duration),
}

/// Parsers take turns, so that memory is that of the one at hand.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// When the case at hand began [ms since the first one]; 0 where there is none.
static CASE_BEGAN: AtomicU64 = AtomicU64::new(0);

/// Ends the process where a case goes on for a minute: an endless loop cannot be ended otherwise.
fn watch(start: Instant) {
    static WATCH: Once = Once::new();
    WATCH.call_once(|| {
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_secs(1));
                let began = CASE_BEGAN.load(Relaxed);
                if began > 0 && start.elapsed().as_millis() as u64 > began + 60_000 {
                    eprintln!(
                        "a file takes more than a minute; it is the last one written under {}",
                        folder("").display()
                    );
                    std::process::abort();
                }
            }
        });
    });
}

fn start() -> Instant {
    static START: Mutex<Option<Instant>> = Mutex::new(None);
    *START
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .get_or_insert_with(|| Instant::now() - Duration::from_millis(1))
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(name)
}

/// A folder of this process's own with the valid files of a parser.
fn fresh_folder(parser: &Parser<'_>) -> PathBuf {
    let place = folder(&format!("{}-{}", parser.name, std::process::id()));
    drop(std::fs::remove_dir_all(&place));
    std::fs::create_dir_all(&place).unwrap();
    parser
        .seeds
        .iter()
        .for_each(|(name, bytes)| std::fs::write(place.join(name), bytes).unwrap());
    place
}

fn seed() -> u64 {
    std::env::var("NMT_FUZZ_SEED").map_or(1, |text| text.parse().expect("NMT_FUZZ_SEED is a whole number"))
}

/// The number of parsers that share the budget.
const PARSERS: u32 = 13;

fn budget(cases: u32) -> Budget {
    match std::env::var("NMT_FUZZ_SECONDS") {
        Ok(text) => Budget::Time(Duration::from_secs_f64(
            text.parse::<f64>().expect("NMT_FUZZ_SECONDS is a number") / f64::from(PARSERS),
        )),
        Err(_) => Budget::Cases(cases),
    }
}

/// What broke, and the smallest file found that does it.
#[derive(Debug)]
struct Broken {
    reason: String,
    file: Vec<u8>,
}

thread_local! {
    static QUIET: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// Catches a panic, without the usual word about it.
fn quietly<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !QUIET.get() {
                usual(info);
            }
        }));
    });
    QUIET.set(true);
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
    QUIET.set(false);
    outcome.unwrap_or_else(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()));
        Err(format!("a panic: {}", text.unwrap_or_default()))
    })
}

/// Reads one file in the place of a valid one, and says what is wrong with how that went.
fn examine(parser: &Parser<'_>, place: &Path, name: &str, bytes: &[u8]) -> Result<bool, String> {
    std::fs::write(place.join(name), bytes).unwrap();
    let before = HELD.load(Relaxed);
    MAX_HELD.store(before, Relaxed);
    LARGEST.store(0, Relaxed);
    CASE_BEGAN.store(start().elapsed().as_millis() as u64, Relaxed);
    // Shrinking meets the same panic often; its message comes with the smallest file.
    let outcome = quietly(|| (parser.read)(place, name));
    CASE_BEGAN.store(0, Relaxed);
    let (held, largest) = (MAX_HELD.load(Relaxed).saturating_sub(before), LARGEST.load(Relaxed));
    std::fs::write(
        place.join(name),
        &parser.seeds.iter().find(|s| s.0 == name).expect("a seed's name").1,
    )
    .unwrap();
    let most = most_memory(bytes.len());
    if held > most || largest > most {
        return Err(format!(
            "{} bytes made it hold {held} and ask for {largest} bytes at once; {most} are allowed",
            bytes.len()
        ));
    }
    outcome
}

/// Files that once broke a parser, each a valid one with a text replaced, are refused.
fn refuses(parser: &Parser<'_>, findings: &[(&str, &str, &str)]) {
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let place = fresh_folder(parser);
    for (name, from, to) in findings {
        let seed = String::from_utf8(parser.seeds.iter().find(|s| s.0 == *name).unwrap().1.clone()).unwrap();
        assert!(seed.contains(from), "{name} has no {from}");
        assert_eq!(
            examine(parser, &place, name, seed.replacen(from, to, 1).as_bytes()),
            Ok(false),
            "{name}: {to}"
        );
    }
}

/// Mutates and reads until the budget is spent; the number of files that were read and of those that were refused.
fn fuzz(parser: &Parser<'_>, budget: Budget) -> Result<(u32, u32), Broken> {
    let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    watch(start());
    let place = fresh_folder(parser);
    for (name, _) in &parser.seeds {
        match (parser.read)(&place, name) {
            Ok(true) => {}
            other => panic!("{}: the seed {name} is not read: {other:?}", parser.name),
        }
    }
    let read = AtomicU64::new(0);
    let refused = AtomicU64::new(0);
    let mutated = |which: &Index, changes: &[Change]| {
        let (name, bytes) = &parser.seeds[which.index(parser.seeds.len())];
        let mut bytes = bytes.clone();
        changes.iter().for_each(|c| c.apply(&mut bytes, &parser.seeds));
        (name.clone(), bytes)
    };
    let changes = prop_oneof![
        prop::collection::vec(change(), 1..5),
        prop::collection::vec(number_change(), 1..4)
    ];
    let strategy = (any::<Index>(), changes);
    let began = Instant::now();
    for batch in 0u64.. {
        let cases = match budget {
            Budget::Cases(cases) if batch == 0 => cases,
            Budget::Time(time) if began.elapsed() < time => 50,
            _ => break,
        };
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed().to_le_bytes());
        bytes[8..16].copy_from_slice(&batch.to_le_bytes());
        bytes[16..]
            .iter_mut()
            .zip(parser.name.bytes())
            .for_each(|(b, c)| *b = c);
        let config = Config {
            cases,
            failure_persistence: None,
            max_shrink_iters: 3000,
            ..Config::default()
        };
        let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
        let outcome = runner.run(&strategy, |(which, changes)| {
            let (name, bytes) = mutated(&which, &changes);
            match examine(parser, &place, &name, &bytes) {
                Ok(true) => read.fetch_add(1, Relaxed),
                Ok(false) => refused.fetch_add(1, Relaxed),
                Err(reason) => return Err(TestCaseError::fail(reason)),
            };
            Ok(())
        });
        if let Err(TestError::Fail(reason, (which, changes))) = outcome {
            let (name, file) = mutated(&which, &changes);
            let kept = folder("").join(format!("broken-{}-{name}", parser.name));
            std::fs::write(&kept, &file).unwrap();
            drop(turn);
            let changes = format!("{changes:?}");
            let reason = format!(
                "{} on {}, seed {}, batch {batch}, of {name} by {changes}: {reason}",
                parser.name,
                kept.display(),
                seed()
            );
            return Err(Broken { reason, file });
        }
    }
    drop(std::fs::remove_dir_all(&place));
    Ok((read.into_inner() as u32, refused.into_inner() as u32))
}

/// Fuzzes a parser. Some files must have been refused, and some read, but for parsers that know every change by a
/// checksum.
fn check(parser: &Parser<'_>, cases: u32) {
    let (read, refused) = fuzz(parser, budget(cases)).unwrap_or_else(|broken| panic!("{}", broken.reason));
    println!("{}: {read} files read, {refused} refused", parser.name);
    let summed = ["npz", "dataset"].contains(&parser.name);
    assert!(
        (read > 0 || summed) && refused > 0,
        "{}: {read} files read, {refused} refused",
        parser.name
    );
}

fn seeds(paths: &[&str]) -> Vec<(String, Vec<u8>)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let name = |p: &str| Path::new(p).file_name().unwrap().to_str().unwrap().to_owned();
    paths
        .iter()
        .map(|p| (name(p), std::fs::read(root.join(p)).unwrap()))
        .collect()
}

/// Whether a list holds what every list promises.
fn valid(list: &FragmentList) -> Result<bool, String> {
    let again = FragmentList::new(
        list.offsets().to_vec(),
        list.view_z().to_vec(),
        list.alpha().to_vec(),
        list.color().map(<[[f32; 3]]>::to_vec),
    );
    again.map_err(|e| format!("an invalid list was read: {e}"))?;
    if let Some((w, h)) = list.size()
        && u64::from(w) * u64::from(h) != list.pixels() as u64
    {
        return Err(format!("{w} x {h} for {} pixels", list.pixels()));
    }
    if let Some(planes) = list.planes() {
        CameraPlanes::new(planes.near(), planes.far()).map_err(|e| format!("invalid planes were read: {e}"))?;
    }
    Ok(true)
}

/// Refusals are fine where they name what they are about.
fn list<E: std::fmt::Display>(read: Result<FragmentList, E>, name: &str) -> Result<bool, String> {
    match read {
        Ok(list) => valid(&list),
        Err(error) => refused(&error, name),
    }
}

fn refused(error: &impl std::fmt::Display, name: &str) -> Result<bool, String> {
    let text = error.to_string();
    if text.contains(name) {
        Ok(false)
    } else {
        Err(format!("an error that names no file: {text}"))
    }
}

#[test]
fn archives_of_fragments() {
    let read = |folder: &Path, name: &str| list(scene::npz::read(&folder.join(name)), name);
    check(
        &Parser {
            name: "npz",
            seeds: seeds(&["data/sample.npz"]),
            read: Box::new(read),
        },
        300,
    );
}

/// The arrays of an archive, each damaged before it is packed: a checksum would refuse them otherwise.
#[test]
fn arrays_of_fragments() {
    use ndarray::{ArrayView1, ArrayView2, arr0};
    // Enough of them that more bytes are numbers than headers.
    let n = 57;
    let offsets: Vec<u64> = (0..=20)
        .map(|p| 3 * p - u64::from(p > 4) - 2 * u64::from(p > 9))
        .collect();
    let arrays = vec![
        ("offsets", npy::encode(ArrayView1::from(&offsets))),
        (
            "view_z",
            npy::encode(ArrayView1::from(&(0..n).map(|i| 1.0 + i as f32).collect::<Vec<f32>>())),
        ),
        (
            "alpha",
            npy::encode(ArrayView1::from(
                &(0..n).map(|i| i as f32 / n as f32).collect::<Vec<f32>>(),
            )),
        ),
        (
            "color",
            npy::encode(ArrayView2::from(vec![[0.5f32, 0.0, 1.0]; n].as_slice())),
        ),
        ("width", npy::encode(arr0(20u32).view())),
        ("height", npy::encode(arr0(1i64).view())),
        ("near", npy::encode(arr0(0.5f32).view())),
        ("far", npy::encode(arr0(9.0f64).view())),
    ];
    let read = |folder: &Path, name: &str| {
        use std::io::Write;
        let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        let options = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        for (array, bytes) in &arrays {
            let file = format!("{array}.npy");
            let damaged = (file == name).then(|| std::fs::read(folder.join(name)).unwrap());
            zip.start_file(file, options).unwrap();
            zip.write_all(damaged.as_ref().unwrap_or(bytes)).unwrap();
        }
        std::fs::write(folder.join("list.npz"), zip.finish().unwrap().into_inner()).unwrap();
        // A file of a single array too.
        drop(npy::read_npy::<f32>(&folder.join(name)));
        drop(npy::read_npy::<u64>(&folder.join(name)));
        list(scene::npz::read(&folder.join("list.npz")), "list.npz")
    };
    let seeds = arrays
        .iter()
        .map(|(name, bytes)| (format!("{name}.npy"), bytes.clone()))
        .collect();
    check(
        &Parser {
            name: "npy",
            seeds,
            read: Box::new(read),
        },
        600,
    );
}

#[test]
fn deep_images() {
    let names = [
        "scanline_no",
        "scanline_rle",
        "scanline_zips",
        "tiled_no",
        "tiled_rle",
        "tiled_zips",
        "zstd_tiled",
        "parts",
    ]
    .map(|n| format!("tests/data/deep/{n}.exr"));
    let read = |folder: &Path, name: &str| {
        let path = folder.join(name);
        drop(scene::exr::read(
            &path,
            &scene::exr::ReadOptions {
                volume_slices: None,
                part: None,
            },
        ));
        list(scene::exr::read(&path, &scene::exr::ReadOptions::default()), name)
    };
    check(
        &Parser {
            name: "exr",
            seeds: seeds(&names.each_ref().map(String::as_str)),
            read: Box::new(read),
        },
        600,
    );
}

const CAMERA: &str = "[camera]\nposition = [4.0, 2.6, 6.0]\nlook_at = [0.6, 0.6, -0.5]\nvertical_fov = 48.0\nwidth = \
    16\nheight = 16\nnear = 0.5\nfar = 50.0\n";
const SMALL: scene::Options = scene::Options {
    size: Some((16, 16)),
    seed: None,
};

/// What a camera sees of a mesh in a folder.
fn seen(folder: &Path, mesh: &str, about: &str) -> Result<bool, String> {
    let text = format!("{CAMERA}[[mesh]]\nfile = \"{mesh}\"\n");
    let file = SceneFile::parse(&folder.join("scene.toml"), &text).unwrap();
    list(scene::build(&file, &SMALL), about)
}

#[test]
fn obj_meshes_and_their_materials() {
    // A damaged library is reported about the mesh that names it.
    let read = |folder: &Path, name: &str| match name {
        "full.obj" => seen(folder, name, name),
        _ => seen(folder, "roof.obj", "roof."),
    };
    // What files of other programs have besides.
    let full = "mtllib roof.mtl\ng a b\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nvt 0 0\nvt 1 0\nvt \
        0.5 1 0\nvn 0 0 1\nvn 0 1 0\n\
        usemtl glass\ns 1\nf 1/1/1 2/2/1 3/3/2\nf -4//-1 -3//1 -1//2\nf 1/1 2/2 3/3 4/1\nl 1 2 3\np 1 2\nusemtl \
        tiles\nf 1 2 3 4 2\n";
    let mut seeds = seeds(&["data/roof.obj", "data/roof.mtl"]);
    seeds.push(("full.obj".to_owned(), full.as_bytes().to_vec()));
    let parser = Parser {
        name: "obj",
        seeds,
        read: Box::new(read),
    };
    refuses(
        &parser,
        &[
            ("roof.mtl", "Kd 0.3 0.7 0.9", "Kd"),
            ("full.obj", "-1//2", "-1//6148914691236517206"),
        ],
    );
    check(&parser, 600);
}

/// A mesh of two triangles, one of them by indices, its nodes moved and turned, with a material that blends.
fn gltf(uri: Option<&str>) -> (String, Vec<u8>) {
    let mut data: Vec<u8> = [[-1.0f32, 0.0, 0.0], [2.0, 0.0, -1.0], [0.0, 2.0, 0.5]]
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    data.extend([0u16, 1, 2, 0].iter().flat_map(|i| i.to_le_bytes()));
    let uri = uri.map_or(String::new(), |u| format!(r#","uri":"{u}""#));
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,2]}}],
"nodes":[{{"children":[1],"translation":[0.1,0.2,-0.5]}},{{"mesh":0,"rotation":[0,0.38,0,0.92],"scale":[1,1,2]}},
{{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0.5,0,0,1]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}},
{{"attributes":{{"POSITION":0}},"indices":1,"mode":4}}]}}],
"materials":[{{"name":"glass","alphaMode":"BLEND","pbrMetallicRoughness":{{"baseColorFactor":[0.3,0.7,0.9,0.4]}}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-1,0,-1],"max":[2,2,0.5]}},
{{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":8}}],
"buffers":[{{"byteLength":44{uri}}}]}}"#
    );
    (json, data)
}

fn glb() -> Vec<u8> {
    let (mut json, data) = gltf(None);
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let length = 12 + 8 + json.len() + 8 + data.len();
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", data.as_slice())] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

#[test]
fn gltf_meshes() {
    let embedded = "data:application/octet-stream;base64,AACAvwAAAAAAAAAAAAAAQAAAAAAAAIC/AAAAAAAAAEAAAAA/AAABAAIAAAA=";
    let seeds = vec![
        ("mesh.glb".to_owned(), glb()),
        ("mesh.gltf".to_owned(), gltf(Some(embedded)).0.into_bytes()),
    ];
    let read = |folder: &Path, name: &str| seen(folder, name, "mesh.");
    let parser = Parser {
        name: "gltf",
        seeds,
        read: Box::new(read),
    };
    let position = r#"{"attributes":{"POSITION":0},"material":0}"#;
    refuses(
        &parser,
        &[
            (
                "mesh.gltf",
                position,
                r#"{"attributes":{"POSITION":16777216},"material":0}"#,
            ),
            (
                "mesh.gltf",
                r#""componentType":5126,"count":3"#,
                r#""componentType":5126,"count":1000000000"#,
            ),
        ],
    );
    check(&parser, 600);
}

/// Splats in each of their formats: one, so that most changes meet a number.
#[test]
fn splats() {
    use std::io::Write;
    let numbers = [0.1f32, -0.2, 0.3, 0.05, 0.02, 0.04];
    let names = "x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3";
    let header = |format: &str| {
        let properties: String = names.split(' ').map(|n| format!("property float {n}\n")).collect();
        format!("ply\nformat {format} 1.0\nelement vertex 2\n{properties}end_header\n").into_bytes()
    };
    let row = [
        0.1f32, -0.2, 0.3, 0.5, -0.5, 1.0, 2.0, -3.0, -4.0, -3.5, 1.0, 0.1, 0.2, 0.3,
    ];
    let binary: Vec<u8> = [row, row].as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let line = row.map(|x| x.to_string()).join(" ");
    let mut record: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    record.extend([200, 100, 50, 180, 200, 140, 120, 110]);
    let mut spz = b"NGSP\x03\0\0\0\x02\0\0\0\x01\x0c\0\0".to_vec();
    spz.extend([10; 2 * (9 + 1 + 3 + 3 + 4 + 9)]);
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::none());
    gzip.write_all(&spz).unwrap();
    let seeds = vec![
        ("a.splat".to_owned(), record.repeat(3)),
        ("a.ply".to_owned(), [header("binary_little_endian"), binary].concat()),
        (
            "b.ply".to_owned(),
            [header("ascii"), format!("{line}\n{line}\n").into_bytes()].concat(),
        ),
        ("a.spz".to_owned(), gzip.finish().unwrap()),
    ];
    let read = |folder: &Path, name: &str| {
        let scene = scene::open(folder.join(name).to_str().unwrap()).map_err(|e| e.to_string())?;
        list(scene::build(&scene, &SMALL), name)
    };
    check(
        &Parser {
            name: "splats",
            seeds,
            read: Box::new(read),
        },
        600,
    );
}

#[test]
fn scene_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |folder: &Path, name: &str| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let Ok(text) = std::str::from_utf8(&bytes) else {
            return list(
                SceneFile::read(&folder.join(name)).and_then(|s| scene::build(&s, &SMALL)),
                name,
            );
        };
        // Meshes are named from the folder of the scene file.
        match SceneFile::parse(&root.join("configs/scenes").join(name), text) {
            // What is wrong may be the mesh's.
            Ok(file) => list(scene::build(&file, &SMALL), ""),
            Err(error) => refused(&error, name),
        }
    };
    check(
        &Parser {
            name: "scene",
            seeds: seeds(&["configs/scenes/house.toml", "configs/scenes/smoke.toml"]),
            read: Box::new(read),
        },
        150,
    );
}

#[test]
fn models() {
    let read = |folder: &Path, name: &str| {
        let path = folder.join(name);
        drop(model::file::import(&path, "imported", nmt::features::FeatureSet::Paper));
        match model::file::load(&path) {
            Err(error) => refused(&error, name),
            Ok(mlp) => {
                let again = model::file::from_json(model::file::to_json(&mlp).as_bytes(), &path)
                    .map_err(|e| format!("what was read is not written: {e}"))?;
                if again != mlp {
                    return Err("what was read is not what is written".to_owned());
                }
                let row = vec![0.5; mlp.feature_set().width()];
                let (one, many) = (mlp.forward::<f32>(&row), mlp.predict(&row));
                if many.len() != 1 || !(one.is_nan() || (0.0..=1.0).contains(&one)) {
                    return Err(format!("answers {one} and {many:?}"));
                }
                Ok(true)
            }
        }
    };
    let names = [
        "models/small.json",
        "models/paper.json",
        "models/deep-weighted-blended.json",
    ];
    check(
        &Parser {
            name: "model",
            seeds: seeds(&names),
            read: Box::new(read),
        },
        200,
    );
}

/// What a configuration file is made of.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "what a file may hold")]
struct Configuration {
    extends: Option<String>,
    name: Option<String>,
    seed: Option<u64>,
    synth: Option<SynthConfig>,
    dataset: Option<DatasetConfig>,
    train: Option<TrainConfig>,
    evaluate: Option<toml::Table>,
}

#[test]
fn configurations() {
    let read = |folder: &Path, name: &str| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let Ok(text) = std::str::from_utf8(&bytes) else {
            return Ok(false);
        };
        let Ok(config) = toml::from_str::<Configuration>(text) else {
            return Ok(false);
        };
        if config.dataset.is_some_and(|d| d.validate().is_err()) {
            return Ok(false);
        }
        if let Some(train) = &config.train {
            if train.validate().is_err() {
                return Ok(false);
            }
            if !(1..10).all(|step| train.learning_rate_at(step, 10).is_finite()) {
                return Err("a learning rate is not finite".to_owned());
            }
        }
        match config.synth.map(|s| Synth::new(s, config.seed.unwrap_or(1))) {
            None => Ok(true),
            Some(Err(_)) => Ok(false),
            Some(Ok(synth)) => valid(&synth.pixels(Purpose::Training, 0, 4)),
        }
    };
    let names = [
        "configs/paper.toml",
        "configs/recommended.toml",
        "configs/sample.toml",
        "configs/deep-weighted-blended.toml",
    ];
    check(
        &Parser {
            name: "config",
            seeds: seeds(&names),
            read: Box::new(read),
        },
        600,
    );
}

#[test]
fn checkpoints() {
    let config: TrainConfig = toml::from_str("hidden = [3]\nepochs = 9\nbatch = 64\nlearning_rate = 1e-3").unwrap();
    let parameters = vec![0.25f32; 28];
    let whole = Checkpoint {
        format: "nmt-checkpoint".to_owned(),
        version: 1,
        config: config.clone(),
        seed: 7,
        dataset_hash: "abc".to_owned(),
        backend: Backend::Fused,
        parameters: parameters.clone(),
        moments: AdamMoments {
            steps: 12,
            first: parameters.clone(),
            second: parameters.clone(),
        },
        best_parameters: parameters,
        best_epoch: 2,
        history: vec![
            Losses {
                training: 0.5,
                validation: 0.25
            };
            3
        ],
    };
    let read = |folder: &Path, name: &str| {
        let path = folder.join(name);
        match Checkpoint::load(&path) {
            Err(error) => refused(&error, name),
            Ok(checkpoint) => match checkpoint.check(&path, &config, 7, "abc", Backend::Fused, 28) {
                Err(error) => refused(&error, name),
                Ok(()) => Ok(true),
            },
        }
    };
    let seeds = vec![("m.checkpoint.json".to_owned(), serde_json::to_vec(&whole).unwrap())];
    check(
        &Parser {
            name: "checkpoint",
            seeds,
            read: Box::new(read),
        },
        600,
    );
}

#[test]
fn datasets() {
    let at = Workplace::new();
    nmt(&["generate", &at.config(), "--out", &at.path("d"), "--quiet"]).success();
    let read = |folder: &Path, name: &str| {
        // The other files stand where they were generated.
        std::fs::copy(folder.join(name), at.path(&format!("d/{name}"))).unwrap();
        match dataset::file::read_from(Path::new(&at.path("d"))) {
            Ok(dataset) => {
                Ok(dataset.training.features.len() == dataset.training.len() * dataset.training.feature_set.width())
            }
            Err(error) => refused(&error, "d/"),
        }
    };
    let seeds = vec![(
        "manifest.json".to_owned(),
        std::fs::read(at.path("d/manifest.json")).unwrap(),
    )];
    check(
        &Parser {
            name: "dataset",
            seeds,
            read: Box::new(read),
        },
        200,
    );
}

#[test]
fn names_of_methods() {
    let sample = FragmentList::new(vec![0, 3, 3], vec![1.0, 3.0, 2.0], vec![0.5, 1.0, 0.0], None)
        .unwrap()
        .with_size(2, 1)
        .unwrap();
    let read = |folder: &Path, name: &str| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let Ok(method) = oit::parse(&String::from_utf8_lossy(&bytes)) else {
            return Ok(false);
        };
        let context = Context {
            planes: CameraPlanes::new(0.5, 9.0).ok(),
            depth_range: None,
        };
        let accumulated = method.accumulate(&sample, context).map_err(|e| e.to_string())?;
        if oit::weights(&sample, &*accumulated).len() == 3 {
            Ok(true)
        } else {
            Err("as many weights as fragments are expected".to_owned())
        }
    };
    let seeds = oit::all_names()
        .into_iter()
        .enumerate()
        .map(|(i, name)| (format!("{i}.txt"), name.into_bytes()))
        .collect();
    check(
        &Parser {
            name: "method",
            seeds,
            read: Box::new(read),
        },
        600,
    );
}

#[test]
fn reports() {
    let at = Workplace::new();
    nmt(&["run", &at.config(), "--out", &at.path("r/run"), "--quiet"]).success();
    let scene = [
        "--fragments",
        "spheres",
        "--size",
        "8x8",
        "--methods",
        "moment-power-4,weighted-average",
    ];
    nmt(&[&["evaluate", "--out", &at.path("r/e"), "--quiet"][..], &scene].concat()).success();
    let bench = [
        "bench",
        "generate",
        "--pairs",
        "256",
        "--repeat",
        "2",
        "--sample-seconds",
        "1e-4",
        "--json",
        "--quiet",
    ];
    let bench = nmt(&bench).success().get_output().stdout.clone();
    let file = |name: &str| std::fs::read(at.path(name)).unwrap();
    let seeds = vec![
        ("run.json".to_owned(), file("r/run/run.json")),
        ("model.losses.csv".to_owned(), file("r/run/model.losses.csv")),
        ("results.json".to_owned(), file("r/e/results.json")),
        ("bench.json".to_owned(), bench),
    ];
    let picture = (file("r/e/spheres/truth.png"), file("r/e/spheres/moment-power-4.png"));
    let read = |folder: &Path, _: &str| {
        std::fs::create_dir_all(folder.join("spheres")).unwrap();
        std::fs::write(folder.join("spheres/truth.png"), &picture.0).unwrap();
        std::fs::write(folder.join("spheres/moment-power-4.png"), &picture.1).unwrap();
        match report::build(folder, &report::Options::default()) {
            Err(error) => Err(format!("the other files are whole: {error}")),
            Ok(page) => {
                if page.html.contains("<script>") && page.html.matches("<script").count() != 1 {
                    return Err("a script of another's".to_owned());
                }
                Ok(page.problems.is_empty())
            }
        }
    };
    check(
        &Parser {
            name: "report",
            seeds,
            read: Box::new(read),
        },
        300,
    );
}

/// The machinery finds what it looks for: a parser that trusts a length and panics, one that takes the memory it is
/// told to, and one that returns what is invalid; and the files that it keeps are small.
#[test]
fn bad_parsers_are_found() {
    let seeds = || vec![("a.bin".to_owned(), [4u8, 0, 0, 0, 1, 2, 3, 4].repeat(8))];
    let length = |folder: &Path| {
        let bytes = std::fs::read(folder.join("a.bin")).unwrap();
        let head: [u8; 4] = bytes.get(..4)?.try_into().ok()?;
        Some((u32::from_le_bytes(head) as usize, bytes))
    };
    let trusting = |folder: &Path, _: &str| Ok(length(folder).is_some_and(|(n, bytes)| bytes[4..4 + n].len() == n));
    let greedy =
        |folder: &Path, _: &str| Ok(length(folder).is_some_and(|(n, _)| vec![0u8; n.min(MAX_REQUEST)].len() == n));
    let careless = |folder: &Path, _: &str| match length(folder) {
        Some((n, _)) if n > 1_000_000 => Err("invalid".to_owned()),
        other => Ok(other.is_some()),
    };
    let budget = Budget::Cases(1500);
    let panics = fuzz(
        &Parser {
            name: "trusting",
            seeds: seeds(),
            read: Box::new(trusting),
        },
        budget,
    )
    .unwrap_err();
    let memory = fuzz(
        &Parser {
            name: "greedy",
            seeds: seeds(),
            read: Box::new(greedy),
        },
        budget,
    )
    .unwrap_err();
    let invalid = fuzz(
        &Parser {
            name: "careless",
            seeds: seeds(),
            read: Box::new(careless),
        },
        budget,
    )
    .unwrap_err();
    assert!(
        memory.reason.contains("bytes at once") && invalid.reason.contains("invalid"),
        "{memory:?} {invalid:?}"
    );
    assert!(
        panics.reason.contains("out of range") && panics.file.len() <= 128,
        "{panics:?}"
    );
    // The same seed finds the same.
    let again = fuzz(
        &Parser {
            name: "careless",
            seeds: seeds(),
            read: Box::new(careless),
        },
        budget,
    )
    .unwrap_err();
    assert_eq!(again.file, invalid.file);
}
