/* SPDX-License-Identifier: MIT
 * The heap of counted objects; see value.h. Releasing walks a list of the dying instead of
 * recursing, so that a chain of a million nested vectors costs no stack.
 */
#include "lang/evaluate/value.h"

#include <math.h>
#include <string.h>

#include "lang/evaluate/rule_value.h"

/* Room for objects of one size. The last one that dies takes the block with it, but for one block
 * of each size: what a text has dropped is there for objects of all sizes. */
struct csg_heap_block {
    csg_heap_block *next, *previous;           /* among all */
    csg_heap_block *next_open, *previous_open; /* among those of this size that have room */
    size_t size_bytes;                         /* with this header */
    uint32_t object_bytes, live;
    csg_object *died;      /* room that was used */
    uint8_t *cursor, *end; /* room that never was */
};

enum {
    FIRST_BLOCK = 4096,
    LARGEST_BLOCK = 1 << 16,
#ifdef __SANITIZE_ADDRESS__
    LARGEST_SMALL = 0 /* so that it sees what is used after its end */
#else
    LARGEST_SMALL = CSG_SMALL_STEP * CSG_SMALL_SIZES
#endif
};

void csg_heap_init(csg_heap *heap, csg_memory *memory, uint32_t deepest)
{
    *heap = (csg_heap){.memory = memory, .deepest = deepest};
}

void csg_heap_reset(csg_heap *heap)
{
    while (heap->objects) {
        csg_object *next = heap->objects->next;
        csg_memory_release(heap->memory, heap->objects, heap->objects->size_bytes);
        heap->objects = next;
    }
    while (heap->blocks) {
        csg_heap_block *next = heap->blocks->next;
        csg_memory_release(heap->memory, heap->blocks, heap->blocks->size_bytes);
        heap->blocks = next;
    }
    csg_heap_init(heap, heap->memory, heap->deepest);
}

static void open_block(csg_heap *heap, csg_heap_block *block)
{
    csg_heap_block **first = &heap->open[block->object_bytes / CSG_SMALL_STEP];
    block->previous_open = NULL;
    block->next_open = *first;
    if (*first)
        (*first)->previous_open = block;
    *first = block;
}

static void close_block(csg_heap *heap, csg_heap_block *block)
{
    if (block->next_open)
        block->next_open->previous_open = block->previous_open;
    if (block->previous_open)
        block->previous_open->next_open = block->next_open;
    else
        heap->open[block->object_bytes / CSG_SMALL_STEP] = block->next_open;
}

/* Each block of a size is twice as large as the one before. */
static csg_heap_block *add_block(csg_heap *heap, size_t object_bytes)
{
    size_t *last = &heap->block_bytes[object_bytes / CSG_SMALL_STEP];
    size_t size = *last ? 2 * *last : (size_t)FIRST_BLOCK;
    size = size > LARGEST_BLOCK ? (size_t)LARGEST_BLOCK : size;
    csg_heap_block *block = csg_memory_alloc(heap->memory, size);
    if (!block)
        return NULL;
    *last = size;
    *block = (csg_heap_block){.next = heap->blocks,
                              .size_bytes = size,
                              .object_bytes = (uint32_t)object_bytes,
                              .cursor = (uint8_t *)(block + 1),
                              .end = (uint8_t *)block + size};
    if (heap->blocks)
        heap->blocks->previous = block;
    heap->blocks = block;
    open_block(heap, block);
    return block;
}

static void remove_block(csg_heap *heap, csg_heap_block *block)
{
    close_block(heap, block);
    if (block->next)
        block->next->previous = block->previous;
    if (block->previous)
        block->previous->next = block->next;
    else
        heap->blocks = block->next;
    csg_memory_release(heap->memory, block, block->size_bytes);
}

static bool has_room(const csg_heap_block *block)
{
    return block->died || (size_t)(block->end - block->cursor) >= block->object_bytes;
}

/* size_bytes: a multiple of CSG_SMALL_STEP. */
static csg_object *create_small(csg_heap *heap, size_t size_bytes)
{
    csg_heap_block *block = heap->open[size_bytes / CSG_SMALL_STEP];
    if (!block && !(block = add_block(heap, size_bytes)))
        return NULL;
    csg_object *object = block->died;
    if (object) {
        block->died = object->next;
    } else {
        object = (csg_object *)(void *)block->cursor;
        block->cursor += size_bytes;
    }
    object->block = block;
    block->live++;
    if (!has_room(block))
        close_block(heap, block);
    return object;
}

static csg_object *create_large(csg_heap *heap, size_t size_bytes)
{
    csg_object *object = csg_memory_alloc(heap->memory, size_bytes);
    if (!object)
        return NULL;
    object->previous = NULL;
    object->next = heap->objects;
    if (heap->objects)
        heap->objects->previous = object;
    heap->objects = object;
    return object;
}

