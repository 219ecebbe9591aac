//! Points rosrust at the message definitions that are kept in `msg/`, so that the build needs no ROS installation.
use std::path::{Path, PathBuf};
use std::{env, fs};

fn watch(folder: &Path) {
    println!("cargo:rerun-if-changed={}", folder.display());
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            watch(&path);
        } else {
            println!("cargo:rerun-if-changed={}", path.display());
        }
    }
}

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let messages = root.join("msg");
    watch(&messages);
    println!("cargo:rustc-env=ROSRUST_MSG_PATH={}", messages.display());
}
