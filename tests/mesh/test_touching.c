/* SPDX-License-Identifier: MIT
 * Solids that touch in a plane and are flush there (mesh/distance/touching.h): what stands for
 * their field has its sign, and is flat nowhere but at the surface; and nothing stands for it where
 * they are almost flush, or almost touch. And their seam is a crease that the search for missed
 * parts looks along.
 */
#include <stdlib.h>
#include <string.h>

#include "mesh/distance/missed.h"
#include "mesh/distance/slopes.h"
#include "mesh/mesh_support.h"
#include "mesh/pipeline/workers.h"
#include "scene/warp_kinds.h"

enum { SOLIDS = 40, PLACES = 40, TRIES = 40 };

/* How the second half is no mirror image of the first. */
typedef struct difference {
    double shift, gap; /* along the plane; between them */
    double lean_deg;   /* of the second one's plane */
    double width;      /* of the union's blend */
} difference;

static const difference FLUSH = {0, 0, 0, 0};

/* A solid that is another one in each height, far larger than what is looked at beside its middle.
 */
static csg_node_id make_part(mesh_case *c, csg_random *random, bool is_warped)
{
    csg_node_id box = make_box(c, 0.5, 0.3, 0.9);
    csg_node_id tower = turned(c, make_cylinder(c, 0.4, 1.5), csg_random_uniform(random, 10, 40),
                               csg_vec3_make(csg_random_uniform(random, 0.2, 1), 1, 0));
    tower = moved(c, tower, csg_random_uniform(random, 0, 0.4), 0.1, 0);
    csg_node_id part = joined(c, CSG_NODE_UNION, ROUND(0.2), box, tower);
    if (is_warped) {
        const csg_warp twist = {.kind = CSG_WARP_TWIST, .parameters = {25, -3, 3}};
        part = csg_build_bare_warp(&c->builder, &twist, part, NOWHERE);
    }
    return part;
}

/* Two halves above and below z = 0, each the other one's mirror image; cavities: what is left of
 * space without them. */
static csg_node_id make_halves(mesh_case *c, csg_random *random, const difference *by,
                               bool are_cavities, bool are_warped)
{
    csg_random again = *random;
    csg_node_kind cut = are_cavities ? CSG_NODE_UNION : CSG_NODE_INTERSECTION;
    csg_node_kind join = are_cavities ? CSG_NODE_INTERSECTION : CSG_NODE_UNION;
    double side = are_cavities ? 1 : -1;
    csg_node_id first = make_part(c, random, are_warped);
    csg_node_id second = make_part(c, &again, are_warped);
    csg_affine mirror = csg_affine_mirror(csg_vec3_make(0, 0, 1));
    first = joined(c, cut, SHARP, first, make_half_space(c, 0, 0, side, 0));
    second = joined(c, cut, SHARP, second, make_half_space(c, 0, 0, side, -by->gap));
    second = csg_build_transform(&c->builder, &mirror, second, NOWHERE);
    second = turned(c, second, by->lean_deg, csg_vec3_make(1, 0, 0));
    second = moved(c, second, by->shift, 0, 0);
    return joined(c, join, by->width > 0 ? ROUND(by->width) : SHARP, first, second);
}

typedef struct bench {
    mesh_case c;
    const csg_kernel *kernel;
    float *scratch;
    size_t floats;
} bench;

static void begin_bench(bench *b, csg_random *random, const difference *by, bool are_cavities,
                        bool are_warped)
{
    mesh_case_begin(&b->c, 1);
    mesh_case_compile(&b->c, make_halves(&b->c, random, by, are_cavities, are_warped));
    b->kernel = csg_kernel_for(CSGM_ISA_AUTO);
    b->floats = csg_kernel_scratch_floats(b->c.field->depth);
    b->scratch = malloc(b->floats * sizeof *b->scratch);
    assert_non_null(b->scratch);
}

static void end_bench(bench *b)
{
    free(b->scratch);
    mesh_case_end(&b->c);
}

