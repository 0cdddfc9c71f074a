//! Size that a subject should wear, with the ease at every level and the tension of the cloth there.

use crate::fit_card::{FitCard, fit_cards};
use crate::picture::{self, tension_near};
use fit::{self, Simulator};
use store::{EaseRow, JobFilter, JobId, JobRow, PUBLISHED, RecommendationRow, Result, Store, StudyError, read};

/// All sizes of a garment on a subject, and the one to wear.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeAnswer {
    pub garment: String,
    pub subject: String,
    pub wear: String,
    /// Reason for this size and against the others.
    pub reason: String,
    /// Sizes in the order of the study file.
    pub sizes: Vec<SizeOn>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SizeOn {
    pub size: String,
    pub levels: Vec<LevelFit>,
    pub shown: &'static str,
}

#[derive(Clone, Debug, PartialEq)]
pub struct LevelFit {
    pub ease: EaseRow,
    /// Mean tension of the FEM-GS drape near that level; `None` without such a drape.
    pub tension_n_m: Option<f64>,
}

/// Size that a subject should wear, for every garment of a study (or for `garment`) with a known ease on that subject.
pub fn size_advice(store: &Store, study: &str, subject: &str, garment: Option<&str>) -> Result<Vec<SizeAnswer>> {
    if study == PUBLISHED {
        let known = read::studies(store)?.into_iter().map(|study| study.name).collect();
        return Err(StudyError::NotFound { what: "study with pattern girths", name: study.to_owned(), known });
    }
    let eases = read::ease(store, study)?;
    let names = |name: fn(&EaseRow) -> &String| -> Vec<String> {
        let mut names: Vec<String> = eases.iter().map(|ease| name(ease).clone()).collect();
        names.sort();
        names.dedup();
        names
    };
    let (subjects, garments) = (names(|ease| &ease.subject), names(|ease| &ease.garment));
    if !subjects.iter().any(|name| name == subject) {
        return Err(StudyError::NotFound { what: "subject", name: subject.to_owned(), known: subjects });
    }
    if let Some(garment) = garment.filter(|garment| !garments.iter().any(|name| name == garment)) {
        return Err(StudyError::NotFound { what: "garment", name: garment.to_owned(), known: garments });
    }
    let jobs = read::jobs(store, &JobFilter { study: Some(study.to_owned()), ..JobFilter::default() })?;
    let recommended = read::recommendations(store, study)?;
    let cards = fit_cards(store, study, None, None)?;
    let mut answers = Vec::new();
    for name in garments.iter().filter(|name| garment.is_none_or(|garment| garment == *name)) {
        let own = eases.iter().filter(|ease| ease.subject == subject && ease.garment == *name);
        answers.extend(size_answer(store, &own.collect::<Vec<_>>(), &jobs, &recommended, &cards)?);
    }
    Ok(answers)
}

/// `None` without eases.
fn size_answer(
    store: &Store,
    eases: &[&EaseRow],
    jobs: &[JobRow],
    answers: &[RecommendationRow],
    cards: &[FitCard],
) -> Result<Option<SizeAnswer>> {
    let Some(first) = eases.first() else { return Ok(None) };
    let mut sizes: Vec<SizeOn> = Vec::new();
    for of_size in eases.chunk_by(|a, b| a.size == b.size) {
        let worn = match drape_of(of_size[0], jobs) {
            Some(id) => Some(picture::dressed(store, id)?),
            None => None,
        };
        let mut levels = Vec::new();
        for ease in of_size {
            let tension_n_m = worn.as_ref().map(|worn| tension_near(worn, &ease.level)).transpose()?.flatten();
            levels.push(LevelFit { ease: (*ease).clone(), tension_n_m });
        }
        sizes.push(SizeOn { size: of_size[0].size.clone(), levels, shown: shown(of_size, answers) });
    }
    let (garment, subject) = (first.garment.clone(), first.subject.clone());
    let card = cards.iter().find(|card| card.garment == garment && card.subject == subject);
    let worn = card.and_then(|card| Some((card.to_wear()?.size.clone(), card.reasons())));
    Ok(worn.map(|(wear, reason)| SizeAnswer { garment, subject, wear, reason, sizes }))
}

/// Picture of a size that a customer should see, chosen by the eases of the size.
fn shown(of_size: &[&EaseRow], answers: &[RecommendationRow]) -> &'static str {
    let Some(decides) = of_size.iter().find(|ease| ease.decides).or(of_size.first()) else { return "" };
    let answer = answers.iter().find(|row| row.garment == decides.garment && row.class == decides.fit.class);
    let recommended = answer.map_or_else(|| decides.fit.class.rule_says(), |row| row.recommended);
    fit::shown(recommended, decides.fit.undersized).words()
}

/// FEM-GS job with a result in the size and on the subject of an ease.
fn drape_of(ease: &EaseRow, jobs: &[JobRow]) -> Option<JobId> {
    let is_it = |job: &&JobRow| {
        (&job.garment, &job.size, &job.subject) == (&ease.garment, &ease.size, &ease.subject)
            && job.simulator == Simulator::Fem
            && job.status.has_result()
    };
    jobs.iter().find(is_it).map(|job| job.id)
}
