/* SPDX-License-Identifier: MIT
 * The part of xml.h that needs no library.
 */
#include <string.h>

#include "outline/svg/xml.h"

void csg_xml_release(csg_xml *xml)
{
    csg_arena_reset(&xml->arena);
    if (xml->elements)
        csg_memory_release(xml->memory, xml->elements, xml->capacity * sizeof *xml->elements);
    if (xml->attributes)
        csg_memory_release(xml->memory, xml->attributes,
                           xml->attribute_capacity * sizeof *xml->attributes);
    *xml = (csg_xml){.memory = xml->memory};
}

const char *csg_xml_get(const csg_xml *xml, uint32_t element, const char *name)
{
    const csg_xml_element *e = &xml->elements[element];
    for (uint32_t i = 0; i < e->attribute_count; i++)
        if (strcmp(xml->attributes[e->attributes + i].name, name) == 0)
            return xml->attributes[e->attributes + i].value;
    return NULL;
}
