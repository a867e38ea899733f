//! Hair in one format, out of it, in another, out of that: for every pair, what was there before is there after, but
//! for what the formats themselves say they cannot hold.

#[allow(dead_code, reason = "shared by several test programs, each of which uses a part")]
mod samples;

use std::path::Path;

use glam::{Quat, Vec3};
use nabiki::Hair;
use nabiki::Pose;
use nabiki::hair::{Attributes, Constants};
use nabiki_io::moving::{self, ChainOptions};
use nabiki_io::{SceneId, cache, exchange, hair};

const FORMATS: [&str; 6] = ["hair", "tfx", "usda", "usdc", "abc", "nabiki"];

fn write(path: &Path, hair: &Hair) {
    if path.extension().is_some_and(|ending| ending == "nabiki") {
        let mut writer = cache::Writer::create(path, &cache::Header::new(SceneId(7), 24.0, hair), 1).unwrap();
        let head = Pose { position_cm: Vec3::ZERO, rotation: Quat::IDENTITY };
        writer.push(&head, hair.strands.points()).unwrap();
        writer.finish().unwrap();
    } else {
        hair::write(path, hair).unwrap();
    }
}

fn read(path: &Path) -> Hair {
    if path.extension().is_some_and(|ending| ending == "nabiki") {
        cache::Reader::open(path).unwrap().hair(0).unwrap()
    } else {
        hair::read(path).unwrap()
    }
}

/// There and back.
fn through(format: &str, hair: &Hair) -> Hair {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hair").with_extension(format);
    write(&path, hair);
    read(&path)
}

fn losses(format: &str, hair: &Hair) -> Vec<String> {
    match format {
        "nabiki" => Vec::new(),
        _ => hair::losses(&Path::new("hair").with_extension(format), hair).unwrap(),
    }
}

/// The same hair with everything said at every point: what is not said is white, opaque, held at the root.
fn spelled_out(hair: &Hair) -> Hair {
    let points = hair.strands.points().len();
    let Attributes { width, colour, transparency, inverse_mass, constant, .. } = hair.attributes.clone();
    let held = || hair.strands.iter().flat_map(|s| (0..s.len()).map(|p| if p == 0 { 0.0 } else { 1.0 })).collect();
    let attributes = Attributes {
        width: width.or(constant.width.map(|w| vec![w; points])),
        colour: Some(colour.unwrap_or_else(|| vec![constant.colour.unwrap_or([1.0; 3]); points])),
        transparency: Some(transparency.unwrap_or_else(|| vec![constant.transparency.unwrap_or(0.0); points])),
        inverse_mass: Some(inverse_mass.unwrap_or_else(held)),
        constant: Constants::default(),
        ..hair.attributes.clone()
    };
    Hair { strands: hair.strands.clone(), attributes }
}

/// Grooms that carry nothing, everything, and each thing alone; strands of one number of points, which .tfx needs.
fn grooms() -> Vec<(&'static str, Hair)> {
    let whole = samples::hair(&[4, 4, 4, 4, 4]);
    let a = whole.attributes.clone();
    let third = vec![1.0 / 3.0; whole.strands.points().len()];
    let nothing = Attributes::default;
    let constant = |constant| Attributes { constant, ..nothing() };
    let each = [
        ("nothing", nothing()),
        ("ids", Attributes { id: a.id.clone(), ..nothing() }),
        ("ids beyond 32 bits", Attributes { id: Some((0..5).map(|s| s - (1 << 40)).collect()), ..nothing() }),
        ("root UVs", Attributes { root_uv: a.root_uv.clone(), ..nothing() }),
        ("groups", Attributes { group: a.group.clone(), ..nothing() }),
        ("named groups", Attributes { group: a.group.clone(), group_names: a.group_names.clone(), ..nothing() }),
        (
            "a name without strands",
            Attributes { group: a.group.clone(), group_names: [(77, "nobody".to_owned())].into(), ..nothing() },
        ),
        ("guides", Attributes { guide: a.guide.clone(), ..nothing() }),
        ("widths", Attributes { width: a.width.clone(), ..nothing() }),
        ("colours", Attributes { colour: a.colour.clone(), ..nothing() }),
        ("transparencies", Attributes { transparency: a.transparency.clone(), ..nothing() }),
        ("thirds of transparency", Attributes { transparency: Some(third), ..nothing() }),
        ("point UVs", Attributes { point_uv: a.point_uv.clone(), ..nothing() }),
        ("freedom", Attributes { inverse_mass: Some((0..20).map(|p| (p % 3) as f32 * 0.5).collect()), ..nothing() }),
        ("one width", constant(Constants { width: Some(0.0123), ..Constants::default() })),
        ("one colour", constant(Constants { colour: Some([0.1, 0.2, 0.3]), ..Constants::default() })),
        ("one transparency", constant(Constants { transparency: Some(0.25), ..Constants::default() })),
        ("everything", a),
    ];
    each.map(|(name, attributes)| (name, Hair { strands: whole.strands.clone(), attributes })).into()
}

