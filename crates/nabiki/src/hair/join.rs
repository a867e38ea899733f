//! Joins the attributes of several pieces of hair.

use super::{Attributes, Other};

impl Attributes {
    /// Appends the attributes of `further` strands. If the two do not have the same attributes, it returns `false` and
    /// leaves this one partly changed.
    ///
    /// Appending pieces of a groom from [`Hair::select`](super::Hair::select) in order, with each strand in one piece,
    /// restores the attributes of the groom bit by bit.
    #[must_use]
    pub fn append(&mut self, further: Self) -> bool {
        fn both<T>(mine: &mut Option<Vec<T>>, further: Option<Vec<T>>) -> bool {
            match (mine, further) {
                (Some(mine), Some(further)) => mine.extend(further),
                (None, None) => {}
                _ => return false,
            }
            true
        }
        self.group_names.extend(further.group_names);
        both(&mut self.id, further.id)
            && both(&mut self.root_uv, further.root_uv)
            && both(&mut self.group, further.group)
            && both(&mut self.guide, further.guide)
            && both(&mut self.tip_first, further.tip_first)
            && both(&mut self.width, further.width)
            && both(&mut self.colour, further.colour)
            && both(&mut self.transparency, further.transparency)
            && both(&mut self.point_uv, further.point_uv)
            && both(&mut self.inverse_mass, further.inverse_mass)
            && self.constant == further.constant
            && append_all(&mut self.other, further.other)
    }
}

fn append_all(mine: &mut [Other], further: Vec<Other>) -> bool {
    mine.len() == further.len()
        && mine.iter_mut().zip(further).all(|(mine, further)| {
            let alike = mine.name == further.name
                && mine.per == further.per
                && mine.role == further.role
                && mine.extent == further.extent
                && mine.stored == further.stored
                && mine.single == further.single;
            alike && mine.append(further)
        })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::{Hair, Other, Per, Role, Values};
    use super::*;
    use crate::Strands;

    /// Five strands of one to three segments, with an attribute of every kind.
    fn groom() -> Hair {
        let mut strands = Strands::default();
        for s in 0..5 {
            strands.push((0..2 + s % 3).map(|p| Vec3::new(s as f32, p as f32, 0.5)));
        }
        let (count, points) = (strands.len(), strands.points().len());
        let number = |i: usize| i as f32 * 0.1;
        let other = |name: &str, per, values| Other::new(name, per, Role::Plain, 1, values);
        let attributes = Attributes {
            id: Some((0..count as i64).map(|i| 7 * i).collect()),
            root_uv: Some((0..count).map(|i| [number(i), -number(i)]).collect()),
            group: Some(vec![3, 1, 3, 2, 1]),
            group_names: [(1, "top"), (2, "back"), (3, "sides"), (9, "of no strand")]
                .map(|(g, n)| (g, n.into()))
                .into(),
            guide: Some(vec![true, false, true, false, false]),
            tip_first: Some(vec![false, true, true, false, true]),
            width: Some((0..points).map(number).collect()),
            colour: Some((0..points).map(|i| [number(i); 3]).collect()),
            transparency: Some((0..points).map(number).collect()),
            point_uv: Some((0..points).map(|i| [number(i); 2]).collect()),
            inverse_mass: Some((0..points).map(number).collect()),
            other: vec![
                other("season", Per::Groom, Values::Words(vec!["winter".into()])),
                other("age", Per::Strand, Values::Integers((0..count as i64).collect())),
                other("wet", Per::Point, Values::Doubles((0..points).map(|i| i as f64).collect())),
            ],
            ..Attributes::default()
        };
        Hair { strands, attributes }
    }

    #[test]
    fn pieces_give_the_whole_again() {
        let whole = groom();
        for cuts in [&[0, 5][..], &[0, 2, 5], &[0, 1, 2, 3, 4, 5], &[0, 4, 5]] {
            let mut pieces = cuts.windows(2).map(|w| whole.select(&(w[0]..w[1]).collect::<Vec<_>>()).attributes);
            let mut joined = pieces.next().unwrap();
            assert!(pieces.all(|piece| joined.append(piece)), "{cuts:?}");
            assert_eq!(joined, whole.attributes, "{cuts:?}");
        }
    }

    #[test]
    fn grooms_that_carry_different_things_are_not_joined() {
        let changes: [fn(&mut Attributes); 5] = [
            |a| a.id = None,
            |a| a.width = None,
            |a| a.constant.width = Some(1.0),
            |a| drop(a.other.pop()),
            |a| a.other[1].name = "length".into(),
        ];
        for (i, change) in changes.into_iter().enumerate() {
            let mut other = groom().attributes;
            change(&mut other);
            assert!(!groom().attributes.append(other), "change {i}");
        }
    }
}
