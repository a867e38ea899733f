//! Parts of a file that are chosen by name.

use std::path::{Path, PathBuf};

use nabiki_io::mesh;

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
    let refused = |said: &str| Err(format!("{}: {said}", file.display()));
    assert_eq!(triangles(&["baest"]), refused("group \"baest\" is not in the file; did you mean \"beast\"?"));
    assert_eq!(triangles(&["/Body/Ey"]), refused("group \"/Body/Ey\" is not in the file; did you mean \"/Body/Eye\"?"));
}

#[test]
fn a_format_without_groups_takes_none() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/solid_text.ply");
    let refused = mesh::read(&file, &["body".to_owned()]).unwrap_err().to_string();
    assert!(refused.ends_with("group \"body\" is not in the file; it has no named groups"), "{refused}");
}
