//! URLs of objects.

use std::io;

use object_store::path::Path;

/// The kind of a store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Amazon S3, or a server that is compatible with it.
    S3,
    /// Google Cloud Storage.
    Google,
    /// Azure Blob Storage.
    Azure,
    /// Files on an HTTP server.
    Http,
}

/// The URL of an object: a store and a name in it.
#[derive(Debug, PartialEq, Eq)]
pub struct Address {
    /// The kind of the store.
    pub kind: Kind,
    /// The URL up to the name, such as `s3://bucket`.
    pub root: String,
    /// The name of the object.
    pub name: Path,
}

impl Address {
    /// Splits a URL.
    pub fn parse(url: &str) -> io::Result<Address> {
        let refuse = |why: String| io::Error::new(io::ErrorKind::InvalidInput, why);
        let (scheme, rest) = url.split_once("://").ok_or_else(|| refuse("it is not a URL".into()))?;
        let (authority, name) = rest.split_once('/').unwrap_or((rest, ""));
        let kind = match scheme {
            "s3" => Kind::S3,
            "gs" => Kind::Google,
            "az" | "abfs" | "abfss" => Kind::Azure,
            "http" | "https" => Kind::Http,
            _ => return Err(refuse(format!("`{scheme}` is not the scheme of a known store"))),
        };
        if authority.is_empty() {
            let what = if kind == Kind::Http { "a server" } else { "a bucket" };
            return Err(refuse(format!("the URL names no {}", &what[2..])));
        }
        if kind == Kind::Http && name.contains(['?', '#']) {
            return Err(refuse("URLs with a query, such as signed ones, are not supported".into()));
        }
        let name = match kind {
            Kind::Http => Path::from_url_path(name),
            _ => Path::parse(name),
        };
        let name = name.map_err(|cause| refuse(format!("its name is not that of an object: {cause}")))?;
        Ok(Address { kind, root: format!("{scheme}://{authority}"), name })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn urls_are_split_into_store_and_name() {
        for (url, kind, root, name) in [
            ("s3://bucket/a/b.tif", Kind::S3, "s3://bucket", "a/b.tif"),
            ("s3://bucket", Kind::S3, "s3://bucket", ""),
            ("gs://b/höhe 1.tif", Kind::Google, "gs://b", "höhe 1.tif"),
            ("abfss://c@account.dfs.core.windows.net/x", Kind::Azure, "abfss://c@account.dfs.core.windows.net", "x"),
            ("http://127.0.0.1:80/a%20b/c.tif", Kind::Http, "http://127.0.0.1:80", "a b/c.tif"),
        ] {
            let address = Address::parse(url).unwrap();
            assert_eq!((address.kind, address.root.as_str(), address.name.as_ref()), (kind, root, name), "{url}");
        }
        for (url, expect) in [
            ("ftp://a/b", "`ftp` is not the scheme"),
            ("s3:///b", "the URL names no bucket"),
            ("https:///b", "the URL names no server"),
            ("s3://a/b//c", "its name is not that of an object"),
            ("s3://a/../c", "its name is not that of an object"),
            ("https://a/b?X-Amz-Signature=1", "URLs with a query"),
            ("a/b", "it is not a URL"),
        ] {
            let error = Address::parse(url).unwrap_err();
            assert!(error.to_string().contains(expect), "{url}: {error}");
        }
    }
}
