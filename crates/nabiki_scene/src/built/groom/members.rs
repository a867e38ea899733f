//! The strands of regions that go by groups or an attribute of the hair.

use std::collections::BTreeSet;

use glam::Vec3;
use nabiki::hair::{Other, Per, Values};
use nabiki::region::{Members, Region};
use nabiki::{Hair, SettingError};

use crate::scene::{FormChoice, Scene};

/// What selects the strands of each region of a scene; `None` for regions that go by their place alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Selectors(Vec<Option<Selector>>);

#[derive(Clone, Debug, PartialEq)]
struct Selector {
    groups: Vec<String>,
    attribute: Option<String>,
}

impl Selectors {
    pub fn of(scene: &Scene) -> Self {
        let regions = if scene.form == FormChoice::Free { scene.free.regions.as_slice() } else { &[] };
        let of = |region: &Region| Selector { groups: region.groups.clone(), attribute: region.attribute.clone() };
        Self(regions.iter().map(|region| region.has_members().then(|| of(region))).collect())
    }

    /// The members of each region among this hair. `more_groups`: names of groups that other hair of the groom may have.
    pub fn members(&self, hair: &[&Hair], more_groups: &[&str]) -> Result<Vec<Option<Members>>, SettingError> {
        let of = |(i, selector): (usize, &Option<Selector>)| {
            let Some(selector) = selector else { return Ok(None) };
            let mut members = Vec::new();
            for hair in hair {
                members.extend(selector.members(&format!("free.regions[{i}]"), hair, more_groups)?);
            }
            Ok(Some(Members::new(members)))
        };
        self.0.iter().enumerate().map(of).collect()
    }
}

impl Selector {
    /// Root and weight of each strand that belongs to the region.
    fn members(&self, key: &str, hair: &Hair, more_groups: &[&str]) -> Result<Vec<(Vec3, f32)>, SettingError> {
        let mut weights = vec![1.0; hair.strands.len()];
        if !self.groups.is_empty() {
            let chosen = self.numbers(key, hair, more_groups)?;
            let groups = hair.attributes.group.as_deref().unwrap_or_default();
            weights.iter_mut().zip(groups).filter(|(_, group)| !chosen.contains(group)).for_each(|(w, _)| *w = 0.0);
        }
        if let Some(name) = &self.attribute {
            let key = format!("{key}.attribute");
            let values = root_values(&key, hair, name)?;
            for (s, (weight, value)) in weights.iter_mut().zip(values).enumerate() {
                if !(0.0..=1.0).contains(&value) {
                    let remedy = format!("must be 0 to 1 for each strand, but is {value} for strand {s}");
                    return Err(SettingError::new(key, format!("{name:?}"), remedy));
                }
                *weight *= value as f32;
            }
        }
        let roots = hair.strands.iter().map(|strand| strand[0]);
        Ok(roots.zip(weights).filter(|&(_, weight)| weight > 0.0).collect())
    }

    /// The numbers of the groups.
    fn numbers(&self, key: &str, hair: &Hair, more_groups: &[&str]) -> Result<BTreeSet<i32>, SettingError> {
        let names = &hair.attributes.group_names;
        let there: BTreeSet<i32> = hair.attributes.group.iter().flatten().copied().collect();
        let mut chosen = BTreeSet::new();
        for group in &self.groups {
            let named = names.iter().filter(|&(_, name)| name == group).map(|(&number, _)| number);
            // Groups without names go by their numbers.
            let plain = group.parse().ok().filter(|number| there.contains(number) && !names.contains_key(number));
            let found: Vec<i32> = named.chain(plain).collect();
            if found.is_empty() && !more_groups.contains(&group.as_str()) {
                let known = there.iter().map(|number| names.get(number).cloned().unwrap_or_else(|| number.to_string()));
                let remedy = match listed(known.collect()) {
                    Some(known) => format!("no group of the hair; it has {known}"),
                    None => "the hair has no groups: use near or attribute".to_owned(),
                };
                return Err(SettingError::new(format!("{key}.groups"), format!("{group:?}"), remedy));
            }
            chosen.extend(found);
        }
        Ok(chosen)
    }
}

/// The number of an attribute at each root.
fn root_values(key: &str, hair: &Hair, name: &str) -> Result<Vec<f64>, SettingError> {
    let usable =
        |other: &&Other| other.extent == 1 && other.per != Per::Groom && !matches!(other.values, Values::Words(_));
    let usable = || hair.attributes.other.iter().filter(usable);
    let Some(found) = usable().find(|other| other.name == name) else {
        let known = usable().map(|other| other.name.clone()).collect();
        let remedy = match listed(known) {
            Some(known) => format!("no attribute of the hair with one number per strand or point; it has {known}"),
            None => "the hair has no attributes with one number per strand or point: use near or groups".to_owned(),
        };
        return Err(SettingError::new(key, format!("{name:?}"), remedy));
    };
    let at = |i: usize| match &found.values {
        Values::Floats(values) => f64::from(values[i]),
        Values::Doubles(values) => values[i],
        Values::Integers(values) => values[i] as f64,
        Values::Words(_) => f64::NAN,
    };
    let index = |s: usize| if found.per == Per::Point { hair.strands.range(s).start } else { s };
    Ok((0..hair.strands.len()).map(|s| at(index(s))).collect())
}

/// The first of these names, or `None` if there are none.
fn listed(names: Vec<String>) -> Option<String> {
    const MOST: usize = 8;
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    let first: Vec<&str> = names.iter().take(MOST).map(String::as_str).collect();
    (!first.is_empty()).then(|| first.join(", ") + &more)
}
