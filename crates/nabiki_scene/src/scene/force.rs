//! `[[force]]`: the intervals of the wind, by their strength or by their speed.

use glam::Vec3;
use nabiki::field::Keyframe;
use nabiki::setting::{Place, Range, Value, refused};
use nabiki::{SettingError, settings};

use super::quantity::{Quantity, Speed};

settings! {
    /// One interval of the wind. `vector` applies in each frame after the previous interval, up to and including
    /// `through`.
    #[derive(Copy)]
    pub struct ForceSettings {
        /// Last frame of the interval (k_j of equation (5)).
        pub through: u32 => of Keyframe, must "50";
        /// Force F_j: direction and strength, without a unit. Only c_i |F| moves hair (section 4.3). With a `speed`,
        /// only the direction counts.
        pub vector: Vec3 => of Keyframe, must "[-100, 0, 0]";
        /// Air speed of the wind, in the free form: "20 km/h", "5 m/s" or "300 cm/s". The strength is then the one that
        /// carries free hair at this speed.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub speed: Option<Quantity<Speed>> = None => "Speed", open "strength from `vector`";
    }
}

impl ForceSettings {
    /// The keyframe for a stepper, if a wind of 1 cm/s has the strength `of_speed`.
    pub fn keyframe(&self, of_speed: f64) -> Keyframe {
        let Self { through, vector, speed } = *self;
        let vector = match speed {
            None => vector,
            Some(speed) => (vector.as_dvec3().normalize_or_zero() * (speed.amount() * of_speed)).as_vec3(),
        };
        Keyframe { through, vector }
    }

    /// Its vector without a speed: only the direction if it has one.
    pub(crate) fn as_given(&self) -> Keyframe {
        Keyframe { through: self.through, vector: self.vector }
    }

    /// Refuses a speed without direction, and one out of range.
    pub(crate) fn check_speed(&self, name: &str) -> Result<(), SettingError> {
        match self.speed {
            Some(speed) if self.vector == Vec3::ZERO => {
                let remedy = "a wind of this speed needs a direction: set vector";
                refused(&Place::Table(name).key("speed"), speed, remedy)
            }
            speed => speed.check(&Place::Table(name).key("speed"), &Range::default()),
        }
    }
}

impl From<Keyframe> for ForceSettings {
    fn from(Keyframe { through, vector }: Keyframe) -> Self {
        Self { through, vector, speed: None }
    }
}

/// Intervals in the form of a scene: where the force equals `was` in these frames, `given` stays.
pub(crate) fn given_as(given: &[ForceSettings], was: &[Keyframe], keys: &[Keyframe]) -> Vec<ForceSettings> {
    let given = |key: &Keyframe| {
        let j = was.partition_point(|was| was.through < key.through).min(was.len().checked_sub(1)?);
        (was[j].vector == key.vector).then(|| ForceSettings { through: key.through, ..given[j] })
    };
    keys.iter().map(|key| given(key).unwrap_or_else(|| (*key).into())).collect()
}
