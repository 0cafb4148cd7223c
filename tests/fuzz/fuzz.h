/* SPDX-License-Identifier: MIT
 * What the two fuzz targets share: a silent context with small limits, and the files that a scene
 * may include, which are parts of the input itself. Nothing is opened while an input runs.
 */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

/* libFuzzer's entry point; replay.c calls it too. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* How many inputs a reader of meshes has taken. */
extern uint64_t fuzz_accepted;

void fuzz_context_init(csgm_context *context);
/* Aborts when memory was not given back. */
void fuzz_context_close(csgm_context *context);
/* Aborts with a message: a finding that is no crash by itself. */
void fuzz_fail(const char *what, const char *text, size_t length) __attribute__((noreturn));

typedef struct fuzz_text {
    const char *text;
    size_t length;
} fuzz_text;

/* Splits the input at bytes 0x1C: the scene, then the files "a", "b", "c" and "d". From here to
 * fuzz_files_close only these can be read. */
fuzz_text fuzz_files_open(const uint8_t *data, size_t size);
void fuzz_files_close(void);

#endif
