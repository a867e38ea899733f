//! The window of Nabiki: one touch, and all frames move.
//!
//! State and logic are plain values without a window or a graphics card; panels show them and answer with commands.

pub mod actions;
pub mod app;
pub mod command;
pub mod desktop;
pub mod dialog;
pub mod document;
pub mod finding;
pub mod gestures;
pub mod icon;
pub mod layout;
pub mod motion;
mod panels;
pub mod play;
pub mod preferences;
pub mod recovery;
pub mod session;
pub mod settings;
pub mod take;
pub mod tasks;
pub mod timeline;
pub mod tools;
pub mod view;
