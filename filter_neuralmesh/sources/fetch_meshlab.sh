#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Downloads Debian's source tarballs of the three MeshLab releases from this system's mirror, checks their sums
# and unpacks them in the user's cache folder. Prints nothing if they are there already.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
cache="${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh"
releases="
2020.09 meshlab_2020.09+dfsg1.orig.tar.xz d6715352ff65caffdec0292858d4263eb0c3cbbf3b1e5c2e2bab218e3f234630
2022.02 meshlab_2022.02+dfsg1.orig.tar.xz 11da26ec46c3fbbbc806d410a3221542ec21ec13fdcc55d624304600029435fd
2025.07 meshlab_2025.07~dfsg.orig.tar.xz d22c98d362f2a284e481af8dbfc272b2222f5b9c67b3cf8bec57d1c3161886f4
"

fail() {
    echo "$1" >&2
    echo "Or build with MeshLab sources that you have:" >&2
    echo "  cmake -S . -B build/own -DMESHLAB_SOURCE_DIR=DIR && cmake --build build/own" >&2
    exit 1
}

holds() { echo "$2  $1" | sha256sum --check --status 2> /dev/null; }

fetch() {
    local tarball="$1" sum="$2" uri
    uri="$("$here/debian_mirror.sh")"
    if [ -z "$uri" ]; then
        fail "apt knows no Debian mirror to fetch MeshLab's sources from: run apt-get update on a Debian system."
    fi
    echo "Fetching $tarball from $uri"
    rm -f "$cache/$tarball.part"
    # apt's downloader uses apt's proxy settings.
    /usr/lib/apt/apt-helper -qq download-file "${uri%/}/pool/main/m/meshlab/$tarball" \
        "$cache/$tarball.part" "SHA256:$sum" 2> "$cache/fetch.log" ||
        fail "$tarball could not be fetched ($(tail -n 1 "$cache/fetch.log")). Check the network and run this again."
    mv "$cache/$tarball.part" "$cache/$tarball"
}

mkdir -p "$cache"
while read -r version tarball sum; do
    [ -n "$version" ] || continue
    [ -e "$cache/meshlab-$version/ML_VERSION" ] && continue
    holds "$cache/$tarball" "$sum" || fetch "$tarball" "$sum"
    holds "$cache/$tarball" "$sum" || fail "$tarball does not have the expected sum; remove it from $cache."
    echo "Unpacking $tarball"
    # Unpack beside and rename, so that an interrupted run leaves no incomplete tree.
    rm -rf "$cache/unpacking"
    mkdir "$cache/unpacking"
    tar -xf "$cache/$tarball" -C "$cache/unpacking" --strip-components=1
    rm -rf "$cache/meshlab-$version"
    mv "$cache/unpacking" "$cache/meshlab-$version"
done <<< "$releases"
