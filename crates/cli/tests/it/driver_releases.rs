//! The scripts of `ci/adapters/` that fetch releases of drivers, tested with stand-ins for `npm` and
//! `apt-get`, so that no test reaches a registry.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const BINARY: &str = env!("CARGO_BIN_EXE_etalon");

/// Packs a release of the requested version with SwiftShader and ANGLE; `STUBS` and `BARE` leave parts out.
/// `brotli` only copies here.
const NPM: &str = r#"
echo "$@" >>"$CALLS"
version=${@: -1}
version=${version##*@}
case $version in
    66) echo "npm error notarget No matching version found" >&2; exit 1 ;;
    123) version=123.0.1 ;;
esac
work=$(mktemp -d)
mkdir -p "$work/package/bin" "$work/tar"
if [ -z "${BARE:-}" ]; then
    echo swiftshader >"$work/tar/libvk_swiftshader.so"
    echo "$version" >"$work/tar/vk_swiftshader_icd.json"
fi
size=2097152
[ -z "${STUBS:-}" ] || size=300
truncate -s "$size" "$work/tar/libGLESv2.so"
echo egl >"$work/tar/libEGL.so"
echo loader >"$work/tar/libvulkan.so.1"
tar -cf "$work/package/bin/swiftshader.tar.br" -C "$work/tar" .
tar -czf "sparticuz-chromium-$version.tgz" -C "$work" package
rm -r "$work"
"#;

/// A suite with two packages; one has the old folder names, as in older suites.
const APT: &str = r#"
for word in "$@"; do
    case $word in Dir::Cache=*) cache=${word#*=} ;; Dir::Etc::SourceList=*) list=${word#*=} ;; esac
done
suite=$(cut -d' ' -f4 "$list")
case $suite in sid) version=26.2.6-1 ;; *) version=25.0.7-2 ;; esac
case "$*" in
    *update) [ "$suite" != nowhere ] || { echo "E: no Release file" >&2; exit 100; } ;;
    *--print-uris*)
        echo "'http://deb.example/mesa-vulkan-drivers_${version}_amd64.deb' mesa-vulkan-drivers_${version}_amd64.deb 1 SHA256:0" ;;
    *--download-only*)
        echo "$suite" >>"$CALLS"
        echo "$version" >"$cache/archives/mesa-vulkan-drivers_${version}_amd64.deb"
        echo libc >"$cache/archives/libc6.deb" ;;
    *) exit 100 ;;
esac
"#;
const DPKG: &str = r#"
mkdir -p "$3/usr/lib/here" "$3/usr/lib64"
cp "$2" "$3/usr/lib/here/"
case $2 in *mesa*) echo lvp >"$3/usr/lib/here/libvulkan_lvp.so" ;; esac
"#;

fn script(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap().join("ci/adapters").join(name)
}

/// A folder with the stand-ins first on the search path, and a log of their calls.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let place = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        fs::create_dir(place.path("bin")).unwrap();
        let programs = [
            ("npm", NPM),
            ("brotli", "cat"),
            ("apt-get", APT),
            ("dpkg-deb", DPKG),
        ];
        for (name, text) in programs {
            let program = place.path("bin").join(name);
            fs::write(
                &program,
                format!("#!/usr/bin/env bash\nset -euo pipefail\n{text}\n"),
            )
            .unwrap();
            fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run_with(&self, name: &str, args: &[&str], variables: &[&str]) -> Output {
        let search = std::env::var("PATH").unwrap();
        Command::new(script(name))
            .args(args)
            .current_dir(self.folder.path())
            .env("PATH", format!("{}:{search}", self.path("bin").display()))
            .env("CALLS", self.path("calls"))
            .envs(variables.iter().map(|name| (name, "1")))
            .output()
            .unwrap()
    }

    fn run(&self, name: &str, args: &[&str]) -> Output {
        self.run_with(name, args, &[])
    }

    fn calls(&self) -> usize {
        fs::read_to_string(self.path("calls")).map_or(0, |text| text.lines().count())
    }

    fn files(&self, name: &str) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.path(name))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn version(&self, name: &str) -> String {
        let text = fs::read_to_string(self.path(name).join("version")).unwrap();
        text.trim_end().to_owned()
    }
}

