/* SPDX-License-Identifier: MIT
 * Cones of gradients hold: what cone.h promises of a ball, tried at random points of it, for every
 * kind of leaf and operator. Arguments: scenes of each kind, 24 by default.
 */
#include <stdlib.h>

#include "field/cones/cone.h"
#include "mesh/distance/slopes.h"
#include "mesh/distance/steps.h"
#include "mesh/mesh_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/random_formula.h"
#include "scene/star.h"
#include "shape/polyhedra/polyhedron.h"

static uint32_t scene_count = ROUNDS(24), range_count = 0, step_count = 0, smooth_count = 0;

enum { TRIES = 60 };

/* A cone's promise, tried at random points of its ball. Returns whether there was a cone. */
static bool try_cone(const csgm_scene *scene, const csgm_field *field, csg_random *random,
                     csg_vec3 at, double radius)
{
    csg_cone cone;
    const float c[3] = {(float)(at.x - field->center.x), (float)(at.y - field->center.y),
                        (float)(at.z - field->center.z)};
    csg_pruner room;
    csg_pruner_init(&room, &field->context->memory, csg_kernel_for(CSGM_ISA_AUTO), 0);
    bool found = csg_cone_find(&room, &field->tape, c, radius, &cone);
    csg_pruner_release(&room);
    if (!found)
        return false;
    assert_true(cone.least > 0);
    for (int i = 0; i < TRIES; i++) {
        csg_vec3 d =
            csg_vec3_scale(test_direction(random), radius * csg_random_uniform(random, 0, 0.999));
        csg_vec3 g = test_sample(scene, csg_vec3_add(at, d)).gradient;
        double climb = g.x * cone.axis[0] + g.y * cone.axis[1] + g.z * cone.axis[2];
        if (csg_vec3_norm(g) > cone.most + 1e-3)
            fail_msg("a slope of %g, not %g at most, near (%g, %g, %g) within %g", csg_vec3_norm(g),
                     cone.most, at.x, at.y, at.z, radius);
        if (!(climb >= cone.least - 1e-3 || csg_vec3_norm(g) < 1e-9))
            fail_msg("the field climbs by %g, not %g, near (%g, %g, %g) within %g", climb,
                     cone.least, at.x, at.y, at.z, radius);
    }
    return true;
}

static uint32_t band_count = 0;

/* The same of a region: in its ball and its cube, where |f| is within its band. */
static bool try_region(const csgm_scene *scene, const csgm_field *field, csg_random *random,
                       csg_vec3 at, double half)
{
    csg_cone cone;
    const csg_cone_region region = {{(float)(at.x - field->center.x),
                                     (float)(at.y - field->center.y),
                                     (float)(at.z - field->center.z)},
                                    half * csg_random_uniform(random, 1, 1.8),
                                    half,
                                    half * csg_random_uniform(random, 0.1, 0.8)};
    csg_pruner room;
    csg_pruner_init(&room, &field->context->memory, csg_kernel_for(CSGM_ISA_AUTO), 0);
    bool found = csg_cone_find_in(&room, &field->tape, &region, &cone);
    csg_pruner_release(&room);
    for (int i = 0; i < TRIES && found; i++) {
        csg_vec3 d = csg_vec3_scale(csg_vec3_make(csg_random_uniform(random, -1, 1),
                                                  csg_random_uniform(random, -1, 1),
                                                  csg_random_uniform(random, -1, 1)),
                                    0.999 * half);
        csg_sample f = test_sample(scene, csg_vec3_add(at, d));
        if ((csg_vec3_norm(d) > region.radius && !cone.fills_cube) || fabs(f.value) > region.band)
            continue;
        csg_vec3 g = f.gradient;
        double climb = g.x * cone.axis[0] + g.y * cone.axis[1] + g.z * cone.axis[2];
        double sum = fabs(g.x) + fabs(g.y) + fabs(g.z);
        if (csg_vec3_norm(g) < 1e-9)
            continue;
        if (climb < cone.least - 1e-3 || csg_vec3_norm(g) > cone.most + 1e-3 ||
            csg_vec3_norm(g) > cone.steep * (climb + 1e-3) || sum > cone.lean * (climb + 1e-3))
            fail_msg("(%g, %g, %g) climbs by %g near (%g, %g, %g) within %g: %g, %g, %g, %g", g.x,
                     g.y, g.z, climb, at.x, at.y, at.z, half, cone.least, cone.most, cone.steep,
                     cone.lean);
        band_count++;
    }
    return found;
}

