//! Where head and bodies are in a step that is told, and where they were: what a state keeps besides hair.

use nabiki::Pose;
use nabiki::body::Body;
use nabiki::dynamics::Form;
use nabiki_scene::BuiltScene;

/// What is said of a step; what is not told goes as in the scene.
#[derive(Default)]
pub struct Told {
    pub head: Option<Pose>,
    /// By their number in the scene.
    pub bodies: Vec<Option<Pose>>,
    /// Whether all of them came at once where they are.
    pub jumped: bool,
}

/// The poses of a step as [`FrameInput`](nabiki::dynamics::FrameInput) has them.
pub struct Poses {
    pub head: Pose,
    pub before: [Pose; 2],
    pub bodies: Vec<Option<[Pose; 2]>>,
}

/// Where head and bodies were last.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    head: Pose,
    /// Where the head was before that; at rest it came as it goes on.
    earlier: Option<Pose>,
    /// By their number in the scene; none of those that were where the scene has them.
    bodies: Vec<Option<Pose>>,
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
        Self { head: built.pose(0), earlier: None, bodies: vec![None; built.scene.bodies.len()] }
    }

    /// Where the head is.
    pub fn head(&self) -> Pose {
        self.head
    }

    /// Goes on to `frame`.
    pub fn step(&mut self, built: &BuiltScene, frame: u32, told: Told) -> Poses {
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
        Poses { head, before, bodies }
    }
}

/// What the bytes of a state begin with; the last one is the version of their layout.
const MAGIC: [u8; 8] = *b"nabikiP\x01";
/// Words before the poses: the frame that comes next, the number of bodies, and the words of the hair behind all of these.
const FIRST: usize = 3;
/// Words of a pose that may be there.
const POSE: usize = 8;

impl Way {
    /// As bytes, with those of the `hair` behind them; `next`: the frame that comes next.
    pub fn bytes(&self, next: u32, hair: &[u8]) -> Vec<u8> {
        let mut words = vec![next, self.bodies.len() as u32, (hair.len() / 4) as u32];
        for pose in [Some(self.head), self.earlier].into_iter().chain(self.bodies.iter().copied()) {
            let Pose { position_cm, rotation } = pose.unwrap_or_default();
            words.push(u32::from(pose.is_some()));
            words.extend(position_cm.to_array().into_iter().chain(rotation.to_array()).map(f32::to_bits));
        }
        words.push(checksum(&words));
        let own = MAGIC.into_iter().chain(words.into_iter().flat_map(u32::to_le_bytes));
        own.chain(hair.iter().copied()).collect()
    }

    /// What such bytes say of a scene with as many bodies: the way, the frame that comes next, and the bytes of the hair.
    ///
    /// # Errors
    /// What they are, and what to do.
    pub fn of_bytes<'a>(&self, bytes: &'a [u8]) -> Result<(Self, u32, &'a [u8]), (String, String)> {
        let refused = |way_out: &str| Err((format!("{} bytes", bytes.len()), way_out.to_owned()));
        let Some(rest) = bytes.strip_prefix(&MAGIC) else {
            return refused("was not written by state()");
        };
        let words =
            |bytes: &[u8]| -> Vec<u32> { bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect() };
        let bodies = words(rest).get(1).map_or(0, |&bodies| bodies as usize);
        // Beyond what there is no state of any scene has bodies.
        let count = FIRST + POSE * (2 + bodies.min(rest.len()));
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
        let mut poses = words[FIRST..count].as_chunks::<POSE>().0.iter().map(|&[is_there, rest @ ..]| {
            let [x, y, z, turn @ ..] = rest.map(f32::from_bits);
            (is_there != 0).then_some(Pose { position_cm: [x, y, z].into(), rotation: glam::Quat::from_array(turn) })
        });
        let (head, earlier) = (poses.next().flatten().unwrap_or_default(), poses.next().flatten());
        Ok((Self { head, earlier, bodies: poses.collect() }, words[0], hair))
    }
}

/// Differs for words of which one differs (FNV-1a, by words).
fn checksum(words: &[u32]) -> u32 {
    words.iter().fold(0x811c_9dc5, |sum, word| (sum ^ word).wrapping_mul(0x0100_0193))
}
