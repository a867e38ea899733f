//! A layer being read, whether text or binary: values are fetched when they are asked for.

use std::collections::HashMap;
use std::fs::File;
use std::io::SeekFrom;
use std::rc::Rc;

use glam::{DMat4, DQuat, Vec3};
use nabiki_exchange::{Budget, Window};

use crate::Problem;
use crate::crate_file::MAGIC;
use crate::crate_file::read::CrateReader;
use crate::rig::Rigs;
use crate::source::{BLOCKED, Handle, Name, PrimInfo, Source};
use crate::standing::Standing;
use crate::text::read as text;

/// A layer.
pub struct Layer {
    /// Prims, parents before their children.
    pub prims: Vec<PrimInfo>,
    /// What the layer says about itself.
    pub metadata: HashMap<Name, Handle>,
    /// What reading the layer may take.
    pub budget: Rc<Budget>,
    /// What each prim is by those above it.
    pub standing: Vec<Standing>,
    /// Whether a prim is itself invisible, once that was asked.
    pub invisible: HashMap<usize, Option<bool>>,
    /// Transforms of prims to the world at the time code asked for last.
    pub worlds: (f64, HashMap<usize, DMat4>),
    /// What the order of each prim names and that is not there, once that was asked.
    pub not_there: HashMap<usize, Rc<[String]>>,
    /// The skeletons that were asked for: thousands of prims may hang on one.
    pub rigs: Rigs,
    values: Values,
    /// Prims by what is above them and their names, when they are first looked up.
    by_name: Option<HashMap<(Option<usize>, Name), usize>>,
}

enum Values {
    Text(Box<dyn Source>),
    Binary(Box<CrateReader<Box<dyn Source>>>),
}

impl Layer {
    /// Reads what prims a layer has; it is told by its first bytes whether it is text.
    pub fn open(mut from: Box<dyn Source>) -> Result<Self, Problem> {
        let mut first = [0; 8];
        let length = from.seek(SeekFrom::End(0))?;
        from.seek(SeekFrom::Start(0))?;
        from.read_exact(&mut first[..length.min(8) as usize])?;
        from.seek(SeekFrom::Start(0))?;
        let budget = Rc::new(Budget::of(length));
        if first == *MAGIC {
            let (reader, prims, metadata) = CrateReader::new(from, length, budget.clone())?;
            return Self::of(prims, metadata, budget, Values::Binary(Box::new(reader)));
        }
        if first.starts_with(b"PK\x03\x04") {
            return Err(Problem::new("is a .usdz package: unpack it and give the layer inside"));
        }
        if first.starts_with(b"\xef\xbb\xbf") {
            return Err(Problem::new(
                "begins with a byte order mark, which USD does not read: save it as UTF-8 without one",
            ));
        }
        if !first.starts_with(b"#usda") && !first.starts_with(b"#sdf") {
            return Err(Problem::new("is not a USD layer: it begins neither with #usda nor with PXR-USDC"));
        }
        let (prims, metadata) = text::parse(&mut *from, length, &budget)?;
        Self::of(prims, metadata, budget, Values::Text(from))
    }

    fn of(
        prims: Vec<PrimInfo>,
        metadata: HashMap<Name, Handle>,
        budget: Rc<Budget>,
        values: Values,
    ) -> Result<Self, Problem> {
        budget.keep((prims.len() * size_of::<Standing>()) as u64, "prims")?;
        let standing = Standing::of_all(&prims);
        let paths: u64 = standing.iter().map(|prim| u64::from(prim.path_bytes)).sum();
        // A question may name every prim several times: as what is there, as what is left out.
        budget.next_question();
        budget.take(4 * paths, "paths of prims")?;
        let worlds = (f64::NAN, HashMap::new());
        Ok(Self {
            prims,
            metadata,
            budget,
            standing,
            invisible: HashMap::new(),
            worlds,
            not_there: HashMap::new(),
            rigs: Rigs::default(),
            values,
            by_name: None,
        })
    }

    /// Opens the layer in a file.
    pub fn file(path: &std::path::Path) -> Result<Self, Problem> {
        Self::open(Box::new(Window::new(File::open(path)?)?))
    }

