//! The description of a directory's sweep, so that no other one is mixed into it.

use std::fs;
use std::io::{self, BufWriter, Write};
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
    /// The axes along which the runs vary.
    axes: Vec<Axis>,
}

impl Manifest {
    /// The manifest of a sweep of `scene`, to which `set` has been applied.
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

    /// Makes `directory` that of this sweep, or checks that it is.
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
            let mut out = BufWriter::new(&mut file);
            serde_json::to_writer_pretty(&mut out, self)?;
            out.write_all(b"\n")?;
            out.flush()?;
            drop(out);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    /// A sweep of a beam of this length.
    fn manifest(length: u8, set: &[&str], axes: &[&str]) -> Manifest {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [{length}, 0], axial_stiffness = 1, bending_stiffness = 1, \
             basis.ancf.elements = 1 }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             analysis.static = {{}}\n"
        );
        let set: Vec<String> = set.iter().map(|&option| option.to_owned()).collect();
        let axes = axes.iter().map(|option| Axis::parse(option).unwrap()).collect();
        Manifest::new(&parse("arm.toml", &text).unwrap(), &set, &Grid::new(axes).unwrap())
    }

    #[test]
    fn what_differs_is_named() {
        let this = manifest(1, &["title=x"], &["b=1,2", "c=3"]);
        let older = Manifest { version: "0.0.1".into(), ..this.clone() };
        for (there, difference) in [
            (&this, ""),
            (&older, "it was computed by version 0.0.1, and this is "),
            (&manifest(1, &[], &["b=1,2", "c=3"]), "there --set has nothing, here title=x"),
            (&manifest(1, &["d=2", "e=3"], &["b=1,2"]), "there --set has d=2, e=3, here title=x"),
            (
                &manifest(2, &["title=x"], &["b=1,2"]),
                "its scene arm.toml had another content than arm.toml has now",
            ),
            (&manifest(1, &["title=x"], &["b=1,2"]), "there b vary, here b, c"),
            (&manifest(1, &["title=x"], &["b=1,2", "c=4"]), "the values of c are others"),
        ] {
            let found = this.compare(there, Path::new("s")).err().map(|error| error.to_string());
            let found = found.unwrap_or_default();
            let expected = if difference.is_empty() { "" } else { "s holds another sweep: " };
            assert!(found.starts_with(&format!("{expected}{difference}")), "{found}");
            assert_eq!(found.is_empty(), difference.is_empty(), "{found}");
        }
    }

    #[test]
    fn a_directory_is_of_one_sweep() {
        let folder = tempfile::tempdir().unwrap();
        let (this, other) = (manifest(1, &[], &["b=1,2"]), manifest(1, &[], &["b=1,3"]));
        assert_eq!(Manifest::read(folder.path()).unwrap(), None);
        this.claim(folder.path()).unwrap();
        assert_eq!(Manifest::read(folder.path()).unwrap().as_ref(), Some(&this));
        assert_eq!(this.grid().unwrap().runs(), 2);
        this.claim(folder.path()).unwrap();
        assert!(matches!(other.claim(folder.path()), Err(SweepError::Another { .. })));
        fs::write(folder.path().join(MANIFEST), "{").unwrap();
        assert!(matches!(this.claim(folder.path()), Err(SweepError::Manifest { .. })));
        fs::remove_file(folder.path().join(MANIFEST)).unwrap();
        fs::write(folder.path().join("journal-1-of-1.jsonl"), "").unwrap();
        assert!(matches!(this.claim(folder.path()), Err(SweepError::Stray { .. })));
    }

    /// Of two processes that begin a sweep at once, one finds the other's manifest, which equals
    /// its own: so many values take so long to write that the other's is there before.
    #[test]
    fn two_may_begin_it_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let (this, ready) = (manifest(1, &[], &["b=1:2:4000"]), folder.path().join("ready"));
        fs::write(&ready, serde_json::to_vec(&this).unwrap()).unwrap();
        // A process that writes has seen that there is no manifest yet.
        let writes = || {
            let mut files = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
            files.any(|path| path.extension().is_some_and(|extension| extension == "part"))
        };
        std::thread::scope(|scope| {
            let claimed = scope.spawn(|| this.claim(folder.path()).map_err(|error| error.to_string()));
            while !writes() && !claimed.is_finished() {
                std::thread::yield_now();
            }
            fs::rename(&ready, folder.path().join(MANIFEST)).unwrap();
            assert_eq!(claimed.join().unwrap(), Ok(()));
        });
    }

    /// The manifest has the permissions of any file that this user makes.
    #[cfg(unix)]
    #[test]
    fn others_may_read_it() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        manifest(1, &[], &["b=1,2"]).claim(folder.path()).unwrap();
        fs::write(folder.path().join("usual"), "").unwrap();
        let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        assert_eq!(mode(MANIFEST), mode("usual"));
    }
}
