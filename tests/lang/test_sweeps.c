/* SPDX-License-Identifier: MIT
 * sheet() against closed forms; sweep(): paths with their frames against closed forms, volumes by
 * Pappus, and random paths of all kinds: the field keeps its Lipschitz constant, no joint leaves a
 * wall inside, and nothing is inside that is farther from the path than the figure reaches.
 *
 *   test_lang_sweeps [TIMES [SEED]]     so many times as many random paths, from this seed on
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/bench_failing.h"
#include "lang/bench_fixture.h"
#include "scene/boxes/bounds.h"
#include "scene/reference.h"
#include "solid/path.h"

#define PI 3.14159265358979323846

static uint32_t times = 1;
static uint64_t first_seed = 1;

static csg_sample sample(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample s = csg_reference_eval(b.scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return s;
}

static csgm_status compile(const char *scene)
{
    return bench_compile_bytes(&b, scene, strlen(scene), NULL);
}

/* ---- paths ----------------------------------------------------------------------------------- */

static void make(csg_path *path, const csg_path_shape *shape)
{
    csg_path_finding found;
    assert_true(csg_path_make(path, &b.context.memory, shape, &found));
    assert_int_equal(found.fault, CSG_PATH_SOUND);
}

static void check_frame(const csg_path_frame *f)
{
    const csg_vec3 axes[3] = {f->x, f->y, f->tangent};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            assert_true(fabs(csg_vec3_dot(axes[i], axes[k]) - (i == k)) < 1e-13);
    assert_true(csg_vec3_norm(csg_vec3_sub(csg_vec3_cross(f->x, f->y), f->tangent)) < 1e-13);
}

static csg_vec3 place(const csg_path_piece *p, double part)
{
    double angle = p->angle * part * PI / 180;
    if (p->radius == 0)
        return csg_vec3_add(p->start.at, csg_vec3_scale(p->start.tangent, p->length * part));
    csg_vec3 along = csg_vec3_scale(p->start.tangent, p->radius * sin(angle));
    return csg_vec3_add(
        p->start.at, csg_vec3_add(along, csg_vec3_scale(p->inward, p->radius * (1 - cos(angle)))));
}

/* Points on a circle give that circle, and all of it; nothing turns. */
static void points_on_a_circle_are_a_circle(void **state)
{
    (void)state;
    csg_vec3 points[5];
    csg_path path;
    double length = 0;
    for (int i = 0; i < 5; i++) { /* at unequal angles, in a plane that leans */
        double angle = 2 * PI * (i + 0.3 * (i % 2)) / 5;
        points[i] = csg_vec3_make(7 * cos(angle), 7 * sin(angle) * 0.6, 7 * sin(angle) * 0.8);
    }
    const csg_path_shape shape = {
        .points = points, .count = 5, .closed = true, .smooth = true, .up = {0, 0, 1}};
    make(&path, &shape);
    for (size_t i = 0; i < path.count; i++) {
        const csg_path_piece *p = &path.pieces[i];
        assert_true(fabs(p->radius - 7) < 1e-12 && p->angle <= 90 && p->turn == 0);
        assert_false(csg_path_is_corner(&path, i));
        check_frame(&p->start);
        check_frame(&p->end);
        length += p->length;
    }
    assert_true(fabs(length - 14 * PI) < 1e-12);
    csg_path_release(&path);
}

/* A frame that is carried around an octant of a sphere has turned by its area, PI / 2. */
static void frames_turn_with_the_tangent_alone(void **state)
{
    (void)state;
    /* tangents x, y, z, then x again: the corners of an octant */
    const csg_vec3 points[5] = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {9, 9, 9}, {18, 9, 9}};
    for (int round = 0; round < 2; round++) {
        csg_path path;
        const csg_path_shape shape = {
            .points = points, .count = 5, .round = 2 * round, .up = {0, 0, 1}};
        make(&path, &shape);
        const csg_path_frame *first = &path.pieces[0].start,
                             *last = &path.pieces[path.count - 1].end;
        assert_true(fabs(csg_vec3_dot(first->y, last->y)) < 1e-14);
        assert_true(fabs(fabs(csg_vec3_dot(first->y, last->x)) - 1) < 1e-14);
        assert_int_equal(path.count, round ? 7 : 4);
        csg_path_release(&path);
    }
}

