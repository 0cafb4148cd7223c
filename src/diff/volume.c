/* SPDX-License-Identifier: MIT
 * Volumes by rays along x, each through its own cell of a grid over the part of the y-z plane where
 * the meshes differ, at a place in the cell that differs from cell to cell. Along a ray lengths are
 * exact (crossings as the winding number counts them); where both meshes agree they contribute 0.
 * The error of the sum over cells is estimated from the differences between neighbours, twice the
 * standard error is told. The difference of both results is known from the divergence theorem and
 * corrects them.
 */
#include "diff/volume.h"

#include <stdlib.h>

#include "base/pool.h"

typedef struct event {
    double x;
    int side, step; /* what is added to that side's winding number */
} event;

typedef struct events {
    csg_memory *memory;
    event *items;
    size_t count, room;
    int side; /* whose crossings are being gathered */
    bool out_of_memory;
} events;

/* Along one ray, or sums of them. */
typedef struct lengths {
    double only_a, only_b, variance_a, variance_b;
    bool is_simple; /* no winding number but 0 and 1 was seen */
} lengths;

typedef struct casting {
    csg_diff_pair *pair;
    csg_box box;
    size_t rows; /* and columns */
    events *workers;
    lengths *row_sums;
} casting;

static void add_event(void *user, double x, int sign)
{
    events *list = user;
    void *data = list->items;
    if (!csg_memory_reserve(list->memory, &data, &list->room, list->count + 1,
                            sizeof *list->items)) {
        list->out_of_memory = true;
        return;
    }
    list->items = data;
    list->items[list->count++] = (event){x, list->side, -sign};
}

static int compare_events(const void *left, const void *right)
{
    const event *a = left, *b = right;
    return (a->x > b->x) - (a->x < b->x);
}

static void sort_events(events *list)
{
    enum { FEW = 32 };
    if (list->count > FEW) {
        qsort(list->items, list->count, sizeof *list->items, compare_events);
        return;
    }
    for (size_t i = 1; i < list->count; i++) {
        event e = list->items[i];
        size_t j = i;
        for (; j > 0 && list->items[j - 1].x > e.x; j--)
            list->items[j] = list->items[j - 1];
        list->items[j] = e;
    }
}

static lengths walk(const events *list)
{
    lengths sum = {.is_simple = true};
    int winding[2] = {0, 0};
    for (size_t i = 0; i < list->count; i++) {
        double length = i ? list->items[i].x - list->items[i - 1].x : 0;
        if (winding[0] && !winding[1])
            sum.only_a += length;
        if (winding[1] && !winding[0])
            sum.only_b += length;
        /* of crossings at one place the order says nothing */
        if (length > 0 && (winding[0] | winding[1]) >> 1)
            sum.is_simple = false;
        winding[list->items[i].side] += list->items[i].step;
    }
    return sum;
}

/* 0 <= fraction < 1, other for each index. */
static double fraction(uint64_t index, uint64_t factor)
{
    return (double)(((index + 1) * factor) >> 11) * 0x1p-53;
}

static double place_in(double low, double high, size_t cell, size_t cells, double within)
{
    return csg_triangle_frame_round(low + (high - low) * (((double)cell + within) / (double)cells));
}

static lengths cast(const casting *c, events *list, size_t row, size_t column)
{
    uint64_t index = (uint64_t)row * c->rows + column;
    double y =
        place_in(c->box.min.y, c->box.max.y, column, c->rows, fraction(index, 0xC13FA9A902A6328Fu));
    double z =
        place_in(c->box.min.z, c->box.max.z, row, c->rows, fraction(index, 0x91E10DA5C79E7B1Du));
    list->count = 0;
    for (list->side = 0; list->side < 2; list->side++)
        if (c->pair->sides[list->side].chain.count)
            csg_tree_line_crossings(&c->pair->sides[list->side].tree, y, z, add_event, list);
    sort_events(list);
    return walk(list);
}

static double square(double x)
{
    return x * x;
}

static bool cast_row(void *user, uint32_t worker, size_t row)
{
    const casting *c = user;
    events *list = &c->workers[worker];
    lengths sum = {.is_simple = true}, last = {.only_a = 0};
    for (size_t column = 0; column < c->rows; column++) {
        lengths l = cast(c, list, row, column);
        sum.only_a += l.only_a;
        sum.only_b += l.only_b;
        sum.is_simple = sum.is_simple && l.is_simple;
        if (column % 2) {
            sum.variance_a += square(l.only_a - last.only_a);
            sum.variance_b += square(l.only_b - last.only_b);
        }
        last = l;
    }
    c->row_sums[row] = sum;
    return !list->out_of_memory && !csg_diff_is_cancelled(c->pair);
}

