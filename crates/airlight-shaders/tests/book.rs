//! The book's tables of functions are those of the WGSL files.

use airlight::Named;
use airlight_shaders::Part;

#[path = "../examples/book/table.rs"]
mod table;

#[test]
fn tables_of_the_book_are_up_to_date() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/shaders.md");
    let text = std::fs::read_to_string(file).expect("the chapter");
    let text = text.replace("\r\n", "\n");
    for &part in Part::ALL {
        let begin = format!("<!-- table: shaders-{} -->\n\n", part.name());
        let (_, after) = text.split_once(&begin).unwrap_or_else(|| panic!("{begin}"));
        let (shown, _) = after.split_once("\n<!-- end of table -->").expect("an end");
        assert!(
            shown == table::function_table(part),
            "{part}: run scripts/book tables shaders-"
        );
    }
}
