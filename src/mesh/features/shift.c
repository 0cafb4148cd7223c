/* SPDX-License-Identifier: MIT
 * A vertex on a lattice edge belongs to four polygons. All four are features here, with an apex or
 * without (bare.h): so all that its move changes is known, and is looked at like any other
 * feature where triangles could meet.
 */
#include "mesh/features/shift.h"

#include <math.h>
#include <string.h>

#include "mesh/features/cut.h"
#include "mesh/features/join.h"
#include "mesh/features/smooth.h"

enum { AROUND = 4 };

/* The four polygons around a vertex, and which of their corners it is. */
typedef struct ring {
    csg_feature *f[AROUND];
    int corner[AROUND];
} ring;

/* False: they are not all known, or not free to change. */
static bool find_ring(csg_feature_store *store, csg_feature *f, int corner, ring *r)
{
    for (int k = 0; k < AROUND; k++) {
        r->f[k] = f;
        r->corner[k] = corner;
        if (f->state == CSG_FEATURE_GIVEN_UP || f->moved >> corner & 1 ||
            f->side[corner].beyond == CSG_FEATURE_NONE)
            return false;
        int side = f->side[corner].beyond_side;
        f = &store->features[f->side[corner].beyond];
        corner = (side + 1) % f->side_count;
    }
    return f == r->f[0] && corner == r->corner[0];
}

static void place_vertex(const ring *r, const float at[3])
{
    for (int k = 0; k < AROUND; k++)
        memcpy(r->f[k]->side[r->corner[k]].corner, at, 3 * sizeof *at);
}

/* Places to try around one vertex or apex. */
enum { WAYS = 16 };

typedef struct places {
    csg_vec3 at[WAYS], normal[WAYS];
    bool good[WAYS];
} places;

/* One step of a place to the surface, from the field there. False: it is not of this sheet. */
static bool step_to_surface(csg_vec3 *at, csg_vec3 *normal, csg_vec3 sheet, double f, csg_vec3 d,
                            double cell)
{
    static const double ALIKE = 0.97; /* cosine */
    double square = csg_vec3_dot(d, d);
    if (!(square > 1e-6) || !(fabs(f) < 0.5 * cell))
        return false;
    *normal = csg_vec3_scale(d, -1 / sqrt(square));
    *at = csg_vec3_sub(*at, csg_vec3_scale(d, f / square));
    return csg_vec3_dot(*normal, sheet) > ALIKE;
}

/* Moves the places to the points of the surface near them, all at once, and finds its outward
 * normals there: good are those that are of the sheet with this normal. One that lies on the
 * surface as far as the field's rounding can tell stays there. */
static void to_surface(csg_feature_probe *probe, csg_vec3 sheet, places *p)
{
    enum { STEPS = 3 };
    double cell = probe->marching->lattice->cell_size, noise = (double)probe->marching->noise;
    double least = 1e-4 * cell + 4 * noise;
    float x[WAYS], y[WAYS], z[WAYS], f[WAYS], g[3][WAYS];
    int which[WAYS], left = WAYS;
    for (int i = 0; i < WAYS; i++)
        which[i] = i;
    for (int step = 0; step <= STEPS && left; step++) {
        for (int k = 0; k < left; k++) {
            csg_vec3 at = p->at[which[k]];
            x[k] = (float)at.x, y[k] = (float)at.y, z[k] = (float)at.z;
        }
        csg_feature_probe_points(probe, x, y, z, (size_t)left, f,
                                 (float *const[3]){g[0], g[1], g[2]});
        int count = left;
        left = 0;
        for (int k = 0; k < count; k++) {
            int i = which[k];
            csg_vec3 d = {(double)g[0][k], (double)g[1][k], (double)g[2][k]};
            csg_vec3 *at = &p->at[i], before = *at;
            double off = fabs((double)f[k]);
            bool is_there = off <= 4 * noise || step == STEPS;
            p->good[i] = step_to_surface(at, &p->normal[i], sheet, (double)f[k], d, cell);
            if (is_there) {
                *at = before;
                p->good[i] = p->good[i] && off <= least;
            } else if (p->good[i]) {
                which[left++] = i;
            }
        }
    }
}

/* Least height of a triangle around a moved vertex. */
static const double FLAT = 0.01;

