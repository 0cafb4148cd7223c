/* SPDX-License-Identifier: MIT
 * Zones; see trace.h. The format is that of "Trace Event Format" (Google, 2016): complete events
 * ("ph":"X") with times in microseconds, wall (ts, dur) and of the thread's processor (tts, tdur).
 */
#include "base/trace.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/screen.h"

enum { ZONES_PER_CHUNK = 256, DEPTH_MOST = 64, COUNTS_MOST = 4 };

typedef struct zone {
    const char *name;
    char *note; /* or NULL */
    uint64_t start_ns, thread_ns, wall_ns, processor_ns;
    struct {
        const char *name;
        uint64_t count;
    } counts[COUNTS_MOST];
    uint8_t count_count;
    bool is_loop;
} zone;

typedef struct chunk {
    struct chunk *next;
    size_t count;
    zone zones[ZONES_PER_CHUNK];
} chunk;

/* One thread at a time writes to it: zones in the order of their ends. */
typedef struct lane {
    size_t number;
    chunk *first, *last;
    bool is_taken; /* under the trace's lock */
} lane;

struct csgm_trace {
    csg_memory memory;
    pthread_mutex_t lock;
    lane **lanes; /* under lock */
    size_t lane_count, lane_capacity;
    csg_arena notes; /* under lock */
    atomic_uint_fast64_t dropped;
    uint64_t start_ns;
};

struct csg_trace_lanes {
    csgm_trace *trace;
    uint32_t threads, depth;
    zone open[DEPTH_MOST];
    lane *lanes[];
};

/* ---- the trace ------------------------------------------------------------------------- */

csgm_status csg_trace_create(const csgm_allocator *allocator, uint64_t memory_bytes,
                             csgm_trace **out)
{
    csg_memory memory;
    csg_memory_init(&memory, allocator, memory_bytes);
    csgm_trace *trace = csg_memory_alloc(&memory, sizeof *trace);
    if (!trace)
        return CSGM_ERR_MEMORY;
    memset(trace, 0, sizeof *trace);
    csg_memory_init(&trace->memory, allocator, memory_bytes);
    csg_arena_init(&trace->notes, &trace->memory);
    pthread_mutex_init(&trace->lock, NULL);
    trace->start_ns = csg_clock_now_ns();
    *out = trace;
    return CSGM_OK;
}

void csg_trace_destroy(csgm_trace *trace)
{
    if (!trace)
        return;
    csg_memory memory;
    csg_memory_init(&memory, &trace->memory.allocator, 0);
    for (size_t i = 0; i < trace->lane_count; i++) {
        for (chunk *c = trace->lanes[i]->first, *next; c; c = next) {
            next = c->next;
            csg_memory_release(&trace->memory, c, sizeof *c);
        }
        csg_memory_release(&trace->memory, trace->lanes[i], sizeof(lane));
    }
    csg_memory_release(&trace->memory, trace->lanes, trace->lane_capacity * sizeof(lane *));
    csg_arena_reset(&trace->notes);
    pthread_mutex_destroy(&trace->lock);
    csg_memory_release(&memory, trace, sizeof *trace);
}

uint64_t csg_trace_dropped(const csgm_trace *trace)
{
    return atomic_load(&trace->dropped);
}

/* ---- lanes ----------------------------------------------------------------------------- */

/* The first lane that nobody has, or a new one. Under lock. */
static lane *take_lane(csgm_trace *trace)
{
    for (size_t i = 0; i < trace->lane_count; i++)
        if (!trace->lanes[i]->is_taken) {
            trace->lanes[i]->is_taken = true;
            return trace->lanes[i];
        }
    lane *fresh = csg_memory_alloc(&trace->memory, sizeof *fresh);
    if (!fresh || !csg_memory_reserve(&trace->memory, (void **)&trace->lanes, &trace->lane_capacity,
                                      trace->lane_count + 1, sizeof(lane *))) {
        csg_memory_release(&trace->memory, fresh, sizeof *fresh);
        return NULL;
    }
    *fresh = (lane){.number = trace->lane_count, .is_taken = true};
    trace->lanes[trace->lane_count++] = fresh;
    return fresh;
}

static size_t lanes_bytes(uint32_t threads)
{
    return sizeof(csg_trace_lanes) + threads * sizeof(lane *);
}