static double volume_of(const csg_diff_side *side)
{
    return side->chain.count ? side->check.volume : 0;
}

/* only_b - only_a is known better than either. */
static void correct(csgm_diff_volume *out, double net)
{
    double error = out->only_b - out->only_a - net, sum = out->only_a + out->only_b;
    if (sum > 0) {
        double part = error / sum;
        out->only_a = fmax(0, out->only_a * (1 + part));
        out->only_b = fmax(0, out->only_b * (1 - part));
    } else {
        out->only_a = fmax(0, -net);
        out->only_b = fmax(0, net);
    }
    out->accuracy = fmax(out->accuracy, fabs(error));
}

static void summarize(const casting *c, csgm_diff_volume *out)
{
    lengths sum = {.is_simple = true};
    for (size_t row = 0; row < c->rows; row++) {
        const lengths *r = &c->row_sums[row];
        sum.only_a += r->only_a;
        sum.only_b += r->only_b;
        sum.variance_a += r->variance_a;
        sum.variance_b += r->variance_b;
        sum.is_simple = sum.is_simple && r->is_simple;
    }
    csg_vec3 size = csg_box_size(c->box);
    double unit = c->pair->frame.unscale;
    double cell = size.y * size.z / ((double)c->rows * (double)c->rows) * unit * unit * unit;
    double a = volume_of(&c->pair->sides[0]), b = volume_of(&c->pair->sides[1]);
    out->only_a = sum.only_a * cell;
    out->only_b = sum.only_b * cell;
    out->accuracy = 2 * cell * sqrt(fmax(sum.variance_a, sum.variance_b));
    if (sum.is_simple)
        correct(out, b - a);
    out->both = fmax(0, fmin(fabs(a) - out->only_a, fabs(b) - out->only_b));
}

static void report_rows(void *user, size_t done, size_t count)
{
    csg_diff_tell(((casting *)user)->pair, done, count);
}

static csgm_status cast_all(casting *c, csgm_diff_volume *out)
{
    csg_memory *memory = &c->pair->context->memory;
    uint32_t threads = csg_pool_threads(c->pair->context->pool);
    csg_arena_mark mark = csg_arena_get_mark(&c->pair->arena);
    csgm_status status = CSGM_OK;
    c->workers = csg_arena_calloc(&c->pair->arena, threads, sizeof *c->workers);
    c->row_sums = csg_arena_calloc(&c->pair->arena, c->rows, sizeof *c->row_sums);
    bool out_of_memory = !c->workers || !c->row_sums;
    for (uint32_t i = 0; i < threads && c->workers; i++)
        c->workers[i].memory = memory;
    csg_diff_take(c->pair, 0.5);
    if (!out_of_memory && !csg_pool_run(c->pair->context->pool, c->rows, cast_row, report_rows, c))
        status = CSGM_CANCELLED;
    for (uint32_t i = 0; i < threads && c->workers; i++) {
        out_of_memory |= c->workers[i].out_of_memory;
        csg_memory_release(memory, c->workers[i].items,
                           c->workers[i].room * sizeof *c->workers[i].items);
    }
    if (out_of_memory)
        status = csg_context_no_memory(c->pair->context);
    if (status == CSGM_OK)
        summarize(c, out);
    csg_arena_release_to(&c->pair->arena, mark);
    return status;
}

csgm_status csg_diff_measure_volume(csg_diff_pair *pair, csg_box differing, uint64_t rays,
                                    csgm_diff_volume *out)
{
    casting c = {.pair = pair, .box = differing, .rows = (size_t)ceil(sqrt((double)rays))};
    csgm_status status = CSGM_OK;
    *out = (csgm_diff_volume){.is_measured = true};
    if (csg_box_is_empty(differing)) /* the same solid */
        out->both = fabs(volume_of(&pair->sides[0]));
    else
        status = cast_all(&c, out);
    double only = out->only_a + out->only_b, whole = only + out->both;
    out->ratio = whole > 0 ? only / whole : 0;
    return status;
}