    /// All numbers of a value, in a row; nothing for text.
    pub fn numbers(&mut self, handle: Handle) -> Result<Vec<f64>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::numbers(&mut **from, handle, &self.budget),
            Values::Binary(reader) => reader.numbers(handle.0),
        }
    }

    /// All numbers of a value as singles.
    pub fn singles(&mut self, handle: Handle) -> Result<Vec<f32>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::numbers(&mut **from, handle, &self.budget),
            Values::Binary(reader) => reader.singles(handle.0),
        }
    }

    /// All numbers of a value as points.
    pub fn points(&mut self, handle: Handle) -> Result<Vec<Vec3>, Problem> {
        match &mut self.values {
            Values::Text(from) => {
                let numbers: Vec<f32> = text::numbers(&mut **from, handle, &self.budget)?;
                Ok(numbers.as_chunks::<3>().0.iter().map(|&p| Vec3::from(p)).collect())
            }
            Values::Binary(reader) => reader.points(handle.0),
        }
    }

    /// All numbers of a value as whole numbers.
    pub fn integers(&mut self, handle: Handle) -> Result<Vec<i64>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::numbers(&mut **from, handle, &self.budget),
            Values::Binary(reader) => reader.integers(handle.0),
        }
    }

    /// How many values an attribute of `extent` numbers a value has.
    pub fn count(&mut self, handle: Handle, extent: usize) -> Result<usize, Problem> {
        if let Values::Binary(reader) = &mut self.values
            && let Some(count) = reader.count(handle.0)?
        {
            return Ok(count);
        }
        Ok(self.numbers(handle)?.len() / extent)
    }

    /// Whether a value has more than so many numbers, as far as that can be told without reading them.
    pub fn has_more_than(&mut self, handle: Handle, numbers: usize) -> Result<bool, Problem> {
        // More letters than a double ever has, with blanks about it.
        const LETTERS: u64 = 400;
        match &mut self.values {
            Values::Text(_) => Ok(handle.1 > LETTERS * numbers as u64),
            Values::Binary(reader) => Ok(reader.count(handle.0)?.is_some_and(|count| count > numbers)),
        }
    }

    /// All words of a value: tokens or strings.
    pub fn words(&mut self, handle: Handle) -> Result<Vec<String>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::words(&mut **from, handle, &self.budget),
            Values::Binary(reader) => reader.words(handle.0),
        }
    }

    /// Path of a prim.
    pub fn path(&self, prim: usize) -> String {
        let mut names: Vec<&str> = self.upward(prim).map(|i| self.prims[i].name.as_str()).collect();
        names.reverse();
        let mut path = String::with_capacity(self.standing[prim].path_bytes as usize);
        names.into_iter().for_each(|name| path.extend(["/", name]));
        path
    }

    /// What a relationship names: `None` for what is no prim of the layer. None at all where the prim does not have it.
    pub fn targets(&mut self, prim: usize, name: &str) -> Result<Option<Vec<Option<usize>>>, Problem> {
        let mut own = self.prims[prim].relationships.iter().filter(|(own, _)| own == name);
        let Some(&(_, value)) = own.next_back() else { return Ok(None) };
        if value == BLOCKED {
            return Ok(Some(Vec::new()));
        }
        let paths = match &mut self.values {
            Values::Text(from) => text::targets(&mut **from, value)?,
            Values::Binary(reader) => return reader.targets(value.0).map(Some),
        };
        Ok(Some(paths.into_iter().map(|path| self.find(&path, prim)).collect()))
    }

    /// The prim that the nearest of `chain`, a prim and those above it, names by a relationship of skeletons.
    pub fn bound_target(&mut self, chain: &[usize], name: &str) -> Result<Option<usize>, Problem> {
        for &prim in chain {
            if !self.prims[prim].is_bound {
                continue;
            }
            // One that is blocked, or leads nowhere, is not inherited either.
            if let Some(targets) = self.targets(prim, name)? {
                return Ok(targets.first().copied().flatten());
            }
        }
        Ok(None)
    }

    /// The prim at a path from the root, or from `base` on.
    fn find(&mut self, path: &str, base: usize) -> Option<usize> {
        let prims = &self.prims;
        let by_name = self.by_name.get_or_insert_with(|| {
            let all = prims.iter().enumerate().rev();
            all.map(|(i, prim)| ((prim.parent, prim.name.clone()), i)).collect()
        });
        let mut at = if path.starts_with('/') { None } else { Some(base) };
        for name in path.split('/').filter(|name| !name.is_empty()) {
            at = match name {
                ".." => prims[at?].parent,
                name => Some(*by_name.get(&(at, Name::from(name)))?),
            };
        }
        at
    }

    /// The value of an attribute at a time code: the last sample at or before it, or the first; none where that is blocked.
    pub fn at(&self, prim: usize, name: &str, time: f64) -> Option<Handle> {
        let attribute = self.prims[prim].attributes.get(name)?;
        let after = attribute.samples.partition_point(|&(t, _)| t <= time + 1e-6);
        let value = match attribute.samples.get(after.saturating_sub(1)) {
            Some(&(_, handle)) => Some(handle),
            None => attribute.default,
        };
        value.filter(|&value| value != BLOCKED)
    }

    /// The values between which an attribute stands at a time code: the sample at or before it, and the one after with
    /// its share (0..1). Before the first sample and after the last, these hold, and so does what stands before a block.
    fn between(&self, prim: usize, name: &str, time: f64) -> Option<(Handle, Option<(Handle, f64)>)> {
        let attribute = self.prims[prim].attributes.get(name)?;
        let after = attribute.samples.partition_point(|&(t, _)| t <= time);
        let sample = |i: usize| attribute.samples.get(i).copied();
        match (after.checked_sub(1).and_then(sample), sample(after)) {
            (Some((_, BLOCKED)), _) | (None, Some((_, BLOCKED))) => None,
            (Some((from, low)), Some((to, high))) if time > from && high != BLOCKED => {
                Some((low, Some((high, (time - from) / (to - from)))))
            }
            (Some((_, value)), _) | (None, Some((_, value))) => Some((value, None)),
            (None, None) => attribute.default.filter(|&value| value != BLOCKED).map(|value| (value, None)),
        }
    }

    /// All numbers of an attribute at a time code, interpolated linearly between its samples as USD does; samples of
    /// different length are held.
    pub fn numbers_at(&mut self, prim: usize, name: &str, time: f64) -> Result<Option<Vec<f64>>, Problem> {
        let Some((low, high)) = self.between(prim, name, time) else { return Ok(None) };
        let mut numbers = self.numbers(low)?;
        if let Some((high, share)) = high {
            let next = self.numbers(high)?;
            if next.len() == numbers.len() {
                numbers.iter_mut().zip(next).for_each(|(a, b)| *a = (1.0 - share) * *a + share * b);
            }
        }
        Ok(Some(numbers))
    }

    /// As [`numbers_at`](Self::numbers_at) for points.
    pub fn points_at(&mut self, prim: usize, name: &str, time: f64) -> Result<Option<Vec<Vec3>>, Problem> {
        let Some((low, high)) = self.between(prim, name, time) else { return Ok(None) };
        let mut points = self.points(low)?;
        if let Some((high, share)) = high {
            let next = self.points(high)?;
            if next.len() == points.len() {
                points.iter_mut().zip(next).for_each(|(a, b)| *a = a.lerp(b, share as f32));
            }
        }
        Ok(Some(points))
    }

    /// The quaternions of an attribute at a time code, turned at a constant rate between samples as USD does.
    pub fn quaternions_at(&mut self, prim: usize, name: &str, time: f64) -> Result<Option<Vec<DQuat>>, Problem> {
        let Some((low, high)) = self.between(prim, name, time) else { return Ok(None) };
        let mut turns = self.quaternions(low)?;
        if let Some((high, share)) = high {
            let next = self.quaternions(high)?;
            if next.len() == turns.len() {
                turns.iter_mut().zip(next).for_each(|(a, b)| *a = a.slerp(b, share));
            }
        }
        Ok(Some(turns))
    }

    fn quaternions(&mut self, handle: Handle) -> Result<Vec<DQuat>, Problem> {
        let real_first = matches!(self.values, Values::Text(_));
        let turn = |&[a, b, c, d]: &[f64; 4]| {
            let turn = if real_first { DQuat::from_xyzw(b, c, d, a) } else { DQuat::from_xyzw(a, b, c, d) };
            if turn.length() > 0.0 { turn.normalize() } else { DQuat::IDENTITY }
        };
        Ok(self.numbers(handle)?.as_chunks::<4>().0.iter().map(turn).collect())
    }

    /// How many values an attribute has, by its own word: `uniform`, `vertex`.
    pub fn interpolation(&mut self, prim: usize, name: &str) -> Result<Option<String>, Problem> {
        let Some(handle) = self.prims[prim].attributes.get(name).and_then(|a| a.interpolation) else { return Ok(None) };
        match &mut self.values {
            Values::Text(from) => text::interpolation(&mut **from, handle),
            Values::Binary(reader) => Ok(reader.words(handle.0)?.into_iter().next()),
        }
    }

    /// Prims of a type that are on the stage.
    pub fn of_type(&self, wanted: &str) -> Vec<usize> {
        let all = 0..self.prims.len();
        all.filter(|&i| self.prims[i].type_name == wanted && self.is_on_stage(i)).collect()
    }

    /// Whether neither a prim nor any above it is inactive or a class.
    pub fn is_active(&self, prim: usize) -> bool {
        self.standing[prim].is_active
    }

    /// Whether this layer by itself has a prim on its stage, at the prim's own place.
    pub fn is_on_stage(&self, prim: usize) -> bool {
        self.is_defined(prim) && self.instancer(prim).is_none()
    }

    /// Whether this layer by itself defines a prim that is active.
    pub fn is_defined(&self, prim: usize) -> bool {
        self.standing[prim].is_defined
    }

    /// What draws a prim at other places than its own: the point instancer that it stands below.
    pub fn instancer(&self, prim: usize) -> Option<usize> {
        self.standing[prim].instancer
    }

    /// Prims of a type that are on the stage and have points; all that are there, where none has.
    pub fn with_points(&self, wanted: &str) -> Vec<usize> {
        let (some, none): (Vec<usize>, Vec<usize>) =
            self.of_type(wanted).into_iter().partition(|&i| self.has_points(i));
        if some.is_empty() { none } else { some }
    }

    /// Prims of a type that [`with_points`](Self::with_points) leaves out, a phrase each. `what`: the type's word.
    pub fn without_points(&self, wanted: &str, what: &str) -> Vec<String> {
        let (some, none): (Vec<usize>, Vec<usize>) =
            self.of_type(wanted).into_iter().partition(|&i| self.has_points(i));
        let none = none.into_iter().filter(|_| !some.is_empty());
        none.map(|prim| format!("{what} {}: no points", self.path(prim))).collect()
    }

    /// Whether a prim has points at any time.
    pub fn has_points(&self, prim: usize) -> bool {
        self.prims[prim].attributes.get("points").is_some_and(|points| points.is_authored())
    }

    /// A prim and those above it, from below.
    pub fn upward(&self, prim: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(prim), |&i| self.prims[i].parent)
    }

    /// The first word of a token attribute.
    pub fn word(&mut self, prim: usize, name: &str) -> Result<Option<String>, Problem> {
        match self.at(prim, name, f64::NEG_INFINITY) {
            Some(handle) => Ok(self.words(handle)?.into_iter().next()),
            None => Ok(None),
        }
    }

    /// Whether other layers stand below this one.
    pub fn has_sublayers(&mut self) -> Result<bool, Problem> {
        let Some(&list) = self.metadata.get("subLayers") else { return Ok(false) };
        match &mut self.values {
            Values::Text(from) => text::holds_any(&mut **from, list),
            Values::Binary(reader) => reader.holds_any(list.0),
        }
    }

    /// A number the layer says about itself.
    pub fn metadata_number(&mut self, name: &str) -> Result<Option<f64>, Problem> {
        match self.metadata.get(name).copied() {
            Some(handle) => Ok(self.numbers(handle)?.first().copied()),
            None => Ok(None),
        }
    }
}
