/* SPDX-License-Identifier: MIT
 * The 256 patterns of marching cubes: each alone, each with each neighbour, and as a whole on white
 * noise, where every pattern meets every other. Nothing here shares code with the inspection.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "mesh/marching/tables.h"

static csg_cell_tables tables;

static int make_tables(void **state)
{
    csg_cell_tables_make(&tables);
    return 0;
}

/* ---- the cell, told again from the header's words -------------------------------------------- */

/* Both corners of an edge: e = 4 * axis + u + 2 * v, u and v on the other axes in order. */
static void edge_corners(unsigned edge, unsigned corner[2])
{
    unsigned axis = edge / 4, u = edge & 1, v = edge >> 1 & 1;
    unsigned first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    corner[0] = u << first | v << second;
    corner[1] = corner[0] | 1u << axis;
}

static bool is_crossed(unsigned pattern, unsigned edge)
{
    unsigned corner[2];
    edge_corners(edge, corner);
    return (pattern >> corner[0] & 1) != (pattern >> corner[1] & 1);
}

/* Face = 2 * axis + side of both edges, or -1: two edges share at most one. */
static int shared_face(unsigned a, unsigned b)
{
    unsigned p[2], q[2];
    edge_corners(a, p);
    edge_corners(b, q);
    for (unsigned axis = 0; axis < 3; axis++) {
        unsigned side = p[0] >> axis & 1;
        if ((p[1] >> axis & 1) == side && (q[0] >> axis & 1) == side && (q[1] >> axis & 1) == side)
            return (int)(2 * axis + side);
    }
    return -1;
}

/* ---- each pattern alone ---------------------------------------------------------------------- */

typedef struct sides {
    bool drawn[CSG_CELL_EDGES][CSG_CELL_EDGES]; /* directed sides of the pattern's triangles */
} sides;

static void collect_sides(unsigned pattern, sides *s)
{
    memset(s, 0, sizeof *s);
    for (int t = 0; t < tables.count[pattern]; t++) {
        const uint8_t *e = tables.edge[pattern] + 3 * t;
        for (int k = 0; k < 3; k++) {
            uint8_t from = e[k], to = e[(k + 1) % 3];
            assert_true(from < CSG_CELL_EDGES && to < CSG_CELL_EDGES && from != to);
            assert_false(s->drawn[from][to]);
            s->drawn[from][to] = true;
        }
    }
}

static void test_patterns(void **state)
{
    for (unsigned pattern = 0; pattern < 256; pattern++) {
        sides s;
        collect_sides(pattern, &s);
        assert_true(tables.count[pattern] <= CSG_CELL_MOST_TRIANGLES);
        bool used[CSG_CELL_EDGES] = {false};
        for (unsigned a = 0; a < CSG_CELL_EDGES; a++)
            for (unsigned b = 0; b < CSG_CELL_EDGES; b++) {
                if (!s.drawn[a][b])
                    continue;
                used[a] = used[b] = true;
                /* A side drawn both ways is a diagonal: inside the cell. Others lie in a face. */
                assert_int_equal(shared_face(a, b) < 0, s.drawn[b][a]);
            }
        for (unsigned e = 0; e < CSG_CELL_EDGES; e++)
            assert_int_equal(used[e], is_crossed(pattern, e));
    }
    assert_int_equal(tables.count[0], 0);
    assert_int_equal(tables.count[255], 0);
}

static void test_offsets(void **state)
{
    for (unsigned e = 0; e < CSG_CELL_EDGES; e++) {
        unsigned corner[2];
        edge_corners(e, corner);
        for (unsigned axis = 0; axis < 3; axis++)
            assert_int_equal(tables.offset[e][axis], corner[0] >> axis & 1);
    }
}

static void edge_middle(unsigned edge, double at[3])
{
    unsigned corner[2];
    edge_corners(edge, corner);
    for (int axis = 0; axis < 3; axis++)
        at[axis] = 0.5 * (double)((corner[0] >> axis & 1) + (corner[1] >> axis & 1));
}