#[test]
fn a_format_says_what_it_cannot_hold_and_holds_the_rest() {
    for (name, groom) in grooms() {
        for format in FORMATS {
            let lost = losses(format, &groom);
            let same = spelled_out(&through(format, &groom)) == spelled_out(&groom);
            assert_eq!(lost.is_empty(), same, "{name} in .{format}: {lost:?}");
        }
    }
}

#[test]
fn every_pair_of_formats_keeps_what_both_hold() {
    for (name, groom) in grooms() {
        for first in FORMATS {
            let once = through(first, &groom);
            for second in FORMATS {
                let twice = spelled_out(&through(second, &once));
                // What the second makes of hair is the same whether it came through the first, but for the first's
                // losses; and the first makes no more of what the second gives back.
                let alone = spelled_out(&through(second, &groom));
                assert_eq!(twice.strands, groom.strands, "{name}: .{first} to .{second}");
                if losses(first, &groom).is_empty() {
                    assert_eq!(twice, alone, "{name}: .{first} to .{second}");
                }
                let back = spelled_out(&through(first, &twice));
                if losses(first, &groom).is_empty() && losses(second, &groom).is_empty() {
                    assert_eq!(back, spelled_out(&groom), "{name}: .{first} to .{second} and back");
                }
            }
        }
    }
}

#[test]
fn strands_of_many_lengths_go_through_every_pair_but_tfx() {
    let groom = samples::hair(&[3, 2, 7, 4]);
    for first in FORMATS.into_iter().filter(|f| *f != "tfx") {
        for second in FORMATS.into_iter().filter(|f| *f != "tfx") {
            let there = through(second, &through(first, &groom));
            assert_eq!(there.strands, groom.strands, "{first} to {second}");
            assert_eq!(there.attributes.width, groom.attributes.width, "{first} to {second}");
        }
    }
}

#[test]
fn polylines_of_an_obj_go_into_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines.obj");
    std::fs::write(&path, "v 0 0 0\nv 0 1e-7 0.1\nv 3 0.5 0\nv 1 0.5 -2.25\nl 1 2 3\nl 4 3 2\n").unwrap();
    let groom = hair::read(&path).unwrap();
    for format in FORMATS {
        assert_eq!(through(format, &groom).strands, groom.strands, "{format}");
    }
    let refused = hair::write(&path, &groom).unwrap_err().to_string();
    assert!(refused.ends_with("cannot write hair as .obj: write .hair, .tfx, .usd, .usda, .usdc or .abc"), "{refused}");
}

#[test]
fn strands_of_one_point_are_no_curves() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hair.usda");
    let refused = hair::write(&path, &samples::hair(&[3, 1])).unwrap_err().to_string();
    assert!(refused.ends_with("strand 1 has 1 points: a curve needs at least two; leave it out"), "{refused}");
}

#[test]
fn no_file_is_smaller_than_it_is_said_to_be_at_least() {
    let folder = tempfile::tempdir().unwrap();
    for (name, groom) in grooms() {
        for format in FORMATS.into_iter().filter(|f| *f != "nabiki") {
            let path = folder.path().join("hair").with_extension(format);
            write(&path, &groom);
            let (bytes, least) = (std::fs::metadata(&path).unwrap().len(), hair::least_bytes(&path, &groom).unwrap());
            assert!(least <= bytes, "{name} in .{format}: {bytes} bytes, {least} at least");
            // A text of a digit a number is the shortest that points can be.
            assert!(least >= 11 * groom.strands.points().len() as u64, "{name} in .{format}: {least}");
        }
    }
    // Of moving text each frame is as long as the first: points of as many digits, and velocities of none.
    let groom = samples::hair(&[40; 40]);
    let path = folder.path().join("moving.usda");
    let mut export = exchange::still(&groom, exchange::DeclaredSpace::default());
    (export.velocities, export.rest) = (true, true);
    let least = exchange::least_bytes(&path, &export, 5, false);
    let mut sink = moving::sink(&path, export, None, ChainOptions::default()).unwrap();
    for _ in 0..5 {
        sink.frame(&groom.strands, &glam::DAffine3::IDENTITY).unwrap();
    }
    sink.finish().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let (_, samples) = text.split_once("points.timeSamples = {\n").unwrap();
    let frame = samples.lines().next().unwrap().trim().trim_start_matches("0: [").trim_end_matches("],");
    assert!(least <= text.len() as u64 && least >= 5 * frame.len() as u64, "{} bytes, {least} at least", text.len());
}