static void *create(csg_heap *heap, csg_value_kind kind, size_t size_bytes)
{
    size_t size = (size_bytes + CSG_SMALL_STEP - 1) & ~(size_t)(CSG_SMALL_STEP - 1);
    csg_object *object =
        size <= LARGEST_SMALL ? create_small(heap, size) : create_large(heap, size);
    if (!object)
        return NULL;
    object->size_bytes = size;
    object->references = 1;
    object->kind = (uint8_t)kind;
    return object;
}

static void unlink_object(csg_heap *heap, csg_object *object)
{
    if (object->size_bytes <= LARGEST_SMALL)
        return;
    if (object->next)
        object->next->previous = object->previous;
    if (object->previous)
        object->previous->next = object->next;
    else
        heap->objects = object->next;
}

/* An object that is on no list any more. */
static void give_back(csg_heap *heap, csg_object *object)
{
    if (object->size_bytes > LARGEST_SMALL) {
        csg_memory_release(heap->memory, object, object->size_bytes);
        return;
    }
    csg_heap_block *block = object->block;
    bool was_open = has_room(block);
    object->next = block->died;
    block->died = object;
    block->live--;
    if (!was_open)
        open_block(heap, block);
    bool is_only = !block->next_open && !block->previous_open;
    if (block->live == 0 && !is_only)
        remove_block(heap, block);
}

/* ---- releasing ------------------------------------------------------------------------------ */

/* Drops one reference; the last one puts the object on the list of the dying. */
static void drop(csg_heap *heap, csg_object *object, csg_object **dying)
{
    if (!object || --object->references > 0)
        return;
    unlink_object(heap, object);
    object->next = *dying;
    *dying = object;
}

static void drop_values(csg_heap *heap, const csg_value *values, size_t count, csg_object **dying)
{
    for (size_t i = 0; i < count; i++)
        if (csg_value_is_object(values[i]))
            drop(heap, values[i].as.object, dying);
}

static void drop_frame(csg_heap *heap, const csg_frame *frame, csg_object **dying)
{
    drop_values(heap, frame->values, frame->count, dying);
    if (frame->parent)
        drop(heap, &frame->parent->object, dying);
    if (frame->children_frame)
        drop(heap, &frame->children_frame->object, dying);
}

void csg_object_release(csg_heap *heap, csg_object *object)
{
    csg_object *dying = NULL;
    unlink_object(heap, object);
    object->next = NULL;
    for (dying = object; dying;) {
        object = dying;
        dying = object->next;
        if (object->kind == CSG_VALUE_VECTOR || object->kind == CSG_VALUE_RECORD) {
            const csg_vector *vector = (const csg_vector *)object;
            drop_values(heap, vector->items, vector->count, &dying);
        } else if (object->kind == CSG_VALUE_FUNCTION) {
            drop(heap, &((csg_function *)object)->frame->object, &dying);
        } else if (object->kind == CSG_VALUE_RULE) {
            csg_function *function = ((csg_rule_value *)object)->function;
            if (function)
                drop(heap, &function->object, &dying);
        } else if (object->kind == CSG_VALUE_FRAME) {
            drop_frame(heap, (const csg_frame *)object, &dying);
        }
        give_back(heap, object);
    }
}

/* ---- making ---------------------------------------------------------------------------------- */

csg_string *csg_string_create(csg_heap *heap, const char *text, size_t length)
{
    csg_string *made = create(heap, CSG_VALUE_STRING, sizeof *made + length + 1);
    if (!made)
        return NULL;
    if (length)
        memcpy(made->text, text, length);
    made->text[length] = '\0';
    made->length = length;
    made->characters = 0;
    for (size_t i = 0; i < length; i++)
        made->characters += ((unsigned char)text[i] & 0xC0) != 0x80;
    return made;
}

csg_vector *csg_vector_create(csg_heap *heap, size_t count)
{
    csg_vector *made = create(heap, CSG_VALUE_VECTOR, sizeof *made + count * sizeof *made->items);
    if (!made)
        return NULL;
    made->count = (uint32_t)count;
    made->depth = 1;
    for (size_t i = 0; i < count; i++)
        made->items[i] = csg_value_undef();
    return made;
}

csg_value csg_range_create(csg_heap *heap, double begin, double step, double end)
{
    csg_range *made = create(heap, CSG_VALUE_RANGE, sizeof *made);
    if (!made)
        return csg_value_undef();
    made->begin = begin;
    made->step = step;
    made->end = end;
    return csg_value_object(made, CSG_VALUE_RANGE);
}

