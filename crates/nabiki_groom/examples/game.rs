//! Hair that a game moves: its head, its wind, the cost of a step and a saved game. docs/guides/game.md shows it.
//!
//!     cargo run --release -p nabiki_groom --example game

use std::time::Instant;

use nabiki::body::{Body, Contact};
use nabiki::dynamics::{
    Dynamics, Form, FrameInput, Motion, Simulation, Stepper, carrying_force, earth_gravity, stiffness_of, substeps,
};
use nabiki::field::UniformField;
use nabiki::free_form::{FreeForm, FreeMotion};
use nabiki::glam::{Quat, Vec3};
use nabiki::locks::LockVariation;
use nabiki::{Head, Pose, Profile, SettingError, Strands};
use nabiki_groom::{Growth, Hairline, Style, bust, grow};

/// Steps per second, whatever rate the game draws at.
const RATE: f64 = 60.0;
/// Steps in which a swing falls to about a third: 0.6 s.
const SETTLE: f64 = 0.6 * RATE;
/// 1 km/h in cm/s.
const KMH: f64 = 1e5 / 3600.0;

/// The hair of one character.
struct Wig {
    simulation: Simulation,
    wind: UniformField,
    /// Strength of a wind of 1 km/h, in F.
    force_per_kmh: f32,
    /// Poses of the head in the last two steps, the later one first.
    before: [Pose; 2],
}

impl Wig {
    /// Hair at rest on a head that is at `pose`.
    fn new(head: &Head, hair: &Strands, pose: Pose) -> Result<Self, SettingError> {
        let length = f64::from(hair.lengths().sum::<f32>()) / hair.len() as f64;
        let motion = Motion { frame_rate: RATE, inertia_length_floor: 14.0, ..Motion::default() };
        let mut dynamics = Dynamics { motion, ..Dynamics::new(head.ellipsoid) };
        let gravity = earth_gravity(&dynamics, length);
        let stiffness = |cm: f64| stiffness_of(&dynamics, f64::from(gravity), length, cm) as f32;
        let mut form = FreeForm {
            stiffness: Profile::RootToTip(vec![stiffness(6.0), stiffness(4.5)]),
            hold: Profile::Even(0.3 * gravity),
            settle: Profile::Even(SETTLE as f32),
            gravity,
            variation: Some(LockVariation::default()),
            ..FreeForm::default()
        };
        form.substeps = Some(substeps(&dynamics, &form, gravity, [length, f64::from(dynamics.segment_length)]));
        let bodies = vec![Body::head(head, Contact::default())];
        dynamics.form = Form::Free(FreeMotion { form, bodies, rest_pose: pose, ..FreeMotion::default() });
        let wind = UniformField::default();
        let simulation = Simulation::new(hair, &dynamics, &wind)?;
        let force_per_kmh = (KMH * carrying_force(&dynamics, length, SETTLE)) as f32;
        Ok(Self { simulation, wind, force_per_kmh, before: [pose; 2] })
    }

    /// One step, to a head that is at `pose` now, in a wind (km/h, world space).
    fn step(&mut self, pose: Pose, wind_kmh: Vec3) {
        let force = self.force_per_kmh * wind_kmh;
        self.wind.0 = force.clamp_length_max(self.simulation.strongest_force());
        let frame = self.simulation.frame() + 1;
        self.simulation.step_frame(&FrameInput::live(frame, pose, self.before, &self.wind));
        self.before = [pose, self.before[0]];
    }

    /// The hair's part of a saved game.
    fn save(&self) -> (Vec<u8>, [Pose; 2]) {
        (self.simulation.state_bytes(), self.before)
    }

    /// Goes back to a saved game.
    fn load(&mut self, (state, before): &(Vec<u8>, [Pose; 2])) -> Result<(), SettingError> {
        self.simulation.set_state_bytes(state)?;
        self.before = *before;
        Ok(())
    }
}

/// Where the game has the head in a step: it looks from side to side.
fn head_pose(step: u32) -> Pose {
    let time = f64::from(step) / RATE;
    Pose { rotation: Quat::from_rotation_y(0.8 * (2.0 * time).sin() as f32), ..Pose::STILL }
}

/// The wind of the game in a step (km/h): a breeze with gusts, along -x.
fn game_wind(step: u32) -> Vec3 {
    let time = f64::from(step) / RATE;
    Vec3::new(-3.0 - 22.0 * (1.5 * time).sin().max(0.0) as f32, 0.0, 0.0)
}

fn main() -> Result<(), SettingError> {
    let (head, hairline, style) = (bust(), Hairline::default(), Style::default());
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 2_000, segments: 18, segment_length: 1.0, seed: 1 };
    let hair = grow(&head, &growth, growth.strands)?.strands;
    let mut wig = Wig::new(&head, &hair, head_pose(0))?;

    let start = Instant::now();
    for step in 1..=120 {
        wig.step(head_pose(step), game_wind(step));
        if step % 30 == 0 {
            // What a vertex shader does: points of head space, by the matrix of the head.
            let tip = wig.simulation.strands().strand(0).last().copied().unwrap_or_default();
            println!("step {step}: a tip is at {:.1}", head_pose(step).world_from_head().transform_point3(tip));
        }
    }
    println!("{} strands, {} segments: {:.2?} per step", hair.len(), hair.segment_count(), start.elapsed() / 120);

    let saved = wig.save();
    let mut play_on = || -> Result<Strands, SettingError> {
        wig.load(&saved)?;
        (121..=180).for_each(|step| wig.step(head_pose(step), game_wind(step)));
        Ok(wig.simulation.strands().clone())
    };
    let (once, again) = (play_on()?, play_on()?);
    assert!(once == again, "the same game moves the hair to the same bits");
    Ok(())
}
