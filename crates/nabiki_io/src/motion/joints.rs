//! The joints of a file's tree: found by name or path, and the way to each from its root.

use crate::error::{Error, Result};

/// Ancestors that a joint may have: each frame walks up to the root, so this bounds the time that a small file can take;
/// a body has a dozen.
pub(crate) const DEEPEST: usize = 1000;

/// Poses of joints that the frames of a motion may take in all: three hours of a chain of thirty.
const MOST_POSES: usize = 1 << 23;

/// Refuses a motion of a chain of so many joints that is longer than nabiki reads.
pub(super) fn check_poses(joints: usize, frames: usize) -> Result<()> {
    if joints.saturating_mul(frames) <= MOST_POSES {
        return Ok(());
    }
    Err(Error::new(format!(
        "moves a chain of {joints} joints over {frames} frames or more: that is more than nabiki reads; bake only the motion \
         of the head, or cut it into parts"
    )))
}

/// Joints by number: their names, and who hangs below whom.
pub(super) struct Tree<'a> {
    /// What the file calls them: `joint`, `bone`, `node`.
    pub kind: &'static str,
    /// Their names; `None` for one that has none and so cannot be chosen.
    pub names: Vec<Option<&'a str>>,
    /// The parent of each, `None` for a root.
    pub parents: Vec<Option<usize>>,
}

