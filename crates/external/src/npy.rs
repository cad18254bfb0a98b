//! Arrays in NumPy's `.npy` files: a header in Python's syntax, then the items.

/// The first bytes of a file of version 1.
const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// The multiple of bytes at which items begin.
const ALIGNMENT: usize = 64;

/// An array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Array<'b> {
    /// The type of items as NumPy writes it, such as `<u2` or `|u1`.
    pub(crate) kind: String,
    /// The lengths of the dimensions, the slowest first.
    pub(crate) shape: Vec<usize>,
    /// The items, the last dimension fastest.
    pub(crate) items: &'b [u8],
}

impl Array<'_> {
    /// Returns the file.
    pub(crate) fn file(&self) -> Vec<u8> {
        let lengths: String = self.shape.iter().map(|n| format!("{n}, ")).collect();
        let mut header = format!(
            "{{'descr': '{}', 'fortran_order': False, 'shape': ({lengths}), }}",
            self.kind
        );
        // The length of the header takes two bytes, and a line end is its last character.
        let before = MAGIC.len() + 2;
        let length = (before + header.len() + 1).next_multiple_of(ALIGNMENT) - before;
        header = format!("{header:<0$}\n", length - 1);
        let mut file = MAGIC.to_vec();
        file.extend((length as u16).to_le_bytes());
        file.extend(header.into_bytes());
        file.extend(self.items);
        file
    }
}

/// Reads a file of version 1, 2 or 3.
///
/// # Errors
/// If the file is no array with rows in order.
pub(crate) fn read(file: &[u8]) -> Result<Array<'_>, String> {
    let damaged = || "it is no .npy file, or a damaged one".to_owned();
    let rest = file.strip_prefix(b"\x93NUMPY").ok_or_else(damaged)?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (u32::from_le_bytes([*a, *b, 0, 0]), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]), rest),
        _ => return Err(damaged()),
    };
    let (header, items) = rest.split_at_checked(length as usize).ok_or_else(damaged)?;
    let header = std::str::from_utf8(header).map_err(|_| damaged())?;
    let value = |key: &str| {
        let (_, value) = header.split_once(&format!("'{key}':"))?;
        Some(value.trim_start())
    };
    let order = value("fortran_order").ok_or_else(damaged)?;
    if !order.starts_with("False") {
        return Err("its columns come first: save numpy.ascontiguousarray(array)".to_owned());
    }
    let kind = value("descr").and_then(|v| v.strip_prefix('\'')?.split('\'').next());
    let shape = value("shape").and_then(|v| v.strip_prefix('(')?.split(')').next());
    let lengths = shape.ok_or_else(damaged)?.split(',').map(str::trim);
    let lengths = lengths.filter(|n| !n.is_empty()).map(str::parse);
    Ok(Array {
        kind: kind.ok_or_else(damaged)?.to_owned(),
        shape: lengths.collect::<Result<_, _>>().map_err(|_| damaged())?,
        items,
    })
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test that panics has failed")]
mod tests {
    use super::*;

    #[test]
    fn an_array_reads_back_equal() {
        for shape in [vec![], vec![3], vec![2, 3, 4], vec![1_000_000; 40]] {
            let items: Vec<u8> = (0..24).collect();
            let kind = "<u2".to_owned();
            let array = Array {
                kind,
                shape,
                items: &items,
            };
            let file = array.file();
            assert_eq!((file.len() - items.len()) % ALIGNMENT, 0);
            assert_eq!(read(&file).unwrap(), array);
        }
    }

    #[test]
    fn a_header_of_numpy_is_read() {
        // What numpy.save writes for numpy.zeros((2, 1), numpy.float16).
        let header = "{'descr': '<f2', 'fortran_order': False, 'shape': (2, 1), }";
        let mut file = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
        file.extend(format!("{header:<117}\n").into_bytes());
        file.extend([0; 4]);
        let array = read(&file).unwrap();
        assert_eq!((&*array.kind, &*array.shape), ("<f2", &[2, 1][..]));
        assert_eq!(array.items, [0; 4]);
    }

    #[test]
    fn no_damage_panics() {
        let kind = "|u1".to_owned();
        let shape = vec![2, 2];
        let file = Array {
            kind,
            shape,
            items: &[1, 2, 3, 4],
        }
        .file();
        for end in 0..file.len() {
            let _ = read(&file[..end]);
            let mut spoilt = file.clone();
            spoilt[end] = b'\'';
            let _ = read(&spoilt);
        }
        assert!(read(b"\x93NUMPY\x02\x00\xff\xff\xff\xff").is_err());
        let columns = String::from_utf8_lossy(&file).replace("False", "True ");
        assert!(read(columns.as_bytes()).is_err());
    }
}
