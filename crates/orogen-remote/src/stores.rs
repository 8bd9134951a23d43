//! The stores behind the URLs, each opened at its first use.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use futures_util::{StreamExt, TryStreamExt};
use object_store::aws::AmazonS3Builder;
use object_store::azure::MicrosoftAzureBuilder;
use object_store::gcp::GoogleCloudStorageBuilder;
use object_store::http::HttpBuilder;
use object_store::{
    ClientOptions, Error, GetOptions, GetRange, ObjectMeta, ObjectStoreExt, PutMode, PutOptions, PutPayload,
    RetryConfig, WriteMultipart,
};
use orogen_codec::fs::objects::{ObjectEntry, ObjectInfo, ObjectStore};
use tokio::runtime::{Builder, Runtime};

use crate::address::{Address, Kind};
use crate::failure::{failure, is_broken_off};

/// How long a failed request is repeated.
const PATIENCE: Duration = Duration::from_secs(60);

/// How often a request is sent whose answers break off.
const TRIES: usize = 5;

/// Objects above this length are sent in parts of at least this length, in bytes.
const PART: u64 = 8 << 20;

/// Maximum number of parts; stores allow 10 000.
const PARTS: u64 = 9000;

/// Number of parts that are sent at a time.
const AT_A_TIME: usize = 4;

/// All stores that were used, by the start of their URLs.
#[derive(Debug)]
pub struct Stores {
    settings: BTreeMap<String, String>,
    opened: Mutex<BTreeMap<String, Arc<dyn object_store::ObjectStore>>>,
}

/// The runtime that sends requests.
fn runtime() -> io::Result<&'static Runtime> {
    static RUNTIME: OnceLock<Runtime> = OnceLock::new();
    if let Some(runtime) = RUNTIME.get() {
        return Ok(runtime);
    }
    // If a program has chosen one, its choice stays.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let made = Builder::new_multi_thread().worker_threads(2).thread_name("orogen-remote").enable_all().build()?;
    Ok(RUNTIME.get_or_init(|| made))
}

/// Runs requests to their end.
fn wait<T>(work: impl Future<Output = Result<T, Error>>) -> io::Result<T> {
    runtime()?.block_on(work).map_err(|error| failure(&error))
}

/// Runs requests that can be repeated to their end. The client repeats requests without an answer, but not those whose
/// answer breaks off.
fn wait_for<T>(work: impl AsyncFn() -> Result<T, Error>) -> io::Result<T> {
    wait(async {
        let mut tries = 1;
        loop {
            match work().await {
                Err(error) if tries < TRIES && is_broken_off(&error) => tries += 1,
                done => return done,
            }
        }
    })
}

/// A builder of a store with its account and settings: from the environment, and `settings`.
macro_rules! builder {
    ($kind:ty, $settings:expr) => {
        $settings.iter().fold(<$kind>::from_env(), |builder, (name, value)| match name.to_lowercase().parse() {
            Ok(key) => builder.with_config(key, value),
            // A setting of another store.
            Err(_) => builder,
        })
    };
}

fn open(address: &Address, settings: &BTreeMap<String, String>) -> Result<Arc<dyn object_store::ObjectStore>, Error> {
    let retry = RetryConfig { retry_timeout: PATIENCE, ..RetryConfig::default() };
    let root = &address.root;
    Ok(match address.kind {
        Kind::S3 => Arc::new(builder!(AmazonS3Builder, settings).with_url(root).with_retry(retry).build()?),
        Kind::Google => {
            Arc::new(builder!(GoogleCloudStorageBuilder, settings).with_url(root).with_retry(retry).build()?)
        }
        Kind::Azure => Arc::new(builder!(MicrosoftAzureBuilder, settings).with_url(root).with_retry(retry).build()?),
        Kind::Http => {
            let options = ClientOptions::new().with_allow_http(true);
            Arc::new(HttpBuilder::new().with_url(root).with_client_options(options).with_retry(retry).build()?)
        }
    })
}

impl Stores {
    /// No stores yet; they will have these settings.
    pub fn new(settings: BTreeMap<String, String>) -> Stores {
        Stores { settings, opened: Mutex::default() }
    }

    fn store(&self, address: &Address) -> io::Result<Arc<dyn object_store::ObjectStore>> {
        let mut opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(store) = opened.get(&address.root) {
            return Ok(Arc::clone(store));
        }
        // Clients of some stores are bound to the runtime in which they are made.
        let _entered = runtime()?.enter();
        let store = open(address, &self.settings).map_err(|error| failure(&error))?;
        opened.insert(address.root.clone(), Arc::clone(&store));
        Ok(store)
    }

    /// The store and the address of an object that can be written.
    fn writable(&self, url: &str) -> io::Result<(Arc<dyn object_store::ObjectStore>, Address)> {
        let address = Address::parse(url)?;
        if address.kind == Kind::Http {
            let message = "files on HTTP servers are only read";
            return Err(io::Error::new(io::ErrorKind::Unsupported, message));
        }
        Ok((self.store(&address)?, address))
    }
}

impl ObjectStore for Stores {
    fn info(&self, url: &str) -> io::Result<ObjectInfo> {
        let address = Address::parse(url)?;
        let store = self.store(&address)?;
        wait_for(async || store.head(&address.name).await).map(info).map_err(|cause| match cause.kind() {
            // Without the permission to list objects, stores answer so for objects that do not exist.
            io::ErrorKind::PermissionDenied => io::Error::new(
                io::ErrorKind::NotFound,
                "there is no such object, or the store denies it to these credentials",
            ),
            _ => cause,
        })
    }

