//! The tables that stores of both kinds keep, for rows that go from one kind to the other.

/// How a value of a column goes over. On its way it is text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::jobs) enum Column {
    /// An id of a job.
    Id(&'static str),
    /// The same text.
    Text(&'static str),
    /// Text that becomes JSON, in which no character is refused.
    Quoted(&'static str),
    /// An integer.
    Number(&'static str),
    /// An integer of 32 bits.
    Small(&'static str),
    /// A number that may have more digits than an integer.
    Wide(&'static str),
    /// 0 or 1.
    Flag(&'static str),
    /// Bytes, on their way in hexadecimal.
    Bytes(&'static str),
}

impl Column {
    /// Its name.
    pub(in crate::jobs) fn name(self) -> &'static str {
        match self {
            Self::Id(name)
            | Self::Text(name)
            | Self::Quoted(name)
            | Self::Number(name)
            | Self::Small(name)
            | Self::Wide(name)
            | Self::Flag(name)
            | Self::Bytes(name) => name,
        }
    }
}

/// A table.
#[derive(Debug)]
pub(in crate::jobs) struct Table {
    /// Its name.
    pub(in crate::jobs) name: &'static str,
    /// Its columns.
    pub(in crate::jobs) columns: &'static [Column],
}

/// A row on its way: a text for each column of its table, where there is a value.
pub(in crate::jobs) type ColumnTexts = Vec<Option<String>>;

use Column::{Bytes, Flag, Id, Number, Quoted, Small, Text, Wide};

/// All tables, those that others refer to first.
pub(in crate::jobs) const TABLES: &[Table] = &[
    Table {
        name: "jobs",
        columns: &[
            Id("id"),
            Text("owner"),
            Text("tenant"),
            Text("operation"),
            Text("options"),
            Quoted("file_name"),
            Text("labels"),
            Text("webhook"),
            Text("trace"),
            Text("input"),
            Bytes("input_sha256"),
            Wide("input_bytes"),
            Wide("file_bytes"),
            Text("material"),
            Number("lane"),
            Text("state"),
            Number("epoch"),
            Number("attempts"),
            Text("worker"),
            Number("lease_until"),
            Text("stop"),
            Flag("is_quick"),
            Flag("is_outgrown"),
            Number("created_at"),
            Number("cancel_at"),
            Number("started_at"),
            Number("finished_at"),
            Number("keep_for"),
            Number("expires_at"),
            Text("ending"),
            Text("engine"),
            Flag("is_cached"),
            Text("idempotency_key"),
            Bytes("fingerprint"),
        ],
    },
    Table { name: "labels", columns: &[Id("job"), Quoted("name"), Quoted("value")] },
    Table { name: "names", columns: &[Id("job"), Text("key"), Wide("bytes"), Text("blob")] },
    Table {
        name: "changes",
        columns: &[Id("job"), Number("number"), Text("state"), Number("epoch"), Number("at")],
    },
    Table {
        name: "deliveries",
        columns: &[
            Text("id"),
            Id("job"),
            Text("webhook"),
            Text("receiver"),
            Text("state"),
            Number("created_at"),
            Number("next_at"),
            Number("epoch"),
        ],
    },
    Table {
        name: "tries",
        columns: &[Text("delivery"), Number("number"), Number("at"), Small("status"), Quoted("error")],
    },
];
