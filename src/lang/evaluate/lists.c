/* SPDX-License-Identifier: MIT
 * Vectors and list comprehensions, what `for` iterates over, and echo and assert.
 */
#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "lang/evaluate/evaluator.h"
#include "lang/parse/ast_kinds.h"

/* ---- building lists
 * ------------------------------------------------------------------------------ */

void csg_list_push(csg_eval *e, csg_list *list, csg_value element, csg_span where)
{
    if (!e->stop && list->count >= CSG_LONGEST_LIST)
        csg_eval_limit(e, CSG_DIAG_LIST_TOO_LONG, where, NULL, "the list has more than %d elements",
                       (int)CSG_LONGEST_LIST);
    if (!e->stop && !csg_memory_reserve(e->heap.memory, (void **)&list->items, &list->capacity,
                                        list->count + 1, sizeof *list->items))
        csg_eval_no_memory(e);
    if (e->stop)
        csg_value_release(&e->heap, element);
    else
        list->items[list->count++] = element;
}

void csg_list_reserve(csg_eval *e, csg_list *list, double more, csg_span where)
{
    if (e->stop)
        return;
    if ((double)list->count + more > CSG_LONGEST_LIST)
        csg_eval_limit(e, CSG_DIAG_LIST_TOO_LONG, where, NULL, "the list has more than %d elements",
                       (int)CSG_LONGEST_LIST);
    else if (!csg_memory_reserve(e->heap.memory, (void **)&list->items, &list->capacity,
                                 list->count + (size_t)more, sizeof *list->items))
        csg_eval_no_memory(e);
}

/* The room of a list that has ended serves the next one. */
static void give_up_room(csg_eval *e, csg_list *list)
{
    enum { MOST_SPARE = 4096 };
    csg_list smaller = e->spare_list, larger = *list;
    if (smaller.capacity > larger.capacity || larger.capacity > MOST_SPARE) {
        smaller = larger;
        larger = e->spare_list;
    }
    csg_memory_release(e->heap.memory, smaller.items, smaller.capacity * sizeof *smaller.items);
    larger.count = 0;
    e->spare_list = larger;
    *list = (csg_list){0};
}

static csg_list begin_list(csg_eval *e)
{
    csg_list list = e->spare_list;
    e->spare_list = (csg_list){0};
    return list;
}

static csg_value vector_value(csg_eval *e, csg_vector *made)
{
    if (made->depth > e->heap.deepest)
        csg_eval_limit(e, CSG_DIAG_TOO_DEEP, csg_span_nowhere(), NULL,
                       "vectors are nested more than %u deep", e->heap.deepest);
    return csg_value_object(made, CSG_VALUE_VECTOR);
}

csg_value csg_list_finish(csg_eval *e, csg_list *list)
{
    csg_vector *made = e->stop ? NULL : csg_vector_create(&e->heap, list->count);
    if (!made)
        csg_eval_no_memory(e);
    for (size_t i = 0; made && i < list->count; i++)
        csg_vector_set(made, i, list->items[i]);
    give_up_room(e, list);
    return made ? vector_value(e, made) : csg_value_undef();
}

/* ---- iterating
 * ------------------------------------------------------------------------------------- */

static void begin_range(csg_eval *e, csg_iteration *iteration, csg_span where)
{
    iteration->count = csg_range_count(iteration->over.as.range);
    if (isinf(iteration->count)) { /* as in OpenSCAD */
        csg_eval_report(e, CSG_DIAG_BAD_RANGE, where, "is the range's step right?",
                        "the range has no end, it counts as empty");
        iteration->count = 0;
    } else if (iteration->count > (double)(e->context->limits.eval_steps - e->steps)) {
        csg_eval_limit(e, CSG_DIAG_TOO_MANY_STEPS, where,
                       "is the range's step right? raise the limit with --max-steps",
                       "the range has %.15g elements", iteration->count);
    }
}

bool csg_iteration_begin(csg_eval *e, csg_iteration *iteration, csg_value over, csg_span where)
{
    *iteration = (csg_iteration){.over = over};
    switch ((csg_value_kind)over.kind) {
    case CSG_VALUE_RANGE:
        begin_range(e, iteration, where);
        break;
    case CSG_VALUE_VECTOR:
        iteration->count = over.as.vector->count;
        break;
    case CSG_VALUE_RECORD:
        iteration->count = csg_record_count(over);
        break;
    case CSG_VALUE_STRING:
        iteration->count = (double)over.as.string->characters;
        break;
    case CSG_VALUE_UNDEF:
        break;
    case CSG_VALUE_NUMBER:
    case CSG_VALUE_BOOLEAN:
    case CSG_VALUE_BLEND:
    case CSG_VALUE_TERM:
    case CSG_VALUE_STEP:
    case CSG_VALUE_UNSET:
    case CSG_VALUE_FUNCTION:
    case CSG_VALUE_RULE:
    case CSG_VALUE_FRAME:
        iteration->count = 1;
        break;
    }
    return !e->stop;
}

