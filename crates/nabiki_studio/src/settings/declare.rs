//! A setting of the schema as a panel shows it: which field, how far a drag by one point goes, which files are offered.

use nabiki::setting::{self as declared, Datum, Range, plain};

use super::{AIM_FILES, HAIR_FILES, Kind, MESH_FILES, MOTION_FILES, Row};

/// What a field takes where the schema has no end: what the scene itself can hold.
const ENDLESS: f64 = f32::MAX as f64;

/// The setting of `key` in `table` as a field.
pub(super) fn setting(table: &str, key: &'static str, found: &declared::Setting) -> Row {
    let help = plain(found.help).split("\n\n").next().unwrap_or_default().replace('`', "");
    let unit = if matches!(found.range.unit, "sRGB" | "linear") { "" } else { found.range.unit };
    Row { key, label: found.label, unit, kind: kind(table, key, found), open: found.open, help }
}

fn kind(table: &str, key: &str, found: &declared::Setting) -> Kind {
    let (least, most) = ends(&found.range);
    let step = step(found);
    match found.kind {
        declared::Kind::Flag => Kind::Flag,
        declared::Kind::Number => Kind::Number { least, most, step },
        declared::Kind::Whole { least: of_type, most: most_of_type } => Kind::Whole {
            least: found.range.least.map_or(of_type, |least| least as i64),
            most: found.range.most.map_or(most_of_type, |most| most as i64),
        },
        declared::Kind::Words(words) => Kind::Choice(words.iter().map(|word| word.word).collect::<Vec<_>>().leak()),
        declared::Kind::Numbers(_) if found.range.unit == "sRGB" => Kind::Colour { linear: false },
        declared::Kind::Numbers(_) if found.range.unit == "linear" => Kind::Colour { linear: true },
        // What is seen from above.
        declared::Kind::Numbers(2) => Kind::Numbers { names: &["x", "z"], step },
        declared::Kind::Numbers(_) => Kind::Numbers { names: &["x", "y", "z"], step },
        declared::Kind::Wholes(_) => Kind::Wholes { names: &["w", "h"], least: least as i64, most: most as i64 },
        declared::Kind::List(declared::Kind::Text) => Kind::Texts,
        declared::Kind::List(declared::Kind::Table(of)) if of.name == "FieldShare" => Kind::Shares,
        declared::Kind::List(declared::Kind::Table(_)) => Kind::Envelope,
        declared::Kind::List(declared::Kind::Numbers(_)) => Kind::Drawn("point"),
        declared::Kind::List(declared::Kind::List(_)) => Kind::Drawn("curve"),
        declared::Kind::List(of) => Kind::List { whole: matches!(of, declared::Kind::Whole { .. }) },
        declared::Kind::Path => Kind::File(endings(table, key)),
        declared::Kind::OneOf([number, declared::Kind::List(_)]) => {
            Kind::Profile { units: units(number), least: least.max(0.0), most, step }
        }
        declared::Kind::OneOf([declared::Kind::Number, _]) if !units(&found.kind).is_empty() => {
            Kind::Amount { units: units(&found.kind), most, step }
        }
        declared::Kind::Quantity(units) => Kind::Quantity { units },
        declared::Kind::OneOf([declared::Kind::Words(_), declared::Kind::Number]) => Kind::Unit,
        declared::Kind::OneOf([declared::Kind::Words(_), declared::Kind::Table(_)]) => Kind::Ellipsoid,
        declared::Kind::OneOf(_) => Kind::HairColour,
        declared::Kind::Text | declared::Kind::Table(_) => Kind::Text,
    }
}

/// The units of the world that a number of this kind may be given in.
fn units(kind: &declared::Kind) -> &'static [&'static str] {
    match kind {
        declared::Kind::Quantity(units) => units,
        declared::Kind::OneOf(kinds) => kinds.iter().map(units).find(|units| !units.is_empty()).unwrap_or_default(),
        _ => &[],
    }
}

/// Whether a setting is a table, or a list of tables that has a group of its own.
pub(super) fn is_table(kind: &declared::Kind) -> bool {
    match kind {
        declared::Kind::Table(_) => true,
        declared::Kind::List(declared::Kind::Table(table)) => !matches!(table.name, "EnvelopeKey" | "FieldShare"),
        _ => false,
    }
}

fn endings(table: &str, key: &str) -> &'static [&'static str] {
    match (table, key) {
        (_, "skeleton") => &["asf", "tof"],
        ("hair", _) => HAIR_FILES,
        (_, "mesh") => MESH_FILES,
        (_, "map") => &["png"],
        ("aim", _) => AIM_FILES,
        _ => MOTION_FILES,
    }
}

/// The least and the most that a field takes.
fn ends(range: &Range) -> (f64, f64) {
    let least = range.least.or(range.above.map(|above| above + 1e-6 * above.abs().max(1.0)));
    (least.unwrap_or(-ENDLESS), range.most.unwrap_or(ENDLESS))
}

/// What a drag by one point adds: a hundredth or so of the default, or of a way that a panel is wide.
fn step(found: &declared::Setting) -> f64 {
    let size = match (found.default)() {
        Datum::Number(default) => default.abs(),
        Datum::List(values) => {
            values.iter().map(|value| if let Datum::Number(x) = value { x.abs() } else { 0.0 }).fold(0.0, f64::max)
        }
        _ => 0.0,
    };
    let width = match (found.range.least, found.range.most) {
        (Some(least), Some(most)) if most - least <= 200.0 => (most - least) / 4.0,
        _ => match found.range.unit {
            "cm" => 10.0,
            _ => 50.0,
        },
    };
    let step = 0.01 * if size > 0.0 { size } else { width };
    // 1, 2 or 5 of its power of ten.
    let power = 10_f64.powf(step.log10().floor());
    power * [1.0, 2.0, 5.0].into_iter().rfind(|part| part * power <= step * (1.0 + 1e-9)).unwrap_or(1.0)
}
