//! The timeline against the fast stepper, whose frames it gives to the bit.

mod common;

use std::sync::Arc;

use common::*;
use glam::Vec3;
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{Dynamics, FrameInput, Simulation, Stepper, Timeline, VectorWidth};
use nabiki::field::{Field, FieldSum};
use nabiki::{Pose, Strands};

const FRAMES: u32 = 60;

/// A head that turns, a disturbance, a field that differs from place to place: all that a step may depend on.
fn dynamics() -> Dynamics {
    let disturbance = Some(Disturbance { from: 5, over: 4, ..Default::default() });
    Dynamics { disturbance, polar_axis: way_of_a_head(0)[0].up_in_head(), ..gust() }
}

fn everything() -> Arc<dyn Field> {
    Arc::new(FieldSum::new(vec![Arc::new(wind()), Arc::new(Whirl)]))
}

fn timeline(hair: &Strands) -> Timeline {
    Timeline::new(hair, &dynamics(), everything(), way_of_a_head(FRAMES), FRAMES).unwrap()
}

fn to_bits(points: &[Vec3]) -> Vec<[u32; 3]> {
    points.iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}

/// All frames, one step at a time.
fn stepped(hair: &Strands, dynamics: &Dynamics, field: &dyn Field, poses: &[Pose]) -> Vec<Vec<[u32; 3]>> {
    let mut simulation = fast(hair, dynamics, field);
    let mut frames = vec![bits(simulation.strands())];
    for frame in 1..=FRAMES {
        simulation.step_frame(&FrameInput::new(frame, poses, field));
        frames.push(bits(simulation.strands()));
    }
    frames
}

fn played(timeline: &mut Timeline) -> Vec<Vec<[u32; 3]>> {
    let film = timeline.play();
    (0..=film.frames()).map(|frame| to_bits(film.points(frame))).collect()
}

#[test]
fn all_frames_are_those_of_the_stepper_to_the_bit() {
    let hair = mixed_hair(150);
    let poses = way_of_a_head(FRAMES);
    assert_eq!(played(&mut timeline(&hair)), stepped(&hair, &dynamics(), &*everything(), &poses));
    let mut still = Timeline::new(&hair, &gust(), Arc::new(wind()), Vec::new(), FRAMES).unwrap();
    assert_eq!(played(&mut still), stepped(&hair, &gust(), &wind(), &[]));
}

#[test]
fn any_subset_threads_and_width_give_the_same_frames() {
    let hair = mixed_hair(150);
    let whole = played(&mut timeline(&hair));
    let chosen = [149, 7, 33, 34, 90];
    let ids = chosen.map(|s| s as u32);
    let part = hair.select(&chosen);
    let mut some = Timeline::with_ids(&part, &ids, &dynamics(), everything(), way_of_a_head(FRAMES), FRAMES).unwrap();
    for (part_frame, whole_frame) in played(&mut some).into_iter().zip(&whole) {
        let expected: Vec<[u32; 3]> = chosen.iter().flat_map(|&s| &whole_frame[hair.range(s)]).copied().collect();
        assert_eq!(part_frame, expected);
    }
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut medium = timeline(&hair).with_vector_width(VectorWidth::Medium);
        assert!(pool.install(|| played(&mut medium)) == whole, "{threads} threads");
    }
}

#[test]
fn any_frame_can_be_gone_to_in_any_order() {
    let hair = mixed_hair(60);
    let whole = played(&mut timeline(&hair));
    let mut timeline = timeline(&hair);
    for frame in [0, 40, 3, 3, 4, 60, 0, 59, 60] {
        assert_eq!(bits(timeline.seek(frame)), whole[frame as usize], "frame {frame}");
        assert_eq!(timeline.frame(), frame);
    }
    timeline.rewind();
    for (frame, expected) in whole.iter().enumerate() {
        assert_eq!(&bits(timeline.strands()), expected, "frame {frame}");
        assert_eq!(timeline.advance(), frame < FRAMES as usize);
    }
    // Playing in the middle of the way changes nothing, and stands at the end, the second time as well.
    for _ in 0..2 {
        assert_eq!(bits(timeline.seek(17)), whole[17]);
        let film = timeline.play();
        assert_eq!(to_bits(film.strand(17, 5)), whole[17][hair.range(5)]);
        assert_eq!((timeline.frame(), bits(timeline.strands())), (FRAMES, whole[FRAMES as usize].clone()));
        assert!(!timeline.advance());
    }
}

