/* SPDX-License-Identifier: MIT
 * The corner table; see corners.h.
 */
#include "mesh/remesh/corners.h"

#include <string.h>

/* ---- making -----------------------------------------------------------------------------------
 */

typedef struct half_edge {
    uint32_t to; /* the larger vertex */
    uint32_t corner;
} half_edge;

static uint32_t start_of(const csg_corners *m, uint32_t c)
{
    return m->vertex[c];
}
static uint32_t end_of(const csg_corners *m, uint32_t c)
{
    return m->vertex[csg_corner_next(c)];
}

static uint32_t lower_end(const csg_corners *m, uint32_t c)
{
    uint32_t a = start_of(m, c), b = end_of(m, c);
    return a < b ? a : b;
}

/* first[v] becomes where the half-edges with the lower vertex v end; they are sorted by vertex. */
static void sort_half_edges(const csg_corners *m, uint32_t *first, half_edge *edges)
{
    uint32_t count = 3 * m->triangle_count, sum = 0;
    memset(first, 0, ((size_t)m->vertex_count + 1) * sizeof *first);
    for (uint32_t c = 0; c < count; c++)
        first[lower_end(m, c)]++;
    for (uint32_t v = 0; v <= m->vertex_count; v++) {
        uint32_t here = first[v];
        first[v] = sum;
        sum += here;
    }
    for (uint32_t c = 0; c < count; c++) {
        uint32_t a = start_of(m, c), b = end_of(m, c);
        edges[first[a < b ? a : b]++] = (half_edge){a < b ? b : a, c};
    }
}

/* Each half-edge of a vertex has exactly one partner, which runs the other way. */
static bool match_vertex(csg_corners *m, half_edge *edges, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        if (edges[i].corner == CSG_CORNER_NONE)
            continue;
        uint32_t partner = CSG_CORNER_NONE, c = edges[i].corner;
        for (uint32_t k = i + 1; k < end; k++) {
            if (edges[k].to != edges[i].to || edges[k].corner == CSG_CORNER_NONE)
                continue;
            if (partner != CSG_CORNER_NONE || start_of(m, edges[k].corner) == start_of(m, c))
                return false;
            partner = edges[k].corner;
            edges[k].corner = CSG_CORNER_NONE;
        }
        if (partner == CSG_CORNER_NONE)
            return false;
        m->across[csg_corner_previous(c)] = csg_corner_previous(partner);
        m->across[csg_corner_previous(partner)] = csg_corner_previous(c);
    }
    return true;
}

static bool match(csg_corners *m, half_edge *edges, const uint32_t *end)
{
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (!match_vertex(m, edges, v ? end[v - 1] : 0, end[v]))
            return false;
    return true;
}

/* One corner per vertex; a second fan would leave corners that a walk around it does not meet. */
static bool find_corners(csg_corners *m, uint32_t *met)
{
    memset(met, 0, ((size_t)m->vertex_count + 1) * sizeof *met);
    memset(m->corner, 0xFF, ((size_t)m->vertex_count + 1) * sizeof *m->corner);
    for (uint32_t c = 0; c < 3 * m->triangle_count; c++) {
        m->corner[m->vertex[c]] = c;
        met[m->vertex[c]]++;
    }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (met[v] && (met[v] < 3 || csg_corners_valence(m, v) != met[v]))
            return false;
    return true;
}

static bool is_sound(const csg_corners *m)
{
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *v = m->vertex + 3 * (size_t)t;
        if (v[0] >= m->vertex_count || v[1] >= m->vertex_count || v[2] >= m->vertex_count ||
            v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
            return false;
    }
    return true;
}

static csg_corners_result connect(csg_corners *m)
{
    size_t edge_bytes = ((size_t)m->triangle_count * 3 + 1) * sizeof(half_edge);
    size_t first_bytes = ((size_t)m->vertex_count + 1) * sizeof(uint32_t);
    half_edge *edges = csg_memory_alloc(m->memory, edge_bytes);
    uint32_t *first = csg_memory_alloc(m->memory, first_bytes);
    csg_corners_result result = CSG_CORNERS_NO_MEMORY;
    if (edges && first) {
        bool closed = is_sound(m);
        if (closed) {
            sort_half_edges(m, first, edges);
            closed = match(m, edges, first) && find_corners(m, first);
        }
        result = closed ? CSG_CORNERS_MADE : CSG_CORNERS_NOT_CLOSED;
    }
    csg_memory_release(m->memory, edges, edge_bytes);
    csg_memory_release(m->memory, first, first_bytes);
    return result;
}

