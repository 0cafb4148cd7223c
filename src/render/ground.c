/* SPDX-License-Identifier: MIT
 * The shadow below a field; see ground.h. Where a ray that has hit nothing meets the ground, the
 * same is asked as on the solid: how much of the key light arrives (shadow.c), and how much of the
 * sky, within the reach of wide tapes (cells.h).
 */
#include "render/ground.h"

#include <string.h>

enum {
    BATCH = 36,           /* rays of a batch from below, along each side */
    MOST_BATCHES = 3,     /* along each side */
    NO_CELL = UINT32_MAX, /* of a point with nothing around it */
};

static const float KEY_SHARE = 0.6f; /* of the light on the ground; the rest is the sky's */
static const float DARKEST = 0.72f;
/* Bounds so near below what was seen, in largest sides, are those of the solid. */
static const double NEAR_BOUNDS = 0.002;

float csg_ground_darkness(const csgm_render_options *options, float lit, float open)
{
    float key = options->shadows ? 1 - lit : 0, sky = options->occlusion ? 1 - open : 0;
    return DARKEST * (KEY_SHARE * key + (1 - KEY_SHARE) * sky);
}

bool csg_ground_is_seen(const csgm_render_options *options, const csg_view *view, double z)
{
    if (!options->ground || !(options->shadows || options->occlusion))
        return false;
    return view->orthographic ? view->forward.z < 0 : view->eye.z > z;
}

/* ---- the lowest place ------------------------------------------------------------------------ */

/* From below, so that the box fills the picture. */
static csg_view view_from_below(csg_box box, uint32_t batches)
{
    csg_vec3 size = csg_box_size(box), middle = csg_box_center(box);
    double side = fmax(fmax(size.x, size.y), 1e-30), pixels = batches * BATCH;
    return (csg_view){.eye = {middle.x, middle.y, box.min.z - 0.01 * side},
                      .right = {1, 0, 0},
                      .up = {0, -1, 0},
                      .forward = {0, 0, 1},
                      .orthographic = true,
                      .pixel = side / pixels,
                      .width = pixels,
                      .height = pixels};
}

/* The least distance from the view's plane to the solid; INFINITY: none was hit. */
static float nearest_hit(const csg_tracer *below, uint32_t batches, csg_trace_room *room)
{
    csg_rays *rays = &room->rays;
    float nearest = INFINITY;
    for (uint32_t batch = 0; batch < batches * batches; batch++) {
        uint32_t x0 = batch % batches * BATCH, y0 = batch / batches * BATCH;
        csg_tracer_begin(rays, y0);
        for (uint32_t i = 0; i < BATCH * BATCH; i++)
            csg_tracer_aim(below, rays, x0 + i % BATCH + 0.5, y0 + i / BATCH + 0.5);
        csg_tracer_trace(below, room);
        for (uint32_t i = 0; i < rays->count; i++)
            nearest = fminf(nearest, rays->t[i]);
    }
    return nearest;
}

/* Few rays do where the bounds are those of the solid, as they often are; else more. */
static csgm_status find_lowest(const csg_picture *picture, const csg_tracer *tracer, csg_box box,
                               csg_trace_room *room, double *z)
{
    csgm_context *context = picture->context;
    size_t bytes = tracer->cells->count * sizeof(csg_pixel_rectangle);
    csg_pixel_rectangle *rectangles = csg_memory_alloc(&context->memory, bytes);
    if (!rectangles)
        return csg_context_no_memory(context);
    csg_tracer below = *tracer;
    below.tolerance_slope = 0;
    below.occlusion = below.shadows = below.colors = below.is_clear = false;
    below.rectangles = rectangles;
    csg_trace_counts counts = room->counts;
    double seen = INFINITY, near = box.min.z + NEAR_BOUNDS * csg_vec3_norm(csg_box_size(box));
    for (uint32_t batches = 1; batches <= MOST_BATCHES && !(seen <= near); batches++) {
        below.view = view_from_below(box, batches);
        csg_tracer_find_rectangles(&below, rectangles);
        seen = fmin(seen, below.view.eye.z + (double)nearest_hit(&below, batches, room));
    }
    room->counts = counts; /* they are of the picture's rays */
    csg_memory_release(&context->memory, rectangles, bytes);
    *z = seen <= near || !isfinite(seen) ? box.min.z : seen;
    return CSGM_OK;
}

