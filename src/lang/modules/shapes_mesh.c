/* SPDX-License-Identifier: MIT
 * Solids by their surface: polyhedron and surface. Faces run clockwise seen from outside, as in
 * OpenSCAD; what is wrong with them is mended and told (shape/polyhedra/polyhedron.h).
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/modules/imports.h"
#include "outline/heights/heights.h"

/* ---- polyhedron ------------------------------------------------------------------------------ */

static bool add_points(csg_module_call *call, uint32_t index, csg_triangles *out)
{
    csg_value points = call->values[index];
    if (points.kind != CSG_VALUE_VECTOR) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "points must be a list of [x, y, z]");
        return false;
    }
    for (uint32_t i = 0; i < points.as.vector->count; i++) {
        double v[3] = {0, 0, 0};
        bool known = csg_value_numbers(points.as.vector->items[i], 3, v);
        if (!known || !isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2])) {
            csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "points[%u] is not [x, y, z]", i);
            return false;
        }
        if (!csg_triangles_add_point(out, csg_vec3_make(v[0], v[1], v[2]))) {
            csg_eval_no_memory(call->e);
            return false;
        }
    }
    return true;
}

/* What of the faces cannot be used: in a lenient text all of it, else the first. */
typedef struct bad_faces {
    uint32_t count; /* corners, and faces that are none */
    char first[160];
} bad_faces;

/* The first is kept in words; true: go on without. */
static bool miss(csg_module_call *call, bad_faces *bad, uint32_t index, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static bool miss(csg_module_call *call, bad_faces *bad, uint32_t index, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (bad->count++ == 0)
        vsnprintf(bad->first, sizeof bad->first, format, arguments);
    va_end(arguments);
    return csg_eval_is_lenient(call->e, CSG_DIAG_BAD_POINTS, call->spans[index]);
}

/* Corners of a face, the other way round, to the end of `corners`; how many there are. */
static size_t read_face(csg_module_call *call, uint32_t index, uint32_t number,
                        const csg_vector *face, size_t point_count, uint32_t *corners,
                        bad_faces *bad)
{
    size_t count = 0;
    for (uint32_t i = 0; i < face->count; i++) {
        csg_value corner = face->items[i];
        double at = corner.kind == CSG_VALUE_NUMBER ? trunc(corner.as.number) : NAN;
        if (at >= 0 && at < (double)point_count)
            corners[face->count - ++count] = (uint32_t)at;
        else if (!miss(call, bad, index, "%s[%u] names point %g, there are points 0 to %d",
                       call->parameters[index].name, number, at, (int)point_count - 1))
            return 0;
    }
    return count;
}

/* False: stop. */
static bool add_face(csg_module_call *call, uint32_t index, uint32_t number, csg_value face,
                     csg_triangles *out, bad_faces *bad)
{
    csg_memory *memory = call->e->heap.memory;
    if (face.kind != CSG_VALUE_VECTOR || face.as.vector->count < 3)
        return miss(call, bad, index, "%s[%u] is not a list of at least 3 indices of points",
                    call->parameters[index].name, number);
    size_t room = face.as.vector->count;
    uint32_t *corners = csg_memory_alloc(memory, room * sizeof *corners);
    size_t count = 0;
    if (corners)
        count = read_face(call, index, number, face.as.vector, out->point_count, corners, bad);
    if (!corners || (count >= 3 && !csg_triangles_add_face(out, corners + room - count, count)))
        csg_eval_no_memory(call->e);
    csg_memory_release(memory, corners, room * sizeof *corners);
    return (count == room || bad->count == 0 ||
            csg_eval_is_lenient(call->e, CSG_DIAG_BAD_POINTS, call->spans[index])) &&
           !call->e->stop;
}

/* As OpenSCAD does, corners without a point are left out, and faces with less than three. */
static void add_faces(csg_module_call *call, uint32_t index, csg_triangles *out)
{
    bad_faces bad = {0};
    const csg_vector *faces = call->values[index].as.vector;
    char instead[80] = "it is left out";
    for (uint32_t i = 0; i < faces->count; i++)
        if (!add_face(call, index, i, faces->items[i], out, &bad))
            break;
    if (bad.count > 1)
        snprintf(instead, sizeof instead, "it is left out, as are %u more corners or faces",
                 bad.count - 1);
    if (bad.count && !call->e->stop)
        csg_argument_mishap(call, index, CSG_DIAG_BAD_POINTS, instead, "%s", bad.first);
}

csg_node_id csg_module_polyhedron(csg_module_call *call)
{
    enum { POINTS, FACES, CONVEXITY, TRIANGLES, CLEAN };
    csg_eval *e = call->e;
    uint32_t index =
        csg_has_argument(call, FACES) || !csg_has_argument(call, TRIANGLES) ? FACES : TRIANGLES;
    csg_value faces = call->values[index];
    csg_triangles triangles;
    csg_triangles_init(&triangles, e->heap.memory);
    bool ok = add_points(call, POINTS, &triangles);
    if (ok && faces.kind != CSG_VALUE_VECTOR)
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "faces must be lists of indices");
    if (ok && !call->failed)
        add_faces(call, index, &triangles);
    if (ok && !call->failed && !e->stop)
        return csg_shape_solid(call, &triangles, !csg_argument_boolean(call, CLEAN));
    csg_triangles_release(&triangles);
    return csg_shape_empty(call);
}

/* ---- surface --------------------------------------------------------------------------------- */

static csgm_status heights_of_file(csg_module_call *call, const char *path, bool invert,
                                   csg_heights *out, csg_problem *problem)
{
    csg_bytes bytes;
    csgm_status status = csg_bytes_read(call->e->heap.memory, path, &bytes, problem);
    if (status != CSGM_OK)
        return status;
    status = csg_heights_from_bytes(call->e->heap.memory, &bytes, invert, out, problem);
    csg_bytes_release(&bytes);
    return status;
}

csg_node_id csg_module_surface(csg_module_call *call)
{
    enum { FILE_NAME, CENTER, CONVEXITY, INVERT };
    csg_eval *e = call->e;
    csg_heights heights;
    csg_triangles triangles;
    csg_problem problem = {""};
    const char *path = csg_import_find(call, FILE_NAME);
    if (!path)
        return csg_shape_empty(call);
    csg_triangles_init(&triangles, e->heap.memory);
    csgm_status status =
        heights_of_file(call, path, csg_argument_boolean(call, INVERT), &heights, &problem);
    if (status == CSGM_OK) {
        status =
            csg_heights_solid(&heights, csg_argument_boolean(call, CENTER), &triangles, &problem);
        csg_heights_release(&heights);
    }
    if (status == CSGM_OK)
        return csg_shape_solid(call, &triangles, true);
    csg_triangles_release(&triangles);
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(e);
    else
        csg_argument_error(call, FILE_NAME, CSG_DIAG_BAD_IMPORT, "'%.120s': %s", path,
                           problem.text);
    return csg_shape_empty(call);
}
