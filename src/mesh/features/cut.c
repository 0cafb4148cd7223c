/* SPDX-License-Identifier: MIT
 * Cutting polygons with an apex into triangles, a sheet at a time. What a sheet has of the polygon
 * is a piece: the apex, the run of corners between two creases, and, where the segment at one of
 * its ends is flipped, the apex beyond it. Mostly a piece is a fan round the apex; where the apex
 * beyond is a corner that bends inwards, not all of the run is in sight of this one's, and the cut
 * goes to the other.
 */
#include "mesh/features/cut.h"

#include <string.h>

enum { MOST = CSG_FEATURE_MOST_SIDES + 3 };

typedef struct piece {
    const csg_feature *features, *f;
    const csg_cell_tables *tables;
    unsigned takes; /* who has which half of flipped sides: f->takes_next, or what is tried */
    int count;
    uint8_t corner[MOST]; /* as in csg_feature.triangle; [0] is the apex */
    csg_vec3 at[MOST], normal;
    uint8_t (*triangles)[3];
    int triangle_count;
} piece;

static void add(piece *q, uint8_t corner)
{
    const csg_feature *f = q->f;
    const float *at = corner == CSG_FEATURE_APEX ? f->at
                      : corner >= CSG_FEATURE_BEYOND
                          ? q->features[f->side[corner - CSG_FEATURE_BEYOND].beyond].at
                          : f->side[corner].corner;
    q->at[q->count] = csg_vec3_from_floats(at);
    q->corner[q->count++] = corner;
}

static bool looks_out(const piece *q, int i, int j, int k)
{
    csg_vec3 u = csg_vec3_sub(q->at[j], q->at[i]), v = csg_vec3_sub(q->at[k], q->at[i]);
    return csg_vec3_dot(csg_vec3_cross(u, v), q->normal) > 0;
}

/* The faces of the cell that a corner of a piece lies in; of an apex beyond, the face between. */
static unsigned faces_of(const piece *q, int i)
{
    const csg_feature *f = q->f;
    uint8_t c = q->corner[i];
    if (c == CSG_FEATURE_APEX)
        return 0;
    if (c < CSG_FEATURE_BEYOND)
        return q->tables->faces[f->side[c].edge];
    int s = c - CSG_FEATURE_BEYOND;
    return q->tables->faces[f->side[s].edge] &
           q->tables->faces[f->side[(s + 1) % f->side_count].edge];
}

/* A diagonal in a face of the cell could be the neighbour's too (see marching/tables.c), one from
 * the apex beyond a face to a corner in it is, and two apexes beyond may be joined elsewhere. */
static bool is_free(const piece *q, int i, int j)
{
    bool both_beyond = q->corner[i] >= CSG_FEATURE_BEYOND && q->corner[j] >= CSG_FEATURE_BEYOND &&
                       q->corner[i] != CSG_FEATURE_APEX && q->corner[j] != CSG_FEATURE_APEX;
    return !both_beyond && !(faces_of(q, i) & faces_of(q, j));
}

/* Cuts the polygon first..last of the piece into triangles that all look out, those at the apex
 * preferred. The side first-last is there already. */
static bool cut(piece *q, int first, int last)
{
    if (last - first < 2)
        return true;
    int before = q->triangle_count;
    for (int middle = last - 1; middle > first; middle--) {
        if ((middle - first > 1 && !is_free(q, first, middle)) ||
            (last - middle > 1 && !is_free(q, middle, last)) || !looks_out(q, first, middle, last))
            continue;
        uint8_t *t = q->triangles[q->triangle_count++];
        t[0] = q->corner[first], t[1] = q->corner[middle], t[2] = q->corner[last];
        if (cut(q, first, middle) && cut(q, middle, last))
            return true;
        q->triangle_count = before;
    }
    return false;
}

static void fan(piece *q)
{
    for (int i = 1; i + 1 < q->count; i++) {
        uint8_t *t = q->triangles[q->triangle_count++];
        t[0] = q->corner[0], t[1] = q->corner[i], t[2] = q->corner[i + 1];
    }
}

