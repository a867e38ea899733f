//! Words of a command as a POSIX shell takes them.

/// One word, in quotes where it has anything but letters, digits and what no shell takes for a sign.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// A command of such words, parted by spaces.
#[must_use]
pub fn command(words: &[String]) -> String {
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_takes_quoted_words_as_they_are() {
        for (word, as_written) in [
            ("scenes/gust.toml", "scenes/gust.toml"),
            ("force.1.vector=[0, -100, 0]", "'force.1.vector=[0, -100, 0]'"),
            ("it's", r"'it'\''s'"),
            ("$HOME `x` \"y\"", "'$HOME `x` \"y\"'"),
            ("", "''"),
            ("\u{98a8}.toml", "'\u{98a8}.toml'"),
        ] {
            assert_eq!(quoted(word), as_written);
        }
        assert_eq!(command(&["a".to_owned(), "b c".to_owned()]), "a 'b c'");
    }
}
