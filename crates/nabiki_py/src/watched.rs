//! Long work beside Python: other threads of Python go on, Ctrl-C ends it, a callback hears how far it is.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use nabiki_scene::threads::none_given;
use nabiki_scene::{Told, Watch};
use pyo3::exceptions::PyUserWarning;
use pyo3::ffi::c_str;
use pyo3::prelude::*;

use crate::error;
use crate::field::PythonField;
use crate::hints::{Given, Progress, Report};
use crate::threads::shared;

/// How often Python is asked whether somebody pressed Ctrl-C.
const ASKED: Duration = Duration::from_millis(50);

enum Message {
    Progress(u64, u64),
    Told(String),
    Warned(String),
}

/// The worker's side.
struct Remote<'a> {
    tell: Sender<Message>,
    stop: &'a AtomicBool,
    fields: &'a [Arc<PythonField>],
    done: u64,
    total: u64,
}

impl Remote<'_> {
    fn say(&self, message: Message) {
        // Nobody hears once the caller has given up, and the work is then about to end.
        let _ = self.tell.send(message);
    }
}

impl Watch for Remote<'_> {
    fn told(&mut self, told: Told) {
        let line = told.to_string().trim().to_owned();
        self.say(match told {
            Told::Advice(_) | Told::Unread { .. } | Told::Lost { .. } | Told::Guessed(_) => Message::Warned(line),
            _ => Message::Told(line),
        });
    }

    fn begin(&mut self, _: &'static str, steps: u64) {
        (self.done, self.total) = (0, steps);
        self.say(Message::Progress(0, steps));
    }

    fn step(&mut self) {
        self.done += 1;
        self.say(Message::Progress(self.done, self.total));
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.fields.iter().any(|field| field.failed())
    }
}

/// What Python wants to hear.
#[derive(Clone, Copy, Default)]
pub struct Ears<'a, 'py> {
    /// Called with the frames done and the frames in all.
    pub progress: Option<&'a Bound<'py, PyAny>>,
    /// Called with each line that the command would print; what looks wrong is a warning where nobody listens.
    pub report: Option<&'a Bound<'py, PyAny>>,
}

impl<'a, 'py> Ears<'a, 'py> {
    /// Those of a call.
    pub fn new(progress: &'a Option<Given<'py, Progress>>, report: &'a Option<Given<'py, Report>>) -> Self {
        Self { progress: progress.as_ref().map(|given| &given.0), report: report.as_ref().map(|given| &given.0) }
    }
}

/// Carries out `work` on a thread of its own and returns when that has ended, whatever happens: after Ctrl-C, or an exception
/// of a callback, it ends at its next frame and leaves nothing half written. `fields`: Python functions that it may ask.
pub fn watched<T: Send>(
    py: Python<'_>,
    ears: Ears<'_, '_>,
    fields: &[Arc<PythonField>],
    work: impl FnOnce(&mut dyn Watch) -> nabiki_scene::Result<T> + Send,
) -> PyResult<T> {
    let (tell, hear) = channel();
    let stop = &AtomicBool::new(false);
    let heard =
        Heard { progress: ears.progress.map(|p| p.clone().unbind()), report: ears.report.map(|r| r.clone().unbind()) };
    fields.iter().for_each(|field| field.begin());
    let (result, failure) = py.detach(move || {
        thread::scope(|scope| {
            let worker = thread::Builder::new().name("nabiki".to_owned()).spawn_scoped(scope, move || {
                let mut remote = Remote { tell, stop, fields, done: 0, total: 0 };
                shared(|| work(&mut remote)).flatten()
            });
            let worker = match worker {
                Ok(worker) => worker,
                Err(none) => return (Ok(Err(nabiki_scene::Error::refused(none_given(&none)))), None),
            };
            let failure = heard.listen(hear, || {
                stop.store(true, Ordering::Relaxed);
                fields.iter().for_each(|field| field.stop());
            });
            (worker.join(), failure)
        })
    });
    if let Some(failure) = failure.or_else(|| fields.iter().find_map(|field| field.take_failure())) {
        return Err(failure);
    }
    match result {
        Ok(result) => result.map_err(|refused| error::raised(py, refused)),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

struct Heard {
    progress: Option<Py<PyAny>>,
    report: Option<Py<PyAny>>,
}

impl Heard {
    /// Passes on what the worker says until it has ended; the first exception of Python, upon which `stop` is called.
    fn listen(&self, hear: Receiver<Message>, stop: impl Fn()) -> Option<PyErr> {
        let mut failure = None;
        let mut asked = Instant::now();
        loop {
            let message = match hear.recv_timeout(ASKED) {
                Ok(message) => Some(self.newest(message, &hear)),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return failure,
            };
            if failure.is_some() || (message.is_none() && asked.elapsed() < ASKED) {
                continue;
            }
            let answer = Python::attach(|py| {
                for message in message.into_iter().flatten() {
                    self.pass_on(py, message)?;
                }
                asked = Instant::now();
                py.check_signals()
            });
            if let Err(error) = answer {
                failure = Some(error);
                stop();
            }
        }
    }

    /// All that has been said by now, of progress only where it began and where it is.
    fn newest(&self, first: Message, hear: &Receiver<Message>) -> Vec<Message> {
        let mut messages = vec![first];
        while let Ok(next) = hear.try_recv() {
            if let (Some(Message::Progress(1.., _)), Message::Progress(1.., _)) = (messages.last(), &next) {
                messages.pop();
            }
            messages.push(next);
        }
        messages
    }

    fn pass_on(&self, py: Python<'_>, message: Message) -> PyResult<()> {
        match (message, &self.progress, &self.report) {
            (Message::Progress(done, total), Some(progress), _) => progress.call1(py, (done, total)).map(drop),
            (Message::Told(line) | Message::Warned(line), _, Some(report)) => report.call1(py, (line,)).map(drop),
            (Message::Warned(line), _, None) => {
                let text = std::ffi::CString::new(line).unwrap_or_else(|_| c_str!("a warning").to_owned());
                PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)
            }
            _ => Ok(()),
        }
    }
}
