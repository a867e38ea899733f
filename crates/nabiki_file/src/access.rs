//! Who may read a result: whoever might read the file that it replaces, or any new file.

use std::fs::{self, File, Metadata, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
use std::path::Path;

/// What a file is made with; the umask is taken off. Of what replaces a private file nobody else sees the beginning.
pub(super) fn at_first(target: &Path) -> u32 {
    replaced(target).map_or(0o666, |there| there.mode() & 0o666 | 0o600)
}

/// Gives `file` owner, group and permissions of the file that it will replace, as far as the system lets it.
pub(super) fn keep(file: &File, target: &Path) {
    let (Some(there), Ok(new)) = (replaced(target), file.metadata()) else { return };
    if (there.uid(), there.gid()) != (new.uid(), new.gid()) {
        // Another's file may be replaced by whoever may write into its folder, who can hand on the group at the most.
        let _ = fchown(file, Some(there.uid()), Some(there.gid())).or_else(|_| fchown(file, None, Some(there.gid())));
    }
    let _ = file.set_permissions(Permissions::from_mode(there.mode() & 0o777));
}

fn replaced(target: &Path) -> Option<Metadata> {
    fs::metadata(target).ok().filter(Metadata::is_file)
}
