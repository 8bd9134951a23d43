//! The window: draws the state of the studio, and turns what a person does into actions.
//!
//! Panels read the state and return [`action::Action`]s; [`app`] carries them out, and nothing else changes the state.

pub mod action;
pub mod analysis_panel;
pub mod app;
pub mod command;
pub mod dialogs;
pub mod export_dialog;
pub mod export_fields;
pub mod fields;
pub mod fonts;
pub mod graph_panel;
pub mod inspector;
pub mod map_panel;
pub mod menu;
pub mod mesh;
pub mod relief;
pub mod relief_panel;
pub mod run;
pub mod start_page;
pub mod text_panel;
pub mod theme;
pub mod variants_panel;
