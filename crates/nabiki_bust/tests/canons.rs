//! The canons of proportion that draughtsmen keep to, measured on the sculpted function itself. Adults miss them by about a tenth
//! either way (Farkas et al., 1985), which is what each is held to unless it says otherwise.

use std::sync::LazyLock;

use glam::{Vec2, Vec3, vec2, vec3};
use nabiki_bust::field;
use nabiki_groom::{Hairline, face};

/// The first skin from `start` on.
fn skin(start: Vec3, toward: Vec3) -> Option<Vec3> {
    let mut p = start;
    for _ in 0..4000 {
        let away = field(p);
        if away < 0.001 {
            return Some(p);
        }
        p += (0.4 * away).clamp(0.001, 1.0) * toward;
        if p.distance_squared(start) > 3600.0 {
            break;
        }
    }
    None
}

/// How far forward the face reaches, seen from before it.
fn front(y: f32, z: f32) -> f32 {
    skin(vec3(20.0, y, z), Vec3::NEG_X).expect("the face is there").x
}

/// Numbers from `low` to `high`, 0.01 apart.
fn between(low: f32, high: f32) -> impl DoubleEndedIterator<Item = f32> {
    (0..=((high - low) * 100.0) as usize).map(move |i| low + 0.01 * i as f32)
}

/// What of the profile reaches farthest forward between two heights.
fn foremost(low: f32, high: f32) -> Vec2 {
    between(low, high).map(|y| vec2(front(y, 0.0), y)).max_by(|a, b| a.x.total_cmp(&b.x)).unwrap()
}

/// And what least far.
fn hindmost(low: f32, high: f32) -> Vec2 {
    between(low, high).map(|y| vec2(front(y, 0.0), y)).min_by(|a, b| a.x.total_cmp(&b.x)).unwrap()
}

/// What of the profile between two of its points lies deepest behind the line from one to the other.
fn deepest(low: Vec2, high: Vec2) -> Vec2 {
    let places = between(low.y, high.y).map(|y| vec2(front(y, 0.0), y));
    let behind = |p: &Vec2| (high - low).perp_dot(*p - low);
    places.max_by(|a, b| behind(a).total_cmp(&behind(b))).unwrap()
}

/// Points of the profile (x, y), from above.
struct Profile {
    hairline: f32,
    brow: f32,
    tip_of_nose: Vec2,
    base_of_nose: Vec2,
    upper_lip: Vec2,
    between_lips: Vec2,
    lower_lip: Vec2,
    above_chin: Vec2,
    chin: Vec2,
    lowest: f32,
}

static PROFILE: LazyLock<Profile> = LazyLock::new(|| {
    let tip_of_nose = foremost(-5.5, -3.0);
    let between_lips = hindmost(-7.5, -6.6);
    let upper_lip = foremost(between_lips.y, -5.8);
    let lower_lip = foremost(-8.3, between_lips.y);
    let above_chin = hindmost(-9.6, lower_lip.y);
    let beneath = (50..90).filter_map(|x| skin(vec3(0.1 * x as f32, -18.0, 0.0), Vec3::Y));
    Profile {
        // Measured from the top of the head's ellipsoid, in the mean of its horizontal half axes.
        hairline: 11.0 - 8.65 * Hairline::default().forehead,
        brow: face::brow_line(0.0),
        base_of_nose: deepest(upper_lip, tip_of_nose),
        chin: foremost(-11.0, above_chin.y),
        lowest: beneath.map(|p| p.y).fold(0.0, f32::min),
        tip_of_nose,
        upper_lip,
        between_lips,
        lower_lip,
        above_chin,
    }
});

fn is_about(measured: f32, canon: f32, share: f32, what: &str) {
    assert!((measured / canon - 1.0).abs() < share, "{what}: {measured} for {canon}");
}

#[test]
fn the_face_has_three_even_thirds() {
    let p = &*PROFILE;
    let thirds = [p.hairline - p.brow, p.brow - p.base_of_nose.y, p.base_of_nose.y - p.lowest];
    let mean = thirds.iter().sum::<f32>() / 3.0;
    for third in thirds {
        is_about(third, mean, 0.1, "a third of the face");
    }
}

#[test]
fn the_mouth_is_a_third_of_the_way_from_nose_to_chin() {
    let p = &*PROFILE;
    let lower_third = p.base_of_nose.y - p.lowest;
    is_about(p.base_of_nose.y - p.between_lips.y, lower_third / 3.0, 0.1, "nose to mouth");
    // The hollow above the chin halves what is left.
    is_about(p.base_of_nose.y - p.above_chin.y, 0.6 * lower_third, 0.1, "nose to the hollow above the chin");
}

#[test]
fn eyes_are_at_half_the_height_of_the_head() {
    let crown = skin(vec3(0.0, 30.0, 0.0), Vec3::NEG_Y).unwrap().y;
    is_about(crown - face::PUPIL[0], 0.5 * (crown - PROFILE.lowest), 0.1, "crown to eyes");
}

/// By how much the lips draw back where they meet, so far from the middle.
fn parted(z: f32) -> f32 {
    let line = face::lip_parting(z, face::along_lips(z));
    let [above, on, below] = [0.2, 0.0, -0.2].map(|off| front(line + off, z));
    0.5 * (above + below) - on
}

