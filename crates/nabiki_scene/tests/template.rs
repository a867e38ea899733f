//! New scenes about files in any unit and axes, and advice where a scene has them wrong.

use std::fmt::Write;
use std::path::Path;

use glam::{DAffine3, DVec3, Vec3};
use nabiki::body::Contact;
use nabiki::free_form::NeighbourForces;
use nabiki::{Hair, Head};
use nabiki_io::DeclaredSpace;
use nabiki_io::motion::Axis;
use nabiki_io::placement::{Placement, Unit};
use nabiki_scene::advice::Advice;
use nabiki_scene::scene::{Amount, FormChoice, HairSource, Measure, Quantity};
use nabiki_scene::template::template;
use nabiki_scene::{BuiltScene, Scene, Shown};

const FORCE: &str = "[[force]]\nthrough = 1\nvector = [0, -1, 0]\n";

fn is_of_world<M: Measure>(amount: &Amount<M>) -> bool {
    amount.quantity().is_some()
}

fn built(text: &str, path: &Path) -> BuiltScene {
    showing(text, path, Shown::All)
}

fn showing(text: &str, path: &Path, shown: Shown) -> BuiltScene {
    // What grows is as many as are asked for, and a file has few.
    let few = if text.contains("[hair]\nfile") { vec![] } else { vec![("hair.strands".to_owned(), "60".to_owned())] };
    Scene::parse(text, path, &few)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
        .build(shown)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn advised(stage: &BuiltScene) -> Vec<Advice> {
    stage.advice()
}

/// The settings that it gives, a line of a table each.
fn settings(advice: &[Advice], table: &str) -> Vec<String> {
    let all = advice.iter().flat_map(|advice| &advice.fixes);
    let line = |setting: &nabiki_scene::advice::Fix| {
        let key = setting.key.strip_prefix(table).unwrap_or_else(|| panic!("{} of {table}", setting.key));
        format!("{} = {}", &key[1..], setting.value)
    };
    all.map(line).collect()
}

/// The built-in head and some hair of it.
fn bust() -> BuiltScene {
    built(FORCE, Path::new("bust.toml"))
}

/// A mesh as the text of a .obj file that lies as `placement` says.
fn mesh_text(head: &Head, placement: &Placement) -> String {
    let place = placement.file_from_head();
    let mut text = String::new();
    for &p in &head.mesh.positions {
        let [x, y, z] = place.transform_point3(p).to_array();
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [a, b, c] in &head.mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    text
}

/// Strands as polylines of a .obj file.
fn hair_text(hair: &Hair, placement: &Placement) -> String {
    let place = placement.file_from_head();
    let (mut text, mut next) = (String::new(), 1);
    for strand in hair.strands.iter() {
        for &p in strand {
            let [x, y, z] = place.transform_point3(p).to_array();
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        let numbers: Vec<String> = (next..next + strand.len()).map(|i| i.to_string()).collect();
        writeln!(text, "l {}", numbers.join(" ")).unwrap();
        next += strand.len();
    }
    text
}

/// A person's height above the floor, in the file's unit and along its up axis.
fn standing(cm: f32, up: Axis, facing: Axis) -> Placement {
    Placement { unit: Unit { cm }, up, facing, origin: up.vector().as_vec3() * (160.0 / cm) }
}

#[test]
fn a_new_scene_finds_unit_and_axes_of_a_head_and_its_hair() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head, hair] = ["new.toml", "head.obj", "hair.obj"].map(|name| folder.path().join(name));
    let bust = bust();
    // Fitted as an imported head's is.
    let half_axes = Head::fit(&bust.model.head.mesh).unwrap().half_axes;
    let (y, z) = ((Axis::PlusY, Axis::PlusZ), (Axis::PlusZ, Axis::MinusY));
    for (unit, cm, (up, facing)) in [("m", 100.0, y), ("in", 2.54, z)] {
        let placement = standing(cm, up, facing);
        std::fs::write(&head, mesh_text(&bust.model.head, &placement)).unwrap();
        std::fs::write(&hair, hair_text(&bust.groom.hair, &placement)).unwrap();
        let new = template(&scene, Some(&head), &[], Some(&hair)).unwrap();
        for guess in
            [format!("head.unit = \"{unit}\""), format!("head.up = \"{up}\""), format!("head.facing = \"{facing}\"")]
        {
            assert!(new.guesses.iter().any(|said| said.starts_with(&guess)), "{guess}: {:?}", new.guesses);
        }
        assert!(!new.guesses.iter().any(|said| said.starts_with("hair.")), "{:?}", new.guesses);
        let stage = built(&new.text, &scene);
        assert_eq!(advised(&stage), [], "{}", new.text);
        // The file's digits, and a fit that settles to 1e-4 of the size.
        let off = (stage.model.head.ellipsoid.half_axes - half_axes).abs().max_element();
        assert!(off < 1e-2, "half axes off by {off} cm in {unit}");
    }
}

#[test]
fn a_new_scene_without_files_runs_in_the_free_form_as_hair_in_life() {
    let path = Path::new("new.toml");
    let new = template(path, None, &[], None).unwrap();
    let stage = built(&new.text, path);
    assert_eq!((new.guesses.len(), advised(&stage)), (0, vec![]));
    let Scene { form, free, contact, neighbours, .. } = &stage.scene;
    assert_eq!((form, contact), (&FormChoice::Free, &Contact::default()));
    // In true timing, whatever the frame rate.
    assert_eq!(free.gravity.quantity().map(Quantity::amount), Some(1.0));
    let of_world = [&free.stiffness.map(is_of_world), &free.hold.map(is_of_world), &free.settle.map(is_of_world)];
    assert!(of_world.iter().all(|profile| profile.values().iter().all(|&of_world| of_world)), "{free:?}");
    let mut winds = stage.scene.field.force.iter().filter(|force| force.vector != Vec3::ZERO);
    assert!(winds.all(|force| force.speed.is_some()));
    for rate in ["24", "25", "60"] {
        let set = [("motion.frame_rate".to_owned(), rate.to_owned())];
        let scene = Scene::parse(&new.text, path, &set).unwrap();
        assert!(scene.build(Shown::AtMost(300)).unwrap().simulation().is_ok(), "{rate} frames a second");
    }
    assert_eq!(neighbours, &None);
    // What it comments out is what it says.
    let more = ["[neighbours]", "pressure", "cohesion"];
    let text = more.iter().fold(new.text, |text, line| text.replace(&format!("# {line}"), line));
    assert_eq!(Scene::parse(&text, path, &[]).unwrap().neighbours, Some(NeighbourForces::default()), "{text}");
}

#[test]
fn a_head_of_no_person_s_size_is_said_with_the_unit_that_mends_it() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, head) = (folder.path().join("scene.toml"), folder.path().join("head.obj"));
    std::fs::write(&head, mesh_text(&bust().model.head, &standing(1.0, Axis::PlusY, Axis::PlusZ))).unwrap();
    let with = |unit: &str| {
        let text = format!(
            "[head]\nmesh = \"head.obj\"\nunit = {unit}\nfacing = \"+z\"\n[hair]\nfile = \"hair.obj\"\n{FORCE}"
        );
        advised(&built(&text, &scene))
    };
    // Hair that goes with the head is not spoken of beside it.
    std::fs::write(folder.path().join("hair.obj"), "v 0 172 0\nv 0 173 0\nl 1 2\n").unwrap();
    for wrong in ["\"m\"", "\"mm\"", "\"ft\""] {
        assert_eq!(settings(&with(wrong), "head"), ["unit = \"cm\""], "{wrong}");
    }
    assert_eq!(with("\"cm\""), []);
}

