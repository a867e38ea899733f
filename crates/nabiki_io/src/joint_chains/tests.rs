use glam::{DQuat, DVec3, Quat};
use nabiki::Hair;
use serde_json::Value;

use super::*;

const FRAMES: u32 = 12;

/// Strands that hang down in rows, 6 cm long (cm).
fn hair() -> Hair {
    let mut strands = Strands::default();
    for s in 0..30 {
        let root = Vec3::new((s % 6) as f32, 10.0, (s / 6) as f32);
        strands.push((0..=12).map(|i| root - Vec3::Y * 0.5 * i as f32));
    }
    Hair { strands, ..Hair::default() }
}

/// The hair bends to the side, more and more toward the tips; `apart` is how much its rows differ.
fn bent(hair: &Hair, n: u32, apart: f32) -> Strands {
    let mut bent = hair.strands.clone();
    for s in 0..bent.len() {
        let root = hair.strands.strand(s)[0];
        let swing = (0.5 * n as f32).sin() * (1.0 + apart * root.x);
        let mut at = root;
        for i in 1..=12 {
            at += Quat::from_rotation_x(0.08 * i as f32 * swing) * Vec3::NEG_Y * 0.5;
            bent.strand_mut(s)[i] = at;
        }
    }
    bent
}

fn head(n: u32) -> DAffine3 {
    let turn = DQuat::from_rotation_y(0.1 * f64::from(n));
    DAffine3::from_rotation_translation(turn, DVec3::new(f64::from(n), 150.0, 0.0))
}

/// The file, and what it says of itself.
fn written(options: ChainOptions, apart: f32) -> (Vec<u8>, String) {
    let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
    let path = folder.path().join("hair.glb");
    let mut export = Export::new(&hair, 24.0);
    (export.frames, export.faces_x) = (FRAMES, true);
    let mut sink: Box<dyn FrameSink> = Box::new(JointChains::create(&path, export, options).unwrap());
    for n in 0..FRAMES {
        sink.frame(&bent(&hair, n, apart), &head(n)).unwrap();
    }
    let holds = sink.finish().unwrap().unwrap();
    (std::fs::read(path).unwrap(), holds)
}

/// A reader of its own for what the tests ask of a file.
struct Read {
    document: Value,
    binary: Vec<u8>,
}

