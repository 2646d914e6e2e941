//! The settings of a frame by their names: what command lines, job files and other languages read and print.

use rara_base::error::{Error, Result, shortened};

/// What a setting is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SettingKind {
    /// It says how Gaussians that the clip cuts are drawn.
    Cut,
    /// It has nothing to do with clipping.
    Look,
    /// It gives up exactness for time.
    Precision,
    /// It is for measuring.
    Measure,
}

/// A field of [`Settings`](crate::Settings) or [`Precision`](crate::Precision) by its name, for command lines, job files and
/// other languages.
///
/// ```
/// # use rara_scene as rara;
/// use rara::Settings;
/// let mut settings = Settings::default();
/// let sigma = Settings::ALL.iter().find(|setting| setting.name == "sigma").unwrap();
/// sigma.read(&mut settings, "2.5")?;
/// assert_eq!(sigma.text(&settings).as_deref(), Some("2.5"));
/// # Ok::<(), rara_base::error::Error>(())
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Setting<S: 'static> {
    /// The name, as on the command line: `sh-degree`.
    pub name: &'static str,
    /// What the setting is for.
    pub kind: SettingKind,
    /// A word that stands for the value in help; empty for one that is on or off.
    pub value: &'static str,
    /// What it does: the documentation of the field.
    pub about: &'static str,
    /// The names of the choices, each with its documentation; none for numbers and colours.
    pub choices: &'static [(&'static str, &'static str)],
    pub(crate) read: fn(&mut S, &str) -> std::result::Result<(), String>,
    pub(crate) text: fn(&S) -> Option<String>,
}

impl<S> Setting<S> {
    /// Sets the field to the value of a text.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a text that is not of such a value, or of one that is not allowed.
    pub fn read(&self, settings: &mut S, text: &str) -> Result<()> {
        (self.read)(settings, text)
            .map_err(|why| Error::Invalid(format!("{} '{}': {why}", self.name, shortened(text))))
    }

    /// Checks the text of a value; the error is a sentence that says what was expected.
    pub fn check(&self, text: &str) -> std::result::Result<(), String>
    where
        S: Default,
    {
        (self.read)(&mut S::default(), text)
    }

    /// Returns the text of the field's value; `None` if the field is `None`.
    pub fn text(&self, settings: &S) -> Option<String> {
        (self.text)(settings)
    }
}

/// Defines a struct of settings by [`setters!`](rara_base::setters) and the table of those that have names. A row is a field,
/// its type, its name, its kind, the word for its value in help, and for numbers what they must be.
macro_rules! settings {
    (
        $(#[$about:meta])*
        pub struct $of:ident {
            $(
                $(#[doc = $doc:literal])+
                pub $field:ident: $type:ty
                    as $name:literal($kind:ident, $value:literal $(, $is:expr, $expected:literal)?),
            )+
            $(; $(#[$rest_doc:meta])+ pub $rest:ident: $rest_type:ty,)?
        }
    ) => {
        rara_base::setters! {
            $(#[$about])*
            pub struct $of {
                $($(#[doc = $doc])+ pub $field: $type,)+
                $($(#[$rest_doc])+ pub $rest: $rest_type,)?
            }
        }

        impl $of {
            /// The fields that have names and texts.
            pub const ALL: &'static [$crate::setting::Setting<Self>] = &[
                $($crate::setting::Setting {
                    name: $name,
                    kind: $crate::setting::SettingKind::$kind,
                    value: $value,
                    about: concat!($($doc, "\n"),+),
                    choices: <$type as rara_base::value::Value>::CHOICES,
                    read: |settings, text| {
                        let value = <$type as rara_base::value::Value>::read(text);
                        $(
                            let is: fn(&$type) -> bool = $is;
                            let value = value.ok().filter(is).ok_or(concat!("expected ", $expected));
                        )?
                        settings.$field = value?;
                        Ok(())
                    },
                    text: |settings| rara_base::value::Value::text(&settings.$field),
                },)+
            ];
        }
    };
}
pub(crate) use settings;
