//! Meshes: points and faces from files of other programs, which the feature `meshes` reads.

#[cfg(feature = "meshes")]
mod files;

#[cfg(feature = "meshes")]
pub(super) use files::read;

/// Limit of the size of a file.
pub(super) const MAX_BYTES: u64 = 16 << 20;

/// Refuses a file of a mesh.
#[cfg(not(feature = "meshes"))]
pub(super) fn read(
    path: &std::path::Path,
    _: &[u8],
    _: &crate::diagnostic::Place,
) -> Result<super::node::Node, crate::diagnostic::Diagnostic> {
    let message = format!(
        "'{}' is not read: files of meshes are not built in",
        path.display()
    );
    let hint = "the feature `meshes` of kfrac reads them; the points and faces may be written out";
    Err(crate::diagnostic::Diagnostic::error(message).hint(hint))
}
