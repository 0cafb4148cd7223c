/* SPDX-License-Identifier: MIT
 * What the tests of the language share: a context that keeps all it says, and one call to compile.
 */
#ifndef TESTS_LANG_SUPPORT_H
#define TESTS_LANG_SUPPORT_H

#include <pthread.h>

#include "lang/lang.h"

enum { MOST_CODES = 64 };

typedef struct bench {
    csgm_context context;
    char text[65536]; /* formatted findings, one after the other */
    size_t text_length;
    char echo[65536]; /* lines without "ECHO: " */
    size_t echo_length;
    int codes[MOST_CODES]; /* of errors and warnings in order; warnings negative */
    int code_count;
    pthread_t thread;  /* that opened it: callbacks must come on it */
    csgm_scene *scene; /* of the last bench_compile */
} bench;

/* Default limits. allocator NULL = malloc. */
void bench_open(bench *b, const csgm_allocator *allocator);
void bench_close(bench *b); /* asserts that all memory came back */
/* Forgets what was said, destroys the scene, compiles text. */
csgm_status bench_compile(bench *b, const char *text);
csgm_status bench_compile_bytes(bench *b, const char *text, size_t length,
                                const csgm_scene_options *options);
csgm_status bench_load(bench *b, const char *path, const csgm_scene_options *options);
bool bench_has(const bench *b, int code); /* negative: warning */

#endif
