//! What both forms of layers are read into: prims, their properties, and where the values of these stand.

use std::borrow::Borrow;
use std::collections::HashMap;
use std::fmt;
use std::io::{Read, Seek};
use std::ops::Deref;
use std::rc::Rc;

use nabiki_exchange::Budget;

use crate::Problem;

/// Prims below prims; a layer that claims more was made to harm.
pub const DEEPEST: usize = 512;
/// Bytes of the name of a prim or property that is read: names are compared again and again.
const LONGEST_NAME: usize = 1024;

/// A name or type. Thousands of prims may have the same one, which is in memory once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Name(Rc<str>);

impl Name {
    /// Its letters.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Refuses what is too long for a name.
    ///
    /// # Errors
    /// One line with its beginning.
    pub fn check(&self) -> Result<(), Problem> {
        match self.len() {
            0..=LONGEST_NAME => Ok(()),
            length => Err(Problem(format!(
                "has the name \"{:.40}...\" of {length} bytes: names of at most {LONGEST_NAME} are read; rename it",
                self.as_str()
            ))),
        }
    }
}

impl Deref for Name {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl Borrow<str> for Name {
    fn borrow(&self) -> &str {
        &self.0
    }
}

impl PartialEq<str> for Name {
    fn eq(&self, other: &str) -> bool {
        self.as_str() == other
    }
}

impl PartialEq<&str> for Name {
    fn eq(&self, other: &&str) -> bool {
        self.as_str() == *other
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

impl From<&str> for Name {
    fn from(letters: &str) -> Self {
        Self(letters.into())
    }
}

impl From<String> for Name {
    fn from(letters: String) -> Self {
        Self(letters.into())
    }
}

/// Where a value is: in text its first byte and length, in binary what names it.
pub type Handle = (u64, u64);

/// A value that is blocked: there is none, whatever weaker layers and the attribute's own default say.
pub const BLOCKED: Handle = (0, 0);

/// The schema by which a prim says how it is bound to a skeleton.
pub const SKEL_BINDING: &str = "SkelBindingAPI";

/// The arcs of prims, each by the word of text layers and by that of binary ones. Of value clips samples come.
pub const ARCS: [(&str, &str); 6] = [
    ("references", "references"),
    ("payload", "payload"),
    ("inherits", "inheritPaths"),
    ("specializes", "specializes"),
    ("variantSets", "variantSetNames"),
    ("clips", "clips"),
];

/// A prim of the layer.
#[derive(Clone, Debug, Default)]
pub struct PrimInfo {
    /// Name.
    pub name: Name,
    /// Type; empty for an `over` or a prim of no type.
    pub type_name: Name,
    /// Whether it is a class or inactive: neither it nor what is below it is on the stage then.
    pub is_off_stage: bool,
    /// Whether it is an `over`, which adds to what another layer defines and defines nothing by itself.
    pub is_over: bool,
    /// The prim above it in the list.
    pub parent: Option<usize>,
    /// Attributes by name, those that are declared and have no value among them.
    pub attributes: HashMap<Name, Box<AttributeInfo>>,
    /// Its relationships by name, `material:binding`: where their targets stand, [`BLOCKED`] where they have none.
    pub relationships: Vec<(Name, Handle)>,
    /// Whether it says how it is bound to a skeleton: `SkelBindingAPI` is applied to it.
    pub is_bound: bool,
    /// Whether what comes to it by arcs is shared with other prims, as `instanceable` asks for.
    pub is_instance: bool,
    /// Arcs by which content from elsewhere comes to it, by the words of text layers: `references`.
    pub arcs: Vec<&'static str>,
}

impl PrimInfo {
    /// Whether it has transforms in USD: what is defined without a type, or as a scope, has none, whatever it says. What an `over` adds to
    /// is not known here.
    pub fn is_transformable(&self) -> bool {
        self.is_over || !matches!(self.type_name.as_str(), "" | "Scope")
    }

    /// The names of its relationships that have targets.
    pub fn related(&self) -> impl Iterator<Item = &Name> {
        self.relationships.iter().filter(|&&(_, targets)| targets != BLOCKED).map(|(name, _)| name)
    }

    /// Its attributes that have a value at some time: one that is blocked is as if it were not there.
    pub fn authored(&self) -> impl Iterator<Item = (&Name, &AttributeInfo)> {
        self.attributes
            .iter()
            .filter(|(_, attribute)| attribute.is_authored())
            .map(|(name, attribute)| (name, &**attribute))
    }
}

/// Counts a prim that stays: what it takes with its name, but for its attributes.
///
/// # Errors
/// A name that is too long; more prims than the file may take.
pub fn keep_prim(budget: &Budget, name: &Name) -> Result<(), Problem> {
    name.check()?;
    budget.keep((size_of::<PrimInfo>() + 16 + name.len()) as u64, "prims")
}

/// Counts an attribute or relationship that stays.
///
/// # Errors
/// A name that is too long; more of them than the file may take.
pub fn keep_property(budget: &Budget, name: &Name) -> Result<(), Problem> {
    name.check()?;
    budget.keep((size_of::<AttributeInfo>() / 2 + 24) as u64, "properties")
}

/// An attribute of a prim.
#[derive(Clone, Debug, Default)]
pub struct AttributeInfo {
    /// Type without the brackets of an array: `color3f`.
    pub type_name: Name,
    /// Whether it had these.
    pub is_array: bool,
    /// Value without a time; [`BLOCKED`] where it says that there is none.
    pub default: Option<Handle>,
    /// Whether a spline moves it, which is not read.
    pub has_spline: bool,
    /// Time codes and values, times growing; [`BLOCKED`] where there is none from then on.
    pub samples: Vec<(f64, Handle)>,
    /// What says how many values there are: in text all that stands in parentheses behind the value.
    pub interpolation: Option<Handle>,
}

impl AttributeInfo {
    /// Whether it has a value at some time.
    pub fn is_authored(&self) -> bool {
        let by_default = self.samples.is_empty() && self.default.is_some_and(|value| value != BLOCKED);
        by_default || self.has_spline || self.samples.iter().any(|&(_, value)| value != BLOCKED)
    }
}

/// What a layer is read from.
pub trait Source: Read + Seek {}
impl<T: Read + Seek> Source for T {}
