/* SPDX-License-Identifier: MIT
 * Looks of parts -> .mtl; see mtl.h. A part of one colour has it in its material alone, so that a
 * reader that multiplies the two gets it once; one that is painted is white there. Colours are
 * sRGB, as those of v lines are. Equal looks are one material.
 */
#include "io/formats/mtl.h"

#include <strings.h>

#include "io/file.h"
#include "io/writers.h"

/* Of one pair of metallic and roughness that is not what is taken where nothing is said. */
static bool has_finish(const csg_part_look *look)
{
    return !look->each_material && (look->material[0] != CSG_MATERIAL_METALLIC ||
                                    look->material[1] != CSG_MATERIAL_ROUGHNESS);
}

csgm_status csg_mtl_make(csgm_context *context, const csgm_mesh_view *mesh, csg_mtl *out)
{
    *out = (csg_mtl){.count = (size_t)csg_part_count(mesh)};
    out->looks = csg_memory_alloc(&context->memory, out->count * sizeof *out->looks);
    if (!out->looks)
        return csg_context_no_memory(context);
    for (size_t i = 0; i < out->count; i++) {
        csg_part_stretch part = csg_part_get(mesh, i);
        out->looks[i] = csg_look_of(mesh, &part);
        out->each_color |= out->looks[i].each_color;
        out->says_more |= !out->looks[i].each_color || has_finish(&out->looks[i]);
    }
    return CSGM_OK;
}

void csg_mtl_release(csgm_context *context, csg_mtl *mtl)
{
    csg_memory_release(&context->memory, mtl->looks, mtl->count * sizeof *mtl->looks);
    *mtl = (csg_mtl){.looks = NULL};
}

void csg_mtl_name(const csg_part_look *look, char name[CSG_MTL_NAME_MOST])
{
    csg_look_name(look, name);
    if (*name != '#')
        return;
    memmove(name + 3, name + 1, strlen(name));
    memcpy(name, "rgb", 3);
}

static void put_value(csg_sink *sink, const char *key, double value)
{
    char *at = (char *)csg_sink_room(sink, 16 + CSG_FIXED_MOST);
    at = stpcpy(at, key);
    *at++ = ' ';
    at = csg_number_put_fixed(at, value, 4);
    *at++ = '\n';
    csg_sink_took(sink, at);
}

static void put_color(csg_sink *sink, const csg_part_look *look)
{
    char *at = (char *)csg_sink_room(sink, 8 + 3 * (CSG_NUMBER_MOST + 1));
    at = stpcpy(at, "Kd");
    for (int k = 0; k < 3; k++) {
        *at++ = ' ';
        at = csg_number_put_float(at, look->each_color ? 1 : (float)look->color[k] / 255.0f);
    }
    *at++ = '\n';
    csg_sink_took(sink, at);
}

/* What is not said is how the reader shows what has no colour. */
static void put_material(csg_sink *sink, const csg_part_look *look)
{
    char name[CSG_MTL_NAME_MOST];
    csg_mtl_name(look, name);
    csg_sink_format(sink, "\nnewmtl %s\n", name);
    if (look->is_colored)
        put_color(sink, look);
    if (look->is_colored && !look->each_color && !look->is_opaque)
        put_value(sink, "d", look->color[3] / 255.0);
    if (look->each_material)
        return;
    put_value(sink, "Pm", look->material[0] / (double)CSG_MATERIAL_ONE);
    put_value(sink, "Pr", look->material[1] / (double)CSG_MATERIAL_ONE);
}

static bool is_new(const csg_mtl *mtl, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (csg_look_is(&mtl->looks[i], &mtl->looks[index]))
            return false;
    return true;
}

static csgm_status fill(csgm_context *context, const csg_mtl *mtl, int fd, const char *path)
{
    csg_sink sink;
    csgm_status status = csg_sink_open(&sink, context, fd, path);
    if (status)
        return status;
    csg_sink_format(&sink, "# %s\n", CSG_WRITTEN_BY);
    for (size_t i = 0; i < mtl->count; i++)
        if (is_new(mtl, i))
            put_material(&sink, &mtl->looks[i]);
    return csg_sink_close(&sink);
}

/* knob.obj -> knob.mtl; other names get the ending behind their own. In the arena. */
static char *path_beside(csg_arena *arena, const char *path)
{
    size_t length = strlen(path);
    bool ends = length > 4 && strcasecmp(path + length - 4, ".obj") == 0;
    char *out = csg_arena_alloc(arena, length + 5);
    if (!out)
        return NULL;
    length -= ends ? 4 : 0;
    memcpy(out, path, length);
    memcpy(out + length, ".mtl", 5);
    return out;
}

csgm_status csg_mtl_write(csg_sink *sink, const csg_mtl *mtl, const csgm_write_options *options)
{
    csg_companion *companion = sink->companion;
    csg_atomic_file *file = &companion->file;
    char *path = path_beside(&companion->names, sink->name);
    if (!path)
        return csg_context_no_memory(sink->context);
    const char *slash = strrchr(path, '/');
    csg_sink_format(sink, "mtllib %s\n", slash ? slash + 1 : path);
    if (companion->nameless)
        return fill(sink->context, mtl, *companion->nameless, path);
    csgm_status status = csg_file_create(file, sink->context, path);
    if (status)
        return status;
    companion->is_there = true;
    file->sync = options->sync;
    file->only_if_changed = options->only_if_changed;
    return fill(sink->context, mtl, file->fd, path);
}
