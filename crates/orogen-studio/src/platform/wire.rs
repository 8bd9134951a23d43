//! How values of other crates are sent to another instance of the program: modules for `#[serde(with = ...)]`.

use std::borrow::Cow;
use std::collections::HashSet;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use orogen::recipe::Recipe;
use orogen::{Error, ErrorKind, Registry};
use serde::de::{Error as _, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Bytes, in one piece.
pub mod bytes {
    use super::*;

    struct Bytes;

    impl Visitor<'_> for Bytes {
        type Value = Vec<u8>;

        fn expecting(&self, text: &mut std::fmt::Formatter) -> std::fmt::Result {
            text.write_str("bytes")
        }

        fn visit_bytes<E>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
            Ok(bytes.to_vec())
        }
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<S: Serializer>(bytes: &[u8], to: S) -> Result<S::Ok, S::Error> {
        to.serialize_bytes(bytes)
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u8>, D::Error> {
        from.deserialize_bytes(Bytes)
    }
}

/// A shared value, which is no longer shared in the other instance.
pub mod shared {
    use super::*;

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<T: Serialize, S: Serializer>(value: &Arc<T>, to: S) -> Result<S::Ok, S::Error> {
        T::serialize(value, to)
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Arc<T>, D::Error> {
        T::deserialize(from).map(Arc::new)
    }
}

/// A shared value or none.
pub mod shared_option {
    use super::*;

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<T: Serialize, S: Serializer>(value: &Option<Arc<T>>, to: S) -> Result<S::Ok, S::Error> {
        value.as_deref().serialize(to)
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Option<Arc<T>>, D::Error> {
        Ok(Option::deserialize(from)?.map(Arc::new))
    }
}

/// Shared values.
pub mod shared_list {
    use super::*;

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<T: Serialize, S: Serializer>(values: &[Arc<T>], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(values.iter().map(|value| &**value))
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Vec<Arc<T>>, D::Error> {
        Ok(Vec::deserialize(from)?.into_iter().map(Arc::new).collect())
    }
}

/// A text of a few that the program has, such as a unit.
pub mod word {
    use super::*;

    static KNOWN: Mutex<Option<HashSet<&'static str>>> = Mutex::new(None);

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<S: Serializer>(word: &str, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(word)
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<&'static str, D::Error> {
        let word = Cow::<str>::deserialize(from)?;
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let known = known.get_or_insert_default();
        Ok(match known.get(&*word) {
            Some(word) => word,
            None => {
                // There are as many as the program has units.
                let word: &'static str = word.into_owned().leak();
                known.insert(word);
                word
            }
        })
    }
}

/// A recipe, as its text. The names of its files are absolute in both instances.
pub mod recipe {
    use super::*;

    /// The folder that relative names of files start in.
    const FOLDER: &str = "/";

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<S: Serializer>(recipe: &Recipe, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&recipe.to_toml())
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Recipe, D::Error> {
        let text = Cow::<str>::deserialize(from)?;
        let mut recipe = Registry::new().parse(&text, "recipe").map_err(D::Error::custom)?;
        recipe.set_base_dir(Path::new(FOLDER));
        Ok(recipe)
    }
}

/// Several recipes.
pub mod recipes {
    use super::*;

    #[derive(Serialize, Deserialize)]
    struct One(#[serde(with = "recipe")] Recipe);

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<S: Serializer>(recipes: &[Recipe], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(recipes.iter().cloned().map(One))
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Recipe>, D::Error> {
        Ok(Vec::<One>::deserialize(from)?.into_iter().map(|one| one.0).collect())
    }
}

/// An error: its kind and its message.
pub mod error {
    use super::*;

    const KINDS: [ErrorKind; 7] = [
        ErrorKind::Internal,
        ErrorKind::Recipe,
        ErrorKind::Request,
        ErrorKind::Memory,
        ErrorKind::File,
        ErrorKind::Part,
        ErrorKind::Cancelled,
    ];

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<S: Serializer>(error: &Error, to: S) -> Result<S::Ok, S::Error> {
        let kind = KINDS.iter().position(|kind| *kind == error.kind()).unwrap_or(0);
        (kind, error.to_string()).serialize(to)
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Error, D::Error> {
        let (kind, message) = <(usize, String)>::deserialize(from)?;
        Ok(Error::new(KINDS.get(kind).copied().unwrap_or(ErrorKind::Internal), message))
    }
}

/// A result.
pub mod result {
    use super::*;

    #[derive(Serialize, Deserialize)]
    enum Outcome<T> {
        Made(T),
        Failed(#[serde(with = "error")] Error),
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<T: Serialize, S: Serializer>(result: &orogen::Result<T>, to: S) -> Result<S::Ok, S::Error> {
        match result {
            Ok(made) => Outcome::Made(made).serialize(to),
            Err(error) => Outcome::<&T>::Failed(error.clone()).serialize(to),
        }
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<orogen::Result<T>, D::Error> {
        Ok(match Outcome::deserialize(from)? {
            Outcome::Made(made) => Ok(made),
            Outcome::Failed(error) => Err(error),
        })
    }
}
