//! The stores that several servers share, as the configuration names them.

use std::path::Path;
use std::time::Duration;

use crate::config::{ConfigError, Loaded, ServerRole};
use crate::jobs::{BucketAccess, DatabaseAccess, SharedStores};

/// Longest validity of a presigned URL that S3 takes.
const PRESIGNED_TTL_MAX: Duration = Duration::from_secs(7 * 24 * 60 * 60);

/// The shared stores; `None`: those in the data directory.
pub(super) fn shared_stores(loaded: &Loaded) -> Result<Option<SharedStores>, ConfigError> {
    let config = &loaded.config;
    let (database_url, blobs_url) = (config.database_url.trim(), config.blobs_url.trim());
    match (database_url.is_empty(), blobs_url.is_empty()) {
        (true, true) if config.role == ServerRole::All => return Ok(None),
        (true, true) => {
            let why = "takes jobs to or from other servers, so it needs database_url and blobs_url";
            return Err(loaded.refused("role", &format!("`{}` {why}", config.role.word())));
        }
        (false, true) => {
            return Err(
                loaded.refused("database_url", &"it needs blobs_url: jobs are shared with their files")
            );
        }
        (true, false) => {
            return Err(
                loaded.refused("blobs_url", &"it needs database_url: files are shared with their jobs")
            );
        }
        (false, false) => {}
    }
    let password = match &config.database_password_file {
        Some(path) => Some(line_of(loaded, "database_password_file", path)?),
        None => None,
    };
    let database = DatabaseAccess {
        url: database_url.to_owned(),
        password,
        connections_max: config.database_connections_max.get(),
    };
    database.check().map_err(|e| loaded.refused("database_url", &e))?;
    let key = match &config.blobs_key_file {
        Some(path) => Some(key_of(loaded, path)?),
        None => None,
    };
    let endpoint = endpoint_of(loaded, "blobs_endpoint", &config.blobs_endpoint)?;
    let public_endpoint = endpoint_of(loaded, "blobs_public_endpoint", &config.blobs_public_endpoint)?;
    let bucket = BucketAccess {
        url: blobs_url.to_owned(),
        endpoint,
        public_endpoint,
        region: config.blobs_region.clone(),
        key,
        cache_bytes_max: config.blobs_copies_bytes_max.0,
    };
    bucket.check().map_err(|e| loaded.refused("blobs_url", &e))?;
    Ok(Some(SharedStores { database, bucket }))
}

/// For how long presigned URLs are valid; `None`: none are given.
pub(super) fn presigned_ttl(loaded: &Loaded) -> Result<Option<Duration>, ConfigError> {
    let Some(lasts) = loaded.config.presigned_ttl else { return Ok(None) };
    if lasts > PRESIGNED_TTL_MAX {
        return Err(loaded.refused("presigned_ttl", &"S3 takes no URL that is valid for longer than 7 days"));
    }
    if loaded.config.blobs_url.trim().is_empty() {
        return Err(
            loaded.refused("presigned_ttl", &"presigned URLs are those of a bucket: it needs blobs_url")
        );
    }
    // A part of a second is no validity that S3 knows.
    Ok(Some(lasts.max(Duration::from_secs(1))))
}

/// The address of an S3 server; `None`: Amazon's.
fn endpoint_of(loaded: &Loaded, setting: &'static str, text: &str) -> Result<Option<String>, ConfigError> {
    let text = text.trim();
    if !text.is_empty() && !text.starts_with("https://") && !text.starts_with("http://") {
        return Err(loaded.refused(setting, &"expected a URL, such as https://s3.example"));
    }
    Ok((!text.is_empty()).then(|| text.to_owned()))
}

fn read(loaded: &Loaded, setting: &'static str, path: &Path) -> Result<String, ConfigError> {
    std::fs::read_to_string(path).map_err(|e| loaded.refused(setting, &e))
}

/// The one line of a file.
fn line_of(loaded: &Loaded, setting: &'static str, path: &Path) -> Result<String, ConfigError> {
    let text = read(loaded, setting, path)?;
    match lines(&text)[..] {
        [line] => Ok(line.to_owned()),
        ref lines => Err(loaded.refused(setting, &format!("expected one line, found {}", lines.len()))),
    }
}

