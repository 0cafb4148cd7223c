/* SPDX-License-Identifier: MIT
 * Dumps of the public interface: the evaluated tree, the tape or the formula
 * as stable text, what meshes are made from as a mesh.
 */
#include "field/field.h"
#include "mesh/pipeline/survey.h"
#include "scene/formula/vm.h"
#include "scene/tree/print.h"
#include "scene/tree/print_openscad.h"

static csgm_status dump_tape(csgm_context *context, const csgm_scene *scene, csgm_text_fn *sink,
                             void *user)
{
    csgm_field *field = NULL;
    csgm_status status = csg_field_compile(context, scene, &field);
    if (status == CSGM_OK)
        status = csg_field_print_tape(field, sink, user);
    csg_field_destroy(field);
    return status;
}

csgm_status csgm_scene_dump(csgm_context *context, const csgm_scene *scene, csgm_dump what,
                            csgm_text_fn *sink, void *user)
{
    if (!context || !scene || !sink)
        return CSGM_ERR_ARGUMENT;
    switch (what) {
    case CSGM_DUMP_SCENE:
        return csg_scene_print(scene, sink, user);
    case CSGM_DUMP_TAPE:
        return dump_tape(context, scene, sink, user);
    case CSGM_DUMP_VM:
        return csg_vm_print(scene, sink, user);
    case CSGM_DUMP_OPENSCAD:
        return csg_scene_print_openscad(scene, sink, user);
    }
    return CSGM_ERR_ARGUMENT;
}

csgm_status csgm_survey_begin(csgm_context *context)
{
    if (!context || context->survey)
        return CSGM_ERR_ARGUMENT;
    context->survey = csg_survey_create(context);
    return context->survey ? CSGM_OK : CSGM_ERR_MEMORY;
}

csgm_status csgm_survey_end(csgm_context *context, csgm_mesh **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !context->survey)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_survey_mesh(context->survey, out);
    csg_survey_destroy(context->survey);
    context->survey = NULL;
    return status;
}
