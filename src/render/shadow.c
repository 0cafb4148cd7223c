/* SPDX-License-Identifier: MIT
 * Soft shadows: from each point that was hit a ray goes to the key light through the cells of wide
 * tapes. How near the solid comes to it, against the width that the light has there, is the share
 * that arrives (Quilez 2010). Wide tapes know the field up to their reach, and a bounded field is
 * no deeper than it is far away: the lesser is the largest width.
 */
#include "render/tracer.h"

enum { STACK_MOST = 8 * 24, MOST_STEPS = 128 };

static const float LIGHT_SLOPE = 0.22f; /* the light's width over its distance */

typedef struct bounds {
    float min[3], max[3]; /* across the light, across the light, towards it */
} bounds;

static float along(const float axis[3], float x, float y, float z)
{
    return axis[0] * x + axis[1] * y + axis[2] * z;
}

static const float *axis_of(const csg_tracer *tracer, int axis)
{
    return axis < 2 ? tracer->light_across[axis] : tracer->light;
}

/* Rays towards the light take the place of the march's `begin`...: x, y, z are their origins. */
static void begin_rays(const csg_tracer *tracer, csg_trace_room *room, csg_march *m, bounds *all)
{
    csg_rays *rays = &room->rays;
    const float *light = tracer->light;
    *all = (bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    m->count = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        if (!(rays->t[i] < INFINITY))
            continue;
        rays->lit[i] = 0;
        if (!(along(light, rays->nx[i], rays->ny[i], rays->nz[i]) > 0))
            continue;
        rays->lit[i] = rays->known_lit[i];
        if (rays->known_lit[i] >= 0)
            continue;
        rays->lit[i] = 1;
        float lift = 2 * (tracer->near_tolerance + tracer->tolerance_slope * rays->t[i]) +
                     0.01f * tracer->cells->reach;
        uint32_t k = m->count++;
        m->ray[k] = (uint16_t)i;
        m->channel[0][k] = rays->ox[i] + rays->t[i] * rays->dx[i] + lift * rays->nx[i];
        m->channel[1][k] = rays->oy[i] + rays->t[i] * rays->dy[i] + lift * rays->ny[i];
        m->channel[2][k] = rays->oz[i] + rays->t[i] * rays->dz[i] + lift * rays->nz[i];
        for (int axis = 0; axis < 3; axis++) {
            float at =
                along(axis_of(tracer, axis), m->channel[0][k], m->channel[1][k], m->channel[2][k]);
            all->min[axis] = fminf(all->min[axis], at);
            all->max[axis] = fmaxf(all->max[axis], at);
        }
    }
    room->counts.shadow_rays += m->count;
}

/* Whether any ray of the batch may come to the cell. */
static bool may_meet(const csg_tracer *tracer, const csg_ray_cell *cell, const bounds *all)
{
    for (int axis = 0; axis < 3; axis++) {
        const float *a = axis_of(tracer, axis);
        float middle = along(a, cell->center[0], cell->center[1], cell->center[2]);
        float reach = 1.001f * cell->half * (fabsf(a[0]) + fabsf(a[1]) + fabsf(a[2]));
        if (middle + reach < all->min[axis] || (axis < 2 && middle - reach > all->max[axis]))
            return false;
    }
    return true;
}

/* Packed rays in a cell; array by array, since what is written in pieces and read as a whole waits.
 */
typedef struct lanes {
    uint16_t from[CSG_RAYS_MOST]; /* in the origins */
    float t[CSG_RAYS_MOST], end[CSG_RAYS_MOST];
} lanes;

/* A cell to visit with the rays that enter its parent: list[first] .. list[first + count]. */
typedef struct visit {
    uint32_t cell, first, count;
} visit;

enum { LISTS = 12 * CSG_RAYS_MOST }; /* one a level of wide cells, and the first */

typedef struct shadow_room {
    lanes lanes;
    visit stack[STACK_MOST];
    uint16_t list[LISTS];
} shadow_room;

/* Without the calls that fminf and fmaxf are; of numbers alone. */
static inline float lesser(float a, float b)
{
    return a < b ? a : b;
}

static inline float greater(float a, float b)
{
    return a > b ? a : b;
}

/* Those of the visit's rays that enter the cell and are not dark yet: lanes, and a list behind the
 * visit's own, which nobody needs who is visited later. */
