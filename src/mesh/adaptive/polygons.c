/* SPDX-License-Identifier: MIT
 * Cycles, segments and loops; see polygons.h.
 */
#include "mesh/adaptive/polygons.h"

#include <string.h>

enum { NOWHERE = 0xFF, MOST_POINTS = 8 };

/* What is found face by face: for the vertex that a segment begins at, the rest of it. */
typedef struct links {
    const csg_shell_cell *cell;
    uint64_t begins[2]; /* places that a segment begins at: of those only there is more */
    uint8_t to[CSG_LOCAL_PLACES], face[CSG_LOCAL_PLACES];
    uint8_t in_face[CSG_LOCAL_PLACES]; /* segments, of faces that have some */
    csg_face_is_inside *is_inside;
    void *user;
} links;

/* A point of 3 x 3 x 3. */
typedef struct cycle {
    uint8_t point[MOST_POINTS][3];
    int count;
} cycle;

static unsigned bit_of(const uint8_t p[3])
{
    return p[0] + 3u * p[1] + 9u * p[2];
}

/* Halfway between two points of 3 x 3 x 3, in quarters. */
static uint8_t middle_of(const uint8_t p[3], const uint8_t q[3])
{
    return (uint8_t)((p[0] + q[0]) + 5 * (p[1] + q[1]) + 25 * (p[2] + q[2]));
}

/* Numbers the runs of equal points, which alternate, along the cycle. */
static int number_runs(const cycle *c, const bool *in, int *run)
{
    int runs = 0, first = 0;
    while (in[first] == in[(first + c->count - 1) % c->count])
        first++;
    for (int i = 0; i < c->count; i++) {
        int p = (first + i) % c->count;
        if (i && in[p] != in[(p + c->count - 1) % c->count])
            runs++;
        run[p] = runs;
    }
    return runs + 1;
}

/* The point of a pierced edge in the cycle, of those there are the one of the lowest bit; -1. */
static int find_pierced(const links *l, const cycle *c)
{
    int found = -1;
    for (int i = 0; i < c->count; i++)
        if (l->cell->pierced >> bit_of(c->point[i]) & 1 &&
            (found < 0 || bit_of(c->point[i]) < bit_of(c->point[found])))
            found = i;
    return found;
}

static void add_point(csg_face_look *look, const uint8_t p[3], double weight)
{
    int at = look->count++;
    for (; at > 0 && bit_of(look->point[at - 1]) > bit_of(p); at--) {
        memcpy(look->point[at], look->point[at - 1], sizeof look->point[at]);
        look->weight[at] = look->weight[at - 1];
    }
    memcpy(look->point[at], p, sizeof look->point[at]);
    look->weight[at] = weight;
}

/* Whether several runs of inside points are one within the face. */
static bool is_joined(const links *l, const cycle *c, const bool *in, unsigned face)
{
    csg_face_look look = {.face = face};
    int run[MOST_POINTS], runs = number_runs(c, in, run), own = find_pierced(l, c), other = -1;
    int lowest = 27;
    for (int i = 0; own >= 0 && i < c->count; i++) /* that of the lowest bit */
        if (in[i] == in[own] && run[i] != run[own] && (int)bit_of(c->point[i]) < lowest) {
            lowest = (int)bit_of(c->point[i]);
            other = run[i];
        }
    int members = 0;
    for (int i = 0; i < c->count && other >= 0; i++)
        members += run[i] == other;
    for (int i = 0; i < c->count && other >= 0 && runs > 1; i++)
        if (i == own || run[i] == other)
            add_point(&look, c->point[i], i == own ? 0.5 : 0.5 / members);
    return l->is_inside(l->user, &look);
}

