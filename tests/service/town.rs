//! Several servers that share a database and a bucket, both of which a test starts for itself.

use crate::server::Server;

#[path = "../support/postgres_server.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod postgres_server;
#[path = "../support/s3_server.rs"]
mod s3_server;

/// What servers share.
pub(crate) struct Town {
    settings: Vec<String>,
    /// For files of a test.
    pub(crate) dir: tempfile::TempDir,
    database: postgres_server::Server,
    _bucket: s3_server::S3Server,
}

impl Town {
    /// Starts what is shared; `None`, after a word about it, where PostgreSQL is not installed.
    #[allow(clippy::print_stderr, reason = "a test that is left out says so")]
    pub(crate) fn open() -> Option<Self> {
        if postgres_server::programs().is_none() {
            eprintln!("left out: PostgreSQL (Debian's package postgresql) is not installed");
            return None;
        }
        let dir = tempfile::tempdir().unwrap();
        let database = postgres_server::Server::start();
        let bucket = s3_server::S3Server::start(&dir.path().join("bucket"), 0);
        let key = dir.path().join("key");
        std::fs::write(&key, format!("{}\n{}\n", s3_server::KEY.0, s3_server::KEY.1)).unwrap();
        let settings = [
            ("--database-url", database.url("postgres")),
            ("--database-connections-max", "8".to_owned()),
            ("--blobs-url", format!("s3://{}/shop", s3_server::BUCKET)),
            ("--blobs-endpoint", format!("http://{}", bucket.address)),
            ("--blobs-key-file", key.to_str().unwrap().to_owned()),
        ];
        let settings = settings.into_iter().flat_map(|(flag, value)| [flag.to_owned(), value]).collect();
        Some(Self { settings, dir, database, _bucket: bucket })
    }

    /// What is shared, as flags.
    pub(crate) fn shared(&self) -> &[String] {
        &self.settings
    }

    /// Has the database do something.
    pub(crate) fn sql(&self, text: &str) {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let url = self.database.url("postgres");
            let (client, connection) = tokio_postgres::connect(&url, tokio_postgres::NoTls).await.unwrap();
            tokio::spawn(connection);
            client.batch_execute(text).await.unwrap();
        });
    }

    /// The settings of a server of this role.
    pub(crate) fn settings<'s>(&'s self, role: &'s str, more: &[&'s str]) -> Vec<&'s str> {
        let shared = self.settings.iter().map(String::as_str);
        ["--role", role].into_iter().chain(shared).chain(more.iter().copied()).collect()
    }

    pub(crate) fn server(&self, role: &str, more: &[&str]) -> Server {
        Server::with(&self.settings(role, more))
    }

    /// Keys of all files in the bucket.
    pub(crate) fn stored_files(&self) -> Vec<String> {
        let mut found = Vec::new();
        for folder in ["in", "out", "pieces"] {
            let folder = self.dir.path().join("bucket").join(s3_server::BUCKET).join("shop").join(folder);
            let Ok(entries) = std::fs::read_dir(folder) else { continue };
            found.extend(entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()));
        }
        found
    }
}
