//! The audit of the thesis's tables: each kind of check over all of them.

use crate::audit::tables::Tables;
use crate::audit::{Audit, claims, equations, metrics, ratios, references, structure};

type Check = fn(&Tables) -> Audit;

/// In the order in which their findings are listed.
const CHECKS: [Check; 7] =
    [ratios::check, metrics::check, structure::check, metrics::subjects, references::check, claims::check, |_| {
        equations::check()
    }];

pub(super) fn audit(tables: &Tables) -> Audit {
    let mut audit = Audit { recomputed: 0, findings: Vec::new() };
    for check in CHECKS {
        let Audit { recomputed, findings } = check(tables);
        audit.recomputed += recomputed;
        audit.findings.extend(findings);
    }
    audit
}
