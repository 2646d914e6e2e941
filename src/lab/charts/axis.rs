//! Axes: what stands beside them, how values lie along them, and where their marks are.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    #[default]
    Linear,
    /// Values lie by their logarithms. Zeros have a band of their own before a break in the axis; negative values are missing.
    Log,
}

/// The largest magnitude on an axis, so that lengths and steps are finite too.
const LARGEST: f64 = 1e300;

#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it measures, and in which unit: "Time (ms)".
    pub label: String,
    pub scale: Scale,
    /// The ends of the axis; `None` is as far as the values.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
        }
    }

    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    pub fn between(self, low: f64, high: f64) -> Self {
        Self {
            range: Some([low, high]),
            ..self
        }
    }

    pub(super) fn takes(&self, value: f64) -> bool {
        value.abs() <= LARGEST && (self.scale == Scale::Linear || value >= 0.0)
    }

    /// The axis with the places of these values; those without a place are ignored.
    pub(super) fn span(&self, values: impl Iterator<Item = f64>) -> Span {
        let values: Vec<f64> = values.filter(|&v| self.takes(v)).collect();
        let is_log = self.scale == Scale::Log;
        let zeros = is_log && values.contains(&0.0);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let ends = self
            .range
            .into_iter()
            .flatten()
            .filter(|v| v.abs() <= LARGEST);
        let placed: Vec<f64> = if self.range.is_some() {
            ends.collect()
        } else {
            values
        };
        for value in placed.into_iter().filter(|&v| !is_log || v > 0.0) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = if is_log { (0.1, 1.0) } else { (0.0, 1.0) };
        }
        let is_fixed = self.range.is_some() && low < high;
        if !is_log && low == high {
            high = low + low.abs().max(1.0);
        }
        let step = step(high - low);
        let (low, high) = match (is_log, is_fixed) {
            (true, true) => (low.log10(), high.log10()),
            (true, false) => {
                let (low, high) = (low.log10(), high.log10());
                let margin = (0.06 * (high - low)).max(0.1);
                (low - margin, high + margin)
            }
            (false, true) => (low, high),
            // A whole number of steps, so that a mark is at both ends.
            (false, false) => ((low / step).floor() * step, (high / step).ceil() * step),
        };
        Span {
            low,
            high,
            step,
            is_log,
            zeros,
        }
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// The ends, of logarithms as such.
    low: f64,
    high: f64,
    /// The distance between marks of an axis that is linear.
    step: f64,
    is_log: bool,
    /// A band for zeros comes first.
    pub(super) zeros: bool,
}

/// The places of zeros on an axis with a band for them, of the break, and of the first of the other values; shares of its
/// length.
pub(super) const ZERO: f64 = 0.035;
pub(super) const BREAK: f64 = 0.075;
const AFTER_BREAK: f64 = 0.1;

impl Span {
    /// The place of a value: 0 is the beginning of the axis and 1 its end.
    pub(super) fn share(&self, value: f64) -> f64 {
        if self.zeros && value <= 0.0 {
            return ZERO;
        }
        let value = if self.is_log { value.log10() } else { value };
        let share = (value - self.low) / (self.high - self.low);
        if self.zeros {
            AFTER_BREAK + (1.0 - AFTER_BREAK) * share
        } else {
            share
        }
    }

    pub(super) fn marks(&self) -> Vec<f64> {
        let mut marks = if self.is_log {
            self.powers()
        } else {
            let step = self.step;
            let first = (self.low / step - 1e-9).ceil();
            let last = (self.high / step + 1e-9).floor();
            // Added up in whole steps; a power of ten is a quotient where it is below 1, so that 3 of them are 0.3.
            let mark = |i: f64| {
                if step < 1.0 {
                    i / (1.0 / step)
                } else {
                    i * step
                }
            };
            (0..=(last - first) as i32)
                .map(|i| mark(first + f64::from(i)))
                .collect()
        };
        if self.zeros {
            marks.insert(0, 0.0);
        }
        marks
    }

