//! Regions: hair of one moves as all hair would under its settings, and other hair does not notice it.

mod common;

use common::{
    bits, exact, fast, field, free, free_motion, hair, run, run_under, twins_apart, way_of_a_head, wind,
    with_neighbours,
};
use std::sync::Arc;

use glam::Vec3;
use nabiki::Profile;
use nabiki::body::{Body, Contact};
use nabiki::dynamics::{Dynamics, Reference, Simulation};
use nabiki::field::{Field, FieldSum, Turbulence, TurbulenceField};
use nabiki::free_form::{FreeForm, FreeMotion};
use nabiki::region::{FieldShare, Members, Region};
use nabiki_groom::bust;

const FRAMES: u32 = 40;

/// All of a head.
fn everywhere() -> Region {
    Region { near: Some(Vec3::ZERO), within: 100.0, soft: 0.0, ..Region::default() }
}

/// The half of a head with z > 0, but for a border.
fn left() -> Region {
    Region { near: Some(Vec3::new(0.0, 0.0, 100.0)), within: 98.0, soft: 4.0, ..Region::default() }
}

fn with(regions: Vec<Region>) -> FreeForm {
    FreeForm { regions, ..FreeForm::default() }
}

/// Factors are powers of 2, so that either way of multiplying rounds alike.
#[test]
fn hair_of_a_region_moves_as_all_hair_does_under_its_settings() {
    let strands = hair(20, 12);
    let form = FreeForm { hold: Profile::Even(32.0), ..FreeForm::default() };
    let changed = FreeForm {
        stiffness: Profile::RootToTip(vec![24_000.0, 2000.0]),
        hold: Profile::RootToTip(vec![32.0, 128.0]),
        settle: Profile::Even(10.0),
        drag: Profile::Even(2.0),
        ..form.clone()
    };
    let region = Region {
        stiffness: 2.0.into(),
        hold: Profile::RootToTip(vec![1.0, 4.0]),
        settle: 0.5.into(),
        drag: 2.0.into(),
        ..everywhere()
    };
    let regional = FreeForm { regions: vec![region], ..form };
    let poses = way_of_a_head(FRAMES);
    let motion = |form: &FreeForm| {
        let bodies = vec![Body::head(&bust(), Contact::default())];
        let dynamics = free_motion(FreeMotion { form: form.clone(), bodies, ..FreeMotion::default() });
        let exact = run_under(&mut exact(&strands, &dynamics, &wind()), &wind(), &poses);
        (bits(&exact), bits(&run_under(&mut fast(&strands, &dynamics, &wind()), &wind(), &poses)))
    };
    assert_eq!(motion(&regional), motion(&changed));
}

#[test]
fn a_share_of_the_wind_is_a_wind_of_that_share() {
    let strands = hair(20, 12);
    let half = field(&[(50, [-50.0, 0.0, 0.0]), (100, [-7.5, -75.0, 0.0])]);
    let regional = free(with(vec![Region { wind: 0.5, ..everywhere() }]));
    let plain = free(FreeForm::default());
    let exact_of = |dynamics, wind| bits(&run(&mut exact(&strands, dynamics, wind), wind, FRAMES));
    assert_eq!(exact_of(&regional, &wind()), exact_of(&plain, &half));
    let fast_of = |dynamics, wind| bits(&run(&mut fast(&strands, dynamics, wind), wind, FRAMES));
    assert_eq!(fast_of(&regional, &wind()), fast_of(&plain, &half));
}

#[test]
fn hair_outside_keeps_its_bits_and_hair_that_no_wind_moves_rests_to_the_bit() {
    let strands = hair(60, 12);
    let still = Region { wind: 0.0, ..left() };
    let without = run(&mut fast(&strands, &free(FreeForm::default()), &wind()), &wind(), FRAMES);
    let together = run(&mut fast(&strands, &free(with(vec![still.clone()])), &wind()), &wind(), FRAMES);
    let calm = field(&[(FRAMES, [0.0; 3])]);
    let at_rest = run(&mut fast(&strands, &free(FreeForm::default()), &calm), &calm, FRAMES);
    let (mut inside, mut outside) = (0, 0);
    for s in 0..strands.len() {
        match still.weight(strands.strand(s)[0]) {
            1.0 => {
                assert_eq!(together.strand(s), at_rest.strand(s), "{s}");
                inside += 1;
            }
            0.0 => {
                assert_eq!(together.strand(s), without.strand(s), "{s}");
                outside += 1;
            }
            _ => {}
        }
    }
    assert!(inside > 10 && outside > 10, "{inside} in, {outside} out");
}