static void link_cycle(links *l, const cycle *c, uint8_t face, uint32_t inside)
{
    bool in[MOST_POINTS];
    uint8_t enter[MOST_POINTS], leave[MOST_POINTS];
    int runs = 0;
    for (int i = 0; i < c->count; i++)
        in[i] = inside >> bit_of(c->point[i]) & 1;
    for (int i = 0; i < c->count; i++) {
        int before = (i + c->count - 1) % c->count, last = i;
        if (!in[i] || in[before])
            continue; /* not the first of a run */
        while (in[(last + 1) % c->count])
            last = (last + 1) % c->count;
        enter[runs] = middle_of(c->point[before], c->point[i]);
        leave[runs++] = middle_of(c->point[last], c->point[(last + 1) % c->count]);
    }
    int shift = runs > 1 && is_joined(l, c, in, face) ? runs - 1 : 0;
    for (int r = 0; r < runs; r++) {
        l->begins[enter[r] / 64] |= (uint64_t)1 << enter[r] % 64;
        l->to[enter[r]] = leave[(r + shift) % runs];
        l->face[enter[r]] = face;
    }
    l->in_face[face] = (uint8_t)runs;
}

/* The points around a face, or a quarter of it: from (u, v), `step` wide, counter-clockwise seen
 * from outside the cell; the middles of divided edges between. */
static void go_round(cycle *c, int axis, int side, unsigned u, unsigned v, unsigned step,
                     uint32_t divided)
{
    static const uint8_t round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    int b = (axis + 1) % 3, d = (axis + 2) % 3;
    c->count = 0;
    for (int i = 0; i < 4; i++) {
        const uint8_t *at = round[side ? i : 3 - i],
                      *next = round[side ? (i + 1) % 4 : (6 - i) % 4];
        uint8_t *p = c->point[c->count++], to[3];
        p[axis] = to[axis] = (uint8_t)(2 * side);
        p[b] = (uint8_t)(u + step * at[0]), p[d] = (uint8_t)(v + step * at[1]);
        to[b] = (uint8_t)(u + step * next[0]), to[d] = (uint8_t)(v + step * next[1]);
        uint8_t middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = (uint8_t)((p[k] + to[k]) / 2);
        if (step == 2 && divided >> bit_of(middle) & 1)
            memcpy(c->point[c->count++], middle, sizeof middle);
    }
}

static void link_face(links *l, const csg_shell_cell *cell, int axis, int side)
{
    int b = (axis + 1) % 3, d = (axis + 2) % 3;
    uint8_t middle[3] = {1, 1, 1};
    cycle c;
    middle[axis] = (uint8_t)(2 * side);
    if (!(cell->divided >> bit_of(middle) & 1)) {
        go_round(&c, axis, side, 0, 0, 2, cell->divided);
        link_cycle(l, &c, middle_of(middle, middle), cell->inside);
        return;
    }
    for (unsigned quarter = 0; quarter < 4; quarter++) {
        unsigned u = quarter & 1, v = quarter >> 1;
        uint8_t low[3], high[3];
        low[axis] = high[axis] = middle[axis];
        low[b] = (uint8_t)u, low[d] = (uint8_t)v;
        high[b] = (uint8_t)(u + 1), high[d] = (uint8_t)(v + 1);
        go_round(&c, axis, side, u, v, 1, cell->divided);
        link_cycle(l, &c, middle_of(low, high), cell->inside);
    }
}

/* The edge of the cell that a vertex lies on, by its middle; NOWHERE: within a face. */
static uint8_t edge_of(uint8_t place)
{
    unsigned at[3], between = 0;
    csg_local_place(place, at);
    for (int axis = 0; axis < 3; axis++)
        if (at[axis] % 4) {
            between++;
            at[axis] = 2;
        }
    return between == 1 ? (uint8_t)(at[0] + 5 * at[1] + 25 * at[2]) : NOWHERE;
}

static bool is_pierced(const csg_shell_cell *cell, uint8_t edge)
{
    unsigned at[3];
    csg_local_place(edge, at);
    return cell->pierced >> (at[0] / 2 + 3 * (at[1] / 2) + 9 * (at[2] / 2)) & 1;
}

/* Whether a segment begins there, once. */
static bool take_beginning(links *l, uint8_t place)
{
    uint64_t bit = (uint64_t)1 << place % 64;
    bool is_there = (l->begins[place / 64] & bit) != 0;
    l->begins[place / 64] &= ~bit;
    return is_there;
}

