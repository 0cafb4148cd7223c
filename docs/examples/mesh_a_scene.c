/* SPDX-License-Identifier: MIT
 * The whole way by the C interface: scene text in, PLY file out.
 *
 *     cc mesh_a_scene.c $(pkg-config --cflags --libs csgmesh) -o mesh_a_scene
 *     ./mesh_a_scene out.ply
 */
#include <csgmesh/csgmesh.h>
#include <stdio.h>
#include <string.h>

static const char scene_text[] = "union(blend = 0.4) {\n"
                                 "  sphere(r = 1);\n"
                                 "  cylinder(h = 2, r = 0.5);\n"
                                 "}\n";

static void print_finding(void *user, const csgm_diag *diag)
{
    char text[1024];
    csgm_diag_format(diag, text, sizeof text);
    fputs(text, user);
}

int main(int argc, char **argv)
{
    csgm_context_options options = csgm_context_options_default();
    options.on_diag = print_finding;
    options.user = stderr;
    csgm_context *context = NULL;
    csgm_scene *scene = NULL;
    csgm_field *field = NULL;
    csgm_mesh *mesh = NULL;

    csgm_status status = csgm_context_create(&options, &context);
    if (status == CSGM_OK)
        status = csgm_scene_parse(context, scene_text, strlen(scene_text), "text", NULL, &scene);
    if (status == CSGM_OK)
        status = csgm_field_compile(context, scene, &field);
    if (status == CSGM_OK)
        status = csgm_mesh_build(context, field, NULL, &mesh, NULL);
    if (status == CSGM_OK) {
        csgm_mesh_view view = csgm_mesh_get_view(mesh);
        printf("%llu triangles\n", (unsigned long long)view.triangle_count);
        status =
            csgm_mesh_write(context, &view, argc > 1 ? argv[1] : "out.ply", CSGM_FORMAT_AUTO, NULL);
    }
    csgm_mesh_destroy(mesh);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
    return status == CSGM_OK ? 0 : 1;
}
