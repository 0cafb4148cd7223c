/* SPDX-License-Identifier: MIT
 * What is in a mesh file: read and looked at where there is memory for that, else gone through in
 * runs, with the same answers to the bit.
 *
 * In runs, what happens at a vertex is found from its corners alone: each corner is written down
 * with the two vertices beside it, and in a vertex's list each edge appears as often as triangles
 * use it. A pass over the file writes down the corners of those vertices whose hashes fall into a
 * range; the ranges are chosen by a count of all hashes, so that the corners of each fit into
 * memory. Sets of triangles that edges join (union-find) are the only thing that is kept of all:
 * four bytes each.
 *
 * Closed manifolds, which most files are, take one pass, and in the order that meshes are made in
 * no memory but that of the border of what has been seen, and a bit for each vertex: they are
 * looked at as they are while they are made (mesh/figures).
 */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/sets.h"
#include "base/table.h"
#include "base/trace.h"
#include "io/format_table.h"
#include "io/formats.h"
#include "mesh/figures/figures.h"
#include "mesh/figures/measures.h"
#include "mesh/inspect.h"

/* A vertex: its number and zeros, or the bits of its place. */
typedef struct key {
    uint32_t word[3];
} key;

enum {
    HASH_BITS = 16, /* of the counts that ranges are chosen by */
    HASHES = 1 << HASH_BITS,
    NONE = UINT32_MAX,
    FEWEST_CORNERS = 1 << 12, /* that a pass can write down */
    WHOLE_SHARE = 4           /* a file read as a whole takes up to this many times its size */
};

typedef struct corner {
    key vertex, next, previous;
    uint32_t triangle; /* NONE: one that uses a vertex twice */
    uint32_t chained;  /* the corner before it in its chain; NONE */
} corner;

/* An edge from a vertex `to` another, as one of its corners has it; or a corner of the vertex `to`.
 */
typedef struct spoke {
    key to;
    uint32_t corner; /* of the pass, or in the vertex's list */
    bool leaves;     /* the triangle goes from the vertex to the other one */
} spoke;

typedef struct scan {
    csg_runs *runs;
    const csg_runs_kind *kind;
    bool by_place; /* vertices at one place are one */
    csgm_mesh_check *check;
    csg_box box; /* of what sound triangles use */
    uint64_t triangles, unsound, vertices, used, edges;
    uint64_t *counts;  /* corners of each hash */
    uint32_t *parents; /* of triangles (base/sets.h) */
    corner *corners;   /* of the pass */
    uint32_t *chains;  /* their heads, by hash */
    uint64_t corner_room, corner_count;
    uint64_t chain_count; /* a power of two */
    spoke *list;          /* corners of the chain at hand, */
    spoke *spokes;        /* edges of the vertex at hand, */
    uint32_t *fans;       /* and sets of its corners */
    size_t spoke_room, fan_room, list_room;
} scan;

/* ---- keys ------------------------------------------------------------------------- */

static key key_of(const scan *s, const csg_runs_triangle *t, int c)
{
    key k = {{0, 0, 0}};
    if (s->by_place)
        memcpy(k.word, t->at[c], sizeof k.word);
    else
        k.word[0] = t->vertex[c];
    return k;
}

static int compare_keys(const key *a, const key *b)
{
    for (int i = 0; i < 3; i++)
        if (a->word[i] != b->word[i])
            return a->word[i] < b->word[i] ? -1 : 1;
    return 0;
}

static uint64_t hash_of(const key *k)
{
    uint64_t hash = csg_hash_word(0, (uint64_t)k->word[0] << 32 | k->word[1]);
    return csg_hash_word(hash, k->word[2]) * 0x9E3779B97F4A7C15u;
}

static bool is_sound(const key k[3])
{
    return compare_keys(&k[0], &k[1]) != 0 && compare_keys(&k[1], &k[2]) != 0 &&
           compare_keys(&k[2], &k[0]) != 0;
}

/* ---- one pass --------------------------------------------------------------------- */

typedef csgm_status triangle_fn(scan *s, void *user, const csg_runs_triangle *triangle,
                                const key k[3]);

