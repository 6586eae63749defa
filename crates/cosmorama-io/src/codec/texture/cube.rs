use std::io::SeekFrom;
use std::path::Path;

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, FramePool, Primaries, Samples, Transfer};
use half::f16;
use rayon::prelude::*;

use super::packing::Packed;
use super::texel::Texels;
use crate::codec::interface::{Codec, Density, Sink, Source, is_beside_others, length, whole_image};
use crate::{EnvMap, Format, Header, ImageFile, IoError, Limits, Metadata, WriteOptions};

/// Supported textures, for messages.
pub(super) const EXPECTED: &str = "a cube of 8-bit, half or float texels, RGB9E5, R11G11B10, BC1 to BC3, BC6H or BC7, as it is or packed by Zstandard \
     or zlib; textures of BasisLZ and UASTC are unpacked by `ktx transcode`";

/// A format of textures that holds cubes with their mip levels.
pub(super) trait TextureFormat: Sync {
    /// Its name.
    const FORMAT: Format;

    /// Reads the structure of a file, without its texels.
    fn texture(&self, path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError>;

    /// Writes six faces with their mip levels.
    fn write(&self, path: &Path, output: Sink<'_>, cube: WrittenCube, metadata: &Metadata) -> Result<(), IoError>;

    /// Writes a flat texture of one level, without faces.
    fn write_flat(
        &self,
        path: &Path,
        _output: Sink<'_>,
        _image: &EncodedImage,
        _options: &WriteOptions,
    ) -> Result<(), IoError> {
        Err(IoError::write(path, "a flat texture is written as KTX 2"))
    }
}

/// A cube to write.
pub(super) struct WrittenCube {
    /// Samples of each level, the largest first: RGBA, face by face.
    pub(super) levels: Vec<Vec<u8>>,
    /// Columns, and rows, of a face in the largest level.
    pub(super) edge: u32,
    /// Sample type.
    pub(super) depth: Depth,
}

impl<T: TextureFormat> Codec for T {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        let texture = self.texture(path, &mut *source)?;
        texture.check_capacity(path, T::FORMAT, source)?;
        Ok(texture.header(T::FORMAT))
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, _: &FramePool) -> Result<ImageFile, IoError> {
        self.texture(path, source)?.read(path, T::FORMAT, source, limits)
    }

    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        self.encode_levels(path, output, std::slice::from_ref(image), options)
    }

    fn encode_flat(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        self.write_flat(path, output, image, options)
    }

    fn encode_levels(
        &self,
        path: &Path,
        output: Sink<'_>,
        levels: &[EncodedImage],
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        let cube = WrittenCube::new((path, T::FORMAT), levels, &options.metadata)?;
        self.write(path, output, cube, &options.metadata)
    }
}

/// The faces of a cube in a texture file: offsets of the largest pictures of +X −X +Y −Y +Z −Z, and their encoding.
pub(super) struct CubeTexture {
    /// Encoding of texels.
    pub(super) texels: Texels,
    /// Transfer function, if the file names one.
    pub(super) transfer: Option<Transfer>,
    /// Primaries, if the file names known ones.
    pub(super) primaries: Option<Primaries>,
    /// Complaints about what the file says of its colours.
    pub(super) complaints: Vec<String>,
    /// Relation of colour to alpha.
    pub(super) alpha: AlphaMode,
    /// Columns, and rows, of a face.
    pub(super) edge: u32,
    /// Alignment of rows in bytes.
    pub(super) row_alignment: u64,
    /// Offset of each face; in supercompressed files, in the unpacked data.
    pub(super) offsets: [u64; 6],
    /// Supercompression of all faces together, if any.
    pub(super) packed: Option<Packed>,
}