/* One inside corner: its triangle faces away from it. */
static void test_orientation(void **state)
{
    for (unsigned c = 0; c < 8; c++) {
        assert_int_equal(tables.count[1u << c], 1);
        double p[3][3], out = 0;
        for (int k = 0; k < 3; k++)
            edge_middle(tables.edge[1u << c][k], p[k]);
        for (int axis = 0; axis < 3; axis++) {
            int b = (axis + 1) % 3, d = (axis + 2) % 3;
            double normal = (p[1][b] - p[0][b]) * (p[2][d] - p[0][d]) -
                            (p[1][d] - p[0][d]) * (p[2][b] - p[0][b]);
            out += normal * (p[0][axis] - (double)(c >> axis & 1));
        }
        assert_true(out > 0);
    }
}

/* ---- no crossings ------------------------------------------------------------------------------
 */

enum { STEPS = 4096 }; /* of a cell's edge: whole numbers, so that every sign below is exact */

typedef struct place {
    int64_t at[3];
} place;

/* Six times the volume of a tetrahedron. */
static int64_t volume_of(const place *a, const place *b, const place *c, const place *d)
{
    int64_t u[3], v[3], w[3];
    for (int i = 0; i < 3; i++) {
        u[i] = b->at[i] - a->at[i];
        v[i] = c->at[i] - a->at[i];
        w[i] = d->at[i] - a->at[i];
    }
    return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
           (u[0] * v[1] - u[1] * v[0]) * w[2];
}

static int sign(int64_t x)
{
    return (x > 0) - (x < 0);
}

/* Whether a segment meets a triangle in whose plane it does not lie, rims included. */
static bool pierces(const place *p, const place *q, const place *t[3])
{
    int above = sign(volume_of(t[0], t[1], t[2], p)), below = sign(volume_of(t[0], t[1], t[2], q));
    if (above == below) /* one side; both 0 has no weight among random places */
        return false;
    int least = 1, most = -1;
    for (int k = 0; k < 3; k++) {
        int turn = sign(volume_of(p, q, t[k], t[(k + 1) % 3]));
        least = turn < least ? turn : least;
        most = turn > most ? turn : most;
    }
    return least >= 0 || most <= 0;
}

/* Whether triangles meet in more than the vertex that they share, or none; with two they cannot. */
static bool cross(const uint8_t *a, const uint8_t *b, const place *places)
{
    const place *p[3], *q[3];
    int shared = 0, in_a = 0, in_b = 0;
    for (int i = 0; i < 3; i++) {
        p[i] = &places[a[i]];
        q[i] = &places[b[i]];
        for (int k = 0; k < 3; k++)
            if (a[i] == b[k]) {
                shared++;
                in_a = i, in_b = k;
            }
    }
    for (int i = 0; i < 3 && shared < 2; i++)
        if (((!shared || i == (in_a + 1) % 3) && pierces(p[i], p[(i + 1) % 3], q)) ||
            ((!shared || i == (in_b + 1) % 3) && pierces(q[i], q[(i + 1) % 3], p)))
            return true;
    return false;
}

/* Places on the cell's edges, many of them near to an end. */
static void draw_places(csg_random *random, place places[CSG_CELL_EDGES])
{
    for (unsigned e = 0; e < CSG_CELL_EDGES; e++) {
        for (unsigned axis = 0; axis < 3; axis++)
            places[e].at[axis] = STEPS * tables.offset[e][axis];
        double most = csg_random_uniform(random, 0, 1) < 0.3 ? STEPS - 1 : 40;
        int64_t from = 1 + (int64_t)(most * csg_random_uniform(random, 0, 0.999));
        places[e].at[e / 4] = csg_random_uniform(random, 0, 1) < 0.5 ? from : STEPS - from;
    }
}

