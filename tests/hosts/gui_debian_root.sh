#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Makes a root directory of another Debian release with its MeshLab, for GUI tests:
#
#   gui_debian_root.sh RELEASE SUITE FOLDER      RELEASE: 2022.02 or 2025.07, SUITE: searched for it first
#
# Takes 800 MB and two minutes; a complete folder is not changed. Needs root and the package debootstrap. Packages come
# from this system's mirror, or from $DEBIAN_MIRROR.
set -eu

release=$1
folder=$3
here=$(cd "$(dirname "$0")" && pwd)
complete="$folder.complete"
if [ -e "$complete" ]; then exit 0; fi
if [ "$(id -u)" != 0 ]; then
    echo "gui_debian_root: needs root, as debootstrap and chroot do." >&2
    exit 1
fi
if ! command -v debootstrap >/dev/null; then
    echo "gui_debian_root: install the Debian package debootstrap first." >&2
    exit 1
fi

mirror=$("$here/../../filter_neuralmesh/sources/debian_mirror.sh")
if [ -z "$mirror" ]; then
    echo "gui_debian_root: no Debian mirror in apt's sources; name one in DEBIAN_MIRROR." >&2
    exit 1
fi

if [ ! -e "$folder.debootstrapped" ]; then
    # A half-made folder with this mark was left by an interrupted run; any other folder is not ours.
    if [ -e "$folder.started" ]; then
        # The interrupted run may have left /proc and /dev mounted there.
        if grep -q " $folder/" /proc/mounts; then
            echo "gui_debian_root: something is mounted in $folder; unmount it first: grep $folder /proc/mounts" >&2
            exit 1
        fi
        rm -rf --one-file-system "$folder"
    elif [ -e "$folder" ]; then
        echo "gui_debian_root: $folder exists and was not made by this script; choose another folder." >&2
        exit 1
    fi
    mkdir -p "$folder.apt"
    cd "$folder.apt"
    . "$here/private_apt.sh"
    choose_suite "$release" "$2"
    cd /
    rm -rf "$folder.apt"
    touch "$folder.started"
    debootstrap --variant=minbase "$suite" "$folder" "$mirror"
    touch "$folder.debootstrapped"
fi
# Libraries that MeshLab's plugins need and its package does not depend on; without them MeshLab starts with a list of
# plugins that it could not load. Their names differ between releases, so unknown ones are skipped.
cat >"$folder/tmp/install_meshlab.sh" <<'INSTALL'
set -eu
export DEBIAN_FRONTEND=noninteractive
# The release file of a mirror that lags behind may be past its date.
apt-get -o Acquire::Check-Valid-Until=false update
packages=meshlab
for package in libgomp1 libmuparser2v5 libqhull-r8.0 lib3ds-1-3 libopenctm1 libmpfr6 libxerces-c3.2; do
    if apt-cache show "$package" >/dev/null 2>&1; then packages="$packages $package"; fi
done
apt-get install -y --no-install-recommends $packages
apt-get clean
INSTALL
chroot "$folder" sh /tmp/install_meshlab.sh
touch "$complete"
