//! A scene is a list of layers: Gaussians with a name that are placed, faded and hidden together.

use std::borrow::Cow;

use crate::clip::Clip;
use crate::numbers::{self, Numbers};
use crate::placement::Placement;
use crate::{Gaussians, Training};
use rara_base::error::{Error, Result};
use rara_base::setters;

setters! {
    /// The state of a layer, which may change from frame to frame.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct LayerState {
        /// The layer's placement in its scene.
        pub placement: Placement,
        /// The factor by which the opacities of its Gaussians are multiplied, 0 to 1.
        pub opacity: f32,
        /// True if the layer is drawn. A hidden layer costs a test for each of its blocks of 256 Gaussians.
        pub visible: bool,
    }
}

impl Default for LayerState {
    fn default() -> Self {
        Self {
            placement: Placement::IDENTITY,
            opacity: 1.0,
            visible: true,
        }
    }
}

impl LayerState {
    /// Checks the state as the upload and `Renderer::configure` do, to find a mistake earlier. `name` is the name of the layer,
    /// for the message.
    ///
    /// # Errors
    /// [`Error::Invalid`] for an opacity that is not 0 to 1, and for a placement whose scale single precision has not.
    pub fn check(&self, name: &str) -> Result<()> {
        if !(0.0..=1.0).contains(&self.opacity) {
            return Err(Error::Invalid(format!(
                "the opacity of layer '{name}' is {}; give 0 to 1",
                self.opacity
            )));
        }
        if !(self.placement.scale() as f32).is_normal() {
            return Err(Error::Invalid(format!(
                "layer '{name}' is placed with a scale of {:e}; give one within 1e-37 and 1e38",
                self.placement.scale()
            )));
        }
        Ok(())
    }
}

/// Checks that a frame can use the clip of a layer.
pub fn check_clip(name: &str, clip: Option<&Clip>) -> Result<()> {
    match clip.map(Clip::check) {
        Some(Err(error)) => Err(Error::Invalid(format!(
            "the clip of layer '{name}': {error}"
        ))),
        _ => Ok(()),
    }
}

/// A layer of a scene that is to be uploaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer<'a> {
    name: String,
    gaussians: Cow<'a, Gaussians>,
    state: LayerState,
    clip: Option<Clip>,
    /// The Gaussians that it has room for, if they are more than it has.
    room: u32,
    /// The number of the first Gaussian of the set that the layer is a part of, and its Gaussians' numbers in that.
    pub(super) numbers: Option<(u32, &'a [u32])>,
}

impl<'a> Layer<'a> {
    /// Makes a layer of these Gaussians in the default state.
    pub fn new(name: impl Into<String>, gaussians: &'a Gaussians) -> Self {
        Self::from_cow(name.into(), Cow::Borrowed(gaussians))
    }

    /// Makes a layer that owns its Gaussians. The upload frees parts of them while it copies them, so that they and their copy
    /// on the device are never in memory completely at the same time.
    pub fn owned(name: impl Into<String>, gaussians: Gaussians) -> Self {
        Self::from_cow(name.into(), Cow::Owned(gaussians))
    }

    fn from_cow(name: String, gaussians: Cow<'a, Gaussians>) -> Self {
        Self {
            name,
            gaussians,
            state: LayerState::default(),
            clip: None,
            room: 0,
            numbers: None,
        }
    }

    /// Returns the same layer in another state.
    #[must_use]
    pub fn with(mut self, state: LayerState) -> Self {
        self.state = state;
        self
    }

    /// Returns the same layer with a clip of its own. This clip replaces the clip of the frame for this layer; a clip without
    /// surfaces keeps the whole layer. The clip is in the scene's space: neither the placement of the layer nor
    /// `Renderer::set_placement` moves it.
    #[must_use]
    pub fn clipped(mut self, clip: Clip) -> Self {
        self.clip = Some(clip);
        self
    }