    /// Powers of ten, and multiples of them where there are few.
    fn powers(&self) -> Vec<f64> {
        let decades = self.high - self.low;
        let within = |v: &f64| (self.low - 1e-9..=self.high + 1e-9).contains(&v.log10());
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let every = (decades / 8.0).ceil().max(1.0) as usize;
        let parts: &[f64] = match decades {
            few if few < 0.7 => &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
            few if few < 3.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let powers = (first..=last).step_by(every).map(power_of_ten);
        let marks = powers.flat_map(|power| parts.iter().map(move |part| part * power));
        marks.filter(within).collect()
    }
}

/// 10 to this power, as exactly as its digits.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::INFINITY)
}

/// A step of 1, 2 or 5 times a power of ten that goes three to seven times into a length.
fn step(length: f64) -> f64 {
    let power = power_of_ten((length / 5.0).log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|part| part * power);
    let few = |step: &f64| length / step <= 7.5;
    steps.into_iter().find(few).unwrap_or(10.0 * power)
}

/// A number as an axis has it: short, and powers of ten where it would be long.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-3..5).contains(&exponent) {
        let digits = (3 - exponent).max(0) as usize;
        let text = format!("{value:.digits$}");
        let text = if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        return text.replace('-', "\u{2212}");
    }
    let raised: String = exponent.to_string().chars().map(raised).collect();
    let factor = number(value / power_of_ten(exponent));
    match factor.as_str() {
        "1" => format!("10{raised}"),
        factor => format!("{factor}·10{raised}"),
    }
}

fn raised(digit: char) -> char {
    match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or('⁰'),
    }
}

impl Ranged for Span {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let place = f64::from(from) + self.share(*value) * f64::from(to - from);
        place.round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() || hint.max_num_points() == 0 {
            return Vec::new();
        }
        self.marks()
    }

    fn range(&self) -> Range<f64> {
        if self.is_log {
            10_f64.powf(self.low)..10_f64.powf(self.high)
        } else {
            self.low..self.high
        }
    }
}

impl ValueFormatter<f64> for Span {
    fn format_ext(&self, value: &f64) -> String {
        number(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marks(axis: &Axis, values: &[f64]) -> Vec<String> {
        let span = axis.span(values.iter().copied());
        span.marks().into_iter().map(number).collect()
    }

    #[test]
    fn marks_are_round_and_include_both_ends() {
        let linear = Axis::linear("");
        assert_eq!(
            marks(&linear, &[0.0, 0.6]),
            ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6"]
        );
        assert_eq!(
            marks(&linear, &[-7.0, 7.0]),
            ["−8", "−6", "−4", "−2", "0", "2", "4", "6", "8"]
        );
        assert_eq!(
            marks(&linear, &[3.0]),
            ["3", "3.5", "4", "4.5", "5", "5.5", "6"]
        );
        assert_eq!(marks(&linear, &[]).first().map(String::as_str), Some("0"));
        let fixed = linear.between(0.0, 5e6);
        assert_eq!(
            marks(&fixed, &[1.0]),
            ["0", "10⁶", "2·10⁶", "3·10⁶", "4·10⁶", "5·10⁶"]
        );
    }

    #[test]
    fn logarithms_have_decades_or_twice_and_five_times_them() {
        let log = Axis::log("");
        assert_eq!(marks(&log, &[1.0, 10.0]), ["1", "2", "5", "10"]);
        assert_eq!(
            marks(&log, &[1e-6, 1.0]),
            ["10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1"]
        );
        assert!(marks(&log, &[1e-30, 1e30]).len() <= 10);
        assert_eq!(marks(&log, &[0.0, 1.0, 10.0])[0], "0");
    }

    #[test]
    fn zeros_lie_before_the_break_and_everything_else_after_it() {
        let span = Axis::log("").span([0.0, 0.01, 1.0].into_iter());
        assert_eq!(span.share(0.0), ZERO);
        assert!(span.share(0.01) > AFTER_BREAK && span.share(1.0) < 1.0);
        let plain = Axis::log("").between(0.01, 1.0).span([0.5].into_iter());
        assert!((plain.share(0.1) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn values_that_are_no_numbers_or_extreme_break_nothing() {
        for axis in [Axis::linear(""), Axis::log("")] {
            for values in [
                &[f64::NAN, f64::INFINITY, -1.0][..],
                &[f64::MIN_POSITIVE, f64::MAX],
                &[5e-324],
                &[-f64::MAX, f64::MAX],
            ] {
                let span = axis.span(values.iter().copied());
                assert!(span.marks().len() < 1000, "{values:?}");
            }
        }
    }
}
