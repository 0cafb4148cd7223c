/* SPDX-License-Identifier: MIT
 * Deriving the marching-cubes cases.
 *
 * Face rule: on each face every run of inside corners is cut off by its own segment, so diagonal
 * inside corners stay apart. It depends on the face's corners only, so both cells at a face draw
 * the same segments, and the segments around a cell close to loops. A loop is cut into triangles by
 * diagonals that never join two edges of one face: such a diagonal would lie in the face, where the
 * neighbour could draw the same one and make an edge of four triangles. Such a cut exists for every
 * loop of every pattern (tests/mesh checks it). Hence the surface is a closed oriented 2-manifold:
 * each segment is drawn by exactly two cells, in opposite directions, each diagonal by one cell
 * twice, and the polygons around a vertex follow one another around its lattice edge in one fan.
 *
 * No triangle meets another one but in what they share, wherever the vertices lie on their edges:
 * segments of a face cut off corners that no other segment reaches, so cells keep apart; within one
 * cell that was searched for all patterns with all their cuts (tests/mesh/test_tables.c does it for
 * those here), and all are good but four of the sixteen cuts of a loop of seven sides: see `fan`.
 */
#include "mesh/marching/tables.h"

#include <string.h>

enum { FACES = 6, FACE_CORNERS = 4, NO_EDGE = 0xFF };

static uint8_t edge_between(unsigned c1, unsigned c2)
{
    unsigned axis = (c1 ^ c2) >> 1; /* 1, 2, 4 -> 0, 1, 2 */
    unsigned low = c1 & c2;
    unsigned u = axis == 0 ? low >> 1 & 1 : low & 1;
    unsigned v = axis == 2 ? low >> 1 & 1 : low >> 2 & 1;
    return (uint8_t)(4 * axis + u + 2 * v);
}

/* Corners of a face, counter-clockwise seen from outside the cell. */
static void face_corners(int face, unsigned corners[FACE_CORNERS])
{
    int axis = face / 2, side = face % 2;
    int b = (axis + 1) % 3, c = (axis + 2) % 3;
    static const uint8_t round[FACE_CORNERS][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < FACE_CORNERS; i++) {
        const uint8_t *at = round[side ? i : FACE_CORNERS - 1 - i];
        corners[i] = (unsigned)(side << axis | at[0] << b | at[1] << c);
    }
}

/* One bit a face that has this edge. */
static unsigned faces_of_edge(uint8_t edge)
{
    unsigned faces = 0;
    for (int face = 0; face < FACES; face++) {
        unsigned corners[FACE_CORNERS];
        face_corners(face, corners);
        for (int i = 0; i < FACE_CORNERS; i++)
            if (edge_between(corners[i], corners[(i + 1) % FACE_CORNERS]) == edge)
                faces |= 1u << face;
    }
    return faces;
}

/* next[e]: the edge that the segment starting on crossed edge e ends on. On a face that is joined,
 * where the next run begins. */
static void link_segments(unsigned pattern, unsigned joined, uint8_t next[CSG_CELL_EDGES])
{
    memset(next, NO_EDGE, CSG_CELL_EDGES);
    for (int face = 0; face < FACES; face++) {
        unsigned corners[FACE_CORNERS];
        face_corners(face, corners);
        for (int i = 0; i < FACE_CORNERS; i++) {
            unsigned before = corners[(i + FACE_CORNERS - 1) % FACE_CORNERS];
            if (!(pattern >> corners[i] & 1) || pattern >> before & 1)
                continue; /* not the first of a run */
            int last = i;
            while (pattern >> corners[(last + 1) % FACE_CORNERS] & 1)
                last++;
            int across = joined >> face & 1 ? 2 : 0; /* runs are of one corner each then */
            uint8_t enter = edge_between(corners[(i + 3 + across) % FACE_CORNERS],
                                         corners[(i + across) % FACE_CORNERS]);
            uint8_t leave =
                edge_between(corners[last % FACE_CORNERS], corners[(last + 1) % FACE_CORNERS]);
            next[leave] = enter;
        }
    }
}

/* Whether the polygon loop[first..last] can be cut without a diagonal in a face; writes triangles.
 */
