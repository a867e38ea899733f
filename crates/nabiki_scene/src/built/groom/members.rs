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

/// Names of groups that the hair itself does not have.
#[derive(Clone, Debug, Default)]
pub(super) struct Names<'a> {
    /// Of other hair of the groom, which is not here.
    pub of_others: &'a [&'a str],
    /// Of all hair, where it has no groups: name and path of the only object with curves.
    pub of_all: Vec<String>,
}

impl Selectors {
    pub fn of(scene: &Scene) -> Self {
        let regions = if scene.form == FormChoice::Free { scene.free.regions.as_slice() } else { &[] };
        let of = |region: &Region| Selector { groups: region.groups.clone(), attribute: region.attribute.clone() };
        Self(regions.iter().map(|region| region.has_members().then(|| of(region))).collect())
    }

    /// The members of each region among this hair.
    pub fn members(&self, hair: &[&Hair], names: &Names<'_>) -> Result<Vec<Option<Members>>, SettingError> {
        let of = |(i, selector): (usize, &Option<Selector>)| {
            let Some(selector) = selector else { return Ok(None) };
            let mut members = Vec::new();
            for hair in hair {
                members.extend(selector.members(&format!("free.regions[{i}]"), hair, names)?);
            }
            Ok(Some(Members::new(members)))
        };
        self.0.iter().enumerate().map(of).collect()
    }
}

impl Selector {
    /// Root and weight of each strand that belongs to the region.
    fn members(&self, key: &str, hair: &Hair, names: &Names<'_>) -> Result<Vec<(Vec3, f32)>, SettingError> {
        let mut weights = vec![1.0; hair.strands.len()];
        if let Some(chosen) = self.numbers(key, hair, names)? {
            let groups = hair.attributes.group.as_deref().unwrap_or_default();
            weights.iter_mut().zip(groups).filter(|(_, group)| !chosen.contains(group)).for_each(|(w, _)| *w = 0.0);
        }
        if let Some(name) = &self.attribute {
            let values = root_values(&format!("{key}.attribute"), hair, name)?;
            weights.iter_mut().zip(values).for_each(|(weight, value)| *weight *= value as f32);
        }
        let roots = hair.strands.iter().map(|strand| strand[0]);
        Ok(roots.zip(weights).filter(|&(_, weight)| weight > 0.0).collect())
    }

    /// The numbers of the groups; `None` for all hair.
    fn numbers(&self, key: &str, hair: &Hair, names: &Names<'_>) -> Result<Option<BTreeSet<i32>>, SettingError> {
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

/// The number of an attribute at each root.
fn root_values(key: &str, hair: &Hair, name: &str) -> Result<Vec<f64>, SettingError> {
    let refused = |why: String| Err(SettingError::new(key, format!("{name:?}"), why));
    let of = &hair.attributes;
    let Some(found) = of.other.iter().find(|other| other.name == name) else {
        let is_it = |line: &&String| line.split(|c: char| !c.is_alphanumeric() && !"_:".contains(c)).any(|w| w == name);
        if let Some(line) = of.unread.iter().find(is_it) {
            return refused(format!("the file has it, but it was not read: {line}"));
        }
        return refused(
            match listed(of.other.iter().filter(|other| is_weight(other)).map(|other| other.name.clone())) {
                Some(known) => format!("no attribute of the hair with one number per strand or point; it has {known}"),
                None => "the hair has no attributes with one number per strand or point: use near or groups".to_owned(),
            },
        );
    };
    if !is_weight(found) {
        let has = match (&found.values, found.per, found.extent) {
            (Values::Words(_), ..) => "words".to_owned(),
            (_, Per::Groom, _) => "one value for all the hair".to_owned(),
            (.., extent) => format!("{extent} numbers each"),
        };
        return refused(format!("has {has}, but a weight is one number per strand or point"));
    }
    let at = |i: usize| match &found.values {
        Values::Floats(values) => f64::from(values[i]),
        Values::Doubles(values) => values[i],
        Values::Integers(values) => values[i] as f64,
        Values::Words(_) => f64::NAN,
    };
    let index = |s: usize| if found.per == Per::Point { hair.strands.range(s).start } else { s };
    let values: Vec<f64> = (0..hair.strands.len()).map(|s| at(index(s))).collect();
    match values.iter().enumerate().find(|(_, value)| !(0.0..=1.0).contains(*value)) {
        Some((s, value)) => {
            let (value, count) = (*value as f32, values.len());
            refused(format!(
                "is {value} at the root of strand {s} of {count}, but must be 0 to 1: correct it in the file"
            ))
        }
        None => Ok(values),
    }
}

/// Whether an attribute has one number per strand or point.
fn is_weight(of: &Other) -> bool {
    of.extent == 1 && of.per != Per::Groom && !matches!(of.values, Values::Words(_))
}

/// The first of these names, or `None` if there are none.
fn listed(names: impl Iterator<Item = String>) -> Option<String> {
    const MOST: usize = 8;
    let names: BTreeSet<String> = names.collect();
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    let first: Vec<&str> = names.iter().take(MOST).map(String::as_str).collect();
    (!first.is_empty()).then(|| first.join(", ") + &more)
}
