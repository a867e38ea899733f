//! A fast preview of a few strands, which move exactly as among all.

use std::path::Path;

use nabiki::dynamics::check_field;
use nabiki_render::{Draft, Picture};

use crate::advice::Advice;
use crate::built::{BuiltScene, Shown};
use crate::cache_file::write_cache;
use crate::error::Result;
use crate::film::Film;
use crate::frames::Simulated;
use crate::outputs::{self, PictureOutputs};
use crate::place::{self, Folders};
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::Watch;

/// Default number of strands of a preview. A scene with fewer strands shows all.
pub const PREVIEW_STRANDS: usize = 300;

/// Longer side of a preview's frames (pixels).
const LONGER_SIDE: u32 = 480;

/// Draws some of a scene's strands, small and with the light of a [`Draft`], into `folder`. If `cache` is given, it
/// also writes their motion there.
///
/// # Errors
/// As for [`run`](super::run()).
pub fn preview(scene: Scene, shown: Shown, folder: &Path, cache: Option<&Path>, watch: &mut dyn Watch) -> Result<()> {
    if let Some(cache) = cache {
        place::cache(cache, "choose another name", &scene.inputs())?;
    }
    outputs::check_movie(&scene, &small(&scene.picture, 1.0))?;
    let built = super::build(scene, shown, watch)?;
    let simulated = Simulated::new(&built)?;
    let scene = &built.scene;
    let share = built.groom.of_scene as f32 / built.strands().len() as f32;
    let picture = small(&scene.picture, share);
    let mut folders = Folders::default();
    let name = format!("{}_preview", scene.name());
    let mut outputs = PictureOutputs::begin(&built, &picture, folder, &name, &scene.inputs(), &mut folders, watch)?;
    outputs.check_apart_from(cache.as_slice())?;
    super::introduce(&built, watch);
    super::advise(whole_is_refused(&built)?, watch);
    let draft = Draft::new(share, picture.hair.width / scene.picture.hair.width);
    let mut film = Film::new(&built, &picture, &mut simulated.again(), watch)?.drafted(draft);
    let mut frames = simulated.again();
    let summary = film.shoot(&mut frames, &mut outputs, watch)?;
    watch.told(Told::Motion(summary));
    let mut written = outputs.finish(watch)?;
    if let Some(cache) = cache {
        write_cache(&built, cache, &mut simulated.again(), watch)?;
        written.push(cache.to_owned());
    }
    super::wrote(written, watch);
    Ok(())
}

/// That all strands of a hair file would be refused although those shown are not: a shorter one may be among them. For
/// grown hair, all of it would have to be grown to know.
fn whole_is_refused(built: &BuiltScene) -> Result<Option<Advice>> {
    let (shown, all) = (built.strands().len(), built.groom.of_scene);
    if built.scene.hair.imported().is_none() || shown == all {
        return Ok(None);
    }
    let whole = built.changed_to(built.scene.clone(), Shown::All)?;
    let Err(refused) = check_field(whole.strands(), &whole.dynamics, &*whole.forces.field) else { return Ok(None) };
    let seen =
        format!("simulates {shown} of {all} strands; nabiki would refuse all of them: {}", whole.refusal(refused));
    Ok(Some(Advice::new(seen)))
}

/// A smaller picture with thicker hair: each strand represents `share` of the scene's, but is not drawn as thick as
/// rope.
fn small(picture: &Picture, share: f32) -> Picture {
    let mut small = picture.clone();
    let factor = (LONGER_SIDE as f32 / picture.size[0].max(picture.size[1]) as f32).min(1.0);
    small.size = picture.size.map(|side| ((side as f32 * factor).round() as u32 & !1).max(16));
    small.hair.width *= share.sqrt().min(8.0);
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preview_has_the_longer_side_of_a_preview_and_the_shape_of_the_picture() {
        for (size, wanted) in [([960, 540], [480, 270]), ([540, 960], [270, 480]), ([200, 100], [200, 100])] {
            assert_eq!(small(&Picture { size, ..Picture::default() }, 1.0).size, wanted);
        }
        // 160.6: both sides are even, as a movie's are.
        assert_eq!(small(&Picture { size: [1001, 335], ..Picture::default() }, 1.0).size, [480, 160]);
    }

    #[test]
    fn fewer_hairs_are_drawn_thicker_by_the_root_of_their_share_up_to_eightfold() {
        let whole = Picture::default();
        for (share, wanted) in [(1.0, 1.0), (4.0, 2.0), (25.0, 5.0), (1000.0, 8.0)] {
            let thicker = small(&whole, share).hair.width / whole.hair.width;
            assert!((thicker - wanted).abs() < 1e-5, "{share}: {thicker}");
        }
    }
}
