//! The objects and properties of an archive being read.

use std::collections::{HashMap, HashSet};
use std::io::{Read, Seek};
use std::rc::Rc;

use glam::{DMat4, Vec3};
use nabiki_exchange::Budget;

use crate::Problem;
use crate::layout::{INLINE_METADATA, Kind, Pod, flags};
use crate::ogawa::read::{Reader, is_data};
use crate::values::singles;

/// Times apart by no more than this are the same (s).
pub const SAME_TIME: f64 = 1e-6;

/// Bytes of digest before the values of a sample.
const DIGEST: usize = 16;
/// Objects below objects; an archive that claims more was made to harm.
const DEEPEST: usize = 64;
/// Bytes of the name of an object or property that is read: names are compared again and again.
const LONGEST_NAME: usize = 1024;

/// One of the archive's time samplings.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Length of a cycle (s); more than 1e10 for times without a rule.
    pub period: f64,
    /// Times of the samples of the first cycle (s).
    pub times: Vec<f64>,
}

impl Timing {
    /// The last of `samples` at or before a time, and how far on to the one after it (0..1) the time is.
    pub fn at(&self, time: f64, samples: usize) -> (usize, f64) {
        let most = samples.saturating_sub(1);
        let (mut low, mut high) = (0, most);
        while low < high {
            let middle = (low + high).div_ceil(2);
            if self.time(middle) <= time + SAME_TIME {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        let (from, to) = (self.time(low), self.time(low + 1));
        (low, if low < most && time > from + SAME_TIME && to > from { (time - from) / (to - from) } else { 0.0 })
    }

    /// When sample `i` is (s).
    pub fn time(&self, i: usize) -> f64 {
        let n = self.times.len();
        match self.cycle() {
            None => self.times[i.min(n - 1)],
            Some(period) => self.times[i % n] + (i / n) as f64 * period,
        }
    }

    /// Length of a cycle (s), where the times follow one.
    pub fn cycle(&self) -> Option<f64> {
        (self.period <= 1e10).then_some(self.period)
    }
}

/// An object: where it is, what it is, and what is above it.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its name; empty at the top.
    pub name: Rc<str>,
    /// Its metadata: `schema=AbcGeom_Curve_v2;...`.
    pub metadata: Rc<str>,
    /// Its group.
    pub place: u64,
    /// Index of the object above it in the list.
    pub parent: Option<usize>,
}

impl Object {
    /// Whether its schema's name begins thus.
    pub fn is(&self, schema: &str) -> bool {
        self.metadata.split(';').any(|entry| entry.strip_prefix("schema=").is_some_and(|s| s.starts_with(schema)))
    }
}

/// What a property is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PropertyKind {
    /// Properties below one name.
    Compound,
    /// One value a sample.
    Scalar,
    /// Any number of values a sample.
    Array,
}

/// A property as its header describes it.
#[derive(Clone, Debug)]
pub struct Header {
    /// Name.
    pub name: Rc<str>,
    /// What it is.
    pub form: PropertyKind,
    /// Type of its values (meaningless for compounds).
    pub kind: Kind,
    /// What else is said of it: `geoScope=vtx;interpretation=rgb`.
    pub metadata: Rc<str>,
    /// Number of samples.
    pub samples: usize,
    first_change: usize,
    last_change: usize,
    /// Which of the archive's time samplings it follows.
    pub timing: usize,
    /// Its group.
    pub place: u64,
}

impl Header {
    /// What its metadata say of `key`.
    pub fn detail(&self, key: &str) -> Option<&str> {
        let mut entries = self.metadata.split(';').filter_map(|entry| entry.split_once('='));
        entries.find(|(name, _)| *name == key).map(|(_, value)| value)
    }

    /// Samples up to the last that differs from the one before it: all that need be looked at.
    pub fn different_samples(&self) -> usize {
        self.samples.min(self.last_change + 1)
    }

    /// Which stored sample stands for sample `i`.
    fn stored(&self, i: usize) -> usize {
        if i < self.first_change || (self.first_change, self.last_change) == (0, 0) {
            0
        } else {
            // From the first change on, each is stored.
            i.min(self.last_change) - self.first_change + 1
        }
    }
}