static bool cut(const uint8_t *loop, const unsigned *faces, int first, int last, int length,
                uint8_t *edges, int *count)
{
    if (last - first < 2)
        return true;
    for (int middle = first + 1; middle < last; middle++) {
        bool is_whole = first == 0 && last == length - 1;
        bool bad = (middle - first > 1 && faces[first] & faces[middle]) ||
                   (last - middle > 1 && faces[middle] & faces[last]) ||
                   (!is_whole && last - first > 1 && faces[first] & faces[last]);
        if (bad)
            continue;
        int before = *count;
        edges[3 * *count] = loop[first];
        edges[3 * *count + 1] = loop[last];
        edges[3 * *count + 2] = loop[middle];
        ++*count;
        if (cut(loop, faces, first, middle, length, edges, count) &&
            cut(loop, faces, middle, last, length, edges, count))
            return true;
        *count = before;
    }
    return false;
}

/* Seven sides go round a lone outside corner and, through a face, round an edge of two. Cut like
 * any other they may run through one another; a fan from the lone corner's edge that does not lie
 * in that face (the one between two edges of one face) never does. With the lone corner at (0, 0,
 * 0) and the face x = 0, the apex is (a, 0, 0); seen from there the others follow one another, in
 * (x - a) / (y + z) and z / (y + z), along (-, 0), (-, < 1/2), (+, < 1/2), (+, > 1/2), (-, > 1/2),
 * (-, 1), the first two and the last two each with the outer one further out: a line that does not
 * meet itself. */
static void fan(const uint8_t *loop, const unsigned *faces, int length, uint8_t *edges, int *count)
{
    int apex = 0;
    while (!(faces[(apex + 1) % length] & faces[(apex + length - 1) % length]))
        apex++;
    for (int i = 1; i + 1 < length; i++, ++*count) {
        edges[3 * *count] = loop[apex];
        edges[3 * *count + 1] = loop[(apex + i + 1) % length];
        edges[3 * *count + 2] = loop[(apex + i) % length];
    }
}

csg_cell_loops csg_cell_loops_of(unsigned pattern, unsigned joined)
{
    csg_cell_loops loops = {.count = 0};
    uint8_t next[CSG_CELL_EDGES];
    link_segments(pattern, joined, next);
    for (uint8_t start = 0; start < CSG_CELL_EDGES; start++) {
        uint8_t loop[CSG_CELL_EDGES];
        int length = 0;
        for (uint8_t edge = start; next[edge] != NO_EDGE;) {
            loop[length++] = edge;
            uint8_t following = next[edge];
            next[edge] = NO_EDGE;
            edge = following;
        }
        if (!length)
            continue;
        uint8_t index = loops.count++;
        loops.sides[index] = (uint8_t)length;
        for (int i = 0; i < length; i++) /* as the triangles turn: against the links */
            loops.edge[index][i] = loop[i ? length - i : 0];
    }
    return loops;
}

bool csg_cell_cut(const uint8_t *edge, int sides, uint8_t *triangles)
{
    uint8_t loop[CSG_CELL_EDGES];
    unsigned faces[CSG_CELL_EDGES];
    int count = 0;
    for (int i = 0; i < sides; i++) {
        loop[i] = edge[i ? sides - i : 0];
        faces[i] = faces_of_edge(loop[i]);
    }
    if (sides != 7)
        return cut(loop, faces, 0, sides - 1, sides, triangles, &count);
    fan(loop, faces, sides, triangles, &count);
    return true;
}

static void make_pattern(csg_cell_tables *tables, unsigned pattern)
{
    csg_cell_loops loops = csg_cell_loops_of(pattern, 0);
    tables->loop_count[pattern] = loops.count;
    memcpy(tables->loop_sides[pattern], loops.sides, sizeof loops.sides);
    memcpy(tables->loop_edge[pattern], loops.edge, sizeof loops.edge);
    for (int l = 0; l < loops.count; l++) {
        uint8_t *to = tables->edge[pattern] + 3 * tables->count[pattern];
        csg_cell_cut(loops.edge[l], loops.sides[l], to);
        tables->count[pattern] = (uint8_t)(tables->count[pattern] + loops.sides[l] - 2);
    }
}

void csg_cell_tables_make(csg_cell_tables *tables)
{
    memset(tables, 0, sizeof *tables);
    for (unsigned pattern = 0; pattern < 256; pattern++)
        make_pattern(tables, pattern);
    for (unsigned edge = 0; edge < CSG_CELL_EDGES; edge++) {
        unsigned axis = edge / 4, u = edge & 1, v = edge >> 1 & 1;
        unsigned first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
        tables->offset[edge][first] = (uint8_t)u;
        tables->offset[edge][second] = (uint8_t)v;
        tables->faces[edge] = (uint8_t)faces_of_edge((uint8_t)edge);
    }
}
