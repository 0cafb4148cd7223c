/* SPDX-License-Identifier: MIT
 * The wavefront, event after event: a heap has when each edge will be nothing, and when each corner
 * that points inwards will meet each edge, by what is known now. Whatever is made by an event is
 * tried against all that moves, so time grows with the square of the points.
 *
 * Corners between edges that run against each other are infinitely fast: such a corner has met the
 * nearer end of its edges at once. Edges that vanish together vanish one after the other at the
 * same time, and corners that meet corners cut edges at their very ends: what is left between them
 * has no length and vanishes, too. Positions follow from the lines of the edges, so errors do not
 * add up.
 *
 * Not handled: loops that touch from outside are told apart from ones that touch from inside only
 * where one of them has a corner.
 */
#include "shape/plane/skeleton.h"

#include "base/elementary.h"
#include "base/random.h"

enum { NONE = UINT32_MAX, MOST_TRIES = 3 };

/* Some seconds. */
static const uint64_t most_work = 300000000;

typedef struct line {
    csg_vec2 along, inwards; /* of length 1 */
    double offset;           /* inwards . p of its points when the time is 0 */
} line;

/* A corner of the front: where the edge `before` ends and the edge `after` begins. */
typedef struct corner {
    csg_vec2 at, speed; /* when it was made */
    double time;
    uint32_t before, after;  /* edges */
    uint32_t previous, next; /* corners */
    uint32_t node;
    bool gone, is_reflex, is_instant;
} corner;

/* The corner `a` meets the edge from the corner `b` to the corner `c`; it is b: the edge is gone.
 */
typedef struct event {
    double time;
    uint32_t a, b, c;
} event;

typedef struct front {
    csg_memory *memory;
    csg_skeleton *out;
    line *lines;
    corner *corners;
    event *heap;
    size_t corner_count, corner_capacity, heap_count, heap_capacity;
    double now, small; /* lengths below `small` are none */
    uint64_t work;
    bool no_memory;
} front;

static double dot(csg_vec2 a, csg_vec2 b)
{
    return a.x * b.x + a.y * b.y;
}

static double cross(csg_vec2 a, csg_vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

/* ---- events ---------------------------------------------------------------------------------- */

static bool is_sooner(const event *a, const event *b)
{
    if (a->time != b->time)
        return a->time < b->time;
    bool a_cuts = a->a != a->b, b_cuts = b->a != b->b;
    if (a_cuts != b_cuts)
        return b_cuts; /* what vanishes makes way first */
    return a->a != b->a ? a->a < b->a : a->b < b->b;
}

static void add_event(front *f, event e)
{
    void *data = f->heap;
    if (f->no_memory || !csg_memory_reserve(f->memory, &data, &f->heap_capacity, f->heap_count + 1,
                                            sizeof *f->heap)) {
        f->no_memory = true;
        return;
    }
    f->heap = data;
    size_t i = f->heap_count++;
    for (; i && is_sooner(&e, &f->heap[(i - 1) / 2]); i = (i - 1) / 2)
        f->heap[i] = f->heap[(i - 1) / 2];
    f->heap[i] = e;
}

static event take_event(front *f)
{
    event first = f->heap[0], last = f->heap[--f->heap_count];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < f->heap_count; i = child) {
        child += child + 1 < f->heap_count && is_sooner(&f->heap[child + 1], &f->heap[child]);
        if (!is_sooner(&f->heap[child], &last))
            break;
        f->heap[i] = f->heap[child];
    }
    f->heap[i] = last;
    return first;
}

/* ---- corners that move ----------------------------------------------------------------------- */

static csg_vec2 position(const front *f, const corner *c, double time)
{
    const line *a = &f->lines[c->before], *b = &f->lines[c->after];
    double turn = cross(a->along, b->along);
    if (c->is_instant)
        return c->at;
    if (fabs(turn) < 0.1 && dot(a->along, b->along) > 0)
        return (csg_vec2){c->at.x + c->speed.x * (time - c->time),
                          c->at.y + c->speed.y * (time - c->time)};
    double p = a->offset + time, q = b->offset + time;
    return (csg_vec2){(p * b->inwards.y - q * a->inwards.y) / turn,
                      (q * a->inwards.x - p * b->inwards.x) / turn};
}