/// An archive's tables and its file.
pub struct Tree<R> {
    from: Reader<R>,
    metadata: Vec<Rc<str>>,
    /// Time samplings.
    pub timings: Vec<Timing>,
    /// Frames a second in the program that wrote it, where it says so.
    pub frame_rate: Option<f64>,
    /// All objects, parents before their children; the first is the top.
    pub objects: Vec<Object>,
    /// Transforms of objects to the world at the time asked for last (s).
    pub worlds: (f64, HashMap<usize, DMat4>),
    /// Whether objects themselves are hidden, of those that were asked.
    pub visible: HashMap<usize, Vec<i64>>,
}

impl<R: Read + Seek> Tree<R> {
    /// Reads the tables and lists the objects.
    pub fn new(from: R) -> Result<Self, Problem> {
        let (mut from, root) = Reader::new(from)?;
        let &[version, _, top, about, timing, metadata] = root.get(..6).unwrap_or(&[]) else {
            return Err(Problem(format!("has {} parts at its root, but Alembic puts 6 there", root.len())));
        };
        let version = from.data(version)?;
        if version != [0; 4] {
            return Err(Problem(format!("has the unknown layout version {version:?}")));
        }
        let timings = timings(&from.data(timing)?)?;
        let metadata = table(&from.data(metadata)?)?;
        let about = String::from_utf8_lossy(&from.data(about).unwrap_or_default()).into_owned();
        let frame_rate = about.split(';').find_map(|entry| entry.strip_prefix("_ai_DCC_FPS=")?.parse().ok());
        let frame_rate = frame_rate.filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
        let worlds = (f64::NAN, HashMap::new());
        let (objects, visible) = (Vec::new(), HashMap::new());
        let mut tree = Self { from, metadata, timings, frame_rate, objects, worlds, visible };
        let top = Object { name: "".into(), metadata: "".into(), place: top, parent: None };
        let paths = tree.list(top, 0, 0, &mut HashSet::new())?;
        // A question may name every object several times: as what is there, as what is left out.
        tree.budget().next_question();
        tree.budget().take(paths.saturating_mul(4), "paths of objects")?;
        Ok(tree)
    }

    /// What reading the archive may take.
    pub fn budget(&self) -> &Budget {
        &self.from.budget
    }

    /// The names from the top down to an object, each behind a `/`.
    pub fn path(&self, object: usize) -> String {
        let upward = std::iter::successors(Some(object), |&i| self.objects[i].parent);
        let mut names: Vec<&str> = upward.map(|i| &*self.objects[i].name).collect();
        // The topmost has no name.
        names.pop();
        names.iter().rev().flat_map(|name| ["/", name]).collect()
    }

    /// Lists an object and all below it, and gives the bytes of their paths. `above`: those of the path of what it is in; `known`:
    /// the places of all before it.
    fn list(&mut self, object: Object, depth: usize, above: u64, known: &mut HashSet<u64>) -> Result<u64, Problem> {
        if depth > DEEPEST {
            let name = &object.name;
            return Err(Problem(format!("object {name:.80}: has more than {DEEPEST} ancestors")));
        }
        if object.name.len() > LONGEST_NAME {
            return Err(too_long(&object.name));
        }
        // Objects that lie in each other, or are shared by several, would be come to again and again.
        if object.place != 0 && !known.insert(object.place) {
            let name = &object.name;
            let what = "has several parents: export the archive again";
            return Err(Problem(format!("object {name:.80}: {what}")));
        }
        self.budget().keep((size_of::<Object>() + object.name.len() + 64) as u64, "objects")?;
        let own = above + object.name.len() as u64 + 1;
        let mut paths = own;
        let children = self.from.group(object.place)?;
        let parent = self.objects.len();
        let named = object.name.clone();
        self.objects.push(object);
        let Some((&headers, [_, children @ ..])) = children.split_last() else { return Ok(paths) };
        if !is_data(headers) {
            return Ok(paths);
        }
        let bytes = self.from.data(headers)?;
        let mut bytes = Bytes(&bytes[..bytes.len().saturating_sub(32)]);
        let mut children = children.iter();
        while !bytes.0.is_empty() {
            let length = bytes.number(4)?;
            let name = bytes.text(length)?.into();
            let index = bytes.number(1)?;
            let metadata = self.metadata(index, 4, &mut bytes)?;
            let &place = children.next().ok_or_else(|| Problem(format!("object {named}: has a child without data")))?;
            let child = Object { name, metadata, place, parent: Some(parent) };
            paths += self.list(child, depth + 1, own, known)?;
        }
        Ok(paths)
    }

