//! Which frames a layer has, at what rate, and what holds at each.

use std::io::Cursor;

use glam::{DVec3, Vec3};
use nabiki::hair::{Per, Values};
use nabiki_exchange::GroomReader;
use nabiki_usd::StageReader;

/// A layer that says `head` of itself.
fn reader(head: &str, text: &str) -> StageReader {
    StageReader::new(Cursor::new(format!("#usda 1.0\n( {head} )\n{text}").into_bytes())).unwrap()
}

/// A curve whose tip has x at time codes, with something else said of it.
fn curve(name: &str, samples: &[(f64, f32)], more: &str) -> String {
    let samples: Vec<String> = samples.iter().map(|(code, x)| format!("{code}: [(0, 0, 0), ({x}, 0, 0)]")).collect();
    format!(
        "def BasisCurves \"{name}\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
         point3f[] points.timeSamples = {{ {} }}\n{more} }}\n",
        samples.join(", ")
    )
}

/// x of the tip in frames that there are, and in one after them.
fn tips(stage: &mut StageReader) -> Vec<f32> {
    let frames = stage.contents().unwrap().times.len();
    (0..=frames).map(|frame| stage.hair(frame, None).unwrap().strands.strand(0)[1].x).collect()
}

#[test]
fn codes_are_told_from_frames_where_a_layer_says_both() {
    let both = "framesPerSecond = 24\n timeCodesPerSecond = 48";
    // Samples at every second code are the frames; those farther apart, or closer, give way to them.
    for (samples, expected) in [
        (&[(96.0, 1.0), (98.0, 3.0), (100.0, 5.0)][..], &[1.0, 3.0, 5.0, 5.0][..]),
        (&[(96.0, 1.0), (100.0, 5.0)], &[1.0, 3.0, 5.0, 5.0]),
        (&[(96.0, 1.0), (97.0, 2.0), (98.0, 3.0)], &[1.0, 3.0, 3.0]),
    ] {
        let mut stage = reader(both, &curve("h", samples, ""));
        let contents = stage.contents().unwrap();
        assert_eq!((contents.frame_rate, contents.start), (24.0, Some(2.0)));
        let times: Vec<f64> = (0..expected.len() - 1).map(|n| 2.0 + n as f64 / 24.0).collect();
        assert_eq!((contents.times, tips(&mut stage)), (times, expected.to_vec()));
    }
    let motion = reader(
        both,
        "def Xform \"a\" { double xformOp:translateX.timeSamples = { 0: 0, 48: 5 }\n\
                               uniform token[] xformOpOrder = [\"xformOp:translateX\"] }\n",
    );
    let last = { motion }.motion("a").unwrap().pop().unwrap();
    assert_eq!((last.time, last.position), (1.0, DVec3::X * 5.0));
}

/// Samples of a tip that goes a unit a time code, at these codes.
fn even(codes: &[f64]) -> String {
    curve("h", &codes.iter().map(|&code| (code, code as f32)).collect::<Vec<_>>(), "")
}

#[test]
fn samples_within_a_frame_are_of_its_shutter_whatever_their_spacing() {
    let every = |step: f64, n: i32| (0..n).map(|i| 1001.0 + f64::from(i) * step).collect::<Vec<_>>();
    for (head, codes, rate, frames, between) in [
        ("timeCodesPerSecond = 24", every(0.5, 9), 24.0, &[1001.0, 1002.0, 1003.0, 1004.0, 1005.0][..], 4),
        ("", every(0.25, 5), 24.0, &[1001.0, 1002.0], 3),
        ("timeCodesPerSecond = 24\n framesPerSecond = 24", every(0.4, 6), 24.0, &[1001.0, 1002.0, 1003.0], 4),
        ("timeCodesPerSecond = 30", vec![1000.75, 1001.25, 1001.75, 1002.25], 30.0, &[1001.0, 1002.0], 4),
        // Poses of which the layer says that they are frames.
        ("timeCodesPerSecond = 24\n framesPerSecond = 48", every(0.5, 4), 48.0, &[1001.0, 1001.5, 1002.0, 1002.5], 0),
        ("timeCodesPerSecond = 48", every(1.0, 3), 48.0, &[1001.0, 1002.0, 1003.0], 0),
        // Codes that are seconds, of which nothing says how many frames they have.
        ("timeCodesPerSecond = 1", every(0.125, 4), 8.0, &[1001.0, 1001.125, 1001.25, 1001.375], 0),
    ] {
        let mut stage = reader(head, &even(&codes));
        let contents = stage.contents().unwrap();
        assert_eq!((contents.frame_rate, contents.times.len()), (rate, frames.len()), "{head} {codes:?}");
        let mut expected: Vec<f32> = frames.iter().map(|&code| code as f32).collect();
        expected.extend(expected.last().copied());
        assert_eq!(tips(&mut stage), expected, "{head} {codes:?}");
        let said = (between > 0).then(|| format!("{between} samples between frames, at {rate} frames a second"));
        assert_eq!(stage.hair(0, None).unwrap().attributes.unread, Vec::from_iter(said), "{head} {codes:?}");
    }
}

