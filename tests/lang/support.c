/* SPDX-License-Identifier: MIT */
#include "lang/support.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void on_diag(void *user, const csgm_diag *diag)
{
    bench *b = user;
    assert_true(pthread_equal(pthread_self(), b->thread)); /* the library's promise */
    if (b->text_length < sizeof b->text)
        b->text_length +=
            csgm_diag_format(diag, b->text + b->text_length, sizeof b->text - b->text_length);
    if (b->text_length > sizeof b->text)
        b->text_length = sizeof b->text;
    if (diag->severity != CSGM_NOTE && b->code_count < MOST_CODES)
        b->codes[b->code_count++] = diag->severity == CSGM_ERROR ? diag->code : -(int)diag->code;
}

static void on_echo(void *user, const char *text, size_t length)
{
    bench *b = user;
    assert_true(pthread_equal(pthread_self(), b->thread));
    assert_true(length >= 7 && memcmp(text, "ECHO: ", 6) == 0 && text[length - 1] == '\n');
    length -= 6;
    if (b->echo_length + length < sizeof b->echo) {
        memcpy(b->echo + b->echo_length, text + 6, length);
        b->echo_length += length;
    }
    b->echo[b->echo_length] = '\0';
}

void bench_open(bench *b, const csgm_allocator *allocator)
{
    memset(b, 0, sizeof *b);
    b->thread = pthread_self();
    csg_memory_init(&b->context.memory, allocator, (uint64_t)8 << 30);
    b->context.limits = (csgm_limits){10000, 4000000, 1000000000, (uint64_t)8 << 30, 0};
    b->context.diags = (csg_diag_sink){.on_diag = on_diag, .user = b};
    b->context.on_echo = on_echo;
    b->context.user = b;
}

static void forget(bench *b)
{
    csg_scene_destroy(b->scene);
    b->scene = NULL;
    b->text_length = b->echo_length = 0;
    b->text[0] = b->echo[0] = '\0';
    b->code_count = 0;
    b->context.diags.errors = b->context.diags.warnings = 0;
    b->context.diags.errors_more = b->context.diags.warnings_more = 0;
    b->context.diags.warnings_shown = b->context.diags.group_count = 0;
    b->context.diags.mute_notes = false;
}

void bench_close(bench *b)
{
    forget(b);
    assert_int_equal(atomic_load(&b->context.memory.used_bytes), 0);
}

csgm_status bench_compile_bytes(bench *b, const char *text, size_t length,
                                const csgm_scene_options *options)
{
    forget(b);
    csg_lang_input input = {
        .path = "scene.txt", .text = text, .text_length = length, .options = options};
    csgm_status status = csg_lang_compile(&b->context, &input, &b->scene);
    assert_true((status == CSGM_OK) == (b->scene != NULL));
    return status;
}

csgm_status bench_compile(bench *b, const char *text)
{
    return bench_compile_bytes(b, text, strlen(text), NULL);
}

csgm_status bench_load(bench *b, const char *path, const csgm_scene_options *options)
{
    forget(b);
    csg_lang_input input = {.path = path, .options = options};
    return csg_lang_compile(&b->context, &input, &b->scene);
}

bool bench_has(const bench *b, int code)
{
    for (int i = 0; i < b->code_count; i++)
        if (b->codes[i] == code)
            return true;
    return false;
}
