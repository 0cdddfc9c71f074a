//! The threads that wait for keys and signals.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crossterm::event::MouseEventKind::{Drag, Moved, Up};
use crossterm::event::{self, Event};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use crate::messages::message::Message;

/// Longest wait for keys at a time; also the pause while another program has the keyboard.
const WAIT: Duration = Duration::from_millis(200);
const AWAY: Duration = Duration::from_millis(10);

#[derive(Clone, Default)]
pub struct Keyboard {
    is_lent: Arc<AtomicBool>,
    reading: Arc<Mutex<()>>,
}

impl Keyboard {
    /// Does work that needs the keyboard, during which no key is read.
    pub fn lend<T>(&self, work: impl FnOnce() -> T) -> T {
        self.is_lent.store(true, Ordering::SeqCst);
        let reading = self.reading.lock().unwrap_or_else(PoisonError::into_inner);
        let outcome = work();
        drop(reading);
        self.is_lent.store(false, Ordering::SeqCst);
        outcome
    }

    /// Returns `None` if there is no event within [`WAIT`].
    fn next(&self) -> std::io::Result<Option<Event>> {
        if self.is_lent.load(Ordering::SeqCst) {
            thread::sleep(AWAY);
            return Ok(None);
        }
        let _reading = self.reading.lock().unwrap_or_else(PoisonError::into_inner);
        if event::poll(WAIT)? { event::read().map(Some) } else { Ok(None) }
    }
}

/// Sends a message for each key, click and turn of the wheel. Nothing follows a mouse that only moves.
pub fn read_keys(keyboard: &Keyboard, sender: &Sender<Message>) {
    loop {
        let event = match keyboard.next().transpose() {
            Some(event) => event,
            None => continue,
        };
        let message = match event {
            Ok(Event::Key(key)) => Message::Key(key),
            Ok(Event::Resize(width, height)) => Message::Resize(width, height),
            Ok(Event::Mouse(event)) if matches!(event.kind, Moved | Drag(_) | Up(_)) => continue,
            Ok(Event::Mouse(event)) => Message::Mouse(event),
            Ok(_) => continue,
            Err(_) => Message::Hangup,
        };
        let is_last = matches!(message, Message::Hangup);
        if sender.send(message).is_err() || is_last {
            return;
        }
    }
}

pub fn watch_signals(sender: &Sender<Message>) {
    let mut signals = match Signals::new([SIGTERM, SIGHUP, SIGINT]) {
        Ok(signals) => signals,
        Err(error) => return drop(sender.send(Message::Failed(format!("signals: {error}")))),
    };
    for signal in signals.forever() {
        let message = if signal == SIGHUP { Message::Hangup } else { Message::Terminate };
        if sender.send(message).is_err() {
            return;
        }
    }
}
