/* SPDX-License-Identifier: MIT
 * Fillets beside what they stand for, the closing of their solids by a ball of radius r: random
 * pairs and triples of boxes, cylinders, balls, cones, tori and polyhedra, turned, whose faces open
 * by more than 50 degrees, r at most half of the smallest curvature radius R. Away from ends, where
 * no ball can touch an edge of a solid.
 *
 * The fillet takes surfaces for their tangent planes. Two arcs of radius R that a ball joins turn
 * from each other by as much in 1 / (1/r + 1/R) as planes do in r: so planes add too much, at most
 * by (1 + r/R)^2. That, and not less than the closing, is what is asked here; and how many scenes
 * are within 10 % is printed. Of what is added at ends, where a ball touches edges, little lies
 * outside of the solids' convex hull.
 *
 *   test_lang_closing [COUNT [SEED [CELLS]]]     so many scenes, from this seed on, CELLS a radius
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/bench_fixture.h"
#include "lang/closing.h"

static uint32_t scene_count = 3;
static uint64_t first_seed = 1;
static double cells = 4;

enum { MOST_POINTS = 8, MOST_EDGES = 12, MOST_SAMPLES = 20000 };

typedef enum solid_kind { BOX, CYLINDER, BALL, CONE, TORUS, POLYHEDRON, KINDS } solid_kind;

typedef struct solid {
    solid_kind kind;
    double a, b, h; /* radii, half height */
    csg_vec3 points[MOST_POINTS];
    uint32_t point_count;
    csg_affine pose;
    double curvature; /* smallest curvature radius; INFINITY: plane faces */
    double size;
} solid;

typedef struct scene {
    solid solids[CLOSING_MOST];
    uint32_t count;
    double r, curvature; /* smallest curvature radius */
    char text[4096];
    int used;
    csg_vec3 *edges; /* samples of edges that are in no other solid */
    uint32_t edge_count;
} scene;

/* ---- scenes ----------------------------------------------------------------------------------- */

static csg_vec3 draw_point(csg_random *random, double size)
{
    return csg_vec3_make(csg_random_uniform(random, -size, size),
                         csg_random_uniform(random, -size, size),
                         csg_random_uniform(random, -size, size));
}

static void say(scene *s, const char *format, ...)
{
    va_list rest;
    va_start(rest, format);
    s->used += vsnprintf(s->text + s->used, sizeof s->text - (size_t)s->used, format, rest);
    va_end(rest);
    assert_true((size_t)s->used < sizeof s->text);
}

