/* SPDX-License-Identifier: MIT
 * Scenes that make meshers leak, cross themselves or fall over: all of a folder (scenes/hard), as
 * they stand and in random rotations; thinned out, as they stand. Each mesh is a closed oriented
 * 2-manifold that does not run through itself, sharp and smooth, with the same bytes for other
 * threads and without pruning.
 *
 * Arguments: the folder, how many rotations of each scene (default 1), cells along the longest side
 * (default 32), another seed for the rotations, how the names of the scenes begin (default: all).
 */
#include <stdarg.h>
#include <stdint.h>

#include <dirent.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "csgmesh/csgmesh.h"
#include "mesh/self_intersections.h"
#include "rounds.h"

enum { MOST_SCENES = 64, MOST_TEXT = 4096, MOST_NAME = 128 };

static const char *folder = ".", *only = NULL;
static unsigned rotation_count = 1, resolution = 32, seed_of_run = 0;

/* One build of a scene: a context of its own, so that the number of threads may differ. */
typedef struct built {
    csgm_context *context;
    csgm_mesh *mesh;
    csgm_mesh_view view;
    csgm_mesh_stats stats;
} built;

static csgm_mesh_options sharp_options(void)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    options.resolution = resolution;
    return options;
}

/* A scene that needs a lattice of its own says "//! resolution N" and "//! options --bounds
 * X,Y,Z,X,Y,Z". */
static bool own_lattice(const char *text, csgm_mesh_options *options)
{
    const char *bounds = strstr(text, "//! options --bounds "), *cells = strstr(text, "//! reso");
    csgm_box *b = &options->bounds;
    if (!bounds || !cells)
        return false;
    assert_int_equal(sscanf(cells, "//! resolution %u", &options->resolution), 1);
    assert_int_equal(sscanf(bounds, "//! options --bounds %lf,%lf,%lf,%lf,%lf,%lf", &b->min.x,
                            &b->min.y, &b->min.z, &b->max.x, &b->max.y, &b->max.z),
                     6);
    return true;
}

static void build(built *b, const char *text, const csgm_mesh_options *options, uint32_t threads)
{
    csgm_context_options how = csgm_context_options_default();
    csgm_scene *scene;
    csgm_field *field;
    how.threads = threads;
    assert_int_equal(csgm_context_create(&how, &b->context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(b->context, text, strlen(text), "hard.txt", NULL, &scene),
                     CSGM_OK);
    assert_int_equal(csgm_field_compile(b->context, scene, &field), CSGM_OK);
    b->stats = csgm_mesh_stats_default();
    assert_int_equal(csgm_mesh_build(b->context, field, options, &b->mesh, &b->stats), CSGM_OK);
    b->view = csgm_mesh_get_view(b->mesh);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
}

static void unbuild(built *b)
{
    csgm_mesh_destroy(b->mesh);
    csgm_context_destroy(b->context);
}

/* ---- what is asked ---------------------------------------------------------------------------
 */

static void check_closed(const built *b, const char *what)
{
    csgm_mesh_check k;
    assert_int_equal(csgm_mesh_inspect(b->context, &b->view, &k), CSGM_OK);
    uint64_t faults = k.boundary_edges + k.nonmanifold_edges + k.misoriented_edges +
                      k.nonmanifold_vertices + k.degenerate_triangles + k.unused_vertices +
                      k.index_out_of_range;
    if (faults)
        fail_msg("%s: %llu faults of a closed oriented manifold", what, (unsigned long long)faults);
}

static void check_uncrossed(const built *b, const char *what)
{
#ifdef HAVE_CGAL
    long long count = test_self_intersections(b->view.positions, b->view.vertex_count,
                                              b->view.indices, b->view.triangle_count, NULL, 0);
    if (count > 0)
        fail_msg("%s: %lld pairs of triangles cross", what, count);
#else
    (void)b;
    (void)what;
#endif
}

static void check_same(const built *a, const built *b, const char *what)
{
    const csgm_mesh_view *v = &a->view, *w = &b->view;
    if (v->vertex_count != w->vertex_count || v->triangle_count != w->triangle_count ||
        memcmp(v->positions, w->positions, 3 * v->vertex_count * sizeof *v->positions) ||
        memcmp(v->normals, w->normals, 3 * v->vertex_count * sizeof *v->normals) ||
        memcmp(v->indices, w->indices, 3 * v->triangle_count * sizeof *v->indices))
        fail_msg("%s: not the same mesh with other threads and without pruning", what);
}

static void check_scene(const char *text, csgm_mesh_options options, const char *what)
{
    built sharp, other, smooth;
    char smoothly[2 * MOST_NAME];
    snprintf(smoothly, sizeof smoothly, "%s, smooth", what);
    build(&sharp, text, &options, 1);
    check_closed(&sharp, what);
    check_uncrossed(&sharp, what);
    options.prune = false;
    build(&other, text, &options, 3);
    if (sharp.view.triangle_count)
        check_same(&sharp, &other, what);
    unbuild(&other);
    options.features = CSGM_FEATURES_SMOOTH;
    build(&smooth, text, &options, 2);
    check_closed(&smooth, smoothly);
    check_uncrossed(&smooth, smoothly);
    unbuild(&smooth);
    unbuild(&sharp);
}

/* Cells that follow the shape, thinned out, coarsely: wedges and gaps are thinner than the
 * tolerance. */
static void check_thinned(const char *text, const char *name)
{
    built b;
    char what[2 * MOST_NAME];
    csgm_mesh_options options = csgm_mesh_options_default();
    options.quality = CSGM_QUALITY_DRAFT;
    snprintf(what, sizeof what, "%s, thinned out", name);
    build(&b, text, &options, 2);
    check_closed(&b, what);
    check_uncrossed(&b, what);
    unbuild(&b);
}

/* ---- the scenes ------------------------------------------------------------------------------
 */

static int is_scene(const struct dirent *entry)
{
    size_t length = strlen(entry->d_name);
    return length > 4 && length < MOST_NAME && !strcmp(entry->d_name + length - 4, ".txt") &&
           (!only || !strncmp(entry->d_name, only, strlen(only)));
}

static void read_scene(const char *name, char text[MOST_TEXT])
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("cannot read %s", path);
    size_t length = fread(text, 1, MOST_TEXT, file);
    fclose(file);
    assert_true(length < MOST_TEXT);
    text[length] = 0;
}

