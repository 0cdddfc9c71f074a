//! `toile recommend`: the simulator for each fit class, with its evidence.

use std::fmt::Write as _;

use super::answers::NO_EASE;
use super::args::Recommend;
use super::context::Context;
use super::{CliError, End, Outcome, output};
use fit::{Analysis, Answer, Estimate, Simulator, Without};
use store::{PUBLISHED, Store, Table, Value, evidence, read};

pub fn recommend(context: &Context, arguments: &Recommend) -> Outcome {
    let (mut store, name) = context.eased(&arguments.study)?;
    if name != PUBLISHED {
        evidence::update_evidence(&mut store, &name)?;
    }
    let evidence = evidence::evidence(&store, &name)?;
    let is_asked = |garment: &str| arguments.garment.as_deref().is_none_or(|asked| asked == garment);
    let answers: Vec<&Answer> = evidence.answers.iter().filter(|answer| is_asked(&answer.garment)).collect();
    if answers.is_empty() && read::ease(&store, &name)?.is_empty() {
        context.say(NO_EASE);
    } else if answers.is_empty() {
        context
            .say(format_args!("study {name} has no drapes yet; `toile run {}` makes them", arguments.study.display()));
    }
    context.print(&table(&answers, arguments.explain || context.json, context.json))?;
    if arguments.explain && !context.json {
        output::text(&explained(&store, &name, &answers)?)?;
    }
    Ok(End::Done)
}

fn table(answers: &[&Answer], numbers: bool, sentences: bool) -> Table {
    let text = |text: &str| Value::Text(text.to_owned());
    let real = |number: Option<f64>| number.map_or(Value::Null, Value::Real);
    let mut columns = vec!["garment", "fit_class", "recommended", "basis", "verdict", "n_subjects"];
    if numbers {
        columns.extend(["rule_says", "effect", "ci_low", "ci_high", "effect_size", "p", "p_holm", "p_equivalence"]);
    }
    if sentences {
        columns.extend(["reason", "would_settle"]);
    }
    let row = |answer: &&Answer| {
        let mut row = vec![
            text(&answer.garment),
            text(answer.class.as_str()),
            text(answer.recommended().as_str()),
            text(answer.basis().as_str()),
            text(answer.finding.as_str()),
            Value::Integer(answer.analysis.subjects.len() as i64),
        ];
        if numbers {
            let estimate = answer.analysis.estimate;
            let interval = estimate.and_then(|e| e.interval);
            row.push(text(answer.class.rule_says().as_str()));
            row.extend([estimate.map(|e| e.mean), interval.map(|i| i.0), interval.map(|i| i.1)].map(real));
            let p = [estimate.and_then(|e| e.size), estimate.map(|e| e.p), answer.p_holm];
            row.extend(p.map(real));
            row.push(real(estimate.and_then(|e| e.p_equivalence)));
        }
        if sentences {
            row.extend([text(&answer.reason), text(&answer.would_settle)]);
        }
        row
    };
    Table::new(columns, answers.iter().map(row))
}

/// Text with every answer in words, then the answers for whole garments, and the rule.
fn explained(store: &Store, study: &str, answers: &[&Answer]) -> Result<String, CliError> {
    let mut text = String::from(
        "\nEffects are EI of FEM-GS less EI of Hybrid-GS, mean over subjects (95 % bootstrap interval): below 0 FEM-GS is truer.\n",
    );
    for answer in answers {
        let name = simulator_name(answer.recommended());
        let _ = write!(
            text,
            "\n{}, {} fit: {name}, by the {}\n",
            answer.garment,
            answer.class.as_str(),
            answer.basis().as_str()
        );
        line(&mut text, "why", &answer.reason);
        analysed(&mut text, &answer.analysis, answer.p_holm);
        if let Some([own, constant]) = answer.regret {
            line(
                &mut text,
                "held out",
                &format!("regret {own:.4} EI, of one simulator for the whole study {constant:.4}"),
            );
        }
        line(&mut text, "settles it", &answer.would_settle);
    }
    let is_asked = |garment: &str| answers.iter().any(|answer| answer.garment == garment);
    for all_fits in evidence::evidence(store, study)?.garments.iter().filter(|all_fits| is_asked(&all_fits.garment)) {
        let _ = write!(text, "\n{}, all fits\n", all_fits.garment);
        analysed(&mut text, &all_fits.analysis, all_fits.p_holm);
        line(&mut text, "crossover", &evidence::crossover_words(store, study, Some(&all_fits.garment))?);
    }
    let pairs = evidence::pairs(store, study)?;
    if !pairs.is_empty() {
        let score = fit::rule_score(&pairs);
        let _ = write!(text, "\nall garments\n");
        line(&mut text, "the rule", &format!("right in {} of {} loose or tight cases", score.right, score.of));
        line(&mut text, "crossover", &evidence::crossover_words(store, study, None)?);
    }
    Ok(text)
}

fn analysed(text: &mut String, analysis: &Analysis, p_holm: Option<f64>) {
    if let Some(estimate) = &analysis.estimate {
        line(text, "effect", &estimated(estimate, p_holm));
    }
    let ([fem, hybrid], cases, subjects) = (analysis.wins, analysis.cases, analysis.subjects.len());
    line(text, "cases", &format!("{cases}, of {subjects} subject(s); lower EI in FEM-GS {fem}, Hybrid-GS {hybrid}"));
    let rest = |w: &Without| format!("{} {:+.4} (FEM-GS {}, Hybrid-GS {})", w.what, w.mean, w.wins[0], w.wins[1]);
    for told in &analysis.told_apart {
        line(text, "without", &rest(told));
    }
    if let Some(turned) = analysis.turned_by() {
        line(text, "turns", &format!("without {}", rest(turned)));
    }
    if analysis.controlled > 0 {
        line(text, "circular", &format!("{} measurements are set by a simulator itself", analysis.controlled));
    }
}

fn estimated(estimate: &Estimate, p_holm: Option<f64>) -> String {
    let mut words = format!("{:+.4}", estimate.mean);
    if let Some((low, high)) = estimate.interval {
        let _ = write!(words, " ({low:+.4} to {high:+.4})");
    }
    let mut add = |name: &str, number: Option<f64>| {
        if let Some(number) = number {
            let _ = write!(words, ", {name} {number:.3}");
        }
    };
    add("d_z", estimate.size);
    add("p", Some(estimate.p));
    add("Holm", p_holm);
    add("equivalence p", estimate.p_equivalence);
    words
}

fn line(text: &mut String, name: &str, words: &str) {
    let _ = writeln!(text, "  {name:<11}{words}");
}

fn simulator_name(simulator: Simulator) -> &'static str {
    match simulator {
        Simulator::Fem => "FEM-GS",
        Simulator::Hybrid => "Hybrid-GS",
    }
}
