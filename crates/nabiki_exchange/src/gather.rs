//! Curves that lie in several objects of a file, as one groom.

use std::collections::BTreeMap;

use glam::Affine3A;
use nabiki::Hair;
use nabiki::hair::Other;

use crate::Problem;
use crate::in_place::{InPlace, check_extent};

/// Hair from several objects.
#[derive(Default)]
pub struct Gathered {
    all: Option<InPlace>,
    /// Parts that were grouped by their object.
    named: usize,
}

impl Gathered {
    /// Appends a part that lies below the transform `world_from_part`; `group` names it where it has no groups of its
    /// own. An attribute stays only if all parts that have curves have it, and is otherwise named among what is unread.
    ///
    /// # Errors
    /// More points in all than strands can count.
    pub fn append(
        &mut self,
        mut part: Hair,
        world_from_part: Affine3A,
        group: Option<(i32, String)>,
    ) -> Result<(), Problem> {
        if part.strands.is_empty() {
            return Ok(());
        }
        let so_far = self.all.as_ref().map_or(0, |all| all.hair.strands.points().len());
        if u32::try_from(so_far + part.strands.points().len()).is_err() {
            return Err(Problem::new("has curves of more than 2^32 points in all: ask for fewer segments"));
        }
        if let (Some((number, name)), None) = (group, &part.attributes.group) {
            part.attributes.group = Some(vec![number; part.strands.len()]);
            part.attributes.group_names = BTreeMap::from([(number, name)]);
            self.named += 1;
        }
        let Some(mut all) = self.all.take() else {
            self.all = Some(InPlace { hair: part, world_from_hair: world_from_part });
            return Ok(());
        };
        if all.world_from_hair != world_from_part {
            if all.world_from_hair != Affine3A::IDENTITY {
                all.hair = all.hair.transformed(&all.world_from_hair);
                all.world_from_hair = Affine3A::IDENTITY;
            }
            part = part.transformed(&world_from_part);
        }
        join(&mut all.hair, part);
        self.all = Some(all);
        Ok(())
    }

    /// The whole. Objects of one strand each, as some tools write them, are no groups.
    ///
    /// # Errors
    /// A point that is not finite; points so far apart that their distance is not.
    pub fn hair(self) -> Result<InPlace, Problem> {
        let mut all = self.all.unwrap_or(InPlace { hair: Hair::default(), world_from_hair: Affine3A::IDENTITY });
        if self.named >= all.hair.strands.len() {
            all.hair.attributes.group = None;
            all.hair.attributes.group_names.clear();
        }
        let repeated = all.hair.attributes.repeated_ids();
        if repeated > 0 {
            let line = format!("ids that tell its strands apart: {repeated} strands have the id of another");
            all.hair.attributes.unread.push(line);
        }
        check_extent(all.hair.strands.points())?;
        Ok(all)
    }
}

fn join(all: &mut Hair, part: Hair) {
    for strand in part.strands.iter() {
        all.strands.push(strand.iter().copied());
    }
    let (a, b) = (&mut all.attributes, part.attributes);
    let (mut lost, mut retyped) = (Vec::new(), Vec::new());
    let mut both = |name: &str, joined: bool| {
        if !joined {
            lost.push(format!("{name}, which only some of its objects have"));
        }
    };
    both("ids", extend(&mut a.id, b.id));
    both("root UVs", extend(&mut a.root_uv, b.root_uv));
    both("groups", extend(&mut a.group, b.group));
    both("guides", extend(&mut a.guide, b.guide));
    both("widths", extend(&mut a.width, b.width));
    both("colours", extend(&mut a.colour, b.colour));
    both("transparencies", extend(&mut a.transparency, b.transparency));
    both("point UVs", extend(&mut a.point_uv, b.point_uv));
    both("held points", extend(&mut a.inverse_mass, b.inverse_mass));
    let mut others = b.other;
    a.other.retain_mut(|mine| {
        let found = others.iter().position(|theirs| same_kind(mine, theirs));
        let stored = mine.stored;
        let joined = found.is_some_and(|i| mine.append(others.swap_remove(i)));
        both(&mine.name, joined);
        if joined && mine.stored != stored {
            retyped.push(format!("the types of {}, which its objects store in several", mine.name));
        }
        joined
    });
    others.iter().for_each(|theirs| both(&theirs.name, false));
    a.group_names.extend(b.group_names);
    lost.append(&mut retyped);
    lost.extend(b.unread);
    lost.retain(|line| !a.unread.contains(line));
    a.unread.extend(lost);
}

/// Whether both or neither had the attribute; one alone is dropped.
fn extend<T>(a: &mut Option<Vec<T>>, b: Option<Vec<T>>) -> bool {
    match (a.as_mut(), b) {
        (Some(a), Some(b)) => a.extend(b),
        (None, None) => {}
        _ => {
            *a = None;
            return false;
        }
    }
    true
}

fn same_kind(a: &Other, b: &Other) -> bool {
    (&a.name, a.per, a.role, a.extent) == (&b.name, b.per, b.role, b.extent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use nabiki::Strands;

    #[test]
    fn an_object_without_curves_takes_nothing_from_the_others() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::Y]);
        let mut part = Hair::from(strands);
        part.attributes.width = Some(vec![0.1, 0.05]);
        for empty_first in [true, false] {
            let mut all = Gathered::default();
            let mut parts = [Hair::default(), part.clone()];
            if !empty_first {
                parts.swap(0, 1);
            }
            for (n, part) in parts.into_iter().enumerate() {
                all.append(part, Affine3A::IDENTITY, Some((n as i32, format!("part {n}")))).unwrap();
            }
            let found = all.hair().unwrap().hair;
            assert_eq!((&found.attributes.width, &found.attributes.unread), (&part.attributes.width, &Vec::new()));
        }
    }
}
