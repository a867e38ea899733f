//! Hair in an engine's loop: frames of any length, wind of the game, a head that moves, a player's hand, a jump, a saved state.
//!
//!     cargo run --release -p nabiki --example engine

use std::sync::Arc;

use nabiki::body::{Body, BodyWay, Contact, skin_of};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Motion, Simulation, Stepper};
use nabiki::field::UniformField;
use nabiki::free_form::FreeMotion;
use nabiki::glam::{Quat, Vec3};
use nabiki::{Mesh, Pose, SettingError};
use nabiki_groom::{Growth, Hairline, Style, bust, grow};

/// Steps a second, however many pictures are drawn; hair is shown up to one step late.
const RATE: f64 = 60.0;
/// Steps that one picture may wait for; of a longer hitch hair feels nothing.
const MOST_STEPS: u32 = 4;

/// Where something is that the game moves: in the last picture, and in the last two steps, the later one first.
struct Way {
    drawn: Pose,
    stepped: [Pose; 2],
}

impl Way {
    fn at(pose: Pose) -> Self {
        Self { drawn: pose, stepped: [pose; 2] }
    }

    /// The pose in a step at `part` of the time from the last picture to the next one, and in the two steps before.
    fn step(&mut self, next: &Pose, part: f32) -> [Pose; 3] {
        let (pose, [before, earlier]) = (self.drawn.between(next, part), self.stepped);
        self.stepped = [pose, before];
        [pose, before, earlier]
    }
}

/// One head of hair.
struct Wig {
    simulation: Simulation,
    wind: UniformField,
    steps: f64,
    /// Points of the step before the last one.
    earlier: Vec<Vec3>,
    head: Way,
    hand: Way,
}

impl Wig {
    /// Goes on by `seconds`, in which head and hand went to `head` and `hand`, or jumped there. `vertices`: the engine's (head space,
    /// cm).
    fn update(&mut self, seconds: f64, [head, hand]: [Pose; 2], jumped: bool, wind: Vec3, vertices: &mut [Vec3]) {
        self.wind.0 = wind.clamp_length_max(self.simulation.strongest_force());
        let (from, to) = (self.steps, self.steps + seconds * RATE);
        if jumped || to as u32 - from as u32 > MOST_STEPS {
            // Hair goes along as it is in the head; `self.simulation.rewind()` would put it to rest.
            self.simulation.jumped();
            (self.head, self.hand) = (Way::at(head), Way::at(hand));
            self.earlier.copy_from_slice(self.simulation.strands().points());
        } else {
            for frame in from as u32 + 1..=to as u32 {
                let part = ((f64::from(frame) - from) / (to - from)) as f32;
                let ([pose, before, earlier], [hand, hand_before, _]) =
                    (self.head.step(&head, part), self.hand.step(&hand, part));
                // By their number among the bodies: the head goes with the head.
                let bodies = &[None, Some([hand, hand_before])];
                let before = [before, earlier];
                self.earlier.copy_from_slice(self.simulation.strands().points());
                let input = FrameInput::live(frame, pose, before, &self.wind).with_bodies(bodies);
                self.simulation.step_frame(&input);
            }
        }
        (self.steps, self.head.drawn, self.hand.drawn) = (to, head, hand);
        self.simulation.strands().between(&self.earlier, to.fract() as f32, vertices);
    }
}

/// What stands for the mesh of a hand: a box about the origin (cm).
fn palm() -> Mesh {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions: (0..8).map(|i| Vec3::new(18.0, 9.0, 3.0) * corner(i)).collect(), triangles, ..Mesh::default() }
}

fn main() -> Result<(), SettingError> {
    // Of your own: `Head::from_mesh`, and `Strands::push` for each strand (head space, cm).
    let (head, hairline, style) = (bust(), Hairline::default(), Style::default());
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 999, segments: 18, segment_length: 1.0, seed: 1 };
    let hair = grow(&head, &growth, growth.strands)?.strands;
    let aside = Pose { position_cm: Vec3::new(-60.0, 0.0, 12.0), ..Pose::STILL };
    let palm = Arc::new(skin_of(palm(), "hand")?);
    let hand = Body::new("hand", palm, BodyWay::InWorld([aside].into()), Contact::default());
    let bodies = vec![Body::head(&head, Contact::default()), hand];
    let dynamics = Dynamics {
        motion: Motion { frame_rate: RATE, inertia_length_floor: 18.0, ..Motion::default() },
        form: Form::Free(FreeMotion { bodies, ..FreeMotion::default() }),
        ..Dynamics::new(head.ellipsoid)
    };
    let simulation = Simulation::new(&hair, &dynamics, &UniformField::default())?;
    let mut saved = simulation.clone();
    let (head, hand, mut vertices) = (Way::at(Pose::STILL), Way::at(aside), hair.points().to_vec());
    let mut wig = Wig { simulation, wind: UniformField::default(), steps: 0.0, earlier: vertices.clone(), head, hand };
    // Pictures of 30, 60 and 144 Hz, and a hitch.
    for (pictures, rate) in [(30, 30.0), (60, 60.0), (144, 144.0), (1, 2.0)] {
        saved.set_state(&wig.simulation)?;
        for time in (0..pictures).map(|n| f64::from(n) / rate) {
            let head = Pose { rotation: Quat::from_rotation_y((3.0 * time).sin() as f32), ..Pose::STILL };
            // Through the hair behind the head, to the side and back.
            let hand = Pose { position_cm: Vec3::new(-14.0, -8.0, 30.0 * (2.0 * time).cos() as f32), ..Pose::STILL };
            wig.update(1.0 / rate, [head, hand], false, Vec3::NEG_X * 150.0 * time as f32, &mut vertices);
        }
        println!("frame {}: a tip is at {}", wig.simulation.frame(), vertices[hair.range(0).end - 1]);
    }
    wig.simulation.set_state(&saved)?;
    Ok(())
}