/* A box with its corners moved by an affine map, or a tetrahedron. */
static const int faces_of_box[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
static const int faces_of_four[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};

static void set_corners(solid *o, csg_vec3 half, csg_vec3 lean)
{
    o->point_count = 8;
    for (uint32_t k = 0; k < 8; k++) {
        double x = k & 1 ? half.x : -half.x, y = k & 2 ? half.y : -half.y;
        double z = k & 4 ? half.z : -half.z;
        o->points[k] = csg_vec3_make(x + lean.x * y + lean.y * z, y + lean.z * z, z);
    }
}

static void draw_polyhedron(solid *o, csg_random *random, csg_vec3 half)
{
    if (csg_random_below(random, 2)) {
        set_corners(o, half, draw_point(random, 0.5));
        return;
    }
    static const double at[4][3] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
    o->point_count = 4;
    for (uint32_t k = 0; k < 4; k++)
        o->points[k] = csg_vec3_add(csg_vec3_make(0.8 * at[k][0], 0.8 * at[k][1], 0.8 * at[k][2]),
                                    draw_point(random, 0.2));
}

static void draw_solid(solid *o, csg_random *random)
{
    csg_vec3 half = csg_vec3_add(csg_vec3_make(0.6, 0.6, 0.6), draw_point(random, 0.3));
    *o = (solid){.kind = (solid_kind)csg_random_below(random, KINDS), .curvature = INFINITY};
    o->a = csg_random_uniform(random, 0.3, 0.7);
    o->h = csg_random_uniform(random, 0.4, 0.9);
    o->size = 0.6;
    if (o->kind == CONE)
        o->b = o->a * csg_random_uniform(random, 0.4, 0.9);
    if (o->kind == TORUS) {
        o->a = csg_random_uniform(random, 0.6, 0.9);
        o->b = csg_random_uniform(random, 0.15, 0.3);
    }
    if (o->kind == BOX)
        set_corners(o, half, csg_vec3_make(0, 0, 0));
    else if (o->kind == POLYHEDRON)
        draw_polyhedron(o, random, half);
    else
        o->curvature = o->kind == CONE || o->kind == TORUS ? o->b : o->a;
}

static void say_polyhedron(scene *s, const solid *o)
{
    say(s, "polyhedron(points = [");
    for (uint32_t k = 0; k < o->point_count; k++)
        say(s, "%s[%.17g, %.17g, %.17g]", k ? ", " : "", o->points[k].x, o->points[k].y,
            o->points[k].z);
    say(s, "], faces = [");
    for (int k = 0; k < (o->point_count == 4 ? 4 : 6); k++)
        if (o->point_count == 4)
            say(s, "%s[%d, %d, %d]", k ? ", " : "", faces_of_four[k][0], faces_of_four[k][1],
                faces_of_four[k][2]);
        else
            say(s, "%s[%d, %d, %d, %d]", k ? ", " : "", faces_of_box[k][0], faces_of_box[k][1],
                faces_of_box[k][2], faces_of_box[k][3]);
    say(s, "]);\n");
}

static void say_solid(scene *s, const solid *o)
{
    switch (o->kind) {
    case BOX:
        say(s, "cube([%.17g, %.17g, %.17g], center = true);\n", 2 * o->points[7].x,
            2 * o->points[7].y, 2 * o->points[7].z);
        break;
    case BALL:
        say(s, "sphere(%.17g);\n", o->a);
        break;
    case CYLINDER:
        say(s, "cylinder(h = %.17g, r = %.17g, center = true);\n", 2 * o->h, o->a);
        break;
    case CONE:
        say(s, "cylinder(h = %.17g, r1 = %.17g, r2 = %.17g, center = true);\n", 2 * o->h, o->a,
            o->b);
        break;
    case TORUS:
        say(s, "torus(r = %.17g, tube = %.17g);\n", o->a, o->b);
        break;
    default:
        say_polyhedron(s, o);
    }
}

static void draw_scene(scene *s, csg_random *random)
{
    double least = INFINITY, size = INFINITY;
    s->used = 0;
    s->count = 2 + csg_random_below(random, 2);
    for (uint32_t i = 0; i < s->count; i++) {
        draw_solid(&s->solids[i], random);
        least = fmin(least, s->solids[i].curvature);
        size = fmin(size, s->solids[i].size);
    }
    s->curvature = least;
    s->r = csg_random_uniform(random, 0.5, 1) * fmin(least / 2, size / 4);
    say(s, "union(blend = fillet(%.17g)) {\n", s->r);
    for (uint32_t i = 0; i < s->count; i++) {
        solid *o = &s->solids[i];
        csg_vec3 axis =
            csg_vec3_normalize(csg_vec3_add(draw_point(random, 1), csg_vec3_make(0, 0, 1.1)));
        csg_vec3 to = draw_point(random, 0.6);
        double angle = csg_random_uniform(random, -180, 180);
        o->pose = csg_affine_multiply(csg_affine_translate(to), csg_affine_rotate(angle, axis));
        say(s, "  translate([%.17g, %.17g, %.17g]) rotate(a = %.17g, v = [%.17g, %.17g, %.17g]) ",
            to.x, to.y, to.z, angle, axis.x, axis.y, axis.z);
        say_solid(s, o);
    }
    say(s, "}\n");
}

/* ---- edges ------------------------------------------------------------------------------------ */

static void add_edge(scene *s, closing *c, uint32_t of, csg_vec3 own)
{
    csg_sample samples[CLOSING_MOST];
    csg_vec3 p = csg_affine_point(&s->solids[of].pose, own);
    closing_operands(c, p, samples);
    assert_true(fabs(samples[of].value) < 1e-9);
    for (uint32_t k = 0; k < s->count; k++)
        if (k != of && samples[k].value > 0)
            return;
    assert_true(s->edge_count < MOST_SAMPLES);
    s->edges[s->edge_count++] = p;
}

static void add_line(scene *s, closing *c, uint32_t of, csg_vec3 from, csg_vec3 to)
{
    csg_vec3 way = csg_vec3_sub(to, from);
    int parts = (int)ceil(csg_vec3_norm(way) / (s->r / 3));
    for (int i = 0; i <= parts; i++)
        add_edge(s, c, of, csg_vec3_add(from, csg_vec3_scale(way, (double)i / parts)));
}

static void add_rim(scene *s, closing *c, uint32_t of, double radius, double height)
{
    int parts = (int)ceil(2 * acos(-1) * radius / (s->r / 3));
    for (int i = 0; i < parts; i++) {
        double angle = 2 * acos(-1) * i / parts;
        add_edge(s, c, of, csg_vec3_make(radius * cos(angle), radius * sin(angle), height));
    }
}

static void find_edges(scene *s, closing *c)
{
    s->edge_count = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        const solid *o = &s->solids[i];
        if (o->kind == CYLINDER || o->kind == CONE) {
            add_rim(s, c, i, o->a, -o->h);
            add_rim(s, c, i, o->kind == CONE ? o->b : o->a, o->h);
        }
        for (uint32_t k = 0; k < o->point_count; k++)
            for (uint32_t l = 0; l < k; l++) /* two bits differ: no edge of a box */
                if (o->point_count == 4 || ((k ^ l) & ((k ^ l) - 1)) == 0)
                    add_line(s, c, i, o->points[k], o->points[l]);
    }
}