csg_corners_result csg_corners_make(csg_corners *m, csg_memory *memory, const uint32_t *indices,
                                    uint64_t triangle_count, uint64_t vertex_count)
{
    if (triangle_count > UINT32_MAX / 3 - 1 || vertex_count >= UINT32_MAX)
        return CSG_CORNERS_NOT_CLOSED;
    *m = (csg_corners){.memory = memory,
                       .triangle_count = (uint32_t)triangle_count,
                       .vertex_count = (uint32_t)vertex_count,
                       .live = (uint32_t)triangle_count};
    size_t bytes = ((size_t)triangle_count * 3 + 1) * sizeof(uint32_t);
    m->vertex = csg_memory_alloc(memory, bytes);
    m->across = csg_memory_alloc(memory, bytes);
    m->corner = csg_memory_alloc(memory, ((size_t)vertex_count + 1) * sizeof(uint32_t));
    csg_corners_result result = CSG_CORNERS_NO_MEMORY;
    if (m->vertex && m->across && m->corner) {
        memcpy(m->vertex, indices, (size_t)triangle_count * 3 * sizeof(uint32_t));
        result = connect(m);
    }
    if (result != CSG_CORNERS_MADE)
        csg_corners_release(m);
    return result;
}

void csg_corners_release(csg_corners *m)
{
    size_t bytes = ((size_t)m->triangle_count * 3 + 1) * sizeof(uint32_t);
    if (!m->memory)
        return;
    csg_memory_release(m->memory, m->vertex, bytes);
    csg_memory_release(m->memory, m->across, bytes);
    csg_memory_release(m->memory, m->corner, ((size_t)m->vertex_count + 1) * sizeof(uint32_t));
    *m = (csg_corners){0};
}

/* ---- looking ----------------------------------------------------------------------------------
 */

uint32_t csg_corners_valence(const csg_corners *m, uint32_t vertex)
{
    uint32_t first = m->corner[vertex], c = first, count = 0;
    do {
        count++;
        c = csg_corner_swing(m, c);
    } while (c != first);
    return count;
}

uint32_t csg_corners_find_edge(const csg_corners *m, uint32_t from, uint32_t to)
{
    uint32_t first = m->corner[from], c = first;
    if (first == CSG_CORNER_NONE)
        return CSG_CORNER_NONE;
    do {
        if (end_of(m, c) == to)
            return c;
        c = csg_corner_swing(m, c);
    } while (c != first);
    return CSG_CORNER_NONE;
}

/* ---- collapsing -------------------------------------------------------------------------------
 */

/* Neighbours of a vertex, in order; 0: more than there is room for. */
static uint32_t neighbours(const csg_corners *m, uint32_t vertex,
                           uint32_t out[CSG_CORNERS_MOST_VALENCE])
{
    uint32_t first = m->corner[vertex], c = first, count = 0;
    do {
        if (count == CSG_CORNERS_MOST_VALENCE)
            return 0;
        out[count++] = end_of(m, c);
        c = csg_corner_swing(m, c);
    } while (c != first);
    return count;
}

bool csg_corners_can_collapse(const csg_corners *m, uint32_t corner)
{
    uint32_t a = start_of(m, corner), b = end_of(m, corner);
    uint32_t apex = m->vertex[csg_corner_previous(corner)];
    uint32_t other = m->vertex[m->across[csg_corner_previous(corner)]];
    uint32_t near_a[CSG_CORNERS_MOST_VALENCE], near_b[CSG_CORNERS_MOST_VALENCE];
    uint32_t count_a = neighbours(m, a, near_a), count_b = neighbours(m, b, near_b);
    uint32_t common = 0;
    if (!count_a || !count_b || count_a + count_b - 4 > CSG_CORNERS_MOST_VALENCE ||
        count_a + count_b < 7 || apex == other)
        return false;
    for (uint32_t i = 0; i < count_a; i++)
        for (uint32_t k = 0; k < count_b; k++)
            common += near_a[i] == near_b[k];
    return common == 2 && csg_corners_valence(m, apex) > 3 && csg_corners_valence(m, other) > 3;
}

/* Takes a triangle away; what faced it over its other two edges now faces each other. `apex` is its
 * corner that faces the collapsed edge. */
