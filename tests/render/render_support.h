/* SPDX-License-Identifier: MIT
 * What the tests of pictures share: a context that counts its memory, scenes from text, and
 * measures of pictures.
 */
#ifndef TEST_RENDER_SUPPORT_H
#define TEST_RENDER_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "csgmesh/csgmesh.h"

typedef struct render_case {
    int64_t bytes, calls, fail_at; /* in use; allocations; the one that fails, 0 = none */
    int errors, warnings;
    uint16_t last_code;
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    csgm_image *image;
    csgm_render_stats stats;
} render_case;

/* isa AUTO and one thread unless the test is about them. text NULL: no scene. */
void render_begin(render_case *c, uint32_t threads, csgm_isa isa, const char *text);
void render_end(render_case *c); /* all memory must be back */

/* An orthographic picture from the front of [-side / 2, side / 2]^3, no shadows or occlusion, the
 * background transparent. */
csgm_render_options front_options(uint32_t pixels, double side);
/* Must succeed; replaces the last image. */
void render_scene(render_case *c, const csgm_render_options *options);
void render_mesh(render_case *c, const csgm_mesh_view *mesh, const csgm_render_options *options);

const uint8_t *pixel_at(const render_case *c, uint32_t x, uint32_t y);
/* Pixels covered, partly covered ones by their part. */
double covered(const render_case *c);
void assert_same_image(const csgm_image *a, const csgm_image *b, const char *what);

#endif