#[test]
fn the_samples_of_one_shutter_are_one_frame() {
    for (head, codes, frame, between) in [
        ("startTimeCode = 1004\n endTimeCode = 1004", &[1003.5, 1004.0][..], 1004.0, "1 sample"),
        ("", &[0.75, 1.25], 1.0, "2 samples"),
        ("", &[1.0, 1.5], 1.0, "1 sample"),
        ("", &[7.75, 8.0, 8.25], 8.0, "2 samples"),
        // The shutter is open all the time, and the layer has one frame.
        ("startTimeCode = 5\n endTimeCode = 5", &[4.0, 5.0], 5.0, "1 sample"),
        ("startTimeCode = 5\n endTimeCode = 5", &[4.5, 5.5], 5.0, "2 samples"),
    ] {
        let mut stage = reader(head, &even(codes));
        let contents = stage.contents().unwrap();
        assert_eq!((contents.times, contents.start), (vec![frame / 24.0], Some(frame / 24.0)), "{head} {codes:?}");
        assert_eq!(tips(&mut stage), [frame as f32; 2], "{head} {codes:?}");
        let said = format!("{between} between frames, at 24 frames a second");
        assert_eq!(stage.hair(0, None).unwrap().attributes.unread, [said], "{head} {codes:?}");
    }
}

#[test]
fn frames_a_second_are_codes_where_nothing_else_is_said_and_24_where_codes_are_too_dense() {
    let two = |step: f64| curve("h", &[(0.0, 0.0), (2.0 * step, 2.0)], "");
    for (head, step, rate) in [
        ("framesPerSecond = 30", 1.0, 30.0),
        ("timeCodesPerSecond = 60", 1.0, 60.0),
        ("", 1.0, 24.0),
        // Of 6000 codes a second, 250 make a frame.
        ("timeCodesPerSecond = 6000", 250.0, 24.0),
        ("timeCodesPerSecond = 6000\n framesPerSecond = 25", 240.0, 25.0),
    ] {
        let mut stage = reader(head, &two(step));
        let contents = stage.contents().unwrap();
        let times: Vec<f64> = (0..3).map(|n| f64::from(n) / rate).collect();
        assert_eq!((contents.times, contents.frame_rate), (times, rate), "{head}");
        assert_eq!(tips(&mut stage), [0.0, 1.0, 2.0, 2.0], "{head}");
    }
}

#[test]
fn the_curves_with_the_most_samples_give_the_frames_wherever_they_stand() {
    let moving = curve("moving", &[(1.0, 1.0), (2.0, 2.0), (3.0, 3.0)], "");
    let still = curve("still", &[(2.0, 7.0)], "");
    for text in [format!("{moving}{still}"), format!("{still}{moving}")] {
        let mut stage = reader("", &text);
        assert_eq!(stage.contents().unwrap().times, [1.0, 2.0, 3.0].map(|code| code / 24.0));
        let hair = stage.hair(2, None).unwrap();
        let mut tips: Vec<f32> = hair.strands.iter().map(|strand| strand[1].x).collect();
        tips.sort_by(f32::total_cmp);
        assert_eq!(tips, [3.0, 7.0]);
    }
}

