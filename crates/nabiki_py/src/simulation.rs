//! A motion, frame by frame.

use std::sync::{Arc, Mutex, MutexGuard};

use glam::Vec3;
use nabiki::dynamics::{FrameInput, Stepper};
use nabiki::field::{self, UniformField};
use nabiki_scene::BuiltScene;
use nabiki_scene::built::LiveSkin;
use numpy::PyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::{Points, Rooms};
use crate::error;
use crate::field::{Field, PythonField};
use crate::frame::{self, Frame};
use crate::hints::{ArrayLike, ForceLike, Given, Hinted, PoseLike, PosesLike, UInt32};
use crate::made::points_of;
use crate::poses;
use crate::scene::said;
use crate::threads::{alone, detached};
use crate::watched::{Ears, watched};
use crate::way::{self, Saved, Shape, Told, Way};

/// The motion of a scene's hair: an iterator over its frames, from the rest frame 0 to the last. Each frame is computed
/// on request. Frames that you drop take no memory. `len()` is the number of all frames.
///
/// `step` advances with a head, bodies, a skin and a force that you decide step by step.
#[pyclass(frozen, module = "nabiki")]
pub struct Simulation {
    built: Arc<BuiltScene>,
    place: Mutex<Place>,
    fields: Vec<Arc<PythonField>>,
    rooms: Arc<Rooms>,
    offsets: Py<PyArray1<u32>>,
}

/// How far it is.
struct Place {
    stepper: nabiki::dynamics::Simulation,
    next: u32,
    way: Way,
    /// The head's skin, once a step has told a shape of it.
    live: Option<Arc<LiveSkin>>,
    /// The points of the last frame, which the stepper has written there and not kept; none at rest.
    shown: Option<Py<Points>>,
    /// Whether a field failed in a step, which is nobody's motion.
    failed: bool,
}

/// What pulls in a step.
enum Force {
    /// The scene.
    Own,
    Everywhere(UniformField),
    Function(Arc<PythonField>),
}

impl Force {
    /// What Python gave, unless hair of this step cannot bear it.
    fn of(given: &Bound<'_, PyAny>, most: f32) -> PyResult<Self> {
        let force = match given.cast::<Field>() {
            Ok(field) => Self::Function(field.get().shared.clone()),
            Err(_) => Self::Everywhere(UniformField(Vec3::from(poses::row("force", given)?.map(|x| x as f32)))),
        };
        let strength = match &force {
            Self::Own => return Ok(force),
            Self::Everywhere(wind) => field::Field::strongest(wind),
            Self::Function(function) => field::Field::strongest(&**function),
        };
        if strength <= most {
            return Ok(force);
        }
        let way_out = format!(
            "is above {most}, the strongest that this hair allows: give a weaker one, or a smaller \
             motion.time_step"
        );
        Err(error::argument(given.py(), "force of strength", strength, &way_out))
    }
}

impl Simulation {
    pub fn of(py: Python<'_>, built: Arc<BuiltScene>, fields: Vec<Arc<PythonField>>) -> PyResult<Self> {
        let stepper = detached(py, || built.simulation())?.map_err(|refused| error::raised(py, refused))?;
        let offsets = frame::offsets(py, &built);
        let place = Place { stepper, next: 0, way: Way::new(&built), live: None, shown: None, failed: false };
        Ok(Self { built, place: Mutex::new(place), fields, rooms: Arc::default(), offsets })
    }

