//! What curves of a file carry beside their points, by the names that tools give it.

use super::Walked;
use crate::error::Problem;
use crate::hair::Attributes;

/// Where a file keeps what its curves carry: values by name, as many as there are.
pub trait Carried {
    /// Values of `N` numbers each; `None` where there are none of that name and shape.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn tuples<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f32; N]>>, Problem>;

    /// Whole numbers; `None` where there are none of that name.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn integers(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem>;

    /// Words; `None` where there are none of that name.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn words(&mut self, name: &str) -> Result<Option<Vec<String>>, Problem>;
}

/// Values that are stored once for many, by `indices` into them.
///
/// # Errors
/// An index past the values; `name` is theirs.
pub fn indexed<T: Clone>(name: &str, values: &[T], indices: &[i64]) -> Result<Vec<T>, Problem> {
    let pick = |&i: &i64| usize::try_from(i).ok().and_then(|i| values.get(i)).cloned();
    let picked: Option<Vec<T>> = indices.iter().map(pick).collect();
    picked.ok_or_else(|| Problem(format!("{name}: an index past its {} values", values.len())))
}

impl Walked {
    /// What `file` says of the curves, at the points of the strands or at their roots.
    ///
    /// Names are those of USD and Alembic, of Unreal's grooms (`groom_...`), of Blender (`surface_uv_coordinate`,
    /// `UVMap`) and of Houdini (`rootuv`, `id`).
    ///
    /// # Errors
    /// What is wrong with the file; numbers of values that fit neither curves nor points.
    pub fn attributes(&self, file: &mut impl Carried) -> Result<Attributes, Problem> {
        let one = |values: Vec<[f32; 1]>| values.into_iter().map(|[x]| x).collect::<Vec<f32>>();
        let mut found = Attributes {
            width: self.by_point(file, &["widths", "width", "groom_width"])?.map(one),
            color: self.by_point(file, &["displayColor", "groom_color", "color"])?,
            point_uv: self.by_point(file, &["point_uv"])?,
            freedom: self.by_point(file, &["freedom"])?.map(one),
            transparency: self.by_point(file, &["transparency"])?.map(one),
            id: self.by_strand(file, &["groom_id", "id", "ids", "hairId"])?,
            ..Attributes::default()
        };
        if found.transparency.is_none() {
            let opacity = self.by_point::<1>(file, &["displayOpacity"])?;
            found.transparency = opacity.map(|o| o.into_iter().map(|[x]| 1.0 - x).collect());
        }
        for name in ["st", "groom_root_uv", "root_uv", "surface_uv_coordinate", "rootuv", "uv", "UVMap"] {
            if found.root_uv.is_none() {
                found.root_uv = file.tuples(name)?.and_then(|v| self.at_roots(&v));
            }
        }
        let group = self.by_strand(file, &["groom_group_id", "group_id", "group"])?;
        found.group = group.map(|g| g.into_iter().map(|g| g as i32).collect());
        let guide = self.by_strand(file, &["groom_guide", "guide"])?;
        found.guide = guide.map(|g| g.into_iter().map(|g| g != 0).collect());
        if let Some(groups) = &found.group {
            let names = match file.words("groom_group_name")? {
                Some(words) => Some(words),
                None => file.words("group_name")?,
            };
            let names = names.and_then(|words| self.at_roots(&words)).unwrap_or_default();
            let named = groups.iter().copied().zip(names);
            found.group_names = named.filter(|(_, name)| !name.is_empty()).collect();
        }
        Ok(found)
    }

    /// Values at the points of the strands, of the first of `names` that has any.
    fn by_point<const N: usize>(
        &self,
        file: &mut impl Carried,
        names: &[&str],
    ) -> Result<Option<Vec<[f32; N]>>, Problem> {
        for name in names {
            let Some(values) = file.tuples::<N>(name)?.filter(|values| !values.is_empty()) else { continue };
            return match self.at_points(&values) {
                Some(found) => Ok(Some(found)),
                None => {
                    let (n, points, curves) = (values.len(), self.control_points(), self.shape.counts.len());
                    Err(Problem(format!("{name}: {n} values for {points} points of {curves} curves")))
                }
            };
        }
        Ok(None)
    }

    /// Whole numbers of the strands, of the first of `names` that has any.
    fn by_strand(&self, file: &mut impl Carried, names: &[&str]) -> Result<Option<Vec<i64>>, Problem> {
        for name in names {
            if let Some(values) = file.integers(name)?.filter(|values| !values.is_empty()) {
                return Ok(self.at_roots(&values));
            }
        }
        Ok(None)
    }
}
