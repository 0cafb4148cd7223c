/* SPDX-License-Identifier: MIT
 * tube, spline, sheet, patch and sweep: points, radii and what is wrong with a path (solid/tubes.c,
 * path.c and along.c have the rest).
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "solid/along.h"
#include "solid/operations.h"

/* ---- points ---------------------------------------------------------------------------------- */

/* How many points are in the list; 0 after a report that there are too few. */
static uint32_t count_points(csg_module_call *call, uint32_t index, uint32_t least)
{
    csg_value value = call->values[index];
    uint32_t count = value.kind == CSG_VALUE_VECTOR ? value.as.vector->count : 0;
    if (count >= least)
        return count;
    csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "%s must be a list of at least %s [x, y, z]",
                       call->parameters[index].name, least == 2 ? "two" : "three");
    return 0;
}

/* [x, y, z], or [x, y] with z = 0. */
static bool is_point(csg_value value, csg_vec3 *out)
{
    double v[3] = {0, 0, 0};
    bool known = csg_value_numbers(value, 3, v) || csg_value_numbers(value, 2, v);
    *out = csg_vec3_make(v[0], v[1], v[2]);
    return known && isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* Point i of a list; reports what is none. */
static csg_vec3 read_point(csg_module_call *call, uint32_t index, uint32_t i)
{
    csg_vec3 point;
    if (!is_point(call->values[index].as.vector->items[i], &point))
        csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "%s[%u] is not [x, y, z]",
                           call->parameters[index].name, i);
    return point;
}

/* All of them; NULL after a report. */
static csg_vec3 *read_points(csg_module_call *call, uint32_t index, uint32_t least, uint32_t *count)
{
    *count = count_points(call, index, least);
    if (!*count)
        return NULL;
    csg_vec3 *points = csg_memory_alloc(call->e->heap.memory, *count * sizeof *points);
    for (uint32_t i = 0; i < *count && points; i++)
        points[i] = read_point(call, index, i);
    if (!points)
        csg_eval_no_memory(call->e);
    return points;
}

/* ---- tube and spline ------------------------------------------------------------------------- */

typedef struct knot_list {
    csg_knot *knots;
    size_t count;
} knot_list;

static void read_radii(csg_module_call *call, uint32_t index, knot_list *s)
{
    csg_value value = call->values[index];
    if (value.kind != CSG_VALUE_VECTOR) {
        double r = csg_argument_number(call, index, 1, CSG_POSITIVE);
        for (size_t i = 0; i < s->count; i++)
            s->knots[i].radius = r;
        return;
    }
    if (value.as.vector->count != s->count) {
        csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "%u radii for %zu points",
                           value.as.vector->count, s->count);
        return;
    }
    for (uint32_t i = 0; i < s->count; i++) {
        csg_value r = value.as.vector->items[i];
        bool sound = r.kind == CSG_VALUE_NUMBER && isfinite(r.as.number) && r.as.number >= 0;
        if (!sound)
            csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "r[%u] is not a number above 0",
                               i);
        s->knots[i].radius = sound ? r.as.number : 1;
    }
}

/* Points and radii; false after a report, or when memory ran out. */
static bool read_knots(csg_module_call *call, uint32_t points, uint32_t radii, knot_list *s)
{
    size_t count = count_points(call, points, 2);
    if (!count)
        return false;
    s->knots = csg_memory_alloc(call->e->heap.memory, count * sizeof *s->knots);
    if (!s->knots) {
        csg_eval_no_memory(call->e);
        return false;
    }
    s->count = count;
    for (uint32_t i = 0; i < count; i++)
        s->knots[i] = (csg_knot){read_point(call, points, i), 1};
    read_radii(call, radii, s);
    return !call->failed;
}

/* Are there balls at all? Reports. */
static bool has_radius(csg_module_call *call, const knot_list *s)
{
    double largest = 0;
    for (size_t i = 0; i < s->count; i++)
        largest = fmax(largest, s->knots[i].radius);
    if (!(largest > 0))
        csg_argument_error(call, 1, CSG_DIAG_OUT_OF_RANGE, "all radii are 0");
    return largest > 0;
}