fn key_of(loaded: &Loaded, path: &Path) -> Result<(String, String), ConfigError> {
    let setting = "blobs_key_file";
    let text = read(loaded, setting, path)?;
    match lines(&text)[..] {
        [id, secret] => Ok((id.to_owned(), secret.to_owned())),
        ref lines => {
            let found = lines.len();
            Err(loaded.refused(setting, &format!("expected two lines, the id and the secret, found {found}")))
        }
    }
}

fn lines(text: &str) -> Vec<&str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Sources;

    fn loaded(flags: &[(&str, &str)]) -> Loaded {
        let flags = flags.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect();
        Sources { flags, ..Sources::default() }.load().unwrap()
    }

    #[test]
    fn both_stores_are_shared_or_none() {
        assert!(shared_stores(&loaded(&[])).unwrap().is_none());
        let (database, blobs) =
            (("database_url", "postgresql://a@localhost/b"), ("blobs_url", "s3://meshes"));
        for (alone, other) in [(database, "blobs_url"), (blobs, "database_url")] {
            let refused = shared_stores(&loaded(&[alone])).unwrap_err().to_string();
            assert!(refused.contains(other), "{refused}");
        }
        for role in ["api", "worker"] {
            let refused = shared_stores(&loaded(&[("role", role)])).unwrap_err().to_string();
            assert!(
                refused.starts_with("`role` (flag --role)") && refused.contains("database_url"),
                "{refused}"
            );
            assert!(shared_stores(&loaded(&[("role", role), database, blobs])).unwrap().is_some());
        }
        let shared = shared_stores(&loaded(&[database, blobs])).unwrap().unwrap();
        assert_eq!((shared.database.url.as_str(), shared.bucket.url.as_str()), (database.1, blobs.1));
        assert_eq!((shared.bucket.endpoint, shared.bucket.key, shared.database.password), (None, None, None));
    }

    #[test]
    fn presigned_urls_need_a_bucket_and_last_a_week_at_most() {
        let shared = [("database_url", "postgresql://a@localhost/b"), ("blobs_url", "s3://meshes")];
        let ttl = |text, shared: &[_]| presigned_ttl(&loaded(&[shared, &[("presigned_ttl", text)]].concat()));
        assert_eq!(ttl("off", &[]), Ok(None));
        assert_eq!(ttl("15min", &shared), Ok(Some(Duration::from_secs(900))));
        assert_eq!(ttl("1ms", &shared), Ok(Some(Duration::from_secs(1))));
        assert!(ttl("15min", &[]).unwrap_err().to_string().contains("blobs_url"));
        assert!(ttl("8d", &shared).unwrap_err().to_string().contains("7 days"));
    }

    #[test]
    fn secrets_are_read_from_files_and_never_shown() {
        let dir = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| {
            let path = dir.path().join(name);
            std::fs::write(&path, text).unwrap();
            path.to_str().unwrap().to_owned()
        };
        let (password, key) = (file("password", "hidden\n"), file("key", "id\nhidden too\n\n"));
        let all = [
            ("database_url", "postgresql://a@localhost/b"),
            ("database_password_file", password.as_str()),
            ("blobs_url", "s3://meshes"),
            ("blobs_key_file", key.as_str()),
        ];
        let shared = shared_stores(&loaded(&all)).unwrap().unwrap();
        assert_eq!(shared.database.password.as_deref(), Some("hidden"));
        assert_eq!(shared.bucket.key, Some(("id".to_owned(), "hidden too".to_owned())));
        assert!(!format!("{shared:?}").contains("hidden"));
        let refused = |name: &'static str, value: &str| {
            let mut flags = all.to_vec();
            flags.retain(|&(other, _)| other != name);
            flags.push((name, value));
            shared_stores(&loaded(&flags)).unwrap_err().to_string()
        };
        assert!(refused("blobs_key_file", &password).contains("found 1"));
        assert!(refused("database_password_file", &key).contains("found 2"));
        assert!(refused("database_url", "postgresql://a@localhost/b?what=hidden").contains("database_url"));
        assert!(refused("blobs_url", "https://meshes.example").contains("s3://"));
        assert!(refused("blobs_endpoint", "s3.example").contains("https://"));
        assert!(refused("blobs_public_endpoint", "s3.example").contains("https://"));
    }
}
