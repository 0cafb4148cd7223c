/* SPDX-License-Identifier: MIT
 * What is found of each run by itself, and what is left to the seam; see figures.h.
 *
 * Vertices of a run have local numbers: those that it brings along in their order, then those of
 * other runs as they come.
 */
#include "mesh/figures/figures.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include "base/sets.h"
#include "base/table.h"
#include "base/trace.h"
#include "mesh/figures/seam.h"

enum { WORD_BITS = 64 };

/* One thread's room, and the run at hand. */
typedef struct worker {
    csg_mesh_measures measures;
    csg_box box;
    uint64_t components;   /* that lie in one run */
    uint32_t *local;       /* numbers of the run's corners */
    uint32_t *begins;      /* of each vertex in arcs, and their end */
    csg_link_arc *arcs;    /* of each vertex's link, in local numbers */
    uint32_t *pieces;      /* of each vertex: sets (base/sets.h) */
    uint32_t *number;      /* of a set's root: its piece on the seam, or NONE */
    uint32_t *foreign;     /* vertices of other runs, in the order of their local numbers */
    uint32_t *open;        /* local numbers of own vertices whose links are not closed */
    uint32_t *others;      /* triangles that have vertices of other runs */
    csg_link_mark *marks;  /* one for each vertex */
    csg_seam_vertex **met; /* where those vertices are on the seam */
    csg_table table;       /* of foreign */
    size_t local_room, begin_room, arc_room, piece_room, number_room, foreign_room, open_room;
    size_t other_room, met_room, mark_room;
    size_t own_count, foreign_count, open_count, other_count, corner_count;
} worker;

struct csg_mesh_figures {
    csgm_context *context;
    csg_mesh_receiver to;
    csg_mesh_counts counts;
    worker *workers;
    uint32_t worker_count;
    /* A bit for each vertex: its link is closed; of a mesh with copies of vertices: a triangle uses
     * it. */
    atomic_uint_fast64_t *closed, *used;
    size_t word_count;
    atomic_bool is_irregular, is_without_memory;
    pthread_mutex_t lock; /* of the seam */
    csg_seam seam;
};

/* ---- numbers ----------------------------------------------------------------------------- */

static uint64_t hash_of_foreign(const void *entries, uint32_t number)
{
    return ((const uint32_t *)entries)[number];
}

/* The local number of another run's vertex. NONE: out of memory. */
static uint32_t number_foreign(csg_memory *memory, worker *w, uint32_t vertex)
{
    size_t slot;
    void *foreign = w->foreign;
    if (!csg_table_reserve(&w->table, w->foreign_count + 1, hash_of_foreign, w->foreign) ||
        !csg_memory_reserve(memory, &foreign, &w->foreign_room, w->foreign_count + 1,
                            sizeof *w->foreign))
        return CSG_SEAM_NONE;
    w->foreign = foreign;
    uint32_t found = csg_table_first(&w->table, vertex, &slot);
    while (found != CSG_TABLE_NONE && w->foreign[found] != vertex)
        found = csg_table_next(&w->table, &slot);
    if (found == CSG_TABLE_NONE) {
        found = (uint32_t)w->foreign_count++;
        w->foreign[found] = vertex;
        csg_table_put(&w->table, slot, found);
    }
    return (uint32_t)w->own_count + found;
}

static bool number_corners(csg_memory *memory, worker *w, const csg_mesh_run *run)
{
    const uint32_t first = (uint32_t)run->first_vertex, own = (uint32_t)w->own_count;
    w->foreign_count = 0;
    if (w->table.size)
        memset(w->table.slots, 0xFF, w->table.size * sizeof *w->table.slots);
    for (size_t i = 0; i < w->corner_count; i++) {
        uint32_t at = run->joined[i] - first;
        if (at >= own) {
            at = number_foreign(memory, w, run->joined[i]);
            if (at == CSG_SEAM_NONE)
                return false;
        }
        w->local[i] = at;
    }
    return true;
}

static uint32_t global_of(const worker *w, const csg_mesh_run *run, uint32_t local)
{
    return local < w->own_count ? (uint32_t)run->first_vertex + local
                                : w->foreign[local - w->own_count];
}

static size_t local_count(const worker *w)
{
    return w->own_count + w->foreign_count;
}

/* ---- links ---------------------------------------------------------------------------------- */

/* Counting sort of arcs by their vertices: begins[v + 1] is where those of v end. Pieces begin as
 * the least vertex around each. False: a triangle uses a vertex twice. */
