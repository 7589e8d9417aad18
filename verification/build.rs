//! Links Python so that what runs is the interpreter that was found at build time, and says which
//! that is.

use std::path::Path;

fn main() {
    let python = pyo3_build_config::get();
    // Without this the program may load another libpython than the one it was linked with.
    pyo3_build_config::add_libpython_rpath_link_args();

    // A linker's complaint about a missing -lpython names no remedy.
    let (folder, name) = (python.lib_dir().unwrap_or_default(), python.lib_name().unwrap_or_default());
    let library = Path::new(folder).join(format!("lib{name}.so"));
    if cfg!(target_os = "linux") && !library.exists() {
        println!(
            "cargo::error=the verification suite embeds Python {}, but there is no {}; install what developers need \
             (Debian: apt install python3-dev python3-venv), or name another interpreter that has its shared library \
             in the environment variable PYO3_PYTHON",
            python.version(),
            library.display(),
        );
    }
    println!("cargo::rustc-env=ANCF_PYTHON={}", python.executable().unwrap_or("python3"));
    println!("cargo::rerun-if-changed=build.rs");
}
