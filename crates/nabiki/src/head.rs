//! The head: its mesh, the head ellipsoid E, and the distance to the skin (section 3.1 of the paper).

mod fit;
mod openings;

use std::fmt::Display;
use std::sync::Arc;

use glam::{Vec2, Vec3};

pub use openings::Opening;

use crate::distance::{Samples, SkinDistance};
use crate::mesh::Orientation;
use crate::strands::bounds;
use crate::{Ellipsoid, Mesh, SettingError};

/// Most fine samples of the box around a head, if it were full: three times those of a person's whole body.
const MOST_SAMPLES: f32 = 2e7;

/// Range of the mean half axis of usable heads (cm).
const HALF_AXES: [f32; 2] = [1e-3, 1e5];

/// A head in head space (cm), with neck and shoulders if the mesh has them.
#[derive(Clone, Debug)]
pub struct Head {
    /// The surface. It may be open where neck or arms are cut off.
    pub mesh: Mesh,
    /// E. It fits the part of the head where hair grows, not the face.
    pub ellipsoid: Ellipsoid,
    /// The orientation of the triangles in the original mesh.
    pub orientation: Orientation,
    /// The openings of the surface.
    pub openings: Vec<Opening>,
    /// Whether it is the bust of `nabiki_groom`, whose face a renderer knows. The creator of a head sets this.
    pub is_builtin: bool,
    /// Lowest and highest corner of the mesh: nothing beyond is inside.
    bounds: [Vec3; 2],
    skin: Arc<SkinDistance>,
}

impl Head {
    /// The same head with another ellipsoid.
    ///
    /// # Errors
    /// If it is not a valid ellipsoid.
    pub fn with_ellipsoid(self, ellipsoid: Ellipsoid) -> Result<Self, SettingError> {
        check_ellipsoid(&ellipsoid)?;
        Ok(Self { ellipsoid, ..self })
    }

    /// A head from a mesh in cm whose face looks along +x. The half axes of a person's head are about 9 cm; other sizes
    /// suggest a wrong unit. Without an `ellipsoid`, E is fitted to the skull above the ears and behind the face, for
    /// any size and origin of the head.
    ///
    /// Triangles that face inward are turned ([`Mesh::turn_outward`]); [`orientation`](Self::orientation) counts them.
    ///
    /// # Errors
    /// If there are no triangles; an index or a coordinate (including texture coordinates) is invalid; only some
    /// triangles have texture coordinates; E is not an ellipsoid; no skull is found at the top of the mesh; or the mesh
    /// is a sheet that encloses no space. The error names `head.mesh` or a part of `head.ellipsoid`, and its value
    /// describes the problem. The caller adds the name of the file.
    pub fn from_mesh(mut mesh: Mesh, ellipsoid: Option<Ellipsoid>) -> Result<Self, SettingError> {
        check_mesh(&mesh)?;
        let orientation = mesh.turn_outward();
        let ellipsoid = match ellipsoid {
            Some(given) => given,
            None => fit::scalp(&mesh)?,
        };
        check_ellipsoid(&ellipsoid)?;
        check_size(&mesh, &ellipsoid)?;
        if !orientation.has_inside {
            let remedy = "encloses no space, so it has no inside: give a closed head, or one that is open only where it is cut off";
            return Err(refused_mesh(&mesh, "a sheet", remedy));
        }
        Ok(Self::assemble(mesh, ellipsoid, orientation))
    }

    /// A head that [`from_mesh`](Self::from_mesh) made before, without the computation. It takes the mesh (triangles
    /// facing outward), E, and the [samples](SkinDistance::samples) of its [`skin`](Self::skin), all in head space
    /// (cm). The caller guarantees that they belong together. The mesh counts as closed; if it is open, set
    /// [`orientation`](Self::orientation) and [`openings`](Self::openings), too.
    ///
    /// # Errors
    /// If [`from_mesh`](Self::from_mesh) would refuse the mesh or E, or if the samples [cannot be
    /// read](Samples::check).
    pub fn from_samples(mesh: Mesh, ellipsoid: Ellipsoid, samples: Samples) -> Result<Self, SettingError> {
        check_mesh(&mesh)?;
        check_ellipsoid(&ellipsoid)?;
        check_size(&mesh, &ellipsoid)?;
        let skin = Arc::new(SkinDistance::from_samples(&mesh, samples)?);
        let orientation = Orientation { has_inside: true, ..Orientation::default() };
        let (bounds, openings) = (bounds(&mesh.positions), Vec::new());
        Ok(Self { mesh, ellipsoid, orientation, openings, is_builtin: false, bounds, skin })
    }

    /// The ellipsoid E that [`from_mesh`](Self::from_mesh) would fit to this mesh.
    ///
    /// # Errors
    /// As for [`from_mesh`](Self::from_mesh).
    pub fn fit(mesh: &Mesh) -> Result<Ellipsoid, SettingError> {
        check_mesh(mesh)?;
        let mut mesh = mesh.clone();
        mesh.turn_outward();
        fit::scalp(&mesh)
    }

    fn assemble(mesh: Mesh, ellipsoid: Ellipsoid, orientation: Orientation) -> Self {
        let [low, high] = bounds(&mesh.positions);
        // Hair is met near the skin; of a whole body only the part within its reach is sampled.
        let finest = ellipsoid.half_axes.min_element() / 24.0;
        let reach = 4.0 * ellipsoid.half_axes.max_element();
        let margin = 0.6 * ellipsoid.half_axes.max_element();
        let low = (low - margin).max(ellipsoid.center - reach);
        let high = (high + margin).min(ellipsoid.center + reach);
        // A flat ellipsoid on a large mesh would need too many samples.
        let spacing = finest.max(((high - low).element_product() / MOST_SAMPLES).cbrt());
        let skin = Arc::new(SkinDistance::new(&mesh, low, high, spacing));
        let openings = openings::of(&mesh, &ellipsoid, &skin);
        Self { bounds: bounds(&mesh.positions), mesh, ellipsoid, orientation, openings, is_builtin: false, skin }
    }

