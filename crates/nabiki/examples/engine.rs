//! Hair in an engine's loop: frames of any length, wind of the game, a head that moves, contact, a jump, a saved state.
//!
//!     cargo run --release -p nabiki --example engine

use glam::{Quat, Vec3};
use nabiki::body::{Body, Contact};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Simulation, Stepper};
use nabiki::field::{Field, FieldSum};
use nabiki::free_form::FreeMotion;
use nabiki::groom::{Growth, Style, grow};
use nabiki::pseudo_force::PseudoForce;
use nabiki::roots::Hairline;
use nabiki::{Head, Pose, SettingError};

/// Steps a second, however many pictures are drawn.
const RATE: f64 = 60.0;
/// Steps that one picture may wait for; of a longer hitch hair feels nothing.
const MOST_STEPS: u32 = 4;

/// Wind that the game sets from step to step.
#[derive(Debug)]
struct Wind(Vec3);

impl Field for Wind {
    fn at(&self, _point: Vec3, _frame: u32) -> Vec3 {
        self.0
    }
    fn strongest(&self) -> f32 {
        self.0.length()
    }
    fn uniform(&self, _frame: u32) -> Option<Vec3> {
        Some(self.0)
    }
}

/// One head of hair.
struct Wig {
    simulation: Simulation,
    wind: Wind,
    steps: f64,
    /// The head in the last picture, and in the last two steps, the later one first.
    head: Pose,
    before: [Pose; 2],
}

impl Wig {
    /// Goes on by `seconds`, in which the head went to `head`, or jumped there. `vertices`: the engine's (head space, cm).
    fn update(&mut self, seconds: f64, head: Pose, jumped: bool, wind: Vec3, vertices: &mut [Vec3]) {
        self.wind.0 = wind.clamp_length_max(self.simulation.strongest_force());
        let (from, to) = (self.steps, self.steps + seconds * RATE);
        if jumped || to as u32 - from as u32 > MOST_STEPS {
            // Hair goes along as it is in the head; `self.simulation.rewind()` would put it to rest.
            self.simulation.jumped();
            self.before = [head; 2];
        } else {
            for frame in from as u32 + 1..=to as u32 {
                let pose = self.head.between(&head, ((f64::from(frame) - from) / (to - from)) as f32);
                self.simulation.step_frame(&FrameInput { frame, pose, before: self.before, field: &self.wind });
                self.before = [pose, self.before[0]];
            }
        }
        (self.steps, self.head) = (to, head);
        vertices.copy_from_slice(self.simulation.strands().points());
    }
}

fn main() -> Result<(), SettingError> {
    // Of your own: `Head::from_mesh`, and `Strands::push` for each strand (head space, cm).
    let (head, hairline, style) = (Head::builtin(), Hairline::default(), Style::default());
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 999, segments: 18, segment_length: 1.0, seed: 1 };
    let hair = grow(&head, &growth, growth.strands)?.strands;
    let bodies = vec![Body::head(&head, Contact::default())];
    let dynamics = Dynamics {
        motion: Motion { frame_rate: RATE, inertia_length_floor: 18.0, ..Motion::default() },
        segment_length: 1.0,
        pseudo_force: PseudoForce::off(),
        ellipsoid: head.ellipsoid,
        shell: 1.25,
        polar_axis: Vec3::Y,
        disturbance: None,
        form: Form::Free(FreeMotion { bodies, ..FreeMotion::default() }),
    };
    let simulation = Simulation::new(&hair, &dynamics, &FieldSum::default())?;
    let mut saved = simulation.clone();
    let mut wig = Wig { simulation, wind: Wind(Vec3::ZERO), steps: 0.0, head: Pose::STILL, before: [Pose::STILL; 2] };
    let mut vertices = hair.points().to_vec();
    // Pictures of 30, 60 and 144 Hz, and a hitch.
    for (pictures, rate) in [(30, 30.0), (60, 60.0), (144, 144.0), (1, 2.0)] {
        saved.set_state(&wig.simulation);
        for time in (0..pictures).map(|n| f64::from(n) / rate) {
            let head = Pose { rotation: Quat::from_rotation_y((3.0 * time).sin() as f32), ..Pose::STILL };
            wig.update(1.0 / rate, head, false, Vec3::NEG_X * 150.0 * time as f32, &mut vertices);
        }
        println!("frame {}: a tip is at {}", wig.simulation.frame(), vertices[hair.range(0).end - 1]);
    }
    wig.simulation.set_state(&saved);
    Ok(())
}
