//! Strands through the frames, with their derivatives by a few unknowns: forward-mode differentiation of the
//! specification, strand by strand on all cores.

use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, Vec3};
use pulp::NullaryFnOnce;
use rayon::prelude::*;

use super::air::{Air, Breeze};
use super::free::{self, Crowd, Springs};
use super::paper::{self, PolarAxis};
use super::standing::{self, Moved, Standing, Standings};
use super::{ForceSpace, Form, FrameInput};
use crate::error::SettingError;
use crate::field::{Field, ROW, VectorRow, WIND};
use crate::free_form::{FreeMotion, Neighbours};
use crate::region::FieldShares;
use crate::scalar::{Dual, Scalar, Vector};

/// A point that is wanted in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Asked {
    pub strand: usize,
    pub frame: u32,
    pub node: usize,
}

/// How what moves the hair depends on the unknowns.
pub(crate) struct Change<'a> {
    /// Everything that pushes.
    pub field: &'a dyn Field,
    /// The effect of a wind of 1 along x, y and z.
    pub of_wind: &'a [Arc<dyn Field>; 3],
    /// For each frame from 1 on: how the wind changes with each unknown.
    pub wind: &'a [Vec<DVec3>],
    /// The unknown that is the logarithm of a factor on the stiffness.
    pub stiffness: Option<usize>,
    /// The same on the frames in which a swing settles.
    pub settle: Option<usize>,
}

/// Points in a frame, and for each of their coordinates how it changes with each unknown.
#[derive(Clone, Debug, Default)]
pub(crate) struct Points {
    /// Head space, cm, in the requested order.
    pub places: Vec<DVec3>,
    /// Three rows for each point, each with one number per unknown.
    pub tangents: Vec<f64>,
}

/// Takes strands through the frames up to the last one that is asked for. `asked`: ascending, by strand and frame. What is asked for
/// up to the frame in which they stand does not change with any unknown, and has no place.
///
/// # Errors
/// Strands that cannot be moved.
pub(crate) fn tangents(moved: &Moved, change: &Change, asked: &[Asked]) -> Result<Points, SettingError> {
    let unknowns = change.wind.first().map_or(0, Vec::len);
    let mut points = Points { places: vec![DVec3::ZERO; asked.len()], tangents: vec![0.0; 3 * unknowns * asked.len()] };
    let mut first = 0;
    while first < unknowns {
        // In the free form more than eight at a time do not fit in the registers: sixteen take more than three times as
        // long. In the paper's form they share the sines.
        let most = if moved.dynamics.form == Form::Paper { 16 } else { 8 };
        let count = (unknowns - first).min(most);
        let part = Part { moved, change, asked, columns: first..first + count, unknowns };
        match (&moved.dynamics.form, count) {
            (Form::Paper, 0..=4) => part.of_paper::<4>(&mut points)?,
            (Form::Paper, 5..=8) => part.of_paper::<8>(&mut points)?,
            (Form::Paper, _) => part.of_paper::<16>(&mut points)?,
            (Form::Free(free), 0..=4) => part.of_free::<4>(free, &mut points)?,
            (Form::Free(free), _) => part.of_free::<8>(free, &mut points)?,
        }
        first += count;
    }
    Ok(points)
}

/// Some of the unknowns, at most the N of its methods.
struct Part<'a> {
    moved: &'a Moved<'a>,
    change: &'a Change<'a>,
    asked: &'a [Asked],
    columns: Range<usize>,
    unknowns: usize,
}

impl Part<'_> {
    /// Of the frames that are stepped to.
    fn inputs(&self) -> Vec<FrameInput<'_>> {
        let last = self.asked.iter().map(|asked| asked.frame).max().unwrap_or(0);
        let Self { moved, change, .. } = self;
        (moved.from() + 1..=last).map(|n| FrameInput::new(n, moved.poses, change.field)).collect()
    }

    fn airs<'b, const N: usize>(&'b self, inputs: &'b [FrameInput]) -> Vec<Gale<'b, N>> {
        let space = self.moved.dynamics.motion.force_space;
        inputs.iter().map(|input| Gale::new(input, space, self.change, &self.columns)).collect()
    }

    fn of_paper<const N: usize>(&self, points: &mut Points) -> Result<(), SettingError> {
        let moved = self.moved;
        let inputs = self.inputs();
        let airs = self.airs::<N>(&inputs);
        let polar_from_head = PolarAxis::new(moved.dynamics.polar_axis).polar_from_head();
        let common = paper::Common { gamma: moved.dynamics.gamma(), polar_from_head };
        let walk = PaperWalk { moved, common, airs: &airs };
        let mut sinks = Sink::split(self.asked, points, self.columns.clone(), self.unknowns);
        sinks.par_iter_mut().try_for_each(|sink| alone(&walk, moved.from(), sink))
    }

    fn of_free<const N: usize>(&self, free: &FreeMotion, points: &mut Points) -> Result<(), SettingError> {
        let Self { moved, change, columns, .. } = self;
        let inputs = self.inputs();
        let airs = self.airs::<N>(&inputs);
        let unknown = |column: Option<usize>| {
            let mut factor = Dual::<N>::from(1.0);
            if let Some(column) = column.filter(|column| columns.contains(column)) {
                factor.tangents[column - columns.start] = 1.0;
            }
            factor
        };
        let springs = Springs { stiffness: unknown(change.stiffness), settle: unknown(change.settle) };
        let settings = inputs.iter().map(|input| free::Common::new(moved.dynamics, free, input)).collect();
        let walk = FreeWalk { moved, free, springs, settings, airs: &airs };
        let mut sinks = Sink::split(self.asked, points, columns.clone(), self.unknowns);
        match &free.neighbours {
            None => sinks.par_iter_mut().try_for_each(|sink| alone(&walk, moved.from(), sink)),
            Some(neighbours) => together(&walk, neighbours, &inputs, &mut sinks),
        }
    }
}

