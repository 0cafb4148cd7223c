/* SPDX-License-Identifier: MIT
 * AMF -> mesh: plain XML, or a ZIP archive whose first file it is. Each object is a part, with its
 * name; where there are constellations, each instance of an object is one, in its place. A vertex
 * has its own colour or its object's. Lengths become millimetres; those of csgmesh's own files
 * stay the numbers that they are. Curved edges are straight, materials, textures and what else
 * there is are passed over; constellations of constellations are refused.
 */
#include <math.h>
#include <stdlib.h>

#include "base/elementary.h"
#include "io/adapter.h"
#include "io/color.h"
#include "io/reader.h"
#include "io/units.h"

enum { MOST_TEXT = 256, MOST_PLACED = 1 << 20, MOST_TRIANGLES_PLACED = 1 << 26 };

typedef struct amf_vertex {
    double at[3];
    uint8_t color[4];
    bool colored;
} amf_vertex;

typedef struct amf_object {
    uint32_t id;
    const char *name;
    size_t first_vertex, vertex_count, first_triangle, triangle_count;
    uint8_t color[4];
    bool colored;
} amf_object;

typedef struct amf_instance {
    uint32_t object;
    double shift[3], turn[3]; /* degrees about x, then y, then z */
} amf_instance;

/* Elements that mean something, by their names. */
typedef enum amf_element {
    OTHER,
    AMF,
    OBJECT,
    MESH,
    VERTICES,
    VERTEX,
    COORDINATES,
    VOLUME,
    TRIANGLE,
    COLOR,
    METADATA,
    CONSTELLATION,
    INSTANCE
} amf_element;

enum { DEEPEST = 64 /* as package.c lets elements nest */ };

typedef struct amf_file {
    csg_input *input;
    csg_mesh_builder *builder;
    csg_arena names;
    amf_vertex *vertices;
    uint32_t *triangles; /* 3 each, relative to the object's first vertex */
    amf_object *objects;
    amf_instance *instances;
    size_t vertex_count, vertex_room, triangle_count, triangle_room, object_count, object_room,
        instance_count, instance_room;
    amf_element path[DEEPEST + 1]; /* of the elements that are open; path[0] is none */
    uint32_t depth;
    char text[MOST_TEXT]; /* of the innermost */
    size_t length;
    bool is_name;     /* the metadata is the object's name */
    bool is_producer; /* it is who made the file */
    bool ours;        /* csgmesh did */
    double unit_mm;
    bool has_pictures; /* textures, of which nothing is read */
    double color[4];   /* being read */
    bool color_is_bad; /* a formula, as AMF allows */
    uint32_t seen;     /* bits of the coordinates or corners that are there */
    bool any_colored;
} amf_file;

static csgm_status broken(const amf_file *f, const char *what)
{
    return csg_read_broken(f->input, 0, "%s", what);
}

static csgm_status no_memory(const amf_file *f)
{
    return csg_context_no_memory(f->input->context);
}

/* ---- names and numbers ------------------------------------------------------------------ */

static const char *local(const char *name)
{
    const char *bar = strrchr(name, '|');
    return bar ? bar + 1 : name;
}

static amf_element element_of(const char *name)
{
    static const struct {
        const char *name;
        amf_element element;
    } rows[] = {{"amf", AMF},           {"object", OBJECT},     {"mesh", MESH},
                {"vertices", VERTICES}, {"vertex", VERTEX},     {"coordinates", COORDINATES},
                {"volume", VOLUME},     {"triangle", TRIANGLE}, {"color", COLOR},
                {"colour", COLOR},      {"metadata", METADATA}, {"constellation", CONSTELLATION},
                {"instance", INSTANCE}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strcmp(name, rows[i].name) == 0)
            return rows[i].element;
    return OTHER;
}

