/* SPDX-License-Identifier: MIT
 * What a mesh is made of: a field, the box it is meshed in, and the lattice of it.
 */
#ifndef CSG_MESH_PIPELINE_INPUT_H
#define CSG_MESH_PIPELINE_INPUT_H

#include "field/field.h"
#include "grid/octree/lattice.h"
#include "mesh/watch.h"

/* What the parts of one mesh have in common, and where in the whole one of them stands. */
typedef struct csg_mesh_share {
    const char *name; /* NULL = the part without a name */
    bool colors, materials;
    bool is_operand; /* not a part, but an operand of one: it may be nothing */
    csg_vec3 origin;
    double started_s;      /* for the time limit */
    double before, amount; /* of the work: fractions */
} csg_mesh_share;

/* Cells along the longest side of a lattice of equal cells, where nothing says how many: to
 * certify. */
enum { CSG_MESH_DEFAULT_CELLS = 128 };

typedef struct csg_mesh_input {
    csgm_context *context;
    const csgm_mesh_options *options;
    const csg_mesh_share *share; /* NULL = the mesh has one part */
    const csgm_field *field; /* as it is meshed: cut by the bounds where it reaches out of them */
    csgm_field *clipped;     /* owned: that field, NULL when the bounds cut nothing */
    csg_box bounds;          /* empty: there is nothing to mesh, and no lattice */
    csg_lattice lattice;
} csg_mesh_input;

/* Chooses bounds and lattice; context, options, share and field are set. Reports what fails. */
csgm_status csg_mesh_input_complete(csg_mesh_input *input);
void csg_mesh_input_release(csg_mesh_input *input);

/* Where the floats of a mesh in these bounds have their zero. */
csg_vec3 csg_mesh_origin(csg_vec3 center, csg_box bounds);
static inline csg_vec3 csg_mesh_origin_of(const csg_mesh_input *input)
{
    return input->share ? input->share->origin
                        : csg_mesh_origin(input->field->center, input->bounds);
}

static inline bool csg_mesh_is_colored(const csgm_field *field)
{
    return field->has_colors && field->color_count > 1;
}

/* Whether the mesh gets them: as all parts have it, if there are several. */
static inline bool csg_mesh_gets_colors(const csg_mesh_input *input)
{
    const csg_mesh_share *share = input->share;
    return input->options->colors && (share ? share->colors : csg_mesh_is_colored(input->field));
}
static inline bool csg_mesh_gets_materials(const csg_mesh_input *input)
{
    const csg_mesh_share *share = input->share;
    return input->options->colors && (share ? share->materials : input->field->has_materials);
}

/* csg_mesh_watch_begin for this input. started_s: of all tries, 0: now; where the mesh has parts,
 * theirs counts. */
void csg_mesh_input_watch(const csg_mesh_input *input, double started_s, csg_mesh_watch *watch);

/* How fine a mesh is, as messages say it. */
typedef struct csg_mesh_fineness {
    const char *of;       /* "cells" */
    double size;          /* of them */
    const char *hints[2]; /* for what may be thinner than that: a whole mesh, a part */
} csg_mesh_fineness;

/* Warns of a mesh without triangles, or of one that the bounds have cut. */
void csg_mesh_warn_of_result(const csg_mesh_input *input, const csg_mesh_fineness *fineness,
                             bool is_empty, bool is_cut);

#endif
