use super::*;
use crate::free_form::FreeForm;
use crate::profile::Profile;
use crate::settings;

settings! {
    /// One setting of its own, and one of another struct.
    struct Sharing {
        /// Its own.
        own: f32 = 1.0 => "Own", unit "cm", most 2.0;
        /// How firmly this one is held.
        hold: Profile => of FreeForm;
    }
}

#[test]
fn a_setting_of_another_struct_is_as_that_one_declares_it_but_for_its_help() {
    let [_, shared] = Sharing::TABLE.settings else { panic!() };
    let declared = FreeForm::TABLE.settings.iter().find(|declared| declared.key == "hold").unwrap();
    let said = |of: &Setting| format!("{} {:?} {:?} {:?}", of.label, of.kind, of.range, (of.default)());
    assert_eq!(said(shared), said(declared));
    assert_eq!(plain(shared.help), "How firmly this one is held.");
    assert_eq!(Sharing::default().hold, FreeForm::default().hold);
    let hold = Profile::Even(-1.0);
    let declared = FreeForm { hold: hold.clone(), ..FreeForm::default() }.check().unwrap_err();
    assert_eq!(Sharing { hold, ..Sharing::default() }.check_at("free").unwrap_err(), declared);
}

#[test]
fn keys_are_written_as_they_are_read() {
    for text in ["motion.frames", "force[1].vector", "hair.style.cuts[0].normal[2]", "own[3]", "--strands", ""] {
        assert_eq!(Key::from(text).to_string(), text);
        assert_eq!(Key::from(text), text);
    }
    assert_eq!(Key::from("force.1.vector.0").to_string(), "force[1].vector[0]");
    let key = Key::from("force[1].vector[0]");
    assert!(key.is_within(&"force".into()) && key.is_within(&"force[1]".into()) && !key.is_within(&"force[0]".into()));
    assert_eq!(key.last_name(), "vector");
}

#[test]
fn a_default_is_in_its_range_and_the_table_says_it() {
    assert_eq!(FreeForm::default().check(), Ok(()));
    let Datum::Table(values) = FreeForm::default().datum() else { panic!() };
    for (setting, (key, value)) in FreeForm::TABLE.settings.iter().zip(values) {
        assert_eq!((setting.key, (setting.default)()), (key, value));
    }
}

#[test]
fn a_number_of_32_bits_has_no_more_digits_than_it_takes() {
    assert_eq!(0.1_f32.datum(), Datum::Number(0.1));
    assert_eq!(f32::MAX.datum(), Datum::Number(3.4028235e38));
}

#[test]
fn what_is_out_of_its_range_is_refused_by_its_place_in_the_words_of_the_range() {
    let at = Place::Table("fan[0]");
    let range = |above, least, most| Range { unit: "", above, least, most };
    let said = |value: &dyn Fn(&Place) -> Result<(), SettingError>| value(&at.key("x")).unwrap_err().to_string();
    let (low, none) = (range(None, Some(0.5), Some(20.0)), range(None, None, None));
    assert_eq!(said(&|at| 0.1_f32.check(at, &low)), "fan[0].x = 0.1: must lie in 0.5..20");
    assert_eq!(said(&|at| f32::NAN.check(at, &none)), "fan[0].x = NaN: must be a finite number");
    assert_eq!(said(&|at| vec![1.0_f32, 30.0].check(at, &low)), "fan[0].x[1] = 30: must lie in 0.5..20");
    assert_eq!(said(&|at| 0_u32.check(at, &range(None, Some(1.0), None))), "fan[0].x = 0: must be at least 1");
    assert_eq!(said(&|at| 9_u32.check(at, &range(None, Some(1.0), Some(8.0)))), "fan[0].x = 9: must lie in 1..8");
    // Bounds are those of the type: 0.1 of 32 bits is a little more than that of 64.
    assert_eq!(0.1_f32.check(&at, &range(None, None, Some(0.1))), Ok(()));
    assert!(0.1_f32.check(&at, &range(Some(0.1), None, None)).is_err());
}

#[test]
fn a_doc_comment_is_plain_text() {
    let help = " One [`Key`](Self::new) of\n two [`lines`].\n\n See `[[force]]`.\n";
    assert_eq!(plain(help), "One `Key` of two `lines`.\n\nSee `[[force]]`.");
}
