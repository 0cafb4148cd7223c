/* SPDX-License-Identifier: MIT
 *
 * The figures of a mesh while it goes into its file. The conventions are those of csgmesh.h.
 */
#ifndef CSGMESH_FIGURES_H
#define CSGMESH_FIGURES_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What csgm_mesh_build_file_figures finds out. */
typedef struct csgm_mesh_figures {
    uint32_t struct_size; /* set by csgm_mesh_figures_default; do not touch */
    /* Whether `check` has something to say: what csgm_mesh_inspect finds of the same mesh in
     * memory. False for a mesh that is not a closed oriented 2-manifold, or for whose figures there
     * was no memory. */
    bool is_checked;
    csgm_mesh_check check;
    double max_abs_field; /* as csgm_mesh_max_abs_field, at other vertices; NaN: not known */
    uint64_t
        vertices_measured; /* for it: those of single triangles, where the file has no others */
} csgm_mesh_figures;

/* Nothing is known yet. */
CSGM_API csgm_mesh_figures csgm_mesh_figures_default(void);

/* csgm_mesh_build_file, and the figures of what goes into the file, in the memory of the border of
 * what has been made and not of the mesh, even where the file is written of a mesh in memory, if
 * its cells are equal; of other meshes, csgm_mesh_inspect's. Each vertex is looked at: a mesh is a
 * closed oriented 2-manifold exactly if the triangles around each are one fan. Sums are exact, so
 * they have the same digits for any number of threads. scene: of the field. *figures is written on
 * CSGM_OK. With ranks (csgmesh/ranks.h): CSGM_ERR_ARGUMENT. */
CSGM_API csgm_status csgm_mesh_build_file_figures(csgm_context *context, const csgm_scene *scene,
                                                  const csgm_field *field,
                                                  const csgm_mesh_options *options,
                                                  const char *path, csgm_format format,
                                                  const csgm_write_options *write_options,
                                                  uint64_t counts[2], csgm_mesh_stats *stats,
                                                  csgm_mesh_figures *figures);

#ifdef __cplusplus
}
#endif

#endif
