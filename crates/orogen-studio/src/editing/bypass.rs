//! Bypassed nodes: with a mask of 0 a node passes its first input on.

use orogen::declare::Input;
use orogen::recipe::document::NamedNode;

use super::edit::Edit;

/// Whether a node is bypassed.
#[must_use]
pub fn is_bypassed(named: &NamedNode) -> bool {
    named.mask == Input::Value(0.0)
}

/// The edit that bypasses a node, or ends that; `None` for a node that has no input to pass on, or whose
/// mask would be lost.
#[must_use]
pub fn toggled(named: &NamedNode) -> Option<Edit> {
    let has_input = !named.node.inputs().is_empty() && *named.node.input(0) != Input::None;
    let source = match &named.mask {
        Input::Value(0.0) => Input::None,
        Input::None if has_input => Input::Value(0.0),
        _ => return None,
    };
    Some(Edit::Connect { node: named.name.clone(), input: "mask".into(), source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;

    const TEXT: &str = "orogen = 1\n[nodes.hills]\nop = \"fbm\"\n[nodes.soft]\nop = \"blur\"\nsource = \"hills\"\n\
        [nodes.part]\nop = \"blur\"\nsource = \"soft\"\nmask = \"hills\"\n[outputs]\nheight = \"part\"\n";

    #[test]
    fn a_node_is_bypassed_and_used_again() {
        let mut document = Document::new("test", TEXT.to_owned()).unwrap();
        let named = |document: &Document, name: &str| {
            document.recipe().nodes().iter().find(|named| named.name == name).unwrap().clone()
        };
        assert_eq!(toggled(&named(&document, "hills")), None, "it has no input");
        assert_eq!(toggled(&named(&document, "part")), None, "it has a mask");
        document.apply(&toggled(&named(&document, "soft")).unwrap()).unwrap();
        assert!(is_bypassed(&named(&document, "soft")) && document.text().contains("mask = 0.0"));
        document.apply(&toggled(&named(&document, "soft")).unwrap()).unwrap();
        assert_eq!(document.text(), TEXT);
    }
}
