/* SPDX-License-Identifier: MIT
 * Seven solids in random rotations at 64 cells against their closed forms (true_solids.h): vertices
 * on creases lie on the true curve, all vertices and flat faces on the true surface, every crease
 * and corner is in the mesh, polyhedra have their volume, no triangles cross, nothing stays smooth.
 *
 * On curved parts the chord's sagitta is what a triangle may be off by besides: its corners span an
 * angle phi around the axis, so no point of it is deeper than R (1 - cos(phi / 2)).
 *
 * Arguments: how many rotations of each solid (default 3), the first one's number (default 0).
 */
#include <stdarg.h>
#include <stdint.h>

#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "csgmesh/csgmesh.h"
#include "mesh/self_intersections.h"
#include "mesh/true_solids.h"

#define PI 3.14159265358979323846

enum { RESOLUTION = 64, MOST_POINTS = 512 };

static unsigned rotation_count = 3, first_rotation = 0;

/* What is measured, lengths in cells, and what is asked. Where a polygon stays smooth it cuts the
 * crease, and says so in the statistics: so many may be beyond for each of them. */
typedef enum measure {
    VERTEX_OFF_CREASE,  /* of a place with normals of several sheets: from the true curve */
    VERTEX_OFF_SURFACE, /* of any */
    FACE_OFF_SURFACE,   /* of a point of a triangle, less the sagitta */
    CORNER_MISSED,      /* from a true corner or tip to the nearest vertex */
    CREASE_MISSED,      /* from a point of a true crease to the nearest edge, less the sagitta */
    VOLUME,             /* of polyhedra, relative */
    MEASURES
} measure;

static const struct {
    const char *name;
    double allowed;
    unsigned for_smooth;
} asked[MEASURES] = {
    {"vertices off their crease", 1e-4, 1},  {"vertices off the surface", 1e-3, 1},
    {"triangles off the surface", 1e-3, 24}, {"corners missed", 1e-4, 1},
    {"places of creases missed", 1e-3, 8},   {"volume", 1e-5, 1},
};

#define NEAR 0.1 /* of a curved part, in cells: a chord's sagitta is less */

/* As measured, in the order of true_solids. Of
 * fifty rotations together at most so many polygons left smooth, rotations with more than one
 * piece, and measures beyond what is asked with no polygon left smooth to account for them; and of
 * each rotation, polygons in which a crease fades: where two cylinders touch, the angle between
 * them falls to nothing, and a crease ends where it is below 3 degrees. */
static const struct {
    unsigned smooth, pieces, unsaid, fading;
} most_of[] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0},
               {0, 0, 0, 8}, {0, 0, 0, 0}, {9, 0, 0, 0}};

/* Of fewer rotations: three times their share, since they differ. */
static uint64_t at_most(unsigned of_fifty)
{
    return (uint64_t)ceil(of_fifty * fmin(1, 3.0 * rotation_count / 50));
}

typedef struct tally {
    double most; /* of those within what is allowed */
    uint64_t beyond;
} tally;

typedef struct record {
    tally of[MEASURES];
    uint64_t smooth, features;
    unsigned smooth_rotations, pieces; /* rotations with such polygons, with several pieces */
    uint64_t unsaid;                   /* beyond, and not for a polygon left smooth */
} record;

static void add(record *r, measure what, double off)
{
    if (off <= asked[what].allowed)
        r->of[what].most = fmax(r->of[what].most, off);
    else
        r->of[what].beyond++;
}

/* One rotation of a solid and its mesh, in the solid's own frame. */
typedef struct pose {
    const true_solid *solid;
    csgm_context *context;
    csgm_mesh_stats stats;
    csgm_mesh_check check;
    csg_vec3 *at; /* a place each: copies at creases are one */
    bool *is_crease;
    uint32_t *corner; /* 3 per triangle */
    size_t vertex_count, triangle_count, crease_count;
    long long crossings; /* pairs of triangles that cross */
    char what[64];
} pose;

/* ---- the mesh --------------------------------------------------------------------------------
 */

/* rotate([a, b, c]) of the language: about x, then y, then z. Its columns. */
static void rotation(const double degrees[3], csg_vec3 column[3])
{
    double c[3], s[3];
    for (int i = 0; i < 3; i++) {
        c[i] = cos(degrees[i] * PI / 180);
        s[i] = sin(degrees[i] * PI / 180);
    }
    column[0] = (csg_vec3){c[2] * c[1], s[2] * c[1], -s[1]};
    column[1] =
        (csg_vec3){c[2] * s[1] * s[0] - s[2] * c[0], s[2] * s[1] * s[0] + c[2] * c[0], c[1] * s[0]};
    column[2] =
        (csg_vec3){c[2] * s[1] * c[0] + s[2] * s[0], s[2] * s[1] * c[0] - c[2] * s[0], c[1] * c[0]};
}