/* Wherever the surface crosses the edges of a cell, its triangles keep clear of one another. */
static void test_crossings(void **state)
{
    csg_random random = {3};
    for (int round = 0; round < 300; round++) {
        place places[CSG_CELL_EDGES];
        draw_places(&random, places);
        for (unsigned pattern = 0; pattern < 256; pattern++)
            for (int i = 0; i < tables.count[pattern]; i++)
                for (int k = 0; k < i; k++)
                    if (cross(tables.edge[pattern] + 3 * i, tables.edge[pattern] + 3 * k, places))
                        fail_msg("pattern %u: triangles %d and %d cross", pattern, i, k);
    }
}

/* ---- joined faces ------------------------------------------------------------------------------
 */

/* Faces whose inside corners lie on a diagonal. */
static unsigned diagonal_faces(unsigned pattern)
{
    unsigned faces = 0;
    for (unsigned axis = 0; axis < 3; axis++)
        for (unsigned side = 0; side < 2; side++) {
            unsigned low = side << axis, b = 1u << (axis + 1) % 3, c = 1u << (axis + 2) % 3;
            unsigned first = pattern >> low & 1, second = pattern >> (low | b) & 1;
            if (first != second && first == (pattern >> (low | b | c) & 1) &&
                second == (pattern >> (low | c) & 1))
                faces |= 1u << (2 * axis + side);
        }
    return faces;
}

/* The sides of a cell's loops. */
static void draw_loops(const csg_cell_loops *loops, bool drawn[CSG_CELL_EDGES][CSG_CELL_EDGES])
{
    memset(drawn, 0, CSG_CELL_EDGES * CSG_CELL_EDGES * sizeof(bool));
    for (int l = 0; l < loops->count; l++)
        for (int i = 0; i < loops->sides[l]; i++) {
            uint8_t from = loops->edge[l][i], to = loops->edge[l][(i + 1) % loops->sides[l]];
            assert_true(shared_face(from, to) >= 0 && !drawn[from][to]);
            drawn[from][to] = true;
        }
}

/* Whether a side cuts a corner of the cell off: it leads from one of its edges to another. */
static bool is_round(unsigned a, unsigned b, unsigned corner)
{
    unsigned p[2], q[2];
    edge_corners(a, p);
    edge_corners(b, q);
    return (p[0] == corner || p[1] == corner) && (q[0] == corner || q[1] == corner);
}

/* Joining changes the sides in that face, which go round the outside corners then, and no others.
 */
static void test_joined_sides(void **state)
{
    for (unsigned pattern = 0; pattern < 256; pattern++)
        for (unsigned joined = 1; joined < 64; joined++) {
            bool plain[CSG_CELL_EDGES][CSG_CELL_EDGES], drawn[CSG_CELL_EDGES][CSG_CELL_EDGES];
            if (joined & ~diagonal_faces(pattern))
                continue;
            csg_cell_loops before = csg_cell_loops_of(pattern, 0),
                           loops = csg_cell_loops_of(pattern, joined);
            draw_loops(&before, plain);
            draw_loops(&loops, drawn);
            for (unsigned a = 0; a < CSG_CELL_EDGES; a++)
                for (unsigned b = 0; b < CSG_CELL_EDGES; b++) {
                    int face = shared_face(a, b);
                    if (face < 0 || !(joined >> face & 1)) {
                        assert_int_equal(drawn[a][b], plain[a][b]);
                        continue;
                    }
                    for (unsigned c = 0; c < 8 && drawn[a][b]; c++)
                        assert_false(is_round(a, b, c) && pattern >> c & 1);
                    assert_false(drawn[a][b] && plain[a][b]);
                }
        }
}

static bool loops_cross(const csg_cell_loops *loops, const place *places,
                        uint8_t (*cut)[3 * CSG_CELL_EDGES])
{
    for (int l = 0; l < loops->count; l++)
        for (int k = 0; k <= l; k++)
            for (int i = 0; i < loops->sides[l] - 2; i++)
                for (int j = 0; j < (k == l ? i : loops->sides[k] - 2); j++)
                    if (cross(cut[l] + 3 * i, cut[k] + 3 * j, places))
                        return true;
    return false;
}

