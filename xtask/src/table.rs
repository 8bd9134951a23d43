//! Plain text tables.

/// Columns padded to their widest cell; columns of numbers (or dashes) are right-aligned.
pub fn render(head: &[&str], rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).chain([head.len()]).max().unwrap_or(0);
    let cells = |column: usize| rows.iter().filter_map(move |row| row.get(column).map(String::as_str));
    let layout: Vec<(usize, bool)> = (0..columns)
        .map(|c| {
            let title = head.get(c).copied().unwrap_or("");
            let width = cells(c).chain([title]).map(|t| t.chars().count()).max().unwrap_or(0);
            let right = cells(c).any(is_number) && cells(c).all(|t| is_number(t) || t.is_empty() || t == "-");
            (width, right)
        })
        .collect();
    let line = |texts: &[&str]| {
        let mut out = String::new();
        for (&text, &(width, right)) in texts.iter().zip(&layout) {
            if !out.is_empty() {
                out.push_str("  ");
            }
            let pad = " ".repeat(width - text.chars().count());
            out.push_str(&if right { pad + text } else { text.to_owned() + &pad });
        }
        out.truncate(out.trim_end().len());
        out
    };
    let mut lines = Vec::new();
    if !head.is_empty() {
        lines.push(line(head));
        let rules: Vec<String> = layout.iter().map(|&(width, _)| "-".repeat(width)).collect();
        lines.push(line(&rules.iter().map(String::as_str).collect::<Vec<_>>()));
    }
    lines.extend(rows.iter().map(|row| line(&row.iter().map(String::as_str).collect::<Vec<_>>())));
    lines.join("\n")
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::render;

    fn rows(rows: &[&[&str]]) -> Vec<Vec<String>> {
        rows.iter().map(|r| r.iter().map(|&c| c.to_owned()).collect()).collect()
    }

    #[test]
    fn words_stand_left_and_numbers_right() {
        let text = render(&["case", "Mpt/s"], &rows(&[&["fbm 6", "1383.0"], &["white", "-"], &["x", "9.5"]]));
        assert_eq!(text, "case    Mpt/s\n-----  ------\nfbm 6  1383.0\nwhite       -\nx         9.5");
    }

    #[test]
    fn no_head_no_rule_and_no_trailing_blanks() {
        assert_eq!(render(&[], &rows(&[&["a", "long words"], &["bcd", "e"]])), "a    long words\nbcd  e");
        assert_eq!(render(&[], &[]), "");
    }
}
