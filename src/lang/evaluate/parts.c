/* SPDX-License-Identifier: MIT
 * Parts -> nodes. Each statement leaves its solids as parts on a stack; the operator around it
 * joins what lies above its mark. As in OpenSCAD the first part's dimension rules among those of
 * one operation; the others are left out with a warning.
 */
#include <string.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "lang/evaluate/evaluator.h"

void csg_push_part(csg_eval *e, csg_eval_part part)
{
    if (e->stop)
        return;
    if (csg_memory_reserve(&e->context->memory, (void **)&e->parts, &e->part_capacity,
                           e->part_count + 1, sizeof *e->parts))
        e->parts[e->part_count++] = part;
    else
        csg_eval_no_memory(e);
}

/* The builder's first failure is sticky; a bad solid is told and built on without it. */
csg_node_id csg_check_node(csg_eval *e, csg_node_id node, csg_span where)
{
    csg_scene_builder *builder = &e->builder;
    if (node != CSG_NODE_NONE || e->stop)
        return node;
    if (builder->status == CSGM_ERR_MEMORY) {
        csg_eval_no_memory(e);
    } else if (builder->status == CSGM_ERR_LIMIT) {
        csg_eval_limit(e, CSG_DIAG_TOO_MANY_NODES, where, "raise the limit with --max-nodes", "%s",
                       builder->problem);
    } else {
        csg_eval_report(e, CSG_DIAG_BAD_SOLID, where, NULL, "%s", builder->problem);
        builder->status = CSGM_OK;
        builder->problem[0] = '\0';
        node = csg_build_empty(builder, where);
        if (node == CSG_NODE_NONE)
            csg_eval_no_memory(e);
    }
    return node;
}

/* Moves the nodes of plain parts to the front, in order; the number of them. */
static size_t gather(csg_eval_part *parts, size_t count, csg_node_id *out)
{
    size_t plain = 0;
    for (size_t i = 0; i < count; i++)
        if (!parts[i].wrapped || i == 0)
            out[plain++] = parts[i].node;
    return plain;
}

static csg_node_id join_wrapped(csg_eval *e, csg_eval_part *parts, size_t count, csg_node_id node,
                                csg_node_kind kind, csg_span where)
{
    for (size_t i = 1; i < count && node != CSG_NODE_NONE; i++) {
        if (!parts[i].wrapped)
            continue;
        csg_node_id pair[2] = {node, parts[i].node};
        node = csg_check_node(
            e, csg_build_operator(&e->builder, kind, parts[i].blend, pair, 2, where), where);
    }
    return node;
}

/* The first part is what the others join. In a union or intersection a first part that is wrapped
 * goes behind the first that is not, so that its blend is used. */
static void put_plain_first(csg_eval *e, csg_eval_part *parts, size_t count, csg_node_kind kind)
{
    size_t i = 0;
    if (count == 0 || !parts[0].wrapped)
        return;
    if (kind == CSG_NODE_DIFFERENCE || count == 1) {
        csg_eval_report(
            e, CSG_DIAG_UNUSED_BLEND, parts[0].where, NULL,
            count == 1 ? "there is nothing that this blend() could join with"
                       : "the first child of a difference joins nothing, its blend() is not used");
        return;
    }
    while (i < count && parts[i].wrapped)
        i++;
    if (i < count) {
        csg_eval_part plain = parts[i];
        memmove(parts + 1, parts, i * sizeof *parts);
        parts[0] = plain;
    }
}

csg_node_id csg_join_parts(csg_eval *e, size_t first, csg_node_kind kind, csg_blend blend,
                           csg_span where)
{
    if (!e->stop)
        csg_parts_keep_alike(e, first, where);
    return csg_join_parts_by(e, first, kind, (csg_joining){.blend = blend}, where);
}

/* Joins `count` parts that are no regions; the first is what the others join. */
static csg_node_id join_operands(csg_eval *e, csg_eval_part *parts, size_t count,
                                 csg_node_kind kind, csg_joining by, csg_span where)
{
    size_t bytes = (count ? count : 1) * sizeof(csg_node_id);
    csg_node_id node = CSG_NODE_NONE, *children = csg_memory_alloc(&e->context->memory, bytes);
    if (children) {
        size_t plain = gather(parts, count, children);
        node = by.radius ? csg_build_varying(&e->builder, kind, by.radius, by.radius_count,
                                             children, plain, where)
                         : csg_build_operator(&e->builder, kind, by.blend, children, plain, where);
        node = csg_check_node(e, node, where);
        node = join_wrapped(e, parts, count, node, kind, where);
    } else {
        csg_eval_no_memory(e);
    }
    csg_memory_release(&e->context->memory, children, bytes);
    return node;
}

/* ---- where a blend acts ----------------------------------------------------------------------
 * A union S is larger where it blends, B, and B within a region R is S, B and R: S or (B and R). An
 * intersection or a difference is smaller there: S without (R without B). A border makes B and R,
 * or R without B, smaller where they end.
 */

/* Moves the regions behind the operands, each in their order; how many operands there are. */
static size_t put_regions_last(csg_eval_part *parts, size_t count)
{
    size_t operands = 0;
    for (size_t i = 0; i < count; i++) {
        if (parts[i].is_region)
            continue;
        csg_eval_part operand = parts[i];
        memmove(parts + operands + 1, parts + operands, (i - operands) * sizeof *parts);
        parts[operands++] = operand;
    }
    return operands;
}

static bool blends(const csg_eval_part *parts, size_t count, csg_joining by)
{
    bool any = count > 1 && (by.radius || !csg_blend_is_sharp(by.blend.kind));
    for (size_t i = 1; i < count; i++)
        any = any || (parts[i].wrapped && !csg_blend_is_sharp(parts[i].blend.kind));
    return any;
}

