//! Moving hair into a USD layer, one frame at a time.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use glam::{DAffine3, Vec3};
use nabiki::Strands;
use nabiki_exchange::{Export, FrameSink, Velocities};
use nabiki_file::{PartFile, folder_of};

use crate::content::{curves, extent, skin};
use crate::crate_file::Rep;
use crate::crate_file::write::CrateWriter;
use crate::layer::{Attribute, Metadata, Prim, Value};
use crate::source::SKEL_BINDING;
use crate::text::write::TextWriter;

/// Which prims a layer has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LayerKind {
    /// A complete stage: a transform `/head`, below it the curves `hair` and, if there is one, the mesh `skin`.
    Stage,
    /// Samples of points and extent only, to be laid over the prim at this path (`/character/hair`), which must have
    /// the same strands. `world_from_head` is not in it: a groom keeps its own place. Where [`Export::bound`] says so the layer takes
    /// it off its skeleton, which would move these points once more, and has `world_from_head` instead of all transforms above it.
    Layer(String),
}

/// A USD layer that takes the hair frame by frame.
pub struct HairStage<'a> {
    export: Export<'a>,
    names: Vec<String>,
    form: LayerKind,
    to: Encoding,
    metadata: Metadata,
    margin: f32,
    times: Vec<f64>,
    extents: Vec<Value>,
    transforms: Vec<Value>,
    points: Vec<Vec3>,
    last_points: Vec<Vec3>,
    velocities: Option<Velocities>,
}

enum Encoding {
    /// Samples stand where they were written: those of velocities, which come with those of points, wait in a file
    /// without a name.
    Text { to: TextWriter<PartFile>, velocities: TextWriter<BufWriter<File>> },
    /// Samples lie anywhere; an attribute lists where.
    Binary { to: Box<CrateWriter<PartFile>>, points: Vec<Rep>, velocities: Vec<Rep> },
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
    pub fn create(path: &Path, export: Export<'a>, form: LayerKind) -> io::Result<Self> {
        export.check()?;
        let names = match &form {
            LayerKind::Stage => vec!["head".to_owned(), "hair".to_owned()],
            LayerKind::Layer(prim) => prim_names(prim)?,
        };
        let ending = path.extension().map(|e| e.to_ascii_lowercase());
        let binary = match ending.as_ref().and_then(|e| e.to_str()) {
            Some("usda") => false,
            Some("usdc" | "usd") => true,
            _ => return Err(invalid("a USD layer's name must end in .usda or .usdc".to_owned())),
        };
        let file = PartFile::create(path)?;
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
            Encoding::Binary { to: Box::new(CrateWriter::new(file)?), points: Vec::new(), velocities: Vec::new() }
        } else {
            let mut to = TextWriter::new(file, &metadata)?;
            let hair = names.len() - 1;
            match &form {
                LayerKind::Stage => {
                    to.open("head", "Xform", &[], 0)?;
                    if let Some(mesh) = export.head {
                        to.prim(&skin(mesh, &export), 1)?;
                    }
                    to.open("hair", "BasisCurves", &[], 1)?;
                    for attribute in curves(&export, "hair").attributes {
                        to.attribute(&attribute, 2)?;
                    }
                }
                LayerKind::Layer(_) => {
                    for (depth, name) in names.iter().enumerate() {
                        let schemas: &[&str] = if depth == hair && export.bound { &[SKEL_BINDING] } else { &[] };
                        to.open(name, "", schemas, depth)?;
                    }
                }
            }
            to.begin_samples("points", "point3f[]", hair + 1)?;
            let waiting = BufWriter::with_capacity(1 << 20, tempfile::tempfile_in(folder_of(path))?);
            Encoding::Text { to, velocities: TextWriter::part(waiting) }
        };
        // Over a groom lie its points alone.
        let velocities = (export.velocities && form == LayerKind::Stage).then(Velocities::default);
        Ok(Self {
            export,
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
            velocities,
        })
    }

    fn complete(mut self) -> io::Result<()> {
        let Some(&end) = self.times.last() else { return Err(invalid("no frame was given".to_owned())) };
        self.metadata.end = end;
        if let Some(last) = self.velocities.as_ref().and_then(Velocities::of_last) {
            self.to.velocities(end, last, self.names.len())?;
        }
        let Self { export, names, form, to, metadata, times, extents, transforms, .. } = self;
        let rest = Rest { export: &export, names: &names, is_stage: form == LayerKind::Stage, times: &times };
        let file = match to {
            Encoding::Text { to, velocities } => rest.text(to, velocities, extents, transforms)?,
            Encoding::Binary { to, points, velocities } => {
                rest.binary(*to, &metadata, points, velocities, &extents, &transforms)?
            }
        };
        file.finish()
    }
}

