//! What other programs call what hair carries.

use std::io::Cursor;

use nabiki::hair::Attributes;
use nabiki_exchange::GroomReader;
use nabiki_usd::StageReader;

/// What is read of two curves of two points that carry this.
fn read(declared: &str) -> Attributes {
    let text = format!(
        "#usda 1.0\ndef BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2, 2]\n\
         point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]\n{declared} }}\n"
    );
    StageReader::new(Cursor::new(text.into_bytes())).unwrap().hair(0, None).unwrap().attributes
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
