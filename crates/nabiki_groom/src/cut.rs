//! Cutting: the length at which a strand ends on a plane.

use nabiki::glam::DVec3;

use crate::drape::{Draping, Ground};
use crate::strand_style::StrandStyle;
use crate::style::Cut;

/// A strand is cut anew this many times at most, since what is left, being lighter, hangs differently.
const TRIMS: usize = 6;
/// Distance of the tip from the plane that is near enough (cm).
const NEAR: f64 = 0.01;

/// How far `p` lies beyond the plane, on the side that is cut off (cm).
fn beyond(cut: &Cut, styled: &StrandStyle, p: DVec3) -> f64 {
    (p - cut.point.as_dvec3()).dot(cut.normal.as_dvec3().normalize()) - styled.cut_offset
}

/// Arc length at which the nodes first pass the plane.
fn crossing(cut: &Cut, styled: &StrandStyle, nodes: &[DVec3]) -> Option<f64> {
    let mut s = 0.0;
    for pair in nodes.windows(2) {
        let (a, b) = (beyond(cut, styled, pair[0]), beyond(cut, styled, pair[1]));
        let d = pair[0].distance(pair[1]);
        if a > 0.0 {
            return Some(s);
        }
        if b > 0.0 {
            return Some(s + d * a / (a - b));
        }
        s += d;
    }
    None
}

/// Drapes a strand, cutting it wherever a plane that concerns it says so, and winds it, if it curls.
pub(crate) fn drape_and_cut(ground: &Ground<'_>, cuts: &[Cut], styled: &StrandStyle, draping: &mut Draping) {
    let whole = styled.line_length(ground.segment);
    let line = line_cut(ground, cuts, styled, whole, draping);
    let Some(curl) = &styled.curl else { return };
    let most = styled.length;
    let length = if line < whole { curl.length_along(line, most, ground.segment) } else { most };
    ground.wind(styled, curl, length, draping);
}

/// Drapes the strand, or the line that it will be wound about, which is `length` long (cm) before any cut; returns the
/// length that is left.
fn line_cut(ground: &Ground<'_>, cuts: &[Cut], styled: &StrandStyle, mut length: f64, draping: &mut Draping) -> f64 {
    ground.drape(styled, length, draping);
    for cut in cuts.iter().filter(|cut| cut.region.is_none_or(|region| region == styled.region)) {
        let Some(at) = crossing(cut, styled, &draping.nodes) else { continue };
        // The tip passes the plane at `long`, and not at `short`, if at any length that is allowed.
        let (mut short, mut long) = (f64::from(cut.shortest).min(length), length);
        length = at.max(short);
        for trim in 0.. {
            ground.drape(styled, length, draping);
            let [.., before, tip] = draping.nodes[..] else { break };
            let left = beyond(cut, styled, tip);
            if left.abs() < NEAR || length <= short {
                break;
            }
            *(if left > 0.0 { &mut long } else { &mut short }) = length;
            if trim >= TRIMS {
                // On a bend over an ear or a shoulder the tip may jump past the plane.
                length = short;
                continue;
            }
            // Per cm of hair the tip moves on by about the last segment's direction.
            let rate = (left - beyond(cut, styled, before)) / before.distance(tip);
            length -= left / rate.max(0.3);
            if !(short..long).contains(&length) {
                length = 0.5 * (short + long);
            }
        }
    }
    length
}
