//! Reads charts back.

use plotters::style::{RGBColor, text_anchor::HPos};
use roxmltree::{Document, Node};

use super::canvas::{INK, PAPER, SMALL, WIDTH, diverging, on, width_of, wrapped};
use super::plot::Labels;
use super::{Axis, HeatMap, Plot, Radar, Series, Violins};

/// The colour of the first series.
const FIRST: &str = "#0072B2";

type Places = Vec<(i32, i32)>;

/// What stands in a chart.
struct Read {
    texts: Vec<String>,
    /// Tag, colour of the inside, colour of the line, and places.
    shapes: Vec<(String, String, String, Places)>,
}

impl Read {
    /// The chart, which must be well-formed and within its canvas; a folder in `RARA_CHARTS` gets a copy to look at.
    fn parse(name: &str, svg: &str) -> Self {
        let document = Document::parse(svg).expect("well-formed XML");
        if let Ok(folder) = std::env::var("RARA_CHARTS") {
            std::fs::write(format!("{folder}/{name}.svg"), svg).expect("a copy");
        }
        let (mut texts, mut shapes) = (Vec::new(), Vec::new());
        for node in document.root_element().children().filter(Node::is_element) {
            let places = places(node);
            let height = number(document.root_element(), "height");
            let is_within =
                |p: &(i32, i32)| (0..=WIDTH).contains(&p.0) && (0..=height).contains(&p.1);
            assert!(places.iter().all(is_within), "{name}: {node:?} {places:?}");
            texts.extend(node.text().map(|text| text.trim().to_owned()));
            let [fill, stroke] = ["fill", "stroke"].map(|name| node.attribute(name).unwrap_or(""));
            shapes.push((
                node.tag_name().name().into(),
                fill.into(),
                stroke.into(),
                places,
            ));
        }
        Self { texts, shapes }
    }

    /// Every text is there, as a whole or in lines of a word.
    fn has(&self, texts: &[&str]) {
        let is_there = |text: &str| self.texts.iter().any(|written| written == text);
        for text in texts {
            let found = is_there(text) || text.split(' ').all(is_there);
            assert!(found, "{text}: {:?}", self.texts);
        }
    }

    /// The places of elements of a kind with a colour.
    fn each(&self, tag: &str, colour: &str) -> Vec<&Places> {
        let shapes = self.shapes.iter();
        let found = shapes.filter(|s| s.0 == tag && [&s.1, &s.2].contains(&&colour.to_owned()));
        found.map(|shape| &shape.3).collect()
    }

    fn circles(&self, colour: &str) -> Places {
        self.each("circle", colour)
            .into_iter()
            .flatten()
            .copied()
            .collect()
    }
}

fn number(node: Node<'_, '_>, name: &str) -> i32 {
    let text = node.attribute(name).expect("an attribute");
    text.parse().expect("a number")
}

/// The corners or the centre of a shape, or the ends of a text.
fn places(node: Node<'_, '_>) -> Places {
    let place = |x, y| (number(node, x), number(node, y));
    match node.tag_name().name() {
        "circle" => vec![place("cx", "cy")],
        "rect" => vec![place("x", "y")],
        "text" => {
            let (x, y) = place("x", "y");
            let wide = width_of(node.text().unwrap_or("").trim(), SMALL);
            match node.attribute("text-anchor") {
                // The description of an axis up.
                _ if node.has_attribute("transform") => vec![(x, y - wide / 2), (x, y + wide / 2)],
                Some("start") => vec![(x, y), (x + wide, y)],
                Some("end") => vec![(x - wide, y), (x, y)],
                _ => vec![(x - wide / 2, y), (x + wide / 2, y)],
            }
        }
        _ => {
            let pairs = node.attribute("points").unwrap_or("").split_whitespace();
            let pairs = pairs.map(|pair| pair.split_once(',').expect("two numbers"));
            let pairs = pairs.map(|(x, y)| (x.parse().expect("x"), y.parse().expect("y")));
            pairs.collect()
        }
    }
}

fn series<'a>(name: &str, points: impl IntoIterator<Item = (f64, f64, &'a str)>) -> Series {
    let points = points.into_iter().map(|(x, y, label)| (x, y, label.into()));
    Series {
        name: name.into(),
        points: points.collect(),
    }
}

