//! Secrets of jobs are sealed while they are stored: who reads the store, or a copy of it, cannot sign.
//!
//! ChaCha20-Poly1305 (RFC 8439) with a random nonce for each secret. The key is in a file of its own, not in the store.

use std::fs::{File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use ring::aead::{Aad, CHACHA20_POLY1305, LessSafeKey, NONCE_LEN, Nonce, UnboundKey};
use ring::rand::{SecureRandom as _, SystemRandom};
use sha2::{Digest as _, Sha256};

/// What a sealed secret begins with; behind it the name of the key and, in base64, nonce and text.
const PREFIX: &str = "sealed:1:";
/// What the seal is for: nothing else that is sealed with this key is taken for a secret.
const PURPOSE: &[u8] = b"webhook secret";
const KEY_BYTES: usize = 32;
/// Most bytes of a key file that are read.
const KEY_FILE_BYTES_MAX: u64 = 4096;

/// Seals and unseals. The key is never printed.
pub(in crate::jobs) struct Vault {
    key: LessSafeKey,
    /// The first bytes of the key's digest, in hexadecimal.
    name: String,
    random: SystemRandom,
}

impl std::fmt::Debug for Vault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Vault(..)")
    }
}

/// A key file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum VaultError {
    /// The system says why.
    #[error("key file {path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It holds something else.
    #[error("key file {path} does not hold 32 bytes in base64")]
    NoKey {
        /// The file.
        path: PathBuf,
    },
}

/// A secret that cannot be had.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(in crate::jobs) enum SealError {
    #[error("the secret is sealed with a key that this server does not have")]
    OtherKey,
    #[error("the sealed secret is damaged")]
    Damaged,
    #[error("the system gives no random numbers")]
    NoRandom,
}

impl Vault {
    /// Takes the key of the file, which is made when there is none. Blocks.
    ///
    /// # Errors
    /// The file cannot be read or made, or holds no key.
    pub(in crate::jobs) fn open(path: &Path) -> Result<Self, VaultError> {
        let file_error = |source| VaultError::File { path: path.to_owned(), source };
        let no_key = || VaultError::NoKey { path: path.to_owned() };
        let random = SystemRandom::new();
        let text = match File::open(path) {
            Ok(file) => read(path, file).map_err(file_error)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let mut key = [0; KEY_BYTES];
                random.fill(&mut key).map_err(|_| file_error(io::Error::other("no random numbers")))?;
                let text = STANDARD.encode(key) + "\n";
                write(path, &text).map_err(file_error)?;
                text
            }
            Err(error) => return Err(file_error(error)),
        };
        let key = STANDARD.decode(text.trim()).map_err(|_| no_key())?;
        let unbound = UnboundKey::new(&CHACHA20_POLY1305, &key).map_err(|_| no_key())?;
        let digest = Sha256::digest(&key);
        let name = digest[..4].iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { key: LessSafeKey::new(unbound), name, random })
    }

    /// The secret as it is stored; `None`: it is sealed already.
    pub(in crate::jobs) fn seal_if_plain(&self, secret: &str) -> Result<Option<String>, SealError> {
        if secret.starts_with(PREFIX) { Ok(None) } else { self.sealed(secret).map(Some) }
    }

    /// The secret as it is stored.
    pub(in crate::jobs) fn sealed(&self, secret: &str) -> Result<String, SealError> {
        let mut nonce = [0; NONCE_LEN];
        self.random.fill(&mut nonce).map_err(|_| SealError::NoRandom)?;
        let mut text = secret.as_bytes().to_vec();
        self.key
            .seal_in_place_append_tag(Nonce::assume_unique_for_key(nonce), Aad::from(PURPOSE), &mut text)
            .map_err(|_| SealError::Damaged)?;
        let sealed = STANDARD.encode([&nonce[..], &text].concat());
        Ok(format!("{PREFIX}{}:{sealed}", self.name))
    }

    /// The secret behind what is stored. One that an older program stored as it is, is given back as it is.
    pub(in crate::jobs) fn unsealed(&self, stored: &str) -> Result<String, SealError> {
        let Some(rest) = stored.strip_prefix(PREFIX) else { return Ok(stored.to_owned()) };
        let (name, sealed) = rest.split_once(':').ok_or(SealError::Damaged)?;
        if name != self.name {
            return Err(SealError::OtherKey);
        }
        let sealed = STANDARD.decode(sealed).map_err(|_| SealError::Damaged)?;
        let (nonce, text) = sealed.split_at_checked(NONCE_LEN).ok_or(SealError::Damaged)?;
        let nonce = Nonce::try_assume_unique_for_key(nonce).map_err(|_| SealError::Damaged)?;
        let mut text = text.to_vec();
        let plain =
            self.key.open_in_place(nonce, Aad::from(PURPOSE), &mut text).map_err(|_| SealError::Damaged)?;
        String::from_utf8(plain.to_vec()).map_err(|_| SealError::Damaged)
    }
}

