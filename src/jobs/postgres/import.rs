//! Rows that come from another store.

use futures_util::future::try_join_all;
use tokio::sync::mpsc;
use tokio_postgres::types::ToSql;

use super::{PostgresStore, failure};
use crate::jobs::store::StoreError;
use crate::jobs::store::tables::{Column, ColumnTexts, TABLES, Table};

/// Some rows of one table.
pub(in crate::jobs) struct Rows {
    pub(in crate::jobs) table: &'static Table,
    pub(in crate::jobs) rows: Vec<ColumnTexts>,
}

impl PostgresStore {
    /// How many jobs there are.
    pub(in crate::jobs) async fn job_count(&self) -> Result<i64, StoreError> {
        let client = self.pool.get().await.map_err(|error| StoreError::Unavailable(error.to_string()))?;
        let row = client.query_one("SELECT count(*) FROM jobs", &[]).await.map_err(|e| failure(&e))?;
        row.try_get(0).map_err(|e| failure(&e))
    }

    /// Takes all rows in, or none: those that come until `None`, table after table as [`TABLES`] has them. How many there are
    /// of each table then. Nobody else may have put a job in.
    pub(in crate::jobs) async fn import(
        &self,
        mut coming: mpsc::Receiver<Option<Rows>>,
    ) -> Result<Vec<i64>, StoreError> {
        let mut client = self.pool.get().await.map_err(|error| StoreError::Unavailable(error.to_string()))?;
        let transaction = client.transaction().await.map_err(|e| failure(&e))?;
        transaction.batch_execute("LOCK TABLE jobs IN EXCLUSIVE MODE").await.map_err(|e| failure(&e))?;
        let jobs = transaction.query_one("SELECT count(*) FROM jobs", &[]).await.map_err(|e| failure(&e))?;
        if jobs.try_get::<_, i64>(0).map_err(|e| failure(&e))? > 0 {
            return Err(StoreError::Unavailable(
                "a server has put jobs into the database meanwhile".to_owned(),
            ));
        }
        let mut is_complete = false;
        while let Some(next) = coming.recv().await {
            let Some(Rows { table, rows }) = next else {
                is_complete = true;
                break;
            };
            let insert = transaction.prepare_cached(&insert_of(table)).await.map_err(|e| failure(&e))?;
            // Sent together, done one after the other.
            let inserting = rows.iter().map(|cells| {
                let (transaction, insert) = (&transaction, &insert);
                async move {
                    let values: Vec<&(dyn ToSql + Sync)> = cells.iter().map(|cell| cell as _).collect();
                    transaction.execute(insert, &values).await
                }
            });
            try_join_all(inserting).await.map_err(|e| failure(&e))?;
        }
        if !is_complete {
            return Err(StoreError::Unavailable("the rows could not all be read".to_owned()));
        }
        let mut counts = Vec::with_capacity(TABLES.len());
        for table in TABLES {
            let sql = format!("SELECT count(*) FROM {}", table.name);
            let row = transaction.query_one(&sql, &[]).await.map_err(|e| failure(&e))?;
            counts.push(row.try_get(0).map_err(|e| failure(&e))?);
        }
        transaction.commit().await.map_err(|e| failure(&e))?;
        Ok(counts)
    }
}

fn insert_of(table: &Table) -> String {
    let names: Vec<_> = table.columns.iter().map(|column| column.name()).collect();
    let values: Vec<_> = (1..).zip(table.columns).map(|(number, &column)| value_of(column, number)).collect();
    format!("INSERT INTO {} ({}) VALUES ({})", table.name, names.join(", "), values.join(", "))
}

/// The value of a column, from its text.
fn value_of(column: Column, number: usize) -> String {
    match column {
        Column::Id(_) => format!("${number}::text::uuid"),
        Column::Text(_) | Column::Quoted(_) => format!("${number}::text"),
        Column::Number(_) => format!("${number}::text::bigint"),
        Column::Small(_) => format!("${number}::text::integer"),
        Column::Wide(_) => format!("${number}::text::numeric"),
        Column::Flag(_) => format!("${number}::text::boolean"),
        Column::Bytes(_) => format!("decode(${number}::text, 'hex')"),
    }
}
