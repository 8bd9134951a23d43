//! The studio and the book are files of a folder, and nothing else is.

use super::HILLS;
use super::client::start;

#[test]
fn files_of_the_folder_are_served_and_no_others() {
    let folder = std::env::temp_dir().join(format!("orogen-serve-site-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("studio/deep")).unwrap();
    for (name, text) in
        [("studio/index.html", "<p>studio</p>"), ("studio/deep/a.wasm.gz", "abc"), ("secret.txt", "secret")]
    {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let path = folder.to_str().unwrap().to_string();
    let server = start(&[("hills", HILLS)], &[("web", path.as_str()), ("token", "secret-token-of-a-test")]);
    for (path, status, kind, text) in [
        ("/studio/", 200, "text/html; charset=utf-8", "<p>studio</p>"),
        ("/studio/index.html", 200, "text/html; charset=utf-8", "<p>studio</p>"),
        ("/studio/deep/a.wasm.gz", 200, "application/octet-stream", "abc"),
        ("/studio/deep/", 404, "application/json", "is no file of the studio"),
        ("/studio/../secret.txt", 404, "application/json", "error"),
        ("/studio/%2e%2e/secret.txt", 404, "application/json", "error"),
        ("/studio/..%2fsecret.txt", 404, "application/json", "error"),
        ("/studio//secret.txt", 404, "application/json", "error"),
        ("/book/", 404, "application/json", "`cargo xtask book` makes its files"),
    ] {
        let reply = server.get(path);
        assert_eq!((reply.status, reply.header("content-type")), (status, kind), "{path}");
        assert!(reply.text().contains(text), "{path}: {}", reply.text());
    }
    let reply = server.get("/studio/");
    assert_eq!(reply.header("cross-origin-opener-policy"), "same-origin");
    assert_eq!(reply.header("cross-origin-embedder-policy"), "require-corp");
    assert_eq!(server.ask("GET", "/studio/", &[&format!("If-None-Match: {}", reply.header("etag"))]).status, 304);
    assert_eq!((server.get("/studio").status, server.get("/studio").header("location")), (308, "studio/"));
    let world = server.get("/world.json?token=secret-token-of-a-test").json();
    assert_eq!((&world["has_studio"], &world["has_book"]), (&true.into(), &false.into()));
    let recipe = server.get("/recipe.toml?seed=5&token=secret-token-of-a-test");
    assert!(orogen::Recipe::parse(recipe.text(), "served").is_ok_and(|recipe| recipe.world.seed == 5));
    drop(server);
    std::fs::remove_dir_all(&folder).unwrap();
    let options = super::client::options(&[("web", path.as_str())]);
    let refused = crate::Server::new(super::client::session(), &options).err().unwrap().to_string();
    assert!(refused.contains("neither a folder `studio` nor a folder `book`"), "{refused}");
}
