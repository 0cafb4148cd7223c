/* SPDX-License-Identifier: MIT
 * A table of keys and outlines, and one of regions; see figures.h.
 */
#include "scene/tree/figures.h"

#include <string.h>

#include "shape/plane/region.h"

/* A scene of many different figures keeps the first ones: what comes behind is made as ever. */
static const size_t most_bytes = (size_t)16 << 20;

typedef struct figure {
    uint64_t hash;
    const uint64_t *words;
    size_t word_count;
    csg_outline outline;
} figure;

struct csg_figures {
    csg_memory *memory;
    csg_arena arena; /* of the words */
    csg_table table, region_table;
    figure *items;
    csg_shape **regions; /* one reference each */
    csg_shape **held;    /* whose addresses are in keys: one reference each */
    size_t count, capacity, region_count, region_capacity, held_count, held_capacity;
    size_t bytes;
};

/* ---- keys ------------------------------------------------------------------------------------ */

void csg_figure_key_init(csg_figure_key *key, csg_memory *memory)
{
    *key = (csg_figure_key){.memory = memory, .is_known = true};
}

void csg_figure_key_release(csg_figure_key *key)
{
    csg_memory_release(key->memory, key->words, key->capacity * sizeof *key->words);
    csg_memory_release(key->memory, key->shapes, key->shape_capacity * sizeof *key->shapes);
    csg_figure_key_init(key, key->memory);
}

bool csg_figure_key_word(csg_figure_key *key, uint64_t word)
{
    void *words = key->words;
    if (!csg_memory_reserve(key->memory, &words, &key->capacity, key->count + 1, sizeof word))
        return false;
    key->words = words;
    key->words[key->count++] = word;
    return true;
}

bool csg_figure_key_numbers(csg_figure_key *key, const double *numbers, size_t count)
{
    bool done = true;
    for (size_t i = 0; i < count && done; i++) {
        uint64_t word;
        memcpy(&word, &numbers[i], sizeof word);
        done = csg_figure_key_word(key, word);
    }
    return done;
}

bool csg_figure_key_shape(csg_figure_key *key, csg_shape *shape)
{
    void *shapes = key->shapes;
    if (!csg_memory_reserve(key->memory, &shapes, &key->shape_capacity, key->shape_count + 1,
                            sizeof(csg_shape *)))
        return false;
    key->shapes = shapes;
    key->shapes[key->shape_count++] = shape;
    return csg_figure_key_word(key, (uintptr_t)shape);
}

static uint64_t hash_of_key(const csg_figure_key *key)
{
    uint64_t hash = CSG_HASH_START;
    for (size_t i = 0; i < key->count; i++)
        hash = csg_hash_word(hash, key->words[i]);
    return hash;
}

static bool is_key_of(const figure *f, uint64_t hash, const csg_figure_key *key)
{
    return f->hash == hash && f->word_count == key->count &&
           memcmp(f->words, key->words, key->count * sizeof *key->words) == 0;
}

/* ---- the tables ------------------------------------------------------------------------------ */

/* NULL: no memory. */
static csg_figures *begin_figures(csg_figures **figures, csg_memory *memory)
{
    if (*figures)
        return *figures;
    csg_figures *made = csg_memory_alloc(memory, sizeof *made);
    if (!made)
        return NULL;
    *made = (csg_figures){.memory = memory};
    csg_arena_init(&made->arena, memory);
    csg_table_init(&made->table, memory);
    csg_table_init(&made->region_table, memory);
    return *figures = made;
}

void csg_figures_destroy(csg_figures *figures)
{
    if (!figures)
        return;
    csg_memory *memory = figures->memory;
    for (size_t i = 0; i < figures->count; i++)
        csg_outline_release(&figures->items[i].outline);
    for (size_t i = 0; i < figures->region_count; i++)
        csg_shape_release(figures->regions[i]);
    for (size_t i = 0; i < figures->held_count; i++)
        csg_shape_release(figures->held[i]);
    csg_memory_release(memory, figures->items, figures->capacity * sizeof *figures->items);
    csg_memory_release(memory, figures->regions,
                       figures->region_capacity * sizeof *figures->regions);
    csg_memory_release(memory, figures->held, figures->held_capacity * sizeof *figures->held);
    csg_table_release(&figures->table);
    csg_table_release(&figures->region_table);
    csg_arena_reset(&figures->arena);
    csg_memory_release(memory, figures, sizeof *figures);
}

static size_t bytes_of(const csg_outline *outline)
{
    return outline->point_count * sizeof *outline->points +
           outline->loop_count * sizeof *outline->ends;
}

/* ---- outlines -------------------------------------------------------------------------------- */

static uint64_t hash_of_figure(const void *items, uint32_t number)
{
    return ((const figure *)items)[number].hash;
}