fn marks(axis: &Axis, values: &[f64]) -> Vec<String> {
    let span = axis.span(values.iter().copied());
    span.marks.into_iter().map(|mark| mark.1).collect()
}

#[test]
fn marks_are_round_and_include_both_ends() {
    let linear = Axis::linear("");
    let tenths = ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6"];
    assert_eq!(marks(&linear, &[0.0, 0.6]), tenths);
    let even = ["−8", "−6", "−4", "−2", "0", "2", "4", "6", "8"];
    assert_eq!(marks(&linear, &[-7.0, 7.0]), even);
    assert!(marks(&linear, &[3.0]).contains(&"3".into()));
    assert_eq!(marks(&linear, &[])[0], "0");
    let millions = ["0", "1e6", "2e6", "3e6", "4e6", "5e6"];
    assert_eq!(marks(&linear.between(0.0, 5e6), &[1.0]), millions);
}

#[test]
fn logarithms_have_decades_or_twice_and_five_times_them() {
    let log = Axis::log("");
    assert_eq!(marks(&log, &[1.0, 10.0]), ["1", "2", "5", "10"]);
    let decades = ["1e−6", "1e−5", "0.0001", "0.001", "0.01", "0.1", "1"];
    assert_eq!(marks(&log, &[1e-6, 1.0]), decades);
    assert!(marks(&log, &[1e-30, 1e30]).len() <= 10);
    assert!(marks(&log, &[0.0, 1.0, 10.0]).contains(&"0".into()));
}

#[test]
fn zeros_of_logarithms_lie_before_the_break_and_everything_else_after_it() {
    let span = Axis::log("").span([0.0, 0.01, 1.0]);
    let [zero, small, one] = [0.0, 0.01, 1.0].map(|value| span.at(value).expect("a place"));
    let at_break = span.breaks().expect("a break");
    assert!(span.ends[0] < zero && zero < at_break && at_break < small && one < span.ends[1]);
    assert_eq!(span.at(-1.0), None);
    let fixed = Axis::log("").between(0.01, 1.0).span([0.5]);
    assert_eq!(
        [0.0, 0.1, 10.0].map(|v| fixed.at(v)),
        [None, Some(-1.0), Some(0.0)]
    );
}

#[test]
fn values_that_are_none_or_extreme_break_nothing() {
    const EXTREMES: [&[f64]; 7] = [
        &[],
        &[f64::NAN, f64::INFINITY, -1.0],
        &[f64::MIN_POSITIVE, f64::MAX, 0.0],
        &[5e-324],
        &[0.0],
        &[-f64::MAX, f64::MAX, -1e300, 1e300],
        &[1.0, 1.0 + f64::EPSILON],
    ];
    let title = "Neither \u{1b} nor \u{ffff} is <XML>";
    for values in EXTREMES {
        let [first, last] = [values.first(), values.last()].map(|v| v.copied().unwrap_or(1.0));
        let axes = [Axis::linear("Value"), Axis::log("Value")];
        for axis in axes
            .into_iter()
            .chain([Axis::log("Value").between(first, last)])
        {
            assert!(marks(&axis, values).len() < 100, "{axis:?} {values:?}");
            let plot = Plot {
                title: title.into(),
                x: axis.clone(),
                y: axis.clone(),
                series: vec![series("all", values.iter().map(|v| (*v, *v, "label")))],
                joined: true,
                front: values.iter().map(|v| [*v, *v]).collect(),
            };
            Read::parse("plot_extreme", &plot.svg());
            let radar = Radar {
                title: title.into(),
                axes: values.iter().map(|v| format!("{v:e}")).collect(),
                radius: axis.clone(),
                series: vec![("all".into(), values.into())],
            };
            Read::parse("radar_extreme", &radar.svg());
            let violins = Violins {
                title: title.into(),
                x: String::new(),
                y: axis,
                samples: vec![("all".into(), values.into())],
            };
            Read::parse("violins_extreme", &violins.svg());
        }
    }
}

