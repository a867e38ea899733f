use super::*;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_file_has_its_name_only_when_it_is_finished() {
    let folder = folder();
    let target = folder.path().join("hair.usdc");
    fs::write(&target, "old").unwrap();
    let mut part = PartFile::create(&target).unwrap();
    part.write_all(b"new").unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"old");
    part.finish().unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"new");
    drop(PartFile::create(&target).unwrap());
    assert_eq!(names(folder.path()), ["hair.usdc"]);
}

#[test]
fn what_a_killed_program_left_is_removed_and_what_another_writes_is_not() {
    let folder = folder();
    let target = folder.path().join("motion.nabiki");
    let part = |end: &str| folder.path().join(prefix_of(&target) + end);
    fs::write(part("killed"), "half").unwrap();
    let held = part("held");
    let holder = File::create(&held).unwrap();
    holder.try_lock().unwrap();
    let first = PartFile::create(&target).unwrap();
    let second = PartFile::create(&target).unwrap();
    assert!(held.exists());
    assert_eq!(names(folder.path()).len(), 3, "one of another program and two of this");
    drop((first, second));
    assert_eq!(names(folder.path()), [held.file_name().unwrap().to_str().unwrap()]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let folder = folder();
    let (link, real) = (folder.path().join("latest.png"), folder.path().join("frame.png"));
    std::os::unix::fs::symlink("frame.png", &link).unwrap();
    let mut part = PartFile::create(&link).unwrap();
    part.write_all(b"picture").unwrap();
    part.finish().unwrap();
    assert_eq!(fs::read_link(&link).unwrap(), Path::new("frame.png"));
    assert_eq!(fs::read(&real).unwrap(), b"picture");
}

#[cfg(unix)]
#[test]
fn links_in_a_circle_are_refused() {
    let folder = folder();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    std::os::unix::fs::symlink("b", &a).unwrap();
    std::os::unix::fs::symlink("a", &b).unwrap();
    assert!(PartFile::create(&a).is_err());
}

#[cfg(unix)]
#[test]
fn a_finished_file_has_the_mode_of_any_other_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let (ours, other) = (folder.path().join("ours"), folder.path().join("other"));
    PartFile::create(&ours).unwrap().finish().unwrap();
    File::create(&other).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&ours), mode(&other));
}

#[test]
fn a_name_may_be_as_long_as_the_disk_takes() {
    let folder = folder();
    let target = folder.path().join("n".repeat(255));
    PartFile::create(&target).unwrap().finish().unwrap();
    assert!(target.exists());
}

#[test]
fn a_folder_is_held_by_one_alone_or_by_many_that_allow_others() {
    let folder = folder();
    let hold = |hold| HeldFolder::hold(folder.path(), hold);
    let alone = hold(Hold::Alone).unwrap();
    assert!(hold(Hold::Alone).is_none() && hold(Hold::BesideOthers).is_none());
    drop(alone);
    assert_eq!(names(folder.path()), [""; 0], "the lock file goes");
    let [first, second] = [0, 1].map(|_| hold(Hold::BesideOthers).unwrap());
    drop(first);
    assert!(hold(Hold::Alone).is_none(), "one is left");
    drop(second);
    assert_eq!(names(folder.path()), [""; 0]);
    drop(hold(Hold::Alone).unwrap());
}

#[test]
fn a_lock_file_that_a_killed_program_left_holds_nothing() {
    let folder = folder();
    fs::write(folder.path().join(".nabiki-lock"), "").unwrap();
    for hold in [Hold::Alone, Hold::BesideOthers] {
        drop(HeldFolder::hold(folder.path(), hold).unwrap());
        assert_eq!(names(folder.path()), [""; 0]);
    }
}

// Who takes a folder while another lets go of it must not be left with a lock file that is gone.
#[cfg(unix)]
#[test]
fn of_many_at_once_one_has_a_folder_for_itself() {
    let folder = folder();
    let inside = std::sync::atomic::AtomicU32::new(0);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..200 {
                    let Some(held) = HeldFolder::hold(folder.path(), Hold::Alone) else { continue };
                    assert_eq!(inside.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0);
                    std::thread::yield_now();
                    inside.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
                    drop(held);
                }
            });
        }
    });
    assert_eq!(names(folder.path()), [""; 0]);
}