static bool sort_arcs(worker *w)
{
    size_t count = local_count(w);
    uint32_t *piece = w->pieces;
    bool is_sound = true;
    csg_sets_init(piece, count);
    memset(w->begins, 0, (count + 2) * sizeof *w->begins);
    for (size_t i = 0; i < w->corner_count; i++)
        w->begins[w->local[i] + 2]++;
    for (size_t v = 2; v < count + 2; v++)
        w->begins[v] += w->begins[v - 1];
    for (size_t i = 0; i < w->corner_count; i += 3) {
        uint32_t a = w->local[i], b = w->local[i + 1], c = w->local[i + 2];
        is_sound &= a != b && b != c && c != a;
        w->arcs[w->begins[a + 1]++] = (csg_link_arc){b, c};
        w->arcs[w->begins[b + 1]++] = (csg_link_arc){c, a};
        w->arcs[w->begins[c + 1]++] = (csg_link_arc){a, b};
        uint32_t least = a < b ? a : b;
        least = least < c ? least : c;
        piece[a] = least < piece[a] ? least : piece[a];
        piece[b] = least < piece[b] ? least : piece[b];
        piece[c] = least < piece[c] ? least : piece[c];
    }
    return is_sound;
}

/* Notes which links are closed. A vertex that the run brings and does not use is open, too: others
 * want its place. (Of a mesh with copies of vertices those are never asked for.) */
static void close_links(csg_mesh_figures *f, worker *w, const csg_mesh_run *run)
{
    uint64_t bits = 0, at = run->first_vertex;
    memset(w->marks, 0xFF, local_count(w) * sizeof *w->marks); /* of nobody */
    w->open_count = 0;
    for (size_t v = 0; v < w->own_count; v++, at++) {
        size_t count = w->begins[v + 1] - w->begins[v];
        if (count && csg_link_is_circle_of((uint32_t)v, w->arcs + w->begins[v], count, w->marks))
            bits |= (uint64_t)1 << at % WORD_BITS;
        else if (count || run->joined == run->indices)
            w->open[w->open_count++] = (uint32_t)v;
        if (at % WORD_BITS == WORD_BITS - 1 || v + 1 == w->own_count) {
            uint64_t before =
                atomic_fetch_or_explicit(&f->closed[at / WORD_BITS], bits, memory_order_relaxed);
            if (before & bits) /* another fan of it was closed on the seam */
                atomic_store(&f->is_irregular, true);
            bits = 0;
        }
    }
}

static bool has_bit(const atomic_uint_fast64_t *words, uint64_t i)
{
    return atomic_load_explicit(&words[i / WORD_BITS], memory_order_relaxed) >> i % WORD_BITS & 1;
}

static void set_bit(atomic_uint_fast64_t *words, uint64_t i)
{
    if (!has_bit(words, i))
        atomic_fetch_or_explicit(&words[i / WORD_BITS], (uint64_t)1 << i % WORD_BITS,
                                 memory_order_relaxed);
}

/* ---- pieces --------------------------------------------------------------------------------- */

/* Each vertex goes to the least one around it, down to one that is the least itself: a basin. Then
 * basins are joined, where triangles lie across them. */
static void find_pieces(worker *w)
{
    uint32_t *piece = w->pieces;
    size_t count = local_count(w);
    for (size_t v = 0; v < count; v++)
        piece[v] = piece[piece[v]];
    for (size_t i = 0; i < w->corner_count; i += 3) {
        uint32_t a = w->local[i], b = w->local[i + 1], c = w->local[i + 2];
        if (piece[a] != piece[b])
            csg_sets_join(piece, a, b);
        if (piece[a] != piece[c])
            csg_sets_join(piece, a, c);
    }
    for (size_t v = 0; v < count; v++)
        piece[v] = piece[piece[v]];
}

/* Gives numbers on the seam to the pieces that reach it. False: out of memory. */
static bool number_pieces(csg_seam *seam, worker *w)
{
    size_t own = w->own_count, count = local_count(w);
    uint32_t numbered = 0;
    for (size_t v = 0; v < count; v++)
        w->number[v] = CSG_SEAM_NONE;
    for (size_t i = 0; i < w->open_count + w->foreign_count; i++) {
        size_t v = i < w->open_count ? w->open[i] : own + i - w->open_count;
        uint32_t *number = &w->number[w->pieces[v]];
        if (*number == CSG_SEAM_NONE && w->begins[v] != w->begins[v + 1])
            *number = numbered++;
    }
    uint32_t first = csg_seam_add_pieces(seam, numbered);
    if (first == CSG_SEAM_NONE)
        return false;
    for (size_t v = 0; v < count; v++) {
        if (w->pieces[v] != v || w->begins[v] == w->begins[v + 1])
            continue;
        if (w->number[v] == CSG_SEAM_NONE)
            w->components++;
        else
            w->number[v] += first;
    }
    return true;
}

