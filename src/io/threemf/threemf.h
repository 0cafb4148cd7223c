/* SPDX-License-Identifier: MIT
 * What a 3MF package says, gathered from its XML (threemf_model.c), for threemf_read.c to put in
 * place. All numbers are checked: what is here is finite and in range.
 */
#ifndef CSG_IO_THREEMF_H
#define CSG_IO_THREEMF_H

#include "io/reader.h"

typedef struct csg_3mf_vertex {
    double at[3];
    uint8_t color[4];
    bool colored; /* of the first triangle that names a colour for it */
} csg_3mf_vertex;

/* A transform's rows of [m | t]. */
typedef struct csg_3mf_reference {
    uint32_t file; /* of the package: index into files */
    uint32_t id;
    double transform[12];
} csg_3mf_reference;

typedef struct csg_3mf_object {
    uint32_t file, id;
    const char *name; /* NULL = none */
    size_t first_vertex, vertex_count, first_triangle, triangle_count;
    size_t first_component, component_count;
} csg_3mf_object;

/* A list of colours that triangles name by its id. */
typedef struct csg_3mf_group {
    uint32_t file, id;
    size_t first, count;
} csg_3mf_group;

typedef struct csg_3mf {
    csg_input *input;
    csg_arena names;
    const char **files; /* names in the package; the first is the root model */
    csg_3mf_vertex *vertices;
    uint32_t *triangles; /* 3 each, relative to the object's first vertex */
    csg_3mf_object *objects;
    csg_3mf_reference *components, *items;
    csg_3mf_group *groups;
    uint8_t *colors; /* 4 each */
    size_t file_count, file_room, vertex_count, vertex_room, triangle_count, triangle_room,
        object_count, object_room, component_count, component_room, item_count, item_room,
        group_count, group_room, color_count, color_room;
    bool colored;      /* some vertex is */
    double unit_mm;    /* of the root model */
    bool ours;         /* it says that csgmesh made it */
    bool has_pictures; /* textures, of which nothing is read */
} csg_3mf;

/* Reads the package. Reports what fails. Release it in any case. */
csgm_status csg_3mf_load(csg_3mf *model, csg_input *input);
void csg_3mf_release(csg_3mf *model);

#endif
