/* SPDX-License-Identifier: MIT
 * Tables of heights and the solid over a field; see heights.h. Images: png.c.
 */
#include "outline/heights/heights.h"

#include <string.h>

void csg_heights_release(csg_heights *heights)
{
    if (heights->values)
        csg_memory_release(heights->memory, heights->values,
                           heights->columns * heights->rows * sizeof(double));
    *heights = (csg_heights){.memory = heights->memory};
}

/* A reader of one table; it goes over the text twice, first to count. */
typedef struct table {
    const char *at, *end;
    size_t line, columns, rows, missing;
    double *values; /* NULL: counting */
    double lowest;
    csg_problem *problem;
} table;

static csgm_status read_row(table *t, size_t *count)
{
    const char *line_end = memchr(t->at, '\n', (size_t)(t->end - t->at));
    line_end = line_end ? line_end : t->end;
    double value;
    for (*count = 0;; ++*count) {
        while (t->at < line_end && csg_is_blank(*t->at))
            t->at++;
        if (t->at == line_end || *t->at == '#')
            break;
        if (!csg_number_scan(&t->at, line_end, &value) ||
            (t->at < line_end && !csg_is_blank(*t->at) && *t->at != '#'))
            return csg_problem_set(t->problem, CSGM_ERR_FORMAT,
                                   "line %zu of the table of heights has something that is not a "
                                   "number",
                                   t->line);
        if (fabs(value) > CSG_INPUT_MOST_COORDINATE)
            return csg_problem_set(t->problem, CSGM_ERR_FORMAT,
                                   "line %zu of the table of heights has a number beyond 1e15",
                                   t->line);
        t->lowest = fmin(t->lowest, value);
        if (t->values)
            t->values[t->rows * t->columns + *count] = value;
    }
    t->at = line_end < t->end ? line_end + 1 : t->end;
    return CSGM_OK;
}

static csgm_status read_rows(table *t)
{
    t->line = 1;
    t->rows = 0;
    for (; t->at < t->end; t->line++) {
        size_t count;
        csgm_status status = read_row(t, &count);
        if (status != CSGM_OK)
            return status;
        if (count == 0)
            continue;
        if (!t->values && count > t->columns)
            t->columns = count;
        t->missing += t->columns - count;
        t->rows++;
    }
    return CSGM_OK;
}

csgm_status csg_heights_from_text(csg_memory *memory, const char *text, size_t length,
                                  csg_heights *out, csg_problem *problem)
{
    table t = {.at = text, .end = text + length, .lowest = INFINITY, .problem = problem};
    *out = (csg_heights){.memory = memory};
    csgm_status status = read_rows(&t);
    if (status != CSGM_OK)
        return status;
    if (t.rows == 0)
        return csg_problem_set(problem, CSGM_ERR_FORMAT, "the table of heights has no rows");
    if (t.columns > CSG_HEIGHTS_MOST / t.rows)
        return csg_problem_set(problem, CSGM_ERR_LIMIT, "the table has more than %zu heights",
                               CSG_HEIGHTS_MOST);
    size_t bytes = t.columns * t.rows * sizeof(double);
    t.values = csg_memory_alloc(memory, bytes);
    if (!t.values)
        return CSGM_ERR_MEMORY;
    memset(t.values, 0, bytes);
    t.at = text;
    t.missing = 0;
    read_rows(&t); /* cannot fail the second time */
    *out = (csg_heights){memory, t.columns, t.rows, t.values, t.lowest, t.missing};
    return CSGM_OK;
}

csgm_status csg_heights_from_bytes(csg_memory *memory, const csg_bytes *bytes, bool invert,
                                   csg_heights *out, csg_problem *problem)
{
    if (bytes->size >= 4 && memcmp(bytes->data, "\x89PNG", 4) == 0)
        return csg_heights_from_png(memory, bytes->data, bytes->size, invert, out, problem);
    return csg_heights_from_text(memory, bytes->data, bytes->size, out, problem);
}

/* ---- the solid ---------------------------------------------------------------------- */

