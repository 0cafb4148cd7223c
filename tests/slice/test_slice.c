/* SPDX-License-Identifier: MIT
 * Layers: closed forms, and of random scenes that contours are closed, oriented and uncrossed, on
 * the surface to the tolerance, and that they part inside from outside wherever the reference says
 * that it is farther from the surface than that.
 */
#include <stdio.h>
#include <stdlib.h>

#include "mesh/mesh_support.h"
#include "slice/slice.h"

enum { MOST_LAYERS = 64 };

typedef struct taken_layers {
    csg_sliced_layer layers[MOST_LAYERS];
    size_t count;
    csg_memory *memory;
    csgm_slice_stats stats;
} taken_layers;

static bool accept_head(void *user, const csg_layers_head *head)
{
    assert_true(head->count <= MOST_LAYERS);
    ((taken_layers *)user)->count = head->count;
    return true;
}

static void take_layer(void *user, csg_page *page, const csg_layers_head *head,
                       const csg_sliced_layer *layer)
{
    taken_layers *t = user;
    csg_sliced_layer *own = &t->layers[layer->number];
    *own = *layer;
    csg_outline_init(&own->contours, t->memory);
    assert_true(csg_outline_append(&own->contours, &layer->contours));
    csg_page_text(page, ".");
}

static bool take_page(void *user, const csg_page *page)
{
    assert_true(page->length > 0);
    return true;
}

static taken_layers *slice(mesh_case *c, double height, double tolerance)
{
    taken_layers *t = calloc(1, sizeof *t);
    const csg_layers_receiver receiver = {t, accept_head, take_layer, take_page};
    const csgm_slice_options options = {.height = height, .tolerance = tolerance};
    assert_non_null(t);
    t->memory = &c->context.memory;
    assert_int_equal(csg_slice_field(&c->context, c->field, &options, &receiver, &t->stats),
                     CSGM_OK);
    assert_int_equal(t->stats.layers, t->count);
    return t;
}

static void release(taken_layers *t)
{
    for (size_t i = 0; i < t->count; i++)
        csg_outline_release(&t->layers[i].contours);
    free(t);
}

static taken_layers *slice_node(mesh_case *c, csg_node_id (*make)(mesh_case *c), double height,
                                double tolerance)
{
    mesh_case_begin(c, 2);
    mesh_case_compile(c, make(c));
    return slice(c, height, tolerance);
}

static void forget(mesh_case *c, taken_layers *t)
{
    release(t);
    mesh_case_end(c);
}

