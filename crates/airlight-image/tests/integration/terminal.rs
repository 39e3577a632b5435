//! Previews in a terminal.

use airlight_image::terminal::{TerminalColor, half_blocks};

#[test]
fn half_blocks_show_two_pixels_each() {
    let rgb = [255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 8, 7];
    let text = half_blocks(&rgb, 2, 80, TerminalColor::True);
    assert_eq!(
        text,
        "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m\u{2580}\x1b[38;2;0;255;0m\x1b[48;2;9;8;7m\u{2580}\x1b[0m\n"
    );
    let cells = |columns| {
        half_blocks(
            &vec![128; 100 * 50 * 3],
            100,
            columns,
            TerminalColor::Palette,
        )
        .lines()
        .map(|line| line.matches('\u{2580}').count())
        .collect::<Vec<_>>()
    };
    assert_eq!(cells(40), vec![40; 10]);
    assert_eq!(cells(1), vec![1]);
    assert_eq!(cells(1000), vec![100; 25]);
    assert_eq!(half_blocks(&[], 10, 80, TerminalColor::True), "");
    assert_eq!(half_blocks(&rgb, 0, 80, TerminalColor::True), "");
    assert_eq!(half_blocks(&rgb, 2, 0, TerminalColor::True), "");
    assert_eq!(half_blocks(&rgb, 2, 80, TerminalColor::None), "");
}

#[test]
fn terminals_are_detected_by_their_environment() {
    use TerminalColor::{None as No, Palette, True};
    for (colorterm, term, no_color, want) in [
        (Some("truecolor"), Some("xterm-256color"), None, True),
        (Some("24bit"), None, None, True),
        (None, Some("xterm-256color"), None, Palette),
        (None, Some("xterm-direct"), None, True),
        (None, Some("xterm"), None, No),
        (Some("truecolor"), Some("dumb"), None, No),
        (Some("truecolor"), Some("xterm"), Some("1"), No),
        (Some("truecolor"), Some("xterm"), Some(""), True),
        (None, None, None, No),
    ] {
        let got = TerminalColor::detect(colorterm, term, no_color);
        assert_eq!(got, want, "{colorterm:?} {term:?} {no_color:?}");
    }
}
