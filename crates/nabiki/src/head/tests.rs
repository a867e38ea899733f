use super::Head;
use crate::Mesh;

#[test]
fn a_mesh_without_triangles_is_refused() {
    assert_eq!(Head::from_mesh(Mesh::default(), None).unwrap_err().thing, "head.mesh");
}
