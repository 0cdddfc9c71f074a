//! The threads that wait for keys and signals.

use std::sync::mpsc::Sender;

use crossterm::event;
use crossterm::event::Event;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use crate::messages::message::Message;

/// Waits for keys, and tells them.
pub fn read_keys(sender: &Sender<Message>) {
    loop {
        let message = match event::read() {
            Ok(Event::Key(key)) => Message::Key(key),
            Ok(Event::Resize(width, height)) => Message::Resize(width, height),
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

/// Waits for signals, and tells them.
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
