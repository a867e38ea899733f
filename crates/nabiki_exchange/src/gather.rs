//! Joins the curves of several objects of a file into one groom.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use glam::DAffine3;
use nabiki::Hair;
use nabiki::hair::{Other, Per};

use crate::Problem;
use crate::in_place::{InPlace, check_extent};

/// Hair from several objects.
#[derive(Default)]
pub struct Gathered {
    all: Option<InPlace>,
    /// Parts that were grouped by their object.
    named: usize,
    /// Curves of fewer than two points, which are no strands.
    short: usize,
    /// Names of what some parts have and the whole has not.
    dropped: BTreeSet<String>,
    /// What is said already: thousands of objects may have a line each.
    said: HashSet<String>,
}

impl Gathered {
    /// Appends a part below the transform `world_from_part`. `group` is its group name, unless it has groups. Curves
    /// with fewer than two points are left out. An attribute is kept only if all parts with curves have it; otherwise
    /// it is listed in `unread`.
    ///
    /// # Errors
    /// If there are more points in total than strands can count.
    pub fn append(
        &mut self,
        mut part: Hair,
        world_from_part: DAffine3,
        group: Option<(i32, String)>,
    ) -> Result<(), Problem> {
        let whole: Vec<usize> = (0..part.strands.len()).filter(|&s| part.strands.range(s).len() > 1).collect();
        if whole.len() < part.strands.len() {
            self.short += part.strands.len() - whole.len();
            part = part.select(&whole);
        }
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
            self.said.extend(part.attributes.unread.iter().cloned());
            self.all = Some(InPlace { hair: part, world_from_hair: world_from_part });
            return Ok(());
        };
        if all.world_from_hair != world_from_part {
            if all.world_from_hair != DAffine3::IDENTITY {
                all.hair = all.hair.transformed(&all.world_from_hair);
                all.world_from_hair = DAffine3::IDENTITY;
            }
            part = part.transformed(&world_from_part);
        }
        join(&mut all.hair, part, &mut self.dropped, &mut self.said);
        self.all = Some(all);
        Ok(())
    }

    /// The joined hair. Objects with one strand each, as some tools write them, do not become groups.
    ///
    /// # Errors
    /// If a point, or the distance between two points, is not finite.
    pub fn hair(self) -> Result<InPlace, Problem> {
        let mut all = self.all.unwrap_or(InPlace { hair: Hair::default(), world_from_hair: DAffine3::IDENTITY });
        if self.named >= all.hair.strands.len() {
            all.hair.attributes.group = None;
            all.hair.attributes.group_names.clear();
        }
        let repeated = all.hair.attributes.repeated_ids();
        if repeated > 0 {
            let have = if repeated == 1 { "strand has" } else { "strands have" };
            let line = format!("unique strand ids: {repeated} {have} the id of another");
            all.hair.attributes.unread.push(line);
        }
        if self.short > 0 {
            all.hair.attributes.unread.push(format!("{} curves with fewer than two points", self.short));
        }
        check_extent(all.hair.strands.points())?;
        Ok(all)
    }
}

/// Paths of closed curves, which are not hair: a rein, or the path of a camera.
pub struct Closed(pub Vec<String>);

impl Closed {
    /// Refuses them if there are no other curves.
    ///
    /// # Errors
    /// Names the curves.
    pub fn check(&self, open: usize) -> Result<(), Problem> {
        match self.0.first().filter(|_| open == 0) {
            Some(path) => {
                let line =
                    format!("curves {path}: are closed, but hair is open: export them as open (nonperiodic) curves");
                Err(Problem(line))
            }
            None => Ok(()),
        }
    }

    /// Phrases that report that they are left out.
    pub fn unread(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|path| format!("curves {path}, which are closed: hair is open"))
    }
}

