/* SPDX-License-Identifier: MIT
 * Random solids at random places: what csgm_clearances proves of them against exact distances of
 * meshes within E of them (CGAL). against_meshes SOLIDS PAIRS SEED. No answer may be wrong by more
 * than 2 E.
 */
#include "clearance_support.h"

#include <stdlib.h>

#include "base/geometry.h"
#include "base/random.h"
#ifdef HAVE_CGAL
#include "mesh_distance.h"
#endif

enum { SKIPPED = 77, BODY = 2400, TEXT = 2 * BODY + 400 };

#ifdef HAVE_CGAL
static const double E = 0.02, T = 0.01;

typedef struct solid {
    char text[BODY];
    double *positions;
    uint32_t *indices;
    size_t vertex_count, triangle_count;
    double reach; /* farthest vertex from the origin */
} solid;

typedef struct placement {
    csg_vec3 at, turn;
} placement;

/* ---- solids ------------------------------------------------------------------------------------
 */

static double between(csg_random *r, double low, double high)
{
    return csg_random_uniform(r, low, high);
}

static csg_vec3 random_vector(csg_random *r, double size)
{
    double x = between(r, -size, size), y = between(r, -size, size);
    return csg_vec3_make(x, y, between(r, -size, size));
}

static void write_primitive(csg_random *r, char *out, size_t size)
{
    double a = between(r, 0.6, 3), b = between(r, 0.6, 3), c = between(r, 0.6, 3);
    switch (csg_random_below(r, 7)) {
    case 0:
        snprintf(out, size, "sphere(%.3f);", a);
        break;
    case 1:
        snprintf(out, size, "cube([%.3f, %.3f, %.3f], center = true);", 2 * a, 2 * b, 2 * c);
        break;
    case 2:
        snprintf(out, size, "cube([%.3f, %.3f, %.3f], center = true, round = 0.25);", 2 * a, 2 * b,
                 2 * c);
        break;
    case 3:
        snprintf(out, size, "cylinder(h = %.3f, r1 = %.3f, r2 = %.3f, center = true);", 2 * a, b,
                 c);
        break;
    case 4:
        snprintf(out, size, "capsule([0, 0, %.3f], [0, 0, %.3f], %.3f);", -a, a, 0.6 * b);
        break;
    case 5:
        snprintf(out, size, "torus(%.3f, %.3f);", 1 + a, 0.3 + 0.2 * b);
        break;
    default:
        snprintf(out, size, "ellipsoid([%.3f, %.3f, %.3f]);", a, b, c);
    }
}

/* Up to three primitives joined, cut or blended. */
static void write_solid(csg_random *r, char *out)
{
    static const char *const operators[] = {"union()", "difference()", "union(blend = 0.4)",
                                            "difference(blend = 0.3)",
                                            "union(blend = fillet(0.4))"};
    uint32_t count = 1 + csg_random_below(r, 3);
    size_t at = (size_t)snprintf(out, BODY, "%s {",
                                 count > 1 ? operators[csg_random_below(r, 5)] : "union()");
    for (uint32_t i = 0; i < count; i++) {
        char body[200];
        csg_vec3 p = random_vector(r, i ? 2 : 0.2), turn = random_vector(r, 180);
        write_primitive(r, body, sizeof body);
        at += (size_t)snprintf(out + at, BODY - at,
                               " translate([%.3f, %.3f, %.3f]) rotate([%.2f, %.2f, %.2f]) %s", p.x,
                               p.y, p.z, turn.x, turn.y, turn.z, body);
    }
    snprintf(out + at, BODY - at, " }");
}

