//! glTF documents and their buffers, for the readers of meshes and of motion. The crate gltf parses and validates; lengths,
//! and buffers in files of their own, are seen to here.

pub(crate) mod accessors;
pub(crate) mod pose;

use std::path::Path;

use gltf::buffer::Source;

use crate::bytes::Bytes;
use crate::error::{Error, Result};
use crate::input::{self, MOST_BINARY_BYTES};

/// The document, valid, and the binary chunk of a .glb.
pub(crate) fn open(bytes: &[u8]) -> Result<(gltf::Document, Option<Vec<u8>>)> {
    let unreadable = |e: gltf::Error| Error::new(format!("is not a readable glTF: {e}"));
    let (text, blob) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
    let text = text.strip_prefix(input::BYTE_ORDER_MARK).unwrap_or(text);
    if text.trim_ascii_start().first() != Some(&b'{') {
        return Err(Error::new("is not a glTF: it does not start with glTF or {"));
    }
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
        return Err(Error::new(format!("is not a readable glTF: accessor {missing} is named, there are {count}")));
    }
    Ok((gltf::Document::from_json(json).map_err(unreadable)?, blob.map(<[u8]>::to_vec)))
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

/// The bytes of every buffer.
pub(crate) fn buffers(document: &gltf::Document, blob: Option<&[u8]>, folder: Option<&Path>) -> Result<Vec<Vec<u8>>> {
    let mut all = Vec::new();
    for buffer in document.buffers() {
        let name = |e: Error| e.under(format!("buffer {}", buffer.index()));
        let bytes = match buffer.source() {
            Source::Bin => blob.ok_or_else(|| name(Error::new("the file has no binary chunk")))?.to_vec(),
            Source::Uri(uri) if uri.starts_with("data:") => {
                let data = gltf::buffer::Data::from_source(buffer.source(), None);
                data.map_err(|e| name(Error::new(e.to_string())))?.0
            }
            Source::Uri(uri) => external(uri, folder).map_err(name)?,
        };
        if bytes.len() < buffer.length() {
            let (found, expected) = (bytes.len(), buffer.length());
            return Err(name(Error::new(format!("{expected} bytes expected, {found} found: the file is cut short"))));
        }
        all.push(bytes);
    }
    Ok(all)
}

/// A buffer in a file of its own, beside the .gltf.
fn external(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>> {
    let plain = !uri.contains([':', '%', '\\']) && !uri.starts_with('/') && !uri.split('/').any(|part| part == "..");
    match folder {
        Some(folder) if plain => input::read(&folder.join(uri), MOST_BINARY_BYTES),
        _ => Err(Error::new(format!("\"{uri}\" is not a file in the folder of the .gltf: save as .glb"))),
    }
}

#[cfg(test)]
pub(crate) mod tests {
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