static csgm_status pass(scan *s, bool places, triangle_fn *visit, void *user)
{
    csg_runs_triangle triangle;
    bool is_there = true;
    csgm_status status = s->kind->rewind(s->runs);
    while (!status) {
        status = s->kind->next(s->runs, places || s->by_place, &triangle, &is_there);
        if (status || !is_there)
            return status;
        const key k[3] = {key_of(s, &triangle, 0), key_of(s, &triangle, 1),
                          key_of(s, &triangle, 2)};
        status = visit(s, user, &triangle, k);
        if (!status && !csg_read_has_time_for_step(&s->runs->clock))
            status = csg_read_why_late(&s->runs->clock);
    }
    return status;
}

static csg_vec3 place(const csg_runs_triangle *t, int c)
{
    return csg_vec3_from_floats(t->at[c]);
}

/* ---- the first pass: how many, and how large ----------------------------------------- */

static csgm_status count_triangle(scan *s, void *user, const csg_runs_triangle *t, const key k[3])
{
    (void)user;
    bool sound = is_sound(k);
    s->triangles++;
    s->unsound += !sound;
    for (int c = 0; c < 3 && sound; c++) {
        csg_vec3 p = place(t, c);
        s->box = csg_box_hull(s->box, (csg_box){p, p});
    }
    return s->triangles > UINT32_MAX / 3 ? csg_mesh_too_large(s->runs->context, s->triangles)
                                         : CSGM_OK;
}

static csgm_status count_hashes(scan *s, void *user, const csg_runs_triangle *t, const key k[3])
{
    (void)user;
    (void)t;
    for (int c = 0; c < 3; c++)
        s->counts[hash_of(&k[c]) >> (64 - HASH_BITS)]++;
    return CSGM_OK;
}

/* ---- the other passes: corners of some of the vertices ----------------------------------- */

typedef struct range {
    scan *scan;
    uint64_t first, end;         /* hashes */
    uint64_t triangle;           /* the number of the next one */
    csg_mesh_measures *measures; /* NULL: they have been taken */
} range;

static csgm_status write_down(scan *s, void *user, const csg_runs_triangle *t, const key k[3])
{
    range *in = user;
    bool sound = is_sound(k);
    uint32_t number = (uint32_t)in->triangle++;
    if (in->measures && sound)
        csg_mesh_measures_put(in->measures, t->at[0], t->at[1], t->at[2]);
    for (int c = 0; c < 3; c++) {
        uint64_t hash = hash_of(&k[c]), high = hash >> (64 - HASH_BITS);
        if (high < in->first || high >= in->end)
            continue;
        if (s->corner_count == s->corner_room)
            return csg_read_broken(&(csg_input){.context = s->runs->context, .path = s->runs->path},
                                   0, "the file has changed while it was read");
        uint32_t *head = &s->chains[(hash >> 16) & (s->chain_count - 1)];
        s->corners[s->corner_count] =
            (corner){k[c], k[(c + 1) % 3], k[(c + 2) % 3], sound ? number : NONE, *head};
        *head = (uint32_t)s->corner_count++;
    }
    return CSGM_OK;
}

/* ---- a vertex ------------------------------------------------------------------------- */

static int compare_spokes(const void *a, const void *b)
{
    const spoke *x = a, *y = b;
    int order = compare_keys(&x->to, &y->to);
    return order ? order : (x->corner > y->corner) - (x->corner < y->corner);
}

static void sort_spokes(spoke *spokes, size_t count)
{
    enum { INSERTION_SORT_MOST = 32 };
    if (count > INSERTION_SORT_MOST) {
        qsort(spokes, count, sizeof *spokes, compare_spokes);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        spoke one = spokes[i];
        size_t j = i;
        for (; j > 0 && compare_spokes(&spokes[j - 1], &one) > 0; j--)
            spokes[j] = spokes[j - 1];
        spokes[j] = one;
    }
}

/* The end of the run of one vertex that begins there. */
static size_t end_of_run(const spoke *spokes, size_t begin, size_t count)
{
    size_t end = begin + 1;
    while (end < count && !compare_keys(&spokes[begin].to, &spokes[end].to))
        end++;
    return end;
}

