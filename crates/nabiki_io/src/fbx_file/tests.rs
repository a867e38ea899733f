mod text;

use glam::{DVec3, Vec3};
use text::Text;

use super::*;
use crate::axis::Axis;
use crate::error::Error;
use crate::motion::{ClipMover, MotionSource, fbx::worst_of_chains};

/// A square in its own plane.
const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The vertices at some times of the only animation.
fn bent(text: &Text, times: &[f64]) -> Vec<Vec<Vec3>> {
    let mut all = Vec::new();
    let take = &mut |_, places| {
        all.push(places);
        Ok(())
    };
    each_bent(&text.bytes(), &[], "", times, take).unwrap();
    all
}

fn at_rest(text: &Text) -> Vec<Vec3> {
    mesh(&text.bytes(), &[]).unwrap().0.positions
}

/// Whether vertices are where they should be, to the rounding of singles.
#[track_caller]
fn are_near(found: &[Vec3], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len());
    for (v, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!(found.as_dvec3().distance(DVec3::from(*expected)) < 1e-6, "{v}: {found}, not {expected:?}");
    }
}

#[test]
fn polygons_become_triangles_where_their_nodes_have_them_in_the_unit_and_axes_of_the_file() {
    let mut text = Text::new([(0, 1), (2, 1), (1, -1)], 100.0);
    text.node(1, "group", "Null", 0, &[("Lcl Translation", "10,0,0"), ("Lcl Rotation", "0,0,90")]);
    text.node(2, "face", "Mesh", 1, &[("Lcl Scaling", "2,2,2"), ("GeometricTranslation", "0,0,1")]);
    text.mesh(3, 2, &SQUARE, &[&[0, 1, 2, 3], &[0, 1, 2]]);
    text.node(4, "other", "Mesh", 0, &[]).mesh(5, 4, &SQUARE, &[&[0, 1, 2]]);
    let bytes = text.bytes();
    let found = mesh(&bytes, &["face".to_owned()]).unwrap().0;
    are_near(&found.positions, &[[10.0, 0.0, 2.0], [10.0, 2.0, 2.0], [8.0, 2.0, 2.0], [8.0, 0.0, 2.0]]);
    assert_eq!(found.triangles.len(), 3);
    for [a, b, c] in found.triangles.iter().map(|t| t.map(|v| found.positions[v as usize])) {
        assert!((b - a).cross(c - a).z > 0.0, "counter-clockwise, as in the file");
    }
    // What is above a mesh selects it as well.
    assert_eq!(mesh(&bytes, &["group".to_owned()]).unwrap().0, found);
    assert_eq!(mesh(&bytes, &[]).unwrap().0.positions.len(), 8);
    assert_eq!(groups(&bytes).unwrap(), [("other".to_owned(), 1), ("face".to_owned(), 3)]);
    let Outline { space, rate, meshes, clips, nodes } = outline(&bytes).unwrap();
    assert_eq!((space.unit.map(|unit| unit.cm), space.up), (Some(100.0), Some(Axis::PlusZ)));
    assert_eq!(
        (rate, meshes, clips, nodes),
        (Some(30.0), 2, Vec::new(), ["group", "other", "face"].map(str::to_owned).to_vec())
    );
}

#[test]
fn a_vertex_has_the_colour_of_its_first_corner() {
    let mut text = Text::plain();
    let grey = |x: f64| [x, x, x, 1.0];
    let layers =
        Text::colours("fringe", &[grey(0.25), grey(0.5), grey(1.0), grey(0.0), grey(0.0), [0.0, 1.0, 0.0, 0.5]]);
    text.node(1, "face", "Mesh", 0, &[]).mesh_with(2, 1, &SQUARE, &[&[0, 1, 2], &[0, 2, 3]], &layers);
    let found = mesh(&text.bytes(), &[]).unwrap().0;
    let of = |name: &str| found.weights_named(name).map(|weights| weights.values.clone());
    assert_eq!(found.weight_names().collect::<Vec<_>>(), ["fringe"]);
    assert_eq!(of("fringe"), Some(vec![0.25, 0.5, 1.0, 0.7152]));
    assert_eq!(of("fringe.a"), Some(vec![1.0, 1.0, 1.0, 0.5]));
}