csg_trace_lanes *csg_trace_enter(csgm_trace *trace, uint32_t threads)
{
    csg_trace_lanes *lanes = csg_memory_alloc(&trace->memory, lanes_bytes(threads));
    if (!lanes)
        return NULL;
    memset(lanes, 0, lanes_bytes(threads));
    lanes->trace = trace;
    lanes->threads = threads;
    bool done = true;
    pthread_mutex_lock(&trace->lock);
    for (uint32_t i = 0; i < threads && done; i++) {
        lanes->lanes[i] = take_lane(trace);
        done = lanes->lanes[i] != NULL;
    }
    pthread_mutex_unlock(&trace->lock);
    if (done)
        return lanes;
    csg_trace_leave(lanes);
    return NULL;
}

void csg_trace_leave(csg_trace_lanes *lanes)
{
    if (!lanes)
        return;
    csgm_trace *trace = lanes->trace;
    while (lanes->depth)
        csg_trace_end(lanes);
    pthread_mutex_lock(&trace->lock);
    for (uint32_t i = 0; i < lanes->threads && lanes->lanes[i]; i++)
        lanes->lanes[i]->is_taken = false;
    pthread_mutex_unlock(&trace->lock);
    csg_memory_release(&trace->memory, lanes, lanes_bytes(lanes->threads));
}

/* ---- zones ----------------------------------------------------------------------------- */

static bool keep(csgm_trace *trace, lane *to, const zone *z)
{
    if (!to->last || to->last->count == ZONES_PER_CHUNK) {
        chunk *fresh = csg_memory_alloc(&trace->memory, sizeof *fresh);
        if (!fresh)
            return false;
        fresh->next = NULL;
        fresh->count = 0;
        *(to->last ? &to->last->next : &to->first) = fresh;
        to->last = fresh;
    }
    to->last->zones[to->last->count++] = *z;
    return true;
}

static void close_zone(csg_trace_lanes *lanes, uint32_t worker, zone *z)
{
    z->wall_ns = csg_clock_now_ns() - z->start_ns;
    z->processor_ns = csg_clock_thread_ns() - z->thread_ns;
    if (!keep(lanes->trace, lanes->lanes[worker], z))
        atomic_fetch_add(&lanes->trace->dropped, 1);
}

static char *copy_note(csgm_trace *trace, const char *note)
{
    pthread_mutex_lock(&trace->lock);
    char *copy = csg_arena_strndup(&trace->notes, note, strlen(note));
    pthread_mutex_unlock(&trace->lock);
    return copy;
}

void csg_trace_begin(csg_trace_lanes *lanes, const char *name, const char *note)
{
    if (lanes->depth++ >= DEPTH_MOST)
        return;
    lanes->open[lanes->depth - 1] = (zone){.name = name,
                                           .note = note ? copy_note(lanes->trace, note) : NULL,
                                           .start_ns = csg_clock_now_ns(),
                                           .thread_ns = csg_clock_thread_ns()};
}

void csg_trace_count(csg_trace_lanes *lanes, const char *name, uint64_t count)
{
    if (lanes->depth == 0 || lanes->depth > DEPTH_MOST)
        return;
    zone *z = &lanes->open[lanes->depth - 1];
    if (z->count_count == COUNTS_MOST)
        return;
    z->counts[z->count_count].name = name;
    z->counts[z->count_count++].count = count;
}

void csg_trace_end(csg_trace_lanes *lanes)
{
    if (lanes->depth == 0)
        return;
    if (lanes->depth-- <= DEPTH_MOST)
        close_zone(lanes, 0, &lanes->open[lanes->depth]);
    else
        atomic_fetch_add(&lanes->trace->dropped, 1);
}

const char *csg_trace_open_name(const csg_trace_lanes *lanes)
{
    uint32_t depth = lanes->depth < DEPTH_MOST ? lanes->depth : DEPTH_MOST;
    return depth ? lanes->open[depth - 1].name : "";
}

csg_trace_loop csg_trace_loop_begin(const char *name)
{
    return (csg_trace_loop){name, csg_clock_now_ns(), csg_clock_thread_ns()};
}

