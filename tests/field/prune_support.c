/* SPDX-License-Identifier: MIT
 * See prune_support.h.
 */
#include "field/prune_support.h"

#include <float.h>

enum { LEVELS = 5, POINTS_IN_CELL = 64 };

void walk_begin(walk *w, double extent)
{
    w->kernel = csg_kernel_for(csg_cpu_best_isa(CSGM_ISA_AUTO));
    w->rounding = 32 * (double)FLT_EPSILON * extent;
    csg_pruner_init(&w->pruner, &w->subject.context.memory, w->kernel, (float)w->rounding);
    csg_arena_init(&w->arena, &w->subject.context.memory);
}

void walk_end(walk *w)
{
    csg_pruner_release(&w->pruner);
    csg_arena_reset(&w->arena);
    test_subject_end(&w->subject);
}

cube child_of(cube parent, int octant)
{
    double q = parent.half / 2;
    csg_vec3 step = {octant & 1 ? q : -q, octant & 2 ? q : -q, octant & 4 ? q : -q};
    return (cube){csg_vec3_add(parent.center, step), q};
}

void prune_children(walk *w, const csg_tape *tape, cube parent)
{
    float c[3][CSG_OCTANTS];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        csg_vec3 at = child_of(parent, o).center;
        c[0][o] = (float)at.x, c[1][o] = (float)at.y, c[2][o] = (float)at.z;
    }
    double radius = parent.half / 2 * sqrt(3.0) * (1 + 4 * (double)FLT_EPSILON);
    assert_true(csg_prune_octants(&w->pruner, tape, c[0], c[1], c[2], (float)radius));
}

/* Corners, the middle, random points, and as many near the surface as a few steps can bring there.
 */
static void points_in_cube(const walk *w, csg_random *random, cube k, test_points *points)
{
    test_points_clear(points);
    test_points_add(points, k.center);
    for (int corner = 0; corner < 8; corner++) {
        csg_vec3 way = {corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1};
        test_points_add(points, csg_vec3_add(k.center, csg_vec3_scale(way, k.half)));
    }
    while (points->count < POINTS_IN_CELL) {
        csg_vec3 p = csg_vec3_add(k.center, test_point(random, k.half));
        for (int step = 0; step < 2 && points->count % 2; step++) {
            csg_sample s = test_sample(w->subject.scene, csg_vec3_add(p, w->subject.field->center));
            csg_vec3 to = csg_vec3_sub(p, csg_vec3_scale(s.gradient, s.value));
            p.x = fmin(fmax(to.x, k.center.x - k.half), k.center.x + k.half);
            p.y = fmin(fmax(to.y, k.center.y - k.half), k.center.y + k.half);
            p.z = fmin(fmax(to.z, k.center.z - k.half), k.center.z + k.half);
        }
        test_points_add(points, p);
    }
}

/* The root's interval of the last prune_children holds every value in the child. */
static void check_interval(const walk *w, const csg_tape *tape, int octant,
                           const test_points *points, const test_results *r, const char *what)
{
    size_t root = ((size_t)tape->count - 1) * CSG_OCTANTS + (size_t)octant;
    double low = (double)w->pruner.low[root], high = (double)w->pruner.high[root];
    csg_cell_state state = csg_prune_state(&w->pruner, octant);
    for (size_t i = 0; i < points->count; i++) {
        double value = (double)r->value[i];
        double exact =
            i % 8 ? value
                  : test_sample(w->subject.scene, test_points_in_scene(points, i, w->subject.field))
                        .value;
        if (!(low <= value && value <= high))
            fail_msg("%s: %.9g is not in [%.9g, %.9g]", what, value, low, high);
        /* Far from the surface a shortened tape has another value of the same sign. */
        if (tape->nodes == w->subject.field->tape.nodes && !(low <= exact && exact <= high))
            fail_msg("%s: exactly %.17g is not in [%.9g, %.9g]", what, exact, low, high);
        if ((state == CSG_CELL_OUTSIDE && !(value < 0 && exact < 0)) ||
            (state == CSG_CELL_INSIDE && !(value >= 0 && exact >= 0)))
            fail_msg("%s: state %d of a cell with %.9g (%.17g)", what, (int)state, value, exact);
    }
}

/* Same bits in the band, same sign outside; keeps only the band's results for the comparison. */
size_t keep_band(test_results *full, test_results *other, size_t count, double tau,
                 const char *what)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        float f = full->value[i];
        if ((f >= 0) != (other->value[i] >= 0))
            fail_msg("%s: %.9g has become %.9g", what, (double)f, (double)other->value[i]);
        if (fabs((double)f) > tau)
            continue;
        test_results *both[2] = {full, other};
        for (int k = 0; k < 2; k++) {
            both[k]->value[kept] = both[k]->value[i];
            for (int c = 0; c < 3; c++)
                both[k]->gradient[c][kept] = both[k]->gradient[c][i];
            for (int c = 0; c < 4; c++)
                both[k]->color[c][kept] = both[k]->color[c][i];
        }
        kept++;
    }
    return kept;
}

/* One random way down from a cube: its tape is shortened again at each level. */
void descend(walk *w, csg_random *random, cube at, double tau, const char *what)
{
    static test_points points;
    static test_results full, other;
    csg_tape tape = w->subject.field->tape;
    for (int level = 0; level < LEVELS; level++) {
        prune_children(w, &tape, at);
        int next = -1;
        uint32_t first = csg_random_below(random, CSG_OCTANTS);
        for (uint32_t k = 0; k < CSG_OCTANTS; k++) {
            int octant = (int)((first + k) % CSG_OCTANTS);
            csg_cell_state state = csg_prune_state(&w->pruner, octant);
            if (k < 2 || (state == CSG_CELL_SURFACE && next < 0)) {
                points_in_cube(w, random, child_of(at, octant), &points);
                test_evaluate(w->kernel, &tape, &points, &other);
                check_interval(w, &tape, octant, &points, &other, what);
                w->cells++;
                w->outside += state == CSG_CELL_OUTSIDE;
                w->inside += state == CSG_CELL_INSIDE;
            }
            if (state == CSG_CELL_SURFACE && next < 0)
                next = octant; /* the points left are of this child, if it is the last looked at */
        }
        if (next < 0)
            return;
        at = child_of(at, next);
        csg_tape shorter;
        assert_true(csg_prune_shorten(&w->pruner, next, (float)tau, &w->arena, &shorter));
        assert_true(shorter.count <= tape.count);
        w->shortened += shorter.count < tape.count;
        tape = shorter;
        points_in_cube(w, random, at, &points);
        test_evaluate(w->kernel, &w->subject.field->tape, &points, &full);
        test_evaluate(w->kernel, &tape, &points, &other);
        size_t kept = keep_band(&full, &other, points.count, tau, what);
        test_same_bits(&full, &other, kept, false, what);
        w->in_band += kept;
    }
}
