/* SPDX-License-Identifier: MIT
 * 3MF package -> csg_3mf: objects with their meshes or components, items, colours. The root model
 * is the one that the package's relationships name; other models that it refers to (the production
 * extension) are read after it. Textures, composites and what else extensions add are passed over.
 */
#include "io/threemf/threemf.h"

#include <math.h>
#include <stdlib.h>

#include "io/adapter.h"
#include "io/units.h"

/* A namespace that the file's root element may name by its prefix. */
typedef struct prefix {
    struct prefix *next;
    const char *name, *space;
} prefix;

typedef struct parser {
    csg_3mf *m;
    uint32_t file;
    csg_3mf_object *object; /* being read, or NULL */
    uint32_t object_group, object_color;
    const csg_3mf_group *last_group;
    const char *target; /* of the relationships: the root model */
    prefix *prefixes;   /* declared before the file's first element */
    bool has_begun;
    char application[8]; /* the first letters of the metadata of this name */
    size_t application_length;
    bool is_application; /* which is open */
} parser;

#define CORE "http://schemas.microsoft.com/3dmanufacturing/core/"
#define MATERIAL "http://schemas.microsoft.com/3dmanufacturing/material/"
#define PRODUCTION "http://schemas.microsoft.com/3dmanufacturing/production/"
#define PRODUCTION_PATH PRODUCTION "2015/06|path"

/* ---- names and numbers ------------------------------------------------------------------------
 */

/* "namespace|name" with any year of the namespace. */
static bool is(const char *element, const char *space, const char *name)
{
    size_t length = strlen(space);
    const char *bar = strrchr(element, '|');
    return bar && strncmp(element, space, length) == 0 && strcmp(bar + 1, name) == 0;
}

