//! Files that come from the computer or from the host, and files that go to the computer.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

use js_sys::{Array, Uint8Array};
use orogen::io::format::zip_writer::ZipWriter;
use orogen::io::fs;
use wasm_bindgen::JsCast as _;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Blob, File, HtmlAnchorElement, HtmlInputElement, Response, Url};

use super::warn;

/// A file that arrives later: its path, or why there is none.
pub type Chosen = Receiver<Result<PathBuf, String>>;

/// Asks for a file of the computer with one of these extensions. `wake` is called when it is there.
pub fn choose(extensions: &[&str], wake: impl Fn() + 'static) -> Option<Chosen> {
    let document = web_sys::window()?.document()?;
    let input: HtmlInputElement = document.create_element("input").ok()?.unchecked_into();
    input.set_type("file");
    let list: Vec<String> = extensions.iter().map(|extension| format!(".{extension}")).collect();
    input.set_accept(&list.join(","));
    let (sender, chosen) = channel();
    let own = input.clone();
    let take = Closure::once_into_js(move || {
        if let Some(file) = own.files().and_then(|files| files.get(0)) {
            read(file, sender, wake);
        }
    });
    input.set_onchange(Some(take.unchecked_ref()));
    input.click();
    Some(chosen)
}

/// Reads a file that was dropped onto the window.
#[cfg(feature = "window")]
#[must_use]
pub fn receive(file: &eframe::egui::DroppedFileHandle, wake: impl Fn() + 'static) -> Option<Chosen> {
    let (sender, chosen) = channel();
    let file = std::sync::Arc::clone(file);
    spawn_local(async move {
        let name = file.path().to_string_lossy().into_owned();
        let put = match file.bytes_async().await {
            Ok(bytes) => put(&name, &bytes),
            Err(cause) => Err(format!("{name} cannot be read: {cause}")),
        };
        // The window may no longer wait for it.
        let _ = sender.send(put);
        wake();
    });
    Some(chosen)
}

/// Reads a chosen file into the user's folder.
fn read(file: File, sender: Sender<Result<PathBuf, String>>, wake: impl Fn() + 'static) {
    spawn_local(async move {
        let (name, bytes) = (file.name(), JsFuture::from(file.array_buffer()).await);
        let put = match bytes {
            Ok(bytes) => put(&name, &Uint8Array::new(&bytes).to_vec()),
            Err(_) => Err(format!("{name} cannot be read")),
        };
        // The window may no longer wait for it.
        let _ = sender.send(put);
        wake();
    });
}

/// Puts a file into the user's folder. It gets a number if there is another one of its name.
fn put(name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
    let own = Path::new("/").join(name.replace(['/', '\\'], "_"));
    let (stem, end) = (own.file_stem().unwrap_or_default().to_string_lossy(), own.extension());
    let numbered = |number: u32| {
        let numbered = own.with_file_name(format!("{stem} {number}"));
        end.map_or(numbered.clone(), |end| PathBuf::from(format!("{}.{}", numbered.display(), end.to_string_lossy())))
    };
    let is_free = |path: &PathBuf| fs::read(path).map_or(true, |there| there == bytes);
    let names = std::iter::once(own.clone()).chain((2..).map(numbered));
    let path = names.into_iter().find(is_free).unwrap_or_else(|| own.clone());
    fs::write(&path, bytes).map_err(|cause| format!("cannot write {}: {cause}", path.display()))?;
    Ok(path)
}

/// Reads a file of the page's own host into the user's folder. `address` is relative to the page.
///
/// # Errors
/// If the address leads to another host, or there is no such file.
pub async fn fetch(address: &str) -> Result<PathBuf, String> {
    let window = web_sys::window().ok_or("there is no window")?;
    let location = window.location();
    let here = location.href().map_err(|_| "the page has no address")?;
    let wrong = |why: &str| format!("cannot open `{address}`: {why}");
    let url = Url::new_with_base(address, &here).map_err(|_| wrong("it is not an address"))?;
    if Ok(url.origin()) != location.origin() {
        return Err(wrong("it is on another host; download it, and open the file"));
    }
    let response = JsFuture::from(window.fetch_with_str(&url.href())).await;
    let response: Response = response.map_err(|_| wrong("the host does not answer"))?.unchecked_into();
    if !response.ok() {
        let (status, text) = (response.status(), response.status_text());
        return Err(wrong(&format!("the host answers {status} {text}")));
    }
    let body = response.array_buffer().map_err(|_| wrong("it has no content"))?;
    let bytes = JsFuture::from(body).await.map_err(|_| wrong("the connection was lost"))?;
    let name = url.pathname();
    let name = name.rsplit('/').next().filter(|name| !name.is_empty()).ok_or_else(|| wrong("it names no file"))?;
    put(name, &Uint8Array::new(&bytes).to_vec())
}

/// Hands a file to the user as a download.
pub fn download(name: &str, bytes: &[u8]) {
    if offer(name, bytes).is_none() {
        warn(&format!("{name} cannot be downloaded"));
    }
}

fn offer(name: &str, bytes: &[u8]) -> Option<()> {
    let window = web_sys::window()?;
    let parts = Array::of1(&Uint8Array::from(bytes));
    let blob = Blob::new_with_u8_array_sequence(&parts).ok()?;
    let url = Url::create_object_url_with_blob(&blob).ok()?;
    let link: HtmlAnchorElement = window.document()?.create_element("a").ok()?.unchecked_into();
    link.set_href(&url);
    link.set_download(name);
    link.click();
    // The browser reads it after this function has returned.
    let free = Closure::once_into_js(move || drop(Url::revoke_object_url(&url)));
    let wait = 60_000;
    window.set_timeout_with_callback_and_timeout_and_arguments_0(free.unchecked_ref(), wait).ok()?;
    Some(())
}

/// Downloads what a task has made: a file, or several in one archive.
pub fn hand_over(mut made: Vec<(String, Vec<u8>)>) {
    let first = made.first().map(|(path, _)| PathBuf::from(path));
    let Some(first) = first else { return };
    if made.len() == 1 {
        if let Some((_, bytes)) = made.pop() {
            download(&first.file_name().unwrap_or_default().to_string_lossy(), &bytes);
        }
        return;
    }
    let folder = first.ancestors().nth(1).and_then(Path::file_name).or(first.file_stem()).unwrap_or_default();
    let name = format!("{}.zip", folder.to_string_lossy());
    let entries: Vec<(&str, &[u8])> =
        made.iter().map(|(path, bytes)| (path.trim_start_matches('/'), bytes.as_slice())).collect();
    match archive(&entries) {
        Ok(bytes) => download(&name, &bytes),
        Err(cause) => warn(&format!("{name} cannot be made: {cause}")),
    }
}

fn archive(entries: &[(&str, &[u8])]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut zip = ZipWriter::new(&mut bytes);
    for (name, content) in entries {
        zip.file(name, |out| out.write_all(content))?;
    }
    zip.finish()?;
    Ok(bytes)
}
