//! The schema of scenes against scenes: it has every key that a file may have, and what it calls valid is read, written and read again.

use std::collections::BTreeSet;
use std::path::Path;

use nabiki::setting::{Datum, Key, Kind, Range, Setting, Table};
use nabiki_scene::Scene;
use nabiki_scene::scene::Problem;
use nabiki_scene::schema::{self, Occurs, SceneTable, TABLES};
use proptest::prelude::*;
use toml::Value;

/// A number that a setting may have, from three numbers of chance: often an end of its range.
fn number(range: &Range, [which, place, _]: [f64; 3]) -> f64 {
    let least = range.least.or(range.above.map(|above| if above == 0.0 { 1e-3 } else { above + 0.01 }));
    let (low, high) = match (least, range.most) {
        (Some(low), Some(high)) => (low, high),
        (Some(low), None) => (low, low + 200.0),
        (None, Some(high)) => (high - 200.0, high),
        (None, None) => (-200.0, 200.0),
    };
    match which {
        w if w < 0.15 => low,
        w if w < 0.3 => high,
        w if w < 0.5 => {
            (low + place * (high - low)).round().clamp(low.ceil(), high.floor().max(low.ceil())).clamp(low, high)
        }
        // As numbers of 32 bits are kept.
        _ => f64::from((low + place * (high - low)) as f32).clamp(low, high),
    }
}

/// A value that a setting may have; `dice` never end.
fn value(kind: &Kind, range: &Range, dice: &mut impl Iterator<Item = [f64; 3]>) -> Value {
    let throw = dice.next().unwrap_or_default();
    match *kind {
        Kind::Flag => Value::Boolean(throw[0] < 0.5),
        Kind::Number => Value::Float(number(range, throw)),
        Kind::Whole { least, most } => {
            let ends = Range {
                least: range.least.or(Some(least as f64)),
                most: range.most.or(Some((most as f64).min(1e6))),
                ..*range
            };
            Value::Integer(number(&ends, throw) as i64)
        }
        Kind::Text => Value::String(["", "Head", "a \"b\" #c\\", "\u{e4}\n"][(4.0 * throw[0]) as usize].to_owned()),
        Kind::Path => Value::String(["a.obj", "../b c/d.abc"][(2.0 * throw[0]) as usize].to_owned()),
        Kind::Words(words) => Value::String(words[(words.len() as f64 * throw[0]) as usize].word.to_owned()),
        Kind::Quantity(units) => {
            let unit = units[(units.len() as f64 * throw[0]) as usize];
            Value::String(format!("{} {unit}", (20.0 * throw[1]) as f32))
        }
        Kind::Numbers(count) => Value::Array((0..count).map(|_| value(&Kind::Number, range, dice)).collect()),
        Kind::Wholes(count) => {
            Value::Array((0..count).map(|_| value(&Kind::Whole { least: 0, most: 9 }, range, dice)).collect())
        }
        Kind::List(of) => Value::Array((0..(4.0 * throw[0]) as usize).map(|_| value(of, range, dice)).collect()),
        Kind::Table(table) => table_of(table, dice),
        Kind::OneOf(kinds) => value(&kinds[(kinds.len() as f64 * throw[0]) as usize], range, dice),
    }
}

/// A table with what must be given, and half of the rest.
fn table_of(table: &Table, dice: &mut impl Iterator<Item = [f64; 3]>) -> Value {
    let mut entries = toml::Table::new();
    for setting in table.settings {
        if setting.must.is_some() || dice.next().unwrap_or_default()[0] < 0.5 {
            entries.insert(setting.key.to_owned(), value(&setting.kind, &setting.range, dice));
        }
    }
    entries.into()
}

/// Every setting at every depth, with its key in a scene that has one of each list.
fn settings() -> Vec<(String, &'static Setting)> {
    fn below(key: String, setting: &'static Setting, found: &mut Vec<(String, &'static Setting)>) {
        let place = if matches!(setting.kind, Kind::List(_)) { "[0]" } else { "" };
        for inner in schema::tables(&setting.kind).into_iter().flat_map(|table| table.settings) {
            below(format!("{key}{place}.{}", inner.key), inner, found);
        }
        found.push((key, setting));
    }
    let mut found = Vec::new();
    for table in TABLES {
        let place = if table.occurs == Occurs::ManyTimes { "[0]" } else { "" };
        for setting in table.settings() {
            below(format!("{}{place}.{}", table.key, setting.key), setting, &mut found);
        }
    }
    found
}

fn parse(text: &str) -> Scene {
    Scene::parse(text, Path::new("a.toml"), &[]).unwrap_or_else(|refused| panic!("{refused}\n{text}"))
}