/* All of the innermost element's text. */
static bool read_number(const amf_file *f, double *value)
{
    const char *at = f->text, *end = f->text + f->length;
    while (at < end && csg_xml_is_blank(*at))
        at++;
    at = f->length < MOST_TEXT ? csg_number_parse(at, end, value) : NULL;
    while (at && at < end && csg_xml_is_blank(*at))
        at++;
    return at == end && isfinite(*value);
}

static bool read_id(const char *const *attributes, const char *name, uint32_t *id)
{
    for (; *attributes; attributes += 2)
        if (strcmp(local(attributes[0]), name) == 0) {
            char *end;
            unsigned long value = strtoul(attributes[1], &end, 10);
            *id = (uint32_t)value;
            return *attributes[1] >= '0' && *attributes[1] <= '9' && !*end && value < UINT32_MAX;
        }
    return false;
}

static const char *find(const char *const *attributes, const char *name)
{
    for (; *attributes; attributes += 2)
        if (strcmp(local(attributes[0]), name) == 0)
            return attributes[1];
    return NULL;
}

static bool has_type(const char *const *attributes, const char *type)
{
    const char *found = find(attributes, "type");
    return found && strcmp(found, type) == 0;
}

/* ---- elements ------------------------------------------------------------------------------ */

static amf_element parent(const amf_file *f, uint32_t levels)
{
    return f->depth > levels ? f->path[f->depth - levels] : OTHER;
}

static amf_object *last_object(amf_file *f)
{
    return &f->objects[f->object_count - 1];
}

static csgm_status begin_object(amf_file *f, const char *const *attributes)
{
    amf_object object = {.first_vertex = f->vertex_count, .first_triangle = f->triangle_count};
    if (!read_id(attributes, "id", &object.id))
        return broken(f, "an object has no good id");
    if (!csg_read_room(f->input, &f->objects, &f->object_room, f->object_count + 1,
                       sizeof *f->objects))
        return no_memory(f);
    f->objects[f->object_count++] = object;
    return CSGM_OK;
}

static csgm_status begin_instance(amf_file *f, const char *const *attributes)
{
    amf_instance instance = {.object = 0};
    if (!read_id(attributes, "objectid", &instance.object))
        return broken(f, "an instance names no object");
    if (!csg_read_room(f->input, &f->instances, &f->instance_room, f->instance_count + 1,
                       sizeof *f->instances))
        return no_memory(f);
    f->instances[f->instance_count++] = instance;
    return CSGM_OK;
}

static csgm_status begin_vertex(amf_file *f)
{
    f->seen = 0;
    if (last_object(f)->vertex_count == UINT32_MAX)
        return csg_read_unsupported(f->input, "more than 4294967295 vertices in one object");
    if (!csg_read_room(f->input, &f->vertices, &f->vertex_room, f->vertex_count + 1,
                       sizeof *f->vertices))
        return no_memory(f);
    f->vertices[f->vertex_count++] = (amf_vertex){.at = {0}};
    last_object(f)->vertex_count++;
    return CSGM_OK;
}

static csgm_status begin_triangle(amf_file *f)
{
    f->seen = 0;
    if (!csg_read_room(f->input, &f->triangles, &f->triangle_room, f->triangle_count + 1,
                       3 * sizeof *f->triangles))
        return no_memory(f);
    memset(f->triangles + 3 * f->triangle_count++, 0, 3 * sizeof *f->triangles);
    last_object(f)->triangle_count++;
    return CSGM_OK;
}

/* An element counts where it belongs, and is passed over elsewhere. */
static bool belongs(const amf_file *f, amf_element element)
{
    static const amf_element parents[] = {
        [OBJECT] = AMF,      [MESH] = OBJECT,       [VERTICES] = MESH,
        [VERTEX] = VERTICES, [VOLUME] = MESH,       [COORDINATES] = VERTEX,
        [TRIANGLE] = VOLUME, [CONSTELLATION] = AMF, [INSTANCE] = CONSTELLATION};
    if (element == AMF)
        return f->depth == 1;
    if (element == COLOR)
        return parent(f, 1) == VERTEX || parent(f, 1) == OBJECT;
    if (element == METADATA)
        return parent(f, 1) == OBJECT || parent(f, 1) == AMF;
    return element != OTHER && parent(f, 1) == parents[element];
}

