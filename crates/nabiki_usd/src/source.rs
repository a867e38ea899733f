//! What both forms of layers are read into: prims, their properties, and where the values of these stand.

use std::collections::HashMap;
use std::io::{Read, Seek};

/// Where a value is: in text its first byte and length, in binary what names it.
pub type Handle = (u64, u64);

/// A prim of the layer.
#[derive(Clone, Debug, Default)]
pub struct PrimInfo {
    /// Name.
    pub name: String,
    /// Type; empty for an `over` or a prim of no type.
    pub type_name: String,
    /// Whether it is a class or inactive: neither it nor what is below it is on the stage then.
    pub is_off_stage: bool,
    /// Whether it is an `over`, which adds to what another layer defines and defines nothing by itself.
    pub is_over: bool,
    /// The prim above it in the list.
    pub parent: Option<usize>,
    /// Attributes by name.
    pub attributes: HashMap<String, AttributeInfo>,
    /// Names of its relationships: `material:binding`.
    pub relationships: Vec<String>,
    /// Whether what comes to it by arcs is shared with other prims, as `instanceable` asks for.
    pub is_instance: bool,
    /// Arcs by which content from elsewhere comes to it, by the words of text layers: `references`.
    pub arcs: Vec<&'static str>,
}

/// An attribute of a prim.
#[derive(Clone, Debug, Default)]
pub struct AttributeInfo {
    /// Type without the brackets of an array: `color3f`.
    pub type_name: String,
    /// Whether it had these.
    pub is_array: bool,
    /// Value without a time.
    pub default: Option<Handle>,
    /// Whether a spline moves it, which is not read.
    pub has_spline: bool,
    /// Time codes and values, times growing.
    pub samples: Vec<(f64, Handle)>,
    /// What says how many values there are: in text all that stands in parentheses behind the value.
    pub interpolation: Option<Handle>,
}

/// What a layer is read from.
pub trait Source: Read + Seek {}
impl<T: Read + Seek> Source for T {}
