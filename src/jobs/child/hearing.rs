//! What a child says, heard piece by piece: it may be late, broken off or not a word of the language.

use super::sandbox::Protections;
use super::task::{ChildMessage, FileMade};
use crate::budget::ProgressEvent;
use crate::jobs::product::RunProduct;
use crate::wire::Problem;

/// Longest line. The answer of a run with many results has some kilobytes.
const LINE_BYTES_MAX: usize = 256 << 10;

/// The last word of a child.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Last {
    Made(Box<RunProduct<FileMade>>),
    Failed(Box<Problem>),
}

/// It says what no child says.
#[derive(Debug, PartialEq)]
pub(super) struct Garbled;

/// What was heard so far.
#[derive(Debug, Default)]
pub(super) struct Hearing {
    line: Vec<u8>,
    /// What holds the child, once it says so.
    pub(super) protections: Option<Protections>,
    /// Whether it has its task: what it does from then on is the job's.
    pub(super) has_task: bool,
    last: Option<Last>,
}

impl Hearing {
    /// Takes the next bytes; passes go to `hear`.
    pub(super) fn take(&mut self, mut bytes: &[u8], hear: &dyn Fn(ProgressEvent)) -> Result<(), Garbled> {
        while let Some(end) = bytes.iter().position(|&byte| byte == b'\n') {
            self.grow(&bytes[..end])?;
            let message = serde_json::from_slice(&self.line).map_err(|_| Garbled)?;
            self.line.clear();
            self.understand(message, hear)?;
            bytes = &bytes[end + 1..];
        }
        self.grow(bytes)
    }

    /// The last word; `None`: the child ended without.
    pub(super) fn last(self) -> Option<Last> {
        self.last.filter(|_| self.line.is_empty())
    }

    fn grow(&mut self, bytes: &[u8]) -> Result<(), Garbled> {
        if self.last.is_some() && !bytes.is_empty() || self.line.len() + bytes.len() > LINE_BYTES_MAX {
            return Err(Garbled);
        }
        self.line.extend_from_slice(bytes);
        Ok(())
    }

    fn understand(&mut self, message: ChildMessage, hear: &dyn Fn(ProgressEvent)) -> Result<(), Garbled> {
        match message {
            ChildMessage::Confined(protections) if self.protections.is_none() => {
                self.protections = Some(protections);
            }
            ChildMessage::Taken if !self.has_task => self.has_task = true,
            ChildMessage::Confined(_) | ChildMessage::Taken => return Err(Garbled),
            ChildMessage::Enter(stage) => hear(ProgressEvent::Enter(stage.into())),
            ChildMessage::Leave(stage) => hear(ProgressEvent::Leave(stage.into())),
            ChildMessage::Work(units) => hear(ProgressEvent::Work(units)),
            ChildMessage::Made(product) => self.last = Some(Last::Made(product)),
            ChildMessage::Failed(problem) => self.last = Some(Last::Failed(problem)),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget;
    use crate::wire::{ProblemCode, Stage};
    use std::cell::RefCell;

    fn line(message: &ChildMessage) -> Vec<u8> {
        let mut line = serde_json::to_vec(message).unwrap();
        line.push(b'\n');
        line
    }

    #[test]
    fn words_are_heard_however_the_pipe_cuts_them() {
        let problem = Problem::new(ProblemCode::MeshEmpty, "empty");
        let said = [
            line(&ChildMessage::Confined(Protections {
                landlock_abi: Some(7),
                is_filtered: true,
                keeps_capabilities: false,
            })),
            line(&ChildMessage::Taken),
            line(&ChildMessage::Enter(Stage::Read)),
            line(&ChildMessage::Leave(Stage::Read)),
            line(&ChildMessage::Failed(Box::new(problem.clone()))),
        ]
        .concat();
        for piece in [1, 7, said.len()] {
            let heard = RefCell::new(Vec::new());
            let mut hearing = Hearing::default();
            for bytes in said.chunks(piece) {
                hearing.take(bytes, &|event| heard.borrow_mut().push(event)).unwrap();
            }
            let read = budget::Stage::Read;
            assert_eq!(*heard.borrow(), [ProgressEvent::Enter(read), ProgressEvent::Leave(read)]);
            assert_eq!(hearing.protections.unwrap().landlock_abi, Some(7));
            assert!(hearing.has_task);
            assert_eq!(hearing.last(), Some(Last::Failed(Box::new(problem.clone()))));
        }
    }

    #[test]
    fn a_last_word_that_is_broken_off_is_none() {
        let said = line(&ChildMessage::Failed(Box::new(Problem::new(ProblemCode::MeshEmpty, "empty"))));
        let mut hearing = Hearing::default();
        hearing.take(&said[..said.len() - 1], &|_| {}).unwrap();
        assert_eq!(hearing.last(), None);
    }

    #[test]
    fn noise_a_word_after_the_last_one_and_a_line_without_end_are_garbled() {
        let last = line(&ChildMessage::Failed(Box::new(Problem::new(ProblemCode::MeshEmpty, "empty"))));
        let taken = line(&ChildMessage::Taken);
        let endless = vec![b'1'; LINE_BYTES_MAX + 1];
        for said in [&b"panic!\n"[..], b"\n", b"{\"made\":{}}\n", &last.repeat(2), &taken.repeat(2), &endless]
        {
            assert_eq!(Hearing::default().take(said, &|_| {}), Err(Garbled));
        }
    }
}