/* False: it is empty, or its mesh is not proven to be within E. */
static bool make_mesh(csgm_context *context, solid *s)
{
    csgm_scene *scene = NULL;
    csgm_field *field = NULL;
    csgm_mesh *mesh = NULL;
    csgm_mesh_options options = csgm_mesh_options_default();
    csgm_mesh_stats stats = csgm_mesh_stats_default();
    options.tolerance = E;
    csgm_status status = csgm_scene_parse(context, s->text, strlen(s->text), "solid", NULL, &scene);
    if (status == CSGM_OK)
        status = csgm_field_compile(context, scene, &field);
    if (status == CSGM_OK)
        status = csgm_mesh_build(context, field, &options, &mesh, &stats);
    bool done =
        status == CSGM_OK && stats.max_distance_bound <= E && stats.max_distance_measured <= E;
    csgm_mesh_view view = {.vertex_count = 0};
    if (done)
        view = csgm_mesh_get_view(mesh);
    done = done && view.triangle_count > 0;
    if (done) {
        s->vertex_count = (size_t)view.vertex_count;
        s->triangle_count = (size_t)view.triangle_count;
        s->positions = malloc(3 * s->vertex_count * sizeof *s->positions);
        s->indices = malloc(3 * s->triangle_count * sizeof *s->indices);
        assert_true(s->positions && s->indices);
        memcpy(s->indices, view.indices, 3 * s->triangle_count * sizeof *s->indices);
        const double origin[3] = {view.origin.x, view.origin.y, view.origin.z};
        for (size_t i = 0; i < 3 * s->vertex_count; i++)
            s->positions[i] = origin[i % 3] + (double)view.positions[i];
        s->reach = 0;
        for (size_t i = 0; i < s->vertex_count; i++) {
            const double *p = s->positions + 3 * i;
            s->reach = fmax(s->reach, sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
        }
    }
    csgm_mesh_destroy(mesh);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    return done;
}

/* ---- pairs -------------------------------------------------------------------------------------
 */

static distance_mesh *place_mesh(const solid *s, const placement *p)
{
    csg_affine x = csg_affine_rotate(p->turn.x, csg_vec3_make(1, 0, 0));
    csg_affine y = csg_affine_rotate(p->turn.y, csg_vec3_make(0, 1, 0));
    csg_affine z = csg_affine_rotate(p->turn.z, csg_vec3_make(0, 0, 1));
    csg_affine all = csg_affine_multiply(csg_affine_translate(p->at),
                                         csg_affine_multiply(z, csg_affine_multiply(y, x)));
    double *moved = malloc(3 * s->vertex_count * sizeof *moved);
    assert_non_null(moved);
    for (size_t i = 0; i < s->vertex_count; i++) {
        const double *v = s->positions + 3 * i;
        csg_vec3 at = csg_affine_point(&all, csg_vec3_make(v[0], v[1], v[2]));
        memcpy(moved + 3 * i, (const double[3]){at.x, at.y, at.z}, 3 * sizeof *moved);
    }
    distance_mesh *m = distance_mesh_make(moved, s->vertex_count, s->indices, s->triangle_count);
    assert_non_null(m);
    free(moved);
    return m;
}

static void write_pair(const solid *a, const solid *b, const placement *p, char text[TEXT])
{
    snprintf(text, TEXT,
             "part(\"a\") %s part(\"b\") translate([%.17g, %.17g, %.17g]) rotate([%.17g, %.17g, "
             "%.17g]) %s",
             a->text, p->at.x, p->at.y, p->at.z, p->turn.x, p->turn.y, p->turn.z, b->text);
}

static double distance_at(const distance_mesh *m, csg_vec3 at)
{
    const double p[3] = {at.x, at.y, at.z};
    return distance_of_point(m, p);
}

/* In double, of the scene itself. */
static double reference_at(const char *text, csg_vec3 at)
{
    csgm_context *context = NULL;
    csgm_scene *scene = NULL;
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "solid", NULL, &scene), CSGM_OK);
    double value = csgm_scene_eval(scene, at, NULL);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
    return value;
}

/* A mesh is within E of the surface for certain, but the surface within E of the mesh only as
 * measured: a thin chip may be missing, or a bulge be farther away. Then the scene itself is asked,
 * part by part. */
static double reference_of_part(const char *text, int part, csgm_vec3 at)
{
    const char *b = strstr(text, "part(\"b\")");
    char first[TEXT];
    snprintf(first, sizeof first, "%.*s", (int)(b - text), text);
    return reference_at(part ? b : first, at);
}

static bool lost_something(const char *text, const csgm_clear_pair *p)
{
    return p->state == CSGM_CLEAR_INTERFERING && reference_of_part(text, 0, p->inside) > 0 &&
           reference_of_part(text, 1, p->inside) > 0;
}

static bool is_of_part(const char *text, int part, const distance_mesh *mesh, csgm_vec3 at)
{
    return distance_at(mesh, at) <= E || reference_of_part(text, part, at) >= 0;
}

