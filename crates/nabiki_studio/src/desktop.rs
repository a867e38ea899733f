//! The desktop's own dialog for a file, asked on a thread, so that this window goes on while it is open.

use std::path::PathBuf;
use std::pin::pin;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::task::{Context, Poll, Wake};
use std::thread::Thread;
use std::time::{Duration, Instant};

use crate::dialog::{Chooser, Purpose};

/// No hand closes a dialog so soon after it was asked for: there was none.
const TOO_SOON: Duration = Duration::from_millis(400);

/// What came of a question.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// This file.
    Path(PathBuf),
    /// The dialog was closed.
    Closed,
    /// The desktop has no dialog.
    None,
}

/// A question to the desktop.
#[derive(Debug)]
pub struct Asked {
    chooser: Chooser,
    answer: Receiver<(Option<PathBuf>, Duration)>,
}

impl Asked {
    /// Asks for what a chooser is for. `wake` is called when there is an answer.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn desktop(chooser: Chooser, wake: impl FnOnce() + Send + 'static) -> std::io::Result<Self> {
        let folder = std::path::absolute(chooser.folder()).unwrap_or_default();
        let dialog = rfd::AsyncFileDialog::new().set_title(chooser.title()).set_directory(folder);
        let dialog = if chooser.endings.is_empty() { dialog } else { dialog.add_filter("Files", &chooser.endings) };
        let name = PathBuf::from(&chooser.path).file_name().map(|name| name.to_string_lossy().into_owned());
        // Some systems show dialogs on the thread of the window only: what is sent to the other one is the waiting.
        let answer: std::pin::Pin<Box<dyn Future<Output = _> + Send>> = match chooser.purpose {
            Purpose::Open | Purpose::Setting(_) => Box::pin(dialog.pick_file()),
            Purpose::SaveAs(_) | Purpose::Export(_) => {
                Box::pin(dialog.set_file_name(name.unwrap_or_default()).save_file())
            }
        };
        Self::asks(chooser, move || wait_for(answer).map(|file| file.path().to_owned()), wake)
    }

    /// The same for any dialog.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn asks(
        chooser: Chooser,
        dialog: impl FnOnce() -> Option<PathBuf> + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (give, answer) = channel();
        std::thread::Builder::new().name("desktop".to_owned()).spawn(move || {
            let begun = Instant::now();
            let path = dialog();
            // Nobody hears it where the question was taken back.
            let _ = give.send((path, begun.elapsed()));
            wake();
        })?;
        Ok(Self { chooser, answer })
    }

    /// What it was asked for.
    pub fn chooser(&self) -> &Chooser {
        &self.chooser
    }

    /// The answer, once there is one.
    pub fn answer(&self) -> Option<Answer> {
        match self.answer.try_recv() {
            Ok((Some(path), _)) => Some(Answer::Path(path)),
            Ok((None, after)) if after >= TOO_SOON => Some(Answer::Closed),
            Ok((None, _)) | Err(TryRecvError::Disconnected) => Some(Answer::None),
            Err(TryRecvError::Empty) => None,
        }
    }
}

/// Waits on this thread for what is to come.
fn wait_for<T>(future: impl Future<Output = T>) -> T {
    struct Unpark(Thread);
    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.0.unpark();
        }
    }
    let waker = Arc::new(Unpark(std::thread::current())).into();
    let mut future = pin!(future);
    loop {
        match future.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(value) => return value,
            Poll::Pending => std::thread::park(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_ends_with_the_value() {
        let mut polled = 0;
        let value = wait_for(std::future::poll_fn(move |context| {
            polled += 1;
            let waker = context.waker().clone();
            std::thread::spawn(move || waker.wake());
            if polled < 3 { Poll::Pending } else { Poll::Ready(polled) }
        }));
        assert_eq!(value, 3);
    }
}
