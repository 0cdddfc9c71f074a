//! Writing in an editor of the user's own: queries, seam files, study files.

use crate::keys::screen::Screen;
use crate::messages::effect::{Effect, Writing};
use crate::messages::seams::SeamTask;
use crate::screens::state::State;
use store::files::SourceFile;
use wardrobe::Part;
use wardrobe::seams::SeamStep;

impl State {
    /// Opens what the screen shows in the editor.
    pub fn write(&mut self) -> Vec<Effect> {
        let screen = self.nav.screen;
        let what = match screen {
            Screen::Sql => Some(Writing::Query(self.sql.editor.text().to_owned())),
            Screen::Styles if !self.may_change(Part::Style) => return vec![],
            Screen::Styles => self.seam_file(),
            _ => self.data.as_ref().and_then(|data| data.study()).map(|study| Writing::File(study.path.clone())),
        };
        match what {
            Some(what) => vec![Effect::Write(what)],
            None => {
                self.say("nothing to edit here: E edits the query, the seams of a DXF pattern, the file of the study");
                vec![]
            }
        }
    }

    /// The seam file of the selected size as it is edited.
    fn seam_file(&self) -> Option<Writing> {
        let request = self.layout_request()?;
        let stored = self.layout().and_then(Result::ok).and_then(|layout| layout.stored.clone());
        let file = request.seams.clone().or(stored)?;
        Some(Writing::Seams(request, file))
    }

    /// Takes in what was written.
    pub fn written(&mut self, what: Writing, text: Result<String, String>) -> Vec<Effect> {
        let text = match text {
            Ok(text) => text,
            Err(error) => {
                self.complain(error);
                return vec![];
            }
        };
        match what {
            Writing::Query(_) => self.take_query(&text),
            Writing::Seams(_, file) if text.as_bytes() == &*file.bytes => self.say("the seams are as they were"),
            Writing::Seams(request, file) => {
                let file = SourceFile { name: file.name, bytes: text.into_bytes().into() };
                self.styles.is_busy = true;
                return vec![Effect::Seams(SeamTask::Sew(request, SeamStep::Written(file)))];
            }
            Writing::File(path) => self.say(format!("{}: R runs it as it is now", path.display())),
        }
        vec![]
    }
}