impl CubeTexture {
    /// Returns the header of an image of six pictures one below the other.
    pub(super) fn header(&self, format: Format) -> Header {
        let edge = self.edge as usize;
        let metadata = Metadata {
            transfer: self.transfer.clone(),
            primaries: self.primaries,
            complaints: self.complaints.clone(),
            envmap: Some(EnvMap::GlCube),
            ..Metadata::default()
        };
        Header {
            format,
            width: edge,
            height: edge.saturating_mul(6),
            channels: self.texels.channels(),
            depth: self.texels.depth(),
            metadata,
            window: None,
        }
    }

    /// Checks the number of levels: each has half the size of the one before, down to a face of one texel. `field` is
    /// the format's name of that number.
    pub(super) fn check_levels(&self, path: &Path, format: Format, field: &str, levels: u32) -> Result<(), IoError> {
        let most = self.edge.checked_ilog2().map_or(1, |halvings| halvings + 1);
        if levels <= most {
            return Ok(());
        }
        let edge = self.edge;
        let reason = format_args!("{field} is {levels}; faces of {edge}x{edge} pixels have {most} levels at most");
        Err(IoError::damaged(path, format, reason))
    }

    /// Returns the bytes of a face.
    pub(super) fn face_bytes(&self) -> u64 {
        self.level_bytes(0)
    }

    /// Returns the bytes of a face's smaller copy, with half the edge at each level.
    pub(super) fn level_bytes(&self, level: u32) -> u64 {
        let edge = (self.edge >> level).max(1);
        let blocks = u64::from(edge.div_ceil(self.texels.block_edge()));
        let row = (blocks * self.texels.block_bytes()).next_multiple_of(self.row_alignment);
        row.saturating_mul(blocks)
    }

    /// Refuses faces of more pixels than the file can hold.
    fn check_capacity(&self, path: &Path, format: Format, source: Source<'_>) -> Result<(), IoError> {
        let length = length(path, source)?;
        let unpacked = self.packed.map_or(1, |packed| packed.packing.unpacked());
        let bytes = self.packed.map_or(length, |packed| packed.length.min(length));
        let edge = self.edge as usize;
        let density = Density::of_bits(self.texels.bits(), unpacked);
        density.check(path, format, (edge, edge.saturating_mul(6)), bytes)
    }

    /// Reads the faces, after checking that they exist and fit into memory.
    pub(super) fn read(
        &self,
        path: &Path,
        format: Format,
        source: Source<'_>,
        limits: &Limits,
    ) -> Result<ImageFile, IoError> {
        let header = self.header(format);
        limits.check(path, (header.width as u64, header.height as u64), header.channels, header.depth)?;
        self.check_capacity(path, format, source)?;
        let bytes = self.face_bytes();
        let size = usize::try_from(bytes).map_err(|_| IoError::damaged(path, format, "it is larger than memory"))?;
        let faces = match self.packed {
            None => self.faces(path, format, source)?,
            Some(packed) => {
                let all =
                    size.checked_mul(6).ok_or_else(|| IoError::damaged(path, format, "it is larger than memory"))?;
                let all = packed.read(path, format, source, all)?;
                all.chunks_exact(size.max(1)).map(<[u8]>::to_vec).collect()
            }
        };
        let decode = |face: Vec<u8>| self.texels.decode(&face, self.edge as usize, self.row_alignment as usize);
        let decoded: Vec<Samples> = if is_beside_others() {
            faces.into_iter().map(decode).collect()
        } else {
            faces.into_par_iter().map(decode).collect()
        };
        let mut file = whole_image(path, header, joined(decoded))?;
        file.image = file.image.with_alpha_mode(self.alpha);
        Ok(file)
    }

    /// Returns the bytes of the faces, where they are not supercompressed.
    fn faces(&self, path: &Path, format: Format, source: Source<'_>) -> Result<Vec<Vec<u8>>, IoError> {
        let bytes = self.face_bytes();
        let length = source.seek(SeekFrom::End(0)).map_err(|error| IoError::open(path, error))?;
        let ends_inside = |offset: &u64| offset.checked_add(bytes).is_some_and(|end| end <= length);
        if !self.offsets.iter().all(ends_inside) {
            return Err(IoError::damaged(path, format, "it ends too early"));
        }
        let size = usize::try_from(bytes).map_err(|_| IoError::damaged(path, format, "it is larger than memory"))?;
        let mut faces = Vec::new();
        for offset in self.offsets {
            let mut face = vec![0; size];
            source
                .seek(SeekFrom::Start(offset))
                .and_then(|_| source.read_exact(&mut face))
                .map_err(|_| IoError::damaged(path, format, "it ends too early"))?;
            faces.push(face);
        }
        Ok(faces)
    }
}