impl Read {
    fn new(bytes: &[u8]) -> Self {
        gltf::Gltf::from_slice(bytes).expect("a valid glTF");
        let whole = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], whole(4), whole(8)), (&b"glTF"[..], 2, bytes.len()));
        let text = whole(12);
        let document = serde_json::from_slice(&bytes[20..20 + text]).unwrap();
        Self { document, binary: bytes[28 + text..].to_vec() }
    }

    /// The numbers of an accessor, one vector after another.
    fn numbers(&self, accessor: &Value) -> Vec<Vec<f64>> {
        let of = &self.document["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.document["bufferViews"][of["bufferView"].as_u64().unwrap() as usize];
        let begin = (view["byteOffset"].as_u64().unwrap() + of["byteOffset"].as_u64().unwrap()) as usize;
        let wide = match of["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let one = |at: usize| match of["componentType"].as_u64().unwrap() {
            5126 => (f64::from(f32::from_le_bytes(self.binary[at..at + 4].try_into().unwrap())), 4),
            5125 => (f64::from(u32::from_le_bytes(self.binary[at..at + 4].try_into().unwrap())), 4),
            5122 => (f64::from(i16::from_le_bytes(self.binary[at..at + 2].try_into().unwrap())) / 32767.0, 2),
            5123 => (f64::from(u16::from_le_bytes(self.binary[at..at + 2].try_into().unwrap())), 2),
            _ => (f64::from(self.binary[at]) / 255.0, 1),
        };
        let size = one(begin).1;
        let vector = |i: usize| (0..wide).map(|k| one(begin + (i * wide + k) * size).0).collect();
        (0..of["count"].as_u64().unwrap() as usize).map(vector).collect()
    }

    /// The skinned vertices in a frame, as the specification has them.
    fn skinned(&self, frame: usize) -> Vec<DVec3> {
        let nodes = self.document["nodes"].as_array().unwrap();
        let vector = |of: &Value| of.as_array().map(|of| of.iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>());
        let mut local: Vec<(DQuat, DVec3)> = nodes
            .iter()
            .map(|node| {
                let turn = vector(&node["rotation"]).map_or(DQuat::IDENTITY, |q| DQuat::from_slice(&q));
                (turn, vector(&node["translation"]).map_or(DVec3::ZERO, |p| DVec3::from_slice(&p)))
            })
            .collect();
        let animation = &self.document["animations"][0];
        for channel in animation["channels"].as_array().unwrap() {
            let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
            let value = &self.numbers(&sampler["output"])[frame];
            let node = &mut local[channel["target"]["node"].as_u64().unwrap() as usize];
            match channel["target"]["path"].as_str().unwrap() {
                "rotation" => node.0 = DQuat::from_slice(value).normalize(),
                _ => node.1 = DVec3::from_slice(value),
            }
        }
        let mut global = vec![DAffine3::IDENTITY; nodes.len()];
        let mut left = vec![(0, DAffine3::IDENTITY)];
        while let Some((node, parent)) = left.pop() {
            global[node] = parent * DAffine3::from_rotation_translation(local[node].0, local[node].1);
            let children = nodes[node]["children"].as_array().into_iter().flatten();
            left.extend(children.map(|child| (child.as_u64().unwrap() as usize, global[node])));
        }
        let skin = &self.document["skins"][0];
        let joints: Vec<usize> =
            skin["joints"].as_array().unwrap().iter().map(|joint| joint.as_u64().unwrap() as usize).collect();
        let inverse = self.numbers(&skin["inverseBindMatrices"]);
        let attributes = &self.document["meshes"][0]["primitives"][0]["attributes"];
        let [positions, by, weights] =
            ["POSITION", "JOINTS_0", "WEIGHTS_0"].map(|name| self.numbers(&attributes[name]));
        let vertex = |i: usize| {
            let p = DVec3::from_slice(&positions[i]);
            let parts = (0..4).map(|k| {
                let joint = by[i][k] as usize;
                let bind = glam::DMat4::from_cols_slice(&inverse[joint]);
                weights[i][k] * global[joints[joint]].transform_point3(bind.transform_point3(p))
            });
            parts.sum()
        };
        (0..positions.len()).map(vertex).collect()
    }
}

/// Hair in glTF's world: metres, facing +z.
fn in_gltf(strands: &Strands, n: u32) -> Vec<DVec3> {
    let points = strands.points().iter().map(|p| head(n).transform_point3(p.as_dvec3()));
    points.map(|p| 0.01 * DVec3::new(-p.z, p.y, p.x)).collect()
}

/// Hair whose strands all do the same is led as it went, in every frame, on a head that walks and turns.
#[test]
fn skinned_hair_goes_where_it_was_simulated() {
    let (bytes, holds) = written(ChainOptions { chains: 5, joints: 12, cards: 0.0, springs: None }, 0.0);
    let read = Read::new(&bytes);
    for n in 0..FRAMES {
        let expected = in_gltf(&bent(&hair(), n, 0.0), n);
        for (a, b) in read.skinned(n as usize).iter().zip(&expected) {
            // A point shares two bones: where these bend by 0.08 i, it is off by an eighth of that and half a centimetre at most.
            assert!(a.distance(*b) < 0.01 * 0.06, "frame {n}: {a} {b}");
        }
    }
    assert!(holds.starts_with("5 chains of 12 joints; the skinned hair is 0.0"), "{holds}");
}

