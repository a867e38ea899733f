use super::*;

const TEXT: &str = "# a breeze\n[[force]]\nthrough = 50     # half\nvector = [-100, 0, 0]\n";

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let place = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(place.file(), TEXT).unwrap();
        place
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("breeze.toml")
    }

    fn open(&self) -> Document {
        Document::open(&self.file()).unwrap()
    }

    fn text(&self) -> String {
        std::fs::read_to_string(self.file()).unwrap()
    }
}

/// The scene with its only interval ending elsewhere.
fn ending(document: &Document, through: u32) -> Scene {
    let mut scene = document.scene().clone();
    scene.field.force[0].through = through;
    scene
}

fn drag(document: &mut Document, through: impl IntoIterator<Item = u32>) {
    for n in through {
        document.edit("Move a border", ending(document, n), Phase::Dragging);
    }
    document.end_drag();
}

#[test]
fn one_drag_is_one_step() {
    let mut document = Place::new().open();
    let before = document.scene().clone();
    drag(&mut document, 51..60);
    drag(&mut document, 61..70);
    assert_eq!(document.scene().field.force[0].through, 69);
    assert!(document.undo());
    assert_eq!(document.scene().field.force[0].through, 59);
    assert!(document.undo());
    assert_eq!(*document.scene(), before);
    assert!(!document.undo());
    assert!(document.redo() && document.redo() && !document.redo());
    assert_eq!(document.scene().field.force[0].through, 69);
}

#[test]
fn a_drag_that_comes_back_is_no_step_and_no_change() {
    let mut document = Place::new().open();
    drag(&mut document, [60, 70, 50]);
    assert_eq!(document.undo_name(), None);
    assert!(!document.is_dirty());
}

#[test]
fn undo_and_redo_are_exact_over_many_random_steps() {
    let mut document = Place::new().open();
    let mut seen = vec![document.scene().clone()];
    let mut state = 7_u32;
    for _ in 0..200 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let through = 1 + (state >> 8) % 90;
        if document.scene().field.force[0].through != through {
            document.edit("Move", ending(&document, through), Phase::Done);
            seen.push(document.scene().clone());
        }
    }
    for scene in seen.iter().rev().skip(1) {
        assert!(document.undo());
        assert_eq!(document.scene(), scene);
    }
    for scene in &seen[1..] {
        assert!(document.redo());
        assert_eq!(document.scene(), scene);
    }
}

#[test]
fn a_new_step_after_an_undo_forgets_what_was_undone() {
    let mut document = Place::new().open();
    drag(&mut document, [60]);
    document.undo();
    drag(&mut document, [70]);
    assert!(!document.redo());
}

#[test]
fn comments_stay_and_the_mark_goes_when_it_is_saved() {
    let place = Place::new();
    let mut document = place.open();
    assert!(!document.is_dirty());
    drag(&mut document, [60]);
    assert!(document.is_dirty());
    document.save(false).unwrap();
    assert_eq!(place.text(), TEXT.replace("50 ", "60 "));
    assert!(!document.is_dirty());
    document.undo();
    assert!(document.is_dirty(), "what was saved is not what is here any more");
    document.save(false).unwrap();
    assert_eq!(place.text(), TEXT);
}

#[test]
fn the_later_of_two_windows_is_asked() {
    let place = Place::new();
    let (mut first, mut second) = (place.open(), place.open());
    drag(&mut first, [60]);
    first.save(false).unwrap();
    drag(&mut second, [70]);
    assert!(matches!(second.save(false), Err(SaveError::Changed(_))));
    assert!(place.text().contains("60"), "nothing is written before the answer");
    second.save(true).unwrap();
    assert!(place.text().contains("70"));
    second.save(false).unwrap();
    assert!(matches!(first.save(false), Err(SaveError::Changed(_))));
    first.reload().unwrap();
    assert_eq!(first.scene().field.force[0].through, 70);
    assert!(first.undo(), "what a reload replaced can be had again");
    assert_eq!(first.scene().field.force[0].through, 60);
}

#[test]
fn a_deleted_file_is_written_again() {
    let place = Place::new();
    let mut document = place.open();
    std::fs::remove_file(place.file()).unwrap();
    assert_eq!(document.changed_on_disk(), None);
    drag(&mut document, [60]);
    document.save(false).unwrap();
    assert!(place.text().contains("60"));
}

#[test]
fn a_file_that_cannot_be_written_leaves_document_and_file_as_they_were() {
    let place = Place::new();
    let mut document = place.open();
    drag(&mut document, [60]);
    let nowhere = place.folder.path().join("no such folder/breeze.toml");
    assert!(matches!(document.save_as(&nowhere), Err(SaveError::Scene(_))));
    assert_eq!(document.path(), Some(place.file().as_path()));
    assert!(document.is_dirty());
    assert_eq!(place.text(), TEXT);
}

