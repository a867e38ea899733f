//! Frames through a lens: the mean of what its points see.
//!
//! Hair and skin are lit once, as the middle of the lens sees them. For each point of the lens they are brought to the picture and drawn anew,
//! hair widened by what lies between one point and the next. The points follow one another and each is drawn by all threads, so the
//! mean is the same for any number of them.

use glam::Vec3;
use nabiki::SettingError;
use rayon::prelude::*;

use super::compose::{Drawing, empty};
use super::seen::Seen;
use super::{MARGIN, Renderer};
use crate::RenderError;
use crate::backdrop::Backdrop;
use crate::camera::{NEAR, View};
use crate::focus::{LensPoints, Spread};
use crate::frame::Frame;
use crate::lens::Lens;
use crate::light::sky::OnSkin;
use crate::moment::{FrameToDraw, Moment};
use crate::raster::Node;
use crate::raster::bins::Bins;
use crate::shutter::{Exposure, Shot};
use crate::skin::{LitSkin, SkinPixel, SkinView};
use crate::timing::Stage;

/// The widest circle of confusion of skin that is drawn (radius, picture heights): skin is lit that far beyond every edge of
/// the picture.
const MOST_BLUR: f32 = 3.0;

impl Renderer {
    /// Draws through this many points of a lens, instead of the number that its blur requires.
    pub fn with_lens_points(mut self, count: usize) -> Self {
        self.lens_points = Some(count);
        self
    }

    pub(super) fn draw_through_lens(&mut self, frame: &FrameToDraw) -> Result<Frame, RenderError> {
        let mut clock = self.timing.start();
        let focused = |moment: Moment| -> Result<_, RenderError> {
            let lens = self.subject.focus(&moment.view.in_head(&moment.pose))?.lens;
            Ok(View { lens, ..moment.view })
        };
        let now = Moment { view: focused(frame.now)?, ..frame.now };
        let before = frame.before.map(|before| Ok::<_, RenderError>(Moment { view: focused(before)?, ..before }));
        let frame = FrameToDraw { now, before: before.transpose()? };
        let mut exposure = Exposure::new(&frame, self.picture.shutter)?;
        let shot = exposure.shot;
        let skin = self.extent_of_skin(&shot);
        self.check_blur(skin.blur, &shot.middle)?;
        // Wide enough for all that the points see past the picture's edges.
        let border = skin.blur.ceil() as u32;
        exposure.shot = shot.seen(|view| View { size: view.size.map(|side| side + 2 * border), ..*view });
        let still = exposure.shot.halfway();
        self.light(&exposure, &still, skin.beside, &mut clock)?;
        let mut timing = self.timing;
        let lit = self.lit_skin(&still.middle, skin.beside);
        clock.lap(&mut timing, Stage::Shading);

        let hair = self.blur_of_hair(&shot.middle, border);
        let points = self.lens_points.map_or_else(|| LensPoints::for_blur(hair, skin.blur), LensPoints::new);
        let spread = Spread::new(&shot.middle, &points);
        let mut sum = empty(&shot.middle, false);
        let (mut nodes, mut bins) = (Vec::new(), Bins::default());
        let none = Backdrop::none();
        for (turn, &through) in points.points.iter().enumerate() {
            let shot = shot.seen(|view| View { lens: view.lens.map(|lens| Lens { through, ..lens }), ..*view });
            let skin = SkinView::in_turn(&self.solids, &shot, turn);
            clock.lap(&mut timing, Stage::Head);
            self.nodes_through(&shot, &skin, spread, &mut nodes);
            clock.lap(&mut timing, Stage::Projection);
            bins.fill(&nodes, shot.middle.size, MARGIN, spread);
            clock.lap(&mut timing, Stage::Sorting);
            let seen = Drawing { shot: &shot, nodes: &nodes, bins: &bins, skin: &skin };
            let on_skin = |_: usize, place: &SkinPixel, _: Option<&mut OnSkin>| {
                self.shows(place.solid).then(|| lit.at(place.solid, place.position))
            };
            let drawn = if self.layers {
                self.compose::<true>(&seen, &none, on_skin)
            } else {
                self.compose::<false>(&seen, &none, on_skin)
            };
            add(&mut sum, drawn);
            clock.lap(&mut timing, Stage::Pixels);
        }
        divide(&mut sum, points.points.len() as f32);
        Backdrop::new(&self.picture, shot.middle.size[1] as usize).lay_behind(&mut sum);
        clock.lap(&mut timing, Stage::Pixels);
        self.timing = timing;
        Ok(sum)
    }

    /// How blurred head and bodies are where they are on the picture.
    fn extent_of_skin(&self, shot: &Shot) -> Extent {
        let view = &shot.middle;
        let Some(lens) = view.lens else { return Extent::default() };
        let positions = self.solids.positions(shot.bodies.iter().map(|body| body.middle));
        let of = |(i, &p): (usize, &Vec3)| {
            let at = view.project(p);
            if at.z < NEAR {
                return Extent::default();
            }
            let motion = shot.motion_of_solid(self.solids.solid_of(i as u32), p);
            let moved = 0.5 * motion.x.hypot(motion.y);
            let blur = lens.blur(at.z, view.scale).abs();
            let shows = touches(view, [at.x, at.y], blur + moved);
            // Against what lies behind, at any distance.
            let beside = 0.5 * lens.diameter * view.scale / at.z + moved;
            if shows { Extent { blur, beside } } else { Extent::default() }
        };
        positions.par_iter().enumerate().map(of).reduce(Extent::default, Extent::both)
    }