/// Asserts the exit code, and that the output contains all of these texts.
fn says(output: &Output, code: i32, words: &[&str]) {
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(output.status.code(), Some(code), "{text}");
    for word in words {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn a_release_of_chromium_is_unpacked_once() {
    let place = Place::new();
    says(
        &place.run("chromium", &["123", "new"]),
        0,
        &["SwiftShader ANGLE of Chromium 123.0.1", "/new "],
    );
    let swiftshader = ["libvk_swiftshader.so", "version", "vk_swiftshader_icd.json"];
    // ANGLE loads Vulkan only from its own folder.
    let angle = ["libEGL.so", "libGLESv2.so", "libvulkan.so.1"];
    let mut expected = [angle, swiftshader].concat();
    expected.sort_unstable();
    assert_eq!(place.files("new"), expected);
    assert_eq!(place.version("new"), "123.0.1");
    says(&place.run("chromium", &["123.0.1", "new"]), 0, &["already"]);
    assert_eq!(place.calls(), 1);

    // Fetching another release removes everything of this one, and stubs do not count as ANGLE.
    says(
        &place.run_with("chromium", &["153.0.0", "new"], &["STUBS"]),
        0,
        &["SwiftShader of Chromium 153.0.0", "has no ANGLE"],
    );
    assert_eq!(place.files("new"), swiftshader);
    assert_eq!(place.version("new"), "153.0.0");
    says(
        &place.run_with("chromium", &["92.0.0", "new"], &["BARE"]),
        0,
        &["ANGLE of Chromium 92.0.0", "has no SwiftShader"],
    );
    assert_eq!(place.files("new"), [&angle[..], &["version"]].concat());

    says(&place.run("angle", &["angle"]), 0, &["ETALON_ANGLE="]);
    assert_eq!(place.files("angle"), expected);
    assert_eq!(place.version("angle"), "123.0.1");
}

#[test]
fn a_missing_release_of_chromium_is_an_error() {
    let place = Place::new();
    for wrong in [&[][..], &["123"], &["123", "new", "more"]] {
        says(&place.run("chromium", wrong), 64, &["usage"]);
    }
    for wrong in ["latest", "1.2", "123.0.1-next", "../x", ""] {
        says(
            &place.run("chromium", &[wrong, "new"]),
            64,
            &["is no version"],
        );
    }
    assert_eq!(place.calls(), 0);
    let words = ["No matching version", "@sparticuz/chromium@66"];
    says(&place.run("chromium", &["66", "new"]), 1, &words);
    assert!(!place.path("new").exists());

    // Earlier files stay unchanged.
    says(&place.run("chromium", &["123", "new"]), 0, &[]);
    says(&place.run("chromium", &["66", "new"]), 1, &words);
    assert_eq!(place.version("new"), "123.0.1");
    says(
        &place.run_with("chromium", &["92", "new"], &["BARE", "STUBS"]),
        1,
        &["neither SwiftShader nor ANGLE"],
    );
    assert_eq!(place.version("new"), "123.0.1");
}

#[test]
fn a_suite_of_debian_is_unpacked_once() {
    let place = Place::new();
    says(
        &place.run("mesa", &["sid", "newest"]),
        0,
        &["Mesa 26.2.6-1 of sid", "inside"],
    );
    assert_eq!(place.version("newest"), "26.2.6-1");
    let read = |name: &str| fs::read_to_string(place.path("newest").join(name));
    assert_eq!(read("lib/here/libc6.deb").unwrap(), "libc\n");
    assert_eq!(read("usr/lib/mesa/libvulkan_lvp.so").unwrap(), "lvp\n");
    assert_eq!(
        place.files("newest"),
        [
            "dev", "lib", "lib64", "proc", "sys", "tmp", "usr", "version"
        ]
    );
    says(&place.run("mesa", &["sid", "newest"]), 0, &["already"]);
    assert_eq!(place.calls(), 1);
    // What bundles use was left out then.
    let bundles = ["--bundles", "sid", "newest"];
    says(&place.run("mesa", &bundles), 0, &["Mesa 26.2.6-1 of sid"]);
    let compiler = fs::read_link(place.path("newest").join("usr/bin/cc"));
    assert_eq!(compiler.unwrap(), Path::new("gcc"));
    says(&place.run("mesa", &bundles), 0, &["already"]);
    says(
        &place.run("mesa", &["trixie", "newest"]),
        0,
        &["Mesa 25.0.7-2 of trixie"],
    );
    assert_eq!(place.version("newest"), "25.0.7-2");
    assert!(
        read("lib/here/mesa-vulkan-drivers_26.2.6-1_amd64.deb").is_err(),
        "a file of the other suite stayed"
    );
}

#[test]
fn a_missing_suite_of_debian_is_an_error() {
    let place = Place::new();
    for wrong in [&[][..], &["sid"], &["sid", "new", "more"]] {
        says(&place.run("mesa", wrong), 64, &["usage"]);
    }
    for wrong in ["Sid", "26.2", "sid main", "../x"] {
        says(&place.run("mesa", &[wrong, "new"]), 64, &["is no suite"]);
    }
    says(
        &place.run("mesa", &["nowhere", "new"]),
        1,
        &["no Release file", "suite nowhere does not exist"],
    );
    assert!(!place.path("new").exists());
    // A foreign folder is not replaced.
    fs::create_dir(place.path("mine")).unwrap();
    fs::write(place.path("mine/notes"), "x").unwrap();
    says(&place.run("mesa", &["sid", "mine"]), 1, &["not empty"]);
    assert_eq!(place.files("mine"), ["notes"]);
    assert_eq!(place.calls(), 0);
}

#[test]
fn a_command_runs_inside_a_folder_of_libraries() {
    let place = Place::new();
    says(&place.run("inside", &["x"]), 64, &["usage"]);
    fs::create_dir(place.path("mine")).unwrap();
    says(
        &place.run("inside", &["mine", BINARY, "list"]),
        64,
        &["ci/adapters/mesa"],
    );
    fs::write(place.path("mine/version"), "1\n").unwrap();
    says(
        &place.run("inside", &["mine", "no-such-command"]),
        64,
        &["no-such-command"],
    );

    // The system can refuse a namespace, as in some containers. Then nothing can run inside, and the script
    // must report that.
    let mut may = Command::new("unshare");
    may.args(["--mount", "--user", "--map-root-user", "true"]);
    let mut may_as_root = Command::new("unshare");
    may_as_root.args(["--mount", "true"]);
    let allowed = [may, may_as_root]
        .iter_mut()
        .any(|c| c.output().is_ok_and(|o| o.status.success()));
    let libraries = Command::new("ldd").arg(BINARY).output().unwrap();
    for word in String::from_utf8(libraries.stdout)
        .unwrap()
        .split_whitespace()
        .filter(|word| word.starts_with('/'))
    {
        let to = place.path("mine").join(word.trim_start_matches('/'));
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(word, to).unwrap();
    }
    let list = ["list", "cull/*"];
    let outside = Command::new(BINARY).args(list).output().unwrap();
    let inside = place.run("inside", &[&["mine", BINARY], &list[..]].concat());
    if !allowed {
        says(&inside, 1, &["unshare"]);
        return;
    }
    says(&inside, 0, &[]);
    assert_eq!(inside.stdout, outside.stdout);
    assert!(outside.stdout.len() > 100, "no case is listed");

    // Its output is written outside, to the folder where it was started.
    let run = ["run", "cull/points/*", "--adapter", "cpu", "--out", "runs"];
    says(
        &place.run("inside", &[&["mine", BINARY], &run[..]].concat()),
        0,
        &[],
    );
    assert!(place.path("runs/run.jsonl").exists());
}

#[test]
fn files_of_adapters_say_how_to_get_their_drivers() {
    for (name, variable, fetched_by) in [
        ("chromium.json", "ETALON_CHROMIUM_FOLDER", "chromium"),
        ("mesa-25.json", "ETALON_MESA_25", "mesa-backports"),
    ] {
        let output = Command::new(BINARY)
            .arg("adapters")
            .arg("--adapters")
            .arg(script(name))
            .env_remove(variable)
            .output()
            .unwrap();
        let remedy = format!("ci/adapters/{fetched_by}");
        says(&output, 64, &[variable, &remedy]);
        assert!(script(fetched_by).exists(), "{fetched_by}");
    }
}
