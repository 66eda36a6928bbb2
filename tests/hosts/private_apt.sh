# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Sourced by other scripts: apt with a separate configuration, as if no package were installed, on the mirror $mirror.
# Its state is kept in the working folder. No root rights are needed.

# The suites that may contain the wanted MeshLab; which one does changes over the years.
suites="trixie forky sid experimental"

private_apt() {
    apt-get -q -q -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::PreferencesParts=/dev/null -o Dir::Etc::Preferences=/dev/null \
        -o Dir::State="$PWD/state" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD/cache" \
        -o APT::Architecture=amd64 -o APT::Architectures=amd64 -o APT::Sandbox::User=root \
        -o Acquire::Check-Valid-Until=false -o Acquire::Languages=none "$@"
}

# choose_suite RELEASE SUITE: sets $suite to the first suite, beginning with SUITE, whose meshlab is of RELEASE, and
# configures private_apt for it. Writes the packages that an installation would fetch to the file uris. Fails with an
# error message if there is no such suite.
choose_suite() {
    release=$1
    preferred=$2
    keys=/usr/share/keyrings/debian-archive-keyring.gpg
    if [ ! -e "$keys" ]; then
        echo "There is no $keys: install the Debian package debian-archive-keyring." >&2
        return 1
    fi
    seen=""
    touch status
    for suite in $preferred $suites; do
        case " $seen " in *" $suite "*) continue ;; esac
        seen="$seen $suite"
        rm -rf state cache
        mkdir -p state/lists/partial cache/archives/partial
        # experimental is incomplete without sid.
        echo "deb [signed-by=$keys] $mirror $suite main" > sources.list
        [ "$suite" != experimental ] || echo "deb [signed-by=$keys] $mirror sid main" >> sources.list
        # Check-Valid-Until is off because the release file of a mirror that lags behind may be past its date.
        if private_apt update > log 2>&1 &&
            private_apt install --print-uris --no-install-recommends --target-release "$suite" meshlab > uris 2> log &&
            grep -q "meshlab_$release" uris; then
            return 0
        fi
    done
    echo "None of the suites$seen of $mirror has a MeshLab $release that can be installed." \
        "Name another mirror, or a snapshot of that time, in DEBIAN_MIRROR and run this again." >&2
    return 1
}