static void release_knots(csg_module_call *call, knot_list *s)
{
    csg_memory_release(call->e->heap.memory, s->knots, s->count * sizeof *s->knots);
}

csg_node_id csg_module_tube(csg_module_call *call)
{
    enum { POINTS, RADIUS, DEGREE };
    knot_list s = {0};
    csg_node_id node = CSG_NODE_NONE;
    bool known = read_knots(call, POINTS, RADIUS, &s);
    double degree = csg_argument_number(call, DEGREE, 1, CSG_POSITIVE);
    if (known && degree != 1 && degree != 2 && degree != 3)
        csg_argument_error(call, DEGREE, CSG_DIAG_OUT_OF_RANGE, "degree is %g", degree);
    if (known && !call->failed && (s.count - 1) % (size_t)degree != 0)
        csg_argument_error(call, POINTS, CSG_DIAG_BAD_POINTS,
                           "curves of degree %g share their ends: 1 + %g n points, not %zu", degree,
                           degree, s.count);
    if (known && !call->failed && has_radius(call, &s)) {
        csg_solid_job job = csg_shape_job(call);
        node = csg_shape_made(call, &job, csg_solid_tube(&job, s.knots, s.count, (int)degree));
    }
    release_knots(call, &s);
    return call->failed ? csg_shape_empty(call) : node;
}

csg_node_id csg_module_spline(csg_module_call *call)
{
    enum { POINTS, RADIUS, CLOSED };
    knot_list s = {0};
    csg_node_id node = CSG_NODE_NONE;
    if (read_knots(call, POINTS, RADIUS, &s) && has_radius(call, &s)) {
        bool closed = csg_argument_boolean(call, CLOSED);
        csg_solid_job job = csg_shape_job(call);
        node = csg_shape_made(call, &job, csg_solid_spline(&job, s.knots, s.count, closed));
    }
    release_knots(call, &s);
    return call->failed ? csg_shape_empty(call) : node;
}

/* ---- sheet ----------------------------------------------------------------------------------- */

/* The plane of a polygon, by Newell's sum of cross products; false after a report. */
static bool plane_of(csg_module_call *call, uint32_t index, const csg_vec3 *points, uint32_t count,
                     csg_affine *frame)
{
    const double flat = 1e-6; /* of the size */
    csg_vec3 sum = {0, 0, 0};
    double size = 0;
    for (uint32_t i = 0; i < count; i++) {
        csg_vec3 a = csg_vec3_sub(points[i], points[0]);
        csg_vec3 to = csg_vec3_sub(points[(i + 1) % count], points[0]);
        sum = csg_vec3_add(sum, csg_vec3_cross(a, to));
        size = fmax(size, csg_vec3_norm(a));
    }
    if (!(csg_vec3_norm(sum) > flat * size * size)) {
        csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "the points enclose no area");
        return false;
    }
    csg_vec3 normal = csg_vec3_normalize(sum);
    for (uint32_t i = 1; i < count; i++) {
        double off = csg_vec3_dot(normal, csg_vec3_sub(points[i], points[0]));
        if (fabs(off) > flat * size) {
            csg_argument_error(call, index, CSG_DIAG_BAD_POINTS,
                               "the points lie in no plane: points[%u] is %.4g off it", i,
                               fabs(off));
            return false;
        }
    }
    *frame = csg_affine_z_to(normal);
    frame->t[0] = points[0].x;
    frame->t[1] = points[0].y;
    frame->t[2] = points[0].z;
    return true;
}

static csg_node_id sheet(csg_module_call *call, const csg_vec3 *points, uint32_t count,
                         const csg_affine *frame, double r)
{
    csg_outline outline;
    bool ok = true;
    csg_outline_init(&outline, call->e->heap.memory);
    for (uint32_t i = 0; i < count && ok; i++) {
        csg_vec3 v = csg_vec3_sub(points[i], points[0]);
        double x = frame->m[0][0] * v.x + frame->m[1][0] * v.y + frame->m[2][0] * v.z;
        double y = frame->m[0][1] * v.x + frame->m[1][1] * v.y + frame->m[2][1] * v.z;
        ok = csg_outline_add(&outline, (csg_vec2){x, y});
    }
    if (!ok || !csg_outline_close(&outline)) {
        csg_outline_release(&outline);
        csg_eval_no_memory(call->e);
        return CSG_NODE_NONE;
    }
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_sheet(&job, &outline, frame, r));
}

