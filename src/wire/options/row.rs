//! One option is one row: its member, its line of the table, and how it is read, joined and listed are made of it.

/// Makes [`Options`](super::Options) and [`SPECS`](super::SPECS) of rows `name: Type = KIND, in OPERATIONS, "About.";`.
/// Without `= KIND` the option takes what its type takes; `of the service` stands in rows that mean nothing on the
/// command line.
macro_rules! options {
    (
        $(#[doc = $description:literal])+
        $($name:ident: $value:ty $(= $kind:expr)?, in $operations:expr, $(of the $service:ident,)? $about:literal;)+
    ) => {
        $(#[doc = $description])+
        #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
        #[serde(try_from = "Map<String, Value>")]
        pub struct Options {
            $(
                #[doc = $about]
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $name: Option<$value>,
            )+
        }

        /// Every option.
        pub const SPECS: &[OptionSpec] = &[$(
            OptionSpec {
                name: stringify!($name),
                kind: options!(@kind $value $(, $kind)?),
                operations: $operations,
                about: $about,
                is_for_service_only: options!(@service $($service)?),
            },
        )+];

        impl Options {
            /// The options that are given, in the order of the table.
            pub(super) fn given(&self) -> impl Iterator<Item = &'static OptionSpec> {
                let given = [$(self.$name.is_some()),+];
                SPECS.iter().zip(given).filter(|&(_, is_given)| is_given).map(|(spec, _)| spec)
            }

            /// Takes the value of an option that is in its range.
            fn take(&mut self, name: &str, text: &str) -> parse::ValueOutcome {
                match name {
                    $(stringify!($name) => {
                        parse::put(&mut self.$name, <$value as value::OptionValue>::from_text(text))
                    })+
                    _ => parse::ValueOutcome::Invalid,
                }
            }

            /// The options of two places, such as query and body, together.
            ///
            /// # Errors
            /// An option that has different values in them.
            pub fn join(mut self, other: Self) -> Result<Self, OptionError> {
                $(
                    parse::put_if_given(&mut self.$name, other.$name)
                        .into_result(lookup::spec_of(stringify!($name))?, "")?;
                )+
                Ok(self)
            }
        }
    };
    (@kind $value:ty, $kind:expr) => { $kind };
    (@kind $value:ty) => { <$value as value::OptionValue>::KIND };
    (@service service) => { true };
    (@service) => { false };
}
