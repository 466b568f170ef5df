//! One public word for each value of the engine's enumerations.

/// An enumeration whose values have public words, as options see it.
pub(super) trait Word: Sized {
    /// Name of its schema.
    const NAME: &'static str;
    /// The words of all values.
    const ALL_WORDS: &'static [&'static str];
    /// What each of them means, in the same order.
    const ALL_ABOUTS: &'static [&'static str];

    /// The value of this word.
    fn of_word(word: &str) -> Option<Self>;
}

/// An enumeration whose values have public words.
macro_rules! words {
    ($(#[doc = $description:literal])+ $name:ident {
        $($(#[doc = $about:literal])+ $variant:ident = $word:literal,)+
    }) => {
        $(#[doc = $description])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
        pub enum $name {
            $($(#[doc = $about])+ #[serde(rename = $word)] $variant,)+
        }

        // Written out, because the derive does not see words that come out of a macro.
        impl utoipa::PartialSchema for $name {
            fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::schema::Schema> {
                let mut description = String::from(concat!($($description),+).trim());
                for (word, about) in [$(($word, concat!($($about),+).trim())),+] {
                    description.push_str(&format!("\n- `{word}`: {about}"));
                }
                let object = utoipa::openapi::schema::ObjectBuilder::new()
                    .schema_type(utoipa::openapi::schema::Type::String)
                    .description(Some(description))
                    .enum_values(Some(Self::WORDS.iter().copied()));
                utoipa::openapi::RefOr::T(utoipa::openapi::schema::Schema::Object(object.build()))
            }
        }

        impl utoipa::ToSchema for $name {}

        impl $crate::wire::words::Word for $name {
            const NAME: &'static str = stringify!($name);
            const ALL_WORDS: &'static [&'static str] = Self::WORDS;
            const ALL_ABOUTS: &'static [&'static str] = &[$(concat!($($about),+)),+];

            fn of_word(word: &str) -> Option<Self> {
                Self::from_word(word)
            }
        }

        impl $name {
            /// Every value.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// The words of all values, in the same order.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The public word.
            pub fn word(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }

            /// The value of this word.
            pub fn from_word(word: &str) -> Option<Self> {
                match word { $($word => Some(Self::$variant),)+ _ => None }
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let word = <std::borrow::Cow<'de, str> as serde::Deserialize>::deserialize(from)?;
                Self::from_word(&word).ok_or_else(|| serde::de::Error::unknown_variant(&word, Self::WORDS))
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

/// As `words!` for a type of the engine, whose values it mirrors one to one.
macro_rules! mirror {
    ($engine:ty => $(#[doc = $description:literal])+ $name:ident {
        $($(#[doc = $about:literal])+ $variant:ident = $word:literal,)+
    }) => {
        words! { $(#[doc = $description])+ $name { $($(#[doc = $about])+ $variant = $word,)+ } }

        impl From<$engine> for $name {
            fn from(inner: $engine) -> Self {
                type Inner = $engine;
                match inner { $(Inner::$variant => Self::$variant),+ }
            }
        }

        impl From<$name> for $engine {
            fn from(word: $name) -> Self {
                match word { $($name::$variant => Self::$variant),+ }
            }
        }
    };
}

pub(super) use {mirror, words};

// The macros above are in scope from here on.
mod drawing;
mod files;
mod holes;
mod mending;
mod reports;

pub use self::drawing::{DrawnEdges, PictureFormat, Projection, Shade, Views};
pub use self::files::{Encoding, Format, Operation, Reader, SolidParts, Units};
pub use self::holes::{
    ConstraintValues, Extract, FillMethod, HoleClass, HoleFate, Kernel, LambdaFrom, Rejection,
};
pub use self::mending::{
    Across, Contact, Criterion, Cut, Degenerate, Effort, FillHoles, Mode, Nesting, OpenShells, Opposite,
    Placement, Remedy, Require, SetOperation, ShellFate, Stitch, StitchValidity, VertexColors, Weld,
};
pub use self::reports::{
    ChangeKind, Condition, DefectCode, Fidelity, Outcome, ProximityTest, ReasonCode, Severity, Stage,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{analysis, budget, formats, pipeline};
    use std::collections::HashSet;

    fn are_distinct(words: &[&str]) -> bool {
        words.iter().collect::<HashSet<_>>().len() == words.len()
    }

    #[test]
    fn the_schema_lists_the_words_that_are_sent() {
        let schema = serde_json::to_value(<Units as utoipa::PartialSchema>::schema()).unwrap();
        assert_eq!(schema["enum"], serde_json::json!(Units::WORDS));
        assert_eq!(serde_json::to_value(Units::ALL).unwrap(), schema["enum"]);
    }

    #[test]
    fn every_value_has_a_word_of_its_own() {
        for words in [
            Operation::WORDS,
            Format::WORDS,
            Encoding::WORDS,
            Reader::WORDS,
            Units::WORDS,
            Require::WORDS,
            FillHoles::WORDS,
            Nesting::WORDS,
            ShellFate::WORDS,
            Opposite::WORDS,
            Remedy::WORDS,
            OpenShells::WORDS,
            Contact::WORDS,
            SetOperation::WORDS,
            Across::WORDS,
            Cut::WORDS,
            Stitch::WORDS,
            StitchValidity::WORDS,
            Degenerate::WORDS,
            Outcome::WORDS,
            Fidelity::WORDS,
            ChangeKind::WORDS,
            Stage::WORDS,
            Severity::WORDS,
            DefectCode::WORDS,
            ProximityTest::WORDS,
            Condition::WORDS,
            ReasonCode::WORDS,
        ] {
            assert!(are_distinct(words), "{words:?}");
        }
    }

    #[test]
    fn a_word_leads_back_to_its_value_and_to_the_engine() {
        for &code in DefectCode::ALL {
            assert_eq!(DefectCode::from_word(code.word()), Some(code));
            assert_eq!(DefectCode::from(analysis::DefectCode::from(code)), code);
            assert_eq!(serde_json::to_value(code).unwrap(), code.word());
        }
        assert_eq!(DefectCode::from_word("hole"), None);
    }

    #[test]
    fn the_lists_of_operations_are_those_of_the_table() {
        let of = |holds: &dyn Fn(pipeline::ProductKind) -> bool| -> Vec<Operation> {
            let product = |operation: Operation| pipeline::Operation::from(operation).facts().product;
            Operation::ALL.iter().copied().filter(|&operation| holds(product(operation))).collect()
        };
        let is_mesh = |product| matches!(product, pipeline::ProductKind::Mesh | pipeline::ProductKind::Solid);
        assert_eq!(Operation::WITH_MESH, of(&is_mesh));
        assert_eq!(Operation::BESIDE_PICTURE, of(&|product| product != pipeline::ProductKind::Picture));
    }

    #[test]
    fn the_engine_uses_the_same_words_where_it_has_names() {
        for format in formats::Format::ALL {
            assert_eq!(Format::from(format).word(), format.name());
        }
        for operation in pipeline::Operation::ALL {
            assert_eq!(Operation::from(operation).word(), operation.name());
        }
        for &operation in SetOperation::ALL {
            assert_eq!(operation.word(), pipeline::SetOperation::from(operation).name());
        }
        for stage in budget::Stage::ALL {
            assert_eq!(Stage::from(stage).word(), stage.name());
        }
        for &encoding in Encoding::ALL {
            assert_eq!(encoding.word(), formats::Encoding::from(encoding).name());
        }
    }
}