static double value_of(const bench *b, const csg_touching *t, csg_vec3 at)
{
    float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES], f[CSG_LANES];
    for (int i = 0; i < CSG_LANES; i++)
        x[i] = (float)at.x, y[i] = (float)at.y, z[i] = (float)at.z;
    csg_touching_values(t, b->kernel, x, y, z, 1, f, b->scratch, b->floats);
    return (double)f[0];
}

/* The sign of the reference, no nearer to zero; and what the gradients of a ball say of it. */
static void check_place(const bench *b, const csg_touching *t, csg_random *random, csg_vec3 c,
                        double radius)
{
    const csg_gradients_region region = {{c, c, c}, c, radius, 0};
    csg_gradients found, *to = &found;
    bool is_known;
    csg_cone cone;
    csg_gradients_find_each(b->kernel, t, &region, 1, b->scratch, b->floats, &to, &is_known);
    bool climbs = is_known && csg_gradients_find_axis(&found, &cone);
    for (int i = 0; i < TRIES; i++) {
        csg_vec3 d =
            csg_vec3_scale(test_direction(random), radius * csg_random_uniform(random, 0, 0.99));
        csg_vec3 p = csg_vec3_add(c, d);
        double f = test_sample(b->c.scene, csg_vec3_add(p, b->c.field->center)).value;
        double h = value_of(b, t, p);
        if (fabs(f) > 1e-5 && (f > 0) != (h > 0))
            fail_msg("%g stands for %g at (%g, %g, %g)", h, f, p.x, p.y, p.z);
        assert_true(fabs(f) <= fabs(h) + 1e-5);
        if (!climbs)
            continue;
        csg_vec3 axis = {cone.axis[0], cone.axis[1], cone.axis[2]};
        double length = (radius - csg_vec3_norm(d)) * csg_random_uniform(random, 0, 1);
        double climb = value_of(b, t, csg_vec3_add(p, csg_vec3_scale(axis, length))) - h;
        if (climb < (cone.least - 1e-3) * length - 1e-5)
            fail_msg("it climbs by %g and not %g near (%g, %g, %g)", climb / length, cone.least,
                     c.x, c.y, c.z);
    }
}

/* A place of the surface near the plane, from outside. */
static csg_vec3 go_to_seam(const bench *b, csg_random *random)
{
    csg_vec3 at = test_direction(random);
    at.z = csg_random_uniform(random, -0.02, 0.02);
    for (int step = 0; step < 8; step++) {
        csg_sample s = test_sample(b->c.scene, at);
        double square = s.gradient.x * s.gradient.x + s.gradient.y * s.gradient.y;
        at.x -= square > 0.1 ? s.gradient.x * s.value / square : 0;
        at.y -= square > 0.1 ? s.gradient.y * s.value / square : 0;
    }
    return at;
}

/* Whether something stands for the field around places near the seam, and how often gradients have
 * a direction in common there that those of the field do not have. */
static void look_at_seam(const bench *b, csg_random *random, int *there, int *clearer)
{
    *there = *clearer = 0;
    for (int i = 0; i < PLACES; i++) {
        csg_vec3 at = go_to_seam(b, random);
        csg_vec3 c = csg_vec3_sub(at, b->c.field->center);
        const csg_tape *tape = &b->c.field->tape;
        double radius = 0.03;
        csg_touching t = csg_touching_find(b->kernel, tape, c, radius), none;
        *there += t.is_there;
        if (!t.is_there)
            continue;
        check_place(b, &t, random, c, radius);
        none = csg_touching_none(tape);
        const csg_gradients_region region = {{c, c, c}, c, radius, 0};
        csg_gradients with, without, *to = &with;
        bool is_known, was_known;
        csg_gradients_find_each(b->kernel, &t, &region, 1, b->scratch, b->floats, &to, &is_known);
        to = &without;
        csg_gradients_find_each(b->kernel, &none, &region, 1, b->scratch, b->floats, &to,
                                &was_known);
        csg_cone cone;
        *clearer += is_known && csg_gradients_find_axis(&with, &cone) &&
                    !(was_known && csg_gradients_find_axis(&without, &cone));
    }
}

