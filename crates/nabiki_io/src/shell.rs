//! Words of a command, quoted for a POSIX shell; on Windows for cmd and PowerShell.

use crate::screen::is_unsafe;

/// Quotes a word, unless it has only letters, digits and signs that no shell interprets.
///
/// On Windows, a word is quoted as its programs take it: in double quotes. Elsewhere, control characters are written in octal between `$'` and `'`, which shells have supported for long and POSIX since
/// 2024. You can therefore paste a command that is displayed.
#[must_use]
pub fn quoted(word: &str) -> String {
    if cfg!(windows) { for_windows(word) } else { for_posix(word) }
}

/// As Windows programs take their command line apart: a backslash counts only before a double quote.
fn for_windows(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || r"_-./\:=+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    let (mut out, mut backslashes) = ('"'.to_string(), 0);
    for c in word.chars().filter(|&c| !is_unsafe(c)) {
        if c == '"' {
            out.extend(std::iter::repeat_n('\\', backslashes + 1));
        }
        backslashes = if c == '\\' { backslashes + 1 } else { 0 };
        out.push(c);
    }
    out.extend(std::iter::repeat_n('\\', backslashes));
    out + "\""
}

/// The words of a text as [`for_windows`] writes them; nothing of which is certain in another.
fn words_of_windows(text: &str) -> Option<Vec<String>> {
    let (mut words, mut rest) = (Vec::new(), text);
    loop {
        let (word, after) = match rest.strip_prefix('"') {
            Some(inside) => in_double_quotes(inside)?,
            None => {
                let (word, after) = rest.split_at(rest.find(' ').unwrap_or(rest.len()));
                (word.to_owned(), after)
            }
        };
        words.push(word);
        if after.is_empty() {
            return Some(words);
        }
        rest = after.strip_prefix(' ')?;
    }
}

/// A word whose opening quote is behind, and what follows its closing one.
fn in_double_quotes(text: &str) -> Option<(String, &str)> {
    let (mut word, mut rest) = (String::new(), text);
    loop {
        let (before, after) = rest.split_once('"')?;
        let plain = before.trim_end_matches('\\');
        let backslashes = before.len() - plain.len();
        word += plain;
        word.extend(std::iter::repeat_n('\\', backslashes / 2));
        rest = after;
        if backslashes % 2 == 0 {
            return Some((word, rest));
        }
        word.push('"');
    }
}

