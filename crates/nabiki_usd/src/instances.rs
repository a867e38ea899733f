//! Prototypes of point instancers, which USD draws at the instances and not where they stand: they are left out, which is said.

use crate::opened::Layer;

/// The prims of type `wanted` and of a path that `is_meant` which are left out as prototypes, a phrase for each instancer.
pub fn unread(layer: &Layer, wanted: &str, is_meant: &dyn Fn(&str) -> bool) -> Vec<String> {
    let all = 0..layer.prims.len();
    let meant = all.filter(|&i| layer.prims[i].type_name == wanted && layer.is_defined(i) && is_meant(&layer.path(i)));
    let mut by: Vec<usize> = meant.filter_map(|prim| layer.instancer(prim)).collect();
    by.dedup();
    let line = |by: usize| {
        format!(
            "the prototypes of PointInstancer {}, drawn only at its instances: turn these into prims first",
            layer.path(by)
        )
    };
    by.into_iter().map(line).collect()
}
