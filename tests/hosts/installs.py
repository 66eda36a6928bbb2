# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Each package in a bare Debian: installed by one command, used by a second, the mesh checked. Also the same bytes from
two builds, and lintian. Started by `./run.sh release`; needs root, debootstrap, lintian and some 2 GB.

The bare systems are made once by debootstrap, in the user's cache, and copied for each test. What cannot run here is
skipped with the reason."""

import os
import shutil
import subprocess
from pathlib import Path

import library_hosts
import programs
from check_mesh import check_mesh
import pytest

ROOT = Path(__file__).resolve().parents[2]
ROOTS = Path(os.environ.get("NEURAL_MESH_ROOTS") or library_hosts.CACHE / "roots")
MIRROR = ROOT / "filter_neuralmesh/sources/debian_mirror.sh"
LIBRARIES = "/usr/lib/x86_64-linux-gnu"
# What a user of the system has before installing the package.
APT = "apt-get -q -q -o Acquire::Check-Valid-Until=false"


def run(*command, **options):
    return programs.output_of(*command, stderr=subprocess.STDOUT, errors="replace", **options)


@pytest.fixture(scope="session")
def dist(build, tmp_path_factory):
    folder = tmp_path_factory.mktemp("packages") / "dist"
    print(run("/usr/bin/python3", ROOT / "packaging/package.py", "--plugins", build / "plugins", "--out", folder))
    return folder


def bare_system(suite):
    """The folder of a bare system of that release of Debian, made on first use."""
    if os.geteuid() != 0:
        pytest.skip("debootstrap and chroot need root")
    if not shutil.which("debootstrap"):
        pytest.skip("the Debian package debootstrap is not installed")
    folder = ROOTS / f"bare-{suite}"
    if not Path(f"{folder}.complete").exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        made = programs.run("debootstrap", "--variant=minbase", suite, folder, programs.output_of(MIRROR).strip(),
                            stderr=subprocess.STDOUT)
        if made.returncode != 0:
            pytest.skip(f"debootstrap could not make {suite}: {made.stdout.splitlines()[-1]}")
        Path(f"{folder}.complete").touch()
    return folder


class System:
    """A copy of a bare system, with the cloud and the packages in /root."""

    def __init__(self, suite, folder, cloud, dist):
        self.folder = folder
        run("cp", "-a", bare_system(suite), folder)
        for file in (cloud, *dist.iterdir()):
            shutil.copy(file, folder / "root" / file.name)
        shutil.copy("/etc/resolv.conf", folder / "etc/resolv.conf")

    def prepare(self, packages):
        """Installs what the test needs and the package does not."""
        self.run(f"{APT} update && {APT} install -y --no-install-recommends {packages}")

    def run(self, command):
        """Runs a shell command in the system, in /root, with this system's /dev and /proc in a private namespace."""
        enter = 'mount --rbind /dev "$0/dev" && mount -t proc proc "$0/proc" && exec chroot "$0" sh -c "cd /root && $1"'
        return run("unshare", "--mount", "sh", "-c", enter, self.folder, command,
                   env={"PATH": "/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "HOME": "/root",
                        "LC_ALL": "C.UTF-8", "QT_QPA_PLATFORM": "offscreen"})


@pytest.fixture
def system(tmp_path, model, dist):
    """system(suite) -> a System."""
    def make(suite):
        cloud = tmp_path / "cloud.ply"
        shutil.copy(model("sphere")[0], cloud)
        return System(suite, tmp_path / "root", cloud, dist)
    yield make
    shutil.rmtree(tmp_path / "root", ignore_errors=True)


def check(build, mesh, vertices):
    found = check_mesh(mesh)
    assert found["vertices"] == vertices and found["watertight"] and found["oriented"] and found["genus"] == 0


def let_pip_download(debian):
    """As this system's pip does."""
    for config in ("/etc/pip.conf", "/etc/ssl/certs/ca-certificates.crt"):
        if Path(config).exists():
            shutil.copy(config, f"{debian.folder}{config}")


@pytest.mark.parametrize("packages, others, blocks", [("", "", 1), ("libgl1 libopengl0", "pymeshlab==2025.7.*", 1),
                                                      ("libgl1 libegl1 libgomp1 libx11-6 libusb-1.0-0", "open3d trimesh scipy", 99)])
