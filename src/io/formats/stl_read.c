/* SPDX-License-Identifier: MIT
 * STL -> mesh. Binary or ASCII is told by content: a file whose size is the one that its count says
 * is binary, whatever its header; else one that begins with "solid" is text. Corners at the same
 * place become one vertex. Facet normals are not kept: they say nothing that the corners do not.
 */
#include <math.h>

#include "base/places.h"
#include "io/formats/stl.h"
#include "io/runs.h"
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

/* The corners of a facet; false: one is not finite. */
static bool unpack_facet(const uint8_t *at, float corners[9])
{
    bool finite = true;
    for (int k = 0; k < 9; k++) {
        uint32_t bits = csg_load_u32(at + CSG_STL_NORMAL_BYTES + 4 * k);
        memcpy(&corners[k], &bits, sizeof bits);
        finite &= isfinite(corners[k]) != 0;
    }
    return finite;
}

static csgm_status not_finite(const csg_input *input, uint64_t facet)
{
    return csg_read_broken(input, 0,
                           "triangle %llu at byte %llu has a coordinate that is not finite",
                           (unsigned long long)facet,
                           (unsigned long long)(CSG_STL_HEAD_BYTES + facet * CSG_STL_FACET_BYTES));
}

static csgm_status read_binary(csg_input *input, weld *w)
{
    uint64_t count = csg_load_u32(input->bytes + 80);
    uint64_t most = (input->size_bytes - CSG_STL_HEAD_BYTES) / CSG_STL_FACET_BYTES;
    if (count > most)
        return csg_read_broken(
            input, 0, "the file ends too soon: it says %llu triangles and has room for %llu",
            (unsigned long long)count, (unsigned long long)most);
    const uint8_t *at = input->bytes + CSG_STL_HEAD_BYTES;
    for (uint64_t i = 0; i < count; i++, at += CSG_STL_FACET_BYTES) {
        float values[9];
        double corners[3][3];
        if (!unpack_facet(at, values))
            return not_finite(input, i);
        for (int k = 0; k < 9; k++)
            corners[k / 3][k % 3] = (double)values[k];
        if (!add_facet(w, corners))
            return CSGM_OK; /* out of memory: csg_builder_finish reports it */
    }
    return CSGM_OK;
}

/* Is it binary, and not text? By its first 84 bytes, of which there are `have`, and its size. */
static bool is_binary(const uint8_t *bytes, size_t have, uint64_t size)
{
    bool text = have >= 5 && memcmp(bytes, "solid", 5) == 0;
    return have >= CSG_STL_HEAD_BYTES &&
           (!text ||
            size == CSG_STL_HEAD_BYTES + CSG_STL_FACET_BYTES * (uint64_t)csg_load_u32(bytes + 80));
}

/* ---- in runs ---------------------------------------------------------------------- */

typedef struct stl_runs {
    uint64_t count, next;
} stl_runs;

static csgm_status begin_runs(csg_runs *r)
{
    stl_runs *s = r->state;
    csgm_status status;
    const uint8_t *head = csg_runs_take(r, CSG_STL_HEAD_BYTES, &status);
    if (status)
        return status;
    if (!head || !is_binary(head, CSG_STL_HEAD_BYTES, r->size_bytes))
        return CSGM_ERR_UNSUPPORTED;
    s->count = csg_load_u32(head + 80);
    if (s->count > (r->size_bytes - CSG_STL_HEAD_BYTES) / CSG_STL_FACET_BYTES)
        return CSGM_ERR_UNSUPPORTED;
    return CSGM_OK;
}

static csgm_status rewind_runs(csg_runs *r)
{
    stl_runs *s = r->state;
    csg_runs_seek(r, CSG_STL_HEAD_BYTES);
    s->next = 0;
    return CSGM_OK;
}

static csgm_status next_of_runs(csg_runs *r, bool places, csg_runs_triangle *triangle,
                                bool *is_there)
{
    stl_runs *s = r->state;
    const csg_input input = {.context = r->context, .path = r->path};
    csgm_status status;
    float values[9];
    *is_there = s->next < s->count;
    if (!*is_there)
        return CSGM_OK;
    const uint8_t *at = csg_runs_take(r, CSG_STL_FACET_BYTES, &status);
    if (!at)
        return status ? status : csg_read_broken(&input, 0, CSG_READ_SHORTER);
    if (!unpack_facet(at, values))
        return not_finite(&input, s->next);
    s->next++;
    for (int k = 0; k < 9; k++)
        triangle->at[k / 3][k % 3] = values[k] + 0.0F;
    return CSGM_OK;
}

const csg_runs_kind csg_stl_runs = {.state_bytes = sizeof(stl_runs),
                                    .begin = begin_runs,
                                    .rewind = rewind_runs,
                                    .next = next_of_runs};

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
    if (is_binary(input->bytes, input->size_bytes, size))
        status = read_binary(input, &w);
    else if (size >= 5 && memcmp(input->bytes, "solid", 5) == 0)
        status = read_ascii(input, &w);
    else
        status =
            csg_read_broken(input, 0, "an STL file begins with 'solid' or has 84 bytes at least");
    csg_table_release(&w.table);
    return status;
}
