/* SPDX-License-Identifier: MIT
 * Built-in modules: the table, their arguments by the table of parameters, and the steps by which
 * handlers look at them.
 */
#ifndef CSG_LANG_MODULES_H
#define CSG_LANG_MODULES_H

#include "lang/functions/functions.h"

enum { CSG_MOST_PARAMETERS = 12 };

typedef struct csg_parameter_row {
    const char *name;
    const char *range; /* in words, "" = any */
    const char *doc;
    int module;
    bool positional;
} csg_parameter_row;

/* One call of a built-in module, its arguments in the order of its parameters. */
typedef struct csg_module_call {
    csg_eval *e;
    const char *name;
    const csg_statement *statement;
    csg_frame *frame;
    const csg_parameter_row *parameters;
    uint32_t parameter_count;
    csg_value values[CSG_MOST_PARAMETERS]; /* UNDEF when not given */
    csg_span spans[CSG_MOST_PARAMETERS];
    bool failed; /* an argument was reported: make the empty solid */
} csg_module_call;

/* A handler returns its node; NONE when it has put its parts on the stack itself. */
typedef csg_node_id csg_module_handler(csg_module_call *call);

/* Control flow looks at its arguments itself. False: it leaves no part of its own. */
typedef bool csg_control_handler(csg_eval *e, const csg_statement *statement, csg_frame *frame);

#define CSG_MODULE(name, handler, children, doc) csg_module_handler csg_module_##handler;
#define CSG_CONTROL(name, handler, children, doc) csg_control_handler csg_control_##handler;
#include "lang/modules/modules.def"

void csg_modules_intern(csg_symbols *symbols, bool *ok);
/* Runs the module of this row: its parts go on the stack, several only where they may spread. */
void csg_modules_run(csg_eval *e, int row, const csg_statement *statement, csg_frame *frame,
                     bool spread);
/* For functions that take the parameters of a module (but the first `skipped`): fills in what
 * csg_argument_* look at; e, name and a statement with the place are set. The values stay the
 * function's. */
void csg_module_call_of_function(csg_module_call *call, const csg_function_call *from,
                                 const char *module, uint32_t skipped);
/* Tells of parts that are only operands (scene/tree/parts.h); CSGM_ERR_MEMORY is reported. */
csgm_status csg_warn_lost_parts(csg_eval *e, const csgm_scene *scene);
/* Reports blends that swell, fill gaps or join nothing. CSGM_OK or CSGM_ERR_MEMORY (reported). */
csgm_status csg_warn_joints(csg_eval *e, const csgm_scene *scene);

/* ---- arguments: index = position in modules.def --------------------------------------------- */

typedef enum csg_range_kind {
    CSG_ANY,
    CSG_POSITIVE,
    CSG_NOT_NEGATIVE,
    CSG_SIZE,         /* above 0, else the solid has nothing inside: only a warning, */
    CSG_SIZE_OR_POINT /* as real files compute sizes that OpenSCAD takes in silence */
} csg_range_kind;

bool csg_has_argument(const csg_module_call *call, uint32_t index);
/* The number given, or `otherwise`; reports what is no number or out of range. */
double csg_argument_number(csg_module_call *call, uint32_t index, double otherwise,
                           csg_range_kind range);
/* The radius of rounded edges, at most half the smallest edge. */
double csg_argument_rounding(csg_module_call *call, uint32_t index, double smallest_edge);
bool csg_argument_boolean(const csg_module_call *call, uint32_t index);
/* [x, y, z] or [x, y] (z = otherwise.z); a single number stands for all three when `spread`. */
csg_vec3 csg_argument_vector(csg_module_call *call, uint32_t index, csg_vec3 otherwise,
                             bool spread);
csg_blend csg_argument_blend(csg_module_call *call, uint32_t index);
/* The same for a value of kind RULE. */
csg_blend csg_rule_blend(csg_module_call *call, uint32_t index);
/* Reports that an argument is out of its range or of the wrong kind: the call makes nothing (a
 * transform leaves its children as they are), which is said where the text is lenient. */
void csg_argument_error(csg_module_call *call, uint32_t index, csg_diag_code code,
                        const char *format, ...) __attribute__((format(printf, 4, 5)));
/* The same where the call can go on in another way, `instead`: "the default is taken". True in a
 * lenient text: go on so. */
bool csg_argument_mishap(csg_module_call *call, uint32_t index, csg_diag_code code,
                         const char *instead, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
/* The children, united. */
csg_node_id csg_module_children(csg_module_call *call);

/* CSS and SVG names, #rgb, #rgba, #rrggbb, #rrggbbaa. */
bool csg_color_parse(const char *text, size_t length, csg_color *out);

#endif
