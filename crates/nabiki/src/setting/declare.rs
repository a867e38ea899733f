//! The macros that declare settings.

/// Declares a struct of settings.
///
/// Each setting has a doc comment, whose first sentence is the help in a panel. Then come key, type and default, and
/// after the arrow the label and these options, in this order:
///
/// - `must "EXAMPLE"` for a required setting; its default is then what a new table starts with
/// - `unit "cm"`
/// - `above`, `least` and `most`, which bound each of its numbers
/// - `open "WHAT"`, what applies if it is left out
///
/// `pub KEY: TYPE => of STRUCT;` repeats the setting that STRUCT declares under this key: default, label, unit and
/// range are taken from there, the help is its own. `pub KEY: TYPE = DEFAULT => of STRUCT;` does this with another
/// type. `in "TABLE"` names the table of the struct, if it always has the same name, and adds `check()`. `where RULE`
/// names a method that refuses what no range can express: `fn RULE(&self, at: &Place) -> Result<(), SettingError>`.
///
/// ```
/// use nabiki::setting::{Settings, plain};
///
/// nabiki::settings! {
///     /// How long hair takes.
///     pub struct Wetness in "wetness" {
///         /// How much water hair holds. Dry hair holds none.
///         pub water: f32 = 0.5 => "Water", unit "g", least 0.0, most 10.0;
///     }
/// }
///
/// assert_eq!(Wetness { water: -1.0 }.check().unwrap_err().to_string(), "wetness.water = -1: must lie in 0..10");
/// assert_eq!(plain(Wetness::TABLE.settings[0].help), "How much water hair holds. Dry hair holds none.");
/// ```
#[macro_export]
macro_rules! settings {
    (
        $(#[doc = $doc:expr])*
        $(#[derive($($derive:ident),*)])?
        $vis:vis struct $name:ident $(in $place:literal)? $(where $rule:ident)? {
            $(
                $(#[doc = $help:expr])*
                $(#[serde($($serde:tt)*)])?
                $field_vis:vis $key:ident: $type:ty $(= $default:expr)? => $($label:literal)? $(of $of:ident)?
                    $(, must $must:literal)? $(, unit $unit:literal)?
                    $(, above $above:expr)? $(, least $least:expr)? $(, most $most:expr)? $(, open $open:literal)?;
            )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize $($(, $derive)*)?)]
        $vis struct $name {
            $(
                $(#[doc = $help])*
                $(#[doc = concat!("\n\nUnit: ", $unit, ".")])?
                $(#[serde($($serde)*)])? $field_vis $key: $type,
            )*
        }

        impl ::std::default::Default for $name {
            fn default() -> Self {
                Self { $($key: $crate::settings!(@default $key [$($default)?] [$($of)?])),* }
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $name {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> ::std::result::Result<Self, D::Error> {
                #[derive(::serde::Deserialize)]
                #[serde(deny_unknown_fields)]
                struct Given {
                    $(#[serde(default)] $key: ::std::option::Option<$type>,)*
                }
                let given = Given::deserialize(deserializer)?;
                Ok(Self {
                    $($key: match given.$key {
                        Some(value) => value,
                        None => $crate::settings!(@absent $key [$($default)?] [$($of)?] $(, $must)?),
                    },)*
                })
            }
        }

        impl $crate::setting::Value for $name {
            const KIND: $crate::setting::Kind =
                $crate::setting::Kind::Table(&<Self as $crate::setting::Settings>::TABLE);

            fn check(
                &self,
                at: &$crate::setting::Place,
                _: &$crate::setting::Range,
            ) -> ::std::result::Result<(), $crate::SettingError> {
                $($crate::setting::Value::check(
                    &self.$key,
                    &at.key(stringify!($key)),
                    &$crate::settings!(@range $key [$($of)?] [$($unit)?] [$($above)?] [$($least)?] [$($most)?]),
                )?;)*
                $(self.$rule(at)?;)?
                Ok(())
            }

            fn datum(&self) -> $crate::setting::Datum {
                $crate::setting::Datum::Table(vec![$((stringify!($key), $crate::setting::Value::datum(&self.$key))),*])
            }
        }

        impl $crate::setting::Settings for $name {
            const TABLE: $crate::setting::Table = $crate::setting::Table {
                name: stringify!($name),
                help: concat!($($doc, "\n"),*),
                settings: &[$($crate::setting::Setting {
                    key: stringify!($key),
                    label: $crate::settings!(@label $key [$($label)?] [$($of)?]),
                    help: concat!($($help, "\n"),*),
                    kind: <$type as $crate::setting::Value>::KIND,
                    range: $crate::settings!(@range $key [$($of)?] [$($unit)?] [$($above)?] [$($least)?] [$($most)?]),
                    default: || {
                        let default: $type = $crate::settings!(@default $key [$($default)?] [$($of)?]);
                        $crate::setting::Value::datum(&default)
                    },
                    must: $crate::settings!(@maybe $($must)?),
                    open: $crate::settings!(@maybe $($open)?),
                }),*],
            };
        }

        $crate::settings!(@check $name $($place)?);
    };

    (@default $key:ident [$default:expr] [$($of:ident)?]) => { $default };
    (@default $key:ident [] [$of:ident]) => { <$of as ::std::default::Default>::default().$key };
    (@absent $key:ident $default:tt $of:tt) => { $crate::settings!(@default $key $default $of) };
    (@absent $key:ident $default:tt $of:tt, $must:literal) => {
        return Err(::serde::de::Error::missing_field(stringify!($key)))
    };
    (@maybe) => { ::std::option::Option::None };
    (@maybe $given:expr) => { ::std::option::Option::Some($given) };
    (@label $key:ident [$label:literal] []) => { $label };
    (@label $key:ident [] [$of:ident]) => { $crate::settings!(@declared $key $of).label };
    (@declared $key:ident $of:ident) => {
        const { <$of as $crate::setting::Settings>::TABLE.setting(stringify!($key)) }
    };
    (@range $key:ident [$of:ident] [] [] [] []) => { $crate::settings!(@declared $key $of).range };
    (@range $key:ident [] [$($unit:literal)?] [$($above:expr)?] [$($least:expr)?] [$($most:expr)?]) => {
        $crate::setting::Range {
            unit: concat!($($unit)?),
            above: $crate::settings!(@maybe $($above)?),
            least: $crate::settings!(@maybe $($least)?),
            most: $crate::settings!(@maybe $($most)?),
        }
    };
    (@check $name:ident) => {
        impl $name {
            /// Refuses values out of range. `name` is the name of the table.
            ///
            /// # Errors
            /// Names the first such setting.
            pub fn check_at(&self, name: &str) -> ::std::result::Result<(), $crate::SettingError> {
                $crate::setting::Value::check(
                    self,
                    &$crate::setting::Place::Table(name),
                    &$crate::setting::Range::default(),
                )
            }
        }
    };
    (@check $name:ident $place:literal) => {
        impl $name {
            /// Refuses values out of range.
            ///
            /// # Errors
            /// Names the first such setting.
            pub fn check(&self) -> ::std::result::Result<(), $crate::SettingError> {
                $crate::setting::Value::check(
                    self,
                    &$crate::setting::Place::Table($place),
                    &$crate::setting::Range::default(),
                )
            }
        }
    };
}

/// Declares an enum whose variants are the words of a setting, each with a doc comment and its word. `= VARIANT` names
/// the default.
///
/// ```
/// nabiki::words! {
///     /// How hair dries.
///     pub enum Drying = Slow {
///         /// In the air.
///         Slow = "slow",
///         /// In a warm wind.
///         Fast = "fast",
///     }
/// }
///
/// assert_eq!(Drying::default().word(), "slow");
/// ```
#[macro_export]
macro_rules! words {
    (
        $(#[doc = $doc:expr])*
        $vis:vis enum $name:ident $(= $default:ident)? {
            $($(#[doc = $help:expr])* $(#[serde($($serde:tt)*)])? $variant:ident = $word:literal,)*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, ::serde::Deserialize, ::serde::Serialize)]
        $vis enum $name {
            $($(#[doc = $help])* $(#[serde($($serde)*)])? #[serde(rename = $word)] $variant,)*
        }

        $(impl ::std::default::Default for $name {
            fn default() -> Self {
                Self::$default
            }
        })?

        impl $name {
            /// The word in a scene file.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)*
                }
            }
        }

        impl $crate::setting::Value for $name {
            const KIND: $crate::setting::Kind = $crate::setting::Kind::Words(&[
                $($crate::setting::Word { word: $word, help: concat!($($help, "\n"),*) },)*
            ]);

            fn check(
                &self,
                _: &$crate::setting::Place,
                _: &$crate::setting::Range,
            ) -> ::std::result::Result<(), $crate::SettingError> {
                Ok(())
            }

            fn datum(&self) -> $crate::setting::Datum {
                $crate::setting::Datum::Text(self.word().to_owned())
            }
        }
    };
}
