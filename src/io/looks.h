/* SPDX-License-Identifier: MIT
 * What a part looks like, for formats that have materials: one colour for all of it or one for each
 * vertex, and the same of metallic and roughness. Parts of one look share a material, whose name is
 * said by the look alone.
 */
#ifndef CSG_IO_LOOKS_H
#define CSG_IO_LOOKS_H

#include <string.h>

#include "io/parts.h"

/* Members that say nothing are zero, so that equal looks have equal bytes. */
typedef struct csg_part_look {
    uint8_t color[4]; /* of all its vertices, where is_colored and not each_color */
    uint16_t material[2];
    bool is_colored;    /* the mesh has colours */
    bool each_color;    /* each vertex has its own */
    bool each_material; /* each vertex has its own metallic and roughness */
    bool is_opaque;
} csg_part_look;

csg_part_look csg_look_of(const csgm_mesh_view *mesh, const csg_part_stretch *part);
/* The look of a part that has no colours and no materials. */
csg_part_look csg_look_plain(void);

static inline bool csg_look_is(const csg_part_look *a, const csg_part_look *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* A CSS colour's name or #RRGGBB, "plain" or "painted" (each vertex has its own), then what is not
 * as in plain materials: goldenrod-metal100-rough30. One word, for formats that end names at a
 * space. */
enum { CSG_LOOK_NAME_MOST = 96 };
void csg_look_name(const csg_part_look *look, char name[CSG_LOOK_NAME_MOST]);

#endif
