/* SPDX-License-Identifier: MIT
 * The order of mending; see repair.h.
 */
#include "shape/polyhedra/repair.h"

#include <string.h>

bool csg_repair_is_flat(const csg_triangles *triangles, const uint32_t corners[3])
{
    csg_vec3 a = triangles->points[corners[0]];
    csg_vec3 b = csg_vec3_sub(triangles->points[corners[1]], a);
    csg_vec3 c = csg_vec3_sub(triangles->points[corners[2]], a);
    csg_int128 bx = csg_triangle_frame_steps(b.x), by = csg_triangle_frame_steps(b.y),
               bz = csg_triangle_frame_steps(b.z);
    csg_int128 cx = csg_triangle_frame_steps(c.x), cy = csg_triangle_frame_steps(c.y),
               cz = csg_triangle_frame_steps(c.z);
    return by * cz == bz * cy && bz * cx == bx * cz && bx * cy == by * cx;
}

static bool points_are_finite(const csg_triangles *in)
{
    for (size_t i = 0; i < in->point_count; i++) {
        csg_vec3 p = in->points[i];
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
            return false;
    }
    return true;
}

static bool corners_are_points(const csg_triangles *in)
{
    for (size_t t = 0; t < in->count; t++)
        for (int k = 0; k < 3; k++)
            if (in->corners[t][k] >= in->point_count)
                return false;
    return true;
}

/* Box of the points that triangles have. */
static csg_box used_box(const csg_triangles *in)
{
    csg_box box = csg_box_empty();
    for (size_t t = 0; t < in->count; t++)
        for (int k = 0; k < 3; k++)
            csg_box_extend(&box, in->points[in->corners[t][k]]);
    return box;
}

static bool has_open_edge(const csg_triangle_edges *edges)
{
    for (size_t i = 0; i < edges->count; i++)
        if (edges->edges[i].count == 1)
            return true;
    return false;
}

/* Everything up to the closed chain; false is for memory. */
static bool close_chain(csg_arena *scratch, csg_triangles *triangles, csg_triangle_edges *edges,
                        csg_repairs *repairs)
{
    if (!csg_repair_drop(scratch, triangles, false, repairs) ||
        !csg_edges_make(scratch, triangles, edges))
        return false;
    if (has_open_edge(edges)) {
        size_t before = repairs->welded;
        if (!csg_repair_weld_rims(scratch, triangles, edges, &repairs->welded))
            return false;
        if (repairs->welded > before && (!csg_repair_drop(scratch, triangles, false, repairs) ||
                                         !csg_edges_make(scratch, triangles, edges)))
            return false;
    }
    for (size_t i = 0; i < edges->count; i++)
        repairs->nonmanifold += edges->edges[i].count > 2;
    for (size_t t = 0; t < triangles->count; t++)
        repairs->degenerate += csg_repair_is_flat(triangles, triangles->corners[t]);
    if (!csg_repair_turn(scratch, triangles, edges, &repairs->flipped) ||
        (repairs->flipped && !csg_edges_make(scratch, triangles, edges)))
        return false;
    size_t count = triangles->count;
    if (!csg_repair_fill(scratch, triangles, edges, repairs))
        return false;
    return triangles->count == count || (csg_repair_drop(scratch, triangles, true, repairs) &&
                                         csg_edges_make(scratch, triangles, edges));
}

/* Rounding and mending move the box: into the frame of what is there now. No point changes its
 * place, since the steps of the new frame are as fine and its centre is a multiple of them. */
static void settle_frame(csg_chain *chain)
{
    csg_triangles *triangles = &chain->triangles;
    csg_box box = used_box(triangles);
    csg_triangle_frame frame;
    box.min = csg_triangle_frame_leave(&chain->frame, box.min);
    box.max = csg_triangle_frame_leave(&chain->frame, box.max);
    if (!csg_triangle_frame_make(box, &frame) || frame.scale < chain->frame.scale)
        return;
    for (size_t i = 0; i < triangles->point_count; i++)
        triangles->points[i] = csg_triangle_frame_enter(
            &frame, csg_triangle_frame_leave(&chain->frame, triangles->points[i]));
    chain->frame = frame;
}

bool csg_repair_number(csg_arena *scratch, csg_triangles *triangles)
{
    size_t count = triangles->point_count, numbered = 0;
    uint32_t *number = csg_arena_alloc(scratch, count * sizeof *number);
    csg_vec3 *points = csg_arena_alloc(scratch, count * sizeof *points);
    if (!number || !points)
        return false;
    memset(number, 0xff, count * sizeof *number);
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t *corner = &triangles->corners[t][k];
            if (number[*corner] == UINT32_MAX) {
                points[numbered] = triangles->points[*corner];
                number[*corner] = (uint32_t)numbered++;
            }
            *corner = number[*corner];
        }
    memcpy(triangles->points, points, numbered * sizeof *points);
    triangles->point_count = numbered;
    return true;
}

static csgm_status repair(csg_arena *scratch, const csg_triangles *in, csg_chain *out,
                          csg_repairs *repairs)
{
    csg_triangle_edges edges;
    if (!csg_repair_weld(scratch, &out->frame, in, &out->triangles, repairs) ||
        !close_chain(scratch, &out->triangles, &edges, repairs))
        return CSGM_ERR_MEMORY;
    csgm_status status = csg_repair_pieces(scratch, &edges, out, repairs);
    if (status == CSGM_OK)
        settle_frame(out);
    return status;
}

csgm_status csg_repair(csg_memory *memory, csg_arena *scratch, const csg_triangles *in,
                       csg_chain *out, csg_repairs *repairs)
{
    static const size_t MOST = 1u << 26; /* four times as many when mended: places have 28 bits */
    *repairs = (csg_repairs){0};
    *out = (csg_chain){0};
    if (!in->count || in->count > MOST || in->point_count > MOST || !corners_are_points(in) ||
        !points_are_finite(in) || !csg_triangle_frame_make(used_box(in), &out->frame))
        return CSGM_ERR_SCENE;
    csg_triangles_init(&out->triangles, memory);
    csgm_status status = repair(scratch, in, out, repairs);
    if (status != CSGM_OK)
        csg_triangles_release(&out->triangles);
    return status;
}
