use crate::actions::Action;
use crate::command::Command;
use crate::document::Phase;
use crate::session::tests::Place;

/// A head of a unit box and a strand beside it, in files without a unit.
fn imported(hair_unit: &str) -> Place {
    let place = Place::new();
    let write = |name: &str, text: &str| std::fs::write(place.0.path().join(name), text).unwrap();
    let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|side: i32| (2 * side - 1) * 9));
    let corners: String = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    write("head.obj", &(corners + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"));
    write("lock.obj", "v 0 9 0\nv 1 11 0\nv 1 13 0\nl 1 2 3\n");
    let head = "[head]\nmesh = \"head.obj\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [0, 0, 0]\n\
                ellipsoid = { center = [0.0, 0.0, 0.0], half_axes = [9.0, 9.0, 9.0] }\n";
    let hair = format!("[hair]\nfile = \"lock.obj\"\n{hair_unit}");
    let motion =
        "[motion]\nform = \"free\"\nframes = 2\n[free]\nstiffness = 300\n[[force]]\nthrough = 2\nvector = [1, 0, 0]\n";
    std::fs::write(place.file(), format!("{head}{hair}{motion}")).unwrap();
    place
}

#[test]
fn a_head_of_another_unit_says_what_its_hair_has_done_until_it_has_its_size_again() {
    for (hair_unit, wanted) in
        [("", "10 times as large, from 4.24 cm"), ("unit = \"cm\"\n", "keeps its length, 4.24 cm")]
    {
        let place = imported(hair_unit);
        let mut session = place.session();
        assert_eq!(session.trouble(), None);
        let said = |session: &crate::session::Session| {
            session.words().iter().map(|word| word.text.clone()).collect::<Vec<_>>()
        };
        assert!(said(&session).is_empty());
        for unit in ["dm", "m", "dm"] {
            let set = Command::Set { key: "head.unit".to_owned(), value: Some(unit.into()), phase: Phase::Done };
            session.apply(set);
            session.wait();
            let said = said(&session);
            let times =
                if unit == "dm" { "The head is 10 times as large now, 180 cm high" } else { "The head is 100 times" };
            assert!(matches!(&said[..], [said] if said.starts_with(times)), "{said:?}");
            assert!(unit == "m" || said[0].contains(wanted), "{said:?}");
        }
        session.tick(60.0, 0.0);
        assert_eq!(said(&session).len(), 1, "it stays until it is read");
        while session.document().unwrap().undo_name().is_some() {
            session.apply(Command::Act(Action::Undo));
            session.wait();
        }
        assert!(said(&session).is_empty(), "{:?}", said(&session));
    }
}