csg_node_id csg_module_sheet(csg_module_call *call)
{
    enum { POINTS, RADIUS };
    csg_affine frame;
    uint32_t count = 0;
    double r = csg_argument_number(call, RADIUS, 1, CSG_POSITIVE);
    csg_vec3 *points = read_points(call, POINTS, 3, &count);
    csg_node_id node = CSG_NODE_NONE;
    if (points && !call->failed && plane_of(call, POINTS, points, count, &frame))
        node = sheet(call, points, count, &frame, r);
    csg_memory_release(call->e->heap.memory, points, count * sizeof *points);
    return call->failed ? csg_shape_empty(call) : node;
}

/* ---- patch ----------------------------------------------------------------------------------- */

static uint32_t length_of(csg_value value)
{
    return value.kind == CSG_VALUE_VECTOR ? value.as.vector->count : 0;
}

/* Reports rows that are none, and patches that take too many triangles. */
static bool read_patch(csg_module_call *call, csg_vec3 *points, csg_bezier_patch *patch, double r)
{
    csg_value rows = call->values[0];
    for (uint32_t i = 0; i < patch->rows; i++) {
        csg_value row = rows.as.vector->items[i];
        if (length_of(row) != patch->columns) {
            csg_argument_error(call, 0, CSG_DIAG_BAD_POINTS, "row %u has %u points, row 0 has %u",
                               i, length_of(row), patch->columns);
            return false;
        }
        for (uint32_t k = 0; k < patch->columns; k++)
            if (!is_point(row.as.vector->items[k], &points[i * patch->columns + k]))
                csg_argument_error(call, 0, CSG_DIAG_BAD_POINTS, "points[%u][%u] is not [x, y, z]",
                                   i, k);
    }
    patch->points = points;
    if (!call->failed && !csg_solid_patch_fits(patch, r))
        csg_argument_error(call, 1, CSG_DIAG_OUT_OF_RANGE,
                           "a patch of this size needs a larger radius, or several patches");
    return !call->failed;
}

csg_node_id csg_module_patch(csg_module_call *call)
{
    enum { POINTS, RADIUS };
    csg_vec3 points[CSG_PATCH_MOST * CSG_PATCH_MOST];
    csg_bezier_patch patch = {.rows = length_of(call->values[POINTS])};
    double r = csg_argument_number(call, RADIUS, 1, CSG_POSITIVE);
    if (patch.rows)
        patch.columns = length_of(call->values[POINTS].as.vector->items[0]);
    if (patch.rows < 2 || patch.rows > CSG_PATCH_MOST || patch.columns < 2 ||
        patch.columns > CSG_PATCH_MOST)
        csg_argument_error(call, POINTS, CSG_DIAG_BAD_TYPE,
                           "points must be 2 to %d rows of 2 to %d [x, y, z]", CSG_PATCH_MOST,
                           CSG_PATCH_MOST);
    if (call->failed || !read_patch(call, points, &patch, r))
        return csg_shape_empty(call);
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_patch(&job, &patch, r));
}

/* ---- sweep ----------------------------------------------------------------------------------- */

enum { PATH, CLOSED_PATH, SMOOTH, ROUND, PATH_TWIST, UP, UPRIGHT };