static csg_value next_character(csg_eval *e, csg_iteration *iteration)
{
    const csg_string *string = iteration->over.as.string;
    size_t from = iteration->offset, to = from + 1;
    while (to < string->length && ((unsigned char)string->text[to] & 0xC0) == 0x80)
        to++;
    iteration->offset = to;
    return csg_eval_string(e, string->text + from, to - from);
}

bool csg_iteration_next(csg_eval *e, csg_iteration *iteration, csg_value *out, csg_span where)
{
    enum { ROUND_STEPS = 4 }; /* with the frame that each round gets */
    if (iteration->next >= iteration->count || !csg_eval_charge(e, ROUND_STEPS, where))
        return false;
    const csg_value over = iteration->over;
    double index = iteration->next++;
    if (over.kind == CSG_VALUE_RANGE)
        *out = csg_value_number(index == 0 ? over.as.range->begin
                                           : over.as.range->begin + index * over.as.range->step);
    else if (over.kind == CSG_VALUE_VECTOR)
        *out = csg_value_retain(over.as.vector->items[(size_t)index]);
    else if (over.kind == CSG_VALUE_RECORD) /* its keys */
        *out = csg_value_retain(over.as.vector->items[2 * (size_t)index]);
    else if (over.kind == CSG_VALUE_STRING)
        *out = next_character(e, iteration);
    else
        *out = csg_value_retain(over);
    return true;
}

/* ---- list comprehensions
 * ------------------------------------------------------------------------------ */

static void add_element(csg_eval *e, const csg_expression *x, csg_frame *frame, csg_list *list);

/* The k-th variable of a for and those behind it. */
static void add_for(csg_eval *e, const csg_expression *x, uint32_t k, csg_frame *frame,
                    csg_list *list)
{
    const csg_arguments *variables = &x->as.call.arguments;
    if (k == variables->count) {
        add_element(e, x->as.call.body, frame, list);
        return;
    }
    csg_iteration iteration;
    csg_value element, over = csg_evaluate(e, variables->items[k].value, frame);
    size_t dynamics = e->dynamic_count;
    csg_symbol name = variables->items[k].name;
    bool special = name && e->program->symbols.entries[name].special;
    bool begun = csg_iteration_begin(e, &iteration, over, variables->items[k].where);
    while (begun && csg_iteration_next(e, &iteration, &element, x->where)) {
        csg_frame *inner = csg_frame_create(&e->heap, frame, 1);
        if (!inner) {
            csg_eval_no_memory(e);
            break;
        }
        inner->names = &variables->items[k];
        if (special)
            csg_eval_push_dynamic(e, name, element);
        else
            inner->values[0] = element;
        add_for(e, x, k + 1, inner, list);
        csg_frame_release(&e->heap, inner);
        csg_eval_pop_dynamics(e, dynamics);
    }
    csg_value_release(&e->heap, over);
}

/* The variables after one round: those of `next` hide those of `first`. */
static csg_frame *next_round(csg_eval *e, const csg_expression *x, csg_frame *first, csg_frame *now)
{
    csg_frame *made = csg_eval_let(e, &x->as.loop.next, now);
    if (made) { /* it has all that `now` has, except for what stays as it was */
        csg_frame_release(&e->heap, made->parent);
        made->parent = csg_frame_retain(first);
    }
    csg_frame_release(&e->heap, now);
    return made;
}

/* As next_round gives it, but that nothing is set: so all rounds see frames alike (names.c). */
static csg_frame *first_round(csg_eval *e, const csg_expression *x, csg_frame *first)
{
    csg_frame *made = first ? csg_frame_create(&e->heap, first, x->as.loop.next.count) : NULL;
    if (made)
        made->names = x->as.loop.next.items;
    else
        csg_eval_no_memory(e);
    return made;
}

static void add_loop(csg_eval *e, const csg_expression *x, csg_frame *frame, csg_list *list)
{
    enum { MOST_ROUNDS = 1000000 }; /* as in OpenSCAD */
    size_t dynamics = e->dynamic_count;
    csg_frame *first = csg_eval_let(e, &x->as.loop.first, frame);
    csg_frame *now = first_round(e, x, first);
    for (uint32_t round = 0; now && csg_eval_charge(e, 1, x->where); round++) {
        csg_value condition = csg_evaluate(e, x->as.loop.condition, now);
        bool more = csg_value_is_true(condition);
        csg_value_release(&e->heap, condition);
        if (!more)
            break;
        if (round == MOST_ROUNDS) {
            csg_eval_limit(e, CSG_DIAG_TOO_MANY_STEPS, x->where,
                           "does the condition ever become false?",
                           "the loop goes round more than %d times", (int)MOST_ROUNDS);
            break;
        }
        add_element(e, x->as.loop.body, now, list);
        now = next_round(e, x, first, now);
    }
    csg_frame_release(&e->heap, now);
    csg_frame_release(&e->heap, first);
    csg_eval_pop_dynamics(e, dynamics);
}

