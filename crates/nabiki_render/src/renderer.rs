//! Draws a frame, from strands to light.

mod blocks;
mod compose;
mod depth_of_field;
mod seen;

use compose::Drawing;
use glam::Vec3;
use nabiki::{Head, Mesh, Strands};
use rayon::prelude::*;
use seen::Seen;

use crate::RenderError;
use crate::backdrop::Backdrop;
use crate::camera::View;
use crate::colour::{self, luminance};
use crate::curve::{CurveNode, Curves, bounds, drawable};
use crate::draft::{Draft, Shared};
use crate::focus::{Spread, Subject};
use crate::frame::{Frame, Layer};
use crate::light::approx::exp_of_negative;
use crate::light::fibre::Fibre;
use crate::light::headlight::SolidShadows;
use crate::light::kajiya::KajiyaKay;
use crate::light::lamps::{Lamp, lamps, zenith};
use crate::light::shade::{HairLight, Model};
use crate::light::shadow::{Crossings, Scene, SkinPlace, Sweep, sweep};
use crate::light::sky::{OnSkin, SkyMap};
use crate::moment::{DrawnBody, FrameToDraw};
use crate::raster::bins::Bins;
use crate::raster::{Node, TILE};
use crate::scalp::{Scalp, roots};
use crate::settings::{Antialiasing, Picture, Shading};
use crate::shutter::{Exposure, Shot};
use crate::skin::{FromLamp, Reached, SkinLight, SkinPixel, SkinView, Solids, placed};
use crate::timing::{Clock, Stage, Timing};
use crate::tone_mapping::linear_from_srgb;

/// How far off the skin (cm) it is asked how much hair lies before it: roots lie within.
const OFF_SKIN: f32 = 0.15;
/// How far a piece may leave traces beyond its own width (pixels): a cell, and its overhang.
const MARGIN: f32 = 1.25;

/// Draws frames of strands on a head, with other bodies. It keeps its working memory between frames, and everything
/// that does not change while camera, lamps, head and bodies do not move.
pub struct Renderer {
    picture: Picture,
    layers: bool,
    draft: Option<Draft>,
    head: Mesh,
    face: bool,
    bodies: Vec<Mesh>,
    solids: Solids,
    /// Colours of the head and of the bodies (linear).
    skins: Vec<[f32; 3]>,
    /// What a lens is focused on.
    subject: Subject,
    model: Model,
    curves: Curves,
    radius: Vec<f32>,
    nodes: Vec<Node>,
    /// Whether the light of each node is asked for: it shows, or a neighbour does.
    lit: Vec<bool>,
    bins: Bins,
    sweeps: Vec<Sweep>,
    sky_map: SkyMap,
    /// In a draft: half the thickness of the strands that each strand stands for, at each node (cm), and what reaches skin.
    mass: Vec<f32>,
    reached: Vec<Reached>,
    zenith: Vec3,
    still: Option<Still>,
    /// Through how many points of a lens to draw, if that was asked for.
    lens_points: Option<usize>,
    timing: Timing,
}

/// What stays the same from frame to frame for one view.
struct Still {
    shot: Shot,
    beside: f32,
    lamps: Vec<Lamp>,
    solid_shadows: Vec<SolidShadows>,
    /// The bodies where they are in head space.
    bodies: Vec<Mesh>,
    skin: SkinView,
    /// Where it is asked how much hair lies before skin: where that is seen, pixel by pixel, and then what lights hair.
    receivers: Vec<SkinPlace>,
    /// In a draft: which places share what reaches them.
    shared: Shared,
    from_lamps: Vec<FromLamp>,
    roots: Vec<Vec3>,
    stubble: Vec<f32>,
    /// The colours of bare skin where it is painted; empty on heads that are not.
    painted: Vec<[f32; 3]>,
}

impl Still {
    /// So many receivers are places that are seen: the first.
    fn seen_receivers(&self) -> usize {
        if self.shared.first.is_empty() { self.skin.pixels.len() } else { self.shared.first.len() }
    }

    /// Tints the scalp about the roots of these strands.
    fn grow(&mut self, strands: &Strands, picture: &Picture) {
        let shade = picture.head.stubble * picture.hair.width;
        self.roots = roots(strands).collect();
        self.stubble = SkinLight::stubble(&self.skin.pixels, &Scalp::new(strands), shade);
    }
}