static double cross_of(csg_vec2 a, csg_vec2 b, csg_vec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static double loop_area(const csg_outline *o, size_t loop)
{
    double twice = 0;
    size_t first = csg_outline_first(o, loop);
    for (size_t i = first + 1; i + 1 < o->ends[loop]; i++)
        twice += cross_of(o->points[first], o->points[i], o->points[i + 1]);
    return 0.5 * twice;
}

/* ---- closed forms ------------------------------------------------------------------------------
 */

static csg_node_id ball(mesh_case *c)
{
    return moved(c, make_sphere(c, 5), 1, -2, 3);
}

static void balls_have_circles(void **state)
{
    static const double TOLERANCE = 0.01, PI = 3.14159265358979;
    mesh_case c;
    taken_layers *t = slice_node(&c, ball, 0.5, TOLERANCE);
    assert_int_equal(t->count, 20);
    double volume = 0;
    for (size_t i = 0; i < t->count; i++) {
        const csg_outline *o = &t->layers[i].contours;
        double z = t->layers[i].at - 3, r = sqrt(25 - z * z);
        assert_true(fabs(t->layers[i].at - (-2 + 0.5 * ((double)i + 0.5))) < 1e-12);
        assert_int_equal(o->loop_count, 1);
        double area = loop_area(o, 0), slope = r / 5;
        assert_true(fabs(area - PI * r * r) <= 2 * PI * r * TOLERANCE / slope);
        volume += 0.5 * area;
        for (size_t k = 0; k < o->point_count; k++) {
            csg_vec2 p = o->points[k], q = o->points[(k + 1) % o->point_count];
            double mx = 0.5 * (p.x + q.x) - 1, my = 0.5 * (p.y + q.y) + 2;
            double at = sqrt((p.x - 1) * (p.x - 1) + (p.y + 2) * (p.y + 2) + z * z);
            assert_true(fabs(at - 5) < TOLERANCE / 300);
            assert_true(fabs(sqrt(mx * mx + my * my + z * z) - 5) <= TOLERANCE);
        }
    }
    assert_true(fabs(t->stats.volume - volume) < 1e-9 * volume);
    assert_int_equal(t->stats.unsettled, 0);
    forget(&c, t);
}

static csg_node_id box(mesh_case *c)
{
    return moved(c, make_box(c, 5, 3, 2), 0.5, 0.25, 2);
}

static void boxes_have_four_corners(void **state)
{
    mesh_case c;
    taken_layers *t = slice_node(&c, box, 0.4, 0.01);
    assert_int_equal(t->count, 10);
    for (size_t i = 0; i < t->count; i++) {
        const csg_outline *o = &t->layers[i].contours;
        assert_int_equal(o->loop_count, 1);
        assert_int_equal(o->point_count, 4);
        for (size_t k = 0; k < 4; k++) {
            assert_true(fabs(fabs(o->points[k].x - 0.5) - 5) < 1e-5);
            assert_true(fabs(fabs(o->points[k].y - 0.25) - 3) < 1e-5);
        }
        assert_true(fabs(loop_area(o, 0) - 60) < 2e-4);
    }
    forget(&c, t);
}

static csg_node_id turned_box(mesh_case *c)
{
    return turned(c, make_box(c, 5, 3, 2), 31, csg_vec3_make(0, 0, 1));
}

static void turned_boxes_too(void **state)
{
    mesh_case c;
    taken_layers *t = slice_node(&c, turned_box, 1, 0.01);
    for (size_t i = 0; i < t->count; i++) {
        const csg_outline *o = &t->layers[i].contours;
        assert_int_equal(o->loop_count, 1);
        assert_int_equal(o->point_count, 4);
        assert_true(fabs(loop_area(o, 0) - 60) < 2e-4);
    }
    forget(&c, t);
}

/* A tube: two circles, the inner one clockwise. */
static csg_node_id tube(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_cylinder(c, 4, 3), make_cylinder(c, 3, 4));
}

static void holes_are_clockwise(void **state)
{
    static const double PI = 3.14159265358979;
    mesh_case c;
    taken_layers *t = slice_node(&c, tube, 1, 0.005);
    assert_int_equal(t->count, 6);
    for (size_t i = 0; i < t->count; i++) {
        const csg_outline *o = &t->layers[i].contours;
        assert_int_equal(o->loop_count, 2);
        double a = loop_area(o, 0), b = loop_area(o, 1);
        assert_true(fabs(fmax(a, b) - 16 * PI) < 8 * PI * 0.005);
        assert_true(fabs(fmin(a, b) + 9 * PI) < 6 * PI * 0.005);
    }
    forget(&c, t);
}

/* A wall of twice the tolerance, which runs between the corners of all squares but the small. */
static csg_node_id thin_wall(mesh_case *c)
{
    return turned(c, make_box(c, 5, 0.01, 2), 20, csg_vec3_make(0, 0, 1));
}

static void thin_walls_are_seen(void **state)
{
    mesh_case c;
    taken_layers *t = slice_node(&c, thin_wall, 1, 0.01);
    for (size_t i = 0; i < t->count; i++) {
        const csg_outline *o = &t->layers[i].contours;
        assert_int_equal(o->loop_count, 1);
        assert_true(fabs(loop_area(o, 0) - 0.2) < 0.01);
    }
    forget(&c, t);
}