static csgm_status on_start(void *user, const char *name, const char *const *attributes)
{
    amf_file *f = user;
    amf_element element = element_of(local(name));
    if (f->depth == DEEPEST)
        return broken(f, "its elements are nested too deeply");
    f->path[++f->depth] = OTHER;
    f->has_pictures |= f->depth == 2 && strcmp(local(name), "texture") == 0;
    f->length = 0;
    if (f->depth == 1 && element != AMF)
        return broken(f, "it does not begin with <amf>");
    if (!belongs(f, element))
        return CSGM_OK;
    f->path[f->depth] = element;
    switch (element) {
    case AMF:
        f->unit_mm = csg_unit_mm(find(attributes, "unit"));
        return CSGM_OK;
    case OBJECT:
        return begin_object(f, attributes);
    case INSTANCE:
        return begin_instance(f, attributes);
    case VERTEX:
        return begin_vertex(f);
    case TRIANGLE:
        return begin_triangle(f);
    case COLOR:
        f->color[0] = f->color[1] = f->color[2] = 0;
        f->color[3] = 1;
        f->color_is_bad = false;
        return CSGM_OK;
    case METADATA:
        f->is_name = parent(f, 1) == OBJECT && has_type(attributes, "name");
        f->is_producer = parent(f, 1) == AMF && has_type(attributes, "producer");
        return CSGM_OK;
    default:
        return CSGM_OK;
    }
}

static csgm_status on_text(void *user, const char *text, size_t length)
{
    amf_file *f = user;
    size_t left = MOST_TEXT - f->length, taken = length < left ? length : left;
    memcpy(f->text + f->length, text, taken);
    f->length += taken;
    return CSGM_OK;
}

/* Which of the names it is; -1: none. */
static int among(const char *name, const char *const *names, int count)
{
    for (int i = 0; i < count; i++)
        if (strcmp(name, names[i]) == 0)
            return i;
    return -1;
}

static csgm_status end_coordinate(amf_file *f, const char *name)
{
    static const char *const axes[] = {"x", "y", "z"};
    int axis = among(name, axes, 3);
    if (axis < 0)
        return CSGM_OK;
    if (!read_number(f, &f->vertices[f->vertex_count - 1].at[axis]))
        return broken(f, "a coordinate is no finite number");
    f->seen |= 1u << axis;
    return CSGM_OK;
}

static csgm_status end_corner(amf_file *f, const char *name)
{
    static const char *const corners[] = {"v1", "v2", "v3"};
    int corner = among(name, corners, 3);
    double value;
    if (corner < 0)
        return CSGM_OK;
    if (!read_number(f, &value) || value < 0 || value >= UINT32_MAX || value != floor(value))
        return broken(f, "a corner of a triangle is no number of a vertex");
    f->triangles[3 * (f->triangle_count - 1) + (size_t)corner] = (uint32_t)value;
    f->seen |= 1u << corner;
    return CSGM_OK;
}

static csgm_status end_place(amf_file *f, const char *name)
{
    static const char *const places[] = {"deltax", "deltay", "deltaz", "rx", "ry", "rz"};
    int place = among(name, places, 6);
    amf_instance *instance = &f->instances[f->instance_count - 1];
    if (place >= 0 &&
        !read_number(f, place < 3 ? &instance->shift[place] : &instance->turn[place - 3]))
        return broken(f, "an instance's place is no finite number");
    return CSGM_OK;
}

static void end_channel(amf_file *f, const char *name)
{
    static const char *const channels[] = {"r", "g", "b", "a"};
    int channel = among(name, channels, 4);
    if (channel >= 0 && !read_number(f, &f->color[channel]))
        f->color_is_bad = true;
}

