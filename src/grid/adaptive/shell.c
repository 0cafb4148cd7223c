/* SPDX-License-Identifier: MIT
 * What touches the leaves of a brick; see shell.h.
 */
#include "grid/adaptive/shell.h"

#include <string.h>

enum { E = CSG_BRICK_EDGE, N = CSG_BRICK_SAMPLES, S = CSG_SHELL_SAMPLES };

static const int CENTER = CSG_BRICKS_AROUND / 2;

/* ---- finer leaves ------------------------------------------------------------------------------
 */

static void take_edges(csg_shell *s, int axis, const int q[3])
{
    for (int other = 0; other < 3; other++)
        if (other != axis && q[other] % 2)
            return; /* within a face */
    s->divided_edges[axis][q[2] / 2][q[1] / 2] |= (uint8_t)(1u << q[0] / 2);
}

static bool is_on_shell(const int q[3])
{
    return q[0] >= 0 && q[0] < S && q[1] >= 0 && q[1] < S && q[2] >= 0 && q[2] < S;
}

/* Signs and edges that a finer brick has on this one's leaves. */
static void take_brick(csg_shell *s, const csg_brick *fine)
{
    int first[3];
    for (int axis = 0; axis < 3; axis++)
        first[axis] = E * ((int)fine->at[axis] - 2 * (int)s->brick->at[axis]);
    for (int p = 0; p < CSG_BRICK_POINTS; p++) {
        const int local[3] = {p % N, p / N % N, p / (N * N)};
        const int q[3] = {first[0] + local[0], first[1] + local[1], first[2] + local[2]};
        if (!is_on_shell(q))
            continue;
        unsigned inside = fine->inside[local[2]][local[1]] >> local[0] & 1u;
        s->inside[q[2]][q[1]] |= (uint16_t)(inside << q[0]);
        for (int axis = 0; axis < 3; axis++) {
            if (local[axis] == E || q[axis] == S - 1)
                continue;
            const unsigned low[3] = {(unsigned)local[0], (unsigned)local[1], (unsigned)local[2]};
            take_edges(s, axis, q);
            if (!(fine->pierced >> csg_brick_edge(axis, low) & 1))
                continue;
            const int end[3] = {q[0] + (axis == 0), q[1] + (axis == 1), q[2] + (axis == 2)};
            s->pierced_beyond |= csg_brick_cells_at(q, end);
        }
    }
}

/* The faces of the cell that a finer brick is in the place of. */
static void take_faces(csg_shell *s, const csg_brick *fine)
{
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            int low[3];
            bool is_own = true;
            for (int k = 0; k < 3; k++) {
                low[k] = (int)fine->at[k] - 2 * (int)s->brick->at[k] + (k == axis ? side : 0);
                is_own = is_own && low[k] >= 0 && low[k] < (k == axis ? N : E);
            }
            if (is_own)
                s->divided_faces[axis][low[2]][low[1]] |= (uint8_t)(1u << low[0]);
        }
}

/* The divided cells of a brick of the same level, of those that touch this one, were it itself. */
static void take_cells(csg_shell *s, const csg_bricks *b, const csg_brick *brick, const int step[3])
{
    for (unsigned octant = 0; octant < CSG_OCTANTS; octant++) {
        uint32_t child[3];
        bool touches = brick->divided >> octant & 1;
        for (int axis = 0; axis < 3; axis++) {
            unsigned bit = octant >> axis & 1;
            touches = touches && (step[axis] == 0 || bit == (step[axis] < 0 ? 1u : 0u));
            child[axis] = 2 * brick->at[axis] + bit;
        }
        uint32_t found = touches ? csg_bricks_find(b, s->brick->level + 1u, child) : CSG_BRICK_NONE;
        if (found == CSG_BRICK_NONE)
            continue;
        s->has_finer = true;
        take_brick(s, &b->items[found]);
        take_faces(s, &b->items[found]);
    }
}

static void take_own(csg_shell *s)
{
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++)
            for (int i = 0; i < N; i++)
                s->inside[2 * k][2 * j] |=
                    (uint16_t)((s->brick->inside[k][j] >> i & 1u) << (2 * i));
}

void csg_shell_make(csg_shell *s, const csg_bricks *b, uint32_t number)
{
    memset(s, 0, sizeof *s);
    s->brick = &b->items[number];
    s->number = number;
    csg_bricks_around(b, number, s->around);
    for (int d = 0; d < CSG_BRICKS_AROUND; d++) {
        const int step[3] = {d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
        if (s->around[d] != CSG_BRICK_NONE && b->items[s->around[d]].divided)
            take_cells(s, b, &b->items[s->around[d]], step);
    }
    if (s->has_finer)
        take_own(s);
}

/* ---- cells -------------------------------------------------------------------------------------
 */

static uint32_t corners_of(unsigned pattern)
{
    uint32_t inside = 0;
    for (unsigned c = 0; c < 8; c++)
        inside |= (pattern >> c & 1u) << (2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2));
    return inside;
}

