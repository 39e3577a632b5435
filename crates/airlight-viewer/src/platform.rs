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
    use std::cell::{Cell, RefCell};
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
        answers: Rc<RefCell<VecDeque<Answer>>>,
        /// Number of the last request.
        asked: Rc<Cell<u64>>,
    }

    impl Worker {
        /// Starts the worker, and calls `wake` after each answer.
        pub fn new(wake: impl Fn() + Send + 'static) -> Self {
            let answers = Rc::new(RefCell::new(VecDeque::new()));
            let asked = Rc::new(Cell::new(0));
            let worker = start(answers.clone(), asked.clone(), wake);
            Self {
                worker,
                answers,
                asked,
            }
        }

        /// Hands in a request. False if there is no worker.
        pub fn send(&mut self, request: Request) -> bool {
            self.asked.set(request.number);
            let (Some(worker), Ok(bytes)) = (&self.worker, request.to_bytes()) else {
                return false;
            };
            let bytes = Uint8Array::from(bytes.as_slice());
            worker.post_message(&bytes).is_ok()
        }

        /// An answer that has arrived.
        pub fn receive(&mut self) -> Option<Answer> {
            self.answers.borrow_mut().pop_front()
        }
    }

    /// The worker, with the module of the page, so that it is neither loaded nor compiled again.
    fn start(
        answers: Rc<RefCell<VecDeque<Answer>>>,
        asked: Rc<Cell<u64>>,
        wake: impl Fn() + 'static,
    ) -> Option<web_sys::Worker> {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let worker = web_sys::Worker::new_with_options(SCRIPT, &options).ok()?;
        worker.post_message(&eframe::wasm_bindgen::module()).ok()?;
        let wake = Rc::new(wake);
        let (failed, wake_failed) = (answers.clone(), wake.clone());
        let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            let bytes = Uint8Array::new(&event.data()).to_vec();
            answers.borrow_mut().extend(Answer::from_bytes(&bytes));
            wake();
        });
        let on_error = Closure::<dyn FnMut(Event)>::new(move |_| {
            let number = asked.get();
            let result = Err("the worker of the page has failed; load the page again".to_owned());
            failed.borrow_mut().push_back(Answer { number, result });
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
