//! Owners of running jobs: one run of one process of one machine, and a test of whether that process is still alive.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::rows::JobId;

/// Time without a change of the heartbeat after which an owner counts as dead, where nobody can ask for its process.
const LEASE: Duration = Duration::from_secs(60);

/// Name of one run: `host/boot/pid/start/number`, unique over machines and time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Owner(String);

impl Owner {
    #[allow(clippy::new_without_default, reason = "each is another one")]
    pub fn new() -> Self {
        static RUNS: AtomicU64 = AtomicU64::new(0);
        let pid = std::process::id();
        let start = start_ticks(pid).unwrap_or_default();
        Self(format!("{}/{}/{pid}/{start}/{}", host(), boot(), RUNS.fetch_add(1, Ordering::Relaxed)))
    }

    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Owner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&describe(&self.0))
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Runner {
    /// The process in words, with its machine.
    pub name: String,
    /// Number of the process, if it is one of this machine.
    pub pid: Option<u32>,
    pub jobs: usize,
}

impl Runner {
    pub(crate) fn new(owner: &str, jobs: usize) -> Self {
        let mut parts = owner.split('/');
        let is_here = parts.next() == Some(&host());
        let pid = parts.nth(1).and_then(|pid| pid.parse().ok()).filter(|_| is_here);
        Self { name: describe(owner), pid, jobs }
    }
}

pub(crate) fn describe(owner: &str) -> String {
    let mut parts = owner.split('/');
    match (parts.next(), parts.nth(1)) {
        (Some(host), Some(pid)) => format!("process {pid} on {host}"),
        _ => owner.to_owned(),
    }
}

/// True if an owner's process has ended; `None` where this machine cannot tell, as for another machine's.
pub(crate) fn is_dead(owner: &str) -> Option<bool> {
    let mut parts = owner.split('/');
    let (their_host, their_boot) = (parts.next()?, parts.next()?);
    let (pid, start): (u32, u64) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
    if their_host != host() || their_boot.is_empty() || boot().is_empty() {
        return None;
    }
    Some(their_boot != boot() || start_ticks(pid) != Some(start))
}

/// Heartbeats of other machines' jobs, as this run has seen them change. Their time stamps come from clocks that may be
/// wrong or be set. So a stamp is only compared with the one before, and the time since its last change is measured by
/// this machine's monotonic clock.
#[derive(Debug, Default)]
pub struct Watch(BTreeMap<JobId, (i64, Instant)>);

impl Watch {
    /// True if a job's heartbeat has stood still for longer than a lease.
    pub(crate) fn stands_still(&mut self, id: JobId, heartbeat: i64) -> bool {
        self.stood_still_until(id, heartbeat, Instant::now())
    }

    fn stood_still_until(&mut self, id: JobId, heartbeat: i64, now: Instant) -> bool {
        let (seen, since) = self.0.entry(id).or_insert((heartbeat, now));
        if *seen != heartbeat {
            (*seen, *since) = (heartbeat, now);
        }
        now.duration_since(*since) > LEASE
    }
}

pub fn host() -> String {
    let kernel = std::fs::read_to_string("/proc/sys/kernel/hostname").ok().filter(|name| !name.trim().is_empty());
    let name = kernel.or_else(|| std::env::var("HOSTNAME").ok()).unwrap_or_else(|| "localhost".into());
    name.trim().replace('/', "-")
}

/// Identifier of this boot of the machine; empty where the system has none.
fn boot() -> String {
    std::fs::read_to_string("/proc/sys/kernel/random/boot_id").map(|id| id.trim().to_owned()).unwrap_or_default()
}

/// Start of a process, clock ticks since boot; `None` when the process has ended. It tells a process from a later one
/// that has the same number.
fn start_ticks(pid: u32) -> Option<u64> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let state = fields.next()?;
    if matches!(state, "Z" | "X") {
        return None;
    }
    fields.nth(18)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heartbeat_is_watched_by_a_clock_that_nobody_sets() {
        let (mut watch, start) = (Watch::default(), Instant::now());
        let mut check = |heartbeat: i64, seconds: u64, dead: bool| {
            let now = start + Duration::from_secs(seconds);
            assert_eq!(watch.stood_still_until(JobId(1), heartbeat, now), dead, "{heartbeat} after {seconds} s");
        };
        check(9_000_000, 0, false); // a stamp of the future, from before a clock was set back
        check(9_000_000, 59, false);
        check(5_000, 61, false); // it lives, on a clock that was set back
        check(5_000, 121, false);
        check(5_000, 122, true);
    }

    #[test]
    fn this_process_lives_and_others_are_told_apart() {
        let mine = Owner::new();
        if boot().is_empty() {
            assert_eq!(is_dead(mine.as_str()), None);
            return;
        }
        assert_eq!(is_dead(mine.as_str()), Some(false));
        assert_eq!(is_dead(&format!("{}/{}/{}/1/0", host(), boot(), std::process::id())), Some(true), "number reused");
        assert_eq!(is_dead(&format!("{}/another-boot/1/1/0", host())), Some(true), "machine restarted");
        assert_eq!(is_dead("another-host/boot/1/1/0"), None);
        assert_eq!(is_dead("not an owner"), None);
    }
}
