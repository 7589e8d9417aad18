//! The Python that runs oracle scripts: a virtual environment of its own with pinned packages.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use ancf_check::{Suite, reference::sha256};
use serde::Deserialize;

use crate::Failure;

/// A virtual environment under `target/`, made on first use.
pub struct Python {
    program: PathBuf,
    /// What it is.
    pub facts: Facts,
}

/// What provenance says of the interpreter and the machine.
#[derive(Clone, Debug, Deserialize)]
pub struct Facts {
    /// Today, by the system's clock.
    pub date: String,
    /// Machine and system.
    pub platform: String,
    /// Interpreter and packages with their versions.
    pub tool: String,
}

const FACTS: &str = r#"
import datetime, importlib.metadata, json, platform, sys
packages = [line.split("==")[0].strip() for line in open(sys.argv[1]) if "==" in line]
tool = [f"Python {platform.python_version()}"] + [f"{p} {importlib.metadata.version(p)}" for p in packages]
print(json.dumps({
    "date": datetime.date.today().isoformat(),
    "platform": f"{platform.system()} {platform.machine()}, {' '.join(platform.libc_ver())}".strip(", "),
    "tool": ", ".join(tool),
}))
"#;

impl Python {
    /// The environment with the packages of `verification/oracles/requirements.txt`; installs them where they are
    /// not there or no longer the same.
    pub fn prepare(suite: &Suite) -> Result<Self, Failure> {
        let requirements = suite.oracles_folder().join("requirements.txt");
        let wanted =
            sha256(&std::fs::read(&requirements).map_err(|e| format!("{}: {e}", requirements.display()))?);
        let folder = suite.root.join("target").join("verification").join("python");
        let program = folder.join("bin").join("python3");
        let stamp = folder.join("requirements.sha256");
        if std::fs::read_to_string(&stamp).ok().as_deref() != Some(wanted.as_str()) {
            eprintln!("making a Python environment in {} …", folder.display());
            run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder)).map_err(|error| {
                format!("{error}\nThe oracles need python3 with its venv module (Debian: apt install python3-venv).")
            })?;
            run(Command::new(&program)
                .args(["-m", "pip", "install", "--quiet", "--requirement"])
                .arg(&requirements))?;
            std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
        }
        let output = run(Command::new(&program).args(["-c", FACTS]).arg(&requirements))?;
        let facts = serde_json::from_slice(&output.stdout)?;
        Ok(Self { program, facts })
    }

    /// What a script prints. Its own messages go to the terminal.
    pub fn run(&self, script: &Path, arguments: &[String]) -> Result<String, Failure> {
        let mut command = Command::new(&self.program);
        command.arg(script).args(arguments).stderr(Stdio::inherit());
        Ok(String::from_utf8(run(&mut command)?.stdout)?)
    }
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