csgm_status csg_ground_find(csg_ground *out, const csg_picture *picture, const csg_tracer *tracer,
                            csg_box box, csg_trace_room *room)
{
    double z = 0;
    csg_vec3 by = csg_vec3_scale(tracer->field->center, -1);
    csg_box moved = {csg_vec3_add(box.min, by), csg_vec3_add(box.max, by)};
    *out = (csg_ground){.options = picture->options};
    if (!csg_ground_is_seen(picture->options, &tracer->view, moved.min.z))
        return CSGM_OK;
    csgm_status status = find_lowest(picture, tracer, moved, room, &z);
    if (status != CSGM_OK)
        return status;
    out->is_shown = csg_ground_is_seen(picture->options, &tracer->view, z);
    out->z = (float)z;
    csg_vec3_to_floats(out->min, moved.min);
    csg_vec3_to_floats(out->max, moved.max);
    for (int axis = 0; axis < 3; axis++) {
        out->min[axis] -= tracer->cells->reach;
        out->max[axis] += tracer->cells->reach;
    }
    return CSGM_OK;
}

/* ---- points of the ground -------------------------------------------------------------------- */

static bool is_below(const csg_ground *ground, float x, float y)
{
    return x >= ground->min[0] && x <= ground->max[0] && y >= ground->min[1] && y <= ground->max[1];
}

/* Whether the way from a place of the ground to the light may meet the solid. */
static bool may_be_dark(const csg_ground *ground, const csg_tracer *tracer, float x, float y)
{
    if (is_below(ground, x, y))
        return true;
    const float from[2] = {x, y};
    float first = 0, last = INFINITY, rise = tracer->light[2];
    if (!(rise > 0) || !tracer->shadows)
        return false;
    last = (ground->max[2] - ground->z) / rise;
    for (int axis = 0; axis < 2; axis++) {
        float d = tracer->light[axis];
        if (d == 0 && (from[axis] < ground->min[axis] || from[axis] > ground->max[axis]))
            return false;
        if (d == 0)
            continue;
        float a = (ground->min[axis] - from[axis]) / d, b = (ground->max[axis] - from[axis]) / d;
        first = fmaxf(first, fminf(a, b));
        last = fminf(last, fmaxf(a, b));
    }
    return first <= last;
}

/* Where a ray meets the ground, if that may be dark there; INFINITY: it does not. */
static float meets_ground(const csg_ground *ground, const csg_tracer *tracer, const csg_rays *rays,
                          uint32_t i)
{
    float t = (ground->z - rays->oz[i]) * rays->iz[i];
    if (!(rays->dz[i] < 0) || !(t > 0) ||
        !may_be_dark(ground, tracer, rays->ox[i] + t * rays->dx[i], rays->oy[i] + t * rays->dy[i]))
        return INFINITY;
    return t;
}

/* The cell of wide tape that knows what is around a point, or NO_CELL. Points outside of all are
 * within the reach of the cell next to them or of none. */
static uint32_t wide_cell_at(const csg_ray_cells *cells, const float at[3])
{
    uint32_t index = 0;
    for (;;) {
        const csg_ray_cell *cell = &cells->cells[index];
        if (index && cell->wide == index)
            return index;
        unsigned octant = 0;
        for (int axis = 0; axis < 3; axis++)
            octant |= (unsigned)(at[axis] > cell->center[axis]) << axis;
        index = cell->child[octant];
        if (!index)
            return NO_CELL;
    }
}

