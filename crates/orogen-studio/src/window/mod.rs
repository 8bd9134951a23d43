//! The window: draws the state of the studio, and converts user input to actions.
//!
//! Panels read the state and return [`action::Action`]s; [`app`] carries them out, and nothing else changes the state.

pub mod action;
pub mod analysis_panel;
pub mod app;
pub mod command;
pub mod contour_lines;
pub mod device;
pub mod dialogs;
pub mod export_dialog;
pub mod export_fields;
pub mod export_list;
pub mod expression_field;
pub mod fields;
pub mod fonts;
pub mod graph_box;
mod graph_frames;
mod graph_menu;
pub mod graph_panel;
mod graph_places;
mod graph_reroutes;
mod graph_route;
pub mod graph_search;
mod graph_wires;
pub mod ground;
pub mod inspector;
pub mod label;
pub mod layouts_menu;
pub mod legend;
pub mod light;
pub mod map_panel;
pub mod menu;
pub mod mesh;
pub mod op_groups;
pub mod open_dialogs;
#[cfg(target_arch = "wasm32")]
pub mod page;
pub mod panels;
pub mod purpose;
pub mod ramp_editor;
pub mod realism_panel;
pub mod recovery_dialog;
pub mod relief;
pub mod relief_drawing;
pub mod relief_panel;
mod relief_part;
mod relief_pipelines;
#[cfg(not(target_arch = "wasm32"))]
pub mod restart;
#[cfg(not(target_arch = "wasm32"))]
pub mod run;
pub mod start_page;
pub mod status;
pub mod swatches;
pub mod system_dialog;
pub mod text_panel;
pub mod theme;
pub mod tool_row;
pub mod tools;
pub mod tour;
pub mod variants_panel;
mod wire_curve;