    /// Signed distance from `p` to the skin (cm), negative inside. Open rims of the mesh count as closed.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.skin.at(p)
    }

    /// The distance to the skin, for sharing with a [`Body`](crate::body::Body).
    pub fn skin(&self) -> &Arc<SkinDistance> {
        &self.skin
    }

    /// Like [`distance`](Self::distance), but computed from the mesh instead of samples. About 100 times slower.
    pub fn exact_distance(&self, p: Vec3) -> f32 {
        self.skin.exact(p)
    }

    /// How deep `p` lies inside the skin (cm); 0 outside. Fast everywhere, unlike the distance of distant points.
    pub fn depth(&self, p: Vec3) -> f32 {
        let [low, high] = self.bounds;
        let may_be_inside = p.cmpge(low).all() && p.cmple(high).all();
        if may_be_inside { (-self.skin.at(p)).max(0.0) } else { 0.0 }
    }

    /// Whether `p` lies inside the skin.
    pub fn contains(&self, p: Vec3) -> bool {
        self.depth(p) > 0.0
    }

    /// The unit vector along which the distance to the skin grows fastest at `p`. On the skin, it is the outward
    /// normal.
    pub fn outward(&self, p: Vec3) -> Vec3 {
        self.skin.gradient(p).try_normalize().unwrap_or_else(|| self.ellipsoid.gradient(p).normalize_or(Vec3::Y))
    }
}

/// Refuses a mesh for the reason `what`. Its size shows a wrong unit, its extent along each axis a wrong up axis.
fn refused_mesh(mesh: &Mesh, what: impl Display, remedy: &str) -> SettingError {
    let [low, high] = bounds(&mesh.positions);
    let size = high - low;
    let triangles = mesh.triangles.len();
    let [x, y, z] = size.to_array();
    let value = if (0.01..1e6).contains(&size.max_element()) {
        format!("{what}, {triangles} triangles, {x:.3} x {y:.3} x {z:.3} cm")
    } else {
        format!("{what}, {triangles} triangles, {x:.1e} x {y:.1e} x {z:.1e} cm")
    };
    SettingError::new("head.mesh", value, remedy)
}

fn check_mesh(mesh: &Mesh) -> Result<(), SettingError> {
    if mesh.triangles.is_empty() {
        return Err(SettingError::new("head.mesh", "no triangles", "must have a surface"));
    }
    if let Some(v) = mesh.triangles.iter().flatten().find(|v| **v as usize >= mesh.positions.len()) {
        let remedy = format!("must name one of the {} vertices, counted from 0", mesh.positions.len());
        return Err(SettingError::new("head.mesh", format!("index {v}"), remedy));
    }
    if let Some(v) = mesh.positions.iter().position(|p| !p.is_finite()) {
        let value = format!("vertex {v} at {}", mesh.positions[v]);
        return Err(SettingError::new("head.mesh", value, "must have finite coordinates"));
    }
    let triangles = mesh.triangles.len();
    if let Some(uvs) = mesh.corner_uvs.as_ref().filter(|uvs| uvs.len() != triangles) {
        let value = format!("texture coordinates of {} triangles", uvs.len());
        return Err(SettingError::new("head.mesh", value, format!("must have {triangles}, or none")));
    }
    let finite = |uvs: &[Vec2; 3]| uvs.iter().all(|uv| uv.is_finite());
    if let Some(t) = mesh.corner_uvs.iter().flatten().position(|uvs| !finite(uvs)) {
        let value = format!("triangle {t} with texture coordinates that are not finite");
        return Err(SettingError::new("head.mesh", value, "must have finite ones, or none"));
    }
    let has_area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        a != b && b != c && c != a
    };
    if !mesh.triangles.iter().any(has_area) {
        return Err(SettingError::new("head.mesh", "only triangles without area", "must have a surface"));
    }
    Ok(())
}

fn check_ellipsoid(ellipsoid: &Ellipsoid) -> Result<(), SettingError> {
    if !ellipsoid.center.is_finite() {
        return Err(SettingError::new("head.ellipsoid.center", ellipsoid.center, "must have finite coordinates"));
    }
    let h = ellipsoid.half_axes;
    if !(h.is_finite() && h.min_element() > 0.0) {
        return Err(SettingError::new("head.ellipsoid.half_axes", h, "must be finite numbers above 0"));
    }
    if h.max_element() > 4.0 * h.min_element() {
        return Err(SettingError::new("head.ellipsoid.half_axes", h, "must lie within a factor 4 of each other"));
    }
    Ok(())
}

/// Refuses a head of an unusable size.
fn check_size(mesh: &Mesh, ellipsoid: &Ellipsoid) -> Result<(), SettingError> {
    let size = ellipsoid.half_axes.as_dvec3().element_product().cbrt() as f32;
    if (HALF_AXES[0]..=HALF_AXES[1]).contains(&size) {
        return Ok(());
    }
    let remedy = format!(
        "its ellipsoid's half axes must lie in {} cm to {} cm (a person's are about 9 cm): correct head.unit",
        HALF_AXES[0], HALF_AXES[1]
    );
    Err(refused_mesh(mesh, format!("a head of {size:.3e} cm"), &remedy))
}

#[cfg(test)]
mod tests;
