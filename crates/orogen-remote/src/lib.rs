//! Object stores: S3, Google Cloud Storage, Azure Blob Storage, and files on HTTP servers.
//!
//! After [`mount`], paths that are URLs work wherever Orogen reads or writes files:
//!
//! | URL | store | account and settings |
//! |---|---|---|
//! | `s3://bucket/name` | Amazon S3, and servers that are compatible with it | `AWS_ACCESS_KEY_ID`, `AWS_SECRET_ACCESS_KEY`, `AWS_SESSION_TOKEN`, `AWS_REGION`, `AWS_ENDPOINT_URL`, `AWS_ALLOW_HTTP`, `AWS_SKIP_SIGNATURE`; roles of containers, EC2 and Kubernetes |
//! | `gs://bucket/name` | Google Cloud Storage | `GOOGLE_APPLICATION_CREDENTIALS`, `GOOGLE_SERVICE_ACCOUNT`; accounts of machines |
//! | `az://container/name`, `abfs://...` | Azure Blob Storage | `AZURE_STORAGE_ACCOUNT_NAME`, `AZURE_STORAGE_ACCOUNT_KEY`, `AZURE_STORAGE_SAS_TOKEN`; managed identities |
//! | `https://server/name`, `http://...` | files on a server, which are only read | |
//!
//! The settings are environment variables with the names that the tools of the stores use. Profiles in
//! `~/.aws/credentials` are not read; `aws configure export-credentials --format env` prints one as variables.
//!
//! Requests that fail are repeated for up to a minute. Objects above 8 MiB are sent in parts, four at a time.
#![forbid(unsafe_code)]

mod address;
mod failure;
mod stores;

use orogen_codec::fs::objects;

/// Reads and writes objects of stores from now on, wherever a path is a URL, in the whole process. Later calls change
/// nothing.
///
/// ```
/// orogen_remote::mount();
/// ```
pub fn mount() {
    mount_with([]);
}

/// [`mount`] with settings that take precedence over environment variables of the same names.
///
/// ```
/// orogen_remote::mount_with([("AWS_REGION".into(), "eu-central-1".into())]);
/// ```
pub fn mount_with(settings: impl IntoIterator<Item = (String, String)>) {
    objects::mount(Box::new(stores::Stores::new(settings.into_iter().collect())));
}
