//! Curves that lie in several objects of a file, as one groom.

use std::collections::BTreeMap;

use crate::Hair;
use crate::error::Problem;
use crate::strands::not_finite;

/// Hair from several objects.
#[derive(Default)]
pub struct Gathered {
    all: Option<Hair>,
    /// Parts that were grouped by their object.
    named: usize,
}

impl Gathered {
    /// Appends a part; `group` names it where it has no groups of its own. An attribute stays only if all parts
    /// have it.
    pub fn append(&mut self, mut part: Hair, group: Option<(i32, String)>) {
        if let (Some((number, name)), None) = (group, &part.attributes.group) {
            part.attributes.group = Some(vec![number; part.strands.len()]);
            part.attributes.group_names = BTreeMap::from([(number, name)]);
            self.named += 1;
        }
        let Some(all) = &mut self.all else {
            self.all = Some(part);
            return;
        };
        for strand in part.strands.iter() {
            all.strands.push(strand.iter().copied());
        }
        fn join<T>(a: &mut Option<Vec<T>>, b: Option<Vec<T>>) {
            match (a.as_mut(), b) {
                (Some(a), Some(b)) => a.extend(b),
                _ => *a = None,
            }
        }
        let (a, b) = (&mut all.attributes, part.attributes);
        join(&mut a.id, b.id);
        join(&mut a.root_uv, b.root_uv);
        join(&mut a.group, b.group);
        join(&mut a.guide, b.guide);
        join(&mut a.width, b.width);
        join(&mut a.color, b.color);
        join(&mut a.transparency, b.transparency);
        join(&mut a.point_uv, b.point_uv);
        join(&mut a.freedom, b.freedom);
        a.group_names.extend(b.group_names);
    }

    /// The whole. Objects of one strand each, as some tools write them, are no groups.
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn hair(self) -> Result<Hair, Problem> {
        let mut hair = self.all.unwrap_or_default();
        if self.named >= hair.strands.len() {
            hair.attributes.group = None;
            hair.attributes.group_names.clear();
        }
        match not_finite(hair.strands.points()) {
            Some(i) => Err(Problem(format!("point {i} of its curves is not finite"))),
            None => Ok(hair),
        }
    }
}
