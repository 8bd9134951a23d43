use super::*;
use std::io::{Read, Seek, SeekFrom};

fn kind<T: std::fmt::Debug>(result: io::Result<T>) -> io::ErrorKind {
    result.unwrap_err().kind()
}

#[test]
fn files_are_written_read_renamed_and_removed() {
    create_dir_all("/files/deep").unwrap();
    let path = Path::new("/files/deep/a.txt");
    write(path, "first").unwrap();
    write("/files/deep/../deep/./a.txt", "again").unwrap();
    assert_eq!(read_to_string("files/deep/a.txt").unwrap(), "again");
    assert_eq!(kind(write_new(path, "no")), io::ErrorKind::AlreadyExists);
    assert_eq!(kind(write("/files/none/a", "")), io::ErrorKind::NotFound);
    assert_eq!(kind(read("/files/deep")), io::ErrorKind::IsADirectory);
    assert_eq!(kind(remove_dir("/files/deep")), io::ErrorKind::DirectoryNotEmpty);

    rename(path, "/files/b.txt").unwrap();
    hard_link("/files/b.txt", "/files/c.txt").unwrap();
    assert_eq!(kind(hard_link("/files/b.txt", "/files/c.txt")), io::ErrorKind::AlreadyExists);
    remove_file("/files/b.txt").unwrap();
    assert_eq!((kind(metadata(path)), metadata("/files/c.txt").unwrap().len()), (io::ErrorKind::NotFound, 5));
    let names: Vec<OsString> = read_dir("/files").unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["c.txt", "deep"]);
    assert!(metadata("/").unwrap().is_dir() && canonicalize("/files/deep/..").unwrap() == Path::new("/files"));
    remove_dir_all("/files").unwrap();
    assert_eq!(kind(read_dir("/files")), io::ErrorKind::NotFound);
}

#[test]
fn an_open_file_has_a_position_and_outlives_its_name() {
    create_dir_all("/open").unwrap();
    let mut file = OpenOptions::new().read(true).write(true).create_new(true).open("/open/a").unwrap();
    file.write_all(b"0123456789").unwrap();
    file.seek(SeekFrom::Start(4)).unwrap();
    file.write_all(b"ab").unwrap();
    remove_file("/open/a").unwrap();
    assert_eq!(file.seek(SeekFrom::End(-6)).unwrap(), 4);
    let mut text = String::new();
    (&file).read_to_string(&mut text).unwrap();
    assert_eq!(text, "ab6789");
    file.set_len(2).unwrap();
    file.seek(SeekFrom::Start(4)).unwrap();
    file.write_all(b"x").unwrap();
    assert_eq!(file.metadata().unwrap().len(), 5);
    assert_eq!(kind(file.seek(SeekFrom::End(-6))), io::ErrorKind::InvalidInput);

    write("/open/log", "a").unwrap();
    let mut log = OpenOptions::new().append(true).open("/open/log").unwrap();
    log.write_all(b"b").unwrap();
    assert_eq!(read("/open/log").unwrap(), b"ab");
}

#[test]
fn a_lock_ends_with_its_file() {
    create_dir_all("/locks").unwrap();
    let first = File::create("/locks/a").unwrap();
    first.try_lock().unwrap();
    let second = File::open("/locks/a").unwrap();
    assert!(matches!(second.try_lock(), Err(TryLockError::WouldBlock)));
    drop(first);
    second.try_lock().unwrap();
}

#[test]
fn changes_are_the_paths_that_were_written_or_removed() {
    create_dir_all("/changes").unwrap();
    write("/changes/a", "1").unwrap();
    write("/changes/b", "1").unwrap();
    let own = |(number, paths): (u64, Vec<PathBuf>)| {
        let names = paths.iter().filter_map(|path| path.strip_prefix("/changes").ok()?.to_str()).map(str::to_owned);
        (number, names.collect::<Vec<_>>())
    };
    let (number, all) = own(changes(0));
    assert_eq!(all, ["a", "b"]);
    write("/changes/b", "2").unwrap();
    assert_eq!(own(changes(number)).1, ["b"]);
    let (number, _) = changes(0);
    rename("/changes/a", "/changes/c").unwrap();
    let (number, moved) = own(changes(number));
    assert_eq!(moved, ["a", "c"]);
    assert_eq!(own(changes(number)).1, Vec::<String>::new());
}
