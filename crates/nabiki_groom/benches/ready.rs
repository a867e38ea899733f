//! How long it takes until there is hair to move: `cargo bench -p nabiki_groom --bench ready`.
//!
//! The built-in head, and the gust's number of strands in the default style: all of them, and the first 300. Each is the
//! best of five, in milliseconds.

use std::time::Instant;

use nabiki::Head;
use nabiki_groom::roots::spread_first;
use nabiki_groom::{Growth, Hairline, Style, bust, grow};

fn best_of_five<T>(name: &str, work: impl Fn() -> T) {
    let time = |_| {
        let start = Instant::now();
        let done = work();
        let taken = start.elapsed();
        drop(done);
        taken
    };
    let best = (0..5).map(time).min().expect("five times");
    println!("{name:40} {:8.1}", best.as_secs_f64() * 1e3);
}

fn main() {
    let (hairline, style) = (Hairline::default(), Style::default());
    best_of_five("built-in head", bust);
    let head = bust();
    best_of_five("the same mesh as any other head", || Head::from_mesh(head.mesh.clone(), Some(head.ellipsoid)));
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 19_330, segments: 18, segment_length: 1.0, seed: 1 };
    for shown in [300, 19_330] {
        best_of_five(&format!("roots, {shown} of 19330"), || spread_first(&head, &hairline, 19_330, shown, 1));
        best_of_five(&format!("roots and hair, {shown} of 19330"), || grow(&head, &growth, shown));
    }
    best_of_five("built-in head and 300 of 19330 strands", || grow(&bust(), &growth, 300));
}
