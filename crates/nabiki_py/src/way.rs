//! Where head, bodies and skin are in a step that is told, and where they were: what a state keeps besides hair.

use std::sync::Arc;

use glam::Vec3;
use nabiki::body::Body;
use nabiki::dynamics::Form;
use nabiki::skin::SkinFrame;
use nabiki::{Pose, SettingError, Skin};
use nabiki_scene::BuiltScene;

/// What is said of a step; what is not told goes as in the scene.
#[derive(Default)]
pub struct Told {
    pub head: Option<Pose>,
    /// By their number in the scene.
    pub bodies: Vec<Option<Pose>>,
    pub skin: Option<Arc<Shape>>,
    /// Whether all of them came at once where they are.
    pub jumped: bool,
}

/// The poses of a step as [`FrameInput`](nabiki::dynamics::FrameInput) has them.
pub struct Poses {
    pub head: Pose,
    pub before: [Pose; 2],
    pub bodies: Vec<Option<[Pose; 2]>>,
    /// In this frame and in the two before it; none where only the scene has bent it so far.
    pub skin: Option<[Arc<SkinFrame>; 3]>,
}

/// A shape of the head's skin.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Of the head's mesh (head space, cm): a state keeps them, and the frame follows from them.
    vertices: Vec<Vec3>,
    frame: Arc<SkinFrame>,
}

impl Shape {
    /// The skin with the vertices of its mesh at these places.
    ///
    /// # Errors
    /// As [`Skin::frame`].
    pub fn of(skin: &Skin, vertices: Vec<Vec3>) -> Result<Self, SettingError> {
        let frame = Arc::new(skin.frame(&vertices)?);
        Ok(Self { vertices, frame })
    }

    /// The skin as the scene has it in a frame.
    fn of_scene(built: &BuiltScene, skin: &Skin, frame: u32) -> Arc<Self> {
        let vertices = built.skin(frame).unwrap_or(&built.model.head.mesh.positions);
        Arc::new(Self::of(skin, vertices.to_vec()).expect("the scene's own shapes were checked when it was built"))
    }
}

/// Where head, bodies and skin were last.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    head: Pose,
    /// Where the head was before that; at rest it came as it goes on.
    earlier: Option<Pose>,
    /// By their number in the scene; none of those that were where the scene has them.
    bodies: Vec<Option<Pose>>,
    /// The shape of the skin, and the one before it; none until a step tells one.
    pub skin: Option<[Arc<Shape>; 2]>,
}

/// The bodies that hair feels, the head first; none in the paper's form.
fn felt(built: &BuiltScene) -> &[Body] {
    match &built.dynamics.form {
        Form::Free(free) => &free.bodies,
        Form::Paper => &[],
    }
}

/// The number among these of a body of the scene.
fn number(felt: &[Body], body: usize) -> Option<usize> {
    let name = format!("body[{body}]");
    felt.iter().position(|body| body.name == name)
}

/// Refuses to tell hair of a body that it does not feel.
///
/// # Errors
/// Says why.
pub fn check_body(built: &BuiltScene, body: usize) -> Result<(), String> {
    let there = built.scene.bodies.len();
    match (&built.dynamics.form, number(felt(built), body)) {
        (_, Some(_)) => Ok(()),
        _ if body >= there => Err(format!("the scene has {there} bodies: scene.bodies must name all of them")),
        (Form::Paper, _) => Err("hair feels bodies only in the free form: set motion.form = \"free\"".to_owned()),
        (Form::Free(_), _) => Err(format!("hair does not feel it: set body[{body}].solid = true, or give None")),
    }
}

impl Way {
    /// At rest.
    pub fn new(built: &BuiltScene) -> Self {
        Self { head: built.pose(0), earlier: None, bodies: vec![None; built.scene.bodies.len()], skin: None }
    }

    /// Where the head is.
    pub fn head(&self) -> Pose {
        self.head
    }

    /// Goes on to `frame`. `skin` carries the hair, if one does.
    pub fn step(&mut self, built: &BuiltScene, skin: Option<&Skin>, frame: u32, told: Told) -> Poses {
        let head = told.head.unwrap_or_else(|| built.input(frame).pose);
        let before = match told.jumped {
            true => [head; 2],
            false => [self.head, self.earlier.unwrap_or_else(|| self.head.continued_back_from(&head))],
        };
        let felt = felt(built);
        let mut bodies = Vec::new();
        for (i, was) in self.bodies.iter_mut().enumerate() {
            let now = told.bodies.get(i).copied().flatten();
            if let (true, Some(number)) = (now.is_some() || was.is_some(), number(felt, i)) {
                let way = &felt[number].way;
                let there = now.unwrap_or_else(|| way.pose(frame, &head));
                let before = match told.jumped {
                    true => there,
                    false => was.unwrap_or_else(|| way.pose(frame - 1, &before[0])),
                };
                bodies.resize(felt.len(), None);
                bodies[number] = Some([there, before]);
            }
            *was = now;
        }
        (self.head, self.earlier) = (head, Some(before[0]));
        // Until a step tells a shape, the stepper itself knows those of the scene.
        let skin = skin.filter(|_| told.skin.is_some() || self.skin.is_some());
        let skin = skin.map(|skin| self.bend(built, skin, frame, told.skin, told.jumped));
        Poses { head, before, bodies, skin }
    }

