//! Parts of a file that are chosen by name.

use std::path::{Path, PathBuf};

use nabiki_io::{GroomFile, mesh};

/// A beast with an eye below it, beside the ground: two triangles, one, and three.
fn layer(folder: &Path) -> PathBuf {
    let mesh = |name: &str, triangles: usize| {
        let (counts, corners) = (vec!["3"; triangles].join(", "), vec!["0, 1, 2"; triangles].join(", "));
        format!(
            "def Mesh \"{name}\" {{ point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n\
             int[] faceVertexCounts = [{counts}]\n int[] faceVertexIndices = [{corners}] }}\n"
        )
    };
    let body = format!("def Xform \"Body\" {{ {} def Xform \"Eye\" {{ {} }} }}\n", mesh("beast", 2), mesh("ball", 1));
    let file = folder.join("scene.usda");
    std::fs::write(&file, format!("#usda 1.0\n{body}{}", mesh("ground", 3))).unwrap();
    file
}

#[test]
fn groups_choose_meshes_of_a_layer_by_name_path_or_what_they_stand_below() {
    let folder = tempfile::tempdir().unwrap();
    let file = layer(folder.path());
    let triangles = |groups: &[&str]| {
        let groups: Vec<String> = groups.iter().map(|&group| group.to_owned()).collect();
        mesh::read(&file, &groups).map(|mesh| mesh.triangles.len()).map_err(|e| e.to_string())
    };
    assert_eq!(triangles(&[]), Ok(6));
    assert_eq!(triangles(&["beast"]), Ok(2));
    assert_eq!(triangles(&["Body"]), Ok(3), "all that stands below");
    assert_eq!(triangles(&["/Body/Eye"]), Ok(1));
    assert_eq!(triangles(&["ball", "ground"]), Ok(4));
    let known: Vec<_> = mesh::groups(&file).unwrap();
    let by_size = [("/ground", 3), ("/Body/beast", 2), ("/Body/Eye/ball", 1)];
    assert_eq!(known, by_size.map(|(path, faces)| (path.to_owned(), faces)));
    let refused = |said: &str| Err(format!("{}: {said}", file.display()));
    assert_eq!(triangles(&["baest"]), refused("group \"baest\" is not in the file; did you mean \"beast\"?"));
    assert_eq!(triangles(&["/Body/Ey"]), refused("group \"/Body/Ey\" is not in the file; did you mean \"/Body/Eye\"?"));
}

#[test]
fn groups_choose_curves_of_a_layer_alike() {
    let curves = |name: &str, strands: usize| {
        let (counts, points) = (vec!["2"; strands].join(", "), vec!["(0, 0, 0), (0, 1, 0)"; strands].join(", "));
        format!(
            "def BasisCurves \"{name}\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [{counts}]\n\
             point3f[] points = [{points}] }}\n"
        )
    };
    let groom = format!("def Xform \"groom\" {{ {} {} }}\n", curves("guides", 1), curves("hair", 3));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("groom.usda");
    std::fs::write(&file, format!("#usda 1.0\n{groom}{}", curves("beard", 5))).unwrap();
    let opened = |groups: &[&str]| {
        let groups: Vec<String> = groups.iter().map(|&group| group.to_owned()).collect();
        GroomFile::open(&file).unwrap().keep(&groups).map_err(|e| e.to_string())
    };
    for (groups, strands, prims) in
        [(&[][..], 9, 3), (&["hair"], 3, 1), (&["groom"], 4, 2), (&["/beard"], 5, 1), (&["guides", "beard"], 6, 2)]
    {
        let mut groom = opened(groups).unwrap();
        assert_eq!(groom.hair(0, None).unwrap().strands.len(), strands, "{groups:?}");
        let kept = groom.curves(&file).unwrap();
        assert_eq!(kept.curves.len(), prims, "{groups:?}");
        // A layer lies over one prim, which groups tell from the others.
        assert_eq!(kept.under_layer(&kept.curves[0].path).is_ok(), prims == 1);
    }
    let refused = opened(&["hiar"]).err().unwrap();
    assert!(refused.ends_with("groom.usda: group \"hiar\" is not in the file; did you mean \"hair\"?"), "{refused}");
    let plain = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/groom.hair");
    let refused = GroomFile::open(&plain).unwrap().keep(&["hair".to_owned()]).err().unwrap().to_string();
    assert!(refused.ends_with("groups has no effect on a file that holds only hair: leave it out"), "{refused}");
}

#[test]
fn groups_choose_curves_of_an_archive_alike() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../nabiki_alembic/tests/files/hidden.abc");
    let of = |groups: &[String]| {
        let mut groom = GroomFile::open(&file).unwrap().keep(groups).unwrap();
        (groom.hair(0, None).unwrap().strands.len(), groom.curves(&file).unwrap().curves)
    };
    let (all, curves) = of(&[]);
    let each: Vec<_> = curves.iter().map(|prim| of(std::slice::from_ref(&prim.path))).collect();
    assert!(each.len() > 1 && each.iter().all(|(strands, curves)| *strands > 0 && curves.len() == 1));
    assert_eq!(each.iter().map(|(strands, _)| strands).sum::<usize>(), all);
}

#[test]
fn a_format_without_groups_takes_none() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/solid_text.ply");
    let refused = mesh::read(&file, &["body".to_owned()]).unwrap_err().to_string();
    assert!(refused.ends_with("group \"body\" is not in the file; it has no named groups"), "{refused}");
}
