//! Reading of text layers: one pass notes where values are; each is turned into numbers when it is asked for.

use std::collections::{HashMap, HashSet};
use std::io::SeekFrom;
use std::str::FromStr;

use nabiki_exchange::Budget;

use super::numbers::{Number, Numbers, is_part};
use super::scan::{Scanner, WINDOW};
use crate::Problem;
use crate::source::{ARCS, BLOCKED, DEEPEST, Handle, Name, PrimInfo, SKEL_BINDING, Source, keep_prim, keep_property};

type Parsed = (Vec<PrimInfo>, HashMap<Name, Handle>);

/// Finds the prims of a layer of `length` bytes and what it says about itself.
pub fn parse(from: &mut dyn Source, length: u64, budget: &Budget) -> Result<Parsed, Problem> {
    let mut text = Scanner::new(from, (0, length))?;
    let mut metadata = HashMap::new();
    let mut prims: Vec<PrimInfo> = Vec::new();
    // Prims whose braces are open.
    let mut open: Vec<usize> = Vec::new();
    // Names of types, each once.
    let mut types: HashSet<Name> = HashSet::new();
    if text.peek()? == Some(b'(') {
        layer_metadata(&mut text, &mut metadata)?;
    }
    while let Some(next) = text.peek()? {
        if next == b'}' {
            text.pass();
            if open.pop().is_none() {
                return Err(text.problem("a closing brace has no opening one"));
            }
            continue;
        }
        if next == b';' {
            text.pass();
            continue;
        }
        let word = text.word()?;
        match word.as_str() {
            "def" | "over" | "class" => {
                let type_name = if text.peek()? == Some(b'"') { String::new() } else { text.word()? };
                let name = Name::from(text.quoted()?);
                keep_prim(budget, &name)?;
                let (is_off_stage, is_over) = (word == "class", word == "over");
                let parent = open.last().copied();
                let type_name = shared(&mut types, type_name);
                let mut prim = PrimInfo { name, type_name, is_off_stage, is_over, parent, ..PrimInfo::default() };
                if text.peek()? == Some(b'(') {
                    note_details(&mut text, &mut prim)?;
                }
                text.expect(b'{')?;
                open.push(prims.len());
                if open.len() > DEEPEST {
                    return Err(text.problem("prims are nested too deep"));
                }
                prims.push(prim);
            }
            "variantSet" => {
                text.quoted()?;
                text.expect(b'=')?;
                text.skip_value()?;
            }
            "reorder" => {
                text.word()?;
                text.expect(b'=')?;
                text.skip_value()?;
            }
            _ if open.is_empty() => return Err(text.problem(&format!("\"{word:.40}\" does not begin a prim"))),
            _ => property(&mut text, word, &mut prims[open[open.len() - 1]], &mut types, budget)?,
        }
    }
    if let Some(&prim) = open.last() {
        return Err(Problem(format!("ends within prim {}: is it complete?", prims[prim].name)));
    }
    Ok((prims, metadata))
}

/// A name that many have, in memory once.
fn shared(names: &mut HashSet<Name>, letters: String) -> Name {
    if let Some(known) = names.get(letters.as_str()) {
        return known.clone();
    }
    let name = Name::from(letters);
    names.insert(name.clone());
    name
}

/// Notes of the details of a prim whether `active = false` or `instanceable = true` stands there, and which arcs.
fn note_details(text: &mut Scanner<'_>, prim: &mut PrimInfo) -> Result<(), Problem> {
    text.expect(b'(')?;
    let (mut before, mut takes_away) = (String::new(), false);
    while let Some(byte) = text.peek()? {
        match byte {
            b')' => {
                text.pass();
                return Ok(());
            }
            b'"' | b'\'' | b'@' | b'<' | b'[' | b'(' | b'{' => {
                text.skip_value()?;
            }
            b if b.is_ascii_alphanumeric() => {
                let word = text.word()?;
                match before.as_str() {
                    "active" => prim.is_off_stage |= matches!(word.as_str(), "false" | "0"),
                    "instanceable" => prim.is_instance |= matches!(word.as_str(), "true" | "1"),
                    _ => {}
                }
                let arc = ARCS.into_iter().map(|(arc, _)| arc).find(|&arc| arc == word);
                if let Some(arc) = arc.filter(|_| !takes_away)
                    && text.peek()? == Some(b'=')
                {
                    text.pass();
                    if begins_to_hold_any(text)? && !prim.arcs.contains(&arc) {
                        prim.arcs.push(arc);
                    }
                }
                if word == "apiSchemas" && !takes_away && text.peek()? == Some(b'=') {
                    text.pass();
                    prim.is_bound |= lists(text, SKEL_BINDING)?;
                }
                takes_away = matches!(word.as_str(), "delete" | "reorder");
                before = word;
            }
            _ => text.pass(),
        }
    }
    Err(text.problem("a parenthesis is never closed: is the file complete?"))
}

