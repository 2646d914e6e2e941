//! `--slice`, `--outline` and `--rim`: what lies on a section's plane.

use clap::Args;
use rara::{
    Camera, Clip, Cue, Cues, Headless, HeadlessDesc, Layer, Picture, Raster, Scene, Settings, Show,
};
use rara_shots::{Face, OUTLINE_WIDTH, RIM_WIDTH, Slice, cut_by_frame};

use super::combine::FrameSummary;
use super::failure::Failure;
use super::layer_names;
use super::process;
use super::session::{Repeat, Session};
use super::values;
use super::views::NamedView;

/// What is shown of a section's plane.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sections")]
pub(super) struct SliceArgs {
    /// Show the colours on the section's plane, not the scene behind it
    ///
    /// The colour of a pixel is the mean of the splats' colours on the plane, each weighted by the splat's opacity there. The order
    /// of the splats has no effect.
    #[arg(long, conflicts_with = "aov")]
    slice: bool,
    /// Make the cut surface of a slice opaque
    ///
    /// Without this flag, a pixel has the alpha of the splats on the plane. With it, pixels of at least the alpha --cut-level are
    /// opaque, and fainter ones fade away.
    #[arg(long)]
    opaque: bool,
    /// Draw a line around the cut surface of all layers, or of layer NAME (repeatable)
    ///
    /// COLOUR draws one line around the cut surface of all layers together. NAME=COLOUR draws a line around the cut surface of the
    /// layer with this name: --outline skin=red --outline bone=white draws two lines. Without --section, lines go around each face
    /// that planes, slabs and boxes have cut and that the camera sees.
    #[arg(long, value_name = "[NAME=]COLOUR", value_parser = outline)]
    outline: Vec<Outline>,
    /// Width of the line of --outline, pixels
    #[arg(long, value_name = "PX", value_parser = values::positive, default_value_t = OUTLINE_WIDTH)]
    outline_width: f32,
    /// Tint each cut surface along its edge
    #[arg(long, value_name = "COLOUR", value_parser = values::colour)]
    rim: Option<[f32; 3]>,
    /// Width of the tint of --rim, pixels
    #[arg(long, value_name = "PX", value_parser = values::positive, default_value_t = RIM_WIDTH)]
    rim_width: f32,
    /// Alpha from which a pixel of a slice counts as cut surface, 0 to 1
    ///
    /// --outline and --rim use it: they treat a pixel as cut surface if a picture with --slice would have at least this alpha
    /// there.
    #[arg(long, value_name = "ALPHA", value_parser = values::share, default_value_t = Cues::default().level)]
    cut_level: f32,
}

/// A line around the cut surface of a layer, or of all together.
#[derive(Debug, Clone, PartialEq)]
struct Outline {
    layer: Option<String>,
    colour: [f32; 3],
}

fn outline(text: &str) -> Result<Outline, String> {
    let (layer, colour) = match text.rsplit_once('=') {
        Some((layer, colour)) => (Some(layer.to_owned()), colour),
        None => (None, text),
    };
    let colour = values::colour(colour)?;
    Ok(Outline { layer, colour })
}

impl SliceArgs {
    /// True when a slice takes the picture's place.
    pub(super) fn is_shown(&self) -> bool {
        self.slice
    }

    /// Refuses to draw a slice in another way than by tiles, before the scene is read.
    pub(super) fn check(&self, settings: &Settings) -> Result<(), Failure> {
        let raster = settings.raster;
        if !self.slice || matches!(raster, Raster::Auto | Raster::Tiles) {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "--slice needs --raster tiles or auto, and not {raster}: leave out --slice or --raster"
        )))
    }

    /// True when something is made of the scene's Gaussians once the scene is on the device.
    pub(super) fn needs_gaussians(&self) -> bool {
        self.slice || self.has_cues()
    }

    /// True when pictures are changed once they are drawn.
    pub(super) fn changes_pictures(&self) -> bool {
        self.opaque || self.has_cues()
    }

    /// True when the edges of cut surfaces are marked.
    pub(super) fn has_cues(&self) -> bool {
        !self.outline.is_empty() || self.rim.is_some()
    }

    /// The marks around the cut surface of each layer that has some of its own, or of all together; the rim comes first.
    fn cues(&self) -> impl Iterator<Item = (Option<&str>, Cues)> {
        let cue = |width| move |colour| Cue { colour, width };
        let mut bare = Cues::default();
        bare.level = self.cut_level;
        let mut rimmed = bare;
        rimmed.rim = self.rim.map(cue(self.rim_width));
        // One slice serves the rim and a line around all layers.
        let is_joined = (self.outline.first()).is_some_and(|line| line.layer.is_none());
        let rim = rimmed.rim.filter(|_| !is_joined).map(|_| (None, rimmed));
        let lines = self.outline.iter().enumerate().map(move |(at, line)| {
            let mut cues = if is_joined && at == 0 { rimmed } else { bare };
            cues.outline = Some(cue(self.outline_width)(line.colour));
            (line.layer.as_deref(), cues)
        });
        rim.into_iter().chain(lines)
    }
}