fn wind() -> Scene {
    parse("# kept\n[[force]] # one\nthrough = 900\nvector = [1, 2, 3]\n")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Any values of any settings, one after another, as long as each leaves a scene that its check takes: what is written is read again,
    /// and means the same.
    #[test]
    fn a_scene_that_its_check_takes_is_one_that_opens(
        picks in prop::collection::vec((any::<prop::sample::Index>(), prop::collection::vec([0.0..1.0, 0.0..1.0, 0.0..1.0], 60)), 1..12),
        written_each_time: bool,
    ) {
        let settings = settings();
        let mut scene = wind();
        for (pick, dice) in picks {
            let (key, setting) = pick.get(&settings);
            let wanted = value(&setting.kind, &setting.range, &mut dice.into_iter().cycle());
            // A setting of a table that is not there, and what does not go together with the others.
            let Ok(changed) = scene.with_setting(key, Some(wanted.clone())) else { continue };
            if let Err(refused) = changed.check() {
                prop_assert!(changed.text_to_be(Path::new("b.toml")).is_err(), "{} = {}: {}", key, wanted, refused);
                continue;
            }
            let text = changed.text_to_be(Path::new("b.toml"));
            let text = text.map_err(|refused| TestCaseError::fail(format!("{key} = {wanted}: {refused}")))?;
            prop_assert_eq!(&parse(&text), &changed, "{} = {}: {}", key, wanted, text);
            prop_assert!(text.starts_with("# kept"), "{}", text);
            scene = if written_each_time { parse(&text) } else { changed };
        }
    }

    /// A value within what the schema says of a setting alone is refused only for what it does not go together with: the check names
    /// another reason than its kind and range.
    #[test]
    fn what_the_schema_calls_valid_is_of_the_right_kind(pick: prop::sample::Index, dice in prop::collection::vec([0.0..1.0, 0.0..1.0, 0.0..1.0], 60)) {
        let settings = settings();
        let (key, setting) = pick.get(&settings);
        let wanted = value(&setting.kind, &setting.range, &mut dice.into_iter().cycle());
        if let Err(refused) = full(key).with_setting(key, Some(wanted.clone())) {
            prop_assert!(false, "{} = {}: {}", key, wanted, refused);
        }
    }
}

/// A scene with every table, one of each list, and the kind of head and hair that has this key.
fn full(key: &str) -> Scene {
    let mut scene = wind();
    let mut put = |key: &str, value: Value| scene = scene.with_setting(key, Some(value)).unwrap();
    let new = |table: &Table| {
        Value::try_from((table.settings.iter().map(|s| (s.key, (s.default)()))).collect::<Entries>().0).unwrap()
    };
    for table in TABLES {
        match table.occurs {
            Occurs::Always => {}
            Occurs::IfGiven => put(table.key, new(&table.kinds[0])),
            Occurs::ManyTimes if table.key == "force" => {}
            Occurs::ManyTimes => put(table.key, Value::Array(vec![new(&table.kinds[0])])),
        }
    }
    for (table, setting) in
        settings().iter().filter(|(key, _)| !key.starts_with("head.") && !key.starts_with("hair.file"))
    {
        let optional = setting.open.is_some() || matches!(setting.kind, Kind::List(_));
        if optional && let [inner, ..] = schema::tables(&setting.kind)[..] {
            let inner = new(inner);
            put(table, if matches!(setting.kind, Kind::List(_)) { Value::Array(vec![inner]) } else { inner });
        }
    }
    // A body is a mesh or a capsule.
    let of_capsule = key.starts_with("body[0].capsule");
    put("body[0].mesh", if of_capsule { "" } else { "b.obj" }.into());
    put("aim[0].file", "pose.usda".into());
    put("free.regions[0].near", Value::Array(vec![0.0.into(); 3]));
    let share = toml::from_str::<toml::Table>("field = \"turbulence\"\nshare = 0.3").unwrap();
    put("free.regions[0].fields", Value::Array(vec![share.into()]));
    put("head.motion", toml::Table::new().into());
    put("picture.hair.colour", toml::from_str::<toml::Table>("melanin = { eumelanin = 1.0 }").unwrap().into());
    let of = |table: &Table, name: &str| table.settings.iter().any(|setting| key == format!("{name}.{}", setting.key));
    let [head, hair] = ["head", "hair"].map(|name| TABLES.iter().find(|table| table.key == name).unwrap());
    let imported = |table: &SceneTable| of(&table.kinds[1], table.key) && !of(&table.kinds[0], table.key);
    if imported(head) {
        put("head.mesh", "head.obj".into());
    }
    if key.starts_with("head.ellipsoid.") {
        put("head.ellipsoid", new(schema::tables(&schema::find(&"head.ellipsoid".into())[0].kind)[0]));
    }
    if key.starts_with("picture.hair.colour.rgb") {
        put("picture.hair.colour", toml::from_str::<toml::Table>("rgb = [0.5, 0.5, 0.5]").unwrap().into());
    }
    if imported(hair) {
        put("hair", toml::from_str::<toml::Table>("file = \"a.abc\"").unwrap().into());
    }
    if of_capsule { scene } else { scene.with_setting("body[0].capsule", None).unwrap() }
}

