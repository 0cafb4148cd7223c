/* SPDX-License-Identifier: MIT
 * Meshes on their way into tiles; see draw.h.
 */
#include "render/draw.h"

#include <string.h>

#include "base/clock.h"
#include "base/trace.h"

enum { VERTICES_PER_ITEM = 1 << 14 };

csg_vec3 csg_draw_position(const csg_draw *draw, uint32_t vertex)
{
    const float *p = draw->mesh->positions + 3 * (size_t)vertex;
    return csg_vec3_add(draw->mesh->origin, csg_vec3_from_floats(p));
}

static int32_t snap(const csg_draw *draw, double pixels)
{
    double at = floor(pixels * draw->samples * CSG_DRAW_SUBSTEPS + 0.5);
    at = at < CSG_DRAW_LARGEST ? at : CSG_DRAW_LARGEST;
    return (int32_t)(at > -CSG_DRAW_LARGEST ? at : -CSG_DRAW_LARGEST);
}

csg_draw_vertex csg_draw_project(const csg_draw *draw, csg_vec3 position)
{
    const csg_view *view = draw->view;
    csg_vec3 at = csg_view_project(view, position);
    if (!isfinite(at.x + at.y + at.z) || at.z < draw->nearest)
        return (csg_draw_vertex){.is_visible = false};
    double nearness = view->orthographic ? draw->nearest - at.z : draw->nearest / at.z;
    return (csg_draw_vertex){snap(draw, at.x), snap(draw, at.y), (float)nearness, true};
}

/* ---- the nearest plane ----------------------------------------------------------------------- */

static csg_vec3 cut(const csg_draw *draw, csg_vec3 a, csg_vec3 b, double depth_a, double depth_b)
{
    double share = (draw->nearest - depth_a) / (depth_b - depth_a);
    return csg_vec3_add(a, csg_vec3_scale(csg_vec3_sub(b, a), share));
}

/* Sutherland and Hodgman's clipping by one plane: three or four corners, or none. */
static int clip(const csg_draw *draw, const csg_vec3 corners[3], csg_draw_vertex out[4])
{
    const csg_view *view = draw->view;
    double depth[3];
    int count = 0;
    for (int i = 0; i < 3; i++)
        depth[i] = csg_vec3_dot(csg_vec3_sub(corners[i], view->eye), view->forward);
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        bool here = depth[i] >= draw->nearest, there = depth[next] >= draw->nearest;
        if (here)
            out[count++] = csg_draw_project(draw, corners[i]);
        if (here == there)
            continue;
        csg_vec3 at = cut(draw, corners[i], corners[next], depth[i], depth[next]);
        /* rounding may leave it a little before the plane */
        at = csg_vec3_add(at, csg_vec3_scale(view->forward, 1e-9 * draw->nearest));
        out[count++] = csg_draw_project(draw, at);
    }
    for (int i = 0; i < count; i++)
        if (!out[i].is_visible)
            return 0;
    return count;
}

int csg_draw_corners(const csg_draw *draw, uint64_t triangle, csg_draw_vertex out[2][3])
{
    const uint32_t *index = draw->mesh->indices + 3 * triangle;
    int visible = 0;
    for (int i = 0; i < 3; i++) {
        if (index[i] >= draw->mesh->vertex_count)
            return 0;
        out[0][i] = draw->vertices[index[i]];
        visible += out[0][i].is_visible;
    }
    if (visible == 3)
        return 1;
    if (visible == 0)
        return 0;
    csg_vec3 corners[3];
    for (int i = 0; i < 3; i++) {
        corners[i] = csg_draw_position(draw, index[i]);
        if (!isfinite(corners[i].x + corners[i].y + corners[i].z))
            return 0;
    }
    csg_draw_vertex polygon[4];
    int count = clip(draw, corners, polygon);
    for (int part = 0; part + 2 < count; part++) {
        out[part][0] = polygon[0];
        out[part][1] = polygon[part + 1];
        out[part][2] = polygon[part + 2];
    }
    return count >= 3 ? count - 2 : 0;
}

/* ---- tiles ----------------------------------------------------------------------------------- */

