/* SPDX-License-Identifier: MIT
 * Counting where edges meet (crossings.h), until there are too many: edges are entered in the cells
 * of a grid that they pass, full cells get a grid of their own, and in the others each pair is
 * looked at. What is counted lies at a place, and counts in the cell of that place only.
 */
#include "shape/plane/crossings.h"

#include <math.h>
#include <string.h>

enum {
    ALWAYS_FEW = 1000,  /* points: not enough pairs */
    EDGES_PER_CELL = 8, /* if each passed one only */
    FULL_CELL = 64,     /* edges */
    MOST_GRIDS = 12,    /* within each other; each at least halves the cell */
    MOST_CELLS = 1 << 20,
    MOST_TESTS = 200000000, /* of pairs: a third of a second */
    NO_ENTRY = -1
};

/* Edges that run along each other cost Clipper as much as so many crossings. */
enum { CROSSINGS_OF_ALONG = 4 };

typedef struct edge {
    double ax, ay, bx, by;
} edge;

typedef struct entry {
    uint32_t edge;
    int32_t next; /* in its cell */
} entry;

typedef struct cells {
    double x, y, width, height; /* of all; */
    double per_x, per_y;        /* cells a length */
    uint32_t columns, rows;
} cells;

typedef struct crossings {
    csg_memory *memory;
    edge *edges;
    size_t edge_count;
    uint64_t count, most, tests;
    bool out_of_memory;
} crossings;

static bool is_over(const crossings *c)
{
    return c->out_of_memory || c->count > c->most || c->tests > MOST_TESTS;
}

/* ---- pairs -------------------------------------------------------------------------------- */

/* Twice the area of a, b, (x, y); 0 within a step of the line. */
static double side_of(const edge *e, double x, double y)
{
    double dx = e->bx - e->ax, dy = e->by - e->ay;
    double area = dx * (y - e->ay) - dy * (x - e->ax);
    return area * area <= dx * dx + dy * dy ? 0 : area;
}

static bool is_apart(const edge *e, const edge *f)
{
    return fmax(e->ax, e->bx) < fmin(f->ax, f->bx) || fmax(f->ax, f->bx) < fmin(e->ax, e->bx) ||
           fmax(e->ay, e->by) < fmin(f->ay, f->by) || fmax(f->ay, f->by) < fmin(e->ay, e->by);
}

static bool is_same(double ax, double ay, double bx, double by)
{
    return ax == bx && ay == by;
}

static bool share_an_end(const edge *e, const edge *f)
{
    return is_same(e->ax, e->ay, f->ax, f->ay) || is_same(e->ax, e->ay, f->bx, f->by) ||
           is_same(e->bx, e->by, f->ax, f->ay) || is_same(e->bx, e->by, f->bx, f->by);
}

/* Where edges on one line lie along each other: the middle of that; false: they do not. */
static bool find_along(const edge *e, const edge *f, double *x, double *y)
{
    double x0 = fmax(fmin(e->ax, e->bx), fmin(f->ax, f->bx));
    double x1 = fmin(fmax(e->ax, e->bx), fmax(f->ax, f->bx));
    double y0 = fmax(fmin(e->ay, e->by), fmin(f->ay, f->by));
    double y1 = fmin(fmax(e->ay, e->by), fmax(f->ay, f->by));
    *x = 0.5 * (x0 + x1);
    *y = 0.5 * (y0 + y1);
    return x1 - x0 > 1 || y1 - y0 > 1;
}

/* How many crossings the pair counts as, and where. */
static unsigned meeting(const edge *e, const edge *f, double *x, double *y)
{
    double fa = side_of(e, f->ax, f->ay), fb = side_of(e, f->bx, f->by);
    if ((fa > 0 && fb > 0) || (fa < 0 && fb < 0))
        return 0;
    double ea = side_of(f, e->ax, e->ay), eb = side_of(f, e->bx, e->by);
    if ((ea > 0 && eb > 0) || (ea < 0 && eb < 0))
        return 0;
    if (fa == 0 && fb == 0)
        return find_along(e, f, x, y) ? CROSSINGS_OF_ALONG : 0;
    if (share_an_end(e, f))
        return 0;
    double t = fa / (fa - fb);
    *x = f->ax + t * (f->bx - f->ax);
    *y = f->ay + t * (f->by - f->ay);
    return 1;
}