impl Renderer {
    /// A renderer for the settings of a scene and its head (head space, cm).
    ///
    /// # Errors
    /// If a setting is out of range, a vertex of the head is not finite, or a triangle has an invalid index.
    pub fn new(picture: &Picture, head: &Mesh) -> Result<Self, RenderError> {
        picture.check()?;
        check_mesh(head, "the head")?;
        let look = &picture.hair;
        let model = match look.shading {
            Shading::Fibre => Model::Fibre(Box::new(Fibre::new(look))),
            Shading::KajiyaKay => {
                let colour = colour::albedo(colour::absorption(look), look.azimuthal_roughness);
                Model::KajiyaKay(KajiyaKay::new(colour, look.roughness.to_radians()))
            }
        };
        Ok(Self {
            picture: picture.clone(),
            layers: false,
            draft: None,
            head: head.clone(),
            face: false,
            bodies: Vec::new(),
            solids: Solids::new(head, std::iter::empty()),
            skins: vec![picture.head.colour.map(linear_from_srgb)],
            subject: Subject::of_mesh(head),
            model,
            curves: Curves::default(),
            radius: Vec::new(),
            nodes: Vec::new(),
            lit: Vec::new(),
            bins: Bins::default(),
            sweeps: Vec::new(),
            sky_map: SkyMap::default(),
            mass: Vec::new(),
            reached: Vec::new(),
            zenith: Vec3::Y,
            still: None,
            lens_points: None,
            timing: Timing::default(),
        })
    }

    /// The least memory (bytes) for drawing this many strands with these settings. `layers` includes the layers of
    /// frames.
    pub fn least_bytes(picture: &Picture, strands: usize, layers: bool) -> u64 {
        let pixels = picture.size.iter().map(|&side| u64::from(side)).product::<u64>();
        let layers = if layers { size_of::<Layer>() } else { 0 };
        let pixel = size_of::<[f32; 4]>() + size_of::<f32>() + layers;
        // However straight it is, a strand has two ends.
        let strand = 2 * (size_of::<CurveNode>() + size_of::<Node>() + size_of::<f32>());
        pixels * pixel as u64 + strands as u64 * strand as u64
    }

    /// Draws the face of the head whose mesh was given, if it has one and `picture.head.face` is set. A lens without a
    /// focus distance is focused on this head.
    pub fn with_face(mut self, head: &Head) -> Self {
        self.face = head.is_builtin && self.picture.head.face;
        self.subject = Subject(head.ellipsoid);
        self.still = None;
        self
    }

    /// Draws these bodies as well, lit like the head, each in its colour. They hide hair and cast shadows like the
    /// head. Every frame gives their poses.
    ///
    /// # Errors
    /// As for [`new`](Self::new), about a body's mesh.
    pub fn with_bodies(mut self, bodies: Vec<DrawnBody>) -> Result<Self, RenderError> {
        for (i, body) in bodies.iter().enumerate() {
            check_mesh(&body.mesh, &format!("body {i}"))?;
        }
        self.solids = Solids::new(&self.head, bodies.iter().map(|body| &body.mesh));
        self.skins.truncate(1);
        self.skins.extend(bodies.iter().map(|body| body.colour.map(linear_from_srgb)));
        self.bodies = bodies.into_iter().map(|body| body.mesh).collect();
        self.still = None;
        Ok(self)
    }

