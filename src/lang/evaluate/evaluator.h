/* SPDX-License-Identifier: MIT
 * The evaluator's state and what its parts share. Expressions become values, statements become
 * scene nodes.
 *
 * Failing: what cannot go on (memory, a limit, a failed assertion) sets `stop`; everything then
 * returns at once, and what it had counted references to goes with the heap. A mistake of the scene
 * is reported (once per place) and evaluation goes on with undef or the empty solid.
 */
#ifndef CSG_LANG_EVALUATOR_H
#define CSG_LANG_EVALUATOR_H

#include <assert.h>

#include "lang/evaluate/value.h"
#include "scene/tree/build.h"

/* A solid that waits to be joined with its neighbours. */
typedef struct csg_eval_part {
    csg_node_id node;
    bool wrapped;    /* in blend(b): joins with `blend`, whatever its operator says */
    bool is_region;  /* in blend_within(): no operand, but where its operator blends */
    csg_blend blend; /* of a region: how the blend ends there */
    csg_span where;  /* of the wrapper */
} csg_eval_part;

typedef struct csg_dynamic { /* a binding of a $variable */
    csg_symbol name;
    uint32_t hidden; /* index + 1 of the binding of the same name below */
    csg_value value;
} csg_dynamic;

typedef struct csg_trace_entry {
    csg_symbol name; /* 0 = a function literal */
    bool module;
    csg_span where; /* of the call */
} csg_trace_entry;

enum { CSG_TWISTER_WORDS = 624 };

typedef struct csg_twister { /* of rands() */
    uint32_t words[CSG_TWISTER_WORDS];
    uint32_t next; /* word, CSG_TWISTER_WORDS = twist first */
} csg_twister;

/* A list under construction. */
typedef struct csg_list {
    csg_value *items;
    size_t count, capacity;
} csg_list;

/* What a modifier stands before. */
typedef struct csg_mark {
    csg_node_id node;
    csgm_mark kind;
} csg_mark;

/* Where a use of a name has found its variable (names.c). */
typedef struct csg_variable_slot {
    const void *owner;    /* the names or the scope of that frame; NULL: not known */
    uint32_t hops, place; /* so many frames outwards; the position in it */
} csg_variable_slot;

/* Where a call has found its function or module; no definition: it is a builtin, or unknown. */
typedef struct csg_call_slot {
    const csg_definition *definition;
    const csg_program_file *file; /* a used file whose frame is its home, or */
    const csg_scope *scope;       /* that of the frame which is, so many frames outwards */
    uint32_t hops;
    bool is_known;
} csg_call_slot;

typedef struct csg_called {
    const csg_definition *definition;
    csg_frame *home; /* borrowed */
} csg_called;

typedef struct csg_eval {
    csg_program *program;
    csgm_context *context;
    csg_heap heap;
    csg_scene_builder builder;
    csg_formula_builder *formula; /* while field() evaluates its function, else NULL */
    bool refused;                 /* it did what no formula can, and was told so */
    bool stop;
    csgm_status status; /* why stopped; SCENE after a reported mistake */
    uint32_t depth;
    uint32_t asking; /* modules in progress that ask for more of their children than a sketch */
    uint64_t steps, clock_steps; /* done so far, and when the clock was last looked at */
    uint64_t next_look;          /* steps at which clock and limit are looked at again */

    csg_dynamic *dynamics;
    size_t dynamic_count, dynamic_capacity;
    uint32_t *dynamic_heads; /* per symbol: index + 1 of its innermost binding */
    size_t dynamic_head_count;

    csg_trace_entry *trace; /* calls in progress, outermost first */
    size_t trace_count, trace_capacity;

    csg_eval_part *parts; /* a stack */
    size_t part_count, part_capacity;

    csg_variable_slot *variable_slots; /* of csg_program.slot_count each */
    csg_call_slot *call_slots;
    csg_frame **file_frames; /* per file, NULL until asked for */
    uint64_t *reported;      /* places already told about: an open-addressing set */
    size_t reported_count, reported_slots;

    csg_list spare_list; /* room for the next list */

    csg_twister *twister; /* two: of calls without a seed, and with; NULL before the first call */

    struct csg_fonts *fonts; /* of text(); NULL before the first one */

    csg_mark *marks; /* a stack (marks.h) */
    size_t mark_count, mark_capacity;

    struct csg_drawing *drawing; /* of a flat scene, where one is asked for; owned */

    csg_node_id root; /* what a ! modifier chose, or NONE */
    csg_node_id
        marked[CSGM_MARK_COUNT]; /* after the run, or once there is a root: each mark's solid */
    csg_symbol symbol_pi, symbol_children_count, symbol_parent_modules, symbol_fn, symbol_fa,
        symbol_fs, symbol_round, symbol_x, symbol_y, symbol_z, symbol_begin, symbol_step,
        symbol_end, symbol_blend, symbol_n, symbol_r, symbol_children, symbol_w;
} csg_eval;

