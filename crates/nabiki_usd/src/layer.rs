//! What a layer says, apart from how it is written: prims, their attributes, and values.

use std::borrow::Cow;

use half::f16;

/// A value of an attribute or of the layer.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `token`
    Token(String),
    /// `token[]`
    Tokens(Vec<String>),
    /// `string[]`
    Texts(Vec<String>),
    /// `double`
    Double(f64),
    /// `int[]`
    Ints(Vec<i32>),
    /// `int64[]`
    Longs(Vec<i64>),
    /// `float[]`
    Floats(Vec<f32>),
    /// `float2[]`, `texCoord2f[]`
    Pairs(Vec<[f32; 2]>),
    /// `float3[]`, `point3f[]`, `color3f[]`
    Triples(Vec<[f32; 3]>),
    /// Values of so many whole numbers each: `int2[]`
    IntTuples(usize, Vec<i32>),
    /// Values of so many singles each: `float4[]`
    FloatTuples(usize, Vec<f32>),
    /// Values of so many doubles each: `double[]`, `double3[]`; of 9 or 16 matrices
    DoubleTuples(usize, Vec<f64>),
    /// Values of so many halves each: `half[]`, `color3h[]`
    HalfTuples(usize, Vec<f16>),
    /// `bool[]`, 1 for true
    Bools(Vec<u8>),
    /// `uchar[]`
    Bytes(Vec<u8>),
    /// `uint[]`
    Unsigned(Vec<u32>),
    /// `uint64[]`
    UnsignedLongs(Vec<u64>),
    /// The one value of a list, without the list: `float`
    One(Box<Value>),
    /// `matrix4d`, row by row as USD multiplies rows from the left
    Matrix([f64; 16]),
    /// No value, whatever weaker layers say
    Blocked,
    /// Of a relationship: no target, whatever weaker layers say
    NoTargets,
}

/// A property of a prim.
#[derive(Clone, Debug)]
pub struct Attribute<S> {
    /// Name with its namespace: `primvars:st`.
    pub name: Cow<'static, str>,
    /// Type as text has it: `texCoord2f[]`.
    pub type_name: &'static str,
    /// Whether it can never vary over time.
    pub uniform: bool,
    /// Value without a time.
    pub value: Option<Value>,
    /// Values at the layer's time codes, in the writer's own form.
    pub samples: Vec<S>,
    /// How many values there are: constant, uniform (by curve) or vertex (by point).
    pub interpolation: Option<&'static str>,
}

impl<S> Attribute<S> {
    /// An attribute with one value.
    pub fn new(name: impl Into<Cow<'static, str>>, type_name: &'static str, value: Value) -> Self {
        Self {
            name: name.into(),
            type_name,
            uniform: false,
            value: Some(value),
            samples: Vec::new(),
            interpolation: None,
        }
    }

    /// The same, never varying.
    pub fn uniform(name: impl Into<Cow<'static, str>>, type_name: &'static str, value: Value) -> Self {
        Self { uniform: true, ..Self::new(name, type_name, value) }
    }

    /// The same with an interpolation.
    pub fn primvar(
        name: impl Into<Cow<'static, str>>,
        type_name: &'static str,
        interpolation: &'static str,
        value: Value,
    ) -> Self {
        Self { interpolation: Some(interpolation), ..Self::new(name, type_name, value) }
    }

    /// A relationship that leads nowhere.
    pub fn no_targets(name: &'static str) -> Self {
        Self::new(name, "rel", Value::NoTargets)
    }

    /// An attribute with samples only.
    pub fn sampled(name: impl Into<Cow<'static, str>>, type_name: &'static str, samples: Vec<S>) -> Self {
        Self { name: name.into(), type_name, uniform: false, value: None, samples, interpolation: None }
    }
}

/// The property that holds a primvar.
pub fn primvar(name: &str) -> String {
    format!("primvars:{name}")
}

/// A prim.
#[derive(Clone, Debug)]
pub struct Prim<S> {
    /// Name.
    pub name: String,
    /// Type, `BasisCurves`; empty for an `over`, which adds to a prim of another layer.
    pub type_name: &'static str,
    /// Schemas that are applied to it beside those that weaker layers apply.
    pub schemas: &'static [&'static str],
    /// Attributes.
    pub attributes: Vec<Attribute<S>>,
    /// Prims below it.
    pub children: Vec<Prim<S>>,
}

/// What a layer says about itself.
#[derive(Clone, Debug)]
pub struct Metadata {
    /// First prim, which a reference to the layer means.
    pub default_prim: String,
    /// Whether z rather than y is up.
    pub z_up: bool,
    /// Length of the unit (m).
    pub meters_per_unit: f64,
    /// Time code of the first frame; one code is one frame.
    pub start: f64,
    /// Time code of the last.
    pub end: f64,
    /// Frames a second.
    pub frame_rate: f64,
}
