//! `table!` and `key!`.

/// A key of a table whose value is a field: `key!(TYPE.FIELD, DOC)`, followed by properties of a
/// [`Key`](super::key::Key), such as `range [0.0, 1.0]`, or by `part PART` for a field that is read from several keys.
macro_rules! key {
    ($type:ident . $field:ident, $doc:expr, part $part:expr) => { &$part };
    ($type:ident . $field:ident, $doc:expr $(, $fact:ident $value:expr)*) => {
        key!($type, stringify!($field), $doc $(, $fact $value)*, |entry| Some(&mut entry.$field))
    };
    ($type:ident, $name:expr, $doc:expr $(, $fact:ident $value:expr)*, |$entry:ident| $field:expr) => {
        &$crate::recipe::table::part::Field {
            key: $crate::recipe::table::key::Key {
                $($fact: Some($value),)*
                ..$crate::recipe::table::key::Key::new($name, $doc)
            },
            of: |$entry: &mut $type| $field,
        }
    };
}

/// Declares an entry of a list of tables: its struct, its defaults, and its keys as `PARTS`.
///
/// A key is a field, `name: TYPE = DEFAULT`, with a doc for both and the properties of `key!`. With `conditions and
/// mask DOC;` the entry has conditions, alternatives and a mask with this doc.
macro_rules! table {
    (
        $(#[doc = $doc:literal])+
        pub struct $name:ident;
        $( $(#[doc = $key_doc:literal])+ $key:ident: $type:ty = $default:expr $(, $fact:ident $value:expr)*; )+
        conditions and mask $mask:literal;
        $( $(#[doc = $last_doc:literal])+ $last:ident: $last_type:ty = $last_default:expr; )?
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            $( $(#[doc = $key_doc])+ pub $key: $type, )+
            /// Conditions that must all hold; their shares are multiplied.
            pub all: Vec<$crate::recipe::condition::document::Condition>,
            /// Alternatives, of which the largest share counts. If empty, only `all` counts.
            pub any: Vec<Vec<$crate::recipe::condition::document::Condition>>,
            #[doc = $mask]
            pub mask: orogen_ops::declare::Input,
            $( $(#[doc = $last_doc])+ pub $last: $last_type, )?
        }

        impl Default for $name {
            fn default() -> $name {
                let (all, any, mask) = (Vec::new(), Vec::new(), orogen_ops::declare::Input::None);
                $name { $($key: $default,)+ all, any, mask, $($last: $last_default)? }
            }
        }

        impl $name {
            /// Its keys.
            pub(crate) const PARTS: &'static [&'static dyn $crate::recipe::table::part::Part<$name>] = &[
                $( key!($name.$key, concat!($($key_doc, "\n"),+) $(, $fact $value)*), )+
                &$crate::recipe::condition::part::Where {
                    mask: $crate::recipe::table::key::Key::new("mask", $mask),
                    of: $name::conditions,
                },
                $( key!($name.$last, concat!($($last_doc, "\n"),+)), )?
            ];

            /// Its conditions.
            pub(in crate::recipe) fn conditions(&mut self) -> $crate::recipe::condition::part::Conditions<'_> {
                let $name { all, any, mask, .. } = self;
                $crate::recipe::condition::part::Conditions { all, any, mask }
            }
        }
    };
}