/// The destination of the points of one strand.
struct Sink<'a> {
    asked: &'a [Asked],
    places: &'a mut [DVec3],
    tangents: &'a mut [f64],
    columns: Range<usize>,
    unknowns: usize,
}

impl<'a> Sink<'a> {
    /// One for each requested strand.
    fn split(mut asked: &'a [Asked], points: &'a mut Points, columns: Range<usize>, unknowns: usize) -> Vec<Sink<'a>> {
        let (mut places, mut tangents) = (&mut points.places[..], &mut points.tangents[..]);
        let mut sinks = Vec::new();
        while let Some(first) = asked.first() {
            let count = asked.partition_point(|asked| asked.strand == first.strand);
            let (of_strand, others) = asked.split_at(count);
            let (near_places, far_places) = places.split_at_mut(count);
            let (near_tangents, far_tangents) = tangents.split_at_mut(3 * unknowns * count);
            let columns = columns.clone();
            sinks.push(Sink { asked: of_strand, places: near_places, tangents: near_tangents, columns, unknowns });
            (asked, places, tangents) = (others, far_places, far_tangents);
        }
        sinks
    }

    fn strand(&self) -> usize {
        self.asked[0].strand
    }

    /// The number of requests up to a frame.
    fn until(&self, frame: u32) -> usize {
        self.asked.partition_point(|asked| asked.frame <= frame)
    }

    /// Stores the requested points of a frame; the sink's first is number `from`. Returns the number stored by then.
    fn take<const N: usize>(&mut self, mut from: usize, frame: u32, positions: &[Vector<Dual<N>>]) -> usize {
        while let Some(asked) = self.asked.get(from).filter(|asked| asked.frame == frame) {
            let p = positions[asked.node];
            self.places[from] = p.value();
            for (axis, number) in [p.x, p.y, p.z].into_iter().enumerate() {
                let row = (3 * from + axis) * self.unknowns;
                let columns = row + self.columns.start..row + self.columns.end;
                self.tangents[columns].copy_from_slice(&number.tangents[..self.columns.len()]);
            }
            from += 1;
        }
        from
    }
}

/// Either form of the motion, a strand at a time.
trait Walk<const N: usize>: Sync {
    type Strand: Send;

    /// The strand in its current state.
    fn begin(&self, s: usize) -> Result<Self::Strand, SettingError>;

    /// By input `n`.
    fn step(&self, strand: &mut Self::Strand, s: usize, n: usize, crowd: Option<&Crowd>);

    fn positions(strand: &Self::Strand) -> &[Vector<Dual<N>>];
}

struct PaperWalk<'a, const N: usize> {
    moved: &'a Moved<'a>,
    common: paper::Common,
    airs: &'a [Gale<'a, N>],
}

impl<const N: usize> Walk<N> for PaperWalk<'_, N> {
    type Strand = paper::Strand<Dual<N>>;

    fn begin(&self, s: usize) -> Result<Self::Strand, SettingError> {
        if let Some(Standing { hair: Standings::Paper(hair), .. }) = self.moved.standing {
            return Ok(paper::Strand::of_known(&hair[s]));
        }
        paper::Strand::new(self.moved.dynamics, &self.common, self.moved.strands.strand(s), s)
    }

    #[inline(always)]
    fn step(&self, strand: &mut Self::Strand, s: usize, n: usize, _: Option<&Crowd>) {
        let disturbance = self.moved.dynamics.disturbance.as_ref();
        let frame = self.moved.from() + n as u32 + 1;
        let part = disturbance.and_then(|disturbance| Some((disturbance, disturbance.part(frame)?)));
        let disturbed = part.map(|(disturbance, part)| disturbance.turn(self.moved.ids[s], &part).map(f64::from));
        let skin = self.moved.dynamics.skin.as_ref().map(|skin| skin.at(frame));
        strand.step(&self.common, &self.airs[n], disturbed, skin);
    }

    fn positions(strand: &Self::Strand) -> &[Vector<Dual<N>>] {
        strand.positions()
    }
}

