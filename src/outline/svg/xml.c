/* SPDX-License-Identifier: MIT
 * XML by expat; the only file that knows it. Entities: expat from 2.4 on stops those that swell,
 * and what they swell to is counted here as well; external ones are not read (no handler is set).
 */
#include "outline/svg/xml.h"

#include <expat.h>
#include <string.h>

typedef struct reader {
    XML_Parser parser;
    csg_xml *xml;
    csg_problem *problem;
    uint32_t open[CSG_XML_MOST_DEPTH]; /* elements from the root down */
    uint32_t last[CSG_XML_MOST_DEPTH]; /* the latest child of each, CSG_XML_NONE = none yet */
    size_t depth, text_bytes;
    csgm_status status;
} reader;

static void stop(reader *r, csgm_status status)
{
    if (r->status == CSGM_OK)
        r->status = status;
    XML_StopParser(r->parser, XML_FALSE);
}

/* Names of other vocabularies keep their prefix, so that "sodipodi:type" is no type. */
static const char *local_name(const char *name)
{
    static const char *const own[] = {"svg:", "xlink:"};
    for (size_t i = 0; i < 2; i++)
        if (strncmp(name, own[i], strlen(own[i])) == 0)
            return name + strlen(own[i]);
    return name;
}

/* A copy in the arena, counted. */
static const char *keep(reader *r, const char *text)
{
    size_t length = strlen(text);
    r->text_bytes += length;
    if (r->text_bytes > CSG_INPUT_MOST_BYTES) {
        stop(r, csg_problem_set(r->problem, CSGM_ERR_LIMIT, "its attributes are too long"));
        return NULL;
    }
    const char *copy = csg_arena_strndup(&r->xml->arena, text, length);
    if (!copy)
        stop(r, CSGM_ERR_MEMORY);
    return copy;
}

static bool add_attributes(reader *r, const char **pairs, csg_xml_element *element)
{
    csg_xml *xml = r->xml;
    size_t before = r->text_bytes;
    element->attributes = (uint32_t)xml->attribute_count;
    for (; *pairs; pairs += 2, element->attribute_count++) {
        if (!csg_memory_reserve(xml->memory, (void **)&xml->attributes, &xml->attribute_capacity,
                                xml->attribute_count + 1, sizeof *xml->attributes)) {
            stop(r, CSGM_ERR_MEMORY);
            return false;
        }
        csg_xml_attribute *attribute = &xml->attributes[xml->attribute_count];
        attribute->name = keep(r, local_name(pairs[0]));
        attribute->value = attribute->name ? keep(r, pairs[1]) : NULL;
        if (!attribute->value)
            return false;
        xml->attribute_count++;
    }
    element->bytes = (uint32_t)(r->text_bytes - before);
    return true;
}

static void link_element(reader *r, uint32_t index)
{
    csg_xml_element *elements = r->xml->elements;
    if (r->depth > 0) {
        uint32_t parent = r->open[r->depth - 1], elder = r->last[r->depth - 1];
        elements[index].parent = parent;
        if (elder == CSG_XML_NONE)
            elements[parent].first_child = index;
        else
            elements[elder].next_sibling = index;
        r->last[r->depth - 1] = index;
    }
    r->open[r->depth] = index;
    r->last[r->depth] = CSG_XML_NONE;
    r->depth++;
}

static void XMLCALL on_start(void *user, const char *name, const char **pairs)
{
    reader *r = user;
    csg_xml *xml = r->xml;
    if (r->status != CSGM_OK)
        return;
    if (r->depth == CSG_XML_MOST_DEPTH || xml->count == CSG_XML_MOST_ELEMENTS) {
        stop(r, csg_problem_set(r->problem, CSGM_ERR_LIMIT, "%s",
                                r->depth == CSG_XML_MOST_DEPTH ? "its elements are nested too deep"
                                                               : "it has too many elements"));
        return;
    }
    if (!csg_memory_reserve(xml->memory, (void **)&xml->elements, &xml->capacity, xml->count + 1,
                            sizeof *xml->elements)) {
        stop(r, CSGM_ERR_MEMORY);
        return;
    }
    csg_xml_element element = {
        .parent = CSG_XML_NONE, .first_child = CSG_XML_NONE, .next_sibling = CSG_XML_NONE};
    element.name = keep(r, local_name(name));
    if (!element.name || !add_attributes(r, pairs, &element))
        return;
    xml->elements[xml->count] = element;
    link_element(r, (uint32_t)xml->count++);
}

static void XMLCALL on_end(void *user, const char *name)
{
    reader *r = user;
    (void)name;
    if (r->status == CSGM_OK)
        r->depth--;
}

/* Also what entities become: the sum is bounded. */
static void XMLCALL on_text(void *user, const char *text, int length)
{
    reader *r = user;
    (void)text;
    r->text_bytes += (size_t)length;
    if (r->text_bytes > CSG_INPUT_MOST_BYTES && r->status == CSGM_OK)
        stop(r, csg_problem_set(r->problem, CSGM_ERR_LIMIT, "its text is too long"));
}

static csgm_status parse_text(reader *r, const char *text, size_t length)
{
    XML_SetUserData(r->parser, r);
    XML_SetElementHandler(r->parser, on_start, on_end);
    XML_SetCharacterDataHandler(r->parser, on_text);
    enum XML_Status done = XML_Parse(r->parser, text, (int)length, 1);
    if (r->status != CSGM_OK)
        return r->status;
    if (done == XML_STATUS_OK)
        return CSGM_OK;
    enum XML_Error code = XML_GetErrorCode(r->parser);
    if (code == XML_ERROR_NO_MEMORY)
        return CSGM_ERR_MEMORY;
    return csg_problem_set(r->problem, CSGM_ERR_FORMAT, "it is not well-formed XML: %s in line %lu",
                           XML_ErrorString(code),
                           (unsigned long)XML_GetCurrentLineNumber(r->parser));
}

csgm_status csg_xml_parse(csg_memory *memory, const char *text, size_t length, csg_xml *out,
                          csg_problem *problem)
{
    reader r = {.xml = out, .problem = problem};
    if (length > CSG_INPUT_MOST_BYTES)
        return csg_problem_set(problem, CSGM_ERR_LIMIT, "it is larger than %zu MiB",
                               CSG_INPUT_MOST_BYTES >> 20);
    r.parser = XML_ParserCreate(NULL);
    if (!r.parser)
        return CSGM_ERR_MEMORY;
    *out = (csg_xml){.memory = memory};
    csg_arena_init(&out->arena, memory);
    csgm_status status = parse_text(&r, text, length);
    XML_ParserFree(r.parser);
    if (status == CSGM_OK && out->count == 0)
        status = csg_problem_set(problem, CSGM_ERR_FORMAT, "it has no elements");
    if (status != CSGM_OK)
        csg_xml_release(out);
    return status;
}
