/* SPDX-License-Identifier: MIT
 * What the files of the compiler share; see compile.c.
 */
#ifndef CSG_FIELD_COMPILE_PRIVATE_H
#define CSG_FIELD_COMPILE_PRIVATE_H

#include "field/compile/compile_leaf.h"
#include "field/compile/compile_rule.h"
#include "field/field.h"
#include "scene/operators/soft.h"

/* What a node inherits from its ancestors. */
typedef struct csg_compile_frame {
    csg_affine place; /* own frame -> scene, or -> the frame below the warp */
    double factor;    /* product of the ancestors' smallest singular values and warps' scales */
    double raise;     /* what offsets above add to the value with its sign */
    uint32_t warp;    /* index + 1, 0 = none */
    double magnitude; /* of the lengths in the warps' arithmetic */
    bool negate;
    csg_form form;     /* what the operator above takes */
    bool is_raised;    /* an offset stands between, so it is no field that comes up */
    csg_operand entry; /* how it becomes one then */
    double entry_factor;
    bool colored, shaded;      /* by a colour, by a material from further out */
    csg_color paint, material; /* what `color` is the number of */
    uint32_t color;
} csg_compile_frame;

/* An operator (or a wrapper on the way to one) whose children are being written. */
typedef struct csg_compile_task {
    csg_node_id node;
    uint32_t next_child;
    csg_compile_frame frame;
    /* The operator that the children join: this one, or an ancestor of the same sharp kind. */
    uint32_t group;   /* index of its task */
    uint32_t written; /* of a group: children in the tape so far */
    uint32_t begin;   /* of a group: first node */
    uint32_t parameters;
    bool is_union;
    bool combines; /* by a formula */
    bool softens;
    csg_tape_curve curve; /* where it softens */
    csg_blend blend;
} csg_compile_task;

typedef struct csg_compiler {
    csgm_context *context;
    const csgm_scene *scene;
    csgm_field *field;
    csg_tape_node *nodes;
    float *parameters;
    double *exact;                 /* as many, where they are asked for; else NULL */
    csg_color *colors, *materials; /* as many of both */
    csg_compile_task *tasks;
    csg_tape_step *steps;
    csg_tape_formula *formulas;
    csg_tape_warp *warps;
    size_t warp_count, warp_capacity;
    size_t step_count, step_capacity, formula_count, formula_capacity;
    size_t node_count, node_capacity, parameter_count, parameter_capacity, color_count,
        color_capacity, exact_count, material_capacity, task_count, task_capacity;
} csg_compiler;

/* Where a node's own frame lies, relative to the field's centre or in the frame below the warp. */
csg_affine csg_compile_place(const csg_compiler *c, const csg_compile_frame *f);
bool csg_compile_leaf(csg_compiler *c, const csg_leaf *l, uint32_t color, uint32_t warp);
bool csg_compile_push(csg_compiler *c, const float *values, size_t count, uint32_t *at);
/* The parameters of a fillet: those of an operator, and behind them how far each operand reaches
 * beyond each of its planes. */
bool csg_compile_fillet(csg_compiler *c, csg_compile_task *t);
/* Where those of the operand are that is written next. */
uint32_t csg_compile_reaches(const csg_compiler *c, const csg_compile_task *t);
/* Behind the operands of a fillet: the planes at which it ends; *count of them. */
bool csg_compile_planes(csg_compiler *c, const csg_compile_task *t, uint32_t *count);
/* Copies all that was written into the field. False: no memory. */
bool csg_compile_keep(const csg_compiler *c);
/* Sets `waver` of a whole tape, and `turns` where it has a fillet. False: no memory. */
bool csg_compile_waver(csg_memory *memory, csg_tape *tape);

#endif