/* Where a random place of a region of mesh/distance/slopes.h, made smaller by `share`, lies from c.
 */
static csg_vec3 place_in(const csg_gradients_region *r, csg_random *random, double share)
{
    double s = csg_random_uniform(random, 0, 1), t = csg_random_uniform(random, 0, 1 - s);
    double to_triangle = csg_random_uniform(random, 0, 1);
    const double weight[3] = {s, t, 1 - s - t};
    csg_vec3 d =
        csg_vec3_scale(test_direction(random), r->around * csg_random_uniform(random, 0, 0.999));
    d.x += r->half * csg_random_uniform(random, -0.999, 0.999);
    d.y += r->half * csg_random_uniform(random, -0.999, 0.999);
    d.z += r->half * csg_random_uniform(random, -0.999, 0.999);
    for (int k = 0; k < 3; k++)
        d = csg_vec3_add(
            d, csg_vec3_scale(csg_vec3_sub(r->triangle[k], r->c), 0.999 * to_triangle * weight[k]));
    return csg_vec3_scale(d, share);
}

/* The gradients of mesh/distance/slopes.h, tried at random points of the region: none is longer,
 * none strays farther from the others, and all climb along the axis that the balls have in common.
 */
static void check_gradients(const csgm_scene *scene, csg_random *random, csg_vec3 at,
                            const csg_gradients_region *region, const csg_gradients *found)
{
    double radius = region->around + sqrt(3.0) * region->half;
    csg_cone cone;
    csg_vec3 first = {0, 0, 0};
    bool has_axis = csg_cone_find_axis(&found->balls, &cone);
    const csg_vec3 *v = region->triangle;
    csg_vec3 normal =
        csg_vec3_normalize(csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0])));
    for (int i = 0; i < TRIES; i++) {
        csg_vec3 d = place_in(region, random, 1);
        double value = test_sample(scene, csg_vec3_add(at, d)).value;
        csg_vec3 g = test_sample(scene, csg_vec3_add(at, d)).gradient;
        double climb = g.x * cone.axis[0] + g.y * cone.axis[1] + g.z * cone.axis[2];
        if (value < found->least - 1e-4 || value > found->most + 1e-4)
            fail_msg("a value of %g, not %g to %g, near (%g, %g, %g) within %g", value,
                     found->least, found->most, at.x, at.y, at.z, radius);
        if (csg_vec3_norm(g) < 1e-9)
            continue;
        first = csg_vec3_norm(first) > 0 ? first : g;
        if (csg_vec3_norm(g) > found->longest + 1e-3)
            fail_msg("a slope of %g, not %g at most, near (%g, %g, %g) within %g", csg_vec3_norm(g),
                     found->longest, at.x, at.y, at.z, radius);
        csg_vec3 way = i % 2 ? test_direction(random) : csg_vec3_normalize(g);
        double beyond = found->exceeds ? 0 : mesh_beyond_hull(&found->balls, g, way);
        if (beyond > 1e-3)
            fail_msg("a slope is %g beyond the hull, near (%g, %g, %g) within %g", beyond, at.x,
                     at.y, at.z, radius);
        double parts = fabs(g.x) + fabs(g.y) + fabs(g.z);
        if (parts > csg_gradients_steepest(found) + 1e-3)
            fail_msg("parts of a slope add up to %g, not %g, near (%g, %g, %g) within %g", parts,
                     csg_gradients_steepest(found), at.x, at.y, at.z, radius);
        if (csg_vec3_norm(csg_vec3_sub(g, first)) > 2 * found->stray + 1e-3)
            fail_msg("slopes %g apart, not %g from one, near (%g, %g, %g) within %g",
                     csg_vec3_norm(csg_vec3_sub(g, first)), found->stray, at.x, at.y, at.z, radius);
        csg_vec3 apart = csg_vec3_sub(g, first);
        apart = csg_vec3_sub(apart, csg_vec3_scale(normal, csg_vec3_dot(normal, apart)));
        if (csg_vec3_norm(apart) > 2 * found->across + 1e-3)
            fail_msg("slopes %g apart along the plane, not %g from one, near (%g, %g, %g)",
                     csg_vec3_norm(apart), found->across, at.x, at.y, at.z);
        if (has_axis && climb < cone.least - 1e-3)
            fail_msg("the field climbs by %g, not %g, near (%g, %g, %g) within %g", climb,
                     cone.least, at.x, at.y, at.z, radius);
    }
}