/// Hair as a file of the built-in head's: all of it, that of the middle line alone, or that of one side.
fn parts_of(hair: &Hair) -> [(&'static str, Hair); 3] {
    let part = |wanted: &dyn Fn(Vec3) -> bool| {
        let strands: Vec<usize> = (0..hair.strands.len()).filter(|&s| wanted(hair.strands.strand(s)[0])).collect();
        hair.select(&strands)
    };
    [("all", hair.clone()), ("the middle", part(&|p| p.z.abs() < 1.5)), ("a side", part(&|p| p.z > 4.0))]
}

#[test]
fn advice_that_is_followed_is_the_last_of_its_kind_whatever_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let many = [("hair.strands".to_owned(), "700".to_owned())];
    let bust = Scene::parse(FORCE, Path::new("bust.toml"), &many).unwrap().build(Shown::All).unwrap();
    let aside = Vec3::new(0.0, 160.0, 30.0);
    let placements = [
        ("aside", Placement { origin: aside, ..Placement::default() }),
        ("in inches", Placement { unit: Unit { cm: 2.54 }, ..Placement::default() }),
        ("in inches, aside", Placement { unit: Unit { cm: 2.54 }, origin: aside, ..Placement::default() }),
        ("in a unit without a name", Placement { unit: Unit { cm: 37.0 }, origin: aside, ..Placement::default() }),
        ("of a smaller head", Placement { unit: Unit { cm: 1.12 }, ..Placement::default() }),
        ("of a larger head", Placement { unit: Unit { cm: 0.8 }, ..Placement::default() }),
    ];
    for (part, hair) in parts_of(&bust.groom.hair) {
        for (how, placement) in placements.iter().filter(|(how, _)| part == "all" || how.contains("aside")) {
            let what = format!("{part} {how}, {} strands", hair.strands.len());
            std::fs::write(folder.path().join("hair.obj"), hair_text(&hair, placement)).unwrap();
            let with = |more: &str, shown| {
                let text = format!("[hair]\nfile = \"hair.obj\"\n{more}\n{FORCE}");
                Scene::parse(&text, &scene, &[]).unwrap().build(shown).unwrap().advice()
            };
            let first = with("", Shown::All);
            assert_eq!(with("", Shown::AtMost(7)), first, "{what}: does not depend on what is shown");
            let followed = settings(&first, "hair").join("\n");
            let then = with(&followed, Shown::All);
            assert_eq!(settings(&then, "hair"), Vec::<String>::new(), "{what}\nfirst {first:?}\nthen {then:?}");
        }
    }
}