fn for_posix(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,+@%".contains(c);
    if word.contains(is_unsafe) {
        return in_octal(word);
    }
    // Of a word that begins with = zsh makes the place of a command.
    if !word.is_empty() && !word.starts_with('=') && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

fn in_octal(word: &str) -> String {
    let mut out = "$'".to_owned();
    for c in word.chars() {
        match c {
            '\n' => out.push_str(r"\n"),
            '\t' => out.push_str(r"\t"),
            '\'' | '\\' => out.extend(['\\', c]),
            c if is_unsafe(c) => out.extend(c.encode_utf8(&mut [0; 4]).bytes().map(|byte| format!(r"\{byte:03o}"))),
            c => out.push(c),
        }
    }
    out + "'"
}

/// Quotes a file name that is an operand. A name that starts with a hyphen would otherwise be an option.
#[must_use]
pub fn operand(file: &str) -> String {
    if file.starts_with('-') { format!("./{file}") } else { file.to_owned() }
}

/// Joins quoted words with spaces.
#[must_use]
pub fn command(words: &[String]) -> String {
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// Whether `text` is a command as written by [`command`] that starts with `first`: only words, with nothing else that a
/// shell would run. In a foreign file, there may be any text instead.
#[must_use]
pub fn is_command(text: &str, first: &[&str]) -> bool {
    let words = if cfg!(windows) { words_of_windows(text) } else { words(text) };
    words.is_some_and(|words| {
        words.iter().zip(first).all(|(word, first)| word == first)
            && words.len() >= first.len()
            && command(&words) == text
    })
}

/// The words of a text as [`command`] writes it; nothing of which is certain in another.
fn words(text: &str) -> Option<Vec<String>> {
    let (mut words, mut rest) = (Vec::new(), text);
    loop {
        let (word, after) = match rest.strip_prefix("$'") {
            Some(inside) => from_octal(inside)?,
            None => plain_or_quoted(rest)?,
        };
        words.push(word);
        if after.is_empty() {
            return Some(words);
        }
        rest = after.strip_prefix(' ')?;
    }
}

/// A word without quotes, or in single ones, and what follows it.
fn plain_or_quoted(text: &str) -> Option<(String, &str)> {
    let (mut word, mut rest) = (String::new(), text);
    while !rest.is_empty() && !rest.starts_with(' ') {
        if let Some(inside) = rest.strip_prefix('\'') {
            let (quoted, after) = inside.split_once('\'')?;
            word += quoted;
            rest = after;
        } else if let Some(after) = rest.strip_prefix(r"\'") {
            word.push('\'');
            rest = after;
        } else {
            let length = rest.find([' ', '\'', '\\']).unwrap_or(rest.len());
            let (plain, after) = rest.split_at(length);
            if plain.is_empty() {
                return None;
            }
            word += plain;
            rest = after;
        }
    }
    Some((word, rest))
}

/// A word whose `$'` is behind, and what follows it.
fn from_octal(text: &str) -> Option<(String, &str)> {
    let (mut bytes, mut chars) = (Vec::new(), text.chars());
    loop {
        match chars.next()? {
            '\'' => return Some((String::from_utf8(bytes).ok()?, chars.as_str())),
            '\\' => match chars.next()? {
                'n' => bytes.push(b'\n'),
                't' => bytes.push(b'\t'),
                c @ ('\'' | '\\') => bytes.push(c as u8),
                first => {
                    let octal: String = [first, chars.next()?, chars.next()?].into_iter().collect();
                    bytes.push(u8::from_str_radix(&octal, 8).ok()?);
                }
            },
            c => bytes.extend(c.encode_utf8(&mut [0; 4]).bytes()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: [(&str, &str); 10] = [
        ("scenes/gust.toml", "scenes/gust.toml"),
        ("force.1.vector=[0, -100, 0]", "'force.1.vector=[0, -100, 0]'"),
        ("it's", r"'it'\''s'"),
        ("$HOME `x` \"y\"", "'$HOME `x` \"y\"'"),
        ("", "''"),
        ("\u{98a8}.toml", "'\u{98a8}.toml'"),
        ("=ls", "'=ls'"),
        ("a\nb's\\ \u{1b}[2J", r"$'a\nb\'s\\ \033[2J'"),
        ("\u{9b}7\u{202e}", r"$'\302\2337\342\200\256'"),
        ("~/x", "'~/x'"),
    ];

    #[test]
    fn a_shell_takes_quoted_words_as_they_are() {
        for (word, as_written) in WORDS {
            assert_eq!(for_posix(word), as_written);
        }
        #[cfg(not(windows))]
        assert_eq!(command(&["a".to_owned(), "b c".to_owned()]), "a 'b c'");
        assert_eq!([operand("-o.toml"), operand("a-b")], ["./-o.toml", "a-b"]);
    }

    #[test]
    fn words_for_windows_are_taken_apart_again() {
        let written = [
            (r"scenes\gust.toml", r"scenes\gust.toml"),
            (r"C:\my hair\new.toml", r#""C:\my hair\new.toml""#),
            ("force.1.vector=[0,-100,0]", r#""force.1.vector=[0,-100,0]""#),
            (r#"free.gravity="1 g""#, r#""free.gravity=\"1 g\"""#),
            (r"o d\", r#""o d\\""#),
            ("", r#""""#),
            ("it's", r#""it's""#),
        ];
        for (word, as_written) in written {
            assert_eq!(for_windows(word), as_written);
        }
        let all = written.map(|(word, _)| word.to_owned()).to_vec();
        let text = all.iter().map(|word| for_windows(word)).collect::<Vec<_>>().join(" ");
        assert_eq!(words_of_windows(&text), Some(all));
    }

    #[cfg(unix)]
    #[test]
    fn bash_gives_every_word_back() {
        for (word, as_written) in WORDS {
            let printed = std::process::Command::new("bash").args(["-c", &format!("printf %s {as_written}")]).output();
            // A machine without bash has its own way.
            let Ok(printed) = printed else { return };
            assert_eq!(String::from_utf8(printed.stdout).unwrap(), word);
        }
    }

    #[cfg(not(windows))]
    #[test]
    fn a_command_is_known_by_being_words_alone() {
        let all: Vec<String> =
            ["nabiki", "simulate"].into_iter().chain(WORDS.map(|(word, _)| word)).map(str::to_owned).collect();
        assert_eq!(words(&command(&all)), Some(all.clone()));
        let is = |text: &str| is_command(text, &["nabiki", "simulate"]);
        assert!(is(&command(&all)) && is("nabiki simulate a.toml"));
        for text in [
            "",
            "nabiki",
            "nabiki simulate a; rm -rf x",
            "nabiki simulate $(rm x)",
            "nabiki simulate `rm x`",
            "nabiki simulate a && b",
            "nabiki simulate a\nrm x",
            "nabiki simulate \u{1b}[2J",
            "nabiki simulate a > b",
            "nabiki simulate 'a",
            "nabiki simulate $'a",
            "nabiki simulate \"a\"",
            "nabiki  simulate a",
            "nabiki simulate a\\",
            "rm simulate a",
            "nabiki simulate ~/x",
        ] {
            assert!(!is(text), "{text}");
        }
    }
}
