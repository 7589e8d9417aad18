//! A picture read back: its elements, the plot's frame, its ticks and marks.

use std::fmt::Write as _;

/// An element of a picture with the text in it.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    attributes: Vec<(String, String)>,
    pub(super) text: String,
}

impl Element {
    /// Of what follows a `<`.
    fn read(source: &str) -> Self {
        let (tag, text) = source.split_once('>').unwrap_or((source, ""));
        let (name, mut rest) = tag.trim_end_matches('/').split_once(' ').unwrap_or((tag, ""));
        let mut attributes = Vec::new();
        while let Some((key, more)) = rest.split_once("=\"") {
            let (value, more) = more.split_once('"').expect("a closed value");
            attributes.push((key.trim().to_owned(), value.to_owned()));
            rest = more;
        }
        Self { name: name.to_owned(), attributes, text: text.trim().to_owned() }
    }

    /// An attribute; empty where there is none.
    pub(super) fn word(&self, key: &str) -> &str {
        let found = self.attributes.iter().find(|(name, _)| name == key);
        found.map_or("", |(_, value)| value.as_str())
    }

    pub(super) fn number(&self, key: &str) -> f64 {
        self.word(key).parse().unwrap_or_else(|_| panic!("no number {key} in {self:?}"))
    }

    /// The points of a polyline.
    pub(super) fn points(&self) -> Vec<[f64; 2]> {
        let pairs = self.word("points").split_whitespace().filter_map(|pair| pair.split_once(','));
        pairs.map(|(x, y)| [x, y].map(|c| c.parse().expect("a number"))).collect()
    }

    /// Name and all attributes that differ from picture to picture, but for the points.
    fn style(&self) -> String {
        let mut line = self.name.clone();
        for (key, value) in &self.attributes {
            match key.as_str() {
                "points" | "xmlns" | "font-family" | "stroke-linejoin" | "role" => {}
                "font-size" => line += &format!(" font-size {:.1}", self.number(key)),
                "opacity" if value == "1" => {}
                "fill" | "stroke" if value == "none" => {}
                _ => line += &format!(" {key} {value}"),
            }
        }
        line
    }

    /// Text and points: all of few, the ends of many.
    fn content(&self) -> String {
        let points: Vec<&str> = self.word("points").split_whitespace().collect();
        let points = match points[..] {
            [first, second, .., last] if points.len() > 16 => {
                format!("{first} {second} … {last}, {} points", points.len())
            }
            _ => points.join(" "),
        };
        format!("{points}{}", self.text)
    }
}

/// What a picture shows, a line each, with all that decides how it looks. Of dashes the first two
/// and the last.
pub(super) fn digest(svg: &str) -> String {
    let lines: Vec<(String, String)> =
        Picture::read(svg).elements.iter().map(|element| (element.style(), element.content())).collect();
    let mut text = String::new();
    for group in lines.chunk_by(|a, b| a.0 == b.0 && a.0.starts_with("polyline")) {
        let contents: Vec<&str> = group.iter().map(|(_, content)| content.as_str()).collect();
        let contents = match contents[..] {
            [first, second, .., last] if contents.len() > 3 => {
                format!("{first} | {second} | … | {last}, {} lines", contents.len())
            }
            _ => contents.join(" | "),
        };
        writeln!(text, "{}: {contents}", group[0].0).expect("text takes text");
    }
    text
}

/// Place and value.
pub(super) type Tick = (f64, f64);

pub(super) struct Picture {
    pub(super) elements: Vec<Element>,
}

/// Of axes and ticks.
const FRAME: &str = "#787878";

impl Picture {
    pub(super) fn read(svg: &str) -> Self {
        let opening = svg.split('<').skip(1).filter(|source| !source.starts_with('/'));
        Self { elements: opening.map(Element::read).collect() }
    }

    pub(super) fn named(&self, name: &'static str) -> impl Iterator<Item = &Element> {
        self.elements.iter().filter(move |element| element.name == name)
    }