impl Encoding {
    /// Writes the velocities at a time code.
    fn velocities(&mut self, time: f64, found: &[Vec3], depth: usize) -> io::Result<()> {
        match self {
            Self::Text { velocities, .. } => velocities.points(time, found, depth),
            Self::Binary { to, velocities, .. } => {
                velocities.push(to.points(found)?);
                Ok(())
            }
        }
    }
}

/// What is written once the last frame is known.
struct Rest<'a> {
    export: &'a Export<'a>,
    names: &'a [String],
    is_stage: bool,
    times: &'a [f64],
}

impl Rest<'_> {
    /// Whether the curves are taken off their skeleton.
    fn is_unbound(&self) -> bool {
        !self.is_stage && self.export.bound
    }

    fn text(
        &self,
        mut to: TextWriter<PartFile>,
        velocities: TextWriter<BufWriter<File>>,
        extents: Vec<Value>,
        transforms: Vec<Value>,
    ) -> io::Result<PartFile> {
        let depth = self.names.len();
        let timed = |values: Vec<Value>| self.times.iter().copied().zip(values).collect::<Vec<_>>();
        to.end_samples(depth)?;
        to.attribute(&Attribute::sampled("extent", "float3[]", timed(extents)), depth)?;
        if self.is_stage && self.export.velocities && self.times.len() > 1 {
            to.begin_samples("velocities", "vector3f[]", depth)?;
            to.append(velocities)?;
            to.end_samples(depth)?;
        }
        if !self.is_stage {
            for attribute in blocked() {
                to.attribute(&attribute, depth)?;
            }
        }
        let mut transforms = Some(transforms);
        if let Some(transforms) = transforms.take_if(|_| self.is_unbound()) {
            for attribute in unbound(transforms, |values| Ok(timed(values)))? {
                to.attribute(&attribute, depth)?;
            }
        }
        to.close(depth - 1)?;
        if let Some(transforms) = transforms.filter(|_| self.is_stage) {
            for attribute in transform(transforms, &[], |values| Ok(timed(values)))? {
                to.attribute(&attribute, 1)?;
            }
        }
        for depth in (0..depth - 1).rev() {
            to.close(depth)?;
        }
        to.finish(self.times[self.times.len() - 1])
    }

    fn binary(
        &self,
        mut to: CrateWriter<PartFile>,
        metadata: &Metadata,
        points: Vec<Rep>,
        velocities: Vec<Rep>,
        extents: &[Value],
        transforms: &[Value],
    ) -> io::Result<PartFile> {
        let mut reps = |values: &[Value]| values.iter().map(|v| to.value(v)).collect::<io::Result<Vec<Rep>>>();
        let (name, above) = self.names.split_last().expect("a path has a name");
        let mut hair = if self.is_stage {
            curves(self.export, name)
        } else {
            Prim { name: name.clone(), type_name: "", schemas: &[], attributes: Vec::new(), children: Vec::new() }
        };
        match hair.attributes.iter_mut().find(|a| a.name == "points") {
            Some(attribute) => attribute.samples = points,
            None => hair.attributes.push(Attribute::sampled("points", "point3f[]", points)),
        }
        hair.attributes.push(Attribute::sampled("extent", "float3[]", reps(extents)?));
        if !velocities.is_empty() {
            hair.attributes.push(Attribute::sampled("velocities", "vector3f[]", velocities));
        }
        if !self.is_stage {
            hair.attributes.extend(blocked());
        }
        if self.is_unbound() {
            hair.schemas = &[SKEL_BINDING];
            hair.attributes.extend(unbound(transforms.to_vec(), |values| reps(&values))?);
        }
        let mut prim = hair;
        for name in above.iter().rev() {
            let type_name = if self.is_stage { "Xform" } else { "" };
            prim = Prim { name: name.clone(), type_name, schemas: &[], attributes: Vec::new(), children: vec![prim] };
        }
        if self.is_stage {
            if let Some(mesh) = self.export.head {
                prim.children.insert(0, skin(mesh, self.export));
            }
            prim.attributes = transform(transforms.to_vec(), &[], |values| reps(&values))?;
        }
        to.finish(metadata, &[prim], self.times)
    }
}