static void begin(piece *q, int sheet)
{
    q->count = 0;
    q->normal = csg_vec3_from_floats(q->f->normal[sheet]);
    add(q, CSG_FEATURE_APEX);
}

/* Round a tip each side makes a triangle with the apex, in the plane of its first corner. */
static bool cut_tip(piece *q)
{
    bool good = true;
    for (uint8_t s = 0; s < q->f->side_count; s++) {
        begin(q, q->f->side[s].sheet);
        add(q, s);
        add(q, (uint8_t)((s + 1) % q->f->side_count));
        good = good && looks_out(q, 0, 1, 2);
        fan(q);
    }
    return good;
}

/* The piece that begins behind creased side s. */
static bool cut_sheet(piece *q, int s)
{
    const csg_feature *f = q->f;
    int k = (s + 1) % f->side_count;
    begin(q, f->side[k].sheet);
    if (f->flipped & q->takes & 1u << s)
        add(q, (uint8_t)(CSG_FEATURE_BEYOND + s));
    for (add(q, (uint8_t)k); !(f->creased >> k & 1); add(q, (uint8_t)k))
        k = (k + 1) % f->side_count;
    if (f->flipped & ~q->takes & 1u << k)
        add(q, (uint8_t)(CSG_FEATURE_BEYOND + k));
    int before = q->triangle_count;
    if (cut(q, 0, q->count - 1))
        return true;
    q->triangle_count = before;
    fan(q);
    return false;
}

/* The lists of a piece are filled before they are read. */
static void prepare(piece *q, const csg_feature *features, const csg_cell_tables *tables,
                    const csg_feature *f, unsigned takes, uint8_t (*triangles)[3])
{
    q->features = features;
    q->f = f;
    q->tables = tables;
    q->takes = takes;
    q->triangles = triangles;
    q->triangle_count = 0;
}

bool csg_feature_cut(const csg_feature *features, const csg_cell_tables *tables,
                     const csg_feature *f, uint8_t (*triangles)[3])
{
    piece q;
    prepare(&q, features, tables, f, f->takes_next, triangles);
    if (!f->creased)
        return cut_tip(&q);
    bool good = true;
    for (int s = 0; s < f->side_count; s++)
        if (f->creased >> s & 1)
            good = cut_sheet(&q, s) && good;
    for (uint8_t s = 0; s < f->side_count; s++)
        if (f->creased & ~f->flipped & 1u << s) { /* from one sheet to the next */
            uint8_t *t = triangles[q.triangle_count++];
            t[0] = CSG_FEATURE_APEX, t[1] = s, t[2] = (uint8_t)((s + 1) % f->side_count);
        }
    return good;
}

bool csg_feature_is_cut(const csg_feature *features, const csg_cell_tables *tables,
                        const csg_feature *f)
{
    uint8_t triangles[CSG_FEATURE_MOST_SIDES][3];
    piece q;
    prepare(&q, features, tables, f, f->takes_next, triangles);
    if (!f->creased)
        return cut_tip(&q);
    for (int s = 0; s < f->side_count; s++) {
        q.triangle_count = 0;
        if (f->creased >> s & 1 && !cut_sheet(&q, s))
            return false;
    }
    return true;
}

bool csg_feature_is_cut_behind(const csg_feature *features, const csg_cell_tables *tables,
                               const csg_feature *f, int side, unsigned takes)
{
    uint8_t triangles[CSG_FEATURE_MOST_SIDES][3];
    piece q;
    prepare(&q, features, tables, f, takes, triangles);
    return cut_sheet(&q, side);
}

bool csg_feature_cuts_at(const csg_feature *features, const csg_cell_tables *tables,
                         const csg_feature *f, int side, unsigned takes)
{
    int before = side; /* the creased side that the run which ends at this one begins behind */
    do
        before = (before + f->side_count - 1) % f->side_count;
    while (!(f->creased >> before & 1));
    return csg_feature_is_cut_behind(features, tables, f, side, takes) &&
           csg_feature_is_cut_behind(features, tables, f, before, takes);
}