#[test]
fn the_mouth_is_as_wide_as_the_pupils_are_apart_and_its_corners_are_in() {
    let corner = between(0.0, 4.0).take_while(|&z| parted(z) > 0.01).last().unwrap();
    is_about(2.0 * corner, 2.0 * face::PUPIL[1], 0.1, "the mouth's width");
    is_about(corner, 2.9, 0.05, "where the paint of the lips ends");
    // Lips lie on the arch of the teeth, so that their corners are far behind their middle.
    let middle = PROFILE.between_lips;
    let line = |z: f32| face::lip_parting(z, face::along_lips(z));
    assert!(front(middle.y, 0.0) - front(line(corner), corner) > 1.0, "the mouth is flat");
    let about = 0.5 * (front(line(corner) + 0.7, corner) + front(line(corner) - 0.7, corner));
    assert!(front(line(corner), corner) < about - 0.03, "the corners are not drawn in");
}

#[test]
fn the_lips_are_closed_and_at_rest() {
    let p = &*PROFILE;
    for z in [0.0, 0.5, 1.0, 1.5, 2.0, 2.5] {
        // Nothing shows between them, neither do they press on one another.
        let depth = parted(z);
        assert!((0.02..0.35).contains(&depth), "they are parted by {depth} at {z}");
    }
    // From the tip of the nose to the chin goes a line that they do not reach past (Ricketts, 1968: 0.4 cm behind it, 0.3 more or
    // less).
    let along = p.chin - p.tip_of_nose;
    for lip in [p.upper_lip, p.lower_lip] {
        let behind = (lip - p.tip_of_nose).perp_dot(along) / along.length();
        assert!((0.0..0.8).contains(&behind), "{behind} cm behind the line");
    }
    // The lower lip is the fuller one.
    let [upper, lower] = face::lip_edges(0.0, 0.0);
    let fuller = (p.between_lips.y - lower) / (upper - p.between_lips.y);
    assert!((1.0..1.7).contains(&fuller), "{fuller}");
}

#[test]
fn eyes_are_an_eye_apart_and_the_face_is_five_eyes_wide() {
    // The lids stand out from the eyeball along the lines that lashes are painted along, to near the corners.
    for t in [-0.8, -0.4, 0.0, 0.4, 0.8] {
        let z = (0..1000).map(|i| 0.01 * i as f32).find(|&z| face::along_lids(z) >= t).unwrap();
        for (edge, out) in face::lid_edges(t).into_iter().zip([1.0, -1.0]) {
            let lid = front(edge + 0.08 * out, z) - front(edge - 0.08 * out, z);
            assert!(lid > 0.03, "the lid stands out {lid} at {t}");
        }
    }
    let at = |t: f32| between(0.0, 8.0).find(|&z| face::along_lids(z) >= t).unwrap();
    let (inner, outer) = (at(-1.0), at(1.0));
    is_about(2.0 * inner, outer - inner, 0.1, "between the eyes");
    is_about(0.5 * (inner + outer), face::PUPIL[1], 0.05, "the pupil in its eye");
    // The face alone: before the ears.
    let side = |y: f32| {
        let before_ears = (15..60).filter_map(|x| skin(vec3(0.1 * x as f32, y, 20.0), Vec3::NEG_Z));
        before_ears.map(|p| p.z).fold(0.0, f32::max)
    };
    is_about(2.0 * side(face::PUPIL[0]), 5.0 * (outer - inner), 0.1, "the face's width");
    // A wing ends where it no longer falls off at 45 degrees.
    let fall = |z: f32| front(-4.7, z - 0.05) - front(-4.7, z + 0.05);
    let nose = between(0.8, 2.6).rfind(|&z| fall(z) > 0.1).unwrap();
    is_about(2.0 * nose, 2.0 * inner, 0.1, "the wings of the nose, from one eye to the other");
}

#[test]
fn ears_go_from_the_brow_to_the_base_of_the_nose() {
    let outermost = |y: f32| {
        let places = (-60..20).filter_map(|x| skin(vec3(0.1 * x as f32, y, 20.0), Vec3::NEG_Z));
        places.max_by(|a, b| a.z.total_cmp(&b.z)).unwrap()
    };
    // Where more than the rounding of its edge stands out from the head beside it.
    let stands_out = |y: f32| outermost(y).z - skin(vec3(2.0, y, 20.0), Vec3::NEG_Z).unwrap().z > 0.5;
    let heights: Vec<f32> = between(-8.0, 4.0).filter(|&y| stands_out(y)).collect();
    let (low, high) = (heights[0], heights[heights.len() - 1]);
    let top_of_brow = between(0.0, 1.0).map(face::brow_line).fold(0.0, f32::max);
    let length = top_of_brow - PROFILE.base_of_nose.y;
    is_about(high - low, length, 0.1, "the ear's length");
    assert!((high - top_of_brow).abs() < 0.1 * length, "its top at {high}, the brow at {top_of_brow}");
}

#[test]
fn ears_stand_off_the_head() {
    // The rim at the back, and the skin before the ear, along one height.
    let from_side = |x: f32| skin(vec3(x, -1.2, 20.0), Vec3::NEG_Z).unwrap();
    let rim = between(-5.0, -2.0).map(from_side).max_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    let before = from_side(1.0);
    let degrees = (rim.z - before.z).atan2(before.x - rim.x).to_degrees();
    assert!((14.0..26.0).contains(&degrees), "{degrees} degrees");
    // Between rim and head one can put a finger, and the hollow of the ear is as deep.
    let behind = skin(vec3(rim.x - 1.0, -1.2, 20.0), Vec3::NEG_Z).unwrap();
    assert!(rim.z - behind.z > 0.8, "{}", rim.z - behind.z);
    let hollow = between(-2.5, 0.0).map(from_side).map(|p| p.z).fold(f32::INFINITY, f32::min);
    assert!(rim.z - hollow > 0.6, "{}", rim.z - hollow);
}
