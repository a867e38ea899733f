//! Attributes of curves in a file, by the names that programs use.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::rc::Rc;

use nabiki::hair::{Attributes, Other, Per, Role, Stored, Values};

use crate::curves::Polylines;
use crate::{Budget, Problem};

/// A source of attribute values by name.
pub trait NamedValues {
    /// What reading the file may take.
    fn budget(&self) -> &Budget;

    /// The names of all there are.
    fn names(&self) -> Vec<String>;

    /// Why the values of a name cannot be looked up, where they are stored by index: see [`misindexed`].
    ///
    /// # Errors
    /// If the file is invalid.
    fn misindexed(&mut self, name: &str) -> Result<Option<&'static str>, Problem>;

    /// Whether the values of a name have more numbers than the `read` first of each, which are all that is read: such values
    /// also stay under that name.
    fn is_wider(&self, _name: &str, _read: usize) -> bool {
        false
    }

    /// Values of `N` numbers each; `None` where there are none of that name and shape.
    ///
    /// # Errors
    /// If the file is invalid.
    fn tuples<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f32; N]>>, Problem>;

    /// Whole numbers, however they are stored; `None` where there are none of that name, or some are not [`whole`].
    ///
    /// # Errors
    /// If the file is invalid.
    fn integers(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem>;

    /// Words; `None` where there are none of that name.
    ///
    /// # Errors
    /// If the file is invalid.
    fn words(&mut self, name: &str) -> Result<Option<Vec<String>>, Problem>;

    /// The values of a name, whatever they are; `None` for a kind that is not known.
    ///
    /// # Errors
    /// If the file is invalid.
    fn whatever(&mut self, name: &str) -> Result<Option<Whatever>, Problem>;
}

/// Converts numbers to whole numbers; `None` if some are not whole. This rejects random numbers between 0 and 1 that
/// some programs store under the name of ids.
pub fn whole(numbers: &[f64]) -> Option<Vec<i64>> {
    // Beyond that not every whole number can be told from its neighbours.
    let is_whole = |x: &f64| x.fract() == 0.0 && x.abs() <= 9_007_199_254_740_992.0;
    numbers.iter().all(is_whole).then(|| numbers.iter().map(|&x| x as i64).collect())
}

/// The values of an attribute as stored in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Whatever {
    /// The meaning of their numbers.
    pub role: Role,
    /// Number of numbers or words in a value.
    pub extent: usize,
    /// How the file stores a number or word.
    pub stored: Stored,
    /// Whether it is a single value, as opposed to a list with one entry.
    pub single: bool,
    /// What each value belongs to, if the file says so. Otherwise the number of values decides.
    pub per: Option<Per>,
    /// The values.
    pub values: Values,
}

/// The names in files of the attributes that [`Hair`](nabiki::Hair) knows: those of USD and Alembic, of Unreal's grooms
/// (`groom_...`), of Blender (`surface_uv_coordinate`, `UVMap`) and of Houdini (`rootuv`, `id`). The first name with
/// values is used.
pub mod names {
    #![allow(missing_docs)]
    pub const WIDTH: &[&str] = &["widths", "width", "groom_width"];
    pub const COLOR: &[&str] = &["displayColor", "groom_color", "color"];
    pub const POINT_UV: &[&str] = &["point_uv"];
    pub const FREEDOM: &[&str] = &["freedom"];
    pub const TRANSPARENCY: &[&str] = &["transparency"];
    pub const OPACITY: &[&str] = &["displayOpacity"];
    pub const ID: &[&str] = &["groom_id", "id", "ids", "hairId"];
    pub const ROOT_UV: &[&str] = &["st", "groom_root_uv", "root_uv", "surface_uv_coordinate", "rootuv", "uv", "UVMap"];
    pub const GROUP: &[&str] = &["groom_group_id", "group_id", "group"];
    pub const GROUP_NAME: &[&str] = &["groom_group_name", "group_name"];
    pub const GUIDE: &[&str] = &["groom_guide", "guide"];
    /// The names that this project's writers use. An attribute found under another name also keeps that name.
    pub const WRITTEN: &[&str] = &[
        "widths",
        "width",
        "displayColor",
        "groom_color",
        "point_uv",
        "freedom",
        "transparency",
        "displayOpacity",
        "groom_id",
        "st",
        "uv",
        "groom_root_uv",
        "surface_uv_coordinate",
        "groom_group_id",
        "groom_group_name",
        "groom_guide",
    ];
    /// The positions of the points at rest.
    pub const REST: &str = "rest";
}

