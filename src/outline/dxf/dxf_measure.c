/* SPDX-License-Identifier: MIT
 * Dimensions and crossings of a drawing; see dxf_measure.h. Group codes are those of Autodesk's
 * reference: 10 to 16 are points, 50 an angle, 70 the kind of dimension.
 */
#include "outline/dxf/dxf_measure.h"

#include <math.h>

#include "base/elementary.h"
#include "outline/dxf/dxf_file.h"

static const double degree = 180 / 3.14159265358979323846;

/* The drawing's own entities of this kind on the layer, one after the other; NULL: no more. */
static const csg_dxf_entity *next_entity(const csg_dxf_file *file, const csg_dxf_request *request,
                                         const char *kind, size_t *at)
{
    const csg_dxf_block *all = &file->blocks[0];
    while (*at < all->count) {
        const csg_dxf_entity *e = &file->entities[all->first + (*at)++];
        if (csg_dxf_text_is(e->kind, kind) && !e->paper &&
            (!request->layer || !*request->layer || csg_dxf_text_is(e->layer, request->layer)))
            return e;
    }
    return NULL;
}

static double scale_of(const csg_dxf_request *request)
{
    return request->scale != 0 ? request->scale : 1;
}

static csg_vec2 point_at(const csg_dxf_entity *e, const csg_dxf_request *request, int code)
{
    double scale = scale_of(request);
    return (csg_vec2){(csg_dxf_get(e, code, 0) - request->origin.x) * scale,
                      (csg_dxf_get(e, code + 10, 0) - request->origin.y) * scale};
}

/* By OpenSCAD's reading, which takes angles between lines from the y axis. False: none it knows. */
static bool measure(const csg_dxf_entity *e, const csg_dxf_request *request, double *out)
{
    enum { ROTATED, ALIGNED, ANGULAR, DIAMETER, RADIUS, ORDINATE = 6, OF_X = 64 };
    double flags = csg_dxf_get(e, 70, 0);
    int kind = flags >= 0 && flags < 256 ? (int)flags : 0;
    csg_vec2 p0 = point_at(e, request, 10), p3 = point_at(e, request, 13),
             p4 = point_at(e, request, 14), p5 = point_at(e, request, 15);
    double angle = csg_dxf_get(e, 50, 0);
    switch (kind & 7) {
    case ROTATED:
        *out =
            fabs((p4.x - p3.x) * csg_cos(angle / degree) + (p4.y - p3.y) * csg_sin(angle / degree));
        return true;
    case ALIGNED:
        *out = csg_hypot(p4.x - p3.x, p4.y - p3.y);
        return true;
    case ANGULAR:
        *out = fabs(csg_atan2(p0.x - p5.x, p0.y - p5.y) - csg_atan2(p4.x - p3.x, p4.y - p3.y)) *
               degree;
        return true;
    case DIAMETER:
    case RADIUS:
        *out = csg_hypot(p5.x - p0.x, p5.y - p0.y);
        return true;
    case ORDINATE:
        *out = kind & OF_X ? p3.x : p3.y;
        return true;
    default:
        return false;
    }
}

csgm_status csg_dxf_dimension(csg_memory *memory, const csg_dxf_request *request, const char *name,
                              double *out, csg_problem *problem)
{
    csg_dxf_file file;
    csgm_status status = csg_dxf_read(memory, request->text, request->length, &file, problem);
    if (status != CSGM_OK)
        return status;
    const csg_dxf_entity *e;
    size_t at = 0;
    bool any = !name || !*name;
    while ((e = next_entity(&file, request, "DIMENSION", &at)))
        if (any || csg_dxf_text_is(csg_dxf_get_text(e, 1), name))
            break;
    if (!e)
        status = csg_problem_set(problem, CSGM_ERR_SCENE, "the drawing has no dimension%s%.60s%s",
                                 any ? "" : " '", any ? "" : name, any ? "" : "'");
    else if (!measure(e, request, out))
        status = csg_problem_set(problem, CSGM_ERR_SCENE,
                                 "the dimension is of a kind that has no measure here");
    csg_dxf_release(&file);
    return status;
}

static bool cross(const csg_vec2 p[4], csg_vec2 *out)
{
    csg_vec2 a = {p[1].x - p[0].x, p[1].y - p[0].y}, b = {p[3].x - p[2].x, p[3].y - p[2].y};
    double area = b.y * a.x - b.x * a.y;
    if (area == 0)
        return false;
    double along = (b.x * (p[0].y - p[2].y) - b.y * (p[0].x - p[2].x)) / area;
    *out = (csg_vec2){p[0].x + along * a.x, p[0].y + along * a.y};
    return isfinite(out->x) && isfinite(out->y);
}

csgm_status csg_dxf_crossing(csg_memory *memory, const csg_dxf_request *request, csg_vec2 *out,
                             csg_problem *problem)
{
    csg_dxf_file file;
    csgm_status status = csg_dxf_read(memory, request->text, request->length, &file, problem);
    if (status != CSGM_OK)
        return status;
    csg_vec2 points[4];
    const csg_dxf_entity *e;
    size_t at = 0, count = 0;
    while (count < 4 && (e = next_entity(&file, request, "LINE", &at))) {
        points[count++] = point_at(e, request, 10);
        points[count++] = point_at(e, request, 11);
    }
    if (count < 4)
        status = csg_problem_set(problem, CSGM_ERR_SCENE, "the drawing has no two lines");
    else if (!cross(points, out))
        status = csg_problem_set(problem, CSGM_ERR_SCENE, "the first two lines do not cross");
    csg_dxf_release(&file);
    return status;
}
