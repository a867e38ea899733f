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
    let hold = |hold| HeldFolder::hold(folder.path(), hold).unwrap();
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
        drop(HeldFolder::hold(folder.path(), hold).unwrap().unwrap());
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
                    let Some(held) = HeldFolder::hold(folder.path(), Hold::Alone).unwrap() else { continue };
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

// Each looks for stale parts while the others begin theirs, as programs do that write to one place at the same moment.
#[test]
fn of_many_that_write_one_file_none_fails() {
    let folder = folder();
    let target = folder.path().join("same.abc");
    std::thread::scope(|scope| {
        for writer in 0..4_u8 {
            let target = &target;
            scope.spawn(move || {
                for _ in 0..300 {
                    let mut part = PartFile::create(target).unwrap();
                    part.write_all(&[writer; 10]).unwrap();
                    part.finish().unwrap();
                }
            });
        }
        scope.spawn(|| (0..3000).for_each(|_| remove_stale_of_another_program(folder.path(), &target)));
    });
    let written = fs::read(&target).unwrap();
    assert!(written.len() == 10 && written.iter().all(|&byte| byte == written[0]), "{written:?}");
    assert_eq!(names(folder.path()), ["same.abc"]);
}

/// What a program does that has none of these parts open itself.
fn remove_stale_of_another_program(folder: &Path, target: &Path) {
    for entry in fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path != *target {
            remove_unheld(&path);
        }
    }
}

#[cfg(unix)]
#[test]
fn a_replaced_file_keeps_its_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let target = folder.path().join("private.usdc");
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    for wanted in [0o600, 0o640, 0o664, 0o444, 0o666, 0o755] {
        fs::write(&target, "old").ok();
        fs::set_permissions(&target, fs::Permissions::from_mode(wanted)).unwrap();
        let part = PartFile::create(&target).unwrap();
        assert_eq!(mode(part.part.path()) & !wanted, 0, "{wanted:o}: nobody else may read it while it grows");
        part.finish().unwrap();
        assert_eq!(mode(&target), wanted, "{wanted:o}");
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_in_the_place_of_a_part_or_a_lock_is_not_waited_for() {
    let folder = folder();
    let pipe = |name: &str| {
        let pipe = folder.path().join(name);
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        pipe
    };
    let target = folder.path().join("hair.abc");
    let part = pipe(&(prefix_of(&target) + "pipe"));
    PartFile::create(&target).unwrap().finish().unwrap();
    let lock = pipe(".nabiki-lock");
    assert_eq!(HeldFolder::hold(folder.path(), Hold::Alone).unwrap_err(), lock);
    assert!(part.exists() && lock.exists());
}

#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_a_lock_is_not_followed() {
    let folder = folder();
    let (lock, nowhere) = (folder.path().join(".nabiki-lock"), folder.path().join("nowhere"));
    std::os::unix::fs::symlink(&nowhere, &lock).unwrap();
    assert_eq!(HeldFolder::hold(folder.path(), Hold::BesideOthers).unwrap_err(), lock);
    assert!(!nowhere.exists(), "nothing is made where it leads");
}

#[test]
fn what_the_system_says_is_said_in_its_words() {
    let folder = folder();
    let system = fs::read_dir(folder.path().join("nowhere")).unwrap_err();
    let ours = PartFile::create(&folder.path().join("nowhere/hair.abc")).unwrap_err();
    assert_eq!((ours.raw_os_error(), ours.to_string()), (system.raw_os_error(), system.to_string()));
}
