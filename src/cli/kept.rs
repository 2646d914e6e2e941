//! A scene on its device, kept from one command to the next that draws the same one.

use std::fmt::Debug;

use rara::{HeadlessDesc, Result, Scene, ShFormat};

use super::failure::Failure;
use super::profile::Profile;
use super::reading::Reading;
use super::scenes::SceneArgs;
use super::session::{FirstFrame, Session, SessionAhead};
use rara::scene::layers::{LayerClip, SceneLayers};

/// What the last command has left; nothing where a command runs by itself.
#[derive(Default)]
pub(super) struct SessionCache {
    is_wanted: bool,
    last: Option<(ScenePlace, SceneLayers)>,
}

/// The scene and the device that a session is kept for.
pub(super) struct ScenePlace {
    /// The flags of the scene and of its device.
    flags: String,
    /// The clips of its layers before a command changes them.
    clips: Vec<Option<LayerClip>>,
    session: Option<Session>,
    ahead: Option<SessionAhead>,
}

impl SessionCache {
    /// A cache that several commands share.
    pub(super) fn wanted() -> Self {
        Self {
            is_wanted: true,
            last: None,
        }
    }

    /// The scene that these flags name, as the last command has left it or from its files. `device` stands for everything
    /// that the session depends on. While files are read, a session for the first frame is opened, if that is known.
    pub(super) fn load(
        &mut self,
        profile: &Profile,
        scenes: &SceneArgs,
        device: &impl Debug,
        first: Option<FirstFrame>,
    ) -> std::result::Result<(ScenePlace, SceneLayers), Failure> {
        let flags = format!("{scenes:?} {device:?}");
        if let Some((place, mut loaded)) = self.last.take() {
            if place.flags == flags {
                for (layer, clip) in loaded.layers.iter_mut().zip(&place.clips) {
                    layer.clip.clone_from(clip);
                }
                return Ok((place, loaded));
            }
            place.close()?; // before the next scene needs the memory
        }
        let (mut first, mut ahead) = (first, None);
        let mut begin = |reading: Reading<'_>| {
            // Of a file that is not there nobody waits for a driver.
            let is_there = reading.bytes.1 > 0;
            if let Some(first) = first.take_if(|_| is_there) {
                ahead = Some(SessionAhead::begin(first));
            }
        };
        let loaded = profile.span("load", || scenes.load_watched(&mut begin))?;
        let place = ScenePlace {
            flags,
            clips: loaded
                .layers
                .iter()
                .map(|layer| layer.clip.clone())
                .collect(),
            session: None,
            ahead,
        };
        Ok((place, loaded))
    }

    /// Keeps the scene for the next command, or closes its session.
    pub(super) fn keep(
        &mut self,
        place: ScenePlace,
        loaded: SceneLayers,
        session: Session,
    ) -> Result<()> {
        let place = ScenePlace {
            session: Some(session),
            ..place
        };
        if !self.is_wanted {
            return place.close();
        }
        self.last = Some((place, loaded));
        Ok(())
    }

    pub(super) fn close(&mut self) -> Result<()> {
        self.last.take().map_or(Ok(()), |(place, _)| place.close())
    }
}

impl ScenePlace {
    pub(super) fn open(
        &mut self,
        profile: &Profile,
        device: HeadlessDesc,
        scene: Scene<'_>,
        sh: ShFormat,
    ) -> std::result::Result<Session, Failure> {
        if let Some(mut session) = self.session.take() {
            session.set_layer_clips(&scene)?;
            return Ok(session);
        }
        match self.ahead.take().and_then(SessionAhead::end) {
            Some(mut session) => {
                session.headless.load_as(scene, sh)?;
                Ok(profile.opened(session))
            }
            None => profile.open(device, scene, sh),
        }
    }

    fn close(self) -> Result<()> {
        self.session
            .map_or(Ok(()), |session| session.headless.close())
    }
}
