//! Finds the locks of a wish file in the hair of a scene.

use std::collections::HashMap;

use glam::Vec3;
use nabiki::SettingError;
use nabiki::dynamics::Timeline;
use nabiki::solve::{Goal, Node, Wish, nodes_near, nodes_of};
use nabiki_io::info::Short;

use super::wishes::{Lock, WishFile, WishSpace, Wishes};
use crate::built::BuiltScene;
use crate::error::{Error, Result};

/// A wish with its name in the file.
#[derive(Clone, Debug)]
pub struct Named {
    /// `wish[0]`, `nail[2]`.
    pub name: String,
    /// The wish, for nodes of the built hair, in head space.
    pub wish: Wish,
}

impl WishFile {
    /// The wishes for the hair of a scene, then the nails, one per frame.
    ///
    /// # Errors
    /// Strands or frames that do not exist, positions without hair, or a scene that cannot be simulated.
    pub fn about(&self, built: &BuiltScene) -> Result<Vec<Named>> {
        let Wishes { space, wish, nail, .. } = &self.wishes;
        let places = built.groom.ids.iter().enumerate().map(|(s, &id)| (id, s)).collect();
        let mut finder = Finder { file: self, built, space: *space, timeline: None, places };
        let mut found = Vec::new();
        for (i, entry) in wish.iter().enumerate() {
            let name = format!("wish[{i}]");
            finder.check_frame(&format!("{name}.frame"), entry.frame)?;
            let nodes = finder.nodes(&name, &entry.lock(), entry.frame)?;
            let goal = entry.goal(&name).map_err(|refused| self.refusal(refused))?;
            if let Goal::Places(places) = &goal
                && places.len() != nodes.len()
            {
                let remedy = format!(
                    "the lock has {} nodes, not counting roots, which do not move: give a place for each, or mean_at",
                    nodes.len()
                );
                return Err(finder.refused(&format!("{name}.places"), format!("{} places", places.len()), remedy));
            }
            let goal = finder.in_head(goal, entry.frame);
            found.push(Named { name, wish: Wish { frame: entry.frame, nodes, goal, weight: entry.weight } });
        }
        for (i, entry) in nail.iter().enumerate() {
            for (k, &frame) in entry.frames.iter().enumerate() {
                let name = format!("nail[{i}]");
                finder.check_frame(&format!("{name}.frames[{k}]"), frame)?;
                let nodes = finder.nodes(&name, &entry.lock(), frame)?;
                found.push(Named { name, wish: Wish { frame, nodes, goal: Goal::Stay, weight: entry.weight } });
            }
        }
        Ok(found)
    }
}

struct Finder<'a> {
    file: &'a WishFile,
    built: &'a BuiltScene,
    space: WishSpace,
    /// The scene's motion, once it was needed.
    timeline: Option<Timeline>,
    /// The index of each strand by its number in the scene.
    places: HashMap<u32, usize>,
}

impl Finder<'_> {
    fn refused(&self, key: &str, value: String, remedy: impl Into<String>) -> Error {
        self.file.refusal(SettingError::new(key, value, remedy)).into()
    }

    fn check_frame(&self, key: &str, frame: u32) -> Result<()> {
        let frames = self.built.frames();
        if (1..=frames).contains(&frame) {
            return Ok(());
        }
        Err(self.refused(key, frame.to_string(), format!("hair moves in frames 1 to {frames} of the scene")))
    }

    /// The nodes of a lock, strand by strand. `name`: the name of the wish; `frame`: its frame.
    fn nodes(&mut self, name: &str, lock: &Lock, frame: u32) -> Result<Vec<Node>> {
        let strands = self.built.strands();
        let part = |s: usize, [from, to]: [f32; 2]| nodes_of(s as u32, strands.strand(s).len(), from..=to);
        let Some(near) = lock.near else {
            let along = lock.along.unwrap_or([0.0, 1.0]);
            let mut nodes = Vec::new();
            for (k, id) in lock.strands.iter().enumerate() {
                let Some(&s) = self.places.get(id) else {
                    let kept = self.built.groom.of_scene;
                    let mut remedy = format!("the scene's strands are 0 to {}", kept - 1);
                    if let Some(report) = self
                        .built
                        .groom
                        .imported
                        .as_ref()
                        .map(|imported| imported.report)
                        .filter(|report| report.strands_in_file > kept)
                    {
                        let of_file = report.strands_in_file;
                        remedy += &format!(", the ones it keeps of {of_file} in its file: count only these");
                    }
                    return Err(self.refused(&format!("{name}.strands[{k}]"), id.to_string(), remedy));
                };
                nodes.extend(part(s, along));
            }
            if nodes.is_empty() {
                let remedy = "contains no moving node: use a longer part of the strands";
                return Err(self.refused(&format!("{name}.along"), format!("{along:?}"), remedy));
            }
            return Ok(nodes);
        };
        let looked_at = near.frame.unwrap_or(frame);
        if looked_at > 0 {
            self.check_frame(&format!("{name}.near.frame"), looked_at)?;
        }
        let point = self.point_in_head(near.point, looked_at);
        let mut timeline = match self.timeline.take() {
            Some(timeline) => timeline,
            None => self.built.timeline()?,
        };
        let mut nodes = nodes_near(timeline.seek(looked_at), point, near.radius);
        self.timeline = Some(timeline);
        if let Some(along) = lock.along {
            nodes.dedup_by_key(|node| node.strand);
            nodes = nodes.into_iter().flat_map(|node| part(node.strand as usize, along)).collect();
        }
        if nodes.is_empty() {
            let [x, y, z] = near.point.to_array().map(Short);
            let remedy = format!(
                "no hair is that close to ({x}, {y}, {z}) in frame {looked_at}: give a larger radius or another point"
            );
            return Err(self.refused(&format!("{name}.near.radius"), near.radius.to_string(), remedy));
        }
        Ok(nodes)
    }

    fn point_in_head(&self, point: Vec3, frame: u32) -> Vec3 {
        match self.space {
            WishSpace::Head => point,
            WishSpace::World => self.built.pose(frame).world_from_head().inverse().transform_point3(point),
        }
    }

    /// A goal of the file in head space.
    fn in_head(&self, goal: Goal, frame: u32) -> Goal {
        let way = |v: Vec3| match self.space {
            WishSpace::Head => v,
            WishSpace::World => self.built.pose(frame).rotation.inverse() * v,
        };
        match goal {
            Goal::Places(places) => Goal::Places(places.iter().map(|&p| self.point_in_head(p, frame)).collect()),
            Goal::Moved(by) => Goal::Moved(way(by)),
            Goal::MeanMoved(by) => Goal::MeanMoved(way(by)),
            Goal::MeanAt(p) => Goal::MeanAt(self.point_in_head(p, frame)),
            Goal::Stay => Goal::Stay,
        }
    }
}