/// The faces that a clip cuts and a camera sees.
pub(super) fn faces(clip: &Clip, camera: &Camera) -> Result<Vec<Face>, Failure> {
    rara_shots::faces(clip, camera).ok_or_else(|| {
        Failure::Usage(
            "--outline and --rim can mark the cut faces of planes, slabs and boxes only, and only if the clip keeps what is inside \
             all of them: leave out other shapes and --clip-op or, or give a --section, whose cut surface they mark with any clip"
                .into(),
        )
    })
}

pub(super) struct Slicer<'a> {
    args: &'a SliceArgs,
    scene: Scene<'a>,
    device: HeadlessDesc,
    /// A renderer that is opened for the first cue.
    headless: Option<Headless>,
}

impl<'a> Slicer<'a> {
    /// Makes slices of a scene; `is_section` says that the planes of sections cut it, which cut also layers with clips of their
    /// own.
    pub(super) fn new(
        args: &'a SliceArgs,
        scene: &Scene<'a>,
        is_section: bool,
        device: HeadlessDesc,
    ) -> Self {
        Self {
            args,
            scene: match is_section {
                true => scene.clone(),
                false => cut_by_frame(scene),
            },
            device,
            headless: None,
        }
    }

    /// Checks that there are the layers that flags name.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let names = || self.scene.layers().iter().map(Layer::name);
        let mut named = self
            .args
            .outline
            .iter()
            .filter_map(|line| line.layer.as_deref());
        match named.find(|layer| !names().any(|name| name == *layer)) {
            Some(layer) => Err(layer_names::no_layer("--outline", layer, names())),
            None => Ok(()),
        }
    }

    /// Draws a slice as the session's frame, in place of the session's scene.
    pub(super) fn frame(
        &self,
        session: &mut Session,
        (view, cut, settings): (&NamedView, &Face, &Settings),
        repeat: Repeat,
    ) -> Result<FrameSummary, Failure> {
        let slice = Slice::new(&self.scene, &cut.plane);
        slice.load(&mut session.headless, settings)?;
        let mut shown = settings.show(Show::Mean);
        if self.args.opaque {
            shown = shown.background(None);
        }
        Ok(session.measured_frame(&view.camera, &cut.rest, &shown, repeat)?)
    }

    /// Makes the cut surface opaque in the picture of a slice, if it is to be.
    pub(super) fn finish(&self, picture: &mut Picture, settings: &Settings) {
        if self.args.opaque {
            picture.make_opaque(self.args.cut_level);
            if let Some(background) = settings.background {
                picture.put_before(background);
            }
        }
    }

    /// Draws the cues onto a picture of these faces.
    pub(super) fn draw_cues(
        &mut self,
        picture: &mut Picture,
        (view, faces, settings): (&NamedView, &[Face], &Settings),
    ) -> Result<(), Failure> {
        if !self.args.has_cues() {
            return Ok(());
        }
        for face in faces {
            let slice = Slice::new(&self.scene, &face.plane);
            let headless = match &mut self.headless {
                Some(headless) => headless,
                none => {
                    process::make_drivers_folder();
                    none.insert(Headless::new(&self.device)?)
                }
            };
            slice.load(headless, settings)?;
            for (layer, cues) in self.args.cues() {
                let seen = (&view.camera, &face.rest, settings);
                picture.draw_cues(&slice.picture(headless, seen, layer)?, &cues)?;
            }
        }
        Ok(())
    }

    /// Frees what was opened for cues.
    pub(super) fn close(self) -> Result<(), Failure> {
        self.headless
            .map_or(Ok(()), |headless| Ok(headless.close()?))
    }
}