static void set_speed(const front *f, corner *c)
{
    const line *a = &f->lines[c->before], *b = &f->lines[c->after];
    double turn = cross(a->along, b->along), same = dot(a->along, b->along);
    c->is_instant = same < 0 && fabs(turn) < 1e-7;
    c->is_reflex = turn < 0 && !c->is_instant;
    if (c->is_instant)
        c->speed = (csg_vec2){0, 0};
    else if (same > 0)
        c->speed = (csg_vec2){(a->inwards.x + b->inwards.x) / (1 + same),
                              (a->inwards.y + b->inwards.y) / (1 + same)};
    else
        c->speed =
            (csg_vec2){(b->inwards.y - a->inwards.y) / turn, (a->inwards.x - b->inwards.x) / turn};
}

/* When the edge from `a` to the corner after it is nothing. */
static void await_end(front *f, uint32_t a)
{
    const corner *p = &f->corners[a], *q = &f->corners[p->next];
    csg_vec2 along = f->lines[p->after].along;
    csg_vec2 from = position(f, p, f->now), to = position(f, q, f->now);
    double length = dot((csg_vec2){to.x - from.x, to.y - from.y}, along);
    double shrinks = dot((csg_vec2){p->speed.x - q->speed.x, p->speed.y - q->speed.y}, along);
    if (p->is_instant || q->is_instant)
        return;
    if (length <= f->small)
        add_event(f, (event){f->now, a, a, p->next});
    else if (shrinks > 0)
        add_event(f, (event){f->now + length / shrinks, a, a, p->next});
}

/* The shorter edge at a corner that is infinitely fast is gone. */
static void end_shorter(front *f, uint32_t a)
{
    const corner *c = &f->corners[a];
    csg_vec2 p = position(f, &f->corners[c->previous], f->now);
    csg_vec2 q = position(f, &f->corners[c->next], f->now);
    bool is_first =
        csg_hypot(p.x - c->at.x, p.y - c->at.y) < csg_hypot(q.x - c->at.x, q.y - c->at.y);
    uint32_t from = is_first ? c->previous : a;
    add_event(f, (event){f->now, from, from, f->corners[from].next});
}

/* When the corner `a`, which points inwards, meets the edge that begins at `b`, as both move now.
 */
static void await_cut(front *f, uint32_t a, uint32_t b)
{
    const corner *v = &f->corners[a], *p = &f->corners[b];
    uint32_t c = p->next;
    const corner *q = &f->corners[c];
    f->work++;
    if (a == b || a == c || p->is_instant || q->is_instant)
        return;
    const line *edge = &f->lines[p->after];
    csg_vec2 at = position(f, v, f->now);
    double room = dot(edge->inwards, at) - edge->offset - f->now;
    double nears = 1 - dot(edge->inwards, v->speed);
    if (nears <= 1e-12 || room < -f->small)
        return;
    double time = f->now + fmax(room, 0) / nears;
    if (room <= f->small && f->now == 0 && /* they touch: from inside? */
        (dot(edge->inwards, f->lines[v->before].along) > 1e-9 ||
         dot(edge->inwards, f->lines[v->after].along) < -1e-9))
        return;
    csg_vec2 meet = position(f, v, time), from = position(f, p, time), to = position(f, q, time);
    double behind = dot((csg_vec2){meet.x - from.x, meet.y - from.y}, edge->along);
    double ahead = dot((csg_vec2){to.x - meet.x, to.y - meet.y}, edge->along);
    if (behind >= -f->small && ahead >= -f->small)
        add_event(f, (event){time, a, b, c});
}

static void await_cuts_of(front *f, uint32_t a)
{
    f->work += f->corner_count / 8; /* to step over what is gone */
    for (uint32_t b = 0; b < f->corner_count && f->corners[a].is_reflex; b++)
        if (!f->corners[b].gone)
            await_cut(f, a, b);
}

static void await_cuts_by_all(front *f, uint32_t b)
{
    f->work += f->corner_count / 8;
    for (uint32_t a = 0; a < f->corner_count; a++)
        if (!f->corners[a].gone && f->corners[a].is_reflex)
            await_cut(f, a, b);
}

/* ---- what events do -------------------------------------------------------------------------- */

static uint32_t add_node(front *f, csg_vec2 at)
{
    csg_skeleton *s = f->out;
    void *data = s->nodes;
    if (f->no_memory || !csg_memory_reserve(f->memory, &data, &s->node_capacity, s->node_count + 1,
                                            sizeof *s->nodes)) {
        f->no_memory = true;
        return 0;
    }
    s->nodes = data;
    s->nodes[s->node_count] = (csg_skeleton_node){at, f->now};
    return (uint32_t)s->node_count++;
}

