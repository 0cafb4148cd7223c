/* SPDX-License-Identifier: MIT
 * Primary rays; see tracer.h. Over-relaxed sphere tracing (Keinert et al. 2014): steps are 1.6
 * times as long as the unbounding sphere allows, and taken back where the spheres of two steps do
 * not touch. A step never leaves the cell, whose tape is of no use outside.
 */
#include "render/tracer.h"

enum {
    MOST_STEPS = 512, /* in one cell; each is at least the tolerance, so that few come near it */
    STACK_MOST = 8 * 24,
    OCCLUSION_SAMPLES = 5
};

static const float RELAXATION = 1.6f;
static const float CREEP = 8; /* tolerances, of which a pixel has 25 */

/* Directions parallel to a face: far away but finite, so that nothing becomes NaN. */
static float inverse_of(float d)
{
    return fabsf(d) < 1e-18f ? (d < 0 ? -1e18f : 1e18f) : 1 / d;
}

void csg_tracer_begin(csg_rays *rays, uint32_t first_row)
{
    rays->count = rays->row_count = 0;
    rays->first_row = first_row;
    rays->row[0] = 0;
}

void csg_tracer_direct(const csg_tracer *tracer, csg_rays *rays, uint32_t ray, double x, double y)
{
    csg_vec3 origin, direction;
    csg_view_ray(&tracer->view, x, y, &origin, &direction);
    rays->known_lit[ray] = -1;
    rays->px[ray] = (float)x;
    rays->py[ray] = (float)y;
    rays->ox[ray] = (float)origin.x;
    rays->oy[ray] = (float)origin.y;
    rays->oz[ray] = (float)origin.z;
    rays->dx[ray] = (float)direction.x;
    rays->dy[ray] = (float)direction.y;
    rays->dz[ray] = (float)direction.z;
    rays->ix[ray] = inverse_of(rays->dx[ray]);
    rays->iy[ray] = inverse_of(rays->dy[ray]);
    rays->iz[ray] = inverse_of(rays->dz[ray]);
}

void csg_tracer_aim(const csg_tracer *tracer, csg_rays *rays, double x, double y)
{
    uint32_t ray = rays->count++, row = (uint32_t)y - rays->first_row;
    while (rays->row_count <= row)
        rays->row[++rays->row_count] = (uint16_t)ray;
    rays->row[rays->row_count] = (uint16_t)rays->count;
    rays->from[ray] = 0;
    rays->is_within[ray] = false;
    csg_tracer_direct(tracer, rays, ray, x, y);
}

/* ---- cells in the picture ------------------------------------------------------------------- */

static csg_pixel_rectangle rectangle_of(const csg_view *view, const csg_ray_cell *cell)
{
    csg_pixel_rectangle r = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    const float margin = 0.25f; /* of a pixel: rounding, and the overlap of cells */
    for (int corner = 0; corner < 8; corner++) {
        double p[3];
        for (int axis = 0; axis < 3; axis++)
            p[axis] = (double)cell->center[axis] +
                      (corner >> axis & 1 ? 1.001 : -1.001) * (double)cell->half;
        csg_vec3 at = csg_view_project(view, csg_vec3_make(p[0], p[1], p[2]));
        if (!view->orthographic && at.z <= 1e-3 * (double)cell->half)
            return (csg_pixel_rectangle){-INFINITY, -INFINITY, INFINITY, INFINITY};
        r.min_x = fminf(r.min_x, (float)at.x - margin);
        r.min_y = fminf(r.min_y, (float)at.y - margin);
        r.max_x = fmaxf(r.max_x, (float)at.x + margin);
        r.max_y = fmaxf(r.max_y, (float)at.y + margin);
    }
    return r;
}

void csg_tracer_find_rectangles(const csg_tracer *tracer, csg_pixel_rectangle *out)
{
    for (size_t i = 0; i < tracer->cells->count; i++)
        out[i] = rectangle_of(&tracer->view, &tracer->cells->cells[i]);
}