/* A ball that holds p may touch an edge. */
static bool is_near_end(const scene *s, csg_vec3 p)
{
    for (uint32_t i = 0; i < s->edge_count; i++)
        if (csg_vec3_norm(csg_vec3_sub(s->edges[i], p)) < (2 + 1.0 / 6) * s->r)
            return true;
    return false;
}

/* ---- the convex hull --------------------------------------------------------------------------- */

static double reach_of(const solid *o, csg_vec3 n)
{
    csg_vec3 own = csg_affine_covector(&o->pose, n);
    double along = csg_vec3_dot(n, csg_affine_point(&o->pose, csg_vec3_make(0, 0, 0)));
    double across = hypot(own.x, own.y), most = -INFINITY;
    for (uint32_t k = 0; k < o->point_count; k++)
        most = fmax(most, csg_vec3_dot(own, o->points[k]));
    if (o->kind == BALL)
        most = o->a;
    if (o->kind == TORUS)
        most = o->a * across + o->b;
    if (o->kind == CYLINDER)
        most = o->a * across + o->h * fabs(own.z);
    if (o->kind == CONE)
        most = fmax(o->a * across - o->h * own.z, o->b * across + o->h * own.z);
    return along + most;
}

static double beyond(const scene *s, csg_vec3 p, csg_vec3 n)
{
    double reach = -INFINITY;
    for (uint32_t i = 0; i < s->count; i++)
        reach = fmax(reach, reach_of(&s->solids[i], n));
    return csg_vec3_dot(n, p) - reach;
}

/* How far at least a half-space that holds all solids leaves p outside: the largest found. */
static double outside_hull(const scene *s, csg_vec3 p, csg_vec3 start)
{
    csg_vec3 n = start;
    double most = beyond(s, p, n);
    for (double step = 0.5; step > 1e-6; step /= 2)
        for (int moved = 1, round = 0; moved && round < 20; round++) {
            moved = 0;
            for (int k = 0; k < 26; k++) {
                int at = k < 13 ? k : k + 1;
                csg_vec3 way = {at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1};
                csg_vec3 next = csg_vec3_normalize(csg_vec3_add(n, csg_vec3_scale(way, step)));
                double found = beyond(s, p, next);
                if (found > most) {
                    most = found;
                    n = next;
                    moved = 1;
                }
            }
        }
    return most;
}

/* ---- comparison -------------------------------------------------------------------------------- */

typedef struct counts {
    uint32_t looked, closed, made, missing, extra; /* away from ends */
    uint32_t at_ends, in_gaps;
    double beyond, widest; /* of the hull; the largest turn of two faces at a crease */
    csg_vec3 where;
} counts;

static double turn_of(csg_vec3 g, csg_vec3 h)
{
    return 1 - csg_vec3_dot(g, h);
}

/* 50 degrees between two faces. */
static const double WIDEST = 1.6427876096865394;