#[test]
fn hair_beside_the_head_is_said_with_what_mends_it() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let bust = bust();
    let with = |placement: &Placement, more: &str| {
        std::fs::write(folder.path().join("hair.obj"), hair_text(&bust.groom.hair, placement)).unwrap();
        advised(&built(&format!("[hair]\nfile = \"hair.obj\"\n{more}\n{FORCE}"), &scene))
    };
    assert_eq!(with(&Placement::default(), ""), []);
    let inches = Placement { unit: Unit { cm: 2.54 }, ..Placement::default() };
    assert_eq!(settings(&with(&inches, ""), "hair"), ["unit = \"in\""]);
    assert_eq!(with(&inches, "unit = \"in\""), []);
    let aside = Placement { origin: Vec3::new(0.0, 160.0, 30.0), ..Placement::default() };
    let origin = settings(&with(&aside, ""), "hair").join("\n");
    assert!(origin.starts_with("origin = "), "{origin}");
    assert_eq!(with(&aside, &origin), []);
}

#[test]
fn hair_within_the_head_is_said_with_what_mends_it() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let bust = bust();
    // A tenth smaller than the head: roots within a centimetre of the skin, and most of the hair below it.
    let smaller = Placement { unit: Unit { cm: 1.1 }, ..Placement::default() };
    std::fs::write(folder.path().join("hair.obj"), hair_text(&bust.groom.hair, &smaller)).unwrap();
    let with = |more: &str| advised(&built(&format!("[hair]\nfile = \"hair.obj\"\n{more}\n{FORCE}"), &scene));
    let said = with("");
    assert!(said.len() == 1 && said[0].seen.contains("% of the hair's points are inside the head at rest"), "{said:?}");
    let followed = settings(&said, "hair").join("\n");
    assert!(followed.contains("unit = 1."), "{followed}");
    assert_eq!(with(&followed), [], "{followed}");
}

#[test]
fn what_a_format_states_is_not_guessed() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("new.toml");
    // An octahedron of half a metre, which has no skull.
    let files = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files"));
    for name in ["solid.glb", "solid.gltf", "solid.fbx"] {
        let new = template(&scene, Some(&files.join(name)), &[], None).unwrap();
        assert!(!new.guesses.iter().any(|said| said.contains("head.unit") || said.contains("head.up")), "{new:?}");
        assert!(!new.text.contains("\nunit =") && !new.text.contains("\nup ="), "{}", new.text);
        let placement = built(&new.text, &scene).model.placement;
        assert_eq!((placement.unit, placement.up), (Unit { cm: 100.0 }, Axis::PlusY), "{name}");
    }
}

