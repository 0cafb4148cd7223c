/* SPDX-License-Identifier: MIT
 * The header of a PLY file, a line at a time.
 */
#include "io/formats/ply.h"

#include <math.h>

const uint8_t csg_ply_type_bytes[CSG_PLY_TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};

typedef struct word {
    const char *text;
    size_t length;
} word;

static word next(csg_text_scan *scan)
{
    word w;
    w.length = csg_scan_word(scan, &w.text);
    return w;
}

static bool is(word w, const char *text)
{
    return csg_scan_is(w.text, w.length, text);
}

static bool find_type(word w, csg_ply_type *type)
{
    static const struct {
        const char *name;
        csg_ply_type type;
    } names[] = {{"char", CSG_PLY_I8},    {"uchar", CSG_PLY_U8},   {"short", CSG_PLY_I16},
                 {"ushort", CSG_PLY_U16}, {"int", CSG_PLY_I32},    {"uint", CSG_PLY_U32},
                 {"float", CSG_PLY_F32},  {"double", CSG_PLY_F64}, {"int8", CSG_PLY_I8},
                 {"uint8", CSG_PLY_U8},   {"int16", CSG_PLY_I16},  {"uint16", CSG_PLY_U16},
                 {"int32", CSG_PLY_I32},  {"uint32", CSG_PLY_U32}, {"float32", CSG_PLY_F32},
                 {"float64", CSG_PLY_F64}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (is(w, names[i].name)) {
            *type = names[i].type;
            return true;
        }
    return false;
}

static csg_ply_slot find_slot(const csg_ply_element *element, word w, bool is_list)
{
    static const struct {
        const char *name;
        csg_ply_slot slot;
    } names[] = {{"x", CSG_PLY_X},
                 {"y", CSG_PLY_Y},
                 {"z", CSG_PLY_Z},
                 {"nx", CSG_PLY_NX},
                 {"ny", CSG_PLY_NY},
                 {"nz", CSG_PLY_NZ},
                 {"red", CSG_PLY_RED},
                 {"green", CSG_PLY_GREEN},
                 {"blue", CSG_PLY_BLUE},
                 {"alpha", CSG_PLY_ALPHA},
                 {"diffuse_red", CSG_PLY_RED},
                 {"diffuse_green", CSG_PLY_GREEN},
                 {"diffuse_blue", CSG_PLY_BLUE},
                 {"diffuse_alpha", CSG_PLY_ALPHA}};
    if (element->kind == CSG_PLY_FACE && is_list)
        return is(w, "vertex_indices") || is(w, "vertex_index") ? CSG_PLY_CORNERS : CSG_PLY_SKIP;
    for (size_t i = 0;
         element->kind == CSG_PLY_VERTEX && !is_list && i < sizeof names / sizeof *names; i++)
        if (is(w, names[i].name))
            return names[i].slot;
    return CSG_PLY_SKIP;
}

static csgm_status add_element(const csg_input *input, csg_text_scan *scan, csg_ply_header *header)
{
    int64_t count;
    word name = next(scan);
    if (!name.length || !csg_scan_integer(scan, &count) || count < 0)
        return csg_read_broken(input, scan->line, "expected 'element NAME COUNT'");
    if (header->element_count == CSG_PLY_MOST_ELEMENTS)
        return csg_read_broken(input, scan->line, "more than %d elements", CSG_PLY_MOST_ELEMENTS);
    csg_ply_element *element = &header->elements[header->element_count++];
    element->kind = is(name, "vertex")      ? CSG_PLY_VERTEX
                    : is(name, "face")      ? CSG_PLY_FACE
                    : is(name, "tristrips") ? CSG_PLY_STRIPS
                                            : CSG_PLY_OTHER;
    element->count = (uint64_t)count;
    for (uint32_t i = 0; i + 1 < header->element_count; i++)
        if (element->kind != CSG_PLY_OTHER && header->elements[i].kind == element->kind)
            return csg_read_broken(input, scan->line, "the element '%.*s' is there twice",
                                   (int)name.length, name.text);
    return CSGM_OK;
}

static csgm_status add_property(const csg_input *input, csg_text_scan *scan, csg_ply_header *header)
{
    csg_ply_property property = {.count_type = CSG_PLY_U8};
    word type = next(scan);
    property.is_list = is(type, "list");
    if (property.is_list) {
        if (!find_type(next(scan), &property.count_type))
            return csg_read_broken(input, scan->line, "unknown type of a list's count");
        type = next(scan);
    }
    word name = type;
    if (!find_type(type, &property.type) || !(name = next(scan)).length)
        return csg_read_broken(input, scan->line, "expected 'property TYPE NAME'");
    if (!header->element_count)
        return csg_read_broken(input, scan->line, "a property before any element");
    csg_ply_element *element = &header->elements[header->element_count - 1];
    if (element->property_count == CSG_PLY_MOST_PROPERTIES)
        return csg_read_broken(input, scan->line, "more than %d properties",
                               CSG_PLY_MOST_PROPERTIES);
    property.slot = find_slot(element, name, property.is_list);
    for (uint32_t i = 0; i < element->property_count; i++)
        if (property.slot != CSG_PLY_SKIP && element->properties[i].slot == property.slot)
            return csg_read_broken(input, scan->line, "the property '%.*s' is there twice",
                                   (int)name.length, name.text);
    element->properties[element->property_count++] = property;
    return CSGM_OK;
}

static csgm_status set_format(const csg_input *input, csg_text_scan *scan, csg_ply_header *header)
{
    word name = next(scan);
    header->ascii = is(name, "ascii");
    header->big_endian = is(name, "binary_big_endian");
    if (!header->ascii && !header->big_endian && !is(name, "binary_little_endian"))
        return csg_read_broken(input, scan->line, "unknown PLY format '%.*s'",
                               (int)(name.length < 40 ? name.length : 40), name.text);
    return CSGM_OK;
}

/* ---- binary data and elements -------------------------------------------------------- */

double csg_ply_decode(const uint8_t *at, csg_ply_type type, bool big_endian)
{
    uint64_t bits = 0;
    unsigned size = csg_ply_type_bytes[type];
    for (unsigned i = 0; i < size; i++)
        bits |= (uint64_t)at[i] << 8 * (big_endian ? size - 1 - i : i);
    float single;
    double wide;
    uint32_t low = (uint32_t)bits;
    switch (type) {
    case CSG_PLY_I8:
        return (int8_t)low;
    case CSG_PLY_I16:
        return (int16_t)low;
    case CSG_PLY_I32:
        return (int32_t)low;
    case CSG_PLY_F32:
        memcpy(&single, &low, sizeof single);
        return (double)single;
    case CSG_PLY_F64:
        memcpy(&wide, &bits, sizeof wide);
        return wide;
    case CSG_PLY_U8:
    case CSG_PLY_U16:
    case CSG_PLY_U32:
    case CSG_PLY_TYPES:
        break;
    }
    return low;
}

bool csg_ply_is_count(double value)
{
    return value >= 0 && value <= UINT32_MAX && value == floor(value);
}

uint32_t csg_ply_slots(const csg_ply_element *element)
{
    uint32_t slots = 0;
    for (uint32_t i = 0; i < element->property_count; i++)
        slots |= 1u << element->properties[i].slot;
    return slots;
}

/* ---- the header ---------------------------------------------------------------------- */

csgm_status csg_ply_read_header(const csg_input *input, csg_text_scan *scan, csg_ply_header *header)
{
    bool has_format = false;
    memset(header, 0, sizeof *header);
    if (!is(next(scan), "ply"))
        return csg_read_broken(input, 1, "a PLY file begins with 'ply'");
    for (;;) {
        csg_scan_skip_line(scan);
        if (scan->at == scan->end)
            return csg_read_broken(input, scan->line, "the file ends before 'end_header'");
        word key = next(scan);
        csgm_status status = CSGM_OK;
        if (is(key, "end_header"))
            break;
        if (is(key, "format")) {
            has_format = true;
            status = set_format(input, scan, header);
        } else if (is(key, "element")) {
            status = add_element(input, scan, header);
        } else if (is(key, "property")) {
            status = add_property(input, scan, header);
        } else if (key.length && !is(key, "comment") && !is(key, "obj_info")) {
            status = csg_read_broken(input, scan->line, "unknown line in the PLY header");
        }
        if (status)
            return status;
    }
    if (!has_format)
        return csg_read_broken(input, scan->line, "the PLY header has no 'format' line");
    csg_scan_skip_line(scan);
    return CSGM_OK;
}