static void test_cell(crossings *c, const cells *cell, const entry *entries, int32_t first)
{
    double x, y;
    for (int32_t i = first; i != NO_ENTRY; i = entries[i].next) {
        const edge *e = &c->edges[entries[i].edge];
        for (int32_t k = entries[i].next; k != NO_ENTRY; k = entries[k].next) {
            const edge *f = &c->edges[entries[k].edge];
            c->tests++;
            unsigned here = is_apart(e, f) ? 0 : meeting(e, f, &x, &y);
            if (here && x >= cell->x && x < cell->x + cell->width && y >= cell->y &&
                y < cell->y + cell->height)
                c->count += here;
        }
        if (is_over(c))
            return;
    }
}

/* ---- cells -------------------------------------------------------------------------------- */

static uint32_t index_along(double at, double per_length, uint32_t count)
{
    double i = at * per_length;
    return i > 0 ? (i < count - 1 ? (uint32_t)i : count - 1) : 0;
}

static cells make_cells(double x, double y, double width, double height, size_t edges)
{
    double most = fmin(fmax((double)edges / EDGES_PER_CELL, 4), MOST_CELLS);
    double columns = fmin(fmax(sqrt(most * width / height), 1), most);
    cells g = {.x = x, .y = y, .width = width, .height = height};
    g.columns = (uint32_t)columns;
    g.rows = (uint32_t)fmax(most / g.columns, 1);
    g.per_x = g.columns / width;
    g.per_y = g.rows / height;
    return g;
}

static cells cell_at(const cells *g, uint32_t column, uint32_t row)
{
    double width = g->width / g->columns, height = g->height / g->rows;
    return (cells){
        .x = g->x + column * width, .y = g->y + row * height, .width = width, .height = height};
}

typedef struct grid_entries {
    cells cells;
    int32_t *heads; /* per cell */
    uint32_t *counts;
    entry *entries;
    size_t entry_count, entry_capacity;
} grid_entries;

static bool enter(crossings *c, grid_entries *g, size_t cell, uint32_t edge_number)
{
    void *data = g->entries;
    if (g->entry_count >= INT32_MAX ||
        !csg_memory_reserve(c->memory, &data, &g->entry_capacity, g->entry_count + 1,
                            sizeof *g->entries)) {
        c->out_of_memory = true;
        return false;
    }
    g->entries = data;
    g->entries[g->entry_count] = (entry){edge_number, g->heads[cell]};
    g->heads[cell] = (int32_t)g->entry_count++;
    g->counts[cell]++;
    c->tests++;
    return true;
}

/* The cells that the edge passes, row by row; one more at either side for rounding. */
static bool enter_edge(crossings *c, grid_entries *g, uint32_t number)
{
    const cells *at = &g->cells;
    const edge *e = &c->edges[number];
    bool is_up = e->ay <= e->by;
    double x0 = is_up ? e->ax : e->bx, y0 = is_up ? e->ay : e->by;
    double x1 = is_up ? e->bx : e->ax, y1 = is_up ? e->by : e->ay;
    double slope = y1 > y0 ? (x1 - x0) / (y1 - y0) : 0, height = at->height / at->rows;
    uint32_t last = index_along(y1 - at->y + 1, at->per_y, at->rows);
    for (uint32_t row = index_along(y0 - at->y - 1, at->per_y, at->rows); row <= last; row++) {
        double low = fmax(y0, at->y + row * height - 1);
        double high = fmin(y1, at->y + (row + 1) * height + 1);
        double from = y1 > y0 ? x0 + (low - y0) * slope : x0;
        double to = y1 > y0 ? x0 + (high - y0) * slope : x1;
        double left = fmin(from, to) - 1, right = fmax(from, to) + 1;
        if (right < at->x || left > at->x + at->width)
            continue;
        uint32_t end = index_along(right - at->x, at->per_x, at->columns);
        uint32_t column = index_along(left - at->x, at->per_x, at->columns);
        for (; column <= end; column++)
            if (!enter(c, g, (size_t)row * at->columns + column, number))
                return false;
    }
    return true;
}

static void count_in(crossings *c, const cells *cell, const entry *entries, int32_t first,
                     uint32_t count, unsigned depth);

/* Whether looking at all pairs cell by cell is less than looking at all pairs. */
static bool is_worth_it(const grid_entries *g, double outer)
{
    double pairs = 0;
    for (size_t i = 0; i < (size_t)g->cells.columns * g->cells.rows; i++)
        pairs += (double)g->counts[i] * (double)g->counts[i];
    return pairs <= outer * outer;
}