static void tell_of_path(csg_module_call *call, const csg_path_finding *found)
{
    uint32_t at = found->at, other = found->other;
    switch (found->fault) {
    case CSG_PATH_SOUND:
        break;
    case CSG_PATH_NO_MEMORY:
        csg_eval_no_memory(call->e);
        break;
    case CSG_PATH_COINCIDES:
        csg_argument_error(call, PATH, CSG_DIAG_BAD_POINTS, "path[%u] and path[%u] are one point%s",
                           other, at,
                           at == 0 ? ": closed = true comes back to the first by itself" : "");
        break;
    case CSG_PATH_TURNS_BACK:
        csg_argument_error(call, PATH, CSG_DIAG_BAD_POINTS, "the path turns back at path[%u]", at);
        break;
    case CSG_PATH_BENDS_MEET:
        csg_argument_error(call, ROUND, CSG_DIAG_OUT_OF_RANGE,
                           "arcs of radius %g at path[%u] and path[%u] need %.6g, the points are "
                           "%.6g apart",
                           call->values[ROUND].as.number, at, other, found->needed, found->there);
        break;
    case CSG_PATH_RUNS_UP:
        csg_argument_error(call, UPRIGHT, CSG_DIAG_OUT_OF_RANGE,
                           "the path runs along up after path[%u], where nothing is upright", at);
        break;
    case CSG_PATH_TOO_THICK:
        csg_argument_error(call, PATH, CSG_DIAG_BAD_POINTS,
                           "the figure reaches %.6g inwards, the path's radius after path[%u] is "
                           "%.6g",
                           found->needed, at, found->there);
        break;
    case CSG_PATH_TURNS_THICK:
        csg_argument_error(call, PATH, CSG_DIAG_BAD_POINTS,
                           "the figure turns along an arc after path[%u] and reaches %.6g, more "
                           "than half the path's radius there, %.6g",
                           at, found->needed, found->there);
        break;
    case CSG_PATH_TOO_SHORT:
        csg_argument_error(call, PATH, CSG_DIAG_BAD_POINTS,
                           "the mitres at path[%u] and path[%u] need %.6g for this figure, the "
                           "points are %.6g apart",
                           at, other, found->needed, found->there);
        break;
    case CSG_PATH_CANNOT_TURN:
        csg_argument_error(call, PATH, CSG_DIAG_BAD_POINTS,
                           "the figure cannot turn between path[%u] and path[%u]: the mitres take "
                           "%.6g of %.6g",
                           at, other, found->needed, found->there);
        break;
    }
}

/* Without the points. */
static csg_path_shape read_path(csg_module_call *call)
{
    csg_path_shape s = {.closed = csg_argument_boolean(call, CLOSED_PATH),
                        .smooth = csg_argument_boolean(call, SMOOTH),
                        .upright = csg_argument_boolean(call, UPRIGHT),
                        .round = csg_argument_number(call, ROUND, 0, CSG_NOT_NEGATIVE),
                        .twist = csg_argument_number(call, PATH_TWIST, 0, CSG_ANY),
                        .up = csg_argument_vector(call, UP, csg_vec3_make(0, 0, 1), false)};
    if (s.smooth && s.round > 0)
        csg_argument_error(call, ROUND, CSG_DIAG_OUT_OF_RANGE,
                           "a smooth path has no corners to be round");
    if (!call->failed && !(csg_vec3_norm(s.up) > 0))
        csg_argument_error(call, UP, CSG_DIAG_OUT_OF_RANGE, "up is zero");
    return s;
}

static csg_node_id swept(csg_module_call *call, const csg_path_shape *shape, csg_node_id flat)
{
    csg_path path;
    csg_path_finding found;
    csg_node_id node = CSG_NODE_NONE;
    if (csg_path_make(&path, call->e->heap.memory, shape, &found)) {
        csg_solid_job job = csg_shape_job(call);
        node = csg_shape_made(call, &job, csg_solid_along(&job, flat, &path, &found));
    }
    csg_path_release(&path);
    tell_of_path(call, &found);
    return call->failed ? csg_shape_empty(call) : node;
}

csg_node_id csg_module_sweep(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_path_shape shape = read_path(call);
    csg_vec3 *points = read_points(call, PATH, shape.closed ? 3 : 2, &shape.count);
    shape.points = points;
    csg_node_id flat = csg_shape_children(call, true);
    if (flat != CSG_NODE_NONE && !e->stop && !csg_eval_is_empty(e, flat))
        flat = call->failed ? csg_shape_empty(call) : swept(call, &shape, flat);
    csg_memory_release(e->heap.memory, points, shape.count * sizeof *points);
    return flat;
}
