use std::collections::BTreeSet;

use nabiki_scene::Scene;

use super::*;

/// Scenes that have every table between them, at their defaults.
fn scenes() -> Vec<Scene> {
    let read = |text: &str| Scene::parse(text, "all.toml".as_ref(), &[]).unwrap();
    let wind = "[[force]]\nthrough = 5\nvector = [1, 2, 3]\n";
    let speed = "speed = \"5 m/s\"\n";
    let motion = "{ file = \"m.bvh\", skeleton = \"s.asf\", unit_cm = 1.0, up = \"+y\", facing = \"+z\", frames_per_second = 30.0 }";
    let lie = "unit = \"m\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [0, 0, 0]\n";
    let most = format!(
        "{wind}{speed}[head]\nmotion = {motion}\n[gust]\n[body_wind]\n[flow]\n[turbulence]\nenvelope = [{{ frame = 1, factor = 1.0 }}]\n[neighbours]\n\
         [[fan]]\nposition = [0, 0, 0]\ndirection = [1, 0, 0]\nenvelope = [{{ frame = 1, factor = 1.0 }}]\n\
         [[vortex]]\nposition = [0, 0, 0]\nenvelope = [{{ frame = 1, factor = 1.0 }}]\n\
         [[point]]\nposition = [0, 0, 0]\nenvelope = [{{ frame = 1, factor = 1.0 }}]\n\
         [free]\nsubsteps = 3\ntie = {{ at = [0, 0, 0], within = 1.0 }}\nvariation = {{ size = 2.0 }}\n[motion]\nform = \"free\"\n\
         [[free.regions]]\nname = \"fringe\"\ngroups = [\"top\"]\nattribute = \"painted\"\nvalues = [1]\nmap = \"m.png\"\npainted = [[8, 4, 0, 1]]\nnear = [8, 4, 0]\nto = [8, 4, 1]\nfields = [{{ field = \"turbulence\", share = 0.5 }}]\n[hair.style.ponytail]\nat = [-12, 0, 0]\n[[hair.style.cuts]]\npoint = [0, 0, 0]\nnormal = [0, -1, 0]\nregion = \"top\"\n\
         [[aim]]\nregion = \"fringe\"\nfile = \"p.usda\"\nframe = 4\nthrough = 9\n[[aim]]\ntoward = [1, 2, 3]\n[[aim]]\ncurves = [[[8, 4, 0], [9, 4, 0]]]\n\
         [[body]]\nmesh = \"b.obj\"\n{lie}motion = {motion}\n\
         [picture.camera]\ndistance = 1.0\nheight = 1.0\ntarget = [0, 0, 0]\nf_stop = 2.0\nfocus_distance = 1.0\n\
         [picture.camera.to]\nazimuth = 1.0\nelevation = 1.0\ndistance = 1.0\nfov = 1.0\ntarget = [0, 0, 0]\nfocus_distance = 1.0\n\
         [output]\nsheet = [0]\nfirst_frame = 0\n[picture.video]\nframe_rate = 24.0\n"
    );
    let imported = format!(
        "{wind}[head]\nmesh = \"h.obj\"\n{lie}[hair]\nfile = \"h.hair\"\nstrands = 5\nsegments = 5\n{lie}[picture.hair.colour.melanin]\neumelanin = 1.0\n[disturbance]\n\
         [[body]]\ncapsule = {{ from = [0, 0, 0], to = [0, 1, 0], radius = 2.0 }}\n"
    );
    vec![read(&most), read(&imported)]
}

/// All keys of a table, those of lists without their numbers.
fn keys(table: &Table, prefix: &str, found: &mut BTreeSet<String>) {
    for (key, value) in table {
        let key = format!("{prefix}{key}");
        match value {
            Value::Table(below) => keys(below, &format!("{key}."), found),
            Value::Array(entries) if entries.iter().any(Value::is_table) => {
                for entry in entries.iter().filter_map(Value::as_table) {
                    keys(entry, &format!("{key}."), found);
                }
            }
            Value::Array(none)
                if none.is_empty() && Page::ALL.iter().flat_map(|page| page.groups()).any(|of| of.table == key) => {}
            _ => drop(found.insert(key)),
        }
    }
}

