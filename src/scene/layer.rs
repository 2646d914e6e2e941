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
        /// The factor of its Gaussians' opacities, 0 to 1.
        pub opacity: f32,
        /// True when it is drawn. A hidden layer costs a test for each of its blocks of 256 Gaussians.
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
    /// Checks the state as the upload and `Renderer::configure` do, so that a mistake is
    /// found earlier; `name` is the layer's, for the message.
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

/// That a frame can have the clip of a layer.
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
    /// The number of the first Gaussian of the set that the layer is a part of, and its Gaussians' numbers in that.
    pub(super) numbers: Option<(u32, &'a [u32])>,
}

impl<'a> Layer<'a> {
    /// A layer of these Gaussians in the default state.
    pub fn new(name: impl Into<String>, gaussians: &'a Gaussians) -> Self {
        Self::from_cow(name.into(), Cow::Borrowed(gaussians))
    }

    /// A layer that owns its Gaussians. Who uploads it has no use for them afterwards: the upload frees them where it can,
    /// so that they and their copy on the device are never in memory as a whole together.
    pub fn owned(name: impl Into<String>, gaussians: Gaussians) -> Self {
        Self::from_cow(name.into(), Cow::Owned(gaussians))
    }

    fn from_cow(name: String, gaussians: Cow<'a, Gaussians>) -> Self {
        Self {
            name,
            gaussians,
            state: LayerState::default(),
            clip: None,
            numbers: None,
        }
    }

    /// The same layer in another state.
    #[must_use]
    pub fn with(mut self, state: LayerState) -> Self {
        self.state = state;
        self
    }

    /// The same layer with a clip of its own in place of the frame's, which then has no say in it: a clip without surfaces
    /// keeps the whole layer. It stands in the scene: neither the layer's placement moves it nor
    /// `Renderer::set_placement`.
    #[must_use]
    pub fn clipped(mut self, clip: Clip) -> Self {
        self.clip = Some(clip);
        self
    }

    /// The same layer as a part of a set of Gaussians, as [`Gaussians::into_parts`] makes them: `numbers` are those that its
    /// Gaussians have in the set, and `first` is how many Gaussians the scene has before the set. Equal depths are then
    /// drawn in the order of the set, whichever of its parts they are in: dividing a set changes no picture. Other layers
    /// number on from the layers before them. The upload refuses a scene in which a number is missing.
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
            numbers: self.numbers,
        }
    }

    /// That a frame can show it so.
    ///
    /// # Errors
    /// As of [`LayerState::check`], and [`Error::Invalid`] for a clip of too many surfaces.
    #[doc(hidden)]
    pub fn check(&self) -> Result<()> {
        self.state.check(&self.name)?;
        check_clip(&self.name, self.clip.as_ref())
    }

    /// Its own clip; `None` where the frame's holds.
    pub fn clip(&self) -> Option<&Clip> {
        self.clip.as_ref()
    }

    /// Its name; several layers may have the same.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its Gaussians.
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

    /// The state in which it is uploaded.
    pub fn state(&self) -> LayerState {
        self.state
    }
}

/// A scene that is to be uploaded: layers that are sorted and blended together, wherever they reach into each other. Where
/// two Gaussians are equally deep, the earlier layer's is in front, unless the layers are [parts](Layer::numbered) of one set.
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

    /// Its layers.
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
        numbers::check(&self.layers, self.gaussians())
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
        let mut before = 0;
        self.layers.iter().map(move |layer| {
            let numbers = match layer.numbers {
                Some((first, in_set)) => Numbers::of_part(first, in_set),
                None => Numbers::of_whole(before),
            };
            before += layer.gaussians.len() as u32;
            numbers
        })
    }

    /// Gaussians of all layers.
    pub fn gaussians(&self) -> usize {
        self.layers.iter().map(|layer| layer.gaussians.len()).sum()
    }

    /// The highest degree of spherical harmonics of any layer.
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
