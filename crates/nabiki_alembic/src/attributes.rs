//! What curves carry beside their points, by name.

use std::io::{Read, Seek};

use nabiki::curves::{Curves, Walked};
use nabiki::hair::Attributes;

use crate::Problem;
use crate::layout::Pod;
use crate::read::ArchiveReader;
use crate::tree::{Form, Header};
use crate::values::{integers, singles, words};

impl<R: Read + Seek> ArchiveReader<R> {
    /// The attributes of curves whose schema has the properties `inside`.
    pub(crate) fn attributes(
        &mut self,
        inside: &[Header],
        frame: usize,
        curves: &Curves<'_>,
        walked: &Walked,
    ) -> Result<Attributes, Problem> {
        let mut headers = inside.to_vec();
        if let Some(more) = inside.iter().find(|h| h.name == ".arbGeomParams" && h.form == Form::Compound) {
            headers.extend(self.tree().properties(more.place)?);
        }
        let mut found = Attributes::default();
        let mut group_names = None;
        for header in &headers {
            let name = header.name.strip_prefix("groom_").unwrap_or(&header.name);
            match name {
                "width" => {
                    let width = self.by_point::<1>(header, frame, curves, walked)?;
                    found.width = width.map(|w| w.into_iter().map(|[w]| w).collect());
                }
                "color" => found.color = self.by_point::<3>(header, frame, curves, walked)?,
                "point_uv" => found.point_uv = self.by_point::<2>(header, frame, curves, walked)?,
                "transparency" => {
                    let values = self.by_point::<1>(header, frame, curves, walked)?;
                    found.transparency = values.map(|v| v.into_iter().map(|[v]| v).collect());
                }
                "freedom" => {
                    let values = self.by_point::<1>(header, frame, curves, walked)?;
                    found.freedom = values.map(|v| v.into_iter().map(|[v]| v).collect());
                }
                "uv" | "root_uv" => {
                    let values = self.numbers::<2>(header, frame)?;
                    found.root_uv = values.and_then(|v| curves.at_roots(&v)).or(found.root_uv);
                }
                "id" => found.id = self.whole_by_strand(header, frame, curves)?,
                "group_id" => {
                    let groups = self.whole_by_strand(header, frame, curves)?;
                    found.group = groups.map(|g| g.into_iter().map(|g| g as i32).collect());
                }
                "guide" => {
                    let guides = self.whole_by_strand(header, frame, curves)?;
                    found.guide = guides.map(|g| g.into_iter().map(|g| g != 0).collect());
                }
                "group_name" => {
                    let (values, _) = self.indexed(header, frame)?;
                    group_names = Some(words(values.0.kind, &values.1));
                }
                _ => {}
            }
        }
        if let (Some(groups), Some(names)) = (&found.group, group_names) {
            let name = |s: usize| if names.len() == 1 { names.first() } else { names.get(s) };
            let named = groups.iter().enumerate().filter_map(|(s, &g)| Some((g, name(s)?.clone())));
            found.group_names = named.filter(|(_, name)| !name.is_empty()).collect();
        }
        Ok(found)
    }

    /// Values of an attribute and, where it is stored once for many, the indices into them.
    #[allow(clippy::type_complexity)]
    fn indexed(&mut self, header: &Header, frame: usize) -> Result<((Header, Vec<u8>), Option<Vec<i64>>), Problem> {
        if header.form != Form::Compound {
            let bytes = self.tree().sample(header, frame)?;
            return Ok(((header.clone(), bytes), None));
        }
        let inside = self.tree().properties(header.place)?;
        let part = |name: &str| {
            let found = inside.iter().find(|h| h.name == name && h.form != Form::Compound);
            found.cloned().ok_or_else(|| Problem(format!("attribute {}: has no {name}", header.name)))
        };
        let (values, indices) = (part(".vals")?, part(".indices")?);
        let bytes = self.tree().sample(&values, frame)?;
        let index = integers(indices.kind, &self.tree().sample(&indices, frame)?)?;
        Ok(((values, bytes), Some(index)))
    }

    /// `N` numbers for each value; `None` for attributes of another shape, which are not those meant.
    fn numbers<const N: usize>(&mut self, header: &Header, frame: usize) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let ((values, bytes), indices) = self.indexed(header, frame)?;
        if matches!(values.kind.pod, Pod::Text | Pod::WideText) {
            return Ok(None);
        }
        let numbers = singles(values.kind, &bytes)?;
        let found: Vec<[f32; N]> = match usize::from(values.kind.extent) {
            // Blender writes colours with an alpha; only what comes before it is kept.
            extent if extent >= N => numbers.chunks_exact(extent).map(|v| std::array::from_fn(|i| v[i])).collect(),
            _ => return Ok(None),
        };
        match indices {
            None => Ok(Some(found)),
            Some(indices) => {
                let pick = |&i: &i64| usize::try_from(i).ok().and_then(|i| found.get(i)).copied();
                let picked: Option<Vec<_>> = indices.iter().map(pick).collect();
                picked.map(Some).ok_or_else(|| Problem(format!("attribute {}: an index past its values", header.name)))
            }
        }
    }

    fn by_point<const N: usize>(
        &mut self,
        header: &Header,
        frame: usize,
        curves: &Curves<'_>,
        walked: &Walked,
    ) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(values) = self.numbers::<N>(header, frame)? else { return Ok(None) };
        if values.is_empty() {
            return Ok(None);
        }
        let found = curves.at_points(walked, &values);
        found.map(Some).ok_or_else(|| {
            let (n, points, curves) = (values.len(), curves.points.len(), curves.counts.len());
            Problem(format!("attribute {}: {n} values for {points} points of {curves} curves", header.name))
        })
    }

    fn whole_by_strand(
        &mut self,
        header: &Header,
        frame: usize,
        curves: &Curves<'_>,
    ) -> Result<Option<Vec<i64>>, Problem> {
        let ((values, bytes), indices) = self.indexed(header, frame)?;
        if indices.is_some() || values.kind.extent != 1 || matches!(values.kind.pod, Pod::Text | Pod::WideText) {
            return Ok(None);
        }
        Ok(curves.at_roots(&integers(values.kind, &bytes)?))
    }
}
