//! How skin is lit.

use glam::Vec3;
use nabiki_groom::face::Paint;
use rayon::prelude::*;

use super::SkinPixel;
use crate::camera::View;
use crate::light::approx::{exp_of_negative, smooth};
use crate::light::headlight::SolidShadows;
use crate::light::lamps::Lamp;
use crate::light::shadow::Crossings;
use crate::light::sky::OnSkin;
use crate::scalp::Scalp;
use crate::settings::{HeadLook, Sky};

/// Light on skin.
pub struct SkinLight<'a> {
    pub look: &'a HeadLook,
    /// What arrives of each lamp at each place where no hair is in the way.
    pub from_lamps: &'a [FromLamp],
    pub lamps: usize,
    /// Fibres in front of each place, for each lamp; the first place is receiver `first_receiver`.
    pub crossings: &'a [&'a Crossings],
    pub first_receiver: usize,
    /// Of each place, the receiver that it shares with others, in a draft; empty where each is one.
    pub shared: &'a [u32],
    /// What reaches those, of the first from all lamps first; empty without.
    pub reached: &'a [Reached],
    pub sky: &'a Sky,
    /// Where the sky is above (head space, unit).
    pub zenith: Vec3,
    /// Colours of bare skin, the head's and of each body (linear).
    pub skins: &'a [[f32; 3]],
    /// The colours of the head's skin at each place, where it is painted; empty where it has one colour.
    pub painted: &'a [[f32; 3]],
    /// Colour of a mass of the hair (linear), for what of it is too short to be drawn.
    pub hair: [f32; 3],
    /// How fast light that hair in the way scatters grows less with each hair: it reaches skin as well.
    pub decay: [f32; 3],
    /// How much of each place is covered by hair too short to be drawn; empty without.
    pub stubble: &'a [f32],
}

/// A lamp's light on a place on skin that no hair hides: what falls onto it, and what its sheen sends toward the eye (linear).
#[derive(Clone, Copy, Default)]
pub struct FromLamp {
    fallen: [f32; 3],
    sheen: [f32; 3],
}

/// The light that other skin sends, and what arrives of each colour of the sky above and below, 0..1.
type FromSky = (f32, [[f32; 3]; 2]);

/// Most lamps that a picture has.
const MOST_LAMPS: usize = 16;

/// What reaches a receiver through hair: the part of each lamp, and the sky.
#[derive(Clone, Copy)]
pub struct Reached {
    lamps: [[f32; 3]; MOST_LAMPS],
    sky: FromSky,
}

/// The share of light scattered forward by hair that falls onto skin behind: it goes on to all sides.
pub const ON_SKIN: f32 = 0.4;

/// What is painted is looked at in at most so many places along each side of a pixel.
const MOST_PAINT: f32 = 6.0;

/// How far light creeps past the terminator under skin of softness 1, red farthest (cosine).
const CREEPS: [f32; 3] = [1.25, 0.8, 0.6];

/// The part of a lamp's light that skin takes at this cosine of the angle to it: the cosine itself, but where light creeps past the
/// terminator, `soft` of cosine to both sides, which a parabola joins without a kink.
fn wrapped(facing: f32, soft: f32) -> f32 {
    let within = (facing + soft).max(0.0);
    if facing >= soft { facing } else { within * within / (4.0 * soft).max(1e-6) }
}

