//! Files of a page: those that are dropped on it or chosen, and the pictures and scenes that it saves.

use airlight_gpu::PendingPixels;
use airlight_image::output::{hdr, png};
use airlight_image::rows::StoredRows;
use airlight_image::tone::ToneMapper;
use airlight_image::{Control, PictureOptions, Size};
use eframe::egui::DroppedFileHandle;
use eframe::wasm_bindgen::{JsCast, JsValue, closure::Closure};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::js_sys::{Array, Uint8Array};
use web_sys::{Blob, BlobPropertyBag, Event, HtmlAnchorElement, HtmlInputElement, Url};

/// Endings of the files that a page opens.
const OPENED: &str = ".toml,.npy,.pfm,.png";

/// A file whose contents have arrived, or why they cannot be read.
pub struct PageFile {
    /// Its name.
    pub path: PathBuf,
    /// Its contents.
    pub contents: Result<Vec<u8>, String>,
}

/// Files that are read, which takes a page some time.
#[derive(Clone)]
pub struct PageFiles {
    arrived: Rc<RefCell<VecDeque<PageFile>>>,
    wake: Rc<dyn Fn()>,
}

impl PageFiles {
    /// None yet; `wake` is called when one has arrived.
    pub fn new(wake: impl Fn() + 'static) -> Self {
        Self {
            arrived: Rc::default(),
            wake: Rc::new(wake),
        }
    }

    /// Reads a file that was dropped.
    pub fn read(&self, file: DroppedFileHandle) {
        let files = self.clone();
        spawn_local(async move {
            let contents = file.bytes_async().await;
            files.arrive(file.path().to_owned(), contents);
        });
    }

    /// Lets the user choose a file, and reads it.
    ///
    /// # Errors
    /// A sentence where the browser refuses.
    pub fn choose(&self) -> Result<(), String> {
        let input: HtmlInputElement = element("input")?;
        input.set_type("file");
        input.set_accept(OPENED);
        let (files, chosen) = (self.clone(), input.clone());
        let on_change = Closure::<dyn FnMut(Event)>::new(move |_| {
            let Some(file) = chosen.files().and_then(|list| list.get(0)) else {
                return;
            };
            let files = files.clone();
            spawn_local(async move {
                let bytes = JsFuture::from(file.array_buffer()).await;
                let contents = bytes.map(|bytes| Uint8Array::new(&bytes).to_vec());
                files.arrive(file.name().into(), contents.map_err(text_of));
            });
        });
        input.set_onchange(Some(on_change.as_ref().unchecked_ref()));
        // It lives as long as its element.
        on_change.forget();
        input.click();
        Ok(())
    }

    fn arrive(&self, path: PathBuf, contents: Result<Vec<u8>, String>) {
        let file = PageFile { path, contents };
        self.arrived.borrow_mut().push_back(file);
        (self.wake)();
    }

    /// A file that has arrived.
    pub fn take(&self) -> Option<PageFile> {
        self.arrived.borrow_mut().pop_front()
    }
}

/// A picture that the page saves once its pixels have come from the device.
#[derive(Debug)]
pub struct PendingPicture {
    /// Name of the file, whose ending is the format.
    pub file: PathBuf,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The light of the pixels, cd/m^2 times the exposure.
    pub pixels: PendingPixels,
    /// Exposure of the pixels.
    pub exposure: f32,
    /// How a display shows them.
    pub tone: ToneMapper,
}

impl PendingPicture {
    /// Whether a file of a name can be saved.
    ///
    /// # Errors
    /// A sentence that states the endings that can.
    pub fn check_name(file: &Path) -> Result<(), String> {
        match ending(file).as_str() {
            "png" | "hdr" => Ok(()),
            other => Err(format!(
                "expected a name that ends in .png, .hdr or .toml, which the page saves, got {other:?}"
            )),
        }
    }

    /// Saves the picture.
    ///
    /// # Errors
    /// A sentence where the pixels cannot be had or the browser refuses.
    pub fn save(&self) -> Result<(), String> {
        let mut pixels = self.pixels.rgb().map_err(|error| error.to_string())?;
        for channel in pixels.as_flattened_mut() {
            *channel /= self.exposure;
        }
        let bytes = self.encoded(pixels).map_err(|error| error.to_string())?;
        download(&self.file, &bytes)
    }

    fn encoded(&self, pixels: Vec<[f32; 3]>) -> Result<Vec<u8>, airlight_image::ImageError> {
        let [width, height] = self.size;
        let size = Size::new(width, height)?;
        let rows = StoredRows::new(width, 3, pixels.as_flattened().to_vec())?;
        let PictureOptions { png, metadata, .. } = PictureOptions::default();
        let mut bytes = Vec::new();
        let control = Control::default();
        match ending(&self.file).as_str() {
            "hdr" => hdr::encode(&mut bytes, size, &rows, &metadata, control),
            _ => png::encode(
                &mut bytes, size, &rows, &self.tone, &png, &metadata, control,
            ),
        }?;
        Ok(bytes)
    }
}

/// The ending of a name, in lower case.
fn ending(file: &Path) -> String {
    let ending = file.extension().unwrap_or_default();
    ending.to_string_lossy().to_lowercase()
}

/// Saves a file as the browser saves downloads.
///
/// # Errors
/// A sentence where the browser refuses.
pub fn download(file: &Path, bytes: &[u8]) -> Result<(), String> {
    let parts = Array::of1(&Uint8Array::from(bytes));
    let kind = BlobPropertyBag::new();
    kind.set_type("application/octet-stream");
    let blob = Blob::new_with_u8_array_sequence_and_options(&parts, &kind).map_err(text_of)?;
    let address = Url::create_object_url_with_blob(&blob).map_err(text_of)?;
    let link: HtmlAnchorElement = element("a")?;
    link.set_href(&address);
    link.set_download(&file.display().to_string());
    link.click();
    Url::revoke_object_url(&address).map_err(text_of)
}

/// A new element of the page, which is not shown.
fn element<T: JsCast>(name: &str) -> Result<T, String> {
    let document = web_sys::window().and_then(|window| window.document());
    let document = document.ok_or("expected a page, got none")?;
    let element = document.create_element(name).map_err(text_of)?;
    let element = element.dyn_into::<T>();
    element.map_err(|_| format!("expected an element `{name}`, got another"))
}

fn text_of(error: JsValue) -> String {
    format!("the browser refuses: {error:?}")
}
