//! Writing of groups and data, each once, children before the groups that hold them.

use std::io::{self, Seek, SeekFrom, Write};

use super::{DATA, HEADER};

/// A child as its group lists it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(u64);

/// Data of no bytes.
pub const EMPTY_DATA: Child = Child(DATA);
/// A group of no children.
pub const EMPTY_GROUP: Child = Child(0);

/// An archive that grows.
pub struct Writer<W> {
    to: W,
    at: u64,
}

impl<W: Write + Seek> Writer<W> {
    /// Begins an archive, marked as unfinished until [`finish`](Self::finish).
    pub fn new(mut to: W) -> io::Result<Self> {
        let mut header = HEADER;
        header[5] = 0;
        to.write_all(&header)?;
        to.write_all(&0u64.to_le_bytes())?;
        Ok(Self { to, at: 16 })
    }

    /// Writes the parts as one piece of data.
    pub fn data(&mut self, parts: &[&[u8]]) -> io::Result<Child> {
        let length: usize = parts.iter().map(|p| p.len()).sum();
        if length == 0 {
            return Ok(EMPTY_DATA);
        }
        let child = Child(self.at | DATA);
        self.put(&(length as u64).to_le_bytes())?;
        for part in parts {
            self.put(part)?;
        }
        Ok(child)
    }

    /// Writes a group of `children`.
    pub fn group(&mut self, children: &[Child]) -> io::Result<Child> {
        if children.is_empty() {
            return Ok(EMPTY_GROUP);
        }
        let child = Child(self.at);
        self.put(&(children.len() as u64).to_le_bytes())?;
        for Child(place) in children {
            self.put(&place.to_le_bytes())?;
        }
        Ok(child)
    }

    /// Names the root and marks the archive as whole.
    pub fn finish(mut self, Child(root): Child) -> io::Result<W> {
        self.to.seek(SeekFrom::Start(0))?;
        self.to.write_all(&HEADER)?;
        self.to.write_all(&root.to_le_bytes())?;
        self.to.flush()?;
        Ok(self.to)
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.at += bytes.len() as u64;
        self.to.write_all(bytes)
    }
}