/* ---- random scenes -----------------------------------------------------------------------------
 */

static bool is_within_box(csg_vec2 p, csg_vec2 a, csg_vec2 b)
{
    return p.x >= fmin(a.x, b.x) && p.x <= fmax(a.x, b.x) && p.y >= fmin(a.y, b.y) &&
           p.y <= fmax(a.y, b.y);
}

static bool do_cross(csg_vec2 a, csg_vec2 b, csg_vec2 c, csg_vec2 d)
{
    double u = cross_of(a, b, c), v = cross_of(a, b, d), s = cross_of(c, d, a),
           t = cross_of(c, d, b);
    if (((u > 0) != (v > 0)) && ((s > 0) != (t > 0)))
        return u != 0 || v != 0;
    return (u == 0 && is_within_box(c, a, b)) || (v == 0 && is_within_box(d, a, b));
}

typedef struct sweep_segment {
    csg_vec2 from, to;
    double low, high; /* along x */
    size_t index, next;
} sweep_segment;

static int by_low(const void *a, const void *b)
{
    const sweep_segment *p = a, *q = b;
    return (p->low > q->low) - (p->low < q->low);
}

static sweep_segment *segments_of(const csg_outline *o)
{
    sweep_segment *all = malloc((o->point_count + 1) * sizeof *all);
    assert_non_null(all);
    for (size_t loop = 0; loop < o->loop_count; loop++) {
        size_t first = csg_outline_first(o, loop);
        for (size_t i = first; i < o->ends[loop]; i++) {
            size_t next = i + 1 < o->ends[loop] ? i + 1 : first;
            csg_vec2 p = o->points[i], q = o->points[next];
            all[i] = (sweep_segment){p, q, fmin(p.x, q.x), fmax(p.x, q.x), i, next};
        }
    }
    qsort(all, o->point_count, sizeof *all, by_low);
    return all;
}

static void assert_uncrossed(const csg_outline *o, const char *what)
{
    sweep_segment *all = segments_of(o);
    for (size_t i = 0; i < o->point_count; i++)
        for (size_t k = i + 1; k < o->point_count && all[k].low <= all[i].high; k++) {
            const sweep_segment *p = &all[i], *q = &all[k];
            bool are_neighbours = p->next == q->index || q->next == p->index;
            if (!are_neighbours && do_cross(p->from, p->to, q->from, q->to))
                fail_msg("%s: (%.9g, %.9g) to (%.9g, %.9g) crosses (%.9g, %.9g) to (%.9g, %.9g)",
                         what, p->from.x, p->from.y, p->to.x, p->to.y, q->from.x, q->from.y,
                         q->to.x, q->to.y);
        }
    free(all);
}

/* How often the contours run around the point, counter-clockwise. */
static int winding(const csg_outline *o, csg_vec2 at)
{
    int turns = 0;
    for (size_t loop = 0; loop < o->loop_count; loop++) {
        size_t first = csg_outline_first(o, loop);
        for (size_t i = first; i < o->ends[loop]; i++) {
            csg_vec2 p = o->points[i], q = o->points[i + 1 < o->ends[loop] ? i + 1 : first];
            if (p.y <= at.y && q.y > at.y && cross_of(p, q, at) > 0)
                turns++;
            else if (p.y > at.y && q.y <= at.y && cross_of(p, q, at) < 0)
                turns--;
        }
    }
    return turns;
}

static bool has_jumps; /* of fillets: the field is not what its gradients say */