    /// Alone with how far it is.
    fn place(&self) -> PyResult<MutexGuard<'_, Place>> {
        alone(&self.place, "simulation", "simulate")
    }

    /// The same, if that is somebody's motion.
    fn sound(&self) -> PyResult<MutexGuard<'_, Place>> {
        let place = self.place()?;
        match place.failed {
            false => Ok(place),
            true => Err(PyRuntimeError::new_err(
                "a step of this simulation failed: start another with scene.simulate(), or restore() an earlier state",
            )),
        }
    }

    /// Steps to the next frame.
    fn stepped(&self, py: Python<'_>, place: &mut Place, told: Told, force: Force) -> PyResult<Frame> {
        let Self { built, fields, rooms, .. } = self;
        let Place { stepper, next, way, shown, failed, .. } = place;
        if told.jumped {
            stepper.jumped();
        }
        let skin = stepper.dynamics().skin.clone();
        let poses = way.step(built, skin.as_deref(), *next, told);
        let mut points = rooms.take(stepper.strands().points().len());
        let (field, functions): (&dyn field::Field, &[Arc<PythonField>]) = match &force {
            Force::Own => (&*built.forces.field, fields),
            Force::Everywhere(wind) => (wind, &[]),
            Force::Function(function) => (&**function, std::slice::from_ref(function)),
        };
        let mut step = || {
            let way::Poses { head: pose, before, bodies, skin } = &poses;
            let mut input = FrameInput::live(*next, *pose, *before, field).with_bodies(bodies);
            if let Some(skin) = skin {
                input = input.with_skin(skin.each_ref().map(|frame| &**frame));
            }
            stepper.step_frame_into(&input, &mut points);
        };
        match functions.is_empty() {
            true => detached(py, step)?,
            // Only then may a step take long.
            false => {
                let asking = watched(py, Ears::default(), functions, |_| {
                    step();
                    Ok(())
                });
                asking.inspect_err(|_| *failed = true)?;
            }
        }
        *shown = Some(Py::new(py, Points::new(points, Some(rooms.clone())))?);
        *next += 1;
        self.frame(py, place)
    }

    /// The frame that was reached last.
    fn frame(&self, py: Python<'_>, place: &Place) -> PyResult<Frame> {
        let Place { stepper, way, shown, .. } = place;
        let points = match shown {
            Some(points) => points.clone_ref(py),
            None => Py::new(py, Points::new(stepper.strands().points().to_vec(), None))?,
        };
        let offsets = self.offsets.clone_ref(py);
        Ok(Frame { built: self.built.clone(), points, offsets, number: stepper.frame(), pose: way.head() })
    }

    /// The head's skin, to be bent.
    fn live(&self, py: Python<'_>, place: &mut Place) -> PyResult<Arc<LiveSkin>> {
        if let Some(live) = &place.live {
            return Ok(live.clone());
        }
        let live = detached(py, || self.built.live_skin())?.map_err(|refused| error::raised(py, refused))?;
        Ok(place.live.insert(Arc::new(live)).clone())
    }

    /// A stepper, at rest, whose roots ride on a skin that only steps bend, or one whose roots do not; none if the present one
    /// is such. Riding changes the last bits of hair on a head that turns, so that a state without a skin needs one without.
    fn other(&self, py: Python<'_>, place: &Place, rides: bool) -> PyResult<Option<nabiki::dynamics::Simulation>> {
        let bends_itself = self.built.dynamics.skin.is_some();
        if bends_itself || place.stepper.dynamics().skin.is_some() == rides {
            return Ok(None);
        }
        let live = place.live.as_ref().filter(|_| rides);
        let other = detached(py, || match live {
            Some(live) => self.built.simulation_on(live),
            None => self.built.simulation(),
        })?;
        other.map(Some).map_err(|refused| error::raised(py, refused))
    }

    /// The shape of the skin with these vertices of `head.mesh`.
    fn shape(&self, py: Python<'_>, place: &mut Place, vertices: &[Vec3]) -> PyResult<Arc<Shape>> {
        let live = self.live(py, place)?;
        let shape = detached(py, || Shape::of(live.skin(), live.placed(vertices)?))?;
        shape.map(Arc::new).map_err(|refused| error::setting(py, refused))
    }

    /// The shape of the skin that a state keeps.
    fn shape_of_state(&self, py: Python<'_>, live: &LiveSkin, vertices: Vec<Vec3>) -> PyResult<Arc<Shape>> {
        let (found, own) = (vertices.len(), self.built.model.head.mesh.positions.len());
        if found != own {
            let way_out = format!("this head has {own}: give the one it was saved with, or begin from rest");
            return Err(error::argument(py, "state of hair", format!("skin of {found} vertices"), &way_out));
        }
        Shape::of(live.skin(), vertices).map(Arc::new).map_err(|refused| error::setting(py, refused))
    }

    /// Where bodies are, by their number in the scene.
    fn bodies(&self, given: &Bound<'_, PyAny>) -> PyResult<Vec<Option<nabiki::Pose>>> {
        let py = given.py();
        let mut bodies = Vec::new();
        for (i, pose) in given.try_iter()?.enumerate() {
            let (thing, pose) = (format!("bodies[{i}]"), pose?);
            let is_there = i < self.built.scene.bodies.len();
            if is_there && pose.is_none() {
                bodies.push(None);
                continue;
            }
            way::check_body(&self.built, i).map_err(|way_out| error::argument(py, &thing, "a pose", &way_out))?;
            bodies.push(Some(poses::pose(&thing, &pose)?));
        }
        Ok(bodies)
    }
}

#[pymethods]
impl Simulation {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Frame>> {
        let mut place = self.sound()?;
        match place.next {
            0 => {
                place.next = 1;
                self.frame(py, &place).map(Some)
            }
            next if next > self.built.frames() => Ok(None),
            _ => self.stepped(py, &mut place, Told::default(), Force::Own).map(Some),
        }
    }

