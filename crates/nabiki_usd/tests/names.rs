//! What other programs call what hair carries.

use std::io::Cursor;

use glam::DAffine3;
use nabiki::Hair;
use nabiki::hair::{Attributes, Values};
use nabiki_exchange::{Export, FrameSink, GroomReader};
use nabiki_usd::{HairStage, LayerKind, StageReader};

/// What is read of two curves of two points that carry this, and of what is written of them.
fn read(declared: &str) -> Attributes {
    let text = format!(
        "#usda 1.0\ndef BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2, 2]\n\
         point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]\n{declared} }}\n"
    );
    let hair = StageReader::new(Cursor::new(text.into_bytes())).unwrap().hair(0, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["again.usda", "again.usdc"] {
        let path = folder.path().join(name);
        let mut sink = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), LayerKind::Stage).unwrap());
        sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
        sink.finish().unwrap();
        let again = StageReader::open(&path).unwrap().hair(0, None).unwrap();
        let unread = hair.attributes.unread.clone();
        let again = Hair { attributes: Attributes { unread, ..again.attributes }, ..again };
        assert_eq!(again, hair, "{name}: {declared}");
    }
    hair.attributes
}

#[test]
fn hair_has_what_other_programs_keep_under_names_of_their_own() {
    let (by_point, by_strand) = ("( interpolation = \"vertex\" )", "( interpolation = \"uniform\" )");
    for name in ["widths", "width", "groom_width"] {
        let at = read(&format!("float[] primvars:{name} = [1, 2, 3, 4] {by_point}"));
        assert_eq!(at.width, Some(vec![1.0, 2.0, 3.0, 4.0]), "{name}");
    }
    for name in ["displayColor", "groom_color", "color"] {
        let at = read(&format!("color3f[] primvars:{name} = [(1, 0, 0), (0, 1, 0)] {by_strand}"));
        assert_eq!(at.colour, Some([[1.0, 0.0, 0.0]; 2].into_iter().chain([[0.0, 1.0, 0.0]; 2]).collect()), "{name}");
    }
    for name in ["groom_id", "id", "ids", "hairId"] {
        assert_eq!(read(&format!("int[] primvars:{name} = [7, 9] {by_strand}")).id, Some(vec![7, 9]), "{name}");
    }
    for name in ["st", "groom_root_uv", "root_uv", "surface_uv_coordinate", "rootuv", "uv", "UVMap"] {
        let at = read(&format!("float2[] primvars:{name} = [(0, 0.5), (1, 0.25)] {by_strand}"));
        assert_eq!(at.root_uv, Some(vec![[0.0, 0.5], [1.0, 0.25]]), "{name}");
    }
    for name in ["groom_group_id", "group_id", "group"] {
        assert_eq!(read(&format!("int[] primvars:{name} = [4, 2] {by_strand}")).group, Some(vec![4, 2]), "{name}");
    }
    for name in ["groom_group_name", "group_name"] {
        let at = read(&format!("string[] primvars:{name} = [\"back\", \"fringe\"] {by_strand}"));
        let names = [(0, "back".to_owned()), (1, "fringe".to_owned())];
        assert_eq!((at.group, at.group_names), (Some(vec![0, 1]), names.into()), "{name}");
    }
    for name in ["groom_guide", "guide"] {
        assert_eq!(
            read(&format!("int[] primvars:{name} = [0, 1] {by_strand}")).guide,
            Some(vec![false, true]),
            "{name}"
        );
    }
}

#[test]
fn colours_with_an_alpha_and_places_of_three_numbers_are_read_and_stay_whole() {
    let by_strand = "( interpolation = \"uniform\" )";
    let colours = Some([[1.0, 0.0, 0.0]; 2].into_iter().chain([[0.0, 1.0, 0.0]; 2]).collect());
    for name in ["displayColor", "color"] {
        let at = read(&format!("color4f[] primvars:{name} = [(1, 0, 0, 0.5), (0, 1, 0, 0.25)] {by_strand}"));
        assert_eq!((&at.colour, &at.unread), (&colours, &Vec::new()), "{name}");
        let whole = Values::Floats(vec![1.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.25]);
        assert_eq!((at.other.len(), &*at.other[0].name, &at.other[0].values), (1, name, &whole));
    }
    // Of as many numbers as four colours of three.
    let three = read("color4f[] primvars:displayColor = [(1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1)]");
    assert_eq!((three.colour, three.other), (None, Vec::new()));
    assert_eq!(three.unread, ["displayColor: 3 values for 4 points of 2 curves"]);
    for name in ["st", "uv"] {
        let at = read(&format!("texCoord3f[] primvars:{name} = [(0, 0.5, 9), (1, 0.25, 9)] {by_strand}"));
        assert_eq!((at.root_uv, at.unread), (Some(vec![[0.0, 0.5], [1.0, 0.25]]), Vec::new()), "{name}");
        assert_eq!((at.other[0].extent, &*at.other[0].name), (3, name));
    }
    // Pairs are not twice as many widths.
    let at = read(&format!("float2[] primvars:width = [(1, 2), (3, 4)] {by_strand}"));
    assert_eq!((at.width, at.other.len()), (None, 1));
}

#[test]
fn words_and_fractions_under_a_name_of_whole_numbers_stay_what_they_are() {
    let by_strand = "( interpolation = \"uniform\" )";
    for name in ["group", "id", "color", "width", "uv"] {
        let at = read(&format!("string[] primvars:{name} = [\"a\", \"b\"] {by_strand}"));
        let words = Values::Words(vec!["a".to_owned(), "b".to_owned()]);
        assert_eq!((at.other.len(), &at.other[0].values, &at.unread), (1, &words, &Vec::new()), "{name}");
        let other = at.other.clone();
        assert_eq!(at, Attributes { other, ..Attributes::default() }, "{name}");
    }
    let at =
        read(&format!("float[] primvars:id = [7, 9] {by_strand}\n double[] primvars:group = [1.0, 2.5] {by_strand}"));
    assert_eq!((at.id, at.group), (Some(vec![7, 9]), None));
    let group = at.other.iter().find(|other| other.name == "group").unwrap();
    assert_eq!(group.values, Values::Doubles(vec![1.0, 2.5]));
}