#[test]
fn a_file_of_a_left_hand_is_seen_in_the_mirror() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let faces: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[0, 3, 2], &[1, 2, 3]];
    let volume = |front: i32| {
        let mut text = Text::new([(0, 1), (1, 1), (2, front)], 1.0);
        text.node(1, "solid", "Mesh", 0, &[("Lcl Translation", "5,6,7")]).mesh(2, 1, &corners, &faces);
        let found = mesh(&text.bytes(), &[]).unwrap().0;
        let volume: f32 = found
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| found.positions[v as usize] - found.positions[0]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        (found.positions, volume)
    };
    let (right, of_right) = volume(1);
    let (left, of_left) = volume(-1);
    // Up stays up, and the outside outside.
    assert!((of_right.abs() - 1.0).abs() < 1e-6 && of_left * of_right > 0.0, "{of_right} {of_left}");
    for (a, b) in right.iter().zip(&left) {
        assert_eq!((a.y, a.x.abs(), a.z.abs()), (b.y, b.x.abs(), b.z.abs()));
    }
    let hand = |p: &[Vec3]| (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
    assert!(hand(&right) * hand(&left) < 0.0, "as seen, it is the same solid");
}

/// A strip of three rows from y = 0 to 2, bound to `neck` at the origin and `Head` at y = 1. The animation turns the head by a
/// quarter about z in a second, from bind pose on; without it, it is turned otherwise.
fn strip(kind: &str, axis: &str) -> Text {
    let mut text = Text::plain();
    text.node(1, "skin", "Mesh", 0, &[]);
    let rows =
        [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 2.0, 0.0], [1.0, 2.0, 0.0]];
    text.mesh(2, 1, &rows, &[&[0, 1, 3, 2], &[2, 3, 5, 4]]);
    text.node(3, "neck", "LimbNode", 0, &[]);
    text.node(4, "Head", "LimbNode", 3, &[("Lcl Translation", "0,1,0"), ("Lcl Rotation", "30,0,-70")]);
    text.skin(5, 2, kind);
    // Shares of the rows: one, halves, and one that is written as a half.
    text.cluster(6, 5, 3, &[(0, 1.0), (1, 1.0), (2, 0.25), (3, 0.5)], DVec3::ZERO);
    text.cluster(7, 5, 4, &[(2, 0.25), (3, 0.5), (4, 0.5), (5, 0.5)], DVec3::Y);
    text.stack(20, "turn", Some([0.0, 1.0]));
    let last = |part: &str| if part == axis { 90.0 } else { 0.0 };
    let keys = ["d|X", "d|Y", "d|Z"].map(|part| (part, [(0.0, 0.0), (1.0, last(part))]));
    let parts: Vec<(&str, &[(f64, f64)])> = keys.iter().map(|(part, keys)| (*part, &keys[..])).collect();
    text.curves(22, 21, (4, "Lcl Rotation"), &parts);
    text
}

#[test]
fn a_strip_is_at_rest_where_its_joints_bind_it_and_bends_with_them() {
    let text = strip("Linear", "d|Z");
    let rest =
        [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 2.0, 0.0], [1.0, 2.0, 0.0]];
    are_near(&at_rest(&text), &rest);
    let found = bent(&text, &[0.0, 1.0, 5.0]);
    are_near(&found[0], &rest);
    // A quarter about (0, 1): (x, 1 + y) goes to (-y, 1 + x). The middle row is half way between that and its place.
    let turned =
        [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.5, 0.0], [0.5, 1.5, 0.0], [-1.0, 0.0, 0.0], [-1.0, 2.0, 0.0]];
    are_near(&found[1], &turned);
    are_near(&found[2], &turned);
    assert!(bends(&text.bytes(), &[], "").unwrap());
}

#[test]
fn dual_quaternions_keep_the_distance_from_the_axis_of_a_twist_that_linear_shares_lose() {
    let of = |kind: &str| bent(&strip(kind, "d|Y"), &[1.0])[0][3];
    let (linear, dual) = (of("Linear"), of("DualQuaternion"));
    assert!((Vec3::new(linear.x, 0.0, linear.z).length() - 0.5_f32.sqrt()).abs() < 1e-6, "{linear}");
    assert!((Vec3::new(dual.x, 0.0, dual.z).length() - 1.0).abs() < 1e-6, "{dual}");
    assert!((linear.y - 1.0).abs() < 1e-6 && (dual.y - 1.0).abs() < 1e-6);
}

