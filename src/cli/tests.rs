use super::command;

#[test]
fn the_arguments_are_consistent() {
    command().debug_assert();
}

#[test]
fn help_is_what_users_were_told() {
    let mut command = command().term_width(100);
    insta::assert_snapshot!(command.render_help());
    let run = command.find_subcommand_mut("run").expect("a command").clone();
    insta::assert_snapshot!(run.term_width(100).render_help());
}
