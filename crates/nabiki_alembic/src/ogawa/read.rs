//! Reading of groups and data, with nothing believed that the file's size contradicts.

use std::io::{Read, Seek, SeekFrom};
use std::rc::Rc;

use nabiki_exchange::Budget;

use super::{DATA, HEADER};
use crate::Problem;

/// An archive to read from.
pub struct Reader<R> {
    from: R,
    size: u64,
    /// What reading the archive may take.
    pub budget: Rc<Budget>,
}

/// Places of a group's children.
pub type Group = Vec<u64>;

/// Whether a child is data.
pub fn is_data(child: u64) -> bool {
    child & DATA != 0
}

impl<R: Read + Seek> Reader<R> {
    /// Opens an archive and gives its root group.
    pub fn new(mut from: R) -> Result<(Self, Group), Problem> {
        let size = from.seek(SeekFrom::End(0))?;
        from.seek(SeekFrom::Start(0))?;
        let mut head = [0; 16];
        from.read_exact(&mut head).map_err(|_| Problem::new("is shorter than an Alembic archive's header"))?;
        if head.starts_with(b"\x89HDF") {
            return Err(Problem::new(
                "is an Alembic archive in the old HDF5 form: export it again as Ogawa (any tool since 2013)",
            ));
        }
        let [version_high, version_low] = [head[6], head[7]];
        if head[..5] != HEADER[..5] || [version_high, version_low] != HEADER[6..] {
            return Err(Problem::new("is not an Alembic archive in Ogawa form"));
        }
        if head[5] != 0xff {
            return Err(Problem::new("was never finished by the program that wrote it"));
        }
        let mut reader = Self { from, size, budget: Rc::new(Budget::of(size)) };
        let root = reader.group(number(&head[8..]))?;
        Ok((reader, root))
    }

    /// The children of the group at `child`.
    pub fn group(&mut self, child: u64) -> Result<Group, Problem> {
        if is_data(child) {
            return Err(Problem::new("has data where a group should be"));
        }
        if child == 0 {
            return Ok(Group::new());
        }
        let count = self.count(child, 8)?;
        self.budget.take(8 * count as u64, "objects and properties")?;
        let mut bytes = vec![0; 8 * count];
        self.from.read_exact(&mut bytes)?;
        Ok(bytes.chunks_exact(8).map(number).collect())
    }

    /// Child number `index` of the group at `child`, without reading the others; `None` past them.
    pub fn child_of(&mut self, child: u64, index: usize) -> Result<Option<u64>, Problem> {
        if is_data(child) {
            return Err(Problem::new("has data where a group should be"));
        }
        if child == 0 || index >= self.count(child, 8)? {
            return Ok(None);
        }
        self.from.seek_relative(8 * index as i64)?;
        let mut bytes = [0; 8];
        self.from.read_exact(&mut bytes)?;
        Ok(Some(number(&bytes)))
    }

    /// The bytes of the data at `child`.
    pub fn data(&mut self, child: u64) -> Result<Vec<u8>, Problem> {
        self.data_after(child, 0)
    }

    /// The bytes of the data at `child` but for the first `skip`.
    pub fn data_after(&mut self, child: u64, skip: usize) -> Result<Vec<u8>, Problem> {
        let length = self.length(child)?;
        if length < skip {
            return Ok(Vec::new());
        }
        self.from.seek_relative(skip as i64)?;
        self.budget.take((length - skip) as u64, "samples")?;
        let mut bytes = vec![0; length - skip];
        self.from.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// The data at `child` but for the first `skip` bytes, read into numbers where they will stay; a part of one at
    /// the end is left out.
    pub fn plain_after<T: bytemuck::Pod>(&mut self, child: u64, skip: usize) -> Result<Vec<T>, Problem> {
        let length = self.length(child)?.saturating_sub(skip);
        self.budget.take(length as u64, "samples")?;
        let mut values = bytemuck::zeroed_vec(length / size_of::<T>());
        if !values.is_empty() {
            self.from.seek_relative(skip as i64)?;
            self.from.read_exact(bytemuck::cast_slice_mut(&mut values))?;
        }
        Ok(values)
    }

    /// Number of bytes of the data at `child`; reading goes on at the first of them.
    pub fn length(&mut self, child: u64) -> Result<usize, Problem> {
        if !is_data(child) {
            return Err(Problem::new("has a group where data should be"));
        }
        match child & !DATA {
            0 => Ok(0),
            place => self.count(place, 1),
        }
    }

    /// The count at `place`, of things of `each` bytes that follow it and must fit into the file.
    fn count(&mut self, place: u64, each: u64) -> Result<usize, Problem> {
        let start = place.checked_add(8).filter(|&start| start <= self.size);
        let start = start.ok_or_else(|| Problem(format!("points to byte {place}, past its end ({})", self.size)))?;
        self.from.seek(SeekFrom::Start(place))?;
        let mut bytes = [0; 8];
        self.from.read_exact(&mut bytes)?;
        let count = number(&bytes);
        if count > (self.size - start) / each {
            return Err(Problem(format!("claims {count} items of {each} bytes at byte {place}, more than it has")));
        }
        Ok(count as usize)
    }
}

/// Eight bytes as a number.
pub fn number(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes"))
}
