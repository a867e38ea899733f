//! What curves carry beside their points: read by name and scope, and joined when curves lie in several objects.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use nabiki::Hair;
use nabiki::curves::Blend;
use nabiki::hair::Attributes;

use crate::Problem;
use crate::read::{ArchiveReader, append_strands};
use crate::tree::{Form, Header};
use crate::values::{integers, singles, words};

impl<R: Read + Seek> ArchiveReader<R> {
    /// The attributes of curves whose schema has the properties `inside`.
    pub(crate) fn attributes(
        &mut self,
        inside: &[Header],
        frame: usize,
        counts: &[usize],
        blends: &[Blend],
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
                    let width = self.by_point::<1>(header, frame, counts, blends)?;
                    found.width = width.map(|w| w.into_iter().map(|[w]| w).collect());
                }
                "color" => found.color = self.by_point::<3>(header, frame, counts, blends)?,
                "point_uv" => found.point_uv = self.by_point::<2>(header, frame, counts, blends)?,
                "transparency" => {
                    let values = self.by_point::<1>(header, frame, counts, blends)?;
                    found.transparency = values.map(|v| v.into_iter().map(|[v]| v).collect());
                }
                "freedom" => {
                    let values = self.by_point::<1>(header, frame, counts, blends)?;
                    found.freedom = values.map(|v| v.into_iter().map(|[v]| v).collect());
                }
                "uv" | "root_uv" => {
                    if let Some(uv) = self.by_strand_uv(header, frame, counts)? {
                        found.root_uv = Some(uv);
                    }
                }
                "id" => found.id = self.whole_by_strand(header, frame, counts.len())?,
                "group_id" => {
                    let groups = self.whole_by_strand(header, frame, counts.len())?;
                    found.group = groups.map(|g| g.into_iter().map(|g| g as i32).collect());
                }
                "guide" => {
                    let guides = self.whole_by_strand(header, frame, counts.len())?;
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
        if matches!(values.kind.pod, crate::layout::Pod::Text | crate::layout::Pod::WideText) {
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
        counts: &[usize],
        blends: &[Blend],
    ) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(values) = self.numbers::<N>(header, frame)? else { return Ok(None) };
        let points: usize = counts.iter().sum();
        let at_controls: Vec<[f32; N]> = match values.len() {
            n if n == points => values,
            1 => vec![values[0]; points],
            n if n == counts.len() => {
                counts.iter().zip(&values).flat_map(|(&count, &v)| std::iter::repeat_n(v, count)).collect()
            }
            0 => return Ok(None),
            n => {
                let name = &header.name;
                return Err(Problem(format!(
                    "attribute {name}: {n} values for {points} points of {} curves",
                    counts.len()
                )));
            }
        };
        Ok(Some(if blends.is_empty() { at_controls } else { blends.iter().map(|b| b.values(&at_controls)).collect() }))
    }

    fn by_strand_uv(
        &mut self,
        header: &Header,
        frame: usize,
        counts: &[usize],
    ) -> Result<Option<Vec<[f32; 2]>>, Problem> {
        let Some(values) = self.numbers::<2>(header, frame)? else { return Ok(None) };
        let points: usize = counts.iter().sum();
        Ok(match values.len() {
            n if n == counts.len() => Some(values),
            // One for each point: the root's counts.
            n if n == points => {
                let starts = counts.iter().scan(0, |at, &count| {
                    *at += count;
                    Some(*at - count)
                });
                Some(starts.map(|s| values.get(s).copied().unwrap_or_default()).collect())
            }
            _ => None,
        })
    }

    fn whole_by_strand(&mut self, header: &Header, frame: usize, strands: usize) -> Result<Option<Vec<i64>>, Problem> {
        let ((values, bytes), indices) = self.indexed(header, frame)?;
        if indices.is_some() || values.kind.extent != 1 {
            return Ok(None);
        }
        let numbers = match values.kind.pod {
            crate::layout::Pod::Text | crate::layout::Pod::WideText => return Ok(None),
            _ => integers(values.kind, &bytes)?,
        };
        Ok(match numbers.len() {
            n if n == strands => Some(numbers),
            1 => Some(vec![numbers[0]; strands]),
            _ => None,
        })
    }
}

/// Hair from several objects.
#[derive(Default)]
pub(crate) struct Gathered {
    all: Option<Hair>,
}

impl Gathered {
    /// Appends a part; `group` names it where it has no groups of its own. An attribute stays only if all parts
    /// have it.
    pub(crate) fn append(&mut self, mut part: Hair, group: Option<(i32, String)>) {
        if let (Some((number, name)), None) = (group, &part.attributes.group) {
            part.attributes.group = Some(vec![number; part.strands.len()]);
            part.attributes.group_names = BTreeMap::from([(number, name)]);
        }
        let Some(all) = &mut self.all else {
            self.all = Some(part);
            return;
        };
        append_strands(&mut all.strands, &part.strands);
        fn join<T>(a: &mut Option<Vec<T>>, b: Option<Vec<T>>) {
            match (a.as_mut(), b) {
                (Some(a), Some(b)) => a.extend(b),
                _ => *a = None,
            }
        }
        let (a, b) = (&mut all.attributes, part.attributes);
        join(&mut a.id, b.id);
        join(&mut a.root_uv, b.root_uv);
        join(&mut a.group, b.group);
        join(&mut a.guide, b.guide);
        join(&mut a.width, b.width);
        join(&mut a.color, b.color);
        join(&mut a.transparency, b.transparency);
        join(&mut a.point_uv, b.point_uv);
        join(&mut a.freedom, b.freedom);
        a.group_names.extend(b.group_names);
    }

    pub(crate) fn hair(self) -> Hair {
        self.all.unwrap_or_default()
    }
}