static uint32_t divided_in_cell(const csg_shell *s, const unsigned at[3])
{
    uint32_t divided = 0;
    for (int axis = 0; axis < 3; axis++) {
        int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
        for (unsigned e = 0; e < 4; e++) {
            unsigned low[3] = {at[0], at[1], at[2]}, middle[3] = {0, 0, 0};
            low[u] += e & 1, low[v] += e >> 1;
            middle[axis] = 1, middle[u] = 2 * (e & 1), middle[v] = 2 * (e >> 1);
            if (s->divided_edges[axis][low[2]][low[1]] >> low[0] & 1)
                divided |= 1u << (middle[0] + 3 * middle[1] + 9 * middle[2]);
        }
        for (unsigned side = 0; side < 2; side++) {
            unsigned low[3] = {at[0], at[1], at[2]}, middle[3] = {1, 1, 1};
            low[axis] += side;
            middle[axis] = 2 * side;
            if (s->divided_faces[axis][low[2]][low[1]] >> low[0] & 1)
                divided |= 1u << (middle[0] + 3 * middle[1] + 9 * middle[2]);
        }
    }
    return divided;
}

/* Pierced edges that are not divided anyway have a point in between whose sign their ends have not.
 */
static void add_pierced(csg_shell_cell *cell, const csg_brick *brick, const unsigned at[3])
{
    for (unsigned e = 0; e < 12 && brick->pierced; e++) {
        int axis = (int)(e / 4), u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
        unsigned low[3] = {at[0], at[1], at[2]}, end[3] = {0, 0, 0};
        low[u] += e & 1, low[v] += e >> 1 & 1;
        end[u] = 2 * (e & 1), end[v] = 2 * (e >> 1 & 1);
        static const unsigned stride[3] = {1, 3, 9};
        unsigned bit = end[0] + 3 * end[1] + 9 * end[2], middle = bit + stride[axis];
        if (!(brick->pierced >> csg_brick_edge(axis, low) & 1) || cell->divided >> middle & 1)
            continue;
        cell->divided |= 1u << middle;
        cell->pierced |= 1u << middle;
        cell->inside |= (~cell->inside >> bit & 1u) << middle;
    }
}

csg_shell_cell csg_shell_cell_of(const csg_shell *s, unsigned i, unsigned j, unsigned k)
{
    const unsigned at[3] = {i, j, k};
    csg_shell_cell cell = {0};
    if (s->has_finer) {
        cell.divided = divided_in_cell(s, at);
        for (unsigned z = 0; z < 3; z++)
            for (unsigned y = 0; y < 3; y++)
                cell.inside |= (s->inside[2 * k + z][2 * j + y] >> (2 * i) & 7u) << (3 * y + 9 * z);
    } else {
        cell.inside = corners_of(csg_brick_pattern(s->brick, i, j, k));
    }
    add_pierced(&cell, s->brick, at);
    return cell;
}

/* ---- who owns what -----------------------------------------------------------------------------
 */

/* Whether no brick with a lower number touches in the brick's lines and planes named by steps. */
static bool is_lowest(const uint32_t around[CSG_BRICKS_AROUND], const int step[3])
{
    for (int part = 1; part < 8; part++) {
        int d = CENTER, place = 1;
        bool used = true;
        for (int axis = 0; axis < 3; axis++, place *= 3) {
            if (!(part >> axis & 1))
                continue;
            used = used && step[axis] != 0;
            d += step[axis] * place;
        }
        if (used && around[d] != CSG_BRICK_NONE && around[d] < around[CENTER])
            return false;
    }
    return true;
}

static int border_step(unsigned at)
{
    return at == 0 ? -1 : at == E ? 1 : 0;
}

bool csg_brick_owns_edge(const uint32_t around[CSG_BRICKS_AROUND], int axis, const unsigned low[3])
{
    int step[3] = {border_step(low[0]), border_step(low[1]), border_step(low[2])};
    step[axis] = 0;
    return is_lowest(around, step);
}

bool csg_brick_owns_face(const uint32_t around[CSG_BRICKS_AROUND], int axis, const unsigned low[3])
{
    int step[3] = {0, 0, 0};
    step[axis] = border_step(low[axis]);
    return is_lowest(around, step);
}