/// Why `count` values cannot be looked up by `indices`: an index is out of range (files use this for a missing value),
/// or there are no values.
pub fn misindexed(indices: &[i64], count: usize) -> Option<&'static str> {
    if indices.is_empty() && count > 0 {
        return Some("its list of indices is empty");
    }
    let is_past = |&i: &i64| usize::try_from(i).map_or(true, |i| i >= count);
    indices.iter().any(is_past).then_some("some of its indices name no value")
}

/// Expands values that are stored once and referred to by `indices`.
///
/// # Errors
/// An index out of range. `name` is the attribute's name.
pub fn indexed<T: Clone>(name: &str, values: &[T], indices: &[i64]) -> Result<Vec<T>, Problem> {
    let pick = |&i: &i64| usize::try_from(i).ok().and_then(|i| values.get(i)).cloned();
    let picked: Option<Vec<T>> = indices.iter().map(pick).collect();
    picked.ok_or_else(|| Problem(format!("{name}: an index past its {} values", values.len())))
}

/// Like [`indexed`], for values of `extent` parts each.
///
/// # Errors
/// An index out of range. `name` is the attribute's name.
pub fn indexed_values(name: &str, values: &Values, extent: usize, indices: &[i64]) -> Result<Values, Problem> {
    let all: Vec<usize> = (0..values.len() / extent.max(1)).collect();
    Ok(values.pick(extent, &indexed(name, &all, indices)?))
}

/// How the type of an attribute changes if a format stores it as `stored` with this `role`. `None` if neither changes.
pub fn type_change(other: &Other, stored: Stored, role: Role) -> Option<String> {
    let name = &other.name;
    if stored != other.stored {
        return Some(format!("the type of {name}: {} becomes {}", type_name(other.stored), type_name(stored)));
    }
    (role != other.role)
        .then(|| format!("the meaning of the numbers of {name}: {} become plain numbers", plural(other.role)))
}

/// Bytes of a name that is written; readers refuse much longer ones.
const LONGEST_NAME: usize = 1000;

/// Unique names for attributes in a format, in order. A name stays if `valid` returns it unchanged; otherwise the
/// result of `valid` is used. If a name is taken by another attribute or `reserved`, a number is appended.
pub fn unique_names(others: &[Other], valid: impl Fn(&str) -> String, reserved: &[&str]) -> Vec<String> {
    let short = |name: &str| {
        let end = (0..=LONGEST_NAME.min(name.len())).rev().find(|&end| name.is_char_boundary(end));
        valid(&name[..end.unwrap_or_default()])
    };
    let valid: Vec<String> = others.iter().map(|other| short(&other.name)).collect();
    let mut taken: HashSet<String> = HashSet::new();
    let kept: Vec<bool> =
        others.iter().zip(&valid).map(|(other, valid)| *valid == other.name && taken.insert(valid.clone())).collect();
    taken.extend(reserved.iter().map(|&name| name.to_owned()));
    // The number that each name came to, so that thousands of one name are not counted anew.
    let mut numbers: HashMap<String, usize> = HashMap::new();
    let unique = |(kept, name): (bool, String)| {
        if kept || taken.insert(name.clone()) {
            return name;
        }
        let number = numbers.entry(name.clone()).or_insert(1);
        loop {
            *number += 1;
            let numbered = format!("{name}_{number}");
            if taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    };
    kept.into_iter().zip(valid).map(unique).collect()
}

/// A phrase that reports that an attribute has another name in the written file.
pub fn renamed(from: &str, to: &str) -> String {
    // Of a name that is as long as a page its beginning tells enough.
    let shown = |name: &str| if name.chars().count() > 80 { format!("{name:.80}...") } else { name.to_owned() };
    format!("the name {:?}: it becomes {}", shown(from), shown(to))
}

/// The name of a type of numbers or words.
pub fn type_name(stored: Stored) -> &'static str {
    match stored {
        Stored::Bool => "bool",
        Stored::I8 => "int8",
        Stored::U8 => "uint8",
        Stored::I16 => "int16",
        Stored::U16 => "uint16",
        Stored::I32 => "int",
        Stored::U32 => "uint",
        Stored::I64 => "int64",
        Stored::U64 => "uint64",
        Stored::F16 => "half",
        Stored::F32 => "float",
        Stored::F64 => "double",
        Stored::Text => "string",
        Stored::Token => "token",
    }
}