static void halves_are_one_solid(void **state)
{
    (void)state;
    csg_random random = {.state = 5};
    int all = 0, all_clearer = 0;
    for (int i = 0; i < SOLIDS; i++) {
        bench b;
        int there, clearer;
        begin_bench(&b, &random, &FLUSH, i % 2, i % 4 > 1);
        look_at_seam(&b, &random, &there, &clearer);
        all += there;
        all_clearer += clearer;
        end_bench(&b);
    }
    assert_int_equal(all, SOLIDS * PLACES);
    assert_true(4 * all_clearer > all);
}

/* A thousandth of their size is more than rounding. */
static void almost_is_not_at_all(void **state)
{
    (void)state;
    static const difference differences[] = {
        {1e-3, 0, 0, 0}, {0, 1e-3, 0, 0}, {0, -1e-3, 0, 0}, {0, 0, 0.06, 0}, {0, 0, 0, 0.05}};
    csg_random random = {.state = 6};
    for (int i = 0; i < SOLIDS; i++) {
        bench b;
        int there, clearer;
        begin_bench(&b, &random, &differences[i % 5], i % 2, i % 4 > 1);
        look_at_seam(&b, &random, &there, &clearer);
        assert_int_equal(there, 0);
        end_bench(&b);
    }
}

/* ---- the seam as a crease ---------------------------------------------------------------------
 */

static const double RADIUS = 0.5, LEAN_DEG = 24;

/* Two that lean to one another: smooth but for the seam. */
static csg_node_id make_bent_bar(mesh_case *c)
{
    csg_affine mirror = csg_affine_mirror(csg_vec3_make(0, 0, 1));
    csg_node_id halves[2];
    for (int i = 0; i < 2; i++) {
        csg_vec3 low = {0, 0, -2}, high = {0, 0, 0.8};
        csg_node_id bar = csg_build_capsule(&c->builder, low, high, RADIUS, RADIUS, NOWHERE);
        bar = turned(c, bar, LEAN_DEG, csg_vec3_make(1, 0, 0));
        halves[i] = joined(c, CSG_NODE_INTERSECTION, SHARP, bar, make_half_space(c, 0, 0, -1, 0));
    }
    halves[1] = csg_build_transform(&c->builder, &mirror, halves[1], NOWHERE);
    return joined(c, CSG_NODE_UNION, SHARP, halves[0], halves[1]);
}

/* The farthest place of the seam from a mesh. */
static double farthest_of_seam(const csg_remesh *r, csg_vec3 center)
{
    enum { STEPS = 4000 };
    double most = 0;
    for (int i = 0; i < STEPS; i++) {
        double turn = 2 * 3.14159265358979 * i / STEPS;
        csg_vec3 at = {RADIUS * cos(turn), RADIUS * sin(turn) / cos(LEAN_DEG * 0.0174532925199433),
                       0};
        uint32_t triangle;
        double away = csg_triangle_tree_nearest(&r->tree, csg_vec3_sub(at, center), 1, &triangle);
        most = fmax(most, away);
    }
    return most;
}

typedef struct search {
    mesh_case c;
    csgm_mesh_options options;
    csg_mesh_input input;
    csg_mesh_workers workers;
    csg_mesh_watch watch;
} search;

static void begin_search(search *s, uint32_t cells, csg_node_id make(mesh_case *c))
{
    memset(s, 0, sizeof *s);
    mesh_case_begin(&s->c, 2);
    mesh_case_compile(&s->c, make(&s->c));
    s->options = mesh_options(cells);
    s->options.normals = false;
    s->options.features = CSGM_FEATURES_SMOOTH;
    s->input =
        (csg_mesh_input){.context = &s->c.context, .options = &s->options, .field = s->c.field};
    csg_mesh_input_watch(&s->input, 0, &s->watch);
    assert_int_equal(csg_mesh_input_complete(&s->input), CSGM_OK);
    assert_int_equal(csg_mesh_workers_create(&s->workers, &s->input), CSGM_OK);
    assert_int_equal(mesh_build(&s->c, &s->options), CSGM_OK);
}