    /// Returns the same layer with room for `count` Gaussians in all, so that `SceneBuffers::replace_layer` can give it as many
    /// later; a layer without Gaussians and with room is one to be added later. Less than the layer has is no room. Room takes as
    /// much memory on the device as Gaussians do, in the scene and in the frames that show it. Layers behind this one
    /// [number on](Scene) from its room, so that no number changes when a layer is filled or emptied. What is put there later has
    /// at most the [degree](Scene::sh_degree) of the scene, which an empty layer of a higher degree raises. A
    /// [part](Self::numbered) of a set has no room for more.
    #[must_use]
    pub fn with_room(mut self, count: u32) -> Self {
        self.room = count;
        self
    }

    /// Returns the number of Gaussians that the layer has room for: those that it has, or more.
    pub fn room(&self) -> u32 {
        self.room.max(self.gaussians.len() as u32)
    }

    /// Returns the same layer as a part of a set of Gaussians, as [`Gaussians::into_parts`] makes them. `numbers` are the
    /// numbers of its Gaussians in the set, and `first` is the number of Gaussians in the scene before the set. Equal depths
    /// are then drawn in the order of the set, whichever of its parts they are in: dividing a set changes no picture. Other
    /// layers number on from the layers before them. The upload refuses a scene in which a number is missing.
    #[must_use]
    pub fn numbered(mut self, first: u32, numbers: &'a [u32]) -> Self {
        self.numbers = Some((first, numbers));
        self
    }

    /// The same layer of other Gaussians, one in place of each, which are shown and drawn in the same order.
    #[doc(hidden)]
    pub fn of<'b>(&self, gaussians: &'b Gaussians) -> Layer<'b>
    where
        'a: 'b,
    {
        Layer {
            name: self.name.clone(),
            gaussians: Cow::Borrowed(gaussians),
            state: self.state,
            clip: self.clip.clone(),
            room: self.room,
            numbers: self.numbers,
        }
    }

    /// That a frame can show it so.
    ///
    /// # Errors
    /// The errors of [`LayerState::check`], and [`Error::Invalid`] for a clip of too many surfaces and for a part of a set that
    /// has room for more.
    #[doc(hidden)]
    pub fn check(&self) -> Result<()> {
        if self.numbers.is_some() && self.room as usize > self.gaussians.len() {
            return Err(Error::Invalid(format!(
                "layer '{}' is a part of other Gaussians, whose numbers leave no room for more: leave out its room or its numbers",
                self.name
            )));
        }
        self.state.check(&self.name)?;
        check_clip(&self.name, self.clip.as_ref())
    }

    /// Returns the layer's own clip, or `None` if it has none and the clip of the frame is used.
    pub fn clip(&self) -> Option<&Clip> {
        self.clip.as_ref()
    }

    /// Returns the name of the layer. Several layers may have the same name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the Gaussians of the layer.
    pub fn gaussians(&self) -> &Gaussians {
        &self.gaussians
    }

    /// Its Gaussians, where nobody else needs the layer.
    #[doc(hidden)]
    pub fn into_gaussians(self) -> Cow<'a, Gaussians> {
        self.gaussians
    }

    /// The placement of its Gaussians' positions: that of its state, with their origin.
    #[doc(hidden)]
    pub fn placement(&self) -> Placement {
        self.state.placement.of_origin(self.gaussians.origin())
    }

    /// Returns the state in which the layer is uploaded.
    pub fn state(&self) -> LayerState {
        self.state
    }
}

/// A scene to upload: layers that are sorted and blended together, even where they overlap. If two Gaussians are equally deep,
/// the one of the earlier layer is in front, unless the layers are [parts](Layer::numbered) of one set.
///
/// The Gaussians of a scene are numbered layer by layer: the first number of a layer is the [room](Layer::room) of all layers
/// before it, which is the number of their Gaussians where no layer has room for more.
///
/// ```
/// # use rara_scene as rara;
/// use rara::{Gaussians, Layer, LayerState, Scene};
///
/// let (skin, vessels) = (Gaussians::default(), Gaussians::default());
/// let faded = LayerState::default().opacity(0.4);
/// let scene = Scene::from_iter([
///     Layer::new("skin", &skin).with(faded),
///     Layer::new("vessels", &vessels),
/// ]);
/// assert_eq!(scene.layers().len(), 2);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene<'a> {
    layers: Vec<Layer<'a>>,
}

