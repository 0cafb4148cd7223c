# SPDX-License-Identifier: MIT
# Sourced by tools/package: one file for Linux, linked with nothing but static libraries. Debian has these of most
# libraries; of the others they are made here, from Debian's sources of the same versions.

work=$results/binary
prefix=$work/prefix

apt_of_sources() {
    quietly "$1" -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/sources.d" -o Dir::State::Lists="$work/lists" \
        -o Dir::Cache="$work/cache" -o APT::Sandbox::User=root -o Debug::NoLocking=1 "$2" ${3:+"$3"}
}

# fetch_sources PACKAGE...: unpacked below $work; what the system knows of packages stays as it is.
fetch_sources() {
    mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$work/sources.d"
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
        case $file in
        *.sources) sed 's/^Types:.*/Types: deb-src/' "$file" >"$work/sources.d/${file##*/}" ;;
        *.list) [ ! -f "$file" ] || sed -n 's/^deb /deb-src /p' "$file" >"$work/sources.d/${file##*/}" ;;
        esac
    done
    fresh=
    for package in "$@"; do
        [ ! -d "$work/$package" ] || continue
        [ -n "$fresh" ] || apt_of_sources apt-get update || fail "there are no lists of source packages to be had"
        fresh=yes
        (cd "$work" && rm -rf "$package"-*/ && apt_of_sources apt-get source "$package" && mv "$package"-*/ "$package") ||
            fail "there is no source of $package to be had"
    done
}

# As its README says: all of it is one file. Fonts are read by its own tables, not through FreeType.
make_harfbuzz() {
    mkdir -p "$prefix/lib/pkgconfig" "$prefix/include/harfbuzz"
    (cd "$work/harfbuzz/src" && quietly g++ -std=c++11 -O2 -fno-exceptions -fno-rtti -fno-threadsafe-statics -DHAVE_PTHREAD \
        -c harfbuzz.cc -o "$work/harfbuzz.o" && cp hb*.h "$prefix/include/harfbuzz")
    ar rcs "$prefix/lib/libharfbuzz.a" "$work/harfbuzz.o"
    write_pc harfbuzz "$(pkg-config --modversion harfbuzz)" "-I$prefix/include/harfbuzz" "-L$prefix/lib -lharfbuzz"
}

# write_pc NAME VERSION CFLAGS LIBS
write_pc() {
    printf 'Name: %s\nDescription: %s, static\nVersion: %s\nCflags: %s\nLibs: %s\n' "$1" "$1" "$2" "$3" "$4" \
        >"$prefix/lib/pkgconfig/$1.pc"
}

# make_by_cmake FOLDER OPTIONS...
make_by_cmake() {
    folder=$work/$1
    shift
    quietly cmake -S "$folder" -B "$folder/made" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
        -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF "$@"
    quietly cmake --build "$folder/made" --target install
}

# The server of csgmesh view, for this machine alone: no TLS, and so none of the libraries that Debian's wants.
make_microhttpd() {
    (cd "$work/libmicrohttpd" && quietly ./configure --prefix="$prefix" --disable-shared --enable-static --disable-https --disable-curl \
        --disable-doc --disable-examples --disable-tools --disable-bauth --disable-dauth && quietly make install)
}

make_static_libraries() {
    [ ! -f "$prefix/complete" ] || return 0
    say "making the libraries of which Debian has no static ones: harfbuzz, libmicrohttpd, libzip, polyclipping"
    fetch_sources harfbuzz libmicrohttpd libzip libpolyclipping
    make_harfbuzz
    make_microhttpd
    make_by_cmake libpolyclipping/cpp
    make_by_cmake libzip -DENABLE_COMMONCRYPTO=OFF -DENABLE_GNUTLS=OFF -DENABLE_MBEDTLS=OFF -DENABLE_OPENSSL=OFF \
        -DENABLE_BZIP2=OFF -DENABLE_LZMA=OFF -DENABLE_ZSTD=OFF -DBUILD_TOOLS=OFF -DBUILD_REGRESS=OFF -DBUILD_EXAMPLES=OFF \
        -DBUILD_DOC=OFF
    [ ! -d "$prefix/share/pkgconfig" ] || cp "$prefix"/share/pkgconfig/*.pc "$prefix/lib/pkgconfig"
    # Debian's static library has another name, which qhull_r.pc does not say
    write_pc qhull_r "$(pkg-config --modversion qhull_r)" "$(pkg-config --cflags qhull_r)" -lqhullstatic_r
    # its header is compiled in; there is a shared library only, which is not needed
    write_pc tinygltf "$(pkg-config --modversion tinygltf)" "$(pkg-config --cflags tinygltf)" ""
    touch "$prefix/complete"
}

make_binary() {
    need_core_packages cmake dpkg-dev libbrotli-dev libbz2-dev
    command -v apt-get >/dev/null || fail "there is no apt-get here" "the binary is made on Debian"
    make_static_libraries
    say "building csgmesh: some minutes"
    [ -f "$work/build/build.ninja" ] ||
        quietly env PKG_CONFIG_PATH="$prefix/lib/pkgconfig" meson setup "$work/build" "$root" -Dprefer_static=true \
            -Dauto_features=enabled -Dtests=disabled -Dopenmesh=disabled -Dmpi=disabled -Dmeshoptimizer=disabled -Dlibcurl=disabled -Dc_link_args=-static -Dcpp_link_args=-static ||
        fail "meson setup failed"
    quietly ninja -C "$work/build" tools/csgmesh/csgmesh || fail "the build failed"
    strip -o "$results/csgmesh" "$work/build/tools/csgmesh/csgmesh"
    if readelf -d "$results/csgmesh" | grep -q NEEDED; then
        fail "the binary needs libraries: $(readelf -d "$results/csgmesh" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | tr '\n' ' ')"
    fi
    quietly "$results/csgmesh" version || fail "the binary does not run"
    (cd "$results" && cp csgmesh "csgmesh-$version-linux-$(uname -m)" && sha256sum "csgmesh-$version-linux-$(uname -m)")
    say "made $results/csgmesh; it needs no library of the system"
}
