//! The commands of the menus, the command palette and the keyboard. Each is declared here once.

use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};

use crate::platform;

/// A command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the list below tells what each is called")]
pub enum Command {
    New,
    Empty,
    Open,
    Save,
    SaveAs,
    SaveVersion,
    Download,
    Export,
    Quit,
    Undo,
    Redo,
    NextSeed,
    AddNode,
    Duplicate,
    Delete,
    Rename,
    Group,
    Ungroup,
    ShowRelief,
    ShowMap,
    ShowBoth,
    ShowWindows,
    ShowGraph,
    ShowText,
    ShowAnalysis,
    ShowVariants,
    ShowReal,
    WholeView,
    PanelBelow,
    Inspector,
    ViewAlone,
    Thumbnails,
    CommandPalette,
    Tour,
    Shortcuts,
    About,
}

/// A menu.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "its name says it")]
pub enum Menu {
    File,
    Edit,
    View,
    Help,
}

impl Menu {
    /// All menus, in their order.
    pub const ALL: [Menu; 4] = [Menu::File, Menu::Edit, Menu::View, Menu::Help];

    /// The catalog key of its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Menu::File => "menu.file",
            Menu::Edit => "menu.edit",
            Menu::View => "menu.view",
            Menu::Help => "menu.help",
        }
    }
}

/// The declaration of a command.
#[derive(Debug)]
pub struct Entry {
    /// The command.
    pub command: Command,
    /// The catalog key of its name.
    pub name: &'static str,
    /// The menu.
    pub menu: Menu,
    /// The keyboard shortcut, as it is shown.
    pub keys: Option<KeyboardShortcut>,
    /// Another keyboard shortcut, which users of other programs know.
    pub also: Option<KeyboardShortcut>,
    /// Whether it needs a document.
    pub needs_document: bool,
}

const fn entry(command: Command, name: &'static str, menu: Menu, needs_document: bool) -> Entry {
    Entry { command, name, menu, keys: None, also: None, needs_document }
}

const fn with_keys(
    command: Command,
    name: &'static str,
    menu: Menu,
    needs_document: bool,
    modifiers: Modifiers,
    key: Key,
) -> Entry {
    Entry { command, name, menu, keys: Some(KeyboardShortcut::new(modifiers, key)), also: None, needs_document }
}

impl Entry {
    const fn also(self, modifiers: Modifiers, key: Key) -> Entry {
        Entry { also: Some(KeyboardShortcut::new(modifiers, key)), ..self }
    }

    /// The keyboard shortcuts.
    pub fn shortcuts(&self) -> impl Iterator<Item = KeyboardShortcut> {
        [self.keys, self.also].into_iter().flatten()
    }
}

