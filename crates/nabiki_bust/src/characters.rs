//! The characters of the scenes `walker`, `beard` and `creature`: sculpted as the bust is, hung on joints and animated by
//! functions of our own.

mod creature;
mod fewer;
mod glb;
mod hair;
mod net;
mod rig;
mod talker;
mod walker;

/// What makes a file.
type Maker = fn() -> Vec<u8>;

/// The files in `scenes/characters`, and what makes each.
pub const ALL: &[(&str, Maker)] = &[
    ("walker.glb", walker::glb),
    ("talker.glb", talker::glb),
    ("beard.hair", talker::beard),
    ("creature.glb", creature::glb),
    ("fur.hair", creature::fur),
];

#[cfg(test)]
mod tests;