impl<'a> Scene<'a> {
    /// Its layers, where nobody else needs the scene.
    #[doc(hidden)]
    pub fn into_layers(self) -> Vec<Layer<'a>> {
        self.layers
    }

    /// Returns the layers of the scene.
    pub fn layers(&self) -> &[Layer<'a>] {
        &self.layers
    }

    /// That there is a layer, and that a frame can show each as it is.
    ///
    /// # Errors
    /// [`Error::Invalid`] where that is not so.
    #[doc(hidden)]
    pub fn check(&self) -> Result<()> {
        if self.layers.is_empty() {
            return Err(Error::Invalid("a scene has at least one layer".into()));
        }
        self.layers.iter().try_for_each(Layer::check)?;
        self.check_light()?;
        numbers::check(&self.layers, self.room())
    }

    /// Its layers that have Gaussians, with how these were trained.
    fn trained(&self) -> impl Iterator<Item = (&Layer<'a>, Training)> {
        let filled = self
            .layers
            .iter()
            .filter(|layer| !layer.gaussians.is_empty());
        filled.map(|layer| (layer, layer.gaussians.training()))
    }

    /// That the colours of all layers are of one kind.
    fn check_light(&self) -> Result<()> {
        let (linear, stored): (Vec<_>, Vec<_>) = self.trained().partition(|(_, own)| own.linear);
        match (linear.first(), stored.first()) {
            (Some((linear, _)), Some((stored, _))) => Err(Error::Invalid(format!(
                "the colours of layer '{}' are linear light and those of '{}' are as displays store them, which cannot be \
                 blended together; draw them one by one",
                linear.name, stored.name
            ))),
            _ => Ok(()),
        }
    }

    /// True where the colours are linear light.
    #[doc(hidden)]
    pub fn is_linear(&self) -> bool {
        self.trained().any(|(_, own)| own.linear)
    }

    /// The most that a splat covers of a pixel.
    #[doc(hidden)]
    pub fn alpha_max(&self) -> f32 {
        self.trained()
            .map(|(_, own)| own.alpha_max)
            .fold(1.0, f32::min)
    }

    /// The numbers of each layer's Gaussians.
    #[doc(hidden)]
    pub fn numbers(&self) -> impl Iterator<Item = Numbers<'a>> {
        let mut before = 0_u32;
        self.layers.iter().map(move |layer| {
            let numbers = match layer.numbers {
                Some((first, in_set)) => Numbers::of_part(first, in_set),
                None => Numbers::of_whole(before),
            };
            before = before.wrapping_add(layer.room()); // more than 32 bits hold are refused
            numbers
        })
    }

    /// Returns the number of Gaussians of all layers.
    pub fn gaussians(&self) -> usize {
        self.layers.iter().map(|layer| layer.gaussians.len()).sum()
    }

    /// How many Gaussians the layers have room for.
    #[doc(hidden)]
    pub fn room(&self) -> u64 {
        self.layers
            .iter()
            .map(|layer| u64::from(layer.room()))
            .sum()
    }

    /// Returns the highest degree of spherical harmonics of any layer.
    pub fn sh_degree(&self) -> u32 {
        let degrees = self.layers.iter().map(|layer| layer.gaussians.sh_degree());
        degrees.max().unwrap_or(0)
    }
}

/// A scene of one layer, which is named `scene`.
impl<'a> From<&'a Gaussians> for Scene<'a> {
    fn from(gaussians: &'a Gaussians) -> Self {
        Self::from_iter([Layer::new("scene", gaussians)])
    }
}

/// The same layers.
impl<'a> From<&Scene<'a>> for Scene<'a> {
    fn from(scene: &Scene<'a>) -> Self {
        scene.clone()
    }
}

impl<'a> FromIterator<Layer<'a>> for Scene<'a> {
    fn from_iter<T: IntoIterator<Item = Layer<'a>>>(layers: T) -> Self {
        Self {
            layers: layers.into_iter().collect(),
        }
    }
}
