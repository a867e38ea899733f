use exr::prelude::{ReadChannels, ReadLayers, read};
use glam::{DMat3, DQuat, DVec3};
use nabiki::Hair;
use serde_json::Value;

use super::*;

const FRAMES: u32 = 3;

/// Strands of 2 to 31 points that fill two rows of a texture, in another unit than glTF's (cm).
fn hair() -> Hair {
    let mut strands = Strands::default();
    for s in 0..600 {
        let root = Vec3::new((s % 20) as f32, 10.0, (s / 20) as f32);
        strands.push((0..2 + s * 7 % 30).map(|i| root + Vec3::new(0.1 * i as f32, -0.5 * i as f32, 0.0)));
    }
    assert!((8_193..16_384).contains(&strands.points().len()));
    Hair { strands, ..Hair::default() }
}

fn moved(hair: &Hair, n: u32) -> Strands {
    let mut moved = hair.strands.clone();
    for s in 0..moved.len() {
        let root = hair.strands.strand(s)[0];
        let turn = glam::Quat::from_rotation_x(0.3 * n as f32 * (s as f32).sin());
        moved.strand_mut(s).iter_mut().for_each(|p| *p = root + turn * (*p - root));
    }
    moved
}

fn head(n: u32) -> DAffine3 {
    let turn = DQuat::from_rotation_y(0.4 * f64::from(n));
    DAffine3::from_rotation_translation(turn, DVec3::new(f64::from(n), 150.0, 0.0))
}

/// The picture, and the attributes of the mesh.
struct Read {
    texels: Vec<[f32; 4]>,
    size: [usize; 2],
    comments: String,
    document: Value,
    binary: Vec<u8>,
    text: String,
    holds: String,
}

fn written(half_width: Option<f32>) -> Read {
    let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
    let path = folder.path().join("hair.exr");
    let mut export = Export::new(&hair, 24.0);
    (export.frames, export.faces_x, export.first_frame) = (FRAMES, true, 7);
    let mut sink: Box<dyn FrameSink> = Box::new(PointTexture::create(&path, export, half_width).unwrap());
    for n in 0..FRAMES {
        sink.frame(&moved(&hair, n), &head(n)).unwrap();
        assert!(std::fs::read_dir(&folder).unwrap().all(|file| {
            let name = file.unwrap().file_name();
            name.to_string_lossy().starts_with('.')
        }));
    }
    let holds = sink.finish().unwrap().unwrap();
    let picture = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |Vec2(w, h), _| (w, vec![[0.0; 4]; w * h]),
            |(w, texels), Vec2(x, y), (r, g, b, a): (f32, f32, f32, f32)| texels[y * *w + x] = [r, g, b, a],
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(&path)
        .unwrap();
    let attributes = &picture.layer_data.attributes;
    assert_eq!(attributes.software_name, None, "by its name the software finds its own stale pictures");
    let glb = std::fs::read(folder.path().join("hair.exr.glb")).unwrap();
    gltf::Gltf::from_slice(&glb).expect("a valid glTF");
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    Read {
        size: [picture.layer_data.size.0, picture.layer_data.size.1],
        comments: attributes.comments.as_ref().unwrap().to_string(),
        texels: picture.layer_data.channel_data.pixels.1,
        document: serde_json::from_slice(&glb[20..20 + length]).unwrap(),
        binary: glb[28 + length..].to_vec(),
        text: std::fs::read_to_string(folder.path().join("hair.exr.txt")).unwrap(),
        holds,
    }
}

