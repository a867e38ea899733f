//! `[[aim]]`: shapes that hair is led to in some frames.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::aim::Lead;
use nabiki::setting::{Key, Place, refused};
use nabiki::{SettingError, settings};

use super::quantity::{Amount, Quantity, Strength};

/// Farthest coordinate of a point to lead hair to (cm).
const FARTHEST: f64 = 100_000.0;

settings! {
    /// A shape that hair is led to in some frames, whatever the wind does: a pose of curves, a point, or the groom. Free form only.
    pub struct AimSettings where leads_somewhere {
        /// Name of the aim, for `info`.
        pub name: String = String::new() => "Name";
        /// Name of the region of `[[free.regions]]` that it leads. Where the region fades, so does the strength.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub region: Option<String> = None => "Region", open "all hair";
        /// A file with curves of the shape: .usd, .usda, .usdc, .abc, .nabiki, .hair, .tfx or .obj. A strand follows
        /// the directions of the curves that begin nearest to its root.
        pub file: PathBuf = PathBuf::new() => "Shape";
        /// Curves of the shape instead of a file, as the studio's comb leaves them: lists of points from root to tip, in
        /// head space (cm).
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub curves: Vec<Vec<Vec3>> = Vec::new() => "Curves", least -FARTHEST, most FARTHEST;
        /// The frame of the scene in which the curves are posed, on the head as it is there. From a file that moves,
        /// this frame is used, counted from the file's first. Without it, the curves are posed on the head at rest.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub frame: Option<u32> = None => "Posed in frame", open "at rest";
        /// A point to lead hair to instead of a shape, in the space of the head at rest.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub toward: Option<Vec3> = None => "Toward", unit "cm", least -FARTHEST, most FARTHEST, open "a shape";
        /// Whether to lead hair to its groom, the shape at rest.
        pub groom: bool = false => "To the groom";
        /// Strength of the pull. "3 g" pulls with three times the weight of the hair on earth; a number is in F. Against
        /// a force F, limp hair settles along F + S t, where t is the direction of the aim.
        pub strength: Amount<Strength> = Amount::World(Quantity::new(3.0)) => of Lead;
        /// First frame of the full strength.
        pub from: u32 => of Lead;
        /// Last frame of the full strength. Without it, the aim never ends.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub through: Option<u32> => of Lead, open "the end";
        /// Number of frames before `from` in which the strength rises from 0.
        pub ease_in: u32 => of Lead;
        /// Number of frames after `through` in which the strength falls to 0.
        pub ease_out: u32 => of Lead;
    }
}

impl AimSettings {
    /// How strongly it leads, and when. `earth`: the strength of the earth's gravity, in F.
    pub(crate) fn lead(&self, earth: f64) -> Lead {
        let &Self { from, through, ease_in, ease_out, .. } = self;
        Lead { strength: self.strength.number(|g| g * earth), from, through, ease_in, ease_out }
    }

    /// Refuses an aim with no shape, or with several, and one that ends before it begins.
    fn leads_somewhere(&self, at: &Place) -> Result<(), SettingError> {
        let given = [!self.file.as_os_str().is_empty(), !self.curves.is_empty(), self.toward.is_some(), self.groom];
        match given.into_iter().filter(|&given| given).count() {
            1 => {}
            0 => return refused(&at.key("file"), "", "is missing: give file, curves, toward, or groom = true"),
            _ => {
                let (key, value) = match self.toward {
                    Some(point) => ("toward", format!("{point}")),
                    None if self.groom => ("groom", "true".to_owned()),
                    None => ("curves", format!("{} curves", self.curves.len())),
                };
                return refused(
                    &at.key(key),
                    value,
                    "an aim has one shape: give only one of file, curves, toward and groom",
                );
            }
        }
        if let Some(frame) = self.frame.filter(|_| !given[0] && !given[1]) {
            return refused(&at.key("frame"), frame, "is for curves, and this aim has none: remove it");
        }
        if let Some(i) = self.curves.iter().position(|curve| curve.len() < 2) {
            let points = format!("{} points", self.curves[i].len());
            return refused(
                &at.key("curves").entry(i),
                points,
                "a curve has at least two points: remove it, or add points",
            );
        }
        self.lead(1.0).check_at(&Key::from(at).to_string())
    }
}