    fn metadata(&self, index: usize, width: usize, bytes: &mut Bytes<'_>) -> Result<Rc<str>, Problem> {
        if index == usize::from(INLINE_METADATA) {
            let length = bytes.number(width)?;
            Ok(bytes.text(length)?.into())
        } else {
            let entry = self.metadata.get(index);
            entry.cloned().ok_or_else(|| Problem(format!("names metadata {index}, but has {}", self.metadata.len())))
        }
    }

    /// The properties of an object.
    pub fn properties_of(&mut self, object: usize) -> Result<Vec<Header>, Problem> {
        match self.from.child_of(self.objects[object].place, 0)? {
            Some(place) => self.properties(place),
            None => Ok(Vec::new()),
        }
    }

    /// The properties in the compound at `place`.
    pub fn properties(&mut self, place: u64) -> Result<Vec<Header>, Problem> {
        let children = self.from.group(place)?;
        let Some((&headers, children)) = children.split_last() else { return Ok(Vec::new()) };
        if !is_data(headers) {
            return Ok(Vec::new());
        }
        let bytes = self.from.data(headers)?;
        let mut bytes = Bytes(&bytes);
        let mut found = Vec::new();
        for &place in children {
            if bytes.0.is_empty() {
                break;
            }
            self.budget().take(size_of::<Header>() as u64 / 2, "properties")?;
            found.push(self.header(&mut bytes, place)?);
        }
        Ok(found)
    }

    fn header(&self, bytes: &mut Bytes<'_>, place: u64) -> Result<Header, Problem> {
        let info = bytes.number(4)? as u32;
        let width = match info >> flags::WIDTH_SHIFT & 3 {
            0 => 1,
            1 => 2,
            2 => 4,
            _ => return Err(Problem::new("has a property header of unknown width")),
        };
        let form = match info & flags::TYPE {
            0 => PropertyKind::Compound,
            1 => PropertyKind::Scalar,
            _ => PropertyKind::Array,
        };
        let mut kind = Kind { pod: Pod::U8, extent: 1 };
        let (mut samples, mut first_change, mut last_change, mut timing) = (0, 0, 0, 0);
        if form != PropertyKind::Compound {
            let code = info >> flags::POD_SHIFT & 0xf;
            let pod = Pod::from_code(code).ok_or_else(|| Problem(format!("has values of unknown type {code}")))?;
            kind = Kind { pod, extent: (info >> flags::EXTENT_SHIFT & 0xff) as u8 };
            samples = bytes.number(width)?;
            if info & flags::CHANGES != 0 {
                first_change = bytes.number(width)?;
                last_change = bytes.number(width)?;
            } else if info & flags::CONSTANT == 0 {
                (first_change, last_change) = (1, samples.saturating_sub(1));
            }
            if info & flags::TIMED != 0 {
                timing = bytes.number(width)?;
            }
        }
        let length = bytes.number(width)?;
        let name: Rc<str> = bytes.text(length)?.into();
        if name.len() > LONGEST_NAME {
            return Err(too_long(&name));
        }
        let metadata = self.metadata((info >> flags::METADATA_SHIFT & 0xff) as usize, width, bytes)?;
        if timing >= self.timings.len() || kind.extent == 0 || first_change > last_change {
            return Err(Problem(format!("property {name}: its header contradicts itself")));
        }
        Ok(Header { name, form, kind, metadata, samples, first_change, last_change, timing, place })
    }

