/* SPDX-License-Identifier: MIT
 * Drawings: their beginning and end; see drawing.h.
 */
#include "shape/plane/drawing.h"

csg_drawing *csg_drawing_create(csg_memory *memory)
{
    csg_drawing *made = csg_memory_alloc(memory, sizeof *made);
    if (!made)
        return NULL;
    *made = (csg_drawing){.memory = memory};
    csg_arena_init(&made->arena, memory);
    return made;
}

void csg_drawing_destroy(csg_drawing *drawing)
{
    if (!drawing)
        return;
    csg_memory *memory = drawing->memory;
    for (size_t i = 0; i < drawing->count; i++)
        csg_outline_release(&drawing->layers[i].outline);
    csg_memory_release(memory, drawing->layers, drawing->capacity * sizeof *drawing->layers);
    csg_arena_reset(&drawing->arena);
    csg_memory_release(memory, drawing, sizeof *drawing);
}
