//! The hairstyle: how a strand leaves its pore, bends, lies on the head, hangs and is cut (method section 4).

pub mod cantilever;
