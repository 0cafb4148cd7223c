/* SPDX-License-Identifier: MIT
 * Counts how often sphere tracing evaluates a scene's field and the nodes in it, with and without
 * lazy evaluation (operators.md 2.4, 3.6): 36 views of 120 x 120 rays from all around.
 *
 *     evaluations [--views N] [--size N] SCENE...
 *
 * One line for each scene and method, separated by tabs: scene, method, nodes in the tree, rays,
 * hits, evaluations of the field, of nodes, pixels that differ from the plain field's picture,
 * seconds of
 * processor. The tracer is the basic one: start outside, step |f| / lambda until f >= -tolerance or
 * the ray has left the ball around the scene. tools/evaluations makes the table of it.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "scene/boxes/bounds.h"
#include "scene/lazy/lazy.h"

typedef struct method {
    const char *name;
    csg_lazy_options options;
} method;

#define TOLERANCE 1e-4 /* of the ball's radius */
#define BAND 1e-3

static const method methods[] = {
    {"plain", {false, CSG_LAZY_NO_BOUNDS, 0, false}},
    {"own boxes", {true, CSG_LAZY_OWN_BOXES, 0, false}},
    {"shared boxes", {true, CSG_LAZY_SHARED_BOXES, 0, false}},
    {"exact", {true, CSG_LAZY_EXACT, 0, false}}, /* the band is set by the scene's size */
    {"exact, demand", {true, CSG_LAZY_EXACT, 0, true}},
};
enum { METHODS = sizeof methods / sizeof *methods };

typedef struct camera {
    csg_vec3 eye, right, up, ahead;
    double half; /* of the picture at distance 1 */
} camera;

typedef struct tracer {
    const csg_lazy *lazy;
    void *scratch;
    csg_lazy_counts counts;
    csg_vec3 center;
    double radius, tolerance, lambda;
    uint64_t hits;
} tracer;

/* The field of view holds the ball around the scene, seen from a little above. */
static camera camera_at(csg_vec3 center, double radius, double turn_deg)
{
    const double above_deg = 20, distance = 3 * radius;
    csg_affine turn = csg_affine_rotate(turn_deg, csg_vec3_make(0, 0, 1));
    csg_affine tilt = csg_affine_rotate(-above_deg, csg_vec3_make(1, 0, 0));
    csg_affine both = csg_affine_multiply(turn, tilt);
    camera c;
    c.right = csg_affine_vector(&both, csg_vec3_make(1, 0, 0));
    c.ahead = csg_affine_vector(&both, csg_vec3_make(0, 1, 0));
    c.up = csg_affine_vector(&both, csg_vec3_make(0, 0, 1));
    c.eye = csg_vec3_sub(center, csg_vec3_scale(c.ahead, distance));
    c.half = radius / sqrt(distance * distance - radius * radius);
    return c;
}

static csg_vec3 ray_of(const camera *c, unsigned x, unsigned y, unsigned size)
{
    double u = c->half * (2 * (x + 0.5) / size - 1), v = c->half * (1 - 2 * (y + 0.5) / size);
    csg_vec3 side = csg_vec3_add(csg_vec3_scale(c->right, u), csg_vec3_scale(c->up, v));
    return csg_vec3_normalize(csg_vec3_add(c->ahead, side));
}

/* Whether the ray hits. */
static bool trace(tracer *t, csg_vec3 eye, csg_vec3 along)
{
    csg_vec3 from = csg_vec3_sub(t->center, eye);
    double middle = csg_vec3_dot(from, along), end = middle + t->radius, s = 0;
    while (s < end) {
        csg_vec3 p = csg_vec3_add(eye, csg_vec3_scale(along, s));
        double f = csg_lazy_eval(t->lazy, p, t->scratch, &t->counts).value;
        if (f >= -t->tolerance)
            return true;
        s += -f / t->lambda;
    }
    return false;
}

static void trace_views(tracer *t, unsigned views, unsigned size, bool *hits)
{
    for (unsigned view = 0; view < views; view++) {
        camera c = camera_at(t->center, t->radius, 360.0 * view / views);
        for (unsigned y = 0; y < size; y++)
            for (unsigned x = 0; x < size; x++) {
                *hits = trace(t, c.eye, ray_of(&c, x, y, size));
                t->hits += *hits++;
            }
    }
}

static bool measure(const csgm_scene *scene, const char *name, unsigned views, unsigned size)
{
    csg_box box = csg_bounds_of_solid(scene);
    size_t rays = (size_t)views * size * size, differ = 0;
    bool *plain = calloc(rays, 1), *hits = calloc(rays, 1), ok = plain && hits;
    for (int m = 0; ok && m < METHODS; m++) {
        csg_lazy_options options = methods[m].options;
        csg_lazy *lazy = NULL;
        tracer t = {.center = csg_box_center(box),
                    .radius = csg_vec3_norm(csg_box_size(box)) / 2,
                    .lambda = csg_scene_lipschitz(scene)};
        t.tolerance = TOLERANCE * t.radius;
        options.band = BAND * t.radius;
        ok = csg_box_is_finite(box) && csg_lazy_create(scene, &options, &lazy) == CSGM_OK;
        t.lazy = lazy;
        t.scratch = ok ? malloc(csg_lazy_scratch_bytes(lazy)) : NULL;
        ok = t.scratch;
        clock_t start = clock();
        if (ok)
            trace_views(&t, views, size, m ? hits : plain);
        for (size_t i = differ = 0; m && i < rays; i++)
            differ += hits[i] != plain[i];
        if (ok)
            printf("%s\t%s\t%llu\t%zu\t%llu\t%llu\t%llu\t%zu\t%.3f\n", name, methods[m].name,
                   (unsigned long long)csg_lazy_node_count(lazy), rays, (unsigned long long)t.hits,
                   (unsigned long long)t.counts.top_level, (unsigned long long)t.counts.total,
                   differ, (double)(clock() - start) / CLOCKS_PER_SEC);
        free(t.scratch);
        csg_lazy_destroy(lazy);
    }
    free(plain);
    free(hits);
    return ok;
}

static bool measure_file(const char *path, unsigned views, unsigned size)
{
    csgm_context *context = NULL;
    csgm_scene *scene = NULL;
    bool ok = csgm_context_create(NULL, &context) == CSGM_OK &&
              csgm_scene_load(context, path, NULL, &scene) == CSGM_OK &&
              measure(scene, path, views, size);
    if (!ok)
        fprintf(stderr, "evaluations: cannot measure '%s'\n", path);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
    return ok;
}

int main(int argc, char **argv)
{
    unsigned views = 36, size = 120;
    for (int i = 1; i < argc; i++) {
        bool is_views = !strcmp(argv[i], "--views"), is_size = !strcmp(argv[i], "--size");
        if ((is_views || is_size) && i + 1 < argc) {
            *(is_views ? &views : &size) = (unsigned)strtoul(argv[++i], NULL, 10);
        } else if (!measure_file(argv[i], views, size)) {
            return 2;
        }
    }
    return 0;
}
