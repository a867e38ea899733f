//! The nearest of the known names, for "did you mean".

/// Bytes beyond which nothing is a name that somebody has typed.
const LONGEST: usize = 256;

/// The candidate nearest to `name` by edit distance, unless all are too far to be meant.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |candidate: &str| edit_distance(&name.to_lowercase(), &candidate.to_lowercase());
    // A name mostly rewritten is another name; so is one much longer or shorter, of which no more need be known.
    let most = |candidate: &str| 1 + name.chars().count().max(candidate.chars().count()) / 3;
    let near = |candidate: &&str| name.chars().count().abs_diff(candidate.chars().count()) <= most(candidate);
    let is_short = |candidate: &&str| name.len().max(candidate.len()) <= LONGEST;
    let candidates = candidates.into_iter().filter(is_short).filter(near);
    let best = candidates.map(|c| (distance(c), c)).min_by_key(|&(d, _)| d)?;
    (best.0 <= most(best.1)).then_some(best.1)
}

/// Optimal string alignment: insertions, deletions, replacements and swaps of neighbours count 1 each.
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    rows[0] = (0..=b.len()).collect();
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_finger_find_their_name() {
        let known = ["time_step", "frames", "linear_density"];
        assert_eq!(nearest("time_stpe", known), Some("time_step"));
        assert_eq!(nearest("Frame", known), Some("frames"));
        assert_eq!(nearest("linear_densty", known), Some("linear_density"));
    }

    #[test]
    fn another_word_finds_nothing() {
        assert_eq!(nearest("colour", ["time_step", "frames"]), None);
        assert_eq!(nearest("x", []), None);
    }

    #[test]
    fn a_swap_of_neighbours_is_one_slip() {
        assert_eq!(edit_distance("stpe", "step"), 1);
        assert_eq!(edit_distance("", "abc"), 3);
    }
}
