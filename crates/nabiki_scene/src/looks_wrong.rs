//! What looks wrong before anything is drawn: size and place of a head and its hair, a forgotten unit, hair beside the
//! head or in it, a skull with a hole, a head that jumps; and settings that change nothing.

mod aims;
mod twice;
mod unused;

use glam::Vec3;
use nabiki::dynamics::Form;
use nabiki::free_form::FreeMotion;
use nabiki::head::Opening;
use nabiki::{Head, Pose};
use nabiki_groom::style::Cut;
use nabiki_io::info::Short;
use nabiki_render::settings::Projection;
use nabiki_render::{Bounds, View};

use crate::advice::{Advice, Fix};
use crate::built::BuiltScene;
use crate::seat::{Lie, Mended, Seat};
use crate::size::{mean_half_axis, vector};

pub(crate) use unused::{of_pictures, unused};

/// A skull that lacks less than this counts as whole (share of the mean half axis).
const MISSING: f32 = 0.03;

impl BuiltScene {
    /// What looks wrong about the size and place of head and hair.
    pub fn advice(&self) -> Vec<Advice> {
        advice(self)
    }
}

fn advice(built: &BuiltScene) -> Vec<Advice> {
    let mut advice: Vec<Advice> =
        built.model.head.openings.iter().filter_map(|hole| open_skull(&built.model.head, hole)).collect();
    let of_head = head_size(built);
    // Hair that depends on the unit of a wrong head cannot be judged.
    let of_hair = if of_head.is_none() { built.seat().and_then(|seat| of_seat(&seat)) } else { None };
    advice.extend(of_head.into_iter().chain(of_hair).chain(untied(built)).chain(unbound(built)));
    advice.extend(cropped(built));
    advice.extend(empty_regions(built));
    advice.extend(aims::advice(built));
    advice.extend(open_bodies(built));
    advice.extend(within_the_head(built));
    advice.extend(leap(built));
    advice.extend(twice::carried_twice(built));
    advice.extend(unused(&built.scene));
    advice
}

/// Bodies with openings, which count as closed: the space behind them, as in a cap, is inside.
fn open_bodies(built: &BuiltScene) -> impl Iterator<Item = Advice> {
    built.open_bodies().map(|(i, edges)| {
        let seen = format!(
            "body[{i}] is open along {edges} edges; nabiki treats an opening as closed straight across. If that is wrong, \
             close it in the file"
        );
        Advice::new(seen)
    })
}

/// A camera that is inside the head, where it sees almost nothing.
pub(crate) fn within_the_head(built: &BuiltScene) -> Option<Advice> {
    let (picture, head) = (&built.scene.picture, &built.model.head);
    // An automatic one is outside, and so is an orthographic one.
    picture.camera.distance.filter(|_| picture.camera.projection == Projection::Perspective)?;
    let turn = built.pose(0).rotation;
    let mut framed = Bounds::default();
    framed.include_head(&head.mesh, &head.ellipsoid);
    built.strands().points().iter().for_each(|&p| framed.include(turn * p));
    let eye = View::new(&picture.camera.at(0.0), picture.size, &framed).eye;
    if head.ellipsoid.value(turn.inverse() * eye) >= 0.0 {
        return None;
    }
    let [x, y, z] = eye.to_array().map(Short);
    let seen = format!(
        "picture.camera is inside the head, at ({x}, {y}, {z}), and sees almost nothing: give a larger \
         picture.camera.distance or another target"
    );
    Some(Advice::new(seen))
}

