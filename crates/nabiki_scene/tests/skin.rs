//! A head whose skin bends in its own file: hair goes along, stays out, and the head is drawn as it is.

use std::fmt::Write;
use std::path::Path;

use glam::{DAffine3, DVec3};
use nabiki::dynamics::Form;
use nabiki_io::exchange;
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::tasks::{NewOptions, SimulateOptions, Twin, new, simulate};
use nabiki_scene::told::SceneSummary;
use nabiki_scene::{Scene, Shown, Unwatched};

const LAST: usize = 6;
const ROWS: usize = 16;
const COLUMNS: usize = 20;

/// A vertex of a ball of 10 cm, at 150 cm, in a frame: its right half swells.
fn vertex(row: usize, column: usize, n: usize) -> DVec3 {
    let down = std::f64::consts::PI * row as f64 / ROWS as f64;
    let around = std::f64::consts::TAU * column as f64 / COLUMNS as f64;
    let out = DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
    let swell = 1.0 + 0.2 * out.z.max(0.0) * (0.5 * n as f64).sin();
    DVec3::Y * 150.0 + 10.0 * swell * out
}

/// Rows and columns of the vertices from which a strand grows.
fn roots() -> impl Iterator<Item = (usize, usize)> {
    (1..7).flat_map(|row| (0..COLUMNS).step_by(2).map(move |column| (row, column)))
}

/// The head and its hair, which stands still. `fewer`: the last frame lacks a vertex.
fn layer(fewer: bool) -> String {
    let points = |n: usize| {
        let all = (0..=ROWS).flat_map(|row| (0..COLUMNS).map(move |column| vertex(row, column, n)));
        let count = (ROWS + 1) * COLUMNS - usize::from(fewer && n == LAST);
        all.take(count).map(|p| format!("({}, {}, {})", p.x, p.y, p.z)).collect::<Vec<_>>().join(", ")
    };
    let samples = (0..=LAST).fold(String::new(), |mut text, n| {
        write!(text, "{n}: [{}], ", points(n)).unwrap();
        text
    });
    let at = |row: usize, column: usize| row * COLUMNS + column % COLUMNS;
    let squares = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column)));
    let corners: Vec<String> = squares
        .flat_map(|(r, c)| [at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)])
        .map(|v| v.to_string())
        .collect();
    let strands: Vec<String> = roots()
        .flat_map(|(row, column)| {
            let root = vertex(row, column, 0);
            let out = (root - DVec3::Y * 150.0).normalize();
            (0..9).map(move |i| root + f64::from(i) * (out - DVec3::Y * 0.1 * f64::from(i)).normalize())
        })
        .map(|p| format!("({}, {}, {})", p.x, p.y, p.z))
        .collect();
    let count = roots().count();
    format!(
        "#usda 1.0\n( metersPerUnit = 0.01\n upAxis = \"Y\"\n startTimeCode = 0\n endTimeCode = {LAST}\n timeCodesPerSecond = 24\n \
         framesPerSecond = 24 )\n\
         def Mesh \"face\" {{ point3f[] points.timeSamples = {{ {samples} }}\n int[] faceVertexCounts = [{}]\n \
         int[] faceVertexIndices = [{}] }}\n\
         def BasisCurves \"hair\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [{}]\n point3f[] points = [{}] }}\n",
        vec!["4"; ROWS * COLUMNS].join(", "),
        corners.join(", "),
        vec!["9"; count].join(", "),
        strands.join(", ")
    )
}

fn made(folder: &Path, fewer: bool) -> nabiki_scene::Result<()> {
    std::fs::write(folder.join("face.usda"), layer(fewer)).unwrap();
    let face = folder.join("face.usda");
    new(
        &folder.join("scene.toml"),
        &NewOptions { head: Some(face.clone()), hair: Some(face), ..NewOptions::default() },
        &mut Unwatched,
    )
}

