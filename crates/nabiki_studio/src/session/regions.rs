//! What brush and comb leave in the scene: painted regions, and aims.

use glam::Vec3;
use nabiki::region::Region;
use nabiki_scene::Scene;
use nabiki_scene::scene::{AimSettings, Amount, Quantity};

use super::Session;
use crate::document::Phase;
use crate::take::Take;
use crate::tools::Stroke;
use crate::view::brush::Weights;

/// Most points of a curve that an aim is given.
const POINTS: usize = 10;
/// Frames over which a new aim begins and ends.
const EASE: u32 = 12;
/// The strength of a new aim (g): enough against a strong wind.
const STRENGTH: f32 = 8.0;
/// Roots nearer than this are of the same strand (cm): curves are in hundredths.
const SAME_CM: f32 = 0.02;

/// What is said of a stroke that leaves a region nothing.
const PAINT: &str = "Paint a region";

impl Session {
    /// A region has been painted: one of the scene, or a new one.
    pub(super) fn painted(&mut self, region: Option<usize>, mut painted: Region) {
        if painted.painted.iter().all(|point| point[3] == 0.0) {
            let why = "a region needs hair: to be rid of it, remove it on the Motion page";
            return self.refuse(PAINT, why);
        }
        self.accept(PAINT);
        let at = self.change(PAINT, Phase::Done, |scene| match region {
            Some(i) if i < scene.free.regions.len() => {
                scene.free.regions[i] = painted;
                i
            }
            _ => {
                painted.name = new_name(scene, "painted");
                scene.free.regions.push(painted);
                scene.free.regions.len() - 1
            }
        });
        self.tools.region = at;
        self.note_region();
    }

    /// The brush stays with its region where others come and go: by its name, or with none where that is not sure.
    pub(super) fn follow_region(&mut self) {
        let regions = self.document.as_ref().map_or(&[][..], |document| &document.scene().free.regions);
        let (name, count) = &self.painted;
        if let Some(i) = self.tools.region
            && regions.len() != *count
            && regions.get(i).is_none_or(|region| region.name.is_empty() || region.name != *name)
        {
            self.tools.region = regions.iter().position(|region| !name.is_empty() && region.name == *name);
        }
        self.note_region();
    }

    /// Remembers the region that is painted, and how many there are.
    fn note_region(&mut self) {
        let regions = self.document.as_ref().map_or(&[][..], |document| &document.scene().free.regions);
        self.tools.region = self.tools.region.filter(|&i| i < regions.len());
        let name = self.tools.region.map(|i| regions[i].name.clone());
        self.painted = (name.unwrap_or_default(), regions.len());
    }

    /// Hair has been combed in a frame: the aim of that frame leads it there, or a new one.
    pub(super) fn combed(&mut self, frame: u32, strands: &[(usize, Vec<Vec3>)]) {
        let Some(take) = self.take.clone() else { return };
        self.change("Comb", Phase::Done, |scene| comb(scene, &take, frame, strands));
    }
}

/// A name that no region of the scene has.
fn new_name(scene: &Scene, word: &str) -> String {
    let taken = |name: &String| scene.free.regions.iter().any(|region| region.name == *name);
    (1..).map(|n| format!("{word} {n}")).find(|name| !taken(name)).unwrap_or_default()
}

fn comb(scene: &mut Scene, take: &Take, frame: u32, strands: &[(usize, Vec<Vec3>)]) {
    let of_frame = |aim: &AimSettings| !aim.curves.is_empty() && aim.frame == Some(frame);
    let at = scene.aims.iter().rposition(of_frame).unwrap_or_else(|| {
        let name = new_name(scene, "combed");
        scene.free.regions.push(Region { name: name.clone(), ..Region::default() });
        scene.aims.push(AimSettings {
            name: name.clone(),
            region: Some(name),
            frame: Some(frame),
            strength: Amount::World(Quantity::new(STRENGTH)),
            from: frame,
            through: Some(frame),
            ease_in: EASE,
            ease_out: EASE,
            ..AimSettings::default()
        });
        scene.aims.len() - 1
    });
    let aim = &mut scene.aims[at];
    let new: Vec<Vec<Vec3>> = strands.iter().map(|(_, strand)| curve(strand)).collect();
    let is_new = |old: &Vec<Vec3>| new.iter().any(|new| new[0].distance(old[0]) < SAME_CM);
    aim.curves.retain(|old| !is_new(old));
    aim.curves.extend(new);
    // What it leads: the hair that was combed.
    let region = aim.region.clone();
    let region = scene.free.regions.iter_mut().find(|of| region.as_ref() == Some(&of.name));
    if let Some(region) = region.filter(|region| !region.has_members()) {
        let before = Weights::new(take.strands(), take.at_hand(), Some(&*region));
        let mut covered = vec![0.0; before.of().len()];
        // The motion may have come anew since, with other strands.
        for (strand, _) in strands {
            covered.get_mut(*strand).into_iter().for_each(|covered| *covered = 1.0);
        }
        before.stroked(Stroke::Add, &covered).paint(region);
    }
}

/// A strand as a curve of few points, in hundredths of a centimetre.
fn curve(strand: &[Vec3]) -> Vec<Vec3> {
    let last = strand.len() - 1;
    let parts = last.min(POINTS - 1);
    let round = |x: f32| (x * 100.0).round() / 100.0;
    (0..=parts).map(|i| Vec3::from(strand[i * last / parts].to_array().map(round))).collect()
}

#[cfg(test)]
#[path = "regions_tests.rs"]
mod tests;
