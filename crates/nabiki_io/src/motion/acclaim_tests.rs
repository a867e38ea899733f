use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use super::*;

/// A neck of 2 units, bent forward by 45 degrees in the rest pose, and a head of 1 unit on it.
pub(in super::super) const ASF: &str = "# a comment\n:version 1.10\n:name Small\n:units\n  mass 1.0\n  length 0.5\n  \
    angle deg\n:documentation\n begin anything\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 0 0 0\n \
    orientation 0 0 0\n:bonedata\n begin\n  id 1\n  name Neck\n  direction 0 0.7071067811865476 0.7071067811865476\n  \
    length 2\n  axis 45 0 0 XYZ\n  dof rx ry rz\n  limits (-20.0 45.0)\n         (-30.0 30.0)\n         (-30.0 30.0)\n \
    end\n begin\n  id 2\n  name Head\n  direction 0 1 0\n  length 1\n  axis 0 0 0 XYZ\n end\n:hierarchy\n begin\n  root \
    Neck\n  Neck Head\n end\n";

pub(in super::super) const AMC: &str = "#!OML:ASF small.asf\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\n\
    Neck 0 0 0\n2\nroot 1 2 3 0 0 90\nNeck 0 90 0\n";

fn read_track(asf: &str, amc: &str, node: &str, rate: Option<f64>) -> Result<Track> {
    let skeleton = Skeleton::read(asf)?;
    skeleton.track(&skeleton.chain(node)?, amc, rate)
}

#[test]
fn bones_start_where_their_parents_end_and_turn_in_their_own_axes() {
    let track = read_track(ASF, AMC, "head", Some(60.0)).unwrap();
    assert_eq!((track.times.as_slice(), track.unit_cm), (&[0.0, 1.0 / 60.0][..], Some(2.54 / 0.5)));
    let neck = DVec3::new(0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2) * 2.0;
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-14, "{a} {b}");
    near(track.samples[0].position, DVec3::new(1.0, 2.0, 3.0) + neck);
    assert!(track.samples[0].rotation.angle_between(DQuat::IDENTITY) < 1e-7, "the rest pose is unturned");
    // About the neck's own y, which lies along the neck: the head stays above it and turns about that.
    let root = DQuat::from_rotation_z(FRAC_PI_2);
    near(track.samples[1].position, DVec3::new(1.0, 2.0, 3.0) + root * neck);
    let expected = root * DQuat::from_axis_angle(neck / 2.0, FRAC_PI_2);
    assert!((track.samples[1].rotation.dot(expected).abs() - 1.0).abs() < 1e-14, "{:?}", track.samples[1]);
}

#[test]
fn the_first_angle_listed_turns_first() {
    let amc = "1\nroot 0 0 0 90 90 0\nNeck 0 0 0\n";
    let rotation = |asf: &str| read_track(asf, amc, "root", Some(1.0)).unwrap().samples[0].rotation;
    let (x, y) = (DQuat::from_rotation_x(FRAC_PI_2), DQuat::from_rotation_y(FRAC_PI_2));
    assert!((rotation(ASF).dot(y * x).abs() - 1.0).abs() < 1e-14);
    let swapped = ASF.replace("RX RY RZ", "RY RX RZ");
    assert!((rotation(&swapped).dot(x * y).abs() - 1.0).abs() < 1e-14);
}

#[test]
fn the_axes_of_a_bone_turn_about_the_first_letter_first() {
    let amc = "1\nroot 0 0 0 0 0 0\nNeck 90 0 0\n";
    for (axis, about) in [
        // About x, which leaves x, then about y, which takes it to -z.
        ("90 90 0 XYZ", DVec3::NEG_Z),
        // About y, which takes x to -z, then about x, which takes that to y.
        ("90 90 0 YXZ", DVec3::Y),
        // About z, which takes x to y, then about x, which takes that to z.
        ("90 90 0 ZXY", DVec3::Z),
    ] {
        let asf = ASF.replace("axis 45 0 0 XYZ", &format!("axis {axis}"));
        let found = read_track(&asf, amc, "Neck", Some(1.0)).unwrap().samples[0].rotation;
        let expected = DQuat::from_axis_angle(about, FRAC_PI_2);
        assert!(found.dot(expected).abs() > 1.0 - 1e-14, "{axis}: {found}");
    }
}

#[test]
fn a_skeleton_in_radians_has_its_axes_in_radians() {
    let in_degrees = read_track(ASF, AMC, "head", Some(60.0)).unwrap();
    let asf = ASF.replace("angle deg", "angle rad").replace("axis 45 0 0", &format!("axis {} 0 0", FRAC_PI_2 / 2.0));
    assert_eq!(read_track(&asf, AMC, "head", Some(60.0)).unwrap(), in_degrees);
    // A motion that says nothing has the angles of its skeleton.
    let amc = AMC.replace(":DEGREES\n", "").replace("90", &FRAC_PI_2.to_string());
    assert_eq!(read_track(&asf, &amc, "head", Some(60.0)).unwrap(), in_degrees);
}