/// What a groom may say of the motion of its own points, which is not that of a layer's.
fn blocked<S>() -> impl Iterator<Item = Attribute<S>> {
    ["velocities", "accelerations"].into_iter().map(|name| Attribute::new(name, "vector3f[]", Value::Blocked))
}

/// What takes curves off their skeleton, to where `matrices` have them in the world: UsdSkel heeds no transform of what is bound, so its
/// own, and those above it, do not count.
fn unbound<S>(
    matrices: Vec<Value>,
    timed: impl FnOnce(Vec<Value>) -> io::Result<Vec<S>>,
) -> io::Result<impl Iterator<Item = Attribute<S>>> {
    let placed = transform(matrices, &["!resetXformStack!"], timed)?;
    Ok([Attribute::no_targets("skel:skeleton")].into_iter().chain(placed))
}

/// The attributes of a transform, after what stands `before` it in the order, that is a matrix: one where all are equal, otherwise the samples that `timed` makes.
fn transform<S>(
    matrices: Vec<Value>,
    before: &[&str],
    timed: impl FnOnce(Vec<Value>) -> io::Result<Vec<S>>,
) -> io::Result<Vec<Attribute<S>>> {
    let name = if before.is_empty() { "xformOp:transform" } else { "xformOp:transform:moved" };
    let mut transform = Attribute::sampled(name, "matrix4d", Vec::new());
    if matrices.iter().all(|t| *t == matrices[0]) {
        transform.value = Some(matrices[0].clone());
    } else {
        transform.samples = timed(matrices)?;
    }
    let order = Value::Tokens(before.iter().chain([&name]).map(|&word| word.to_owned()).collect());
    Ok(vec![transform, Attribute::uniform("xformOpOrder", "token[]", order)])
}

