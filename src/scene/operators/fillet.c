/* SPDX-License-Identifier: MIT
 * Fillets of whole trees at a point; see fillet.h.
 *
 * From the leaves up every term becomes a lattice: a piece, or a maximum or a minimum of such, of
 * which only what lies within the window of the deciding one is kept. Operands of a fillet that are
 * in reach of the largest are taken by twos or threes; as long as one of those is a maximum, all of
 * them are replaced by their members, then all minima, and so on until all are pieces. With that
 * order the result does not depend on the operands' order, and members that pruning has dropped
 * change no bit. Nested fillets hand up what they are made of, since they have edges where their
 * operands do.
 */
#include "scene/operators/fillet.h"

#include <string.h>

enum {
    NODES = 1024,      /* pieces and lattices at one point */
    LINKS = 2048,      /* members of all lattices */
    MOST_ROOTS = 64,   /* lattices that wait to be joined */
    MOST_MEMBERS = 12, /* of a lattice: those nearest to deciding */
    MOST_DEEP = 10,    /* levels of a lattice; of a deeper part the deciding piece stands for it */
    MOST_TAKEN = 3     /* operands at a time */
};

/* A lattice: a piece, or members links[first .. first + count), in their order. */
typedef struct lattice {
    double f;
    uint32_t first, count; /* of a piece: its index, 0 */
    uint32_t decides;      /* the piece whose value it has */
    uint8_t kind, depth;
} lattice;

typedef struct work {
    csg_fillet_piece pieces[NODES];
    lattice nodes[NODES];
    uint32_t links[LINKS];
    uint32_t piece_count, node_count, link_count;
    bool is_full;  /* something did not fit */
    bool is_plain; /* the piece that decides stands for every lattice */
} work;

/* The order in which members of a maximum stand: larger ones first, equal ones by their gradients.
 */
static int compare_pieces(const csg_fillet_piece *a, const csg_fillet_piece *b)
{
    if (a->f != b->f)
        return a->f > b->f ? -1 : 1;
    for (int i = 0; i < 3; i++)
        if (a->g[i] != b->g[i])
            return a->g[i] > b->g[i] ? -1 : 1;
    return a->paint != b->paint ? (a->paint > b->paint ? -1 : 1) : 0;
}

/* A leaf and the face that decides it there are the same, but for their rounding. */
static bool is_same_piece(const work *w, uint32_t a, uint32_t b)
{
    static const double SAME = 4e-6;
    const lattice *x = &w->nodes[a], *y = &w->nodes[b];
    if (x->kind != CSG_FILLET_PIECE || y->kind != CSG_FILLET_PIECE)
        return false;
    const csg_fillet_piece *p = &w->pieces[x->first], *q = &w->pieces[y->first];
    double off = fabs(p->f - q->f) / (1 + fabs(p->f));
    for (int i = 0; i < 3; i++)
        off = csg_fillet_larger(off, fabs(p->g[i] - q->g[i]));
    return off < SAME && p->paint == q->paint;
}

static uint32_t add_piece(work *w, const csg_fillet_piece *piece)
{
    if (w->piece_count == NODES || w->node_count == NODES) {
        w->is_full = true;
        return NODES - 1;
    }
    w->pieces[w->piece_count] = *piece;
    w->nodes[w->node_count] = (lattice){.f = piece->f,
                                        .first = w->piece_count,
                                        .decides = w->piece_count,
                                        .kind = CSG_FILLET_PIECE};
    w->piece_count++;
    return w->node_count++;
}

static uint32_t add_decider(work *w, uint32_t node)
{
    csg_fillet_piece piece = w->pieces[w->nodes[node].decides];
    return add_piece(w, &piece);
}

/* A list that is being made of members: kept in order, by value and then by gradient. */
typedef struct gathering {
    uint32_t items[MOST_ROOTS];
    uint32_t count;
    csg_fillet_kind kind; /* MAX or MIN */
    double window;
    bool is_sharp; /* of a sharp operator: of equal ones the last decides, as on the tape */
} gathering;

/* Whether member a stands before b: nearer to deciding. */
static bool stands_before(const work *w, const gathering *g, uint32_t a, uint32_t b)
{
    const csg_fillet_piece *p = &w->pieces[w->nodes[a].decides],
                           *q = &w->pieces[w->nodes[b].decides];
    if (g->is_sharp && p->f == q->f && p->rank != q->rank)
        return p->rank > q->rank;
    int order = compare_pieces(p, q);
    return g->kind == CSG_FILLET_MAX ? order < 0 : order > 0;
}