/* How far values over the region's triangle, or over a smaller one moved within the region, are
 * from what the corners say. Returns whether it was known to fall with the square of the size. */
static bool check_sag(const csgm_scene *scene, csg_random *random, csg_vec3 at,
                      const csg_gradients_region *region, const csg_gradients *found)
{
    for (int i = 0; i < TRIES && found->kink < INFINITY; i++) {
        double n = exp(csg_random_uniform(random, 0, 3)), share = i % 2 ? 1 / n : -0.5 / n;
        double s = csg_random_uniform(random, 0, 1), t = csg_random_uniform(random, 0, 1 - s);
        const double weight[3] = {s, t, 1 - s - t};
        csg_vec3 from = {0, 0, 0}, v[3], x = {0, 0, 0};
        csg_vec3 moved = csg_vec3_scale(test_direction(random), 0.99 * region->around);
        double said = 0;
        /* around a place from which the small triangle is within the whole one */
        for (int k = 0; k < 3; k++)
            from = csg_vec3_add(from, csg_vec3_scale(region->triangle[k], 1.0 / 3));
        from = csg_vec3_add(from, csg_vec3_sub(at, region->c));
        for (int k = 0; k < 3; k++) {
            csg_vec3 corner = csg_vec3_add(region->triangle[k], csg_vec3_sub(at, region->c));
            csg_vec3 off = csg_vec3_scale(csg_vec3_sub(corner, from), share);
            v[k] = csg_vec3_add(csg_vec3_add(from, off), moved);
            x = csg_vec3_add(x, csg_vec3_scale(v[k], weight[k]));
            said += weight[k] * test_sample(scene, v[k]).value;
        }
        double size = fabs(share), off = fabs(test_sample(scene, x).value - said);
        if (off > found->kink * size + found->sag * size * size + 1e-6)
            fail_msg("a value is %g off, not %g + %g, near (%g, %g, %g)", off, found->kink * size,
                     found->sag * size * size, at.x, at.y, at.z);
    }
    return found->kink == 0;
}

/* What mesh/distance/steps.h says of the region's triangle, tried at random points of it. Returns
 * whether it was settled. */
static bool try_steps(const csgm_scene *scene, const csgm_field *field, csg_random *random,
                      const csg_gradients_region *region, const csg_gradients *found,
                      float *scratch, size_t floats)
{
    csg_cone cone;
    const csg_vec3 *v = region->triangle;
    csg_vec3 c = csg_vec3_scale(csg_vec3_add(v[0], csg_vec3_add(v[1], v[2])), 1.0 / 3);
    double radius = 0;
    if (!csg_gradients_find_axis(found, &cone))
        return false;
    for (int k = 0; k < 3; k++)
        radius = fmax(radius, csg_vec3_norm(csg_vec3_sub(v[k], c)));
    csg_vec3 axis = {cone.axis[0], cone.axis[1], cone.axis[2]};
    csg_steps piece = {.at = {v[0], v[1], v[2]},
                       .step = csg_vec3_scale(axis, region->around),
                       .stray = found->across * radius,
                       .kink = found->kink,
                       .sag = found->sag};
    const csg_touching whole = csg_touching_none(&field->tape);
    csg_steps_settle(csg_kernel_for(CSGM_ISA_AUTO), &whole, 0, scratch, floats, &piece, 1);
    for (int i = 0; !piece.fails && i < TRIES; i++) {
        double s = csg_random_uniform(random, 0, 1), t = csg_random_uniform(random, 0, 1 - s);
        csg_vec3 p = csg_vec3_add(csg_vec3_scale(v[0], s), csg_vec3_scale(v[1], t));
        p = csg_vec3_add(csg_vec3_add(p, csg_vec3_scale(v[2], 1 - s - t)), field->center);
        double inside = test_sample(scene, csg_vec3_add(p, piece.step)).value;
        double outside = test_sample(scene, csg_vec3_sub(p, piece.step)).value;
        if (inside < -1e-4 || outside > 1e-4)
            fail_msg("%g a step inwards, %g a step back, at (%g, %g, %g)", inside, outside, p.x,
                     p.y, p.z);
    }
    return !piece.fails;
}