csg_value csg_rule_value_create(csg_heap *heap, const csg_rule *rule, csg_function *function)
{
    csg_rule_value *made = create(heap, CSG_VALUE_RULE, sizeof *made);
    if (!made)
        return csg_value_undef();
    made->rule = *rule;
    made->function = function;
    if (function)
        function->object.references++;
    return csg_value_object(made, CSG_VALUE_RULE);
}

csg_value csg_function_create(csg_heap *heap, const csg_expression *literal, csg_frame *frame)
{
    csg_function *made = create(heap, CSG_VALUE_FUNCTION, sizeof *made);
    if (!made)
        return csg_value_undef();
    made->literal = literal;
    made->frame = csg_frame_retain(frame);
    return csg_value_object(made, CSG_VALUE_FUNCTION);
}

csg_frame *csg_frame_create(csg_heap *heap, csg_frame *parent, uint32_t count)
{
    csg_frame *made = create(heap, CSG_VALUE_FRAME, sizeof *made + count * sizeof *made->values);
    if (!made)
        return NULL;
    made->parent = csg_frame_retain(parent);
    made->scope = NULL;
    made->file = NULL;
    made->children = NULL;
    made->children_frame = NULL;
    made->names = NULL;
    made->has_dynamics = false;
    made->child_count = (csg_value){.kind = CSG_VALUE_UNSET};
    made->count = count;
    for (uint32_t i = 0; i < count; i++)
        made->values[i] = (csg_value){.kind = CSG_VALUE_UNSET};
    return made;
}

/* ---- looking -----------------------------------------------------------------------------------
 */

bool csg_value_is_true(csg_value value)
{
    switch ((csg_value_kind)value.kind) {
    case CSG_VALUE_NUMBER:
        return value.as.number != 0;
    case CSG_VALUE_BOOLEAN:
        return value.as.boolean;
    case CSG_VALUE_STRING:
        return value.as.string->length > 0;
    case CSG_VALUE_VECTOR:
    case CSG_VALUE_RECORD:
        return value.as.vector->count > 0;
    case CSG_VALUE_UNDEF:
    case CSG_VALUE_UNSET:
        return false;
    case CSG_VALUE_BLEND:
    case CSG_VALUE_TERM:
    case CSG_VALUE_STEP:
    case CSG_VALUE_RANGE:
    case CSG_VALUE_FUNCTION:
    case CSG_VALUE_RULE:
    case CSG_VALUE_FRAME:
        break;
    }
    return true;
}

const char *csg_value_kind_name(csg_value value)
{
    switch ((csg_value_kind)value.kind) {
    case CSG_VALUE_NUMBER:
        return "number";
    case CSG_VALUE_BOOLEAN:
        return "bool";
    case CSG_VALUE_BLEND:
    case CSG_VALUE_RULE:
        return "blend";
    case CSG_VALUE_TERM:
        return "formula";
    case CSG_VALUE_STEP:
        return "step";
    case CSG_VALUE_STRING:
        return "string";
    case CSG_VALUE_VECTOR:
        return "vector";
    case CSG_VALUE_RECORD:
        return "object";
    case CSG_VALUE_RANGE:
        return "range";
    case CSG_VALUE_FUNCTION:
        return "function";
    case CSG_VALUE_UNDEF:
    case CSG_VALUE_UNSET:
    case CSG_VALUE_FRAME:
        break;
    }
    return "undef";
}

bool csg_value_numbers(csg_value value, size_t count, double *out)
{
    if (value.kind != CSG_VALUE_VECTOR || value.as.vector->count != count)
        return false;
    for (size_t i = 0; i < count; i++) {
        if (value.as.vector->items[i].kind != CSG_VALUE_NUMBER)
            return false;
        out[i] = value.as.vector->items[i].as.number;
    }
    return true;
}

uint32_t csg_record_find(csg_value record, const char *key, size_t length)
{
    const csg_vector *entries = record.as.vector;
    uint32_t i = 0, count = entries->count / 2;
    for (; i < count; i++) {
        const csg_string *name = entries->items[2 * i].as.string;
        if (name->length == length && memcmp(name->text, key, length) == 0)
            break;
    }
    return i;
}

double csg_range_count(const csg_range *range)
{
    if (isnan(range->begin) || isnan(range->step) || isnan(range->end))
        return 0;
    if (isinf(range->step) && isfinite(range->begin) && isfinite(range->end)) {
        double length = range->end - range->begin;
        return length == 0 || signbit(length) == signbit(range->step) ? 1 : 0;
    }
    if (range->step == 0 || isinf(range->begin) || isinf(range->end))
        return range->step != 0 && (range->end - range->begin) / range->step < 0 ? 0 : INFINITY;
    double span = (range->end - range->begin) / range->step;
    /* One unit in the last place beyond the end counts as the end, as in OpenSCAD: 0.3 / 0.1 < 3.
     */
    return span < 0 ? 0 : floor(nextafter(span, INFINITY)) + 1;
}