    /// The texts in their order.
    pub(super) fn texts(&self) -> Vec<&str> {
        self.named("text").map(|element| element.text.as_str()).collect()
    }

    /// The one text that reads so.
    pub(super) fn text(&self, words: &str) -> &Element {
        let mut found = self.named("text").filter(|element| element.text == words);
        let first = found.next().unwrap_or_else(|| panic!("no text {words} in {:?}", self.texts()));
        assert!(found.next().is_none(), "{words} is there twice");
        first
    }

    /// Polylines of a colour.
    pub(super) fn lines(&self, colour: &'static str) -> Vec<&Element> {
        self.named("polyline").filter(|line| line.word("stroke") == colour).collect()
    }

    /// Filled circles of a colour.
    pub(super) fn dots(&self, colour: &'static str) -> Vec<&Element> {
        self.named("circle").filter(|circle| circle.word("fill") == colour).collect()
    }

    /// Left, right, top and bottom of the plot, between which values are mapped.
    pub(super) fn frame(&self) -> [f64; 4] {
        let length = |line: &[[f64; 2]]| (line[0][0] - line[1][0]).abs() + (line[0][1] - line[1][1]).abs();
        let longest = |axis: usize| {
            let lines = self.lines(FRAME).into_iter().map(Element::points);
            let along = lines.filter(|line| line[0][1 - axis] == line[1][1 - axis]);
            along.max_by(|a, b| length(a).total_cmp(&length(b))).expect("an axis")
        };
        let (across, upright) = (longest(0), longest(1));
        [across[0][0], across[1][0], upright[0][1], upright[1][1]]
    }

    /// Ticks along x and along y, in the order of their places.
    pub(super) fn ticks(&self) -> [Vec<Tick>; 2] {
        let mut ticks = [Vec::new(), Vec::new()];
        let mut factors = [1.0, 1.0];
        for text in self.named("text") {
            let (anchor, shift) = (text.word("text-anchor"), text.word("dy"));
            if let Some(power) = text.text.strip_prefix("× ") {
                factors[usize::from(anchor == "start")] = value(power);
            } else if text.word("transform").is_empty() {
                match (anchor, shift) {
                    ("middle", "0.76em") => ticks[0].push((text.number("x"), value(&text.text))),
                    ("end", "0.5ex") => ticks[1].push((text.number("y"), value(&text.text))),
                    _ => {}
                }
            }
        }
        for (ticks, factor) in ticks.iter_mut().zip(factors) {
            ticks.iter_mut().for_each(|tick| tick.1 *= factor);
            ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        ticks
    }

    /// Where a value lies along an axis, by its first and last tick.
    pub(super) fn place(&self, axis: usize, log: bool, value: f64) -> f64 {
        let measure = |v: f64| if log { v.log10() } else { v };
        let ticks = &self.ticks()[axis];
        let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
        let slope = (last.0 - first.0) / (measure(last.1) - measure(first.1));
        first.0 + slope * (measure(value) - measure(first.1))
    }

    /// The value at a place along an axis without logarithm.
    pub(super) fn value_at(&self, axis: usize, place: f64) -> f64 {
        let ticks = &self.ticks()[axis];
        let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
        first.1 + (place - first.0) * (last.1 - first.1) / (last.0 - first.0)
    }
}

/// The number that a tick's text says: `−2.5`, `1`, `10`, `10⁻³`.
fn value(text: &str) -> f64 {
    let plain = |c: char| match "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|digit| digit == c) {
        Some(digit) => char::from_digit(digit as u32, 10).expect("a digit"),
        None => '-',
    };
    let written = match text.strip_prefix("10") {
        Some(power) if power.starts_with(|c: char| !c.is_ascii()) => {
            format!("1e{}", power.chars().map(plain).collect::<String>())
        }
        _ => text.replace('−', "-"),
    };
    written.parse().unwrap_or_else(|_| panic!("no number: {text}"))
}