    fn read(&self, url: &str, range: Option<Range<u64>>, tag: Option<&str>) -> io::Result<Vec<u8>> {
        let address = Address::parse(url)?;
        let store = self.store(&address)?;
        let options = GetOptions {
            range: range.map(GetRange::Bounded),
            if_match: tag.map(str::to_string),
            ..GetOptions::default()
        };
        let bytes = wait_for(async || store.get_opts(&address.name, options.clone()).await?.bytes().await)?;
        Ok(bytes.into())
    }

    fn list(&self, url: &str) -> io::Result<Vec<ObjectEntry>> {
        let address = Address::parse(url)?;
        if address.kind == Kind::Http {
            return Err(io::Error::new(io::ErrorKind::Unsupported, "HTTP servers do not list files"));
        }
        let store = self.store(&address)?;
        let found = wait_for(async || store.list_with_delimiter(Some(&address.name)).await)?;
        let folders = found.common_prefixes.iter().filter_map(|folder| folder.filename());
        let folders = folders.map(|name| ObjectEntry { name: name.to_string(), object: None });
        let objects = found.objects.into_iter().filter_map(|meta| {
            let name = meta.location.filename()?.to_string();
            Some(ObjectEntry { name, object: Some(info(meta)) })
        });
        Ok(folders.chain(objects).collect())
    }

    fn write(&self, url: &str, content: &mut dyn Read, length: u64, only_new: bool) -> io::Result<()> {
        let (store, address) = self.writable(url)?;
        let name = &address.name;
        if length <= PART {
            let mut bytes = Vec::new();
            content.take(length).read_to_end(&mut bytes)?;
            let mode = if only_new { PutMode::Create } else { PutMode::Overwrite };
            let payload = PutPayload::from(bytes.clone());
            let put = wait_for(async || {
                store.put_opts(name, payload.clone(), PutOptions::from(mode.clone())).await.map(drop)
            });
            return match put {
                // If an answer was lost, the object that exists is that of the first try.
                Err(cause)
                    if cause.kind() == io::ErrorKind::AlreadyExists
                        && self.read(url, None, None).is_ok_and(|there| there == bytes) =>
                {
                    Ok(())
                }
                put => put,
            };
        }
        let before = self.info(url).ok();
        if only_new && before.is_some() {
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, "the object already exists"));
        }
        let part = PART.max(length.div_ceil(PARTS));
        let mut upload = wait_for(async || store.put_multipart(name).await)
            .map(|upload| WriteMultipart::new_with_chunk_size(upload, part as usize))?;
        let mut left = length;
        let sent = loop {
            let mut bytes = Vec::new();
            if let Err(cause) = content.take(part.min(left)).read_to_end(&mut bytes) {
                break Err(cause);
            }
            if bytes.is_empty() {
                break Ok(());
            }
            left -= bytes.len() as u64;
            // Parts are sent by tasks of the runtime.
            let put = wait(async {
                upload.wait_for_capacity(AT_A_TIME).await?;
                upload.put(bytes.into());
                Ok(())
            });
            if put.is_err() {
                break put;
            }
        };
        match sent {
            Ok(()) => match runtime()?.block_on(upload.finish()) {
                // It was completed, and the answer was lost.
                Err(error)
                    if is_broken_off(&error)
                        && self.info(url).is_ok_and(|now| now.length == length && Some(now) != before) =>
                {
                    Ok(())
                }
                done => done.map(drop).map_err(|error| failure(&error)),
            },
            Err(cause) => {
                // Parts of an object that is never completed cost money.
                let _ = wait(async { upload.abort().await });
                Err(cause)
            }
        }
    }

    fn remove(&self, url: &str) -> io::Result<()> {
        let (store, address) = self.writable(url)?;
        wait_for(async || store.delete(&address.name).await)
    }

    fn remove_all(&self, url: &str) -> io::Result<()> {
        let (store, address) = self.writable(url)?;
        wait_for(async || {
            let names = store.list(Some(&address.name)).map_ok(|meta| meta.location).boxed();
            store
                .delete_stream(names)
                // Another process has just removed it.
                .filter(|removed| std::future::ready(!matches!(removed, Err(Error::NotFound { .. }))))
                .try_for_each(|_| std::future::ready(Ok(())))
                .await
        })
    }
}

fn info(meta: ObjectMeta) -> ObjectInfo {
    // Weak tags may stay the same although bytes differ, and servers do not compare them.
    let tag = meta.e_tag.filter(|tag| !tag.starts_with("W/"));
    ObjectInfo { length: meta.size, changed: meta.last_modified.into(), tag }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_server_without_tls_must_be_allowed() {
        let settings = [
            ("AWS_ENDPOINT_URL", "http://127.0.0.1:9"),
            ("AWS_ACCESS_KEY_ID", "somebody"),
            ("AWS_SECRET_ACCESS_KEY", "secret"),
        ];
        let settings = settings.map(|(name, value)| (name.to_string(), value.to_string()));
        let refused = Stores::new(settings.into()).info("s3://land/hills.tif").unwrap_err();
        assert!(refused.to_string().contains("AWS_ALLOW_HTTP=true"), "{refused}");
    }
}