#[test]
fn every_point_and_label_is_there_and_zeros_lie_below_the_break() {
    let points = [
        (1.0, 1e-4, "exact"),
        (1.1, 1e-4, "affine"),
        (2.0, 0.0, "beam"),
    ];
    let plot = Plot {
        title: "Error against time".into(),
        x: Axis::log("Time (ms)"),
        y: Axis::log("Mean squared error"),
        series: vec![
            series("rara", points),
            series("others", [(0.5, 1e-2, "hard"), (4.0, 1e-3, "<none>")]),
        ],
        joined: false,
        front: vec![[0.5, 1e-2], [1.0, 1e-4], [2.0, 0.0]],
    };
    let read = Read::parse("points", &plot.svg());
    read.has(&[
        "exact", "affine", "beam", "hard", "<none>", "rara", "others",
    ]);
    read.has(&["Error against time", "Time (ms)", "Mean squared error", "0"]);
    let [_, exact, affine, beam] = read.circles(FIRST)[..] else {
        panic!("the legend's and three points");
    };
    assert!(exact.0 < affine.0 && affine.0 < beam.0);
    assert!(exact.1 == affine.1 && beam.1 > exact.1 + 20);
    let front = read
        .each("polyline", "#666666")
        .into_iter()
        .find(|path| path.len() > 2);
    let front = front.expect("a front");
    assert_eq!(
        front[1..],
        [(exact.0, front[0].1), exact, (beam.0, exact.1), beam]
    );
}

#[test]
fn labels_of_close_points_do_not_overlap() {
    let mut labels = Labels {
        taken: vec![[94, 94, 106, 106], [96, 94, 108, 106]],
        room: [0, 0, 400, 400],
    };
    for (number, text) in (0..).zip(["first", "second", "third", "fourth"]) {
        labels.place(text, (100 + 2 * (number % 2), 100));
    }
    for (i, a) in labels.taken.iter().enumerate().skip(2) {
        for b in &labels.taken[..i] {
            let apart = a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3];
            assert!(apart, "{a:?} {b:?}");
        }
    }
    let (_, anchor) = labels.place("at the right edge", (390, 200));
    assert!(matches!(anchor, HPos::Right));
}

#[test]
fn lines_pass_through_their_points_and_break_where_values_are_missing() {
    let broken = [
        (1e3, 1.0, ""),
        (1e4, 2.0, ""),
        (1e5, f64::NAN, ""),
        (1e6, 9.0, ""),
    ];
    let plot = Plot {
        title: "Time by size".into(),
        x: Axis::log("Gaussians"),
        y: Axis::linear("Time (ms)").between(0.0, 10.0),
        series: vec![
            series("exact", broken),
            series("hard & fast", [(1e3, 0.5, ""), (1e6, 4.0, "")]),
        ],
        joined: true,
        front: Vec::new(),
    };
    let read = Read::parse("lines", &plot.svg());
    read.has(&[
        "Time by size",
        "Gaussians",
        "Time (ms)",
        "exact",
        "hard & fast",
    ]);
    read.has(&["0", "10", "1e6"]);
    let [first, last] = read.each("polyline", FIRST)[..] else {
        panic!("two pieces");
    };
    assert_eq!((first.len(), last.len()), (2, 1));
    // Decades are equally long.
    let decade = first[1].0 - first[0].0;
    assert!((last[0].0 - first[0].0 - 3 * decade).abs() <= 2);
    assert!(first[0].1 > first[1].1 && first[1].1 > last[0].1);
    assert_eq!(read.circles(FIRST)[1..], [first[0], first[1], last[0]]);
}

#[test]
fn cells_have_the_colours_and_numbers_of_their_values() {
    let map = HeatMap {
        title: "Preference by case".into(),
        x: "Metric".into(),
        y: "Case".into(),
        rows: vec!["surfaces 1, face".into(), "hair 1, edge".into()],
        columns: vec!["Flatness".into(), "Temporal stability".into()],
        values: vec![vec![7.0, -3.456], vec![-0.01, f64::NAN]],
        unit: "Mean signed preference".into(),
        most: 7.0,
    };
    let read = Read::parse("heat_map", &map.svg());
    read.has(&[
        "Preference by case",
        "Metric",
        "Case",
        "Mean signed preference",
    ]);
    read.has(&[
        "surfaces 1, face",
        "hair 1, edge",
        "Flatness",
        "Temporal stability",
    ]);
    read.has(&["7.0", "−3.5", "0.0", "–"]);
    let [full, minus, middle] = [7.0, -3.456, -0.01].map(|value| {
        let RGBColor(r, g, b) = diverging(value / 7.0);
        read.each("rect", &format!("#{r:02X}{g:02X}{b:02X}"))[0][0]
    });
    assert!(full.0 == middle.0 && full.1 < middle.1, "rows go down");
    assert!(full.1 == minus.1 && full.0 < minus.0, "columns go right");
}

