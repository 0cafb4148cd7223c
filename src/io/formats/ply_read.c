/* SPDX-License-Identifier: MIT
 * PLY -> mesh: ASCII and binary of both byte orders, properties of any type in any order, polygons
 * as fans. Elements other than vertex and face are skipped. Does not read triangle strips.
 */
#include <math.h>

#include "io/color.h"
#include "io/formats/ply.h"

typedef struct ply {
    csg_input *input;
    csg_mesh_builder *builder;
    csg_text_scan scan; /* also the cursor of binary data */
    csg_ply_header header;
    uint64_t vertex_count;
} ply;

static csgm_status broken(const ply *p, const char *what)
{
    if (p->header.ascii)
        return csg_read_broken(p->input, p->scan.line, "%s", what);
    return csg_read_broken(p->input, 0, "at byte %llu: %s",
                           (unsigned long long)(p->scan.at - (const char *)p->input->bytes), what);
}

/* ---- one value ----------------------------------------------------------------------------------
 */

static bool next_value(ply *p, csg_ply_type type, double *value)
{
    if (p->header.ascii) {
        csg_scan_space(&p->scan);
        return csg_scan_number(&p->scan, value);
    }
    size_t size = csg_ply_type_bytes[type];
    if ((size_t)(p->scan.end - p->scan.at) < size)
        return false;
    *value = csg_ply_decode((const uint8_t *)p->scan.at, type, p->header.big_endian);
    p->scan.at += size;
    return true;
}

static bool next_count(ply *p, const csg_ply_property *list, uint64_t *count)
{
    double value;
    if (!next_value(p, list->count_type, &value) || !csg_ply_is_count(value))
        return false;
    *count = (uint64_t)value;
    return true;
}

static bool skip_property(ply *p, const csg_ply_property *property)
{
    double ignored;
    uint64_t count = 1;
    if (property->is_list && !next_count(p, property, &count))
        return false;
    while (count--)
        if (!next_value(p, property->type, &ignored))
            return false;
    return true;
}

/* ---- rows ------------------------------------------------------------------------- */

/* Whole numbers fill their type's range, fractions go from 0 to 1. */
static uint8_t to_color(double value, csg_ply_type type)
{
    switch (type) {
    case CSG_PLY_F32:
    case CSG_PLY_F64:
        return csg_color_to_byte((float)value);
    case CSG_PLY_U16:
        return csg_color_to_byte((float)(value / 65535));
    default:
        return csg_color_to_byte((float)(value / 255));
    }
}

static csgm_status read_vertex(ply *p, const csg_ply_element *element, bool normals, bool colors)
{
    double position[3] = {0};
    float normal[3] = {0};
    uint8_t color[4] = {0, 0, 0, 255};
    for (uint32_t i = 0; i < element->property_count; i++) {
        const csg_ply_property *property = &element->properties[i];
        double value;
        if (property->slot == CSG_PLY_SKIP || property->is_list) {
            if (!skip_property(p, property))
                return broken(p, "expected a vertex");
            continue;
        }
        if (!next_value(p, property->type, &value))
            return broken(p, "expected a vertex");
        if (property->slot <= CSG_PLY_Z)
            position[property->slot] = value;
        else if (property->slot <= CSG_PLY_NZ)
            normal[property->slot - CSG_PLY_NX] = (float)value;
        else
            color[property->slot - CSG_PLY_RED] = to_color(value, property->type);
    }
    if (!isfinite(position[0]) || !isfinite(position[1]) || !isfinite(position[2]))
        return broken(p, CSG_PLY_NOT_FINITE);
    csg_builder_vertex(p->builder, position, normals ? normal : NULL, colors ? color : NULL);
    return CSGM_OK;
}

