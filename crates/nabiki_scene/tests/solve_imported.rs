//! Wishes about imported hair, whose strands a preview shows in the order of their file.

use std::fmt::Write;
use std::path::PathBuf;

use glam::{DVec3, Vec3};
use nabiki::dynamics::largest_gain;
use nabiki::solve::Node;
use nabiki_scene::solve::WishFile;
use nabiki_scene::tasks::find;
use nabiki_scene::{BuiltScene, Scene, Shown, Unwatched};

const STRANDS: usize = 40;
const SHOWN: usize = 10;
/// Each has a short one beside it.
const BESIDE: [usize; 3] = [11, 20, 31];

/// Straight hair all over the upper half of the head, 16 cm long, with a few short strands between: the lines of an .obj.
fn hair() -> String {
    let mut text = String::new();
    let mut count = 0;
    let mut line = |root: Vec3, way: Vec3, segments: u32| {
        let mut names = String::new();
        for i in 0..=segments {
            let p = root + i as f32 * way;
            writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
            count += 1;
            write!(names, " {count}").unwrap();
        }
        writeln!(text, "l{names}").unwrap();
    };
    for k in 0..STRANDS {
        // The places of a spiral, one here, the next far away.
        let place = (17 * k % STRANDS) as f32;
        let (height, turn) = ((place + 0.5) / STRANDS as f32, 2.4 * place);
        let flat = (1.0 - height * height).sqrt();
        let way = Vec3::new(flat * turn.cos(), height, flat * turn.sin());
        let root = 1.02 * way * Vec3::new(9.5, 11.0, 7.8);
        line(root, way, 16);
        if BESIDE.contains(&k) {
            line(root + Vec3::splat(1e-3), way, 2);
        }
    }
    text
}

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("hair.obj"), hair()).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `hair`: what `[hair]` says besides the file.
    fn scene(&self, hair: &str) -> Scene {
        let text = format!(
            "[hair]\nfile = \"hair.obj\"\n{hair}\n[motion]\nframes = 20\n[[force]]\nthrough = 20\nvector = [0, -8, 0]\n"
        );
        Scene::parse(&text, &self.path("scene.toml"), &[]).unwrap()
    }
}

fn mean(built: &BuiltScene, frame: u32, nodes: &[Node]) -> DVec3 {
    let mut timeline = built.timeline().unwrap();
    let strands = timeline.seek(frame);
    let places = nodes.iter().map(|node| strands.strand(node.strand as usize)[node.node as usize].as_dvec3());
    places.sum::<DVec3>() / nodes.len() as f64
}

#[test]
fn what_hair_that_is_not_shown_can_bear_is_found_for_the_strands_that_were_meant() {
    let place = Place::new();
    let wishes =
        "[[wish]]\nframe = 20\nnear = { point = [0, 12, 18], radius = 13, frame = 0 }\nmean_moved = [0, 0, -14]\n";
    let wishes = WishFile::parse(wishes, &place.path("wish.toml")).unwrap();
    let shown = Shown::AtMost(SHOWN);
    let before = place.scene("").build(shown).unwrap();
    assert!(before.groom.ids.iter().zip(0..).any(|(&id, s)| id != s), "they are not the first of the file");
    // What hair has within 13 cm of the point, but for its roots.
    let is_near = |p: Vec3| p.as_dvec3().distance(DVec3::new(0.0, 12.0, 18.0)) <= 13.0;
    let mut nodes = Vec::new();
    for (strand, points) in (0..).zip(before.strands().iter()) {
        nodes.extend((1..).zip(&points[1..]).filter(|(_, p)| is_near(**p)).map(|(node, _)| Node { strand, node }));
    }
    assert!(!nodes.is_empty());
    let goal = mean(&before, 20, &nodes) + DVec3::new(0.0, 0.0, -14.0);

    let (without, _) = find(place.scene("drop_shorter_than = 5"), &wishes, SHOWN, &mut Unwatched).unwrap();
    let whole = place.scene("").build(Shown::All).unwrap();
    let bears = 4.0 / largest_gain(whole.strands(), &whole.dynamics).unwrap();
    let strength = without.field.force[0].vector.length();
    assert!(f64::from(strength) > bears, "short hair does not bear the first answer: {strength} of {bears}");

    let (scene, solved) = find(place.scene(""), &wishes, SHOWN, &mut Unwatched).unwrap();
    scene.clone().build(Shown::All).unwrap().simulation().expect("all hair bears what was found");
    let reported = solved.report.wishes[0].after_cm;
    let left = mean(&scene.build(shown).unwrap(), 20, &nodes).distance(goal);
    assert!((left - reported).abs() < 1e-5, "{left} cm are left, and {reported} are reported");
}

#[test]
fn strands_are_counted_among_those_that_a_scene_keeps() {
    let place = Place::new();
    let refused = |hair: &str, strand: usize| {
        let wishes = format!("[[wish]]\nframe = 20\nstrands = [{strand}]\nmean_moved = [0, 0, -2]\n");
        let wishes = WishFile::parse(&wishes, &place.path("wish.toml")).unwrap();
        let built = place.scene(hair).build(Shown::All).unwrap();
        wishes
            .about(&built)
            .err()
            .map(|refused| refused.to_string().replace(&format!("{}/", place.folder.path().display()), ""))
    };
    let all = STRANDS + BESIDE.len();
    assert_eq!(refused("", all - 1), None);
    let said = format!("wish.toml:3: wish[0].strands[0] = {all}: the scene's strands are 0 to {}", all - 1);
    assert_eq!(refused("", all), Some(said));
    for (hair, kept) in [("strands = 12", 12), ("drop_shorter_than = 5", STRANDS)] {
        assert_eq!(refused(hair, kept - 1), None);
        let said = format!(
            "wish.toml:3: wish[0].strands[0] = {kept}: the scene's strands are 0 to {}, the ones it keeps of {all} in its file: count only these",
            kept - 1
        );
        assert_eq!(refused(hair, kept), Some(said));
    }
}
