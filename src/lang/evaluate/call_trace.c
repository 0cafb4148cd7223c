/* SPDX-License-Identifier: MIT
 * The trace of calls behind a finding: a note a call, innermost first. A recursion's rounds (of up
 * to four calls, the same at the same places) are shown once and counted; of what is still long,
 * both ends are shown.
 */
#include "lang/evaluate/evaluator.h"

enum { LONGEST_ROUND = 4, INNER = 5, OUTER = 3 };

static bool is_same(const csg_trace_entry *a, const csg_trace_entry *b)
{
    return a->name == b->name && a->module == b->module && a->where.source == b->where.source &&
           a->where.offset == b->where.offset;
}

/* How many more entries below `count` repeat its last `round` ones, in whole rounds. */
static size_t repeated(const csg_eval *e, size_t count, size_t round)
{
    size_t more = 0;
    while (count >= round + more + 1 &&
           is_same(&e->trace[count - 1 - more], &e->trace[count - 1 - more - round]))
        more++;
    return more - more % round;
}

static void note_call(const csg_eval *e, const csg_trace_entry *entry)
{
    csg_source_note(&e->program->sources, entry->where, "in the call of %s '%s'",
                    entry->module ? "module" : "function",
                    entry->name ? csg_symbol_name(&e->program->symbols, entry->name) : "(literal)");
}

/* One round and how often it is there; returns its entries, 0 where nothing repeats. */
static size_t note_rounds(const csg_eval *e, size_t count)
{
    for (size_t round = 1; round <= LONGEST_ROUND; round++) {
        size_t more = repeated(e, count, round);
        if (more < 2 || more < round)
            continue;
        for (size_t i = 0; i < round; i++)
            note_call(e, &e->trace[count - 1 - i]);
        csg_source_note(&e->program->sources, e->trace[count - 1 - round].where,
                        round > 1 ? "and %zu more calls like these" : "and %zu more like this",
                        more);
        return round + more;
    }
    return 0;
}

void csg_eval_note_calls(const csg_eval *e)
{
    size_t shown = 0;
    for (size_t left = e->trace_count; left > 0; shown++) {
        size_t taken = note_rounds(e, left);
        left -= taken;
        if (taken)
            continue;
        if (shown >= INNER && left > OUTER + 1) {
            csg_source_note(&e->program->sources, e->trace[left - 1].where, "and %zu more calls",
                            left - OUTER);
            left = OUTER;
        }
        note_call(e, &e->trace[--left]);
    }
}