#[test]
fn every_key_of_a_scene_has_a_field_with_help() {
    let mut found = BTreeSet::new();
    for scene in scenes() {
        keys(&scene.settings().unwrap(), "", &mut found);
    }
    // The intervals are the timeline's.
    let missing: Vec<&String> = found.iter().filter(|key| !key.starts_with("force.") && find(key).is_none()).collect();
    assert!(missing.is_empty(), "no field for {missing:?}");
    for page in Page::ALL {
        for group in page.groups() {
            for setting in group.settings() {
                assert!(setting.help.ends_with('.') && !setting.label.is_empty(), "{}.{}", group.table, setting.key);
                let key = format!("{}.{}", group.table, setting.key);
                let there = found.iter().any(|known| *known == key || known.starts_with(&format!("{key}.")));
                assert!(there, "no scene has {key}");
            }
        }
    }
}

/// Settings whose range depends on another one.
const BOUND_BY_ANOTHER: [&str; 12] = [
    "aim.from",
    "hair.strands",
    "free.settle",
    "turbulence.swirl_size",
    "disturbance.over",
    "contact.friction",
    "contact.static_friction",
    "body.friction",
    "body.static_friction",
    "hair.style.curl.radius",
    "hair.style.clumps.wave",
    "hair.style.clumps.wave_length",
];

#[test]
fn both_ends_of_what_a_field_takes_are_in_the_range_of_the_scene() {
    let scenes = scenes();
    let mut tried = 0;
    for group in Page::ALL.iter().flat_map(|page| page.groups()) {
        for setting in group.settings() {
            let ends = match setting.kind {
                Kind::Number { least, most, .. } => [least, most].map(Value::Float),
                Kind::Whole { least, most } => [least, most].map(Value::Integer),
                Kind::Profile { least, most, .. } => [least, most].map(Value::Float),
                Kind::Amount { most, .. } => [0.0, most].map(Value::Float),
                _ => continue,
            };
            if BOUND_BY_ANOTHER.contains(&format!("{}.{}", group.table, setting.key).as_str()) {
                continue;
            }
            let table = match group.shape {
                Shape::List(_) => format!("{}[0]", group.table),
                _ => group.table.replace("body.", "body[0]."),
            };
            let key = format!("{table}.{}", setting.key);
            for end in ends {
                // No scene has all: hair is grown or imported, and a disturbance is of the paper's form.
                let changed = scenes.iter().filter_map(|scene| scene.with_setting(&key, Some(end.clone())).ok());
                let checks: Vec<_> = changed.map(|scene| scene.check()).collect();
                assert!(checks.contains(&Ok(())), "{key} = {end}: {checks:?}");
                tried += 1;
            }
        }
    }
    assert!(tried > 200, "{tried}");
}

#[test]
fn what_a_new_table_is_given_makes_a_scene() {
    for page in Page::ALL {
        for group in
            page.groups().iter().filter(|group| group.shape != Shape::Always && !group.table.starts_with("body."))
        {
            let key = match group.shape {
                Shape::List(_) => format!("{}[{}]", group.table, if group.table == "picture.lights" { 3 } else { 0 }),
                _ => group.table.to_owned(),
            };
            let text = "[[force]]\nthrough = 5\nvector = [1, 2, 3]\n";
            let scene = Scene::parse(text, "new.toml".as_ref(), &[]).unwrap();
            let scene = scene.with_setting(&key, group.fresh()).unwrap_or_else(|e| panic!("{key}: {e}"));
            assert!(value_at(&scene.settings().unwrap(), &key).is_some(), "{key}");
        }
    }
}

#[test]
fn an_error_leads_to_its_field() {
    let label = |key: &str| find(key).map(|(_, group, setting)| (group.title, setting.label));
    assert_eq!(label("free.stiffness[1]"), Some(("Shape and settling", "Stiffness")));
    assert_eq!(label("fan[3].falloff.radius"), Some(("Fans", "Radius")));
    assert_eq!(label("hair.style.length.top"), Some(("Length", "Top")));
    assert_eq!(label("picture.hair.colour.rgb"), Some(("Hair", "Colour")));
    assert_eq!(label("nothing.like.this"), None);
}

#[test]
fn a_value_is_found_by_its_key() {
    let table: Table = "a = [{ b = 1 }, { b = 2 }]\nc.d = 3".parse().unwrap();
    assert_eq!(value_at(&table, "a[1].b").and_then(Value::as_integer), Some(2));
    assert_eq!(value_at(&table, "c.d").and_then(Value::as_integer), Some(3));
    assert_eq!(value_at(&table, "a[2].b"), None);
    assert_eq!(value_at(&table, "c.d.e"), None);
}
