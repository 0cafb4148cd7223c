/* SPDX-License-Identifier: MIT
 * Ends of lines are gathered to nodes by a hash table of squares as wide as the tolerance; then
 * lines are walked from node to node, first from loose ends, then around what is left. See chain.h.
 */
#include "outline/dxf/chain.h"

#include <string.h>

#include "base/elementary.h"

#define NONE UINT32_MAX

/* End 2 i is where line i begins, 2 i + 1 where it ends. */
typedef struct chains {
    const csg_polylines *lines;
    csg_outline *out;
    double tolerance;
    size_t end_count, node_count, table_size;
    csg_vec2 *node_points;
    uint32_t *node_of;   /* per end */
    uint32_t *first_end; /* per node: its ends, in the order of the lines */
    uint32_t *last_end;  /* per node */
    uint32_t *next_end;  /* per end */
    uint32_t *table;     /* per place: the newest node of these squares */
    uint32_t *next_node; /* per node: another one of the same place */
    uint32_t *degree;    /* per node: unused ends */
    bool *used;          /* per line */
} chains;

static csg_vec2 end_point(const csg_polylines *lines, size_t end)
{
    const csg_polyline *line = &lines->items[end / 2];
    return lines->points[line->first + (end % 2 ? line->count - 1 : 0)];
}

static uint64_t place_of(const chains *c, double square_x, double square_y)
{
    uint64_t x = (uint64_t)(int64_t)square_x, y = (uint64_t)(int64_t)square_y;
    uint64_t mixed = (x * 0x9E3779B97F4A7C15u) ^ (y * 0xC2B2AE3D27D4EB4Fu);
    return (mixed ^ mixed >> 29) & (c->table_size - 1);
}

static uint32_t find_node(const chains *c, csg_vec2 p)
{
    double x = floor(p.x / c->tolerance), y = floor(p.y / c->tolerance);
    for (int i = 0; i < 9; i++) {
        uint32_t node = c->table[place_of(c, x + i % 3 - 1, y + i / 3 - 1)];
        for (; node != NONE; node = c->next_node[node])
            if (csg_hypot(c->node_points[node].x - p.x, c->node_points[node].y - p.y) <=
                c->tolerance)
                return node;
    }
    return NONE;
}

static uint32_t add_node(chains *c, csg_vec2 p)
{
    uint32_t node = (uint32_t)c->node_count++;
    uint64_t place = place_of(c, floor(p.x / c->tolerance), floor(p.y / c->tolerance));
    c->node_points[node] = p;
    c->first_end[node] = c->last_end[node] = NONE;
    c->degree[node] = 0;
    c->next_node[node] = c->table[place];
    c->table[place] = node;
    return node;
}

static void gather_end(chains *c, uint32_t end)
{
    csg_vec2 p = end_point(c->lines, end);
    uint32_t node = find_node(c, p);
    if (node == NONE)
        node = add_node(c, p);
    c->node_of[end] = node;
    c->next_end[end] = NONE;
    if (c->first_end[node] == NONE)
        c->first_end[node] = end;
    else
        c->next_end[c->last_end[node]] = end;
    c->last_end[node] = end;
    c->degree[node]++;
}

/* Adds the points of the line from this end on, but for the last one. */
static bool add_points(chains *c, uint32_t end)
{
    const csg_polyline *line = &c->lines->items[end / 2];
    for (size_t i = 0; i + 1 < line->count; i++) {
        size_t index = end % 2 ? line->count - 1 - i : i;
        if (!csg_outline_add(c->out, c->lines->points[line->first + index]))
            return false;
    }
    return true;
}

/* The first unused line at a node, by its end there. Ends passed over stay used, so the list is
 * shortened. */
static uint32_t take_end(chains *c, uint32_t node)
{
    while (c->first_end[node] != NONE && c->used[c->first_end[node] / 2])
        c->first_end[node] = c->next_end[c->first_end[node]];
    return c->first_end[node];
}

static csgm_status walk(chains *c, uint32_t start, size_t *unclosed)
{
    uint32_t node = start, end;
    csg_vec2 last = c->node_points[start];
    while ((end = take_end(c, node)) != NONE) {
        c->used[end / 2] = true;
        c->degree[node]--;
        if (!add_points(c, end))
            return CSGM_ERR_MEMORY;
        last = end_point(c->lines, end ^ 1);
        node = c->node_of[end ^ 1];
        c->degree[node]--;
        if (node == start)
            return csg_outline_close(c->out) ? CSGM_OK : CSGM_ERR_MEMORY;
    }
    ++*unclosed;
    return csg_outline_add(c->out, last) && csg_outline_close(c->out) ? CSGM_OK : CSGM_ERR_MEMORY;
}

static csgm_status walk_all(chains *c, size_t *unclosed)
{
    csgm_status status = CSGM_OK;
    for (int loose = 1; loose >= 0; loose--)
        for (uint32_t node = 0; node < c->node_count; node++)
            while (status == CSGM_OK && (loose ? c->degree[node] == 1 : c->degree[node] > 0))
                status = walk(c, node, unclosed);
    return status;
}

static csgm_status add_closed(chains *c)
{
    for (size_t i = 0; i < c->lines->count; i++) {
        const csg_polyline *line = &c->lines->items[i];
        c->used[i] = line->closed;
        for (size_t k = 0; line->closed && k < line->count; k++)
            if (!csg_outline_add(c->out, c->lines->points[line->first + k]))
                return CSGM_ERR_MEMORY;
        if (line->closed && !csg_outline_close(c->out))
            return CSGM_ERR_MEMORY;
    }
    return CSGM_OK;
}

static bool make_room(chains *c, csg_arena *arena)
{
    size_t ends = c->end_count;
    c->table_size = 16;
    while (c->table_size < ends)
        c->table_size *= 2;
    c->node_points = csg_arena_calloc(arena, ends, sizeof *c->node_points);
    c->node_of = csg_arena_calloc(arena, ends, sizeof(uint32_t));
    c->first_end = csg_arena_calloc(arena, ends, sizeof(uint32_t));
    c->last_end = csg_arena_calloc(arena, ends, sizeof(uint32_t));
    c->next_end = csg_arena_calloc(arena, ends, sizeof(uint32_t));
    c->next_node = csg_arena_calloc(arena, ends, sizeof(uint32_t));
    c->degree = csg_arena_calloc(arena, ends, sizeof(uint32_t));
    c->table = csg_arena_calloc(arena, c->table_size, sizeof(uint32_t));
    c->used = csg_arena_calloc(arena, c->lines->count + 1, sizeof *c->used);
    if (!c->node_points || !c->node_of || !c->first_end || !c->last_end || !c->next_end ||
        !c->next_node || !c->degree || !c->table || !c->used)
        return false;
    memset(c->table, 0xff, c->table_size * sizeof(uint32_t)); /* NONE */
    return true;
}

csgm_status csg_chain_lines(const csg_polylines *lines, double tolerance, csg_outline *out,
                            size_t *unclosed)
{
    csg_arena arena;
    chains c = {.lines = lines, .out = out, .tolerance = fmax(tolerance, 1e-15)};
    *unclosed = 0;
    c.end_count = 2 * lines->count;
    csg_arena_init(&arena, lines->memory);
    csgm_status status = make_room(&c, &arena) ? add_closed(&c) : CSGM_ERR_MEMORY;
    for (uint32_t end = 0; end < c.end_count && status == CSGM_OK; end++)
        if (!lines->items[end / 2].closed)
            gather_end(&c, end);
    if (status == CSGM_OK)
        status = walk_all(&c, unclosed);
    csg_arena_reset(&arena);
    return status;
}