static uint32_t enter(const csg_tracer *tracer, const visit *v, const csg_rays *rays,
                      const csg_march *m, shadow_room *room)
{
    const csg_ray_cell *cell = &tracer->cells->cells[v->cell];
    const uint16_t *from = room->list + v->first;
    uint16_t *to = room->list + v->first + v->count;
    lanes *l = &room->lanes;
    uint32_t count = 0;
    float inverse[3], reach[3]; /* as csg_ray_in_cube, whose rays have directions of their own */
    for (int axis = 0; axis < 3; axis++) {
        float d = tracer->light[axis];
        inverse[axis] = fabsf(d) < 1e-18f ? 1e18f : 1 / d;
        reach[axis] = cell->half * (1 + CSG_RAY_CELL_OVERLAP) * fabsf(inverse[axis]);
    }
    for (uint32_t i = 0; i < v->count; i++) {
        uint16_t k = from[i];
        float x = (cell->center[0] - m->channel[0][k]) * inverse[0];
        float y = (cell->center[1] - m->channel[1][k]) * inverse[1];
        float z = (cell->center[2] - m->channel[2][k]) * inverse[2];
        float t = greater(greater(x - reach[0], y - reach[1]), greater(z - reach[2], 0));
        float end = lesser(lesser(x + reach[0], y + reach[1]), z + reach[2]);
        if (!(t <= end) || !(rays->lit[m->ray[k]] > 0))
            continue;
        l->t[count] = t;
        l->end[count] = end;
        l->from[count] = to[count] = k;
        count++;
    }
    return count;
}

static void march(const csg_tracer *tracer, const csg_tape *tape, csg_trace_room *room,
                  csg_march *m, lanes *l, uint32_t count)
{
    const float *light = tracer->light, reach = tracer->cells->reach;
    float *lit = room->rays.lit;
    uint64_t points = 0, primitives = 0;
    for (uint32_t i = 0; i < tape->count; i++)
        primitives += csg_op_is_leaf(tape->nodes[i].op);
    for (int step = 0; count && step < MOST_STEPS; step++) {
        for (uint32_t k = 0; k < count; k++) {
            uint32_t o = l->from[k];
            m->x[k] = m->channel[0][o] + l->t[k] * light[0];
            m->y[k] = m->channel[1][o] + l->t[k] * light[1];
            m->z[k] = m->channel[2][o] + l->t[k] * light[2];
        }
        for (uint32_t k = count; k % CSG_LANES; k++)
            m->x[k] = m->y[k] = m->z[k] = 0;
        tracer->kernel->values(tape, m->x, m->y, m->z, count, m->f, room->scratch,
                               room->scratch_floats);
        points += count;
        uint32_t kept = 0;
        for (uint32_t k = 0; k < count; k++) {
            uint16_t from = l->from[k], ray = m->ray[from];
            float height = -m->f[k] * room->rays.inverse_slope[ray], t = l->t[k], end = l->end[k];
            float width = LIGHT_SLOPE * t + 0.01f * reach;
            float most = lesser(reach, tracer->depth * room->rays.inverse_slope[ray]);
            float share = height / (width < most ? width : most);
            float *here = &lit[ray];
            *here = share < *here ? (share > 0 ? share : 0) : *here;
            /* half a sphere: whole ones would miss where the ratio is least, in streaks */
            t += height > 0.08f * reach ? 0.5f * height : 0.04f * reach;
            l->from[kept] = from;
            l->t[kept] = t;
            l->end[kept] = end;
            kept += *here > 0 && t < end;
        }
        count = kept;
    }
    room->counts.point_evaluations += points;
    room->counts.primitive_evaluations += points * primitives;
}

/* All cells of wide tapes that rays of the march enter. */
static void visit_cells(const csg_tracer *tracer, csg_trace_room *room, shadow_room *own,
                        const bounds *all)
{
    csg_march *m = &room->march;
    uint32_t top = 0;
    for (uint32_t k = 0; k < m->count; k++)
        own->list[k] = (uint16_t)k;
    own->stack[top++] = (visit){0, 0, m->count};
    while (top) {
        visit v = own->stack[--top];
        const csg_ray_cell *cell = &tracer->cells->cells[v.cell];
        if (!may_meet(tracer, cell, all))
            continue;
        uint32_t count = enter(tracer, &v, &room->rays, m, own);
        if (!count)
            continue;
        if (cell->wide == v.cell && v.cell) {
            csg_tape tape = tracer->field->tape;
            tape.nodes = cell->wide_nodes;
            tape.count = cell->wide_count;
            march(tracer, &tape, room, m, &own->lanes, count);
            continue;
        }
        for (int o = 0; o < CSG_OCTANTS; o++)
            if (cell->child[o])
                own->stack[top++] = (visit){cell->child[o], v.first + v.count, count};
    }
}

void csg_tracer_shade_light(const csg_tracer *tracer, csg_trace_room *room)
{
    csg_march *m = &room->march;
    shadow_room own;
    bounds all;
    begin_rays(tracer, room, m, &all);
    if (m->count)
        visit_cells(tracer, room, &own, &all);
    for (uint32_t k = 0; k < m->count; k++) {
        float *lit = &room->rays.lit[m->ray[k]];
        *lit = *lit * *lit * (3 - 2 * *lit);
    }
}