static const char *find(const char *const *attributes, const char *name)
{
    for (; *attributes; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            return attributes[1];
    return NULL;
}

static csgm_status broken(const parser *p, const char *what)
{
    return csg_read_broken(p->m->input, 0, "in the package's %.80s: %s", p->m->files[p->file],
                           what);
}

/* The next of several numbers; NULL when there is none or it is not finite. */
static const char *next_number(const char *at, double *value)
{
    while (csg_xml_is_blank(*at))
        at++;
    at = csg_number_parse(at, at + strlen(at), value);
    return at && isfinite(*value) ? at : NULL;
}

static bool read_number(const char *const *attributes, const char *name, double *value)
{
    const char *text = find(attributes, name), *end = text ? next_number(text, value) : NULL;
    while (end && csg_xml_is_blank(*end))
        end++;
    return end && !*end;
}

/* Up to 2^31 - 1, as the format has them. */
static bool read_index(const char *text, uint32_t *value)
{
    uint32_t number = 0;
    const char *at = text;
    for (; at && *at >= '0' && *at <= '9' && number <= INT32_MAX / 10; at++)
        number = number * 10 + (uint32_t)(*at - '0');
    *value = number;
    return at && at != text && !*at && number <= INT32_MAX;
}

/* "m00 m01 m02 m10 ... m32", for rows of coordinates from the left. */
static bool read_transform(const char *text, double rows[12])
{
    for (int i = 0; i < 12; i++)
        rows[i] = i % 5 == 0 ? 1 : 0;
    if (!text)
        return true;
    for (int i = 0; i < 12; i++) {
        text = next_number(text, &rows[4 * (i % 3) + i / 3]);
        if (!text)
            return false;
    }
    while (csg_xml_is_blank(*text))
        text++;
    return !*text;
}

/* ---- growing arrays ---------------------------------------------------------------------------
 */

static csgm_status no_memory(const parser *p)
{
    return csg_context_no_memory(p->m->input->context);
}

/* The number of a file of the package, read later if it is new. */
static csgm_status file_number(parser *p, const char *name, uint32_t *number)
{
    enum { MOST = 1000 };
    csg_3mf *m = p->m;
    while (*name == '/')
        name++;
    for (uint32_t i = 0; i < m->file_count; i++)
        if (strcmp(m->files[i], name) == 0) {
            *number = i;
            return CSGM_OK;
        }
    if (m->file_count == MOST)
        return broken(p, "it refers to more than 1000 other models");
    if (!csg_read_room(p->m->input, &m->files, &m->file_room, m->file_count + 1, sizeof *m->files))
        return no_memory(p);
    m->files[m->file_count] = csg_arena_strndup(&m->names, name, strlen(name));
    if (!m->files[m->file_count])
        return no_memory(p);
    *number = (uint32_t)m->file_count++;
    return CSGM_OK;
}

/* ---- colours ----------------------------------------------------------------------------------
 */

static int hex(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* "#RRGGBB" or "#RRGGBBAA". */
static bool read_color(const char *text, uint8_t color[4])
{
    size_t length = text ? strlen(text) : 0;
    if ((length != 7 && length != 9) || text[0] != '#')
        return false;
    color[3] = 255;
    for (size_t i = 0; 2 * i + 1 < length; i++) {
        int high = hex(text[2 * i + 1]), low = hex(text[2 * i + 2]);
        if (high < 0 || low < 0)
            return false;
        color[i] = (uint8_t)(16 * high + low);
    }
    return true;
}

static csgm_status add_group(parser *p, const char *const *attributes)
{
    csg_3mf *m = p->m;
    csg_3mf_group group = {.file = p->file, .first = m->color_count};
    if (!read_index(find(attributes, "id"), &group.id))
        return broken(p, "a group of colours has no good id");
    if (!csg_read_room(p->m->input, &m->groups, &m->group_room, m->group_count + 1,
                       sizeof *m->groups))
        return no_memory(p);
    m->groups[m->group_count++] = group;
    p->last_group = NULL; /* the array may have moved */
    return CSGM_OK;
}

static csgm_status add_color(parser *p, const char *text)
{
    csg_3mf *m = p->m;
    uint8_t color[4];
    if (!m->group_count)
        return CSGM_OK;
    if (!read_color(text, color))
        return broken(p, "a colour is not written as #RRGGBB or #RRGGBBAA");
    if (!csg_read_room(p->m->input, &m->colors, &m->color_room, m->color_count + 1, 4))
        return no_memory(p);
    memcpy(m->colors + 4 * m->color_count++, color, 4);
    m->groups[m->group_count - 1].count++;
    return CSGM_OK;
}

/* NULL: no such group, or it is not of colours. */
static const uint8_t *find_color(parser *p, uint32_t group_id, uint32_t index)
{
    csg_3mf *m = p->m;
    const csg_3mf_group *group = p->last_group;
    if (!group || group->id != group_id)
        for (size_t i = m->group_count; i-- > 0;) {
            group = &m->groups[i];
            if (group->file == p->file && group->id == group_id)
                break;
            group = NULL;
        }
    p->last_group = group;
    return group && index < group->count ? m->colors + 4 * (group->first + index) : NULL;
}

/* ---- objects ----------------------------------------------------------------------------------
 */

static csgm_status begin_object(parser *p, const char *const *attributes)
{
    csg_3mf *m = p->m;
    const char *name = find(attributes, "name");
    csg_3mf_object object = {.file = p->file,
                             .first_vertex = m->vertex_count,
                             .first_triangle = m->triangle_count,
                             .first_component = m->component_count};
    if (p->object)
        return broken(p, "an object stands inside another");
    if (!read_index(find(attributes, "id"), &object.id))
        return broken(p, "an object has no good id");
    if (!read_index(find(attributes, "pid"), &p->object_group))
        p->object_group = UINT32_MAX;
    if (!read_index(find(attributes, "pindex"), &p->object_color))
        p->object_color = 0;
    if (name && *name) {
        object.name = csg_arena_strndup(&m->names, name, strlen(name));
        if (!object.name)
            return no_memory(p);
    }
    if (!csg_read_room(p->m->input, &m->objects, &m->object_room, m->object_count + 1,
                       sizeof *m->objects))
        return no_memory(p);
    m->objects[m->object_count] = object;
    p->object = &m->objects[m->object_count++];
    return CSGM_OK;
}

/* Vertices that no triangle colours take the object's colour. */
static csgm_status end_object(parser *p)
{
    csg_3mf *m = p->m;
    csg_3mf_object *object = p->object;
    if (!object)
        return CSGM_OK;
    object->vertex_count = m->vertex_count - object->first_vertex;
    object->triangle_count = m->triangle_count - object->first_triangle;
    object->component_count = m->component_count - object->first_component;
    const uint8_t *color = find_color(p, p->object_group, p->object_color);
    for (size_t i = object->first_vertex; i < m->vertex_count && color; i++)
        if (!m->vertices[i].colored) {
            memcpy(m->vertices[i].color, color, 4);
            m->vertices[i].colored = m->colored = true;
        }
    p->object = NULL;
    return CSGM_OK;
}

static csgm_status add_vertex(parser *p, const char *const *attributes)
{
    csg_3mf *m = p->m;
    csg_3mf_vertex vertex = {.color = {255, 255, 255, 255}};
    if (!p->object)
        return broken(p, "a vertex stands outside of an object");
    if (!read_number(attributes, "x", &vertex.at[0]) ||
        !read_number(attributes, "y", &vertex.at[1]) ||
        !read_number(attributes, "z", &vertex.at[2]))
        return broken(p, "a vertex has a coordinate that is not a finite number");
    if (!csg_read_room(p->m->input, &m->vertices, &m->vertex_room, m->vertex_count + 1,
                       sizeof vertex))
        return no_memory(p);
    m->vertices[m->vertex_count++] = vertex;
    return CSGM_OK;
}

/* p1 alone colours all three corners; the group is the triangle's own or the object's. */
static void color_corners(parser *p, const char *const *attributes, const uint32_t corners[3])
{
    static const char *const names[3] = {"p1", "p2", "p3"};
    csg_3mf *m = p->m;
    uint32_t group, index[3];
    if (!read_index(find(attributes, "pid"), &group))
        group = p->object_group;
    if (group == UINT32_MAX || !read_index(find(attributes, names[0]), &index[0]))
        return;
    for (int k = 0; k < 3; k++) {
        csg_3mf_vertex *vertex = &m->vertices[p->object->first_vertex + corners[k]];
        if (vertex->colored)
            continue;
        if (k && !read_index(find(attributes, names[k]), &index[k]))
            index[k] = index[0];
        const uint8_t *color = find_color(p, group, index[k]);
        if (!color)
            continue;
        memcpy(vertex->color, color, 4);
        vertex->colored = m->colored = true;
    }
}

static csgm_status add_triangle(parser *p, const char *const *attributes)
{
    static const char *const names[3] = {"v1", "v2", "v3"};
    csg_3mf *m = p->m;
    uint32_t corners[3];
    if (!p->object)
        return broken(p, "a triangle stands outside of an object");
    for (int k = 0; k < 3; k++)
        if (!read_index(find(attributes, names[k]), &corners[k]) ||
            corners[k] >= m->vertex_count - p->object->first_vertex)
            return broken(p, "a triangle names a vertex that does not exist");
    if (!csg_read_room(p->m->input, &m->triangles, &m->triangle_room, m->triangle_count + 1,
                       sizeof corners))
        return no_memory(p);
    memcpy(m->triangles + 3 * m->triangle_count++, corners, sizeof corners);
    color_corners(p, attributes, corners);
    return CSGM_OK;
}

/* A component of the object at hand, or an item to build. */
static csgm_status add_reference(parser *p, const char *const *attributes,
                                 csg_3mf_reference **array, size_t *count, size_t *capacity)
{
    csg_3mf_reference reference = {.file = p->file};
    const char *path = find(attributes, PRODUCTION_PATH);
    if (!read_index(find(attributes, "objectid"), &reference.id))
        return broken(p, "a component or item does not say which object it is");
    if (!read_transform(find(attributes, "transform"), reference.transform))
        return broken(p, "a transform is not twelve finite numbers");
    csgm_status status = path ? file_number(p, path, &reference.file) : CSGM_OK;
    if (status)
        return status;
    if (!csg_read_room(p->m->input, array, capacity, *count + 1, sizeof reference))
        return no_memory(p);
    (*array)[(*count)++] = reference;
    return CSGM_OK;
}

/* ---- elements ---------------------------------------------------------------------------------
 */

static csgm_status start_core(parser *p, const char *element, const char *const *attributes)
{
    csg_3mf *m = p->m;
    if (is(element, CORE, "vertex"))
        return add_vertex(p, attributes);
    if (is(element, CORE, "triangle"))
        return add_triangle(p, attributes);
    if (is(element, CORE, "object"))
        return begin_object(p, attributes);
    if (is(element, CORE, "component"))
        return p->object ? add_reference(p, attributes, &m->components, &m->component_count,
                                         &m->component_room)
                         : broken(p, "a component stands outside of an object");
    if (is(element, CORE, "item") && p->file == 0)
        return add_reference(p, attributes, &m->items, &m->item_count, &m->item_room);
    if (is(element, CORE, "basematerials"))
        return add_group(p, attributes);
    if (is(element, CORE, "base"))
        return add_color(p, find(attributes, "displaycolor"));
    return CSGM_OK;
}

static csgm_status on_namespace(void *user, const char *name, const char *space)
{
    parser *p = user;
    csg_arena *names = &p->m->names;
    if (p->has_begun)
        return CSGM_OK;
    prefix *declared = csg_arena_alloc(names, sizeof *declared);
    if (!declared)
        return no_memory(p);
    *declared = (prefix){.next = p->prefixes,
                         .name = csg_arena_strndup(names, name, strlen(name)),
                         .space = csg_arena_strndup(names, space, strlen(space))};
    p->prefixes = declared;
    return declared->name && declared->space ? CSGM_OK : no_memory(p);
}

/* What a model requires must be read, or the mesh is not what is meant. Colours are read, of
 * materials else only the triangles. */
static csgm_status check_required(parser *p, const char *prefixes)
{
    enum { MOST = 64 };
    int count = 0;
    for (const char *at = prefixes; at && *at;) {
        if (count++ == MOST)
            return broken(p, "it requires too many extensions");
        size_t length = strcspn(at, " \t\r\n");
        const prefix *known = p->prefixes;
        while (known && (strlen(known->name) != length || memcmp(known->name, at, length) != 0))
            known = known->next;
        if (length && !known)
            return broken(p, "a required extension's prefix is not declared");
        if (length && strncmp(known->space, MATERIAL, strlen(MATERIAL)) != 0 &&
            strncmp(known->space, PRODUCTION, strlen(PRODUCTION)) != 0)
            return csg_read_unsupported(
                p->m->input, "it requires the extension '%.200s', which is not read", known->space);
        at += length + (at[length] != '\0');
    }
    return CSGM_OK;
}

static csgm_status begin_file(parser *p, const char *const *attributes)
{
    p->has_begun = true;
    if (p->file == 0)
        p->m->unit_mm = csg_unit_mm(find(attributes, "unit"));
    return check_required(p, find(attributes, "requiredextensions"));
}

static csgm_status on_start(void *user, const char *element, const char *const *attributes)
{
    parser *p = user;
    csgm_status status = p->has_begun ? CSGM_OK : begin_file(p, attributes);
    if (status)
        return status;
    if (is(element, CORE, "metadata") && p->file == 0) {
        const char *name = find(attributes, "name");
        p->is_application = name && strcmp(name, "Application") == 0;
        p->application_length = 0;
    }
    p->m->has_pictures |= is(element, MATERIAL, "texture2dgroup");
    if (is(element, MATERIAL, "colorgroup"))
        return add_group(user, attributes);
    if (is(element, MATERIAL, "color"))
        return add_color(user, find(attributes, "color"));
    return start_core(user, element, attributes);
}

static csgm_status on_text(void *user, const char *text, size_t length)
{
    parser *p = user;
    for (size_t i = 0; p->is_application && i < length; i++)
        if (p->application_length < sizeof p->application)
            p->application[p->application_length++] = text[i];
    return CSGM_OK;
}

static csgm_status on_end(void *user, const char *element)
{
    parser *p = user;
    if (is(element, CORE, "metadata") && p->is_application) {
        p->m->ours = p->application_length == sizeof p->application &&
                     memcmp(p->application, "csgmesh ", sizeof p->application) == 0;
        p->is_application = false;
    }
    return is(element, CORE, "object") ? end_object(user) : CSGM_OK;
}

static csgm_status on_relationship(void *user, const char *element, const char *const *attributes)
{
    parser *p = user;
    const char *bar = strrchr(element, '|'), *type = find(attributes, "Type"),
               *target = find(attributes, "Target");
    size_t length = type ? strlen(type) : 0;
    if (!bar || strcmp(bar + 1, "Relationship") != 0 || !target || p->target || length < 8 ||
        strcmp(type + length - 8, "/3dmodel") != 0)
        return CSGM_OK;
    p->target = csg_arena_strndup(&p->m->names, target, strlen(target));
    return p->target ? CSGM_OK : no_memory(p);
}

static csgm_status on_nothing(void *user, const char *element)
{
    (void)user, (void)element;
    return CSGM_OK;
}

/* ---- the package ------------------------------------------------------------------------------
 */

static csgm_status report(const csg_input *input, csgm_status status,
                          const csg_adapter_error *error)
{
    if (!status || !error->text[0])
        return status;
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(input->context);
    return csg_read_broken(input, 0, "%s", error->text);
}

static csgm_status read_files(parser *p, csg_package *package)
{
    csg_3mf *m = p->m;
    csg_adapter_error error = {.text = ""};
    csg_xml_calls relationships = {NULL, on_relationship, on_nothing, p, NULL};
    csg_xml_calls model = {on_namespace, on_start, on_end, p, on_text};
    csgm_status status =
        report(m->input, csg_package_parse(package, "_rels/.rels", &relationships, &error), &error);
    uint32_t root;
    if (!status && !p->target)
        status = csg_read_broken(m->input, 0, "the package names no 3-D model");
    if (!status)
        status = file_number(p, p->target, &root);
    for (; !status && p->file < m->file_count; p->file++) {
        p->object = NULL;
        p->last_group = NULL;
        p->prefixes = NULL;
        p->has_begun = false;
        error.text[0] = 0;
        status =
            report(m->input, csg_package_parse(package, m->files[p->file], &model, &error), &error);
    }
    return status;
}

csgm_status csg_3mf_load(csg_3mf *model, csg_input *input)
{
    *model = (csg_3mf){.input = input, .unit_mm = 1};
    csg_arena_init(&model->names, &input->context->memory);
    csg_adapter_error error = {.text = ""};
    csg_package *package = NULL;
    parser p = {.m = model};
    csgm_status status =
        report(input, csg_package_open(input->bytes, input->size_bytes, &package, &error), &error);
    if (!status)
        status = read_files(&p, package);
    csg_package_close(package);
    return status;
}

void csg_3mf_release(csg_3mf *m)
{
    csg_memory *memory = &m->input->context->memory;
    csg_memory_release(memory, m->files, m->file_room * sizeof *m->files);
    csg_memory_release(memory, m->vertices, m->vertex_room * sizeof *m->vertices);
    csg_memory_release(memory, m->triangles, m->triangle_room * 3 * sizeof *m->triangles);
    csg_memory_release(memory, m->objects, m->object_room * sizeof *m->objects);
    csg_memory_release(memory, m->components, m->component_room * sizeof *m->components);
    csg_memory_release(memory, m->items, m->item_room * sizeof *m->items);
    csg_memory_release(memory, m->groups, m->group_room * sizeof *m->groups);
    csg_memory_release(memory, m->colors, m->color_room * 4);
    csg_arena_reset(&m->names);
}
