/* SPDX-License-Identifier: MIT
 * What a row of primitives.def promises beside its distance: balls whose hull is the solid, how
 * deep it is at its skeleton, and where its field may have a crease. Wrong ones would make a hull
 * too small, blends of soft solids uneven, and edges round, each without a word.
 */
#include "scene_support.h"

#include <string.h>

#include "base/elementary.h"
#include "random_scene.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"

static void example(csg_random *random, csg_primitive_kind kind, double *v)
{
    csg_refusal refusal = {0};
    test_random_parameters(random, kind, v);
    assert_true(csg_primitive_of(kind)->check(&refusal, v));
}

/* ---- balls: the largest n . p over their hull is that of the solid ---------------------------- */

typedef struct hull {
    csg_vec3 n;
    double most;
} hull;

static void take_ball(void *user, csg_vec3 at, double radius)
{
    hull *h = user;
    h->most = fmax(h->most, csg_vec3_dot(h->n, at) + radius * csg_vec3_norm(h->n));
}

static void take_arc(void *user, double radius, double height, double half_deg, double ball_radius)
{
    const hull *h = user;
    const double degree = 0.017453292519943295;
    double towards = atan2(h->n.y, h->n.x) / degree,
           angle = fmax(-half_deg, fmin(half_deg, towards));
    double ends[3] = {angle, -half_deg, half_deg};
    for (int i = 0; i < 3; i++) {
        double x = radius * cos(ends[i] * degree), y = radius * sin(ends[i] * degree);
        take_ball(user, csg_vec3_make(x, y, height), ball_radius);
    }
}

/* The sink's directions are those before the solid is stretched. */
static bool find_hull(csg_primitive_kind kind, const double *v, csg_vec3 n, double within,
                      hull *out)
{
    csg_vec3 axes = {1, 1, 1};
    for (int round = 0; round < 2; round++) { /* the axes are known once it has been asked */
        *out = (hull){csg_vec3_make(n.x * axes.x, n.y * axes.y, n.z * axes.z), -INFINITY};
        csg_ball_sink sink = {out, take_ball, take_arc, within, {1, 1, 1}};
        if (!csg_primitive_of(kind)->balls(&sink, v))
            return false;
        axes = sink.axes;
    }
    return true;
}

static void test_balls(void **state)
{
    const double within = 1e-3;
    csg_random random = {901};
    size_t rows = 0;
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        bool has_balls = false;
        for (int set = 0; set < 100; set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            example(&random, kind, v);
            csg_vec3 n = test_direction(&random);
            n.z = csg_primitive_has(kind, CSG_TRAIT_FLAT) ? 0 : n.z; /* a figure of the plane */
            hull h;
            has_balls = find_hull(kind, v, n, within, &h);
            double support = csg_primitive_of(kind)->support(v, n);
            if (has_balls && (h.most > support + 1e-9 || h.most < support - within - 1e-9))
                fail_msg("%s: its balls reach %.9g, the solid %.9g",
                         csg_node_kind_name((csg_node_kind)kind), h.most, support);
        }
        rows += has_balls;
    }
    assert_true(rows >= 5);
}

/* ---- depth: as far inside as that, and no farther, along the gradient ------------------------- */

static void test_depth(void **state)
{
    csg_random random = {902};
    size_t rows = 0;
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        const csg_primitive *primitive = csg_primitive_of(kind);
        size_t reached = 0, deep = 0;
        for (int set = 0; set < 100; set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            example(&random, kind, v);
            double depth = primitive->depth(v);
            assert_true(depth >= 0);
            for (int i = 0; i < 100 && depth > 0; i++) {
                csg_vec3 p = test_point(&random, 1);
                csg_sample s = primitive->distance(v, p);
                assert_true(s.value <= depth + 1e-9);
                if (!(primitive->traits & CSG_TRAIT_OUTSIDE) ||
                    fabs(csg_vec3_norm(s.gradient) - 1) > 1e-9)
                    continue;
                csg_vec3 to = csg_vec3_add(p, csg_vec3_scale(s.gradient, depth - s.value));
                deep++;
                reached += primitive->distance(v, to).value > depth - 1e-6;
            }
        }
        if (reached != deep)
            fail_msg("%s: %zu of %zu ways to its skeleton are not as deep as it says",
                     csg_node_kind_name((csg_node_kind)kind), deep - reached, deep);
        rows += deep > 0;
    }
    assert_true(rows >= 3);
}