#[test]
fn samples_may_stand_in_any_order() {
    let mut stage = reader("", &curve("h", &[(3.0, 30.0), (1.0, 10.0), (2.0, 20.0)], ""));
    assert_eq!(tips(&mut stage), [10.0, 20.0, 30.0, 30.0]);
}

#[test]
fn hair_that_stands_still_begins_where_the_layer_says() {
    let still = curve("h", &[(7.0, 1.0)], "");
    let start = |head: &str| reader(head, &still).contents().unwrap().start;
    assert_eq!(start("startTimeCode = 1001\n timeCodesPerSecond = 48"), Some(1001.0 / 48.0));
    assert_eq!(start("timeCodesPerSecond = 48"), None);
}

#[test]
fn attributes_are_those_of_the_frame_before_which_they_were_set() {
    let more = "float[] primvars:widths.timeSamples = { 0: [1, 1], 5: [2, 2], 6: [3, 3] } ( interpolation = \"vertex\" )\n\
                float[] primvars:stiff.timeSamples = { 4.5: [0.25], 5.5: [0.5] } ( interpolation = \"uniform\" )";
    let mut stage = reader("", &curve("h", &[(5.0, 1.0), (6.0, 2.0), (7.0, 3.0)], more));
    for (frame, width, stiff) in [(0, 2.0, 0.25), (1, 3.0, 0.5), (2, 3.0, 0.5)] {
        let at = stage.hair(frame, None).unwrap().attributes;
        assert_eq!(at.width, Some(vec![width; 2]), "frame {frame}");
        let own = at.other.iter().find(|other| other.name == "stiff").unwrap();
        assert_eq!((own.per, &own.values), (Per::Strand, &Values::Floats(vec![stiff])), "frame {frame}");
        let said = |name: &str| format!("motion of primvars:{name}: its value in frame {frame} is kept");
        assert_eq!(at.unread, [said("stiff"), said("widths")]);
    }
}

#[test]
fn values_lie_where_the_layer_says_and_go_along_the_curves_as_their_points_do() {
    // Of two curves, one of whose values is constant: as many as there are curves, and no curve has one of them.
    let mut stage = reader(
        "",
        "def BasisCurves \"h\" { uniform token type = \"cubic\"\n uniform token basis = \"bspline\"\n\
         uniform token wrap = \"pinned\"\n int[] curveVertexCounts = [4, 5]\n\
         point3f[] points = [(0, 0, 0), (0, 0, 1), (0, 0, 2), (0, 0, 3), (1, 0, 0), (1, 0, 1), (1, 0, 2), (1, 0, 3), (1, 0, 4)]\n\
         float[] primvars:range = [0.5, 2] ( interpolation = \"constant\" )\n\
         float[] primvars:each = [0.5, 2] ( interpolation = \"uniform\" )\n\
         vector3f[] primvars:comb = [(0, 0, 0), (0, 1, 2), (0, 2, 4), (0, 3, 6), (1, 0, 0), (1, 1, 2), (1, 2, 4), \
         (1, 3, 6), (1, 4, 8)] ( interpolation = \"vertex\" )\n\
         float[] primvars:widths = [0, 1, 2, 3, 0, 10, 20, 30, 40] ( interpolation = \"varying\" ) }\n",
    );
    let hair = stage.hair(0, Some(8)).unwrap();
    let own = |name: &str| hair.attributes.other.iter().find(|other| other.name == name).unwrap();
    assert_eq!((own("range").per, own("each").per), (Per::Groom, Per::Strand));
    assert_eq!(own("comb").per, Per::Point);
    let Values::Floats(comb) = &own("comb").values else { panic!("floats") };
    for (p, place) in hair.strands.points().iter().enumerate() {
        // x of a curve, y along it, and twice that.
        let found = Vec3::from_slice(&comb[3 * p..]);
        assert!(found.distance(Vec3::new(place.x, place.z, 2.0 * place.z)) < 1e-5, "{found} at {place}");
        let width = hair.attributes.width.as_ref().unwrap()[p];
        let expected = if place.x == 0.0 { place.z } else { 10.0 * place.z };
        assert!((width - expected).abs() < 1e-4, "{width} at {place}");
    }
}