#[test]
fn saved_elsewhere_it_leads_to_the_same_files_and_so_does_what_is_undone() {
    let place = Place::new();
    let folder = place.folder.path();
    std::fs::write(folder.join("head.csv"), "").unwrap();
    std::fs::create_dir(folder.join("below")).unwrap();
    std::fs::write(place.file(), format!("{TEXT}\n[head.motion]\nfile = \"head.csv\"\n")).unwrap();
    let mut document = place.open();
    drag(&mut document, [60]);
    let there = folder.join("below/other.toml");
    document.save_as(&there).unwrap();
    let leads_to = |document: &Document| {
        let scene = document.scene();
        std::fs::canonicalize(scene.resolve(&scene.head.motion.as_ref().unwrap().file)).unwrap()
    };
    assert_eq!(leads_to(&document), std::fs::canonicalize(folder.join("head.csv")).unwrap());
    document.undo();
    assert_eq!(leads_to(&document), std::fs::canonicalize(folder.join("head.csv")).unwrap());
    assert_eq!(document.path(), Some(there.as_path()));
}

#[test]
fn a_scene_without_a_file_asks_for_a_name() {
    let scene = Scene::parse(TEXT, "breeze.toml".as_ref(), &[]).unwrap();
    let mut document = Document::untitled(scene);
    assert!(!document.is_dirty(), "what was only looked at is not lost");
    assert!(matches!(document.save(false), Err(SaveError::NoFile)));
    drag(&mut document, [60]);
    assert!(document.is_dirty());
    let folder = tempfile::tempdir().unwrap();
    document.save_as(&folder.path().join("mine.toml")).unwrap();
    assert!(!document.is_dirty());
}

#[test]
fn a_drag_that_is_given_up_was_never_there() {
    let mut document = Place::new().open();
    let before = document.scene().clone();
    document.edit("Pull", ending(&document, 60), Phase::Dragging);
    document.edit("Pull", ending(&document, 70), Phase::Dragging);
    let version = document.version();
    document.give_up_drag();
    assert_eq!(*document.scene(), before);
    assert_ne!(document.version(), version, "it is to be moved again");
    assert!(!document.undo() && !document.redo());
}

#[test]
fn what_was_recovered_is_not_saved_yet() {
    let place = Place::new();
    let scene = place.open().scene().clone();
    let mut document = Document::unsaved(scene.clone(), Some(TEXT.into()));
    assert!(document.is_dirty());
    document.save(false).unwrap();
    assert!(!document.is_dirty());
    assert!(Document::unsaved(scene, None).is_dirty());
}

#[test]
fn two_things_done_in_one_drag_are_two_steps_and_what_goes_on_is_seen_from_where_its_drag_began() {
    let mut document = Place::new().open();
    let through = |scene: &Scene| scene.field.force[0].through;
    document.edit("Pull", ending(&document, 60), Phase::Dragging);
    document.edit("Pull", ending(&document, 65), Phase::Dragging);
    assert_eq!(through(document.before_drag("Pull")), 50);
    assert_eq!(through(document.before_drag("Cut")), 65);
    document.edit("Cut", ending(&document, 70), Phase::Dragging);
    document.end_drag();
    assert_eq!(through(document.before_drag("Cut")), 70, "it has ended");
    assert!(document.undo());
    assert_eq!(through(document.scene()), 65);
}

#[test]
fn an_undo_while_a_drag_is_where_it_began_takes_back_the_step_before() {
    let mut document = Place::new().open();
    drag(&mut document, [60]);
    for n in [70, 60] {
        document.edit("Pull", ending(&document, n), Phase::Dragging);
    }
    assert!(document.undo());
    assert_eq!(document.scene().field.force[0].through, 50);
}

#[test]
fn of_more_steps_than_are_kept_the_oldest_are_forgotten() {
    let mut document = Place::new().open();
    for n in 0..MOST_STEPS as u32 + 3 {
        document.edit("Move", ending(&document, 100 + n), Phase::Done);
    }
    let steps = std::iter::from_fn(|| document.undo().then_some(())).count();
    assert_eq!((steps, document.scene().field.force[0].through), (MOST_STEPS, 102));
}

#[test]
fn what_is_found_after_a_drag_belongs_to_its_step_while_that_is_the_last() {
    let mut document = Place::new().open();
    let through = |document: &Document| document.scene().field.force[0].through;
    let before = through(&document);
    document.edit("Pull", ending(&document, 60), Phase::Dragging);
    document.edit("Pull", ending(&document, 61), Phase::Done);
    document.edit("Pull", ending(&document, 62), Phase::After);
    document.edit("Pull", ending(&document, 63), Phase::After);
    assert_eq!(through(&document), 63);
    document.undo();
    assert_eq!(through(&document), before, "it is one step");
    // After another step it is one of its own.
    document.edit("Cut", ending(&document, 70), Phase::Done);
    document.edit("Pull", ending(&document, 71), Phase::After);
    document.undo();
    assert_eq!(through(&document), 70);
}
