/* SPDX-License-Identifier: MIT
 * The walk through a drawing and its blocks, and what is made of its lines; see dxf.h.
 */
#include "outline/dxf/dxf.h"

#include <string.h>

#include "base/elementary.h"
#include "outline/dxf/chain.h"
#include "outline/dxf/dxf_entity.h"
#include "shape/plane/polygons.h"

enum { MOST_DEPTH = 32, MOST_VISITS = 2 << 20, MOST_ARRAY = 10000 };

typedef struct drawing {
    const csg_dxf_request *request;
    csg_dxf_report *report;
    csg_dxf_file file;
    csg_polylines lines;
    size_t visits;           /* of entities of blocks, and of their bytes */
    size_t open[MOST_DEPTH]; /* the blocks that are being drawn */
    size_t depth;
    csgm_status status;
    bool is_tangled; /* too much so to make areas of its lines */
} drawing;

typedef struct place {
    csg_affine map;
    csg_dxf_text layer; /* of the INSERT: what layer 0 of a block means */
} place;

static void draw_block(drawing *d, size_t block, const place *p);

/* Entities with an extrusion of 0 0 -1 are seen from behind. ELLIPSE, LINE and SPLINE have
 * coordinates of the world. */
static bool is_mirrored(const csg_dxf_entity *e)
{
    static const char *const flat[] = {"CIRCLE", "ARC",   "LWPOLYLINE", "POLYLINE",
                                       "INSERT", "SOLID", "TRACE"};
    for (size_t i = 0; i < sizeof flat / sizeof *flat; i++)
        if (csg_dxf_text_is(e->kind, flat[i]))
            return csg_dxf_get(e, 230, 1) < 0;
    return false;
}

static csg_affine shift(double x, double y)
{
    return csg_affine_translate(csg_vec3_make(x, y, 0));
}

static size_t find_block(const csg_dxf_file *file, csg_dxf_text name)
{
    for (size_t i = 1; i < file->block_count; i++)
        if (file->blocks[i].name.length == name.length &&
            memcmp(file->blocks[i].name.begin, name.begin, name.length) == 0)
            return i;
    return 0;
}

static double count_at(const csg_dxf_entity *e, int code)
{
    return fmin(fmax(floor(csg_dxf_get(e, code, 1)), 1), MOST_ARRAY);
}

static void draw_insert(drawing *d, const csg_dxf_entity *e, const place *p)
{
    size_t block = find_block(&d->file, csg_dxf_get_text(e, 2));
    d->visits += d->file.block_count / 64; /* the search costs time too */
    bool inside = d->depth >= MOST_DEPTH;
    for (size_t i = 0; i < d->depth && !inside; i++)
        inside = d->open[i] == block;
    if (block == 0 || inside) {
        d->report->unresolved++;
        return;
    }
    csg_vec2 base = d->file.blocks[block].base;
    csg_affine scale =
        csg_affine_scale(csg_vec3_make(csg_dxf_get(e, 41, 1), csg_dxf_get(e, 42, 1), 1));
    csg_affine turn = csg_affine_rotate(fmod(csg_dxf_get(e, 50, 0), 360), csg_vec3_make(0, 0, 1));
    csg_affine put = csg_affine_multiply(shift(csg_dxf_get(e, 10, 0), csg_dxf_get(e, 20, 0)), turn);
    csg_affine inner = csg_affine_multiply(scale, shift(-base.x, -base.y));
    double columns = count_at(e, 70), rows = count_at(e, 71);
    double dx = csg_dxf_get(e, 44, 0), dy = csg_dxf_get(e, 45, 0);
    place q = *p;
    d->open[d->depth++] = block;
    for (double row = 0; row < rows && d->status == CSGM_OK; row++)
        for (double column = 0; column < columns && d->status == CSGM_OK; column++) {
            csg_affine cell = csg_affine_multiply(put, shift(column * dx, row * dy));
            q.map = csg_affine_multiply(p->map, csg_affine_multiply(cell, inner));
            d->visits++;
            draw_block(d, block, &q);
        }
    d->depth--;
}

static void note_ignored(drawing *d, const csg_dxf_entity *e)
{
    csg_dxf_report *report = d->report;
    size_t length = e->kind.length < sizeof report->ignored_kind - 1
                        ? e->kind.length
                        : sizeof report->ignored_kind - 1;
    if (report->ignored++ > 0)
        return;
    for (size_t i = 0; i < length; i++) /* the file's bytes go into a message */
        report->ignored_kind[i] =
            e->kind.begin[i] >= ' ' && e->kind.begin[i] < 0x7f ? e->kind.begin[i] : '?';
}

static void draw_entity(drawing *d, size_t index, size_t past, const place *outer)
{
    const csg_dxf_entity *e = &d->file.entities[index];
    const char *wanted = d->request->layer;
    place p = *outer;
    if (csg_dxf_text_is(e->kind, "VERTEX") || csg_dxf_text_is(e->kind, "SEQEND") || e->paper)
        return;
    if (!csg_dxf_text_is(e->layer, "0") || d->depth == 0)
        p.layer = e->layer;
    if (is_mirrored(e))
        p.map = csg_affine_multiply(p.map, csg_affine_scale(csg_vec3_make(-1, 1, 1)));
    if (csg_dxf_text_is(e->kind, "INSERT")) {
        draw_insert(d, e, &p);
        return;
    }
    if (wanted && *wanted && !csg_dxf_text_is(p.layer, wanted))
        return;
    d->report->not_found = false;
    double(*m)[3] = p.map.m;
    double stretch = csg_hypot(csg_hypot(m[0][0], m[0][1]), csg_hypot(m[1][0], m[1][1]));
    size_t first = d->lines.count;
    bool drawn = false;
    d->status = csg_dxf_draw(&d->file, index, past, d->request, stretch, &d->lines, &drawn);
    csg_polylines_transform(&d->lines, first, &p.map);
    if (drawn)
        d->report->entities++;
    else
        note_ignored(d, e);
}

