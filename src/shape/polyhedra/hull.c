/* SPDX-License-Identifier: MIT
 * Qhull behind csg_hull: points moved to a frame of size 1, facets cut into triangles ("Qt"). The
 * library jumps back into qh_new_qhull on errors; after that nothing of it is called that could
 * jump again. What it would print goes nowhere. Its memory is its own, so the number of points is
 * bounded.
 */
#include <libqhull_r/qhull_ra.h>

#include <stdio.h>
#include <string.h>

#include "shape/polyhedra/frame.h"
#include "shape/polyhedra/hull.h"

static const size_t POINTS_MOST = 4000000;

/* Everything that has to be given back. */
typedef struct hull_run {
    csg_memory *memory;
    qhT *qh;
    double *coordinates; /* 3 per point, in the frame */
    uint32_t *number;    /* per point: its number in the result + 1, 0 = inside */
    size_t count;
    FILE *nowhere;
} hull_run;

static void release_run(hull_run *run)
{
    csg_memory_release(run->memory, run->qh, sizeof *run->qh);
    csg_memory_release(run->memory, run->coordinates, 3 * run->count * sizeof(double));
    csg_memory_release(run->memory, run->number, run->count * sizeof *run->number);
    if (run->nowhere)
        fclose(run->nowhere);
}

static bool make_run(hull_run *run, csg_memory *memory, size_t count)
{
    *run = (hull_run){.memory = memory, .count = count};
    run->qh = csg_memory_alloc(memory, sizeof *run->qh);
    run->coordinates = csg_memory_alloc(memory, 3 * count * sizeof(double));
    run->number = csg_memory_alloc(memory, count * sizeof *run->number);
    run->nowhere = fopencookie(NULL, "w", (cookie_io_functions_t){0});
    if (run->qh && run->coordinates && run->number && run->nowhere)
        return true;
    release_run(run);
    return false;
}

static bool box_of(const csg_vec3 *points, size_t count, csg_box *box)
{
    *box = csg_box_empty();
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(points[i].x) || !isfinite(points[i].y) || !isfinite(points[i].z))
            return false;
        *box = csg_box_hull(*box, (csg_box){points[i], points[i]});
    }
    return true;
}

/* The three points of a facet, counter-clockwise from outside. */
static void corners_of(qhT *qh, const facetT *facet, uint32_t corners[3])
{
    bool is_forward = facet->toporient ^ qh_ORIENTclock;
    for (int k = 0; k < 3; k++) {
        const vertexT *vertex = SETelemt_(facet->vertices, k, vertexT);
        corners[is_forward ? 2 - k : k] = (uint32_t)qh_pointid(qh, vertex->point);
    }
}

static bool is_triangle(const facetT *facet)
{
    for (int k = 0; k < 3; k++)
        if (!facet->vertices || !SETelem_(facet->vertices, k))
            return false;
    return !SETelem_(facet->vertices, 3);
}

/* Points in the order of the input, triangles in that of the library. */
static csgm_status take_facets(hull_run *run, const csg_vec3 *points, csg_triangles *out)
{
    qhT *qh = run->qh;
    facetT *facet;
    memset(run->number, 0, run->count * sizeof *run->number);
    FORALLfacets
    {
        uint32_t corners[3];
        if (!is_triangle(facet))
            return CSGM_ERR_SCENE;
        corners_of(qh, facet, corners);
        if (!csg_triangles_add(out, corners[0], corners[1], corners[2]))
            return CSGM_ERR_MEMORY;
        for (int k = 0; k < 3; k++)
            run->number[corners[k]] = 1;
    }
    for (size_t i = 0; i < run->count; i++) {
        if (run->number[i] && !csg_triangles_add_point(out, points[i]))
            return CSGM_ERR_MEMORY;
        run->number[i] = (uint32_t)out->point_count;
    }
    for (size_t t = 0; t < out->count; t++)
        for (int k = 0; k < 3; k++)
            out->corners[t][k] = run->number[out->corners[t][k]] - 1;
    return CSGM_OK;
}

static csgm_status run_library(hull_run *run, const csg_vec3 *points, csg_triangles *out)
{
    static const char COMMAND[] = "qhull Qt Pp";
    char command[sizeof COMMAND];
    memcpy(command, COMMAND, sizeof COMMAND);
    qh_zero(run->qh, run->nowhere);
    int failure = qh_new_qhull(run->qh, 3, (int)run->count, run->coordinates, False, command, NULL,
                               run->nowhere);
    csgm_status status = failure == qh_ERRmem ? CSGM_ERR_MEMORY
                         : failure            ? CSGM_ERR_SCENE
                                              : take_facets(run, points, out);
    int curlong, totlong;
    qh_freeqhull(run->qh, !qh_ALL);
    qh_memfreeshort(run->qh, &curlong, &totlong);
    return status;
}

csgm_status csg_hull(csg_memory *memory, const csg_vec3 *points, size_t count, csg_triangles *out)
{
    csg_box box;
    csg_triangle_frame frame;
    csg_triangles_init(out, memory);
    if (count < 4 || count > POINTS_MOST || !box_of(points, count, &box) ||
        !csg_triangle_frame_make(box, &frame))
        return CSGM_ERR_SCENE;
    hull_run run;
    if (!make_run(&run, memory, count))
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        csg_vec3 p = csg_triangle_frame_enter(&frame, points[i]);
        run.coordinates[3 * i] = p.x;
        run.coordinates[3 * i + 1] = p.y;
        run.coordinates[3 * i + 2] = p.z;
    }
    csgm_status status = run_library(&run, points, out);
    release_run(&run);
    if (status != CSGM_OK)
        csg_triangles_release(out);
    return status;
}

bool csg_hull_is_available(void)
{
    return true;
}