/* ---- measures ------------------------------------------------------------------------------- */

/* With so many points more. */
static csg_box box_of(csg_box box, const float *at, size_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++, at += 3)
        for (int c = 0; c < 3; c++) {
            low[c] = at[c] < low[c] ? at[c] : low[c];
            high[c] = at[c] > high[c] ? at[c] : high[c];
        }
    return csg_box_hull(box, (csg_box){csg_vec3_from_floats(low), csg_vec3_from_floats(high)});
}

/* Of loose triangles. */
static void measure_corners(worker *w, const csg_mesh_run *run)
{
    const float *at = run->corners;
    for (size_t i = 0; i < w->corner_count; i += 3, at += 9)
        csg_mesh_measures_put(&w->measures, at, at + 3, at + 6);
    if (w->corner_count)
        w->box = box_of(w->box, run->corners, w->corner_count);
}

/* Of triangles whose vertices are all the run's own. */
static void measure_own(worker *w, const csg_mesh_run *run)
{
    const uint32_t own = (uint32_t)w->own_count;
    w->other_count = 0;
    if (w->own_count)
        w->box = box_of(w->box, run->positions, w->own_count);
    for (size_t i = 0; i < w->corner_count; i += 3) {
        uint32_t a = w->local[i], b = w->local[i + 1], c = w->local[i + 2];
        if (a < own && b < own && c < own)
            csg_mesh_measures_put(&w->measures, run->positions + 3 * (size_t)a,
                                  run->positions + 3 * (size_t)b, run->positions + 3 * (size_t)c);
        else
            w->others[w->other_count++] = (uint32_t)(i / 3);
    }
}

/* ---- the seam --------------------------------------------------------------------------------- */

/* The i-th of the run's vertices on the seam: its open ones, then those of others. */
static uint32_t on_seam(const worker *w, size_t i)
{
    return i < w->open_count ? w->open[i] : (uint32_t)(w->own_count + i - w->open_count);
}

/* A vertex with what this run has of its link. */
static void meet_vertex(csg_mesh_figures *f, worker *w, const csg_mesh_run *run, uint32_t local)
{
    uint32_t vertex = global_of(w, run, local);
    bool is_own = local < w->own_count;
    const float *at = is_own && run->positions ? run->positions + 3 * (size_t)local : NULL;
    if (w->begins[local] != w->begins[local + 1] && has_bit(f->closed, vertex))
        atomic_store(&f->is_irregular, true);
    csg_seam_vertex *met = csg_seam_meet(&f->seam, vertex, w->number[w->pieces[local]], at);
    for (size_t i = w->begins[local]; i < w->begins[local + 1]; i++) {
        csg_link_arc arc = {global_of(w, run, w->arcs[i].from), global_of(w, run, w->arcs[i].to)};
        csg_seam_add_arc(&f->seam, met, arc);
    }
    if (is_own)
        csg_seam_settle(&f->seam, met, &w->measures);
    else
        w->met[local - w->own_count] = met;
}

/* Triangles with vertices of other runs. */
static bool measure_others(csg_seam *seam, worker *w, const csg_mesh_run *run)
{
    for (size_t i = 0; i < w->other_count; i++) {
        const uint32_t *v = w->local + 3 * (size_t)w->others[i];
        csg_seam_vertex *vertices[3];
        float at[9] = {0};
        for (int c = 0; c < 3; c++) {
            bool is_own = v[c] < w->own_count;
            vertices[c] = is_own ? NULL : w->met[v[c] - w->own_count];
            if (is_own)
                memcpy(at + 3 * c, run->positions + 3 * (size_t)v[c], 3 * sizeof(float));
        }
        if (!csg_seam_add_triangle(seam, vertices, at, &w->measures))
            return false;
    }
    return true;
}

/* False: out of memory. */
static bool sew(csg_mesh_figures *f, worker *w, const csg_mesh_run *run)
{
    csg_seam *seam = &f->seam;
    size_t count = w->open_count + w->foreign_count, arcs = 0;
    for (size_t i = 0; i < count; i++)
        arcs += w->begins[on_seam(w, i) + 1] - w->begins[on_seam(w, i)];
    if (!number_pieces(seam, w) || !csg_seam_reserve(seam, count, arcs))
        return false;
    for (size_t i = 0; i < count; i++)
        meet_vertex(f, w, run, on_seam(w, i));
    if (!run->corners && !measure_others(seam, w, run))
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t vertex = global_of(w, run, on_seam(w, i));
        bool is_closed;
        if (!csg_seam_close(seam, vertex, &is_closed))
            return false;
        if (is_closed)
            set_bit(f->closed, vertex);
    }
    return true;
}

