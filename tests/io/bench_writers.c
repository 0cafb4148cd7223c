/* SPDX-License-Identifier: MIT
 * Seconds to write and read about a million triangles with normals: our files and OpenMesh's.
 * Prints the best of three; the numbers are kept in src/io/README.md. Not a test.
 */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#ifdef HAVE_OPENMESH
#include "openmesh.h"
#endif

enum { COLUMNS = 1000, ROWS = 501, ROUNDS = 3 }; /* 1 000 000 triangles */

typedef struct kind {
    const char *name;
    bool ascii, draco;
} kind;

static const kind kinds[] = {{"a.ply", false, false}, {"t.ply", true, false},
                             {"a.stl", false, false}, {"t.stl", true, false},
                             {"a.obj", false, false}, {"a.off", false, false},
                             {"a.glb", false, false}, {"a.gltf", false, false},
                             {"d.glb", false, true},  {"a.drc", false, true}};

static char folder[128], path[256];

static double ours(io_context *io, const csgm_mesh_view *view, const kind *k, bool reading)
{
    double best = 1e9;
    csgm_write_options options = csg_write_options_default();
    options.ascii = k->ascii;
    options.draco = k->draco;
    for (int i = 0; i < ROUNDS; i++) {
        double start = csg_clock_now_s();
        csgm_mesh *mesh = NULL;
        csgm_status status =
            reading ? csg_io_read(&io->context, path, CSGM_FORMAT_AUTO, &mesh)
                    : csg_io_write(&io->context, view, path, CSGM_FORMAT_AUTO, &options);
        double took = csg_clock_now_s() - start;
        csg_mesh_destroy(mesh);
        if (status)
            return -1;
        best = took < best ? took : best;
    }
    return best;
}

#ifdef HAVE_OPENMESH
static double theirs(const openmesh_mesh *mesh, const kind *k, bool reading)
{
    double best = 1e9;
    for (int i = 0; i < ROUNDS; i++) {
        double start = csg_clock_now_s();
        openmesh_mesh *back = reading ? openmesh_read(path) : NULL;
        bool fine = reading ? back != NULL
                            : openmesh_write(mesh, path, !k->ascii && !strstr(k->name, ".off"));
        double took = csg_clock_now_s() - start;
        openmesh_destroy(back);
        if (!fine)
            return -1;
        best = took < best ? took : best;
    }
    return best;
}
#endif

int main(void)
{
    io_context io;
    io_context_init(&io, 0);
    csgm_mesh *mesh = io_sphere_make(&io.context, COLUMNS, ROWS);
    csgm_mesh_view view = csg_mesh_view(mesh);
    view.colors = NULL; /* OpenMesh is given none */
    io_folder_make(folder, sizeof folder);
    printf("%llu triangles, %llu vertices; seconds, best of %d\n",
           (unsigned long long)view.triangle_count, (unsigned long long)view.vertex_count, ROUNDS);
#ifdef HAVE_OPENMESH
    uint32_t refused;
    double start = csg_clock_now_s();
    openmesh_mesh *other = openmesh_build(view.positions, view.normals, (uint32_t)view.vertex_count,
                                          view.indices, (uint32_t)view.triangle_count, &refused);
    printf("OpenMesh takes %.2f s to build its half-edges\n", csg_clock_now_s() - start);
#endif
    printf("%-8s %8s %8s  %8s %8s\n", "", "write", "read", "OM write", "OM read");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, kinds[i].name);
        double write = ours(&io, &view, &kinds[i], false), read = ours(&io, &view, &kinds[i], true);
        printf("%-8s %8.3f %8.3f", kinds[i].name, write, read);
#ifdef HAVE_OPENMESH
        if (!strstr(kinds[i].name, ".gl") && !strstr(kinds[i].name, ".drc"))
            printf("  %8.3f %8.3f", theirs(other, &kinds[i], false),
                   theirs(other, &kinds[i], true));
#endif
        printf("\n");
    }
#ifdef HAVE_OPENMESH
    openmesh_destroy(other);
#endif
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    return 0;
}