/* What is wrong; NULL: nothing. distance: of the meshes. */
static const char *find_fault(const char *text, const csgm_clear_pair *p, const distance_mesh *a,
                              const distance_mesh *b, double distance)
{
    if (p->state == CSGM_CLEAR_INTERFERING)
        return distance > 2 * E ? "called interfering"
               : distance_at(a, p->inside) > E || distance_at(b, p->inside) > E
                   ? "the point inside both is not"
                   : NULL;
    if (p->state == CSGM_CLEAR_TOUCHING && distance > T + 2 * E)
        return "called touching";
    if (p->gap.low > distance + 2 * E)
        return "the lower bound is too large";
    if (p->gap.high < distance - 2 * E)
        return "the upper bound is too small";
    if (p->gap.high < 1e9 &&
        (!is_of_part(text, 0, a, p->nearest[0]) || !is_of_part(text, 1, b, p->nearest[1])))
        return "a nearest point is not of its part";
    return NULL;
}

typedef struct tally {
    uint32_t states[4], wrong, lost;
} tally;

static void try_pair(const solid *a, const solid *b, csg_random *r, tally *seen)
{
    static const char *const both[] = {"a", "b"};
    char text[TEXT];
    double nearest[2][3];
    csg_vec3 way = csg_vec3_normalize(random_vector(r, 1));
    placement none = {{0, 0, 0}, {0, 0, 0}};
    placement p = {csg_vec3_scale(way, between(r, 0.3, 1) * (a->reach + b->reach)),
                   random_vector(r, 180)};
    distance_mesh *of_a = place_mesh(a, &none), *of_b = place_mesh(b, &p);
    double distance = distance_of_meshes(of_a, of_b, nearest);
    if (distance > 0 && csg_random_below(r, 2)) { /* nearly in touch, on either side of it */
        csg_vec3 d = csg_vec3_make(nearest[1][0] - nearest[0][0], nearest[1][1] - nearest[0][1],
                                   nearest[1][2] - nearest[0][2]);
        double by = between(r, -4, 4) * E - csg_vec3_norm(d);
        p.at = csg_vec3_add(p.at, csg_vec3_scale(csg_vec3_normalize(d), by));
        distance_mesh_free(of_b);
        of_b = place_mesh(b, &p);
        distance = distance_of_meshes(of_a, of_b, nearest);
    }
    write_pair(a, b, &p, text);
    csgm_clear_options options = csgm_clear_options_default();
    options.tolerance = T;
    options.parts = both;
    options.part_count = 2;
    options.most_pairs = 1 << 17;
    csgm_clear_pair found = clear_pair(&options, text);
    const char *fault = find_fault(text, &found, of_a, of_b, distance);
    bool is_lost = fault && lost_something(text, &found);
    seen->states[found.state]++;
    seen->lost += is_lost;
    if (fault && !is_lost) {
        seen->wrong++;
        printf("%s: state %d, gap %.9g .. %.9g, of the meshes %.9g\n%s\n", fault, found.state,
               found.gap.low, found.gap.high, distance, text);
    }
    distance_mesh_free(of_a);
    distance_mesh_free(of_b);
}

static int search(uint32_t solids, uint32_t pairs, uint64_t seed)
{
    csg_random r = {seed};
    csgm_context *context = NULL;
    tally seen = {.wrong = 0};
    solid *all = calloc(solids, sizeof *all);
    assert_non_null(all);
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    for (uint32_t i = 0; i < solids;) {
        write_solid(&r, all[i].text);
        i += make_mesh(context, &all[i]);
    }
    csgm_context_destroy(context);
    for (uint32_t i = 0; i < pairs; i++) {
        uint32_t a = csg_random_below(&r, solids), b = csg_random_below(&r, solids);
        try_pair(&all[a], &all[b], &r, &seen);
    }
    for (uint32_t i = 0; i < solids; i++) {
        free(all[i].positions);
        free(all[i].indices);
    }
    free(all);
    printf("seed %llu: %u pairs, %u apart, %u touching, %u undecided, %u interfering, %u wrong; "
           "%u where a mesh lacks what is inside both\n",
           (unsigned long long)seed, pairs, seen.states[0], seen.states[1], seen.states[2],
           seen.states[3], seen.wrong, seen.lost);
    return seen.wrong || seen.states[0] < pairs / 8 || seen.states[3] < pairs / 8;
}
#endif

int main(int argc, char **argv)
{
    uint32_t solids = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 6;
    uint32_t pairs = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 60;
    uint64_t seed = argc > 3 ? strtoull(argv[3], NULL, 10) : 1;
#ifdef HAVE_CGAL
    return search(solids, pairs, seed);
#else
    printf("without CGAL %u solids and %u pairs of seed %llu are not looked at\n", solids, pairs,
           (unsigned long long)seed);
    return SKIPPED;
#endif
}
