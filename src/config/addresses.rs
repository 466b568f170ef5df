//! Addresses with a password in them, which everybody would read who sees the settings.

use super::settings::ResolvedSetting;

/// Settings that name a database: their passwords may also stand in a parameter.
const OF_DATABASES: [&str; 1] = ["database_url"];

/// Whether the value of the setting has a password in it, also where it is no address that can be used.
pub(super) fn has_password(entry: &ResolvedSetting) -> bool {
    let is_of_database = OF_DATABASES.contains(&entry.setting.name);
    let after_scheme = entry.value.split_once("://").map(|(_, rest)| rest);
    after_scheme.or(is_of_database.then_some(&*entry.value)).is_some_and(has_credentials)
        || (is_of_database && has_password_parameter(&entry.value))
}

/// `user:password@`, also with characters in it that should have been encoded.
fn has_credentials(address: &str) -> bool {
    let host_end = address.find(['/', '?', '#']).unwrap_or(address.len());
    let of_host = address[..host_end].rsplit_once('@').map(|(before, _)| before);
    let of_all = address.split_once('@').map(|(before, _)| before);
    of_host.into_iter().chain(of_all).any(|before| before.contains(':'))
}

/// `password=`, also as the end of a longer name.
fn has_password_parameter(text: &str) -> bool {
    let text = text.to_ascii_lowercase();
    text.split("password").skip(1).any(|rest| rest.trim_start().starts_with('='))
}

#[cfg(test)]
mod tests {
    use super::super::origin::Origin;
    use super::super::settings::SETTINGS;
    use super::*;

    fn is_found(name: &str, value: &str) -> bool {
        let setting = SETTINGS.iter().find(|setting| setting.name == name).unwrap();
        has_password(&ResolvedSetting { setting, value: value.to_owned(), origin: Origin::Default })
    }

    #[test]
    fn a_password_is_found_wherever_an_address_has_one() {
        for address in [
            "postgresql://a:open@localhost/b",
            "postgres://a:op/en@localhost/b",
            "postgresql://a:op@en@localhost/b",
            "postgresql://a:@localhost/b",
            "a:open@localhost/b",
            "postgresql://a:open@localhost:no-port/b",
            "postgresql://a@localhost/b?password=open",
            "postgresql://a@localhost/b?sslmode=require&sslpassword=open",
            "host=/run/postgresql user=a PASSWORD = 'open'",
        ] {
            assert!(is_found("database_url", address), "{address}");
        }
        assert!(is_found("blobs_url", "s3://id:open@meshes"));
        assert!(is_found("blobs_endpoint", "https://id:open@s3.example"));
    }

    #[test]
    fn an_address_without_a_password_is_left_alone() {
        for address in [
            "",
            "postgresql://a@localhost:5433/b",
            "postgresql://localhost:5433/b?application_name=shop",
            "postgresql://a@[::1]:5433/password",
            "host=/run/postgresql user=a dbname=password",
        ] {
            assert!(!is_found("database_url", address), "{address}");
        }
        assert!(!is_found("blobs_endpoint", "http://127.0.0.1:9000"));
        assert!(!is_found("listen", "127.0.0.1:8080"));
    }
}
