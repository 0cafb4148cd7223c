/* SPDX-License-Identifier: MIT
 * The figures of a mesh while it goes by: a receiver (run.h) that looks at every run and hands it
 * on. What csg_mesh_inspect finds of a mesh in memory is found of one that never is, if it is what
 * it should be: a closed oriented 2-manifold, which is proven vertex by vertex (link.h).
 *
 * A run is looked at by itself, by the thread that made it: links, pieces (sets of vertices that
 * hang together), sums. What it has in common with others goes to the seam. Sums are exact
 * (measures.h), so figures do not depend on threads, nor on where runs begin and end.
 *
 * Of a mesh with a border, with an edge used more than twice or with several fans at a vertex
 * nothing is said but that: it is to be inspected as a whole.
 */
#ifndef CSG_MESH_FIGURES_FIGURES_H
#define CSG_MESH_FIGURES_FIGURES_H

#include "base/context.h"
#include "mesh/run.h"

typedef struct csg_mesh_figures csg_mesh_figures;

/* What hands runs on to `to`, which is copied. workers: run.worker stays below. False: out of
 * memory, not reported. Memory that runs out later ends the figures and nothing else. */
bool csg_mesh_figures_make(csgm_context *context, const csg_mesh_receiver *to, uint32_t workers,
                           csg_mesh_figures **out);
csg_mesh_receiver csg_mesh_figures_receiver(csg_mesh_figures *figures);
/* Once all runs have come. False, and *out is as it was: it is no closed manifold, there are
 * vertices (but copies) that no triangle uses, or memory ran out. */
bool csg_mesh_figures_get(csg_mesh_figures *figures, csgm_mesh_check *out);
void csg_mesh_figures_destroy(csg_mesh_figures *figures);

#endif
