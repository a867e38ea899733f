//! Wishes in the world about the hair of a head that walks and turns.

use glam::{DVec3, Vec3};
use nabiki::dynamics::Stepper;
use nabiki::solve::Goal;
use nabiki::{Pose, Strands};
use nabiki_scene::solve::WishFile;
use nabiki_scene::{BuiltScene, Scene, Shown};

const FRAMES: u32 = 24;

/// Walks along +x and looks to its left.
fn walking(folder: &std::path::Path) -> BuiltScene {
    let mut track = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned();
    for n in 0..=FRAMES {
        let (sin, cos) = (0.5 * 0.05 * f64::from(n)).sin_cos();
        track += &format!("{},{},150,7,0,{sin},0,{cos}\n", f64::from(n) / 24.0, 1.5 * f64::from(n));
    }
    std::fs::write(folder.join("walk.csv"), track).unwrap();
    let text = format!(
        "[hair]\nstrands = 200\n[motion]\nform = \"free\"\nframes = {FRAMES}\ninertia_length_floor = 18.0\n[head.motion]\n\
         file = \"walk.csv\"\nup = \"+y\"\nfacing = \"+x\"\n[[force]]\nthrough = {FRAMES}\nvector = [-80, 10, 20]\n"
    );
    Scene::parse(&text, &folder.join("scene.toml"), &[]).unwrap().build(Shown::All).unwrap()
}

fn at(built: &BuiltScene, frame: u32) -> Strands {
    let mut simulation = built.simulation().unwrap();
    (1..=frame).for_each(|n| simulation.step_frame(&built.input(n)));
    simulation.strands().clone()
}

/// Where a place of the head is in the world.
fn in_world(pose: Pose, p: Vec3) -> DVec3 {
    pose.rotation.as_dquat() * p.as_dvec3() + pose.position_cm.as_dvec3()
}

#[test]
fn a_wish_in_the_world_is_about_what_is_there_in_the_frame_that_is_looked_at() {
    let folder = tempfile::tempdir().unwrap();
    let built = walking(folder.path());
    let (looked_at, wished) = (8, 20);
    let [then, pose] = [looked_at, wished].map(|n| built.pose(n));
    assert!(then.position_cm.x > 11.9 && pose.rotation.angle_between(then.rotation) > 0.5);
    // Near a tip of frame 8, as it hangs in the world.
    let strands = at(&built, looked_at);
    let tip = strands.strand(17)[strands.strand(17).len() - 1];
    let point = in_world(then, tip).as_vec3();
    let wishes = |goal: &str| {
        let text = format!(
            "space = \"world\"\n[[wish]]\nframe = {wished}\nnear = {{ point = [{}, {}, {}], radius = 3, frame = {looked_at} }}\n{goal}\n",
            point.x, point.y, point.z
        );
        let file = WishFile::parse(&text, &folder.path().join("wish.toml")).unwrap();
        file.about(&built).unwrap().remove(0).wish
    };
    let wish = wishes("mean_moved = [1, 2, -3]");
    let mut expected = Vec::new();
    for (s, strand) in strands.iter().enumerate() {
        let near = |p: &Vec3| in_world(then, *p).distance(point.as_dvec3()) <= 3.0;
        expected.extend((1..strand.len()).filter(|&i| near(&strand[i])).map(|i| (s as u32, i as u32)));
    }
    let found: Vec<(u32, u32)> = wish.nodes.iter().map(|node| (node.strand, node.node)).collect();
    assert_eq!(found, expected);
    assert!(expected.len() > 1, "the tip has nodes beside it");
    // Ways are turned with the head of the frame that the wish is about, places are moved with it, too. Roundings of 150 cm.
    let Goal::MeanMoved(by) = wish.goal else { panic!("{:?}", wish.goal) };
    assert!((pose.rotation * by).distance(Vec3::new(1.0, 2.0, -3.0)) < 1e-5, "{by}");
    let Goal::MeanAt(place) = wishes("mean_at = [40, 160, 3]").goal else { panic!("a place") };
    assert!(in_world(pose, place).distance(DVec3::new(40.0, 160.0, 3.0)) < 1e-4, "{place}");
}