#[test]
fn a_blend_shape_goes_through_its_inbetween() {
    let mut text = Text::plain();
    text.node(1, "skin", "Mesh", 0, &[("Lcl Translation", "0,0,5")]).mesh(2, 1, &SQUARE, &[&[0, 1, 2, 3]]);
    text.shapes(3, 2, 50.0, &[(50.0, &[(2, [0.0, 0.0, 1.0])]), (100.0, &[(2, [0.0, 4.0, 0.0]), (3, [1.0, 0.0, 0.0])])]);
    text.stack(20, "smile", Some([0.0, 1.0]));
    text.curves(22, 21, (4, "DeformPercent"), &[("d|DeformPercent", &[(0.0, 0.0), (1.0, 100.0)])]);
    let at = |two: [f64; 3], three: [f64; 3]| [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], two, three];
    are_near(&at_rest(&text), &at([1.0, 1.0, 6.0], [0.0, 1.0, 5.0]));
    let found = bent(&text, &[0.0, 0.25, 0.5, 0.75, 1.0]);
    are_near(&found[0], &at([1.0, 1.0, 5.0], [0.0, 1.0, 5.0]));
    are_near(&found[1], &at([1.0, 1.0, 5.5], [0.0, 1.0, 5.0]));
    are_near(&found[2], &at([1.0, 1.0, 6.0], [0.0, 1.0, 5.0]));
    are_near(&found[3], &at([1.0, 3.0, 5.5], [0.5, 1.0, 5.0]));
    are_near(&found[4], &at([1.0, 5.0, 5.0], [1.0, 1.0, 5.0]));
    assert!(bends(&text.bytes(), &[], "").unwrap());
    let unread = mesh(&text.bytes(), &[]).unwrap().1;
    assert_eq!(unread, ["changes of the blend shape of skin: it keeps its shape in the file's still pose"]);
}

#[test]
fn curves_of_one_value_bend_nothing_and_one_joint_carries_a_mesh_as_a_whole() {
    let is_bent = |last: f64, joints: u32| {
        let mut text = Text::plain();
        text.node(1, "skin", "Mesh", 0, &[]).mesh(2, 1, &SQUARE, &[&[0, 1, 2, 3]]).skin(3, 2, "Linear");
        for joint in 10..10 + joints {
            text.node(joint, "Head", "LimbNode", 0, &[]);
            text.cluster(joint + 10, 3, joint, &[(0, 1.0), (1, 1.0)], DVec3::ZERO);
        }
        text.stack(30, "take", None).curves(32, 31, (10, "Lcl Translation"), &[("d|X", &[(0.0, 1.0), (1.0, last)])]);
        bends(&text.bytes(), &[], "take").unwrap()
    };
    assert!(is_bent(2.0, 2));
    assert!(!is_bent(1.0, 2), "a curve of one value");
    assert!(!is_bent(2.0, 1), "one joint");
}

/// What bends a skin may be the helper above a joint, and what carries all joints alike bends nothing.
#[test]
fn joints_bend_a_skin_where_they_move_against_each_other() {
    let is_bent = |moved: u32| {
        let mut text = Text::plain();
        text.node(1, "skin", "Mesh", 0, &[]).mesh(2, 1, &SQUARE, &[&[0, 1, 2, 3]]).skin(3, 2, "Linear");
        for (node, name, class, parent) in [
            (10, "hips", "Null", 0),
            (11, "Head", "LimbNode", 10),
            (12, "helper", "Null", 11),
            (13, "jaw", "LimbNode", 12),
        ] {
            text.node(node, name, class, parent, &[]);
        }
        text.cluster(21, 3, 11, &[(0, 1.0), (1, 1.0)], DVec3::ZERO);
        text.cluster(22, 3, 13, &[(2, 1.0), (3, 1.0)], DVec3::ZERO);
        text.stack(30, "take", None).curves(32, 31, (moved, "Lcl Translation"), &[("d|X", &[(0.0, 1.0), (1.0, 2.0)])]);
        bends(&text.bytes(), &[], "take").unwrap()
    };
    assert_eq!([10, 11, 12, 13].map(is_bent), [false, false, true, true]);
}