#[test]
fn a_new_scene_of_a_head_that_bends_moves_its_hair_with_the_skin() {
    let folder = tempfile::tempdir().unwrap();
    made(folder.path(), false).unwrap();
    let scene = Scene::load(&folder.path().join("scene.toml"), &[]).unwrap();
    assert_eq!(scene.motion.frames as usize, LAST, "as long as it bends");
    let built = scene.clone().build(Shown::All).unwrap();
    let summary = SceneSummary::of(&built);
    assert_eq!(summary.skin.as_deref(), Some("its skin bends, and carries 60 roots on 60 triangles"));
    assert!(summary.unread.iter().all(|line| !line.contains("first frame")), "{:?}", summary.unread);

    // The head is a body that is where its skin is.
    let Form::Free(free) = &built.dynamics.form else { panic!("a new scene is in the free form") };
    let head = free.bodies[0].shape.obstacle();
    for n in 0..=LAST {
        let world = built.pose(n as u32).world_from_head();
        let skin = built.skin(n as u32).unwrap();
        for (row, column) in roots() {
            // The scene faces +x, whatever the file does; its origin is the file's.
            let there = built.model.placement.head_from_file().transform_vector3(vertex(row, column, n).as_vec3());
            let p = world.inverse().transform_point3(there);
            let nearest = skin.iter().map(|v| v.distance(p)).fold(f32::INFINITY, f32::min);
            assert!(nearest < 1e-4, "frame {n}: {nearest} cm");
            // Between the samples, a third of a centimetre apart, of a coarse ball.
            let off = head.read(p, n as u32).unwrap().distance.abs();
            assert!(off < 0.06, "frame {n}: {off} cm");
        }
    }

    let options = SimulateOptions {
        output: folder.path().join("moved.usdc"),
        exports: ExportOptions::default(),
        twin: Twin::Fast,
        shard: None,
    };
    simulate(scene, Shown::All, &options, &mut Unwatched).unwrap();
    let mut hair = exchange::MovingHair::open(&options.output, None).unwrap();
    assert_eq!(hair.frames(), LAST + 1);
    for n in 0..=LAST {
        let (strands, world): (_, DAffine3) = hair.frame(n).unwrap();
        for (s, (row, column)) in roots().enumerate() {
            let root = world.transform_point3(strands.strand(s)[0].as_dvec3());
            let off = root.distance(vertex(row, column, n));
            // Single precision at 150 cm.
            assert!(off < 1e-4, "frame {n}, strand {s}: {off} cm");
        }
    }
}

#[test]
fn skin_whose_vertices_change_their_number_is_refused_with_the_frame() {
    let folder = tempfile::tempdir().unwrap();
    // `new` leaves such a head still, and says why.
    made(folder.path(), true).unwrap();
    let text = std::fs::read_to_string(folder.path().join("scene.toml")).unwrap();
    assert!(!text.contains("face.usda\", node"), "{text}");
    let moving = text.replace(
        "ellipsoid = \"fit\"",
        "ellipsoid = \"fit\"\nmotion = { file = \"face.usda\", node = \"/face\", facing = \"+x\", bind_at_start = true }",
    );
    std::fs::write(folder.path().join("moving.toml"), moving).unwrap();
    let mut scene = Scene::load(&folder.path().join("moving.toml"), &[]).unwrap();
    scene.motion.frames = LAST as u32;
    scene.field.force.truncate(1);
    scene.field.force[0].through = LAST as u32;
    let refused = scene.build(Shown::All).unwrap_err().to_string();
    assert!(refused.contains("face.usda: frame 6 of the motion: its meshes have 339 vertices, and 340"), "{refused}");
}

/// A point cache of the head's vertices in each frame: PC2, as its makers describe it.
fn cache(at: impl Fn(usize, usize, usize) -> DVec3) -> Vec<u8> {
    let points = (ROWS + 1) * COLUMNS;
    let mut bytes = b"POINTCACHE2\0".to_vec();
    for word in [1, points as i32] {
        bytes.extend(word.to_le_bytes());
    }
    for number in [0.0_f32, 1.0] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend((LAST as i32 + 1).to_le_bytes());
    for n in 0..=LAST {
        for (row, column) in (0..=ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
            bytes.extend(at(row, column, n).as_vec3().to_array().into_iter().flat_map(f32::to_le_bytes));
        }
    }
    bytes
}