fn swirls() -> Arc<dyn Field> {
    let settings = Turbulence { strength: 60.0, drift: 0.0, ..Turbulence::default() };
    Arc::new(TurbulenceField::new(&settings, common::HEAD, &[], &[]).unwrap())
}

fn both(wind: Arc<dyn Field>, swirls: Arc<dyn Field>) -> FieldSum {
    FieldSum::named(vec![("wind".to_owned(), wind), ("turbulence".to_owned(), swirls)])
}

fn share(field: &str, share: f32) -> FieldShare {
    FieldShare { field: field.to_owned(), share }
}

/// A share of 0 takes a field away, one of 1 leaves all bits, and one of a half is a field half as strong: factors that are
/// powers of 2 round alike.
#[test]
fn a_share_of_one_field_is_that_field_at_that_strength() {
    let strands = hair(20, 12);
    let half = field(&[(50, [-50.0, 0.0, 0.0]), (100, [-7.5, -75.0, 0.0])]);
    let sum = both(Arc::new(wind()), swirls());
    let with = |fields: Vec<FieldShare>| free(with(vec![Region { fields, ..everywhere() }]));
    let motion = |dynamics: &Dynamics, field: &dyn Field| {
        let exact = bits(&run(&mut exact(&strands, dynamics, field), field, FRAMES));
        (exact, bits(&run(&mut fast(&strands, dynamics, field), field, FRAMES)))
    };
    let plain = free(FreeForm::default());
    assert_eq!(motion(&with(vec![share("wind", 1.0), share("turbulence", 1.0)]), &sum), motion(&plain, &sum));
    assert_eq!(motion(&with(vec![share("turbulence", 0.0)]), &sum), motion(&plain, &wind()));
    assert_eq!(motion(&with(vec![share("wind", 0.0)]), &sum), motion(&plain, &*swirls()));
    let halved = both(Arc::new(half), swirls());
    assert_eq!(motion(&with(vec![share("wind", 0.5)]), &sum), motion(&plain, &halved));
    // Of a uniform field alone, too.
    let alone = FieldSum::named(vec![("wind".to_owned(), Arc::new(wind()) as Arc<dyn Field>)]);
    let quarter = field(&[(50, [-25.0, 0.0, 0.0]), (100, [-3.75, -37.5, 0.0])]);
    assert_eq!(motion(&with(vec![share("wind", 0.5), share("wind", 0.5)]), &alone), motion(&plain, &quarter));
}

#[test]
fn a_share_in_a_field_that_is_not_there_is_refused() {
    let dynamics = free(with(vec![Region { fields: vec![share("fan[3]", 0.5)], ..left() }]));
    let strands = hair(4, 12);
    let refused = |field: &dyn Field| Simulation::new(&strands, &dynamics, field).err().unwrap().to_string();
    let both = both(Arc::new(wind()), swirls());
    let line = refused(&both);
    assert_eq!(Reference::new(&strands, &dynamics, &both).err().unwrap().to_string(), line);
    assert_eq!(
        line,
        "free.regions[0].fields[0].field = \"fan[3]\": no such field: use one of wind, turbulence, or remove it"
    );
    assert!(refused(&wind()).contains("no such field: remove it"), "{}", refused(&wind()));
}

/// Hair of half the weight moves as all hair does under half of the gravity, on a head that turns it over, and keeps from the head
/// what a margin half as large keeps.
#[test]
fn weight_and_margin_are_factors_on_the_settings() {
    let strands = hair(20, 12);
    let poses = way_of_a_head(FRAMES);
    let motion = |form: FreeForm, margin: f32| {
        let bodies = vec![Body::head(&bust(), Contact { margin, ..Contact::default() })];
        let dynamics = free_motion(FreeMotion { form, bodies, ..FreeMotion::default() });
        let exact = run_under(&mut exact(&strands, &dynamics, &wind()), &wind(), &poses);
        (bits(&exact), bits(&run_under(&mut fast(&strands, &dynamics, &wind()), &wind(), &poses)))
    };
    let region = Region { gravity: 0.5, margin: 2.0, ..everywhere() };
    // Steps are counted for the heaviest hair.
    let form = FreeForm { gravity: 64.0, substeps: Some(4), ..FreeForm::default() };
    let regional = motion(FreeForm { regions: vec![region], ..form.clone() }, 0.25);
    assert_eq!(regional, motion(FreeForm { gravity: 32.0, ..form.clone() }, 0.5));
    assert_ne!(regional, motion(form, 0.25));
}

