//! Attributes that the motion does not use and passes on unchanged.

/// An attribute with the name and values of its source. Transforming the hair neither scales nor turns the values.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Name in its source.
    pub name: String,
    /// What each value belongs to.
    pub per: Per,
    /// The meaning of its numbers.
    pub role: Role,
    /// Number of numbers or words in a value.
    pub extent: usize,
    /// How its source stores a number or word. This may be narrower than `values`.
    pub stored: Stored,
    /// Whether it is a single value of the groom, as opposed to a list with one entry.
    pub single: bool,
    /// The values, one after another.
    pub values: Values,
}

/// How a source stores a number or word of an [`Other`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// True (1) or false (0).
    Bool,
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 64 bits. Numbers from 2^63 on are held as the negative numbers with the same bits.
    U64,
    /// Half precision.
    F16,
    /// Single precision.
    F32,
    /// Double precision.
    F64,
    /// Any text.
    Text,
    /// A word of a fixed vocabulary.
    Token,
}

impl Stored {
    /// How to store all of `values`: whole numbers in 32 bits if they fit.
    pub fn of(values: &Values) -> Self {
        match values {
            Values::Floats(_) => Self::F32,
            Values::Doubles(_) => Self::F64,
            Values::Integers(v) if v.iter().all(|&x| i32::try_from(x).is_ok()) => Self::I32,
            Values::Integers(_) => Self::I64,
            Values::Words(_) => Self::Text,
        }
    }
}

/// What a value belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// The entire groom.
    Groom,
    /// Each strand.
    Strand,
    /// Each point.
    Point,
}

/// The meaning of a value's numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Plain numbers.
    #[default]
    Plain,
    /// A colour.
    Colour,
    /// A position.
    Point,
    /// A direction with a length.
    Vector,
    /// A direction normal to a surface.
    Normal,
    /// Texture coordinates.
    TextureCoordinate,
}

/// Values of one kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Single precision.
    Floats(Vec<f32>),
    /// Double precision.
    Doubles(Vec<f64>),
    /// Whole numbers.
    Integers(Vec<i64>),
    /// Words.
    Words(Vec<String>),
}

impl Values {
    /// Total number of numbers or words.
    pub fn len(&self) -> usize {
        match self {
            Self::Floats(v) => v.len(),
            Self::Doubles(v) => v.len(),
            Self::Integers(v) => v.len(),
            Self::Words(v) => v.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values (of `extent` parts each) with these `indices`.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn pick(&self, extent: usize, indices: &[usize]) -> Self {
        fn of<T: Clone>(values: &[T], extent: usize, indices: &[usize]) -> Vec<T> {
            indices.iter().flat_map(|&i| values[extent * i..extent * (i + 1)].iter().cloned()).collect()
        }
        match self {
            Self::Floats(v) => Self::Floats(of(v, extent, indices)),
            Self::Doubles(v) => Self::Doubles(of(v, extent, indices)),
            Self::Integers(v) => Self::Integers(of(v, extent, indices)),
            Self::Words(v) => Self::Words(of(v, extent, indices)),
        }
    }

    /// Values blended from these, each of `extent` parts. For each result, `blends` gives indices and weights that add
    /// up to 1. Whole numbers and words are taken from the largest weight.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn blended<const N: usize>(&self, extent: usize, blends: impl Iterator<Item = [(usize, f64); N]>) -> Self {
        let sum = |at: &dyn Fn(usize) -> f64, blend: &[(usize, f64); N], part: usize| {
            let heavy = blend.iter().filter(|(_, w)| *w != 0.0);
            heavy.map(|&(i, w)| w * at(extent * i + part)).sum::<f64>()
        };
        match self {
            Self::Floats(v) => Self::Floats(
                blends.flat_map(|b| (0..extent).map(move |part| sum(&|i| f64::from(v[i]), &b, part) as f32)).collect(),
            ),
            Self::Doubles(v) => {
                Self::Doubles(blends.flat_map(|b| (0..extent).map(move |part| sum(&|i| v[i], &b, part))).collect())
            }
            Self::Integers(_) | Self::Words(_) => {
                let heaviest = |b: [(usize, f64); N]| b.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |b| b.0);
                self.pick(extent, &blends.map(heaviest).collect::<Vec<_>>())
            }
        }
    }
}

impl Other {
    /// An attribute stored as its values are: whole numbers in 32 bits if they fit.
    pub fn new(name: impl Into<String>, per: Per, role: Role, extent: usize, values: Values) -> Self {
        Self { name: name.into(), per, role, extent, stored: Stored::of(&values), single: false, values }
    }

    /// The number of numbers or words that it must have for this many strands and points.
    pub fn expected(&self, strands: usize, points: usize) -> usize {
        match self.per {
            // A groom may have a list of values.
            Per::Groom => self.values.len().next_multiple_of(self.extent.max(1)),
            Per::Strand => self.extent * strands,
            Per::Point => self.extent * points,
        }
    }

    /// Appends the values of further strands. Returns `false` if the two attributes do not match.
    pub fn append(&mut self, further: Self) -> bool {
        if self.per == Per::Groom {
            return *self == further;
        }
        match (&mut self.values, further.values) {
            (Values::Floats(a), Values::Floats(b)) => a.extend(b),
            (Values::Doubles(a), Values::Doubles(b)) => a.extend(b),
            (Values::Integers(a), Values::Integers(b)) => a.extend(b),
            (Values::Words(a), Values::Words(b)) => a.extend(b),
            _ => return false,
        }
        if self.stored != further.stored {
            self.stored = Stored::of(&self.values);
        }
        true
    }

    /// That of the given strands and points, in that order.
    pub(super) fn gather(&self, strands: &[usize], points: &[usize]) -> Self {
        let values = match self.per {
            Per::Groom => self.values.clone(),
            Per::Strand => self.values.pick(self.extent, strands),
            Per::Point => self.values.pick(self.extent, points),
        };
        Self { values, ..self.clone_without_values() }
    }

    /// That of points blended from existing ones, two each with their weights.
    pub(super) fn resampled(&self, blends: impl Iterator<Item = [(usize, f64); 2]>) -> Self {
        match self.per {
            Per::Point => Self { values: self.values.blended(self.extent, blends), ..self.clone_without_values() },
            _ => self.clone(),
        }
    }

    fn clone_without_values(&self) -> Self {
        let Self { per, role, extent, stored, single, .. } = *self;
        Self { name: self.name.clone(), per, role, extent, stored, single, values: Values::Integers(Vec::new()) }
    }
}
