//! Protocol buffers, as much of them as ONNX's messages need: integers, text, bytes and messages within messages.
//!
//! # Source
//! *Encoding* in the documentation of Protocol Buffers: a field is a key (its number and its wire type, as a base-128
//! integer) and a value. Fields of unknown numbers are skipped, as readers of older messages must.

/// Why bytes are not the message that they should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// The bytes end within a field.
    #[error("the message ends within a field")]
    Truncated,
    /// An integer of more than 64 bits.
    #[error("an integer has more than 64 bits")]
    TooLong,
    /// A wire type that nothing here is written in.
    #[error("a field is of wire type {0}, which is not known")]
    WireType(u64),
    /// A number no field may have.
    #[error("a field has the number {0}")]
    Number(u64),
    /// A field of another kind than its message says.
    #[error("a field holds another kind of value than its message says")]
    Kind,
    /// Text that is not UTF-8.
    #[error("text is not UTF-8")]
    Text,
}

/// Value of a field as it stands in the bytes.
#[derive(Debug, Clone, Copy)]
pub enum Value<'a> {
    /// Wire type 0.
    Integer(u64),
    /// Wire type 2: bytes, text, a message, or packed integers.
    Bytes(&'a [u8]),
    /// Wire types 1 and 5, which no field of these messages has.
    Fixed,
}

/// Wire type of integers.
const INTEGER: u64 = 0;
/// Wire type of eight bytes.
const EIGHT_BYTES: u64 = 1;
/// Wire type of a length and as many bytes.
const BYTES: u64 = 2;
/// Wire type of four bytes.
const FOUR_BYTES: u64 = 5;

/// A message: fields, each with its number.
pub trait Message: Default {
    /// Appends the message's fields in the order of their numbers.
    fn write(&self, out: &mut Vec<u8>);

    /// Takes a field that was read; one of an unknown number is left out.
    ///
    /// # Errors
    /// Where the value is of another kind than the field.
    fn field(&mut self, number: u64, value: Value<'_>) -> Result<(), DecodeError>;

    /// The bytes of the message.
    fn encode_to_vec(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.write(&mut out);
        out
    }

    /// Reads all fields that stand in the bytes into the message; repeated ones are appended.
    ///
    /// # Errors
    /// [`DecodeError`].
    fn merge(&mut self, mut bytes: &[u8]) -> Result<(), DecodeError> {
        while !bytes.is_empty() {
            let key = integer(&mut bytes)?;
            let value = match key & 7 {
                INTEGER => Value::Integer(integer(&mut bytes)?),
                EIGHT_BYTES => take(&mut bytes, 8).map(|_| Value::Fixed)?,
                FOUR_BYTES => take(&mut bytes, 4).map(|_| Value::Fixed)?,
                BYTES => {
                    let length = integer(&mut bytes)?;
                    Value::Bytes(take(&mut bytes, length)?)
                }
                other => return Err(DecodeError::WireType(other)),
            };
            match key >> 3 {
                number @ 1..0x2000_0000 => self.field(number, value)?,
                number => return Err(DecodeError::Number(number)),
            }
        }
        Ok(())
    }

    /// The message of these bytes.
    ///
    /// # Errors
    /// [`DecodeError`].
    fn decode(bytes: &[u8]) -> Result<Self, DecodeError> {
        let mut message = Self::default();
        message.merge(bytes)?;
        Ok(message)
    }
}

/// Takes so many bytes off the front.
fn take<'a>(bytes: &mut &'a [u8], length: u64) -> Result<&'a [u8], DecodeError> {
    let length = usize::try_from(length).map_err(|_| DecodeError::Truncated)?;
    let (taken, rest) = bytes.split_at_checked(length).ok_or(DecodeError::Truncated)?;
    *bytes = rest;
    Ok(taken)
}

