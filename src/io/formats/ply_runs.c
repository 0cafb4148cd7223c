/* SPDX-License-Identifier: MIT
 * The triangles of a PLY that is not held: binary, its vertices of fixed size before its faces,
 * these its last element. Places of vertices are read again where they are wanted, in blocks of
 * which as many are kept as there is room for: neighbours stand together in most files.
 */
#include <math.h>
#include <string.h>

#include "io/formats/ply.h"
#include "io/origin.h"
#include "io/runs.h"

enum { BLOCK = 256, SMALLEST_CACHE = 64 }; /* vertices; blocks */

typedef struct block {
    uint64_t number; /* + 1; 0 = none */
    float at[BLOCK][3];
} block;

typedef struct ply_runs {
    csg_ply_header header;
    const csg_ply_element *vertices, *faces;
    uint64_t vertices_at, faces_at; /* in the file */
    size_t row_bytes;               /* of a vertex */
    uint8_t *rows;                  /* those of a block */
    size_t place_at[3];             /* of x, y, z in a row */
    csg_ply_type place_type[3];
    block *cache;
    size_t cache_blocks;
    /* where the faces are: */
    uint64_t faces_left, corners_left, corners_taken; /* corners: of the list at hand */
    uint32_t property;                                /* the next one of the face */
    uint32_t fan[2];
    bool is_plain;
} ply_runs;

static csgm_status broken(const csg_runs *r, const char *what)
{
    return csg_read_broken(&(csg_input){.context = r->context, .path = r->path}, 0,
                           "at byte %llu: %s",
                           (unsigned long long)(r->window_ends - (r->end - r->at)), what);
}

/* ---- the head --------------------------------------------------------------------- */

/* Of a row, 0 where rows differ. */
static size_t row_bytes(const csg_ply_element *element)
{
    size_t size = 0;
    for (uint32_t i = 0; i < element->property_count; i++) {
        if (element->properties[i].is_list)
            return 0;
        size += csg_ply_type_bytes[element->properties[i].type];
    }
    return size;
}

/* Vertices first, faces last, what is between them of fixed size. */
static bool find_elements(csg_runs *r, uint64_t at)
{
    ply_runs *p = r->state;
    for (uint32_t i = 0; i < p->header.element_count; i++) {
        const csg_ply_element *element = &p->header.elements[i];
        size_t row = row_bytes(element);
        if (p->faces)
            return false;
        if (element->kind == CSG_PLY_FACE) {
            p->faces = element;
            p->faces_at = at;
            continue;
        }
        if (!row || element->count > (r->size_bytes - at) / row ||
            (element->kind == CSG_PLY_VERTEX && p->vertices))
            return false;
        if (element->kind == CSG_PLY_VERTEX) {
            p->vertices = element;
            p->vertices_at = at;
            p->row_bytes = row;
        }
        at += row * element->count;
    }
    return p->vertices && p->faces && p->vertices->count < UINT32_MAX &&
           (csg_ply_slots(p->vertices) & CSG_PLY_PLACE) == CSG_PLY_PLACE &&
           (csg_ply_slots(p->faces) & 1u << CSG_PLY_CORNERS);
}

static void find_places(ply_runs *p)
{
    size_t at = 0;
    for (uint32_t i = 0; i < p->vertices->property_count; i++) {
        const csg_ply_property *property = &p->vertices->properties[i];
        if (property->slot <= CSG_PLY_Z) {
            p->place_at[property->slot] = at;
            p->place_type[property->slot] = property->type;
        }
        at += csg_ply_type_bytes[property->type];
    }
}

/* ---- places ----------------------------------------------------------------------- */

static void unpack(const ply_runs *p, const uint8_t *row, double position[3])
{
    for (int k = 0; k < 3; k++)
        position[k] = csg_ply_decode(row + p->place_at[k], p->place_type[k], p->header.big_endian);
}

/* Once over all vertices: each is finite; where the origin is. */
static csgm_status look_at_vertices(csg_runs *r)
{
    ply_runs *p = r->state;
    csg_origin_choice choice = csg_origin_begin();
    csg_runs_seek(r, p->vertices_at);
    for (uint64_t v = 0; v < p->vertices->count; v++) {
        csgm_status status;
        double position[3];
        const uint8_t *row = csg_runs_take(r, p->row_bytes, &status);
        if (!row)
            return status ? status : broken(r, CSG_READ_SHORTER);
        unpack(p, row, position);
        for (int k = 0; k < 3; k++) {
            if (!isfinite(position[k]))
                return broken(r, CSG_PLY_NOT_FINITE);
            if (!csg_origin_is_near(position[k]))
                return broken(r, CSG_READ_TOO_FAR);
        }
        csg_origin_add(&choice, position);
        if (!csg_read_has_time_for_step(&r->clock))
            return csg_read_why_late(&r->clock);
    }
    r->origin = csg_origin_choose(&choice);
    return CSGM_OK;
}