/* ---- exact: |f| along the gradient lies the surface ------------------------------------------ */

/* Since f never changes faster than 1, f(p) is the distance where p - f(p) grad f(p) is on the
 * surface. What a row does not promise fails somewhere: the manual's table says no less than holds.
 */
static void test_exactness(void **state)
{
    csg_random random = {904};
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        const csg_primitive *primitive = csg_primitive_of(kind);
        size_t off[2] = {0, 0}, seen[2] = {0, 0};
        for (int set = 0; set < 200; set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            example(&random, kind, v);
            for (int i = 0; i < 60; i++) {
                csg_vec3 p = test_point(&random, i % 2 ? 2 : 0.3);
                csg_sample s = primitive->distance(v, p);
                if (csg_vec3_norm(s.gradient) == 0) /* at a skeleton any direction would do */
                    continue;
                csg_vec3 foot = csg_vec3_sub(p, csg_vec3_scale(s.gradient, s.value));
                bool inside = s.value > 0;
                seen[inside]++;
                off[inside] += fabs(primitive->distance(v, foot).value) > 1e-7;
            }
        }
        const char *name = csg_node_kind_name((csg_node_kind)kind);
        bool exact[2] = {primitive->traits & CSG_TRAIT_OUTSIDE,
                         primitive->traits & CSG_TRAIT_INSIDE};
        for (int inside = 0; inside < 2; inside++) {
            const char *trait = inside ? "CSG_TRAIT_INSIDE" : "CSG_TRAIT_OUTSIDE";
            if (seen[inside] >= 100 && !exact[inside] && off[inside] == 0)
                fail_msg("%s: all %zu points are as far as they say, so its row has %s", name,
                         seen[inside], trait);
            if (seen[inside] < 100 || exact[inside] != (off[inside] == 0))
                fail_msg("%s, %s: %zu of %zu points are not as far as they say", name, trait,
                         off[inside], seen[inside]);
        }
    }
}

/* ---- may_crease: never no where a gradient jumps ----------------------------------------------- */

/* Gradients so far apart cannot come from curvature over such a step in solids of these sizes. */
static bool has_jump(const csg_primitive *primitive, const double *v, csg_vec3 p, csg_vec3 step)
{
    csg_vec3 a = primitive->distance(v, csg_vec3_sub(p, step)).gradient;
    csg_vec3 b = primitive->distance(v, csg_vec3_add(p, step)).gradient;
    return csg_vec3_norm(csg_vec3_sub(a, b)) > 0.9;
}

static bool may_crease(const csg_primitive *primitive, const double *v, csg_vec3 p, double reach,
                       csg_band band)
{
    csg_leaf leaf = {.sigma = 1, .to_own = csg_affine_identity()};
    float own[CSG_LEAF_MOST_OWN];
    primitive->pack(&leaf, v, 1);
    for (int i = 0; i < CSG_LEAF_MOST_OWN; i++)
        own[i] = (float)leaf.own[i];
    csg_vec3 at = csg_affine_point(&leaf.to_own, p);
    const float q[3] = {(float)at.x, (float)at.y, (float)at.z};
    return primitive->may_crease(own, q, (float)reach, band);
}