    /// Bends the skin as in `frame`, and gives its shapes in that frame and in the two before it.
    fn bend(
        &mut self,
        built: &BuiltScene,
        skin: &Skin,
        frame: u32,
        told: Option<Arc<Shape>>,
        jumped: bool,
    ) -> [Arc<SkinFrame>; 3] {
        let now = told.unwrap_or_else(|| Shape::of_scene(built, skin, frame));
        let (before, earlier) = match &self.skin {
            _ if jumped => (now.clone(), now.frame.clone()),
            Some([before, earlier]) => (before.clone(), earlier.frame.clone()),
            None => {
                let before = Shape::of_scene(built, skin, frame - 1);
                let earlier = match frame.checked_sub(2) {
                    Some(earlier) => Shape::of_scene(built, skin, earlier).frame.clone(),
                    // At rest it came as it goes on, like the head.
                    None => Arc::new(before.frame.continued_back_from(&now.frame)),
                };
                (before, earlier)
            }
        };
        let frames = [now.frame.clone(), before.frame.clone(), earlier];
        self.skin = Some([now, before]);
        frames
    }
}

/// What the bytes of a state begin with; the last one is the version of their layout.
const MAGIC: [u8; 8] = *b"nabikiP\x02";
/// Words before the poses: the frame that comes next, the number of bodies, the words of the hair behind all of these, and the
/// vertices of each of the two shapes of the skin, which follow the poses; 0 without them.
const FIRST: usize = 4;
/// Words of a pose that may be there.
const POSE: usize = 8;

/// What bytes of a state say.
pub struct Saved<'a> {
    /// Without the skin.
    pub way: Way,
    /// The frame that comes next.
    pub next: u32,
    /// The vertices of the skin in its last shape, and in the one before it.
    pub skin: Option<[Vec<Vec3>; 2]>,
    pub hair: &'a [u8],
}

impl Way {
    /// As bytes, with those of the `hair` behind them; `next`: the frame that comes next.
    pub fn bytes(&self, next: u32, hair: &[u8]) -> Vec<u8> {
        let vertices = self.skin.as_ref().map_or(0, |[now, _]| now.vertices.len());
        let mut words = vec![next, self.bodies.len() as u32, (hair.len() / 4) as u32, vertices as u32];
        for pose in [Some(self.head), self.earlier].into_iter().chain(self.bodies.iter().copied()) {
            let Pose { position_cm, rotation } = pose.unwrap_or_default();
            words.push(u32::from(pose.is_some()));
            words.extend(position_cm.to_array().into_iter().chain(rotation.to_array()).map(f32::to_bits));
        }
        for shape in self.skin.iter().flatten() {
            words.extend(shape.vertices.iter().flat_map(|v| v.to_array()).map(f32::to_bits));
        }
        words.push(checksum(&words));
        let own = MAGIC.into_iter().chain(words.into_iter().flat_map(u32::to_le_bytes));
        own.chain(hair.iter().copied()).collect()
    }

    /// What such bytes say of a scene with as many bodies.
    ///
    /// # Errors
    /// What they are, and what to do.
    pub fn of_bytes<'a>(&self, bytes: &'a [u8]) -> Result<Saved<'a>, (String, String)> {
        let refused = |way_out: &str| Err((format!("{} bytes", bytes.len()), way_out.to_owned()));
        let Some(rest) = bytes.strip_prefix(&MAGIC) else {
            return refused("was not written by state()");
        };
        let words =
            |bytes: &[u8]| -> Vec<u32> { bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect() };
        let first = words(&rest[..rest.len().min(4 * FIRST)]);
        // Beyond what there is no state of any scene has bodies or vertices.
        let [bodies, vertices] = [1, 3].map(|at| first.get(at).map_or(0, |&count| (count as usize).min(rest.len())));
        let poses = FIRST + POSE * (2 + bodies);
        let count = poses + 2 * 3 * vertices;
        let Some((own, hair)) = rest.split_at_checked(4 * (count + 1)) else {
            return refused("is cut short");
        };
        let words = words(own);
        if checksum(&words[..count]) != words[count] {
            return refused("is altered: its checksum does not match");
        }
        if hair.len() / 4 != words[2] as usize {
            return refused("is cut short, or has bytes after its end");
        }
        if bodies != self.bodies.len() {
            let way_out = format!(
                "has {bodies} bodies, but this scene has {}: give those it was saved with, or begin from rest",
                self.bodies.len()
            );
            return Err((String::new(), way_out));
        }
        let numbers = words[poses..count].as_chunks::<3>().0;
        let shape = |of: &[[u32; 3]]| of.iter().map(|&v| Vec3::from_array(v.map(f32::from_bits))).collect::<Vec<_>>();
        let skin = (vertices > 0).then(|| [shape(&numbers[..vertices]), shape(&numbers[vertices..])]);
        let mut poses = words[FIRST..poses].as_chunks::<POSE>().0.iter().map(|&[is_there, rest @ ..]| {
            let [x, y, z, turn @ ..] = rest.map(f32::from_bits);
            (is_there != 0).then_some(Pose { position_cm: [x, y, z].into(), rotation: glam::Quat::from_array(turn) })
        });
        let (head, earlier) = (poses.next().flatten().unwrap_or_default(), poses.next().flatten());
        let way = Self { head, earlier, bodies: poses.collect(), skin: None };
        Ok(Saved { way, next: words[0], skin, hair })
    }
}

/// Differs for words of which one differs (FNV-1a, by words).
fn checksum(words: &[u32]) -> u32 {
    words.iter().fold(0x811c_9dc5, |sum, word| (sum ^ word).wrapping_mul(0x0100_0193))
}
