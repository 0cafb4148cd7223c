/* SPDX-License-Identifier: MIT
 * Sweeps as polyhedra: rings of the figure's points at each step, belts of triangles between them,
 * the figure itself as a lid at both ends. What lies on one place is welded later
 * (shape/polyhedra/polyhedron.h), so points on the axis and apexes need no care.
 */
#include "solid/sweeps.h"

#include <math.h>

#include "base/elementary.h"
#include "shape/plane/polygons.h"
#include "solid/facets.h"
#include "solid/measure.h"

enum { POINT_STEPS = 400 }; /* a point costs its triangles, their mending and their tree */

typedef struct sweeping {
    csg_outline outline; /* of the figure, clean */
    csg_triangles triangles;
    bool ok;
} sweeping;

static void begin_sweep(sweeping *w, csg_solid_job *job)
{
    csg_memory *memory = job->memory;
    csg_outline_init(&w->outline, memory);
    csg_triangles_init(&w->triangles, memory);
    w->ok = true;
}

/* The quadrangle between two points of one ring and the same of the next, outward when the loop
 * runs counter-clockwise and the rings go up. `first`: the diagonal from (0, a) to (1, b). */
static void add_quad(sweeping *w, uint32_t below, uint32_t above, uint32_t a, uint32_t b,
                     bool first)
{
    csg_triangles *t = &w->triangles;
    if (first)
        w->ok = w->ok && csg_triangles_add(t, below + a, below + b, above + b) &&
                csg_triangles_add(t, below + a, above + b, above + a);
    else
        w->ok = w->ok && csg_triangles_add(t, below + a, below + b, above + a) &&
                csg_triangles_add(t, above + a, below + b, above + b);
}

/* Is the diagonal from (below, a) to (above, b) the shorter one, seen from above? `otherwise` where
 * both are as long. OpenSCAD cuts so. */
static bool is_first_shorter(const csg_triangles *t, const uint32_t c[4], bool otherwise)
{
    const double alike = 1e-5;
    csg_vec3 first = csg_vec3_sub(t->points[c[0]], t->points[c[2]]);
    csg_vec3 second = csg_vec3_sub(t->points[c[1]], t->points[c[3]]);
    double p = csg_hypot(first.x, first.y), q = csg_hypot(second.x, second.y);
    return fabs(p - q) <= alike * (p + q) ? otherwise : p < q;
}

static void add_belts(sweeping *w, uint32_t below, uint32_t above, bool diagonal)
{
    for (size_t loop = 0; loop < w->outline.loop_count && w->ok; loop++) {
        uint32_t start = (uint32_t)csg_outline_first(&w->outline, loop);
        uint32_t end = w->outline.ends[loop];
        for (uint32_t i = start; i < end && w->ok; i++) {
            uint32_t next = i + 1 < end ? i + 1 : start;
            const uint32_t corners[4] = {below + i, below + next, above + next, above + i};
            add_quad(w, below, above, i, next, is_first_shorter(&w->triangles, corners, diagonal));
        }
    }
}

static csgm_status add_lid(sweeping *w, csg_solid_job *job, uint32_t ring, bool up)
{
    csg_memory *memory = job->memory;
    uint32_t *indices = NULL;
    size_t count = 0;
    csgm_status status = csg_polygons_triangulate(&w->outline, memory, &indices, &count);
    for (size_t i = 0; i + 2 < count && status == CSGM_OK && w->ok; i += 3)
        w->ok =
            csg_triangles_add(&w->triangles, ring + indices[i], ring + indices[i + (up ? 1 : 2)],
                              ring + indices[i + (up ? 2 : 1)]);
    csg_memory_release(memory, indices, count * sizeof *indices);
    return status;
}

static csg_node_id close_sweep(sweeping *w, csg_solid_job *job, csgm_status status)
{
    csg_outline_release(&w->outline);
    if (w->ok && status == CSGM_OK && !job->stop)
        return csg_solid_of_triangles(job, &w->triangles, NULL);
    csg_triangles_release(&w->triangles);
    return csg_solid_failed(job, w->ok ? status : CSGM_ERR_MEMORY, "make this extrusion");
}

/* ---- up -------------------------------------------------------------------------------------- */

/* Divides edges longer than `longest`. */
static bool divide_edges(csg_outline *outline, double longest)
{
    csg_outline fine;
    csg_outline_init(&fine, outline->memory);
    bool ok = true;
    for (size_t loop = 0; loop < outline->loop_count && ok; loop++) {
        size_t start = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = start; i < end && ok; i++) {
            csg_vec2 a = outline->points[i], b = outline->points[i + 1 < end ? i + 1 : start];
            uint32_t parts = (uint32_t)ceil(csg_hypot(b.x - a.x, b.y - a.y) / longest);
            for (uint32_t k = 0; k < parts && ok; k++)
                ok = csg_outline_add(&fine, (csg_vec2){a.x + (b.x - a.x) * k / parts,
                                                       a.y + (b.y - a.y) * k / parts});
        }
        ok = ok && csg_outline_close(&fine);
    }
    csg_outline_release(outline);
    *outline = fine;
    return ok;
}