fn plural(role: Role) -> &'static str {
    match role {
        Role::Plain => "plain numbers",
        Role::Colour => "colours",
        Role::Point => "points",
        Role::Vector => "vectors",
        Role::Normal => "normals",
        Role::TextureCoordinate => "texture coordinates",
    }
}

impl Polylines {
    /// Reads the attributes of the curves in `file`, at the points of the strands or at their roots. Unknown attributes
    /// are kept under their own names. Those that cannot be kept are listed in `unread`.
    ///
    /// # Errors
    /// If the file is invalid.
    pub fn attributes(&self, file: &mut impl NamedValues) -> Result<Attributes, Problem> {
        let mut search =
            Search { lines: self, file, used: BTreeSet::new(), misindexed: BTreeSet::new(), unread: Vec::new() };
        search.indices()?;
        let one = |values: Vec<[f32; 1]>| values.into_iter().map(|[x]| x).collect::<Vec<f32>>();
        let mut found = Attributes {
            width: search.by_point(names::WIDTH)?.map(one),
            colour: search.by_point(names::COLOR)?,
            point_uv: search.by_point(names::POINT_UV)?,
            inverse_mass: search.by_point(names::FREEDOM)?.map(one),
            transparency: search.by_point(names::TRANSPARENCY)?.map(one),
            id: search.by_strand(names::ID)?,
            ..Attributes::default()
        };
        if let Some(opacity) = search.by_point::<1>(names::OPACITY)? {
            let same = |transparency: &[f32]| transparency.iter().zip(&opacity).all(|(t, [o])| 1.0 - t == *o);
            let transparency = || opacity.iter().map(|[o]| 1.0 - o).collect::<Vec<f32>>();
            // One of which that cannot be made again stays under its own name: 1 - (1 - 0.1) is another number.
            if !same(found.transparency.get_or_insert_with(transparency)) {
                search.used.retain(|name| !names::OPACITY.contains(name));
            }
        }
        found.root_uv = search.root_uv()?;
        found.group = search.by_strand(names::GROUP)?.map(|g| g.into_iter().map(|g| g as i32).collect());
        let guide = search.by_strand(names::GUIDE)?;
        found.guide = guide.map(|g| g.into_iter().map(|g| g != 0).collect());
        search.group_names(&mut found)?;
        found.other = search.others()?;
        search.unread.extend(found.width.as_deref().and_then(odd_widths));
        found.unread = search.unread;
        Ok(found)
    }

    /// Values of any kind at the points of the strands, at their roots, or one for all, by what the file says or by how
    /// many there are; `None` for a number that fits nothing.
    fn placed(&self, name: &str, found: Whatever) -> Option<Other> {
        let (extent, n) = (found.extent.max(1), found.values.len() / found.extent.max(1));
        if found.values.is_empty() || !found.values.len().is_multiple_of(extent) {
            return None;
        }
        let by_number = match n {
            n if n == self.control_points() => Some(Per::Point),
            n if n == self.shape.counts.len() => Some(Per::Strand),
            1 => Some(Per::Groom),
            _ => None,
        };
        let one = found.single.then_some(Per::Groom);
        let per = one.or(found.per).or(by_number)?;
        let (strands, points) = (self.shape.counts.len(), self.control_points());
        let Whatever { role, stored, single, values, .. } = found;
        let mut other = Other { name: name.to_owned(), per, role, extent, stored, single, values };
        if other.values.len() != other.expected(strands, points) {
            return None;
        }
        if per == Per::Point && !self.blends.is_empty() {
            let most = self.control_points() - 1;
            let blends = self.blends.iter();
            let blends = blends.map(|b| std::array::from_fn::<_, 4, _>(|k| ((b.first + k).min(most), b.weights[k])));
            other.values = other.values.blended(extent, blends);
        }
        Some(other)
    }
}