static csg_pixel_rectangle rectangle_of_rays(const csg_rays *rays)
{
    csg_pixel_rectangle r = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < rays->count; i++) {
        r.min_x = fminf(r.min_x, rays->px[i]);
        r.min_y = fminf(r.min_y, rays->py[i]);
        r.max_x = fmaxf(r.max_x, rays->px[i]);
        r.max_y = fmaxf(r.max_y, rays->py[i]);
    }
    return r;
}

static bool overlap(const csg_pixel_rectangle *a, const csg_pixel_rectangle *b)
{
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y &&
           b->min_y <= a->max_y;
}

/* ---- one cell -------------------------------------------------------------------------------- */

static csg_tape tape_of(const csg_tracer *tracer, const csg_tape_node *nodes, uint32_t count)
{
    csg_tape tape = tracer->field->tape;
    tape.nodes = nodes;
    tape.count = count;
    return tape;
}

/* Rays of the rows that the cell's rectangle touches: [*first, *end). */
static void rays_of(const csg_rays *rays, const csg_pixel_rectangle *in, uint32_t *first,
                    uint32_t *end)
{
    float low = floorf(in->min_y) - (float)rays->first_row;
    float high = floorf(in->max_y) - (float)rays->first_row + 1;
    uint32_t row = low > 0 ? (uint32_t)fminf(low, CSG_RAYS_ROWS) : 0;
    uint32_t last = high > 0 ? (uint32_t)fminf(high, CSG_RAYS_ROWS) : 0;
    row = row < rays->row_count ? row : rays->row_count;
    last = last < rays->row_count ? last : rays->row_count;
    *first = rays->row[row];
    *end = rays->row[last];
}

static void enter(const csg_ray_cell *cell, const csg_pixel_rectangle *in, csg_trace_room *room)
{
    const csg_rays *rays = &room->rays;
    csg_march *m = &room->march;
    uint32_t first, end;
    m->count = m->hit_count = 0;
    rays_of(rays, in, &first, &end);
    for (uint32_t i = first; i < end; i++) {
        if (rays->t[i] < INFINITY || rays->px[i] < in->min_x || rays->px[i] > in->max_x)
            continue;
        const float o[3] = {rays->ox[i], rays->oy[i], rays->oz[i]};
        const float inverse[3] = {rays->ix[i], rays->iy[i], rays->iz[i]};
        uint32_t k = m->count;
        if (!csg_ray_in_cube(o, inverse, cell->center, cell->half, &m->begin[k], &m->end[k]) ||
            !(rays->from[i] <= m->end[k]))
            continue;
        m->begin[k] = m->begin[k] > rays->from[i] ? m->begin[k] : rays->from[i];
        m->ray[k] = (uint16_t)i;
        m->t[k] = m->begin[k];
        m->radius[k] = m->step[k] = 0;
        m->count++;
    }
}

static void place_points(const csg_rays *rays, csg_march *m)
{
    for (uint32_t k = 0; k < m->count; k++) {
        uint32_t i = m->ray[k];
        m->x[k] = rays->ox[i] + m->t[k] * rays->dx[i];
        m->y[k] = rays->oy[i] + m->t[k] * rays->dy[i];
        m->z[k] = rays->oz[i] + m->t[k] * rays->dz[i];
    }
    for (uint32_t k = m->count; k % CSG_LANES; k++)
        m->x[k] = m->y[k] = m->z[k] = 0;
}

/* Takes ray k one step further. False: it is through, or has hit (then *hit). Where lambda is far
 * above the slope, |f| / lambda is near 0 long before the surface: a ray that close creeps on, a
 * third of a pixel at a time, until the sign changes. */