static void add_arc(front *f, csg_skeleton_arc arc)
{
    csg_skeleton *s = f->out;
    void *data = s->arcs;
    if (f->no_memory || !csg_memory_reserve(f->memory, &data, &s->arc_capacity, s->arc_count + 1,
                                            sizeof *s->arcs)) {
        f->no_memory = true;
        return;
    }
    s->arcs = data;
    s->arcs[s->arc_count++] = arc;
}

static uint32_t add_corner(front *f, corner c)
{
    void *data = f->corners;
    if (f->no_memory || !csg_memory_reserve(f->memory, &data, &f->corner_capacity,
                                            f->corner_count + 1, sizeof *f->corners)) {
        f->no_memory = true;
        return NONE;
    }
    f->corners = data;
    f->corners[f->corner_count] = c;
    return (uint32_t)f->corner_count++;
}

/* A corner arrives at a node. */
static void end_corner(front *f, uint32_t a, uint32_t node)
{
    corner *c = &f->corners[a];
    c->gone = true;
    add_arc(f, (csg_skeleton_arc){c->node, node, c->before, c->after});
}

/* From a node on, between two corners that stay. NONE: out of memory. */
static uint32_t begin_corner(front *f, uint32_t node, uint32_t before, uint32_t after,
                             uint32_t previous, uint32_t next)
{
    corner c = {.at = f->out->nodes[node].at,
                .time = f->now,
                .before = before,
                .after = after,
                .previous = previous,
                .next = next,
                .node = node};
    set_speed(f, &c);
    uint32_t made = add_corner(f, c);
    if (made != NONE) {
        f->corners[previous].next = made;
        f->corners[next].previous = made;
    }
    return made;
}

/* Two edges on top of each other: a ridge between the two corners. */
static void end_loop(front *f, uint32_t a, uint32_t b)
{
    csg_vec2 p = position(f, &f->corners[a], f->now), q = position(f, &f->corners[b], f->now);
    uint32_t left = f->corners[a].before, right = f->corners[a].after;
    uint32_t first = add_node(f, p);
    end_corner(f, a, first);
    if (csg_hypot(q.x - p.x, q.y - p.y) <= f->small) {
        end_corner(f, b, first);
        return;
    }
    uint32_t second = add_node(f, q);
    end_corner(f, b, second);
    add_arc(f, (csg_skeleton_arc){first, second, left, right});
}

/* What happens next at a new corner and at its edges. */
static void await(front *f, uint32_t a)
{
    const corner *c = &f->corners[a];
    if (c->gone)
        return;
    if (c->previous == c->next) {
        end_loop(f, a, c->next);
        return;
    }
    if (c->is_instant) {
        end_shorter(f, a);
        return;
    }
    uint32_t previous = c->previous;
    await_end(f, previous);
    await_end(f, a);
    await_cuts_of(f, a);
    await_cuts_by_all(f, previous);
    await_cuts_by_all(f, a);
}

static void end_edge(front *f, uint32_t a, uint32_t b)
{
    const corner p = f->corners[a], q = f->corners[b];
    bool by_first = q.is_instant || !p.is_instant;
    if (p.is_instant) /* it runs to the other end */
        by_first = false;
    uint32_t node = add_node(f, position(f, by_first ? &p : &q, f->now));
    end_corner(f, a, node);
    end_corner(f, b, node);
    if (f->no_memory)
        return;
    uint32_t made = begin_corner(f, node, p.before, q.after, p.previous, q.next);
    if (made != NONE)
        await(f, made);
}

static void cut_edge(front *f, const event *e)
{
    const corner v = f->corners[e->a];
    uint32_t edge = f->corners[e->b].after;
    uint32_t node = add_node(f, position(f, &v, f->now));
    end_corner(f, e->a, node);
    if (f->no_memory)
        return;
    uint32_t first = begin_corner(f, node, v.before, edge, v.previous, e->c);
    if (first == NONE)
        return;
    uint32_t second = begin_corner(f, node, edge, v.after, e->b, v.next);
    if (second == NONE)
        return;
    await(f, first);
    await(f, second);
}

