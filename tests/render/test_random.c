/* SPDX-License-Identifier: MIT
 * Seeded random scenes of 1 to 60 primitives with all operators and blends: what pruned float tapes
 * show, cell by cell, is what the plain field in double shows, ray by ray; and any number of
 * threads and instruction set writes the same bytes.
 *
 * Arguments: how many scenes (default 16), the first one's seed (default 0).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/mesh_support.h"
#include "render/render.h"

enum { PIXELS = 56 };

static unsigned scene_count = 16, first_seed = 0;

static void compile_scene(mesh_case *c, unsigned seed, uint32_t threads)
{
    csg_random random = {7000 + seed};
    test_random_shapes = seed % 2;
    mesh_case_begin(c, threads);
    mesh_case_compile(c, test_random_scene(&c->builder, &random, 1 + seed * 17 % 60));
}

static csgm_render_options options_of(const mesh_case *c, unsigned seed)
{
    csgm_render_options options = csg_render_options_default();
    options.width = options.height = PIXELS;
    options.camera.azimuth_deg = 37.0 * (seed % 1000); /* an angle in reach, whatever the seed */
    options.camera.elevation_deg = seed % 7 * 25.0 - 75;
    options.camera.projection = seed % 3 ? CSGM_PERSPECTIVE : CSGM_ORTHOGRAPHIC;
    options.frame = c->field->bounds; /* the same for both evaluators */
    options.samples = 1;
    options.occlusion = options.shadows = false;
    memset(options.background, 0, sizeof options.background);
    return options;
}

static csgm_image *render(mesh_case *c, const csgm_render_options *options)
{
    csgm_image *image;
    csgm_render_stats stats;
    assert_int_equal(csg_render_scene(&c->context, c->field, options, &image, &stats), CSGM_OK);
    return image;
}

/* Pixels that only one of the pictures covers; *light: mean difference of those that both do. */
static int compare(const csgm_image *a, const csgm_image *b, double *light)
{
    int differ = 0, both = 0;
    *light = 0;
    for (size_t i = 0; i < PIXELS * PIXELS; i++) {
        const uint8_t *p = a->pixels + 4 * i, *q = b->pixels + 4 * i;
        differ += p[3] != q[3];
        if (!p[3] || !q[3])
            continue;
        both++;
        for (int k = 0; k < 3; k++)
            *light += abs(p[k] - q[k]) / 3.0;
    }
    *light /= both ? both : 1;
    return differ;
}

static void check_scene(unsigned seed)
{
    mesh_case c, other;
    compile_scene(&c, seed, 2);
    csg_box bounds = c.field->bounds;
    if (csg_box_is_finite(bounds)) {
        csgm_render_options options = options_of(&c, seed);
        csgm_image *fast = render(&c, &options);
        options.evaluator = CSGM_EVALUATOR_LAZY;
        options.lazy = options.bounds_used = false;
        csgm_image *plain = render(&c, &options);
        double light;
        int differ = compare(fast, plain, &light);
        if (differ > PIXELS * PIXELS / 100)
            fail_msg("scene %u: %d pixels differ", seed, differ);
        if (c.field->color_count == 1 && !c.field->has_colors && light > 1.5)
            fail_msg("scene %u: light differs by %g on average", seed, light);
        csg_image_destroy(plain);

        compile_scene(&other, seed, 1 + seed % 4);
        other.context.isa = CSGM_ISA_SCALAR;
        options = options_of(&other, seed);
        csgm_image *again = render(&other, &options);
        assert_memory_equal(fast->pixels, again->pixels, PIXELS * PIXELS * 4);
        csg_image_destroy(again);
        csg_image_destroy(fast);
        mesh_case_end(&other);
    }
    mesh_case_end(&c);
}

static void test_random_scenes(void **state)
{
    for (unsigned seed = first_seed; seed < first_seed + scene_count; seed++)
        check_scene(seed);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        scene_count = (unsigned)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_seed = (unsigned)strtoul(argv[2], NULL, 10);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
