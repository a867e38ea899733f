//! The wish file: which hair should be where in which frames, and what may change for it.

use std::path::Path;

use glam::Vec3;
use nabiki::SettingError;
use nabiki::field::{Ease, Keyframe, KeyframedField};
use nabiki::solve::{Goal, Prior, Search, Unknown, with_interval};
use nabiki_io::input;
use serde::Deserialize;
use toml::{Table, Value};

use crate::scene::read::Node;
use crate::scene::tree::{self, Origins};
use crate::scene::{SceneError, file_error};

/// A wish file, TOML: `[unknowns]`, `[[wish]]`, `[[nail]]`, `[prior]`, `[search]`.
#[derive(Clone, Debug, PartialEq)]
pub struct WishFile {
    /// The wishes.
    pub wishes: Wishes,
    origins: Origins,
}

/// The contents of a wish file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "a wish file")]
pub struct Wishes {
    /// The space of its points (default: the world).
    pub space: WishSpace,
    /// What may change. By default, the vectors of all intervals that can influence wishes and nails.
    pub unknowns: Option<Unknowns>,
    /// Where locks should be.
    pub wish: Vec<WishEntry>,
    /// Locks that should stay.
    pub nail: Vec<NailEntry>,
    /// Preferences among solutions.
    pub prior: Prior,
    /// Limits of the search.
    pub search: Search,
}

/// The space of the points of a wish file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WishSpace {
    /// The world, in the frame of the wish.
    #[default]
    World,
    /// Head space.
    Head,
}

/// `[unknowns]`: what may change.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Unknowns {
    /// Indices of the intervals whose vectors may change, from 0 in the order of `[[force]]`. A new interval is counted
    /// as if it were there already, and may change without being listed.
    pub vectors: Vec<usize>,
    /// Indices of the intervals whose last frame, the border to the next one, may change.
    pub borders: Vec<usize>,
    /// A new interval.
    pub interval: Option<Interval>,
    /// Whether `gust.intensity` may change.
    pub gust: bool,
    /// Whether `free.stiffness` may change, by one common factor.
    pub stiffness: bool,
    /// Whether `free.settle` may change, by one common factor.
    pub settle: bool,
}

/// A new interval of the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Its first frame, from 1 on.
    pub from: u32,
    /// Its last frame.
    pub through: u32,
}

/// Some strands, or parts of them: named, or found near a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lock<'a> {
    /// Indices of strands of the scene.
    pub strands: &'a [u32],
    /// All strands with a node near a point.
    pub near: Option<Near>,
    /// The part of each strand, 0 at its root and 1 at its tip. By default, all of the strands in `strands`, and the
    /// near nodes of strands found near a point.
    pub along: Option<[f32; 2]>,
}

/// A neighbourhood of a point.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Near {
    /// The point (cm).
    pub point: Vec3,
    /// The distance (cm).
    pub radius: f32,
    /// The frame in which to look for the hair; 0 is rest (default: the frame of the wish).
    pub frame: Option<u32>,
}

/// `[[wish]]`: where a lock should be in a frame, given by one of `moved`, `mean_moved`, `mean_at`, `places`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WishEntry {
    /// The frame.
    pub frame: u32,
    /// Indices of strands.
    #[serde(default)]
    pub strands: Vec<u32>,
    /// Or all strands with a node near a point.
    pub near: Option<Near>,
    /// The part of each strand.
    pub along: Option<[f32; 2]>,
    /// Each node moved by this from where it is (cm).
    pub moved: Option<Vec3>,
    /// Their mean moved by this (cm).
    pub mean_moved: Option<Vec3>,
    /// Their mean here (cm).
    pub mean_at: Option<Vec3>,
    /// Each node at its own place, strand by strand from the node after the root to the tip (cm).
    pub places: Option<Vec<Vec3>>,
    /// Weight relative to others, above 0 (default 1).
    #[serde(default = "one")]
    pub weight: f32,
}