#[test]
fn chains_of_nodes_are_where_ufbx_has_them_however_scale_is_taken_over() {
    for inherit in 0..3 {
        let inherit = format!("{inherit}");
        let kind = ("InheritType", inherit.as_str());
        let mut text = Text::plain();
        text.node(
            1,
            "a",
            "LimbNode",
            0,
            &[kind, ("Lcl Translation", "1,2,3"), ("Lcl Scaling", "2,3,1"), ("PreRotation", "20,30,40")],
        );
        text.node(
            2,
            "b",
            "LimbNode",
            1,
            &[kind, ("Lcl Translation", "0,5,1"), ("Lcl Scaling", "1,0.5,1"), ("Lcl Rotation", "0,45,0")],
        );
        text.node(
            3,
            "c",
            "LimbNode",
            2,
            &[kind, ("Lcl Translation", "3,1,0"), ("RotationPivot", "1,0,2"), ("Lcl Rotation", "10,0,70")],
        );
        text.node(4, "Head", "LimbNode", 3, &[kind, ("Lcl Translation", "0,2,0"), ("Lcl Scaling", "3,1,1")]);
        text.stack(20, "grow", Some([0.0, 1.0]));
        text.curves(22, 21, (1, "Lcl Scaling"), &[("d|Y", &[(0.0, 3.0), (1.0, 1.0)])]);
        text.curves(24, 21, (2, "Lcl Rotation"), &[("d|Z", &[(0.0, 0.0), (1.0, 50.0)])]);
        text.curves(26, 21, (3, "Lcl Translation"), &[("d|X", &[(0.0, 3.0), (1.0, -4.0)])]);
        for time in [0.0, 0.3, 1.0] {
            let worst = worst_of_chains(&text.bytes(), time).unwrap();
            assert!(worst < 1e-12, "InheritType {inherit} at {time}: {worst}");
        }
    }
}

fn motion(text: &Text, source: MotionSource, rate: f64) -> Result<crate::motion::HeadMotion> {
    head_motion(&MotionSource { file: "head.fbx".into(), ..source }, &text.bytes(), rate)
}

#[test]
fn the_head_turns_from_where_it_is_bound() {
    let facing = Some(Axis::PlusZ);
    let found = motion(&strip("Linear", "d|Z"), MotionSource { facing, ..MotionSource::default() }, 4.0).unwrap();
    assert_eq!((found.poses.len(), found.first_frame), (5, Some(0)));
    let bound = found.bound.unwrap();
    assert!(bound.position_cm.distance(Vec3::Y) < 1e-6 && bound.rotation.angle_between(glam::Quat::IDENTITY) < 1e-6);
    for (n, pose) in found.poses.iter().enumerate() {
        // The file's +z is where the face looks, x here.
        let turned = glam::Quat::from_rotation_x(std::f32::consts::FRAC_PI_8 * n as f32);
        assert!(
            pose.position_cm.distance(Vec3::Y) < 1e-6 && pose.rotation.dot(turned).abs() > 1.0 - 1e-6,
            "{n}: {pose:?}"
        );
    }
    let asked = motion(&strip("Linear", "d|Z"), MotionSource::default(), 4.0).unwrap_err().to_string();
    assert_eq!(asked, "facing is not in the file: give facing = \"+z\" in the scene");
}

/// A head that goes along x by 1 a second, in two animations.
fn takes() -> Text {
    let mut text = Text::plain();
    text.node(1, "body", "Null", 0, &[]).node(2, "Head", "Mesh", 1, &[]).mesh(3, 2, &SQUARE, &[&[0, 1, 2, 3]]);
    text.stack(20, "walk", Some([2.0, 3.0])).curves(
        22,
        21,
        (2, "Lcl Translation"),
        &[("d|X", &[(0.0, 0.0), (9.0, 9.0)])],
    );
    text.stack(30, "run", None).curves(32, 31, (2, "Lcl Translation"), &[("d|X", &[(0.5, 1.0), (1.0, 2.0)])]);
    text
}