impl Tree<'_> {
    /// The joints from the root down to the one that `node` names, the wanted one last.
    ///
    /// `node` is a name, or a path such as `Hips/Spine/Head` where several have that name; a path that begins with `/`
    /// begins at the root. Capitals count only where they tell two joints apart.
    ///
    /// # Errors
    /// A name that no joint has, or several; a joint that is its own ancestor or has more of them than are read.
    pub fn chain(&self, node: &str) -> Result<Vec<usize>> {
        let exact = self.named(node, |a, b| a == b)?;
        let found = if exact.is_empty() { self.named(node, |a, b| a.eq_ignore_ascii_case(b))? } else { exact };
        match found[..] {
            [] => Err(self.unknown(node)),
            [joint] => self.to_root(joint),
            _ => Err(self.ambiguous(node, &found)?),
        }
    }

    /// The joints whose name or path `node` is, as `same` compares texts.
    fn named(&self, node: &str, same: impl Fn(&str, &str) -> bool) -> Result<Vec<usize>> {
        let mut found = Vec::new();
        for (joint, name) in self.names.iter().enumerate() {
            let Some(name) = name else { continue };
            // A path ends with the name.
            let Some(from) = node.len().checked_sub(name.len()) else { continue };
            if !node.get(from..).is_some_and(|end| same(end, name)) {
                continue;
            }
            let fits = from == 0 || {
                let path = self.path(joint)?;
                let wanted = if node.starts_with('/') { node.to_owned() } else { format!("/{node}") };
                let from = path.len().checked_sub(wanted.len());
                let whole = !node.starts_with('/') || from == Some(0);
                whole && from.and_then(|from| path.get(from..)).is_some_and(|end| same(end, &wanted))
            };
            if fits {
                found.push(joint);
            }
        }
        Ok(found)
    }

    /// The names from the root on, each behind a `/`.
    fn path(&self, joint: usize) -> Result<String> {
        let names = self.to_root(joint)?.into_iter().map(|joint| self.names[joint].unwrap_or_default());
        Ok(names.fold(String::new(), |path, name| path + "/" + name))
    }

    fn to_root(&self, joint: usize) -> Result<Vec<usize>> {
        let mut chain = vec![joint];
        while let Some(parent) = self.parents[chain[chain.len() - 1]] {
            chain.push(parent);
            if chain.len() > self.names.len() {
                return Err(Error::new(format!("a {} is its own ancestor", self.kind)));
            }
            if chain.len() > DEEPEST {
                let what = format!("a {} has more than {DEEPEST} ancestors, more than nabiki reads", self.kind);
                return Err(Error::new(what));
            }
        }
        chain.reverse();
        Ok(chain)
    }

    fn unknown(&self, node: &str) -> Error {
        const SHOWN: usize = 60;
        let kind = self.kind;
        let names: Vec<String> =
            self.names.iter().copied().flatten().take(SHOWN).map(|name| format!("{name:.80}")).collect();
        if names.is_empty() {
            return Error::new(format!("no {kind} \"{node:.80}\": none has a name"));
        }
        Error::new(format!("no {kind} \"{node:.80}\": node can be {}", names.join(", ")))
    }

    fn ambiguous(&self, node: &str, found: &[usize]) -> Result<Error> {
        const SHOWN: usize = 10;
        let (kind, count) = (self.kind, found.len());
        let paths = found.iter().take(SHOWN).map(|&joint| self.path(joint)).collect::<Result<Vec<_>>>()?;
        let what = format!("{kind} \"{node:.80}\": {count} have that name");
        let differ = paths.iter().enumerate().all(|(i, path)| !paths[..i].contains(path));
        let way = if differ { "give node as a path: one of" } else { "rename one of them in the file:" };
        Ok(Error::new(format!("{what}; {way} {}", paths.join(", "))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hips over Spine over Head, and over Tail over Head and head; a second root Head over Head.
    fn tree() -> Tree<'static> {
        let names = ["Hips", "Spine", "Head", "Tail", "Head", "head", "Head", "Head"].map(Some).to_vec();
        let parents = vec![None, Some(0), Some(1), Some(0), Some(3), Some(3), None, Some(6)];
        Tree { kind: "joint", names, parents }
    }

    #[test]
    fn a_path_tells_joints_of_one_name_apart() {
        let tree = tree();
        assert_eq!(tree.chain("Spine").unwrap(), [0, 1]);
        assert_eq!(tree.chain("spine").unwrap(), [0, 1], "capitals do not count");
        assert_eq!(tree.chain("head").unwrap(), [0, 3, 5], "but where they tell");
        assert_eq!(tree.chain("Spine/Head").unwrap(), [0, 1, 2]);
        assert_eq!(tree.chain("/hips/spine/head").unwrap(), [0, 1, 2]);
        assert_eq!(tree.chain("Tail/Head").unwrap(), [0, 3, 4]);
        assert_eq!(tree.chain("/Head").unwrap(), [6], "a root of a name that others have");
        assert_eq!(tree.chain("/Head/Head").unwrap(), [6, 7]);
        assert!(tree.chain("pine/Head").is_err() && tree.chain("/Spine/Head").is_err() && tree.chain("").is_err());
    }

    #[test]
    fn a_name_that_several_have_is_refused_with_their_paths() {
        assert_eq!(
            tree().chain("Head").unwrap_err().to_string(),
            "joint \"Head\": 4 have that name; give node as a path: one of /Hips/Spine/Head, /Hips/Tail/Head, /Head, \
             /Head/Head"
        );
        let twins =
            Tree { kind: "node", names: vec![Some("A"), Some("B"), Some("B")], parents: vec![None, Some(0), Some(0)] };
        assert_eq!(
            twins.chain("B").unwrap_err().to_string(),
            "node \"B\": 2 have that name; rename one of them in the file: /A/B, /A/B"
        );
        let unknown = twins.chain("C").unwrap_err().to_string();
        assert_eq!(unknown, "no node \"C\": node can be A, B, B");
    }

    #[test]
    fn a_circle_of_joints_is_refused() {
        let circle = Tree { kind: "joint", names: vec![Some("A"), Some("B")], parents: vec![Some(1), Some(0)] };
        assert_eq!(circle.chain("A").unwrap_err().to_string(), "a joint is its own ancestor");
        assert_eq!(circle.chain("B/A").unwrap_err().to_string(), "a joint is its own ancestor");
    }
}
