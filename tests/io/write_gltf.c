/* SPDX-License-Identifier: MIT
 * Writes GLB and glTF files of every shape and option into the folder named by the argument, for
 * validate.mjs. Exit 1 when a write fails.
 */
#include "support.h"

#include <stdio.h>
#include <string.h>

#include "io/adapter.h"

typedef struct variant {
    const char *name;
    bool draco, z_up;
    csgm_unit unit;
    bool meshopt;
    csgm_uv uv;
    bool levels, khr;
} variant;

static int write_one(io_context *io, const csgm_mesh_view *view, const char *folder,
                     const char *shape, const variant *v, const char *extension)
{
    static const char *const metadata[] = {"title=A \"mug\"", "licence=MIT", "title=Mug"};
    char path[512];
    csgm_write_options options = csg_write_options_default();
    options.draco = v->draco;
    options.meshopt = v->meshopt;
    options.meshopt_khr = v->khr;
    options.uv = v->uv;
    const csgm_level level = {.mesh = *view, .error = 0.5};
    options.levels = &level;
    options.level_count = v->levels && view->triangle_count ? 1 : 0;
    options.metadata = metadata;
    options.metadata_count = sizeof metadata / sizeof *metadata;
    options.y_up = !v->z_up;
    options.unit = v->unit;
    snprintf(path, sizeof path, "%s/%s-%s.%s", folder, shape, v->name, extension);
    csgm_status status = csg_io_write(&io->context, view, path, CSGM_FORMAT_AUTO, &options);
    if (status)
        fprintf(stderr, "%s: %s\n", path, io->last);
    return status != CSGM_OK;
}

static int write_variants(io_context *io, const csgm_mesh_view *view, const char *folder,
                          const char *shape)
{
    static const variant variants[] = {
        {"plain", false, false, CSGM_UNIT_NONE, false, CSGM_UV_NONE, false, false},
        {"zup", false, true, CSGM_UNIT_NONE, false, CSGM_UV_NONE, false, false},
        {"mm", false, false, CSGM_UNIT_MM, false, CSGM_UV_NONE, false, false},
        {"inch-zup", false, true, CSGM_UNIT_IN, false, CSGM_UV_NONE, false, false},
        {"draco", true, false, CSGM_UNIT_NONE, false, CSGM_UV_NONE, false, false},
        {"draco-cm", true, false, CSGM_UNIT_CM, false, CSGM_UV_NONE, false, false},
        {"meshopt", false, false, CSGM_UNIT_MM, true, CSGM_UV_NONE, false, false},
        {"meshopt-zup", false, true, CSGM_UNIT_NONE, true, CSGM_UV_NONE, false, false},
        {"box", false, false, CSGM_UNIT_MM, false, CSGM_UV_BOX, true, false},
        {"cylinder-meshopt", false, false, CSGM_UNIT_MM, true, CSGM_UV_CYLINDER, true, false},
        {"khr", false, false, CSGM_UNIT_MM, true, CSGM_UV_BOX, false, true},
        {"levels-draco", true, false, CSGM_UNIT_MM, false, CSGM_UV_NONE, true, false}};
    int failed = 0;
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        if (variants[i].draco && !csg_format_available(CSGM_FORMAT_DRC, false))
            continue;
        if (variants[i].meshopt && !csg_meshopt_available())
            continue;
        failed |= write_one(io, view, folder, shape, &variants[i], "glb");
        failed |= write_one(io, view, folder, shape, &variants[i], "gltf");
    }
    return failed;
}

/* What a mesher may hand over: no normals, glass, normals of no length. */
static int write_odd(io_context *io, const char *folder)
{
    csgm_mesh *mesh = io_shape_make(&io->context, IO_SPHERE);
    csgm_mesh_view view = csg_mesh_view(mesh);
    int failed = 0;
    mesh->colors[7] = 128;
    memset(mesh->normals + 30, 0, 12);
    mesh->normals[60] *= 1.5f;
    failed |= write_variants(io, &view, folder, "odd");
    view.normals = NULL;
    failed |= write_variants(io, &view, folder, "colors");
    view.colors = NULL;
    failed |= write_variants(io, &view, folder, "bare");
    csg_mesh_destroy(mesh);
    mesh = io_sphere_make(&io->context, 400, 200); /* more vertices than 16 bits count */
    view = csg_mesh_view(mesh);
    failed |= write_variants(io, &view, folder, "large");
    csg_mesh_destroy(mesh);
    return failed;
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    io_context io;
    io_context_init(&io, 0);
    int failed = 0;
    for (int shape = 0; shape < IO_SHAPES; shape++) {
        csgm_mesh *mesh = io_shape_make(&io.context, (io_shape)shape);
        csgm_mesh_view view = csg_mesh_view(mesh);
        failed |= write_variants(&io, &view, argv[1], io_shape_names[shape]);
        csg_mesh_destroy(mesh);
    }
    return failed | write_odd(&io, argv[1]);
}