csgm_status csg_eval_init(csg_eval *e, csg_program *program);
void csg_eval_reset(csg_eval *e);
/* Evaluates the program's scene; the root of the result, or NONE when status is not OK. */
csg_node_id csg_eval_run(csg_eval *e);

/* ---- failing -------------------------------------------------------------------------------- */

/* Reports once per place, with the trace of calls. An error makes the status SCENE. */
void csg_eval_report(csg_eval *e, csg_diag_code code, csg_span where, const char *hint,
                     const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Is it only a warning there, so that what was left out is to be said (text/source.h)? */
/* OpenSCAD's language that holds, as version_num() has it: 20210100 is 2021.01. The default is the
 * newest of which nothing is missing but what is experimental there. */
uint32_t csg_eval_level(const csg_eval *e);
bool csg_eval_is_lenient(const csg_eval *e, csg_diag_code code, csg_span where);
/* What a finding about an argument ends in: ", this is ignored" there where it is only a warning.
 */
const char *csg_eval_ignores(const csg_eval *e, csg_diag_code code, csg_span where);
/* The trace of calls, innermost first, as notes; what repeats itself is counted (call_trace.c). */
void csg_eval_note_calls(const csg_eval *e);
/* Was this finding reported before at this place? */
bool csg_eval_has_told(const csg_eval *e, csg_diag_code code, csg_span where);
void csg_eval_no_memory(csg_eval *e);
/* Where it was refused since it is time to end, that is said of this place. */
void csg_eval_no_memory_at(csg_eval *e, csg_span where);
void csg_eval_limit(csg_eval *e, csg_diag_code code, csg_span where, const char *hint,
                    const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Looks at the limits of steps and time; false: one is reached. */
bool csg_eval_look_at_limits(csg_eval *e, csg_span where);
/* Counts steps of work; false: the evaluation stops. */
static inline bool csg_eval_charge(csg_eval *e, uint64_t steps, csg_span where)
{
    if (e->stop)
        return false;
    e->steps += steps;
    return e->steps < e->next_look || csg_eval_look_at_limits(e, where);
}
/* Before and after what may take long in one step: reports that the time is up. False: stop. */
bool csg_eval_check_time(csg_eval *e, csg_span where);
/* Into a call or a nesting; false: too deep. Pair with csg_eval_leave when true. */
bool csg_eval_enter(csg_eval *e, csg_span where);
void csg_eval_leave(csg_eval *e);
void csg_eval_stack_ends(csg_eval *e, csg_span where); /* reports, and stops */
/* Is there room on the C stack? */
static inline bool csg_eval_check_stack(csg_eval *e, csg_span where)
{
    char here = 0;
    bool has_room = csg_program_has_stack(e->program, &here);
    if (!has_room)
        csg_eval_stack_ends(e, where);
    return has_room;
}
void csg_eval_push_trace(csg_eval *e, csg_symbol name, bool module, csg_span where);

/* ---- names
 * (names.c) ------------------------------------------------------------------------------------ */

/* False: no memory. */
bool csg_eval_make_slots(csg_eval *e);
const csg_value *csg_eval_search_variable(csg_eval *e, const csg_expression *x,
                                          const csg_frame *frame);
bool csg_eval_would_find(csg_eval *e, const csg_expression *x, const csg_frame *frame,
                         const csg_value *found); /* for assertions */
/* The variable that a NAME is, borrowed; NULL when there is none. */
static inline const csg_value *csg_eval_find_variable(csg_eval *e, const csg_expression *x,
                                                      const csg_frame *frame)
{
    const csg_variable_slot *slot = &e->variable_slots[x->slot];
    if (slot->owner) {
        const csg_frame *at = frame;
        for (uint32_t hops = slot->hops; hops > 0 && at; hops--)
            at = at->parent;
        if (at && (at->names == slot->owner || at->scope == slot->owner) &&
            at->values[slot->place].kind != CSG_VALUE_UNSET) {
            assert(csg_eval_would_find(e, x, frame, &at->values[slot->place]));
            return &at->values[slot->place];
        }
    }
    return csg_eval_search_variable(e, x, frame);
}
/* PI, or UNDEF and a warning that there is none. */
csg_value csg_eval_no_variable(csg_eval *e, const csg_expression *x, csg_frame *frame);
/* A variable of this name, searched for; borrowed, NULL when there is none. */
const csg_value *csg_eval_lookup(csg_eval *e, csg_symbol name, const csg_frame *frame);
/* The value of a $variable, borrowed; UNSET when it has none. */
csg_value csg_eval_dynamic(const csg_eval *e, csg_symbol name);
void csg_eval_push_dynamic(csg_eval *e, csg_symbol name, csg_value value); /* consumed */
void csg_eval_pop_dynamics(csg_eval *e, size_t count);
/* The module or function that a call goes to; slot: that of its name. false = nowhere. */
bool csg_eval_find_called(csg_eval *e, csg_member_kind kind, csg_symbol name, uint32_t slot,
                          csg_frame *frame, csg_called *out);
/* The same, searched for. */
bool csg_eval_find_definition(csg_eval *e, csg_member_kind kind, csg_symbol name, csg_frame *frame,
                              csg_called *out);
/* Evaluates a scope's assignments: a new frame, or `parent` retained when it defines nothing.
 * $variables go to the dynamics: pop them when leaving. NULL: stopped. */
csg_frame *csg_eval_scope(csg_eval *e, const csg_scope *scope, csg_frame *parent);
csg_frame *csg_eval_file_frame(csg_eval *e, const csg_program_file *file);

/* ---- expressions -------------------------------------------------------------------------------
 */

csg_value csg_evaluate(csg_eval *e, const csg_expression *x, csg_frame *frame);
/* The frame of a call: arguments evaluated in `caller`, defaults in `home`; $arguments are pushed
 * to the dynamics. */
csg_frame *csg_eval_bind(csg_eval *e, const csg_arguments *parameters,
                         const csg_arguments *arguments, csg_frame *home, csg_frame *caller,
                         csg_symbol name);
/* The frame of let (...): each assignment sees those before it. */
csg_frame *csg_eval_let(csg_eval *e, const csg_arguments *assignments, csg_frame *frame);
csg_value csg_eval_unary(csg_eval *e, const csg_expression *x, csg_value operand);
csg_value csg_eval_binary(csg_eval *e, const csg_expression *x, csg_value left, csg_value right);
/* Warns that there is no such operation, unless an operand is undef; UNDEF. */
csg_value csg_eval_no_operation(csg_eval *e, const csg_expression *x, csg_value left,
                                csg_value right);
csg_value csg_eval_compare(csg_eval *e, const csg_expression *x, csg_value left, csg_value right);
bool csg_value_equal(csg_eval *e, csg_value left, csg_value right, csg_span where);
/* False also where the values have no order. */
bool csg_value_is_less(csg_eval *e, csg_value left, csg_value right, csg_span where);
csg_value csg_eval_vector(csg_eval *e, const csg_expression *x, csg_frame *frame);
void csg_eval_echo(csg_eval *e, const csg_arguments *arguments, csg_frame *frame);
/* False when the assertion failed (reported, evaluation stopped). */
bool csg_eval_assert(csg_eval *e, const csg_arguments *arguments, csg_frame *frame, csg_span where);
csg_text
csg_eval_text(const csg_eval *e); /* an empty one, no longer than the steps that are left */
/* Pays for a text in steps; false, reported: it is too long, or memory ran out. */
bool csg_eval_text_done(csg_eval *e, const csg_text *text, csg_span where);
csg_value csg_eval_text_value(csg_eval *e, csg_text *text, csg_span where); /* consumes the text */
csg_value csg_eval_string(csg_eval *e, const char *text, size_t length);

/* The elements that `for` sees: of a range, vector or string; undef has none, others are one. */
typedef struct csg_iteration {
    csg_value over; /* borrowed */
    double count, next;
    size_t offset; /* strings */
} csg_iteration;

bool csg_iteration_begin(csg_eval *e, csg_iteration *iteration, csg_value over, csg_span where);
bool csg_iteration_next(csg_eval *e, csg_iteration *iteration, csg_value *out, csg_span where);

/* ---- lists under construction
 * ----------------------------------------------------------------------------------- */

void csg_list_push(csg_eval *e, csg_list *list, csg_value element, csg_span where); /* consumed */
/* Room for `more` elements at once. */
void csg_list_reserve(csg_eval *e, csg_list *list, double more, csg_span where);
csg_value csg_list_finish(csg_eval *e, csg_list *list); /* a vector; the list is released */

/* "did you mean 'x'?" for an unknown module, function or variable (by the code of the finding), or
 * NULL. The buffer belongs to the caller. */
const char *csg_suggest(csg_eval *e, csg_diag_code code, csg_symbol name, csg_frame *frame,
                        csg_span where, char *buffer, size_t size);

/* ---- statements
 * ------------------------------------------------------------------------------------ */

/* Runs the statements of a scope that was entered; parts go on the stack. spread: for, if and
 * children() may leave several parts; else each statement leaves at most one. */
void csg_run_statements(csg_eval *e, const csg_scope *scope, csg_frame *frame, bool spread);
/* Enters the scope, runs it, leaves it. */
void csg_run_scope(csg_eval *e, const csg_scope *scope, csg_frame *frame, bool spread);
void csg_run_statement(csg_eval *e, const csg_statement *statement, csg_frame *frame, bool spread);
void csg_push_part(csg_eval *e, csg_eval_part part);
static inline csg_eval_part csg_part_plain(csg_node_id node)
{
    return (csg_eval_part){.node = node};
}
/* Joins the parts above `first` into one node and takes them off the stack. Of figures and solids
 * the first one's dimension rules, unless they may be mixed. */
csg_node_id csg_join_parts(csg_eval *e, size_t first, csg_node_kind kind, csg_blend blend,
                           csg_span where);
/* How: by a blend, or where `radius` is not NULL round by a radius that varies, a formula of the
 * point (csg_build_varying). */
typedef struct csg_joining {
    csg_blend blend;
    const csg_formula_step *radius;
    uint32_t radius_count;
} csg_joining;
/* The same of parts as they are, figures and solids mixed. */
csg_node_id csg_join_parts_by(csg_eval *e, size_t first, csg_node_kind kind, csg_joining by,
                              csg_span where);
/* Joins them without blend and puts the result on the stack. */
void csg_join_as_part(csg_eval *e, size_t first, csg_span where);
/* Of the parts above `first`, takes those of the other dimension off; how many. Empty solids go
 * with either. */
size_t csg_parts_drop_unlike(csg_eval *e, size_t first, bool flat);
/* The same by the first part's dimension; warns of the others. */
void csg_parts_keep_alike(csg_eval *e, size_t first, csg_span where);
/* Takes off the regions of blend_within() above `first`, which `name` has no use for, and warns. */
void csg_parts_drop_regions(csg_eval *e, size_t first, const char *name);
/* At the end of a scene (flat_scene.c): where only a drawing is asked for, solids beside figures
 * are left out, told; */
void csg_eval_keep_drawn(csg_eval *e, csg_span where);
/* a flat scene is drawn and becomes a plate, as csgm_flat says. */
csg_node_id csg_eval_finish_flat(csg_eval *e, csg_node_id node, csg_span where);
/* A flat node with a thickness of 1. */
csg_node_id csg_eval_plate(csg_eval *e, csg_node_id flat, csg_span where);
bool csg_eval_is_empty(const csg_eval *e, csg_node_id node);
bool csg_eval_is_flat(const csg_eval *e, csg_node_id node); /* false for the empty solid */
/* After every csg_build_*: a failure becomes a finding, and the node EMPTY. */
csg_node_id csg_check_node(csg_eval *e, csg_node_id node, csg_span where);

#endif