/* ---- runs ------------------------------------------------------------------------------------- */

static bool reserve(csg_memory *memory, void *slot, size_t *room, size_t count, size_t bytes)
{
    void *data;
    memcpy(&data, slot, sizeof data);
    if (!csg_memory_reserve(memory, &data, room, count, bytes))
        return false;
    memcpy(slot, &data, sizeof data);
    return true;
}

/* Whether a run's room leaves several times as much of the memory limit to those who make and write
 * the mesh, who would have to end without it. */
static bool leaves_enough(csg_memory *memory, const csg_mesh_run *run)
{
    enum { BYTES_PER_CORNER = 4 + 8 + 4, BYTES_PER_VERTEX = 28, TIMES = 4 };
    return csg_memory_allows(memory, TIMES * (3 * run->triangle_count * BYTES_PER_CORNER +
                                              run->vertex_count * BYTES_PER_VERTEX));
}

static bool reserve_for_corners(csg_memory *memory, worker *w)
{
    return reserve(memory, &w->local, &w->local_room, w->corner_count, sizeof *w->local) &&
           reserve(memory, &w->arcs, &w->arc_room, w->corner_count, sizeof *w->arcs) &&
           reserve(memory, &w->open, &w->open_room, w->own_count, sizeof *w->open) &&
           reserve(memory, &w->others, &w->other_room, w->corner_count / 3, sizeof *w->others);
}

static bool reserve_for_vertices(csg_memory *memory, worker *w)
{
    size_t count = local_count(w);
    return reserve(memory, &w->begins, &w->begin_room, count + 2, sizeof *w->begins) &&
           reserve(memory, &w->pieces, &w->piece_room, count, sizeof *w->pieces) &&
           reserve(memory, &w->number, &w->number_room, count, sizeof *w->number) &&
           reserve(memory, &w->marks, &w->mark_room, count, sizeof *w->marks) &&
           reserve(memory, &w->met, &w->met_room, w->foreign_count, sizeof *w->met);
}

static void release_worker(csg_memory *memory, worker *w)
{
    csg_memory_release(memory, w->local, w->local_room * sizeof *w->local);
    csg_memory_release(memory, w->begins, w->begin_room * sizeof *w->begins);
    csg_memory_release(memory, w->arcs, w->arc_room * sizeof *w->arcs);
    csg_memory_release(memory, w->pieces, w->piece_room * sizeof *w->pieces);
    csg_memory_release(memory, w->number, w->number_room * sizeof *w->number);
    csg_memory_release(memory, w->foreign, w->foreign_room * sizeof *w->foreign);
    csg_memory_release(memory, w->open, w->open_room * sizeof *w->open);
    csg_memory_release(memory, w->others, w->other_room * sizeof *w->others);
    csg_memory_release(memory, w->marks, w->mark_room * sizeof *w->marks);
    csg_memory_release(memory, w->met, w->met_room * sizeof *w->met);
    csg_table_release(&w->table);
    *w = (worker){.table = w->table};
}

/* False: out of memory. */
static bool look_at_run(csg_mesh_figures *f, worker *w, const csg_mesh_run *run)
{
    csg_memory *memory = &f->context->memory;
    w->own_count = (size_t)run->vertex_count;
    w->corner_count = 3 * (size_t)run->triangle_count;
    if (!leaves_enough(memory, run) || !reserve_for_corners(memory, w) ||
        !number_corners(memory, w, run) || !reserve_for_vertices(memory, w))
        return false;
    if (!sort_arcs(w)) {
        atomic_store(&f->is_irregular, true);
        return true;
    }
    close_links(f, w, run);
    find_pieces(w);
    if (run->corners)
        measure_corners(w, run);
    else
        measure_own(w, run);
    for (size_t i = 0; i < w->corner_count && f->used && run->indices; i++)
        set_bit(f->used, run->indices[i]);
    pthread_mutex_lock(&f->lock);
    bool is_sewn = sew(f, w, run);
    pthread_mutex_unlock(&f->lock);
    return is_sewn;
}

static bool put_run(void *user, const csg_mesh_run *run)
{
    csg_mesh_figures *f = user;
    if (!atomic_load(&f->is_irregular) && !atomic_load(&f->is_without_memory) &&
        !look_at_run(f, &f->workers[run->worker], run)) {
        atomic_store(&f->is_without_memory, true);
        release_worker(&f->context->memory, &f->workers[run->worker]);
    }
    return f->to.put(f->to.user, run);
}