const csg_outline *csg_figures_find(const csg_figures *f, const csg_figure_key *key)
{
    if (!f || !f->count || !key->is_known)
        return NULL;
    size_t slot;
    uint64_t hash = hash_of_key(key);
    uint32_t found = csg_table_first(&f->table, hash, &slot);
    while (found != CSG_TABLE_NONE && !is_key_of(&f->items[found], hash, key))
        found = csg_table_next(&f->table, &slot);
    return found == CSG_TABLE_NONE ? NULL : &f->items[found].outline;
}

static bool hold_shapes(csg_figures *f, const csg_figure_key *key)
{
    void *held = f->held;
    if (!csg_memory_reserve(f->memory, &held, &f->held_capacity, f->held_count + key->shape_count,
                            sizeof(csg_shape *)))
        return false;
    f->held = held;
    for (size_t i = 0; i < key->shape_count; i++) {
        csg_shape_retain(key->shapes[i]);
        f->held[f->held_count++] = key->shapes[i];
    }
    return true;
}

bool csg_figures_keep(csg_figures **figures, const csg_figure_key *key, const csg_outline *outline)
{
    csg_figures *f = key->is_known ? begin_figures(figures, key->memory) : NULL;
    if (!f)
        return !key->is_known;
    size_t bytes = key->count * sizeof *key->words + bytes_of(outline) + sizeof(figure);
    if (f->bytes + bytes > most_bytes)
        return true;
    void *items = f->items;
    uint64_t *words = csg_arena_alloc(&f->arena, key->count * sizeof *words);
    if (!words ||
        !csg_memory_reserve(f->memory, &items, &f->capacity, f->count + 1, sizeof *f->items))
        return false;
    f->items = items;
    figure *new = &f->items[f->count];
    memcpy(words, key->words, key->count * sizeof *words);
    *new = (figure){.hash = hash_of_key(key), .words = words, .word_count = key->count};
    csg_outline_init(&new->outline, f->memory);
    if (!csg_outline_append(&new->outline, outline) ||
        !csg_table_reserve(&f->table, f->count + 1, hash_of_figure, f->items) ||
        !hold_shapes(f, key)) {
        csg_outline_release(&new->outline);
        return false;
    }
    csg_table_add(&f->table, new->hash, (uint32_t)f->count++);
    f->bytes += bytes;
    return true;
}

/* ---- regions --------------------------------------------------------------------------------- */

static uint64_t hash_of_region(const void *regions, uint32_t number)
{
    return csg_shape_hash(((csg_shape *const *)regions)[number]);
}

static bool is_same(const csg_outline *a, const csg_outline *b)
{
    return a->point_count == b->point_count && a->loop_count == b->loop_count &&
           memcmp(a->points, b->points, a->point_count * sizeof *a->points) == 0 &&
           memcmp(a->ends, b->ends, a->loop_count * sizeof *a->ends) == 0;
}

static csg_shape *find_region(const csg_figures *f, const csg_outline *outline, uint64_t hash)
{
    size_t slot;
    if (!f->region_count)
        return NULL;
    uint32_t found = csg_table_first(&f->region_table, hash, &slot);
    while (found != CSG_TABLE_NONE && !is_same(csg_region_outline(f->regions[found]), outline))
        found = csg_table_next(&f->region_table, &slot);
    return found == CSG_TABLE_NONE ? NULL : f->regions[found];
}

/* False: no memory. */
static bool keep_region(csg_figures *f, csg_shape *region, uint64_t hash, size_t bytes)
{
    void *regions = f->regions;
    if (!csg_memory_reserve(f->memory, &regions, &f->region_capacity, f->region_count + 1,
                            sizeof(csg_shape *)))
        return false;
    f->regions = regions;
    if (!csg_table_reserve(&f->region_table, f->region_count + 1, hash_of_region, f->regions))
        return false;
    csg_shape_retain(region);
    f->regions[f->region_count] = region;
    csg_table_add(&f->region_table, hash, (uint32_t)f->region_count++);
    f->bytes += bytes;
    return true;
}

csgm_status csg_figures_region(csg_figures **figures, csg_memory *memory, const csg_outline *clean,
                               csg_shape **out)
{
    enum { TREE = 4 }; /* what a region has beside its outline, in outlines */
    csg_figures *f = begin_figures(figures, memory);
    if (!f || !clean->point_count)
        return f ? csg_region_create(f->memory, clean, out) : CSGM_ERR_MEMORY;
    uint64_t hash = csg_region_hash(clean);
    size_t bytes = (TREE + 1) * bytes_of(clean);
    csg_shape *known = find_region(f, clean, hash);
    if (known) {
        csg_shape_retain(known);
        *out = known;
        return CSGM_OK;
    }
    csgm_status status = csg_region_create(f->memory, clean, out);
    if (status == CSGM_OK && f->bytes + bytes <= most_bytes && !keep_region(f, *out, hash, bytes)) {
        csg_shape_release(*out);
        *out = NULL;
        status = CSGM_ERR_MEMORY;
    }
    return status;
}
