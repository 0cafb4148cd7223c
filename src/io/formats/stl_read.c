/* SPDX-License-Identifier: MIT
 * STL -> mesh. Binary or ASCII is told by content: a file whose size is the one that its count says
 * is binary, whatever its header; else one that begins with "solid" is text. Corners at the same
 * place become one vertex. Facet normals are not kept: they say nothing that the corners do not.
 */
#include <math.h>

#include "base/places.h"
#include "io/text/scan.h"

/* ---- welding ---------------------------------------------------------------------- */

typedef struct weld {
    csg_mesh_builder *builder;
    csg_table table; /* of its vertices */
} weld;

/* Positions of the builder as points. */
static const csg_vec3 *points_of(const csg_mesh_builder *builder)
{
    return (const csg_vec3 *)builder->positions;
}

static bool find_or_add(weld *w, const double *p, uint32_t *vertex)
{
    csg_mesh_builder *b = w->builder;
    if (!csg_table_reserve(&w->table, b->vertex_count + 1, csg_place_hash_of, b->positions)) {
        b->failed = true;
        return false;
    }
    size_t slot;
    *vertex = csg_place_find(&w->table, points_of(b), csg_vec3_make(p[0], p[1], p[2]), &slot);
    if (*vertex != CSG_TABLE_NONE)
        return true;
    *vertex = (uint32_t)b->vertex_count;
    csg_table_put(&w->table, slot, *vertex);
    return csg_builder_vertex(b, p, NULL, NULL);
}

static bool add_facet(weld *w, double corners[3][3])
{
    uint32_t v[3];
    for (int c = 0; c < 3; c++)
        if (!find_or_add(w, corners[c], &v[c]))
            return false;
    return csg_builder_triangle(w->builder, v[0], v[1], v[2]);
}

/* ---- binary ----------------------------------------------------------------------- */

enum { HEADER = 84, FACET = 50 };

static csgm_status read_binary(csg_input *input, weld *w)
{
    uint64_t count = csg_load_u32(input->bytes + 80);
    if (count > (input->size_bytes - HEADER) / FACET)
        return csg_read_broken(
            input, 0, "the file ends too soon: it says %llu triangles and has room for %llu",
            (unsigned long long)count, (unsigned long long)((input->size_bytes - HEADER) / FACET));
    const uint8_t *at = input->bytes + HEADER;
    for (uint64_t i = 0; i < count; i++, at += FACET) {
        double corners[3][3];
        for (int k = 0; k < 9; k++) {
            uint32_t bits = csg_load_u32(at + 12 + 4 * k);
            float value;
            memcpy(&value, &bits, sizeof value);
            if (!isfinite(value))
                return csg_read_broken(
                    input, 0, "triangle %llu at byte %llu has a coordinate that is not finite",
                    (unsigned long long)i, (unsigned long long)(at - input->bytes));
            corners[k / 3][k % 3] = (double)value;
        }
        if (!add_facet(w, corners))
            return CSGM_OK; /* out of memory: csg_builder_finish reports it */
    }
    return CSGM_OK;
}

/* ---- ASCII ------------------------------------------------------------------------ */

static bool next_is(csg_text_scan *s, const char *expected)
{
    const char *word;
    csg_scan_space(s);
    size_t length = csg_scan_word(s, &word);
    return csg_scan_is(word, length, expected);
}

static bool three_numbers(csg_text_scan *s, double *values)
{
    for (int k = 0; k < 3; k++) {
        csg_scan_space(s);
        if (!csg_scan_number(s, &values[k]))
            return false;
    }
    return true;
}

/* After "facet". */
static bool read_facet(csg_text_scan *s, double corners[3][3])
{
    double normal[3]; /* may be anything, nan too */
    if (!next_is(s, "normal") || !three_numbers(s, normal) || !next_is(s, "outer") ||
        !next_is(s, "loop"))
        return false;
    for (int c = 0; c < 3; c++) {
        if (!next_is(s, "vertex") || !three_numbers(s, corners[c]))
            return false;
        for (int k = 0; k < 3; k++)
            if (!isfinite(corners[c][k]))
                return false;
    }
    return next_is(s, "endloop") && next_is(s, "endfacet");
}

static csgm_status read_ascii(csg_input *input, weld *w)
{
    csg_text_scan s = csg_scan_start(input);
    const char *word;
    double corners[3][3];
    bool open = false;
    for (;;) {
        csg_scan_space(&s);
        size_t length = csg_scan_word(&s, &word);
        if (!length)
            break;
        if (open && csg_scan_is(word, length, "facet")) {
            if (!read_facet(&s, corners))
                return csg_read_broken(input, s.line,
                                       "this facet is not three vertices of finite "
                                       "numbers between 'outer loop' and 'endloop'");
            if (!add_facet(w, corners))
                return CSGM_OK;
        } else if (csg_scan_is(word, length, open ? "endsolid" : "solid")) {
            open = !open;
            csg_scan_skip_line(&s);
        } else {
            return csg_read_broken(input, s.line, "expected '%s'",
                                   open ? "facet' or 'endsolid" : "solid");
        }
    }
    return open ? csg_read_broken(input, s.line, "the file ends before 'endsolid'") : CSGM_OK;
}

csgm_status csg_stl_read(csg_input *input, csg_mesh_builder *builder)
{
    weld w = {.builder = builder, .table = {.memory = &builder->context->memory}};
    csgm_status status;
    uint64_t size = input->size_bytes;
    bool text = size >= 5 && memcmp(input->bytes, "solid", 5) == 0;
    if (size >= HEADER &&
        (!text || size == HEADER + FACET * (uint64_t)csg_load_u32(input->bytes + 80)))
        status = read_binary(input, &w);
    else if (text)
        status = read_ascii(input, &w);
    else
        status =
            csg_read_broken(input, 0, "an STL file begins with 'solid' or has 84 bytes at least");
    csg_table_release(&w.table);
    return status;
}