/* From p to where both surfaces meet, by Newton's method. */
static void look_at_crease(const scene *s, closing *c, csg_vec3 p, const csg_sample *here,
                           counts *n)
{
    csg_sample f[CLOSING_MOST];
    (void)here;
    n->looked++;
    if (n->widest > WIDEST)
        return;
    for (uint32_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < i; k++) {
            csg_vec3 q = p;
            for (int step = 0; step < 12; step++) {
                closing_operands(c, q, f);
                csg_vec3 g = f[i].gradient, h = f[k].gradient;
                double gh = csg_vec3_dot(g, h), det = 1 - gh * gh;
                if (det < 1e-4 || csg_vec3_norm(csg_vec3_sub(p, q)) > 3 * s->r)
                    break;
                double x = (f[i].value - gh * f[k].value) / det;
                double y = (f[k].value - gh * f[i].value) / det;
                q = csg_vec3_sub(q, csg_vec3_add(csg_vec3_scale(g, x), csg_vec3_scale(h, y)));
            }
            closing_operands(c, q, f);
            bool is_there = fabs(f[i].value) < 1e-9 && fabs(f[k].value) < 1e-9 &&
                            csg_vec3_norm(csg_vec3_sub(p, q)) < 3 * s->r;
            for (uint32_t l = 0; l < s->count; l++)
                is_there = is_there && f[l].value < 1e-9;
            if (is_there)
                n->widest = fmax(n->widest, turn_of(f[i].gradient, f[k].gradient));
        }
}

static bool is_in_gap(const scene *s, const csg_sample *f)
{
    for (uint32_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < i; k++)
            if (fmin(f[i].value, f[k].value) > -1.8 * s->r &&
                turn_of(f[i].gradient, f[k].gradient) > WIDEST)
                return true;
    return false;
}

static void look_at_point(const scene *s, closing *c, csg_vec3 p, const csg_sample *f, counts *n)
{
    csg_sample root = csg_reference_below(&c->room, c->scene, 0, c->scene->root, p);
    bool made = root.value >= 0, closed = closing_holds(c, p);
    if (made && !closed) {
        double out = -INFINITY;
        for (int k = 0; k < 7; k++) {
            csg_vec3 start = root.gradient;
            if (k)
                start = csg_vec3_make(k % 3 == 0, k % 3 == 1, k % 3 == 2);
            start = csg_vec3_scale(csg_vec3_normalize(start), k < 4 ? -1 : 1);
            out = fmax(out, outside_hull(s, p, start));
        }
        if (out > n->beyond) {
            n->beyond = out;
            n->where = p;
        }
    }
    if (!made && !closed)
        return;
    if (is_in_gap(s, f)) {
        n->in_gaps++;
        return;
    }
    if (is_near_end(s, p)) {
        n->at_ends++;
        return;
    }
    n->closed += closed;
    n->made += made;
    n->missing += closed && !made;
    n->extra += made && !closed;
}

typedef void visit(const scene *s, closing *c, csg_vec3 p, const csg_sample *f, counts *n);

/* Halves a cube down to a lattice so fine, where two solids are in reach and none is entered. */
static void walk(const scene *s, closing *c, csg_vec3 at, double half, double spacing, visit *see,
                 counts *n)
{
    csg_sample f[CLOSING_MOST];
    double top = -INFINITY, second = -INFINITY;
    bool is_point = 2 * half < spacing * 1.0001;
    double radius = is_point ? 0 : half * sqrt(3);
    closing_operands(c, at, f);
    for (uint32_t k = 0; k < s->count; k++) {
        double v = f[k].value;
        second = fmax(second, fmin(v, top));
        top = fmax(top, v);
    }
    if (top - radius >= 0 || second + radius < -1.8 * s->r)
        return;
    if (is_point) {
        see(s, c, at, f, n);
        return;
    }
    for (int k = 0; k < 8; k++) {
        csg_vec3 by = {k & 1 ? half / 2 : -half / 2, k & 2 ? half / 2 : -half / 2,
                       k & 4 ? half / 2 : -half / 2};
        walk(s, c, csg_vec3_add(at, by), half / 2, spacing, see, n);
    }
}

