/* SPDX-License-Identifier: MIT
 * Comparisons against closed forms: concentric and moved balls, shifted boxes, a pulled vertex,
 * the same surface in other triangles; bounds are bounds of what samples show; any order, any
 * threads, empty and open meshes; each allocation refused in turn.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "diff/shapes.h"
#include "rounds.h"

static const csgm_vec3 ORIGIN = {0, 0, 0}, ONE = {1, 1, 1};

static csgm_context *open_context(uint32_t threads)
{
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context;
    options.threads = threads;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

static csgm_diff_options few_samples(void)
{
    csgm_diff_options options = csgm_diff_options_default();
    options.samples = 4096;
    return options;
}

static csgm_diff_report compare_with(const diff_shape *a, const diff_shape *b,
                                     const csgm_diff_options *options, uint32_t threads)
{
    csgm_context *context = open_context(threads);
    csgm_mesh_view left = diff_view(a), right = diff_view(b);
    csgm_diff *diff;
    assert_int_equal(csgm_diff_meshes(context, &left, &right, options, &diff), CSGM_OK);
    csgm_diff_report report = *csgm_diff_get_report(diff);
    csgm_diff_destroy(diff);
    csgm_context_destroy(context);
    return report;
}

static csgm_diff_report compare(const diff_shape *a, const diff_shape *b)
{
    csgm_diff_options options = few_samples();
    return compare_with(a, b, &options, 2);
}

static void assert_bounds(double lower, double upper, double truth, double slack)
{
    assert_true(lower <= truth + slack);
    assert_true(upper >= truth - slack);
    assert_true(upper <= 1.01 * lower + slack);
}

/* ---- closed forms --------------------------------------------------------------------------- */

static void test_shifted_boxes(void **state)
{
    for (uint32_t n = 1; n <= 7; n += 3)
        for (uint32_t m = 1; m <= 5; m += 2) {
            const csgm_vec3 low = {0.25, 0, 0}, high = {1.25, 1, 1};
            diff_shape a = diff_box(ORIGIN, ONE, n), b = diff_box(low, high, m);
            csgm_diff_report r = compare(&a, &b);
            for (int i = 0; i < 2; i++)
                assert_bounds(r.distance[i].lower, r.distance[i].upper, 0.25, 1e-6);
            assert_true(fabs(r.volume.only_a - 0.25) < 1e-6 + r.volume.accuracy);
            assert_true(fabs(r.volume.only_b - 0.25) < 1e-6 + r.volume.accuracy);
            assert_true(fabs(r.volume.ratio - 0.4) < 1e-4);
            assert_int_equal(r.reasons, CSGM_DIFF_REASON_DISTANCE);
            diff_shape_release(&a);
            diff_shape_release(&b);
        }
}

/* Of inscribed polyhedra: vertices of the outer are at least the difference of the radii away, and
 * no point more than that and the sagitta of the inner one's facets. */
static void test_concentric_balls(void **state)
{
    const double radii[] = {1.5, 1.01, 1.0001};
    for (int i = 0; i < 3; i++) {
        diff_shape a = diff_ball(60, 40, 1, ORIGIN), b = diff_ball(61, 39, radii[i], ORIGIN);
        csgm_diff_report r = compare(&a, &b);
        double sagitta = 0.008, apart = radii[i] - 1;
        assert_true(r.hausdorff_lower >= apart * (1 - 1e-6));
        assert_true(r.hausdorff_upper <= apart + sagitta);
        assert_true(r.hausdorff_upper <= 1.01 * r.hausdorff_lower);
        double ball = 4.0 / 3 * acos(-1);
        if (i < 2)
            assert_true(fabs(r.volume.only_b / (ball * (pow(radii[i], 3) - 1)) - 1) < 0.25);
        assert_true(r.distance[0].mean <= r.distance[0].rms);
        assert_true(r.distance[0].percentile_95 <= r.distance[0].percentile_99);
        assert_true(r.distance[0].percentile_99 <= r.distance[0].upper);
        diff_shape_release(&a);
        diff_shape_release(&b);
    }
}