/// What is said of diameters that are none; those of 0 where none is more, as tips may have them.
fn odd_widths(widths: &[f32]) -> Option<String> {
    let odd = widths.iter().filter(|&&w| !(w.is_finite() && w >= 0.0)).count();
    if odd == 0 {
        return (!widths.is_empty() && widths.iter().all(|&w| w == 0.0))
            .then(|| "widths as diameters: all are 0".to_owned());
    }
    Some(format!("{odd} of {} widths as diameters: they are below 0 or not finite", widths.len()))
}

/// The search of one file for what its curves carry.
struct Search<'a, F> {
    lines: &'a Polylines,
    file: &'a mut F,
    used: BTreeSet<&'static str>,
    /// Names whose values cannot be looked up.
    misindexed: BTreeSet<String>,
    unread: Vec<String>,
}

impl<F: NamedValues> Search<'_, F> {
    /// The names of all there are, in order.
    fn sorted_names(&self) -> Result<Vec<String>, Problem> {
        let mut names = self.file.names();
        let letters: usize = names.iter().map(String::len).sum();
        self.file.budget().take(letters as u64, "names of attributes")?;
        names.sort();
        Ok(names)
    }

    /// Sets aside what is stored by index and cannot be looked up.
    fn indices(&mut self) -> Result<(), Problem> {
        for name in self.sorted_names()? {
            if let Some(why) = self.file.misindexed(&name)? {
                self.unread.push(format!("{name}: {why}"));
                self.misindexed.insert(name);
            }
        }
        Ok(())
    }

    /// The names that can be looked up.
    fn readable(&self, names: &[&'static str]) -> Vec<&'static str> {
        names.iter().copied().filter(|name| !self.misindexed.contains(*name)).collect()
    }

    /// Values at the points of the strands, of the first of `names` that has any.
    fn by_point<const N: usize>(&mut self, names: &[&'static str]) -> Result<Option<Vec<[f32; N]>>, Problem> {
        for name in self.readable(names) {
            let Some(values) = self.file.tuples::<N>(name)?.filter(|values| !values.is_empty()) else { continue };
            self.file.budget().take_list::<[f32; N]>(self.lines.strands.points().len(), name)?;
            let found = self.lines.at_points(&values);
            if !self.file.is_wider(name, N) {
                self.used.insert(name);
                if found.is_none() {
                    self.unread.push(self.misfit(name, values.len()));
                }
            }
            return Ok(found);
        }
        Ok(None)
    }

    /// Whole numbers of the strands, of the first of `names` that has any.
    fn by_strand(&mut self, names: &[&'static str]) -> Result<Option<Vec<i64>>, Problem> {
        for name in self.readable(names) {
            if let Some(values) = self.file.integers(name)?.filter(|values| !values.is_empty()) {
                self.used.insert(name);
                self.file.budget().take_list::<i64>(self.lines.shape.counts.len(), name)?;
                return Ok(self.of_strands(name, &values));
            }
        }
        Ok(None)
    }

    fn root_uv(&mut self) -> Result<Option<Vec<[f32; 2]>>, Problem> {
        let mut root_uv = None;
        for name in self.readable(names::ROOT_UV) {
            let Some(values) = self.file.tuples::<2>(name)?.filter(|values| !values.is_empty()) else { continue };
            match &root_uv {
                None => {
                    // What each point has stays under its name: the roots' values are not all of it.
                    let is_all = values.len() != self.lines.control_points() && !self.file.is_wider(name, 2);
                    if is_all {
                        self.used.insert(name);
                    }
                    root_uv = if is_all { self.at_roots(name, &values) } else { self.lines.at_roots(&values) };
                }
                // A copy under another program's name says nothing new.
                Some(uv) if self.lines.at_roots(&values).as_ref() == Some(uv) => {
                    if values.len() == uv.len() && !self.file.is_wider(name, 2) {
                        self.used.insert(name);
                    }
                }
                Some(_) => {}
            }
        }
        Ok(root_uv)
    }

    /// Names of groups; where a file has names only, they are numbered as they come.
    fn group_names(&mut self, found: &mut Attributes) -> Result<(), Problem> {
        for name in self.readable(names::GROUP_NAME) {
            let Some(words) = self.file.words(name)?.filter(|words| !words.is_empty()) else { continue };
            self.used.insert(name);
            // One name may stand for many strands.
            let words: Vec<Rc<str>> = words.into_iter().map(Rc::from).collect();
            self.file.budget().take_list::<Rc<str>>(self.lines.shape.counts.len(), name)?;
            let Some(words) = self.of_strands(name, &words) else { return Ok(()) };
            let groups = found.group.get_or_insert_with(|| {
                let mut numbers = BTreeMap::new();
                let number = |word: &Rc<str>| {
                    let next = numbers.len() as i32;
                    *numbers.entry(word.clone()).or_insert(next)
                };
                words.iter().map(number).collect()
            });
            let named = groups.iter().copied().zip(words).filter(|(_, name)| !name.is_empty());
            let named: BTreeMap<i32, Rc<str>> = named.collect();
            let letters: usize = named.values().map(|name| name.len()).sum();
            self.file.budget().take(letters as u64, "names of groups")?;
            found.group_names = named.into_iter().map(|(number, name)| (number, name.to_string())).collect();
            return Ok(());
        }
        Ok(())
    }

    /// All that has no place of its own.
    fn others(&mut self) -> Result<Vec<Other>, Problem> {
        let mut others = Vec::new();
        // What was looked for under a name has said so already.
        let said: BTreeSet<String> = self.unread.iter().cloned().collect();
        for name in self.sorted_names()? {
            if self.misindexed.contains(&name) {
                continue;
            }
            if self.used.contains(&*name) && names::WRITTEN.contains(&&*name) {
                continue;
            }
            match self.file.whatever(&name)? {
                Some(found) if found.values.is_empty() => {}
                Some(found) => {
                    let count = found.values.len() / found.extent.max(1);
                    match self.lines.placed(&name, found) {
                        Some(other) => others.push(other),
                        None => {
                            let line = self.misfit(&name, count);
                            if !said.contains(&line) {
                                self.unread.push(line);
                            }
                        }
                    }
                }
                None => self.unread.push(format!("{name}, whose type nabiki does not read")),
            }
        }
        others.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(others)
    }

    /// One value for each strand. Where points have values unlike that of their root, that is said, unless they all stay under
    /// this name.
    fn of_strands<T: Clone + PartialEq>(&mut self, name: &str, values: &[T]) -> Option<Vec<T>> {
        let changing = self.lines.changing(values);
        if changing > 0 && names::WRITTEN.contains(&name) {
            let curves = self.lines.shape.counts.len();
            let line =
                format!("{name} from point to point: it changes along {changing} of {curves} curves, but a strand");
            self.unread.push(line + " keeps only the value at its root");
        }
        self.at_roots(name, values)
    }

    fn at_roots<T: Clone>(&mut self, name: &str, values: &[T]) -> Option<Vec<T>> {
        let found = self.lines.at_roots(values);
        if found.is_none() {
            self.unread.push(self.misfit(name, values.len()));
        }
        found
    }

    fn misfit(&self, name: &str, values: usize) -> String {
        let (points, curves) = (self.lines.control_points(), self.lines.shape.counts.len());
        format!("{name}: {values} values for {points} points of {curves} curves")
    }
}