/* All uses of one edge at the vertex. Counted at one of its ends. */
static void close_edge(scan *s, const spoke *list, const spoke *spokes, size_t uses)
{
    const corner *at = &s->corners[list[spokes[0].corner].corner];
    bool counts = compare_keys(&at->vertex, &spokes[0].to) < 0;
    size_t leaving = 0;
    for (size_t i = 0; i < uses; i++) {
        leaving += spokes[i].leaves;
        csg_sets_join(s->fans, spokes[0].corner, spokes[i].corner);
        if (counts)
            csg_sets_join(s->parents, at->triangle,
                          s->corners[list[spokes[i].corner].corner].triangle);
    }
    if (!counts)
        return;
    s->edges++;
    s->check->boundary_edges += uses == 1;
    s->check->nonmanifold_edges += uses > 2;
    s->check->misoriented_edges += uses == 2 && leaving != 1;
}

static bool room_for(scan *s, void *array, size_t *room, size_t needed, size_t bytes)
{
    void *data;
    memcpy(&data, array, sizeof data);
    if (!csg_memory_reserve(&s->runs->context->memory, &data, room, needed, bytes))
        return false;
    memcpy(array, &data, sizeof data);
    return true;
}

/* The corners of one vertex. false: out of memory. */
static bool close_vertex(scan *s, const spoke *list, size_t count)
{
    size_t spokes = 0, fans = 0;
    s->vertices++;
    if (!room_for(s, &s->spokes, &s->spoke_room, 2 * count, sizeof *s->spokes) ||
        !room_for(s, &s->fans, &s->fan_room, count, sizeof *s->fans))
        return false;
    csg_sets_init(s->fans, count);
    for (size_t i = 0; i < count; i++) {
        const corner *c = &s->corners[list[i].corner];
        if (c->triangle == NONE)
            continue;
        s->spokes[spokes++] = (spoke){c->next, (uint32_t)i, true};
        s->spokes[spokes++] = (spoke){c->previous, (uint32_t)i, false};
    }
    sort_spokes(s->spokes, spokes);
    for (size_t begin = 0, end; begin < spokes; begin = end) {
        end = end_of_run(s->spokes, begin, spokes);
        close_edge(s, list, s->spokes + begin, end - begin);
    }
    for (size_t i = 0; i < count; i++)
        fans += s->corners[list[i].corner].triangle != NONE && s->fans[i] == i;
    s->used += spokes > 0;
    s->check->nonmanifold_vertices += fans > 1;
    return true;
}

static bool close_chain(scan *s, uint32_t head)
{
    size_t count = 0;
    for (uint32_t c = head; c != NONE; c = s->corners[c].chained) {
        if (!room_for(s, &s->list, &s->list_room, count + 1, sizeof *s->list))
            return false;
        s->list[count++] = (spoke){s->corners[c].vertex, c, false};
    }
    sort_spokes(s->list, count);
    for (size_t begin = 0, end; begin < count; begin = end) {
        end = end_of_run(s->list, begin, count);
        if (!close_vertex(s, s->list + begin, end - begin))
            return false;
    }
    return true;
}

static csgm_status close_vertices(scan *s)
{
    for (uint64_t i = 0; i < s->chain_count; i++) {
        if (!close_chain(s, s->chains[i]))
            return csg_context_no_memory(s->runs->context);
        if (!csg_read_has_time_for_step(&s->runs->clock))
            return csg_read_why_late(&s->runs->clock);
    }
    return CSGM_OK;
}

/* ---- closed manifolds ------------------------------------------------------------------ */

enum { RUN_TRIANGLES = 1 << 11 };

/* Triangles on their way to the figures, some at a time. */
typedef struct gathering {
    csg_mesh_receiver to;
    uint64_t first, count; /* triangles handed on, and at hand */
    uint64_t owned;        /* vertices of runs before */
    uint64_t all_vertices;
    uint8_t *is_used; /* vertices from `owned` on */
    uint32_t *vertices;
    float *places;
} gathering;

static csgm_status begin_nothing(void *user, const csg_mesh_counts *counts)
{
    (void)user;
    (void)counts;
    return CSGM_OK;
}

static bool put_nothing(void *user, const csg_mesh_run *run)
{
    (void)user;
    (void)run;
    return true;
}