/* Whether the triangles of a polygon without an apex at a corner look along n. */
static bool looks_out(const csg_feature *f, int corner, csg_vec3 n, double cell)
{
    for (int t = 0; t < csg_feature_triangle_count(f); t++) {
        const uint8_t *c = f->triangle[t];
        if (c[0] != corner && c[1] != corner && c[2] != corner)
            continue;
        csg_vec3 at[3], u, v;
        for (int i = 0; i < 3; i++)
            at[i] = csg_vec3_from_floats(f->side[c[i]].corner);
        u = csg_vec3_sub(at[1], at[0]);
        v = csg_vec3_sub(at[2], at[0]);
        if (!(csg_vec3_dot(csg_vec3_cross(u, v), n) > FLAT * cell * cell))
            return false;
    }
    return true;
}

/* Of what csg_feature_holds asks: what costs next to nothing. */
static bool ring_stays_outward(const ring *r)
{
    for (int k = 0; k < AROUND; k++)
        if (r->f[k]->state != CSG_FEATURE_BARE && r->f[k]->state != CSG_FEATURE_UNSOLVED &&
            !csg_feature_stays_outward(r->f[k]))
            return false;
    return true;
}

static bool ring_holds(csg_feature_store *store, const csg_cell_tables *tables, const ring *r,
                       csg_vec3 normal)
{
    uint8_t triangles[CSG_FEATURE_MOST_SIDES][3];
    for (int k = 0; k < AROUND; k++) /* what is quick first */
        if (r->f[k]->state == CSG_FEATURE_BARE &&
            !looks_out(r->f[k], r->corner[k], normal, store->cell_size))
            return false;
    if (!ring_stays_outward(r))
        return false;
    for (int k = 0; k < AROUND; k++) {
        csg_feature *f = r->f[k];
        if (f->state == CSG_FEATURE_BARE || f->state == CSG_FEATURE_UNSOLVED)
            continue;
        if (f->creased ? !csg_feature_holds(store, tables, f)
                       : !csg_feature_cut(store->features, tables, f, triangles))
            return false;
    }
    return true;
}

static bool keep(csg_feature_store *store, const csg_feature *asker, const ring *r,
                 const float from[3], csg_vec3 normal)
{
    if (!csg_memory_reserve(store->memory, (void **)&store->moves, &store->move_capacity,
                            store->move_count + 1, sizeof *store->moves))
        return false;
    csg_feature_moved *m = &store->moves[store->move_count++];
    *m = (csg_feature_moved){.asker = (uint32_t)(asker - store->features),
                             .normal = {(float)normal.x, (float)normal.y, (float)normal.z}};
    memcpy(m->from, from, sizeof m->from);
    for (int k = 0; k < AROUND; k++) {
        m->feature[k] = (uint32_t)(r->f[k] - store->features);
        m->corner[k] = (uint8_t)r->corner[k];
        r->f[k]->moved |= (uint16_t)(1u << r->corner[k]);
        r->f[k]->moves++;
    }
    return true;
}

/* A place to try in the plane of a sheet: around the vertex first, then around the apex that it is
 * to make way for. */
enum { RINGS = 6, APEX_RINGS = 3 };

static csg_vec3 place_of(int i, csg_vec3 vertex, csg_vec3 apex, csg_vec3 normal, double cell)
{
    static const double way[WAYS][2] = {{1, 0},       {0.7, 0.7},   {0, 1},      {-0.7, 0.7},
                                        {-1, 0},      {-0.7, -0.7}, {0, -1},     {0.7, -0.7},
                                        {0.9, 0.4},   {0.4, 0.9},   {-0.4, 0.9}, {-0.9, 0.4},
                                        {-0.9, -0.4}, {-0.4, -0.9}, {0.4, -0.9}, {0.9, -0.4}};
    static const double radius[RINGS + APEX_RINGS] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.2, 0.35, 0.5};
    csg_vec3 axis = fabs(normal.x) < 0.7 ? csg_vec3_make(1, 0, 0) : csg_vec3_make(0, 1, 0);
    csg_vec3 u = csg_vec3_normalize(csg_vec3_cross(normal, axis));
    csg_vec3 v = csg_vec3_cross(normal, u), at = i < RINGS * WAYS ? vertex : apex;
    double reach = radius[i / WAYS] * cell;
    at = csg_vec3_add(at, csg_vec3_scale(u, reach * way[i % WAYS][0]));
    return csg_vec3_add(at, csg_vec3_scale(v, reach * way[i % WAYS][1]));
}