static csgm_mesh *build(pose *p, const double degrees[3])
{
    char text[512];
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh *mesh;
    snprintf(text, sizeof text, "rotate([%.17g, %.17g, %.17g]) %s", degrees[0], degrees[1],
             degrees[2], p->solid->text);
    assert_int_equal(csgm_scene_parse(p->context, text, strlen(text), "rotated.txt", NULL, &scene),
                     CSGM_OK);
    assert_int_equal(csgm_field_compile(p->context, scene, &field), CSGM_OK);
    csgm_mesh_options options = csgm_mesh_options_default();
    options.resolution = RESOLUTION;
    options.normals = CSGM_NORMALS_CREASE;
    p->stats = csgm_mesh_stats_default();
    assert_int_equal(csgm_mesh_build(p->context, field, &options, &mesh, &p->stats), CSGM_OK);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    return mesh;
}

/* Copies at a crease come one after the other: a place that has them is on a crease. */
static void take(pose *p, const csgm_mesh_view *view, const csg_vec3 column[3])
{
    uint32_t *to = malloc(view->vertex_count * sizeof *to);
    float *places = malloc(3 * view->vertex_count * sizeof *places);
    p->at = malloc(view->vertex_count * sizeof *p->at);
    p->is_crease = calloc(view->vertex_count, sizeof *p->is_crease);
    p->corner = malloc(3 * view->triangle_count * sizeof *p->corner);
    assert_true(to && places && p->at && p->is_crease && p->corner);
    for (size_t i = 0; i < view->vertex_count; i++) {
        const float *v = view->positions + 3 * i;
        if (i > 0 && memcmp(v, v - 3, 3 * sizeof *v) == 0) {
            to[i] = to[i - 1];
            p->crease_count += !p->is_crease[to[i]];
            p->is_crease[to[i]] = true;
            continue;
        }
        csg_vec3 w =
            csg_vec3_add(view->origin, (csg_vec3){(double)v[0], (double)v[1], (double)v[2]});
        memcpy(places + 3 * p->vertex_count, v, 3 * sizeof *v);
        p->at[p->vertex_count] = (csg_vec3){csg_vec3_dot(column[0], w), csg_vec3_dot(column[1], w),
                                            csg_vec3_dot(column[2], w)};
        to[i] = (uint32_t)p->vertex_count++;
    }
    p->triangle_count = view->triangle_count;
    for (size_t i = 0; i < 3 * p->triangle_count; i++)
        p->corner[i] = to[view->indices[i]];
    csgm_mesh_view joined = {.positions = places,
                             .indices = p->corner,
                             .vertex_count = p->vertex_count,
                             .triangle_count = p->triangle_count};
    assert_int_equal(csgm_mesh_inspect(p->context, &joined, &p->check), CSGM_OK);
#ifdef HAVE_CGAL
    p->crossings =
        test_self_intersections(places, p->vertex_count, p->corner, p->triangle_count, NULL, 0);
#endif
    free(places);
    free(to);
}

static void pose_begin(pose *p, const true_solid *solid, unsigned number)
{
    csg_random random = {1000 + number};
    double degrees[3];
    csg_vec3 column[3];
    memset(p, 0, sizeof *p);
    p->solid = solid;
    snprintf(p->what, sizeof p->what, "%s, rotation %u", solid->name, number);
    for (int i = 0; i < 3; i++)
        degrees[i] = csg_random_uniform(&random, 0, 360);
    rotation(degrees, column);
    assert_int_equal(csgm_context_create(NULL, &p->context), CSGM_OK);
    csgm_mesh *mesh = build(p, degrees);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    take(p, &view, column);
    csgm_mesh_destroy(mesh);
}

static void pose_end(pose *p)
{
    free(p->at);
    free(p->is_crease);
    free(p->corner);
    csgm_context_destroy(p->context);
}

/* ---- distances -------------------------------------------------------------------------------
 */

static void check_closed(const pose *p)
{
    const csgm_mesh_check *k = &p->check;
    uint64_t faults = k->boundary_edges + k->nonmanifold_edges + k->misoriented_edges +
                      k->nonmanifold_vertices + k->degenerate_triangles + k->unused_vertices;
    if (faults)
        fail_msg("%s: not a closed oriented manifold", p->what);
    if (k->genus != p->solid->genus)
        fail_msg("%s: genus %lld", p->what, (long long)k->genus);
    if (p->crossings)
        fail_msg("%s: %lld pairs of triangles cross", p->what, p->crossings);
    assert_true(p->crease_count <= p->stats.feature_vertices);
}