/// Settings by key, without those that are open.
struct Entries(Datum);

impl FromIterator<(&'static str, Datum)> for Entries {
    fn from_iter<I: IntoIterator<Item = (&'static str, Datum)>>(entries: I) -> Self {
        Self(Datum::Table(entries.into_iter().collect()))
    }
}

#[test]
fn the_schema_has_every_key_of_a_scene_and_no_other() {
    fn keys(value: &Value, key: String, found: &mut BTreeSet<String>) {
        match value {
            Value::Table(table) => {
                let below = |name: &String| if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                table.iter().for_each(|(name, value)| keys(value, below(name), found));
            }
            Value::Array(values) if values.iter().any(Value::is_table) => keys(&values[0], format!("{key}[0]"), found),
            _ => drop(found.insert(key)),
        }
    }
    let mut found = BTreeSet::new();
    for of in
        ["head.unit", "hair.root", "head.mesh", "picture.hair.colour.rgb", "head.ellipsoid.center", "body[0].capsule"]
    {
        keys(&full(of).settings().unwrap().into(), String::new(), &mut found);
    }
    let declared = settings();
    for key in &found {
        assert!(declared.iter().any(|(known, _)| known == key), "{key} is not in the schema");
        assert!(!schema::find(&Key::from(key.as_str())).is_empty(), "{key}");
    }
    for (key, setting) in declared {
        let read = full(&key).setting(&key);
        assert!(read.is_ok(), "the schema has {key}: {read:?}");
        assert!(setting.help.trim().ends_with(['.', '?']) && !setting.label.is_empty(), "{key}: {}", setting.help);
    }
}

#[test]
fn a_file_without_a_name_is_refused_and_not_left_out() {
    for (table, key) in [("head", "mesh"), ("hair", "file")] {
        let unnamed = toml::Table::from_iter([(key.to_owned(), Value::String(String::new()))]);
        let refused = wind().with_setting(table, Some(unnamed.into())).unwrap().check().unwrap_err();
        assert_eq!(refused.to_string(), format!("{table}.{key} = \"\": name a file"));
    }
}

#[test]
fn tables_stand_in_the_schema_as_they_are_read() {
    let unknown = Scene::parse("no_table = 1", Path::new("a.toml"), &[]).unwrap_err();
    let Problem::UnknownKey { known, .. } = *unknown.problem else { panic!("{unknown}") };
    assert_eq!(TABLES.iter().map(|table| table.key).collect::<Vec<_>>(), known);
}

#[test]
fn defaults_are_those_of_a_scene_that_says_nothing() {
    let scene = Scene::default().settings().unwrap();
    for table in TABLES.iter().filter(|table| table.occurs == Occurs::Always) {
        for setting in table.shared.iter().chain(&table.kinds[..1]).flat_map(|table| table.settings) {
            let read = scene[table.key].get(setting.key).cloned();
            let default = Value::try_from((setting.default)()).ok();
            assert_eq!(read, default, "{}.{}", table.key, setting.key);
        }
    }
}

#[test]
fn a_number_out_of_what_the_schema_says_is_refused_by_the_name_of_its_setting() {
    let mut tried = 0;
    for (key, setting) in settings() {
        let Range { above, least, most, .. } = setting.range;
        let scene = full(&key);
        for beyond in [above, least.map(|least| least - 1.0), most.map(|most| most + 1.0)].into_iter().flatten() {
            let beyond = match setting.kind {
                Kind::Number => Value::Float(beyond),
                Kind::Whole { least, .. } if beyond >= least as f64 => Value::Integer(beyond as i64),
                _ => continue,
            };
            let changed = scene.with_setting(&key, Some(beyond.clone())).unwrap();
            let refused = changed.check().expect_err(&format!("{key} = {beyond}"));
            assert_eq!(refused.thing, key, "{refused}");
            tried += 1;
        }
    }
    assert!(tried > 200, "{tried}");
}