/* The rays of one cell, taken out of the list: the march's points. */
static void take_points(const csg_tracer *tracer, csg_trace_room *room, uint32_t *cell_of)
{
    const csg_rays *rays = &room->rays;
    csg_march *m = &room->march;
    uint32_t cell = NO_CELL;
    m->count = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        if (cell_of[i] == NO_CELL || (cell != NO_CELL && cell_of[i] != cell))
            continue;
        uint32_t k = m->count++;
        cell = cell_of[i];
        cell_of[i] = NO_CELL;
        m->ray[k] = (uint16_t)i;
        m->x[k] = rays->ox[i] + rays->t[i] * rays->dx[i];
        m->y[k] = rays->oy[i] + rays->t[i] * rays->dy[i];
        m->z[k] = rays->oz[i] + rays->t[i] * rays->dz[i];
        m->radius[k] = tracer->steepest;
    }
    if (!m->count)
        return;
    csg_tape tape = tracer->field->tape;
    tape.nodes = tracer->cells->cells[cell].wide_nodes;
    tape.count = tracer->cells->cells[cell].wide_count;
    csg_tracer_shade_sky(tracer, &tape, room);
}

static void find_open(const csg_ground *ground, const csg_tracer *tracer, csg_trace_room *room)
{
    uint32_t cell_of[CSG_RAYS_MOST];
    const csg_rays *rays = &room->rays;
    for (uint32_t i = 0; i < rays->count; i++) {
        float at[3] = {rays->ox[i] + rays->t[i] * rays->dx[i],
                       rays->oy[i] + rays->t[i] * rays->dy[i], ground->z};
        bool is_near = rays->t[i] < INFINITY && is_below(ground, at[0], at[1]);
        cell_of[i] = is_near ? wide_cell_at(tracer->cells, at) : NO_CELL;
    }
    do
        take_points(tracer, room, cell_of);
    while (room->march.count);
}

/* Fills `ground` of the rays that meet it: those with a t. */
static void find_darkness(const csg_ground *ground, const csg_tracer *tracer, csg_trace_room *room)
{
    csg_rays *rays = &room->rays;
    uint32_t count = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        if (!(rays->t[i] < INFINITY))
            continue;
        rays->nx[i] = rays->ny[i] = 0;
        rays->nz[i] = 1;
        rays->inverse_slope[i] = 1 / tracer->steepest;
        rays->open[i] = rays->lit[i] = 1;
        rays->known_lit[i] = -1;
        count++;
    }
    if (!count)
        return;
    if (tracer->shadows && tracer->light[2] > 0)
        csg_tracer_shade_light(tracer, room);
    if (tracer->occlusion)
        find_open(ground, tracer, room);
    for (uint32_t i = 0; i < rays->count; i++)
        if (rays->t[i] < INFINITY)
            rays->ground[i] = csg_ground_darkness(ground->options, rays->lit[i], rays->open[i]);
}

/* ---- between nodes --------------------------------------------------------------------------- */

static const float UNKNOWN = -1, WANTED = -2;
/* By no more may the corners of a square differ in which the ground is mixed: a few hundredths, of
 * which the mixture is off by a part. */
static const float SMOOTH = 0.1f;

void csg_ground_begin(csg_ground_nodes *nodes, uint32_t x, uint32_t y)
{
    nodes->x = (float)x - CSG_GROUND_STEP;
    nodes->y = (float)y - CSG_GROUND_STEP;
    for (int i = 0; i < CSG_GROUND_NODES * CSG_GROUND_NODES; i++)
        nodes->darkness[i] = UNKNOWN;
}

/* The square that the ray is in: its first corner, and where in it. False: in none. */
static bool square_of(const csg_ground_nodes *nodes, const csg_rays *rays, uint32_t i,
                      uint32_t *corner, float within[2])
{
    const float from[2] = {(rays->px[i] - nodes->x) / CSG_GROUND_STEP,
                           (rays->py[i] - nodes->y) / CSG_GROUND_STEP};
    *corner = 0;
    for (int axis = 0; axis < 2; axis++) {
        if (!(from[axis] >= 0 && from[axis] < CSG_GROUND_NODES - 1))
            return false;
        uint32_t whole = (uint32_t)from[axis];
        *corner += whole * (axis ? CSG_GROUND_NODES : 1);
        within[axis] = from[axis] - (float)whole;
    }
    return true;
}

