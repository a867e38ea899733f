//! Available and required memory: what cannot fit is refused before it begins, because the system ends a program that
//! runs out of memory without a message.

use std::path::{Path, PathBuf};

/// Why this many bytes are not available, as a phrase; `None` if they may be, or if the system does not report its memory.
///
/// What is asked for is what is certain to be needed, not all of it: what fits is never refused.
pub(crate) fn short_of(bytes: u64) -> Option<String> {
    let left = available().filter(|&left| bytes > left)?;
    Some(format!("needs at least {} of memory, but only {} are available", size(bytes), size(left)))
}

/// A number of bytes for display.
pub(crate) fn size(bytes: u64) -> String {
    let steps = [(1u64 << 40, "TiB"), (1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    match steps.into_iter().find(|&(unit, _)| bytes >= unit) {
        Some((unit, name)) => format!("{:.1} {name}", bytes as f64 / unit as f64),
        None => format!("{bytes} bytes"),
    }
}

/// Bytes that this program may still use: the free memory of the machine, and what limits on its control group and on
/// itself leave. `None` if the system does not report it.
fn available() -> Option<u64> {
    let read = |file: &str| std::fs::read_to_string(file).ok();
    let limits = read("/proc/self/limits").zip(read("/proc/self/status"));
    let of_machine = read("/proc/meminfo").and_then(|text| of_machine(&text));
    let of_limits = limits.and_then(|(limits, status)| of_limits(&limits, &status));
    let of_groups = read("/proc/self/cgroup").and_then(|groups| of_groups(&groups, Path::new("/sys/fs/cgroup")));
    [of_machine, of_limits, of_groups].into_iter().flatten().min()
}

/// The number of kB after `name` in a file of the system.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.trim_start_matches(':').split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

/// From `/proc/meminfo`: free memory, without that of other programs, and free swap.
fn of_machine(meminfo: &str) -> Option<u64> {
    Some(kilobytes(meminfo, "MemAvailable")? + kilobytes(meminfo, "SwapFree").unwrap_or(0))
}

/// From `/proc/self/limits` and `/proc/self/status`: what `ulimit -v` and `ulimit -d` leave.
fn of_limits(limits: &str, status: &str) -> Option<u64> {
    let left = |limit: &str, used: &str| {
        let limit = limits.lines().find_map(|line| line.strip_prefix(limit))?;
        // "unlimited" is no number.
        let limit: u64 = limit.split_whitespace().next()?.parse().ok()?;
        Some(limit.saturating_sub(kilobytes(status, used)?))
    };
    [left("Max address space", "VmSize"), left("Max data size", "VmData")].into_iter().flatten().min()
}

/// From `/proc/self/cgroup`: what its control group, and each group around that, leaves. `root`: the folder of the groups.
fn of_groups(groups: &str, root: &Path) -> Option<u64> {
    let left = groups.lines().flat_map(|line| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (kinds, path) = (parts.next().unwrap_or(""), parts.next().unwrap_or("/"));
        let (root, files) = match kinds {
            "" => (root.to_owned(), &SECOND),
            kinds if kinds.split(',').any(|kind| kind == "memory") => (root.join("memory"), &FIRST),
            _ => return Vec::new(),
        };
        // In a container the path may be that of the host; its own group is then the root.
        let folder = root.join(path.trim_start_matches('/'));
        let above = folder.ancestors().take_while(|folder| folder.starts_with(&root));
        above.filter_map(|folder| files.left(folder)).collect()
    });
    left.min()
}

/// Names of the files of a group.
struct Files {
    limit: &'static str,
    used: &'static str,
    /// In `memory.stat`: cached files, which yield memory when it is needed.
    copies: [&'static str; 2],
    swap: Option<[&'static str; 2]>,
}

const FIRST: Files = Files {
    limit: "memory.limit_in_bytes",
    used: "memory.usage_in_bytes",
    copies: ["total_inactive_file ", "total_active_file "],
    swap: None,
};

const SECOND: Files = Files {
    limit: "memory.max",
    used: "memory.current",
    copies: ["inactive_file ", "active_file "],
    swap: Some(["memory.swap.max", "memory.swap.current"]),
};

impl Files {
    fn left(&self, group: &Path) -> Option<u64> {
        let read = |name: &str| std::fs::read_to_string(PathBuf::from(group).join(name)).ok();
        let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
        // "max" is no number.
        let limit = number(self.limit)?;
        let stat = read("memory.stat").unwrap_or_default();
        let copies = self
            .copies
            .iter()
            .filter_map(|name| stat.lines().find_map(|line| line.strip_prefix(name))?.trim().parse::<u64>().ok());
        let used = number(self.used)?.saturating_sub(copies.sum());
        let swap = match self.swap {
            // A group without a swap limit may swap all of its memory.
            Some([limit, used]) => read(limit).map_or(0, |text| match text.trim().parse::<u64>() {
                Ok(limit) => limit.saturating_sub(number(used).unwrap_or(0)),
                Err(_) => u64::MAX,
            }),
            None => u64::MAX,
        };
        let swap = swap.min(swap_of_machine());
        Some(limit.saturating_sub(used).saturating_add(swap))
    }
}

fn swap_of_machine() -> u64 {
    let meminfo = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    kilobytes(&meminfo, "SwapFree").unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_machine_has_is_what_is_free_and_what_can_be_moved_out() {
        let meminfo = "MemTotal:  100 kB\nMemFree: 5 kB\nMemAvailable:   30 kB\nSwapFree:  7 kB\n";
        assert_eq!(of_machine(meminfo), Some(37 * 1024));
        assert_eq!(of_machine("MemAvailable:   30 kB\n"), Some(30 * 1024));
        assert_eq!(of_machine("MemTotal:  100 kB\n"), None, "an old kernel does not say");
    }

    #[test]
    fn limits_leave_what_is_not_taken_yet() {
        let limits = |space: &str, data: &str| {
            format!(
                "Limit  Soft Limit Hard Limit Units\nMax data size  {data}  unlimited bytes\nMax address space {space} 9 \
                 bytes\n"
            )
        };
        let status = "VmSize:\t   10 kB\nVmData:\t  4 kB\n";
        assert_eq!(of_limits(&limits("20480", "unlimited"), status), Some(10 * 1024));
        assert_eq!(of_limits(&limits("20480", "8192"), status), Some(4 * 1024));
        assert_eq!(of_limits(&limits("100", "unlimited"), status), Some(0), "already beyond");
        assert_eq!(of_limits(&limits("unlimited", "unlimited"), status), None);
    }

    #[test]
    fn a_group_leaves_what_the_narrowest_of_those_about_it_leaves() {
        let root = tempfile::tempdir().unwrap();
        let inner = root.path().join("work/job");
        std::fs::create_dir_all(&inner).unwrap();
        let write = |folder: &Path, name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
        let swap = swap_of_machine();
        write(&inner, "memory.max", "max\n");
        write(&inner, "memory.current", "500\n");
        let left = |groups: &str| of_groups(groups, root.path());
        assert_eq!(left("0::/work/job\n"), None, "nothing is limited");
        let outer = root.path().join("work");
        write(&outer, "memory.max", "5000\n");
        write(&outer, "memory.current", "1000\n");
        write(&outer, "memory.stat", "anon 600\ninactive_file 100\nactive_file 50\n");
        write(&outer, "memory.swap.max", "0\n");
        assert_eq!(left("0::/work/job\n"), Some(4150), "copies of files make room");
        write(&outer, "memory.swap.max", "max\n");
        assert_eq!(left("0::/work/job\n"), Some(4150 + swap));
        assert_eq!(left("3:cpu:/work/job\n"), None, "another kind of group");
        // Version 1, seen from inside a container: the path is that of the host.
        let first = root.path().join("memory");
        std::fs::create_dir_all(&first).unwrap();
        write(&first, "memory.limit_in_bytes", "900\n");
        write(&first, "memory.usage_in_bytes", "300\n");
        write(&first, "memory.stat", "total_inactive_file 10\ntotal_active_file 1\n");
        assert_eq!(left("4:cpuset,memory:/outside/there\n"), Some(611 + swap));
    }
}