#[test]
fn a_unit_that_a_file_states_is_kept_and_its_up_axis_may_be_another_than_the_head_s() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head, hair] = ["new.toml", "head.obj", "hair.usda"].map(|name| folder.path().join(name));
    let bust = bust();
    let (y, z) = ((Axis::PlusY, Axis::PlusZ), (Axis::PlusZ, Axis::MinusY));
    for (of_head, of_hair) in [(y, z), (z, y)] {
        std::fs::write(&head, mesh_text(&bust.model.head, &standing(100.0, of_head.0, of_head.1))).unwrap();
        // A little too small for the head: some of it lies inside.
        let place = standing(100.0, of_hair.0, of_hair.1).file_from_head_in_doubles();
        let place = place * DAffine3::from_scale(DVec3::splat(0.93));
        let declared = DeclaredSpace { unit: Some(Unit { cm: 100.0 }), up: Some(of_hair.0) };
        nabiki_io::exchange::write(&hair, &bust.groom.hair.clone().transformed(&place), declared).unwrap();
        let new = template(&scene, Some(&head), &[], Some(&hair)).unwrap();
        assert!(!new.guesses.iter().any(|said| said.starts_with("hair.")), "{:?}", new.guesses);
        let placement = built(&new.text, &scene).groom.imported.as_ref().unwrap().placement;
        assert_eq!((placement.unit.cm, placement.up, placement.facing), (100.0, of_hair.0, of_hair.1));
    }
}

/// A layer without metadata means centimetres and y by USD's rule, in which this hair is a hundredth of the head.
#[test]
fn hair_of_a_layer_that_states_nothing_has_the_unit_and_axes_of_its_head() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head, hair] = ["new.toml", "head.usda", "hair.usda"].map(|name| folder.path().join(name));
    let bust = bust();
    let place = standing(100.0, Axis::PlusZ, Axis::MinusY);
    let strings = |items: Vec<String>| items.join(", ");
    let points = |points: &[Vec3]| {
        let p = points.iter().map(|&p| place.file_from_head().transform_point3(p));
        strings(p.map(|p| format!("({}, {}, {})", p.x, p.y, p.z)).collect())
    };
    let mesh = &bust.model.head.mesh;
    let header = "#usda 1.0\n";
    let body = format!(
        "def Mesh \"head\" {{\n int[] faceVertexCounts = [{}]\n int[] faceVertexIndices = [{}]\n point3f[] points = [{}]\n}}\n",
        strings(vec!["3".to_owned(); mesh.triangles.len()]),
        strings(mesh.triangles.as_flattened().iter().map(u32::to_string).collect()),
        points(&mesh.positions)
    );
    std::fs::write(&head, format!("{header}(\n metersPerUnit = 1\n upAxis = \"Z\"\n)\n{body}")).unwrap();
    let strands = &bust.groom.hair.strands;
    let curves = format!(
        "def BasisCurves \"hair\" {{\n uniform token type = \"linear\"\n int[] curveVertexCounts = [{}]\n \
         point3f[] points = [{}]\n}}\n",
        strings(strands.iter().map(|strand| strand.len().to_string()).collect()),
        points(strands.points())
    );
    std::fs::write(&hair, format!("{header}{curves}")).unwrap();
    let new = template(&scene, Some(&head), &[], Some(&hair)).unwrap();
    let guessed = |line: &str| new.guesses.iter().any(|said| said.starts_with(line));
    assert!(guessed("hair.unit = \"m\"") && guessed("hair.up = \"+z\""), "{:?}", new.guesses);
    let stage = built(&new.text, &scene);
    assert_eq!(advised(&stage), [], "{}", new.text);
    assert_eq!(stage.groom.imported.as_ref().unwrap().placement, stage.model.placement);
}

