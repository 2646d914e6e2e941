use super::*;

const ROOM: (u32, u32) = (1280, 720);

fn lines(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| (*text).to_owned()).collect()
}

#[test]
fn text_is_broken_at_blanks_and_within_long_words() {
    assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
    assert_eq!(wrapped("one two three", 6), ["one", "two", "three"]);
    assert_eq!(
        wrapped("a /very/long/path end", 5),
        ["a", "/very", "/long", "/path", "end"]
    );
    assert_eq!(wrapped("abcdefg hi", 4), ["abcd", "efg", "hi"]);
    assert_eq!(wrapped("ab", 0), ["a", "b"]);
    assert!(wrapped("  ", 5).is_empty());
    let text = "what is wrong, where it is wrong, and a remedy".repeat(5);
    for columns in 1..60 {
        let lines = wrapped(&text, columns);
        assert!(lines.iter().all(|line| line.chars().count() <= columns));
        let letters = |text: &str| text.chars().filter(|c| *c != ' ').collect::<String>();
        assert_eq!(letters(&lines.concat()), letters(&text), "{columns}");
    }
}

#[test]
fn a_sheet_holds_its_text_and_no_more_than_there_is_room() {
    let text = lines(&["plane", "normal 1 0 0"]);
    let large = sheet(&text, Type::new(1.0), ROOM, None);
    assert_eq!((large.width, large.height), (12 * 8 + 12, 2 * 16 + 12));
    let twice = sheet(&text, Type::new(2.0), ROOM, None);
    assert_eq!(
        (twice.width, twice.height),
        (2 * large.width, 2 * large.height)
    );
    // Where there is less room the letters are smaller, and then some are missing.
    let small = sheet(&text, Type::new(2.0), (100, 200), None);
    assert_eq!((small.width, small.height), (12 * 6 + 12, 2 * 12 + 12));
    let cut = sheet(&text, Type::new(1.0), (40, 7), None);
    assert_eq!((cut.width, cut.height), (40, 7));
    let none = sheet(&text, Type::new(1.0), (0, 0), None);
    assert!(none.pixels.is_empty());
}

#[test]
fn letters_are_on_the_paper_and_not_at_its_edges() {
    let text = lines(&["Hjgp|", "|_|_|"]);
    for scale in [1.0, 2.0] {
        let paper = sheet(&text, Type::new(scale), ROOM, Some(WARNING));
        let plain = paper.at(0, 0);
        let [r, g, b] = WARNING.map(|v| f32::from(v) / 255.0);
        let inked = paper.pixels.iter().filter(|p| p[..3] == [r, g, b]).count();
        assert!(inked > 60, "{inked}");
        let edge = |x: u32, y: u32| x < 2 || y < 2 || x >= paper.width - 2 || y >= paper.height - 2;
        for (x, y) in (0..paper.height).flat_map(|y| (0..paper.width).map(move |x| (x, y))) {
            assert!(!edge(x, y) || paper.at(x, y) == plain, "{x} {y}");
        }
    }
}

#[test]
fn a_bar_is_as_full_as_the_work_is_done() {
    let filled = |progress| {
        let paper = bar("reading", progress, Type::new(1.0), ROOM);
        let [r, g, b] = FILLED.map(|v| f32::from(v) / 255.0);
        let filled = paper.pixels.iter().filter(|p| p[..3] == [r, g, b]).count();
        filled as f64 / (320 * BAR) as f64
    };
    for share in [0.0, 0.25, 0.5, 1.0] {
        assert_eq!(filled(ProgressBar::Share(share)), share);
    }
    assert_eq!(filled(ProgressBar::Share(f64::INFINITY)), 1.0);
    assert_eq!(filled(ProgressBar::Share(f64::NAN)), 0.0);
    assert_eq!(filled(ProgressBar::Moving(0.5)), RUNNER);
    assert_eq!(filled(ProgressBar::Moving(0.0)), 0.0);
    assert_eq!(filled(ProgressBar::Moving(1.0)), 0.0);
}