    /// Draws the head (`None`) or a body, by its number, with other vertices in its own space (cm) from now on, as its skin bends.
    /// Motion blur shows the motion of its space, but not how it bends.
    ///
    /// # Panics
    /// If there is no such body, or the number of vertices is not that of its mesh.
    pub fn bend<'a>(&mut self, skins: impl IntoIterator<Item = (Option<usize>, &'a [Vec3])>) {
        let mut bent = false;
        for (body, vertices) in skins {
            let mesh = body.map_or(&mut self.head, |body| &mut self.bodies[body]);
            if mesh.positions != vertices {
                mesh.positions.copy_from_slice(vertices);
                bent = true;
            }
        }
        if bent {
            self.solids = Solids::new(&self.head, self.bodies.iter());
            self.still = None;
        }
    }

    /// Also fills the layers of hair direction and motion in frames (only with coverage antialiasing).
    pub fn with_layers(mut self) -> Self {
        self.layers = true;
        self
    }

    /// Draws with lower quality and faster, for previews.
    pub fn drafted(mut self, draft: Draft) -> Self {
        self.sky_map.coarsen(draft.sky_cell);
        self.draft = Some(draft);
        self.still = None;
        self
    }

    /// The settings.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Time spent so far on each stage of drawing.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Draws one frame like a camera whose shutter closes at this frame and opened `picture.shutter` of a frame
    /// earlier. For hair, motion blur takes little more time than a sharp frame, however fast it moves. For a head, the
    /// time grows with its movement on the picture. If the view has a lens, the frame is the mean of the pictures
    /// through its points.
    ///
    /// # Errors
    /// If a point of a strand is not finite (names the strand), the previous frame has other strands, or the number of
    /// poses is not that of the bodies.
    pub fn draw(&mut self, frame: &FrameToDraw) -> Result<Frame, RenderError> {
        for moment in [Some(&frame.now), frame.before.as_ref()].into_iter().flatten() {
            let (given, bodies) = (moment.bodies.len(), self.bodies.len());
            if given != bodies {
                return Err(RenderError::Geometry(format!("{given} poses for {bodies} bodies: give one for each")));
            }
        }
        if frame.now.view.lens.is_some() {
            return self.draw_through_lens(frame);
        }
        let mut clock = self.timing.start();
        let exposure = Exposure::new(frame, self.picture.shutter)?;
        self.light(&exposure, &exposure.shot, 0.0, &mut clock)?;
        let shot = &exposure.shot;
        self.bins.fill(&self.nodes, shot.middle.size, MARGIN, Spread::default());
        clock.lap(&mut self.timing, Stage::Sorting);
        let still = self.still.as_ref().expect("stands");
        let seen = Drawing { shot, nodes: &self.nodes, bins: &self.bins, skin: &still.skin };
        let crossings = self.crossings();
        let light = self.skin_light(&crossings);
        let on_skin = |i: usize, place: &SkinPixel, sky: Option<&mut OnSkin>| self.skin_light_of(&light, i, place, sky);
        let backdrop = Backdrop::new(&self.picture, shot.middle.size[1] as usize);
        let frame = match self.picture.antialiasing {
            Antialiasing::Coverage if self.layers => self.compose::<true>(&seen, &backdrop, on_skin),
            Antialiasing::Coverage => self.compose::<false>(&seen, &backdrop, on_skin),
            Antialiasing::Oversample => self.oversample(&seen, &backdrop, on_skin),
        };
        clock.lap(&mut self.timing, Stage::Pixels);
        Ok(frame)
    }

    /// Lights hair and what of the skin can be seen. Skin is where it is in the shot `still`, or so many pixels `beside` it.
    fn light(&mut self, exposure: &Exposure, still: &Shot, beside: f32, clock: &mut Clock) -> Result<(), RenderError> {
        let view = &exposure.shot.middle;
        self.curves.build(&exposure.strands, &exposure.moved, &self.picture.hair, view)?;
        clock.lap(&mut self.timing, Stage::Curves);
        self.stand(exposure, still, beside);
        clock.lap(&mut self.timing, Stage::Head);
        self.project(&exposure.shot);
        clock.lap(&mut self.timing, Stage::Projection);
        self.occlude(view);
        clock.lap(&mut self.timing, Stage::Occlusion);
        self.reach_skin();
        self.shade(view);
        clock.lap(&mut self.timing, Stage::Shading);
        Ok(())
    }

    /// Prepares what stays the same while nothing but the hair moves.
    fn stand(&mut self, exposure: &Exposure, shot: &Shot, beside: f32) {
        let lamps = lamps(&self.picture.lights, &exposure.view, &exposure.pose);
        self.zenith = zenith(&self.picture.sky, &exposure.pose);
        let strands = &exposure.strands;
        let before = self.still.take().filter(|s| s.lamps == lamps);
        let shadows = match before {
            Some(mut still) if still.shot == *shot && still.beside == beside => {
                if !roots(strands).eq(still.roots.iter().copied()) {
                    still.grow(strands, &self.picture);
                }
                self.still = Some(still);
                return;
            }
            // The head stands still in the same light, and so does its shadow.
            Some(still) => still.solid_shadows,
            None => Vec::new(),
        };
        self.sky_map.forget_seen();
        let bodies: Vec<Mesh> =
            self.bodies.iter().zip(&shot.bodies).map(|(mesh, at)| placed(mesh, &at.middle)).collect();
        let solid_shadows: Vec<_> = if self.picture.shadows {
            let of_lamp = |(l, lamp)| match shadows.get(l) {
                Some(before) => SolidShadows::with_bodies(before, lamp, &bodies),
                None => SolidShadows::new(lamp, &self.head, &bodies),
            };
            lamps.par_iter().enumerate().map(of_lamp).collect()
        } else {
            Vec::new()
        };
        let skin = SkinView::new(&self.solids, shot).seen_from_beside(beside, shot.middle.size);
        let shared = match self.draft {
            Some(_) => {
                let [across, down] = shot.middle.size.map(|side| (side as usize).div_ceil(TILE));
                Shared::of(&skin, across * down)
            }
            None => Shared::default(),
        };
        let receiver = |p: &SkinPixel| off_skin(p.position, p.normal);
        let receivers = match self.draft {
            Some(_) => shared.first.iter().map(|&i| receiver(&skin.pixels[i as usize])).collect(),
            None => skin.pixels.iter().map(receiver).collect(),
        };
        let from_lamps = SkinLight::from_lamps(&skin.pixels, &lamps, &solid_shadows, &self.picture.head, &shot.middle);
        let painted = if self.face {
            SkinLight::painted(&skin.pixels, self.skins[0], self.hair_colour(), &shot.middle)
        } else {
            Vec::new()
        };
        let (roots, stubble) = (Vec::new(), Vec::new());
        let shot = shot.clone();
        let mut still = Still {
            shot,
            beside,
            lamps,
            solid_shadows,
            bodies,
            skin,
            receivers,
            shared,
            from_lamps,
            roots,
            stubble,
            painted,
        };
        still.grow(strands, &self.picture);
        self.still = Some(still);
    }

    fn project(&mut self, shot: &Shot) {
        let look = &self.picture.hair;
        self.curves
            .nodes
            .par_iter()
            .with_min_len(4096)
            .map(|n| {
                let thin = ((n.along.min(1.0) - 1.0 + look.taper) / look.taper.max(1e-6)).clamp(0.0, 1.0);
                0.5 * look.width * (1.0 - thin * (1.0 - look.tip))
            })
            .collect_into_vec(&mut self.radius);
        let skin = &self.still.as_ref().expect("stands").skin;
        let seen = Seen { curves: &self.curves, radius: &self.radius, shot, skin, spread: Spread::default() };
        (0..self.curves.nodes.len())
            .into_par_iter()
            .with_min_len(4096)
            .map(|i| seen.node(i))
            .collect_into_vec(&mut self.nodes);
        let shows = |n: &Node| n.drawable && !n.hidden;
        let nodes = &self.nodes;
        (0..nodes.len())
            .into_par_iter()
            .with_min_len(8192)
            .map(|i| nodes[i.saturating_sub(1)..(i + 2).min(nodes.len())].iter().any(shows))
            .collect_into_vec(&mut self.lit);
    }

    /// Finds what stands in the way of lamps and sky.
    fn occlude(&mut self, view: &View) {
        let still = self.still.as_mut().expect("stands");
        let nodes = &self.curves.nodes;
        let lamps: &[Lamp] = if self.picture.shadows { &still.lamps } else { &[] };
        let bounds = bounds(nodes);
        let (occluded, sky_map) = (self.picture.sky.is_occluded(), &mut self.sky_map);
        let seen_receivers = still.seen_receivers();
        still.receivers.truncate(seen_receivers);
        if occluded {
            let seen = still.skin.pixels.par_iter().map(|p| p.position);
            sky_map.lay_out(bounds, self.picture.hair.width, (&self.head, &still.bodies), self.zenith, seen);
            still.receivers.extend(sky_map.skin().iter().map(|skin| off_skin(skin.place, skin.normal)));
        }
        let width = self.picture.hair.width;
        let least_facing = SkinLight::least_facing(&self.picture.head);
        let (radius, least_cell) = match self.draft {
            Some(draft) => {
                self.mass.clear();
                self.mass.extend(self.radius.iter().map(|radius| draft.stands_for * radius));
                (&self.mass, draft.lamp_cell)
            }
            None => (&self.radius, 0.0),
        };
        let skin = &still.receivers;
        let scene = Scene { nodes, radius, asked: &self.lit, skin, least_facing, width, least_cell, bounds };
        // Some more tasks than threads, which take turns of unlike length.
        let strips = (2 * rayon::current_num_threads()).div_ceil(lamps.len().max(1));
        let sweeps = &mut self.sweeps;
        let cast = || sweep(sweeps, lamps, &still.solid_shadows, &scene, strips);
        let cover = || {
            if occluded {
                sky_map.fill(nodes, radius);
            }
        };
        // Parts of each run on one core only; side by side they fill each other's gaps.
        rayon::join(cover, cast);
        if occluded {
            let crossings: Vec<&Crossings> = self.sweeps.iter().map(|s| &s.crossings).collect();
            // The head's colour is that of all light from skin: a body counts as much more or less as it is lighter or darker.
            let as_head = |solid: u16| luminance(self.skins[usize::from(solid)]) / luminance(self.skins[0]).max(1e-3);
            let sky = &self.picture.sky;
            let first = nodes.len() + seen_receivers;
            self.sky_map.gather((nodes, &self.lit), view, &still.lamps, |open, i, skin| {
                let place = off_skin(skin.place, skin.normal).at;
                let mut lit = 0.0;
                for (l, lamp) in still.lamps.iter().enumerate() {
                    let facing = skin.normal.dot(lamp.toward);
                    if facing <= 0.0 {
                        continue;
                    }
                    let hair = crossings.get(l).map_or(1.0, |c| exp_of_negative(-c.at(first + i)));
                    let solid =
                        still.solid_shadows.get(l).map_or(1.0, |s| s.visible(&place.to_array().map(|c| [c]))[0]);
                    lit += luminance(lamp.strength) * facing * hair * solid;
                }
                let up = 0.5 + 0.5 * skin.normal.dot(self.zenith);
                let [above, below] = open.at(skin.place + 0.9 * skin.normal, skin.normal);
                let sky =
                    sky.strength * (luminance(sky.above) * up * above + luminance(sky.below) * (1.0 - up) * below);
                (lit + sky) * as_head(skin.solid)
            });
        }
    }

    /// Finds what reaches the places on skin that share it, in a draft.
    fn reach_skin(&mut self) {
        if self.draft.is_none() {
            return;
        }
        let mut reached = std::mem::take(&mut self.reached);
        let still = self.still.as_ref().expect("stands");
        let crossings = self.crossings();
        let light = self.skin_light(&crossings);
        (still.shared.first.par_iter().enumerate().with_min_len(256))
            .map_init(
                || self.occluded_sky().map(OnSkin::new),
                |sky, (receiver, &i)| light.reach(receiver, &still.skin.pixels[i as usize], sky.as_mut()),
            )
            .collect_into_vec(&mut reached);
        self.reached = reached;
    }

    /// Lights all nodes.
    fn shade(&mut self, view: &View) {
        let mut nodes = std::mem::take(&mut self.nodes);
        let still = self.still.as_ref().expect("stands");
        let crossings = self.crossings();
        let hair = HairLight {
            model: &self.model,
            variation: self.picture.hair.variation,
            lamps: &still.lamps,
            crossings: &crossings,
            solid_shadows: &still.solid_shadows,
            sky: &self.picture.sky,
            sky_map: self.occluded_sky(),
            skin: self.skins[0],
            view,
        };
        hair.shade(&self.curves.nodes, &self.lit, &mut nodes);
        self.nodes = nodes;
    }

    fn skin_light<'a>(&'a self, crossings: &'a [&'a Crossings]) -> SkinLight<'a> {
        let still = self.still.as_ref().expect("stands");
        SkinLight {
            look: &self.picture.head,
            from_lamps: &still.from_lamps,
            lamps: still.lamps.len(),
            crossings,
            first_receiver: self.curves.nodes.len(),
            shared: &still.shared.number,
            reached: &self.reached,
            sky: &self.picture.sky,
            zenith: self.zenith,
            skins: &self.skins,
            painted: &still.painted,
            hair: self.hair_colour(),
            decay: self.model.decay(),
            stubble: &still.stubble,
        }
    }

    /// The colour of a mass of the hair (linear).
    fn hair_colour(&self) -> [f32; 3] {
        colour::of_mass(&self.picture.hair)
    }

    fn crossings(&self) -> Vec<&Crossings> {
        self.sweeps.iter().map(|s| &s.crossings).collect()
    }

    fn occluded_sky(&self) -> Option<&SkyMap> {
        self.picture.sky.is_occluded().then_some(&self.sky_map)
    }
}

/// Where it is asked how much hair lies before a place on the skin.
fn off_skin(place: Vec3, normal: Vec3) -> SkinPlace {
    SkinPlace { at: place + OFF_SKIN * normal, normal }
}

/// Refuses what cannot be drawn of a mesh that is called `name`.
fn check_mesh(mesh: &Mesh, name: &str) -> Result<(), RenderError> {
    if let Some(v) = mesh.positions.iter().position(|&p| !drawable(p)) {
        let p = mesh.positions[v];
        return Err(RenderError::Geometry(format!(
            "vertex {v} of {name} lies at {p}: every coordinate must be a number within 1e7 cm"
        )));
    }
    let vertices = mesh.positions.len();
    match mesh.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
        Some(t) => Err(RenderError::Geometry(format!("triangle {t} of {name} names a vertex past its {vertices}"))),
        None => Ok(()),
    }
}