/// `[[nail]]`: a lock should stay as it is in some frames.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NailEntry {
    /// The frames.
    pub frames: Vec<u32>,
    /// Indices of strands.
    #[serde(default)]
    pub strands: Vec<u32>,
    /// Or all strands with a node near a point.
    pub near: Option<Near>,
    /// The part of each strand.
    pub along: Option<[f32; 2]>,
    /// Weight in each frame relative to others, above 0 (default 1).
    #[serde(default = "one")]
    pub weight: f32,
}

fn one() -> f32 {
    1.0
}

impl WishFile {
    /// Reads a wish file.
    ///
    /// # Errors
    /// If the file is invalid: file, line, key, value and remedy.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = input::read_text(path, input::MOST_SCENE_BYTES).map_err(|e| file_error(path, e))?;
        Self::parse(&text, path)
    }

    /// Reads wishes from text. `path` is the name in errors.
    ///
    /// # Errors
    /// As for [`load`](Self::load).
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        let (table, origins) = tree::parse(text, path, &[], Table::new)?;
        let wishes = Wishes::deserialize(Node(&Value::Table(table))).map_err(|refusal| {
            let (key, problem) = refusal.into_parts();
            origins.error(&key, problem)
        })?;
        let file = Self { wishes, origins };
        file.wishes.check().map_err(|refused| file.refusal(refused))?;
        Ok(file)
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.origins.file
    }

    /// Adds file and line to an error.
    pub fn refusal(&self, refused: SettingError) -> SceneError {
        let SceneError { key, problem, .. } = refused.into();
        self.origins.error(&key.to_string(), *problem)
    }
}

impl Wishes {
    /// Refuses wishes that are invalid for any scene.
    ///
    /// # Errors
    /// Names the first such value.
    pub fn check(&self) -> Result<(), SettingError> {
        if self.wish.is_empty() && self.nail.is_empty() {
            let remedy = "is missing: give a [[wish]] with frame, strands or near, and a goal";
            return Err(SettingError::new("wish", "", remedy));
        }
        self.unknowns.as_ref().map_or(Ok(()), Unknowns::check)?;
        for (i, wish) in self.wish.iter().enumerate() {
            let name = format!("wish[{i}]");
            wish.lock().check(&name)?;
            check_weight(&name, wish.weight)?;
            wish.goal(&name)?;
        }
        for (i, nail) in self.nail.iter().enumerate() {
            let name = format!("nail[{i}]");
            nail.lock().check(&name)?;
            check_weight(&name, nail.weight)?;
            if nail.frames.is_empty() {
                let remedy = "name the frames to keep, frames = [20, 40]";
                return Err(SettingError::new(format!("{name}.frames"), "[]", remedy));
            }
        }
        let Search { iterations, starts, near_cm: near, .. } = self.search;
        for (thing, value, most) in [("search.iterations", iterations, 10_000), ("search.starts", starts, 1000)] {
            if !(1..=most).contains(&value) {
                return Err(SettingError::new(thing, value, format!("must lie in 1..{most}")));
            }
        }
        let prior = [("prior.keep", self.prior.keep), ("prior.alike", self.prior.alike)];
        for (thing, value) in
            prior.map(|(thing, value)| (thing, f64::from(value))).into_iter().chain([("search.near", near)])
        {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SettingError::new(thing, value, "must be a finite distance of at least 0 cm"));
            }
        }
        Ok(())
    }

    /// What may change in a scene with this number of `intervals`.
    pub fn unknowns(&self, intervals: usize) -> Unknowns {
        let all = || Unknowns { vectors: (0..intervals).collect(), ..Unknowns::default() };
        self.unknowns.clone().unwrap_or_else(all)
    }

    /// The largest index of a strand in the wishes.
    pub fn largest_strand(&self) -> Option<u32> {
        let named = self.wish.iter().flat_map(|wish| &wish.strands);
        named.chain(self.nail.iter().flat_map(|nail| &nail.strands)).copied().max()
    }
}