/// Takes an integer off the front: seven bits a byte, the lowest first, the eighth set in all bytes but the last.
fn integer(bytes: &mut &[u8]) -> Result<u64, DecodeError> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let byte = u64::from(take(bytes, 1)?[0]);
        let bits = byte & 0x7f;
        if bits << shift >> shift != bits {
            return Err(DecodeError::TooLong);
        }
        value |= bits << shift;
        if byte < 0x80 {
            return Ok(value);
        }
    }
    Err(DecodeError::TooLong)
}

fn write_integer(mut value: u64, out: &mut Vec<u8>) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn write_key(number: u64, wire_type: u64, out: &mut Vec<u8>) {
    write_integer(number << 3 | wire_type, out);
}

fn write_bytes(number: u64, bytes: &[u8], out: &mut Vec<u8>) {
    write_key(number, BYTES, out);
    write_integer(bytes.len() as u64, out);
    out.extend(bytes);
}

/// A type that a field may have.
pub trait Field {
    /// Appends the field; a number that is zero and text or bytes that are empty are left out.
    fn write(&self, number: u64, out: &mut Vec<u8>);

    /// Takes a value that was read.
    ///
    /// # Errors
    /// Where it is of another kind.
    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError>;
}

fn bytes_of(value: Value<'_>) -> Result<&[u8], DecodeError> {
    match value {
        Value::Bytes(bytes) => Ok(bytes),
        _ => Err(DecodeError::Kind),
    }
}

fn text_of(value: Value<'_>) -> Result<String, DecodeError> {
    let text = std::str::from_utf8(bytes_of(value)?).map_err(|_| DecodeError::Text)?;
    Ok(text.to_owned())
}

impl Field for i64 {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        if *self != 0 {
            write_key(number, INTEGER, out);
            write_integer(*self as u64, out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        let Value::Integer(value) = value else {
            return Err(DecodeError::Kind);
        };
        *self = value as i64;
        Ok(())
    }
}

impl Field for i32 {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        i64::from(*self).write(number, out);
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        let mut wide = 0i64;
        wide.read(value)?;
        *self = wide as i32;
        Ok(())
    }
}

/// Written one by one, read packed too.
impl Field for Vec<i64> {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        for &value in self {
            write_key(number, INTEGER, out);
            write_integer(value as u64, out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        match value {
            Value::Integer(value) => self.push(value as i64),
            Value::Bytes(mut packed) => {
                while !packed.is_empty() {
                    self.push(integer(&mut packed)? as i64);
                }
            }
            Value::Fixed => return Err(DecodeError::Kind),
        }
        Ok(())
    }
}

impl Field for String {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        if !self.is_empty() {
            write_bytes(number, self.as_bytes(), out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        *self = text_of(value)?;
        Ok(())
    }
}

impl Field for Vec<String> {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        for text in self {
            write_bytes(number, text.as_bytes(), out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        self.push(text_of(value)?);
        Ok(())
    }
}

impl Field for Vec<u8> {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        if !self.is_empty() {
            write_bytes(number, self, out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        *self = bytes_of(value)?.to_vec();
        Ok(())
    }
}

impl<M: Message> Field for Option<M> {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        if let Some(message) = self {
            write_bytes(number, &message.encode_to_vec(), out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        self.get_or_insert_default().merge(bytes_of(value)?)
    }
}

impl<M: Message> Field for Vec<M> {
    fn write(&self, number: u64, out: &mut Vec<u8>) {
        for message in self {
            write_bytes(number, &message.encode_to_vec(), out);
        }
    }

    fn read(&mut self, value: Value<'_>) -> Result<(), DecodeError> {
        self.push(M::decode(bytes_of(value)?)?);
        Ok(())
    }
}

/// Declares a message: a struct whose fields say their numbers.
macro_rules! message {
    ($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $kind:ty = $number:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Default, PartialEq)]
        pub struct $name { $($(#[$field_doc])* pub $field: $kind,)* }

        impl $crate::export::protobuf::Message for $name {
            fn write(&self, out: &mut Vec<u8>) {
                use $crate::export::protobuf::Field;
                $(self.$field.write($number, out);)*
            }

            fn field(
                &mut self,
                number: u64,
                value: $crate::export::protobuf::Value<'_>,
            ) -> Result<(), $crate::export::protobuf::DecodeError> {
                use $crate::export::protobuf::Field;
                match number {
                    $($number => self.$field.read(value),)*
                    _ => Ok(()),
                }
            }
        }
    };
}
pub(crate) use message;

#[cfg(test)]
mod tests {
    use super::*;

