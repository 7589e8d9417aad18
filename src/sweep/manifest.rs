//! What a directory's sweep is, so that no other one is mixed into it.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::{Axis, Grid, SweepError, journal};
use crate::scene::Scene;

/// Name of the file in the directory of the sweep.
pub const MANIFEST: &str = "sweep.json";

/// Everything on which the results of a sweep depend.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Manifest {
    /// Version of the program.
    version: String,
    /// The scene file; for people, since a scene may move.
    scene: String,
    /// SHA-256 of the scene's text with `set` applied.
    sha256: String,
    /// Overrides that all runs share.
    set: Vec<String>,
    /// What varies.
    axes: Vec<Axis>,
}

impl Manifest {
    /// Of a sweep of `scene`, to which `set` has been applied.
    pub fn new(scene: &Scene, set: &[String], grid: &Grid) -> Self {
        let digest = Sha256::digest(scene.text().as_bytes());
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene.name().to_owned(),
            sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
            set: set.to_vec(),
            axes: grid.axes().to_vec(),
        }
    }

    /// The grid of its runs.
    pub fn grid(&self) -> Result<Grid, SweepError> {
        Grid::new(self.axes.clone())
    }

    /// Reads the manifest of `directory`; nothing where there is none.
    pub fn read(directory: &Path) -> Result<Option<Self>, SweepError> {
        let path = directory.join(MANIFEST);
        let wrong = |reason: String| SweepError::Manifest { path: path.clone(), reason };
        match fs::read(&path) {
            Ok(text) => serde_json::from_slice(&text).map(Some).map_err(|error| wrong(error.to_string())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(wrong(error.to_string())),
        }
    }

    /// Makes `directory` that of this sweep, or sees that it is.
    pub fn claim(&self, directory: &Path) -> Result<(), SweepError> {
        // In this order: whoever writes a journal has written the manifest before.
        let journals = journal::paths(directory)?;
        if let Some(there) = Self::read(directory)? {
            return self.compare(&there, directory);
        }
        if !journals.is_empty() {
            return Err(SweepError::Stray { directory: directory.to_owned() });
        }
        let path = directory.join(MANIFEST);
        let wrong = |error: io::Error| SweepError::Manifest { path: path.clone(), reason: error.to_string() };
        let write = || -> io::Result<tempfile::NamedTempFile> {
            let mut builder = tempfile::Builder::new();
            builder.prefix(".ancf-").suffix(".part");
            #[cfg(unix)]
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            let mut file = builder.tempfile_in(directory)?;
            serde_json::to_writer_pretty(&mut file, self)?;
            file.write_all(b"\n")?;
            Ok(file)
        };
        match write().map_err(wrong)?.persist_noclobber(&path) {
            Ok(_) => Ok(()),
            // Another process was faster.
            Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => {
                match Self::read(directory)? {
                    Some(there) => self.compare(&there, directory),
                    None => Err(wrong(error.error)),
                }
            }
            Err(error) => Err(wrong(error.error)),
        }
    }

    fn compare(&self, there: &Self, directory: &Path) -> Result<(), SweepError> {
        let paths = |this: &Self| {
            this.axes.iter().flat_map(|axis| axis.paths.iter().cloned()).collect::<Vec<_>>().join(", ")
        };
        let list = |set: &[String]| if set.is_empty() { "nothing".to_owned() } else { set.join(", ") };
        let difference = if self.version != there.version {
            format!("it was computed by version {}, and this is {}", there.version, self.version)
        } else if self.set != there.set {
            format!("there --set has {}, here {}", list(&there.set), list(&self.set))
        } else if self.sha256 != there.sha256 {
            format!("its scene {} had another content than {} has now", there.scene, self.scene)
        } else if paths(self) != paths(there) {
            format!("there {} vary, here {}", paths(there), paths(self))
        } else if let Some((axis, _)) = self.axes.iter().zip(&there.axes).find(|(here, there)| here != there)
        {
            format!("the values of {} are others", axis.paths.join(", "))
        } else {
            return Ok(());
        };
        Err(SweepError::Another { directory: directory.to_owned(), difference })
    }
}
