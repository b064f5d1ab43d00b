//! `NumPy`'s array file, format versions 1 to 3.
//!
//! Read by hand rather than through an array library because the header of a damaged file may
//! ask for any amount of memory; here nothing is allocated before the file's length agrees.

use std::io::{self, Write};

use super::scalar::Scalar;

const MAGIC: &[u8] = b"\x93NUMPY";

/// Headers are padded so that the numbers begin at a multiple of this.
const ALIGNMENT: usize = 64;

/// The points, or what is wrong with the file.
pub(super) fn parse(bytes: &[u8]) -> Result<Vec<[f64; 3]>, String> {
    let damaged = || "its NumPy header is damaged; save it again with numpy.save".to_owned();
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or("it is no NumPy file; save it with numpy.save")?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        _ => return Err(damaged()),
    };
    let header = rest.get(..length).ok_or_else(damaged)?;
    let header = std::str::from_utf8(header).map_err(|_| damaged())?;
    let (scalar, is_big_endian) = element_type(header).ok_or_else(damaged)??;
    let is_by_column = value_of(header, "fortran_order")
        .ok_or_else(damaged)?
        .starts_with("True");
    let count = rows(header).ok_or_else(damaged)??;
    let numbers = &rest[length..];
    let size = scalar.size();
    if count.checked_mul(3 * size) != Some(numbers.len()) {
        return Err(format!(
            "it should hold {count} x 3 numbers of {size} bytes but has {} bytes of numbers; it was cut off or damaged, save it again",
            numbers.len()
        ));
    }
    let number = |row: usize, column: usize| {
        let at = if is_by_column {
            column * count + row
        } else {
            row * 3 + column
        };
        scalar
            .read(&numbers[at * size..], is_big_endian)
            .expect("the length was checked, else this is a bug")
    };
    Ok((0..count)
        .map(|row| std::array::from_fn(|column| number(row, column)))
        .collect())
}

/// Float64, one row a point.
pub(super) fn write(points: &[[f64; 3]], out: &mut dyn Write) -> io::Result<()> {
    let mut header = format!(
        "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, 3), }}",
        points.len()
    );
    // Magic, version and the header's length take ten bytes, the newline at its end one.
    while (header.len() + 11) % ALIGNMENT != 0 {
        header.push(' ');
    }
    header.push('\n');
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&(header.len() as u16).to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for point in points {
        out.write_all(point.map(f64::to_le_bytes).as_flattened())?;
    }
    Ok(())
}

/// What follows a key of the header's dictionary.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let after = &header[header.find(&format!("'{key}'"))? + key.len() + 2..];
    after.trim_start().strip_prefix(':').map(str::trim_start)
}

/// The number type and whether it is big-endian; outer `None` for a damaged header.
fn element_type(header: &str) -> Option<Result<(Scalar, bool), String>> {
    let value = value_of(header, "descr")?;
    let Some(name) = value.strip_prefix('\'').and_then(|v| v.split('\'').next()) else {
        return Some(Err(
            "it is a structured array; save an array of N rows and 3 columns".to_owned(),
        ));
    };
    let order = name.chars().next()?;
    let scalar = match name.get(order.len_utf8()..)? {
        "i1" => Scalar::I8,
        "u1" => Scalar::U8,
        "i2" => Scalar::I16,
        "u2" => Scalar::U16,
        "i4" => Scalar::I32,
        "u4" => Scalar::U32,
        "i8" => Scalar::I64,
        "u8" => Scalar::U64,
        "f4" => Scalar::F32,
        "f8" => Scalar::F64,
        _ => {
            return Some(Err(format!(
                "its numbers are of type {name}; save it as float64"
            )));
        }
    };
    Some(Ok((scalar, order == '>')))
}

/// The N of a shape `(N, 3)`; outer `None` for a damaged header.
fn rows(header: &str) -> Option<Result<usize, String>> {
    let value = value_of(header, "shape")?;
    let shape = &value[..=value.find(')')?];
    let sides: Option<Vec<usize>> = shape
        .strip_prefix('(')?
        .trim_end_matches(')')
        .split(',')
        .map(str::trim)
        .filter(|side| !side.is_empty())
        .map(|side| side.parse().ok())
        .collect();
    Some(match sides?[..] {
        [rows, 3] => Ok(rows),
        _ => Err(format!(
            "its shape is {shape}; a cloud needs N rows and 3 columns: x, y, z"
        )),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(descr: &str, order: &str, shape: &str, numbers: &[u8]) -> Vec<u8> {
        let header =
            format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let mut bytes = MAGIC.to_vec();
        bytes.extend([1, 0]);
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(numbers);
        bytes
    }

    #[test]
    fn the_header_is_as_numpy_writes_it() {
        let mut bytes = Vec::new();
        write(&[[1.0, 2.0, 3.0]], &mut bytes).unwrap();
        assert_eq!(bytes.len(), 128 + 24);
        assert_eq!(bytes[127], b'\n');
        assert_eq!(u16::from_le_bytes([bytes[8], bytes[9]]), 118);
    }

    #[test]
    fn other_number_types_and_orders_are_read() {
        let floats: Vec<u8> = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0]
            .iter()
            .flat_map(|v| v.to_be_bytes())
            .collect();
        let rows = parse(&file(">f4", "False", "(2, 3)", &floats)).unwrap();
        assert_eq!(rows, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let columns = parse(&file(">f4", "True", "(2, 3)", &floats)).unwrap();
        assert_eq!(columns, [[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
        let bytes = parse(&file("|u1", "False", "(1, 3)", &[7, 8, 255])).unwrap();
        assert_eq!(bytes, [[7.0, 8.0, 255.0]]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (bytes, word) in [
            (b"solid".to_vec(), "no NumPy file"),
            (MAGIC.to_vec(), "damaged"),
            (file("<f8", "False", "(3, 2)", &[0; 48]), "(3, 2)"),
            (file("<f8", "False", "(3,)", &[0; 24]), "3 columns"),
            (file("<c16", "False", "(1, 3)", &[0; 48]), "c16"),
            (file("<f8", "False", "(2, 3)", &[0; 47]), "cut off"),
            (
                file("<f8", "False", "(9999999999999999, 3)", &[0; 8]),
                "cut off",
            ),
            (
                file("<f8", "False", "(18446744073709551615, 3)", &[]),
                "cut off",
            ),
        ] {
            let reason = parse(&bytes).unwrap_err();
            assert!(reason.contains(word), "{reason}");
        }
    }
}