/* And between two places of the region, on a line along that axis and on any other: gradients as
 * the reference gives them leave out what a fillet's operands turn. */
static void check_differences(const csgm_scene *scene, csg_random *random, csg_vec3 at,
                              const csg_gradients_region *region, const csg_gradients *found)
{
    double radius = region->around + region->half;
    csg_cone cone;
    bool has_axis = csg_cone_find_axis(&found->balls, &cone);
    for (int i = 0; i < TRIES; i++) {
        csg_vec3 way = test_direction(random), d = place_in(region, random, 0.6);
        if (has_axis && i % 2)
            way = csg_vec3_make(cone.axis[0], cone.axis[1], cone.axis[2]);
        csg_vec3 p = csg_vec3_add(at, d);
        double length = radius * csg_random_uniform(random, 0.05, 0.39);
        csg_vec3 q = csg_vec3_add(p, csg_vec3_scale(way, length));
        double climb = test_sample(scene, q).value - test_sample(scene, p).value;
        if (fabs(climb) > (found->longest + 1e-3) * length + 1e-6)
            fail_msg("a climb of %g, not %g at most, near (%g, %g, %g) within %g", climb / length,
                     found->longest, at.x, at.y, at.z, radius);
        if (has_axis && i % 2 && climb < (cone.least - 1e-3) * length - 1e-6)
            fail_msg("a climb of %g along the axis, not %g, near (%g, %g, %g) within %g",
                     climb / length, cone.least, at.x, at.y, at.z, radius);
    }
}

/* The range of mesh/distance/slopes.h over a triangle, tried at random points of it. Returns
 * whether there was one. */
static bool try_range(const csgm_scene *scene, const csgm_field *field, csg_random *random,
                      csg_vec3 at, double radius)
{
    const csg_kernel *kernel = csg_kernel_for(CSGM_ISA_AUTO);
    size_t floats = csg_kernel_scratch_floats(field->depth);
    float *scratch = malloc(floats * sizeof *scratch);
    assert_non_null(scratch);
    csg_gradients found;
    csg_vec3 v[3];
    double share = csg_random_uniform(random, 0, 1), ball = csg_random_uniform(random, 0, 1);
    csg_gradients_region region = {.c = csg_vec3_sub(at, field->center),
                                   .around = (1 - share) * ball * radius,
                                   .half = (1 - share) * (1 - ball) * radius / sqrt(3.0)};
    for (int i = 0; i < 3; i++) {
        double length = share * radius * csg_random_uniform(random, 0.05, 0.99);
        v[i] = csg_vec3_add(at, csg_vec3_scale(test_direction(random), length));
        region.triangle[i] = csg_vec3_sub(v[i], field->center);
    }
    bool is_known = csg_gradients_find(kernel, &field->tape, &region, scratch, floats, &found);
    for (int i = 0; is_known && i < TRIES; i++) {
        double s = csg_random_uniform(random, 0, 1), t = csg_random_uniform(random, 0, 1 - s);
        csg_vec3 p = csg_vec3_add(csg_vec3_scale(v[0], s), csg_vec3_scale(v[1], t));
        p = csg_vec3_add(p, csg_vec3_scale(v[2], 1 - s - t));
        double value = test_sample(scene, p).value;
        if (value < found.low - 1e-4 || value > found.high + 1e-4)
            fail_msg("a value of %g, not %g to %g, near (%g, %g, %g) within %g", value, found.low,
                     found.high, at.x, at.y, at.z, radius);
    }
    if (is_known) {
        check_gradients(scene, random, at, &region, &found);
        check_differences(scene, random, at, &region, &found);
        smooth_count += check_sag(scene, random, at, &region, &found);
        step_count += try_steps(scene, field, random, &region, &found, scratch, floats);
    }
    free(scratch);
    return is_known;
}

/* Where two boxes share a face, all around it: the union is zero there and nowhere less, what is
 * left of one without the other is nowhere more. */
