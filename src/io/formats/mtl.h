/* SPDX-License-Identifier: MIT
 * Materials of OBJ, in a file of their own beside it (.mtl): colour (Kd), opacity (d), and metallic
 * and roughness (Pm, Pr, as most programs have agreed on).
 */
#ifndef CSG_IO_MTL_H
#define CSG_IO_MTL_H

#include "io/looks.h"
#include "io/reader.h"
#include "io/sink.h"

/* ---- written ---------------------------------------------------------------------- */

/* The looks of a mesh's parts. */
typedef struct csg_mtl {
    csg_part_look *looks; /* one per part */
    size_t count;
    bool each_color; /* of some part each vertex has its own: v lines have colours */
    bool says_more;  /* than that */
} csg_mtl;

/* A look's name; '#', with which comments begin, is "rgb". */
enum { CSG_MTL_NAME_MOST = CSG_LOOK_NAME_MOST + 2 };
void csg_mtl_name(const csg_part_look *look, char name[CSG_MTL_NAME_MOST]);

/* Of a mesh that has colours or materials. Reports what fails (memory only). Release it. */
csgm_status csg_mtl_make(csgm_context *context, const csgm_mesh_view *mesh, csg_mtl *out);
void csg_mtl_release(csgm_context *context, csg_mtl *mtl);

/* Writes the companion of the sink's file, and "mtllib NAME" into the sink. Reports what fails. */
csgm_status csg_mtl_write(csg_sink *sink, const csg_mtl *mtl, const csgm_write_options *options);

/* ---- read ------------------------------------------------------------------------- */

typedef struct csg_mtl_material {
    uint8_t color[4];
    uint16_t finish[2]; /* metallic and roughness */
    bool has_color, has_finish;
} csg_mtl_material;

typedef struct csg_mtl_entry {
    const char *name;
    uint32_t index;
} csg_mtl_entry;

typedef struct csg_mtl_library {
    csg_mtl_material *materials;
    csg_mtl_entry *sorted; /* by name */
    size_t count, room, sorted_room;
    size_t file_count;
    csg_arena names;
    bool has_pictures; /* of which nothing is read */
    bool is_missing;   /* a file was not to be had */
} csg_mtl_library;

void csg_mtl_library_init(csg_mtl_library *library, csgm_context *context);
void csg_mtl_library_release(csg_mtl_library *library);
/* Adds the materials of a file beside the input. One that is not there or lies elsewhere is
 * noted; CSGM_ERR_MEMORY and the like are reported. */
csgm_status csg_mtl_read(csg_input *input, const char *name, csg_mtl_library *library);
/* -1: there is none of this name. */
int64_t csg_mtl_find(const csg_mtl_library *library, const char *name, size_t length);

#endif