impl Unknowns {
    fn check(&self) -> Result<(), SettingError> {
        let Self { vectors, borders, interval, gust, stiffness, settle } = self;
        if vectors.is_empty() && borders.is_empty() && interval.is_none() && !gust && !stiffness && !settle {
            let remedy = "is empty, so nothing may change: give vectors, borders, interval, gust, stiffness or settle";
            return Err(SettingError::new("unknowns", "", remedy));
        }
        for (key, list) in [("vectors", vectors), ("borders", borders)] {
            if let Some(i) = (0..list.len()).find(|&i| list[..i].contains(&list[i])) {
                let remedy = "is named twice: name it once";
                return Err(SettingError::new(format!("unknowns.{key}[{i}]"), list[i], remedy));
            }
        }
        match interval {
            Some(Interval { from, through }) if *from == 0 || from > through => {
                let remedy = format!("must lie in 1..{through}, the interval's last frame");
                Err(SettingError::new("unknowns.interval.from", from, remedy))
            }
            _ => Ok(()),
        }
    }

    /// The unknowns that a wish can feel, and a line about each one that none can, which stays as it is. `force` and
    /// `unknowns`: from [`of`](Self::of); `last`: the last frame of a wish or nail.
    ///
    /// # Errors
    /// Names the first vector, where nothing is left that may change.
    pub(crate) fn within_reach(
        &self,
        force: &[Keyframe],
        ease: Ease,
        unknowns: &[Unknown],
        last: u32,
    ) -> Result<(Vec<Unknown>, Vec<String>), SettingError> {
        let first_felt = |unknown: Unknown| match unknown {
            // A border that may change may bring the interval after it nearer.
            Unknown::Vector(j) if !unknowns.iter().any(|u| matches!(u, Unknown::Border(before) if *before < j)) => {
                KeyframedField::new(force).map(|field| field.eased(ease).first_felt(j))
            }
            _ => Ok(1),
        };
        let (mut felt, mut out_of_reach) = (Vec::new(), Vec::new());
        for &unknown in unknowns {
            let first = first_felt(unknown)?;
            if first <= last {
                felt.push(unknown);
                continue;
            }
            let why = format!("first felt in frame {first}, after the last frame of a wish or nail, {last}");
            let named = self.vectors.iter().position(|&j| unknown == Unknown::Vector(j));
            let (key, value) = match (named, self.interval) {
                (Some(i), _) => (format!("unknowns.vectors[{i}]"), self.vectors[i].to_string()),
                (None, interval) => {
                    let from = interval.map_or(first, |interval| interval.from);
                    ("unknowns.interval.from".to_owned(), from.to_string())
                }
            };
            out_of_reach.push((key, value, why));
        }
        if felt.is_empty()
            && let Some((key, value, why)) = out_of_reach.first()
        {
            let remedy = format!("{why}: let an earlier wind change, or wish for a later frame");
            return Err(SettingError::new(key.as_str(), value, remedy));
        }
        let line = |(key, value, why): (String, String, String)| format!("{key} = {value} does not change: {why}");
        Ok((felt, out_of_reach.into_iter().map(line).collect()))
    }

    /// The intervals of a scene, including the new one if there is one, and all unknowns.
    ///
    /// # Errors
    /// Intervals that do not exist, or an interval beyond the scene's `frames`.
    pub fn of(&self, force: &[Keyframe], frames: u32) -> Result<(Vec<Keyframe>, Vec<Unknown>), SettingError> {
        let Self { vectors, borders, interval, gust, stiffness, settle } = self;
        let (force, new) = match *interval {
            None => (force.to_vec(), None),
            Some(Interval { through, .. }) if through > frames => {
                let remedy = format!("hair moves in frames 1 to {frames} of the scene");
                return Err(SettingError::new("unknowns.interval.through", through, remedy));
            }
            Some(Interval { from, through }) => {
                let (force, new) = with_interval(force, from, through);
                (force, Some(new))
            }
        };
        let there = |key: &str, i: usize, j: usize| {
            let remedy = match force.len() {
                n if j < n => return Ok(()),
                0 => "the scene has no [[force]]: give it one, or ask for a new interval".to_owned(),
                1 => "the only interval of [[force]] is number 0".to_owned(),
                n => format!("the intervals of [[force]] are 0 to {}", n - 1),
            };
            Err(SettingError::new(format!("unknowns.{key}[{i}]"), j, remedy))
        };
        let mut unknowns = Vec::new();
        for (i, &j) in vectors.iter().enumerate() {
            there("vectors", i, j)?;
            unknowns.push(Unknown::Vector(j));
        }
        unknowns.extend(new.filter(|new| !vectors.contains(new)).map(Unknown::Vector));
        for (i, &j) in borders.iter().enumerate() {
            there("borders", i, j)?;
            if j + 1 == force.len() {
                let remedy = "the last interval has no border after it: name an earlier one";
                return Err(SettingError::new(format!("unknowns.borders[{i}]"), j, remedy));
            }
            unknowns.push(Unknown::Border(j));
        }
        let others = [(gust, Unknown::Gust), (stiffness, Unknown::Stiffness), (settle, Unknown::Settle)];
        unknowns.extend(others.into_iter().filter(|(free, _)| **free).map(|(_, unknown)| unknown));
        Ok((force, unknowns))
    }
}

