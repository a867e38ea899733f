//! What the palette finds by a few letters: commands, and settings with the place where they are.

use nabiki_scene::Scene;
use nabiki_scene::scene::{FormChoice, HeadSettings};
use toml::{Table, Value};

use crate::actions::{ACTIONS, Entry};
use crate::settings::{Group, Page, Row, Shape, When, value_at};

/// Something found.
#[derive(Clone, Copy, Debug)]
pub enum Found {
    /// A command.
    Action(&'static Entry),
    /// A setting, on a page.
    Setting(Page, &'static Group, &'static Row),
    /// What an interval of the wind has, in the timeline: its name, its key and what it is.
    Interval([&'static str; 3]),
}

/// What intervals have, which no page has.
const OF_INTERVALS: [[&str; 3]; 3] = [
    ["Force", "force.vector", "The vector of an interval: direction and strength of the wind."],
    ["Strength", "force.vector", "The strength of an interval's wind, |F|."],
    ["Frames", "force.through", "The last frame of an interval."],
];

impl Found {
    /// What it is called.
    pub fn title(self) -> String {
        match self {
            Self::Action(entry) => format!("{}  \u{203a}  {}", entry.menu, entry.name),
            Self::Setting(page, group, setting) => {
                format!("{}  \u{203a}  {}  \u{203a}  {}", page.title(), group.title, setting.label)
            }
            Self::Interval([name, ..]) => format!("Timeline  \u{203a}  Interval  \u{203a}  {name}"),
        }
    }

    /// What stands at the end of its line: the key to press, or what a scene file calls it.
    pub fn key(self) -> String {
        match self {
            Self::Action(entry) => entry.key.map(|key| key.text()).unwrap_or_default(),
            Self::Setting(_, group, setting) => format!("{}.{}", group.table, setting.key),
            Self::Interval([_, key, _]) => key.to_owned(),
        }
    }

    /// What it does.
    pub fn help(self) -> &'static str {
        match self {
            Self::Action(entry) => entry.help,
            Self::Setting(_, _, setting) => &setting.help,
            Self::Interval([.., help]) => help,
        }
    }

    /// Its own name and that of what it is in; and all else that is said of it.
    fn words(self) -> [String; 3] {
        let lower = |text: &str| text.to_lowercase();
        match self {
            Self::Action(entry) => [lower(entry.name), lower(entry.menu), lower(entry.help)],
            Self::Setting(page, group, setting) => {
                let about = format!("{} {} {} {}", self.key(), page.title(), setting.help, group.help);
                [lower(setting.label), lower(group.title), lower(&about.replace('_', " "))]
            }
            Self::Interval([name, key, help]) => {
                [lower(name), "interval".to_owned(), lower(&format!("{key} {help} wind timeline"))]
            }
        }
    }
}

/// What holds all words of `query`, in any order; the best first. Without words, all commands.
pub fn matching(query: &str) -> Vec<Found> {
    let query = query.to_lowercase().replace('_', " ");
    let words: Vec<&str> = query.split_whitespace().collect();
    let actions = ACTIONS.iter().map(Found::Action);
    let groups = Page::ALL.into_iter().flat_map(|page| page.groups().iter().map(move |group| (page, group)));
    let of_groups = groups
        .flat_map(|(page, group)| group.settings().iter().map(move |setting| Found::Setting(page, group, setting)));
    let settings = OF_INTERVALS.into_iter().map(Found::Interval).chain(of_groups);
    let mut found: Vec<(usize, Found)> = actions
        .chain(settings.filter(|_| !words.is_empty()))
        .filter_map(|found| Some((rank(&found.words(), &words)?, found)))
        .collect();
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, found)| found).collect()
}

/// How well words fit what is said of something, less is better: names that begin so come before those that hold it, and before help
/// that only speaks of it. None where one is missing.
fn rank([name, group, about]: &[String; 3], words: &[&str]) -> Option<usize> {
    words.iter().try_fold(0, |sum, word| {
        let rank = match word {
            word if name.starts_with(word) => 0,
            word if group.starts_with(word) => 1,
            word if name.contains(word) || group.contains(word) => 2,
            word if about.split(|c: char| !c.is_alphanumeric()).any(|of| of.starts_with(word)) => 5,
            word if about.contains(word) => 6,
            _ => return None,
        };
        Some(sum + rank)
    })
}