static void add_level(sweeping *w, const csg_sweep *sweep, double at)
{
    /* A scale of 0 along one axis would leave a blade of no thickness, which no lid closes. */
    const double thinnest = 1e-6;
    double scale[2], turn = -sweep->twist * at;
    bool apex = sweep->scale[0] == 0 && sweep->scale[1] == 0 && at == 1;
    for (int i = 0; i < 2; i++)
        scale[i] = apex ? 0 : fmax(1 + (sweep->scale[i] - 1) * at, thinnest);
    double c = csg_cosine_deg(turn), s = csg_sine_deg(turn);
    for (size_t i = 0; i < w->outline.point_count && w->ok; i++) {
        csg_vec2 p = w->outline.points[i];
        w->ok = csg_triangles_add_point(&w->triangles, csg_vec3_make(scale[0] * (c * p.x - s * p.y),
                                                                     scale[1] * (s * p.x + c * p.y),
                                                                     sweep->height * at));
    }
}

static uint32_t slice_count(const csg_sweep *sweep)
{
    const double smooth_deg = 1.5, most = 20000;
    if (sweep->slices)
        return sweep->slices;
    return sweep->twist == 0 ? 1 : (uint32_t)fmin(ceil(fabs(sweep->twist) / smooth_deg) + 1, most);
}

csg_node_id csg_sweep_up(csg_solid_job *job, csg_node_id flat, const csg_sweep *sweep)
{
    sweeping w;
    begin_sweep(&w, job);
    csgm_status status = csg_flat_outline(job, flat, &w.outline);
    csg_sweep used = *sweep;
    if (sweep->smooth)
        used.slices = 0; /* what is smooth has as many as it needs */
    uint32_t slices = slice_count(&used), points;
    if (status == CSGM_OK && sweep->smooth && sweep->twist != 0) {
        csg_vec3 size = csg_box_size(csg_outline_box(&w.outline));
        w.ok = divide_edges(&w.outline, fmax(size.x, size.y) / 24);
    }
    points = (uint32_t)w.outline.point_count;
    if (!csg_solid_charge(job, (uint64_t)points * slices * POINT_STEPS))
        status = CSGM_ERR_MEMORY;
    for (uint32_t i = 0; i <= slices && status == CSGM_OK && w.ok; i++) {
        add_level(&w, sweep, (double)i / slices);
        if (i > 0)
            add_belts(&w, (i - 1) * points, i * points, sweep->twist > 0);
    }
    if (status == CSGM_OK)
        status = add_lid(&w, job, 0, false);
    if (status == CSGM_OK && !(sweep->scale[0] == 0 && sweep->scale[1] == 0))
        status = add_lid(&w, job, slices * points, true);
    return close_sweep(&w, job, status);
}

/* ---- around ---------------------------------------------------------------------------------- */

static void add_meridian(sweeping *w, double angle)
{
    double c = csg_cosine_deg(angle), s = csg_sine_deg(angle);
    for (size_t i = 0; i < w->outline.point_count && w->ok; i++) {
        csg_vec2 p = w->outline.points[i];
        w->ok = csg_triangles_add_point(&w->triangles, csg_vec3_make(p.x * c, p.x * s, p.y));
    }
}

csg_node_id csg_sweep_around(csg_solid_job *job, csg_outline *outline, double angle, double start,
                             uint32_t steps)
{
    sweeping w;
    csgm_status status = CSGM_OK;
    begin_sweep(&w, job);
    w.outline = *outline;
    csg_outline_init(outline, w.outline.memory);
    uint32_t points = (uint32_t)w.outline.point_count;
    bool whole = fabs(angle) >= 360;
    if (!csg_solid_charge(job, (uint64_t)points * steps * POINT_STEPS))
        status = CSGM_ERR_MEMORY;
    for (uint32_t i = 0; i < steps + !whole && w.ok && status == CSGM_OK; i++) {
        add_meridian(&w, start + angle * i / steps);
        if (i > 0)
            add_belts(&w, i * points, (i - 1) * points, true);
    }
    if (whole && status == CSGM_OK)
        add_belts(&w, 0, (steps - 1) * points, true);
    if (!whole && status == CSGM_OK)
        status = add_lid(&w, job, 0, true);
    if (!whole && status == CSGM_OK)
        status = add_lid(&w, job, steps * points, false);
    return close_sweep(&w, job, status);
}
