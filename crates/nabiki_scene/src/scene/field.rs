//! The fields of a scene: `[[force]]` with `[wind]`, `[gust]`, `[body_wind]`, `[flow]`, `[turbulence]`, `[[point]]`,
//! `[[vortex]]`, `[[fan]]`.

use std::sync::Arc;

use glam::Vec3;
use nabiki::dynamics::ForceSpace;
use nabiki::field::{
    BodyWind, BodyWindField, Ease, Fan, FanField, Field, FieldSum, Flow, FlowField, Gust, GustField, Keyframe,
    KeyframedField, Point, PointField, Turbulence, TurbulenceField, Vortex, VortexField, WIND, Wind,
};
use nabiki::{Ellipsoid, Pose, SettingError};
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::force::ForceSettings;
use super::tree::{Unwritable, table_of};

/// The fields of a scene. The wind is the sum of `[[force]]`, multiplied by `[gust]`, and `[body_wind]`. `[flow]` makes
/// it flow around the head. Turbulence and local fields are added to it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct FieldSettings {
    /// Vectors uniform in space, each for some frames: equation (5). `[[force]]`
    pub force: Vec<ForceSettings>,
    /// The ease between them. `[wind]`
    pub wind: Wind,
    /// A random factor on the vectors. `[gust]`
    pub gust: Option<Gust>,
    /// The wind that a moving head feels. `[body_wind]`
    pub body_wind: Option<BodyWind>,
    /// The flow of the wind around the head. `[flow]`
    pub flow: Option<Flow>,
    /// Random swirls. `[turbulence]`
    pub turbulence: Option<Turbulence>,
    /// Points that push or pull. `[[point]]`
    pub point: Vec<Point>,
    /// Vortices. `[[vortex]]`
    pub vortex: Vec<Vortex>,
    /// Winds in a cone. `[[fan]]`
    pub fan: Vec<Fan>,
    /// Fields that a program adds. A file cannot store them.
    #[serde(skip)]
    pub own: Vec<OwnField>,
}

/// A field that a program adds to a scene. It is equal only to itself.
#[derive(Clone, Debug)]
pub struct OwnField(pub Arc<dyn Field>);

impl PartialEq for OwnField {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The inputs of fields.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FieldPlace {
    /// E.
    pub ellipsoid: Ellipsoid,
    /// World poses of the head from frame 0 on; none for a head that does not move.
    pub poses: Arc<[Pose]>,
    /// Frames per second.
    pub frame_rate: f64,
    /// Frames after the rest frame.
    pub frames: u32,
    /// The space of the forces.
    pub space: ForceSpace,
    /// Whether there may be no field at all.
    pub may_be_none: bool,
}

/// Fields, built.
pub(crate) struct FieldParts {
    /// All of them.
    pub field: Arc<dyn Field>,
    /// The wind before it meets the head: uniform, and 0 without `[[force]]` and `[body_wind]`.
    pub wind: Arc<dyn Field>,
    /// The bound of each.
    pub bounds: Vec<FieldBound>,
}

/// The bound of one field of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FieldBound {
    /// Its table, such as `turbulence` or `fan[1]`.
    pub name: String,
    /// Bound on |F|. For `gust` and `flow`, bound on the factor on the wind.
    pub at_most: f32,
}

impl FieldSettings {
    /// Only keyframes: the paper's field.
    pub fn keyframes(force: Vec<Keyframe>) -> Self {
        Self { force: force.into_iter().map(ForceSettings::from).collect(), ..Self::default() }
    }

    /// The intervals as given. Those with a speed have only a direction.
    pub fn as_given(&self) -> Vec<Keyframe> {
        self.force.iter().map(ForceSettings::as_given).collect()
    }

    /// Whether it is the paper's field: only `[[force]]`, stepped.
    pub fn is_the_papers(&self) -> bool {
        let Self { force, wind, gust, body_wind, flow, turbulence, point, vortex, fan, own } = self;
        let alone = gust.is_none() && body_wind.is_none() && flow.is_none() && turbulence.is_none();
        let local = point.is_empty() && vortex.is_empty() && fan.is_empty() && own.is_empty();
        !force.is_empty() && wind.ease == Ease::Stepped && alone && local
    }