static csgm_status read_corners(ply *p, const csg_ply_property *property)
{
    uint64_t count;
    uint32_t fan[2] = {0, 0};
    if (!next_count(p, property, &count))
        return broken(p, CSG_PLY_NO_FACE);
    for (uint64_t i = 0; i < count; i++) {
        double index;
        if (!next_value(p, property->type, &index))
            return broken(p, CSG_PLY_SHORT_FACE);
        if (!(index >= 0 && index < (double)p->vertex_count) || index != floor(index))
            return broken(p, CSG_PLY_NO_SUCH_VERTEX);
        if (i >= 2 && !csg_builder_triangle(p->builder, fan[0], fan[1], (uint32_t)index))
            return CSGM_OK;
        fan[i != 0] = (uint32_t)index;
    }
    return CSGM_OK;
}

static csgm_status read_row(ply *p, const csg_ply_element *element)
{
    for (uint32_t i = 0; i < element->property_count; i++) {
        const csg_ply_property *property = &element->properties[i];
        if (property->slot == CSG_PLY_CORNERS) {
            csgm_status status = read_corners(p, property);
            if (status)
                return status;
        } else if (!skip_property(p, property)) {
            return broken(p, element->kind == CSG_PLY_FACE ? CSG_PLY_NO_FACE : "expected a row");
        }
    }
    return CSGM_OK;
}

/* ---- elements --------------------------------------------------------------------- */

/* Compares the count with the fewest bytes that its rows can take. */
static bool fits(const ply *p, const csg_ply_element *element)
{
    uint64_t row = 0, left = (uint64_t)(p->scan.end - p->scan.at);
    for (uint32_t i = 0; i < element->property_count; i++) {
        const csg_ply_property *property = &element->properties[i];
        row += p->header.ascii
                   ? 2
                   : csg_ply_type_bytes[property->is_list ? property->count_type : property->type];
    }
    return !row || element->count <= (left + 1) / row; /* +1: the last line may lack its end */
}

static csgm_status read_element(ply *p, const csg_ply_element *element)
{
    const uint32_t xyz = CSG_PLY_PLACE, nxyz = CSG_PLY_NORMAL, rgb = CSG_PLY_COLOR;
    uint32_t slots = csg_ply_slots(element);
    bool is_vertex = element->kind == CSG_PLY_VERTEX;
    csgm_status status = CSGM_OK;
    if (!fits(p, element))
        return broken(p, "the file is too short for the rows that its header tells");
    if (is_vertex && (slots & xyz) != xyz)
        return broken(p, "the vertices have no x, y and z");
    if (element->kind == CSG_PLY_FACE && element->count && !(slots & 1u << CSG_PLY_CORNERS))
        return broken(p, "the faces have no list 'vertex_indices'");
    if (is_vertex)
        csg_builder_reserve(p->builder, element->count, 0);
    if (element->kind == CSG_PLY_FACE)
        csg_builder_reserve(p->builder, 0, element->count);
    if (!element->property_count)
        return CSGM_OK; /* rows of nothing */
    for (uint64_t i = 0; i < element->count && !status && !p->builder->failed; i++)
        status = is_vertex ? read_vertex(p, element, (slots & nxyz) == nxyz, (slots & rgb) == rgb)
                           : read_row(p, element);
    return status;
}

csgm_status csg_ply_read(csg_input *input, csg_mesh_builder *builder)
{
    csg_memory *memory = &input->context->memory;
    ply *p = csg_memory_alloc(memory, sizeof *p);
    if (!p)
        return csg_context_no_memory(input->context);
    *p = (ply){.input = input, .builder = builder, .scan = csg_scan_start(input)};
    csgm_status status = csg_ply_read_header(input, &p->scan, &p->header);
    bool faces = false, strips = false;
    for (uint32_t i = 0; i < p->header.element_count && !status; i++) {
        csg_ply_kind kind = p->header.elements[i].kind;
        faces |= kind == CSG_PLY_FACE;
        strips |= kind == CSG_PLY_STRIPS;
        if (kind == CSG_PLY_VERTEX)
            p->vertex_count = p->header.elements[i].count;
    }
    if (!status && strips && !faces)
        status = csg_read_unsupported(input, "PLY triangle strips are not read");
    for (uint32_t i = 0; i < p->header.element_count && !status && !builder->failed; i++)
        status = read_element(p, &p->header.elements[i]);
    csg_memory_release(memory, p, sizeof *p);
    return status;
}