#[test]
fn regions_that_keep_hair_farther_than_a_contact_may_are_refused() {
    let bodies = vec![Body::head(&bust(), Contact { margin: 1.0, ..Contact::default() })];
    let regions = |margin| vec![Region { margin, ..left() }];
    let check =
        |margin| FreeMotion { form: with(regions(margin)), bodies: bodies.clone(), ..Default::default() }.check(9);
    assert_eq!(check(5.0), Ok(()));
    let line = check(6.0).unwrap_err().to_string();
    assert!(
        line.starts_with("free.regions[0].margin = 6: ") && line.contains("multiply contact.margin to 6 cm"),
        "{line}"
    );
}

/// The region is of the place of a root, so a few strands move as they do among all.
#[test]
fn a_subset_moves_as_it_does_within_the_whole() {
    let strands = hair(60, 12);
    let dynamics = free(with(vec![Region { hold: 5.0.into(), wind: 0.3, ..left() }]));
    let all = run(&mut fast(&strands, &dynamics, &wind()), &wind(), FRAMES);
    let few: Vec<usize> = (0..60).step_by(7).collect();
    let alone = run(&mut fast(&strands.select(&few), &dynamics, &wind()), &wind(), FRAMES);
    assert_eq!(bits(&alone), bits(&all.select(&few)));
}

/// Members with the weights of a place move as the place does; hair that is no member does not notice it.
#[test]
fn members_move_as_a_place_of_their_weights() {
    let strands = hair(60, 12);
    let place = Region { hold: 4.0.into(), wind: 0.5, soft: 0.0, ..left() };
    let roots = || strands.iter().map(|strand| strand[0]);
    let inside = roots().filter(|&root| place.weight(root) == 1.0).count();
    assert!(inside > 10 && inside < 50, "{inside}");
    let of_a_group = Region { near: None, groups: vec!["left".to_owned()], ..place.clone() };
    let members = Members::new(roots().map(|root| (root, place.weight(root) as f32)));
    let free = |region: &Region, members: Vec<Option<Members>>| {
        free_motion(FreeMotion { form: with(vec![region.clone()]), members, ..FreeMotion::default() })
    };
    let [by_place, by_group] = [free(&place, Vec::new()), free(&of_a_group, vec![Some(members)])];
    let motion = |dynamics| {
        let exact = run(&mut exact(&strands, dynamics, &wind()), &wind(), FRAMES);
        (bits(&exact), bits(&run(&mut fast(&strands, dynamics, &wind()), &wind(), FRAMES)))
    };
    assert_eq!(motion(&by_place), motion(&by_group));
    let refused = free(&of_a_group, Vec::new()).check().unwrap_err().to_string();
    assert!(refused.starts_with("free.regions[0] "), "{refused}");
}

/// As without: see `the_twins_agree`.
#[test]
fn the_twins_agree_on_regions() {
    let (strands, wind) = (hair(96, 18), wind());
    let along = Region { to: Some(Vec3::new(0.0, 11.0, -9.0)), within: 3.0, soft: 5.0, wind: 1.5, ..left() };
    let fields = vec![share("turbulence", 0.3), share("wind", 1.2)];
    let regions = vec![
        Region { hold: 3.0.into(), stiffness: 1.7.into(), drag: 0.3.into(), gravity: 0.4, ..left() },
        Region { fields, gravity: 1.5, ..along },
    ];
    let dynamics = free(with(regions));
    let wind = both(Arc::new(wind), swirls());
    // Of 93 strands, so that there are lanes without one; carriers belong to regions, too.
    let (strands, dynamics) = (strands.select(&(0..93).collect::<Vec<_>>()), with_neighbours(dynamics));
    let apart = twins_apart(&strands, &dynamics, &wind, 100);
    let most = apart.len() - 1;
    assert!(apart[most - apart.len() / 1000] < 1e-3 && apart[most] < 1e-2, "{:e}", apart[most]);
}

#[test]
fn a_refusal_names_the_region_that_multiplies_the_force() {
    let strands = hair(20, 12);
    let region = |wind: f32| Region { wind, ..everywhere() };
    // Half of what holds without a region.
    let most = fast(&strands, &free(with(Vec::new())), &wind()).strongest_force();
    let strong = field(&[(100, [-0.5 * most, 0.0, 0.0])]);
    let refused = |wind: f32| {
        Simulation::new(&strands, &free(with(vec![region(wind)])), &strong).err().map(|refused| refused.to_string())
    };
    assert_eq!(refused(1.0), None);
    let line = refused(10.0).unwrap();
    assert!(line.contains("lower free.regions[0].wind = 10, which multiplies the force there"), "{line}");
}
