//! What a viewer writes over its picture: keys, the clip's numbers, messages, and how far the reading of files has come.

use std::time::{Duration, Instant};

use rara::{FrameStats, Mode, Picture};

use super::input::KEYS;
use super::layers::Clips;
use super::numbers;
use super::text::{self, ProgressBar, Type};
use super::title::total;
use crate::Panel;

const HINT: &str = "H: keys   M: numbers   drop a file to open it";
/// The hint goes away after this time with a scene.
const HINT_TIME: Duration = Duration::from_secs(10);
/// A message that nobody takes away goes away after this time.
const MESSAGE_TIME: Duration = Duration::from_secs(20);
/// Pixels between panels, and between them and the window's edges, on an ordinary screen.
const GAP: f64 = 8.0;

#[derive(Debug, Clone, Default)]
pub(super) struct Overlay {
    talks: bool,
    keys: bool,
    numbers: bool,
    hint: bool,
    /// The time until which the hint is shown, once there is a scene.
    hint_until: Option<Instant>,
    /// What has failed or was done, until when it is shown, and whether it has failed.
    message: Option<(String, Instant, bool)>,
    /// What the window shows now.
    shown: Option<Content>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Content {
    size: (u32, u32),
    of: Type,
    gap: u32,
    keys: bool,
    numbers: Vec<String>,
    hint: bool,
    message: Option<(String, bool)>,
    progress: Option<(String, ProgressBar)>,
}

/// What the overlay says of the picture.
pub(super) struct OverlayScene<'a> {
    /// The clips; none without a scene.
    pub(super) clips: Option<&'a Clips>,
    pub(super) mode: Mode,
    pub(super) stats: Option<&'a FrameStats>,
    /// The work that the window waits for.
    pub(super) progress: Option<(String, ProgressBar)>,
    /// The window's size, px, and how many of them are as long as one on an ordinary screen.
    pub(super) size: (u32, u32),
    pub(super) scale_factor: f64,
}

impl Overlay {
    pub(super) fn new(text: bool) -> Self {
        Self {
            talks: text,
            numbers: text,
            hint: text,
            ..Self::default()
        }
    }

    /// Shows the keys or not; whichever it is not where that is not said.
    pub(super) fn set_keys(&mut self, on: Option<bool>) {
        self.keys = on.unwrap_or(!self.keys);
        (self.hint, self.hint_until) = (false, None);
    }

    pub(super) fn set_numbers(&mut self, on: Option<bool>) {
        self.numbers = on.unwrap_or(!self.numbers);
    }

    pub(super) fn warn(&mut self, text: String) {
        self.message = Some((text, Instant::now() + MESSAGE_TIME, true));
    }

    pub(super) fn tell(&mut self, text: String) {
        if self.talks {
            self.message = Some((text, Instant::now() + MESSAGE_TIME, false));
        }
    }

    /// Takes a message away; says whether there was one.
    pub(super) fn hush(&mut self) -> bool {
        self.message.take().is_some()
    }

    pub(super) fn scene_is_seen(&mut self) {
        if self.hint {
            self.hint_until
                .get_or_insert_with(|| Instant::now() + HINT_TIME);
        }
    }

    /// The time at which something of it goes away.
    pub(super) fn until(&self) -> Option<Instant> {
        let message = self.message.as_ref().map(|(_, until, _)| *until);
        [self.hint_until, message].into_iter().flatten().min()
    }

    /// Takes away what has been shown for long enough; says whether there was anything.
    pub(super) fn pass(&mut self, now: Instant) -> bool {
        let hint = self.hint_until.take_if(|until| *until <= now).is_some();
        self.hint &= !hint;
        let message = self.message.take_if(|(_, until, _)| *until <= now);
        hint || message.is_some()
    }

    /// The panels to show, if they are others than before.
    pub(super) fn panels(&mut self, content: Content) -> Option<Vec<Panel>> {
        if self.shown.as_ref() == Some(&content) {
            return None;
        }
        let panels = laid_out(&content);
        self.shown = Some(content);
        Some(panels)
    }

    /// True when the window does not show what it should.
    pub(super) fn is_old(&self, seen: &OverlayScene<'_>) -> bool {
        self.shown.as_ref() != Some(&self.content(seen))
    }

    /// What the window should show.
    pub(super) fn content(&self, seen: &OverlayScene<'_>) -> Content {
        Content {
            size: seen.size,
            of: Type::new(seen.scale_factor),
            gap: (GAP * seen.scale_factor).round() as u32,
            keys: self.keys,
            numbers: match seen.clips.filter(|_| self.numbers) {
                Some(clips) => lines(clips, seen.mode, seen.stats),
                None => Vec::new(),
            },
            hint: self.hint,
            message: self
                .message
                .as_ref()
                .map(|(text, _, failed)| (text.clone(), *failed)),
            progress: seen.progress.clone(),
        }
    }
}

/// The mode and what a frame takes, what is cut by what, and its numbers.
fn lines(clips: &Clips, mode: Mode, stats: Option<&FrameStats>) -> Vec<String> {
    let took = stats.and_then(total);
    let took = took.map(|ms| format!(", last frame {ms:.1} ms"));
    let mut lines = vec![format!("mode {}{}", mode, took.unwrap_or_default())];
    let words = clips.words();
    lines.push(words.unwrap_or_else(|| "nothing is cut; P or a right drag cuts".into()));
    if let Some(cut) = clips.edited().filter(|cut| cut.on) {
        lines.extend(cut.shape().map(numbers::lines).unwrap_or_default());
    }
    lines
}

/// The panels, the most important first: of those that overlap it is shown.
fn laid_out(content: &Content) -> Vec<Panel> {
    let ((width, height), gap) = (content.size, content.gap);
    let room = (
        width.saturating_sub(2 * gap),
        height.saturating_sub(2 * gap),
    );
    let of = content.of;
    let mut panels = Vec::new();
    let mut put = |x: u32, y: u32, picture: Picture| {
        panels.push(Panel {
            at: (x, y),
            picture,
        })
    };
    // Messages and the hint are at the bottom, and what is read is above them.
    let mut floor = height.saturating_sub(gap);
    let below = match &content.message {
        Some((text, failed)) => {
            let lines = text::wrapped(text, of.columns(room.0));
            Some(text::sheet(
                &lines,
                of,
                room,
                failed.then_some(text::WARNING),
            ))
        }
        None => content
            .hint
            .then(|| text::sheet(&[HINT.into()], of, room, None)),
    };
    if let Some(picture) = below {
        floor = floor.saturating_sub(picture.height);
        put(gap, floor, picture);
        floor = floor.saturating_sub(gap);
    }
    if let Some((text, progress)) = &content.progress {
        let picture = text::bar(text, *progress, of, room);
        let left = width.saturating_sub(picture.width) / 2;
        put(left, floor.saturating_sub(picture.height), picture);
    }
    let numbers = match content.numbers.is_empty() {
        true => None,
        false => Some(text::sheet(&content.numbers, of, room, None)),
    };
    if content.keys {
        let lines: Vec<String> = KEYS.lines().map(str::to_owned).collect();
        let keys = text::sheet(&lines, of, room, None);
        // They stand beside the numbers, or in their place.
        let beside = numbers.as_ref().map_or(0, |numbers| numbers.width + gap);
        let left = match beside + keys.width <= room.0 {
            true => gap + room.0 - keys.width,
            false => gap,
        };
        put(left, gap, keys);
    }
    if let Some(numbers) = numbers {
        put(gap, gap, numbers);
    }
    panels
}

#[cfg(test)]
mod tests;