static void shared_faces_are_no_surface(void **state)
{
    (void)state;
    csg_random random = {.state = 83};
    for (int i = 0; i < 40; i++) {
        bool cuts = i % 2;
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_affine beside = csg_affine_translate(csg_vec3_make(cuts ? 0.2 : 1, 0, 0));
        const csg_box half = {{-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}};
        csg_node_id box = csg_build_block(&c.builder, half, NOWHERE);
        csg_node_id other = csg_build_block(&c.builder, half, NOWHERE);
        other = csg_build_transform(&c.builder, &beside, other, NOWHERE);
        csg_node_kind kind = cuts ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION;
        mesh_case_compile(&c, joined(&c, kind, SHARP, box, other));
        size_t floats = csg_kernel_scratch_floats(c.field->depth);
        float *scratch = malloc(floats * sizeof *scratch);
        assert_non_null(scratch);
        double y = csg_random_uniform(&random, -0.1, 0.1),
               z = csg_random_uniform(&random, -0.1, 0.1);
        csg_vec3 face = cuts ? csg_vec3_make(0.3 + y, 0.4, z) : csg_vec3_make(0.5, y, z);
        csg_vec3 at = csg_vec3_sub(
            csg_vec3_add(face, csg_vec3_scale(test_direction(&random), 0.02)), c.field->center);
        const csg_gradients_region region = {
            {at, at, at}, at, cuts ? 0.05 : 0, cuts ? 0 : 0.05 / sqrt(3.0)};
        csg_gradients found;
        assert_true(csg_gradients_find(csg_kernel_for(CSGM_ISA_AUTO), &c.field->tape, &region,
                                       scratch, floats, &found));
        if (cuts)
            assert_true(found.most < 1e-5 && found.least < -0.01);
        else
            assert_true(found.least > -1e-5 && found.most > 0.01);
        free(scratch);
        mesh_case_end(&c);
    }
}

static csg_blend any_blend(csg_random *random)
{
    const csg_blend blends[] = {SHARP,
                                ROUND(0.2),
                                {CSG_BLEND_PARABOLA, 0.4, false},
                                {CSG_BLEND_CHAMFER, 0.1, false},
                                {CSG_BLEND_HYPERBOLA, 0.02, false}};
    return blends[(int)csg_random_uniform(random, 0, 4.999)];
}

/* By steps of Newton's method. */
static csg_vec3 come_near(const csgm_scene *scene, csg_vec3 at)
{
    enum { STEPS = 4 };
    for (int step = 0; step < STEPS; step++) {
        csg_sample s = test_sample(scene, at);
        double square = csg_vec3_dot(s.gradient, s.gradient);
        if (square > 0.01)
            at = csg_vec3_sub(at, csg_vec3_scale(s.gradient, s.value / square));
    }
    return at;
}

static void cones_hold(void **state)
{
    (void)state;
    csg_random random = {.state = 81};
    uint32_t found = 0, ranges = 0;
    for (int kind = 0; kind < 36; kind++) {
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_node_id root = posed_anyhow(&c, make_any_primitive(&c, kind, &random), &random);
        if (kind >= 9) {
            csg_node_id other =
                posed_anyhow(&c, make_any_primitive(&c, kind / 2, &random), &random);
            csg_node_kind operators[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE,
                                         CSG_NODE_INTERSECTION};
            root = joined(&c, operators[kind % 3], any_blend(&random), root, other);
        }
        if (kind % 4 == 3) {
            csg_affine stretch = csg_affine_scale(csg_vec3_make(1.5, 0.8, 1));
            root = csg_build_transform(&c.builder, &stretch, root, NOWHERE);
        }
        mesh_case_compile(&c, root);
        for (int i = 0; i < 250; i++) {
            csg_vec3 at = test_point(&random, 1.6);
            double radius = exp(csg_random_uniform(&random, -5, -0.5));
            found += try_cone(c.scene, c.field, &random, at, radius);
            ranges += try_range(c.scene, c.field, &random, at, radius);
            if (i % 2)
                try_range(c.scene, c.field, &random, come_near(c.scene, at), 0.3 * radius);
        }
        mesh_case_end(&c);
    }
    assert_true(found > 3000);
    assert_true(ranges > 3000);
    assert_true(step_count > 1000);
    assert_true(smooth_count > 1500);
}