#[test]
fn values_of_a_radar_are_as_far_from_the_middle_as_they_are_large() {
    let names = [
        "Flatness",
        "Stability",
        "Topological integrity",
        "Naturalness",
    ];
    let radar = Radar {
        title: "Mean preferences".into(),
        axes: names.map(Into::into).into(),
        radius: Axis::linear("Signed preference").between(0.0, 4.0),
        series: vec![("exact".into(), vec![4.0, 2.0, 2.0, f64::NAN])],
    };
    let read = Read::parse("radar", &radar.svg());
    read.has(&names);
    read.has(&["Mean preferences", "Signed preference", "exact", "4"]);
    let [_, top, right, bottom] = read.circles(FIRST)[..] else {
        panic!("the legend's and three values");
    };
    assert_eq!(top.0, bottom.0);
    let reach = right.0 - top.0;
    assert!((bottom.1 - right.1 - reach).abs() <= 1);
    assert!((right.1 - top.1 - 2 * reach).abs() <= 1);
}

#[test]
fn a_violin_is_widest_where_values_are_frequent_and_its_bar_is_at_the_median() {
    let samples = [
        ("Flatness", vec![3.0, 3.0, 3.0, 3.0, -6.0]),
        ("Topological integrity", vec![0.0, 7.0]),
        ("Nobody", vec![]),
        ("All the same", vec![2.0, 2.0]),
    ];
    let violins = Violins {
        title: "Preferences".into(),
        x: "Metric".into(),
        y: Axis::linear("Signed preference").between(-7.0, 7.0),
        samples: samples.map(|(name, values)| (name.into(), values)).into(),
    };
    let read = Read::parse("violins", &violins.svg());
    read.has(&[
        "Preferences",
        "Flatness",
        "Nobody",
        "Signed preference",
        "Metric",
    ]);
    let [first, second, _] = read.each("polyline", "#222222")[..] else {
        panic!("three bars");
    };
    let dots = read.circles("#222222");
    assert_eq!(dots.len(), 9);
    // The median of the first is where its threes are, that of the second halfway between its values.
    assert_eq!(first[0].1, dots[0].1);
    assert!((2 * second[0].1 - dots[5].1 - dots[6].1).abs() <= 1);
    let outline = read.each("polygon", FIRST)[0].iter();
    let widest = outline.max_by_key(|place| place.0).expect("a violin");
    assert!((widest.1 - dots[0].1).abs() <= 12);
}

#[test]
fn long_text_is_wrapped_at_its_spaces_and_a_long_word_stays() {
    let text = "Topological integrity";
    assert_eq!(wrapped(text, 100, SMALL), ["Topological", "integrity"]);
    assert_eq!(wrapped(text, 500, SMALL), [text]);
    let word = "Donaudampfschifffahrt";
    assert_eq!(wrapped(word, 10, SMALL), [word]);
    assert_eq!(wrapped("", 10, SMALL), [""]);
}

#[test]
fn both_directions_of_colours_are_equally_strong_and_text_can_be_read_on_them() {
    let brightness = |RGBColor(r, g, b)| (u32::from(r) + u32::from(g) + u32::from(b)) / 3;
    assert_eq!(diverging(0.0), diverging(-0.0));
    for step in 1..=10 {
        let value = f64::from(step) / 10.0;
        let (RGBColor(r, _, b), RGBColor(r2, _, b2)) = (diverging(value), diverging(-value));
        assert!(r > b && b2 > r2, "{value}");
        assert!(brightness(diverging(value)) < brightness(diverging(value - 0.1)));
        assert!(brightness(diverging(-value)) < brightness(diverging(0.1 - value)));
    }
    assert_eq!([0.0, -1.0].map(|value| on(diverging(value))), [INK, PAPER]);
}
