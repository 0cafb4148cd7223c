# SPDX-License-Identifier: MIT
# Shared by tools/run and tools/test: packages and build folders. Sourced, POSIX sh; sets nothing but
# functions and `root`. All it says goes to standard error.

root=$(cd "$(dirname "$0")/.." && pwd)

say() {
    echo "$*" >&2
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    else
        sudo "$@"
    fi
}

is_installed() {
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# need_packages NAME...: installs those that are missing, so that a second call needs no network.
# A name as command:package is missing when there is no such command.
need_packages() {
    missing=
    for name in "$@"; do
        case $name in
        *:*) command -v "${name%%:*}" >/dev/null || missing="$missing ${name#*:}" ;;
        *) is_installed "$name" || missing="$missing $name" ;;
        esac
    done
    [ -n "$missing" ] || return 0
    say "installing:$missing"
    quietly as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 update ||
        say "apt-get update failed; trying to install all the same"
    # shellcheck disable=SC2086 # one word a package
    quietly as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y \
        -o DPkg::Lock::Timeout=300 --no-install-recommends install $missing
}

# On Debian and its like; elsewhere the packages are the user's task.
need_core_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        say "no apt-get here: taking it that compilers, meson, ninja and the libraries are installed"
        return 0
    fi
    need_packages gcc g++ meson ninja-build pkg-config:pkgconf libopenmesh-dev libdraco-dev \
        libpolyclipping-dev libexpat1-dev libzip-dev zlib1g-dev libpng-dev libfreetype-dev libharfbuzz-dev \
        libfribidi-dev libfontconfig-dev fonts-liberation fonts-dejavu-core \
        libtinygltf-dev nlohmann-json3-dev libqhull-dev libb2-dev libcurl4-openssl-dev libmicrohttpd-dev \
        libmeshoptimizer-dev \
        "$@"
}

# quietly COMMAND...: its output only when it fails.
quietly() {
    log=$(mktemp)
    if "$@" >"$log" 2>&1 </dev/null; then
        rm -f "$log"
        return 0
    fi
    cat "$log" >&2
    rm -f "$log"
    return 1
}

# configure FOLDER OPTIONS...: once; later calls keep the folder.
configure() {
    folder=$1
    shift
    [ -f "$folder/build.ninja" ] || quietly meson setup "$folder" "$root" "$@"
}