/* Behind the vertices that are the run's own: of those that come next in the file, as many as half
 * of are used. Where vertices and triangles stand in one order, as meshes are made, most links are
 * closed in a run then, and do not come to the seam. */
static uint64_t end_of_own(gathering *g)
{
    uint64_t left = g->all_vertices - g->owned, most = 3 * g->count, used = 0, end = 0;
    most = most < left ? most : left;
    memset(g->is_used, 0, RUN_TRIANGLES * 3);
    for (uint64_t i = 0; i < 3 * g->count; i++)
        if (g->vertices[i] - g->owned < most)
            g->is_used[g->vertices[i] - g->owned] = 1;
    for (uint64_t i = 0; i < most; i++) {
        used += g->is_used[i];
        end = 2 * used > i ? i + 1 : end;
    }
    return g->owned + end;
}

static void hand_on(gathering *g)
{
    uint64_t end = end_of_own(g);
    const csg_mesh_run run = {.first_vertex = g->owned,
                              .vertex_count = end - g->owned,
                              .first_triangle = g->first,
                              .triangle_count = g->count,
                              .corners = g->places,
                              .joined = g->vertices};
    g->to.put(g->to.user, &run);
    g->owned = end;
    g->first += g->count;
    g->count = 0;
}

static csgm_status gather(scan *s, void *user, const csg_runs_triangle *t, const key k[3])
{
    gathering *g = user;
    (void)s;
    (void)k;
    for (size_t c = 0; c < 3; c++) {
        g->vertices[3 * g->count + c] = t->vertex[c];
        memcpy(g->places + 9 * g->count + 3 * c, t->at[c], sizeof t->at[c]);
    }
    if (++g->count == RUN_TRIANGLES)
        hand_on(g);
    return CSGM_OK;
}

static csgm_status look_at_manifold(scan *s, csg_mesh_figures *figures, gathering *g, bool *is_one)
{
    const csg_mesh_counts counts = {.vertex_count = s->runs->vertex_count,
                                    .triangle_count = s->triangles,
                                    .origin = s->runs->origin,
                                    .bounds = s->box};
    g->to = csg_mesh_figures_receiver(figures);
    csgm_status status = g->to.begin(g->to.user, &counts);
    if (!status)
        status = pass(s, true, gather, g);
    if (!status && g->count)
        hand_on(g);
    *is_one = !status && csg_mesh_figures_get(figures, s->check);
    return status;
}

/* *is_one: it is a closed manifold, whose figures are in s->check; else, also where there is too
 * little memory, nothing has changed. */
static csgm_status try_manifold(scan *s, bool *is_one)
{
    csg_memory *memory = &s->runs->context->memory;
    const csg_mesh_receiver nobody = {.begin = begin_nothing, .put = put_nothing};
    const size_t vertex_bytes = RUN_TRIANGLES * 3 * sizeof(uint32_t);
    const size_t place_bytes = RUN_TRIANGLES * 9 * sizeof(float);
    gathering g = {.all_vertices = s->runs->vertex_count,
                   .is_used = csg_memory_alloc(memory, RUN_TRIANGLES * 3),
                   .vertices = csg_memory_alloc(memory, vertex_bytes),
                   .places = csg_memory_alloc(memory, place_bytes)};
    csg_mesh_figures *figures = NULL;
    csgm_status status = CSGM_OK;
    *is_one = false;
    if (g.is_used && g.vertices && g.places &&
        csg_mesh_figures_make(s->runs->context, &nobody, 1, &figures))
        status = look_at_manifold(s, figures, &g, is_one);
    if (figures)
        csg_mesh_figures_destroy(figures);
    csg_memory_release(memory, g.is_used, RUN_TRIANGLES * 3);
    csg_memory_release(memory, g.vertices, vertex_bytes);
    csg_memory_release(memory, g.places, place_bytes);
    return status;
}

/* ---- all of it ------------------------------------------------------------------------- */

static bool take_counts(scan *s)
{
    s->counts = csg_memory_alloc(&s->runs->context->memory, HASHES * sizeof *s->counts);
    if (s->counts)
        memset(s->counts, 0, HASHES * sizeof *s->counts);
    return s->counts != NULL;
}