static void test_pulled_vertex(void **state)
{
    diff_shape a = diff_ball(50, 30, 1, ORIGIN), b = diff_ball(50, 30, 1, ORIGIN);
    b.positions[3 * (b.vertex_count - 1) + 2] = 1.5F;
    csgm_diff_report r = compare(&a, &b);
    assert_bounds(r.distance[1].lower, r.distance[1].upper, 0.5, 1e-6);
    assert_true(fabs(r.distance[1].worst[0].at.z - 1.5) < 1e-6);
    assert_true(fabs(r.distance[1].worst[0].nearest.z - 1) < 1e-6);
    assert_int_equal(r.distance[1].worst_count, 1);
    /* the pulled cone: the fan of 50 triangles around the pole, 0.5 high */
    double t = acos(-1) / 30, base = 25 * sin(2 * acos(-1) / 50) * sin(t) * sin(t);
    assert_true(fabs(r.volume.only_b - base * 0.5 / 3) < 1e-6 + r.volume.accuracy);
    assert_true(r.volume.only_a < 1e-9);
    csgm_diff_options options = few_samples();
    options.material = CSGM_DIFF_REMOVED;
    assert_false(compare_with(&a, &b, &options, 2).is_different);
    options.material = CSGM_DIFF_ADDED;
    r = compare_with(&a, &b, &options, 2);
    assert_true(r.is_different);
    assert_bounds(r.counted.lower, r.counted.upper, 0.5, 1e-6);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

/* The same box in other triangles: nothing but rounding between them, and that is proven. */
static void test_other_triangles(void **state)
{
    diff_shape a = diff_box(ORIGIN, ONE, 8), b = diff_box(ORIGIN, ONE, 5);
    csgm_diff_report r = compare(&a, &b);
    assert_int_equal(r.level, CSGM_DIFF_WITHIN_TOLERANCE);
    assert_false(r.is_different);
    assert_true(r.hausdorff_upper < 1e-6);
    assert_true(r.volume.only_a + r.volume.only_b < 1e-6);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

static void test_order_and_seams(void **state)
{
    diff_shape a = diff_ball(20, 10, 1, ORIGIN), b = diff_ball(20, 10, 1, ORIGIN);
    for (uint64_t seed = 0; seed < 20; seed++) {
        diff_shape_shuffle(&b, seed);
        if (seed == 10)
            diff_shape_loosen(&b);
        csgm_diff_report r = compare(&a, &b);
        assert_int_equal(r.level, CSGM_DIFF_SAME_TRIANGLES);
        assert_false(r.is_different);
        assert_true(r.figures[1].is_closed);
        assert_int_equal(r.figures[1].check.components, 1);
    }
    uint32_t corner = b.indices[0];
    b.indices[0] = b.indices[1];
    b.indices[1] = corner;
    assert_int_not_equal(compare(&a, &b).level, CSGM_DIFF_SAME_TRIANGLES);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

/* ---- properties ----------------------------------------------------------------------------- */

static diff_shape random_shape(csg_random *random)
{
    csgm_vec3 at = {csg_random_uniform(random, -0.3, 0.3), csg_random_uniform(random, -0.3, 0.3),
                    csg_random_uniform(random, -0.3, 0.3)};
    uint32_t n = 3 + csg_random_below(random, 20);
    double size = csg_random_uniform(random, 0.2, 1.5);
    csgm_vec3 high = {at.x + size, at.y + 1, at.z + csg_random_uniform(random, 0.1, 1)};
    diff_shape shape =
        csg_random_below(random, 2) ? diff_ball(n, n, size, at) : diff_box(at, high, 1 + n / 3);
    if (csg_random_below(random, 3) == 0)
        for (uint64_t i = 0; i < 3 * shape.vertex_count; i++)
            shape.positions[i] += (float)csg_random_uniform(random, -0.01, 0.01);
    return shape;
}

/* The distance of the vertices, by every triangle of the other mesh: never above the bound. */
static double vertex_distance(const float *p, const diff_shape *other);

static void test_random_pairs(void **state)
{
    csg_random random = {1234};
    for (int round = 0; round < ROUNDS(60); round++) {
        diff_shape shapes[2] = {random_shape(&random), random_shape(&random)};
        csgm_diff_report r = compare(&shapes[0], &shapes[1]);
        for (int from = 0; from < 2; from++) {
            const csgm_diff_distance *d = &r.distance[from];
            double most = 0;
            for (uint64_t v = 0; v < shapes[from].vertex_count; v++)
                most =
                    fmax(most, vertex_distance(shapes[from].positions + 3 * v, &shapes[1 - from]));
            assert_true(d->is_refined);
            assert_true(most <= d->upper + 1e-9);
            assert_true(d->lower >= most - 1e-6);
            assert_true(d->upper <= fmax(1.01 * d->lower, d->lower + 2 * r.precision));
            assert_true(d->mean <= d->upper && d->percentile_99 <= d->upper);
        }
        diff_shape_release(&shapes[0]);
        diff_shape_release(&shapes[1]);
    }
}

/* A part and the same in metres: from the middle of a ball all of it is equally far, so there
 * distances are those of a point close by, less up to 2^-11. */
static void test_another_unit(void **state)
{
    enum { STEP = ROUNDS(4) == 4 ? 1 : 3 }; /* with sanitizers one ball and one box */
    for (int round = 0; round < 4; round += STEP) {
        double unit = round % 2 ? 1e-3 : 1e-5;
        csgm_vec3 low = {-unit, -unit, -unit}, high = {unit, unit, unit};
        diff_shape a =
            round < 2 ? diff_ball(72, 36, 1, ORIGIN) : diff_box((csgm_vec3){-1, -1, -1}, ONE, 20);
        diff_shape b = round < 2 ? diff_ball(72, 36, unit, ORIGIN) : diff_box(low, high, 20);
        csgm_diff_report r = compare(&a, &b);
        for (int from = 0; from < 2; from++) {
            const csgm_diff_distance *d = &r.distance[from];
            const diff_shape *shape = from ? &b : &a;
            double most = 0;
            for (uint64_t v = 0; v < shape->vertex_count; v += from ? 1 : 61)
                most = fmax(most, vertex_distance(shape->positions + 3 * v, from ? &a : &b));
            assert_true(d->is_refined && most <= d->upper * (1 + 1e-6));
            assert_true(d->upper <= 1.01 * d->lower);
            assert_true(d->mean <= d->upper && d->mean <= d->percentile_95 * (1 + 1e-9));
            double largest = from ? most : sqrt(round < 2 ? 1 : 3) * (1 - unit);
            assert_true(d->lower <= largest + 1e-5);
            if (from && round < 2) /* the sagitta of a's triangles is 4e-3 */
                assert_true(d->mean > 1 - unit - 6e-3 && d->mean < 1);
        }
        diff_shape_release(&a);
        diff_shape_release(&b);
    }
}

static void test_same_for_any_threads(void **state)
{
    csg_random random = {99};
    for (int round = 0; round < 6; round++) {
        diff_shape a = random_shape(&random), b = random_shape(&random);
        csgm_diff_options options = few_samples();
        options.material = CSGM_DIFF_ADDED;
        csgm_diff_report one = compare_with(&a, &b, &options, 1);
        for (uint32_t threads = 2; threads <= 5; threads += 3) {
            csgm_diff_report many = compare_with(&a, &b, &options, threads);
            assert_memory_equal(&one.distance, &many.distance, sizeof one.distance);
            assert_memory_equal(&one.volume, &many.volume, sizeof one.volume);
            assert_true(one.counted.lower == many.counted.lower);
            assert_true(one.counted.upper == many.counted.upper);
            assert_int_equal(one.reasons, many.reasons);
        }
        diff_shape_release(&a);
        diff_shape_release(&b);
    }
}

/* Ericson 2005, 5.1.5, as an independent reference. */
static double point_triangle(const double *p, const double *a, const double *b, const double *c)
{
    double best = INFINITY;
    enum { STEPS = 3 };
    double ab[3], ac[3], ap[3], n[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = b[k] - a[k];
        ac[k] = c[k] - a[k];
        ap[k] = p[k] - a[k];
    }
    double d1 = 0, d2 = 0, aa = 0, bb = 0, cc = 0;
    for (int k = 0; k < 3; k++) {
        aa += ab[k] * ab[k];
        bb += ab[k] * ac[k];
        cc += ac[k] * ac[k];
        d1 += ab[k] * ap[k];
        d2 += ac[k] * ap[k];
    }
    double w = aa * cc - bb * bb, v = (cc * d1 - bb * d2) / w, u = (aa * d2 - bb * d1) / w;
    if (w > 0 && v >= 0 && u >= 0 && u + v <= 1) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            n[k] = ap[k] - v * ab[k] - u * ac[k];
            sum += n[k] * n[k];
        }
        return sqrt(sum);
    }
    const double *corners[STEPS + 1] = {a, b, c, a};
    for (int e = 0; e < STEPS; e++) {
        double along = 0, length = 0, sum = 0;
        for (int k = 0; k < 3; k++) {
            double edge = corners[e + 1][k] - corners[e][k];
            along += edge * (p[k] - corners[e][k]);
            length += edge * edge;
        }
        double t = length > 0 ? fmin(1, fmax(0, along / length)) : 0;
        for (int k = 0; k < 3; k++) {
            double off = p[k] - corners[e][k] - t * (corners[e + 1][k] - corners[e][k]);
            sum += off * off;
        }
        best = fmin(best, sqrt(sum));
    }
    return best;
}

static double vertex_distance(const float *p, const diff_shape *other)
{
    double best = INFINITY, at[3] = {(double)p[0], (double)p[1], (double)p[2]};
    for (uint64_t t = 0; t < other->triangle_count; t++) {
        double corners[3][3];
        for (uint64_t k = 0; k < 3; k++)
            for (uint64_t i = 0; i < 3; i++)
                corners[k][i] = (double)other->positions[3 * (size_t)other->indices[3 * t + k] + i];
        best = fmin(best, point_triangle(at, corners[0], corners[1], corners[2]));
    }
    return best;
}

/* ---- what is not a closed mesh -------------------------------------------------------------- */

static void test_empty(void **state)
{
    diff_shape ball = diff_ball(10, 10, 1, ORIGIN), nothing = {NULL, NULL, 0, 0};
    csgm_diff_report r = compare(&ball, &nothing);
    assert_int_equal(r.reasons, CSGM_DIFF_REASON_EMPTY);
    assert_true(isinf(r.hausdorff_lower) && r.volume.only_b == 0 && r.volume.only_a > 3);
    assert_false(compare(&nothing, &nothing).is_different);
    diff_shape_release(&ball);
}

static void test_open(void **state)
{
    diff_shape a = diff_ball(20, 12, 1, ORIGIN), b = diff_ball(20, 12, 1, ORIGIN);
    b.triangle_count -= 5;
    csgm_diff_report r = compare(&a, &b);
    assert_false(r.figures[1].is_closed);
    assert_false(r.volume.is_measured);
    assert_true(r.reasons & CSGM_DIFF_REASON_TOPOLOGY);
    assert_true(r.distance[0].lower > 0.01 && r.distance[1].upper < 1e-6);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

static void test_bad_views(void **state)
{
    csgm_context *context = open_context(1);
    diff_shape a = diff_ball(6, 4, 1, ORIGIN), b = diff_ball(6, 4, 1, ORIGIN);
    csgm_mesh_view left = diff_view(&a), right = diff_view(&b);
    csgm_diff *diff;
    b.indices[3] = 10000;
    assert_int_equal(csgm_diff_meshes(context, &left, &right, NULL, &diff), CSGM_ERR_ARGUMENT);
    b.indices[3] = 0;
    b.positions[4] = NAN;
    assert_int_equal(csgm_diff_meshes(context, &left, &right, NULL, &diff), CSGM_ERR_ARGUMENT);
    assert_null(diff);
    csgm_context_destroy(context);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

/* ---- tolerance, attributes, turning --------------------------------------------------------- */

static void test_tolerances(void **state)
{
    const csgm_vec3 low = {0.01, 0, 0}, high = {1.01, 1, 1};
    diff_shape a = diff_box(ORIGIN, ONE, 3), b = diff_box(low, high, 2);
    csgm_diff_options options = few_samples();
    options.tolerance = 0.011;
    assert_false(compare_with(&a, &b, &options, 2).is_different);
    options.tolerance = 0.009;
    assert_true(compare_with(&a, &b, &options, 2).is_different);
    options.tolerance_relative = 0.011 / sqrt(3);
    assert_false(compare_with(&a, &b, &options, 2).is_different);
    options.tolerance = INFINITY;
    options.tolerance_volume = 0.021;
    assert_false(compare_with(&a, &b, &options, 2).is_different);
    options.tolerance_volume = 0.019;
    assert_int_equal(compare_with(&a, &b, &options, 2).reasons, CSGM_DIFF_REASON_VOLUME);
    options.verdict_only = true;
    assert_int_equal(compare_with(&a, &b, &options, 2).reasons, CSGM_DIFF_REASON_VOLUME);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

typedef struct teller {
    int calls;
    double last;
    bool is_wrong;
} teller;

static void tell(void *user, csgm_stage stage, double fraction)
{
    teller *t = user;
    t->is_wrong |= stage != CSGM_STAGE_COMPARE || fraction < t->last || fraction > 1;
    t->last = fraction;
    t->calls++;
}

static void test_progress_never_falls(void **state)
{
    const csgm_vec3 high = {1.01, 1, 1};
    diff_shape a = diff_box(ORIGIN, ONE, 40), b = diff_box(ORIGIN, high, 50);
    csgm_diff_options options = few_samples();
    teller t = {0};
    options.monitor = (csgm_monitor){.progress = tell, .user = &t};
    assert_true(compare_with(&a, &b, &options, 2).is_different);
    assert_true(t.calls > 0);
    assert_false(t.is_wrong);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

/* Far from zero floats are coarse: what that does is in the bound, not added to the tolerance. */
static void test_never_same_above_tolerance(void **state)
{
    const csgm_vec3 low[2] = {{1e5, 1e5, 1e5}, {1e5 + 0.5078125, 1e5, 1e5}},
                    high[2] = {{1e5 + 1, 1e5 + 1, 1e5 + 1}, {1e5 + 1.5078125, 1e5 + 1, 1e5 + 1}};
    diff_shape a = diff_box(low[0], high[0], 3), b = diff_box(low[1], high[1], 2);
    csgm_diff_options options = few_samples();
    int same = 0;
    for (options.tolerance = 0.48; options.tolerance < 0.56; options.tolerance += 0.002) {
        csgm_diff_report report = compare_with(&a, &b, &options, 2);
        assert_true(report.hausdorff_upper >= 0.5078125);
        assert_int_equal(report.is_different, report.hausdorff_upper > options.tolerance);
        same += !report.is_different;
    }
    assert_true(same > 0);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

static void test_turned(void **state)
{
    const csgm_vec3 high = {1, 2, 3};
    diff_shape a = diff_box(ORIGIN, high, 2), b = diff_box(ORIGIN, high, 2);
    for (uint64_t v = 0; v < b.vertex_count; v++) {
        float y = b.positions[3 * v + 1], z = b.positions[3 * v + 2];
        b.positions[3 * v + 1] = z;
        b.positions[3 * v + 2] = -y;
    }
    csgm_diff_options options = few_samples();
    assert_true(compare_with(&a, &b, &options, 2).is_different);
    options.ignored = CSGM_DIFF_IGNORE_UP;
    csgm_diff_report r = compare_with(&a, &b, &options, 2);
    assert_true(r.is_turned && r.level == CSGM_DIFF_SAME_TRIANGLES);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

static void test_attributes(void **state)
{
    diff_shape a = diff_ball(12, 8, 1, ORIGIN);
    csgm_context *context = open_context(2);
    csgm_mesh_view left = diff_view(&a), right = diff_view(&a);
    uint8_t *colors = calloc(a.vertex_count, 4);
    uint8_t *others = calloc(a.vertex_count, 4);
    csgm_diff *diff;
    others[5] = 9;
    left.colors = colors;
    right.colors = others;
    left.normals = right.normals = a.positions;
    assert_int_equal(csgm_diff_meshes(context, &left, &right, NULL, &diff), CSGM_OK);
    assert_int_equal(csgm_diff_get_report(diff)->reasons, CSGM_DIFF_REASON_COLORS);
    assert_true(csgm_diff_get_report(diff)->colors.largest == 9);
    assert_true(csgm_diff_get_report(diff)->normals.is_compared);
    csgm_diff_destroy(diff);
    csgm_diff_options options = few_samples();
    options.ignored = CSGM_DIFF_IGNORE_COLORS;
    const csgm_mesh_part part = {"lid", 0, a.triangle_count};
    right.parts = &part;
    right.part_count = 1;
    assert_int_equal(csgm_diff_meshes(context, &left, &right, &options, &diff), CSGM_OK);
    assert_int_equal(csgm_diff_get_report(diff)->reasons, CSGM_DIFF_REASON_NAMES);
    csgm_diff_destroy(diff);
    csgm_context_destroy(context);
    free(colors);
    free(others);
    diff_shape_release(&a);
}

/* ---- out of memory -------------------------------------------------------------------------- */

typedef struct refusal {
    long left; /* allocations that still succeed */
} refusal;

static void *take(void *user, size_t size_bytes)
{
    refusal *r = user;
    return r->left-- > 0 ? malloc(size_bytes) : NULL;
}

static void give(void *user, void *memory, size_t size_bytes)
{
    free(memory);
}

static void test_each_allocation_fails(void **state)
{
    diff_shape a = diff_ball(12, 8, 1, ORIGIN), b = diff_ball(9, 9, 1.1, ORIGIN);
    csgm_mesh_view left = diff_view(&a), right = diff_view(&b);
    refusal r = {1000000};
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context;
    csgm_diff *diff = NULL;
    options.allocator = (csgm_allocator){take, give, &r};
    options.threads = 1;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    csgm_diff_options few = few_samples();
    few.samples = 100;
    uint64_t before = csgm_context_memory(context, NULL);
    csgm_status status = CSGM_ERR_MEMORY;
    long allowed = 0;
    for (; status != CSGM_OK && allowed < 10000; allowed++) {
        r.left = allowed;
        status = csgm_diff_meshes(context, &left, &right, &few, &diff);
        if (status != CSGM_OK) {
            assert_int_equal(status, CSGM_ERR_MEMORY);
            assert_int_equal(csgm_context_memory(context, NULL), before);
        }
    }
    assert_true(allowed > 10);
    csgm_diff_destroy(diff);
    assert_int_equal(csgm_context_memory(context, NULL), before);
    r.left = 1000000;
    csgm_context_destroy(context);
    diff_shape_release(&a);
    diff_shape_release(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shifted_boxes),
        cmocka_unit_test(test_concentric_balls),
        cmocka_unit_test(test_pulled_vertex),
        cmocka_unit_test(test_other_triangles),
        cmocka_unit_test(test_order_and_seams),
        cmocka_unit_test(test_random_pairs),
        cmocka_unit_test(test_another_unit),
        cmocka_unit_test(test_same_for_any_threads),
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_open),
        cmocka_unit_test(test_bad_views),
        cmocka_unit_test(test_tolerances),
        cmocka_unit_test(test_progress_never_falls),
        cmocka_unit_test(test_never_same_above_tolerance),
        cmocka_unit_test(test_turned),
        cmocka_unit_test(test_attributes),
        cmocka_unit_test(test_each_allocation_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