/* Whether all four may hold with the vertex elsewhere. */
static bool ring_may_hold(const csg_feature_store *store, const ring *r)
{
    for (int k = 0; k < AROUND; k++)
        if (r->f[k]->state != CSG_FEATURE_BARE && r->f[k]->state != CSG_FEATURE_UNSOLVED &&
            !csg_feature_may_hold(store, r->f[k], r->corner[k]))
            return false;
    return true;
}

/* Tries the places of one ring. */
static bool shift_corner(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f,
                         int corner, int around, csg_feature_probe *probe)
{
    ring r;
    if (!find_ring(store, f, corner, &r) || !ring_may_hold(store, &r))
        return false;
    csg_feature_whole before[AROUND];
    float from[3], to[3];
    for (int k = 0; k < AROUND; k++)
        csg_feature_keep(&before[k], r.f[k]);
    memcpy(from, f->side[corner].corner, sizeof from);
    csg_vec3 n = csg_vec3_from_floats(f->normal[f->side[corner].sheet]);
    places p;
    for (int i = 0; i < WAYS; i++)
        p.at[i] = place_of(around * WAYS + i, csg_vec3_from_floats(from),
                           csg_vec3_from_floats(f->at), n, store->cell_size);
    to_surface(probe, n, &p);
    for (int i = 0; i < WAYS; i++) {
        if (!p.good[i])
            continue;
        to[0] = (float)p.at[i].x, to[1] = (float)p.at[i].y, to[2] = (float)p.at[i].z;
        place_vertex(&r, to);
        if (ring_holds(store, tables, &r, p.normal[i])) {
            if (keep(store, f, &r, from, p.normal[i]))
                return true;
            probe->around->out_of_memory = true; /* ends the run: another mesh would come out */
        }
        for (int k = 0; k < AROUND; k++) {
            csg_feature_copy(r.f[k], &before[k].feature);
            csg_feature_agree(store, r.f[k]);
        }
    }
    return false;
}

static bool shift_ring(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f,
                       int around, csg_feature_probe *probe)
{
    if (!f->creased || f->state == CSG_FEATURE_UNSOLVED || f->shift > around)
        return false;
    f->shift = (uint8_t)(around + 1);
    bool done = false;
    for (int corner = 0; corner < f->side_count && !done; corner++)
        done = shift_corner(store, tables, f, corner, around, probe);
    f->made_way = f->made_way || done;
    return done;
}

bool csg_feature_shift(csg_feature_store *store, const csg_cell_tables *tables, uint32_t index,
                       uint32_t other, csg_feature_probe *probe)
{
    for (int around = 0; around < RINGS + APEX_RINGS; around++)
        if (shift_ring(store, tables, &store->features[index], around, probe) ||
            (other != CSG_FEATURE_NONE &&
             shift_ring(store, tables, &store->features[other], around, probe)))
            return true;
    return false;
}

static void put_back(csg_feature_store *store, const csg_cell_tables *tables, csg_feature_moved *m)
{
    for (int k = 0; k < AROUND; k++) {
        csg_feature *f = &store->features[m->feature[k]];
        memcpy(f->side[m->corner[k]].corner, m->from, sizeof m->from);
        f->moved &= (uint16_t) ~(1u << m->corner[k]);
        f->moves++;
        if (f->state == CSG_FEATURE_GIVEN_UP)
            csg_feature_divide(f, tables, 0);
    }
    m->back = true;
}

void csg_feature_shift_back(csg_feature_store *store, const csg_cell_tables *tables,
                            csg_feature *feature)
{
    uint32_t index = (uint32_t)(feature - store->features);
    bool any = csg_feature_is_shifted(feature);
    for (size_t i = 0; any && i < store->move_count; i++)
        for (int k = 0; k < AROUND && !store->moves[i].back; k++)
            if (store->moves[i].feature[k] == index || store->moves[i].asker == index)
                put_back(store, tables, &store->moves[i]);
    feature->made_way = false;
}