/* ---- other leaves ---------------------------------------------------------------------------- */

typedef csg_node_id make_node(mesh_case *c, csg_random *random);

/* Balls of all sizes in scenes of one kind; some cones must be found, or nothing was tried. */
static void try_kind(const char *name, make_node *make, uint64_t seed, uint32_t least_found)
{
    csg_random random = {.state = seed};
    uint32_t found = 0;
    for (uint32_t i = 0; i < scene_count; i++) {
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_node_id node = make(&c, &random);
        if (node == CSG_NODE_NONE) {
            csg_build_abandon(&c.builder);
            c.scene = NULL;
            mesh_case_end(&c);
            continue;
        }
        mesh_case_compile(&c, posed_anyhow(&c, node, &random));
        for (int k = 0; k < 250; k++) {
            csg_vec3 at = test_point(&random, 1.4);
            double radius = exp(csg_random_uniform(&random, -6, -0.5));
            found += try_cone(c.scene, c.field, &random, at, radius);
            csg_random other = random; /* what cones are tried at depends on nothing else */
            try_region(c.scene, c.field, &other, come_near(c.scene, at), 0.3 * radius);
            range_count += try_range(c.scene, c.field, &other, at, radius);
        }
        mesh_case_end(&c);
    }
    if (found < least_found * scene_count / 24)
        fail_msg("%s: only %u cones", name, found);
}

static double any_radius(int corner, csg_random *random)
{
    return csg_random_uniform(random, 0.5, 1);
}

/* Extruded. */
static csg_node_id outline(mesh_case *c, csg_random *random)
{
    int count = 5 + (int)csg_random_uniform(random, 0, 40);
    csg_shape *star = test_star(&c->context.memory, count, any_radius, random);
    csg_node_id node = csg_build_shape(&c->builder, star, NOWHERE);
    return csg_build_extrude(&c->builder, node, -0.5, csg_random_uniform(random, -0.3, 0.7),
                             NOWHERE);
}

/* A ball of triangles with another radius at every corner, or two of them that overlap. */
static void add_bumpy(csg_triangles *t, csg_random *random, double x)
{
    enum { RINGS = 6, AROUND = 9 };
    uint32_t base = (uint32_t)t->point_count;
    for (int i = 0; i <= RINGS; i++)
        for (int k = 0; k < (i % RINGS ? AROUND : 1); k++) {
            double polar = i * 3.14159265358979 / RINGS, angle = k * 6.283185307179586 / AROUND;
            double r = csg_random_uniform(random, 0.5, 0.9);
            assert_true(csg_triangles_add_point(t, csg_vec3_make(x + r * sin(polar) * cos(angle),
                                                                 r * sin(polar) * sin(angle),
                                                                 r * cos(polar))));
        }
    uint32_t last = base + 1 + (RINGS - 1) * AROUND;
    for (uint32_t k = 0; k < AROUND; k++) {
        uint32_t next = (k + 1) % AROUND, low = base + 1 + (RINGS - 2) * AROUND;
        assert_true(csg_triangles_add(t, base, base + 1 + k, base + 1 + next));
        assert_true(csg_triangles_add(t, last, low + next, low + k));
        for (uint32_t i = 0; i + 2 < RINGS; i++) {
            uint32_t at = base + 1 + i * AROUND;
            assert_true(csg_triangles_add(t, at + k, at + AROUND + k, at + AROUND + next));
            assert_true(csg_triangles_add(t, at + k, at + AROUND + next, at + next));
        }
    }
}

static csg_node_id polyhedron(mesh_case *c, csg_random *random)
{
    csg_triangles triangles;
    csg_shape *shape = NULL;
    csg_triangles_init(&triangles, &c->context.memory);
    add_bumpy(&triangles, random, -0.3);
    if (csg_random_uniform(random, 0, 1) < 0.5)
        add_bumpy(&triangles, random, 0.4);
    assert_int_equal(csg_polyhedron_create(&c->context.memory, &triangles, NULL, &shape), CSGM_OK);
    csg_triangles_release(&triangles);
    return csg_build_shape(&c->builder, shape, NOWHERE);
}

/* A pyramid far higher than wide, turned and stretched another way along every axis: outside its
 * tip gradients are longer than those of its faces, and lean further. */