static size_t check_layer(const mesh_case *c, const csg_sliced_layer *layer, double tolerance,
                          csg_random *random, const char *what)
{
    enum { POINTS = 200 };
    const csg_outline *o = &layer->contours;
    double steepest = fmax(1, (double)c->field->tape.lipschitz);
    double room = tolerance * steepest;
    size_t told = 0;
    assert_uncrossed(o, what);
    for (size_t loop = 0; loop < o->loop_count && !has_jumps; loop++) {
        size_t first = csg_outline_first(o, loop);
        for (size_t i = first; i < o->ends[loop]; i++) {
            csg_vec2 p = o->points[i], q = o->points[i + 1 < o->ends[loop] ? i + 1 : first];
            double at = test_sample(c->scene, (csg_vec3){p.x, p.y, layer->at}).value;
            double middle =
                test_sample(c->scene, (csg_vec3){0.5 * (p.x + q.x), 0.5 * (p.y + q.y), layer->at})
                    .value;
            if (!(fabs(at) <= room && fabs(middle) <= room))
                fail_msg("%s: f = %g at (%.9g, %.9g, %.9g), %g behind it", what, at, p.x, p.y,
                         layer->at, middle);
        }
    }
    csg_box b = c->field->bounds;
    for (int i = 0; i < POINTS; i++) {
        csg_vec2 at = {csg_random_uniform(random, b.min.x, b.max.x),
                       csg_random_uniform(random, b.min.y, b.max.y)};
        double f = test_sample(c->scene, (csg_vec3){at.x, at.y, layer->at}).value;
        if (fabs(f) <= room)
            continue;
        told++;
        if (winding(o, at) != (f > 0))
            fail_msg("%s: f = %g at (%.9g, %.9g, %.9g), around which contours run %d times", what,
                     f, at.x, at.y, layer->at, winding(o, at));
    }
    return told;
}

static void random_scenes(void **state)
{
    size_t told = 0, contours = 0, points = 0;
    for (uint64_t i = 0; i < ROUNDS(48) * test_times; i++) {
        csg_random random = {.state = 2300 + test_first_seed + i};
        char what[40];
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_node_id root = test_random_mixed(&c.builder, &random, i);
        has_jumps = test_random_fillets;
        assert_true(root != CSG_NODE_NONE);
        mesh_case_compile(&c, root);
        csg_box b = c.field->bounds;
        if (csg_box_is_finite(b) && !csg_box_is_empty(b) && !test_has_debulge(c.scene)) {
            csg_vec3 size = csg_box_size(b);
            double tolerance = fmax(size.x, fmax(size.y, size.z)) / 400;
            taken_layers *t = slice(&c, size.z / 5.5, tolerance);
            snprintf(what, sizeof what, "scene %d", (int)i);
            for (size_t k = 0; k < t->count; k++) {
                contours += t->layers[k].contours.loop_count;
                points += t->layers[k].contours.point_count;
                told += check_layer(&c, &t->layers[k], tolerance, &random, what);
            }
            release(t);
        }
        mesh_case_end(&c);
    }
    assert_true(told > ROUNDS(20000) * test_times && contours > ROUNDS(200) * test_times &&
                points > ROUNDS(5000) * test_times);
}

/* ---- limits ------------------------------------------------------------------------------------
 */

static bool always(void *user)
{
    return true;
}

static void stopped_in_time(void **state)
{
    mesh_case c;
    taken_layers t = {.count = 0};
    const csg_layers_receiver receiver = {&t, accept_head, take_layer, take_page};
    csgm_slice_options options = {
        .height = 0.5, .tolerance = 0.01, .monitor = {.cancelled = always}};
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, ball(&c));
    assert_int_equal(csg_slice_field(&c.context, c.field, &options, &receiver, &t.stats),
                     CSGM_CANCELLED);
    assert_int_equal(t.stats.layers, 0);
    mesh_case_end(&c);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_have_circles),  cmocka_unit_test(boxes_have_four_corners),
        cmocka_unit_test(turned_boxes_too),    cmocka_unit_test(holes_are_clockwise),
        cmocka_unit_test(thin_walls_are_seen), cmocka_unit_test(random_scenes),
        cmocka_unit_test(stopped_in_time),
    };
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