/* By how much a value lies behind the one that decides so far. */
static double behind(const work *w, const gathering *g, double f)
{
    double best = w->nodes[g->items[0]].f;
    return g->kind == CSG_FILLET_MAX ? best - f : f - best;
}

static void gather_one(const work *w, gathering *g, uint32_t node)
{
    if (g->count && behind(w, g, w->nodes[node].f) > g->window)
        return;
    for (uint32_t i = 0; i < g->count; i++)
        if (is_same_piece(w, g->items[i], node)) {
            if (!stands_before(w, g, node, g->items[i]))
                return;
            memmove(g->items + i, g->items + i + 1, (--g->count - i) * sizeof *g->items);
            break;
        }
    uint32_t at = g->count < MOST_ROOTS ? g->count++ : MOST_ROOTS - 1;
    for (; at > 0 && stands_before(w, g, node, g->items[at - 1]); at--)
        g->items[at] = g->items[at - 1];
    g->items[at] = node;
    while (behind(w, g, w->nodes[g->items[g->count - 1]].f) > g->window)
        g->count--;
}

/* Members of a member of the same kind are its own. */
static void gather(const work *w, gathering *g, uint32_t node)
{
    const lattice *l = &w->nodes[node];
    if (l->kind != (uint8_t)g->kind) {
        gather_one(w, g, node);
        return;
    }
    for (uint32_t i = 0; i < l->count; i++)
        gather_one(w, g, w->links[l->first + i]);
}

static uint32_t make(work *w, const gathering *g)
{
    uint32_t depth = 0;
    if (g->count == 1)
        return g->items[0];
    uint32_t count = g->count < MOST_MEMBERS ? g->count : MOST_MEMBERS;
    for (uint32_t i = 0; i < count; i++)
        depth = w->nodes[g->items[i]].depth > depth ? w->nodes[g->items[i]].depth : depth;
    w->is_full |= w->node_count == NODES || w->link_count + count > LINKS;
    if (depth + 1 > MOST_DEEP || w->is_full || w->is_plain)
        return add_decider(w, g->items[0]);
    memcpy(w->links + w->link_count, g->items, count * sizeof *g->items);
    w->nodes[w->node_count] = (lattice){.f = w->nodes[g->items[0]].f,
                                        .first = w->link_count,
                                        .count = count,
                                        .decides = w->nodes[g->items[0]].decides,
                                        .kind = (uint8_t)g->kind,
                                        .depth = (uint8_t)(depth + 1)};
    w->link_count += count;
    return w->node_count++;
}

/* ---- fillets of pieces -------------------------------------------------------------------------
 */

/* Pieces in their order; those without a gradient do not blend. */
static uint32_t arrange(const work *w, const uint32_t *pieces, uint32_t count,
                        csg_fillet_operand *out)
{
    uint32_t made = 0;
    for (uint32_t i = 0; i < count; i++) {
        const csg_fillet_piece *p = &w->pieces[pieces[i]];
        csg_fillet_operand o = {.index = pieces[i]};
        if (csg_fillet_set(&o, p->f, p->g[0], p->g[1], p->g[2]))
            made = csg_fillet_insert(out, made, &o);
    }
    return made;
}

static csg_fillet_piece mix(const work *w, const csg_fillet_operand *o,
                            const csg_fillet_choice *best)
{
    csg_fillet_piece out = {.f = o[0].f + best->excess};
    double share = 1;
    for (uint32_t i = 1; i < best->count; i++)
        share -= best->share[i];
    for (uint32_t i = 0; i < best->count; i++) {
        const csg_fillet_piece *p = &w->pieces[o[best->at[i]].index];
        share = i ? best->share[i] : share;
        for (int k = 0; k < 3; k++)
            out.g[k] += share * p->g[k];
        out.paint += share * p->paint;
    }
    return out;
}

static csg_fillet_piece unite_pieces(const work *w, double r, const uint32_t *pieces,
                                     uint32_t count)
{
    csg_fillet_operand o[CSG_FILLET_MOST];
    uint32_t top = pieces[0];
    for (uint32_t i = 1; i < count; i++)
        if (compare_pieces(&w->pieces[pieces[i]], &w->pieces[top]) < 0)
            top = pieces[i];
    uint32_t made = arrange(w, pieces, count, o);
    if (made < 2)
        return w->pieces[top];
    csg_fillet_choice best = csg_fillet_solve(r, o, made);
    double level = o[0].f + best.excess;
    return level > w->pieces[top].f ? mix(w, o, &best) : w->pieces[top];
}