    /// Whether this is the name of a field that a scene may have, but this one has not. A share in it changes nothing until it is
    /// there again.
    pub(crate) fn is_off(&self, name: &str) -> bool {
        match name {
            WIND => self.force.is_empty() && self.body_wind.is_none(),
            "turbulence" => self.turbulence.is_none(),
            _ => false,
        }
    }

    /// Refuses values out of range, a missing field, and tables without effect. `head_moves` is whether the head has a
    /// motion. `may_be_none` is whether the form of the motion allows no field.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self, head_moves: bool, may_be_none: bool) -> Result<(), SettingError> {
        let Self { force, wind, gust, body_wind, flow, turbulence, point, vortex, fan, own } = self;
        let local = point.len() + vortex.len() + fan.len() + own.len();
        let none = force.is_empty() && body_wind.is_none() && turbulence.is_none() && local == 0;
        if none && !may_be_none {
            let remedy = "is missing: give at least one [[force]] with through and vector, or another field";
            return Err(SettingError::new("force", "", remedy));
        }
        if force.is_empty() && wind.ease != Ease::Stepped {
            let remedy = "there is no [[force]] to ease: add one, or remove this";
            return Err(SettingError::new("wind.ease", wind.ease.word(), remedy));
        }
        if !force.is_empty() {
            KeyframedField::new(&self.as_given())?;
        }
        force.iter().enumerate().try_for_each(|(j, force)| force.check_speed(&format!("force[{j}]")))?;
        if let Some(gust) = gust {
            gust.check()?;
            if force.is_empty() {
                let remedy = "gusts change the strength of [[force]], but there is none: add one, or remove [gust]";
                return Err(SettingError::new("gust", "on", remedy));
            }
        }
        if let Some(body_wind) = body_wind {
            body_wind.check()?;
            if !head_moves {
                let remedy = "the head must move to make wind: set head.motion, or remove [body_wind]";
                return Err(SettingError::new("body_wind", "on", remedy));
            }
        }
        if let Some(flow) = flow {
            flow.check()?;
            if force.is_empty() && body_wind.is_none() {
                let remedy = "there is no [[force]] or [body_wind] to guide around the head: add one, or remove [flow]";
                return Err(SettingError::new("flow", "on", remedy));
            }
        }
        turbulence.iter().try_for_each(Turbulence::check)?;
        let named = |kind: &str, i: usize| format!("{kind}[{i}]");
        point.iter().enumerate().try_for_each(|(i, point)| point.check_at(&named("point", i)))?;
        vortex.iter().enumerate().try_for_each(|(i, vortex)| vortex.check_at(&named("vortex", i)))?;
        fan.iter().enumerate().try_for_each(|(i, fan)| fan.check_at(&named("fan", i)))
    }

    /// The fields, built. `force`: the strengths of `[[force]]`.
    ///
    /// # Errors
    /// As [`check`](Self::check), and what only shows about this head: an ellipsoid too flat for the flow.
    pub(crate) fn build(&self, place: &FieldPlace, force: &[Keyframe]) -> Result<FieldParts, SettingError> {
        self.build_of(place, force, None)
    }

    /// The same with this wind in place of `[[force]]` and `[gust]`.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub(crate) fn build_about(&self, place: &FieldPlace, instead: Arc<dyn Field>) -> Result<FieldParts, SettingError> {
        self.build_of(place, &[], Some(instead))
    }

    fn build_of(
        &self,
        place: &FieldPlace,
        force: &[Keyframe],
        instead: Option<Arc<dyn Field>>,
    ) -> Result<FieldParts, SettingError> {
        self.check(!place.poses.is_empty(), place.may_be_none)?;
        let mut bounds = Vec::new();
        let mut bound = |name: String, at_most: f32| bounds.push(FieldBound { name, at_most });
        let mut winds: Vec<Arc<dyn Field>> = Vec::new();
        if let Some(wind) = &instead {
            winds.push(wind.clone());
        } else if !force.is_empty() {
            let keyframed = KeyframedField::new(force)?.eased(self.wind.ease);
            bound("force".to_owned(), keyframed.strongest());
            winds.push(Arc::new(keyframed));
        }
        if let (Some(gust), None) = (&self.gust, &instead) {
            let gusty = GustField::new(gust, sum(std::mem::take(&mut winds)), place.frame_rate)?;
            bound("gust".to_owned(), gusty.largest_factor());
            winds.push(Arc::new(gusty));
        }
        if let Some(body_wind) = &self.body_wind {
            let body_wind = BodyWindField::new(body_wind, &place.poses, place.frame_rate, place.space)?;
            bound("body_wind".to_owned(), body_wind.strongest());
            winds.push(Arc::new(body_wind));
        }
        let wind = sum(winds);
        // In head space the head does not move.
        let poses = match place.space {
            ForceSpace::World => &place.poses[..],
            ForceSpace::Head => &[],
        };
        let mut parts = vec![(WIND.to_owned(), wind.clone())];
        if let Some(flow) = &self.flow {
            let flow = FlowField::new(flow, wind.clone(), place.ellipsoid, poses)?;
            bound("flow".to_owned(), flow.largest_part());
            parts = vec![(WIND.to_owned(), Arc::new(flow))];
        }
        if self.force.is_empty() && self.body_wind.is_none() && instead.is_none() {
            parts.clear();
        }
        if let Some(turbulence) = &self.turbulence {
            let drift: Vec<Vec3> = (0..=place.frames).filter_map(|n| wind.uniform(n)).collect();
            let turbulence = TurbulenceField::new(turbulence, place.ellipsoid, poses, &drift)?;
            bound("turbulence".to_owned(), turbulence.strongest());
            parts.push(("turbulence".to_owned(), Arc::new(turbulence)));
        }
        let mut local = |name: String, field: Arc<dyn Field>| {
            bound(name.clone(), field.strongest());
            parts.push((name, field));
        };
        for (i, settings) in self.point.iter().enumerate() {
            let name = format!("point[{i}]");
            local(name.clone(), Arc::new(PointField::new(settings, &name)?));
        }
        for (i, settings) in self.vortex.iter().enumerate() {
            let name = format!("vortex[{i}]");
            local(name.clone(), Arc::new(VortexField::new(settings, &name)?));
        }
        for (i, settings) in self.fan.iter().enumerate() {
            let name = format!("fan[{i}]");
            local(name.clone(), Arc::new(FanField::new(settings, &name)?));
        }
        for (i, OwnField(field)) in self.own.iter().enumerate() {
            local(format!("own[{i}]"), field.clone());
        }
        Ok(FieldParts { field: Arc::new(FieldSum::named(parts)), wind, bounds })
    }

    /// The tables, for writing.
    pub(super) fn tables(&self) -> Result<Table, Unwritable> {
        let Self { force, wind, gust, body_wind, flow, turbulence, point, vortex, fan, own: _ } = self;
        let mut tree = Table::new();
        tree.insert("force".to_owned(), list(force)?);
        tree.insert("wind".to_owned(), table_of(wind)?.into());
        let mut optional = |name: &str, table: Option<Table>| {
            if let Some(table) = table {
                tree.insert(name.to_owned(), table.into());
            }
        };
        optional("gust", gust.as_ref().map(table_of).transpose()?);
        optional("body_wind", body_wind.as_ref().map(table_of).transpose()?);
        optional("flow", flow.as_ref().map(table_of).transpose()?);
        optional("turbulence", turbulence.as_ref().map(table_of).transpose()?);
        for (name, list) in [("point", list(point)?), ("vortex", list(vortex)?), ("fan", list(fan)?)] {
            if list.as_array().is_some_and(|list| !list.is_empty()) {
                tree.insert(name.to_owned(), list);
            }
        }
        Ok(tree)
    }

    /// The same with every optional table, at its own defaults.
    pub(super) fn with_optional_tables(self) -> Self {
        Self {
            gust: Some(Gust::default()),
            body_wind: Some(BodyWind::default()),
            flow: Some(Flow::default()),
            turbulence: Some(Turbulence::default()),
            ..self
        }
    }
}

/// A list of tables.
fn list<T: Serialize>(entries: &[T]) -> Result<Value, Unwritable> {
    entries.iter().map(|entry| table_of(entry).map(Value::Table)).collect::<Result<_, _>>().map(Value::Array)
}

/// The sum of fields; a single one unchanged.
fn sum(mut parts: Vec<Arc<dyn Field>>) -> Arc<dyn Field> {
    match parts.len() {
        1 => parts.remove(0),
        _ => Arc::new(FieldSum::new(parts)),
    }
}
