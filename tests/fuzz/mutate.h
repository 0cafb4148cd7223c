/* SPDX-License-Identifier: MIT
 * Mutations that know what they change: of a thousand random changes of a packed or nested file
 * hardly one passes the first checks of its reader, so that what lies behind these is never tried.
 * Here containers stay whole (a GLB's chunks and lengths, Draco's header), and documents stay
 * documents: numbers, words and whole elements are exchanged, left out and doubled.
 */
#ifndef TESTS_FUZZ_MUTATE_H
#define TESTS_FUZZ_MUTATE_H

#include <stddef.h>
#include <stdint.h>

/* libFuzzer's own; replay.c has one for other builds. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
/* What libFuzzer calls instead of its own where a target has one. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);

/* Each changes data in place, which has room for `most` bytes, and returns the new size. */
size_t fuzz_mutate_json(uint8_t *data, size_t size, size_t most, unsigned seed);
size_t fuzz_mutate_xml(uint8_t *data, size_t size, size_t most, unsigned seed);
/* GLB, or glTF when it begins with '{'. */
size_t fuzz_mutate_gltf(uint8_t *data, size_t size, size_t most, unsigned seed);
/* XML, or the package of a 3MF or AMF, which is changed as bytes. */
size_t fuzz_mutate_package(uint8_t *data, size_t size, size_t most, unsigned seed);
size_t fuzz_mutate_draco(uint8_t *data, size_t size, size_t most, unsigned seed);

#endif
