//! What differs between a desktop and a web page: where work runs.

use crate::compute::{Answer, Request};

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::Worker;
#[cfg(target_arch = "wasm32")]
pub use page::{Worker, keep};

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
    use eframe::wasm_bindgen::{JsCast, closure::Closure};
    use std::cell::RefCell;
    use std::collections::VecDeque;
    use std::rc::Rc;
    use web_sys::js_sys::Uint8Array;
    use web_sys::{Event, MessageEvent, WorkerOptions, WorkerType};

    /// The script of the worker, beside the page.
    const SCRIPT: &str = "worker.js";

    /// A worker of the page that computes answers one after another.
    #[derive(Debug)]
    pub struct Worker {
        worker: Option<web_sys::Worker>,
        messages: Rc<RefCell<VecDeque<Message>>>,
        /// Number of the last request.
        asked: u64,
        /// Bytes of the last answer. The memory of a page never shrinks: large pieces that come and go would leave holes in it.
        bytes: Vec<u8>,
    }

    /// What the worker has sent.
    #[derive(Debug)]
    enum Message {
        /// An answer, outside the memory of the page's module.
        Answer(Uint8Array),
        /// It has failed.
        Failure,
    }

    impl Worker {
        /// Starts the worker, and calls `wake` after each answer.
        pub fn new(wake: impl Fn() + Send + 'static) -> Self {
            let messages = Rc::default();
            Self {
                worker: start(&messages, wake),
                messages,
                asked: 0,
                bytes: Vec::new(),
            }
        }

        /// Hands in a request. False if there is no worker.
        pub fn send(&mut self, request: Request) -> bool {
            self.asked = request.number;
            let (Some(worker), Ok(bytes)) = (&self.worker, request.to_bytes()) else {
                return false;
            };
            let bytes = Uint8Array::from(bytes.as_slice());
            worker.post_message(&bytes).is_ok()
        }

        /// An answer that has arrived.
        pub fn receive(&mut self) -> Option<Answer> {
            let message = self.messages.borrow_mut().pop_front()?;
            let Message::Answer(bytes) = message else {
                let result =
                    Err("the worker of the page has failed; load the page again".to_owned());
                let number = self.asked;
                return Some(Answer { number, result });
            };
            self.bytes.resize(bytes.length() as usize, 0);
            bytes.copy_to(&mut self.bytes);
            Answer::from_bytes(&self.bytes)
        }
    }

    /// The worker, with the module of the page, so that it is neither loaded nor compiled again.
    fn start(
        messages: &Rc<RefCell<VecDeque<Message>>>,
        wake: impl Fn() + 'static,
    ) -> Option<web_sys::Worker> {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let worker = web_sys::Worker::new_with_options(SCRIPT, &options).ok()?;
        worker.post_message(&eframe::wasm_bindgen::module()).ok()?;
        let wake = Rc::new(wake);
        let (answers, failures) = (messages.clone(), messages.clone());
        let wake_failed = wake.clone();
        let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            let bytes = event.data().unchecked_into::<Uint8Array>();
            answers.borrow_mut().push_back(Message::Answer(bytes));
            wake();
        });
        let on_error = Closure::<dyn FnMut(Event)>::new(move |_| {
            failures.borrow_mut().push_back(Message::Failure);
            wake_failed();
        });
        worker.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
        worker.set_onerror(Some(on_error.as_ref().unchecked_ref()));
        // They live as long as the page.
        on_message.forget();
        on_error.forget();
        Some(worker)
    }

    /// Keeps a state in the address of the page.
    pub fn keep(fragment: &str) {
        let history = web_sys::window().and_then(|window| window.history().ok());
        let address = format!("#{fragment}");
        if let Some(history) = history {
            // Without a right to change the address, the page works all the same.
            let _ = history.replace_state_with_url(&"".into(), "", Some(&address));
        }
    }
}
