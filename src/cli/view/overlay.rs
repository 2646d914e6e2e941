//! What a viewer writes over its picture: keys, the clip's numbers, messages, and how far the reading of files has come.

use std::time::{Duration, Instant};

use rara::{FrameStats, Mode, Panel, Picture};

use super::input::KEYS;
use super::layers::Clips;
use super::numbers;
use super::text::{self, ProgressBar, Type};
use crate::{times, values};

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
    let took = stats.and_then(times::total);
    let took = took.map(|ms| format!(", last frame {} ms", times::ms(Some(ms), 1)));
    let mut lines = vec![format!(
        "mode {}{}",
        values::name(mode),
        took.unwrap_or_default()
    )];
    let words = clips.words();
    lines.push(words.unwrap_or_else(|| "nothing is cut; P or a right drag cuts".into()));
    if let Some(cut) = clips.edited().filter(|cut| cut.on) {
        lines.extend(numbers::lines(&cut.shape()));
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
mod tests {
    use super::*;
    use crate::view::cut::ClipEditor;
    use glam::DVec3;
    use rara::{ClipOp, PassTime};

    fn clips(shapes: &[&str]) -> Clips {
        let shapes = shapes.iter().map(|text| text.parse().unwrap()).collect();
        Clips::new(
            ClipEditor::new(shapes, ClipOp::And, DVec3::ZERO),
            &[],
            DVec3::ZERO,
        )
    }

    fn seen<'a>(clips: &'a Clips, size: (u32, u32)) -> OverlayScene<'a> {
        OverlayScene {
            clips: Some(clips),
            mode: Mode::Exact,
            stats: None,
            progress: None,
            size,
            scale_factor: 1.0,
        }
    }

    #[test]
    fn the_numbers_are_those_of_the_held_shape_and_of_the_last_frame() {
        let mut stats = FrameStats::default();
        let pass = |name, ms| PassTime { name, ms };
        stats.passes = vec![pass("clip", 1.25), pass("tiles", 10.0)];
        let mut clips = clips(&["sphere:1,2,3,0.5", "plane:1,0,0,0"]);
        let written = lines(&clips, Mode::Exact, Some(&stats));
        assert_eq!(written[0], "mode exact, last frame 11.2 ms");
        assert_eq!(written[1], "sphere 1 of 2");
        assert!(written[3].starts_with("radius") && written[3].ends_with("0.5000"));
        clips.frame.next();
        let written = lines(&clips, Mode::Hard, None);
        assert_eq!(written[..2], ["mode hard", "plane 2 of 2 at 0.0000"]);
        clips.frame.on = false;
        assert_eq!(lines(&clips, Mode::None, None).len(), 2);
    }

    #[test]
    fn panels_are_made_anew_only_where_something_has_changed() {
        let mut overlay = Overlay::new(true);
        let mut clips = clips(&["plane:1,0,0,0"]);
        let size = (1280, 720);
        assert!(overlay.is_old(&seen(&clips, size)));
        let first = overlay
            .panels(overlay.content(&seen(&clips, size)))
            .expect("the first");
        assert_eq!(first.len(), 2, "numbers and a hint");
        assert!(
            overlay
                .panels(overlay.content(&seen(&clips, size)))
                .is_none()
        );
        clips.frame.flip();
        assert!(overlay.is_old(&seen(&clips, size)));
        assert!(
            overlay
                .panels(overlay.content(&seen(&clips, size)))
                .is_some()
        );
        overlay.set_keys(None);
        let with_keys = overlay
            .panels(overlay.content(&seen(&clips, size)))
            .expect("keys");
        assert_eq!(with_keys.len(), 2, "the keys are there, and no hint");
        overlay.set_numbers(Some(false));
        overlay.set_keys(Some(false));
        let none = overlay
            .panels(overlay.content(&seen(&clips, size)))
            .expect("a change");
        assert!(none.is_empty());
    }

    #[test]
    fn hints_and_messages_go_away_in_time() {
        let mut overlay = Overlay::new(true);
        let now = Instant::now();
        assert!(overlay.until().is_none(), "there is no scene yet");
        overlay.scene_is_seen();
        assert!(!overlay.pass(now) && overlay.until().is_some());
        assert!(overlay.pass(now + HINT_TIME + MESSAGE_TIME));
        overlay.scene_is_seen();
        assert_eq!(overlay.until(), None, "it does not come again");
        overlay.warn("a.ply: no scene".into());
        assert!(overlay.hush() && !overlay.hush());
        overlay.tell("wrote a.png".into());
        assert!(overlay.pass(now + HINT_TIME + MESSAGE_TIME));
        let mut silent = Overlay::new(false);
        silent.tell("wrote a.png".into());
        assert!(silent.until().is_none());
        silent.warn("a.ply: no scene".into());
        assert!(silent.until().is_some());
    }

    #[test]
    fn in_a_window_of_any_size_panels_begin_within_it_and_the_keys_beside_the_numbers() {
        let clips = clips(&["box:0,0,0,1,1,1"]);
        for size in [
            (1, 1),
            (64, 64),
            (320, 240),
            (700, 500),
            (1280, 720),
            (3840, 2160),
        ] {
            let mut overlay = Overlay::new(true);
            overlay.set_keys(Some(true));
            overlay.warn("what is wrong ".repeat(20));
            let content = overlay.content(&OverlayScene {
                progress: Some(("reading a.ply".into(), ProgressBar::Share(0.5))),
                ..seen(&clips, size)
            });
            for panel in laid_out(&content) {
                let Picture { width, height, .. } = panel.picture;
                assert!(width <= size.0 && height <= size.1, "{size:?}");
                let is_nothing = width == 0 || height == 0;
                let end = (panel.at.0 + width, panel.at.1 + height);
                assert!(
                    is_nothing || end.0 <= size.0 && end.1 <= size.1,
                    "{size:?}: {end:?}"
                );
            }
        }
        let mut overlay = Overlay::new(true);
        overlay.set_keys(Some(true));
        let panels = laid_out(&overlay.content(&seen(&clips, (1280, 720))));
        let [keys, numbers] = &panels[..] else {
            panic!("{} panels", panels.len());
        };
        assert!(numbers.at.0 + numbers.picture.width < keys.at.0);
        assert_eq!(keys.at.0 + keys.picture.width, 1280 - 8);
        assert!(keys.at.1 + keys.picture.height < 720);
    }
}
