//! The head of a scene.

use std::path::PathBuf;
use std::sync::OnceLock;

use glam::Vec3;
use nabiki::body::{Body, Contact};
use nabiki::{Head, SettingError};
use nabiki_groom::bust;
use nabiki_io::info::Short;
use nabiki_io::mesh::{self, MeshReport};
use nabiki_io::{DeclaredSpace, Placement, declared_space};

use super::live_skin::FileVertices;
use super::stage::{At, Stage};
use crate::advice::{Advice, Fix};
use crate::error::Result;
use crate::scene::{EllipsoidChoice, HeadSettings, HeadSource, Scene, resolved};
use crate::size::{HALF_AXES, HALF_AXIS, mean_half_axis, unit_for};

/// A head with the data of its file. It is equal only to itself.
#[derive(Debug)]
pub struct Model {
    pub(crate) inputs: ModelInputs,
    /// The head.
    pub head: Head,
    /// Its file's placement in head space; the identity for the built-in head.
    pub placement: Placement,
    /// The results of the import; `None` for the built-in head.
    pub report: Option<MeshReport>,
    /// Unit and axes that its file declares.
    pub(crate) declared: DeclaredSpace,
    /// How the vertices of its file become those of the head; `None` for the built-in head.
    pub(super) vertices: Option<FileVertices>,
    /// The head as a body, once it is needed.
    body: OnceLock<Body>,
}

/// The inputs of a head.
#[derive(Debug, PartialEq)]
pub(crate) struct ModelInputs {
    /// The scene file, to whose folder paths are relative.
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

    /// Whether its size is not that of a person's head.
    pub(crate) fn of_size(&self) -> Option<Advice> {
        let Self { inputs, placement, declared, .. } = self;
        let ellipsoid = &self.head.ellipsoid;
        let size = mean_half_axis(ellipsoid);
        if (HALF_AXES[0]..=HALF_AXES[1]).contains(&size) {
            return None;
        }
        let [x, y, z] = ellipsoid.half_axes.to_array().map(Short);
        // A creature's head may have any size.
        let seen = format!("the head's half axes are {x} x {y} x {z} cm; a person's head has about 9.5 x 11 x 7.8 cm");
        let HeadSource::Imported(head) = &inputs.source else {
            return Some(Advice::new(format!("{seen}: correct head.ellipsoid")));
        };
        let seen = match declared.unit.filter(|_| head.unit.is_none()) {
            Some(unit) => format!("{seen}; its file is in {unit}"),
            None => seen,
        };
        if matches!(inputs.ellipsoid, EllipsoidChoice::Given(_)) {
            let seen = format!("{seen}: correct head.unit or head.ellipsoid");
            return Some(Advice::new(seen));
        }
        let value = unit_for(size / placement.unit.cm, HALF_AXIS);
        Some(Advice { seen, fixes: vec![Fix { key: "head.unit", value }] })
    }

    /// The head as a body.
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
        let (head, placement, report, declared, vertices) = match &inputs.source {
            HeadSource::Builtin => {
                let head = match given {
                    None => bust(),
                    Some(given) => bust().with_ellipsoid(given).map_err(|refused| at.refusal(refused))?,
                };
                (head, Placement::default(), None, DeclaredSpace::default(), None)
            }
            HeadSource::Imported(imported) => {
                let file = at.there(&inputs.file, "head.mesh", &imported.mesh)?;
                let declared = declared_space(&file)?;
                let mut placement = imported.placement(declared.unit, declared.up);
                placement.check("head").map_err(|refused| at.refusal(refused))?;
                let (read, unread) = mesh::read_with_losses(&file, &imported.groups)?;
                let (welded, head_from_file) = (mesh::welded_from(&read.positions), placement.head_from_file());
                let (mut mesh, mut report) = mesh::place_and_weld(read, &placement).map_err(|e| e.in_file(&file))?;
                report.unread = unread;
                let mut center = Vec3::ZERO;
                let refused = |refused: SettingError| {
                    let value = format!("{}, {}", imported.mesh.display(), refused.value);
                    at.refusal(if refused.thing == "head.mesh" { SettingError { value, ..refused } } else { refused })
                };
                let mut ellipsoid = given;
                if imported.origin.is_none() && given.is_none() {
                    let mut fitted = Head::fit(&mesh).map_err(refused)?;
                    placement.origin = placement.file_from_head().transform_point3(fitted.center);
                    center = fitted.center;
                    for p in &mut mesh.positions {
                        *p -= center;
                    }
                    fitted.center = Vec3::ZERO;
                    ellipsoid = Some(fitted);
                }
                let head = Head::from_mesh(mesh, ellipsoid).map_err(refused)?;
                let vertices = FileVertices { welded, head_from_file, center };
                (head, placement, Some(report), declared, Some(vertices))
            }
        };
        Ok(Self { inputs, head, placement, report, declared, vertices, body: OnceLock::new() })
    }
}
