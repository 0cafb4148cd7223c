/* SPDX-License-Identifier: MIT
 * Scene -> field -> mesh as `mesh` and `info` both do it, with the time each step took.
 */
#ifndef CLI_WORK_H
#define CLI_WORK_H

#include "core/cli.h"
#include "csgmesh/figures.h"

typedef struct cli_work {
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh *mesh;
    csgm_scene_info info;
    csgm_mesh_stats stats;
    csgm_mesh *level_meshes[CSGM_DETAILS_MOST]; /* of --lod */
    csgm_level levels[CSGM_DETAILS_MOST];
    size_t level_count;
    bool is_leveled; /* they are made */
    double compile_s;
    bool drops_looks;            /* the mesh is for a format that has none */
    const csgm_normals *normals; /* instead of those that the outputs want, NULL: none */
    double
        within; /* > 0: the tolerance of cells that follow the shape, instead of their quality's */
} cli_work;

/* Usage faults of -r, -s and --bounds. CLI_DONE or CLI_TROUBLE. */
int cli_work_check(cli_app *app);
/* The tolerance that a loaded scene's mesh would have of its quality; 0: its cells do not follow
 * the shape, or something else says how fine they are. */
double cli_work_tolerance(const cli_app *app, const cli_work *work, csgm_quality quality);
/* Each returns an exit status; failures are reported. */
int cli_work_load(cli_app *app, cli_work *work, const char *path);
int cli_work_mesh(cli_app *app, cli_work *work);
/* The coarser levels of --lod, and the write options' part that names them. A level that is not
 * coarser than the one before ends them. */
int cli_work_mesh_levels(cli_app *app, cli_work *work, csgm_write_options *write_options);
/* Straight into a file, without the whole mesh in memory where the format allows it; work->mesh
 * stays NULL. counts: vertices, triangles. figures: NULL, they are not wanted. A mesh without
 * triangles writes nothing and is an error.
 */
int cli_work_mesh_file(cli_app *app, cli_work *work, const char *path, csgm_format format,
                       const csgm_write_options *write_options, uint64_t counts[2],
                       csgm_mesh_figures *figures);
void cli_work_release(cli_work *work);

#endif
