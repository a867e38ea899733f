//! Moving hair into a USD layer, one frame at a time.

use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use glam::{Affine3A, Vec3};
use nabiki::Strands;
use nabiki::export::{Export, FrameSink};
use tempfile::NamedTempFile;

use crate::content::{curves, extent, skin};
use crate::crate_file::Rep;
use crate::crate_file::write::CrateWriter;
use crate::layer::{Attribute, Metadata, Prim, Value};
use crate::text::write::TextWriter;

/// Which prims a layer has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// A complete stage: a transform `/head`, below it the curves `hair` and, if there is one, the mesh `skin`.
    Stage,
    /// Samples of points and extent only, to be laid over the prim at this path (`/character/hair`), which must have
    /// the same strands. `world_from_head` is not in it: a groom keeps its own place.
    Layer(String),
}

/// A USD layer that takes the hair frame by frame.
pub struct HairStage<'a> {
    export: Export<'a>,
    path: PathBuf,
    names: Vec<String>,
    form: Form,
    to: Encoding,
    metadata: Metadata,
    margin: f32,
    times: Vec<f64>,
    extents: Vec<Value>,
    transforms: Vec<Value>,
    points: Vec<Vec3>,
    last_points: Vec<Vec3>,
}

type Writer = BufWriter<NamedTempFile>;

enum Encoding {
    /// Samples stand where they were written.
    Text(TextWriter<Writer>),
    /// Samples lie anywhere; an attribute lists where.
    Binary { to: Box<CrateWriter<Writer>>, samples: Vec<Rep> },
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, problem)
}

impl<'a> HairStage<'a> {
    /// Begins the layer that [`FrameSink::finish`] will name `path`: text if that ends in .usda, binary for .usdc and
    /// .usd.
    ///
    /// # Errors
    /// Another ending, a prim path that is none, settings that [`Export::check`] refuses, what the disk says.
    pub fn create(path: &Path, export: Export<'a>, form: Form) -> io::Result<Self> {
        export.check()?;
        let names = match &form {
            Form::Stage => vec!["head".to_owned(), "hair".to_owned()],
            Form::Layer(prim) => prim_names(prim)?,
        };
        let ending = path.extension().map(|e| e.to_ascii_lowercase());
        let binary = match ending.as_ref().and_then(|e| e.to_str()) {
            Some("usda") => false,
            Some("usdc" | "usd") => true,
            _ => return Err(invalid("a USD layer's name must end in .usda or .usdc".to_owned())),
        };
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let file = BufWriter::with_capacity(1 << 20, unnamed_in(folder)?);
        let start = f64::from(export.first_frame);
        let metadata = Metadata {
            default_prim: names[0].clone(),
            z_up: export.z_up,
            meters_per_unit: export.meters_per_unit,
            start,
            end: start,
            frame_rate: export.frame_rate,
        };
        let widest = export.widths().unwrap_or_default().into_iter().fold(0.0, f32::max);
        let to = if binary {
            Encoding::Binary { to: Box::new(CrateWriter::new(file)?), samples: Vec::new() }
        } else {
            let mut to = TextWriter::new(file, &metadata)?;
            let hair = names.len() - 1;
            match &form {
                Form::Stage => {
                    to.open("head", "Xform", 0)?;
                    if let Some(mesh) = export.head {
                        to.prim(&skin(mesh, &export), 1)?;
                    }
                    to.open("hair", "BasisCurves", 1)?;
                    for attribute in curves(&export, "hair").attributes {
                        to.attribute(&attribute, 2)?;
                    }
                }
                Form::Layer(_) => {
                    for (depth, name) in names.iter().enumerate() {
                        to.open(name, "", depth)?;
                    }
                }
            }
            to.begin_samples("points", "point3f[]", hair + 1)?;
            Encoding::Text(to)
        };
        Ok(Self {
            export,
            path: path.to_owned(),
            names,
            form,
            to,
            metadata,
            margin: 0.5 * widest,
            times: Vec::new(),
            extents: Vec::new(),
            transforms: Vec::new(),
            points: Vec::new(),
            last_points: Vec::new(),
        })
    }