/// A head that moves or turns more suddenly than any blow could make it: a cut of the shot, or missing samples.
fn leap(built: &BuiltScene) -> Option<Advice> {
    // A hundred times gravity (cm/s^2), and a change of the turn from one frame to the next (rad).
    const SUDDEN: f32 = 1e5;
    const TURNED: f32 = 1.0;
    let poses = built.given_poses();
    let rate = built.scene.frame_rate() as f32;
    let is_sudden = |[a, b, c]: [&Pose; 3]| {
        let change = (c.position_cm - b.position_cm) - (b.position_cm - a.position_cm);
        let turns = [b.rotation * a.rotation.inverse(), c.rotation * b.rotation.inverse()];
        change.length() * rate * rate > SUDDEN || turns[0].angle_between(turns[1]) > TURNED
    };
    let before = poses.windows(3).position(|at| is_sudden([&at[0], &at[1], &at[2]]))? + 1;
    let (from, to) = (poses[before], poses[before + 1]);
    let (way, turn) =
        (from.position_cm.distance(to.position_cm), from.rotation.angle_between(to.rotation).to_degrees());
    let seen = format!(
        "the head moves {way:.0} cm and turns {turn:.0} degrees from frame {before} to frame {}, and the hair feels it: if \
         the shot cuts there, make one scene for each part",
        before + 1
    );
    matches!(built.dynamics.form, Form::Free(_)).then_some(Advice::new(seen))
}

/// A tie that holds no hair.
fn untied(built: &BuiltScene) -> Option<Advice> {
    let Form::Free(free) = &built.dynamics.form else { return None };
    let tie = free.form.tie?;
    let strands = built.strands();
    if strands.iter().any(|strand| tie.held(strand) > 0) {
        return None;
    }
    let [x, y, z] = tie.at.to_array().map(Short);
    let seen = format!(
        "free.tie ties nothing: none of the {} strands comes within {} cm of ({x}, {y}, {z}) at rest",
        strands.len(),
        Short(tie.within)
    );
    Some(Advice::new(seen))
}

/// A ponytail whose band no hair reaches.
fn unbound(built: &BuiltScene) -> Option<Advice> {
    let style = &built.scene.hair.grown()?.style;
    let tail = style.ponytail?;
    // Nodes are at most a segment apart, and a curl winds around the tied line with its radius plus the random part.
    let near = tail.radius + built.scene.hair.segment_length + 3.0 * style.curl.radius;
    let strands = built.strands();
    if strands.points().iter().any(|p| p.distance(tail.at) <= near) {
        return None;
    }
    let [x, y, z] = tail.at.to_array().map(Short);
    let seen = format!(
        "hair.style.ponytail ties nothing: none of the {} strands reaches its band at ({x}, {y}, {z}): give longer hair or \
         another hair.style.ponytail.at",
        strands.len()
    );
    Some(Advice::new(seen))
}

/// Cuts that remove all they can: the roots of all hair are on the wrong side of the plane.
fn cropped(built: &BuiltScene) -> impl Iterator<Item = Advice> {
    let cuts = built.scene.hair.grown().map_or(&[][..], |hair| &hair.style.cuts);
    let strands = built.strands();
    let beyond = |cut: &Cut| strands.iter().all(|strand| (strand[0] - cut.point).dot(cut.normal) > 0.0);
    let all = move |cut: &Cut| cut.region.is_none() && beyond(cut);
    cuts.iter().enumerate().filter(move |(_, cut)| all(cut)).map(|(i, cut)| {
        let seen = format!(
            "hair.style.cuts[{i}] cuts all hair to {} cm, because every root is on the side its normal points to: to reverse \
             it, give normal = {}",
            Short(cut.shortest),
            vector(Vec3::ZERO - cut.normal)
        );
        Advice::new(seen)
    })
}