static void paths_that_turn_come_where_they_shall(void **state)
{
    (void)state;
    csg_vec3 points[13];
    csg_path path;
    for (int i = 0; i < 13; i++)
        points[i] = csg_vec3_make(10 * cos(i * PI / 6), 10 * sin(i * PI / 6), 0.5 * i);
    csg_path_shape shape = {
        .points = points, .count = 13, .smooth = true, .upright = true, .up = {0, 0, 1}};
    make(&path, &shape);
    for (size_t i = 0; i < path.count; i++) /* the figure's x axis is level */
        assert_true(fabs(path.pieces[i].start.x.z) < 1e-12);
    csg_path_release(&path);
    shape.upright = false;
    shape.closed = true;
    make(&path, &shape); /* what is closed has its first frame again */
    const csg_path_piece *last = &path.pieces[path.count - 1];
    double turn = last->turn * PI / 180;
    csg_vec3 x = csg_vec3_add(csg_vec3_scale(last->end.x, cos(turn)),
                              csg_vec3_scale(last->end.y, sin(turn)));
    assert_true(csg_vec3_norm(csg_vec3_sub(x, path.pieces[0].start.x)) < 1e-9);
    csg_path_release(&path);
}

/* ---- volumes --------------------------------------------------------------------------------- */

static double volume(int cells)
{
    csg_box box = csg_bounds_of_solid(b.scene);
    double cell = csg_box_longest_side(box) / cells, sum = 0;
    for (double x = box.min.x - 0.69 * cell; x < box.max.x + cell; x += cell)
        for (double y = box.min.y - 0.63 * cell; y < box.max.y + cell; y += cell)
            for (double z = box.min.z - 0.59 * cell; z < box.max.z + cell; z += cell) {
                csg_sample s = sample(csg_vec3_make(x, y, z));
                double slope = csg_vec3_norm(s.gradient);
                sum += fmin(fmax(s.value / fmax(slope, 0.01) / cell + 0.5, 0), 1);
            }
    return sum * cell * cell * cell;
}

/* Pappus: area times the way of the centroid, which is the path here. */
static void sweeps_have_the_volume_of_pappus(void **state)
{
    (void)state;
    const struct {
        const char *scene;
        double volume;
    } cases[] = {
        {"sweep([[0,0,0], [20,0,0], [20,20,0], [20,20,20]]) square([4,2], center = true);", 480},
        {"sweep([[0,0], [20,0], [20,12], [0,12]], closed = true) square(4, center = true);", 1024},
        {"sweep([[0,0,0], [20,0,0], [20,20,0]], round = 5) circle(2);", 4 * PI * (30 + 2.5 * PI)},
        {"sweep([[10,0], [0,10], [-10,0], [0,-10]], closed = true, smooth = true)"
         " square([2,3], center = true);",
         120 * PI},
        {"sweep([[0,0,0], [0,0,20]], twist = 90) square(4, center = true);", 320},
        {"sweep([[0,0,0], [0,0,20], [20,0,20]], round = 8, twist = 180) square(4, center = true);",
         16 * (24 + 4 * PI)},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(compile(cases[i].scene), CSGM_OK);
        double found = volume(56);
        if (fabs(found - cases[i].volume) > 0.015 * cases[i].volume)
            print_error("%s: %g, not %g\n", cases[i].scene, found, cases[i].volume);
        assert_true(fabs(found - cases[i].volume) <= 0.015 * cases[i].volume);
    }
}

static csg_vec3 near_scene(csg_random *random, csg_box box)
{
    return csg_vec3_make(csg_random_uniform(random, box.min.x, box.max.x),
                         csg_random_uniform(random, box.min.y, box.max.y),
                         csg_random_uniform(random, box.min.z, box.max.z));
}

static double way_to_ends(const csg_path *path, csg_vec3 p)
{
    csg_vec3 first = path->pieces[0].start.at, last = path->pieces[path->count - 1].end.at;
    return fmin(csg_vec3_norm(csg_vec3_sub(first, p)), csg_vec3_norm(csg_vec3_sub(last, p)));
}

