#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Fetches the libraries of the MeshLab of another Debian release into the user's cache, for library_hosts.py:
#
#   fetch_libraries.sh RELEASE SUITE FOLDER    RELEASE: 2022.02 or 2025.07, SUITE: searched for it first
#
# apt, with a separate configuration, finds the packages on this system's mirror and checks the archive's signature and
# the checksums. They are unpacked, not installed; no root rights are needed. Takes 200 MB on disk. Prints nothing if
# the folder is complete.
set -euo pipefail
release="$1" folder="$3"
[ -e "$folder.complete" ] && exit 0
# Tests run side by side; one fetches, the others wait.
mkdir -p "$(dirname "$folder")"
exec 9> "$folder.lock"
flock 9
[ -e "$folder.complete" ] && exit 0
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"

fail() {
    echo "$1" >&2
    exit 1
}

mirror="$("$here/../../filter_neuralmesh/sources/debian_mirror.sh")"
[ -n "$mirror" ] || fail "apt knows no Debian mirror to fetch MeshLab $release from: run apt-get update, as root."

rm -rf "$folder" "$folder.apt"
mkdir -p "$folder" "$folder.apt"
cd "$folder.apt"
echo "Fetching the libraries of MeshLab $release from $mirror"

# apt with a configuration of its own, as if no package were installed.
private_apt() {
    apt-get -q -q -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::PreferencesParts=/dev/null -o Dir::Etc::Preferences=/dev/null \
        -o Dir::State="$PWD/state" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD/cache" \
        -o APT::Architecture=amd64 -o APT::Architectures=amd64 -o APT::Sandbox::User=root \
        -o Acquire::Check-Valid-Until=false -o Acquire::Languages=none "$@"
}

# Writes the packages that an installation from a suite would fetch to the file uris. Fails unless they have the release.
offers() {
    rm -rf state cache
    mkdir -p state/lists/partial cache/archives/partial
    echo "deb [signed-by=$keys] $mirror $1 main" > sources.list
    # experimental is incomplete without sid.
    [ "$1" != experimental ] || echo "deb [signed-by=$keys] $mirror sid main" >> sources.list
    # Check-Valid-Until is off because the release file of a mirror that lags behind may be past its date.
    private_apt update > log 2>&1 &&
        private_apt install --print-uris --no-install-recommends --target-release "$1" meshlab > uris 2> log &&
        grep -q "meshlab_$release" uris
}

keys=/usr/share/keyrings/debian-archive-keyring.gpg
[ -e "$keys" ] || fail "There is no $keys: install the Debian package debian-archive-keyring."
touch status
found=""
# Which suite has the wanted MeshLab changes over the years.
for suite in "$2" trixie forky sid experimental; do
    if [ -z "$found" ] && offers "$suite"; then found="$suite"; fi
done
[ -n "$found" ] || fail "No suite of $mirror has a MeshLab $release that can be installed: name another mirror, or a snapshot of \
that time, in DEBIAN_MIRROR and run this again."

# Only libraries are unpacked; programs and drivers are not run.
sed "s/'//g" uris | awk '$2 ~ /^(lib|meshlab_)/ && $2 !~ /^(libllvm|libgl1-mesa|libperl|libsystemd)/ {print $1, $2, $4}' > wanted
while read -r uri file sum; do
    /usr/lib/apt/apt-helper -qq download-file "$uri" "cache/archives/$file" "$sum" 2> log ||
        fail "$file could not be fetched ($(tail -n 1 log)). Check the network and run this again."
    dpkg --extract "cache/archives/$file" "$folder"
done < wanted
rm -rf "$folder.apt"
touch "$folder.complete"