    fn complete(mut self) -> io::Result<()> {
        let Some(&end) = self.times.last() else { return Err(invalid("no frame was given".to_owned())) };
        self.metadata.end = end;
        let still = self.transforms.iter().all(|t| *t == self.transforms[0]);
        let order = Value::Tokens(vec!["xformOp:transform".to_owned()]);
        let is_stage = self.form == Form::Stage;
        let file = match self.to {
            Encoding::Text(mut to) => {
                let depth = self.names.len();
                to.end_samples(depth)?;
                let timed = |values: Vec<Value>| self.times.iter().copied().zip(values).collect::<Vec<_>>();
                to.attribute(&Attribute::sampled("extent", "float3[]", timed(self.extents)), depth)?;
                to.close(depth - 1)?;
                if is_stage {
                    let mut transform = Attribute::sampled("xformOp:transform", "matrix4d", Vec::new());
                    if still {
                        transform.value = Some(self.transforms[0].clone());
                    } else {
                        transform.samples = timed(self.transforms);
                    }
                    to.attribute(&transform, 1)?;
                    to.attribute(&Attribute::uniform("xformOpOrder", "token[]", order), 1)?;
                }
                for depth in (0..depth - 1).rev() {
                    to.close(depth)?;
                }
                to.finish(end)?
            }
            Encoding::Binary { mut to, samples } => {
                let extents = self.extents.iter().map(|e| to.value(e)).collect::<io::Result<Vec<Rep>>>()?;
                let mut hair = if is_stage {
                    curves(&self.export, "hair")
                } else {
                    let name = self.names[self.names.len() - 1].clone();
                    Prim { name, type_name: "", attributes: Vec::new(), children: Vec::new() }
                };
                match hair.attributes.iter_mut().find(|a| a.name == "points") {
                    Some(attribute) => attribute.samples = samples,
                    None => hair.attributes.push(Attribute::sampled("points", "point3f[]", samples)),
                }
                hair.attributes.push(Attribute::sampled("extent", "float3[]", extents));
                let mut prim = hair;
                for name in self.names[..self.names.len() - 1].iter().rev() {
                    let type_name = if is_stage { "Xform" } else { "" };
                    let name = name.clone();
                    prim = Prim { name, type_name, attributes: Vec::new(), children: vec![prim] };
                }
                if is_stage {
                    if let Some(mesh) = self.export.head {
                        prim.children.insert(0, skin(mesh, &self.export));
                    }
                    let mut transform = Attribute::sampled("xformOp:transform", "matrix4d", Vec::new());
                    if still {
                        transform.value = Some(self.transforms[0].clone());
                    } else {
                        transform.samples =
                            self.transforms.iter().map(|t| to.value(t)).collect::<io::Result<Vec<Rep>>>()?;
                    }
                    prim.attributes = vec![transform, Attribute::uniform("xformOpOrder", "token[]", order)];
                }
                to.finish(&self.metadata, &[prim], &self.times)?
            }
        };
        let file = file.into_inner().map_err(|e| e.into_error())?;
        file.persist(&self.path).map_err(|e| e.error)?;
        Ok(())
    }
}

impl FrameSink for HairStage<'_> {
    fn frame(&mut self, strands: &Strands, world_from_head: &Affine3A) -> io::Result<()> {
        let points = self.export.points(strands, &mut self.points)?;
        let time = self.metadata.start + self.times.len() as f64;
        self.extents.push(Value::Triples(extent(points, self.margin)));
        match &mut self.to {
            Encoding::Text(to) => to.points(time, points, self.names.len())?,
            Encoding::Binary { to, samples } => {
                let rep = match samples.last() {
                    // Hair that stands still is written once.
                    Some(&last) if points == self.last_points => last,
                    _ => {
                        self.last_points.clear();
                        self.last_points.extend_from_slice(points);
                        to.points(points)?
                    }
                };
                samples.push(rep);
            }
        }
        // USD multiplies rows from the left.
        let parent = self.export.parent(world_from_head);
        self.transforms.push(Value::Matrix(parent.to_cols_array().map(f64::from)));
        self.times.push(time);
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.complete()
    }
}

/// The names along a prim path.
fn prim_names(path: &str) -> io::Result<Vec<String>> {
    let names: Vec<String> = path.strip_prefix('/').unwrap_or_default().split('/').map(str::to_owned).collect();
    let is_name = |name: &String| {
        let mut letters = name.chars();
        letters.next().is_some_and(|c| c.is_alphabetic() || c == '_')
            && letters.all(|c| c.is_alphanumeric() || c == '_')
    };
    if names.iter().all(is_name) {
        Ok(names)
    } else {
        Err(invalid(format!("prim path \"{path}\": must be like /character/hair")))
    }
}

/// A file in `folder` that goes away unless it is given a name, with the rights of any new file.
fn unnamed_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    // A temporary file is its owner's alone unless told otherwise; the user's mask still takes away from this.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