static csg_node_id needle(mesh_case *c, csg_random *random)
{
    csg_triangles t;
    csg_shape *shape = NULL;
    csg_triangles_init(&t, &c->context.memory);
    double r = csg_random_uniform(random, 0.05, 0.4);
    for (int i = 0; i < 3; i++)
        assert_true(
            csg_triangles_add_point(&t, csg_vec3_make(r * cos(2.1 * i), r * sin(2.1 * i), -0.5)));
    assert_true(csg_triangles_add_point(&t, csg_vec3_make(0, 0, 0.5)));
    static const uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (int i = 0; i < 4; i++)
        assert_true(csg_triangles_add(&t, faces[i][0], faces[i][1], faces[i][2]));
    assert_int_equal(csg_polyhedron_create(&c->context.memory, &t, NULL, &shape), CSGM_OK);
    csg_triangles_release(&t);
    csg_node_id node = csg_build_shape(&c->builder, shape, NOWHERE);
    if (csg_random_uniform(random, 0, 1) < 0.5)
        node = turned(c, node, csg_random_uniform(random, 0, 360), test_direction(random));
    double u = exp(csg_random_uniform(random, 0, 2.5));
    csg_affine stretch = csg_affine_scale(csg_vec3_make(u * csg_random_uniform(random, 0.5, 1), u,
                                                        csg_random_uniform(random, 0.5, 1.5)));
    return csg_build_transform(&c->builder, &stretch, node, NOWHERE);
}

/* One minus another, by blends whose bounds need the whole range of slopes, or alone. */
static csg_node_id needles(mesh_case *c, csg_random *random)
{
    csg_node_id a = needle(c, random);
    if (csg_random_uniform(random, 0, 1) < 0.4)
        return a;
    const csg_blend blends[] = {ROUND(0.2), {CSG_BLEND_ORTHOGONAL, 0.3, false}, SHARP};
    return joined(c, csg_random_uniform(random, 0, 1) < 0.5 ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION,
                  blends[(int)csg_random_uniform(random, 0, 2.999)], a, needle(c, random));
}

static csg_node_id formula(mesh_case *c, csg_random *random)
{
    csg_formula_step steps[TEST_MOST_STEPS];
    uint32_t count = test_random_formula(&c->context.memory, random, 8, true, steps);
    csg_box box = {{-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}};
    const csg_field_domain domain = {box, true, 100, true};
    return csg_build_field(&c->builder, steps, count, &domain, NOWHERE);
}

/* Extrusions, revolutions, twisted and bent solids, slices, offsets. */
static csg_node_id shaped(mesh_case *c, csg_random *random)
{
    return test_random_shaped(&c->builder, random);
}

/* A formula of three solids' fields. */
static csg_node_id combination(mesh_case *c, csg_random *random)
{
    csg_formula_step steps[TEST_MOST_STEPS];
    csg_node_id children[3];
    for (int i = 0; i < 3; i++)
        children[i] = posed_anyhow(
            c, make_any_primitive(c, (int)csg_random_uniform(random, 0, 8.99), random), random);
    uint32_t count = test_random_formula(&c->context.memory, random, 5, true, steps);
    return csg_build_combine(&c->builder, steps, count, 100, children, 3, NOWHERE);
}

/* Soft solids and blends of every rule. */
static csg_node_id ruled(mesh_case *c, csg_random *random)
{
    test_random_rules = true;
    csg_node_id node = test_random_scene(&c->builder, random, 3);
    test_random_rules = false;
    return node;
}

/* Two solids, or half-spaces, of every kind. */
static csg_node_id filleted(mesh_case *c, csg_random *random)
{
    static const csg_node_kind operators[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE,
                                              CSG_NODE_INTERSECTION};
    csg_blend blend = {CSG_BLEND_FILLET, csg_random_uniform(random, 0.05, 0.6), false};
    csg_node_id pair[2];
    for (int i = 0; i < 2; i++)
        pair[i] = posed_anyhow(
            c, make_any_primitive(c, (int)csg_random_uniform(random, 0, 8.99), random), random);
    return joined(c, operators[(int)csg_random_uniform(random, 0, 2.999)], blend, pair[0], pair[1]);
}

