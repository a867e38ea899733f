//! What all shaders know: camera, lamps, look. The same numbers as common.wgsl's `Globals`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};
use nabiki::{Ellipsoid, Pose};
use nabiki_render::live::{self, FibreTables};
use nabiki_render::settings::{Projection, Shading};
use nabiki_render::{Picture, View, colour};

use super::volume::{LAMPS, Volume};

/// Lamps that shaders have room for; pictures have no more.
const MOST_LAMPS: usize = 16;
/// Half the width below which a ribbon takes part of a pixel's samples instead of growing thinner (px).
const LEAST_HALF_WIDTH: f32 = 0.7;
/// A strand is at most this many times as thick as one of the whole hair: thicker looks like rope.
const MOST_WIDENED: f32 = 8.0;

#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Lamp {
    toward: [f32; 3],
    channel: i32,
    strength: [f32; 3],
    pad: f32,
}

/// For the uniform buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Globals {
    eye: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    screen: [f32; 4],
    lamps: [Lamp; MOST_LAMPS],
    counts: [u32; 4],
    sky_above: [f32; 4],
    sky_below: [f32; 4],
    zenith: [f32; 4],
    skin: [f32; 4],
    hair: [f32; 4],
    decay: [f32; 4],
    volume_low: [f32; 4],
    volume_size: [f32; 4],
    spread: [f32; 4],
    look: [f32; 4],
    width: [f32; 4],
    centre: [f32; 4],
    axes: [f32; 4],
}

/// How much thicker a strand is drawn that stands for `share` of the whole hair: by what keeps the hair's surface, so that few
/// strands still hide the head; as `nabiki preview` has it.
pub fn widened(share: f32) -> f32 {
    share.max(1.0).sqrt().min(MOST_WIDENED)
}

/// How a strand that stands for many is drawn: as a lock of some.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Locks {
    /// Hairs of a lock.
    pub hairs: u32,
    /// Half of the room between neighbouring roots (cm).
    pub half_width: f32,
}

impl Locks {
    /// For so many strands on a head, each of which stands for `share`; at most `most` hairs each.
    pub fn new(strands: usize, share: f32, head: &Ellipsoid, most: u32) -> Self {
        let hairs = (share.max(1.0).sqrt().round() as u32).min(most);
        // Hair grows on half of a head.
        let scalp = std::f32::consts::TAU * head.half_axes.element_product().cbrt().powi(2);
        Self { hairs, half_width: 0.5 * (scalp / strands.max(1) as f32).sqrt() }
    }

    /// The part of the breadth of the whole hair that is drawn.
    fn drawn(&self, share: f32) -> f32 {
        (self.hairs as f32 * self.wider(share) / share.max(1.0)).min(1.0)
    }

    /// How much thicker each hair of a lock is than one of the whole.
    fn wider(&self, share: f32) -> f32 {
        (share.max(1.0) / self.hairs as f32).sqrt().min(MOST_WIDENED)
    }
}

/// The lamps of a picture for a camera and a head in the world, toward which directions of head space.
pub fn lamps(picture: &Picture, world: &View, pose: &Pose) -> Vec<live::Lamp> {
    live::lamps(&picture.lights, world, pose)
}

/// All of it but the volume and the number of points.
pub fn globals(
    picture: &Picture,
    world: &View,
    pose: &Pose,
    ellipsoid: &Ellipsoid,
    tables: &FibreTables,
    share: f32,
    locks: Locks,
) -> Globals {
    let head = world.in_head(pose);
    let (look, sky) = (&picture.hair, &picture.sky);
    let lit = lamps(picture, world, pose);
    let mut of_lamps = [Lamp::default(); MOST_LAMPS];
    for (l, (to, lamp)) in of_lamps.iter_mut().zip(&lit).enumerate() {
        let channel = if picture.shadows && l < LAMPS { l as i32 } else { -1 };
        *to = Lamp { toward: lamp.toward.to_array(), channel, strength: lamp.strength, pad: 0.0 };
    }
    let strength = |c: [f32; 3]| c.map(|c| c * sky.strength);
    let decay = match look.shading {
        Shading::Fibre => tables.decay(),
        Shading::KajiyaKay => [1.0; 3],
    };
    let [variance_r, variance_tt, variance_trt] = tables.variances;
    let is_parallel = f32::from(head.projection == Projection::Orthographic);
    Globals {
        eye: of(head.eye, 0.0),
        right: of(head.right, 0.0),
        up: of(head.up, 0.0),
        forward: of(head.forward, 0.0),
        screen: [head.size[0] as f32, head.size[1] as f32, head.scale, is_parallel],
        lamps: of_lamps,
        counts: [lit.len().min(MOST_LAMPS) as u32, 0, 0, u32::from(look.shading == Shading::KajiyaKay)],
        sky_above: of(strength(sky.above).into(), live::SKY_KEPT),
        sky_below: of(strength(sky.below).into(), live::ON_SKIN),
        zenith: of(live::zenith(sky, pose), 0.0),
        skin: of(picture.head.colour.map(nabiki_render::tone_mapping::linear_from_srgb).into(), picture.head.softness),
        hair: of(colour::of_mass(look).into(), picture.head.sheen),
        decay: of(decay.into(), 0.0),
        volume_low: [0.0, 0.0, 0.0, 1.0],
        volume_size: [1.0; 4],
        spread: [variance_r, variance_tt, variance_trt, live::STRAYS],
        look: [
            tables.tilt,
            live::TILT_SPREAD * look.variation,
            (2.0 * look.roughness.to_radians()).powi(-2),
            LEAST_HALF_WIDTH,
        ],
        width: [0.5 * look.width * locks.wider(share), look.tip, look.taper, locks.half_width],
        centre: of(ellipsoid.center, 0.0),
        axes: of(ellipsoid.half_axes, locks.drawn(share)),
    }
}

impl Globals {
    /// With so many points, in segments of so many pieces, in locks of so many hairs.
    pub fn count(&mut self, points: usize, pieces: u32, hairs: u32) {
        self.counts[1] = points as u32;
        self.counts[2] = pieces | hairs << 16;
    }

    /// With the place of a volume.
    pub fn around(&mut self, volume: &Volume) {
        self.volume_low = of(volume.low, 1.0 / volume.cell);
        self.volume_size = of(volume.size.as_vec3(), 0.0);
    }
}

/// For show.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Show {
    top: [f32; 4],
    bottom: [f32; 4],
}

impl Show {
    /// How a picture shows its light.
    pub fn new(picture: &Picture) -> Self {
        let filmic = picture.tone_mapping == nabiki_render::settings::ToneCurve::Filmic;
        let back = &picture.background;
        Self { top: of(back.top.into(), picture.exposure.exp2()), bottom: of(back.bottom.into(), f32::from(filmic)) }
    }
}

fn of(v: Vec3, w: f32) -> [f32; 4] {
    Vec4::from((v, w)).to_array()
}
