/* SPDX-License-Identifier: MIT
 * What a PLY header says: elements in file order, each with its properties.
 */
#ifndef CSG_IO_PLY_H
#define CSG_IO_PLY_H

#include "io/text/scan.h"

typedef enum csg_ply_type {
    CSG_PLY_I8,
    CSG_PLY_U8,
    CSG_PLY_I16,
    CSG_PLY_U16,
    CSG_PLY_I32,
    CSG_PLY_U32,
    CSG_PLY_F32,
    CSG_PLY_F64,
    CSG_PLY_TYPES
} csg_ply_type;

extern const uint8_t csg_ply_type_bytes[CSG_PLY_TYPES];

/* What a property means to us; numbered so that positions, normals and colours are runs. */
typedef enum csg_ply_slot {
    CSG_PLY_X,
    CSG_PLY_Y,
    CSG_PLY_Z,
    CSG_PLY_NX,
    CSG_PLY_NY,
    CSG_PLY_NZ,
    CSG_PLY_RED,
    CSG_PLY_GREEN,
    CSG_PLY_BLUE,
    CSG_PLY_ALPHA,
    CSG_PLY_CORNERS, /* a face's list of vertices */
    CSG_PLY_SKIP
} csg_ply_slot;

typedef struct csg_ply_property {
    csg_ply_type type, count_type; /* count_type: of lists */
    bool is_list;
    csg_ply_slot slot;
} csg_ply_property;

typedef enum csg_ply_kind {
    CSG_PLY_VERTEX,
    CSG_PLY_FACE,
    CSG_PLY_STRIPS,
    CSG_PLY_OTHER
} csg_ply_kind;

enum { CSG_PLY_MOST_ELEMENTS = 16, CSG_PLY_MOST_PROPERTIES = 64 };

typedef struct csg_ply_element {
    csg_ply_kind kind;
    uint64_t count;
    uint32_t property_count;
    csg_ply_property properties[CSG_PLY_MOST_PROPERTIES];
} csg_ply_element;

typedef struct csg_ply_header {
    bool ascii, big_endian;
    uint32_t element_count;
    csg_ply_element elements[CSG_PLY_MOST_ELEMENTS];
} csg_ply_header;

/* What is wrong with rows, whoever finds it. */
#define CSG_PLY_NOT_FINITE "this vertex has a coordinate that is not finite"
#define CSG_PLY_NO_FACE "expected a face"
#define CSG_PLY_SHORT_FACE "this face has fewer vertices than it tells"
#define CSG_PLY_NO_SUCH_VERTEX "this face names a vertex that does not exist"

/* A number of binary data. */
double csg_ply_decode(const uint8_t *at, csg_ply_type type, bool big_endian);
/* Is it a list's count? */
bool csg_ply_is_count(double value);
/* Which slots the element fills, as bits; those of a place, a normal, a colour. */
uint32_t csg_ply_slots(const csg_ply_element *element);
enum {
    CSG_PLY_PLACE = 7u << CSG_PLY_X,
    CSG_PLY_NORMAL = 7u << CSG_PLY_NX,
    CSG_PLY_COLOR = 7u << CSG_PLY_RED
};

/* Leaves the scan on the first byte of data. Reports what is broken. */
csgm_status csg_ply_read_header(const csg_input *input, csg_text_scan *scan,
                                csg_ply_header *header);

#endif