/* From the path itself. */
static double distance_of(const csg_path *path, csg_vec3 q)
{
    double least = INFINITY;
    for (size_t i = 0; i < path->count; i++) {
        const csg_path_piece *p = &path->pieces[i];
        csg_vec3 to = csg_vec3_sub(q, p->start.at), near;
        double along = csg_vec3_dot(to, p->start.tangent);
        double inward = csg_vec3_dot(to, p->inward);
        double angle = atan2(along, p->radius - inward) * 180 / PI;
        double part = p->radius > 0 ? angle / p->angle : along / p->length;
        near = place(p, fmin(fmax(part, 0), 1));
        least = fmin(least, csg_vec3_norm(csg_vec3_sub(q, near)));
        for (int k = 0; k < 2; k++) /* an arc's ends, where the angle is behind it */
            least = fmin(least, csg_vec3_norm(csg_vec3_sub(q, place(p, k))));
    }
    return least;
}

/* A path of lines with arcs between them has the distance of the figure from the path as its field,
 * along arcs too, on their inner side and where the path turns back: inside, and outside nearly
 * everywhere; beside the end of an elbow, on the outer side of the next arc, it may be less, by no
 * more than sqrt(2) times. Of points that are nearer to the path than to its ends. */
static void round_paths_are_distances(void **state)
{
    (void)state;
    static const struct {
        const char *scene;
        csg_vec3 points[4];
        uint32_t count;
        double round;
    } cases[] = {
        {"sweep([[0,0,0], [30,0,0], [30,30,0], [30,30,30]], round = 6) circle(2);",
         {{0, 0, 0}, {30, 0, 0}, {30, 30, 0}, {30, 30, 30}},
         4,
         6},
        {"sweep([[0,0,0], [30,0,0], [8,14,5], [30,30,30]], round = 4) circle(2);",
         {{0, 0, 0}, {30, 0, 0}, {8, 14, 5}, {30, 30, 30}},
         4,
         4},
    };
    csg_random random = {first_seed + 77};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csg_path path;
        const csg_path_shape shape = {.points = cases[i].points,
                                      .count = cases[i].count,
                                      .round = cases[i].round,
                                      .up = {0, 0, 1}};
        make(&path, &shape);
        assert_int_equal(compile(cases[i].scene), CSGM_OK);
        csg_box box = csg_box_grow(csg_bounds_of_solid(b.scene), 2);
        uint32_t compared = 0, exact = 0;
        for (int n = 0; n < 3000; n++) {
            csg_vec3 q = near_scene(&random, box);
            double way = distance_of(&path, q);
            if (way > 4 || way_to_ends(&path, q) < 2 * way + 1)
                continue;
            compared++;
            double value = sample(q).value, wanted = 2 - way;
            if (value < wanted - 1e-9 || value > (wanted > 0 ? 1 : sqrt(0.5)) * wanted + 1e-9)
                fail_msg("case %zu: %g, not %g, at (%g, %g, %g)", i, value, wanted, q.x, q.y, q.z);
            exact += fabs(value - wanted) < 1e-9;
        }
        assert_true(compared > 150 && exact > 0.9 * compared);
        csg_path_release(&path);
    }
}

/* ---- polygons as skeletons ------------------------------------------------------------------- */

/* Steiner's formula: area, edges as half cylinders, corners as parts of one ball. */
static void sheets_have_the_volume_of_steiner(void **state)
{
    (void)state;
    const char *scene = "sheet([[1,2,0], [1,12,0], [1,12,10], [1,2,10]], 1);";
    assert_int_equal(compile(scene), CSGM_OK);
    double wanted = 200 + 20 * PI + 4 * PI / 3;
    assert_true(fabs(volume(56) - wanted) <= 0.01 * wanted);
}

/* The distance from a concave polygon in a plane that leans: beside an edge, a corner, the notch
 * and the face. */