struct FreeWalk<'a, const N: usize> {
    moved: &'a Moved<'a>,
    free: &'a FreeMotion,
    springs: Springs<Dual<N>>,
    /// For every input.
    settings: Vec<free::Common<'a>>,
    airs: &'a [Gale<'a, N>],
}

impl<const N: usize> Walk<N> for FreeWalk<'_, N> {
    type Strand = free::Strand<Dual<N>>;

    fn begin(&self, s: usize) -> Result<Self::Strand, SettingError> {
        let Self { moved, free, springs, .. } = self;
        if let Some(Standing { hair: Standings::Free(hair), .. }) = moved.standing {
            return Ok(free::Strand::of_known(&hair[s]));
        }
        free::Strand::new(moved.dynamics, free, springs, moved.strands.strand(s), s)
    }

    #[inline(always)]
    fn step(&self, strand: &mut Self::Strand, _: usize, n: usize, crowd: Option<&Crowd>) {
        strand.step(&self.settings[n], &self.airs[n], crowd);
    }

    fn positions(strand: &Self::Strand) -> &[Vector<Dual<N>>] {
        strand.positions()
    }
}

/// Takes a strand without neighbours through all its frames.
fn alone<const N: usize, W: Walk<N>>(walk: &W, from: u32, sink: &mut Sink) -> Result<(), SettingError> {
    let s = sink.strand();
    let mut strand = walk.begin(s)?;
    let mut taken = sink.until(from);
    let mut n = 0;
    while let Some(next) = sink.asked.get(taken) {
        let frames = n..(next.frame - from) as usize;
        n = frames.end;
        let frame = next.frame;
        Stretch { walk, strand: &mut strand, s, frames, crowd: None }.run();
        taken = sink.take(taken, frame, W::positions(&strand));
    }
    Ok(())
}

/// Takes strands frame by frame among their neighbours: the carriers' grids count as constant for the tangents.
fn together<const N: usize>(
    walk: &FreeWalk<N>,
    neighbours: &Neighbours,
    inputs: &[FrameInput],
    sinks: &mut [Sink],
) -> Result<(), SettingError> {
    let FreeWalk { moved, .. } = *walk;
    let Moved { dynamics, .. } = moved;
    let from = moved.from();
    let (mut carriers, mut crowd) = match moved.crowds {
        Some(_) => (Vec::new(), None),
        None => {
            let (carriers, crowd) = standing::carriers_at_rest(dynamics, walk.free, neighbours)?;
            (carriers, Some(crowd))
        }
    };
    let mut points = vec![Vec3::ZERO; neighbours.carriers.points().len()];
    let mut velocities = points.clone();
    let mut hair = Vec::with_capacity(sinks.len());
    for sink in sinks.iter_mut() {
        hair.push((walk.begin(sink.strand())?, sink.until(from)));
    }
    for (n, input) in inputs.iter().enumerate() {
        let air = Breeze { input, space: dynamics.motion.force_space };
        let of_frame = moved.crowds.and_then(|crowds| crowds.0.get(n)).or(crowd.as_ref());
        let step = |((strand, taken), sink): (&mut (free::Strand<Dual<N>>, usize), &mut Sink)| {
            let (s, frames) = (sink.strand(), n..n + 1);
            Stretch { walk, strand, s, frames, crowd: of_frame }.run();
            *taken = sink.take(*taken, from + n as u32 + 1, strand.positions());
        };
        rayon::join(
            || hair.par_iter_mut().zip(sinks.par_iter_mut()).for_each(step),
            || carriers.par_iter_mut().for_each(|strand| strand.step(&walk.settings[n], &air, of_frame)),
        );
        if let Some(crowd) = &mut crowd {
            standing::collect(&carriers, &mut points, &mut velocities);
            crowd.fill(&points, &velocities);
        }
    }
    Ok(())
}

/// A strand through some frames, compiled for the widest vectors that the machine has.
struct Stretch<'a, W: Walk<N>, const N: usize> {
    walk: &'a W,
    strand: &'a mut W::Strand,
    s: usize,
    frames: Range<usize>,
    crowd: Option<&'a Crowd>,
}

impl<const N: usize, W: Walk<N>> Stretch<'_, W, N> {
    /// Compiled again wherever it is dispatched: only here.
    #[inline(never)]
    fn run(self) {
        pulp::Arch::new().dispatch(self);
    }
}

impl<const N: usize, W: Walk<N>> NullaryFnOnce for Stretch<'_, W, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for n in self.frames {
            self.walk.step(self.strand, self.s, n, self.crowd);
        }
    }
}