static csgm_status fill(csg_runs *r, uint64_t number, block *b)
{
    ply_runs *p = r->state;
    uint64_t first = number * BLOCK, left = p->vertices->count - first;
    size_t count = left < BLOCK ? (size_t)left : BLOCK;
    csgm_status status =
        csg_runs_read_at(r, p->rows, count * p->row_bytes, p->vertices_at + first * p->row_bytes);
    const double *origin = &r->origin.x;
    for (size_t i = 0; i < count && !status; i++) {
        double position[3];
        unpack(p, p->rows + i * p->row_bytes, position);
        for (int k = 0; k < 3; k++)
            b->at[i][k] = (float)(position[k] - origin[k]) + 0.0F;
    }
    b->number = status ? 0 : number + 1;
    return status;
}

static csgm_status place_of(csg_runs *r, uint32_t vertex, float at[3])
{
    ply_runs *p = r->state;
    uint64_t number = vertex / BLOCK;
    block *b = &p->cache[number % p->cache_blocks];
    csgm_status status = b->number == number + 1 ? CSGM_OK : fill(r, number, b);
    if (!status)
        memcpy(at, b->at[vertex % BLOCK], 3 * sizeof(float));
    return status;
}

/* ---- begin and end ---------------------------------------------------------------- */

static csgm_status take_cache(csg_runs *r)
{
    ply_runs *p = r->state;
    uint64_t all = p->vertices->count / BLOCK + 1, most = r->cache_bytes / sizeof *p->cache;
    most = most < SMALLEST_CACHE ? SMALLEST_CACHE : most;
    p->cache_blocks = (size_t)(all < most ? all : most);
    p->cache = csg_memory_alloc(&r->context->memory, p->cache_blocks * sizeof *p->cache);
    p->rows = csg_memory_alloc(&r->context->memory, BLOCK * p->row_bytes);
    if (!p->cache || !p->rows)
        return csg_context_no_memory(r->context);
    for (size_t i = 0; i < p->cache_blocks; i++)
        p->cache[i].number = 0;
    return CSGM_OK;
}

/* The header is parsed in the window: one that is longer has no runs. Its findings are the reader's
 * to report, so that they are not kept here. */
static csgm_status begin(csg_runs *r)
{
    ply_runs *p = r->state;
    csgm_status status;
    csg_runs_take(r, 1, &status);
    if (status)
        return status;
    csgm_context quiet = {.memory.limit_bytes = 0};
    csg_input head = {.context = &quiet, .path = r->path, .bytes = r->window, .size_bytes = r->end};
    csg_text_scan scan = csg_scan_start(&head);
    if (csg_ply_read_header(&head, &scan, &p->header) || p->header.ascii ||
        !find_elements(r, (uint64_t)(scan.at - (const char *)r->window)))
        return CSGM_ERR_UNSUPPORTED;
    find_places(p);
    uint32_t slots = csg_ply_slots(p->vertices);
    r->names_vertices = true;
    r->vertex_count = p->vertices->count;
    r->has_normals = r->vertex_count && (slots & CSG_PLY_NORMAL) == CSG_PLY_NORMAL;
    r->has_colors = r->vertex_count && (slots & CSG_PLY_COLOR) == CSG_PLY_COLOR;
    status = look_at_vertices(r);
    return status ? status : take_cache(r);
}

/* Rows of nothing but a list of 32-bit numbers with its count in a byte, as nearly all files have.
 */
static bool is_plain(const ply_runs *p)
{
    const csg_ply_property *list = &p->faces->properties[0];
    return p->faces->property_count == 1 && !p->header.big_endian &&
           list->count_type == CSG_PLY_U8 &&
           (list->type == CSG_PLY_I32 || list->type == CSG_PLY_U32);
}

static csgm_status rewind_faces(csg_runs *r)
{
    ply_runs *p = r->state;
    csg_runs_seek(r, p->faces_at);
    p->faces_left = p->faces->count;
    p->property = p->faces->property_count;
    p->corners_left = 0;
    p->is_plain = is_plain(p);
    return CSGM_OK;
}