#[test]
fn a_film_in_stretches_is_the_film_and_can_be_stopped_between_them() {
    let hair = mixed_hair(60);
    let whole = played(&mut timeline(&hair));
    let points = hair.points().len();
    let last = FRAMES as usize;
    for stretch in [1, 7, FRAMES, FRAMES + 1, 1000] {
        let mut timeline = timeline(&hair);
        let mut film = vec![Vec3::NAN; (last + 1) * points];
        let mut asked = 0;
        assert!(timeline.play_into_while(&mut film, stretch, || {
            asked += 1;
            true
        }));
        assert_eq!(asked, FRAMES / stretch, "it is asked between any two stretches");
        assert!(film.chunks(points).zip(&whole).all(|(page, frame)| to_bits(page) == *frame));
        assert_eq!(timeline.frame(), FRAMES);
        // Stopped, it stands where it has come to, and goes on from there.
        let ended = timeline.play_into_while(&mut film, stretch, || false);
        let at = (stretch - 1).min(FRAMES);
        assert_eq!((ended, timeline.frame()), (at == FRAMES, at));
        assert_eq!(bits(timeline.strands()), whole[at as usize]);
        assert_eq!(bits(timeline.seek(FRAMES)), whole[last]);
    }
}

#[test]
fn another_field_settings_or_way_give_what_a_new_timeline_gives() {
    let hair = mixed_hair(60);
    let mut timeline = timeline(&hair);
    let first = played(&mut timeline);
    timeline.set_field(Arc::new(wind())).unwrap();
    assert_eq!((timeline.frame(), bits(timeline.strands())), (0, first[0].clone()));
    assert_eq!(played(&mut timeline), stepped(&hair, &dynamics(), &wind(), &way_of_a_head(FRAMES)));
    timeline.set_dynamics(&gust()).unwrap();
    assert_eq!(played(&mut timeline), stepped(&hair, &gust(), &wind(), &way_of_a_head(FRAMES)));
    timeline.set_poses(Vec::new(), FRAMES - 1).unwrap();
    assert_eq!(played(&mut timeline), stepped(&hair, &gust(), &wind(), &[])[..FRAMES as usize]);
    timeline.set_poses(way_of_a_head(FRAMES), FRAMES).unwrap();
    timeline.set_dynamics(&dynamics()).unwrap();
    timeline.set_field(everything()).unwrap();
    assert_eq!(played(&mut timeline), first);
}

#[test]
fn what_cannot_be_stepped_is_refused_and_leaves_all_as_it_was() {
    let hair = mixed_hair(30);
    let mut timeline = timeline(&hair);
    let film = played(&mut timeline);
    let before = bits(timeline.seek(31));
    let too_strong: Arc<dyn Field> = Arc::new(field(&[(9, [1.0, 0.0, 0.0]), (10, [1e9, 0.0, 0.0])]));
    let refused = timeline.set_field(too_strong.clone()).unwrap_err();
    assert_eq!(refused.thing, "force[1].vector");
    assert_eq!(Simulation::new(&hair, &dynamics(), &*too_strong).err(), Some(refused.clone()));
    assert_eq!(Timeline::new(&hair, &dynamics(), too_strong, Vec::new(), 9).err(), Some(refused));
    // The same field may be too strong for other settings.
    let mut slow = dynamics();
    slow.motion.time_step = 10.0;
    assert_eq!(timeline.set_dynamics(&slow).unwrap_err().thing, "force[0].vector");
    slow.motion.time_step = -1.0;
    assert_eq!(timeline.set_dynamics(&slow).unwrap_err().thing, "motion.time_step");
    assert_eq!(timeline.set_poses(way_of_a_head(5), 6).unwrap_err().thing, "motion.frames");
    let mut nowhere = way_of_a_head(6);
    nowhere[4].position_cm.x = f32::NAN;
    assert_eq!(timeline.set_poses(nowhere, 6).unwrap_err().thing, "head.motion frame 4");
    assert_eq!((timeline.frame(), bits(timeline.strands())), (31, before));
    assert_eq!(played(&mut timeline), film);
}

#[test]
fn a_step_into_storage_of_the_callers_is_the_step() {
    let (hair, poses, field) = (mixed_hair(50), way_of_a_head(FRAMES), everything());
    let wanted = stepped(&hair, &dynamics(), &*field, &poses);
    let mut simulation = fast(&hair, &dynamics(), &*field);
    let at_rest = bits(simulation.strands());
    let mut points = vec![Vec3::NAN; hair.points().len()];
    for frame in 1..=FRAMES {
        simulation.step_frame_into(&FrameInput::new(frame, &poses, &*field), &mut points);
        assert_eq!((simulation.frame(), to_bits(&points)), (frame, wanted[frame as usize].clone()));
    }
    assert_eq!(bits(simulation.strands()), at_rest, "what is shown stays");
}