static bool advance(const csg_tracer *tracer, csg_march *m, uint32_t k, bool *hit)
{
    float t = m->t[k], radius = fabsf(m->f[k]) * tracer->inverse_lipschitz;
    float tolerance = tracer->near_tolerance + tracer->tolerance_slope * t;
    bool has_crept = tracer->is_loose && m->step[k] > 0 && m->radius[k] < tolerance;
    *hit = false;
    if (!has_crept && m->step[k] > m->radius[k] && radius + m->radius[k] < m->step[k]) {
        m->t[k] = t - (m->step[k] - m->radius[k]);
        m->step[k] = m->radius[k] = 0; /* and no relaxed step before the next sphere is known */
        return true;
    }
    if (m->f[k] >= 0 || (radius < tolerance && !tracer->is_loose)) {
        float sum = radius + m->radius[k];
        float back = has_crept && sum > 0 ? m->step[k] * (radius / sum) : radius;
        float at = m->f[k] >= 0 ? t - back : t + radius;
        m->t[k] = at > m->begin[k] ? at : m->begin[k];
        *hit = true;
        return false;
    }
    if (t + radius >= m->end[k])
        return false;
    float next = t + (radius < tolerance ? CREEP * tolerance : RELAXATION * radius);
    next = next < m->end[k] ? next : m->end[k];
    m->step[k] = next - t;
    m->radius[k] = radius;
    m->t[k] = next;
    return true;
}

/* The same of a ray that began within the solid: it goes on until it is out, and too far from what
 * it has left to hit that. */
static bool leave(const csg_tracer *tracer, csg_march *m, uint32_t k, bool *is_within)
{
    float radius = fabsf(m->f[k]) * tracer->inverse_lipschitz;
    float tolerance = tracer->near_tolerance + tracer->tolerance_slope * m->t[k];
    *is_within = m->f[k] >= 0 || (radius < 2 * tolerance && !tracer->is_loose);
    m->t[k] += *is_within ? fmaxf(radius, tolerance) : 0;
    m->radius[k] = m->step[k] = 0;
    return m->t[k] < m->end[k];
}

static void march(const csg_tracer *tracer, const csg_tape *tape, csg_trace_room *room)
{
    csg_march *m = &room->march;
    csg_rays *rays = &room->rays;
    uint64_t points = 0;
    for (int step = 0; m->count && step < MOST_STEPS; step++) {
        place_points(rays, m);
        tracer->kernel->values(tape, m->x, m->y, m->z, m->count, m->f, room->scratch,
                               room->scratch_floats);
        points += m->count;
        uint32_t kept = 0;
        for (uint32_t k = 0; k < m->count; k++) {
            bool hit = false, *is_within = &rays->is_within[m->ray[k]];
            if (*is_within ? !leave(tracer, m, k, is_within) : !advance(tracer, m, k, &hit)) {
                if (!hit)
                    continue;
                rays->t[m->ray[k]] = m->t[k];
                m->hit[m->hit_count++] = m->ray[k];
                continue;
            }
            m->ray[kept] = m->ray[k];
            m->t[kept] = m->t[k];
            m->begin[kept] = m->begin[k];
            m->end[kept] = m->end[k];
            m->radius[kept] = m->radius[k];
            m->step[kept] = m->step[k];
            kept++;
        }
        m->count = kept;
    }
    room->counts.point_evaluations += points;
    room->counts.primitive_evaluations += points * csg_tape_leaf_count(tape);
}

/* ---- what is there --------------------------------------------------------------------------- */

/* The march's points become those that were hit in the cell. */
static void place_hits(const csg_rays *rays, csg_march *m)
{
    m->count = m->hit_count;
    for (uint32_t k = 0; k < m->count; k++) {
        m->ray[k] = m->hit[k];
        m->t[k] = rays->t[m->hit[k]];
    }
    place_points(rays, m);
}

/* What is as steep as lambda allows has lambda's inverse to the bit; next to flat is a crease or a
 * tip, which says nothing of the field around it. */
static float inverse_slope_of(const csg_tracer *tracer, float slope)
{
    if (slope * tracer->inverse_lipschitz > 0.9f)
        return tracer->inverse_lipschitz;
    return 1 / fmaxf(slope, 0.25f * tracer->steepest);
}

static void find_normals(const csg_tracer *tracer, const csg_tape *tape, csg_trace_room *room)
{
    csg_march *m = &room->march;
    csg_rays *rays = &room->rays;
    tracer->kernel->gradients(tape, m->x, m->y, m->z, m->count, m->channel[0], m->channel[1],
                              m->channel[2], room->scratch, room->scratch_floats);
    for (uint32_t k = 0; k < m->count; k++) {
        uint32_t i = m->ray[k];
        float x = m->channel[0][k], y = m->channel[1][k], z = m->channel[2][k];
        float length = sqrtf(x * x + y * y + z * z);
        bool is_known = length > 0 && length < INFINITY; /* else: as if it faced the eye */
        rays->nx[i] = is_known ? -x / length : -rays->dx[i];
        rays->ny[i] = is_known ? -y / length : -rays->dy[i];
        rays->nz[i] = is_known ? -z / length : -rays->dz[i];
        m->radius[k] = is_known ? length : 1; /* the field's slope, for occlusion */
        rays->inverse_slope[i] = inverse_slope_of(tracer, is_known ? length : 0);
    }
}

