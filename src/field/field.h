/* SPDX-License-Identifier: MIT
 * From scenes to tapes, and values of tapes: the door of this layer.
 */
#ifndef CSG_FIELD_FIELD_H
#define CSG_FIELD_FIELD_H

#include "field/tape.h"

extern const csg_color csg_default_color;
/* Metallic in r, roughness in g. */
extern const csg_color csg_default_material;

/* The scene must outlive the field. */
csgm_status csg_field_compile(csgm_context *context, const csgm_scene *scene, csgm_field **out);
void csg_field_destroy(csgm_field *field);
/* Of the floats of a field with these bounds. */
csg_vec3 csg_field_center(csg_box bounds);
/* An empty one; NULL: no memory. */
csgm_field *csg_field_create(csgm_context *context);

/* For a scene with named parts: a field for each in field->parts, which the field owns. */
csgm_status csg_field_compile_parts(csgm_field *field);
void csg_field_release_parts(csgm_field *field);

/* The same scene met with a finite box (scene units) and compiled around the box's centre, so that
 * floats are fine there however far away the scene's own centre is. */
csgm_status csg_field_clip(csgm_context *context, const csgm_field *field, csg_box box,
                           csgm_field **out);

/* What the scene says of a compiled field's parameters, in the arena; nothing, of what was clipped.
 * False: no memory. */
bool csg_field_exact(csgm_context *context, const csgm_field *field, csg_arena *arena,
                     csg_tape_exact *out);

/* The scene's counts of nodes and its steepest leaf, into the field. */
void csg_field_count(const csgm_scene *scene, csgm_field *field);

/* count values at points in scene units; arrays must not overlap. */
void csg_field_eval(const csgm_field *field, const float *x, const float *y, const float *z,
                    float *out, size_t count);

/* Stable text, one node per line. */
csgm_status csg_field_print_tape(const csgm_field *field, csgm_text_fn *sink, void *user);

#endif