/* Room for the triangles' sets, and for as many corners as the rest allows, up to all. */
static bool take_arrays(scan *s)
{
    csg_memory *memory = &s->runs->context->memory;
    uint64_t all = 3 * s->triangles, room = all;
    if (s->triangles)
        s->parents = csg_memory_alloc(memory, (size_t)s->triangles * sizeof *s->parents);
    if (s->triangles && !s->parents)
        return false;
    uint64_t left = csg_memory_left(memory), each = sizeof *s->corners + sizeof *s->chains;
    if (left && left / 8 * 7 / each < room) /* an eighth is for lists of single vertices */
        room = left / 8 * 7 / each;
    if (room < FEWEST_CORNERS)
        room = FEWEST_CORNERS;
    for (s->chain_count = 1; 2 * s->chain_count <= room;)
        s->chain_count *= 2;
    s->corner_room = room;
    s->corners = csg_memory_alloc(memory, (size_t)room * sizeof *s->corners);
    s->chains = csg_memory_alloc(memory, (size_t)s->chain_count * sizeof *s->chains);
    return s->corners && s->chains;
}

static void release_arrays(scan *s)
{
    csg_memory *memory = &s->runs->context->memory;
    csg_memory_release(memory, s->counts, HASHES * sizeof *s->counts);
    csg_memory_release(memory, s->parents, (size_t)s->triangles * sizeof *s->parents);
    csg_memory_release(memory, s->corners, (size_t)s->corner_room * sizeof *s->corners);
    csg_memory_release(memory, s->chains, (size_t)s->chain_count * sizeof *s->chains);
    csg_memory_release(memory, s->spokes, s->spoke_room * sizeof *s->spokes);
    csg_memory_release(memory, s->fans, s->fan_room * sizeof *s->fans);
    csg_memory_release(memory, s->list, s->list_room * sizeof *s->list);
}

/* The end of the hashes from `first` on whose corners have room together; `first` itself: those of
 * one hash are too many. */
static uint64_t end_of_range(const scan *s, uint64_t first)
{
    uint64_t end = first, sum = 0;
    while (end < HASHES && sum + s->counts[end] <= s->corner_room)
        sum += s->counts[end++];
    return end;
}

static csgm_status close_ranges(scan *s, csg_mesh_measures *measures)
{
    csgm_status status = CSGM_OK;
    csg_sets_init(s->parents, (size_t)s->triangles);
    for (uint64_t first = 0; first < HASHES && !status;) {
        range in = {.scan = s, .first = first, .end = end_of_range(s, first)};
        in.measures = first ? NULL : measures;
        if (in.end == first)
            return csg_context_no_memory(s->runs->context);
        s->corner_count = 0;
        memset(s->chains, 0xFF, (size_t)s->chain_count * sizeof *s->chains);
        status = pass(s, in.measures != NULL, write_down, &in);
        if (!status)
            status = close_vertices(s);
        first = in.end;
    }
    return status;
}

static void count_components(scan *s)
{
    uint64_t roots = 0;
    for (uint64_t t = 0; t < s->triangles; t++)
        roots += s->parents[t] == t;
    s->check->components = roots - s->unsound; /* each of those is alone */
}

static void fill_in(const scan *s, csgm_file_figures *out)
{
    out->vertices = s->runs->names_vertices ? s->runs->vertex_count : s->vertices;
    out->triangles = s->triangles;
    out->has_normals = s->runs->has_normals;
    out->has_colors = s->runs->has_colors;
    out->check = *s->check;
}

/* With vertices by number or by place. */
static csgm_status scan_once(csg_runs *runs, const csg_runs_kind *kind, bool by_place,
                             csgm_file_figures *out)
{
    csgm_mesh_check check = {0};
    scan s = {.runs = runs, .kind = kind, .by_place = by_place, .check = &check};
    s.box = csg_box_empty();
    csgm_status status = pass(&s, true, count_triangle, NULL);
    bool is_manifold = false;
    if (!status && !by_place && s.triangles && !s.unsound)
        status = try_manifold(&s, &is_manifold);
    if (!status && is_manifold) {
        fill_in(&s, out);
        return status;
    }
    csg_mesh_measures measures = csg_mesh_measures_begin(s.box);
    if (!status && !take_counts(&s))
        status = csg_context_no_memory(runs->context);
    if (!status)
        status = pass(&s, false, count_hashes, NULL);
    if (!status && !take_arrays(&s))
        status = csg_context_no_memory(runs->context);
    if (!status)
        status = close_ranges(&s, &measures);
    if (!status) {
        count_components(&s);
        csg_mesh_measures_end(&measures, s.box, runs->origin, &check);
        check.degenerate_triangles = s.unsound;
        check.unused_vertices = (runs->names_vertices ? runs->vertex_count : s.vertices) - s.used;
        check.euler = (int64_t)s.used - (int64_t)s.edges + (int64_t)(s.triangles - s.unsound);
        check.genus = (int64_t)check.components - check.euler / 2;
        fill_in(&s, out);
    }
    release_arrays(&s);
    return status;
}