/// The force in one frame, with its tangents.
struct Gale<'a, const N: usize> {
    field: &'a dyn Field,
    of_wind: &'a [Arc<dyn Field>; 3],
    frame: u32,
    /// From head space to the space of the field.
    rotation: DQuat,
    position: DVec3,
    /// The force (head space), if it is the same everywhere.
    uniform: Option<Vector<Dual<N>>>,
    /// How the wind changes with the unknowns (the field's space); none if it does not.
    wind: Option<[DVec3; N]>,
}

/// Half the distance for a field's derivatives in space (cm): fields are f32, and smooth over centimetres.
const STEP_CM: f32 = 0.02;

impl<'a, const N: usize> Gale<'a, N> {
    fn new(input: &FrameInput<'a>, space: ForceSpace, change: &Change<'a>, columns: &Range<usize>) -> Self {
        let FrameInput { frame, pose, field, .. } = *input;
        let (rotation, position) = match space {
            ForceSpace::Head => (DQuat::IDENTITY, DVec3::ZERO),
            ForceSpace::World => (pose.rotation.as_dquat(), pose.position_cm.as_dvec3()),
        };
        let mut wind = [DVec3::ZERO; N];
        wind[..columns.len()].copy_from_slice(&change.wind[frame as usize - 1][columns.clone()]);
        let of_wind = change.of_wind;
        let everywhere = [0, 1, 2].map(|i| of_wind[i].uniform(frame));
        let uniform = match (field.uniform(frame), everywhere) {
            (Some(force), [Some(x), Some(y), Some(z)]) => {
                let matrix = DMat3::from_cols(x.as_dvec3(), y.as_dvec3(), z.as_dvec3());
                let tangents = wind.map(|wind| rotation.inverse() * (matrix * wind));
                Some(with_tangents(rotation.inverse() * force.as_dvec3(), &tangents))
            }
            _ => None,
        };
        let wind = wind.iter().any(|wind| *wind != DVec3::ZERO).then_some(wind);
        Self { field, of_wind, frame, rotation, position, uniform, wind }
    }

    /// The force at a point, if it varies in space.
    #[inline(never)]
    fn at(&self, at: Vector<Dual<N>>, shares: &FieldShares) -> Vector<Dual<N>> {
        let point = (self.rotation * at.value() + self.position).as_vec3();
        let mut points = VectorRow::default();
        for axis in 0..3 {
            points[axis] = [point[axis]; ROW];
            points[axis][1 + 2 * axis] += STEP_CM;
            points[axis][2 + 2 * axis] -= STEP_CM;
        }
        let mut forces = VectorRow::default();
        match shares.is_empty() {
            true => self.field.at_row(&points, self.frame, &mut forces),
            false => {
                let share = |name: &str| Some([shares.of(name); ROW]);
                self.field.at_row_shared(&points, self.frame, &share, &mut forces);
            }
        }
        let force = |i: usize| DVec3::new(forces[0][i].into(), forces[1][i].into(), forces[2][i].into());
        let slope = |axis: usize| {
            let [ahead, behind] = [1 + 2 * axis, 2 + 2 * axis];
            (force(ahead) - force(behind)) / f64::from(points[axis][ahead] - points[axis][behind])
        };
        let head_from_field = DMat3::from_quat(self.rotation.inverse());
        let in_field = DMat3::from_cols(slope(0), slope(1), slope(2));
        let value = self.rotation.inverse() * force(0);
        let moved = Dual::known_vector(value, at, || head_from_field * in_field * head_from_field.transpose());
        let Some(wind) = &self.wind else { return moved };
        let [x, y, z] = [0, 1, 2].map(|i| self.of_wind[i].at(point, self.frame).as_dvec3());
        // In a field without parts, the wind has no share of its own.
        let named = self.field.parts().iter().any(|name| name == WIND);
        let share = if named { f64::from(shares.of(WIND)) } else { 1.0 };
        let matrix = share * head_from_field * DMat3::from_cols(x, y, z);
        moved + with_tangents(DVec3::ZERO, &wind.map(|wind| matrix * wind))
    }
}

impl<const N: usize> Air<Dual<N>> for Gale<'_, N> {
    #[inline(always)]
    fn force(&self, at: Vector<Dual<N>>, shares: &FieldShares) -> Vector<Dual<N>> {
        match self.uniform {
            Some(force) if shares.is_empty() => force,
            _ => self.at(at, shares),
        }
    }
}

fn with_tangents<const N: usize>(value: DVec3, tangents: &[DVec3; N]) -> Vector<Dual<N>> {
    let along = |value: f64, axis: usize| Dual { value, tangents: tangents.map(|t| t[axis]) };
    Vector::new(along(value.x, 0), along(value.y, 1), along(value.z, 2))
}