/// Whether a word in quotation marks is in the list that follows.
fn lists(text: &mut Scanner<'_>, wanted: &str) -> Result<bool, Problem> {
    let mut found = false;
    if text.peek()? == Some(b'[') {
        text.pass();
        while let Some(byte) = text.peek()?.filter(|&byte| byte != b']') {
            match byte {
                b'"' | b'\'' => found |= text.quoted()? == wanted,
                _ => text.pass(),
            }
        }
    }
    Ok(found)
}

/// Whether anything stands in a value, the bracket of whose list is passed over: it is neither `None` nor an empty list.
fn begins_to_hold_any(text: &mut Scanner<'_>) -> Result<bool, Problem> {
    if text.peek()? == Some(b'[') {
        text.pass();
    }
    Ok(text.peek()?.is_some_and(|b| b != b']' && !b.is_ascii_alphabetic()))
}

/// Whether a value is neither `None` nor an empty list.
pub fn holds_any(from: &mut dyn Source, value: Handle) -> Result<bool, Problem> {
    begins_to_hold_any(&mut Scanner::new(from, value)?)
}

/// Passes over the layer's metadata in parentheses, noting `name = value`.
fn layer_metadata(text: &mut Scanner<'_>, into: &mut HashMap<Name, Handle>) -> Result<(), Problem> {
    text.expect(b'(')?;
    loop {
        match text.peek()? {
            Some(b')') => {
                text.pass();
                return Ok(());
            }
            Some(b'"' | b'\'') => {
                text.quoted()?;
            }
            Some(b';' | b',') => text.pass(),
            Some(_) => {
                let mut name = text.word()?;
                while text.peek()?.is_some_and(|b| b != b'=') {
                    name = text.word()?;
                }
                text.expect(b'=')?;
                let value = text.skip_value()?;
                into.insert(name.into(), value);
            }
            None => return Err(text.problem("a parenthesis is never closed: is the file complete?")),
        }
    }
}

/// A property of `prim` whose first word was `first`.
fn property(
    text: &mut Scanner<'_>,
    first: String,
    prim: &mut PrimInfo,
    types: &mut HashSet<Name>,
    budget: &Budget,
) -> Result<(), Problem> {
    let mut words = vec![first];
    let mut is_array = false;
    loop {
        match text.peek()? {
            Some(b'[') => {
                text.pass();
                text.expect(b']')?;
                is_array = true;
            }
            Some(b'=' | b'(' | b'}' | b';') | None => break,
            // A property without a value ends where the next line begins.
            Some(_) if words.len() >= 2 && text.line_ended() && !is_prefix(&words[words.len() - 2]) => break,
            Some(_) => words.push(text.word()?),
        }
        if words.len() > 8 {
            return Err(text.problem("a property has too many words"));
        }
    }
    let is_relation = words.iter().any(|w| w == "rel");
    let [.., type_name, name] = &words[..] else {
        return Err(text.problem(&format!("\"{:.40}\" is not a property", words[0])));
    };
    let (name, timed) = match name.strip_suffix(".timeSamples") {
        Some(name) => (name, true),
        None => (name.as_str(), false),
    };
    let (name, is_spline) = match name.strip_suffix(".spline") {
        Some(name) => (name, true),
        None => (name, false),
    };
    let connection = name.ends_with(".connect");
    if text.peek()? == Some(b'=') {
        text.pass();
        if is_relation || connection {
            let targets = value(text)?;
            // What is taken away from weaker layers is none of this one's.
            if is_relation && !words.iter().any(|word| word == "delete" || word == "reorder") {
                let name = Name::from(name);
                keep_property(budget, &name)?;
                prim.relationships.push((name, targets));
            }
        } else {
            let name = Name::from(name);
            keep_property(budget, &name)?;
            let samples = if timed { Some(samples(text)?) } else { None };
            let value = if timed { None } else { Some(value(text)?) };
            let attribute = prim.attributes.entry(name).or_default();
            attribute.has_spline |= is_spline;
            attribute.type_name = shared(types, type_name.clone());
            attribute.is_array = is_array;
            attribute.samples = samples.unwrap_or(std::mem::take(&mut attribute.samples));
            attribute.default = value.filter(|_| !is_spline).or(attribute.default);
        }
    } else if !is_relation && !connection {
        // Declared without a value.
        let name = Name::from(name);
        keep_property(budget, &name)?;
        prim.attributes.entry(name).or_default();
    }
    if text.peek()? == Some(b'(') {
        let details = text.skip_value()?;
        if let Some(attribute) = prim.attributes.get_mut(name) {
            attribute.interpolation = Some(details);
        }
    }
    Ok(())
}