fn joined(faces: Vec<Samples>) -> Samples {
    let mut faces = faces.into_iter();
    let mut all = faces.next().unwrap_or(Samples::U8(Vec::new()));
    for face in faces {
        match (&mut all, face) {
            (Samples::U8(all), Samples::U8(face)) => all.extend(face),
            (Samples::U16(all), Samples::U16(face)) => all.extend(face),
            (Samples::Half(all), Samples::Half(face)) => all.extend(face),
            (Samples::Float(all), Samples::Float(face)) => all.extend(face),
            // All faces are of one format.
            _ => {}
        }
    }
    all
}

impl WrittenCube {
    /// Takes the samples of a cube's levels.
    fn new((path, format): (&Path, Format), levels: &[EncodedImage], metadata: &Metadata) -> Result<Self, IoError> {
        let Some(largest) = levels.first() else { return Err(IoError::write(path, "there is no picture")) };
        let (edge, depth) = (largest.width(), largest.depth());
        let mut bytes = Vec::new();
        for (level, image) in levels.iter().enumerate() {
            let expected = (edge >> level).max(1);
            let is_level = (image.width(), image.depth()) == (expected, depth);
            if !is_level || (level > 0 && edge >> level == 0) {
                return Err(IoError::write(path, format_args!("level {level} is no half of the level before")));
            }
            bytes.push(faces_to_write(path, format, image, metadata)?);
        }
        let edge = u32::try_from(edge).map_err(|_| IoError::write(path, format_args!("faces of {edge} pixels")))?;
        Ok(Self { levels: bytes, edge, depth })
    }
}

/// Returns the samples of six faces.
fn faces_to_write(path: &Path, format: Format, image: &EncodedImage, metadata: &Metadata) -> Result<Vec<u8>, IoError> {
    let cannot = |found: String| IoError::CannotHold {
        path: path.to_owned(),
        format,
        found,
        expected: "the six faces of a cube in its own order, one below the other (--to cube)".to_owned(),
    };
    let (width, height) = (image.width(), image.height());
    if metadata.envmap != Some(EnvMap::GlCube) || Some(height) != width.checked_mul(6) {
        return Err(cannot(format!("a picture of {width}x{height} pixels that is no such cube")));
    }
    match (image.channels(), image.samples()) {
        (Channels::Rgba, Samples::U8(samples)) => Ok(samples.clone()),
        (Channels::Rgba, Samples::Half(samples)) => {
            Ok(samples.iter().flat_map(|sample: &f16| sample.to_le_bytes()).collect())
        }
        (Channels::Rgba, Samples::Float(samples)) => {
            Ok(samples.iter().flat_map(|sample| sample.to_le_bytes()).collect())
        }
        _ => Err(cannot(format!("{} of depth {}", image.channels(), image.depth()))),
    }
}

/// Encodes what KTX files say under names, in order: the orientation of pictures, and remarks. Each pair is aligned to four bytes.
pub(super) fn key_values(orientation: (&str, &str), metadata: &Metadata) -> Vec<u8> {
    let mut pairs = vec![orientation, ("KTXwriter", "cosmorama")];
    pairs.extend(metadata.remarks.iter().map(|remark| (remark.name, &*remark.text)));
    pairs.sort_unstable();
    let mut bytes = Vec::new();
    for (key, value) in pairs {
        bytes.extend(((key.len() + value.len() + 2) as u32).to_le_bytes());
        bytes.extend(format!("{key}\0{value}\0").into_bytes());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}
