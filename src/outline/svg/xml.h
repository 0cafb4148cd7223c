/* SPDX-License-Identifier: MIT
 * XML bytes -> a tree of elements with their attributes, in the order of the document (so a parent
 * stands before its children). Text between tags is dropped, the prefixes "svg:" and "xlink:" are
 * cut off names, nothing outside the bytes is ever read.
 */
#ifndef CSG_OUTLINE_XML_H
#define CSG_OUTLINE_XML_H

#include "outline/input.h"

#define CSG_XML_NONE UINT32_MAX
enum { CSG_XML_MOST_DEPTH = 256, CSG_XML_MOST_ELEMENTS = 1 << 20 };

typedef struct csg_xml_attribute {
    const char *name, *value;
} csg_xml_attribute;

typedef struct csg_xml_element {
    const char *name;
    uint32_t parent, first_child, next_sibling; /* CSG_XML_NONE = none */
    uint32_t attributes;                        /* index of the first */
    uint32_t attribute_count;
    uint32_t bytes; /* of its attributes: what looking at it costs */
} csg_xml_element;

typedef struct csg_xml {
    csg_arena arena; /* names and values */
    csg_memory *memory;
    csg_xml_element *elements; /* elements[0] is the root */
    csg_xml_attribute *attributes;
    size_t count, capacity, attribute_count, attribute_capacity;
} csg_xml;

/* CSGM_ERR_FORMAT: not well-formed, or entities that swell. CSGM_ERR_LIMIT: too deep, too many
 * elements, too much text. *out is released by the caller on CSGM_OK only. */
csgm_status csg_xml_parse(csg_memory *memory, const char *text, size_t length, csg_xml *out,
                          csg_problem *problem);
void csg_xml_release(csg_xml *xml);
/* NULL: the element has no such attribute. */
const char *csg_xml_get(const csg_xml *xml, uint32_t element, const char *name);

#endif