static void end_search(search *s)
{
    csg_mesh_workers_release(&s->workers);
    csg_mesh_input_release(&s->input);
    mesh_case_end(&s->c);
}

/* How far what is found is from a mesh, which may be another solid's. error: 0 = a little less than
 * the seam is away, in place of which *seam is then. */
static double farthest_found(search *s, const csgm_mesh *mesh, double error, double *seam)
{
    csg_remesh r;
    csg_missed missed;
    const csg_missed_before none = {0};
    uint8_t *kinds = calloc(1, (size_t)mesh->vertex_count);
    assert_non_null(kinds);
    const csg_remesh_origin origin = {.kinds = kinds};
    csgm_mesh *copy;
    assert_int_equal(csg_mesh_create(&s->c.context, mesh->vertex_count, mesh->triangle_count, false,
                                     false, &copy),
                     CSGM_OK);
    copy->origin = mesh->origin;
    memcpy(copy->indices, mesh->indices, 3 * mesh->triangle_count * sizeof *mesh->indices);
    memcpy(copy->positions, mesh->positions, 3 * mesh->vertex_count * sizeof *mesh->positions);
    assert_int_equal(csg_remesh_begin(&r, copy, &origin, &s->workers.marching, &s->watch), CSGM_OK);
    *seam = farthest_of_seam(&r, s->c.field->center);
    error = error > 0 ? error : *seam / 1.2;
    assert_int_equal(csg_missed_find(&r, error, &none, false, &missed), CSGM_OK);
    double farthest = missed.distances.farthest;
    csg_missed_release(&missed, &s->c.context.memory);
    csg_mesh_destroy(r.mesh);
    csg_remesh_end(&r);
    free(kinds);
    return farthest;
}

/* A mesh that cuts the seam off, as one of smooth cells does, has missed it. */
static void seams_are_looked_along(void **state)
{
    (void)state;
    for (uint32_t cells = 12; cells < 52; cells++) {
        search s;
        double seam;
        begin_search(&s, cells, make_bent_bar);
        double farthest = farthest_found(&s, s.c.mesh, 0, &seam);
        if (farthest < 0.9 * seam)
            fail_msg("the seam is %g away, and not %g, of %u cells", seam, farthest, cells);
        end_search(&s);
    }
}

static const double SMALL = 0.01;

/* With a bubble, so many radii above the plane. */
static csg_node_id with_bubble(mesh_case *c, double height)
{
    csg_node_id ball = moved(c, make_sphere(c, SMALL), 0.1, 0.2, height * SMALL);
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_bent_bar(c), ball);
}

static csg_node_id make_bubble_beside(mesh_case *c)
{
    return with_bubble(c, 1.01);
}

static csg_node_id make_bubble_below(mesh_case *c)
{
    return with_bubble(c, -1.01);
}

static csg_node_id make_bubble_across(mesh_case *c)
{
    return with_bubble(c, 0.2);
}

/* Beside the plane there may be more of which a mesh has nothing. */
static void bubbles_beside_it_are_found(void **state)
{
    (void)state;
    csg_node_id (*const makes[])(mesh_case *) = {make_bubble_beside, make_bubble_below,
                                                 make_bubble_across};
    for (int i = 0; i < 3; i++) {
        search whole, bare;
        double seam;
        begin_search(&bare, 40, make_bent_bar);
        begin_search(&whole, 40, makes[i]);
        double farthest = farthest_found(&whole, bare.c.mesh, SMALL / 4, &seam);
        assert_true(farthest > 0.1 && farthest > 2 * seam);
        end_search(&whole);
        end_search(&bare);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(halves_are_one_solid),
        cmocka_unit_test(almost_is_not_at_all),
        cmocka_unit_test(seams_are_looked_along),
        cmocka_unit_test(bubbles_beside_it_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