static void test_creases(void **state)
{
    const double step = 1e-3;
    size_t rows = 0;
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        const csg_primitive *primitive = csg_primitive_of(kind);
        csg_random random = {903};
        size_t jumps = 0, missed = 0;
        if (primitive->traits & CSG_TRAIT_CURVE)
            continue; /* its leaves are pieces: tests/field/test_curves.c */
        for (int set = 0; set < 60; set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            example(&random, kind, v);
            for (int i = 0; i < 4000; i++) {
                csg_vec3 p = test_point(&random, 1);
                if (!has_jump(primitive, v, p, csg_vec3_scale(test_direction(&random), step)))
                    continue;
                float f = (float)primitive->distance(v, p).value, room = (float)(2 * step);
                jumps++;
                missed += !may_crease(primitive, v, p, 2 * step, (csg_band){f - room, f + room});
            }
        }
        if (missed)
            fail_msg("%s: may_crease says no at %zu of %zu jumps of the gradient",
                     csg_node_kind_name((csg_node_kind)kind), missed, jumps);
        rows += jumps > 0;
    }
    assert_true(rows >= 5);
}

/* ---- mirrors: the field is the same at mirrored points ---------------------------------------- */

static csg_vec3 mirrored(csg_mirror by, csg_vec3 q, double angle)
{
    double cosine = csg_cos(angle), sine = csg_sin(angle);
    switch (by) {
    case CSG_MIRROR_X:
        return csg_vec3_make(-q.x, q.y, q.z);
    case CSG_MIRROR_Y:
        return csg_vec3_make(q.x, -q.y, q.z);
    case CSG_MIRROR_Z:
        return csg_vec3_make(q.x, q.y, -q.z);
    case CSG_MIRROR_XY:
        return csg_vec3_make(q.y, q.x, q.z);
    case CSG_MIRROR_AROUND:
        return csg_vec3_make(cosine * q.x - sine * q.y, sine * q.x + cosine * q.y, q.z);
    default:
        return csg_vec3_make(q.x, q.z, q.y);
    }
}

/* Sizes that are equal now and then, as mirrors that exchange axes ask for. */
static void example_of_equal_sizes(csg_random *random, csg_primitive_kind kind, double *v)
{
    csg_refusal refusal = {0};
    double copy[CSG_PRIMITIVE_MOST_PARAMETERS];
    example(random, kind, v);
    memcpy(copy, v, sizeof copy);
    int from = (int)csg_random_below(random, 3), to = (int)csg_random_below(random, 3);
    copy[to] = copy[from];
    if (csg_primitive_of(kind)->check(&refusal, copy))
        memcpy(v, copy, sizeof copy);
}

static void test_mirrors(void **state)
{
    size_t rows = 0;
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        const csg_primitive *primitive = csg_primitive_of(kind);
        csg_random random = {905};
        unsigned seen = 0;
        if (primitive->traits & CSG_TRAIT_CURVE)
            continue; /* pieces of curves have none */
        for (int set = 0; set < 200; set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            csg_leaf leaf = {.sigma = 1, .to_own = csg_affine_identity()};
            csg_affine back;
            float own[CSG_LEAF_MOST_OWN];
            example_of_equal_sizes(&random, kind, v);
            primitive->pack(&leaf, v, 1);
            for (int i = 0; i < CSG_LEAF_MOST_OWN; i++)
                own[i] = (float)leaf.own[i];
            assert_true(csg_affine_invert(leaf.to_own, &back));
            unsigned mirrors = primitive->mirrors(own);
            seen |= mirrors;
            for (unsigned by = 1; by <= mirrors; by *= 2)
                for (int i = 0; i < 20 && mirrors & by; i++) {
                    csg_vec3 p = test_point(&random, 1), q = csg_affine_point(&leaf.to_own, p);
                    csg_vec3 to = csg_affine_point(
                        &back, mirrored((csg_mirror)by, q, csg_random_uniform(&random, 0, 6)));
                    double f = primitive->distance(v, p).value;
                    if (fabs(primitive->distance(v, to).value - f) > 1e-6)
                        fail_msg("%s: it is not the same after mirror %u",
                                 csg_node_kind_name((csg_node_kind)kind), by);
                }
        }
        rows += seen != 0;
    }
    assert_true(rows >= 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exactness), cmocka_unit_test(test_balls),
        cmocka_unit_test(test_depth),     cmocka_unit_test(test_creases),
        cmocka_unit_test(test_mirrors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
