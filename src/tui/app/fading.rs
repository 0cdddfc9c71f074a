//! Fading of messages: what was said leaves the status line after the time that reading it takes, so that the keys come
//! back. An error stays until the next key.

use std::time::{Duration, Instant};

use crate::screens::state::Notice;

/// Time that a short message stays.
const LEAST: Duration = Duration::from_secs(4);
/// Time for each letter: 238 words of six letters a minute, as adults read silently (Brysbaert 2019).
const LETTER: Duration = Duration::from_millis(42);

/// Message in the status line, and the time since which it is there.
#[derive(Debug, Default)]
pub struct Fading(Option<(Notice, Instant)>);

impl Fading {
    pub fn follow(&mut self, notice: Option<&Notice>, now: Instant) {
        if self.0.as_ref().map(|(known, _)| known) != notice {
            self.0 = notice.map(|notice| (notice.clone(), now));
        }
    }

    /// Time until the message fades; `None` where none does.
    pub fn left(&self, now: Instant) -> Option<Duration> {
        let (notice, since) = self.0.as_ref().filter(|(notice, _)| !notice.is_error)?;
        let stays = LEAST + LETTER * notice.text.chars().count() as u32;
        Some((*since + stays).saturating_duration_since(now))
    }

    pub fn is_over(&self, now: Instant) -> bool {
        self.left(now).is_some_and(|left| left.is_zero())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_said_fades_and_errors_stay() {
        let start = Instant::now();
        let notice = |text: &str, is_error| Notice { text: text.to_owned(), is_error };
        let mut fading = Fading::default();
        let mut check = |notice: Option<Notice>, seconds: u64, expect: bool| {
            let now = start + Duration::from_secs(seconds);
            fading.follow(notice.as_ref(), now);
            assert_eq!(fading.is_over(now), expect, "{notice:?} after {seconds} s");
        };
        check(None, 0, false);
        check(Some(notice("done", false)), 0, false);
        check(Some(notice("done", false)), 3, false);
        check(Some(notice("done", false)), 5, true);
        check(Some(notice("another", false)), 5, false);
        check(Some(notice(&"long ".repeat(40), false)), 9, false);
        check(Some(notice(&"long ".repeat(40), false)), 15, false);
        check(Some(notice(&"long ".repeat(40), false)), 22, true);
        check(Some(notice("broken", true)), 30, false);
        check(Some(notice("broken", true)), 900, false);
    }
}
