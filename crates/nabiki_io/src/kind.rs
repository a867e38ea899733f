//! The kind of a file, from its first bytes or else the ending of its name.

use std::fmt;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};
use crate::input;
use crate::shell::{operand, quoted};

/// A name's ending in lower case, without the dot.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// How hair or a head goes between here and the programs whose own files have this ending: the end of a line that refuses these.
pub(crate) fn way_out(ending: &str) -> &'static str {
    match ending {
        "usdz" => "; it is a package: give the layer inside",
        "bgeo" | "geo" | "sc" | "gz" | "hip" | "hiplc" | "hipnc" => "; Houdini reads and writes USD and Alembic",
        "ma" | "mb" | "xgen" => "; Maya reads and writes Alembic and USD",
        "fbx" => "; it holds heads and motion: its programs write hair as USD or Alembic",
        "blend" => "; Blender reads and writes USD and Alembic",
        _ => "",
    }
}

/// The kinds of files that Nabiki uses, or that are likely to be passed to it by mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "their Display says what they are")]
pub enum FileKind {
    Scene,
    Cache,
    YukselHair,
    TressFxHair,
    TressFxBones,
    TressFxMesh,
    Obj,
    Gltf,
    Ply,
    UsdText,
    UsdCrate,
    UsdPackage,
    Alembic,
    Hdf5,
    Bvh,
    AcclaimMotion,
    AcclaimSkeleton,
    ObjectStream,
    Table,
    Fbx,
    Blender,
    Png,
    Jpeg,
    Exr,
    Movie,
}

impl FileKind {
    /// The kind of the file at `path`; `None` if neither its bytes nor its name tell.
    ///
    /// # Errors
    /// If the file is not regular or cannot be read.
    pub fn of(path: &Path) -> Result<Option<Self>> {
        let mut first = Vec::new();
        input::open(path)?.take(16).read_to_end(&mut first).map_err(|e| Error::from(e).in_file(path))?;
        Ok(Self::of_bytes(&first).or_else(|| Self::of_name(path)))
    }

    /// The kind of a file that starts with `first`. Sixteen bytes are enough.
    pub fn of_bytes(first: &[u8]) -> Option<Self> {
        const BEGINNINGS: [(&[u8], FileKind); 19] = [
            (b"NABIKI\r\n", FileKind::Cache),
            (b"HAIR", FileKind::YukselHair),
            // 3.0 and 4.0 as f32.
            (b"\0\0\x40\x40", FileKind::TressFxHair),
            (b"\0\0\x80\x40", FileKind::TressFxHair),
            (b"numOfBones", FileKind::TressFxMesh),
            (b"glTF", FileKind::Gltf),
            (b"ply\n", FileKind::Ply),
            (b"ply\r", FileKind::Ply),
            (b"#usda", FileKind::UsdText),
            (b"PXR-USDC", FileKind::UsdCrate),
            (b"Ogawa", FileKind::Alembic),
            (b"\x89HDF", FileKind::Hdf5),
            (b"HIERARCHY", FileKind::Bvh),
            (b"TOS ", FileKind::ObjectStream),
            (b"Kaydara FBX", FileKind::Fbx),
            (b"BLENDER", FileKind::Blender),
            (b"\x89PNG", FileKind::Png),
            (b"\xff\xd8\xff", FileKind::Jpeg),
            (b"\x76\x2f\x31\x01", FileKind::Exr),
        ];
        let first = first.strip_prefix(input::BYTE_ORDER_MARK).unwrap_or(first);
        if first.get(4..8) == Some(b"ftyp") {
            return Some(Self::Movie);
        }
        BEGINNINGS.into_iter().find(|(beginning, _)| first.starts_with(beginning)).map(|(_, kind)| kind)
    }

    /// The kind for the ending of a name.
    pub fn of_name(path: &Path) -> Option<Self> {
        Some(match extension(path).as_str() {
            "toml" => Self::Scene,
            "nabiki" => Self::Cache,
            "hair" => Self::YukselHair,
            "tfx" => Self::TressFxHair,
            "tfxbone" => Self::TressFxBones,
            "tfxmesh" => Self::TressFxMesh,
            "obj" => Self::Obj,
            "glb" | "gltf" => Self::Gltf,
            "ply" => Self::Ply,
            "usda" => Self::UsdText,
            "usd" | "usdc" => Self::UsdCrate,
            "usdz" => Self::UsdPackage,
            "abc" => Self::Alembic,
            "bvh" => Self::Bvh,
            "amc" => Self::AcclaimMotion,
            "asf" => Self::AcclaimSkeleton,
            "tof" => Self::ObjectStream,
            "csv" => Self::Table,
            "fbx" => Self::Fbx,
            "blend" => Self::Blender,
            "png" => Self::Png,
            "jpg" | "jpeg" => Self::Jpeg,
            "exr" => Self::Exr,
            "mp4" | "mov" => Self::Movie,
            _ => return None,
        })
    }

