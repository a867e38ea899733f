//! A value that is blocked, as Houdini blocks the indices of primvars that have none, is as if it were not written.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use nabiki::hair::Values;
use nabiki_exchange::GroomReader;
use nabiki_usd::StageReader;

/// `blocked.usdc` is `blocked.usda` as usd-core 26.11 exports it.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

fn reader(text: &str) -> StageReader {
    StageReader::new(Cursor::new(text.as_bytes().to_vec())).unwrap()
}

#[test]
fn what_is_blocked_reads_as_if_it_were_not_written_and_leaves_no_line() {
    let blocked = std::fs::read_to_string(file("blocked.usda")).unwrap();
    // Whatever is blocked at one time is blocked at all: its samples go with the lines that hold them.
    let mut within = false;
    let kept = blocked.lines().filter(|line| {
        let begins = line.contains("group.timeSamples");
        let goes = line.ends_with("= None") || begins || within;
        within = (within || begins) && line.trim() != "}";
        !goes
    });
    let without = kept.collect::<Vec<_>>().join("\n");
    assert!(!without.contains("None") && without.contains("primvars:widths ="), "{without}");
    let mut plain = reader(&without);
    let (contents, hair, mesh) = (plain.contents().unwrap(), plain.hair(0, None).unwrap(), plain.mesh().unwrap());
    for name in ["blocked.usda", "blocked.usdc"] {
        let mut stage = StageReader::open(&file(name)).unwrap();
        assert_eq!(stage.contents().unwrap(), contents, "{name}");
        let found = stage.hair(0, None).unwrap();
        assert_eq!(found.strands, hair.strands, "{name}");
        let (of_hair, unread) = (found.attributes, &hair.attributes.unread);
        // The order of operations still names the one that is blocked; without its line it is not there.
        let missing = "\"xformOp:scale\" of /groom: its xformOpOrder names it, but it does not exist";
        assert_eq!((&of_hair.unread, &unread[..]), (&Vec::new(), &[missing.to_owned()][..]), "{name}");
        assert_eq!((&of_hair.id, &of_hair.root_uv), (&Some(vec![41, 42]), &Some(vec![[0.1, 0.2], [0.3, 0.4]])));
        assert_eq!(of_hair.width, Some(vec![0.5, 0.5, 0.5, 0.25, 0.25, 0.25]), "{name}");
        assert_eq!(of_hair.colour.as_ref().map(|colour| colour[5]), Some([0.0, 0.0, 1.0]), "{name}");
        let clump = of_hair.other.iter().find(|other| other.name == "clump").unwrap();
        assert_eq!(clump.values, Values::Words(vec!["a".to_owned(), "b".to_owned()]), "{name}");
        assert_eq!(of_hair.other, hair.attributes.other, "{name}");
        assert_eq!(
            (stage.mesh().unwrap(), stage.mesh_unread().unwrap()),
            (mesh.clone(), vec![missing.to_owned()][1..].to_vec())
        );
        assert!(mesh.corner_uvs.is_some());
    }
}

/// As usd-core 26.11 has it: from a block on there is no value, and what was before it is held until then.
#[test]
fn a_block_among_samples_holds_from_its_time_on() {
    let text = "#usda 1.0\ndef BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
                point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 0, 0)], 2: [(0, 0, 0), (2, 0, 0)], 3: [(0, 0, 0), (3, 0, 0)] }\n\
                int[] primvars:id.timeSamples = { 1: [7], 2: None } ( interpolation = \"uniform\" ) }\n";
    let mut stage = reader(text);
    let ids = [0, 1, 2].map(|frame| stage.hair(frame, None).unwrap().attributes.id);
    assert_eq!(ids, [Some(vec![7]), None, None]);
}

#[test]
fn values_that_an_empty_list_of_indices_leaves_without_a_place_are_said() {
    let text = "#usda 1.0\ndef BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
                point3f[] points = [(0, 0, 0), (1, 0, 0)]\n\
                int[] primvars:id = [7] ( interpolation = \"uniform\" )\n int[] primvars:id:indices = [] }\n";
    let attributes = reader(text).hair(0, None).unwrap().attributes;
    assert_eq!((attributes.id, attributes.unread), (None, vec!["id: its list of indices is empty".to_owned()]));
}