impl Read {
    /// The vectors of 32-bit floats of an attribute.
    fn floats<const N: usize>(&self, name: &str) -> Vec<[f32; N]> {
        let accessor = &self.document["meshes"][0]["primitives"][0]["attributes"][name];
        let of = &self.document["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.document["bufferViews"][of["bufferView"].as_u64().unwrap() as usize];
        let [begin, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        let numbers = self.binary[begin..begin + length].as_chunks::<4>().0;
        let numbers: Vec<f32> = numbers.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
        numbers.as_chunks::<N>().0.to_vec()
    }

    /// What a shader finds for each vertex in a frame: the nearest texel.
    fn sampled(&self, frame: usize) -> Vec<[f32; 4]> {
        let [width, height] = self.size;
        let step = (height / FRAMES as usize) as f32 / height as f32;
        let texel = |[u, v]: [f32; 2]| {
            let (x, y) = (u * width as f32, (v + frame as f32 * step) * height as f32);
            self.texels[y as usize * width + x as usize]
        };
        self.floats("TEXCOORD_1").into_iter().map(texel).collect()
    }
}

fn position([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Hair in glTF's world: metres, facing +z.
fn in_gltf(strands: &Strands, n: u32) -> Vec<Vec3> {
    // +x to +z, +z to -x.
    let axes = DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::NEG_X) * 0.01;
    let world = DAffine3::from_mat3(axes) * head(n);
    strands.points().iter().map(|p| world.transform_point3(p.as_dvec3()).as_vec3()).collect()
}

/// Each vertex of the mesh finds its simulated point in every frame, bit for bit.
#[test]
fn the_texels_of_lines_are_the_simulated_points() {
    let (read, hair) = (written(None), hair());
    let points = hair.strands.points().len();
    assert_eq!(read.size, [points.div_ceil(2), 6]);
    for n in 0..FRAMES {
        let found: Vec<Vec3> = read.sampled(n as usize).into_iter().map(position).collect();
        assert!(found == in_gltf(&moved(&hair, n), n), "frame {n}");
    }
    let first: Vec<Vec3> = read.sampled(0).into_iter().map(position).collect();
    assert!(first == read.floats::<3>("POSITION").into_iter().map(Vec3::from).collect::<Vec<_>>());
    let attributes = read.document["meshes"][0]["primitives"][0].clone();
    assert_eq!(attributes["mode"], 1);
    assert!(read.document["skins"].is_null() && read.document["animations"].is_null());
}

#[test]
fn alpha_runs_from_root_to_tip_and_the_rest_is_empty() {
    let (read, hair) = (written(None), hair());
    for n in 0..FRAMES as usize {
        let along: Vec<f32> = read.sampled(n).into_iter().map(|[.., a]| a).collect();
        for s in 0..hair.strands.len() {
            let along = &along[hair.strands.range(s)];
            assert_eq!((along[0], along[along.len() - 1]), (0.0, 1.0), "strand {s}");
            assert!(along.is_sorted_by(|a, b| a < b), "strand {s}");
        }
    }
    let [width, height] = read.size;
    let unused = 2 * width - hair.strands.points().len();
    for (y, row) in read.texels.chunks(width).enumerate().filter(|(y, _)| y % 2 == 1) {
        assert!(row[width - unused..].iter().all(|texel| *texel == [0.0; 4]), "row {y} of {height}");
    }
}

/// The middle of a ribbon is the strand, its width stays, and it turns with the head and its strand alone.
#[test]
fn ribbons_keep_to_their_strands_in_every_frame() {
    const HALF: f32 = 0.002;
    let (read, hair) = (written(Some(HALF)), hair());
    let first: Vec<Vec3> = read.sampled(0).into_iter().map(position).collect();
    assert!(first == read.floats::<3>("POSITION").into_iter().map(Vec3::from).collect::<Vec<_>>());
    for n in 0..FRAMES {
        let found: Vec<Vec3> = read.sampled(n as usize).into_iter().map(position).collect();
        let middle = in_gltf(&moved(&hair, n), n);
        for (pair, middle) in found.as_chunks::<2>().0.iter().zip(&middle) {
            let [a, b] = *pair;
            // f32 of 1.5 m.
            assert!((0.5 * (a + b)).distance(*middle) < 2e-7, "frame {n}: {a} {b} {middle}");
            assert!((a.distance(b) - 2.0 * HALF).abs() < 1e-6, "frame {n}: {a} {b}");
        }
        // Each strand is turned as a whole here, and so is its ribbon: all sides of a strand are alike.
        for s in 0..hair.strands.len() {
            let sides = hair.strands.range(s).map(|i| found[2 * i + 1] - found[2 * i]);
            let sides: Vec<Vec3> = sides.collect();
            assert!(sides.iter().all(|side| side.distance(sides[0]) < 2e-6), "frame {n}, strand {s}");
        }
    }
    let normals = read.floats::<3>("NORMAL");
    for (i, normal) in normals.into_iter().map(Vec3::from).enumerate() {
        let side = first[i / 2 * 2 + 1] - first[i / 2 * 2];
        assert!(normal.dot(side).abs() < 1e-6 && (normal.length() - 1.0).abs() < 1e-5, "vertex {i}");
    }
    assert_eq!(read.document["meshes"][0]["primitives"][0]["mode"], 4);
}

#[test]
fn what_the_files_say_is_in_the_picture() {
    let read = written(None);
    let points = hair().strands.points().len();
    let [width, height] = read.size;
    let numbers = format!("frames=3 frames_per_second=24 vertices={points} rows_per_frame=2");
    assert_eq!(read.comments, format!("vertex-animation texture: {numbers}"));
    assert_eq!(read.holds, format!("3 frames of {points} vertices, each 2 rows of {width} texels"));
    for line in [
        format!("width, height            {width} x {height} texels"),
        format!("vertices                 {points}, of 600 strands"),
        "v from frame to frame    0.3333333333333333".to_owned(),
        "first frame              number 7 of the shot".to_owned(),
    ] {
        assert!(read.text.contains(&line), "{line}\n{}", read.text);
    }
}

/// The same hair gives the same bytes.
#[test]
fn the_same_frames_give_the_same_texture() {
    let bytes = |_| {
        let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
        let path = folder.path().join("hair.exr");
        let sink: Box<PointTexture<'_>> =
            Box::new(PointTexture::create(&path, Export::new(&hair, 24.0), Some(0.002)).unwrap());
        let mut sink: Box<dyn FrameSink> = sink;
        sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
        sink.finish().unwrap();
        std::fs::read(path).unwrap()
    };
    assert!(bytes(0) == bytes(1));
}

#[test]
fn too_much_for_a_texture_is_refused_before_the_first_frame() {
    let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
    let refused = |half_width| {
        let mut export = Export::new(&hair, 24.0);
        export.frames = 8_193;
        PointTexture::create(&folder.path().join("hair.exr"), export, half_width).err().unwrap().to_string()
    };
    let points = hair.strands.points().len();
    let said = format!(
        "8193 frames of {points} vertices need a texture of 8192 x 16386 texels, but 8192 x 16384 is the limit: use fewer \
         strands (simulate --strands N) or fewer frames"
    );
    assert_eq!(refused(None), said);
    assert!(refused(Some(0.002)).ends_with("or fewer frames, or lines (--export-cards 0)"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_texture_that_lacks_a_frame_is_not_finished() {
    let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
    let mut export = Export::new(&hair, 24.0);
    export.frames = 2;
    let mut sink: Box<dyn FrameSink> =
        Box::new(PointTexture::create(&folder.path().join("hair.exr"), export, None).unwrap());
    sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
    assert!(sink.finish().is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
