#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Puts the libraries of a MeshLab of another Debian release into the user's cache, for library_hosts.py:
#
#   fetch_libraries.sh RELEASE SUITE FOLDER    RELEASE: 2022.02 or 2025.07, SUITE: trixie or sid
#
# The packages are those of the mirror this system installs from, found by apt under a configuration of its own,
# checked against the archive's signature and sums, and unpacked; nothing is installed. No root rights are needed.
# About 200 MB on disk. Prints nothing when all is there already.
set -euo pipefail
release="$1" suite="$2" folder="$3"
[ -e "$folder.complete" ] && exit 0
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"

fail() {
    echo "$1" >&2
    exit 1
}

keys=/usr/share/keyrings/debian-archive-keyring.gpg
[ -e "$keys" ] || fail "There is no $keys: install the Debian package debian-archive-keyring."
mirror="$("$here/../../filter_neuralmesh/debian_mirror.sh")"
[ -n "$mirror" ] || fail "apt knows no Debian mirror to fetch MeshLab $release from: run apt-get update, as root."

rm -rf "$folder" "$folder.apt"
mkdir -p "$folder" "$folder.apt/state/lists/partial" "$folder.apt/cache/archives/partial"
cd "$folder.apt"
echo "deb [signed-by=$keys] $mirror $suite main" > sources.list
touch status  # as if nothing were installed
private_apt() {
    apt-get -q -q -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::PreferencesParts=/dev/null -o Dir::Etc::Preferences=/dev/null \
        -o Dir::State="$PWD/state" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD/cache" \
        -o APT::Architecture=amd64 -o APT::Architectures=amd64 -o APT::Sandbox::User=root \
        -o Acquire::Check-Valid-Until=false -o Acquire::Languages=none "$@"
}

echo "Fetching the libraries of MeshLab $release from $mirror"
# A mirror that lags behind serves a release file past its date, hence Check-Valid-Until above.
private_apt update > log 2>&1 || fail "The list of packages of Debian $suite could not be fetched ($(tail -n 1 log))."
private_apt install --print-uris --no-install-recommends meshlab > uris 2> log ||
    fail "Debian $suite has no MeshLab that can be installed ($(tail -n 1 log))."
grep -q "meshlab_$release" uris || fail "Debian $suite has another MeshLab than $release by now: $(grep -o 'meshlab_[^ ]*' uris | tail -n 1)."

# Libraries alone: programs and drivers are not run.
sed "s/'//g" uris | awk '$2 ~ /^(lib|meshlab_)/ && $2 !~ /^(libllvm|libgl1-mesa|libperl|libsystemd)/ {print $1, $2, $4}' > wanted
while read -r uri file sum; do
    /usr/lib/apt/apt-helper -qq download-file "$uri" "cache/archives/$file" "$sum" 2> log ||
        fail "$file could not be fetched ($(tail -n 1 log)). Check the network and run this again."
    dpkg --extract "cache/archives/$file" "$folder"
done < wanted
rm -rf "$folder.apt"
touch "$folder.complete"