static void draw_block(drawing *d, size_t block, const place *p)
{
    const csg_dxf_block *b = &d->file.blocks[block];
    for (size_t i = 0; i < b->count && d->status == CSGM_OK; i++) {
        const csg_dxf_entity *e = &d->file.entities[b->first + i];
        if (d->depth > 0) /* each is looked through anew */
            d->visits += 1 + (size_t)(e->end - e->begin) / 64;
        if (d->visits > MOST_VISITS) {
            d->status = csg_problem_set(&d->report->problem, CSGM_ERR_LIMIT,
                                        "its blocks hold too many entities");
            return;
        }
        draw_entity(d, b->first + i, b->first + b->count, p);
    }
}

/* ---- from lines to areas ----------------------------------------------------------------- */

static double unit_in_mm(int code)
{
    static const double units[] = {0,      25.4,  304.8, 1609344, 1,    10,  1000, 1e6, 25.4e-6,
                                   0.0254, 914.4, 1e-7,  1e-6,    1e-3, 100, 1e4,  1e5, 1e12};
    return code > 0 && code < (int)(sizeof units / sizeof *units) ? units[code] : 0;
}

static bool is_bounded(const csg_polylines *lines)
{
    for (size_t i = 0; i < lines->point_count; i++)
        if (!(fabs(lines->points[i].x) <= CSG_INPUT_MOST_COORDINATE &&
              fabs(lines->points[i].y) <= CSG_INPUT_MOST_COORDINATE))
            return false;
    return true;
}

/* Ends meet within 1e-5 of the drawing's size: what programs round their numbers to. */
static double reach_of(const csg_polylines *lines)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < lines->point_count; i++) {
        csg_vec3 p = csg_vec3_make(lines->points[i].x, lines->points[i].y, 0);
        box = csg_box_hull(box, (csg_box){p, p});
    }
    csg_vec3 size = lines->point_count ? csg_box_size(box) : csg_vec3_make(0, 0, 0);
    return 1e-5 * csg_hypot(size.x, size.y);
}

static csgm_status make_outline(drawing *d, csg_memory *memory, csg_outline *out)
{
    csg_outline loops;
    if (!is_bounded(&d->lines))
        return csg_problem_set(&d->report->problem, CSGM_ERR_FORMAT,
                               "it has coordinates beyond 1e15");
    csg_outline_init(&loops, memory);
    csgm_status status =
        csg_chain_lines(&d->lines, reach_of(&d->lines), &loops, &d->report->unclosed);
    if (status == CSGM_OK && loops.loop_count > 0) {
        csg_outline_release(out);
        status = csg_polygons_clean(&loops, CSG_FILL_EVEN_ODD, out);
        if (status == CSGM_ERR_LIMIT)
            d->is_tangled = true;
    }
    csg_outline_release(&loops);
    return status;
}

static csgm_status draw_all(drawing *d, csg_memory *memory, csg_outline *out)
{
    const csg_dxf_request *q = d->request;
    double scale = q->scale != 0 ? q->scale : 1;
    place p = {.map = csg_affine_multiply(csg_affine_scale(csg_vec3_make(scale, scale, 1)),
                                          shift(-q->origin.x, -q->origin.y)),
               .layer = {"0", 1}};
    d->report->not_found = q->layer && *q->layer;
    d->report->unit_mm = unit_in_mm(d->file.units);
    csg_polylines_init(&d->lines, memory);
    draw_block(d, 0, &p);
    if (d->status == CSGM_OK)
        d->status = make_outline(d, memory, out);
    if (d->status == CSGM_ERR_LIMIT)
        csg_problem_set(&d->report->problem, d->status,
                        d->is_tangled ? "its lines cross or cover each other too often"
                                      : "its curves have too many points");
    csg_polylines_release(&d->lines);
    return d->status;
}

csgm_status csg_dxf_outline(csg_memory *memory, const csg_dxf_request *request, csg_outline *out,
                            csg_dxf_report *report)
{
    drawing d = {.request = request, .report = report};
    *report = (csg_dxf_report){0};
    csg_outline_init(out, memory);
    csgm_status status =
        csg_dxf_read(memory, request->text, request->length, &d.file, &report->problem);
    if (status != CSGM_OK)
        return status;
    status = draw_all(&d, memory, out);
    csg_dxf_release(&d.file);
    if (status == CSGM_ERR_UNSUPPORTED)
        csg_problem_set(&report->problem, status,
                        "this build cannot read DXF files (made without Clipper)");
    if (status != CSGM_OK) {
        csg_outline_release(out);
    } else if (request->center && out->point_count) {
        csg_affine map =
            csg_affine_translate(csg_vec3_scale(csg_box_center(csg_outline_box(out)), -1));
        csg_outline_transform(out, &map);
    }
    return status;
}
