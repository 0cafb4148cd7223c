/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"

uint64_t fuzz_accepted;

static void on_diag(void *user, const csgm_diag *diag)
{
    char text[4096];
    (void)user;
    size_t length = csgm_diag_format(diag, text, sizeof text);
    if (length == 0 || !diag->message || strchr(diag->message, '\n'))
        fuzz_fail("a finding without a line of text", diag->message ? diag->message : "", 0);
}

static void on_echo(void *user, const char *text, size_t length)
{
    (void)user;
    if (length < 7 || memcmp(text, "ECHO: ", 6) != 0 || text[length - 1] != '\n')
        fuzz_fail("an echo that is no line", text, length);
}

void fuzz_context_init(csgm_context *context)
{
    *context = (csgm_context){.on_echo = on_echo};
    csg_memory_init(&context->memory, NULL, (uint64_t)64 << 20);
    context->limits = (csgm_limits){.depth = 300,
                                    .scene_nodes = 5000,
                                    .eval_steps = 100000,
                                    .memory_bytes = (uint64_t)64 << 20};
    context->diags.on_diag = on_diag;
}

void fuzz_context_close(csgm_context *context)
{
    if (context->memory.used_bytes != 0)
        fuzz_fail("memory was not given back", "", 0);
}

void fuzz_fail(const char *what, const char *text, size_t length)
{
    fprintf(stderr, "%s\n%.*s\n", what, (int)length, text);
    abort();
}
