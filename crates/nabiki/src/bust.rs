//! The built-in bust, for tests. Its reader is in `nabiki_groom`, whose `Head` belongs to another copy of this crate here.

#[path = "../../nabiki_groom/src/bust/head.rs"]
mod head;
#[path = "../../nabiki_groom/src/bust/layout.rs"]
mod layout;
#[path = "../../nabiki_groom/src/bust/numbers.rs"]
mod numbers;
#[path = "../../nabiki_groom/src/bust/read.rs"]
mod read;

pub(crate) use head::bust;