static void end_color(amf_file *f)
{
    bool of_vertex = parent(f, 1) == VERTEX;
    uint8_t *color = of_vertex ? f->vertices[f->vertex_count - 1].color : last_object(f)->color;
    if (f->color_is_bad)
        return;
    for (int k = 0; k < 4; k++)
        color[k] = csg_color_to_byte((float)f->color[k]);
    *(of_vertex ? &f->vertices[f->vertex_count - 1].colored : &last_object(f)->colored) = true;
    f->any_colored = true;
}

static csgm_status end_metadata(amf_file *f)
{
    static const char US[] = "csgmesh ";
    f->ours |= f->is_producer && f->length >= strlen(US) && memcmp(f->text, US, strlen(US)) == 0;
    if (!f->is_name || !f->length)
        return CSGM_OK;
    last_object(f)->name = csg_arena_strndup(&f->names, f->text, f->length);
    return last_object(f)->name ? CSGM_OK : no_memory(f);
}

static csgm_status on_end(void *user, const char *full_name)
{
    amf_file *f = user;
    const char *name = local(full_name);
    csgm_status status = CSGM_OK;
    amf_element element = f->path[f->depth], outer = parent(f, 1);
    if (element == OTHER && outer == COORDINATES)
        status = end_coordinate(f, name);
    else if (element == OTHER && outer == TRIANGLE)
        status = end_corner(f, name);
    else if (element == OTHER && outer == INSTANCE)
        status = end_place(f, name);
    else if (element == OTHER && outer == COLOR)
        end_channel(f, name);
    else if (element == METADATA)
        status = end_metadata(f);
    else if (element == COLOR)
        end_color(f);
    else if (element == VERTEX && f->seen != 7)
        status = broken(f, "a vertex lacks coordinates");
    else if (element == TRIANGLE && f->seen != 7)
        status = broken(f, "a triangle lacks corners");
    f->length = 0;
    f->depth--;
    return status;
}

/* ---- into the builder -------------------------------------------------------------------- */

static int compare_objects(const void *a, const void *b)
{
    const amf_object *p = a, *q = b;
    return p->id < q->id ? -1 : p->id > q->id;
}

/* Objects are in the order of their ids. */
static const amf_object *find_object(const amf_file *f, uint32_t id)
{
    const amf_object wanted = {.id = id};
    return f->object_count
               ? bsearch(&wanted, f->objects, f->object_count, sizeof wanted, compare_objects)
               : NULL;
}

static void place(const amf_instance *instance, double at[3])
{
    const double degree = 0.017453292519943295;
    for (int axis = 0; axis < 3 && instance; axis++) {
        double angle = fmod(instance->turn[axis], 360) * degree, c = csg_cos(angle),
               s = csg_sin(angle);
        double *u = &at[(axis + 1) % 3], *v = &at[(axis + 2) % 3], old = *u;
        if (instance->turn[axis] == 0)
            continue;
        *u = c * old - s * *v;
        *v = s * old + c * *v;
    }
    for (int axis = 0; axis < 3 && instance; axis++)
        at[axis] += instance->shift[axis];
}

static csgm_status add_object(amf_file *f, const amf_object *object, const amf_instance *instance)
{
    uint64_t first = f->builder->vertex_count;
    if (first + object->vertex_count > UINT32_MAX)
        return csg_read_unsupported(f->input, "more than 4294967295 vertices in all");
    if (!csg_builder_part(f->builder, object->name))
        return no_memory(f);
    for (size_t i = 0; i < object->vertex_count && !f->builder->failed; i++) {
        const amf_vertex *vertex = &f->vertices[object->first_vertex + i];
        const uint8_t *color = vertex->colored ? vertex->color : object->color;
        static const uint8_t white[4] = {255, 255, 255, 255};
        double at[3] = {vertex->at[0], vertex->at[1], vertex->at[2]};
        place(instance, at);
        for (int k = 0; k < 3 && !f->ours; k++)
            at[k] *= f->unit_mm;
        if (!isfinite(at[0]) || !isfinite(at[1]) || !isfinite(at[2]))
            return broken(f, "a vertex is moved beyond all numbers");
        csg_builder_vertex(f->builder, at, NULL,
                           !f->any_colored                      ? NULL
                           : vertex->colored || object->colored ? color
                                                                : white);
    }
    for (size_t i = 0; i < object->triangle_count && !f->builder->failed; i++) {
        const uint32_t *corner = f->triangles + 3 * (object->first_triangle + i);
        for (int k = 0; k < 3; k++)
            if (corner[k] >= object->vertex_count)
                return broken(f, "a triangle names a vertex that does not exist");
        csg_builder_triangle(f->builder, (uint32_t)first + corner[0], (uint32_t)first + corner[1],
                             (uint32_t)first + corner[2]);
    }
    return f->builder->failed ? csg_builder_why_failed(f->builder) : CSGM_OK;
}