#[test]
fn an_animation_is_chosen_by_name_and_lasts_as_the_file_says_or_as_its_keys_do() {
    let facing = Some(Axis::PlusX);
    let of =
        |clip: &str| motion(&takes(), MotionSource { clip: clip.to_owned(), facing, ..MotionSource::default() }, 10.0);
    let walk = of("walk").unwrap();
    assert_eq!((walk.poses.len(), walk.first_frame, walk.times), (11, Some(20), [2.0, 0.1]));
    assert!((walk.poses[10].position_cm.x - 3.0).abs() < 1e-6 && (walk.poses[0].position_cm.x - 2.0).abs() < 1e-6);
    let run = of("run").unwrap();
    assert_eq!((run.poses.len(), run.first_frame), (6, Some(5)));
    assert!((run.poses[5].position_cm.x - 2.0).abs() < 1e-6);
    assert_eq!(of("").unwrap_err().to_string(), "has several animations: give clip = one of walk, run");
    assert_eq!(of("jump").unwrap_err().to_string(), "no clip \"jump\": clip can be walk, run");
    let clips = outline(&takes().bytes()).unwrap().clips;
    assert_eq!(clips, [("walk".to_owned(), 1.0), ("run".to_owned(), 0.5)]);
}

#[test]
fn what_moves_a_head_is_found() {
    let found = mover(&takes().bytes(), &[], &|_| true).unwrap();
    let clips = ["walk", "run"].map(str::to_owned).to_vec();
    assert_eq!(found, Some(ClipMover { node: "Head".to_owned(), clip: "walk".to_owned(), clips }));
    // Of a skin, the joint that has the vertices, here those of the upper rows.
    let strip = strip("Linear", "d|Z").bytes();
    let found = mover(&strip, &[], &|p| p.y > 1.5).unwrap().unwrap();
    assert_eq!((found.node.as_str(), found.clip.as_str()), ("Head", ""));
    assert!(carries(&strip, "neck", &[]).unwrap() && carries(&strip, "Head", &[]).unwrap());
    assert!(!carries(&strip, "skin", &[]).unwrap());
}

#[test]
fn meshes_that_a_joint_carries_stand_with_it_in_the_bind_pose() {
    let mut text = strip("Linear", "d|Z");
    text.node(8, "hat", "Mesh", 4, &[("Lcl Translation", "0,1,0")]).mesh(9, 8, &SQUARE, &[&[0, 1, 2, 3]]);
    let found = mesh(&text.bytes(), &["hat".to_owned()]).unwrap().0;
    are_near(&found.positions, &[[0.0, 2.0, 0.0], [1.0, 2.0, 0.0], [1.0, 3.0, 0.0], [0.0, 3.0, 0.0]]);
}

#[test]
fn hidden_meshes_and_coarser_levels_are_left_out_beside_others() {
    let mut text = Text::plain();
    text.node(1, "head", "Mesh", 0, &[]).mesh(2, 1, &SQUARE, &[&[0, 1, 2, 3]]);
    text.node(3, "helper", "Mesh", 0, &[("Visibility", "0")]).mesh(4, 3, &SQUARE, &[&[0, 1, 2, 3]]);
    text.node(5, "levels", "LodGroup", 0, &[])
        .object("NodeAttribute", 6, "NodeAttribute::", "LodGroup", "")
        .below(6, 5);
    text.node(7, "fine", "Mesh", 5, &[]).mesh(8, 7, &SQUARE, &[&[0, 1, 2, 3]]);
    text.node(9, "coarse", "Mesh", 5, &[]).mesh(10, 9, &SQUARE, &[&[0, 1, 2]]);
    let (found, unread) = mesh(&text.bytes(), &[]).unwrap();
    assert_eq!(found.positions.len(), 8);
    assert_eq!(
        unread,
        [
            "mesh coarse, which is hidden: level of detail of levels is \"coarser\"",
            "mesh helper, which is hidden: Visibility of helper is \"0\""
        ]
    );
    assert_eq!(mesh(&text.bytes(), &["helper".to_owned()]).unwrap().0.positions.len(), 4, "alone, it is read");
}