/* Fourteen cubes in place of the two of cubes_at_an_edge: a third of all the time. */
static bool only_has_more(const char *name)
{
    return ROUNDS(4) < 4 && !strcmp(name, "touching_cubes.txt");
}

static void check_poses(const char *name, uint64_t seed)
{
    char text[MOST_TEXT], turned[MOST_TEXT + 256], what[MOST_NAME + 64];
    csg_random random = {seed};
    csgm_mesh_options options = sharp_options();
    read_scene(name, text);
    bool is_fixed = own_lattice(text, &options);
    check_scene(text, options, name);
    if (!only_has_more(name))
        check_thinned(text, name);
    for (unsigned i = 0; i < rotation_count && !is_fixed; i++) {
        double a[3];
        for (int k = 0; k < 3; k++)
            a[k] = csg_random_uniform(&random, 0, 360);
        snprintf(turned, sizeof turned, "rotate([%.17g, %.17g, %.17g]) union() {\n%s}\n", a[0],
                 a[1], a[2], text);
        snprintf(what, sizeof what, "%s, rotation %u (%g %g %g)", name, i, a[0], a[1], a[2]);
        check_scene(turned, options, what);
    }
}

static void test_scene(void **state)
{
    const char *name = *state;
    uint64_t seed = seed_of_run;
    for (const char *p = name; *p; p++)
        seed = 31 * seed + (unsigned char)*p;
    check_poses(name, seed);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        folder = argv[1];
    if (argc > 2)
        rotation_count = (unsigned)strtoul(argv[2], NULL, 10);
    if (argc > 3)
        resolution = (unsigned)strtoul(argv[3], NULL, 10);
    if (argc > 4)
        seed_of_run = (unsigned)strtoul(argv[4], NULL, 10);
    if (argc > 5)
        only = argv[5];
    struct CMUnitTest tests[MOST_SCENES] = {{0}};
    struct dirent **entries;
    int count = scandir(folder, &entries, is_scene, alphasort);
    if (count < 1 || count > MOST_SCENES) {
        fprintf(stderr, "%d scenes in %s\n", count, folder);
        return 1;
    }
    for (int i = 0; i < count; i++)
        tests[i] =
            (struct CMUnitTest){entries[i]->d_name, test_scene, NULL, NULL, entries[i]->d_name};
    int failures = _cmocka_run_group_tests("hard scenes", tests, (size_t)count, NULL, NULL);
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
    return failures;
}
