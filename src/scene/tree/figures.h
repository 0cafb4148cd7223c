/* SPDX-License-Identifier: MIT
 * What has been made of flat figures while a scene is being built. Scenes name the same figure
 * again and again (a screw, a letter, one ring of many), and its offsets, hulls and unions cost far
 * more than finding it here: outlines by all that says what the figure is, regions by their
 * outlines, each compared in full. What was made once is the same to the bit when made again.
 */
#ifndef CSG_SCENE_FIGURES_H
#define CSG_SCENE_FIGURES_H

#include "base/table.h"
#include "shape/shape.h"

typedef struct csg_figures csg_figures;

/* All that says what a figure is, as words. */
typedef struct csg_figure_key {
    csg_memory *memory;
    uint64_t *words;
    csg_shape **shapes; /* whose addresses are among the words; borrowed */
    size_t count, capacity, shape_count, shape_capacity;
    bool is_known; /* nothing of it was beyond words; else it is not looked for */
} csg_figure_key;

void csg_figure_key_init(csg_figure_key *key, csg_memory *memory);
void csg_figure_key_release(csg_figure_key *key);
/* False: no memory. */
bool csg_figure_key_word(csg_figure_key *key, uint64_t word);
bool csg_figure_key_numbers(csg_figure_key *key, const double *numbers, size_t count);
bool csg_figure_key_shape(csg_figure_key *key, csg_shape *shape);

/* The outline that was kept, in the hands of `figures`; NULL: none. */
const csg_outline *csg_figures_find(const csg_figures *figures, const csg_figure_key *key);
/* Keeps a copy while there is room; *figures: NULL at first. False: no memory. */
bool csg_figures_keep(csg_figures **figures, const csg_figure_key *key, const csg_outline *outline);

/* csg_region_create, or one more reference to the region of this outline that was made before. */
csgm_status csg_figures_region(csg_figures **figures, csg_memory *memory, const csg_outline *clean,
                               csg_shape **out);

/* NULL is a no-op. */
void csg_figures_destroy(csg_figures *figures);

#endif