#[test]
fn a_mesh_of_no_size_of_a_person_s_is_guessed_by_its_height_or_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head] = ["new.toml", "head.obj"].map(|name| folder.path().join(name));
    let solid =
        std::fs::read_to_string(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files/solid.obj")));
    std::fs::write(&head, solid.unwrap()).unwrap();
    let guess = |head: &Path| template(&scene, Some(head), &[], None).unwrap().guesses.join("\n");
    assert!(guess(&head).contains("head.unit = \"m\", by how tall the mesh is"), "{}", guess(&head));
    // A tenth of a unit: no unit up to the metre makes that a head or a body.
    std::fs::write(&head, "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n").unwrap();
    assert!(guess(&head).contains("head.unit = \"cm\": no unit gives it the height"), "{}", guess(&head));
    assert!(guess(&head).contains("give the unit of the file"), "{}", guess(&head));
    for scale in ["1e-9", "1e20"] {
        let unit = Unit { cm: scale.parse::<f32>().unwrap().recip() };
        std::fs::write(&head, mesh_text(&bust().model.head, &Placement { unit, ..Placement::default() })).unwrap();
        let refused = template(&scene, Some(&head), &[], None).unwrap_err().to_string();
        assert!(refused.contains("head.obj: ") && refused.contains("scale it in the file"), "{refused}");
    }
}

#[test]
fn of_a_body_among_other_things_the_part_with_a_skull_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head] = ["new.toml", "head.obj"].map(|name| folder.path().join(name));
    // A plate high above the head, so that there is no skull at the top.
    let plate =
        "v -90 90 -90\nv 90 90 -90\nv 0 90 90\nv 0 91 0\ng helper\nf -4 -3 -2\nf -4 -3 -1\nf -3 -2 -1\nf -2 -4 -1\n";
    let text = mesh_text(&bust().model.head, &standing(1.0, Axis::PlusY, Axis::PlusZ));
    let body = text.replacen("\nf ", "\ng body\nf ", 1);
    std::fs::write(&head, format!("{body}{}", plate.replace("90", "290").replace("91", "291"))).unwrap();
    let new = template(&scene, Some(&head), &[], None).unwrap();
    assert!(
        new.guesses.contains(&"head.groups = [\"body\"], the largest with a skull".to_owned()),
        "{:?}",
        new.guesses
    );
    assert!(new.text.contains("groups = [\"body\"]"), "{}", new.text);
    assert_eq!(advised(&built(&new.text, &scene)), []);
}

#[test]
fn a_hole_in_the_skull_is_said_and_one_at_the_neck_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head] = ["scene.toml", "head.obj"].map(|name| folder.path().join(name));
    let bust = bust().model.head.clone();
    let without = |gone: &dyn Fn(Vec3) -> bool| {
        let mut open = bust.clone();
        open.mesh.triangles.retain(|t| !t.iter().any(|&v| gone(bust.mesh.positions[v as usize])));
        std::fs::write(&head, mesh_text(&open, &standing(1.0, Axis::PlusY, Axis::PlusZ))).unwrap();
        let ellipsoid = "ellipsoid = { center = [0.0, 0.0, 0.0], half_axes = [9.5, 11.0, 7.8] }\norigin = [0, 160, 0]";
        advised(&built(&format!("[head]\nmesh = \"head.obj\"\nfacing = \"+z\"\n{ellipsoid}\n{FORCE}"), &scene))
    };
    assert_eq!(without(&|_| false), []);
    // The neck and what is below it.
    assert_eq!(without(&|p| p.y < -16.0), []);
    // A hole of 12 cm on the crown, about a third of a ball of 9 cm: 9 - sqrt(81 - 36) = 2.3 cm are missing.
    let said = without(&|p| p.y > 0.0 && p.with_y(0.0).length() < 6.0);
    assert!(
        said.len() == 1 && said[0].seen.starts_with("the skull has a hole") && said[0].fixes.is_empty(),
        "{said:?}"
    );
}

#[test]
fn a_file_that_is_not_there_is_said_with_the_scene_s_line() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let motion = "[head.motion]\nunit_cm = 1.0\nup = \"+y\"\nfacing = \"+z\"\n";
    for (table, key, file, line) in [
        ("[head]\n".to_owned(), "mesh", "no/head.obj", 2),
        ("[hair]\nsegment_length = 2.0\n".to_owned(), "file", "hair.tfx", 3),
        (motion.to_owned(), "file", "walk.bvh", 5),
        (format!("{motion}file = \"scene.toml\"\n"), "skeleton", "one.asf", 6),
        ("[motion]\nform = \"free\"\n[[body]]\n".to_owned(), "mesh", "no/hand.obj", 4),
    ] {
        let text = format!("{table}{key} = \"{file}\"\n{FORCE}");
        std::fs::write(&scene, &text).unwrap();
        let said = Scene::load(&scene, &[]).unwrap().build(Shown::All).unwrap_err().to_string();
        let (start, end) = (format!("{}:{line}: ", scene.display()), format!("{key} = \"{file}\": there is no "));
        assert!(said.starts_with(&start) && said.contains(&end), "{said}");
        let refused = |value: &str| {
            let other = [(format!("{}.{key}", table_of(&table)), value.to_owned())];
            match Scene::load(&scene, &other) {
                Ok(loaded) => loaded.build(Shown::All).unwrap_err().to_string(),
                Err(refused) => refused.to_string(),
            }
        };
        if !table.contains("[[") {
            assert!(refused("\"\"").ends_with("= \"\": name a file"), "{}", refused("\"\""));
            assert!(refused(".").ends_with("= \".\": is a folder: name a file"), "{}", refused("."));
        }
    }
}