#[test]
fn radians_are_read_as_such_and_a_rate_in_the_file_is_the_rate() {
    let in_degrees = read_track(ASF, AMC, "head", Some(60.0)).unwrap();
    let quarter = FRAC_PI_2.to_string();
    let amc = AMC.replace(":DEGREES", ":RADIANS\n:SAMPLES-PER-SECOND 60").replace("90", &quarter);
    assert_eq!(read_track(ASF, &amc, "head", None).unwrap(), in_degrees);
    let twice = read_track(ASF, &amc, "head", Some(60.0)).unwrap_err().to_string();
    assert!(twice.contains("remove frames_per_second"), "{twice}");
}

#[test]
fn what_is_missing_or_does_not_fit_is_said_in_one_line() {
    let refused = |from: &str, to: &str| {
        assert!(ASF.contains(from) || AMC.contains(from), "{from}");
        let (asf, amc) = (ASF.replace(from, to), AMC.replace(from, to));
        read_track(&asf, &amc, "head", Some(60.0)).unwrap_err().to_string()
    };
    for (from, to, said) in [
        ("angle deg", "", "axis: :units should say angle deg or rad first"),
        ("angle deg", "angle grad", "angle \"grad\": must be deg or rad"),
        ("length 0.5", "length -1", "length -1: must be above 0"),
        ("position 0 0 0", "position 0 9 0", "root position 0 9 0: programs disagree"),
        ("axis 45 0 0 XYZ", "axis 45 0 0 XYW", "axis order \"XYW\": must be three letters such as XYZ"),
        ("dof rx ry rz", "dof rx ry l", "\"l\": a root moves by tx..tz and rx..rz, a bone by rx, ry and rz"),
        ("dof rx ry rz", "dof tx ry rz", "dof tx, ty, tz: bones that leave their parents are not read"),
        ("length 2", "length two", "length \"two\": not a finite number"),
        ("name Head", "", "a bone without a name ends here"),
        ("name Head", "name neck", "bone neck: defined twice"),
        ("  Neck Head", "  Neck Hat", "\"Hat\": no bone of that name is in :bonedata"),
        ("  Neck Head\n", "", "bone head: :hierarchy does not connect it to the root"),
        ("  Neck Head\n", "  Neck Head\n  Head Neck\n", "bone Neck: has two parents"),
        ("  root Neck\n  Neck Head\n", "  Head Neck\n  Neck Head\n", "a bone is its own ancestor"),
        (":bonedata", ":bones", "\"Neck\": no bone of that name is in :bonedata"),
        (":bonedata\n", ":bonedata\n length 3\n", "\"length\": a bone begins with begin"),
        ("\nNeck 0 90 0", "", "bone Neck: has no numbers in this frame"),
        ("Neck 0 90 0", "Neck 0 90", "bone Neck: 2 numbers, but the skeleton gives it 3 degrees of freedom"),
        ("Neck 0 90 0", "Neck 0 90 inf", "Neck \"inf\": not a finite number"),
        ("Neck 0 90 0", "Tail 0 90 0", "bone Tail is not in the skeleton"),
        ("Neck 0 90 0", "Neck 0 90 0\nNeck 0 90 0", "bone Neck: occurs twice in one frame"),
        ("\n2\n", "\n3\n", "frame 3 follows frame 1: frames must have no gaps"),
        ("\n1\n", "\n", "\"root\": a frame's number expected here"),
    ] {
        let found = refused(from, to);
        assert!(found.contains(said), "{from:?} -> {to:?}: {found}");
    }
    let cut = Skeleton::read(&ASF[..ASF.find("name Head").unwrap()]).err().unwrap().to_string();
    assert_eq!(cut, "has no complete :bonedata: is it a complete Acclaim skeleton?");
    let error = |amc: &str, node: &str, rate| read_track(ASF, amc, node, rate).unwrap_err().to_string();
    assert_eq!(error(AMC, "Haed", None), "no bone \"Haed\": node can be root, Neck, Head");
    assert_eq!(
        error(AMC, "head", None),
        "frames_per_second is not in the file: give frames_per_second = 120 in the scene"
    );
    assert_eq!(error(AMC, "head", Some(-1.0)), "frames_per_second = -1: must be a finite number above 0");
    assert_eq!(error(":DEGREES\n", "head", Some(1.0)), "holds no frames: is it Acclaim motion?");
}