impl WishEntry {
    pub(super) fn lock(&self) -> Lock<'_> {
        Lock { strands: &self.strands, near: self.near, along: self.along }
    }

    /// Its goal, in the file's space. `name`: the name of the wish.
    pub(super) fn goal(&self, name: &str) -> Result<Goal, SettingError> {
        let goals = [
            ("moved", self.moved.map(Goal::Moved)),
            ("mean_moved", self.mean_moved.map(Goal::MeanMoved)),
            ("mean_at", self.mean_at.map(Goal::MeanAt)),
            ("places", self.places.clone().map(Goal::Places)),
        ];
        let mut given = goals.into_iter().filter_map(|(key, goal)| Some((key, goal?)));
        let (first, second) = (given.next(), given.next());
        let Some((key, goal)) = first else {
            let remedy = "has no goal: give one of moved, mean_moved, mean_at and places";
            return Err(SettingError::new(name, "", remedy));
        };
        if let Some((other, _)) = second {
            let remedy = format!("is given with {key}: give only one of moved, mean_moved, mean_at and places");
            return Err(SettingError::new(format!("{name}.{other}"), "", remedy));
        }
        let finite = match &goal {
            Goal::Moved(v) | Goal::MeanMoved(v) | Goal::MeanAt(v) => v.is_finite(),
            Goal::Places(places) => places.iter().all(|p| p.is_finite()),
            Goal::Stay => true,
        };
        match finite {
            true => Ok(goal),
            false => {
                let remedy = "is not finite: every coordinate must be a finite number (cm)";
                Err(SettingError::new(format!("{name}.{key}"), "", remedy))
            }
        }
    }
}

impl NailEntry {
    pub(super) fn lock(&self) -> Lock<'_> {
        Lock { strands: &self.strands, near: self.near, along: self.along }
    }
}

impl Lock<'_> {
    fn check(&self, name: &str) -> Result<(), SettingError> {
        let Self { strands, near, along } = self;
        match (strands.is_empty(), near) {
            (false, None) => {}
            (true, None) => {
                let remedy = "names no hair: give strands = [0, 1], or near = { point = [x, y, z], radius = 2 }";
                return Err(SettingError::new(name, "", remedy));
            }
            (false, Some(_)) => {
                let remedy = "is given with strands: give only one of the two";
                return Err(SettingError::new(format!("{name}.near"), "", remedy));
            }
            (true, Some(Near { point, radius, .. })) => {
                if !point.is_finite() {
                    let remedy = "must be three finite numbers (cm)";
                    return Err(SettingError::new(format!("{name}.near.point"), point, remedy));
                }
                if !(radius.is_finite() && *radius > 0.0) {
                    let remedy = "must be a finite length above 0 cm";
                    return Err(SettingError::new(format!("{name}.near.radius"), radius, remedy));
                }
            }
        }
        match along {
            Some([from, to]) if !(0.0 <= *from && from <= to && *to <= 1.0) => {
                let remedy = "must be two parts of a strand in order, from 0 at the root to 1 at the tip";
                Err(SettingError::new(format!("{name}.along"), format!("[{from}, {to}]"), remedy))
            }
            _ => Ok(()),
        }
    }
}

fn check_weight(name: &str, weight: f32) -> Result<(), SettingError> {
    if weight.is_finite() && weight > 0.0 {
        return Ok(());
    }
    Err(SettingError::new(format!("{name}.weight"), weight, "must be a finite number above 0"))
}
