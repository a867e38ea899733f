//! A scene of a real head and its hair.

use std::path::Path;

use nabiki_reference_tests::shared;
use nabiki_scene::{Scene, Shown};

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn sintels_hair_lands_on_her_head() {
    let text = format!(
        "head = {{ mesh = \"{}\", unit = \"m\", facing = \"+z\" }}\n\
         hair = {{ file = \"{}\", strands = 500 }}\n\
         [[force]]\nthrough = 50\nvector = [-1, 0, 0]\n",
        shared("heads/sintel_bust.obj").display(),
        shared("hair/sintel_hair_16pts.tfx").display()
    );
    let stage = Scene::parse(&text, Path::new("sintel.toml"), &[]).unwrap().build(Shown::All).unwrap();
    assert_eq!(stage.hair.strands.len(), 500);
    let report = stage.import_report.unwrap();
    assert_eq!((report.strands_in_file, report.degenerate.dropped_strands), (11_400, 0));
    assert!(stage.head.ellipsoid.center.length() < 1e-3, "the origin is the centre of the fitted ellipsoid");
    // The README: root to surface 0.36 mm in the median, 6.1 mm at worst.
    let mut off: Vec<f32> = stage.hair.strands.iter().map(|s| stage.head.distance(s[0]).abs()).collect();
    off.sort_by(f32::total_cmp);
    assert!(off[250] < 0.1 && off[499] < 0.9, "median {} cm, worst {} cm", off[250], off[499]);
    // The back of the head carries more hair than the face.
    let behind = stage.hair.strands.iter().filter(|s| s[0].x < 0.0).count();
    assert!(behind > 300, "{behind} of 500 roots behind the centre");
    let placement = stage.hair_placement.unwrap();
    assert_eq!(placement, stage.placement, "the hair's file lies as the head's");
}