/// Passes over one value and gives its place, or [`BLOCKED`].
fn value(text: &mut Scanner<'_>) -> Result<Handle, Problem> {
    // No other value begins like `None`.
    let begins_as_none = text.peek()? == Some(b'N');
    let place = text.skip_value()?;
    Ok(if begins_as_none && place.1 == "None".len() as u64 { BLOCKED } else { place })
}

fn samples(text: &mut Scanner<'_>) -> Result<Vec<(f64, Handle)>, Problem> {
    text.expect(b'{')?;
    let mut found = Vec::new();
    loop {
        match text.peek()? {
            Some(b'}') => {
                text.pass();
                break;
            }
            Some(b',') => text.pass(),
            _ => {
                // A time code's word takes the colon after it along.
                let word = text.word()?;
                let number = word.trim_end_matches(':');
                let Some(time) = f64::from_str(number).ok().filter(|t| t.is_finite()) else {
                    return Err(text.problem(&format!("\"{word:.40}\" is not a time code")));
                };
                if number.len() == word.len() {
                    text.expect(b':')?;
                }
                found.push((time, value(text)?));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(found)
}

/// Words before a type.
fn is_prefix(word: &str) -> bool {
    matches!(word, "custom" | "uniform" | "varying" | "config" | "prepend" | "append" | "add" | "delete")
}

/// Numbers of a value, whatever brackets stand between them.
pub fn numbers<T: Number>(from: &mut dyn Source, (start, length): Handle, budget: &Budget) -> Result<Vec<T>, Problem> {
    budget.take(length, "values")?;
    from.seek(SeekFrom::Start(start))?;
    let mut numbers = Numbers::new();
    let mut window = Vec::new();
    let mut left = length;
    let mut beyond = 0;
    while left > 0 {
        // Behind what was left of the last window, the beginning of a number.
        let begun = window.len();
        let more = left.min((WINDOW - begun) as u64);
        window.resize(begun + more as usize, 0);
        from.read_exact(&mut window[begun..])?;
        left -= more;
        let whole = match window.iter().rposition(|&b| !is_part(b)) {
            _ if left == 0 => window.len(),
            Some(last) => last + 1,
            None => return Err(Problem(format!("byte {start}: a number has more than {WINDOW} digits"))),
        };
        numbers.read(&window[..whole]).map_err(|e| Problem(format!("byte {start}: {e}")))?;
        // Digits with nothing between them but a comma take less than the numbers.
        let half = (numbers.found.len() * size_of::<T>()) as u64 / 2;
        let more = half.saturating_sub(length).saturating_sub(beyond);
        budget.take(more, "values")?;
        beyond += more;
        if numbers.found.capacity() * 2 < numbers.found.len() * 3 && left > 0 {
            let share = (length - left) as f64 / length as f64;
            let expected = (numbers.found.len() as f64 / share) as usize;
            numbers.found.reserve_exact(expected.saturating_sub(numbers.found.len()));
        }
        window.drain(..whole);
    }
    numbers.all().map_err(|e| Problem(format!("byte {start}: {e}")))
}

/// The word that stands for `interpolation` among the details of an attribute.
pub fn interpolation(from: &mut dyn Source, details: Handle) -> Result<Option<String>, Problem> {
    let mut text = Scanner::new(from, details)?;
    let mut asked = false;
    while let Some(byte) = text.peek()? {
        match byte {
            b'"' | b'\'' => {
                let word = text.quoted()?;
                if asked {
                    return Ok(Some(word));
                }
            }
            b if b.is_ascii_alphabetic() => asked = text.word()? == "interpolation",
            _ => text.pass(),
        }
    }
    Ok(None)
}

/// The paths that a relationship's value names.
pub fn targets(from: &mut dyn Source, (start, length): Handle) -> Result<Vec<String>, Problem> {
    from.seek(SeekFrom::Start(start))?;
    let mut value = vec![0; length as usize];
    from.read_exact(&mut value)?;
    let value = String::from_utf8_lossy(&value);
    let paths = value.split('<').skip(1).filter_map(|rest| rest.split_once('>'));
    Ok(paths.map(|(path, _)| path.to_owned()).collect())
}

/// Words in quotation marks of a value.
pub fn words(from: &mut dyn Source, value: Handle, budget: &Budget) -> Result<Vec<String>, Problem> {
    budget.take(value.1, "words")?;
    let mut text = Scanner::new(from, value)?;
    let mut found = Vec::new();
    while let Some(byte) = text.peek()? {
        if matches!(byte, b'"' | b'\'') {
            budget.take(size_of::<String>() as u64, "words")?;
            found.push(text.quoted()?);
        } else {
            text.pass();
        }
    }
    Ok(found)
}
