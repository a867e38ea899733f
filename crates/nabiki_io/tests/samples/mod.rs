//! Small valid files of every binary format, made in code.

use glam::{Quat, Vec3};
use nabiki::Pose;
use nabiki::hair::{Attributes, Other, Per, Role, Values};
use nabiki::{Hair, Strands};
use nabiki_io::{SceneId, cache, hair_file, tfx};
use twox_hash::XxHash3_64;

/// Strands of `counts` points with every attribute that any format holds.
pub fn hair(counts: &[usize]) -> Hair {
    let mut strands = Strands::default();
    for (s, &count) in counts.iter().enumerate() {
        strands.push((0..count).map(|p| Vec3::new(s as f32, p as f32 * 0.5, 0.25)));
    }
    let points = strands.points().len();
    let by_point = |scale: f32| (0..points).map(|p| p as f32 * scale).collect::<Vec<f32>>();
    let attributes = Attributes {
        id: Some((0..counts.len() as i64).map(|s| 1000 - s).collect()),
        root_uv: Some((0..counts.len()).map(|s| [s as f32 * 0.125, 0.75]).collect()),
        group: Some((0..counts.len() as i32).collect()),
        group_names: [(0, "fringe".to_owned()), (1, "crown".to_owned())].into(),
        guide: Some((0..counts.len()).map(|s| s == 0).collect()),
        width: Some(by_point(0.001)),
        colour: Some(by_point(0.03125).into_iter().map(|c| [c, 0.5, 1.0 - c]).collect()),
        transparency: Some(by_point(0.03125)),
        point_uv: Some(by_point(0.25).into_iter().map(|u| [u, 1.0]).collect()),
        inverse_mass: Some(by_point(1.0).into_iter().map(|p| p.min(1.0)).collect()),
        constant: nabiki::hair::Constants {
            width: Some(0.01),
            colour: Some([0.25, 0.5, 1.0]),
            transparency: Some(0.0),
        },
        ..Attributes::default()
    };
    Hair { strands, attributes }
}

/// The same with attributes of every kind that mean nothing to the method.
pub fn whole(counts: &[usize]) -> Hair {
    let mut hair = hair(counts);
    let (strands, points) = (hair.strands.len(), hair.strands.points().len());
    let words = (0..strands).map(|s| "clump ".repeat(s)).collect();
    let places = (0..3 * points).map(|i| i as f64 / 3.0).collect();
    let numbers = (0..2 * points).map(|i| i as f32 / 7.0).collect();
    let others = [
        ("P_rest", Per::Point, Role::Point, 3, Values::Doubles(places)),
        ("clump", Per::Strand, Role::Plain, 1, Values::Words(words)),
        ("map", Per::Point, Role::TextureCoordinate, 2, Values::Floats(numbers)),
        ("seed of the groom", Per::Groom, Role::Plain, 1, Values::Integers(vec![-1, i64::MAX])),
    ];
    let other = |(name, per, role, extent, values)| Other::new(name, per, role, extent, values);
    hair.attributes.other = others.map(other).into();
    hair
}

/// A .hair file with a segments array and every other array.
pub fn hair_bytes() -> Vec<u8> {
    let mut bytes = Vec::new();
    hair_file::to_writer(&hair(&[3, 2, 4]), "sample", &mut bytes).unwrap();
    bytes
}

/// A .tfx file of version 4 with every array.
pub fn tfx_bytes() -> Vec<u8> {
    let mut bytes = Vec::new();
    tfx::to_writer(&hair(&[4, 4, 4]), &mut bytes).unwrap();
    bytes
}

/// A .tfx file of version 3: two guides of three points, thickness and UVs.
pub fn tfx_3_bytes() -> Vec<u8> {
    let mut bytes = 3.0f32.to_le_bytes().to_vec();
    let mut words = |words: &[u32]| bytes.extend(words.iter().flat_map(|w| w.to_le_bytes()));
    words(&[2, 3, 5, 1]);
    words(&[0; 31]);
    words(&[296, 368, 376, 0, 0, 0]);
    words(&[0; 32]);
    let mut floats = |floats: &[f32]| words(&floats.iter().map(|f| f.to_bits()).collect::<Vec<u32>>());
    floats(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0]);
    floats(&[1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 2.0, 0.5]);
    floats(&[0.01, 0.02]);
    floats(&[0.25, 0.5, 0.75, 1.0]);
    bytes
}

/// Where the head is in a frame of the sample cache.
pub fn pose(frame: usize) -> Pose {
    Pose { position_cm: Vec3::new(frame as f32, 160.0, 0.0), rotation: Quat::from_rotation_y(0.1 * frame as f32) }
}

/// The points of a frame of the sample cache.
pub fn frame_points(hair: &Hair, frame: usize) -> Vec<Vec3> {
    hair.strands.points().iter().map(|&p| p + Vec3::new(0.1, -0.3, 0.7) * frame as f32).collect()
}

/// Writes a cache of three frames with every attribute.
pub fn write_cache(path: &std::path::Path) -> cache::Header {
    let hair = whole(&[3, 2, 4]);
    let header = cache::Header::new(SceneId(0x0123_4567_89ab_cdef), 24.0, &hair);
    let mut writer = cache::Writer::create(path, &header, 3).unwrap();
    for frame in 0..3 {
        writer.push(&pose(frame), &frame_points(&hair, frame)).unwrap();
    }
    assert_eq!(writer.finish().unwrap(), 3);
    header
}

/// The same as bytes.
pub fn cache_bytes() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sample.nabiki");
    write_cache(&path);
    std::fs::read(path).unwrap()
}

/// A cache whose bytes have been changed, with the sums of what it holds now, as whoever means harm would write them.
pub fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    let at = bytes.windows(8).position(|tag| tag == b"sums    ").unwrap() + 16;
    let number = |at: usize, size: usize| (0..size).map(|i| usize::from(bytes[at + i]) << (8 * i)).sum::<usize>();
    let (points, frames_at) = (number(16, 4), number(32, 8));
    let all = std::iter::once(&bytes[..at]).chain(bytes[frames_at..].chunks(28 + 12 * points));
    let sums: Vec<u8> = all.flat_map(|part| XxHash3_64::oneshot(part).to_le_bytes()).collect();
    bytes[at..at + sums.len()].copy_from_slice(&sums);
    bytes
}