fn read(path: &Path, file: File) -> io::Result<String> {
    if file.metadata()?.permissions().mode() & 0o077 != 0 {
        tracing::warn!(path = %path.display(), "others than the server's user may read or write this key file");
    }
    let mut text = String::new();
    file.take(KEY_FILE_BYTES_MAX).read_to_string(&mut text)?;
    Ok(text)
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    // Under another name until it is whole: a server that is killed leaves no half of a key.
    let unfinished = path.with_extension("unfinished");
    let mut file =
        OpenOptions::new().write(true).create(true).truncate(true).mode(0o600).open(&unfinished)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    std::fs::rename(&unfinished, path)?;
    path.parent().filter(|dir| !dir.as_os_str().is_empty()).map_or(Ok(()), |dir| File::open(dir)?.sync_all())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECRET: &str = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

    #[test]
    fn a_secret_comes_back_with_the_same_key_only_and_never_twice_in_the_same_words() {
        let dir = tempfile::tempdir().unwrap();
        let vault = Vault::open(&dir.path().join("key")).unwrap();
        let (first, second) = (vault.sealed(SECRET).unwrap(), vault.sealed(SECRET).unwrap());
        assert!(first != second && !first.contains("MfKQ"));
        let again = Vault::open(&dir.path().join("key")).unwrap();
        assert_eq!(again.unsealed(&first).as_deref(), Ok(SECRET));
        let other = Vault::open(&dir.path().join("other")).unwrap();
        assert_eq!(other.unsealed(&first), Err(SealError::OtherKey));
        assert_eq!(again.seal_if_plain(&first), Ok(None));
        assert!(again.seal_if_plain(SECRET).unwrap().is_some());
        assert_eq!(again.unsealed(SECRET).as_deref(), Ok(SECRET), "as an older program stored it");
    }

    #[test]
    fn a_sealed_secret_that_was_changed_is_told_from_a_good_one() {
        let dir = tempfile::tempdir().unwrap();
        let vault = Vault::open(&dir.path().join("key")).unwrap();
        let sealed = vault.sealed(SECRET).unwrap();
        let (head, text) = sealed.rsplit_once(':').unwrap();
        let mut bytes = STANDARD.decode(text).unwrap();
        bytes[20] ^= 1;
        for damaged in [
            format!("{head}:{}", STANDARD.encode(&bytes)),
            format!("{head}:{}", STANDARD.encode(&bytes[..5])),
            format!("{head}:%"),
            PREFIX.to_owned(),
        ] {
            assert_eq!(vault.unsealed(&damaged), Err(SealError::Damaged), "{damaged}");
        }
    }

    #[test]
    fn a_key_file_is_private_and_another_content_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("key");
        Vault::open(&path).unwrap();
        assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o600);
        for content in ["", "c2hvcnQ=", "no base64 at all"] {
            std::fs::write(&path, content).unwrap();
            assert!(matches!(Vault::open(&path), Err(VaultError::NoKey { .. })), "{content}");
        }
    }
}
