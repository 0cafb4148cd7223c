/* SPDX-License-Identifier: MIT
 * Meshes for the language: read from files by io, or made of a part of the scene by field and mesh.
 * What those layers report on the way is caught: the caller knows the place in the scene that it is
 * about, they do not.
 */
#include "api/services.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "field/field.h"
#include "io/formats.h"
#include "mesh/pipeline/parts.h"

/* The first error, as a sentence. */
typedef struct catcher {
    char *problem;
    size_t size;
    bool is_set;
} catcher;

static void catch_problem(void *user, const csgm_diag *diag)
{
    catcher *c = user;
    if (c->is_set || diag->severity != CSGM_ERROR || !c->size)
        return;
    c->is_set = true;
    if (diag->line)
        snprintf(c->problem, c->size, "line %u: %s", diag->line, diag->message);
    else
        snprintf(c->problem, c->size, "%s", diag->message);
}

/* In place of the context's own, which is handed back by the caller. */
static csg_diag_sink catching_sink(catcher *c)
{
    return (csg_diag_sink){.on_diag = catch_problem, .user = c};
}

static csgm_status copy_mesh(csgm_context *context, const csgm_mesh *mesh, csg_triangles *out)
{
    csgm_mesh_view view = csg_mesh_view(mesh);
    csg_triangles_init(out, &context->memory);
    bool ok = true;
    for (uint64_t i = 0; i < view.vertex_count && ok; i++) {
        const float *p = view.positions + 3 * i;
        csg_vec3 at = {(double)p[0], (double)p[1], (double)p[2]};
        ok = csg_triangles_add_point(out, csg_vec3_add(view.origin, at));
    }
    for (uint64_t t = 0; t < view.triangle_count && ok; t++) {
        const uint32_t *corners = view.indices + 3 * t;
        ok = csg_triangles_add(out, corners[0], corners[1], corners[2]);
    }
    if (!ok)
        csg_triangles_release(out);
    return ok ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* A scene may wait for no other program and read from no endless device. What is not there at all
 * is for the reader to tell. */
static bool is_file(const char *path, char *problem, size_t problem_size)
{
    struct stat kind;
    if (stat(path, &kind) != 0 || S_ISREG(kind.st_mode))
        return true;
    snprintf(problem, problem_size, "it is a %s, not a file",
             S_ISDIR(kind.st_mode)    ? "folder"
             : S_ISFIFO(kind.st_mode) ? "pipe"
                                      : "device");
    return false;
}

static csgm_status read_mesh(csgm_context *context, const char *path, csg_triangles *out,
                             char *problem, size_t problem_size)
{
    catcher caught = {problem, problem_size, false};
    csg_diag_sink own = context->diags;
    csgm_mesh *mesh;
    if (problem_size)
        problem[0] = '\0';
    csg_triangles_init(out, &context->memory);
    if (!is_file(path, problem, problem_size))
        return CSGM_ERR_IO;
    context->diags = catching_sink(&caught);
    csgm_status status = csg_io_read(context, path, CSGM_FORMAT_AUTO, &mesh);
    context->diags = own;
    if (status != CSGM_OK)
        return status;
    status = copy_mesh(context, mesh, out);
    csg_mesh_destroy(mesh);
    if (status != CSGM_OK && problem_size)
        snprintf(problem, problem_size, "out of memory");
    return status;
}

static csgm_status build_mesh(csgm_context *context, const csgm_scene *scene, uint32_t cells,
                              csgm_mesh **mesh)
{
    csgm_mesh_options options = {.struct_size = sizeof options,
                                 .bounds = csg_box_empty(),
                                 .resolution = cells,
                                 .prune = true};
    csgm_mesh_stats stats;
    csgm_field *field;
    csgm_status status = csg_field_compile(context, scene, &field);
    if (status != CSGM_OK)
        return status;
    status = csg_mesh_build(context, field, &options, mesh, &stats);
    csg_field_destroy(field);
    return status;
}

static csgm_status tessellate(csgm_context *context, const csgm_scene *scene, uint32_t cells,
                              csg_triangles *out)
{
    catcher caught = {NULL, 0, false};
    csg_diag_sink own = context->diags;
    csgm_mesh *mesh;
    context->diags = catching_sink(&caught);
    csgm_status status = build_mesh(context, scene, cells, &mesh);
    context->diags = own;
    csg_triangles_init(out, &context->memory);
    if (status != CSGM_OK)
        return status;
    status = copy_mesh(context, mesh, out);
    csg_mesh_destroy(mesh);
    return status;
}

const csg_services *csg_api_services(void)
{
    static const csg_services services = {.read_mesh = read_mesh, .tessellate = tessellate};
    return &services;
}