/* Unless corners alternate all, loops of up to seven sides have cuts that do not cross, and longer
 * ones are alone in their cell (mesh/features/smooth.c). */
static void test_joined_crossings(void **state)
{
    enum { MOST_CUT = 7, ROUNDS = 100, FACES = 63 };
    csg_random random = {5};
    for (unsigned pattern = 0; pattern < 256; pattern++)
        for (unsigned joined = 1; joined < 64; joined++) {
            unsigned faces = diagonal_faces(pattern);
            if (joined & ~faces || faces == FACES)
                continue;
            csg_cell_loops loops = csg_cell_loops_of(pattern, joined);
            uint8_t cut[CSG_CELL_MOST_LOOPS][3 * CSG_CELL_EDGES];
            bool is_long = false;
            for (int l = 0; l < loops.count; l++)
                is_long = is_long || loops.sides[l] > MOST_CUT;
            assert_true(!is_long || loops.count == 1);
            for (int l = 0; l < loops.count && !is_long; l++)
                assert_true(csg_cell_cut(loops.edge[l], loops.sides[l], cut[l]));
            for (int round = 0; round < ROUNDS && !is_long; round++) {
                place places[CSG_CELL_EDGES];
                draw_places(&random, places);
                if (loops_cross(&loops, places, cut))
                    fail_msg("pattern %u, joined %u: triangles cross", pattern, joined);
            }
        }
}

/* ---- each pattern beside each other ------------------------------------------------------------
 */

static unsigned signs_of_face(unsigned pattern, int axis, unsigned side)
{
    unsigned signs = 0, n = 0;
    for (unsigned c = 0; c < 8; c++)
        if ((c >> axis & 1) == side)
            signs |= (pattern >> c & 1) << n++;
    return signs;
}

/* The edge on the face `from` as the cell across that face counts it. */
static unsigned across(unsigned edge, int axis)
{
    unsigned corner[2], other[2];
    edge_corners(edge, corner);
    for (unsigned e = 0; e < CSG_CELL_EDGES; e++) {
        edge_corners(e, other);
        if (other[0] == (corner[0] ^ 1u << axis) && other[1] == (corner[1] ^ 1u << axis))
            return e;
    }
    return CSG_CELL_EDGES;
}

/* What a cell draws in its upper face is what the one above draws there, turned round. */
static void test_neighbours(void **state)
{
    static sides of[256];
    for (unsigned pattern = 0; pattern < 256; pattern++)
        collect_sides(pattern, &of[pattern]);
    for (unsigned lower = 0; lower < 256; lower++)
        for (unsigned upper = 0; upper < 256; upper++)
            for (int axis = 0; axis < 3; axis++) {
                if (signs_of_face(lower, axis, 1) != signs_of_face(upper, axis, 0))
                    continue;
                for (unsigned a = 0; a < CSG_CELL_EDGES; a++)
                    for (unsigned b = 0; b < CSG_CELL_EDGES; b++)
                        if (shared_face(a, b) == 2 * axis + 1)
                            assert_int_equal(of[lower].drawn[a][b],
                                             of[upper].drawn[across(b, axis)][across(a, axis)]);
            }
}

/* ---- white noise ------------------------------------------------------------------------------
 */

enum { N = 9, MOST_TRIANGLES = (N - 1) * (N - 1) * (N - 1) * CSG_CELL_MOST_TRIANGLES };

typedef struct noise {
    bool inside[N][N][N]; /* [z][y][x]; the border is outside */
    uint32_t triangles[MOST_TRIANGLES][3];
    size_t count;
} noise;

static void fill_noise(noise *n, csg_random *random, double density)
{
    memset(n, 0, sizeof *n);
    for (int z = 1; z < N - 1; z++)
        for (int y = 1; y < N - 1; y++)
            for (int x = 1; x < N - 1; x++)
                n->inside[z][y][x] = csg_random_uniform(random, 0, 1) < density;
}

