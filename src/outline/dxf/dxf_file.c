/* SPDX-License-Identifier: MIT
 * Pairs, entities and blocks of DXF; see dxf_file.h.
 */
#include "outline/dxf/dxf_file.h"

#include <string.h>

enum { MOST_ENTITIES = 4 << 20, MOST_BLOCKS = 1 << 18 };

typedef struct reader {
    const char *at, *end;
    csg_dxf_file *file;
    csg_problem *problem;
    bool has_section;
} reader;

static csg_dxf_text next_line(const char **at, const char *end)
{
    const char *begin = *at, *stop = memchr(begin, '\n', (size_t)(end - begin));
    *at = stop ? stop + 1 : end;
    stop = stop ? stop : end;
    while (begin < stop && csg_is_blank(*begin))
        begin++;
    while (stop > begin && csg_is_blank(stop[-1]))
        stop--;
    return (csg_dxf_text){begin, (size_t)(stop - begin)};
}

static bool to_integer(csg_dxf_text text, int *out)
{
    double value;
    const char *at = text.begin, *end = at + text.length;
    if (!csg_number_scan(&at, end, &value) || at != end || fabs(value) > 1e6)
        return false;
    *out = (int)value;
    return true;
}

bool csg_dxf_pair_next(const char **at, const char *end, csg_dxf_pair *out)
{
    if (*at == end)
        return false;
    csg_dxf_text code = next_line(at, end);
    if (*at == end || !to_integer(code, &out->code)) {
        *at = end;
        return false;
    }
    out->value = next_line(at, end);
    return true;
}

bool csg_dxf_text_is(csg_dxf_text text, const char *name)
{
    return text.length == strlen(name) && memcmp(text.begin, name, text.length) == 0;
}

double csg_dxf_number(const csg_dxf_pair *pair, double otherwise)
{
    double value;
    const char *at = pair->value.begin, *end = at + pair->value.length;
    if (!csg_number_scan(&at, end, &value) || fabs(value) > CSG_INPUT_MOST_COORDINATE)
        return otherwise;
    return value;
}

static bool find_pair(const csg_dxf_entity *entity, int code, csg_dxf_pair *out)
{
    const char *at = entity->begin;
    while (csg_dxf_pair_next(&at, entity->end, out))
        if (out->code == code)
            return true;
    return false;
}

double csg_dxf_get(const csg_dxf_entity *entity, int code, double otherwise)
{
    csg_dxf_pair pair;
    return find_pair(entity, code, &pair) ? csg_dxf_number(&pair, otherwise) : otherwise;
}

csg_dxf_text csg_dxf_get_text(const csg_dxf_entity *entity, int code)
{
    csg_dxf_pair pair;
    return find_pair(entity, code, &pair) ? pair.value : (csg_dxf_text){"", 0};
}

/* ---- structure ----------------------------------------------------------------------- */

static bool is_next(const reader *r, int code, const char *value)
{
    const char *at = r->at;
    csg_dxf_pair pair;
    return csg_dxf_pair_next(&at, r->end, &pair) && pair.code == code &&
           (!value || csg_dxf_text_is(pair.value, value));
}

static bool next_pair(reader *r, csg_dxf_pair *out)
{
    return csg_dxf_pair_next(&r->at, r->end, out);
}

/* Up to the next pair of code 0. */
static void read_entity(reader *r, csg_dxf_text kind, csg_dxf_entity *out)
{
    csg_dxf_pair pair;
    *out = (csg_dxf_entity){.kind = kind, .layer = {"0", 1}, .begin = r->at};
    while (!is_next(r, 0, NULL) && next_pair(r, &pair)) {
        if (pair.code == 8)
            out->layer = pair.value;
        if (pair.code == 67)
            out->paper = csg_dxf_number(&pair, 0) > 0;
    }
    out->end = r->at;
}

static csgm_status add_entity(reader *r, csg_dxf_text kind)
{
    csg_dxf_file *f = r->file;
    if (f->entity_count == MOST_ENTITIES)
        return csg_problem_set(r->problem, CSGM_ERR_LIMIT, "it has too many entities");
    void *entities = f->entities;
    if (!csg_memory_reserve(f->memory, &entities, &f->entity_capacity, f->entity_count + 1,
                            sizeof *f->entities))
        return CSGM_ERR_MEMORY;
    f->entities = entities;
    read_entity(r, kind, &f->entities[f->entity_count++]);
    return CSGM_OK;
}

static csgm_status add_block(csg_dxf_file *f, csg_dxf_block block, csg_problem *problem)
{
    if (f->block_count == MOST_BLOCKS)
        return csg_problem_set(problem, CSGM_ERR_LIMIT, "it has too many blocks");
    void *blocks = f->blocks;
    if (!csg_memory_reserve(f->memory, &blocks, &f->block_capacity, f->block_count + 1,
                            sizeof *f->blocks))
        return CSGM_ERR_MEMORY;
    f->blocks = blocks;
    f->blocks[f->block_count++] = block;
    return CSGM_OK;
}

