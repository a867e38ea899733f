//! The strands of regions that go by groups or an attribute of the hair, by weights of the head's mesh, or by a painted map.

mod weights;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use glam::{Vec2, Vec3};
use nabiki::distance::Surface;
use nabiki::region::{Members, Region};
use nabiki::{Hair, Head, SettingError};
use nabiki_io::painted::{self, PaintedMap};

use crate::built::stage::At;
use crate::error::Result;
use crate::scene::{FormChoice, Scene};

/// What a setting may refuse.
type Refusable<T> = std::result::Result<T, SettingError>;

/// What selects the strands of each region of a scene; `None` for regions that go by their place alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Selectors(Vec<Option<Selector>>);

#[derive(Clone, Debug, PartialEq)]
struct Selector {
    groups: Vec<String>,
    attribute: Option<String>,
    values: Vec<i32>,
    map: Option<Arc<Map>>,
}

/// A painted map.
#[derive(Debug, PartialEq)]
struct Map {
    /// As the scene names it.
    named: PathBuf,
    file: PathBuf,
    stamp: Option<(u64, SystemTime)>,
    picture: PaintedMap,
}

/// Names of groups that the hair itself does not have.
#[derive(Clone, Debug, Default)]
pub(super) struct Names<'a> {
    /// Of other hair of the groom, which is not here.
    pub of_others: &'a [&'a str],
    /// Of all hair, where it has no groups: name and path of the only object with curves.
    pub of_all: Vec<String>,
}

impl Selectors {
    /// Those of a scene; maps that a known scene has read are not read again.
    ///
    /// # Errors
    /// A map that cannot be read.
    pub fn of<'a>(scene: &Scene, known: impl Iterator<Item = &'a Self> + Clone, at: At<'_>) -> Result<Self> {
        let regions = if scene.form == FormChoice::Free { scene.free.regions.as_slice() } else { &[] };
        let of = |(i, region): (usize, &Region)| {
            if !region.has_members() {
                return Ok(None);
            }
            let map = region.map.as_ref().map(|file| {
                let known = known.clone().flat_map(|of| &of.0).flatten().filter_map(|selector| selector.map.as_ref());
                Map::of(scene, &format!("free.regions[{i}].map"), file, known, at)
            });
            let (groups, attribute, values) = (region.groups.clone(), region.attribute.clone(), region.values.clone());
            Ok(Some(Selector { groups, attribute, values, map: map.transpose()? }))
        };
        regions.iter().enumerate().map(of).collect::<Result<_>>().map(Self)
    }

    /// The painted maps.
    pub fn maps(&self) -> impl Iterator<Item = &PaintedMap> {
        self.0.iter().flatten().filter_map(|selector| Some(&selector.map.as_ref()?.picture))
    }

    /// The names of the attributes that regions go by.
    pub fn attributes(&self) -> impl Iterator<Item = &str> {
        self.0.iter().flatten().filter_map(|selector| selector.attribute.as_deref())
    }

    /// The members of each region among this hair, which stands on this head.
    pub fn members(&self, hair: &[&Hair], head: &Head, names: &Names<'_>) -> Refusable<Vec<Option<Members>>> {
        let of = |(i, selector): (usize, &Option<Selector>)| {
            let Some(selector) = selector else { return Ok(None) };
            let mut members = Vec::new();
            for hair in hair {
                members.extend(selector.members(&format!("free.regions[{i}]"), hair, head, names)?);
            }
            Ok(Some(Members::new(members)))
        };
        self.0.iter().enumerate().map(of).collect()
    }
}

impl Selector {
    /// Root and weight of each strand that belongs to the region.
    fn members(&self, key: &str, hair: &Hair, head: &Head, names: &Names<'_>) -> Refusable<Vec<(Vec3, f32)>> {
        let mut weights = vec![1.0; hair.strands.len()];
        if let Some(chosen) = self.numbers(key, hair, names)? {
            let groups = hair.attributes.group.as_deref().unwrap_or_default();
            weights.iter_mut().zip(groups).filter(|(_, group)| !chosen.contains(group)).for_each(|(w, _)| *w = 0.0);
        }
        if let Some(name) = &self.attribute {
            let values = weights::at_roots(&format!("{key}.attribute"), hair, head, name, &self.values)?;
            weights.iter_mut().zip(values).for_each(|(weight, value)| *weight *= value as f32);
        }
        if let Some(map) = &self.map {
            let uvs = map.root_uvs(&format!("{key}.map"), hair, head)?;
            weights.iter_mut().zip(uvs).for_each(|(weight, uv)| *weight *= map.picture.at(uv));
        }
        let roots = hair.strands.iter().map(|strand| strand[0]);
        Ok(roots.zip(weights).filter(|&(_, weight)| weight > 0.0).collect())
    }

