//! Named steps in order, each timed; the first failure ends the run.

use std::time::Instant;

use crate::failure::{Failure, Result};
use crate::table;

/// A step.
pub struct Step {
    /// The name on the command line.
    pub name: &'static str,
    /// The description in the list.
    pub about: &'static str,
    /// The function.
    pub run: fn() -> Result,
}

/// Runs the named steps, or all of them, and prints the time of each. `command` is the command that runs a single step.
pub fn run(command: &str, steps: &[&Step], named: &[String]) -> Result {
    let chosen = choose(steps, named)?;
    let begun = Instant::now();
    let mut done: Vec<Vec<String>> = Vec::new();
    for step in chosen {
        println!("==> {}: {}", step.name, step.about);
        let start = Instant::now();
        let result = (step.run)();
        let seconds = format!("{:.1}", start.elapsed().as_secs_f64());
        if let Err(failure) = result {
            return Err(Failure::new(format!(
                "step '{}' failed after {seconds} s: {}\n       run it alone: {command} {}",
                step.name,
                failure.message(),
                step.name
            )));
        }
        println!("    {} done in {seconds} s", step.name);
        done.push(vec![step.name.to_owned(), seconds]);
    }
    println!("\n{}", table::render(&["step", "seconds"], &done));
    println!("all {} steps well in {:.1} s", done.len(), begun.elapsed().as_secs_f64());
    Ok(())
}

fn choose<'a>(steps: &[&'a Step], named: &[String]) -> Result<Vec<&'a Step>> {
    if let Some(unknown) = named.iter().find(|n| steps.iter().all(|s| s.name != n.as_str())) {
        let rows: Vec<Vec<String>> = steps.iter().map(|s| vec![format!("  {}", s.name), s.about.to_owned()]).collect();
        return Err(Failure::usage(format!("there is no step '{unknown}'; there are\n{}", table::render(&[], &rows))));
    }
    Ok(steps.iter().copied().filter(|s| named.is_empty() || named.iter().any(|n| n == s.name)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fine() -> Result {
        Ok(())
    }

    fn broken() -> Result {
        Err(Failure::new("it broke"))
    }

    const FINE: Step = Step { name: "fine", about: "goes well", run: fine };
    const BROKEN: Step = Step { name: "broken", about: "does not", run: broken };

    #[test]
    fn a_failure_names_the_step_and_how_to_run_it() {
        let failure = run("cargo xtask test", &[&FINE, &BROKEN], &[]).expect_err("the second step fails");
        assert!(failure.message().contains("step 'broken' failed"), "{}", failure.message());
        assert!(failure.message().ends_with("run it alone: cargo xtask test broken"), "{}", failure.message());
    }

    #[test]
    fn steps_are_chosen_by_name() {
        run("x", &[&FINE, &BROKEN], &["fine".to_owned()]).expect("the broken step is not chosen");
        let failure = run("x", &[&FINE], &["fin".to_owned()]).expect_err("no such step");
        assert!(failure.message().contains("no step 'fin'"), "{}", failure.message());
    }
}