static csgm_status add_all(amf_file *f)
{
    csgm_status status = CSGM_OK;
    uint64_t placed = 0;
    csg_builder_unit(f->builder, f->ours ? csg_unit_of_mm(f->unit_mm) : CSGM_UNIT_MM);
    if (f->has_pictures)
        csg_builder_leave_out(f->builder, "textures");
    if (f->instance_count > MOST_PLACED)
        return csg_read_unsupported(f->input, "more than %d instances", MOST_PLACED);
    if (f->instance_count && f->object_count)
        qsort(f->objects, f->object_count, sizeof *f->objects, compare_objects);
    for (size_t i = 0; i < f->object_count && !f->instance_count && !status; i++)
        status = add_object(f, &f->objects[i], NULL);
    for (size_t i = 0; i < f->instance_count && !status; i++) {
        const amf_object *object = find_object(f, f->instances[i].object);
        if (!object)
            return csg_read_unsupported(f->input,
                                        "an instance names %u, which is no object (constellations "
                                        "of constellations are not read)",
                                        f->instances[i].object);
        placed += object->triangle_count;
        if (placed > f->triangle_count + MOST_TRIANGLES_PLACED)
            return csg_read_unsupported(f->input, "instances of more than %d triangles",
                                        MOST_TRIANGLES_PLACED);
        status = add_object(f, object, &f->instances[i]);
    }
    return status;
}

static csgm_status parse_file(amf_file *f)
{
    csg_adapter_error error = {.text = ""};
    const csg_xml_calls calls = {NULL, on_start, on_end, f, on_text};
    const csg_input *input = f->input;
    csg_package *package = NULL;
    csgm_status status;
    if (input->size_bytes < 2 || memcmp(input->bytes, "PK", 2) != 0) {
        status = csg_package_parse_bytes(input->bytes, input->size_bytes, &calls, &error);
    } else {
        status = csg_package_open(input->bytes, input->size_bytes, &package, &error);
        const char *first = package ? csg_package_first(package) : NULL;
        if (status == CSGM_OK && !first)
            status = broken(f, "the archive is empty");
        else if (status == CSGM_OK)
            status = csg_package_parse(package, first, &calls, &error);
        csg_package_close(package);
    }
    if (!status || !error.text[0])
        return status;
    return status == CSGM_ERR_MEMORY ? no_memory(f) : csg_read_broken(input, 0, "%s", error.text);
}

csgm_status csg_amf_read(csg_input *input, csg_mesh_builder *builder)
{
    csg_memory *memory = &input->context->memory;
    amf_file f = {.input = input, .builder = builder, .unit_mm = 1};
    csg_arena_init(&f.names, memory);
    csgm_status status = parse_file(&f);
    if (!status)
        status = add_all(&f);
    csg_memory_release(memory, f.vertices, f.vertex_room * sizeof *f.vertices);
    csg_memory_release(memory, f.triangles, f.triangle_room * 3 * sizeof *f.triangles);
    csg_memory_release(memory, f.objects, f.object_room * sizeof *f.objects);
    csg_memory_release(memory, f.instances, f.instance_room * sizeof *f.instances);
    csg_arena_reset(&f.names);
    return status;
}
