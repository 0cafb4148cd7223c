/* SPDX-License-Identifier: MIT
 * The table of formats and what can be asked of it. A format's name is its extension.
 */
#include "io/formats.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "io/format_table.h"

#define PACKAGE_LIBRARIES "libzip, expat and zlib"

static const csg_format_row rows[] = {
    {CSGM_FORMAT_OBJ, "obj", csg_obj_write, csg_obj_read, NULL, NULL, NULL, NULL},
    {CSGM_FORMAT_PLY, "ply", csg_ply_write, csg_ply_read, NULL, NULL, NULL, NULL},
    {CSGM_FORMAT_STL, "stl", csg_stl_write, csg_stl_read, NULL, NULL, NULL, NULL},
    {CSGM_FORMAT_OFF, "off", csg_off_write, csg_off_read, NULL, NULL, NULL, NULL},
    {CSGM_FORMAT_GLTF, "gltf", csg_gltf_write, csg_gltf_read_file, NULL, "tinygltf", NULL,
     csg_gltf_available},
    {CSGM_FORMAT_GLB, "glb", csg_glb_write, csg_gltf_read_file, NULL, "tinygltf", NULL,
     csg_gltf_available},
    {CSGM_FORMAT_DRC, "drc", csg_drc_write, csg_drc_read, "Draco", "Draco", csg_draco_available,
     csg_draco_available},
    {CSGM_FORMAT_3MF, "3mf", csg_3mf_write, csg_3mf_read, PACKAGE_LIBRARIES, PACKAGE_LIBRARIES,
     csg_package_available, csg_package_available},
};

enum { ROWS = sizeof rows / sizeof *rows };
_Static_assert(ROWS == CSGM_FORMAT_COUNT - 1, "every format but AUTO has a row");

const csg_format_row *csg_format_find(csgm_format format)
{
    for (size_t i = 0; i < ROWS; i++)
        if (rows[i].id == format)
            return &rows[i];
    return NULL;
}

csgm_format csg_format_from_name(const char *name)
{
    for (size_t i = 0; name && i < ROWS; i++)
        if (strcasecmp(rows[i].name, name) == 0)
            return rows[i].id;
    return CSGM_FORMAT_AUTO;
}

csgm_format csg_format_from_path(const char *path)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && !strchr(dot, '/') ? csg_format_from_name(dot + 1) : CSGM_FORMAT_AUTO;
}

const char *csg_format_name(csgm_format format)
{
    const csg_format_row *row = csg_format_find(format);
    return row ? row->name : "auto";
}

bool csg_format_available(csgm_format format, bool for_reading)
{
    const csg_format_row *row = csg_format_find(format);
    if (!row)
        return false;
    bool (*can)(void) = for_reading ? row->can_read : row->can_write;
    return !can || can();
}

csgm_status csg_format_no_library(csgm_context *context, const char *file, const char *library,
                                  const char *what)
{
    csg_diag_plain(&context->diags, CSG_DIAG_NO_LIBRARY, file,
                   "install the library's development package and build csgmesh again",
                   "this csgmesh was built without %s, which %s needs", library, what);
    return CSGM_ERR_UNSUPPORTED;
}

csgm_status csg_format_unknown(csgm_context *context, const char *file)
{
    char known[128];
    int length = snprintf(known, sizeof known, "formats are");
    for (size_t i = 0; i < ROWS; i++)
        length += snprintf(known + length, sizeof known - (size_t)length, "%s %s", i ? "," : "",
                           rows[i].name);
    csg_diag_plain(&context->diags, CSG_DIAG_UNKNOWN_FORMAT, file, known,
                   "the file name's extension names no mesh format");
    return CSGM_ERR_UNSUPPORTED;
}
