//! glTF documents and their buffers, for the readers of meshes and of motion. The crate gltf parses and validates; lengths,
//! and buffers in files of their own, are seen to here.

pub(crate) mod accessors;
pub(crate) mod pose;

use std::collections::HashMap;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gltf::buffer::Source;
use nabiki_exchange::Budget;

use crate::bytes::Bytes;
use crate::error::{Error, Result};
use crate::input::{self, MOST_BINARY_BYTES};

/// What an object of JSON takes in memory once it is read, and what one of its values or of an array's; half of that, as
/// budgets count.
const OBJECT_BYTES: u64 = 150;
const VALUE_BYTES: u64 = 16;

/// The document, valid, and the binary chunk of a .glb.
pub(crate) fn open(bytes: &[u8]) -> Result<(gltf::Document, Option<&[u8]>)> {
    let unreadable = |e: gltf::Error| Error::new(format!("is not a readable glTF: {e}"));
    let (text, blob) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
    let text = text.strip_prefix(input::BYTE_ORDER_MARK).unwrap_or(text);
    if text.trim_ascii_start().first() != Some(&b'{') {
        return Err(Error::new("is not a glTF: it does not start with glTF or {"));
    }
    // The crate makes all of it at once, a node of two bytes as large as any.
    let count = |wanted: u8| text.iter().filter(|&&byte| byte == wanted).count() as u64;
    let takes = count(b'{') * OBJECT_BYTES + count(b',') * VALUE_BYTES;
    Budget::of(bytes.len() as u64).take(takes, "nodes and other objects")?;
    let gltf = gltf::Gltf::from_slice_without_validation(text).map_err(unreadable)?;
    let mut json = gltf.document.into_json();
    json.extensions_required.retain(|extension| !is_met(extension));
    if !json.extensions_required.is_empty() {
        return Err(not_met(&json.extensions_required));
    }
    // The crate's validation looks at these accessors before it has checked that they exist.
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if let Some(missing) = primitives.flat_map(|p| p.attributes.values()).find(|a| a.value() >= json.accessors.len()) {
        let (missing, count) = (missing.value(), json.accessors.len());
        return Err(Error::new(format!("is not a readable glTF: names accessor {missing}, but has {count}")));
    }
    Ok((gltf::Document::from_json(json).map_err(unreadable)?, blob))
}

/// Whether shapes and motion are read as they are, though the file requires the extension: other component types are read by their
/// type ([`accessors`]), and looks, lights and notes are no part of a shape.
fn is_met(extension: &str) -> bool {
    const OF_LOOKS: [&str; 8] = [
        "KHR_materials_",
        "KHR_texture_",
        "EXT_texture_",
        "MSFT_texture_",
        "KHR_lights_",
        "EXT_lights_",
        "KHR_xmp",
        "KHR_node_visibility",
    ];
    extension == "KHR_mesh_quantization" || OF_LOOKS.iter().any(|beginning| extension.starts_with(beginning))
}

/// A refusal of what a file requires and is not read, with the way out.
fn not_met(extensions: &[String]) -> Error {
    let way_out = |extension: &String| match extension.as_str() {
        "KHR_draco_mesh_compression" => "export it without compression (in Blender, Data > Compression off)",
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "pack it without compression (gltfpack without -c and -cc)"
        }
        _ => "export it without that",
    };
    let mut ways: Vec<&str> = extensions.iter().map(way_out).collect();
    ways.dedup();
    let (names, ways) = (extensions.join(" and "), ways.join(", and "));
    Error::new(format!("requires the glTF extension {names}, which is not read: {ways}"))
}

/// The JSON and the binary chunk of a .glb. (The crate's own reader of them trusts their lengths.)
fn chunks(glb: &[u8]) -> Result<(&[u8], Option<&[u8]>)> {
    let mut source = Bytes::from_slice(glb);
    let [_, version, length]: [u32; 3] = source.value("header")?;
    if version != 2 {
        return Err(Error::new(format!("glTF version is {version}: only version 2 is read")));
    }
    if u64::from(length) != source.len() {
        return Err(Error::new(format!("{length} bytes expected, {} found: the file is cut short", source.len())));
    }
    let mut chunk = |kind: &[u8; 4]| -> Result<Option<&[u8]>> {
        if source.remaining() == 0 {
            return Ok(None);
        }
        let bytes: u32 = source.value("chunk length")?;
        let found: [u8; 4] = source.value("chunk type")?;
        source.expect(u64::from(bytes), "chunk")?;
        let (start, end) = (source.at(), source.at() + u64::from(bytes));
        source.seek(end)?;
        Ok((found == *kind).then_some(&glb[start as usize..end as usize]))
    };
    let text = chunk(b"JSON")?.ok_or_else(|| Error::new("its first chunk is not JSON"))?;
    Ok((text, chunk(b"BIN\0")?))
}

/// The bytes of a buffer. Many buffers may be of the same chunk or file, which is in memory once.
#[derive(Clone)]
enum Buffer<'a> {
    /// The chunk of a .glb.
    Chunk(&'a [u8]),
    /// Read or unpacked for it.
    Read(Rc<Vec<u8>>),
}