/// The scene of the head, moved by a point cache.
fn cached(folder: &Path, bytes: &[u8]) -> Result<nabiki_scene::BuiltScene, String> {
    made(folder, false).unwrap();
    std::fs::write(folder.join("face.pc2"), bytes).unwrap();
    let mut scene = Scene::load(&folder.join("scene.toml"), &[]).unwrap();
    let motion = scene.head.motion.as_mut().unwrap();
    *motion = nabiki_io::motion::MotionSource { file: "face.pc2".into(), ..Default::default() };
    scene.build(Shown::All).map_err(|e| e.to_string())
}

/// The points of a mesh in a cache are its skin, however the mesh itself is stored.
#[test]
fn a_point_cache_bends_the_mesh_that_it_is_of() {
    let folder = tempfile::tempdir().unwrap();
    let built = cached(folder.path(), &cache(vertex)).unwrap();
    let summary = SceneSummary::of(&built);
    assert_eq!(summary.skin.as_deref(), Some("its skin bends, and carries 60 roots on 60 triangles"));
    for n in 0..=LAST {
        let world = built.pose(n as u32).world_from_head();
        let skin = built.skin(n as u32).unwrap();
        for (row, column) in roots() {
            let there = built.model.placement.head_from_file().transform_vector3(vertex(row, column, n).as_vec3());
            let p = world.inverse().transform_point3(there);
            let nearest = skin.iter().map(|v| v.distance(p)).fold(f32::INFINITY, f32::min);
            assert!(nearest < 1e-4, "frame {n}: {nearest} cm");
        }
    }
}

/// A cache of a mesh that only goes as a whole moves the head, and no skin.
#[test]
fn a_point_cache_of_a_rigid_mesh_is_a_motion() {
    let folder = tempfile::tempdir().unwrap();
    let turned = |row, column, n: usize| {
        let turn = glam::DQuat::from_rotation_y(0.2 * n as f64);
        turn * vertex(row, column, 0) + DVec3::new(4.0 * n as f64, 0.0, 0.0)
    };
    let built = cached(folder.path(), &cache(turned)).unwrap();
    assert!(built.skin(3).is_none());
    for n in 0..=LAST {
        let world = built.pose(n as u32).world_from_head();
        for (row, column) in roots() {
            let to_head = built.model.placement.head_from_file();
            let rest = to_head.transform_point3(vertex(row, column, 0).as_vec3());
            let there = to_head.transform_vector3(turned(row, column, n).as_vec3());
            assert!(world.transform_point3(rest).distance(there) < 1e-4, "frame {n}");
        }
    }
}

#[test]
fn a_point_cache_of_another_mesh_or_cut_off_is_refused() {
    let whole = cache(vertex);
    let said = |bytes: &[u8]| cached(tempfile::tempdir().unwrap().path(), bytes).map(|_| ()).unwrap_err();
    let line = said(&whole[..whole.len() - 1]);
    assert!(line.contains("face.pc2: has 28591 bytes, but 7 frames of 340 points take 28592: it is cut off"), "{line}");
    let mut fewer = whole.clone();
    fewer[16..20].copy_from_slice(&339_i32.to_le_bytes());
    let line = said(&fewer);
    assert!(
        line.contains("face.pc2: holds 339 points, but ") && line.contains("give the cache of this mesh"),
        "{line}"
    );
    let line = said(b"POINTCACHE2\0");
    assert!(line.contains("face.pc2: ends within its header: the file is cut off"), "{line}");
    // Counts of more bytes than fit into 64 bits.
    let mut huge = whole[..32].to_vec();
    huge[16..20].copy_from_slice(&i32::MAX.to_le_bytes());
    huge[28..32].copy_from_slice(&i32::MAX.to_le_bytes());
    let line = said(&huge);
    assert!(line.contains("it is cut off"), "{line}");
    huge[28..32].copy_from_slice(&(-1_i32).to_le_bytes());
    let line = said(&huge);
    assert!(line.contains("holds -1 frames of 2147483647 points: both must be above 0"), "{line}");
}
