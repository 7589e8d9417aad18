//! The Python of the verification suite: a virtual environment of its own with pinned packages.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use ancf_check::{Suite, reference::sha256};
use indexmap::IndexMap;
use serde::Deserialize;

use crate::Failure;

/// The interpreter that this program is linked to. Another one's environment would have packages
/// for another version.
const INTERPRETER: &str = env!("ANCF_PYTHON");

/// The message that tells what to install where something is missing.
const REMEDY: &str = "The verification suite needs Python 3 with its venv module and its shared library (Debian: apt install \
                      python3 python3-venv python3-dev), and once a connection to the package index.";

/// A virtual environment under `target/`, made on first use.
pub struct Python {
    program: PathBuf,
    /// Its interpreter, packages and machine.
    pub facts: Facts,
}

/// Data on the interpreter and the machine, for provenance.
#[derive(Clone, Debug, Deserialize)]
pub struct Facts {
    /// Today, by the system's clock.
    pub date: String,
    /// Machine and system.
    pub platform: String,
    /// Version of the interpreter.
    pub python: String,
    /// Where its packages are.
    pub site_packages: String,
    /// Versions of the pinned packages.
    pub packages: IndexMap<String, String>,
}

impl Facts {
    /// The interpreter and those of the packages that `uses` admits, with their versions.
    pub fn tool(&self, uses: impl Fn(&str) -> bool) -> String {
        let packages = self.packages.iter().filter(|(name, _)| uses(name));
        let packages = packages.map(|(name, version)| format!(", {name} {version}"));
        format!("Python {}{}", self.python, packages.collect::<String>())
    }
}

const FACTS: &str = r#"
import datetime, importlib.metadata, json, platform, sys, sysconfig
lines = [line for path in sys.argv[1:] for line in open(path)]
there = {p.metadata["Name"].lower(): p.version for p in importlib.metadata.distributions()}
print(json.dumps({
    "date": datetime.date.today().isoformat(),
    "platform": f"{platform.system()} {platform.machine()}, {' '.join(platform.libc_ver())}".strip(", "),
    "python": platform.python_version(),
    "site_packages": sysconfig.get_path("platlib"),
    "packages": {p: there[p] for p in (l.split("==")[0].strip() for l in lines if "==" in l) if p in there},
}))
"#;

impl Python {
    /// The environment with the packages that `requirements.txt` of the oracles and of the peers
    /// pin; installs them where they are not there or no longer the same.
    ///
    /// # Errors
    /// Where the interpreter, its venv module or a package is missing.
    pub fn prepare(suite: &Suite) -> Result<Self, Failure> {
        let requirements = requirements(suite);
        let mut wanted = INTERPRETER.as_bytes().to_vec();
        for path in &requirements {
            wanted.extend(std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?);
        }
        let wanted = sha256(&wanted);
        let folder = suite.root.join("target").join("verification").join("python");
        let program = folder.join("bin").join("python3");
        let stamp = folder.join("requirements.sha256");
        if std::fs::read_to_string(&stamp).ok().as_deref() != Some(wanted.as_str()) {
            eprintln!("making a Python environment in {} …", folder.display());
            let mut install = pip(&program);
            for path in &requirements {
                install.arg("--requirement").arg(path);
            }
            run(Command::new(INTERPRETER).args(["-m", "venv", "--clear"]).arg(&folder))
                .and_then(|_| run(&mut install))
                .map_err(|error| format!("{error}\n{REMEDY}"))?;
            std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
        }
        let facts = facts(&program, requirements.iter().map(PathBuf::as_path))?;
        Ok(Self { program, facts })
    }

    /// The facts with the packages that a further file pins, which are installed where they are not there. What is there stays
    /// as it is, and what cannot be had is told and left to whoever imports it.
    ///
    /// # Errors
    /// Where the file cannot be read or the interpreter cannot be started.
    pub fn add(&self, suite: &Suite, further: &Path) -> Result<Facts, Failure> {
        let text = std::fs::read_to_string(further).map_err(|e| format!("{}: {e}", further.display()))?;
        let pinned = requirements(suite);
        let stamp = self.program.with_file_name("further.sha256");
        let wanted = sha256(text.as_bytes());
        if std::fs::read_to_string(&stamp).ok().as_deref() != Some(wanted.as_str()) {
            eprintln!("installing what {} pins …", further.display());
            let mut all = true;
            for package in text.lines().filter(|line| line.contains("==")) {
                let mut install = pip(&self.program);
                for path in &pinned {
                    install.arg("--constraint").arg(path);
                }
                if let Err(error) = run(install.arg(package)) {
                    eprintln!("{error}");
                    all = false;
                }
            }
            if all {
                std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
            }
        }
        facts(&self.program, pinned.iter().map(PathBuf::as_path).chain([further]))
    }

    /// What a script prints. Its own messages go to the terminal.
    ///
    /// # Errors
    /// Where it cannot be started or fails.
    pub fn run(&self, script: &Path, arguments: &[String]) -> Result<String, Failure> {
        let mut command = Command::new(&self.program);
        command.arg(script).args(arguments).stderr(Stdio::inherit());
        Ok(String::from_utf8(run(&mut command)?.stdout)?)
    }
}

/// What pins the packages that every part of the suite needs.
fn requirements(suite: &Suite) -> [PathBuf; 2] {
    [suite.oracles_folder(), suite.peers_folder()].map(|folder| folder.join("requirements.txt"))
}

fn pip(program: &Path) -> Command {
    let mut install = Command::new(program);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    install
}

fn facts<'a>(program: &Path, requirements: impl Iterator<Item = &'a Path>) -> Result<Facts, Failure> {
    let output = run(Command::new(program).args(["-c", FACTS]).args(requirements))?;
    Ok(serde_json::from_slice(&output.stdout)?)
}

fn run(command: &mut Command) -> Result<Output, Failure> {
    let name = format!("{command:?}");
    let output =
        command.stdin(Stdio::null()).output().map_err(|e| format!("{name} cannot be started: {e}"))?;
    if output.status.success() {
        Ok(output)
    } else {
        Err(format!("{name} failed ({}):\n{}", output.status, String::from_utf8_lossy(&output.stderr)).into())
    }
}