static void check_vertices(const pose *p, record *r)
{
    double cell = p->stats.cell_size;
    for (size_t i = 0; i < p->vertex_count; i++) {
        add(r, VERTEX_OFF_SURFACE, p->solid->kind.surface(p->solid, p->at[i]) / cell);
        if (p->is_crease[i])
            add(r, VERTEX_OFF_CREASE, p->solid->kind.crease(p->solid, p->at[i]) / cell);
    }
}

/* Largest R (1 - cos(phi / 2)) of the corners that lie on one of the solid's curved parts. */
static double sagitta_on(const true_round *round, const csg_vec3 corner[3], double near)
{
    csg_vec3 u = fabs(round->axis.z) > 0.5 ? (csg_vec3){1, 0, 0} : (csg_vec3){0, 0, 1};
    csg_vec3 v = csg_vec3_cross(round->axis, u);
    double first = 0, low = 0, high = 0, most = 0;
    int count = 0;
    for (int i = 0; i < 3; i++) {
        csg_vec3 d = csg_vec3_sub(corner[i], round->at);
        double x = csg_vec3_dot(d, u), y = csg_vec3_dot(d, v), r = hypot(x, y);
        double radius = round->r0 + round->slope * csg_vec3_dot(d, round->axis);
        if (fabs(r - radius) > near || r < 1e-2 * near)
            continue;
        double angle = atan2(y, x);
        if (count++ == 0)
            first = angle;
        double turn = remainder(angle - first, 2 * PI);
        low = fmin(low, turn);
        high = fmax(high, turn);
        most = fmax(most, radius);
    }
    return count < 2 ? 0 : most * (1 - cos(fmin(high - low, 2 * PI) / 2));
}

static double sagitta(const true_solid *solid, const csg_vec3 corner[3], double near)
{
    double most = 0;
    for (size_t i = 0; i < solid->round_count; i++)
        most = fmax(most, sagitta_on(&solid->round[i], corner, near));
    return most * solid->chord;
}

/* Points of every triangle: its middle, and beside edges and corners. */
static void check_faces(const pose *p, record *r)
{
    static const double weight[7][3] = {{1, 1, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1},
                                        {4, 1, 1}, {1, 4, 1}, {1, 1, 4}};
    double cell = p->stats.cell_size;
    for (size_t t = 0; t < p->triangle_count; t++) {
        csg_vec3 corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = p->at[p->corner[3 * t + (size_t)k]];
        double allowed = sagitta(p->solid, corner, NEAR * cell);
        double most = 0;
        for (int i = 0; i < 7; i++) {
            const double *w = weight[i];
            csg_vec3 sum = csg_vec3_add(
                csg_vec3_scale(corner[0], w[0]),
                csg_vec3_add(csg_vec3_scale(corner[1], w[1]), csg_vec3_scale(corner[2], w[2])));
            csg_vec3 at = csg_vec3_scale(sum, 1 / (w[0] + w[1] + w[2]));
            most = fmax(most, p->solid->kind.surface(p->solid, at) - allowed);
        }
        add(r, FACE_OFF_SURFACE, most / cell);
    }
}

static double to_edge(csg_vec3 p, csg_vec3 a, csg_vec3 b)
{
    csg_vec3 u = csg_vec3_sub(b, a), v = csg_vec3_sub(p, a);
    double t = csg_vec3_dot(u, v) / fmax(csg_vec3_dot(u, u), 1e-300);
    return csg_vec3_norm(csg_vec3_sub(v, csg_vec3_scale(u, fmin(fmax(t, 0), 1))));
}

/* To the nearest edge of the mesh and, in *vertex, the nearest vertex; both at most `reach`. */
static double to_mesh_edges(const pose *p, csg_vec3 q, double reach, double *vertex)
{
    double nearest = reach;
    *vertex = reach;
    for (size_t t = 0; t < p->triangle_count; t++) {
        const uint32_t *c = p->corner + 3 * t;
        csg_vec3 d = csg_vec3_sub(p->at[c[0]], q);
        if (fabs(d.x) > 2 * reach || fabs(d.y) > 2 * reach || fabs(d.z) > 2 * reach)
            continue;
        for (int k = 0; k < 3; k++) {
            csg_vec3 a = p->at[c[k]], b = p->at[c[(k + 1) % 3]];
            nearest = fmin(nearest, to_edge(q, a, b));
            *vertex = fmin(*vertex, csg_vec3_norm(csg_vec3_sub(a, q)));
        }
    }
    return nearest;
}

