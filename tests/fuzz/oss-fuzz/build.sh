#!/bin/bash -eu
# SPDX-License-Identifier: MIT
# OSS-Fuzz's build: every target into $OUT with its seeds, words and the shared libraries that it needs. Runs in the sources,
# with CC, CXX, CFLAGS, CXXFLAGS, LIB_FUZZING_ENGINE, OUT and WORK as base-builder sets them.
fuzz=$PWD/tests/fuzz inputs=$PWD/tests/data/fuzz build=$WORK/build
rm -rf "$build"
# Ubuntu's libraries in C++ are made with libstdc++, and base-builder's libc++ has no from_chars for floats.
export CXXFLAGS="${CXXFLAGS//-stdlib=libc++/}"
# The sanitizers stand in CFLAGS. b_lundef: their functions are not in shared libraries.
meson setup "$build" -Dfuzz=true -Dfuzz_engine="$LIB_FUZZING_ENGINE" -Dtests=enabled -Dwerror=false -Db_lundef=false \
    -Dbuildtype=plain -Db_ndebug=false -Dopenmesh=disabled -Dlibb2=disabled -Dlibcurl=disabled -Dmicrohttpd=disabled -Dmpi=disabled
targets=$(ninja -C "$build" -t targets all | sed -n 's,^\(tests/[a-z]*/fuzz_[a-z0-9]*\):.*,\1,p' | sort -u)
# shellcheck disable=SC2086 # a word for each target
ninja -C "$build" $targets

mkdir -p "$OUT/lib"
for target in $targets; do
    name=${target##*/}
    kind=${name#fuzz_}
    cp "$build/$target" "$OUT/$name"
    seeds=$(find "$inputs/corpus/$kind" "$inputs/findings/$kind" -type f 2>/dev/null || true)
    # shellcheck disable=SC2086 # a word for each seed, none has a space
    zip -q -j "$OUT/${name}_seed_corpus.zip" $seeds
    words=$fuzz/dictionaries/$kind.dict
    [ -f "$words" ] || words=$fuzz/scene.dict
    cp "$words" "$OUT/$name.dict"
    # Where the targets run there are no libraries of this image.
    ldd "$OUT/$name" | sed -n 's,.* => \(/[^ ]*\) .*,\1,p' | grep -v -E '/(libc|libm|libpthread|libdl|librt|libgcc_s)\.so' |
        xargs -r -I '{}' cp -n -L '{}' "$OUT/lib/"
    # not a run path, which holds for what the target names itself, and not for what these libraries do
    patchelf --force-rpath --set-rpath '$ORIGIN/lib' "$OUT/$name"
done
