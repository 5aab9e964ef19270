//! A network that the user names: a description with the ONNX model that it is of.

use std::path::Path;

use crate::delineation::{Description, NamedModel};
use crate::fault::Fault;
use crate::files::{FileError, read_small, text_from_bytes};

/// How large a description may be, in bytes.
const LARGEST_DESCRIPTION: u64 = 1 << 20;

/// How large a model may be, in bytes: ONNX itself ends at two gigabytes.
const LARGEST_MODEL: u64 = 2 << 30;

/// Reads a description and its model, which lies beside it.
///
/// # Errors
/// With the file that cannot be taken: the description, or the model.
pub fn read_named_engine(path: &Path) -> Result<NamedModel, FileError> {
    let at = |fault: Fault| FileError::new(path, fault);
    let remedy = "give the TOML file that describes the model";
    let bytes = read_small(path, LARGEST_DESCRIPTION, "description", remedy)?;
    let text = text_from_bytes(&bytes).map_err(at)?;
    let description = Description::read(text).map_err(at)?;
    let network = |name: &str| {
        let file = path.with_file_name(name);
        let bytes = read_small(&file, LARGEST_MODEL, "model", "give a smaller one")?;
        Ok((file, bytes))
    };
    let (model, bytes) = network(&description.model)?;
    let decoder = description.decoder().map(network).transpose()?;
    let decoder = decoder.map(|(_, bytes)| bytes);
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    NamedModel::new(bytes, decoder, description, &name)
        .map_err(|fault| FileError::new(&model, fault))
}
