/* SPDX-License-Identifier: MIT
 * Bricks that finer ones touch; see borders.h.
 */
#include "mesh/adaptive/borders.h"

#include <string.h>

#include "base/trace.h"
#include "mesh/adaptive/cells.h"

/* Wants cells divided, as long as there are smaller ones. */
static void want_divided(csg_cell_loop *w, const csg_shell *s, unsigned cells)
{
    csg_bricks *b = w->x->bricks;
    csg_brick *brick = &b->items[s->number];
    if (brick->level == b->finest || !cells)
        return;
    brick->wanted |= (uint8_t)cells;
    atomic_store(&w->any, true);
}

/* ---- simple ------------------------------------------------------------------------------------
 */

/* Of the finest cells: where leaves are as large as that several polygons may stay beside finer
 * ones. Smaller ones have wedges thinner than they are, of which their corners see crumbs, while
 * the finest make one edge of it: models/bottle_cap had a crumb with leaves half as large. */
enum { LEAST_SEVERAL = 8 };

/* Several polygons beside finer leaves: whether they keep apart is seen when their vertices are
 * known. */
static bool may_keep_apart(const csg_cell_at_hand *c)
{
    return c->is_border && c->polygons.count <= CSG_JUDGED_MOST_PIECES &&
           csg_bricks_cell(c->loop->x->bricks, c->shell->brick->level) >= LEAST_SEVERAL;
}

static bool want_simple(csg_cell_at_hand *c)
{
    unsigned cell = 1u << csg_cells_bit(c);
    bool several = c->polygons.count > 1 || c->shell->brick->several & cell;
    if (!c->is_whole &&
        ((several && !may_keep_apart(c)) || csg_cell_polygons_are_mixed(&c->polygons)))
        want_divided(c->loop, c->shell, cell);
    return true;
}

static bool visit_simple(csg_cell_loop *w, uint32_t worker, const csg_shell *s)
{
    want_divided(w, s, s->pierced_beyond & (uint8_t)~s->brick->divided);
    return !s->has_finer || csg_cells_each(w, worker, s, want_simple);
}

/* ---- near --------------------------------------------------------------------------------------
 */

static bool set_border_aside(csg_cell_at_hand *c)
{
    bool done = true;
    csg_judge_room *room = &c->loop->x->judge->rooms[c->worker];
    unsigned cell = csg_cells_bit(c);
    room->first_piece[cell] = (uint8_t)room->piece_count;
    for (unsigned i = 0; c->is_border && i < c->polygons.count && done; i++)
        done = csg_cells_set_aside(c, i);
    room->end_piece[cell] = (uint8_t)room->piece_count;
    return done;
}

/* Fans beside finer leaves: the judge has not seen them. */
static bool visit_near(csg_cell_loop *w, uint32_t worker, const csg_shell *s)
{
    csg_judge_room *room = &w->x->judge->rooms[worker];
    csg_cut_polygon *fans[CSG_JUDGED_MOST_APEXES];
    csg_tape tape;
    unsigned far = 0;
    if (!s->has_finer || s->brick->level == w->x->bricks->finest)
        return true;
    room->piece_count = 0;
    memset(room->first_piece, 0, sizeof room->first_piece);
    memset(room->end_piece, 0, sizeof room->end_piece);
    if (!csg_cells_each(w, worker, s, set_border_aside))
        return false;
    csg_cells_find_apexes(w, worker, s);
    for (int i = 0; i < room->piece_count; i++)
        fans[i] = &room->pieces[i];
    csg_sheet_probe probe = csg_judge_probe(w->x->judge, w->x->bricks, s->brick, room, &tape);
    const double tolerance = w->x->judge->tolerance;
    csg_cuts_find_distances(&probe, fans, room->piece_count, tolerance);
    csg_cuts_settle_near(fans, room->piece_count, tolerance);
    room->evaluations += probe.evaluations;
    const csg_bricks *b = w->x->bricks;
    double cell = csg_bricks_cell(b, s->brick->level) * b->lattice->cell_size;
    bool may_fail = csg_judge_may_fail(w->x->judge, cell);
    for (int i = 0; i < room->piece_count; i++)
        far |= (unsigned)(fans[i]->distance > w->x->farthest ||
                          (csg_cut_has_failed(fans[i]) && !may_fail))
               << fans[i]->cell;
    for (unsigned i = 0; i < CSG_BRICK_CELLS; i++)
        far |= (unsigned)!csg_judge_are_apart(room, i, cell) << i;
    want_divided(w, s, far);
    return true;
}

/* ---- which ------------------------------------------------------------------------------------
 */