    /// The numbers of the groups; `None` for all hair.
    fn numbers(&self, key: &str, hair: &Hair, names: &Names<'_>) -> Refusable<Option<BTreeSet<i32>>> {
        if self.groups.is_empty() {
            return Ok(None);
        }
        let named = &hair.attributes.group_names;
        let there: BTreeSet<i32> = hair.attributes.group.iter().flatten().copied().collect();
        let mut chosen = BTreeSet::new();
        for group in &self.groups {
            if hair.attributes.group.is_none() && names.of_all.contains(group) {
                return Ok(None);
            }
            let by_name = named.iter().filter(|&(_, name)| name == group).map(|(&number, _)| number);
            // Groups without names go by their numbers.
            let by_number = group.parse().ok().filter(|number| there.contains(number) && !named.contains_key(number));
            let found: Vec<i32> = by_name.chain(by_number).collect();
            if found.is_empty() && !names.of_others.contains(&group.as_str()) {
                let word = |number: &i32| named.get(number).cloned().unwrap_or_else(|| number.to_string());
                let known = there.iter().map(word).chain(names.of_others.iter().map(|&name| name.to_owned()));
                let all = names.of_all.first().filter(|_| hair.attributes.group.is_none());
                let remedy = match listed(known.chain(all.cloned())) {
                    Some(known) => format!("no group of the hair; it has {known}"),
                    None => "the hair has no groups: use near or attribute".to_owned(),
                };
                return Err(SettingError::new(format!("{key}.groups"), format!("{group:?}"), remedy));
            }
            chosen.extend(found);
        }
        Ok(Some(chosen))
    }
}

impl Map {
    fn of<'a>(
        scene: &Scene,
        key: &str,
        named: &Path,
        mut known: impl Iterator<Item = &'a Arc<Self>>,
        at: At<'_>,
    ) -> Result<Arc<Self>> {
        let file = at.there(scene.file(), key, named)?;
        let stamp = painted::stamp(&file);
        if let Some(known) = known.find(|known| known.file == file && known.stamp == stamp && stamp.is_some()) {
            return Ok(known.clone());
        }
        let picture = PaintedMap::read(&file)?;
        Ok(Arc::new(Self { named: named.to_owned(), file, stamp, picture }))
    }

    /// Where on the map each strand grows: at its own texture coordinates, or else at those of the skin there.
    fn root_uvs(&self, key: &str, hair: &Hair, head: &Head) -> Refusable<Vec<Vec2>> {
        if let Some(uvs) = &hair.attributes.root_uv {
            return Ok(uvs.iter().map(|&uv| uv.into()).collect());
        }
        let (Some(corners), Some(skin)) = (&head.mesh.corner_uvs, Surface::new(&head.mesh)) else {
            let remedy = "neither the hair's roots nor the head's mesh have texture coordinates (UVs), which a map needs: \
                          add them in the file, or use near, groups or attribute";
            return Err(SettingError::new(key, format!("\"{}\"", self.named.display()), remedy));
        };
        let of = |strand: &[Vec3]| {
            let (triangle, weights) = skin.nearest(strand[0]);
            let [a, b, c] = corners[triangle];
            a * weights.x + b * weights.y + c * weights.z
        };
        Ok(hair.strands.iter().map(of).collect())
    }
}

/// The first of these names, or `None` if there are none.
fn listed(names: impl Iterator<Item = String>) -> Option<String> {
    const MOST: usize = 8;
    let names: BTreeSet<String> = names.collect();
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    let first: Vec<&str> = names.iter().take(MOST).map(String::as_str).collect();
    (!first.is_empty()).then(|| first.join(", ") + &more)
}