def test_the_wheel_from_numpy(system, packages, others, blocks):
    """The first block of the page as written, also beside pymeshlab; all blocks beside open3d and trimesh."""
    debian = system("bookworm")
    debian.prepare(f"python3-venv ca-certificates {packages}")
    let_pip_download(debian)
    for file in ("tests/hosts/library_page.py", "filter_neuralmesh/docs/python.md"):
        (debian.folder / "root" / file).parent.mkdir(parents=True)
        shutil.copy(ROOT / file, debian.folder / "root" / file)
    debian.run(f"python3 -m venv own && own/bin/pip install --quiet neural_mesh-*manylinux*x86_64.whl {others}")
    assert ", 0 printed something else" in debian.run(f"own/bin/python tests/hosts/library_page.py {blocks}")


def test_the_wheel(build, system):
    debian = system("bookworm")
    debian.prepare("python3-pip python3-venv ca-certificates libgl1 libopengl0")
    let_pip_download(debian)
    debian.run("pip install --quiet --break-system-packages pymeshlab==2025.7.* neural_mesh-*manylinux*x86_64.whl")
    debian.run("neural-mesh cloud.ply mesh.ply target_vertices=300")
    check(build, debian.folder / "root/mesh.ply", 300)


def test_the_package_for_debian_12(build, system):
    debian = system("bookworm")
    debian.prepare("xauth xvfb libgl1-mesa-dri")
    debian.run(f"{APT} install -y --no-install-recommends ./meshlab-plugin-neuralmesh_*deb12u1_amd64.deb")
    debian.run("env -u QT_QPA_PLATFORM xvfb-run -a meshlabserver -i cloud.ply -o mesh.ply "
               "-s /usr/share/doc/meshlab-plugin-neuralmesh/examples/reconstruct.mlx")
    check(build, debian.folder / "root/mesh.ply", 10000)


def use_library(build, debian, release, plugin):
    """Runs the filter in the system's MeshLab library, since these releases of Debian have no meshlabserver."""
    for file in ("run_library_host", f"liblibrary_host_{release}.so"):
        shutil.copy(build / "tests" / file, debian.folder / "root" / file)
    debian.run(f"./run_library_host {LIBRARIES}/meshlab/libmeshlab-common.so ./liblibrary_host_{release}.so "
               f"{plugin} mesh.off")
    check(build, debian.folder / "root/mesh.off", 100)


def test_the_package_for_debian_13(build, system):
    debian = system("trixie")
    debian.prepare("ca-certificates")
    debian.run(f"{APT} install -y --no-install-recommends ./meshlab-plugin-neuralmesh_*deb13u1_amd64.deb")
    use_library(build, debian, "2022.02", f"{LIBRARIES}/meshlab/plugins/libfilter_neuralmesh.so")


@pytest.mark.parametrize("release, suite", library_hosts.SUITES.items())
def test_the_archives(build, system, release, suite):
    debian = system(suite)
    debian.prepare("meshlab")
    debian.run(f"tar -xzf neural-mesh-*-meshlab-{release}-float-linux-x86_64.tar.gz --strip-components=1")
    use_library(build, debian, release, "./libfilter_neuralmesh.so")


def test_lintian_has_nothing_to_say(dist):
    if not shutil.which("lintian"):
        pytest.skip("the Debian package lintian is not installed")
    for path in dist.glob("*.deb"):
        assert run("lintian", "--allow-root", path) == ""


def test_two_builds_of_the_commit_give_the_same_files(tmp_path):
    """In folders of different names, since a path in a file would show."""
    folders = [tmp_path / name / "source" for name in ("one", "another_folder")]
    run("git", "clone", "--quiet", ROOT, folders[0])
    run("git", "clone", "--quiet", *folders)  # not from ROOT, which may get a commit during the first build
    for folder in folders:
        (folder / "build").mkdir()
        (folder / "build/venv").symlink_to(ROOT / "build/venv")
        run(folder / "run.sh", "package", env=dict(os.environ, CCACHE_DISABLE="1"))
    sums = [(folder / "dist/SHA256SUMS").read_text() for folder in folders]
    assert sums[0] == sums[1]