/* False: the faces open too little, or there is too little away from ends to speak of. */
static bool compare(scene *s, closing *c, csg_random *random, counts *n)
{
    enum { COARSE = 2, LEAST = 300 };
    double spacing = s->r / cells, half = spacing / 2;
    while (half < 3)
        half *= 2;
    csg_vec3 at = draw_point(random, s->r);
    *n = (counts){.beyond = -INFINITY};
    walk(s, c, at, half, COARSE * spacing, look_at_crease, n);
    if (n->looked < 50 || n->widest > WIDEST)
        return false;
    find_edges(s, c);
    walk(s, c, at, half, spacing, look_at_point, n);
    return n->closed >= LEAST;
}

/* ---- closed forms ------------------------------------------------------------------------------ */

/* In the half plane of (x, z) a ball at c touches two solids along a and b: the closing adds what
 * lies between both radii beyond the ball. */
typedef struct control {
    const char *solids;
    double r, c[2], a[2], b[2];
} control;

static bool is_added(const control *k, double x, double z)
{
    double dx = x - k->c[0], dz = z - k->c[1];
    double det = k->a[0] * k->b[1] - k->a[1] * k->b[0];
    double by_a = (dx * k->b[1] - dz * k->b[0]) / det, by_b = (k->a[0] * dz - k->a[1] * dx) / det;
    return by_a >= 0 && by_b >= 0 && hypot(dx, dz) >= k->r;
}

static void begin_control(closing *c, const char *solids, double r)
{
    char text[512];
    snprintf(text, sizeof text, "union(blend = fillet(%.17g)) { %s }", r, solids);
    assert_int_equal(bench_compile(&b, text), CSGM_OK);
    assert_true(closing_begin(c, b.scene, r));
}

static void check_control(const control *k)
{
    csg_random random = {5};
    uint32_t compared = 0, added = 0;
    closing c;
    begin_control(&c, k->solids, k->r);
    for (int i = 0; i < 4000; i++) {
        double by_a = csg_random_uniform(&random, -0.2, 1.2) * k->r;
        double by_b = csg_random_uniform(&random, -0.2, 1.2) * k->r;
        double x = k->c[0] + by_a * k->a[0] + by_b * k->b[0];
        double z = k->c[1] + by_a * k->a[1] + by_b * k->b[1];
        csg_sample f[CLOSING_MOST];
        closing_operands(&c, csg_vec3_make(x, 0, z), f);
        bool is_outside = f[0].value < 0 && f[1].value < 0;
        if (!is_outside || fabs(hypot(x - k->c[0], z - k->c[1]) - k->r) < 1e-4 * k->r)
            continue;
        bool is_wanted = is_added(k, x, z);
        added += is_wanted;
        compared++;
        assert_int_equal(closing_holds(&c, csg_vec3_make(x, 0, z)), is_wanted);
    }
    assert_true(added > 20 && compared > 10 * added / 9);
    closing_end(&c);
}

/* Faces that open by 60, 90 and 130 degrees; a ball in a floor, and two balls. */
static void closed_forms(void **state)
{
    static const char floor[] = "translate([-50, -50, -100]) cube(100);";
    (void)state;
    for (int i = 0; i < 3; i++) {
        double opening = (double[]){60, 90, 130}[i], half = opening / 2 * acos(-1) / 180;
        char solids[256];
        snprintf(solids, sizeof solids, "%s rotate([0, %g, 0]) %s", floor, 180 - opening, floor);
        control k = {.solids = solids, .r = 2, .a = {0, -1}};
        double way = k.r / tan(half); /* the bisector leans from the floor by half the opening */
        k.c[0] = way, k.c[1] = k.r;
        k.b[0] = -sin(2 * half), k.b[1] = cos(2 * half);
        check_control(&k);
    }
    char solids[256];
    snprintf(solids, sizeof solids, "%s translate([0, 0, 1]) sphere(4);", floor);
    control ball = {.solids = solids, .r = 2, .c = {sqrt(35), 2}, .a = {0, -1}};
    ball.b[0] = -sqrt(35) / 6, ball.b[1] = -1.0 / 6;
    check_control(&ball);
    control two = {.solids = "sphere(3); translate([0, 0, 5]) sphere(4);", .r = 1.5};
    two.c[1] = (4.5 * 4.5 - 5.5 * 5.5 + 25) / 10;
    two.c[0] = sqrt(4.5 * 4.5 - two.c[1] * two.c[1]);
    two.a[0] = -two.c[0] / 4.5, two.a[1] = -two.c[1] / 4.5;
    two.b[0] = -two.c[0] / 5.5, two.b[1] = (5 - two.c[1]) / 5.5;
    check_control(&two);
}

