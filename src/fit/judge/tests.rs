use super::super::resample::Draw;
use super::super::{Errors, rule_score, wins};
use super::*;

/// Pairs of `subjects` subjects whose EI differs by `effect` on average. The standard deviation is `spread` over
/// subjects and half of that over measurements.
fn study(draw: &mut Draw, garments: usize, subjects: usize, effect: f64, spread: f64) -> (Vec<Cell>, Vec<Pair>) {
    let names: Vec<String> = (0..garments).map(|g| format!("g{g}")).collect();
    let mut pairs = Vec::new();
    for garment in &names {
        for subject in 0..subjects {
            let own = effect + spread * draw.normal();
            let errors = (1..=9).map(|no| {
                let difference = own + 0.5 * spread * draw.normal();
                let (fem, hybrid) = (0.1 + difference / 2.0, 0.1 - difference / 2.0);
                Errors { no, name: format!("m{no}"), fem, hybrid, free_edge: no == 6, controlled: false }
            });
            pairs.push(Pair {
                garment: garment.clone(),
                size: "S".into(),
                subject: subject.to_string(),
                class: FitClass::Loose,
                ease_m: 0.12,
                errors: errors.collect(),
            });
        }
    }
    let cell = |garment: &String| Cell { garment: garment.clone(), class: FitClass::Loose };
    (names.iter().map(cell).collect(), pairs)
}

fn share(studies: usize, garments: usize, subjects: usize, effect: f64, spread: f64, findings: &[Finding]) -> f64 {
    let mut draw = Draw::new(8);
    let found = (0..studies).filter(|_| {
        let (cells, pairs) = study(&mut draw, garments, subjects, effect, spread);
        judge(&cells, &pairs).answers.iter().any(|answer| findings.contains(&answer.finding))
    });
    found.count() as f64 / studies as f64
}

#[test]
fn without_a_difference_hardly_any_study_finds_one() {
    let wrong = [Finding::Fem, Finding::Hybrid];
    for (subjects, spread) in [(6, 0.02), (12, 0.05)] {
        let found = share(150, 3, subjects, 0.0, spread, &wrong);
        assert!(found <= 0.05, "{subjects} subjects, spread {spread}: {found}");
    }
    // A difference at the margin is not called none, nor is one of twice the margin.
    for effect in [0.01, 0.02] {
        let found = share(150, 1, 12, effect, 0.01, &[Finding::NoDifference]);
        assert!(found <= 0.05, "effect {effect}: {found}");
    }
}

/// docs/evidence.md states these rates.
#[test]
fn a_difference_of_two_hundredths_is_found() {
    let found = share(200, 1, 12, 0.02, 0.01, &[Finding::Hybrid]);
    assert!((0.80..=0.97).contains(&found), "{found}");
    let equal = share(100, 1, 12, 0.0, 0.01, &[Finding::NoDifference]);
    assert!(equal > 0.6, "{equal}");
}

fn answer_for(errors: &[(f64, f64)], subjects: usize, class: FitClass) -> Answer {
    let pair = |subject: usize| Pair {
        garment: "tee".into(),
        size: "S".into(),
        subject: subject.to_string(),
        class,
        ease_m: 0.0,
        errors: (1..)
            .zip(errors)
            .map(|(no, &(fem, hybrid))| {
                let wobble = 0.001 * (subject as f64 - subjects as f64 / 2.0);
                Errors { no, name: format!("m{no}"), fem: fem + wobble, hybrid, free_edge: no == 2, controlled: false }
            })
            .collect(),
    };
    let pairs: Vec<Pair> = (0..subjects).map(pair).collect();
    judge(&[Cell { garment: "tee".into(), class }], &pairs).answers.remove(0)
}

#[test]
fn the_evidence_speaks_or_says_why_not() {
    let check = |errors: &[(f64, f64)], n: usize, class: FitClass, finding: Finding, use_: Simulator, says: &str| {
        let answer = answer_for(errors, n, class);
        let all = format!("{} {}", answer.reason, answer.would_settle);
        assert!((answer.finding, answer.recommended()) == (finding, use_) && all.contains(says), "{answer:#?}");
        assert_eq!(answer.basis() == Basis::Evidence, finding.simulator().is_some());
    };
    use FitClass::{Loose, Tight};
    use Simulator::{Fem, Hybrid};
    let (sure, none) = ([(0.02, 0.06), (0.03, 0.06)], [(0.02, 0.021), (0.03, 0.03)]);
    check(&sure, 8, Loose, Finding::Fem, Fem, "supports the rule");
    check(&sure, 8, Tight, Finding::Fem, Fem, "contradicts the rule");
    check(&none, 8, Tight, Finding::NoDifference, Hybrid, "no practical difference");
    check(&none, 5, Loose, Finding::NoDifference, Fem, "no practical difference");
    check(&none, 4, Loose, Finding::InsufficientEvidence, Fem, "1 subject more");
    check(&sure, 5, Tight, Finding::InsufficientEvidence, Hybrid, "fewer than 6");
    check(&sure, 5, Tight, Finding::InsufficientEvidence, Hybrid, "1 subject more");
    check(&sure, 0, Loose, Finding::InsufficientEvidence, Fem, "6 subjects with this fit");
    check(&[(0.03, 0.04), (0.03, 0.04)], 8, Loose, Finding::InsufficientEvidence, Fem, "the rule stands");
    // One measurement decides: without it the sign turns.
    let neck = [(0.03, 0.04), (0.25, 0.05), (0.03, 0.04)];
    check(&neck, 8, Loose, Finding::InsufficientEvidence, Fem, "without #2 m2 it is");
}

#[test]
fn what_hybrid_sets_is_no_evidence_for_it() {
    let judged = |controlled: &[u32]| {
        let (cells, mut pairs) = study(&mut Draw::new(5), 1, 10, 0.03, 0.004);
        let errors = pairs.iter_mut().flat_map(|pair| &mut pair.errors);
        errors.for_each(|e| e.controlled = controlled.contains(&e.no));
        judge(&cells, &pairs).answers.remove(0)
    };
    assert_eq!(judged(&[]).finding, Finding::Hybrid);
    assert_eq!(judged(&[1, 6]).finding, Finding::Hybrid);
    let all = judged(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    assert!(all.finding == Finding::InsufficientEvidence && all.reason.contains("circular"), "{}", all.reason);
}

#[test]
fn several_tests_share_one_level() {
    let mut draw = Draw::new(3);
    let (cells, pairs) = study(&mut draw, 3, 6, 0.1, 0.001);
    let evidence = judge(&cells, &pairs);
    for answer in &evidence.answers {
        assert!((answer.p_holm.expect("six subjects") - 3.0 / 32.0).abs() < 1e-12);
        assert_eq!(answer.finding, Finding::InsufficientEvidence, "{}", answer.reason);
        assert!(answer.would_settle.starts_with("1 subject more"), "{}", answer.would_settle);
    }
    assert_eq!(evidence.garments.len(), 3);
    assert_eq!(evidence.garments[0].analysis.told_apart[0].what, "free edges");
    let all: Vec<&Pair> = pairs.iter().collect();
    assert_eq!(wins(&all, |_| true), [0, 18]);
    assert_eq!((rule_score(&pairs).right, rule_score(&pairs).of), (0, 18));
}
