//! Starting and stopping a run.

use crate::messages::effect::Effect;
use crate::messages::requests::Target;
use crate::screens::state::State;

impl State {
    /// Runs the study, or the quickstart where there is none.
    pub fn start_run(&mut self) -> Vec<Effect> {
        if self.is_first_start() {
            return self.run(Target::Quickstart);
        }
        let Some(study) = self.data.as_ref().and_then(|data| data.study()) else { return vec![] };
        let target = Target::Study(study.path.clone());
        self.run(target)
    }

    /// Runs what is wanted, where that can be.
    pub fn run(&mut self, target: Target) -> Vec<Effect> {
        if !self.setup.abilities.run {
            self.complain("this workbench is read-only: start it without --readonly to run a study");
            return vec![];
        }
        if self.running.target.is_some() {
            self.say("a run goes on here already; X stops it");
            return vec![];
        }
        self.running.target = Some(target.clone());
        self.say("run started; it goes on in the background");
        vec![Effect::Run(target)]
    }

    /// Asks whether the run is to stop.
    pub fn stop_run(&mut self) {
        if self.running.target.is_none() {
            self.say("no run goes on here");
            return;
        }
        self.ask("Stop the run? Unfinished jobs go back to the queue.", vec![Effect::StopRun]);
    }
}