/* Entities up to the end of the section or block, which is read too. */
static csgm_status read_entities(reader *r, const char *last, size_t *count)
{
    csg_dxf_pair pair;
    csgm_status status = CSGM_OK;
    *count = 0;
    while (status == CSGM_OK && next_pair(r, &pair)) {
        if (pair.code != 0)
            continue;
        if (csg_dxf_text_is(pair.value, last) || csg_dxf_text_is(pair.value, "ENDSEC"))
            break;
        status = add_entity(r, pair.value);
        ++*count;
    }
    return status;
}

static csgm_status read_blocks(reader *r)
{
    csg_dxf_pair pair;
    csgm_status status = CSGM_OK;
    while (status == CSGM_OK && next_pair(r, &pair)) {
        if (pair.code != 0)
            continue;
        if (csg_dxf_text_is(pair.value, "ENDSEC"))
            break;
        if (!csg_dxf_text_is(pair.value, "BLOCK"))
            continue;
        csg_dxf_entity head;
        read_entity(r, pair.value, &head);
        csg_dxf_block block = {.name = csg_dxf_get_text(&head, 2),
                               .base = {csg_dxf_get(&head, 10, 0), csg_dxf_get(&head, 20, 0)},
                               .first = r->file->entity_count};
        status = read_entities(r, "ENDBLK", &block.count);
        if (status == CSGM_OK)
            status = add_block(r->file, block, r->problem);
    }
    return status;
}

static void read_header(reader *r)
{
    csg_dxf_pair pair;
    bool units = false;
    while (!is_next(r, 0, NULL) && next_pair(r, &pair)) {
        if (pair.code == 9)
            units = csg_dxf_text_is(pair.value, "$INSUNITS");
        else if (units && pair.code == 70)
            r->file->units = (int)fmin(fmax(csg_dxf_number(&pair, 0), 0), 100);
    }
}

static csgm_status read_section(reader *r)
{
    csg_dxf_pair name;
    csgm_status status = CSGM_OK;
    if (!next_pair(r, &name) || name.code != 2)
        return CSGM_OK;
    r->has_section = true;
    if (csg_dxf_text_is(name.value, "HEADER")) {
        read_header(r);
    } else if (csg_dxf_text_is(name.value, "BLOCKS")) {
        status = read_blocks(r);
    } else if (csg_dxf_text_is(name.value, "ENTITIES")) {
        size_t first = r->file->entity_count, count;
        status = read_entities(r, "ENDSEC", &count);
        r->file->blocks[0].first = first;
        r->file->blocks[0].count = count;
    }
    return status;
}

static csgm_status refuse_other_formats(const char *text, size_t length, csg_problem *problem)
{
    if (length >= 18 && memcmp(text, "AutoCAD Binary DXF", 18) == 0)
        return csg_problem_set(problem, CSGM_ERR_FORMAT,
                               "it is a binary DXF file; save it as text (ASCII DXF)");
    if (length >= 6 && memcmp(text, "AC10", 4) == 0)
        return csg_problem_set(problem, CSGM_ERR_FORMAT,
                               "it is a DWG file; save it as text (ASCII DXF)");
    if (length > CSG_INPUT_MOST_BYTES)
        return csg_problem_set(problem, CSGM_ERR_LIMIT, "it is larger than %zu MiB",
                               CSG_INPUT_MOST_BYTES >> 20);
    return CSGM_OK;
}

csgm_status csg_dxf_read(csg_memory *memory, const char *text, size_t length, csg_dxf_file *out,
                         csg_problem *problem)
{
    reader r = {.at = text, .end = text + length, .file = out, .problem = problem};
    csg_dxf_pair pair;
    *out = (csg_dxf_file){.memory = memory};
    csgm_status status = refuse_other_formats(text, length, problem);
    if (status == CSGM_OK)
        status = add_block(out, (csg_dxf_block){.name = {"", 0}}, problem);
    while (status == CSGM_OK && next_pair(&r, &pair))
        if (pair.code == 0 && csg_dxf_text_is(pair.value, "SECTION"))
            status = read_section(&r);
    if (status == CSGM_OK && !r.has_section)
        status = csg_problem_set(problem, CSGM_ERR_FORMAT,
                                 "it is no DXF file: there is no section in it");
    if (status != CSGM_OK)
        csg_dxf_release(out);
    return status;
}

void csg_dxf_release(csg_dxf_file *file)
{
    if (file->entities)
        csg_memory_release(file->memory, file->entities,
                           file->entity_capacity * sizeof *file->entities);
    if (file->blocks)
        csg_memory_release(file->memory, file->blocks, file->block_capacity * sizeof *file->blocks);
    *file = (csg_dxf_file){.memory = file->memory};
}
