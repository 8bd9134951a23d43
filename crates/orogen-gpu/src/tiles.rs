//! Tiles of a window whose data fit into the buffers of a device, and positions of parts of a window.

use orogen_grid::grid::Window;

/// Divides a window until each part fits; `None` if not even a single sample does.
pub(crate) fn fitting(window: &Window, fits: impl Fn(&Window) -> bool) -> Option<Vec<Window>> {
    let (mut width, mut height) = (window.width, window.height);
    let part = |width, height| Window { width, height, ..*window };
    while !fits(&part(width, height)) {
        match (width, height) {
            (1, 1) => return None,
            _ if width > height => width = width.div_ceil(2),
            _ => height = height.div_ceil(2),
        }
    }
    let mut tiles = Vec::new();
    for top in (0..window.height).step_by(height) {
        for left in (0..window.width).step_by(width) {
            tiles.push(Window {
                x: window.x + left as i64,
                y: window.y + top as i64,
                width: width.min(window.width - left),
                height: height.min(window.height - top),
                cell: window.cell,
            });
        }
    }
    Some(tiles)
}

/// The column and row of a part of a window in that window.
pub(crate) fn offset(window: &Window, part: &Window) -> (usize, usize) {
    ((part.x - window.x) as usize, (part.y - window.y) as usize)
}

/// The index of the first sample of a part of a window in that window.
pub(crate) fn index(window: &Window, part: &Window) -> usize {
    let (left, top) = offset(window, part);
    top * window.width + left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_window_once() {
        let window = Window::new(37, 100, 2.0).at(-5, 7);
        let tiles = fitting(&window, |tile| tile.len() <= 300).unwrap();
        assert!(tiles.iter().all(|tile| tile.len() <= 300 && window.contains(tile)));
        assert_eq!(tiles.iter().map(Window::len).sum::<usize>(), window.len());
        assert_eq!(fitting(&window, |_| true).unwrap(), [window]);
        assert_eq!(fitting(&window, |_| false), None);
    }
}
