/* SPDX-License-Identifier: MIT
 * The skeleton of a DXF file: pairs of a group code and a value, a line each; entities, and the
 * blocks they stand in. Values are pieces of the file's text.
 */
#ifndef CSG_OUTLINE_DXF_FILE_H
#define CSG_OUTLINE_DXF_FILE_H

#include "outline/input.h"

typedef struct csg_dxf_text {
    const char *begin;
    size_t length;
} csg_dxf_text;

typedef struct csg_dxf_pair {
    int code;
    csg_dxf_text value;
} csg_dxf_pair;

typedef struct csg_dxf_entity {
    csg_dxf_text kind, layer;
    const char *begin, *end; /* its pairs, after the one that names it */
    bool paper;
} csg_dxf_entity;

typedef struct csg_dxf_block {
    csg_dxf_text name;
    csg_vec2 base;
    size_t first, count; /* in entities */
} csg_dxf_block;

typedef struct csg_dxf_file {
    csg_memory *memory;
    csg_dxf_entity *entities;
    csg_dxf_block *blocks; /* blocks[0] is the drawing itself */
    size_t entity_count, entity_capacity, block_count, block_capacity;
    int units; /* $INSUNITS */
} csg_dxf_file;

csgm_status csg_dxf_read(csg_memory *memory, const char *text, size_t length, csg_dxf_file *out,
                         csg_problem *problem);
void csg_dxf_release(csg_dxf_file *file);

/* The pair at *at, which moves on. False: the end, or lines that are no pair (*at is at the end).
 */
bool csg_dxf_pair_next(const char **at, const char *end, csg_dxf_pair *out);
bool csg_dxf_text_is(csg_dxf_text text, const char *name);
/* The value as a number of at most CSG_INPUT_MOST_COORDINATE; `otherwise` where it is none. */
double csg_dxf_number(const csg_dxf_pair *pair, double otherwise);
/* The first pair of an entity with this code as a number. */
double csg_dxf_get(const csg_dxf_entity *entity, int code, double otherwise);
/* The value of the first pair with this code; empty = none. */
csg_dxf_text csg_dxf_get_text(const csg_dxf_entity *entity, int code);

#endif