static void end(csg_runs *r)
{
    ply_runs *p = r->state;
    csg_memory_release(&r->context->memory, p->cache, p->cache_blocks * sizeof *p->cache);
    csg_memory_release(&r->context->memory, p->rows, BLOCK * p->row_bytes);
}

/* ---- faces ------------------------------------------------------------------------ */

static csgm_status take_number(csg_runs *r, csg_ply_type type, const char *missing, double *value)
{
    const ply_runs *p = r->state;
    csgm_status status;
    const uint8_t *at = csg_runs_take(r, csg_ply_type_bytes[type], &status);
    if (!at)
        return status ? status : broken(r, missing);
    *value = csg_ply_decode(at, type, p->header.big_endian);
    return CSGM_OK;
}

/* The property at hand: the corners' count, or all of another one. */
static csgm_status open_property(csg_runs *r, const csg_ply_property *property)
{
    ply_runs *p = r->state;
    double count = 1, ignored;
    csgm_status status = CSGM_OK;
    if (property->is_list)
        status = take_number(r, property->count_type, CSG_PLY_NO_FACE, &count);
    if (!status && !csg_ply_is_count(count))
        status = broken(r, CSG_PLY_NO_FACE);
    if (status)
        return status;
    p->property++;
    if (property->slot == CSG_PLY_CORNERS) {
        p->corners_left = (uint64_t)count;
        p->corners_taken = 0;
        return CSGM_OK;
    }
    for (uint64_t i = 0; i < (uint64_t)count && !status; i++)
        status = take_number(r, property->type, CSG_PLY_NO_FACE, &ignored);
    return status;
}

/* A corner more of the face: from the third on, each closes a triangle of the fan. */
static csgm_status take_corner(csg_runs *r, csg_runs_triangle *triangle, bool *closes)
{
    ply_runs *p = r->state;
    double index = 0;
    csg_ply_type type = p->faces->properties[p->property - 1].type;
    csgm_status status = take_number(r, type, CSG_PLY_SHORT_FACE, &index);
    if (status)
        return status;
    if (!(index >= 0 && index < (double)r->vertex_count) || index != floor(index))
        return broken(r, CSG_PLY_NO_SUCH_VERTEX);
    *closes = p->corners_taken >= 2;
    if (*closes) {
        triangle->vertex[0] = p->fan[0];
        triangle->vertex[1] = p->fan[1];
        triangle->vertex[2] = (uint32_t)index;
    }
    p->fan[p->corners_taken != 0] = (uint32_t)index;
    p->corners_taken++;
    p->corners_left--;
    return CSGM_OK;
}

/* A face of a plain file if it is a sound triangle; everything else is left to what goes value by
 * value. */
static bool take_plain(csg_runs *r, csg_runs_triangle *triangle)
{
    enum { ROW = 1 + 3 * 4 };
    ply_runs *p = r->state;
    csgm_status status;
    const uint8_t *at = csg_runs_take(r, ROW, &status);
    if (!at)
        return false;
    bool sound = at[0] == 3;
    for (int k = 0; k < 3; k++) {
        triangle->vertex[k] = csg_load_u32(at + 1 + 4 * k);
        sound &= triangle->vertex[k] < r->vertex_count;
    }
    if (sound)
        p->faces_left--;
    else
        r->at -= ROW;
    return sound;
}

static csgm_status next(csg_runs *r, bool places, csg_runs_triangle *triangle, bool *is_there)
{
    ply_runs *p = r->state;
    csgm_status status = CSGM_OK;
    *is_there = p->is_plain && !p->corners_left && p->faces_left &&
                p->property == p->faces->property_count && take_plain(r, triangle);
    while (!status && !*is_there) {
        if (p->corners_left) {
            status = take_corner(r, triangle, is_there);
        } else if (p->property < p->faces->property_count) {
            status = open_property(r, &p->faces->properties[p->property]);
        } else if (p->faces_left) {
            p->faces_left--;
            p->property = 0;
        } else {
            return CSGM_OK;
        }
        if (!csg_read_has_time_for_step(&r->clock))
            return csg_read_why_late(&r->clock);
    }
    for (int k = 0; k < 3 && places && !status; k++)
        status = place_of(r, triangle->vertex[k], triangle->at[k]);
    return status;
}

const csg_runs_kind csg_ply_runs = {.state_bytes = sizeof(ply_runs),
                                    .begin = begin,
                                    .rewind = rewind_faces,
                                    .next = next,
                                    .end = end};
