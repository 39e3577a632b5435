//! What differs between a desktop and a web page: where work runs.

use crate::compute::{Answer, Request};

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::Worker;
#[cfg(target_arch = "wasm32")]
pub use page::Worker;

#[cfg(not(target_arch = "wasm32"))]
mod desktop {
    use super::{Answer, Request};
    use crate::compute::Computer;
    use std::sync::mpsc::{Receiver, Sender, channel};

    /// A thread that computes answers one after another.
    #[derive(Debug)]
    pub struct Worker {
        requests: Sender<Request>,
        answers: Receiver<Answer>,
    }

    impl Worker {
        /// Starts the thread, which calls `wake` after each answer.
        pub fn new(wake: impl Fn() + Send + 'static) -> Self {
            let (requests, to_do) = channel::<Request>();
            let (done, answers) = channel();
            // Ends with the viewer, which drops the other end of `to_do`. Without threads, no answer comes.
            let _ = std::thread::Builder::new()
                .name("airlight".to_owned())
                .spawn(move || {
                    let mut computer = Computer::default();
                    while let Ok(request) = to_do.recv() {
                        if done.send(computer.compute(&request)).is_err() {
                            return;
                        }
                        wake();
                    }
                });
            Self { requests, answers }
        }

        /// Hands in a request. False if the thread has ended.
        pub fn send(&mut self, request: Request) -> bool {
            self.requests.send(request).is_ok()
        }

        /// An answer that has arrived.
        pub fn receive(&mut self) -> Option<Answer> {
            self.answers.try_recv().ok()
        }

        /// Waits for an answer. `None` if the thread has ended.
        pub fn wait(&mut self) -> Option<Answer> {
            self.answers.recv().ok()
        }
    }
}

#[cfg(target_arch = "wasm32")]
mod page {
    use super::{Answer, Request};
    use crate::compute::Computer;

    /// Computes answers at once, on the thread of the page.
    #[derive(Debug, Default)]
    pub struct Worker {
        computer: Computer,
        answers: Vec<Answer>,
    }

    impl Worker {
        /// A worker; `wake` is not needed, as answers are there at once.
        pub fn new(_wake: impl Fn() + Send + 'static) -> Self {
            Self::default()
        }

        /// Hands in a request.
        pub fn send(&mut self, request: Request) -> bool {
            self.answers.push(self.computer.compute(&request));
            true
        }

        /// An answer that has arrived.
        pub fn receive(&mut self) -> Option<Answer> {
            self.answers.pop()
        }
    }
}
