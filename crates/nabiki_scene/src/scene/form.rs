//! `motion.form`: the equations that move the hair.

use nabiki::dynamics::Motion;
use nabiki::{settings, words};
use toml::Table;

use super::flat;
use super::read::Refusal;
use super::tree::{Unwritable, table_of};

words! {
    /// The equations of the motion.
    pub enum FormChoice = Paper {
        /// The equations of 1993: two angles per segment.
        Paper = "paper",
        /// The free form: hair returns to rest, keeps out of bodies and follows a moving head.
        Free = "free",
    }
}

settings! {
    /// The key of `[motion]` that does not belong to the method.
    pub(crate) struct FormKey {
        /// The equations of the motion.
        form: FormChoice = FormChoice::Paper => "Form";
    }
}

/// Reads the table `[motion]`.
pub(super) fn read_motion(table: &Table) -> Result<(Motion, FormChoice), Refusal> {
    let (motion, FormKey { form }) = flat::read(table, &[], "")?;
    Ok((motion, form))
}

/// The table `[motion]`, for writing.
pub(super) fn motion_table(motion: &Motion, form: FormChoice) -> Result<Table, Unwritable> {
    let mut table = table_of(motion)?;
    table.extend(table_of(&FormKey { form })?);
    Ok(table)
}
