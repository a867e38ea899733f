//! `[[body]]`: what hair collides with besides the head.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::body::Contact;
use nabiki::obstacle::Capsule;
use nabiki::setting::{Key, Place, refused};
use nabiki::{SettingError, settings};
use nabiki_io::motion::{Axis, MotionSource};
use nabiki_io::{Placement, Unit};
use nabiki_render::settings::BodyLook;

use super::head::check_placement;

/// Farthest coordinate of a capsule in its body's space (cm).
const FARTHEST: f64 = 1000.0;

settings! {
    /// A capsule: all points within a radius of a line, or of a single point.
    #[derive(Copy)]
    pub struct CapsuleSettings {
        /// One end of the line, in the body's space.
        pub from: Vec3 = Vec3::ZERO => "From", must "[x, y, z]", unit "cm", least -FARTHEST, most FARTHEST;
        /// The other end. Without it, the capsule is a ball.
        pub to: Option<Vec3> = None => "To", unit "cm", least -FARTHEST, most FARTHEST, open "a ball";
        /// The radius.
        pub radius: f32 = 5.0 => "Radius", must "5.0", unit "cm", above 0.0, most FARTHEST;
    }
}

settings! {
    /// An object besides the head that hair keeps out of in the free form.
    pub struct BodySettings where can_be_loaded {
        /// The mesh: a .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, USD layer or Alembic archive. Required without `capsule`.
        pub mesh: PathBuf = PathBuf::new() => "Mesh";
        /// A capsule or ball instead of a mesh: an arm, a shoulder, a finger. It needs no file.
        pub capsule: Option<CapsuleSettings> = None => "Capsule", open "the mesh";
        /// Groups, objects or nodes of the file to use. Uses all if empty.
        pub groups: Vec<String> = Vec::new() => "Groups";
        /// Length unit of the file.
        pub unit: Option<Unit> = None => "Unit", above 0.0, open "what the file says, or cm";
        /// Axis of the file that points up.
        pub up: Option<Axis> = None => "Up", open "what the file says, or +y";
        /// Axis of the file that lies along +x of the scene.
        pub facing: Option<Axis> = None => "Facing", open "+x";
        /// Point of the file that the body's motion carries, in the file's unit.
        pub origin: Option<Vec3> = None => "Origin", open "the file's";
        /// A file that moves the body through the world, as `head.motion` moves the head.
        pub motion: Option<MotionSource> = None => "Motion of a body", open "no motion";
        /// Whether the body is worn: it is placed in head space and moves with the head.
        pub with_head: bool = false => "Attached to head";
        /// Whether hair keeps out of the body. If false, the body is only drawn, and its mesh may be open.
        pub solid: bool = true => "Solid";
        /// Distance that nodes keep from its skin.
        pub margin: f32 => of Contact;
        /// Friction of sliding hair: the share of the push that it loses as speed along the skin.
        pub friction: f32 => of Contact;
        /// Friction of hair that does not slide, at least `friction`.
        pub static_friction: f32 => of Contact;
        /// Whether the body is drawn. A hidden body hides nothing and casts no shadow.
        pub shown: bool => of BodyLook;
        /// Colour in pictures. The default is a grey.
        pub colour: [f32; 3] => of BodyLook;
    }
}

impl BodySettings {
    /// Its contact settings.
    pub fn contact(&self) -> Contact {
        Contact { margin: self.margin, friction: self.friction, static_friction: self.static_friction }
    }

    /// Its look.
    pub fn look(&self) -> BodyLook {
        BodyLook { shown: self.shown, colour: self.colour }
    }

    /// The placement of the file in the body's space. `up` and `unit`: what the file itself declares.
    pub fn placement(&self, unit: Option<Unit>, up: Option<Axis>) -> Placement {
        let default = Placement::default();
        Placement {
            unit: self.unit.or(unit).unwrap_or(default.unit),
            up: self.up.or(up).unwrap_or(default.up),
            facing: self.facing.unwrap_or(default.facing),
            origin: self.origin.unwrap_or(Vec3::ZERO),
        }
    }

    /// Its capsule, if it is one. `name` is the body's name in errors.
    pub(crate) fn as_capsule(&self, name: &str) -> Result<Option<Capsule>, SettingError> {
        let of = |CapsuleSettings { from, to, radius }| {
            Capsule::new([from, to.unwrap_or(from)], radius, &format!("{name}.capsule"))
        };
        self.capsule.map(of).transpose()
    }

    /// Refuses settings that only a mesh has, for a capsule.
    fn places_no_file(&self, at: &Place) -> Result<(), SettingError> {
        let given = [
            ("groups", !self.groups.is_empty()),
            ("unit", self.unit.is_some()),
            ("up", self.up.is_some()),
            ("facing", self.facing.is_some()),
            ("origin", self.origin.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            Some((key, _)) => refused(&at.key(key), "", "is for a mesh, and this body is a capsule: remove it"),
            None => Ok(()),
        }
    }

    /// Refuses settings from which no body can be loaded.
    fn can_be_loaded(&self, at: &Place) -> Result<(), SettingError> {
        let of_a_mesh = !self.mesh.as_os_str().is_empty();
        match self.capsule {
            None if !of_a_mesh => {
                return refused(&at.key("mesh"), "", "is missing: give the file of its mesh, or a capsule");
            }
            Some(_) if of_a_mesh => {
                let remedy = "a body is a mesh or a capsule: remove one of the two";
                return refused(&at.key("mesh"), self.mesh.display(), remedy);
            }
            Some(_) => self.places_no_file(at)?,
            None => {}
        }
        if self.with_head && self.motion.is_some() {
            let remedy = "a body that moves with the head cannot have its own motion: remove one of the two";
            return refused(&at.key("with_head"), true, remedy);
        }
        check_placement(&Key::from(at).to_string(), self.unit, self.up, self.facing, self.origin)?;
        self.contact().holds_what_lies_still(at)
    }
}