/// Regions without hair.
fn empty_regions(built: &BuiltScene) -> impl Iterator<Item = Advice> {
    let free = match &built.dynamics.form {
        Form::Free(free) => Some(free),
        Form::Paper => None,
    };
    let strands = built.strands();
    // A shard may well have no hair of a region.
    let free = free.filter(|_| built.groom.shard.is_none());
    let regions = free.into_iter().flat_map(|free| (0..free.form.regions.len()).map(move |i| (free, i)));
    let empty = |&(free, i): &(&FreeMotion, usize)| strands.iter().all(|strand| free.weight_in(i, strand[0]) == 0.0);
    regions.filter(empty).map(|(free, i)| {
        let region = &free.form.regions[i];
        let why = match region.near {
            Some(_) if region.has_members() => {
                "none is near it and also in its groups, attribute and map; leave out one of these".to_owned()
            }
            Some(_) if !region.painted.is_empty() => {
                "none is near it and also painted; leave out one of these".to_owned()
            }
            Some(_) => {
                let far = Short(region.within + region.soft);
                format!("no root is within {far} cm of it; correct near, or raise within")
            }
            None if !region.painted.is_empty() && region.has_members() => {
                "none is painted and also in its groups, attribute and map; leave out one of these".to_owned()
            }
            None if !region.painted.is_empty() => {
                "no root is near a painted point with a weight; paint it anew, or raise within".to_owned()
            }
            None if region.map.is_some() => "its map is black at all roots; correct it".to_owned(),
            None if !region.values.is_empty() => {
                "none has one of its values of the attribute, within its groups; correct these".to_owned()
            }
            None if region.groups.is_empty() => "its attribute is 0 on all of them; correct it".to_owned(),
            None if region.attribute.is_none() => "none is in its groups; correct these".to_owned(),
            None => "its attribute is 0 on all of its groups; correct one of them".to_owned(),
        };
        let of = if strands.len() == 1 { "the only strand" } else { &format!("any of the {} strands", strands.len()) };
        Advice::new(format!("free.regions[{i}] does not contain {of}: {why}"))
    })
}

fn open_skull(head: &Head, hole: &Opening) -> Option<Advice> {
    let missing = hole.missing.filter(|&missing| missing > MISSING * mean_half_axis(&head.ellipsoid))?;
    let [x, y, z] = hole.middle.to_array().map(Short);
    let seen = format!(
        "the skull has a hole {:.1} cm wide around ({x}, {y}, {z}) cm. nabiki treats it as closed straight across, up to \
         {missing:.1} cm below the missing skin: close it in the file, or include more of the file with head.groups",
        2.0 * hole.radius,
    );
    Some(Advice::new(seen))
}

fn head_size(built: &BuiltScene) -> Option<Advice> {
    built.model.of_size()
}

fn of_seat(seat: &Seat<'_>) -> Option<Advice> {
    let astray = seat.astray();
    if !astray.is_empty() {
        let (keys, file) = (astray.join(" and "), seat.settings.file.display());
        let seen = format!("{keys}: this moves the hair away from the head, which is also from {file}; leave it out");
        return Some(Advice::new(seen));
    }
    let now = seat.lie();
    if now.is_good() {
        return None;
    }
    let seen = wrong(&now);
    if seat.of_head {
        let seen = format!("{seen}: that is their place in the file, which the head is also from");
        return Some(Advice::new(seen));
    }
    let Some((Mended { facing, unit, up, origin, .. }, then)) = seat.mended() else {
        // With a given origin no other facing is tried.
        let sought = if seat.has_origin() { "hair.unit" } else { "hair.facing, hair.unit" };
        let seen = format!("{seen}: it was made for another head, and no other {sought} or hair.origin fixes that");
        return Some(Advice::new(seen));
    };
    let seen = if then.is_good() {
        seen
    } else {
        format!("{seen}. It was made for another head; at the best place found, {}", wrong(&then))
    };
    let facing = facing.map(|axis| Fix { key: "hair.facing", value: format!("\"{axis}\"") });
    let unit = unit.map(|value| Fix { key: "hair.unit", value });
    let up = up.map(|axis| Fix { key: "hair.up", value: format!("\"{axis}\"") });
    let origin = origin.map(|p| Fix { key: "hair.origin", value: vector(p) });
    Some(Advice { seen, fixes: facing.into_iter().chain(unit).chain(up).chain(origin).collect() })
}

/// What is wrong with hair that lies like this.
fn wrong(lie: &Lie) -> String {
    let Lie { off, inside, depth, on_skin } = lie;
    if *on_skin {
        let percent = 100.0 * inside;
        format!("{percent:.1} % of the hair's points are inside the head at rest, up to {} cm deep", Short(*depth))
    } else {
        format!("half of the hair's roots are more than {} cm from the skin", Short(*off))
    }
}
