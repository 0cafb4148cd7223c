/* SPDX-License-Identifier: MIT
 * A scene's formula, step by step; see vm.h.
 */
#include "base/scene_codes.h"
#include "scene/formula/vm.h"

#include <stdio.h>
#include <string.h>

#include "scene/formula/formula.h"
#include "scene/formula/formula_print.h"
#include "scene/formula/formulate.h"
#include "shape/polyhedra/polyhedron.h"

#define DEGREE 0.017453292519943295

typedef struct tape {
    csgm_text_fn *sink;
    void *user;
    const csg_formula_step *steps;
    uint32_t *lines; /* per step: where its value stands */
    uint32_t count;  /* lines so far */
    uint32_t degree, radian, zero;
} tape;

enum { NOWHERE = UINT32_MAX };

static const struct {
    const char *name;
    int unit;
} ops[CSG_FORMULA_OP_COUNT] = {
#define CSG_VM_OP(name, arity, OP, unit) [CSG_FORMULA_##OP] = {name, unit},
#include "scene/formula/vm.def"
#undef CSG_VM_OP
};

static void put_text(tape *out, const char *text)
{
    out->sink(out->user, text, strlen(text));
}

static uint32_t put_constant(tape *out, double value)
{
    char text[32];
    snprintf(text, sizeof text, "_%x const ", out->count);
    put_text(out, text);
    csg_print_number(out->sink, out->user, value);
    put_text(out, "\n");
    return out->count++;
}

/* Operands that are NOWHERE are not there. */
static uint32_t put_line(tape *out, const char *op, uint32_t a, uint32_t b)
{
    char text[80];
    int length = snprintf(text, sizeof text, "_%x %s", out->count, op);
    if (a != NOWHERE)
        length += snprintf(text + length, sizeof text - (size_t)length, " _%x", a);
    if (b != NOWHERE)
        snprintf(text + length, sizeof text - (size_t)length, " _%x", b);
    put_text(out, text);
    put_text(out, "\n");
    return out->count++;
}

/* A constant that is written where it is first needed. */
static uint32_t shared(tape *out, uint32_t *line, double value)
{
    if (*line == NOWHERE)
        *line = put_constant(out, value);
    return *line;
}

/* The remainder has the sign of a here; there it is never negative. */
static uint32_t put_mod(tape *out, uint32_t a, uint32_t b)
{
    uint32_t sign = put_line(out, "compare", a, shared(out, &out->zero, 0));
    uint32_t size = put_line(out, "abs", a, NOWHERE);
    uint32_t mod = put_line(out, "mod", size, put_line(out, "abs", b, NOWHERE));
    return put_line(out, "mul", sign, mod);
}

static uint32_t put_step(tape *out, const csg_formula_step *step)
{
    uint32_t arity = csg_formula_op_arity(step->op);
    uint32_t a = arity > 0 ? out->lines[step->a] : NOWHERE;
    uint32_t b = arity > 1 ? out->lines[step->b] : NOWHERE;
    if (step->op == CSG_FORMULA_CONSTANT)
        return put_constant(out, step->constant);
    if (step->op == CSG_FORMULA_MOD)
        return put_mod(out, a, b);
    if (step->op == CSG_FORMULA_POW) {
        a = put_line(out, "ln", a, NOWHERE);
        return put_line(out, "exp", put_line(out, "mul", a, b), NOWHERE);
    }
    if (step->op == CSG_FORMULA_MUL && a == b)
        return put_line(out, "square", a, NOWHERE);
    if (ops[step->op].unit == 1)
        a = put_line(out, "mul", a, shared(out, &out->degree, DEGREE));
    uint32_t line = put_line(out, ops[step->op].name, a, b);
    return ops[step->op].unit == 2
               ? put_line(out, "mul", line, shared(out, &out->radian, 1 / DEGREE))
               : line;
}

static csgm_status print_steps(const csg_terms *terms, csg_term result, csgm_text_fn *sink,
                               void *user)
{
    size_t step_bytes = terms->count * sizeof(csg_formula_step);
    size_t line_bytes = terms->count * sizeof(uint32_t);
    csg_formula_step *steps = csg_memory_alloc(terms->memory, step_bytes);
    uint32_t *lines = csg_memory_alloc(terms->memory, line_bytes);
    uint32_t count = steps && lines ? csg_formula_collect(terms, result, steps) : 0;
    tape out = {sink, user, steps, lines, 0, NOWHERE, NOWHERE, NOWHERE};
    for (uint32_t i = 0; i < count; i++)
        lines[i] = put_step(&out, &steps[i]);
    if (count)
        put_line(&out, "neg", lines[count - 1], NOWHERE);
    csg_memory_release(terms->memory, steps, step_bytes);
    csg_memory_release(terms->memory, lines, line_bytes);
    return count ? CSGM_OK : CSGM_ERR_MEMORY;
}

static csgm_status report(const csgm_scene *scene, csgm_status status, csg_node_id obstacle,
                          size_t most)
{
    csg_diag_sink *diags = &scene->context->diags;
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(scene->context);
    if (status == CSGM_ERR_LIMIT)
        csg_diag_plain(diags, CSG_DIAG_NO_TAPE, NULL, NULL,
                       "the scene's tape would have more than %zu lines", most);
    if (status == CSGM_ERR_UNSUPPORTED && scene->nodes[obstacle].kind != CSG_NODE_SHAPE)
        csg_diag_plain(
            diags, CSG_DIAG_NO_TAPE, NULL, NULL,
            "no tape can hold soft solids, fillets, nor blends by fields or smooth steps");
    else if (status == CSGM_ERR_UNSUPPORTED)
        csg_diag_plain(
            diags, CSG_DIAG_NO_TAPE, NULL,
            "polyhedra, imported meshes, heights and hulls can be written where they "
            "are convex",
            "no tape can hold a solid of %zu triangles that is not convex",
            csg_polyhedron_triangles(scene->shapes[scene->nodes[obstacle].payload])->count);
    return status;
}

csgm_status csg_vm_print(const csgm_scene *scene, csgm_text_fn *sink, void *user)
{
    static const size_t MOST = 1u << 23;
    csg_terms terms;
    csg_term result;
    csg_node_id obstacle = 0;
    csg_formula_begin(&terms, &scene->context->memory);
    terms.most = MOST;
    csgm_status status = csg_formulate(scene, &terms, &result, &obstacle);
    if (status == CSGM_OK)
        status = print_steps(&terms, result, sink, user);
    csg_formula_end(&terms);
    return status == CSGM_OK ? status : report(scene, status, obstacle, MOST);
}