static void add_each(csg_eval *e, const csg_expression *x, csg_frame *frame, csg_list *list)
{
    csg_list inner = begin_list(e);
    add_element(e, x->as.inner, frame, &inner);
    for (size_t i = 0; i < inner.count; i++) {
        csg_iteration iteration;
        csg_value element;
        bool begun = csg_iteration_begin(e, &iteration, inner.items[i], x->where);
        while (begun && csg_iteration_next(e, &iteration, &element, x->where))
            csg_list_push(e, list, element, x->where);
        csg_value_release(&e->heap, inner.items[i]);
    }
    give_up_room(e, &inner);
}

static void add_let(csg_eval *e, const csg_expression *x, csg_frame *frame, csg_list *list)
{
    size_t dynamics = e->dynamic_count;
    csg_frame *inner = csg_eval_let(e, &x->as.call.arguments, frame);
    if (inner && !e->stop)
        add_element(e, x->as.call.body, inner, list);
    csg_frame_release(&e->heap, inner);
    csg_eval_pop_dynamics(e, dynamics);
}

static void add_choice(csg_eval *e, const csg_expression *x, csg_frame *frame, csg_list *list)
{
    csg_value condition = csg_evaluate(e, x->as.branch.condition, frame);
    const csg_expression *chosen =
        csg_value_is_true(condition) ? x->as.branch.then : x->as.branch.other;
    csg_value_release(&e->heap, condition);
    if (chosen)
        add_element(e, chosen, frame, list);
}

static void add_element(csg_eval *e, const csg_expression *x, csg_frame *frame, csg_list *list)
{
    if (!csg_eval_charge(e, 1, x->where) || !csg_eval_check_stack(e, x->where))
        return;
    switch ((csg_expression_kind)x->kind) {
    case CSG_EXPRESSION_FOR:
        add_for(e, x, 0, frame, list);
        return;
    case CSG_EXPRESSION_FOR_LOOP:
        add_loop(e, x, frame, list);
        return;
    case CSG_EXPRESSION_IF:
        add_choice(e, x, frame, list);
        return;
    case CSG_EXPRESSION_EACH:
        add_each(e, x, frame, list);
        return;
    case CSG_EXPRESSION_LET:
        add_let(e, x, frame, list);
        return;
    case CSG_EXPRESSION_ECHO:
        csg_eval_echo(e, &x->as.call.arguments, frame);
        break;
    case CSG_EXPRESSION_ASSERT:
        csg_eval_assert(e, &x->as.call.arguments, frame, x->where);
        break;
    case CSG_EXPRESSION_NUMBER:
    case CSG_EXPRESSION_BOOLEAN:
    case CSG_EXPRESSION_UNDEF:
    case CSG_EXPRESSION_STRING:
    case CSG_EXPRESSION_NAME:
    case CSG_EXPRESSION_UNARY:
    case CSG_EXPRESSION_BINARY:
    case CSG_EXPRESSION_CONDITIONAL:
    case CSG_EXPRESSION_INDEX:
    case CSG_EXPRESSION_MEMBER:
    case CSG_EXPRESSION_CALL:
    case CSG_EXPRESSION_VECTOR:
    case CSG_EXPRESSION_RANGE:
    case CSG_EXPRESSION_FUNCTION:
        csg_list_push(e, list, csg_evaluate(e, x, frame), x->where);
        return;
    }
    if (x->as.call.body && !e->stop)
        add_element(e, x->as.call.body, frame, list);
}

/* As many elements as the text has. */
static csg_value plain_vector(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    uint32_t count = x->as.list.count;
    csg_vector *made =
        csg_eval_charge(e, count, x->where) ? csg_vector_create(&e->heap, count) : NULL;
    if (!made) {
        csg_eval_no_memory(e);
        return csg_value_undef();
    }
    for (uint32_t i = 0; i < count && !e->stop; i++)
        csg_vector_set(made, i, csg_evaluate(e, x->as.list.items[i], frame));
    return vector_value(e, made);
}

csg_value csg_eval_vector(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    if (x->as.list.is_plain)
        return plain_vector(e, x, frame);
    csg_list list = begin_list(e);
    for (uint32_t i = 0; i < x->as.list.count && !e->stop; i++)
        add_element(e, x->as.list.items[i], frame, &list);
    return csg_list_finish(e, &list);
}