static void find_colors(const csg_tracer *tracer, const csg_tape *tape, csg_trace_room *room)
{
    csg_march *m = &room->march;
    csg_rays *rays = &room->rays;
    float *const out[4] = {m->channel[0], m->channel[1], m->channel[2], m->channel[3]};
    csg_tape shaded = *tape;
    shaded.colors = tracer->field->materials;
    if (tracer->colors)
        tracer->kernel->colors(tape, m->x, m->y, m->z, m->count, out, room->scratch,
                               room->scratch_floats);
    for (uint32_t k = 0; k < m->count; k++) {
        uint32_t i = m->ray[k];
        rays->r[i] = tracer->colors ? out[0][k] : 0.76f;
        rays->g[i] = tracer->colors ? out[1][k] : 0.76f;
        rays->b[i] = tracer->colors ? out[2][k] : 0.74f;
        rays->alpha[i] = tracer->is_clear ? out[3][k] : 1;
    }
    if (shaded.colors)
        tracer->kernel->colors(&shaded, m->x, m->y, m->z, m->count, out, room->scratch,
                               room->scratch_floats);
    for (uint32_t k = 0; k < m->count; k++) {
        uint32_t i = m->ray[k];
        rays->metallic[i] = shaded.colors ? out[0][k] : csg_default_material.r;
        rays->roughness[i] = shaded.colors ? out[1][k] : csg_default_material.g;
    }
}

/* How far from the surface the field falls about as fast as at it: bounded fields end smoothly, at
 * twice this. */
static float occlusion_reach(const csg_tracer *tracer, float slope)
{
    return fminf(tracer->cells->reach, 0.5f * tracer->depth / slope);
}

/* Along the normal the field falls as on a plane unless something is near: how much less it has
 * fallen, at a few distances up to the reach of wide tapes. */
void csg_tracer_shade_sky(const csg_tracer *tracer, const csg_tape *tape, csg_trace_room *room)
{
    static const float places[OCCLUSION_SAMPLES] = {0.1f, 0.25f, 0.45f, 0.7f, 0.98f};
    static const float weights[OCCLUSION_SAMPLES] = {0.35f, 0.3f, 0.25f, 0.2f, 0.15f};
    csg_march *m = &room->march;
    csg_rays *rays = &room->rays;
    for (uint32_t k = 0; k < m->count; k++)
        m->step[k] = 0;
    for (int s = 0; s < OCCLUSION_SAMPLES; s++) {
        for (uint32_t k = 0; k < m->count; k++) {
            uint32_t i = m->ray[k];
            float height = places[s] * occlusion_reach(tracer, m->radius[k]);
            m->channel[0][k] = m->x[k] + height * rays->nx[i];
            m->channel[1][k] = m->y[k] + height * rays->ny[i];
            m->channel[2][k] = m->z[k] + height * rays->nz[i];
        }
        for (uint32_t k = m->count; k % CSG_LANES; k++)
            m->channel[0][k] = m->channel[1][k] = m->channel[2][k] = 0;
        tracer->kernel->values(tape, m->channel[0], m->channel[1], m->channel[2], m->count, m->f,
                               room->scratch, room->scratch_floats);
        for (uint32_t k = 0; k < m->count; k++) {
            float height = places[s] * occlusion_reach(tracer, m->radius[k]);
            float missing = 1 + m->f[k] / (m->radius[k] * height);
            missing = missing > 0 ? missing : 0;
            m->step[k] += weights[s] * (missing < 1 ? missing : 1);
        }
    }
    for (uint32_t k = 0; k < m->count; k++)
        rays->open[m->ray[k]] = m->step[k] < 1 ? 1 - m->step[k] : 0;
    room->counts.point_evaluations += (uint64_t)m->count * OCCLUSION_SAMPLES;
    room->counts.primitive_evaluations +=
        (uint64_t)m->count * OCCLUSION_SAMPLES * csg_tape_leaf_count(tape);
}

