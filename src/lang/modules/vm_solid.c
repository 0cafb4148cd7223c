/* SPDX-License-Identifier: MIT
 * import() of .vm tapes: a formula from a file becomes a field.
 */
#include "base/scene_codes.h"
#include "lang/modules/formula_call.h"
#include "lang/modules/imports.h"
#include "outline/input.h"
#include "scene/formula/formula.h"
#include "scene/formula/vm.h"

/* The tape's steps, from the heap's memory: *bytes; NULL after a report. */
static csg_formula_step *read_tape(csg_module_call *call, const char *path, uint32_t file,
                                   uint32_t *count, size_t *bytes)
{
    csg_memory *memory = call->e->heap.memory;
    csg_problem problem = {""};
    csg_vm_problem wrong = {0, ""};
    csg_bytes text;
    csg_terms terms;
    csg_term result;
    csg_formula_step *steps = NULL;
    csgm_status status = csg_bytes_read(memory, path, &text, &problem);
    csg_formula_begin(&terms, memory);
    if (status == CSGM_OK) {
        status = csg_vm_read(&terms, text.data, text.size, &result, &wrong);
        csg_bytes_release(&text);
    }
    *bytes = terms.count * sizeof *steps;
    if (status == CSGM_OK) {
        steps = csg_memory_alloc(memory, *bytes);
        *count = steps ? csg_formula_collect(&terms, result, steps) : 0;
        status = *count ? CSGM_OK : CSGM_ERR_MEMORY;
    }
    csg_formula_end(&terms);
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(call->e);
    else if (status != CSGM_OK && wrong.line)
        csg_argument_error(call, file, CSG_DIAG_BAD_IMPORT, "'%.120s', line %zu: %s", path,
                           wrong.line, wrong.text);
    else if (status != CSGM_OK)
        csg_argument_error(call, file, CSG_DIAG_BAD_IMPORT, "'%.120s': %s", path,
                           wrong.text[0] ? wrong.text : problem.text);
    return steps;
}

csg_node_id csg_import_tape(csg_module_call *call, const char *path, uint32_t file, uint32_t bounds,
                            uint32_t lipschitz)
{
    csg_eval *e = call->e;
    const csg_field_domain domain = {.bounds = csg_argument_box(call, bounds),
                                     .cut = csg_has_argument(call, bounds),
                                     .lipschitz =
                                         csg_argument_number(call, lipschitz, 0, CSG_POSITIVE)};
    csg_node_id node = CSG_NODE_NONE;
    uint32_t count = 0;
    size_t bytes = 0;
    csg_formula_step *steps = call->failed ? NULL : read_tape(call, path, file, &count, &bytes);
    if (steps && count)
        node = csg_build_field(&e->builder, steps, count, &domain, call->statement->where);
    csg_memory_release(e->heap.memory, steps, bytes);
    if (e->stop)
        return CSG_NODE_NONE;
    return call->failed ? csg_shape_empty(call) : csg_shape_done(call, node);
}