#[test]
fn vertices_without_a_joint_go_with_their_mesh() {
    let mut text = Text::plain();
    text.node(1, "skin", "Mesh", 0, &[("Lcl Translation", "7,0,0")]).mesh(2, 1, &SQUARE, &[&[0, 1, 2, 3]]);
    text.node(3, "Head", "LimbNode", 0, &[]).skin(5, 2, "Linear");
    text.cluster(6, 5, 3, &[(0, 1.0), (1, -2.0), (2, f64::NAN)], DVec3::ZERO);
    text.cluster(7, 5, 0, &[(3, 1.0)], DVec3::ZERO);
    text.stack(20, "go", None).curves(22, 21, (3, "Lcl Translation"), &[("d|Y", &[(0.0, 0.0), (1.0, 1.0)])]);
    let beside = [[8.0, 0.0, 0.0], [8.0, 1.0, 0.0], [7.0, 1.0, 0.0]];
    for (found, y) in [(&at_rest(&text), 0.0), (&bent(&text, &[1.0])[0], 1.0)] {
        are_near(found, &[[0.0, y, 0.0], beside[0], beside[1], beside[2]]);
    }
}

#[test]
fn what_is_no_fbx_or_has_no_mesh_is_refused_in_one_line() {
    let refused = |bytes: &[u8]| mesh(bytes, &[]).unwrap_err().to_string();
    assert_eq!(refused(b""), "is empty: export it again");
    let no_fbx = "is not an FBX: it starts neither with Kaydara FBX nor with ; FBX";
    assert_eq!(refused(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), no_fbx, "another format that ufbx knows");
    assert_eq!(refused(&[0x5a; 3000]), no_fbx);
    assert_eq!(refused(&Text::plain().bytes()), "holds no triangles");
    let mut text = Text::plain();
    text.node(1, "skin", "Mesh", 0, &[]).mesh(2, 1, &[[0.0, f64::NAN, 0.0], [1.0; 3], [2.0; 3]], &[&[0, 1, 2]]);
    assert_eq!(refused(&text.bytes()), "skin: vertex 0 is not finite: export it again");
    let mut text = Text::plain();
    text.node(1, "skin", "Mesh", 0, &[]).mesh(2, 1, &SQUARE, &[&[0, 1, 7]]);
    assert_eq!(refused(&text.bytes()), "is damaged: export it again");
    assert_eq!(
        outline(&Text::new([(0, 1), (1, 1), (2, 1)], 0.0).bytes()).unwrap_err().to_string(),
        "UnitScaleFactor is 0: must be the centimetres in one unit, such as 1 or 100"
    );
    let group = mesh(&takes().bytes(), &["haed".to_owned()]).unwrap_err().to_string();
    assert_eq!(group, "group \"haed\" is not in the file; did you mean \"Head\"?");
    assert!(
        head_motion(&MotionSource::default(), &Text::plain().bytes(), 24.0)
            .unwrap_err()
            .to_string()
            .contains("no node")
    );
}

#[test]
fn no_damage_to_a_skin_in_motion_panics_or_takes_more_than_a_line_to_say() {
    let whole = strip("DualQuaternion", "d|Y").bytes();
    let one_line = |e: Error| assert!(!e.to_string().contains('\n') && e.to_string().len() < 1000, "{e}");
    let read = |bytes: &[u8]| {
        mesh(bytes, &[]).map(drop).unwrap_or_else(one_line);
        each_bent(bytes, &[], "", &[0.5], &mut |_, _| Ok(())).unwrap_or_else(one_line);
        let source = MotionSource { facing: Some(Axis::PlusZ), ..MotionSource::default() };
        head_motion(&source, bytes, 4.0).map(drop).unwrap_or_else(one_line);
        mover(bytes, &[], &|_| true).map(drop).unwrap_or_else(one_line);
        outline(bytes).map(drop).unwrap_or_else(one_line);
    };
    let mut damaged = whole.clone();
    for at in 0..whole.len() {
        if at % 7 == 0 {
            read(&whole[..at]);
        }
        for byte in [b'9', b'-', b'\0', b'"', b'}'] {
            damaged[at] = byte;
            read(&damaged);
        }
        damaged[at] = whole[at];
    }
}