static void look_at_hits(const csg_tracer *tracer, const csg_ray_cell *cell, const csg_tape *tape,
                         csg_trace_room *room)
{
    csg_march *m = &room->march;
    place_hits(&room->rays, m);
    find_normals(tracer, tape, room);
    if (tracer->occlusion) {
        const csg_ray_cell *wide = &tracer->cells->cells[cell->wide];
        csg_tape wide_tape = tape_of(tracer, wide->wide_nodes, wide->wide_count);
        csg_tracer_shade_sky(tracer, &wide_tape, room);
    }
    find_colors(tracer, tape, room);
    uint64_t looks = 1u + tracer->colors + (tracer->field->materials != NULL);
    room->counts.hits += m->count;
    room->counts.gradient_evaluations += m->count;
    room->counts.primitive_evaluations += looks * m->count * csg_tape_leaf_count(tape);
}

static void trace_cell(const csg_tracer *tracer, uint32_t index, csg_trace_room *room)
{
    const csg_ray_cell *cell = &tracer->cells->cells[index];
    enter(cell, &tracer->rectangles[index], room);
    if (!room->march.count)
        return;
    csg_tape tape = tape_of(tracer, cell->near_nodes, cell->near_count);
    march(tracer, &tape, room);
    if (room->march.hit_count)
        look_at_hits(tracer, cell, &tape, room);
}

float csg_tracer_slack(const csg_tracer *tracer, const csg_rays *rays, uint32_t i)
{
    const float tolerances = 10, flattest = 0.05f;
    float cosine =
        fabsf(rays->dx[i] * rays->nx[i] + rays->dy[i] * rays->ny[i] + rays->dz[i] * rays->nz[i]);
    float tolerance = tracer->near_tolerance + tracer->tolerance_slope * rays->t[i];
    return tolerances * tolerance / fmaxf(cosine, flattest);
}

/* ---- all cells, from the front to the back --------------------------------------------------- */

/* The octant that rays meet first. */
static unsigned nearest_octant(const csg_view *view, const csg_ray_cell *cell)
{
    const double eye[3] = {view->eye.x, view->eye.y, view->eye.z};
    const double forward[3] = {view->forward.x, view->forward.y, view->forward.z};
    unsigned octant = 0;
    for (int axis = 0; axis < 3; axis++) {
        bool upper =
            view->orthographic ? forward[axis] < 0 : eye[axis] > (double)cell->center[axis];
        octant |= (unsigned)upper << axis;
    }
    return octant;
}

void csg_tracer_trace(const csg_tracer *tracer, csg_trace_room *room)
{
    csg_rays *rays = &room->rays;
    const csg_ray_cell *cells = tracer->cells->cells;
    csg_pixel_rectangle all = rectangle_of_rays(rays);
    uint32_t stack[STACK_MOST], top = 0;
    uint64_t hits = room->counts.hits;
    for (uint32_t i = 0; i < rays->count; i++) {
        rays->t[i] = INFINITY;
        rays->open[i] = rays->lit[i] = 1;
    }
    room->counts.rays += rays->count;
    stack[top++] = 0;
    while (top && room->counts.hits - hits < rays->count) {
        uint32_t index = stack[--top];
        const csg_ray_cell *cell = &cells[index];
        if (!cell->has_surface || !overlap(&tracer->rectangles[index], &all))
            continue;
        if (cell->is_leaf) {
            trace_cell(tracer, index, room);
            continue;
        }
        /* numbers of octants with their bits turned so that 0 is the nearest: any octant that
         * hides another has the smaller one */
        unsigned nearest = nearest_octant(&tracer->view, cell);
        for (unsigned k = CSG_OCTANTS; k-- > 0;)
            if (cell->child[k ^ nearest])
                stack[top++] = cell->child[k ^ nearest];
    }
    if (tracer->shadows)
        csg_tracer_shade_light(tracer, room);
}
