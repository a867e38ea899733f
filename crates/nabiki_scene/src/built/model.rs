//! The head of a scene, in its place.

use std::path::PathBuf;
use std::sync::OnceLock;

use glam::Vec3;
use nabiki::body::{Body, Contact};
use nabiki::{Head, SettingError};
use nabiki_groom::bust;
use nabiki_io::mesh::{self, MeshReport};
use nabiki_io::{DeclaredSpace, Placement, declared_space};

use super::stage::{At, Stage};
use crate::error::Result;
use crate::scene::{EllipsoidChoice, HeadSettings, HeadSource, Scene, resolved};

/// A head, and what its file said of it. It is equal to itself and to no other.
#[derive(Debug)]
pub struct Model {
    pub(crate) inputs: ModelInputs,
    /// The head.
    pub head: Head,
    /// How its file lies in head space; the identity for the built-in head.
    pub placement: Placement,
    /// What its file held; `None` for the built-in head.
    pub report: Option<MeshReport>,
    /// What its file says of its own space.
    pub(crate) declared: DeclaredSpace,
    /// What hair does not enter, once that is asked for.
    body: OnceLock<Body>,
}

/// What a head is made from.
#[derive(Debug, PartialEq)]
pub(crate) struct ModelInputs {
    /// That of the scene, to whose folder paths are relative.
    pub file: PathBuf,
    pub source: HeadSource,
    pub ellipsoid: EllipsoidChoice,
}

impl ModelInputs {
    pub fn of(scene: &Scene) -> Self {
        let HeadSettings { source, ellipsoid, .. } = &scene.head;
        Self { file: scene.file().to_owned(), source: source.clone(), ellipsoid: *ellipsoid }
    }
}

impl PartialEq for Model {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Model {
    /// The file of its mesh; `None` for the built-in head.
    pub(super) fn file(&self) -> Option<PathBuf> {
        match &self.inputs.source {
            HeadSource::Imported(head) => Some(resolved(&self.inputs.file, &head.mesh)),
            HeadSource::Builtin => None,
        }
    }

    /// It as what hair does not enter.
    pub(super) fn body(&self, contact: Contact) -> Body {
        let mut body = self.body.get_or_init(|| Body::head(&self.head, contact)).clone();
        body.contact = contact;
        body
    }
}

impl Stage for Model {
    type Inputs = ModelInputs;

    fn is_of(&self, inputs: &ModelInputs) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: ModelInputs, at: At<'_>) -> Result<Self> {
        let given = match inputs.ellipsoid {
            EllipsoidChoice::Fit => None,
            EllipsoidChoice::Given(ellipsoid) => Some(ellipsoid),
        };
        let (head, placement, report, declared) = match &inputs.source {
            HeadSource::Builtin => {
                let head = match given {
                    None => bust(),
                    Some(given) => bust().with_ellipsoid(given).map_err(|refused| at.refusal(refused))?,
                };
                (head, Placement::default(), None, DeclaredSpace::default())
            }
            HeadSource::Imported(imported) => {
                let file = at.there(&inputs.file, "head.mesh", &imported.mesh)?;
                let declared = declared_space(&file)?;
                let mut placement = imported.placement(declared.unit, declared.up);
                placement.check("head").map_err(|refused| at.refusal(refused))?;
                let (mut mesh, report) = mesh::import(&file, &placement, &imported.groups)?;
                let refused = |refused: SettingError| {
                    let value = format!("{}, {}", imported.mesh.display(), refused.value);
                    at.refusal(if refused.thing == "head.mesh" { SettingError { value, ..refused } } else { refused })
                };
                let mut ellipsoid = given;
                if imported.origin.is_none() && given.is_none() {
                    let mut fitted = Head::fit(&mesh).map_err(refused)?;
                    placement.origin = placement.file_from_head().transform_point3(fitted.center);
                    for p in &mut mesh.positions {
                        *p -= fitted.center;
                    }
                    fitted.center = Vec3::ZERO;
                    ellipsoid = Some(fitted);
                }
                let head = Head::from_mesh(mesh, ellipsoid).map_err(refused)?;
                (head, placement, Some(report), declared)
            }
        };
        Ok(Self { inputs, head, placement, report, declared, body: OnceLock::new() })
    }
}
