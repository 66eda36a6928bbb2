# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# For other scripts to read in with ".": apt under a configuration of its own, as if nothing were installed, on a mirror
# that $mirror names; what it knows lies in the working folder. No root rights are needed.

# The suites that hold a MeshLab by now; which release moves on from year to year, so they are asked for it.
suites="trixie forky sid experimental"

private_apt() {
    apt-get -q -q -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::PreferencesParts=/dev/null -o Dir::Etc::Preferences=/dev/null \
        -o Dir::State="$PWD/state" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD/cache" \
        -o APT::Architecture=amd64 -o APT::Architectures=amd64 -o APT::Sandbox::User=root \
        -o Acquire::Check-Valid-Until=false -o Acquire::Languages=none "$@"
}

# choose_suite RELEASE SUITE: sets $suite to SUITE, or else the first other one, whose meshlab is of RELEASE, and leaves
# private_apt on it and in uris what an installation would fetch; fails with a sentence if there is none.
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
        # What experimental lacks is in sid.
        echo "deb [signed-by=$keys] $mirror $suite main" > sources.list
        [ "$suite" != experimental ] || echo "deb [signed-by=$keys] $mirror sid main" >> sources.list
        # A mirror that lags behind serves a release file past its date, hence Check-Valid-Until above.
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
