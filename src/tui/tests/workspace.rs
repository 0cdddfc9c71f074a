//! The workbench on a real database.

use std::sync::Arc;

use super::Bench;
use crate::messages::message::Message;
use crate::messages::requests::Command;
use crate::messages::snapshot::Focus;
use crate::threads::database::carry_out;
use crate::threads::reading;
use engine::{Executor, Outcome, RunOptions, run};
use sim::Monitor;
use spec::JobSpec;
use store::{Origin, Status, Store, StudyError};
use wardrobe::catalogue;

struct Refusing;

impl Executor for Refusing {
    fn execute(&self, spec: &JobSpec, _monitor: &mut dyn Monitor) -> Result<Outcome, StudyError> {
        let message = format!("size {} does not go over the head", spec.size);
        Err(StudyError::refused(Origin::Sim, message))
    }
}

#[test]
fn follows_a_run_and_acts_on_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
    let read = |store: &Store, focus: &Focus| reading::snapshot(store, focus).expect("readable");
    let mut bench = Bench::new(80, 24, read(&store, &Focus::default()));
    assert!(bench.app.state.is_first_start());

    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart");
    let study = run::load_study(&store, &path).expect("the quickstart is right");
    let run = run::start_with(&mut store, &study, &RunOptions::default(), Arc::new(Refusing)).expect("queued");
    run.join().expect("the database works");

    let data = read(&store, &Focus::default());
    let jobs = data.jobs.len();
    assert!(jobs > 0 && data.jobs.iter().all(|job| job.status == Status::Failed));
    let first = data.grid.as_ref().and_then(|grid| grid.cells[0][0][0].job).expect("queued");
    bench.app.update(Message::Data(Box::new(data)));
    assert_eq!(bench.app.state.focus.job, Some(first));
    bench.app.update(Message::Data(Box::new(read(&store, &bench.app.state.focus.clone()))));
    assert!(bench.screen().contains("does not go over"), "{}", bench.screen());

    assert!(carry_out(&mut store, &Command::Retry(vec![first])).expect("allowed").contains("is queued again"));
    assert!(carry_out(&mut store, &Command::Retry(vec![first])).expect("allowed").contains("is not run again"));
    assert!(carry_out(&mut store, &Command::Pause(study.name.clone())).expect("allowed").contains("is paused"));
    assert!(carry_out(&mut store, &Command::Pause("none".into())).is_err());
    bench.app.update(Message::Data(Box::new(read(&store, &bench.app.state.focus.clone()))));
    let screen = bench.screen();
    assert!(screen.contains(" paused ") && screen.contains(&format!("…1 ✗{}", jobs - 1)), "{screen}");
}