static csgm_status run_events(front *f)
{
    size_t most_corners = 8 * f->corner_count; /* an edge ends once, a corner cuts once */
    while (f->heap_count && !f->no_memory && f->work <= most_work &&
           f->corner_count <= most_corners) {
        event e = take_event(f);
        if (f->corners[e.a].gone || f->corners[e.b].gone || f->corners[e.b].next != e.c)
            continue;
        f->now = fmax(f->now, e.time);
        if (e.a == e.b)
            end_edge(f, e.a, e.c);
        else
            cut_edge(f, &e);
    }
    if (f->no_memory)
        return CSGM_ERR_MEMORY;
    if (f->work > most_work)
        return CSGM_ERR_LIMIT;
    for (size_t i = 0; i < f->corner_count; i++)
        if (!f->corners[i].gone)
            return CSGM_ERR_UNSUPPORTED;
    return CSGM_OK;
}

/* ---- the outline ----------------------------------------------------------------------------- */

/* The point, from the second try on a little beside its place. */
static csg_vec2 near_point(const csg_outline *outline, size_t i, unsigned tries, double size)
{
    csg_vec2 p = outline->points[i];
    csg_random random = {i * 8 + tries};
    double most = 1e-8 * size * tries;
    p.x += csg_random_uniform(&random, -most, most);
    p.y += csg_random_uniform(&random, -most, most);
    return p;
}

/* The lines of all edges, a node and a corner at each point. */
static void begin(front *f, const csg_outline *outline, unsigned tries, double size)
{
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = first; i < end; i++) {
            csg_vec2 p = near_point(outline, i, tries, size);
            csg_vec2 q = near_point(outline, i + 1 < end ? i + 1 : first, tries, size);
            double length = csg_hypot(q.x - p.x, q.y - p.y);
            csg_vec2 along = {(q.x - p.x) / length, (q.y - p.y) / length};
            csg_vec2 inwards = {-along.y, along.x};
            f->lines[i] = (line){along, inwards, dot(inwards, p)};
        }
        for (size_t i = first; i < end && !f->no_memory; i++) {
            uint32_t before = (uint32_t)(i > first ? i - 1 : end - 1);
            uint32_t after = (uint32_t)(i + 1 < end ? i + 1 : first);
            corner c = {.at = near_point(outline, i, tries, size),
                        .before = before,
                        .after = (uint32_t)i,
                        .previous = before,
                        .next = after};
            c.node = add_node(f, outline->points[i]);
            set_speed(f, &c);
            add_corner(f, c);
        }
    }
    uint64_t reflex = 0;
    for (size_t i = 0; i < f->corner_count; i++)
        reflex += f->corners[i].is_reflex;
    if (reflex * outline->point_count > most_work)
        f->work = most_work + 1;
    for (uint32_t i = 0; i < outline->point_count && !f->no_memory && f->work <= most_work; i++) {
        if (f->corners[i].is_instant)
            end_shorter(f, i);
        await_end(f, i);
        await_cuts_of(f, i);
    }
}

static csgm_status try_to_make(const csg_outline *clean, csg_memory *memory, unsigned tries,
                               csg_skeleton *out)
{
    *out = (csg_skeleton){.memory = memory};
    size_t count = clean->point_count;
    csg_vec3 sides = csg_box_size(csg_outline_box(clean));
    double size = fmax(sides.x, sides.y);
    front f = {.memory = memory, .out = out, .small = 1e-11 * size};
    f.lines = csg_memory_alloc(memory, count * sizeof *f.lines);
    csgm_status status = CSGM_ERR_MEMORY;
    if (f.lines) {
        begin(&f, clean, tries, size);
        status = run_events(&f);
    }
    csg_memory_release(memory, f.lines, count * sizeof *f.lines);
    csg_memory_release(memory, f.corners, f.corner_capacity * sizeof *f.corners);
    csg_memory_release(memory, f.heap, f.heap_capacity * sizeof *f.heap);
    if (status != CSGM_OK)
        csg_skeleton_release(out);
    return status;
}

csgm_status csg_skeleton_make(const csg_outline *clean, csg_memory *memory, csg_skeleton *out)
{
    csgm_status status = CSGM_OK;
    *out = (csg_skeleton){.memory = memory};
    for (unsigned tries = 0; tries < MOST_TRIES && clean->point_count; tries++) {
        status = try_to_make(clean, memory, tries, out);
        if (status != CSGM_ERR_UNSUPPORTED)
            break;
    }
    return status;
}

void csg_skeleton_release(csg_skeleton *skeleton)
{
    csg_memory *memory = skeleton->memory;
    csg_memory_release(memory, skeleton->nodes, skeleton->node_capacity * sizeof *skeleton->nodes);
    csg_memory_release(memory, skeleton->arcs, skeleton->arc_capacity * sizeof *skeleton->arcs);
    *skeleton = (csg_skeleton){.memory = memory};
}