static void trace(csg_cell_polygons *polygons, const csg_shell_cell *cell,
                  csg_face_is_inside *is_inside, void *user)
{
    links l; /* its arrays are filled where begins says so */
    l.begins[0] = l.begins[1] = 0;
    l.cell = cell;
    l.is_inside = is_inside;
    l.user = user;
    for (int face = 0; face < 6; face++)
        link_face(&l, cell, face / 2, face % 2);
    polygons->count = 0;
    unsigned n = 0;
    while (l.begins[0] | l.begins[1]) {
        unsigned first = n, half = l.begins[0] ? 0 : 1;
        uint8_t at = (uint8_t)(64 * half + (unsigned)__builtin_ctzll(l.begins[half]));
        while (take_beginning(&l, at) && n < CSG_CELL_MOST_SEGMENTS) {
            csg_polygon_side *s = &polygons->side[n++];
            uint8_t edge = edge_of(at);
            *s = (csg_polygon_side){.from = at, .to = l.to[at], .face = l.face[at]};
            bool is_on_edge = edge != NOWHERE && edge == edge_of(s->to);
            s->pierced = is_on_edge && is_pierced(cell, edge);
            s->along_edge = is_on_edge && !s->pierced;
            s->alone = l.in_face[s->face] == 1;
            s->crease = (uint8_t)(s->pierced ? (edge + s->face) / 2 : s->face);
            at = s->to;
        }
        if (n - first == 2 && polygons->side[first].along_edge)
            n = first;
        if (n > first && polygons->count < CSG_CELL_MOST_POLYGONS)
            polygons->first[polygons->count++] = (uint8_t)first;
    }
    polygons->first[polygons->count] = (uint8_t)n;
}

/* ---- plain cells -------------------------------------------------------------------------------
 */

static const uint8_t CORNER[8] = {0, 2, 6, 8, 18, 20, 24, 26}; /* bits of 3 x 3 x 3 */

/* The faces of this cell have to be looked at. */
static bool note_look(void *user, const csg_face_look *look)
{
    (void)look;
    *(bool *)user = true;
    return false;
}

void csg_plain_polygons_fill(csg_plain_polygons *plain)
{
    for (unsigned pattern = 0; pattern < 256; pattern++) {
        csg_cell_polygons polygons;
        csg_shell_cell cell = {0};
        bool looks = false;
        for (unsigned c = 0; c < 8; c++)
            cell.inside |= (pattern >> c & 1u) << CORNER[c];
        trace(&polygons, &cell, note_look, &looks);
        plain->of[pattern].is_known = !looks;
        plain->of[pattern].count = polygons.count;
        if (looks)
            continue;
        memcpy(plain->of[pattern].first, polygons.first, polygons.count + 1u);
        memcpy(plain->of[pattern].side, polygons.side,
               polygons.first[polygons.count] * sizeof polygons.side[0]);
    }
}

void csg_cell_polygons_make(csg_cell_polygons *polygons, const csg_plain_polygons *plain,
                            const csg_shell_cell *cell, csg_face_is_inside *is_inside, void *user)
{
    unsigned pattern = 0;
    for (unsigned c = 0; c < 8; c++)
        pattern |= (cell->inside >> CORNER[c] & 1u) << c;
    if (cell->divided || !plain->of[pattern].is_known) {
        trace(polygons, cell, is_inside, user);
        return;
    }
    unsigned count = plain->of[pattern].count;
    polygons->count = (uint8_t)count;
    memcpy(polygons->first, plain->of[pattern].first, count + 1);
    memcpy(polygons->side, plain->of[pattern].side,
           polygons->first[count] * sizeof polygons->side[0]);
}

bool csg_cell_polygons_are_mixed(const csg_cell_polygons *polygons)
{
    for (unsigned i = 0; i < polygons->first[polygons->count]; i++)
        if (polygons->side[i].pierced && !polygons->side[i].alone)
            return true;
    return false;
}
