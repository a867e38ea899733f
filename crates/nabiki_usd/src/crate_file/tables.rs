//! The tables of binary layers: names, numbers of fields, the tree of paths.

use std::rc::Rc;

use nabiki_exchange::Budget;

use super::integers::{unpack, unpack_integers_as};
use crate::Problem;
use crate::source::Name;

/// What a path names, before prims and attributes are told apart.
pub struct Node {
    /// Number by which specs know it.
    pub path: u32,
    /// The one above it in the list.
    pub parent: Option<u32>,
    /// Its name.
    pub token: u32,
    /// How many are above it.
    pub depth: u32,
    /// Whether it is a property.
    pub is_property: bool,
}

/// A table's bytes.
pub struct Table {
    pub bytes: Vec<u8>,
    /// What is read next.
    pub at: usize,
    /// Entries beyond which a count is a lie.
    pub most: u64,
    /// What it is called.
    pub name: &'static str,
    /// What reading the layer may take.
    pub budget: Rc<Budget>,
}

impl Table {
    /// The next bytes.
    pub fn take(&mut self, length: usize) -> Result<&[u8], Problem> {
        let end = self.at.checked_add(length).filter(|&end| end <= self.bytes.len());
        let end = end.ok_or_else(|| Problem::new("has a table that ends too early"))?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    /// The next number.
    pub fn number(&mut self) -> Result<u64, Problem> {
        Ok(number(self.take(8)?))
    }

    /// The next number, of entries.
    pub fn count(&mut self) -> Result<usize, Problem> {
        let count = self.number()?;
        if count > self.most {
            return Err(Problem(format!("has a table of {count} entries, more than it can hold")));
        }
        Ok(count as usize)
    }

    /// The next integers, which are packed.
    pub fn integers(&mut self, count: usize) -> Result<Vec<i32>, Problem> {
        let length = self.number()?;
        self.budget.take_list::<i32>(count, self.name)?;
        let packed = self.take(usize::try_from(length).unwrap_or(usize::MAX))?;
        unpack_integers_as::<4, i32>(packed, count, |x| x as i32).map_err(Problem)
    }

    /// The next bytes, which are packed.
    pub fn packed(&mut self, size: usize) -> Result<Vec<u8>, Problem> {
        let length = self.number()?;
        self.budget.take(size as u64, self.name)?;
        unpack(self.take(usize::try_from(length).unwrap_or(usize::MAX))?, size).map_err(Problem)
    }
}

/// The names.
pub fn tokens(table: &mut Table) -> Result<Vec<Name>, Problem> {
    let count = table.count()?;
    let size = table.number()?;
    let words = table.packed(usize::try_from(size).unwrap_or(usize::MAX))?;
    // Each is in memory by itself.
    let each = (size_of::<Name>() + 32) * count.min(words.len());
    table.budget.keep((words.len() + each) as u64, table.name)?;
    let tokens: Vec<Name> =
        words.split(|&b| b == 0).take(count).map(|w| Name::from(&*String::from_utf8_lossy(w))).collect();
    if tokens.len() < count {
        return Err(Problem(format!("has {} words but claims {count}", tokens.len())));
    }
    Ok(tokens)
}

/// The paths, parents before what hangs below them.
pub fn paths(table: &mut Table) -> Result<Vec<Node>, Problem> {
    let damaged = || Problem::new("has a table of paths that contradicts itself");
    table.count()?;
    let count = table.count()?;
    let (indices, tokens, jumps) = (table.integers(count)?, table.integers(count)?, table.integers(count)?);
    table.budget.take_list::<Node>(count, table.name)?;
    let mut nodes: Vec<Node> = Vec::new();
    // Entries to visit, each with the node above it and how deep it lies.
    let mut todo = if count == 0 { Vec::new() } else { vec![(0, None, 0)] };
    while let Some((entry, parent, depth)) = todo.pop() {
        if nodes.len() == count || entry >= count {
            return Err(damaged());
        }
        let (token, jump) = (tokens[entry], jumps[entry]);
        let is_property = token < 0;
        let token = token.unsigned_abs();
        nodes.push(Node { path: indices[entry] as u32, parent, token, depth, is_property });
        if jump >= 0 {
            let sibling = if jump == 0 { entry + 1 } else { entry + jump as usize };
            todo.push((sibling, parent, depth));
        }
        if jump > 0 || jump == -1 {
            todo.push((entry + 1, Some(nodes.len() as u32 - 1), depth + 1));
        }
    }
    Ok(nodes)
}

/// The number of eight bytes.
pub fn number(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes"))
}