const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// The commands of all platforms, in the order of their menus.
pub static ALL: [Entry; 36] = [
    with_keys(Command::New, "command.new", Menu::File, false, CTRL, Key::N),
    with_keys(Command::Empty, "command.empty", Menu::File, false, CTRL_SHIFT, Key::N),
    with_keys(Command::Open, "command.open", Menu::File, false, CTRL, Key::O),
    with_keys(Command::Save, "command.save", Menu::File, true, CTRL, Key::S),
    with_keys(Command::SaveAs, "command.save_as", Menu::File, true, CTRL_SHIFT, Key::S),
    with_keys(Command::SaveVersion, "command.save_version", Menu::File, true, CTRL.plus(Modifiers::ALT), Key::S),
    entry(Command::Download, "command.download", Menu::File, true),
    with_keys(Command::Export, "command.export", Menu::File, true, CTRL, Key::E),
    with_keys(Command::Quit, "command.quit", Menu::File, false, CTRL, Key::Q),
    with_keys(Command::Undo, "command.undo", Menu::Edit, true, CTRL, Key::Z),
    with_keys(Command::Redo, "command.redo", Menu::Edit, true, CTRL_SHIFT, Key::Z).also(CTRL, Key::Y),
    with_keys(Command::NextSeed, "command.next_seed", Menu::Edit, true, CTRL, Key::R),
    with_keys(Command::AddNode, "command.add_node", Menu::Edit, true, CTRL, Key::Space),
    with_keys(Command::Duplicate, "command.duplicate", Menu::Edit, true, CTRL, Key::D),
    with_keys(Command::Rename, "command.rename", Menu::Edit, true, Modifiers::NONE, Key::F2),
    entry(Command::Delete, "command.delete", Menu::Edit, true),
    with_keys(Command::Group, "command.group", Menu::Edit, true, CTRL, Key::G),
    with_keys(Command::Ungroup, "command.ungroup", Menu::Edit, true, CTRL_SHIFT, Key::G),
    with_keys(Command::ShowRelief, "command.show_relief", Menu::View, true, CTRL, Key::Num1),
    with_keys(Command::ShowMap, "command.show_map", Menu::View, true, CTRL, Key::Num2),
    with_keys(Command::ShowBoth, "command.show_both", Menu::View, true, CTRL, Key::Num8),
    with_keys(Command::ShowWindows, "command.show_windows", Menu::View, true, CTRL, Key::Num9),
    with_keys(Command::ShowGraph, "command.show_graph", Menu::View, true, CTRL, Key::Num3),
    with_keys(Command::ShowText, "command.show_text", Menu::View, true, CTRL, Key::Num4),
    with_keys(Command::ShowAnalysis, "command.show_analysis", Menu::View, true, CTRL, Key::Num5),
    with_keys(Command::ShowVariants, "command.show_variants", Menu::View, true, CTRL, Key::Num6),
    with_keys(Command::ShowReal, "command.show_real", Menu::View, true, CTRL, Key::Num7),
    with_keys(Command::WholeView, "command.whole_view", Menu::View, true, Modifiers::NONE, Key::Home),
    with_keys(Command::PanelBelow, "command.panel_below", Menu::View, true, Modifiers::NONE, Key::F6),
    with_keys(Command::Inspector, "command.inspector", Menu::View, true, Modifiers::NONE, Key::F7),
    with_keys(Command::ViewAlone, "command.view_alone", Menu::View, true, Modifiers::NONE, Key::F11),
    entry(Command::Thumbnails, "command.thumbnails", Menu::View, true),
    with_keys(Command::CommandPalette, "command.command_palette", Menu::Help, false, CTRL_SHIFT, Key::P),
    with_keys(Command::Shortcuts, "command.shortcuts", Menu::Help, false, Modifiers::NONE, Key::F1),
    entry(Command::Tour, "command.tour", Menu::Help, false),
    entry(Command::About, "command.about", Menu::Help, false),
];

/// The commands of this platform, in the order of their menus.
pub fn all() -> impl Iterator<Item = &'static Entry> + Clone {
    ALL.iter().filter(|entry| match entry.command {
        Command::Download => platform::IS_PAGE,
        Command::Quit | Command::ShowWindows => !platform::IS_PAGE,
        _ => true,
    })
}

impl Command {
    /// The declaration of the command.
    #[must_use]
    pub fn entry(self) -> Option<&'static Entry> {
        ALL.iter().find(|entry| entry.command == self)
    }
}

/// The commands whose keyboard shortcuts were pressed.
#[must_use]
pub fn pressed(context: &Context) -> Vec<Command> {
    // Text fields need keys such as Home.
    let is_typing = context.egui_wants_keyboard_input();
    let is_free = |keys: &KeyboardShortcut| !(is_typing && keys.modifiers.is_none() && keys.logical_key == Key::Home);
    let entries = all().flat_map(|entry| entry.shortcuts().map(move |keys| (entry.command, keys)));
    let mut entries: Vec<(Command, KeyboardShortcut)> = entries.filter(|(_, keys)| is_free(keys)).collect();
    // Longer combinations first, so that Ctrl+Shift+Z does not trigger Ctrl+Z.
    entries.sort_by_key(|(_, keys)| !(keys.modifiers.shift || keys.modifiers.alt));
    let is_pressed = |keys: &KeyboardShortcut| context.input_mut(|input| input.consume_shortcut(keys));
    entries.into_iter().filter(|(_, keys)| is_pressed(keys)).map(|(command, _)| command).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_commands_are_there_once() {
        for (n, entry) in ALL.iter().enumerate() {
            for other in &ALL[..n] {
                assert_ne!(entry.command, other.command);
                let is_shared = entry.shortcuts().any(|keys| other.shortcuts().any(|theirs| theirs == keys));
                assert!(!is_shared, "{} and {}", entry.name, other.name);
            }
        }
    }
}