/* S: of copies of the operands. */
static csg_node_id join_sharply(csg_eval *e, const csg_eval_part *parts, size_t count,
                                csg_node_kind kind, csg_span where)
{
    size_t bytes = count * sizeof *parts;
    csg_node_id node = CSG_NODE_NONE;
    csg_eval_part *copies = csg_memory_alloc(&e->context->memory, bytes);
    if (!copies) {
        csg_eval_no_memory(e);
        return CSG_NODE_NONE;
    }
    for (size_t i = 0; i < count && !e->stop; i++)
        copies[i] =
            csg_part_plain(csg_check_node(e, csg_build_copy(&e->builder, parts[i].node), where));
    if (!e->stop)
        node = join_operands(e, copies, count, kind, (csg_joining){.blend = CSG_SHARP}, where);
    csg_memory_release(&e->context->memory, copies, bytes);
    return node;
}

static csg_node_id join_within(csg_eval *e, csg_eval_part *parts, size_t operands, size_t count,
                               csg_node_kind kind, csg_joining by, csg_span where)
{
    bool is_union = kind == CSG_NODE_UNION;
    csg_node_id node = join_sharply(e, parts, operands, kind, where);
    csg_node_id blended =
        e->stop ? CSG_NODE_NONE : join_operands(e, parts, operands, kind, by, where);
    for (size_t i = operands; i < count && !e->stop; i++) {
        csg_node_id whole = blended, region = parts[i].node;
        if (i + 1 < count)
            whole = csg_check_node(e, csg_build_copy(&e->builder, blended), where);
        csg_node_id of[2] = {is_union ? whole : region, is_union ? region : whole};
        csg_node_kind how = is_union ? CSG_NODE_INTERSECTION : CSG_NODE_DIFFERENCE;
        csg_node_id pair[2] = {node, CSG_NODE_NONE};
        if (!e->stop)
            pair[1] = csg_check_node(
                e, csg_build_operator(&e->builder, how, parts[i].blend, of, 2, parts[i].where),
                where);
        if (!e->stop)
            node = csg_check_node(
                e,
                csg_build_operator(&e->builder, is_union ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE,
                                   CSG_SHARP, pair, 2, where),
                where);
    }
    return e->stop ? CSG_NODE_NONE : node;
}

void csg_parts_drop_regions(csg_eval *e, size_t first, const char *name)
{
    size_t operands = e->stop ? 0 : put_regions_last(e->parts + first, e->part_count - first);
    for (size_t i = first + operands; i < e->part_count && !e->stop; i++)
        csg_eval_report(e, CSG_DIAG_UNUSED_BLEND, e->parts[i].where, NULL,
                        "%s has no blend, this blend_within() is not used", name);
    if (!e->stop)
        e->part_count = first + operands;
}

csg_node_id csg_join_parts_by(csg_eval *e, size_t first, csg_node_kind kind, csg_joining by,
                              csg_span where)
{
    if (e->stop)
        return CSG_NODE_NONE;
    size_t count = e->part_count - first;
    csg_eval_part *parts = count ? e->parts + first : NULL;
    size_t operands = put_regions_last(parts, count);
    put_plain_first(e, parts, operands, kind);
    bool is_bounded = operands < count && blends(parts, operands, by);
    if (operands < count && !is_bounded)
        csg_eval_report(e, CSG_DIAG_UNUSED_BLEND, parts[operands].where, NULL,
                        "there is no blend here that this blend_within() could bound");
    csg_node_id node = is_bounded ? join_within(e, parts, operands, count, kind, by, where)
                                  : join_operands(e, parts, operands, kind, by, where);
    e->part_count = first;
    return node;
}

void csg_join_as_part(csg_eval *e, size_t first, csg_span where)
{
    if (e->part_count == first + 1)
        return;
    csg_node_id node = csg_join_parts(e, first, CSG_NODE_UNION, CSG_SHARP, where);
    if (node != CSG_NODE_NONE)
        csg_push_part(e, csg_part_plain(node));
}

/* ---- figures and solids ---------------------------------------------------------------------- */

bool csg_eval_is_empty(const csg_eval *e, csg_node_id node)
{
    return e->builder.scene->nodes[node].kind == CSG_NODE_EMPTY;
}

bool csg_eval_is_flat(const csg_eval *e, csg_node_id node)
{
    return !csg_eval_is_empty(e, node) && csg_build_is_flat(&e->builder, node);
}

size_t csg_parts_drop_unlike(csg_eval *e, size_t first, bool flat)
{
    size_t kept = first, count = e->part_count;
    for (size_t i = first; i < count; i++)
        if (csg_eval_is_empty(e, e->parts[i].node) || csg_eval_is_flat(e, e->parts[i].node) == flat)
            e->parts[kept++] = e->parts[i];
    e->part_count = kept;
    return count - kept;
}

void csg_parts_keep_alike(csg_eval *e, size_t first, csg_span where)
{
    size_t i = first;
    while (i < e->part_count && csg_eval_is_empty(e, e->parts[i].node))
        i++;
    if (e->stop || i == e->part_count)
        return;
    bool flat = csg_eval_is_flat(e, e->parts[i].node);
    size_t dropped = csg_parts_drop_unlike(e, first, flat);
    if (dropped)
        csg_eval_report(e, CSG_DIAG_MIXED_DIMENSIONS, where,
                        flat ? "linear_extrude makes a solid of a figure"
                             : "projection makes a figure of a solid",
                        "%s and %s side by side: the first rules, %zu %s left out",
                        flat ? "a flat figure" : "a solid", flat ? "solids" : "flat figures",
                        dropped, dropped == 1 ? "operand is" : "operands are");
}