    /// Advances to the next frame. The first is 1, and you may step beyond the scene's last frame. What you leave out
    /// follows the scene.
    ///
    /// `head`: where the head is in the world (cm), as a (4, 4) matrix from head space or (position, quaternion (x, y,
    /// z, w)). `bodies`: the same for the scene's bodies, in order, None for those that follow the scene. `skin`: where
    /// the vertices of `head.mesh` are, (V, 3), in its order, unit and axes; roots ride on them, while contact with the
    /// head stays as the scene has it. `force`: replaces all fields of the scene, a vector or a `Field`. `jumped`: head,
    /// bodies and skin moved there at once, and the hair goes along without feeling it.
    #[pyo3(signature = (*, head=None, bodies=None, skin=None, force=None, jumped=false))]
    fn step(
        &self,
        py: Python<'_>,
        head: Option<Given<'_, PoseLike>>,
        bodies: Option<Given<'_, PosesLike>>,
        skin: Option<Given<'_, ArrayLike>>,
        force: Option<Given<'_, ForceLike>>,
        jumped: bool,
    ) -> PyResult<Frame> {
        let head = head.map(|head| poses::pose("head", &head.0)).transpose()?;
        let bodies = bodies.map(|bodies| self.bodies(&bodies.0)).transpose()?.unwrap_or_default();
        let skin = skin.map(|skin| points_of("skin", &skin.0)).transpose()?;
        let mut place = self.sound()?;
        let most = place.stepper.strongest_force();
        let force = force.map_or(Ok(Force::Own), |force| Force::of(&force.0, most))?;
        let skin = skin.map(|vertices| self.shape(py, &mut place, &vertices)).transpose()?;
        if skin.is_some()
            && let Some(mut riding) = self.other(py, &place, true)?
        {
            riding.set_state(&place.stepper).map_err(|refused| error::setting(py, refused))?;
            place.stepper = riding;
        }
        place.next = place.next.max(1);
        self.stepped(py, &mut place, Told { head, bodies, skin, jumped }, force)
    }

    /// The state of hair, head, bodies and skin, as bytes for `restore`. You may store them or send them to another process
    /// or machine.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let place = self.sound()?;
        let Place { stepper, next, way, shown, .. } = &*place;
        let hair = match shown {
            Some(points) => stepper.state_bytes_showing(points.get().points()),
            None => stepper.state_bytes(),
        };
        Ok(PyBytes::new(py, &way.bytes(*next, &hair)))
    }

    /// Goes back to a `state` of a simulation of the same hair and returns its frame. With the same settings, the
    /// motion continues bit for bit. Other settings are allowed.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<Frame> {
        let mut place = self.place()?;
        let refused = |(value, way_out): (String, String)| error::argument(py, "state of hair", value, &way_out);
        let Saved { mut way, next, skin, hair } = place.way.of_bytes(state).map_err(refused)?;
        if let Some([now, before]) = skin {
            let live = self.live(py, &mut place)?;
            let shape = |vertices| self.shape_of_state(py, &live, vertices);
            way.skin = Some([shape(now)?, shape(before)?]);
        }
        let mut other = self.other(py, &place, way.skin.is_some())?;
        let stepper = other.as_mut().unwrap_or(&mut place.stepper);
        stepper.set_state_bytes(hair).map_err(|refused| error::setting(py, refused))?;
        if let Some(other) = other {
            place.stepper = other;
        }
        // From now on the stepper shows these points itself, until the next step.
        (place.way, place.next, place.shown, place.failed) = (way, next, None, false);
        self.frame(py, &place)
    }

    /// An independent simulation from the current frame. It shares everything that no frame changes.
    fn copy(&self, py: Python<'_>) -> PyResult<Self> {
        let place = self.sound()?;
        let Place { stepper, next, way, live, shown, failed } = &*place;
        let (stepper, way, live) = (stepper.clone(), way.clone(), live.clone());
        let shown = shown.as_ref().map(|shown| shown.clone_ref(py));
        let place = Mutex::new(Place { stepper, next: *next, way, live, shown, failed: *failed });
        let Self { built, fields, offsets, .. } = self;
        let (built, fields, offsets) = (built.clone(), fields.clone(), offsets.clone_ref(py));
        Ok(Self { built, place, fields, rooms: Arc::default(), offsets })
    }

    fn __copy__(&self, py: Python<'_>) -> PyResult<Self> {
        self.copy(py)
    }

    #[pyo3(signature = (_memo: "object"))]
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.copy(py)
    }

    /// The strongest force for which the step is stable. Normal winds are a hundredth of it or less.
    #[getter]
    fn strongest_force(&self) -> PyResult<f32> {
        Ok(self.place()?.stepper.strongest_force())
    }

    fn __len__(&self) -> usize {
        self.built.frames() as usize + 1
    }

    fn __repr__(&self) -> String {
        // Whoever has it at work need not wait to be shown.
        let at = match self.place() {
            Ok(place) => format!("at frame {}", place.stepper.frame()),
            Err(_) => "at work".to_owned(),
        };
        format!("<nabiki.Simulation {}; {at}>", said::motion(&self.built))
    }

    /// The number of frames still to come, for progress bars.
    fn __length_hint__(&self) -> PyResult<usize> {
        let next = self.place()?.next;
        Ok((self.built.frames() + 1).saturating_sub(next) as usize)
    }

    /// Where strands begin in the points of each frame, with the end as the last value: (S + 1,) uint32.
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(self.offsets.bind(py).clone())
    }

    /// The number of each strand among all strands of the scene: (S,) uint32.
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Hinted<'py, UInt32> {
        Hinted::new(PyArray1::from_slice(py, &self.built.groom.ids))
    }
}
