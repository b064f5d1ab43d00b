//! Three numbers a line.

use std::io::{self, Write};

/// The points, or which line is wrong.
pub(super) fn parse(bytes: &[u8]) -> Result<Vec<[f64; 3]>, String> {
    let text = std::str::from_utf8(bytes)
        .map_err(|_| "it is no text; save it with three numbers a line")?;
    // A byte order mark is what some editors put first.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut points = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let point = parse_line(line).ok_or_else(|| {
            let shown: String = line.chars().take(40).collect();
            format!("line {} is `{shown}`; write x, y and z in mm", number + 1)
        })?;
        points.push(point);
    }
    Ok(points)
}

/// The first three numbers of a line, separated by blanks, commas or semicolons.
fn parse_line(line: &str) -> Option<[f64; 3]> {
    let mut numbers = line
        .split(|c: char| c.is_whitespace() || c == ',' || c == ';')
        .filter(|word| !word.is_empty())
        .map(str::parse);
    let mut next = || numbers.next()?.ok();
    Some([next()?, next()?, next()?])
}

/// Shortest text that reads back as the same numbers.
pub(super) fn write(points: &[[f64; 3]], out: &mut dyn Write) -> io::Result<()> {
    for [x, y, z] in points {
        writeln!(out, "{x} {y} {z}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_separators_and_further_columns_are_fine() {
        let text = b"# x y z\n1 2 3\r\n\n 4,5;6.5\t255 0 0\n-1e-3 +2 .5\n";
        let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.5], [-0.001, 2.0, 0.5]];
        assert_eq!(parse(text).unwrap(), expected);
        assert_eq!(parse(b"\xef\xbb\xbf1 2 3").unwrap(), [[1.0, 2.0, 3.0]]);
        assert!(parse(b"").unwrap().is_empty());
    }

    #[test]
    fn the_wrong_line_is_named() {
        for text in ["1 2 3\n1 2\n", "1 2 3\nx y z\n"] {
            assert!(parse(text.as_bytes()).unwrap_err().contains("line 2"));
        }
        assert!(parse(&[0xff, 0xfe]).unwrap_err().contains("no text"));
    }
}