impl FrameSink for HairStage<'_> {
    fn frame(&mut self, strands: &Strands, world_from_head: &DAffine3) -> io::Result<()> {
        let points = self.export.points(strands, &mut self.points)?;
        let time = self.metadata.start + self.times.len() as f64;
        self.extents.push(Value::Triples(extent(points, self.margin)));
        match &mut self.to {
            Encoding::Text { to, .. } => to.points(time, points, self.names.len())?,
            Encoding::Binary { to, points: samples, .. } => {
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
        if let Some(velocities) = &mut self.velocities
            && let Some(found) = velocities.before(points, self.export.frame_rate)?
        {
            self.to.velocities(time - 1.0, found, self.names.len())?;
        }
        // USD multiplies rows from the left.
        let parent = self.export.parent(world_from_head);
        self.transforms.push(Value::Matrix(parent.to_cols_array()));
        self.times.push(time);
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<Option<String>> {
        self.complete()?;
        Ok(None)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::opened::Layer;
    use crate::source::BLOCKED;
    use nabiki::Hair;

    #[test]
    fn what_only_other_programs_ask_for_is_in_every_frame() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::new(1.0, -2.0, 3.0)]);
        let mut hair = Hair::from(strands.clone());
        hair.attributes.width = Some(vec![0.5, 0.25]);
        hair.attributes.id = Some(vec![7]);
        hair.attributes.root_uv = Some(vec![[0.5, 0.25]]);
        let skin = nabiki::Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..nabiki::Mesh::default()
        };
        let folder = tempfile::tempdir().unwrap();
        for name in ["hair.usda", "hair.usdc"] {
            let path = folder.path().join(name);
            let mut export = Export::new(&hair, 8.0);
            (export.velocities, export.first_frame, export.rest) = (true, 1001, true);
            (export.default_colour, export.head) = (Some([0.25, 0.5, 1.0]), Some(&skin));
            let mut sink = Box::new(HairStage::create(&path, export, LayerKind::Stage).unwrap());
            for frame in 0..3 {
                let mut moved = strands.clone();
                moved.points_mut()[1].x += (frame * frame) as f32;
                sink.frame(&moved, &DAffine3::IDENTITY).unwrap();
            }
            sink.finish().unwrap();
            let mut layer = Layer::file(&path).unwrap();
            for (said, expected) in [
                ("startTimeCode", 1001.0),
                ("endTimeCode", 1003.0),
                ("framesPerSecond", 8.0),
                ("timeCodesPerSecond", 8.0),
                ("metersPerUnit", 0.01),
            ] {
                assert_eq!(layer.metadata_number(said).unwrap(), Some(expected), "{name}: {said}");
            }
            let first = layer.metadata["defaultPrim"];
            assert_eq!(layer.words(first).unwrap(), ["head"], "{name}");
            let prim = layer.of_type("BasisCurves")[0];
            for (attribute, of) in [
                ("widths", "vertex"),
                ("primvars:displayColor", "constant"),
                ("primvars:groom_id", "uniform"),
                ("primvars:st", "uniform"),
                ("primvars:rest", "vertex"),
            ] {
                assert_eq!(layer.interpolation(prim, attribute).unwrap().as_deref(), Some(of), "{name}: {attribute}");
            }
            let skin = layer.of_type("Mesh")[0];
            assert_eq!(layer.word(skin, "subdivisionScheme").unwrap().as_deref(), Some("none"), "{name}");
            // The tip goes by 1 and by 3, eight times a second; the last frame goes on as it came.
            for (code, farthest, speed) in [(1001.0, 1.0, 8.0), (1002.0, 2.0, 24.0), (1003.0, 5.0, 24.0)] {
                let mut at = |attribute: &str| layer.points_at(prim, attribute, code).unwrap().unwrap();
                // The box about the hair is wider than that of its points by half of the widest.
                let [low, high] = [Vec3::new(0.0, -2.0, 0.0) - 0.25, Vec3::new(farthest, 0.0, 3.0) + 0.25];
                assert_eq!(at("extent"), [low, high], "{name}, code {code}");
                assert_eq!(at("velocities"), [Vec3::ZERO, Vec3::X * speed], "{name}, code {code}");
            }
        }
    }

    #[test]
    fn a_layer_over_a_groom_takes_the_grooms_own_velocities_away() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::X]);
        let hair = Hair::from(strands.clone());
        let folder = tempfile::tempdir().unwrap();
        for name in ["over.usda", "over.usdc"] {
            let path = folder.path().join(name);
            let form = LayerKind::Layer("/character/hair".to_owned());
            let mut sink = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), form).unwrap());
            sink.frame(&strands, &DAffine3::IDENTITY).unwrap();
            sink.finish().unwrap();
            let layer = Layer::file(&path).unwrap();
            for attribute in ["velocities", "accelerations"] {
                let found = layer.prims[1].attributes.get(attribute).and_then(|found| found.default);
                assert_eq!(found, Some(BLOCKED), "{name}: {attribute}");
            }
        }
    }
}