/* ---- fillets of lattices -----------------------------------------------------------------------
 */

static uint32_t distribute(work *w, double r, double window, const uint32_t *roots, uint32_t count);

static bool is_gathered(const work *w, const gathering *g, uint32_t node)
{
    bool is_among = w->nodes[node].kind == (uint8_t)g->kind; /* its members may be */
    for (uint32_t i = 0; i < g->count && !is_among; i++)
        is_among = g->items[i] == node;
    return is_among;
}

static void take_back(work *w, const uint32_t counts[3])
{
    w->piece_count = counts[0];
    w->node_count = counts[1];
    w->link_count = counts[2];
}

/* Members of those roots that are of this kind, each in turn with each of the others'. */
static uint32_t distribute_members(work *w, double r, double window, const uint32_t *roots,
                                   uint32_t count, csg_fillet_kind kind)
{
    gathering g = {.kind = kind, .window = window};
    uint32_t at[MOST_TAKEN] = {0}, taken[MOST_TAKEN], k = 0;
    while (k < count) {
        double most = -INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            const lattice *l = &w->nodes[roots[i]];
            taken[i] = l->kind == (uint8_t)kind ? w->links[l->first + at[i]] : roots[i];
            most = csg_fillet_larger(most, w->nodes[taken[i]].f);
        }
        /* the result is `most` or more, by r at most */
        double nearest = kind == CSG_FILLET_MAX ? most + r : most;
        if (!g.count || !(behind(w, &g, nearest) > window)) {
            const uint32_t counts[3] = {w->piece_count, w->node_count, w->link_count};
            uint32_t made = distribute(w, r, window, taken, count);
            gather(w, &g, made);
            if (!is_gathered(w, &g, made))
                take_back(w, counts);
        }
        for (k = 0; k < count; k++) {
            const lattice *l = &w->nodes[roots[k]];
            if (l->kind == (uint8_t)kind && ++at[k] < l->count)
                break;
            at[k] = 0;
        }
    }
    return make(w, &g);
}

static uint32_t distribute(work *w, double r, double window, const uint32_t *roots, uint32_t count)
{
    bool has[CSG_FILLET_MIN + 1] = {false};
    uint32_t pieces[MOST_TAKEN];
    for (uint32_t i = 0; i < count; i++) {
        has[w->nodes[roots[i]].kind] = true;
        pieces[i] = w->nodes[roots[i]].first;
    }
    if (has[CSG_FILLET_MAX])
        return distribute_members(w, r, window, roots, count, CSG_FILLET_MAX);
    if (has[CSG_FILLET_MIN])
        return distribute_members(w, r, window, roots, count, CSG_FILLET_MIN);
    csg_fillet_piece made = unite_pieces(w, r, pieces, count);
    return add_piece(w, &made);
}

/* All that are pieces at once, lattices by twos or threes. */
static void gather_blends(work *w, double r, gathering *g, const uint32_t *reach, uint32_t count)
{
    uint32_t pieces[CSG_FILLET_MOST];
    bool are_pieces = true;
    for (uint32_t i = 0; i < count; i++) {
        are_pieces &= w->nodes[reach[i]].kind == CSG_FILLET_PIECE;
        pieces[i] = w->nodes[reach[i]].first;
    }
    if (are_pieces) {
        csg_fillet_piece made = unite_pieces(w, r, pieces, count);
        gather(w, g, add_piece(w, &made));
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = i + 1; k < count; k++) {
            if (count == 2)
                gather(w, g, distribute(w, r, g->window, (uint32_t[]){reach[i], reach[k]}, 2));
            for (uint32_t l = k + 1; l < count; l++) {
                double top = w->nodes[reach[i]].f, second = top - w->nodes[reach[k]].f,
                       third = top - w->nodes[reach[l]].f;
                if (!(behind(w, g, top + csg_fillet_bound(r, second, third, 2)) > g->window))
                    gather(
                        w, g,
                        distribute(w, r, g->window, (uint32_t[]){reach[i], reach[k], reach[l]}, 3));
            }
        }
}