static void mesh_noise(noise *n)
{
    for (int z = 0; z < N - 1; z++)
        for (int y = 0; y < N - 1; y++)
            for (int x = 0; x < N - 1; x++) {
                unsigned pattern = 0;
                for (int c = 0; c < 8; c++)
                    pattern |= (unsigned)n->inside[z + (c >> 2)][y + (c >> 1 & 1)][x + (c & 1)]
                               << c;
                for (int t = 0; t < 3 * tables.count[pattern]; t++) {
                    unsigned e = tables.edge[pattern][t];
                    const uint8_t *o = tables.offset[e];
                    int point = ((z + o[2]) * N + y + o[1]) * N + x + o[0];
                    n->triangles[n->count + (size_t)t / 3][t % 3] = (uint32_t)point * 3 + e / 4;
                }
                n->count += tables.count[pattern];
            }
}

typedef struct wedge {
    uint32_t vertex, from, to; /* a triangle's corner: its other two vertices in order */
} wedge;

static int compare_wedges(const void *a, const void *b)
{
    const wedge *p = a, *q = b;
    if (p->vertex != q->vertex)
        return p->vertex < q->vertex ? -1 : 1;
    return (p->from > q->from) - (p->from < q->from);
}

static const wedge *wedge_from(const wedge *fan, size_t count, uint32_t from)
{
    for (size_t i = 0; i < count; i++)
        if (fan[i].from == from)
            return &fan[i];
    return NULL;
}

/* The wedges around one vertex follow one another and close: one fan. This says all: edges are
 * used once in each direction exactly when every wedge has one successor and one predecessor. */
static void assert_one_fan(const wedge *fan, size_t count)
{
    for (size_t i = 0; i + 1 < count; i++)
        assert_true(fan[i].from != fan[i + 1].from); /* sorted: no directed edge twice */
    const wedge *w = fan;
    size_t steps = 0;
    do {
        w = wedge_from(fan, count, w->to);
        assert_non_null(w);
        steps++;
    } while (w != fan && steps <= count);
    assert_int_equal(steps, count);
}

static void assert_manifold(const noise *n)
{
    static wedge wedges[3 * MOST_TRIANGLES];
    size_t count = 0;
    for (size_t t = 0; t < n->count; t++)
        for (int k = 0; k < 3; k++)
            wedges[count++] = (wedge){n->triangles[t][k], n->triangles[t][(k + 1) % 3],
                                      n->triangles[t][(k + 2) % 3]};
    qsort(wedges, count, sizeof *wedges, compare_wedges);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count && wedges[end].vertex == wedges[i].vertex;)
            end++;
        assert_one_fan(wedges + i, end - i);
    }
}

static double noise_volume(const noise *n)
{
    double volume = 0;
    for (size_t t = 0; t < n->count; t++) {
        double p[3][3];
        for (int k = 0; k < 3; k++) {
            uint32_t v = n->triangles[t][k], point = v / 3;
            p[k][0] = point % N, p[k][1] = point / N % N, p[k][2] = point / (N * N);
            p[k][v % 3] += 0.5;
        }
        for (int axis = 0; axis < 3; axis++) {
            int b = (axis + 1) % 3, d = (axis + 2) % 3;
            volume += p[0][axis] * (p[1][b] * p[2][d] - p[1][d] * p[2][b]) / 6;
        }
    }
    return volume;
}

static void test_noise(void **state)
{
    static noise n;
    csg_random random = {11};
    for (int i = 0; i < 300; i++) {
        fill_noise(&n, &random, 0.05 + 0.1 * (i % 10));
        mesh_noise(&n);
        assert_manifold(&n);
        assert_true(n.count > 0 && noise_volume(&n) > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_patterns),     cmocka_unit_test(test_offsets),
        cmocka_unit_test(test_orientation),  cmocka_unit_test(test_neighbours),
        cmocka_unit_test(test_crossings),    cmocka_unit_test(test_noise),
        cmocka_unit_test(test_joined_sides), cmocka_unit_test(test_joined_crossings),
    };
    return cmocka_run_group_tests(tests, make_tables, NULL);
}