static atomic_uint_fast64_t *take_bits(csg_mesh_figures *f)
{
    atomic_uint_fast64_t *bits =
        csg_memory_alloc(&f->context->memory, f->word_count * sizeof *bits);
    for (size_t i = 0; bits && i < f->word_count; i++)
        atomic_init(&bits[i], 0);
    return bits;
}

static csgm_status begin_runs(void *user, const csg_mesh_counts *counts)
{
    csg_mesh_figures *f = user;
    f->counts = *counts;
    f->word_count = (size_t)(counts->vertex_count / WORD_BITS + 1);
    f->closed = take_bits(f);
    if (counts->split)
        f->used = take_bits(f);
    if (!f->closed || (counts->split && !f->used))
        atomic_store(&f->is_without_memory, true);
    for (uint32_t i = 0; i < f->worker_count; i++) {
        f->workers[i].measures = csg_mesh_measures_begin(counts->bounds);
        f->workers[i].box = csg_box_empty();
    }
    return f->to.begin(f->to.user, counts);
}

/* ---- all of them -------------------------------------------------------------------------------- */

bool csg_mesh_figures_make(csgm_context *context, const csg_mesh_receiver *to, uint32_t workers,
                           csg_mesh_figures **out)
{
    csg_memory *memory = &context->memory;
    csg_mesh_figures *f = csg_memory_alloc(memory, sizeof *f);
    worker *each = csg_memory_alloc(memory, workers * sizeof *each);
    if (!f || !each) {
        csg_memory_release(memory, f, sizeof *f);
        csg_memory_release(memory, each, workers * sizeof *each);
        return false;
    }
    memset(f, 0, sizeof *f);
    memset(each, 0, workers * sizeof *each);
    f->context = context;
    f->to = *to;
    f->workers = each;
    f->worker_count = workers;
    f->seam.memory = memory;
    for (uint32_t i = 0; i < workers; i++)
        csg_table_init(&each[i].table, memory);
    pthread_mutex_init(&f->lock, NULL);
    *out = f;
    return true;
}

csg_mesh_receiver csg_mesh_figures_receiver(csg_mesh_figures *f)
{
    csg_mesh_receiver receiver = f->to;
    receiver.user = f;
    receiver.begin = begin_runs;
    receiver.put = put_run;
    receiver.seen = NULL;
    receiver.flush = NULL;
    receiver.wants_joined = true;
    return receiver;
}

static uint64_t count_bits(const csg_mesh_figures *f, const atomic_uint_fast64_t *bits)
{
    uint64_t count = 0;
    for (size_t i = 0; i < f->word_count; i++)
        count += (uint64_t)__builtin_popcountll(atomic_load(&bits[i]));
    return count;
}

bool csg_mesh_figures_get(csg_mesh_figures *f, csgm_mesh_check *out)
{
    if (atomic_load(&f->is_irregular) || atomic_load(&f->is_without_memory) || !f->closed ||
        f->seam.count)
        return false;
    csgm_mesh_check check = {0};
    csg_mesh_measures *measures = &f->workers[0].measures;
    csg_box box = csg_box_empty();
    check.components = csg_seam_components(&f->seam);
    for (uint32_t i = 0; i < f->worker_count; i++) {
        if (i)
            csg_mesh_measures_add(measures, &f->workers[i].measures);
        box = csg_box_hull(box, f->workers[i].box);
        check.components += f->workers[i].components;
    }
    csg_mesh_measures_end(measures, box, f->counts.origin, &check);
    uint64_t vertices = count_bits(f, f->closed), triangles = measures->triangles;
    check.unused_vertices = f->counts.vertex_count - (f->used ? count_bits(f, f->used) : vertices);
    check.euler = (int64_t)vertices - (int64_t)(triangles / 2 * 3) + (int64_t)triangles;
    check.genus = (int64_t)check.components - check.euler / 2;
    if (triangles != f->counts.triangle_count)
        return false;
    *out = check;
    return true;
}

void csg_mesh_figures_destroy(csg_mesh_figures *f)
{
    csg_memory *memory = &f->context->memory;
    for (uint32_t i = 0; i < f->worker_count; i++)
        release_worker(memory, &f->workers[i]);
    csg_memory_release(memory, f->workers, f->worker_count * sizeof *f->workers);
    csg_memory_release(memory, f->closed, f->word_count * sizeof *f->closed);
    csg_memory_release(memory, f->used, f->word_count * sizeof *f->used);
    csg_seam_release(&f->seam);
    pthread_mutex_destroy(&f->lock);
    csg_memory_release(memory, f, sizeof *f);
}