/* ---- trees -------------------------------------------------------------------------------------
 */

/* A tree at a point; bounds: of every term, least and most. */
typedef struct tree {
    const csg_fillet_term *terms;
    const csg_fillet_piece *pieces;
    double (*bounds)[2];
    work *w;
} tree;

static bool is_fillet(csg_fillet_kind kind)
{
    return kind == CSG_FILLET_UNITE || kind == CSG_FILLET_MEET;
}

static bool is_union(csg_fillet_kind kind)
{
    return kind == CSG_FILLET_MAX || kind == CSG_FILLET_UNITE;
}

/* What an operand can have at least and at most, the other way round for those that meet. */
static double end_of(const tree *t, uint32_t at, bool flipped, int end)
{
    return flipped ? -t->bounds[at][!end] : t->bounds[at][end];
}

/* Of operands, the last of which stands right before their operator. A fillet adds something where
 * two of them are in reach of each other. */
static void join_bounds(tree *t, uint32_t i)
{
    const csg_fillet_term *term = &t->terms[i];
    bool flipped = !is_union((csg_fillet_kind)term->kind);
    double least = -INFINITY, most[2] = {-INFINITY, -INFINITY};
    for (uint32_t at = i - 1; at != i - term->size; at -= t->terms[at].size) {
        double low = end_of(t, at, flipped, 0), high = end_of(t, at, flipped, 1);
        least = csg_fillet_larger(least, low);
        most[1] = csg_fillet_larger(most[1], csg_fillet_smaller(most[0], high));
        most[0] = csg_fillet_larger(most[0], high);
    }
    bool blends = is_fillet((csg_fillet_kind)term->kind) && least - most[1] < 2 * term->radius;
    most[0] += blends ? term->radius : 0;
    t->bounds[i][flipped] = flipped ? -least : least;
    t->bounds[i][!flipped] = flipped ? -most[0] : most[0];
}

static void find_bounds(tree *t, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (t->terms[i].kind == CSG_FILLET_PIECE)
            t->bounds[i][0] = t->bounds[i][1] = t->pieces[t->terms[i].piece].f;
        else
            join_bounds(t, i);
}

static csg_fillet_kind turned(csg_fillet_kind kind, bool negated)
{
    static const csg_fillet_kind other[] = {CSG_FILLET_PIECE, CSG_FILLET_MIN, CSG_FILLET_MAX,
                                            CSG_FILLET_MEET, CSG_FILLET_UNITE};
    return negated ? other[kind] : kind;
}

csg_fillet_piece csg_fillet_negated(csg_fillet_piece p)
{
    p.f = -p.f;
    for (int k = 0; k < 3; k++)
        p.g[k] = -p.g[k];
    return p;
}

/* The lattice of the negated pieces. */
static uint32_t negate(work *w, uint32_t root)
{
    lattice l = w->nodes[root];
    if (l.kind == CSG_FILLET_PIECE) {
        csg_fillet_piece p = csg_fillet_negated(w->pieces[l.first]);
        return add_piece(w, &p);
    }
    gathering g = {
        .kind = turned((csg_fillet_kind)l.kind, true), .window = INFINITY, .is_sharp = true};
    for (uint32_t i = 0; i < l.count; i++)
        gather(w, &g, negate(w, w->links[l.first + i]));
    return make(w, &g);
}

/* Operands of the term that can be within `reach` of the largest (of a minimum: the smallest), in
 * an order that is not theirs where there are more than there is room for. */
static uint32_t find_near(const tree *t, uint32_t i, bool negated, double reach,
                          uint32_t near[MOST_ROOTS])
{
    const csg_fillet_term *term = &t->terms[i];
    bool lowest = !is_union(turned((csg_fillet_kind)term->kind, negated));
    bool flipped = negated != lowest; /* so that the largest is wanted */
    double best = -INFINITY;
    uint32_t count = 0;
    for (uint32_t at = i - 1; at != i - term->size; at -= t->terms[at].size)
        best = csg_fillet_larger(best, end_of(t, at, flipped, 0));
    for (uint32_t at = i - 1; at != i - term->size; at -= t->terms[at].size) {
        double most = end_of(t, at, flipped, 1);
        if (best - most > reach)
            continue;
        uint32_t place = count < MOST_ROOTS ? count++ : MOST_ROOTS;
        for (; place > 0 && most > end_of(t, near[place - 1], flipped, 1); place--)
            if (place < MOST_ROOTS)
                near[place] = near[place - 1];
        if (place < MOST_ROOTS)
            near[place] = at;
    }
    return count;
}