static void sheets_are_distances(void **state)
{
    (void)state;
    const char *scene = "rotate([30, 0, 0]) translate([0, 0, 3])"
                        " sheet([[0,0], [8,0], [8,6], [4,2], [0,6]], 0.5);";
    assert_int_equal(compile(scene), CSGM_OK);
    const struct {
        csg_vec3 at; /* where the polygon lies in z = 3 */
        double distance;
    } cases[] = {
        {{4, 1, 5}, 2},  {{11, -4, 3}, 5},
        {{4, -3, 7}, 5}, {{4, 6, 3}, 2.8284271247461903}, /* of both edges of the notch */
        {{4, 6, 4}, 3},  {{9, 8, 5}, 3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csg_affine lean = csg_affine_rotate(30, csg_vec3_make(1, 0, 0));
        double value = sample(csg_affine_point(&lean, cases[i].at)).value;
        assert_true(fabs(value - (0.5 - cases[i].distance)) < 1e-6);
    }
}

/* The classical field: P of the distance from the polygon by R = r / d_iso. */
static void soft_sheets_have_their_own_range(void **state)
{
    (void)state;
    double of_sheet, of_ball;
    assert_int_equal(compile("soft() sheet([[0,0], [9,0], [9,9]], 2);"), CSGM_OK);
    of_sheet = sample(csg_vec3_make(6, 2, 2.7)).value;
    assert_int_equal(compile("soft() sphere(2);"), CSGM_OK);
    of_ball = sample(csg_vec3_make(0, 0, 2.7)).value;
    assert_true(fabs(of_sheet - of_ball) < 1e-5);
}

/* ---- random paths ---------------------------------------------------------------------------- */

typedef struct random_path {
    csg_vec3 points[8];
    csg_path_shape shape;
    char scene[1024];
} random_path;

static void draw_path(random_path *r, csg_random *random)
{
    static const char *const figures[] = {
        "circle(0.5)", "square([1.6, 1], center = true)",
        "difference() { circle(1.2); translate([0, 0.9]) circle(0.4); }"};
    uint32_t kind = csg_random_below(random, 3);
    r->shape = (csg_path_shape){.points = r->points,
                                .count = 3 + csg_random_below(random, 5),
                                .smooth = kind == 1,
                                .round = kind == 2 ? 1.5 : 0,
                                .up = {0.1, 0.2, 1}};
    r->shape.closed = csg_random_below(random, 3) == 0;
    r->shape.twist = csg_random_below(random, 3) == 0 ? csg_random_uniform(random, -90, 90) : 0;
    r->shape.upright = csg_random_below(random, 4) == 0;
    csg_vec3 at = {0, 0, 0};
    int used = snprintf(r->scene, sizeof r->scene, "sweep([");
    for (uint32_t i = 0; i < r->shape.count; i++) {
        r->points[i] = at;
        used += snprintf(r->scene + used, sizeof r->scene - (size_t)used, "%s[%.17g, %.17g, %.17g]",
                         i ? ", " : "", at.x, at.y, at.z);
        csg_vec3 way =
            csg_vec3_make(csg_random_uniform(random, -1, 1), csg_random_uniform(random, -1, 1),
                          csg_random_uniform(random, -1, 1));
        double length = csg_random_uniform(random, 7, 12);
        at = csg_vec3_add(at, csg_vec3_scale(csg_vec3_normalize(way), length));
    }
    snprintf(r->scene + used, sizeof r->scene - (size_t)used,
             "], closed = %s, smooth = %s, upright = %s, round = %g, twist = %.17g, "
             "up = [0.1, 0.2, 1]) %s;",
             r->shape.closed ? "true" : "false", r->shape.smooth ? "true" : "false",
             r->shape.upright ? "true" : "false", r->shape.round, r->shape.twist,
             figures[csg_random_below(random, 3)]);
}

static void check_slopes(csg_random *random)
{
    csg_box box = csg_box_grow(csg_bounds_of_solid(b.scene), 1);
    double lambda = csg_scene_lipschitz(b.scene);
    for (int i = 0; i < 100; i++) {
        csg_vec3 p = near_scene(random, box), q = near_scene(random, box);
        if (i % 2) /* jumps show between points that are near each other */
            q = csg_vec3_add(p, csg_vec3_scale(csg_vec3_normalize(q), 1e-3));
        csg_sample sp = sample(p), sq = sample(q);
        double way = csg_vec3_norm(csg_vec3_sub(p, q));
        assert_true(fabs(sp.value - sq.value) <= lambda * way + 1e-12);
        assert_true(csg_vec3_norm(sp.gradient) <= lambda * (1 + 1e-12));
    }
}

/* The shortest of a piece and its neighbours; whether one of them turns. */
static double shortest_near(const csg_path *path, size_t i, bool *turns)
{
    const size_t near[3] = {i, csg_path_before(path, i), csg_path_after(path, i)};
    double least = INFINITY;
    *turns = false;
    for (int k = 0; k < 3; k++)
        if (near[k] != SIZE_MAX) {
            least = fmin(least, path->pieces[near[k]].length);
            *turns = *turns || path->pieces[near[k]].turn != 0;
        }
    return least;
}

/* No wall at joints. All figures reach 0.5 around the path; where pieces are longer than that, a
 * third of it is left at h from a joint's plane: h of the piece itself, 0.5 - 2 h of what goes
 * across. What turns is divided by its constant. */
static void check_no_walls(const csg_path *path, const char *scene)
{
    for (size_t i = 0; i < path->count; i++)
        for (int k = 0; k <= 8; k++) {
            const csg_path_piece *p = &path->pieces[i];
            csg_vec3 at = place(p, k / 8.0);
            bool turns;
            if (!path->closed && way_to_ends(path, at) < 0.5)
                continue;
            double value = sample(at).value, shortest = shortest_near(path, i, &turns);
            double least = turns ? fmin(5e-4, 0.05 * shortest) : fmin(0.16, 0.45 * shortest);
            if (value < least)
                print_error("%s\npiece %zu of %zu, %d / 8: %g\n", scene, i, path->count, k, value);
            assert_true(value >= least);
        }
}

static double distance(const csg_path *path, csg_vec3 q)
{
    double least = INFINITY;
    for (size_t i = 0; i < path->count; i++)
        for (int k = 0; k <= 64; k++)
            least = fmin(least, csg_vec3_norm(csg_vec3_sub(q, place(&path->pieces[i], k / 64.0))));
    return least;
}

/* Points are at most 0.2 apart in distance() and figures reach at most 1.2. */
static void check_reach(const csg_path *path, csg_random *random)
{
    csg_box box = csg_bounds_of_solid(b.scene);
    for (int i = 0; i < 60; i++) {
        csg_vec3 q = near_scene(random, box);
        if (distance(path, q) > 1.35)
            assert_true(sample(q).value < 0);
    }
}

static void random_paths_keep_their_promises(void **state)
{
    (void)state;
    uint32_t made = 0, refused = 0;
    for (uint64_t n = 0; n < 60 * times; n++) {
        csg_random random = {first_seed + n};
        random_path r;
        csg_path path;
        csg_path_finding found;
        draw_path(&r, &random);
        bool is_path = csg_path_make(&path, &b.context.memory, &r.shape, &found);
        csgm_status status = compile(r.scene);
        assert_true(is_path || status != CSGM_OK);
        if (status == CSGM_OK) {
            made++;
            check_slopes(&random);
            check_no_walls(&path, r.scene);
            if (r.shape.smooth || r.shape.round > 0)
                check_reach(&path, &random);
        } else {
            refused++;
            if (!strstr(b.text, "sweep(): "))
                print_error("%s\n%s", r.scene, b.text);
            assert_non_null(strstr(b.text, "sweep(): "));
        }
        csg_path_release(&path);
    }
    print_message("%u made, %u refused\n", made, refused);
    assert_true(made > 20 * times);
}

static csgm_status attempt(bench *poor)
{
    static const char scene[] =
        "sweep([[0,0,0], [9,0,0], [9,9,0]], closed = true, round = 2, twist = 20)"
        " square(1, center = true);";
    return bench_compile_bytes(poor, scene, sizeof scene - 1, NULL);
}

static csgm_status attempt_elbows(bench *poor)
{
    static const char scene[] = "sweep([[0,0,0], [9,0,0], [4,4,0], [4,9,0]], round = 1)"
                                " square(1, center = true);";
    return bench_compile_bytes(poor, scene, sizeof scene - 1, NULL);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(attempt, 60, 12) > 60);
    assert_true(bench_fail_every(attempt_elbows, 60, 12) > 60);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_on_a_circle_are_a_circle),
        cmocka_unit_test(frames_turn_with_the_tangent_alone),
        cmocka_unit_test(paths_that_turn_come_where_they_shall),
        cmocka_unit_test(sweeps_have_the_volume_of_pappus),
        cmocka_unit_test(round_paths_are_distances),
        cmocka_unit_test(sheets_have_the_volume_of_steiner),
        cmocka_unit_test(sheets_are_distances),
        cmocka_unit_test(soft_sheets_have_their_own_range),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(random_paths_keep_their_promises),
    };
    if (argc > 1)
        times = (uint32_t)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_seed = strtoull(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