void csg_trace_loop_end(csg_trace_lanes *lanes, uint32_t worker, const csg_trace_loop *loop,
                        uint64_t items)
{
    zone z = {.name = loop->name,
              .start_ns = loop->start_ns,
              .thread_ns = loop->thread_ns,
              .counts = {{"items", items}, {"caller", lanes->lanes[0]->number}},
              .count_count = 2,
              .is_loop = true};
    close_zone(lanes, worker, &z);
}

/* ---- printing -------------------------------------------------------------------------- */

typedef struct printer {
    csgm_text_fn *sink;
    void *user;
    bool is_first;
} printer;

__attribute__((format(printf, 2, 3))) static void print(const printer *p, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    p->sink(p->user, text, length < (int)sizeof text ? (size_t)length : sizeof text - 1);
}

/* Names of files need not be UTF-8, JSON must. */
static void print_string(const printer *p, const char *text)
{
    print(p, "\"");
    for (size_t left = strlen(text); left > 0;) {
        csg_screen_cell cell = csg_screen_cell_at(text, left);
        if (*text == '"' || *text == '\\')
            print(p, "\\%c", *text);
        else if (*text == '\t' || !cell.is_shown)
            print(p, "?");
        else
            p->sink(p->user, text, cell.bytes);
        text += cell.bytes;
        left -= cell.bytes;
    }
    print(p, "\"");
}

static void begin_event(printer *p)
{
    print(p, p->is_first ? "\n" : ",\n");
    p->is_first = false;
}

/* With three digits behind the point. */
static void print_time(const printer *p, const char *key, uint64_t ns)
{
    print(p, ",\"%s\":%" PRIu64 ".%03u", key, ns / 1000, (unsigned)(ns % 1000));
}

static void print_zone(printer *p, size_t thread, uint64_t start_ns, const zone *z)
{
    begin_event(p);
    print(p, "{\"ph\":\"X\",\"pid\":1,\"tid\":%zu,\"cat\":\"%s\",\"name\":", thread,
          z->is_loop ? "loop" : "stage");
    print_string(p, z->name);
    print_time(p, "ts", z->start_ns - start_ns);
    print_time(p, "dur", z->wall_ns);
    print_time(p, "tts", z->thread_ns);
    print_time(p, "tdur", z->processor_ns);
    if (z->note || z->count_count) {
        print(p, ",\"args\":{");
        if (z->note) {
            print(p, "\"of\":");
            print_string(p, z->note);
        }
        for (uint32_t i = 0; i < z->count_count; i++)
            print(p, "%s\"%s\":%" PRIu64, z->note || i ? "," : "", z->counts[i].name,
                  z->counts[i].count);
        print(p, "}");
    }
    print(p, "}");
}

static void print_lane(printer *p, size_t thread, uint64_t start_ns, const lane *l)
{
    if (!l->first)
        return;
    begin_event(p);
    print(p,
          "{\"ph\":\"M\",\"pid\":1,\"tid\":%zu,\"name\":\"thread_name\",\"args\":{\"name\":"
          "\"%s %zu\"}}",
          thread, thread ? "thread" : "main thread", thread);
    for (const chunk *c = l->first; c; c = c->next)
        for (size_t i = 0; i < c->count; i++)
            print_zone(p, thread, start_ns, &c->zones[i]);
}

void csg_trace_print(csgm_trace *trace, csgm_text_fn *sink, void *user)
{
    printer p = {sink, user, true};
    pthread_mutex_lock(&trace->lock);
    print(&p,
          "{\"displayTimeUnit\":\"ms\",\"otherData\":{\"csgmesh\":\"%d.%d.%d\",\"dropped_zones\":"
          "%" PRIu64 "},\n\"traceEvents\":[",
          CSGM_VERSION_MAJOR, CSGM_VERSION_MINOR, CSGM_VERSION_PATCH, csg_trace_dropped(trace));
    begin_event(&p);
    print(&p, "{\"ph\":\"M\",\"pid\":1,\"name\":\"process_name\",\"args\":{\"name\":\"csgmesh\"}}");
    for (size_t i = 0; i < trace->lane_count; i++)
        print_lane(&p, i, trace->start_ns, trace->lanes[i]);
    print(&p, "\n]}\n");
    pthread_mutex_unlock(&trace->lock);
}