/* Their rays are appended to the batch's, which have no t meanwhile. */
static void trace_nodes(const csg_ground *ground, const csg_tracer *tracer, csg_trace_room *room,
                        csg_ground_nodes *nodes)
{
    csg_rays *rays = &room->rays;
    uint32_t own = rays->count;
    for (uint32_t i = 0; i < CSG_GROUND_NODES * CSG_GROUND_NODES; i++) {
        if (nodes->darkness[i] != WANTED)
            continue;
        uint32_t ray = rays->count;
        csg_tracer_direct(tracer, rays, ray,
                          (double)nodes->x + i % CSG_GROUND_NODES * CSG_GROUND_STEP,
                          (double)nodes->y + i / CSG_GROUND_NODES * CSG_GROUND_STEP);
        rays->t[ray] = meets_ground(ground, tracer, rays, ray);
        rays->ground[ray] = rays->dz[ray] < 0 ? 0 : UNKNOWN; /* where no shadow falls, or beyond */
        rays->count++;
    }
    find_darkness(ground, tracer, room);
    uint32_t ray = own;
    for (uint32_t i = 0; i < CSG_GROUND_NODES * CSG_GROUND_NODES; i++)
        if (nodes->darkness[i] == WANTED)
            nodes->darkness[i] = rays->ground[ray++];
    rays->count = own;
}

/* Of a square whose corners are known and nearly the same. */
static bool mix_corners(const csg_ground_nodes *nodes, const csg_rays *rays, uint32_t i, float *out)
{
    uint32_t corner;
    float within[2], least = INFINITY, most = -INFINITY, rows[2];
    if (!square_of(nodes, rays, i, &corner, within))
        return false;
    for (uint32_t k = 0; k < 2; k++) {
        const float *at = nodes->darkness + corner + k * CSG_GROUND_NODES;
        least = fminf(least, fminf(at[0], at[1]));
        most = fmaxf(most, fmaxf(at[0], at[1]));
        rows[k] = at[0] + within[0] * (at[1] - at[0]);
    }
    *out = rows[0] + within[1] * (rows[1] - rows[0]);
    return least >= 0 && most - least <= SMOOTH;
}

static void want_nodes(csg_ground_nodes *nodes, const csg_rays *rays, const float *meets)
{
    for (uint32_t i = 0; i < rays->count; i++) {
        uint32_t corner;
        float within[2];
        if (!(meets[i] < INFINITY) || !square_of(nodes, rays, i, &corner, within))
            continue;
        nodes->darkness[corner] = nodes->darkness[corner + 1] = WANTED;
        nodes->darkness[corner + CSG_GROUND_NODES] = WANTED;
        nodes->darkness[corner + CSG_GROUND_NODES + 1] = WANTED;
    }
}

/* Rays that have hit something are set aside, those that meet the ground hit that. */
void csg_ground_trace(const csg_ground *ground, const csg_tracer *tracer, csg_trace_room *room,
                      csg_ground_nodes *nodes, bool is_tile)
{
    csg_rays *rays = &room->rays;
    float t[CSG_RAYS_MOST], slope[CSG_RAYS_MOST], meets[CSG_RAYS_MOST];
    memset(rays->ground, 0, rays->count * sizeof *rays->ground);
    if (!ground->is_shown)
        return;
    memcpy(t, rays->t, rays->count * sizeof *t);
    memcpy(slope, rays->inverse_slope, rays->count * sizeof *slope);
    for (uint32_t i = 0; i < rays->count; i++) {
        meets[i] = t[i] < INFINITY ? INFINITY : meets_ground(ground, tracer, rays, i);
        rays->t[i] = INFINITY;
    }
    if (is_tile) {
        want_nodes(nodes, rays, meets);
        trace_nodes(ground, tracer, room, nodes);
    }
    for (uint32_t i = 0; i < rays->count; i++)
        if (meets[i] < INFINITY && !mix_corners(nodes, rays, i, &rays->ground[i])) {
            rays->ground[i] = 0;
            rays->t[i] = meets[i];
        }
    find_darkness(ground, tracer, room);
    memcpy(rays->t, t, rays->count * sizeof *t);
    memcpy(rays->inverse_slope, slope, rays->count * sizeof *slope);
}