static void count_in_cells(crossings *c, const grid_entries *g, unsigned depth)
{
    for (uint32_t row = 0; row < g->cells.rows; row++) {
        for (uint32_t column = 0; column < g->cells.columns && !is_over(c); column++) {
            size_t i = (size_t)row * g->cells.columns + column;
            cells cell = cell_at(&g->cells, column, row);
            count_in(c, &cell, g->entries, g->heads[i], g->counts[i], depth + 1);
        }
    }
}

/* The edges of a cell, as a list of entries. The recursion ends with `depth`. */
static void count_in(crossings *c, const cells *cell, const entry *entries, int32_t first,
                     uint32_t count, unsigned depth)
{
    if (count < 2)
        return;
    if (count <= FULL_CELL || depth >= MOST_GRIDS || cell->width < 4 || cell->height < 4) {
        test_cell(c, cell, entries, first);
        return;
    }
    grid_entries g = {.cells = make_cells(cell->x, cell->y, cell->width, cell->height, count)};
    size_t cell_count = (size_t)g.cells.columns * g.cells.rows;
    size_t bytes = cell_count * (sizeof *g.heads + sizeof *g.counts);
    g.heads = csg_memory_alloc(c->memory, bytes);
    c->out_of_memory = !g.heads;
    if (!g.heads)
        return;
    g.counts = (uint32_t *)(g.heads + cell_count);
    memset(g.heads, 0xff, cell_count * sizeof *g.heads); /* NO_ENTRY */
    memset(g.counts, 0, cell_count * sizeof *g.counts);
    bool is_room = true;
    for (int32_t i = first; i != NO_ENTRY && is_room; i = entries[i].next)
        is_room = enter_edge(c, &g, entries[i].edge);
    if (is_room && is_worth_it(&g, count))
        count_in_cells(c, &g, depth);
    else if (is_room)
        test_cell(c, cell, entries, first);
    csg_memory_release(c->memory, g.heads, bytes);
    csg_memory_release(c->memory, g.entries, g.entry_capacity * sizeof *g.entries);
}

/* ---- all ---------------------------------------------------------------------------------- */

/* Edges of no length are none. */
static void add_edges(crossings *c, entry *all, const csg_clipper_loops *loops)
{
    for (size_t loop = 0, i = 0; loop < loops->loop_count; loop++) {
        size_t end = loops->ends[loop], first = i;
        for (; i < end; i++) {
            csg_clipper_point a = loops->points[i], b = loops->points[i + 1 < end ? i + 1 : first];
            if (a.x == b.x && a.y == b.y)
                continue;
            size_t n = c->edge_count++;
            c->edges[n] = (edge){(double)a.x, (double)a.y, (double)b.x, (double)b.y};
            all[n] = (entry){(uint32_t)n, n ? (int32_t)n - 1 : NO_ENTRY};
        }
    }
}

static cells box_of(const crossings *c)
{
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (size_t i = 0; i < c->edge_count; i++) {
        const edge *e = &c->edges[i];
        x0 = fmin(x0, e->ax); /* each end is the beginning of another */
        y0 = fmin(y0, e->ay);
        x1 = fmax(x1, e->ax);
        y1 = fmax(y1, e->ay);
    }
    return (cells){.x = x0 - 1, .y = y0 - 1, .width = x1 - x0 + 2, .height = y1 - y0 + 2};
}

csgm_status csg_crossings_check(csg_memory *memory, const csg_clipper_loops *loops, csg_fill fill)
{
    size_t count = loops->loop_count ? loops->ends[loops->loop_count - 1] : 0;
    if (count <= ALWAYS_FEW)
        return CSGM_OK;
    size_t bytes = count * (sizeof(edge) + sizeof(entry));
    crossings c = {.memory = memory};
    c.most = fill == CSG_FILL_EVEN_ODD ? CSG_MOST_CROSSINGS : CSG_MOST_CROSSINGS_NONZERO;
    c.edges = csg_memory_alloc(memory, bytes);
    if (!c.edges)
        return CSGM_ERR_MEMORY;
    entry *all = (entry *)(c.edges + count);
    add_edges(&c, all, loops);
    if (c.edge_count) {
        cells box = box_of(&c);
        count_in(&c, &box, all, (int32_t)c.edge_count - 1, (uint32_t)c.edge_count, 0);
    }
    csg_memory_release(memory, c.edges, bytes);
    return c.out_of_memory ? CSGM_ERR_MEMORY : is_over(&c) ? CSGM_ERR_LIMIT : CSGM_OK;
}
