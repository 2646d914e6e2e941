//! Reads charts back.

use roxmltree::{Document, Node};

/// What stands in a chart.
pub(super) struct Read {
    text: String,
}

impl Read {
    /// The chart, which must be well-formed; a folder in `RARA_CHARTS` gets a copy to look at.
    pub(super) fn parse(name: &str, svg: &str) -> Self {
        Document::parse(svg).expect("well-formed XML");
        if let Ok(folder) = std::env::var("RARA_CHARTS") {
            std::fs::write(format!("{folder}/{name}.svg"), svg).expect("a copy");
        }
        Self { text: svg.into() }
    }

    /// Every text is there, as a whole or in lines.
    pub(super) fn has(&self, texts: &[&str]) {
        let document = Document::parse(&self.text).expect("well-formed XML");
        let written = document.descendants().filter(|n| n.has_tag_name("text"));
        let written: Vec<_> = written.filter_map(|n| n.text()).map(str::trim).collect();
        let all = written.join(" ");
        for text in texts {
            assert!(
                written.contains(text) || all.contains(text),
                "{text}: {written:?}"
            );
        }
    }

    /// Elements of a kind in a colour, as it stands in the file.
    fn each<T>(
        &self,
        tag: &str,
        key: &str,
        colour: &str,
        read: impl Fn(Node<'_, '_>) -> T,
    ) -> Vec<T> {
        let document = Document::parse(&self.text).expect("well-formed XML");
        let nodes = document.descendants().filter(|n| n.has_tag_name(tag));
        let coloured = nodes.filter(|n| n.attribute(key) == Some(colour));
        coloured.map(read).collect()
    }

    /// Centres of filled circles.
    pub(super) fn circles(&self, colour: &str) -> Vec<(i32, i32)> {
        self.each("circle", "fill", colour, |n| {
            (value(n, "cx"), value(n, "cy"))
        })
    }

    /// Left, top, width and height of filled rectangles.
    pub(super) fn rectangles(&self, colour: &str) -> Vec<(i32, i32, i32, i32)> {
        self.each("rect", "fill", colour, |n| {
            (
                value(n, "x"),
                value(n, "y"),
                value(n, "width"),
                value(n, "height"),
            )
        })
    }

    /// The corners of filled polygons.
    pub(super) fn polygons(&self, colour: &str) -> Vec<Vec<(i32, i32)>> {
        self.each("polygon", "fill", colour, points)
    }

    /// The points of lines.
    pub(super) fn paths(&self, colour: &str) -> Vec<Vec<(i32, i32)>> {
        self.each("polyline", "stroke", colour, points)
    }
}

fn value(node: Node<'_, '_>, name: &str) -> i32 {
    let text = node.attribute(name).expect("an attribute");
    text.parse().expect("a number")
}

fn points(node: Node<'_, '_>) -> Vec<(i32, i32)> {
    let text = node.attribute("points").expect("points");
    let point = |pair: &str| {
        let (x, y) = pair.split_once(',').expect("two numbers");
        (x.parse().expect("x"), y.parse().expect("y"))
    };
    text.split_whitespace().map(point).collect()
}