/// Appends `part`; `dropped`: names of what parts before it had, and which stays away; `said`: the lines of what is unread.
fn join(all: &mut Hair, part: Hair, dropped: &mut BTreeSet<String>, said: &mut HashSet<String>) {
    for strand in part.strands.iter() {
        all.strands.push(strand.iter().copied());
    }
    let (a, b) = (&mut all.attributes, part.attributes);
    let (mut lost, mut retyped) = (Vec::new(), Vec::new());
    let mut both = |name: &str, joined: bool| {
        if !joined {
            lost.push(format!("{name}, {SOME}"));
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
    let others = b.other.into_iter().filter(|theirs| !dropped.contains(&theirs.name));
    let mut others: BTreeMap<String, Other> = others.map(|theirs| (theirs.name.clone(), theirs)).collect();
    a.other.retain_mut(|mine| {
        let stored = mine.stored;
        let Err(why) = append(mine, others.remove(&mine.name)) else {
            if mine.stored != stored {
                retyped.push(format!("the types of {}: its objects use different ones", mine.name));
            }
            return true;
        };
        lost.push(format!("{}, {why}", mine.name));
        dropped.insert(mine.name.clone());
        false
    });
    for name in others.into_keys() {
        lost.push(format!("{name}, {SOME}"));
        dropped.insert(name);
    }
    a.group_names.extend(b.group_names);
    lost.append(&mut retyped);
    lost.extend(b.unread);
    lost.retain(|line| said.insert(line.clone()));
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

/// Why the whole has not what some of its objects have.
const SOME: &str = "which only some of its objects have";

/// Appends what a further object has under the same name, or says why the two cannot be one.
fn append(mine: &mut Other, theirs: Option<Other>) -> Result<(), &'static str> {
    let theirs = theirs.ok_or(SOME)?;
    let kind = |other: &Other| (other.per, other.role, other.extent);
    let same = kind(mine) == kind(&theirs);
    let differs = mine.per == Per::Groom && mine.stored == theirs.stored && mine.values != theirs.values;
    match same {
        true if mine.append(theirs) => Ok(()),
        true if differs => Err("for which its objects have different values"),
        _ => Err("which its objects store in different ways"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use nabiki::Strands;
    use nabiki::hair::{Role, Values};

    fn part(other: Vec<Other>) -> Hair {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::Y]);
        let mut part = Hair::from(strands);
        part.attributes.other = other;
        part
    }

    #[test]
    fn what_objects_have_unlike_one_another_is_said_once_and_why() {
        let constant = |value: f32| Other::new("con", Per::Groom, Role::Plain, 1, Values::Floats(vec![value]));
        let mixed = |values| Other::new("mix", Per::Strand, Role::Plain, 1, values);
        let point = Other::new("own", Per::Point, Role::Plain, 1, Values::Floats(vec![0.0, 1.0]));
        let per_point = Other { name: "per".to_owned(), ..point.clone() };
        let per_strand = Other::new("per", Per::Strand, Role::Plain, 1, Values::Floats(vec![1.0]));
        let both = Other::new("same", Per::Groom, Role::Plain, 1, Values::Floats(vec![1.0]));
        let integer = mixed(Values::Integers(vec![1]));
        let word = mixed(Values::Words(vec!["a".to_owned()]));
        let first = vec![constant(1.0), integer.clone(), per_point, both.clone()];
        let second = vec![constant(2.0), word, per_strand, point, both.clone()];
        let third = vec![both.clone(), integer, constant(2.0)];
        let mut all = Gathered::default();
        for other in [first, second, third] {
            all.append(part(other), DAffine3::IDENTITY, None).unwrap();
        }
        let found = all.hair().unwrap().hair.attributes;
        assert_eq!(found.other, [both]);
        let mut unread = found.unread;
        unread.sort();
        assert_eq!(
            unread,
            [
                "con, for which its objects have different values",
                "mix, which its objects store in different ways",
                "own, which only some of its objects have",
                "per, which its objects store in different ways",
            ]
        );
    }

    #[test]
    fn ids_that_objects_share_stay_and_that_is_said() {
        let mut all = Gathered::default();
        for id in [3, 3, 4] {
            let mut part = part(Vec::new());
            part.attributes.id = Some(vec![id]);
            all.append(part, DAffine3::IDENTITY, None).unwrap();
        }
        let found = all.hair().unwrap().hair.attributes;
        assert_eq!(found.id, Some(vec![3, 3, 4]));
        assert_eq!(found.unread, ["unique strand ids: 1 strand has the id of another"]);
    }

    #[test]
    fn objects_below_different_transforms_are_all_where_these_put_them() {
        let at = |x: f64| DAffine3::from_translation(glam::DVec3::X * x);
        for places in [[10.0, 20.0, 10.0], [10.0, 10.0, 20.0], [0.0, 20.0, 20.0], [10.0, 0.0, 0.0]] {
            let mut all = Gathered::default();
            for x in places {
                all.append(part(Vec::new()), at(x), None).unwrap();
            }
            let hair = all.hair().unwrap().in_world().unwrap();
            let roots: Vec<Vec3> = hair.strands.iter().map(|strand| strand[0]).collect();
            assert_eq!(roots, places.map(|x| Vec3::X * x as f32));
        }
        // Those below one transform stay in its space.
        let mut all = Gathered::default();
        for _ in 0..2 {
            all.append(part(Vec::new()), at(5.0), None).unwrap();
        }
        let all = all.hair().unwrap();
        assert_eq!((all.world_from_hair, all.hair.strands.strand(1)[0]), (at(5.0), Vec3::ZERO));
    }

    #[test]
    fn objects_are_groups_of_their_names_unless_each_is_one_strand() {
        let groups = |objects: &[usize]| {
            let mut all = Gathered::default();
            for (n, &strands) in objects.iter().enumerate() {
                let mut object = part(Vec::new());
                (1..strands).for_each(|_| object.strands.push([Vec3::ZERO, Vec3::Y]));
                all.append(object, DAffine3::IDENTITY, Some((n as i32, format!("object {n}")))).unwrap();
            }
            let found = all.hair().unwrap().hair.attributes;
            (found.group, found.group_names)
        };
        let names = BTreeMap::from([(0, "object 0".to_owned()), (1, "object 1".to_owned())]);
        assert_eq!(groups(&[2, 1]), (Some(vec![0, 0, 1]), names));
        assert_eq!(groups(&[1, 1]), (None, BTreeMap::new()));
    }

    #[test]
    fn an_object_without_curves_takes_nothing_from_the_others() {
        let mut part = part(Vec::new());
        part.attributes.width = Some(vec![0.1, 0.05]);
        for empty_first in [true, false] {
            let mut all = Gathered::default();
            let mut parts = [Hair::default(), part.clone()];
            if !empty_first {
                parts.swap(0, 1);
            }
            for (n, part) in parts.into_iter().enumerate() {
                all.append(part, DAffine3::IDENTITY, Some((n as i32, format!("part {n}")))).unwrap();
            }
            let found = all.hair().unwrap().hair;
            assert_eq!((&found.attributes.width, &found.attributes.unread), (&part.attributes.width, &Vec::new()));
        }
    }
}