impl FromLamp {
    /// Where so much of each colour gets past head and bodies, on skin with this look and unit normal, for an eye in this direction.
    /// It is not asked how much where skin turns too far away.
    fn new(lamp: &Lamp, unhidden: impl FnOnce() -> [f32; 3], (look, normal, eye): (&HeadLook, Vec3, Vec3)) -> Self {
        let facing = normal.dot(lamp.toward);
        if facing <= SkinLight::least_facing(look) {
            return Self::default();
        }
        let halfway = (lamp.toward + eye).normalize_or(eye);
        let gloss = 0.045 * 9.0 * normal.dot(halfway).max(0.0).powi(18) * smooth(facing / 0.25);
        let rim = (1.0 - eye.dot(normal).clamp(0.0, 1.0)).powi(4) * facing.max(0.0);
        let unhidden = unhidden();
        let arriving = [0, 1, 2].map(|c| lamp.strength[c] * unhidden[c]);
        Self {
            fallen: std::array::from_fn(|c| arriving[c] * wrapped(facing, CREEPS[c] * look.softness)),
            sheen: arriving.map(|light| light * (gloss + 0.5 * rim)),
        }
    }
}

impl SkinLight<'_> {
    /// What arrives of each lamp at each place, of the first place from all `lamps` first, past head and bodies if they cast `shadows`: it
    /// does not change while they, lamps and camera stand still.
    pub fn from_lamps(
        pixels: &[SkinPixel],
        lamps: &[Lamp],
        shadows: &[SolidShadows],
        look: &HeadLook,
        view: &View,
    ) -> Vec<FromLamp> {
        let from = |p: &SkinPixel, l: usize| {
            let unhidden =
                || shadows.get(l).map_or([1.0; 3], |shadow| shadow.visible_from_skin(p.solid, p.position, p.normal));
            FromLamp::new(&lamps[l], unhidden, (look, p.normal, view.toward_eye(p.position)))
        };
        let of_place = |p| (0..lamps.len()).map(move |l| from(p, l));
        pixels.par_iter().with_min_len(256).flat_map_iter(of_place).collect()
    }

    /// The cosine of the angle to a lamp from which on skin takes of its light.
    pub fn least_facing(look: &HeadLook) -> f32 {
        -CREEPS[0] * look.softness
    }

    /// How much of each place on the head hair too short to be drawn covers, 0..1, where `shade` square centimetres of it stand on each root.
    pub fn stubble(pixels: &[SkinPixel], scalp: &Scalp, shade: f32) -> Vec<f32> {
        let covered = |p: &SkinPixel| match p.solid {
            0 => 1.0 - (-shade * scalp.density(p.position)).exp(),
            _ => 0.0,
        };
        if shade > 0.0 { pixels.par_iter().with_min_len(256).map(covered).collect() } else { Vec::new() }
    }

    /// The colour of the built-in bust's skin at each place, under hair of a colour: the mean over what the pixel shows, since lashes and the
    /// hairs of brows are thinner.
    pub fn painted(pixels: &[SkinPixel], skin: [f32; 3], hair: [f32; 3], view: &View) -> Vec<[f32; 3]> {
        let colour = |p: &SkinPixel| {
            let side = 1.0 / view.pixels_per_cm(p.depth);
            let count = (side / Paint::detail(p.position)).ceil().clamp(1.0, MOST_PAINT) as u32;
            let away = -view.toward_eye(p.position);
            // At the outline a pixel shows much of the skin.
            let along_normal = p.normal / away.dot(p.normal).min(-0.1);
            let mut sum = Vec3::ZERO;
            for k in 0..count * count {
                let [right, down] = [k % count, k / count].map(|i| ((i as f32 + 0.5) / count as f32 - 0.5) * side);
                let aside = view.right * right - view.up * down;
                let on_skin = aside - away * aside.dot(along_normal);
                sum += Vec3::from(Paint::at(p.position + on_skin).over(skin, hair));
            }
            (sum / (count * count) as f32).to_array()
        };
        pixels.par_iter().with_min_len(256).map(colour).collect()
    }

    /// Light toward the eye (linear) from place `i` on the skin, where something is in the way of the `sky`.
    pub fn at(&self, i: usize, p: &SkinPixel, sky: Option<&mut OnSkin>) -> [f32; 3] {
        match self.shared.get(i).and_then(|&shared| self.reached.get(shared as usize)) {
            Some(reached) => self.sent(i, p, |l| reached.lamps[l], reached.sky),
            None => {
                let sky = self.sky_reaching(p, sky);
                self.sent(i, p, |l| self.lamp_reaching(l, i), sky)
            }
        }
    }

    /// What reaches the receiver of this number, the place `p`.
    pub fn reach(&self, receiver: usize, p: &SkinPixel, sky: Option<&mut OnSkin>) -> Reached {
        let mut lamps = [[1.0; 3]; MOST_LAMPS];
        for (l, lamp) in lamps.iter_mut().enumerate().take(self.lamps) {
            *lamp = self.lamp_reaching(l, receiver);
        }
        Reached { lamps, sky: self.sky_reaching(p, sky) }
    }

    /// What hair leaves of lamp `l` to a receiver.
    #[inline(always)]
    fn lamp_reaching(&self, l: usize, receiver: usize) -> [f32; 3] {
        self.crossings.get(l).map_or([1.0; 3], |c| self.through(c.at(self.first_receiver + receiver)))
    }

    /// The light that other skin sends to a place, and what arrives of the sky above and below.
    #[inline(always)]
    fn sky_reaching(&self, p: &SkinPixel, sky: Option<&mut OnSkin>) -> FromSky {
        let arriving = sky.map(|sky| sky.seen(p.position, p.normal));
        arriving.map_or((0.0, [[1.0; 3]; 2]), |arriving| {
            let open = |half: usize| {
                let through = arriving.through[half];
                let through = if through < 1.0 { self.through(-through.max(1e-6).ln()) } else { [1.0; 3] };
                through.map(|through| arriving.open[half] * through)
            };
            (arriving.glow, [open(0), open(1)])
        })
    }

    /// Light toward the eye, of what reaches a place.
    #[inline(always)]
    fn sent(
        &self,
        i: usize,
        p: &SkinPixel,
        through_hair: impl Fn(usize) -> [f32; 3],
        (glow, [open_above, open_below]): FromSky,
    ) -> [f32; 3] {
        let normal = p.normal;
        let mut diffuse = [0.0; 3];
        let mut sheen = [0.0; 3];
        let count = self.lamps;
        for (l, from) in self.from_lamps[i * count..][..count].iter().enumerate() {
            if from.fallen == [0.0; 3] {
                continue;
            }
            let hair = through_hair(l);
            for c in 0..3 {
                diffuse[c] += hair[c] * from.fallen[c];
                sheen[c] += hair[c] * from.sheen[c];
            }
        }
        let up = 0.5 + 0.5 * normal.dot(self.zenith);
        for (c, diffuse) in diffuse.iter_mut().enumerate() {
            let sky = self.sky.above[c] * up * open_above[c] + self.sky.below[c] * (1.0 - up) * open_below[c];
            *diffuse += self.sky.strength * sky + self.skins[0][c] * glow;
        }
        let bare_skin = self.skins[usize::from(p.solid)];
        let skin = match self.painted.get(i) {
            Some(&painted) if p.solid == 0 => painted,
            _ => bare_skin,
        };
        let hair = self.stubble.get(i).copied().unwrap_or(0.0);
        std::array::from_fn(|c| {
            // Brows and lashes have none of the skin's sheen, and what is darker has less of it.
            let covered = (skin[c] / bare_skin[c].max(1e-6)).min(1.0);
            let bare = skin[c] * diffuse[c] + covered * self.look.sheen * sheen[c];
            bare + (self.hair[c] * diffuse[c] - bare) * hair
        })
    }

    /// What arrives through hair that light crosses `n` times: unscattered, and scattered forward as among the hair itself.
    fn through(&self, n: f32) -> [f32; 3] {
        let straight = exp_of_negative(-n);
        self.decay.map(|k| straight + ON_SKIN * (exp_of_negative(-n * k) - straight).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Projection;

    /// A lash is thinner than a pixel: what a large pixel shows of the eye is the mean of the small ones in it, up to a row of
    /// what it looks at; the colour in its middle alone is not.
    #[test]
    fn a_pixel_shows_the_mean_of_what_is_painted_in_it() {
        let side = 0.18; // cm
        let view = |pixels_per_cm: f32| View {
            eye: Vec3::new(100.0, 0.0, 0.0),
            right: Vec3::NEG_Z,
            up: Vec3::Y,
            forward: Vec3::NEG_X,
            projection: Projection::Orthographic,
            scale: pixels_per_cm,
            size: [64, 64],
            lens: None,
        };
        let (skin, hair) = ([1.0; 3], [0.1; 3]);
        let small = 0.01;
        let mut middles_off = 0.0_f32;
        // Straight before the eye, and turned from it about the vertical.
        for normal in [Vec3::X, Vec3::new(0.8, 0.0, 0.6)] {
            for k in 0..40 {
                let middle = Vec3::new(8.5, -1.0 + 0.03 * k as f32, 3.1);
                let pixel = |right: f32, up: f32| SkinPixel {
                    position: middle + Vec3::new(right * normal.z / normal.x, up, -right),
                    normal,
                    pixel: 0,
                    mask: u16::MAX,
                    solid: 0,
                    depth: 90.0,
                    slope: [0.0; 2],
                };
                let shown = SkinLight::painted(&[pixel(0.0, 0.0)], skin, hair, &view(1.0 / side))[0][0];
                let places = (0..18).map(|i| (i as f32 + 0.5) * small - 0.5 * side);
                let within: Vec<SkinPixel> =
                    places.clone().flat_map(|up| places.clone().map(move |right| pixel(right, up))).collect();
                let fine = SkinLight::painted(&within, skin, hair, &view(1.0 / small));
                let mean = fine.iter().map(|colour| colour[0]).sum::<f32>() / fine.len() as f32;
                assert!((shown - mean).abs() < 1.0 / 6.0, "{shown} for {mean} at {middle}");
                middles_off = middles_off.max((Paint::at(middle).over(skin, hair)[0] - mean).abs());
            }
        }
        assert!(middles_off > 0.3, "{middles_off}");
    }

    #[test]
    fn past_the_terminator_skin_is_red_and_far_before_it_as_the_light() {
        let look = HeadLook { softness: 0.2, ..HeadLook::default() };
        let fallen = |facing: f32| {
            let normal = Vec3::new((1.0 - facing * facing).sqrt(), facing, 0.0);
            let lamp = Lamp { toward: Vec3::Y, strength: [1.0; 3], spread: 0.0 };
            FromLamp::new(&lamp, || [1.0; 3], (&look, normal, Vec3::Z)).fallen
        };
        for facing in [0.3, 0.6, 1.0] {
            assert!(fallen(facing).iter().all(|light| (light - facing).abs() < 1e-6), "{facing}: {:?}", fallen(facing));
        }
        let [red, green, blue] = fallen(-0.1);
        assert!(red > green && green > blue && blue > 0.0, "{red} {green} {blue}");
        assert_eq!(fallen(-1.25 * 0.2 - 1e-3), [0.0; 3]);
    }

    #[test]
    fn skin_has_its_sheen_at_the_rim() {
        let look = HeadLook::default();
        let lamp = Lamp { toward: Vec3::new(0.5_f32.sqrt(), 0.5_f32.sqrt(), 0.0), strength: [1.0; 3], spread: 0.0 };
        // As much turned to the lamp: one faces the eye, one is the outline.
        let [facing, rim] =
            [Vec3::X, Vec3::Y].map(|normal| FromLamp::new(&lamp, || [1.0; 3], (&look, normal, Vec3::X)));
        assert_eq!(facing.fallen, rim.fallen);
        assert!(rim.sheen[0] > 2.0 * facing.sheen[0], "{:?} {:?}", facing.sheen, rim.sheen);
    }
}