impl Deref for Buffer<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Chunk(bytes) => bytes,
            Self::Read(bytes) => bytes,
        }
    }
}

/// The bytes of every buffer, and what may be made of them.
pub(crate) struct Buffers<'a> {
    all: Vec<Buffer<'a>>,
    /// What lies in the file, or in another's, counts once.
    pub budget: Budget,
}

impl<'a> Buffers<'a> {
    /// Those of a document, which was read out of `file` with this binary chunk. `folder`: where buffers in files of their own are;
    /// `None` refuses them.
    pub fn new(document: &gltf::Document, file: &[u8], blob: Option<&'a [u8]>, folder: Option<&Path>) -> Result<Self> {
        let mut all = Vec::new();
        let mut files: HashMap<PathBuf, Rc<Vec<u8>>> = HashMap::new();
        let mut held = file.len() as u64;
        for buffer in document.buffers() {
            let name = |e: Error| e.under(format!("buffer {}", buffer.index()));
            let bytes = match buffer.source() {
                Source::Bin => Buffer::Chunk(blob.ok_or_else(|| name(Error::new("the file has no binary chunk")))?),
                // Its letters are the file's.
                Source::Uri(uri) if uri.starts_with("data:") => {
                    let data = gltf::buffer::Data::from_source(buffer.source(), None);
                    Buffer::Read(Rc::new(data.map_err(|e| name(Error::new(e.to_string())))?.0))
                }
                Source::Uri(uri) => {
                    let file = external(uri, folder).map_err(name)?;
                    // Under whichever of its names.
                    let file = file.canonicalize().unwrap_or(file);
                    let bytes = match files.get(&file) {
                        Some(known) => known.clone(),
                        None => Rc::new(input::read(&file, MOST_BINARY_BYTES).map_err(name)?),
                    };
                    if !files.contains_key(&file) {
                        held += bytes.len() as u64;
                    }
                    Buffer::Read(files.entry(file).or_insert(bytes).clone())
                }
            };
            if bytes.len() < buffer.length() {
                let (found, expected) = (bytes.len(), buffer.length());
                let line = format!("{expected} bytes expected, {found} found: the file is cut short");
                return Err(name(Error::new(line)));
            }
            all.push(bytes);
        }
        Ok(Self { all, budget: Budget::of(held) })
    }

    /// The bytes of one.
    pub fn get(&self, index: usize) -> Option<&[u8]> {
        self.all.get(index).map(|bytes| &**bytes)
    }
}

/// A buffer in a file of its own, beside the .gltf.
fn external(uri: &str, folder: Option<&Path>) -> Result<PathBuf> {
    let plain = |name: &String| {
        !name.contains([':', '\\', '\0']) && !name.starts_with('/') && !name.split('/').any(|part| part == "..")
    };
    match (folder, decoded(uri).filter(plain)) {
        (Some(folder), Some(name)) => Ok(folder.join(name)),
        _ => Err(Error::new(format!("\"{uri}\" is not a file in the folder of the .gltf: save as .glb"))),
    }
}

/// A name as its address spells it: a blank is `%20` there. `None` where that is no text.
fn decoded(uri: &str) -> Option<String> {
    let mut name = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let pair = after.first_chunk::<2>().filter(|pair| byte == b'%' && pair.iter().all(u8::is_ascii_hexdigit));
        match pair {
            Some(pair) => {
                name.push(u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()?);
                rest = &after[2..];
            }
            None => {
                name.push(byte);
                rest = after;
            }
        }
    }
    String::from_utf8(name).ok()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_in_the_folder_under_the_name_that_its_address_spells() {
        let folder = Path::new("folder");
        let of = |uri: &str| external(uri, Some(folder)).ok();
        for (uri, name) in [
            ("a.bin", "a.bin"),
            ("my%20head.bin", "my head.bin"),
            ("%E9%AB%AA/a.bin", "\u{9aea}/a.bin"),
            ("50%.bin", "50%.bin"),
            ("a%2Fb.bin", "a/b.bin"),
            ("\u{9aea} 1.bin", "\u{9aea} 1.bin"),
        ] {
            assert_eq!(of(uri), Some(folder.join(name)), "{uri}");
        }
        for uri in
            ["../a.bin", "%2E%2E/a.bin", "/a.bin", "%2Fa.bin", "http://a/b.bin", "a%5Cb.bin", "%FF.bin", "a%00b.bin"]
        {
            assert_eq!(of(uri), None, "{uri}");
        }
        assert!(external("a.bin", None).is_err());
    }

    /// A .glb of a text and of the one buffer that this describes.
    pub(crate) fn glb(text: &str, binary: &[u8]) -> Vec<u8> {
        let mut json = text.as_bytes().to_vec();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = binary.to_vec();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut glb = b"glTF".to_vec();
        let mut words = |words: &[u32], bytes: &[u8]| {
            glb.extend(words.iter().flat_map(|w| w.to_le_bytes()));
            glb.extend(bytes);
        };
        words(&[2, (28 + json.len() + binary.len()) as u32, json.len() as u32, 0x4E4F_534A], &json);
        words(&[binary.len() as u32, 0x004E_4942], &binary);
        glb
    }
}