/* The other way: the mesh has every corner and, as an edge, every crease. The chord of a curved one
 * may span two cells. */
static void check_creases(const pose *p, record *r)
{
    csg_vec3 *points = malloc(8 * MOST_POINTS * sizeof *points);
    assert_non_null(points);
    size_t corners,
        count = p->solid->kind.points(p->solid, points, (size_t)8 * MOST_POINTS, &corners);
    double cell = p->stats.cell_size, least = INFINITY, vertex;
    for (size_t i = 0; i < p->solid->round_count; i++)
        least = fmin(least, p->solid->round[i].slope != 0 ? 5 : p->solid->round[i].r0);
    double allowed = p->solid->chord * 4 * cell * cell / (8 * least);
    for (size_t i = 0; i < corners; i++) {
        to_mesh_edges(p, points[i], 2 * cell, &vertex);
        add(r, CORNER_MISSED, vertex / cell);
    }
    size_t step = (count - corners) / MOST_POINTS + 1;
    for (size_t i = corners; i < count; i += step) {
        double off = to_mesh_edges(p, points[i], 2 * cell, &vertex);
        add(r, CREASE_MISSED, fmax(off - allowed, 0) / cell);
    }
    free(points);
}

/* ---- what is asked ---------------------------------------------------------------------------
 */

static void check_rotation(const true_solid *solid, unsigned number, record *all)
{
    pose p;
    record r = {0};
    pose_begin(&p, solid, number);
    check_closed(&p);
    check_vertices(&p, &r);
    check_faces(&p, &r);
    check_creases(&p, &r);
    if (solid->volume > 0)
        add(&r, VOLUME, fabs(p.check.volume / solid->volume - 1));
    all->smooth += p.stats.smooth_features;
    all->features += p.stats.feature_vertices;
    all->smooth_rotations += p.stats.smooth_features > 0;
    all->pieces += p.check.components != 1;
    for (int i = 0; i < MEASURES; i++) {
        uint64_t cut = p.stats.smooth_features + most_of[solid - true_solids].fading;
        uint64_t said = asked[i].for_smooth * cut;
        if (r.of[i].beyond > said) {
            print_message("%s: %llu %s, and %llu polygons stay smooth\n", p.what,
                          (unsigned long long)r.of[i].beyond, asked[i].name,
                          (unsigned long long)p.stats.smooth_features);
            all->unsaid += r.of[i].beyond - said;
        }
        all->of[i].most = fmax(all->of[i].most, r.of[i].most);
        all->of[i].beyond += r.of[i].beyond;
    }
    pose_end(&p);
}

static void print_record(const char *name, const record *r)
{
    print_message(
        "%s: %llu polygons smooth beside %llu apexes, in %u of %u rotations; in pieces in "
        "%u\n",
        name, (unsigned long long)r->smooth, (unsigned long long)r->features, r->smooth_rotations,
        rotation_count, r->pieces);
    for (int i = 0; i < MEASURES; i++)
        print_message("    %s: %llu; the others at most %.1e\n", asked[i].name,
                      (unsigned long long)r->of[i].beyond, r->of[i].most);
}

static void test_solid(void **state)
{
    size_t index = (size_t)(uintptr_t)*state;
    record all = {0};
    for (unsigned i = first_rotation; i < first_rotation + rotation_count; i++)
        check_rotation(&true_solids[index], i, &all);
    print_record(true_solids[index].name, &all);
    /* the shares are those of the rotations that are always the same */
    if (first_rotation == 0)
        assert_true(all.smooth <= at_most(most_of[index].smooth));
    assert_true(all.pieces <= at_most(most_of[index].pieces));
    assert_true(all.unsaid <= at_most(most_of[index].unsaid));
}

int main(int argc, char **argv)
{
    if (argc > 1)
        rotation_count = (unsigned)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_rotation = (unsigned)strtoul(argv[2], NULL, 10);
    struct CMUnitTest tests[16] = {{0}};
    for (size_t i = 0; i < true_solid_count && i < 16; i++)
        tests[i] =
            (struct CMUnitTest){true_solids[i].name, test_solid, NULL, NULL, (void *)(uintptr_t)i};
    return _cmocka_run_group_tests("rotations", tests, true_solid_count, NULL, NULL);
}
