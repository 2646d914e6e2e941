//! How a viewer opens files: those it begins with, and those that are dropped on its window.

use std::time::Instant;

use rara::clip::{NamedClip, are_alternatives};

use super::action::{Step, Which};
use super::dropped::DroppedFile;
use super::failure::Failure;
use super::loading::{Load, Loading, TICK};
use super::scenery::SceneView;
use super::stage::{AppEvent, Viewer};
use rara::scene::layers::{LayerClip, Tint};

impl Viewer {
    pub(super) fn load(&mut self, load: Load) -> Result<(), Failure> {
        let proxy = self.proxy.clone();
        // Where the event loop has ended nobody waits for the scene.
        let done = move |outcome| drop(proxy.send_event(AppEvent::Read(Box::new(outcome))));
        self.loading = Some(Loading::begin(load, done)?);
        self.dirty = true;
        Ok(())
    }

    /// True while what is shown is not yet what was asked for.
    pub(super) fn waits_for_files(&self) -> bool {
        self.loading.is_some() || !self.dropped.is_empty()
    }

    /// Opens what was dropped, unless a scene is being read. Scenes that are dropped at once are one scene. What cannot be
    /// opened is said, and what is shown stays.
    pub(super) fn open_dropped(&mut self) -> Result<(), Failure> {
        if self.loading.is_some() {
            return Ok(());
        }
        let mut scenes = Vec::new();
        let files = std::mem::take(&mut self.dropped);
        if !files.is_empty() {
            self.dirty |= self.overlay.hush();
        }
        for file in files {
            match DroppedFile::open(&file) {
                Ok(DroppedFile::Scene) => scenes.push(file),
                Ok(other) => self.beside.push(other),
                Err(failure) => self.warn(failure),
            }
        }
        if scenes.is_empty() {
            self.take_up_what_is_beside();
            return Ok(());
        }
        let size = self.picture_size();
        let load = self.host.read(scenes, self.manner.up, size);
        self.load(load)
    }

    /// Shows a scene that has been read. Only the first one has to be readable.
    pub(super) fn arrive(&mut self, outcome: Result<SceneView, Failure>) -> Result<(), Failure> {
        let is_first = !self.began;
        let shown = outcome.and_then(|fresh| self.show(fresh));
        self.loading = None;
        self.dirty = true;
        match shown {
            Ok(()) => self.began = true,
            Err(failure) if is_first || !failure.is_of_the_scene() => return Err(failure),
            Err(failure) => {
                self.beside.clear();
                self.warn(failure);
            }
        }
        self.take_up_what_is_beside();
        Ok(())
    }

    fn show(&mut self, fresh: SceneView) -> Result<(), Failure> {
        if let Some(loading) = &mut self.loading {
            loading.uploading(&fresh.scenery.scene);
            // The window does nothing else meanwhile, so that it says so before.
            if self.visible() {
                self.draw()?;
            }
        }
        let uploaded = fresh
            .scenery
            .upload(&mut self.windowed, &self.manner.settings);
        self.after_upload(uploaded)?;
        self.scenery = fresh.scenery;
        self.view = 0;
        self.viewpoint = self.scenery.viewpoint(0);
        Ok(())
    }

    /// Mixes a colour into layers, or none.
    pub(super) fn tint(&mut self, which: &Which, tint: Step<Option<Tint>>) -> Result<(), Failure> {
        let (places, tint, text) = self.scenery.clips.tint(which, tint)?;
        self.scenery.tint(&places, tint);
        let uploaded = self
            .scenery
            .upload(&mut self.windowed, &self.manner.settings);
        self.after_upload(uploaded)?;
        self.overlay.tell(text);
        Ok(())
    }

    /// Notes which scene there is after an upload: where it does not fit there is none, and one that is refused leaves the one
    /// before.
    fn after_upload(&mut self, uploaded: rara::Result<()>) -> Result<(), Failure> {
        self.loaded = !self.windowed.layers().is_empty();
        self.last = None;
        self.faces.forget(&mut self.windowed);
        Ok(uploaded?)
    }

    /// Takes the next of the clips of a file, of which one is meant.
    pub(super) fn next_clip(&mut self) {
        let (clips, at) = &mut self.alternatives;
        *at = (*at + 1) % clips.len().max(1);
        self.show_alternative();
    }

    fn show_alternative(&mut self) {
        let (clips, at) = &self.alternatives;
        let Some(named) = clips.get(*at) else {
            self.overlay
                .tell("no file of several clips was dropped".into());
            return;
        };
        let text = format!(
            "clip {} of {}: {}; V takes the next",
            at + 1,
            clips.len(),
            named.name
        );
        self.scenery.clips.replace(vec![named.clip.clone()]);
        self.overlay.tell(text);
    }

    /// Gives layers the clips of a file that are theirs, and takes the others in place of the clip that is edited.
    fn take_up(&mut self, clips: Vec<NamedClip>) {
        let mut of_all = Vec::new();
        for named in clips {
            let Some(layer) = &named.layer else {
                of_all.push(named);
                continue;
            };
            if !self
                .scenery
                .clips
                .replace_of(layer, &LayerClip::from_expression(named.clip))
            {
                let text = format!("the file has a clip for '{layer}', and no layer is called so");
                self.overlay.warn(text);
            }
        }
        if are_alternatives(&of_all) {
            self.alternatives = (of_all, 0);
            self.show_alternative();
        } else if !of_all.is_empty() {
            self.alternatives = (Vec::new(), 0);
            let clips = of_all.into_iter().map(|named| named.clip);
            self.scenery.clips.replace(clips.collect());
        }
    }

    /// Clips and cameras that were dropped, once the scene that they are for is there.
    fn take_up_what_is_beside(&mut self) {
        for dropped in std::mem::take(&mut self.beside) {
            if !self.loaded {
                continue;
            }
            match dropped {
                DroppedFile::Scene => {}
                DroppedFile::Clip(clips) => self.take_up(clips),
                DroppedFile::Cameras(cameras, error) => {
                    let count = cameras.len();
                    // What is up is what is up in the camera's own picture.
                    let up = |camera: rara::Camera| (camera, -camera.rotation.row(1));
                    self.scenery.views = cameras.into_iter().map(up).collect();
                    self.view = 0;
                    self.viewpoint = self.scenery.viewpoint(0);
                    if count > 1 {
                        self.overlay
                            .tell(format!("camera 1 of {count}; N takes the next"));
                    }
                    if let Some(error) = error {
                        self.warn(error.into());
                    }
                }
            }
            self.dirty = true;
        }
    }

    /// Says why something failed, by the program and over the picture.
    pub(super) fn warn(&mut self, failure: Failure) {
        let text = self.host.warn(failure);
        self.warnings += 1;
        self.overlay.warn(text);
        self.dirty = true;
    }

    /// Notices what has changed without anybody's doing, and says when something will.
    pub(super) fn changes_by_itself(&mut self, now: Instant) -> Option<Instant> {
        self.dirty |= self.overlay.pass(now) || self.loading.is_some() && self.is_behind();
        let tick = self.loading.as_ref().map(|_| now + TICK);
        self.overlay.until().into_iter().chain(tick).min()
    }
}