static uint32_t lattice_of(const tree *t, uint32_t i, bool negated, double window);

/* Finds what a term has, which is the same for whoever asks, where that is not known. */
static void settle(const tree *t, uint32_t i)
{
    work *w = t->w;
    if (!(t->bounds[i][0] < t->bounds[i][1]))
        return;
    const uint32_t counts[3] = {w->piece_count, w->node_count, w->link_count};
    t->bounds[i][0] = t->bounds[i][1] = w->nodes[lattice_of(t, i, false, 0)].f;
    take_back(w, counts);
}

/* Whether two operands are in reach of each other. */
static bool may_blend(const tree *t, uint32_t i, bool negated)
{
    uint32_t near[MOST_ROOTS], count = find_near(t, i, negated, 2 * t->terms[i].radius, near);
    for (uint32_t k = 0; k < count && count > 1; k++)
        settle(t, near[k]);
    return count > 1 && find_near(t, i, negated, 2 * t->terms[i].radius, near) > 1;
}

/* The union with a fillet of operands that are in reach of the largest, and these themselves. Only
 * where some blend, what is below has to be seen from farther away. */
static uint32_t unite(const tree *t, uint32_t i, bool negated, double window)
{
    work *w = t->w;
    double r = t->terms[i].radius;
    gathering all = {.kind = CSG_FILLET_MAX, .window = window};
    uint32_t near[MOST_ROOTS], reach[CSG_FILLET_MOST], reaching = 0;
    bool blends = may_blend(t, i, negated);
    uint32_t count =
        find_near(t, i, negated, blends ? csg_fillet_larger(window, 2 * r) : window, near);
    double inner = blends ? window + csg_fillet_window(r) : window;
    for (uint32_t k = 0; k < count; k++) {
        near[k] = lattice_of(t, near[k], negated, inner);
        gather(w, &all, near[k]);
        uint32_t at = reaching < CSG_FILLET_MOST ? reaching++ : CSG_FILLET_MOST - 1;
        for (; at > 0 && stands_before(w, &all, near[k], reach[at - 1]); at--)
            reach[at] = reach[at - 1];
        reach[at] = near[k];
    }
    while (reaching > 1 && !(w->nodes[reach[0]].f - w->nodes[reach[reaching - 1]].f < 2 * r))
        reaching--;
    if (reaching > 1)
        gather_blends(w, r, &all, reach, reaching);
    return make(w, &all);
}

/* CSG_FILLET_DEEPEST bounds the depth. */
static uint32_t lattice_of(const tree *t, uint32_t i, bool negated, double window)
{
    const csg_fillet_term *term = &t->terms[i];
    csg_fillet_kind kind = turned((csg_fillet_kind)term->kind, negated);
    if (kind == CSG_FILLET_PIECE) {
        csg_fillet_piece p = t->pieces[term->piece];
        p.rank = term->piece + 1;
        p = negated ? csg_fillet_negated(p) : p;
        return add_piece(t->w, &p);
    }
    if (is_fillet(kind)) {
        bool meets = kind == CSG_FILLET_MEET;
        uint32_t made = unite(t, i, negated != meets, window);
        return meets ? negate(t->w, made) : made;
    }
    uint32_t near[MOST_ROOTS], count = find_near(t, i, negated, window, near);
    gathering g = {.kind = kind, .window = window, .is_sharp = true};
    for (uint32_t k = 0; k < count; k++)
        gather(t->w, &g, lattice_of(t, near[k], negated, window));
    return make(t->w, &g);
}

csg_fillet_piece csg_fillet_evaluate(const csg_fillet_term *terms, uint32_t count,
                                     const csg_fillet_piece *pieces, double (*bounds)[2])
{
    work w;
    tree t = {terms, pieces, bounds, &w};
    uint32_t made = 0;
    w.is_full = true;
    for (w.is_plain = false; w.is_full; w.is_plain = true) { /* plain ones fit */
        w.piece_count = w.node_count = w.link_count = 0;
        w.is_full = false;
        find_bounds(&t, count);
        made = lattice_of(&t, count - 1, false, 0);
        if (w.is_plain)
            break;
    }
    return w.pieces[w.nodes[made].decides];
}
