//! Strands that their source stores tip first.

use super::Hair;
use crate::Strands;

impl Hair {
    /// Reverses the strands for which `tip_first` is true, with their values by point, and records this in the
    /// attributes.
    #[must_use]
    pub fn from_tip_first(self, tip_first: Vec<bool>) -> Self {
        let mut hair = self.turned(&tip_first);
        hair.attributes.tip_first = Some(tip_first);
        hair
    }

    /// The hair in the order of its source: strands that are stored tip first there are reversed again.
    #[must_use]
    pub fn as_in_source(mut self) -> Self {
        match self.attributes.tip_first.take() {
            Some(tip_first) => self.turned(&tip_first),
            None => self,
        }
    }

    /// Reverses the strands for which `which` is true.
    fn turned(self, which: &[bool]) -> Self {
        if !which.contains(&true) {
            return self;
        }
        let Self { strands, attributes } = self;
        let all: Vec<usize> = (0..strands.len()).collect();
        let mut points: Vec<usize> = (0..strands.points().len()).collect();
        for (s, _) in which.iter().enumerate().filter(|(_, turned)| **turned) {
            points[strands.range(s)].reverse();
        }
        let mut turned = attributes.gather(&all, &points);
        // Root texture coordinates that equal those of the root point move to the other end.
        if let (Some(uv), Some(root_uv)) = (&attributes.point_uv, &mut turned.root_uv) {
            for (s, _) in which.iter().enumerate().filter(|(_, turned)| **turned) {
                let range = strands.range(s);
                if !range.is_empty() && root_uv[s] == uv[range.start] {
                    root_uv[s] = uv[range.end - 1];
                }
            }
        }
        let places = points.iter().map(|&p| strands.points()[p]).collect();
        Self { strands: Strands::from_parts(strands.starts().to_vec(), places), attributes: turned }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::{Attributes, Other, Per, Role, Values};
    use super::*;

    #[test]
    fn strands_are_turned_with_what_they_carry_and_back_again() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]);
        strands.push([Vec3::Y, 3.0 * Vec3::Y]);
        let other = |per, values| Other::new("wet", per, Role::Plain, 1, values);
        let attributes = Attributes {
            id: Some(vec![7, 9]),
            root_uv: Some(vec![[0.0, 0.5], [0.75, 0.5]]),
            point_uv: Some([0.0, 0.1, 0.2, 0.3, 0.4].map(|u| [u, 0.5]).to_vec()),
            width: Some(vec![1.0, 2.0, 3.0, 4.0, 5.0]),
            other: vec![
                other(Per::Strand, Values::Integers(vec![1, 2])),
                other(Per::Point, Values::Integers(vec![1, 2, 3, 4, 5])),
            ],
            ..Attributes::default()
        };
        let source = Hair { strands, attributes };
        let hair = source.clone().from_tip_first(vec![true, false]);
        assert_eq!(hair.check_lengths(), Ok(()));
        assert_eq!(hair.strands.strand(0), [2.0 * Vec3::X, Vec3::X, Vec3::ZERO]);
        assert_eq!(hair.strands.strand(1), source.strands.strand(1));
        let a = &hair.attributes;
        assert_eq!((a.id.as_deref(), a.width.as_deref()), (Some(&[7, 9][..]), Some(&[3.0, 2.0, 1.0, 4.0, 5.0][..])));
        assert_eq!(a.root_uv, Some(vec![[0.2, 0.5], [0.75, 0.5]]), "those of the strand's own stay");
        assert_eq!(a.other[0], source.attributes.other[0]);
        assert_eq!(a.other[1].values, Values::Integers(vec![3, 2, 1, 4, 5]));
        assert_eq!(hair.as_in_source(), source);
        let both = source.clone().from_tip_first(vec![true, true]);
        assert_eq!(both.select(&[1]).as_in_source(), source.select(&[1]), "a part knows how its source has it");
    }
}