static void close_gap(csg_corners *m, uint32_t apex)
{
    uint32_t p = m->across[csg_corner_next(apex)], q = m->across[csg_corner_previous(apex)];
    m->across[p] = q;
    m->across[q] = p;
    const uint32_t ends[2] = {csg_corner_next(p), csg_corner_previous(p)};
    for (int i = 0; i < 2; i++)
        m->corner[m->vertex[ends[i]]] = ends[i];
    m->vertex[apex / 3 * 3] = CSG_CORNER_NONE;
    m->live--;
}

void csg_corners_collapse(csg_corners *m, uint32_t corner)
{
    uint32_t a = start_of(m, corner), b = end_of(m, corner);
    uint32_t apex = csg_corner_previous(corner), other = m->across[apex];
    uint32_t c = corner;
    do {
        uint32_t after = csg_corner_swing(m, c);
        m->vertex[c] = b;
        c = after;
    } while (c != corner);
    m->corner[a] = CSG_CORNER_NONE;
    close_gap(m, apex);
    close_gap(m, other);
}

/* ---- flipping ---------------------------------------------------------------------------------
 */

bool csg_corners_can_flip(const csg_corners *m, uint32_t corner)
{
    uint32_t apex = m->vertex[csg_corner_previous(corner)];
    uint32_t other = m->vertex[m->across[csg_corner_previous(corner)]];
    return apex != other && csg_corners_find_edge(m, apex, other) == CSG_CORNER_NONE &&
           csg_corners_valence(m, start_of(m, corner)) > 3 &&
           csg_corners_valence(m, end_of(m, corner)) > 3;
}

static void face(csg_corners *m, uint32_t c, uint32_t d)
{
    m->across[c] = d;
    m->across[d] = c;
}

/* Triangles (c, a, b) and (d, b, a) over the edge a b become (c, a, d) and (d, b, c). */
void csg_corners_flip(csg_corners *m, uint32_t corner)
{
    uint32_t c = csg_corner_previous(corner), d = m->across[c];
    uint32_t c1 = csg_corner_next(c), c2 = csg_corner_previous(c);
    uint32_t d1 = csg_corner_next(d), d2 = csg_corner_previous(d);
    uint32_t a = m->vertex[c1], b = m->vertex[c2];
    uint32_t beyond_bc = m->across[c1], beyond_ad = m->across[d1];
    m->vertex[c2] = m->vertex[d];
    m->vertex[d2] = m->vertex[c];
    face(m, c1, d1);       /* the new edge c d */
    face(m, c, beyond_ad); /* edge a d of (c, a, d) */
    face(m, d, beyond_bc); /* edge b c of (d, b, c) */
    m->corner[a] = c1;
    m->corner[b] = d1;
    m->corner[m->vertex[c]] = c;
    m->corner[m->vertex[d]] = d;
}

static void set_triangle(csg_corners *m, uint32_t triangle, uint32_t a, uint32_t b, uint32_t c)
{
    m->vertex[3 * triangle] = a;
    m->vertex[3 * triangle + 1] = b;
    m->vertex[3 * triangle + 2] = c;
    m->live++;
}

/* Triangles (c, a, b) and (d, b, a) become (c, a, n) and (d, b, n), and there are (c, n, b) and
 * (d, n, a) too. */
void csg_corners_split(csg_corners *m, uint32_t corner, uint32_t vertex,
                       const uint32_t triangles[2])
{
    uint32_t c = csg_corner_previous(corner), d = m->across[c];
    uint32_t c1 = csg_corner_next(c), c2 = csg_corner_previous(c);
    uint32_t d1 = csg_corner_next(d), d2 = csg_corner_previous(d);
    uint32_t a = m->vertex[c1], b = m->vertex[c2], t = 3 * triangles[0], u = 3 * triangles[1];
    uint32_t beyond_bc = m->across[c1], beyond_ad = m->across[d1];
    set_triangle(m, triangles[0], m->vertex[c], vertex, b);
    set_triangle(m, triangles[1], m->vertex[d], vertex, a);
    m->vertex[c2] = vertex;
    m->vertex[d2] = vertex;
    face(m, c, u);             /* edge a n */
    face(m, d, t);             /* edge b n */
    face(m, c1, t + 2);        /* edge n c */
    face(m, d1, u + 2);        /* edge n d */
    face(m, t + 1, beyond_bc); /* edge b c */
    face(m, u + 1, beyond_ad); /* edge a d */
    m->corner[vertex] = c2;
    m->corner[a] = c1;
    m->corner[b] = d1;
}
