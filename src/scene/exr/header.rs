//! Headers: what the parts of a file say of themselves.

use super::bytes::{Bytes, Kind};
use super::{DEEP, MAGIC, MULTI_PART, TILED};
use crate::scene::SceneError;

/// What one part's header says.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub name: Option<String>,
    pub kind: Option<String>,
    pub channels: Option<Vec<(String, Kind)>>,
    pub compression: Option<u8>,
    /// x_min, y_min, x_max, y_max.
    pub data_window: Option<[i32; 4]>,
    pub display_window: Option<[i32; 4]>,
    pub tiles: Option<[u32; 2]>,
    pub levels: u8,
    pub chunk_count: Option<u64>,
    pub near: Option<f32>,
    pub far: Option<f32>,
}

/// The version word and the headers of all parts.
pub(super) struct FileHeader {
    version: u32,
    pub parts: Vec<Header>,
}

impl FileHeader {
    /// Reads from the magic number to the end of the last header.
    pub fn read(bytes: &mut Bytes<'_>) -> Result<Self, SceneError> {
        if bytes.u32("the magic number")? != MAGIC {
            return Err(bytes.wrong("byte 0", "this is no OpenEXR file"));
        }
        let version = bytes.u32("the version")?;
        if version & 0xff != 2 {
            let reason = format!(
                "version {} of the format; 2 is the one that is supported",
                version & 0xff
            );
            return Err(bytes.wrong("byte 4", reason));
        }
        let mut parts = Vec::new();
        while let Some(header) = header(bytes)? {
            parts.push(header);
            if version & MULTI_PART == 0 {
                break;
            }
        }
        Ok(Self { version, parts })
    }

    /// Whether chunks name their part.
    pub fn is_multi_part(&self) -> bool {
        self.version & MULTI_PART != 0
    }

    /// Whether a part holds samples in depth.
    pub fn is_deep(&self, part: usize) -> bool {
        match self.parts[part].kind.as_deref() {
            Some(kind) => kind.starts_with("deep"),
            None => self.version & DEEP != 0,
        }
    }

    /// Whether a deep part is in tiles.
    pub fn is_tiled(&self, part: usize) -> bool {
        match self.parts[part].kind.as_deref() {
            Some(kind) => kind.starts_with("deeptile"),
            None => self.version & TILED != 0,
        }
    }

    /// A part as a message names it.
    pub fn name_of(&self, part: usize) -> String {
        let header = &self.parts[part];
        let name = header.name.as_ref().map_or(String::new(), |n| format!(" '{n}'"));
        let kind = header.kind.as_ref().map_or(String::new(), |k| format!(" ({k})"));
        format!("part {part}{name}{kind}")
    }
}

/// One header; none where it is empty, which ends the list of a multi-part file.
fn header(bytes: &mut Bytes<'_>) -> Result<Option<Header>, SceneError> {
    let mut header = Header::default();
    for count in 0.. {
        let name = bytes.name("an attribute's name")?;
        if name.is_empty() {
            return Ok((count > 0).then_some(header));
        }
        let kind = bytes.name("an attribute's type")?;
        let size = bytes.u32("an attribute's size")?;
        let at = bytes.at;
        let data = bytes.take(size.into(), &format!("attribute '{name}'"))?;
        let mut value = Bytes {
            path: bytes.path,
            data: &bytes.data[..at + data.len()],
            at,
        };
        let what = format!("attribute '{name}'");
        let mut window = || -> Result<Option<[i32; 4]>, SceneError> {
            Ok(Some([
                value.i32(&what)?,
                value.i32(&what)?,
                value.i32(&what)?,
                value.i32(&what)?,
            ]))
        };
        match (name.as_str(), kind.as_str()) {
            ("name", "string") => header.name = Some(String::from_utf8_lossy(data).into_owned()),
            ("type", "string") => header.kind = Some(String::from_utf8_lossy(data).into_owned()),
            ("channels", "chlist") => header.channels = Some(channels(&mut value)?),
            ("compression", "compression") => header.compression = Some(value.take(1, &what)?[0]),
            ("dataWindow", "box2i") => header.data_window = window()?,
            ("displayWindow", "box2i") => header.display_window = window()?,
            ("tiles", "tiledesc") => {
                header.tiles = Some([value.u32(&what)?, value.u32(&what)?]);
                header.levels = value.take(1, &what)?[0] & 15;
            }
            ("chunkCount", "int") => header.chunk_count = Some(value.u32(&what)?.into()),
            ("near", "float") => header.near = Some(f32::from_bits(value.u32(&what)?)),
            ("far", "float") => header.far = Some(f32::from_bits(value.u32(&what)?)),
            ("type" | "channels" | "compression" | "dataWindow" | "displayWindow" | "tiles" | "chunkCount", other) => {
                return Err(bytes.wrong(
                    &format!("attribute '{name}' at byte {at}"),
                    format!("it has the type '{other}', which is not its own"),
                ));
            }
            _ => {}
        }
    }
    Ok(None)
}

fn channels(value: &mut Bytes<'_>) -> Result<Vec<(String, Kind)>, SceneError> {
    let mut out: Vec<(String, Kind)> = Vec::new();
    loop {
        let name = value.name("a channel's name")?;
        if name.is_empty() {
            return Ok(out);
        }
        let place = format!("channel '{name}'");
        let kind = match value.u32(&place)? {
            0 => Kind::Uint,
            1 => Kind::Half,
            2 => Kind::Float,
            other => {
                return Err(value.wrong(
                    &place,
                    format!("number type {other}; 0 (uint), 1 (half) or 2 (float) is expected"),
                ));
            }
        };
        value.take(4, &place)?;
        let sampling = [value.u32(&place)?, value.u32(&place)?];
        if sampling != [1, 1] {
            return Err(value.wrong(
                &place,
                format!("sampling {sampling:?}; deep channels have a value for every pixel, [1, 1]"),
            ));
        }
        if out.iter().any(|(n, _)| *n == name) {
            return Err(value.wrong(&place, "it is there twice"));
        }
        out.push((name, kind));
    }
}
