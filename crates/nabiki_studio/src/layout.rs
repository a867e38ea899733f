//! Where the panels are: as a hand has placed them, as they were remembered, and as wide as they must be.

use std::path::Path;

use eframe::egui::Ui;
use egui_tiles::{Behavior, Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

use crate::settings::Page;

/// Width without which a page of settings would be cut (points).
const PAGE_WIDTH: f32 = 292.0;
/// Height without which the circles of a chosen interval would be cut (points).
const TIMELINE_HEIGHT: f32 = 222.0;
/// Most of a window that panels take for being as large as they must.
const MOST: f32 = 0.5;

/// A panel of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Pane {
    /// Head and hair.
    View,
    /// The wind over time.
    Timeline,
    /// Settings.
    Page(Page),
}

/// Panels in a window.
#[derive(Clone, Debug)]
pub struct Layout {
    tree: Tree<Pane>,
}

impl Default for Layout {
    /// As at the first start.
    fn default() -> Self {
        let mut tiles = Tiles::default();
        let view = tiles.insert_pane(Pane::View);
        let timeline = tiles.insert_pane(Pane::Timeline);
        let pages = Page::ALL.map(|page| tiles.insert_pane(Pane::Page(page))).to_vec();
        let pages = tiles.insert_tab_tile(pages);
        let mut shares = Linear::new(LinearDir::Horizontal, vec![view, pages]);
        shares.shares.set_share(view, 0.77);
        shares.shares.set_share(pages, 0.23);
        let above = tiles.insert_container(shares);
        let mut shares = Linear::new(LinearDir::Vertical, vec![above, timeline]);
        shares.shares.set_share(above, 0.72);
        shares.shares.set_share(timeline, 0.28);
        let root = tiles.insert_container(shares);
        Self { tree: Tree::new(eframe::egui::Id::unique("panels"), root, tiles) }
    }
}

impl Layout {
    /// As it was written; what cannot be read, or lacks a panel, is as at the first start, and said.
    pub fn load(file: &Path) -> (Self, Option<String>) {
        let text = match std::fs::read_to_string(file) {
            Ok(text) => Ok(text),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return (Self::default(), None),
            Err(e) => Err(e.to_string()),
        };
        match text.and_then(|text| Self::read(&text)) {
            Ok(layout) => (layout, None),
            Err(why) => {
                let said = format!("{}: {why}; the default layout applies", file.display());
                (Self::default(), Some(said))
            }
        }
    }

    fn read(text: &str) -> Result<Self, String> {
        let tree: Tree<Pane> = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let whole = [Pane::View, Pane::Timeline]
            .into_iter()
            .chain(Page::ALL.map(Pane::Page))
            .all(|pane| tree.tiles.find_pane(&pane).is_some_and(|id| tree.tiles.is_visible(id)));
        let has_root = tree.root().is_some_and(|root| tree.tiles.get(root).is_some());
        if whole && has_root { Ok(Self { tree }) } else { Err("a panel is missing".to_owned()) }
    }

    /// Writes it. A layout that is not remembered is no loss.
    pub fn write(&self, file: &Path) {
        if let Ok(text) = serde_json::to_string(&self.tree) {
            let _ = std::fs::write(file, text);
        }
    }

    /// Brings a page to the front.
    pub fn show(&mut self, page: Page) {
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(Pane::Page(shown)) if *shown == page));
    }

    /// Draws all panels into the room that is left. Where their shares of a small window would be less than they need, they
    /// have what they need; in a larger one their shares again.
    pub fn ui(&mut self, behavior: &mut impl Behavior<Pane>, ui: &mut Ui) {
        let kept: Vec<_> = lines(&self.tree.tiles).map(|(id, linear)| (id, linear.shares.clone())).collect();
        if let Some(root) = self.tree.root() {
            widen(&mut self.tree.tiles, root, ui.available_size().into());
        }
        let given: Vec<_> = lines(&self.tree.tiles).map(|(id, linear)| (id, linear.shares.clone())).collect();
        self.tree.ui(behavior, ui);
        for ((id, kept), (_, given)) in kept.into_iter().zip(given) {
            // Shares that a hand has changed are its own from then on.
            if let Some(Tile::Container(Container::Linear(linear))) = self.tree.tiles.get_mut(id)
                && linear.shares == given
            {
                linear.shares = kept;
            }
        }
    }
}

fn lines(tiles: &Tiles<Pane>) -> impl Iterator<Item = (TileId, &Linear)> {
    tiles.iter().filter_map(|(id, tile)| match tile {
        Tile::Container(Container::Linear(linear)) => Some((*id, linear)),
        _ => None,
    })
}