static void cones_of_fillets_hold(void **state)
{
    (void)state;
    uint32_t before = range_count;
    try_kind("fillets", filleted, 98, 400);
    if (range_count - before < 100 * scene_count)
        fail_msg("fillets: only %u ranges", range_count - before);
}

static void cones_of_outlines_hold(void **state)
{
    (void)state;
    try_kind("outlines", outline, 91, 1700);
}

static void cones_of_polyhedra_hold(void **state)
{
    (void)state;
    try_kind("polyhedra", polyhedron, 92, 1700);
}

static void cones_of_needles_hold(void **state)
{
    (void)state;
    try_kind("needles", needles, 97, 1700);
}

static void cones_of_formulas_hold(void **state)
{
    (void)state;
    try_kind("formulas", formula, 93, 1700);
}

static void cones_of_warps_hold(void **state)
{
    (void)state;
    try_kind("warps", shaped, 94, 1700);
}

static void cones_of_combinations_hold(void **state)
{
    (void)state;
    try_kind("combinations", combination, 95, 1000);
}

static void cones_of_rules_hold(void **state)
{
    (void)state;
    try_kind("rules", ruled, 96, 300);
}

/* Of few solids, so that gradients' bounds are found and not only tried. */
static void ranges_of_rules_hold(void **state)
{
    (void)state;
    static const csg_blend_kind rules[] = {
#define CSG_RULE_INNER(...)
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc) CSG_BLEND_##NAME,
#include "scene/operators/operators.def"
    };
    enum { RULES = sizeof rules / sizeof *rules, SCENES = 12 };
    const csg_node_kind operators[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE, CSG_NODE_INTERSECTION};
    csg_random random = {.state = 104};
    uint32_t smooth[RULES] = {0};
    for (int i = 0; i < RULES * SCENES; i++) {
        uint32_t found = 0, before = smooth_count;
        csg_rule rule = csg_rule_standard(rules[i / SCENES]);
        if (rule.kind == CSG_BLEND_PROFILE) /* a formula: combinations */
            continue;
        bool is_soft = csg_blend_takes_fields(rule.kind);
        for (int k = 0; k < 2 && !is_soft; k++)
            rule.parameters[k] *= 0.5;
        rule.range = is_soft ? 0.5 : 0;
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_blend blend = csg_build_rule(&c.builder, &rule);
        csg_node_id root = csg_build_ball(&c.builder, 1, NOWHERE);
        for (int k = 0; k < 1 + i % 3; k++) {
            csg_affine beside = csg_affine_translate(csg_vec3_scale(test_direction(&random), 0.9));
            csg_node_id other = i % 4 > 1 ? csg_build_ball(&c.builder, 0.7, NOWHERE)
                                          : make_any_primitive(&c, i % 9, &random);
            other = csg_build_transform(&c.builder, &beside, other, NOWHERE);
            root = joined(&c, operators[i % 3], blend, root, other);
        }
        mesh_case_compile(&c, root);
        for (int k = 0; k < 40; k++) {
            csg_vec3 at = test_point(&random, 1.2);
            double radius = exp(csg_random_uniform(&random, -5, -1));
            found += try_range(c.scene, c.field, &random, at, radius);
        }
        if (found < 25)
            fail_msg("%s: only %u ranges", csg_rule_name(rule.kind), found);
        smooth[i / SCENES] += smooth_count - before;
        mesh_case_end(&c);
    }
    for (int r = 0; r < RULES; r++) /* of those of lengths only between what slopes are */
        if (csg_blend_takes_fields(rules[r]) && smooth[r] < 20)
            fail_msg("%s: only %u are known to second order", csg_rule_name(rules[r]), smooth[r]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shared_faces_are_no_surface), cmocka_unit_test(cones_hold),
        cmocka_unit_test(cones_of_fillets_hold),       cmocka_unit_test(cones_of_outlines_hold),
        cmocka_unit_test(cones_of_polyhedra_hold),     cmocka_unit_test(cones_of_needles_hold),
        cmocka_unit_test(cones_of_formulas_hold),      cmocka_unit_test(cones_of_warps_hold),
        cmocka_unit_test(cones_of_combinations_hold),  cmocka_unit_test(cones_of_rules_hold),
        cmocka_unit_test(ranges_of_rules_hold),
    };
    if (argc > 1)
        scene_count = (uint32_t)strtoul(argv[1], NULL, 10);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
