//! `toile comment`: comments of fittings, in rounds.

use super::args::{Comment, Fittings};
use super::context::Context;
use super::{CliError, End, Outcome, output};
use advice::comments::fitted;
use results::assessment;
use store::comments::{self, Comment as Kept, Edit, Fitting, Remark, State};
use store::{Store, StudyError, Table, Value};

pub fn comment(context: &Context, command: &Comment) -> Outcome {
    match command {
        Comment::Ls(fittings) => list(context, fittings),
        Comment::Round(fittings) => round(context, fittings),
        Comment::Add { fitting, at: (side, place), text, severity, action } => {
            let (mut store, study, garment, subject) = one(context, fitting)?;
            let remark = Remark {
                side: *side,
                place: place.clone(),
                said: text.clone(),
                severity: (*severity).into(),
                cause: String::new(),
                action: action.clone(),
                quantity: None,
            };
            let of = Fitting { study: &study, garment: &garment, subject: &subject };
            let number = comments::add(&mut store, of, &remark)?;
            context.say(format_args!("comment {number} of {garment} on {subject}"));
            Ok(End::Done)
        }
        Comment::Set { fitting, number, status, severity, text, action, owner } => {
            let (mut store, study, garment, subject) = one(context, fitting)?;
            let edit = Edit {
                status: status.map(Into::into),
                severity: severity.map(Into::into),
                said: text.clone(),
                action: action.clone(),
                owner: owner.clone(),
                is_worded: None,
            };
            let of = Fitting { study: &study, garment: &garment, subject: &subject };
            comments::edit(&mut store, of, *number, &edit)?;
            Ok(End::Done)
        }
        Comment::Sign { fitting, by } => {
            let (mut store, study, garment, subject) = one(context, fitting)?;
            let of = Fitting { study: &study, garment: &garment, subject: &subject };
            let round = comments::sign(&mut store, of, by)?;
            context.say(format_args!("round {round} of {garment} on {subject} is signed by {by}"));
            Ok(End::Done)
        }
    }
}

fn list(context: &Context, fittings: &Fittings) -> Outcome {
    let store = context.store()?;
    let study = context.study_name(&store, &fittings.study)?;
    print(context, &kept(&store, &study, fittings)?)
}

/// Begins the next round of every fitting that is asked for.
fn round(context: &Context, fittings: &Fittings) -> Outcome {
    let (mut store, name) = context.eased(&fittings.study)?;
    let study = context.study(&store, &fittings.study)?;
    for worn in assessment::worn(&store, &name, fittings.garment.as_deref(), fittings.subject.as_deref())? {
        let (garment, subject) = (&worn.card.garment, &worn.card.subject);
        let Some(fitted) = fitted(&study, &worn)? else {
            context.say(format_args!("{garment} on {subject}: {}", worn.card.verdict()));
            continue;
        };
        if let Some(reason) = &fitted.untold {
            context.say(format_args!("{garment} on {subject}: no action is proposed: {reason}"));
        }
        let of = Fitting { study: &name, garment, subject };
        match comments::begin_round(&mut store, of, &fitted.size, &fitted.basis, &fitted.found)? {
            Some(round) => context.say(format_args!("{garment} on {subject}: round {round}, size {}", fitted.size)),
            None => context.say(format_args!("{garment} on {subject}: nothing has changed since the last round")),
        }
    }
    print(context, &kept(&store, &name, fittings)?)
}

fn kept(store: &Store, study: &str, fittings: &Fittings) -> Result<Vec<Kept>, CliError> {
    let is = |asked: &Option<String>, name: &str| asked.as_deref().is_none_or(|asked| asked == name);
    let all = comments::comments(store, study)?.into_iter();
    Ok(all.filter(|one| is(&fittings.garment, &one.garment) && is(&fittings.subject, &one.subject)).collect())
}

fn print(context: &Context, comments: &[Kept]) -> Outcome {
    if context.json {
        output::json(&comments)?;
    } else {
        context.print(&table(comments))?;
    }
    Ok(End::Done)
}

fn table(comments: &[Kept]) -> Table {
    let text = |text: &str| Value::Text(text.to_owned());
    let columns = [
        "garment", "subject", "size", "round", "no", "side", "place", "comment", "severity", "cause", "action",
        "owner", "status",
    ];
    let rows = comments.iter().map(|one| {
        let status = match (one.status, one.met_in) {
            (State::Met, Some(round)) => format!("met in round {round}"),
            (status, _) => status.as_str().to_owned(),
        };
        let Remark { side, place, said, severity, cause, action, .. } = &one.remark;
        vec![
            text(&one.garment),
            text(&one.subject),
            text(&one.size),
            Value::Integer(one.round),
            Value::Integer(one.number),
            text(side.as_str()),
            text(place),
            text(said),
            text(severity.as_str()),
            text(cause),
            text(action),
            text(&one.owner),
            Value::Text(status),
        ]
    });
    Table::new(columns, rows)
}

/// The one fitting that is asked for: store, study, garment, subject. Without names, that of a study with one.
fn one(context: &Context, fittings: &Fittings) -> Result<(Store, String, String, String), CliError> {
    let store = context.store()?;
    let study = context.study_name(&store, &fittings.study)?;
    let worn = assessment::worn(&store, &study, fittings.garment.as_deref(), fittings.subject.as_deref())?;
    let mut names: Vec<(String, String)> =
        worn.into_iter().map(|worn| (worn.card.garment, worn.card.subject)).collect();
    match names.len() {
        1 => {
            let (garment, subject) = names.remove(0);
            Ok((store, study, garment, subject))
        }
        _ => {
            let known = names.iter().map(|(garment, subject)| format!("{garment} on {subject}")).collect();
            Err(StudyError::Unsaid { what: "fitting", known }.into())
        }
    }
}