/* Marks of bricks. */
enum { CHANGED = 1, CHOSEN = 4 }; /* beside CSG_MARK_AROUND */

/* Marks what a new brick, in the place of a cell, changes the border of: itself, and the bricks
 * around that cell. */
static void mark_changed(const csg_bricks *b, size_t number, uint8_t *changed)
{
    const csg_brick *brick = &b->items[number];
    changed[number] = CHANGED;
    if (brick->level <= b->options.coarse)
        return;
    for (unsigned part = 0; part < CSG_OCTANTS; part++) {
        uint32_t at[3];
        csg_brick_beside(brick, part, at);
        uint32_t found = csg_bricks_find(b, brick->level - 1u, at);
        if (found != CSG_BRICK_NONE)
            changed[found] = CHANGED;
    }
}

/* A byte per brick: CHANGED where new bricks, from `first` on, changed its border. NULL: out of
 * memory. */
static uint8_t *find_changed(const csg_extraction *x, size_t first)
{
    const csg_bricks *b = x->bricks;
    uint8_t *changed = csg_memory_alloc(&x->context->memory, b->count);
    if (!changed)
        return NULL;
    memset(changed, 0, b->count);
    for (size_t i = first; i < b->count; i++)
        mark_changed(b, i, changed);
    return changed;
}

/* ---- all of it ---------------------------------------------------------------------------------
 */

csgm_status csg_borders_check_simple(csg_extraction *x, bool *any)
{
    csg_cell_loop w;
    csgm_status status = csg_cell_loop_begin(&w, x);
    uint8_t *changed = status == CSGM_OK ? find_changed(x, x->simple) : NULL;
    if (status == CSGM_OK)
        status = changed ? csg_cell_loop_list_marked(&w, changed, CHANGED)
                         : csg_context_no_memory(x->context);
    csg_memory_release(&x->context->memory, changed, changed ? x->bricks->count : 0);
    x->simple = x->bricks->count;
    if (status == CSGM_OK)
        status = csg_cell_loop_run(&w, visit_simple, x->bricks->reported, 0);
    *any = atomic_load(&w.any);
    csg_cell_loop_end(&w);
    return status;
}

/* Bricks whose borders are looked at together: each takes a kilobyte with what is around it. Where
 * the memory is narrow they are fewer, but not so few that what is around them is most of it. Ranks
 * have the same limit. */
static size_t most_together(const csg_memory *memory)
{
    enum { MOST = 1 << 15, LEAST = 1 << 11, BYTES_EACH = 1024, SHARE = 32 };
    uint64_t room = memory->limit_bytes / SHARE / BYTES_EACH;
    return !memory->limit_bytes || room > MOST ? MOST : room < LEAST ? LEAST : (size_t)room;
}

/* Marks the changed bricks from *first on that are looked at together, and what is around them;
 * *first is then behind them. */
static void choose_together(const csg_bricks *b, uint8_t *marks, size_t *first)
{
    const size_t most = most_together(&b->context->memory);
    size_t count = 0, i;
    for (i = 0; i < b->count; i++)
        marks[i] &= CHANGED;
    for (i = *first; i < b->count && count < most; i++)
        if (marks[i] & CHANGED && csg_brick_has_leaves(&b->items[i])) {
            csg_cell_loop_mark_around(b, (uint32_t)i, marks);
            marks[i] |= CHOSEN;
            count++;
        }
    *first = i;
}

static csgm_status check_together(csg_extraction *x, const uint8_t *marks, bool *any)
{
    csg_cell_loop w;
    const double reported = x->bricks->reported;
    csgm_status status = csg_cell_loop_begin(&w, x);
    if (status == CSGM_OK)
        status = csg_cells_find_vertices_around(&w, marks, reported, 0);
    if (status == CSGM_OK)
        status = csg_cell_loop_list_marked(&w, marks, CHOSEN);
    if (status == CSGM_OK)
        status = csg_cell_loop_run(&w, visit_near, reported, 0);
    *any |= atomic_load(&w.any);
    csg_cell_loop_end(&w);
    return status;
}

csgm_status csg_borders_check_near(csg_extraction *x, bool *any)
{
    CSG_ZONE(x->context, "borders");
    csg_bricks *b = x->bricks;
    *any = false;
    uint8_t *marks = find_changed(x, x->near);
    csgm_status status = marks ? CSGM_OK : csg_context_no_memory(x->context);
    for (size_t first = 0; status == CSGM_OK && first < b->count;) {
        choose_together(b, marks, &first);
        status = check_together(x, marks, any);
    }
    x->near = b->count;
    csg_memory_release(&x->context->memory, marks, marks ? b->count : 0);
    return status;
}
