//! Any hair that a format can hold comes back from it to the bit.

use glam::{Quat, Vec3};
use nabiki::Pose;
use nabiki::hair::{Attributes, Other, Per, Role, Values};
use nabiki::{Hair, Strands};
use nabiki_io::{
    SceneId,
    cache::{Header, Reader, Writer},
    hair_file, tfx,
};
use proptest::{collection::vec, prelude::*};

/// Any finite number, subnormals and -0 included.
fn number() -> impl Strategy<Value = f32> {
    any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |x| x.is_finite())
}

/// Strands of the given point counts, with a width and a colour at every point.
fn hair(counts: impl Strategy<Value = Vec<usize>>) -> impl Strategy<Value = Hair> {
    counts.prop_flat_map(|counts| {
        let points: usize = counts.iter().sum();
        (
            vec([number(), number(), number()], points),
            vec(0.0f32..1e3, points),
            vec([number(), number(), number()], points),
        )
            .prop_map(move |(points, width, color)| {
                let mut points = points.into_iter().map(Vec3::from_array);
                let mut strands = Strands::default();
                for &count in &counts {
                    strands.push(points.by_ref().take(count));
                }
                let attributes = Attributes { width: Some(width), colour: Some(color), ..Attributes::default() };
                Hair { strands, attributes }
            })
    })
}

/// Attributes of any name, kind and values for so many strands and points.
fn others(strands: usize, points: usize) -> impl Strategy<Value = Vec<Other>> {
    let per = prop_oneof![Just(Per::Groom), Just(Per::Strand), Just(Per::Point)];
    let roles = [Role::Plain, Role::Colour, Role::Point, Role::Vector, Role::Normal, Role::TextureCoordinate];
    let other = (".*", per, proptest::sample::select(roles.to_vec()), 1usize..5, 0usize..3, 0usize..4);
    let other = other.prop_flat_map(move |(name, per, role, extent, list, kind)| {
        let count = extent
            * match per {
                Per::Groom => list,
                Per::Strand => strands,
                Per::Point => points,
            };
        let values = match kind {
            0 => vec(number(), count).prop_map(Values::Floats).boxed(),
            1 => vec(-1e300..1e300, count).prop_map(Values::Doubles).boxed(),
            2 => vec(any::<i64>(), count).prop_map(Values::Integers).boxed(),
            _ => vec(".*", count).prop_map(Values::Words).boxed(),
        };
        values.prop_map(move |values| Other::new(name.clone(), per, role, extent, values))
    });
    vec(other, 0..4)
}

/// All that decides a hair's bits: comparing floats would let -0 pass for 0.
fn bits(hair: &Hair) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let words = |values: &[f32]| values.iter().map(|x| x.to_bits()).collect();
    let points = words(bytemuck::cast_slice(hair.strands.points()));
    let width = words(hair.attributes.width.as_deref().unwrap_or_default());
    (hair.strands.starts().to_vec(), points, width)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_hair_comes_back_from_a_hair_file(hair in hair(vec(1usize..9, 1..12))) {
        let mut bytes = Vec::new();
        hair_file::to_writer(&hair, "", &mut bytes).unwrap();
        let read = hair_file::from_bytes(&bytes).unwrap();
        prop_assert_eq!(bits(&read), bits(&hair));
        prop_assert_eq!(read.attributes.colour, hair.attributes.colour);
    }

    #[test]
    fn the_points_of_any_hair_of_one_length_come_back_from_a_tfx_file(
        hair in (1usize..9, 1usize..12).prop_flat_map(|(points, strands)| hair(Just(vec![points; strands])))
    ) {
        let mut bytes = Vec::new();
        tfx::to_writer(&hair, &mut bytes).unwrap();
        let read = tfx::from_bytes(&bytes).unwrap();
        prop_assert_eq!((bits(&read).0, bits(&read).1), (bits(&hair).0, bits(&hair).1));
        prop_assert_eq!(read.attributes.colour, hair.attributes.colour);
    }

    #[test]
    fn any_frames_come_back_from_a_cache(
        hair in hair(vec(2usize..9, 1..12)).prop_flat_map(|hair| {
            others(hair.strands.len(), hair.strands.points().len()).prop_map(move |other| {
                let attributes = Attributes { other, ..hair.attributes.clone() };
                Hair { strands: hair.strands.clone(), attributes }
            })
        }),
        scene: u128,
        head in ([number(), number(), number()], [-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0, 0.1_f32..1.0]),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.nabiki");
        let pose = Pose { position_cm: head.0.into(), rotation: Quat::from_array(head.1).normalize() };
        let header = Header::new(SceneId(scene), 23.976, &hair);
        let mut writer = Writer::create(&path, &header, 1).unwrap();
        writer.push(&pose, hair.strands.points()).unwrap();
        writer.finish().unwrap();
        let mut reader = Reader::open(&path).unwrap();
        prop_assert_eq!(reader.header(), &header);
        let mut strands = header.strands();
        let read_pose = reader.read(0, &mut strands).unwrap();
        let head_bits = |pose: &Pose| (pose.position_cm.to_array().map(f32::to_bits), pose.rotation.to_array().map(f32::to_bits));
        prop_assert_eq!(head_bits(&read_pose), head_bits(&pose));
        prop_assert_eq!(bits(&reader.hair(0).unwrap()), bits(&hair));
    }
}