    message! {
        Inner {
            text: String = 1,
            numbers: Vec<i64> = 3,
        }
    }
    message! {
        Outer {
            a: i32 = 1,
            b: String = 2,
            c: Option<Inner> = 3,
            d: Vec<u8> = 4,
            e: Vec<Inner> = 16,
            f: i64 = 17,
        }
    }

    fn outer() -> Outer {
        let inner = |n: i64| Inner {
            text: "tail".repeat(n as usize),
            numbers: vec![n, -n, i64::MIN, 0],
        };
        Outer {
            a: 150,
            b: "testing".to_owned(),
            c: Some(inner(3)),
            d: vec![0, 255],
            e: vec![inner(0), inner(70)],
            f: -1,
        }
    }

    /// The two examples of the documentation: 150 in field 1, "testing" in field 2; a negative number is ten bytes.
    #[test]
    fn bytes_of_the_documentation() {
        let message = Outer {
            a: 150,
            b: "testing".to_owned(),
            ..Outer::default()
        };
        let mut expected = vec![0x08, 0x96, 0x01, 0x12, 0x07];
        expected.extend(b"testing");
        assert_eq!(message.encode_to_vec(), expected);
        let negative = Outer {
            a: -2,
            ..Outer::default()
        };
        let mut expected = vec![0x08, 0xfe];
        expected.extend([0xff; 8]);
        expected.push(0x01);
        assert_eq!(negative.encode_to_vec(), expected);
        assert!(Outer::default().encode_to_vec().is_empty());
    }

    #[test]
    fn messages_come_back() {
        let bytes = outer().encode_to_vec();
        assert_eq!(Outer::decode(&bytes).unwrap(), outer());
        // Unknown fields of all four wire types are skipped: as Inner, whose fields 2 and 4 and more are unknown.
        let mut other = bytes[bytes.len() - 12..].to_vec();
        other.extend([
            0x29, 0, 0, 0, 0, 0, 0, 0, 0, 0x35, 0, 0, 0, 0, 0x3a, 1, 0, 0x0a, 1, b'x',
        ]);
        assert_eq!(Inner::decode(&other).unwrap().text, "x");
        // Packed integers are read as single ones are.
        assert_eq!(
            Inner::decode(&[0x1a, 3, 5, 0x96, 1, 0x18, 7]).unwrap().numbers,
            [5, 150, 7]
        );
    }

    /// No truncation is read as the whole message, and what is wrong is told apart.
    #[test]
    fn wrong_bytes_are_errors() {
        let bytes = outer().encode_to_vec();
        for length in 0..bytes.len() {
            assert_ne!(Outer::decode(&bytes[..length]).ok(), Some(outer()), "{length}");
        }
        let cases: [(&[u8], DecodeError); 8] = [
            (&[0x08], DecodeError::Truncated),
            (&[0x12, 5, b'a'], DecodeError::Truncated),
            (
                &[0x12, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1],
                DecodeError::Truncated,
            ),
            (
                &[0x08, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2],
                DecodeError::TooLong,
            ),
            (&[0x0b], DecodeError::WireType(3)),
            (&[0x00, 0], DecodeError::Number(0)),
            (&[0x0a, 1, b'a'], DecodeError::Kind),
            (&[0x12, 1, 0xff], DecodeError::Text),
        ];
        for (bytes, error) in cases {
            assert_eq!(Outer::decode(bytes), Err(error), "{bytes:?}");
        }
    }
}
