//! The jobs of docs/jobs.md, done with the commands given there.

use crate::harness::{Folder, words};

const PAGE: &str = include_str!("../../../../docs/jobs.md");

/// Generates a test for each job, and one for their number.
macro_rules! jobs {
    ($($name:ident: $title:literal,)*) => {
        $(#[test]
        fn $name() {
            do_job($title);
        })*

        #[test]
        fn every_job_has_a_test() {
            let titles: Vec<&str> = PAGE.lines().filter_map(|line| line.strip_prefix("## ")).collect();
            assert_eq!(titles, [$($title),*]);
        }
    };
}

jobs! {
    a_paper: "show noises and fractals in a paper",
    a_unity_island: "bring an island into Unity",
    a_dem: "analyze a DEM",
    a_campaign_map: "draw the map of a campaign",
    a_valley_of_blocks: "build a valley of blocks",
    a_print: "print a mountain",
}

/// Writes the files of a job, runs its commands, and checks that the expected files were written.
fn do_job(title: &str) {
    let Some((_, job)) = PAGE.split_once(&format!("## {title}\n")) else { panic!("{title} is not on the page") };
    let job = job.split("\n## ").next().unwrap_or_default();
    let folder = Folder::with_solutions();
    // The last name before a code block is the name of its file.
    let parts: Vec<&str> = job.split("\n```").collect();
    for pair in parts.chunks_exact(2) {
        let (Some(name), Some((_, content))) = (pair[0].split('`').nth_back(1), pair[1].split_once('\n')) else {
            panic!("a block of {title} has no file")
        };
        folder.write(name, content);
    }
    let commands = job.lines().filter_map(|line| line.strip_prefix("    orogen "));
    let mut done = 0;
    for command in commands {
        let arguments = words(command);
        folder.good(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        let Some(at) = arguments.iter().position(|argument| argument == "-o") else { panic!("{command} has no -o") };
        let out = folder.path(&arguments[at + 1]);
        assert!(out.is_dir() || out.metadata().is_ok_and(|file| file.len() > 100), "{command}: {}", out.display());
        done += 1;
    }
    assert!(done >= 3, "{title}: {done} commands");
}