static int64_t least_of(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t most_of(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* Tiles that, with their borders, the box around the triangle touches: x0, y0, x1, y1, the last
 * ones included. */
static bool tiles_of(const csg_draw *draw, uint64_t triangle, uint32_t tiles[4])
{
    csg_draw_vertex corners[2][3];
    int count = csg_draw_corners(draw, triangle, corners);
    int64_t low[2] = {INT64_MAX, INT64_MAX}, high[2] = {INT64_MIN, INT64_MIN};
    for (int part = 0; part < count; part++)
        for (int i = 0; i < 3; i++) {
            low[0] = least_of(low[0], corners[part][i].x);
            low[1] = least_of(low[1], corners[part][i].y);
            high[0] = most_of(high[0], corners[part][i].x);
            high[1] = most_of(high[1], corners[part][i].y);
        }
    int64_t size = (int64_t)CSG_DRAW_TILE * draw->samples * CSG_DRAW_SUBSTEPS;
    int64_t border = (int64_t)draw->border * CSG_DRAW_SUBSTEPS;
    const int64_t ends[2] = {draw->columns, draw->rows};
    for (int axis = 0; axis < 2 && count; axis++) {
        low[axis] -= border;
        high[axis] += border;
        if (high[axis] < 0 || low[axis] >= ends[axis] * size)
            return false;
        tiles[axis] = (uint32_t)(most_of(low[axis], 0) / size);
        tiles[2 + axis] = (uint32_t)least_of(high[axis] / size, ends[axis] - 1);
    }
    return count > 0;
}

/* Counts the triangles of each tile, or (fill) writes them there, in their order. */
static bool each_triangle(csg_draw *draw, bool fill)
{
    enum { BETWEEN_LOOKS = 1 << 16 };
    for (uint64_t t = 0; t < draw->mesh->triangle_count; t++) {
        uint32_t tiles[4];
        if (t % BETWEEN_LOOKS == 0 && csg_picture_should_stop(draw->picture))
            return false;
        if (!tiles_of(draw, t, tiles))
            continue;
        for (uint32_t y = tiles[1]; y <= tiles[3]; y++)
            for (uint32_t x = tiles[0]; x <= tiles[2]; x++) {
                uint64_t *at = &draw->tile_first[(size_t)y * draw->columns + x];
                if (fill)
                    draw->tile_triangles[*at] = (uint32_t)t;
                (*at)++;
            }
    }
    return true;
}

static csgm_status sort_triangles(csg_draw *draw, uint64_t *total)
{
    CSG_ZONE(draw->picture->context, "sort triangles");
    csgm_context *context = draw->picture->context;
    size_t tiles = (size_t)draw->columns * draw->rows;
    draw->tile_first = csg_memory_alloc(&context->memory, (tiles + 1) * sizeof(uint64_t));
    if (!draw->tile_first)
        return csg_context_no_memory(context);
    memset(draw->tile_first, 0, (tiles + 1) * sizeof(uint64_t));
    if (!each_triangle(draw, false))
        return csg_picture_why_stopped(draw->picture);
    *total = 0;
    for (size_t i = 0; i < tiles; i++) {
        uint64_t count = draw->tile_first[i];
        draw->tile_first[i] = *total;
        *total += count;
    }
    if (*total) {
        draw->tile_triangles = csg_memory_alloc(&context->memory, *total * sizeof(uint32_t));
        if (!draw->tile_triangles)
            return csg_context_no_memory(context);
    }
    if (!each_triangle(draw, true))
        return csg_picture_why_stopped(draw->picture);
    /* filling has moved each tile's first to the next one's */
    memmove(draw->tile_first + 1, draw->tile_first, tiles * sizeof(uint64_t));
    draw->tile_first[0] = 0;
    return CSGM_OK;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool project_item(void *user, uint32_t worker, size_t item)
{
    csg_draw *draw = user;
    (void)worker;
    uint64_t first = (uint64_t)item * VERTICES_PER_ITEM, end = first + VERTICES_PER_ITEM;
    if (csg_picture_should_stop(draw->picture))
        return false;
    for (uint64_t v = first; v < end && v < draw->mesh->vertex_count; v++)
        draw->vertices[v] = csg_draw_project(draw, csg_draw_position(draw, (uint32_t)v));
    return true;
}

static csgm_status project(csg_draw *draw)
{
    CSG_ZONE(draw->picture->context, "project");
    csgm_context *context = draw->picture->context;
    size_t count = draw->mesh->vertex_count;
    if (!count)
        return CSGM_OK;
    draw->vertices = csg_memory_alloc(&context->memory, count * sizeof *draw->vertices);
    if (!draw->vertices)
        return csg_context_no_memory(context);
    size_t items = (count + VERTICES_PER_ITEM - 1) / VERTICES_PER_ITEM;
    if (csg_pool_run(context->pool, items, project_item, NULL, draw))
        return CSGM_OK;
    return csg_picture_why_stopped(draw->picture);
}

static size_t room_samples(const csg_draw *draw)
{
    size_t side = (size_t)CSG_DRAW_TILE * draw->samples + 2 * (size_t)draw->border;
    return side * side;
}

static bool create_room(csg_draw *draw, csg_draw_room **out)
{
    csg_memory *memory = &draw->picture->context->memory;
    size_t floats = room_samples(draw) * sizeof(float);
    csg_draw_room *room = *out = csg_memory_alloc(memory, sizeof *room);
    if (!room)
        return false;
    room->nearness = csg_memory_alloc(memory, floats);
    room->triangle = csg_memory_alloc(memory, room_samples(draw) * sizeof(uint32_t));
    room->through = draw->is_clear ? csg_memory_alloc(memory, floats) : NULL;
    room->behind = draw->is_clear ? csg_memory_alloc(memory, floats) : NULL;
    return room->nearness && room->triangle && (!draw->is_clear || (room->through && room->behind));
}

static bool create_rooms(csg_draw *draw)
{
    csg_memory *memory = &draw->picture->context->memory;
    draw->room_count = csg_pool_threads(draw->picture->context->pool);
    draw->rooms = csg_memory_alloc(memory, draw->room_count * sizeof *draw->rooms);
    if (!draw->rooms)
        return false;
    memset(draw->rooms, 0, draw->room_count * sizeof *draw->rooms);
    bool done = true;
    for (uint32_t i = 0; i < draw->room_count && done; i++)
        done = create_room(draw, &draw->rooms[i]);
    return done;
}

static void release(csg_draw *draw, uint64_t total)
{
    csg_memory *memory = &draw->picture->context->memory;
    for (uint32_t i = 0; draw->rooms && i < draw->room_count && draw->rooms[i]; i++) {
        float *floats[] = {draw->rooms[i]->nearness, draw->rooms[i]->through,
                           draw->rooms[i]->behind};
        for (int k = 0; k < 3; k++)
            csg_memory_release(memory, floats[k], room_samples(draw) * sizeof(float));
        csg_memory_release(memory, draw->rooms[i]->triangle, room_samples(draw) * sizeof(uint32_t));
        csg_memory_release(memory, draw->rooms[i], sizeof *draw->rooms[i]);
    }
    csg_memory_release(memory, draw->rooms, draw->room_count * sizeof *draw->rooms);
    csg_memory_release(memory, draw->tile_triangles, total * sizeof(uint32_t));
    csg_memory_release(memory, draw->tile_first,
                       ((size_t)draw->columns * draw->rows + 1) * sizeof(uint64_t));
    csg_memory_release(memory, draw->vertices, draw->mesh->vertex_count * sizeof *draw->vertices);
}

csgm_status csg_draw_run(csg_draw *draw, csg_pool_work *item, csgm_render_stats *stats)
{
    CSG_ZONE(draw->picture->context, "draw");
    csg_picture *picture = draw->picture;
    uint64_t total = 0;
    csgm_status status = project(draw);
    if (status == CSGM_OK)
        status = sort_triangles(draw, &total);
    if (status == CSGM_OK && !create_rooms(draw))
        status = csg_context_no_memory(picture->context);
    stats->prepare_s = csg_clock_now_s() - picture->started_s;
    if (status == CSGM_OK &&
        !csg_pool_run(picture->context->pool, (size_t)draw->columns * draw->rows, item,
                      csg_picture_poll, draw))
        status = csg_picture_why_stopped(picture);
    release(draw, total);
    return status;
}