/* Points: the values, the centres of the cells, the rim of the base, the middle of the base. */
typedef struct builder {
    const csg_heights *field;
    csg_triangles *out;
    csg_vec3 shift;
    bool failed;
} builder;

static void add_point(builder *b, double x, double y, double z)
{
    b->failed |= !csg_triangles_add_point(b->out, csg_vec3_add(csg_vec3_make(x, y, z), b->shift));
}

static void add_triangle(builder *b, size_t a, size_t c, size_t d)
{
    b->failed |= !csg_triangles_add(b->out, (uint32_t)a, (uint32_t)c, (uint32_t)d);
}

static double value_at(const csg_heights *field, size_t column, size_t row)
{
    return field->values[row * field->columns + column];
}

static void add_top(builder *b)
{
    const csg_heights *f = b->field;
    size_t columns = f->columns, rows = f->rows;
    for (size_t y = 0; y < rows && !b->failed; y++)
        for (size_t x = 0; x < columns; x++)
            add_point(b, (double)x, (double)y, value_at(f, x, y));
    for (size_t y = 0; y + 1 < rows && !b->failed; y++)
        for (size_t x = 0; x + 1 < columns; x++) {
            size_t a = y * columns + x, corners[4] = {a, a + 1, a + columns + 1, a + columns};
            size_t middle = columns * rows + y * (columns - 1) + x;
            add_point(b, (double)x + 0.5, (double)y + 0.5,
                      (value_at(f, x, y) + value_at(f, x + 1, y) + value_at(f, x, y + 1) +
                       value_at(f, x + 1, y + 1)) /
                          4);
            for (size_t i = 0; i < 4; i++)
                add_triangle(b, corners[i], corners[(i + 1) % 4], middle);
        }
}

/* The value below which point `i` of the rim stands, counter-clockwise from the origin. */
static size_t rim_value(const csg_heights *f, size_t i)
{
    size_t right = f->columns - 1, up = f->rows - 1;
    if (i < right)
        return i;
    if (i < right + up)
        return (i - right) * f->columns + right;
    if (i < 2 * right + up)
        return up * f->columns + (2 * right + up - i);
    return (2 * right + 2 * up - i) * f->columns;
}

static void add_sides_and_base(builder *b, double base)
{
    const csg_heights *f = b->field;
    size_t rim = 2 * (f->columns + f->rows - 2);
    size_t first = f->columns * f->rows + (f->columns - 1) * (f->rows - 1), middle = first + rim;
    for (size_t i = 0; i < rim && !b->failed; i++) {
        size_t value = rim_value(f, i);
        add_point(b, (double)(value % f->columns), (double)(value / f->columns), base);
    }
    add_point(b, (double)(f->columns - 1) / 2, (double)(f->rows - 1) / 2, base);
    for (size_t i = 0; i < rim && !b->failed; i++) {
        size_t next = (i + 1) % rim, top = rim_value(f, i), next_top = rim_value(f, next);
        add_triangle(b, first + i, first + next, next_top);
        add_triangle(b, first + i, next_top, top);
        add_triangle(b, first + next, first + i, middle);
    }
}

csgm_status csg_heights_solid(const csg_heights *heights, bool center, csg_triangles *out,
                              csg_problem *problem)
{
    csg_triangles_init(out, heights->memory);
    if (heights->columns < 2 || heights->rows < 2)
        return csg_problem_set(problem, CSGM_ERR_SCENE,
                               "a solid needs at least 2 x 2 heights, here are %zu x %zu",
                               heights->columns, heights->rows);
    builder b = {.field = heights, .out = out};
    if (center)
        b.shift =
            csg_vec3_make(-(double)(heights->columns - 1) / 2, -(double)(heights->rows - 1) / 2, 0);
    add_top(&b);
    add_sides_and_base(&b, fmin(0, heights->lowest - 1));
    if (!b.failed)
        return CSGM_OK;
    csg_triangles_release(out);
    return CSGM_ERR_MEMORY;
}