    /// What to do with such a file where a scene was expected; `file` is its name.
    fn way_into_a_scene(self, file: &str) -> String {
        let in_scene = |key: &str| format!("use it in a scene with {key} = \"{file}\"");
        match self {
            Self::YukselHair | Self::TressFxHair => in_scene("hair.file"),
            Self::TressFxMesh | Self::Gltf | Self::Fbx | Self::Ply => in_scene("head.mesh"),
            Self::Obj | Self::UsdText | Self::UsdCrate | Self::Alembic => {
                format!("{} or head.mesh", in_scene("hair.file"))
            }
            Self::Bvh | Self::AcclaimMotion | Self::ObjectStream | Self::Table => in_scene("head.motion.file"),
            Self::AcclaimSkeleton => in_scene("head.motion.skeleton"),
            Self::Cache => {
                let file = quoted(&operand(file));
                format!("nabiki render SCENE --motion {file} renders it, nabiki info {file} describes it")
            }
            _ => "give a scene".to_owned(),
        }
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scene => "a scene",
            Self::Cache => "a motion cache",
            Self::YukselHair => "a .hair file",
            Self::TressFxHair => "TressFX hair",
            Self::TressFxBones => "TressFX bone weights",
            Self::TressFxMesh => "a TressFX mesh",
            Self::Obj => "a Wavefront .obj file",
            Self::Gltf => "a glTF file",
            Self::Ply => "a .ply mesh",
            Self::UsdText => "a USD layer (text)",
            Self::UsdCrate => "a USD layer (binary)",
            Self::UsdPackage => "a USD package",
            Self::Alembic => "an Alembic archive",
            Self::Hdf5 => "an HDF5 file (perhaps an Alembic archive from before 2014)",
            Self::Bvh => "BVH motion",
            Self::AcclaimMotion => "Acclaim motion",
            Self::AcclaimSkeleton => "an Acclaim skeleton",
            Self::ObjectStream => "an object stream of Jolt",
            Self::Table => "a table",
            Self::Fbx => "an FBX file",
            Self::Blender => "a Blender file",
            Self::Png => "a PNG picture",
            Self::Jpeg => "a JPEG picture",
            Self::Exr => "an OpenEXR picture",
            Self::Movie => "a movie",
        })
    }
}

/// Refuses a file that is not a scene, saying what it is and how to use it.
///
/// # Errors
/// One line. Also if the file cannot be read.
pub fn check_scene(path: &Path) -> Result<()> {
    match FileKind::of(path)? {
        None | Some(FileKind::Scene) => Ok(()),
        Some(kind) => {
            let way = kind.way_into_a_scene(&path.display().to_string());
            Err(Error::new(format!("is {kind}, not a scene (.toml): {way}")).in_file(path))
        }
    }
}

/// Refuses to write this text under a name that does not belong to a scene.
///
/// # Errors
/// Names the kind of file that the name suggests.
pub fn check_scene_to_be(path: &Path, text: &str) -> Result<()> {
    match FileKind::of_bytes(text.as_bytes()).or_else(|| FileKind::of_name(path)) {
        None | Some(FileKind::Scene) => Ok(()),
        Some(kind) => {
            let line = format!("would be mistaken for {kind}: a scene ends in .toml; choose another name");
            Err(Error::new(line).in_file(path))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bytes_go_before_the_name() {
        let folder = tempfile::tempdir().unwrap();
        let written = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let kind = |name: &str, bytes: &[u8]| FileKind::of(&written(name, bytes)).unwrap();
        assert_eq!(kind("a.toml", b"PXR-USDC\0\x08"), Some(FileKind::UsdCrate));
        assert_eq!(kind("a.tfx", &4.0f32.to_le_bytes()), Some(FileKind::TressFxHair));
        assert_eq!(kind("a.usd", b"#usda 1.0\n"), Some(FileKind::UsdText));
        assert_eq!(kind("a.obj", b"v 0 0 0\n"), Some(FileKind::Obj));
        assert_eq!(kind("a.mp4", b"\0\0\0\x20ftypisom"), Some(FileKind::Movie));
        assert_eq!(kind("a", b""), None);
    }

    #[test]
    fn what_is_no_scene_is_called_by_its_name_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let path_text = path.display().to_string();
            check_scene(&path).map_err(|e| e.to_string().replace(&path_text, name))
        };
        assert_eq!(
            refused("hair.usdc", b"PXR-USDC").unwrap_err(),
            "hair.usdc: is a USD layer (binary), not a scene (.toml): use it in a scene with hair.file = \"hair.usdc\" or head.mesh"
        );
        assert_eq!(
            refused("walk.bvh", b"HIERARCHY").unwrap_err(),
            "walk.bvh: is BVH motion, not a scene (.toml): use it in a scene with head.motion.file = \"walk.bvh\""
        );
        assert!(refused("gust.nabiki", b"NABIKI\r\n").unwrap_err().contains("render SCENE --motion gust.nabiki"));
        assert!(refused("a.png", b"\x89PNG").unwrap_err().contains("is a PNG picture, not a scene"));
        // Whatever else is there may be a scene: its own reader says what is wrong with it.
        for (name, bytes) in [("scene.toml", &b"[head]"[..]), ("scene", b"[head]"), ("empty.toml", b"")] {
            assert_eq!(refused(name, bytes), Ok(()));
        }
    }
}