/// What the file says of itself is what a reader of the file finds.
#[test]
fn the_distance_that_is_told_is_that_of_the_file() {
    let (bytes, holds) = written(ChainOptions { chains: 6, joints: 4, cards: 0.0, springs: None }, 0.6);
    let read = Read::new(&bytes);
    let (mut sum, mut count) = (0.0, 0);
    for n in 0..FRAMES {
        let expected = in_gltf(&bent(&hair(), n, 0.6), n);
        let skinned = read.skinned(n as usize);
        for s in 0..30 {
            for at in [3, 6, 9, 12] {
                sum += 100.0 * skinned[13 * s + at].distance(expected[13 * s + at]);
                count += 1;
            }
        }
    }
    let told: f64 = holds.split("is ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    // Told to a hundredth; weights are parts of 255, of hair that moves by up to 5 cm.
    assert!((sum / f64::from(count) - told).abs() < 0.005 + 0.02, "{} {told}", sum / f64::from(count));
    assert!(told > 0.02, "{told}");
}

#[test]
fn ribbons_lie_along_the_strands() {
    let (bytes, _) = written(ChainOptions { chains: 3, joints: 4, cards: 0.4, springs: None }, 0.1);
    let read = Read::new(&bytes);
    let primitive = &read.document["meshes"][0]["primitives"][0];
    assert_eq!(primitive["mode"], 4);
    let points = read.numbers(&primitive["attributes"]["POSITION"]);
    let expected: Vec<DVec3> =
        hair().strands.points().iter().map(|p| 0.01 * Vec3::new(-p.z, p.y, p.x).as_dvec3()).collect();
    for (pair, middle) in points.as_chunks::<2>().0.iter().zip(&expected) {
        let [a, b] = [0, 1].map(|i| DVec3::from_slice(&pair[i]));
        assert!((0.5 * (a + b)).distance(*middle) < 1e-6 && (a.distance(b) - 0.004).abs() < 1e-6, "{a} {b}");
    }
    assert_eq!(read.numbers(&primitive["indices"]).len(), 30 * 12 * 6);
}

#[test]
fn weights_sum_to_one_and_joints_are_there() {
    let (bytes, _) = written(ChainOptions { chains: 7, joints: 3, cards: 0.0, springs: None }, 0.2);
    let read = Read::new(&bytes);
    let attributes = &read.document["meshes"][0]["primitives"][0]["attributes"];
    for (weights, joints) in read.numbers(&attributes["WEIGHTS_0"]).iter().zip(read.numbers(&attributes["JOINTS_0"])) {
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{weights:?}");
        assert!(joints.iter().all(|&joint| joint < 21.0), "{joints:?}");
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let refused = |chains, joints, cards| ChainOptions { chains, joints, cards, springs: None }.check().unwrap_err();
    assert_eq!(refused(0, 8, 0.0), "0x8: give at least 1x1");
    assert_eq!(refused(9000, 8, 0.0), "9000x8 are 72000 joints: a file holds at most 65535");
    assert_eq!(refused(64, 8, -1.0), "cards of -1 cm: give a width, or 0 for lines");
}

/// A bone of VRM that is turned aside swings as its settings say: its amplitude falls to 1/e in the time given.
#[test]
fn springs_settle_when_they_should() {
    let (back, settle, length) = (12.0, 0.6, 0.02);
    let springs = Springs::new(back, settle);
    let dt = 1.0 / 60.0;
    // Small swings: the way of the tail across the bone, step by step as VRM writes it.
    let (mut before, mut now) = (0.002_f64, 0.002);
    let mut energy = Vec::new();
    for _ in 0..120 {
        let back = springs.stiffness * dt * now / length;
        let next = now + (now - before) * (1.0 - springs.drag) - back;
        (before, now) = (now, next);
        energy.push(((now - before) / dt).powi(2) * length / 12.0 + now * now);
    }
    // An energy falls twice as fast as an amplitude; it ripples within a swing of 0.26 s, so it is taken over many of these.
    let slope = (energy[100] / energy[10]).ln() / (90.0 * dt);
    assert!((-2.0 / slope - settle).abs() < 0.1 * settle, "{} s", -2.0 / slope);
}

#[test]
fn spring_bones_name_the_joints_of_each_chain_and_its_end() {
    let springs = Some(Springs { stiffness: 0.2, drag: 0.1 });
    let (bytes, _) = written(ChainOptions { chains: 3, joints: 4, cards: 0.0, springs }, 0.0);
    let read = Read::new(&bytes);
    let all = read.document["extensions"]["VRMC_springBone"]["springs"].as_array().unwrap();
    assert_eq!(all.len(), 3);
    for spring in all {
        let bones = spring["joints"].as_array().unwrap();
        assert_eq!(bones.len(), 5);
        for pair in bones.windows(2) {
            let children = &read.document["nodes"][pair[0]["node"].as_u64().unwrap() as usize]["children"];
            assert_eq!(children, &serde_json::json!([pair[1]["node"]]));
        }
    }
    // The hair is bound as without them.
    for n in 0..FRAMES {
        let expected = in_gltf(&bent(&hair(), n, 0.0), n);
        assert!(read.skinned(n as usize).iter().zip(&expected).all(|(a, b)| a.distance(*b) < 0.01), "frame {n}");
    }
}