/// What a tile needs (points).
fn needs(tiles: &Tiles<Pane>, id: TileId) -> [f32; 2] {
    let all = |children: &[TileId]| -> Vec<[f32; 2]> { children.iter().map(|&child| needs(tiles, child)).collect() };
    let most = |all: &[[f32; 2]], axis: usize| all.iter().map(|need| need[axis]).fold(0.0, f32::max);
    match tiles.get(id) {
        Some(Tile::Pane(Pane::Page(_))) => [PAGE_WIDTH, 0.0],
        Some(Tile::Pane(Pane::Timeline)) => [0.0, TIMELINE_HEIGHT],
        Some(Tile::Container(Container::Linear(linear))) => {
            let all = all(&linear.children);
            let along = usize::from(linear.dir == LinearDir::Vertical);
            let mut needs = [most(&all, 0), most(&all, 1)];
            needs[along] = all.iter().map(|need| need[along]).sum();
            needs
        }
        Some(Tile::Container(container)) => {
            let all = all(&container.children().copied().collect::<Vec<_>>());
            [most(&all, 0), most(&all, 1)]
        }
        _ => [0.0, 0.0],
    }
}

/// Gives the tiles of a room the shares by which each has what it needs, if half of the room is enough for that.
fn widen(tiles: &mut Tiles<Pane>, id: TileId, size: [f32; 2]) {
    let Some(Tile::Container(container)) = tiles.get(id) else { return };
    let Container::Linear(linear) = container else {
        let children: Vec<TileId> = container.children().copied().collect();
        children.into_iter().for_each(|child| widen(tiles, child, size));
        return;
    };
    let along = usize::from(linear.dir == LinearDir::Vertical);
    let children: Vec<TileId> = linear.children.iter().copied().filter(|&child| tiles.is_visible(child)).collect();
    let mut lengths = linear.shares.split(&children, size[along]);
    let needed: Vec<f32> = children.iter().map(|&child| needs(tiles, child)[along].min(MOST * size[along])).collect();
    let missing: f32 = lengths.iter().zip(&needed).map(|(length, need)| (need - length).max(0.0)).sum();
    let spare: f32 = lengths.iter().zip(&needed).map(|(length, need)| (length - need).max(0.0)).sum();
    if missing > 0.0 && spare >= missing {
        for (length, need) in lengths.iter_mut().zip(&needed) {
            *length = if *length < *need { *need } else { *length - (*length - need) * missing / spare };
        }
        if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(id) {
            for (&child, &length) in children.iter().zip(&lengths) {
                linear.shares.set_share(child, length);
            }
        }
    }
    for (child, length) in children.into_iter().zip(lengths) {
        let mut room = size;
        room[along] = length;
        widen(tiles, child, room);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Widths and heights of view, timeline and pages in a room.
    fn rooms(layout: &Layout, size: [f32; 2]) -> [[f32; 2]; 3] {
        let mut tiles = layout.tree.tiles.clone();
        let root = layout.tree.root().unwrap();
        widen(&mut tiles, root, size);
        let split = |id: TileId, length: f32| match tiles.get(id) {
            Some(Tile::Container(Container::Linear(linear))) => {
                (linear.children.clone(), linear.shares.split(&linear.children, length))
            }
            _ => panic!("no line of panels"),
        };
        let (rows, heights) = split(root, size[1]);
        let (_, widths) = split(rows[0], size[0]);
        [[widths[0], heights[0]], [size[0], heights[1]], [widths[1], heights[0]]]
    }

    #[test]
    fn pages_and_timeline_have_what_they_need_in_a_small_window_and_their_share_in_a_large_one() {
        let layout = Layout::default();
        for size in [[720.0, 400.0], [1280.0, 670.0], [640.0, 370.0]] {
            let [view, timeline, pages] = rooms(&layout, size);
            assert!(pages[0] >= PAGE_WIDTH.min(MOST * size[0]) - 0.01, "{size:?}: {pages:?}");
            assert!(timeline[1] >= TIMELINE_HEIGHT.min(MOST * size[1]) - 0.01, "{size:?}: {timeline:?}");
            assert!(view[0] >= MOST * size[0] - 0.01 && view[1] >= MOST * size[1] - 0.01, "{size:?}: {view:?}");
            assert!((view[0] + pages[0] - size[0]).abs() < 0.01 && (view[1] + timeline[1] - size[1]).abs() < 0.01);
        }
        let [view, timeline, pages] = rooms(&layout, [3840.0, 2000.0]);
        assert!((pages[0] - 0.23 * 3840.0).abs() < 0.1 && (timeline[1] - 560.0).abs() < 0.1, "{view:?}");
    }

    #[test]
    fn a_layout_comes_back_and_a_broken_one_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("layout.json");
        let said = || Layout::load(&file).1;
        assert_eq!(said(), None, "before the first start there is none");
        Layout::default().write(&file);
        assert_eq!(said(), None);
        let text = std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, text.replace("Timeline", "View")).unwrap();
        assert!(said().is_some_and(|said| said.contains("layout.json: a panel is missing")));
        std::fs::write(&file, "{ \"root\": 17 }").unwrap();
        assert!(said().is_some_and(|said| said.contains("layout.json") && !said.contains('\n')));
    }
}