/* As csg_mesh_inspect: what is open along creases is looked at by place, too. */
static csgm_status scan_runs(csg_runs *runs, const csg_runs_kind *kind, csgm_file_figures *out)
{
    csgm_status status = scan_once(runs, kind, !runs->names_vertices, out);
    if (!status && runs->names_vertices && out->check.boundary_edges) {
        csgm_file_figures welded = *out;
        status = scan_once(runs, kind, true, &welded);
        if (!status && welded.check.boundary_edges < out->check.boundary_edges) {
            welded.check.unused_vertices = out->check.unused_vertices;
            *out = welded;
        }
    }
    return status;
}

static csgm_status inspect_runs(csgm_context *context, const char *path, int fd, uint64_t size,
                                const csg_runs_kind *kind, csgm_file_figures *out)
{
    csg_memory *memory = &context->memory;
    csg_runs runs = {.context = context, .path = path, .fd = fd, .size_bytes = size};
    csgm_status status;
    csg_read_clock_start(&runs.clock, context, 0);
    runs.cache_bytes = csg_memory_left(memory) / 16; /* corners want the rest */
    runs.window = csg_memory_alloc(memory, CSG_RUNS_WINDOW_BYTES);
    runs.state = csg_memory_alloc(memory, kind->state_bytes);
    if (runs.window && runs.state) {
        memset(runs.state, 0, kind->state_bytes);
        status = kind->begin(&runs);
        if (!status)
            status = scan_runs(&runs, kind, out);
        if (kind->end)
            kind->end(&runs);
    } else {
        status = csg_context_no_memory(context);
    }
    csg_memory_release(memory, runs.window, CSG_RUNS_WINDOW_BYTES);
    csg_memory_release(memory, runs.state, kind->state_bytes);
    return status;
}

static csgm_status inspect_whole(csgm_context *context, const char *path, csgm_format format,
                                 csgm_file_figures *out)
{
    csgm_mesh *mesh;
    double started_s = csg_clock_now_s(); /* one time limit for both */
    csgm_status status = csg_io_read(context, path, format, &mesh);
    if (status)
        return status;
    csgm_mesh_view view = csg_mesh_view(mesh);
    out->vertices = view.vertex_count;
    out->triangles = view.triangle_count;
    out->has_normals = view.normals != NULL;
    out->has_colors = view.colors != NULL;
    status = csg_mesh_inspect(context, &view, started_s, &out->check);
    csg_mesh_destroy(mesh);
    return status;
}

csgm_status csg_io_inspect(csgm_context *context, const char *path, csgm_format format,
                           csgm_file_figures *out)
{
    CSG_ZONE(context, "look at file");
    const csg_format_row *row =
        csg_format_find(format == CSGM_FORMAT_AUTO ? csg_format_from_path(path) : format);
    uint64_t left = csg_memory_left(&context->memory);
    csgm_status status = CSGM_ERR_UNSUPPORTED;
    struct stat state;
    int fd = row && row->runs && left ? open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY) : -1;
    if (fd >= 0 && fstat(fd, &state) == 0 && S_ISREG(state.st_mode) &&
        (uint64_t)state.st_size > left / WHOLE_SHARE) {
        csg_context_tell_file(context, path, true);
        status = inspect_runs(context, path, fd, (uint64_t)state.st_size, row->runs, out);
    }
    if (fd >= 0)
        close(fd);
    return status == CSGM_ERR_UNSUPPORTED ? inspect_whole(context, path, format, out) : status;
}