    /// Bytes of sample `i` of a property; the nearest one it has.
    pub fn sample(&mut self, header: &Header, i: usize) -> Result<Vec<u8>, Problem> {
        let bytes = match self.place(header, i)? {
            Some(data) => self.from.data_after(data, DIGEST)?,
            None => Vec::new(),
        };
        // They become numbers of eight bytes or words that are each in memory by itself; half of that counts.
        let half = match header.kind.pod {
            Pod::Text => 24 * bytes.iter().filter(|&&b| b == 0).count(),
            pod => 4 * (bytes.len() / pod.size()),
        };
        self.budget().take(half.saturating_sub(bytes.len()) as u64, "samples")?;
        Ok(bytes)
    }

    /// Number of these bytes, which are not read.
    pub fn sample_length(&mut self, header: &Header, i: usize) -> Result<usize, Problem> {
        match self.place(header, i)? {
            Some(data) => Ok(self.from.length(data)?.saturating_sub(DIGEST)),
            None => Ok(0),
        }
    }

    /// Sample `i` of a property of points, without a detour where they are stored as they are wanted.
    pub fn points(&mut self, header: &Header, i: usize) -> Result<Vec<Vec3>, Problem> {
        if header.kind == (Kind { pod: Pod::F32, extent: 3 }) && cfg!(target_endian = "little") {
            return match self.place(header, i)? {
                Some(data) => self.from.plain_after(data, DIGEST),
                None => Ok(Vec::new()),
            };
        }
        let numbers = singles(header.kind, &self.sample(header, i)?)?;
        Ok(numbers.as_chunks::<3>().0.iter().map(|&p| Vec3::from(p)).collect())
    }

    /// Where the data of sample `i` is.
    fn place(&mut self, header: &Header, i: usize) -> Result<Option<u64>, Problem> {
        if header.samples == 0 || header.form == PropertyKind::Compound {
            return Ok(None);
        }
        let each = if header.form == PropertyKind::Array { 2 } else { 1 };
        let stored = header.stored(i.min(header.samples - 1));
        let data = self.from.child_of(header.place, each * stored)?;
        data.map(Some).ok_or_else(|| Problem(format!("property {}: sample {i} is missing", header.name)))
    }
}

fn too_long(name: &str) -> Problem {
    let length = name.len();
    Problem(format!(
        "has the name \"{name:.40}...\" of {length} bytes: names of at most {LONGEST_NAME} are read; rename it"
    ))
}

fn timings(bytes: &[u8]) -> Result<Vec<Timing>, Problem> {
    let mut bytes = Bytes(bytes);
    let mut found = Vec::new();
    while !bytes.0.is_empty() {
        bytes.number(4)?;
        let period = bytes.double()?;
        let count = bytes.number(4)?;
        if count == 0 || count > bytes.0.len() / 8 {
            return Err(Problem(format!("claims {count} times, but only {} bytes are left", bytes.0.len())));
        }
        let times: Vec<f64> = (0..count).map(|_| bytes.double()).collect::<Result<_, _>>()?;
        if !(period > 0.0 && times.iter().all(|t| t.is_finite())) {
            return Err(Problem(format!("has times that are not finite, or a cycle of {period} s")));
        }
        found.push(Timing { period, times });
    }
    Ok(found)
}

fn table(bytes: &[u8]) -> Result<Vec<Rc<str>>, Problem> {
    let mut bytes = Bytes(bytes);
    let mut found: Vec<Rc<str>> = vec!["".into()];
    while !bytes.0.is_empty() {
        let length = bytes.number(1)?;
        found.push(bytes.text(length)?.into());
    }
    Ok(found)
}

/// Bytes yet to be read.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], Problem> {
        let (taken, rest) =
            self.0.split_at_checked(length).ok_or_else(|| Problem::new("has a header that ends too early"))?;
        self.0 = rest;
        Ok(taken)
    }

    fn number(&mut self, width: usize) -> Result<usize, Problem> {
        let mut all = [0; 8];
        all[..width].copy_from_slice(self.take(width)?);
        Ok(u64::from_le_bytes(all) as usize)
    }

    fn double(&mut self) -> Result<f64, Problem> {
        Ok(f64::from_le_bytes(self.take(8)?.try_into().expect("eight bytes")))
    }

    fn text(&mut self, length: usize) -> Result<String, Problem> {
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}
