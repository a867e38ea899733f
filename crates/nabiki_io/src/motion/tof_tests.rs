use std::f64::consts::FRAC_PI_2;

use super::*;

/// A neck and a head, with a shape of another class before them.
pub(in super::super) const TOF_SKELETON: &str = "TOS 1.00\n\ndeclare Other 2\n  mShape pointer Skeleton \n  mRows array \
    array float\n\ndeclare Skeleton 1\n  mJoints array instance Skeleton::Joint \n\ndeclare Skeleton::Joint 2\n  mName \
    string\n  mParentName string\n\nobject Other 00000001\n  00000002\n  1\n  2\n  0.5 0.25\n\nobject Skeleton 00000002\n  \
    2\n      \"Head\"\n      \"The \\\"Neck\\\"\"\n      \"The \\\"Neck\\\"\"\n      \"\"\n";

/// The neck has keys at 0 and 2 s, the head at 0, 1 and 2 s.
pub(in super::super) const TOF: &str = "TOS 1.00\n\ndeclare SkeletalAnimation 2\n  mAnimatedJoints array instance \
    SkeletalAnimation::AnimatedJoint \n  mIsLooping bool\n\ndeclare SkeletalAnimation::AnimatedJoint 2\n  mJointName \
    string\n  mKeyframes array instance SkeletalAnimation::Keyframe \n\ndeclare SkeletalAnimation::Keyframe 3\n  \
    mRotation quat\n  mTranslation vec3\n  mTime float\n\nobject SkeletalAnimation 00000001\n  2\n      \"The \
    \\\"Neck\\\"\"\n      2\n          0 0 0 1\n          0 1 0\n          0\n          0 0 1 0\n          4 1 0\n          \
    2\n      \"Head\"\n      3\n          0 0 0 1\n          0 1 0\n          0\n          0 0.70710678 0 \
    0.70710678\n          0 1 0\n          1\n          0 1 0 0\n          0 1 0\n          2\n  true\n";

fn read_track(skeleton_text: &str, text: &str, node: &str) -> Result<Track> {
    track(&chain(&skeleton(skeleton_text)?, node)?, &animation(text)?)
}

#[test]
fn joints_are_carried_by_their_parents_between_whose_keys_they_stand() {
    let track = read_track(TOF_SKELETON, TOF, "head").unwrap();
    assert_eq!(track.times, [0.0, 1.0, 2.0]);
    // The neck has no key at 1 s: half way on its line, and half of its turn about z.
    for (n, sample) in track.samples.iter().enumerate() {
        let neck = DQuat::from_rotation_z(FRAC_PI_2 * n as f64);
        let expected = DVec3::new(2.0 * n as f64, 1.0, 0.0) + neck * DVec3::Y;
        assert!(sample.position.distance(expected) < 1e-14, "{n}: {sample:?}");
        let expected = neck * DQuat::from_rotation_y(FRAC_PI_2 * n as f64);
        assert!(sample.rotation.dot(expected).abs() > 1.0 - 1e-14, "{n}: {sample:?}");
    }
    assert_eq!(extent(&animation(TOF).unwrap()), (2.0, 3));
}

#[test]
fn a_motion_lasts_from_its_first_key_to_its_last_of_the_joint_that_has_most() {
    let joint = |times: &[f64]| AnimatedJoint {
        name: String::new(),
        keys: times.iter().map(|&time| Key { time, position: DVec3::ZERO, rotation: DQuat::IDENTITY }).collect(),
    };
    assert_eq!(extent(&[joint(&[0.0]), joint(&[1.0, 2.0, 3.5]), joint(&[0.0, 9.0])]), (2.5, 3));
    assert_eq!(extent(&[]), (0.0, 0));
}

#[test]
fn what_is_missing_or_does_not_fit_is_said_in_one_line() {
    let refused = |from: &str, to: &str| {
        assert!(TOF_SKELETON.contains(from) || TOF.contains(from), "{from}");
        read_track(&TOF_SKELETON.replace(from, to), &TOF.replace(from, to), "Head").unwrap_err().to_string()
    };
    for (from, to, said) in [
        ("TOS 1.00", "TOB 1.00", "does not start with TOS"),
        ("TOS 1.00", "TOS 2.00", "version 2.00: only text object streams of version 1 are read"),
        ("object SkeletalAnimation", "object Walk", "holds no SkeletalAnimation, only Walk: is this the right file?"),
        ("object Skeleton 0", "object Bones 0", "holds no Skeleton, only Other, Bones: is this the right file?"),
        ("mTranslation vec3", "mTranslation dvec3", "Keyframe is not declared as mRotation quat, mTranslation vec3"),
        ("mParentName string", "mParent int", "Skeleton::Joint is not declared as mName string, mParentName string"),
        ("mAnimatedJoints array", "mJoints array", "SkeletalAnimation does not begin with mAnimatedJoints"),
        ("  2\n      \"Head\"", "  3\n      \"Head\"", "ends before a joint's name: is it complete?"),
        ("  2\n      \"Head\"", "  -1\n      \"Head\"", "\"-1\": the number of joints expected here"),
        ("      3\n", "      4000000000\n", "joint Head: \"true\": a key must be a finite number"),
        ("      3\n", "      0\n", "joint Head: has no keys"),
        ("0 1 0 0\n", "0 2 0 0\n", "joint Head: time 2 s: quaternion of length 2, but only 1 is a rotation"),
        ("0 1 0 0\n", "0 nan 0 0\n", "joint Head: \"nan\": a key must be a finite number"),
        ("          1\n", "          0\n", "joint Head: time 0 s: times must increase"),
        ("      \"\"\n", "      \"Spine\"\n", "joint The \"Neck\": its parent Spine is not in the skeleton"),
        ("      \"\"\n", "      \"Head\"\n", "a joint is its own ancestor"),
        ("      2\n          0 0 0 1", "      0\n          0 0 0 1", "expected here"),
        (
            "\"Head\"\n      3",
            "\"Hat\"\n      3",
            "joint Head: has no keys: does the animation belong to the skeleton?",
        ),
    ] {
        let found = refused(from, to);
        assert!(found.contains(said), "{from:?} -> {to:?}: {found}");
    }
    let unknown = read_track(TOF_SKELETON, TOF, "Haed").unwrap_err().to_string();
    assert_eq!(unknown, "no joint \"Haed\": node can be Head, The \"Neck\"");
}