    /// Refuses a lens that blurs skin by so many pixels that what its points see is too large to be drawn.
    fn check_blur(&self, blur: f32, view: &View) -> Result<(), SettingError> {
        let heights = blur / view.size[1] as f32;
        if heights <= MOST_BLUR {
            return Ok(());
        }
        let f_stop = self.picture.camera.f_stop.map_or_else(|| "none".to_owned(), |f_stop| f_stop.to_string());
        let focus = view.lens.and_then(|lens| lens.focus).unwrap_or_default();
        let way_out = match self.picture.camera.focus_distance {
            Some(_) => "set picture.camera.focus_distance to where the head is",
            None => "keep bodies farther from the camera",
        };
        let remedy = format!(
            "with focus at {focus} cm, the head or a body is blurred by {heights:.1} picture heights, but at most {MOST_BLUR} \
             are allowed: raise it, or {way_out}"
        );
        Err(SettingError::new("picture.camera.f_stop", f_stop, remedy))
    }

    /// The radius of the widest circle of confusion of lit hair on the picture (pixels), whose nodes were found `border` pixels off.
    fn blur_of_hair(&self, view: &View, border: u32) -> f32 {
        let Some(lens) = view.lens else { return 0.0 };
        let of = |(n, &lit): (&Node, &bool)| {
            let blur = if lit && n.drawable { lens.blur(n.depth, view.scale).abs() } else { 0.0 };
            let shows = touches(view, n.at.map(|c| c - border as f32), blur);
            if shows { blur } else { 0.0 }
        };
        self.nodes.par_iter().zip(&self.lit).map(of).reduce(|| 0.0, f32::max)
    }

    /// The light of all skin that is seen.
    fn lit_skin(&self, view: &View, beside: f32) -> LitSkin<'_> {
        let still = self.still.as_ref().expect("stands");
        let crossings = self.crossings();
        let of_skin = self.skin_light(&crossings);
        let light = (still.skin.pixels.par_iter().enumerate().with_min_len(256))
            .map_init(
                || self.occluded_sky().map(OnSkin::new),
                |sky, (i, place)| if self.shows(place.solid) { of_skin.at(i, place, sky.as_mut()) } else { [0.0; 3] },
            )
            .collect();
        LitSkin::new(&still.skin, *view, light, beside)
    }

    /// The lit hair as a point of the lens sees it.
    fn nodes_through(&self, shot: &Shot, skin: &SkinView, spread: Spread, nodes: &mut Vec<Node>) {
        let seen = Seen { curves: &self.curves, radius: &self.radius, shot, skin, spread };
        let of = |i: usize| {
            let node = seen.node(i);
            Node { light: self.nodes[i].light, hidden: node.hidden || !self.lit[i], ..node }
        };
        (0..self.nodes.len()).into_par_iter().with_min_len(4096).map(of).collect_into_vec(nodes);
    }
}

/// Of head and bodies on the picture, the most of anywhere (pixels).
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    /// Radius of the circle of confusion.
    blur: f32,
    /// How far they move against what lies behind, between the middle of the lens and its edge, and while the shutter is open.
    beside: f32,
}

impl Extent {
    fn both(self, other: Self) -> Self {
        Self { blur: self.blur.max(other.blur), beside: self.beside.max(other.beside) }
    }
}

/// Whether a disc touches the picture (pixels).
fn touches(view: &View, at: [f32; 2], radius: f32) -> bool {
    (0..2).all(|i| at[i] > -radius && at[i] < view.size[i] as f32 + radius)
}

/// Adds a frame to a sum of frames; the nearest depth stays.
fn add(sum: &mut Frame, frame: Frame) {
    sum.rgba.par_iter_mut().zip(&frame.rgba).for_each(|(sum, p)| *sum = std::array::from_fn(|c| sum[c] + p[c]));
    sum.depth.par_iter_mut().zip(&frame.depth).for_each(|(sum, &depth)| *sum = sum.min(depth));
    if sum.layers.is_empty() {
        sum.layers = frame.layers;
        return;
    }
    sum.layers.par_iter_mut().zip(&frame.layers).for_each(|(sum, layer)| {
        (0..3).for_each(|c| sum.direction[c] += layer.direction[c]);
        (0..2).for_each(|c| sum.motion[c] += layer.motion[c]);
        sum.hair += layer.hair;
        sum.head += layer.head;
    });
}

/// Makes the sum of so many frames their mean.
fn divide(sum: &mut Frame, count: f32) {
    sum.rgba.par_iter_mut().for_each(|p| *p = p.map(|c| c / count));
    sum.layers.par_iter_mut().for_each(|layer| {
        layer.direction = layer.direction.map(|c| c / count);
        layer.motion = layer.motion.map(|c| c / count);
        layer.hair /= count;
        layer.head /= count;
    });
}