/* ---- echo and assert
 * --------------------------------------------------------------------------------- */

enum { BYTES_A_STEP = 16 };

csg_text csg_eval_text(const csg_eval *e)
{
    uint64_t all = e->context->limits.eval_steps, left = all > e->steps ? all - e->steps : 0;
    bool plenty = left > CSG_LONGEST_STRING / BYTES_A_STEP;
    return (csg_text){.memory = e->heap.memory,
                      .most = plenty ? CSG_LONGEST_STRING : (size_t)(left + 1) * BYTES_A_STEP};
}

bool csg_eval_text_done(csg_eval *e, const csg_text *text, csg_span where)
{
    if (text->failed && !text->too_long)
        csg_eval_no_memory(e);
    else if (csg_eval_charge(e, (text->too_long ? text->most : text->length) / BYTES_A_STEP,
                             where) &&
             text->too_long)
        csg_eval_limit(e, CSG_DIAG_STRING_TOO_LONG, where, NULL, "the text is longer than %d MiB",
                       CSG_LONGEST_STRING >> 20);
    return !e->stop;
}

csg_value csg_eval_text_value(csg_eval *e, csg_text *text, csg_span where)
{
    csg_value made = csg_value_undef();
    if (csg_eval_text_done(e, text, where))
        made = csg_eval_string(e, text->data, text->length);
    csg_text_reset(text);
    return made;
}

void csg_eval_echo(csg_eval *e, const csg_arguments *arguments, csg_frame *frame)
{
    csg_text text = csg_eval_text(e);
    csg_text_put_string(&text, "ECHO: ");
    for (uint32_t i = 0; i < arguments->count && !e->stop; i++) {
        const csg_argument *argument = &arguments->items[i];
        csg_value value = csg_evaluate(e, argument->value, frame);
        if (i)
            csg_text_put(&text, ", ", 2);
        if (argument->name) {
            csg_text_put_string(&text, csg_symbol_name(&e->program->symbols, argument->name));
            csg_text_put(&text, " = ", 3);
        }
        csg_text_put_value(&text, value, true, &e->program->symbols);
        csg_value_release(&e->heap, value);
    }
    csg_text_put(&text, "\n", 1);
    csg_span where = arguments->count ? arguments->items[0].where : csg_span_nowhere();
    if (!e->stop && csg_eval_text_done(e, &text, where) && e->context->on_echo)
        e->context->on_echo(e->context->user, text.data, text.length);
    csg_text_reset(&text);
}

static const csg_argument *find_argument(csg_eval *e, const csg_arguments *arguments,
                                         uint32_t position, const char *name)
{
    uint32_t at = 0;
    for (uint32_t i = 0; i < arguments->count; i++) {
        const csg_argument *argument = &arguments->items[i];
        if (argument->name
                ? strcmp(csg_symbol_name(&e->program->symbols, argument->name), name) == 0
                : at++ == position)
            return argument;
    }
    return NULL;
}

static void fail_assertion(csg_eval *e, const csg_argument *condition, csg_value message,
                           csg_span where)
{
    csg_text text = {.memory = e->heap.memory};
    csg_text_put_string(&text, "assertion '");
    if (condition)
        csg_text_put_expression(&text, condition->value, &e->program->symbols);
    csg_text_put_string(&text, "' failed");
    if (message.kind != CSG_VALUE_UNDEF) {
        csg_text_put_string(&text, ": ");
        csg_text_put_value(&text, message, true, &e->program->symbols);
    }
    if (text.failed && !text.too_long)
        csg_eval_no_memory(e);
    else
        csg_eval_report(e, CSG_DIAG_ASSERTION, condition ? condition->value->whole : where, NULL,
                        "%.*s", (int)(text.length < 400 ? text.length : 400), text.data);
    csg_text_reset(&text);
    e->stop = true;
}

bool csg_eval_assert(csg_eval *e, const csg_arguments *arguments, csg_frame *frame, csg_span where)
{
    const csg_argument *condition = find_argument(e, arguments, 0, "condition");
    const csg_argument *message = find_argument(e, arguments, 1, "message");
    csg_value truth = condition ? csg_evaluate(e, condition->value, frame) : csg_value_undef();
    bool holds = csg_value_is_true(truth);
    csg_value_release(&e->heap, truth);
    if (holds || e->stop)
        return holds;
    csg_value text = message ? csg_evaluate(e, message->value, frame) : csg_value_undef();
    if (!e->stop)
        fail_assertion(e, condition, text, where);
    csg_value_release(&e->heap, text);
    return false;
}