/* Cylinders of radius 3 that cross at 60 degrees, r = 2: an eighth gains 2.46 (a lattice of 0.05,
 * held against 3000 points of the two ellipses on which a ball's centre touches both); the fillet,
 * which takes the cylinders for planes, a quarter more. */
static void crossing_cylinders(void **state)
{
    (void)state;
    static scene s = {.r = 2, .count = 2};
    csg_vec3 unused;
    closing c;
    counts n = {.beyond = -INFINITY};
    double spacing = 0.3;
    s.edges = &unused;
    for (uint32_t i = 0; i < s.count; i++)
        s.solids[i] = (solid){.kind = CYLINDER,
                              .a = 3,
                              .h = 30,
                              .pose = csg_affine_rotate(60.0 * i, csg_vec3_make(0, 1, 0))};
    begin_control(&c,
                  "cylinder(h = 60, r = 3, center = true);"
                  " rotate([0, 60, 0]) cylinder(h = 60, r = 3, center = true);",
                  s.r);
    walk(&s, &c, csg_vec3_make(0.1, 0.13, 0.07), spacing * 64, spacing, look_at_point, &n);
    closing_end(&c);
    assert_true(fabs(n.closed * pow(spacing, 3) / 8 - 2.46) < 0.1);
    assert_true(n.made > 1.2 * n.closed && n.made < 1.32 * n.closed);
}

/* ---- random scenes ----------------------------------------------------------------------------- */

static bool try_scene(uint64_t seed, counts *n, scene *s)
{
    csg_random random = {seed};
    closing c;
    draw_scene(s, &random);
    assert_int_equal(bench_compile_bytes(&b, s->text, strlen(s->text), NULL), CSGM_OK);
    if (b.scene->nodes[b.scene->root].child_count != s->count)
        return false;
    assert_true(closing_begin(&c, b.scene, s->r));
    bool is_fit = compare(s, &c, &random, n);
    closing_end(&c);
    return is_fit;
}

/* Of r for what lies beyond the hull, of what the closing adds for the rest. */
#define BEYOND 0.15
#define LESS 0.05
#define MORE 0.05

static bool is_as_told(const scene *s, const counts *n)
{
    double added = (double)n->made / n->closed, by = 1 + s->r / s->curvature;
    return added > 1 - LESS && added < by * by + MORE && n->beyond < BEYOND * s->r;
}

static void random_fillets(void **state)
{
    (void)state;
    static scene s;
    s.edges = calloc(MOST_SAMPLES, sizeof *s.edges);
    assert_non_null(s.edges);
    uint32_t found = 0, wrong = 0, near = 0, within = 0;
    uint64_t seed = first_seed;
    for (; found < scene_count; seed++) {
        counts n;
        if (!try_scene(seed, &n, &s))
            continue;
        found++;
        bool is_right = is_as_told(&s, &n);
        double more = (double)n.made / n.closed - 1;
        wrong += !is_right;
        near += fabs(more) < 0.1;
        within += n.beyond < 1e-6;
        print_message(
            "seed %u: %u solids, r / R %.2f, %u points %+.1f %%, missing %.1f %%, at ends "
            "%u, beyond the hull %.3f r\n%s",
            (unsigned)seed, s.count, s.r / s.curvature, n.closed, 100 * more,
            100.0 * n.missing / n.closed, n.at_ends, fmax(n.beyond, 0) / s.r,
            is_right ? "" : s.text);
    }
    free(s.edges);
    print_message("%u scenes: %u within 10 %%, %u within the hull, %u wrong\n", found, near, within,
                  wrong);
    assert_int_equal(wrong, 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(crossing_cylinders),
        cmocka_unit_test(random_fillets),
    };
    if (argc > 1)
        scene_count = (uint32_t)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_seed = strtoull(argv[2], NULL, 10);
    if (argc > 3)
        cells = strtod(argv[3], NULL);
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
