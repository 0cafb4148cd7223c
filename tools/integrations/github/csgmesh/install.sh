#!/bin/bash
# SPDX-License-Identifier: MIT
# Makes sure that $CSGMESH can be called: from the Debian package $PACKAGE (a file or a URL), from the clone of
# csgmesh in the folder $SOURCE, or because a step before has installed it.
set -eu
work=${RUNNER_TEMP:-/tmp}

give_up() {
    echo "::error::csgmesh: $1"
    exit 2
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

[ -z "$PACKAGE" ] || [ -z "$SOURCE" ] || give_up "package and source are two ways to have it: give one"
if [ -n "$PACKAGE" ]; then
    file=$PACKAGE
    case $PACKAGE in
    *://*)
        file=$work/csgmesh.deb
        curl --fail --silent --show-error --location --retry 3 --output "$file" "$PACKAGE" ||
            give_up "$PACKAGE could not be had"
        ;;
    esac
    [ -f "$file" ] || give_up "there is no package $file"
    as_root apt-get -q update
    as_root apt-get -q -y install "$(realpath "$file")" || give_up "$PACKAGE could not be installed"
elif [ -n "$SOURCE" ]; then
    [ -x "$SOURCE/tools/run" ] || give_up "$SOURCE is no clone of csgmesh: it has no tools/run"
    "$SOURCE/tools/run" version
    folder=$(realpath "$SOURCE/build/tools/csgmesh")
    echo "$folder" >>"${GITHUB_PATH:-/dev/null}"
    PATH=$folder:$PATH
fi
command -v "$CSGMESH" >/dev/null ||
    give_up "there is no program '$CSGMESH': give the action a package, a source, or install it in a step before"
"$CSGMESH" version