impl When {
    /// Whether it is so in a scene.
    pub fn holds(self, scene: &Scene) -> bool {
        match self {
            Self::Always => true,
            Self::Paper => scene.form == FormChoice::Paper,
            Self::Free => scene.form == FormChoice::Free,
            Self::Grown => scene.hair.grown().is_some(),
            Self::Imported => scene.hair.imported().is_some(),
            Self::ImportedHead => scene.head.mesh() != HeadSettings::BUILTIN,
        }
    }

    /// In which scenes, in words.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Always => "in all scenes",
            Self::Paper => "in the paper's form (Motion > Form)",
            Self::Free => "in the free form (Motion > Form)",
            Self::Grown => "if the hair is grown; in this scene it comes from a file",
            Self::Imported => "if the hair comes from a file; in this scene it is grown",
            Self::ImportedHead => "if the head comes from a file; in this scene it is built in",
        }
    }
}

/// The key under which a page shows a setting of a scene: that of the first entry of a list; of a table that the scene leaves out, and
/// of a list without entries, the table alone.
pub fn shown_key(settings: &Table, page: Page, group: &Group, setting: &Row) -> String {
    let lists = page.groups().iter().filter(|of| matches!(of.shape, Shape::List(_)));
    let list = lists
        .into_iter()
        .find(|of| group.table.strip_prefix(of.table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')));
    let table = match list {
        Some(list) => match value_at(settings, list.table).and_then(Value::as_array) {
            Some(entries) if !entries.is_empty() => {
                format!("{}[0]{}", list.table, group.table.strip_prefix(list.table).unwrap_or_default())
            }
            _ => return list.table.to_owned(),
        },
        None => group.table.to_owned(),
    };
    let is_left_out = matches!(group.shape, Shape::Optional(_)) && value_at(settings, &table).is_none();
    if is_left_out { table } else { format!("{table}.{}", setting.key) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actions::Action;

    fn keys(query: &str) -> Vec<String> {
        matching(query).into_iter().map(Found::key).collect()
    }

    fn first(query: &str) -> Option<Action> {
        matching(query).first().and_then(|found| match found {
            Found::Action(entry) => Some(entry.action),
            _ => None,
        })
    }

    #[test]
    fn commands_are_found_by_parts_of_words() {
        assert_eq!(first("und"), Some(Action::Undo));
        assert_eq!(first("sav as"), Some(Action::SaveAs));
        assert_eq!(matching("").len(), ACTIONS.len());
        assert!(matching("no such thing").is_empty());
    }

    #[test]
    fn every_setting_is_found_by_its_name_with_its_group_by_its_key_and_by_its_help() {
        for page in Page::ALL {
            for group in page.groups() {
                for setting in group.settings() {
                    let key = format!("{}.{}", group.table, setting.key);
                    let help: Vec<&str> = setting.help.split_whitespace().take(4).collect();
                    for query in [format!("{} {}", group.title, setting.label), key.clone(), help.join(" ")] {
                        assert!(keys(&query).contains(&key), "{query} does not find {key}");
                    }
                    assert!(keys(&format!("{} {}", setting.label, group.title))[..].contains(&key));
                }
            }
        }
        assert!(keys("curl").iter().take(7).all(|key| key.starts_with("hair.style.curl.")), "{:?}", keys("curl"));
        assert!(keys("vector").contains(&"force.vector".to_owned()));
        assert_eq!(keys("settle")[0], "free.settle");
    }

    #[test]
    fn a_setting_is_shown_where_the_scene_has_it() {
        let settings: Table = "fan = [{ strength = 1.0 }]\nbody = [{ mesh = 'a.obj' }]\ngust = {}\npoint = []\nhair.style.length.top = 1.0"
            .parse()
            .unwrap();
        let shown = |key: &str| {
            let (page, group, setting) = crate::settings::find(key).unwrap();
            shown_key(&settings, page, group, setting)
        };
        assert_eq!(shown("fan.falloff.radius"), "fan[0].falloff.radius");
        assert_eq!(shown("gust.intensity"), "gust.intensity");
        assert_eq!(shown("flow.thickness"), "flow", "it is left out");
        assert_eq!(shown("point.strength"), "point", "there is none");
        assert_eq!(shown("vortex.strength"), "vortex");
        assert_eq!(shown("body.motion.file"), "body[0].motion");
        assert_eq!(shown("hair.style.length.top"), "hair.style.length.top");
    }
}
