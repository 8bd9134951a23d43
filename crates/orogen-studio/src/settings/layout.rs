//! The layout of the window.

use serde::{Deserialize, Serialize};

/// What is shown of the land.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum View {
    /// The land in 3D.
    #[default]
    Relief,
    /// The land from above.
    Map,
    /// Both, side by side.
    Both,
    /// One of them in the first window, and the other one in a window of its own.
    Windows,
}

impl View {
    /// All views.
    pub const ALL: [View; 4] = [View::Relief, View::Map, View::Both, View::Windows];

    /// The catalog key of its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            View::Relief => "view.relief",
            View::Map => "view.map",
            View::Both => "view.both",
            View::Windows => "view.windows",
        }
    }

    /// Whether the map is shown.
    #[must_use]
    pub fn has_map(self) -> bool {
        self != View::Relief
    }
}

/// The panel below the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Below {
    /// The graph of nodes.
    #[default]
    Graph,
    /// The text of the recipe.
    Text,
    /// Measurements.
    Analysis,
    /// Measurements compared with real land.
    Real,
    /// Pictures with other seeds and values.
    Variants,
}

/// The layout of the window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Layout {
    /// What is shown of the land.
    pub view: View,
    /// In two windows: whether the land in 3D has the window of its own, and not the map.
    pub is_relief_apart: bool,
    /// The panel below the view.
    pub below: Below,
    /// Whether the panel below the view is shown.
    pub has_below: bool,
    /// Whether the parameters of the selected node are shown.
    pub has_inspector: bool,
    /// The height of the panel below the view, in points; `None` before it was shown.
    pub height: Option<f32>,
    /// The width of the panel with parameters, in points.
    pub width: Option<f32>,
    /// The width of the land in 3D beside the map, in points.
    pub beside: Option<f32>,
}

/// A layout that was kept under a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptLayout {
    /// The name.
    pub name: String,
    /// The layout.
    pub layout: Layout,
}

impl Default for Layout {
    fn default() -> Layout {
        Layout {
            view: View::default(),
            is_relief_apart: false,
            below: Below::default(),
            has_below: true,
            has_inspector: true,
            height: None,
            width: None,
            beside: None,
        }
    }
}

impl Layout {
    /// The layout with sizes that can be shown.
    #[must_use]
    pub fn sound(self) -> Layout {
        let sound = |size: Option<f32>| size.filter(|size| size.is_finite() && *size > 0.0);
        Layout { height: sound(self.height), width: sound(self.width), beside: sound(self.beside), ..self }
    }

    /// Whether only the view is shown.
    #[must_use]
    pub fn is_view_alone(&self) -> bool {
        !self.has_below && !self.has_inspector
    }
}