/// The name of the table that a text begins with.
fn table_of(text: &str) -> &str {
    text[1..].split(']').next().unwrap()
}

#[test]
fn more_strands_than_a_file_has_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let bust = bust();
    std::fs::write(folder.path().join("hair.obj"), hair_text(&bust.groom.hair, &Placement::default())).unwrap();
    let count = bust.strands().len();
    let load = |strands: usize, shown: Shown| {
        let text = format!("[hair]\nfile = \"hair.obj\"\nstrands = {strands}\n{FORCE}");
        Scene::parse(&text, &scene, &[]).unwrap().build(shown)
    };
    assert_eq!(load(count, Shown::All).unwrap().strands().len(), count);
    let refused = load(count + 1, Shown::All).unwrap_err().to_string();
    let end = format!(
        "hair.strands = {}: hair.obj has {count} strands: request fewer, or leave it out to use all",
        count + 1
    );
    assert!(refused.ends_with(&end), "{refused}");
    // There is nothing to grow more of.
    let shown = load(count, Shown::First(count + 1)).unwrap_err().to_string();
    assert!(shown.ends_with("request fewer"), "{shown}");
}

#[test]
fn hair_that_was_moved_aside_keeps_its_facing_however_much_of_it_is_inside() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, file] = ["new.toml", "hair.obj"].map(|name| folder.path().join(name));
    let many = [("hair.strands".to_owned(), "700".to_owned())];
    let bust = Scene::parse(FORCE, Path::new("bust.toml"), &many).unwrap().build(Shown::All).unwrap();
    // Every nth strand is pressed into the head behind its root.
    let pressed = |each: usize, deep: f32| {
        let mut strands = bust.strands().clone();
        let starts = strands.starts().to_vec();
        for strand in starts.windows(2).step_by(each) {
            for p in &mut strands.points_mut()[strand[0] as usize + 1..strand[1] as usize] {
                *p -= bust.model.head.outward(*p) * (bust.model.head.distance(*p) + deep);
            }
        }
        Hair::from(strands)
    };
    let smaller = |by: f32| {
        let place = DAffine3::from_scale(DVec3::splat(by.into()));
        bust.groom.hair.clone().transformed(&place)
    };
    let grooms = [
        ("as it is", bust.groom.hair.clone()),
        ("a tenth inside", pressed(10, 0.3)),
        ("a fifth inside", pressed(5, 0.5)),
        ("a third inside", pressed(3, 0.3)),
        ("two hundredths smaller", smaller(0.98)),
        ("four hundredths smaller", smaller(0.96)),
    ];
    let moves = [[30.0, 5.0, -20.0], [-30.0, 5.0, 20.0], [0.0, 40.0, 0.0], [5.0, 160.0, 3.0]];
    let front = Placement { facing: Axis::PlusZ, ..Placement::default() };
    let mut wrong = Vec::new();
    for (what, hair) in &grooms {
        for aside in moves.map(Vec3::from) {
            // The point of the file that is the middle of the head.
            std::fs::write(&file, hair_text(hair, &Placement { origin: aside, ..front })).unwrap();
            let new = template(&scene, None, &[], Some(&file)).unwrap();
            let HairSource::Imported(read) = Scene::parse(&new.text, &scene, &[]).unwrap().hair.source else {
                panic!()
            };
            let off = read.origin.unwrap_or_default().distance(aside);
            if read.facing != Some(Axis::PlusZ) || off > 2.0 {
                wrong.push(format!("{what}, moved by {aside}: {:?}, {:?}", read.facing, read.origin));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
