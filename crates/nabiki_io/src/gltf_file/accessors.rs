//! The numbers of glTF accessors, sparse ones too. They are read here rather than by the crate gltf, whose iterators trust the
//! file's offsets and counts.

use glam::DAffine3;
use gltf::accessor::{Accessor, DataType, Dimensions};

use super::Buffers;
use crate::error::{Error, Result};

/// What whole numbers stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Whole {
    /// Themselves, but for those that the accessor calls normalized.
    AsSaid,
    /// Shares of the largest number of their type.
    Shares,
}

/// Items of `N` numbers each, whole ones or singles; `what` they are.
pub(crate) fn numbers<const N: usize>(
    accessor: &Accessor,
    buffers: &Buffers<'_>,
    whole: Whole,
    what: &str,
) -> Result<Vec<[f32; N]>> {
    let (kind, shape) = (accessor.data_type(), accessor.dimensions());
    if shape.multiplicity() != N {
        return Err(Error::new(format!(
            "accessor {}: {what} of type {kind:?} {shape:?} are not read",
            accessor.index()
        )));
    }
    let shares = whole == Whole::Shares || accessor.normalized();
    let number = |b: &[u8]| -> f32 {
        let (value, largest) = match kind {
            DataType::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            DataType::U8 => (f32::from(b[0]), 255.0),
            DataType::I8 => (f32::from(b[0] as i8), 127.0),
            DataType::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            DataType::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            DataType::U32 => (u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32, u32::MAX as f32),
        };
        // The least of a signed type has no opposite, and stands for -1 as the next one does (glTF 2.0, section 3.11).
        if shares { (value / largest).max(-1.0) } else { value }
    };
    items(accessor, buffers, number)
}

/// Items of `N` whole numbers from 0 on, which are `what`.
pub(crate) fn whole_numbers<const N: usize>(
    accessor: &Accessor,
    buffers: &Buffers<'_>,
    what: &str,
) -> Result<Vec<[u32; N]>> {
    let (kind, shape) = (accessor.data_type(), accessor.dimensions());
    if shape.multiplicity() != N || !matches!(kind, DataType::U8 | DataType::U16 | DataType::U32) {
        return Err(Error::new(format!(
            "accessor {}: {what} of type {kind:?} {shape:?} are not read",
            accessor.index()
        )));
    }
    items(accessor, buffers, whole_number)
}

/// The transforms of an accessor of matrices.
pub(crate) fn transforms(accessor: &Accessor, buffers: &Buffers<'_>, what: &str) -> Result<Vec<DAffine3>> {
    if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Mat4) {
        let (kind, shape) = (accessor.data_type(), accessor.dimensions());
        return Err(Error::new(format!(
            "accessor {}: {what} of type {kind:?} {shape:?} are not read",
            accessor.index()
        )));
    }
    let matrices = numbers::<16>(accessor, buffers, Whole::AsSaid, what)?;
    Ok(matrices
        .iter()
        .map(|m| super::pose::transform(std::array::from_fn(|c| std::array::from_fn(|r| m[4 * c + r]))))
        .collect())
}

fn whole_number(little_endian: &[u8]) -> u32 {
    little_endian.iter().rev().fold(0, |n, &byte| n << 8 | u32::from(byte))
}

/// The items of an accessor, each of `N` components, all within their buffer.
fn items<T: Copy + Default, const N: usize>(
    accessor: &Accessor,
    buffers: &Buffers<'_>,
    component: impl Fn(&[u8]) -> T,
) -> Result<Vec<[T; N]>> {
    let width = accessor.data_type().size();
    let (count, index) = (accessor.count(), accessor.index());
    let take = |count: usize| buffers.budget.take_list::<[T; N]>(count, "accessors").map_err(Error::from);
    let item = |bytes: &[u8]| std::array::from_fn(|i| component(&bytes[i * width..(i + 1) * width]));
    let mut items: Vec<[T; N]> = match accessor.view() {
        Some(view) => {
            let part = Part { index, offset: accessor.offset(), count, size: N * width };
            let bytes = part.within(&view, buffers)?;
            take(count)?;
            bytes.map(item).collect()
        }
        // Noughts, but for those that are given one by one.
        None => {
            // Of these nothing lies in the file.
            take(count)?;
            vec![[T::default(); N]; count]
        }
    };
    let Some(sparse) = accessor.sparse() else { return Ok(items) };
    let (indices, values) = (sparse.indices(), sparse.values());
    let of_indices = Part { index, offset: indices.offset(), count: sparse.count(), size: indices.index_type().size() };
    let of_values = Part { index, offset: values.offset(), count: sparse.count(), size: N * width };
    let numbers = of_indices.within(&indices.view(), buffers)?.map(whole_number);
    for (at, value) in numbers.zip(of_values.within(&values.view(), buffers)?) {
        let room = items
            .get_mut(at as usize)
            .ok_or_else(|| Error::new(format!("accessor {index}: its sparse item {at} is past its {count} items")))?;
        *room = item(value);
    }
    Ok(items)
}

/// Items that lie in a view of a buffer.
struct Part {
    /// Of the accessor.
    index: usize,
    /// Of the first (bytes from the view's beginning).
    offset: usize,
    count: usize,
    /// Bytes of each.
    size: usize,
}

impl Part {
    fn within<'b>(
        &self,
        view: &gltf::buffer::View,
        buffers: &'b Buffers<'_>,
    ) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>> {
        let &Self { index, offset, count, size } = self;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(Error::new(format!("accessor {index}: stride {stride} is less than its items' {size} bytes")));
        }
        let slice = || {
            let bytes = buffers.get(view.buffer().index())?;
            let view_bytes = bytes.get(view.offset()..view.offset().checked_add(view.length())?)?;
            let length = count.checked_sub(1)?.checked_mul(stride)?.checked_add(size)?;
            view_bytes.get(offset..offset.checked_add(length)?)
        };
        let slice =
            slice().ok_or_else(|| Error::new(format!("accessor {index}: {count} items reach past their buffer")))?;
        Ok(slice.chunks(stride).map(move |chunk| &chunk[..size]))
    }
}
